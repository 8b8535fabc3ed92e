"""Fingerprint (32 bytes) of all that results depend on: the request, and the program.

On one machine, sizes and times of change of its files identify the program, as Python matches bytecode to
sources. That takes a millisecond; to read all files would take twenty. Between machines, the contents of
the files identify it.
"""

from __future__ import annotations

import os
import pickle
import platform
from collections.abc import Iterable, Iterator
from dataclasses import fields, is_dataclass
from functools import cache
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import numpy as np

import fcm
from fcm.run.digest import sha256

PROGRAM = (".py", ".so", ".pyd")  # endings of files that decide what is computed
TABLE, LAST = ".nc", 64  # a table ends in a checksum of all its bytes (`fcm.table.file_checksum`)


def fingerprint(*parts: Any) -> bytes:
    """Digest of dataclasses, arrays, plain values and collections of them, and of this program.

    >>> fingerprint(1.0, "a") == fingerprint(1.0, "a"), fingerprint(("a", "b")) == fingerprint(("ab",))
    (True, False)
    """
    seen: dict[int, bytes] = {}
    return sha256(installed(Path(fcm.__file__).parent) + _digest(parts, seen)).digest()


@cache
def installed(folder: Path) -> bytes:
    """Digest of sizes and times of change of the sources in a folder, and of Python and library versions."""
    files = [(file.path, file.stat().st_size, file.stat().st_mtime_ns) for file in _files(str(folder))]
    scipy = find_spec("scipy")  # to import it takes 15 ms
    where = scipy.origin if scipy is not None else None
    changed = os.stat(where).st_mtime_ns if where is not None else 0  # noqa: PTH116
    versions = fcm.__version__, platform.python_version(), platform.machine(), np.__version__, where, changed
    return sha256(repr((versions, sorted(files))).encode()).digest()


def _files(folder: str) -> Iterator[os.DirEntry[str]]:
    """Yields the files in a folder and below that decide what is computed."""
    for entry in os.scandir(folder):
        if entry.name.endswith((*PROGRAM, TABLE)):
            yield entry
        elif entry.name != "__pycache__" and entry.is_dir():
            yield from _files(entry.path)


@cache
def program(folder: Path) -> bytes:
    """Digest of the contents of the sources in a folder, and of Python and library versions."""
    import scipy

    versions = (
        fcm.__version__,
        platform.python_version(),
        platform.machine(),
        np.__version__,
        scipy.__version__,
    )
    digest = sha256(repr(versions).encode())
    for path in sorted(folder.rglob("*")):
        if path.suffix in (*PROGRAM, TABLE):
            content = path.read_bytes() if path.suffix != TABLE else _end(path)
            digest.update(f"{path.relative_to(folder)} {len(content)} ".encode() + content)
    return digest.digest()


def _end(path: Path) -> bytes:
    with path.open("rb") as file:
        file.seek(max(file.seek(0, 2) - LAST, 0))
        return file.read()


def _digest(value: Any, seen: dict[int, bytes]) -> bytes:
    """Digest of a value; values that curves share are digested once."""
    if id(value) in seen:
        return seen[id(value)]
    name = type(value).__qualname__
    if isinstance(value, np.ndarray):
        found = sha256(f"{name} {value.shape} {value.dtype}".encode() + value.tobytes()).digest()
    elif is_dataclass(value) and not isinstance(value, type):
        found = _of(name, (getattr(value, field.name) for field in fields(value)), seen)
    elif isinstance(value, dict):
        found = _of(name, (part for item in value.items() for part in item), seen)
    elif isinstance(value, tuple | list):
        found = _of(name, value, seen)
    elif isinstance(value, str | bytes | int | float | complex | None):
        return sha256(f"{name} {value!r}".encode()).digest()
    else:
        found = sha256(pickle.dumps(value)).digest()
    seen[id(value)] = found
    return found


def _of(name: str, parts: Iterable[Any], seen: dict[int, bytes]) -> bytes:
    digests = [_digest(part, seen) for part in parts]
    return sha256(f"{name} {len(digests)} ".encode() + b"".join(digests)).digest()
