"""Finished groups of a sweep, kept in a file beside the output until the sweep is whole.

The file begins with a fingerprint of everything that the result depends on; then each group is appended as
its length, its digest and its curves. A record that an interruption has cut off is not read.
"""

from __future__ import annotations

import hashlib
import io
import pickle
import struct
from collections.abc import Iterator
from dataclasses import fields, is_dataclass
from pathlib import Path
from typing import Any

import numpy as np

import fcm
from fcm.response.result import Curve
from fcm.scene.model import Scene

HEAD = struct.Struct("<qq32s")  # number of the group, length, digest
_ALLOWED = {  # what a record may consist of, and nothing that could do anything
    ("fcm.response.result", "Curve"),
    ("fcm.response.result", "Orbits"),
    ("fcm.response.jumps", "Jump"),
    ("numpy", "ndarray"),
    ("numpy", "dtype"),
    ("numpy._core.multiarray", "_reconstruct"),
    ("numpy.core.multiarray", "_reconstruct"),
    ("numpy._core.numeric", "_frombuffer"),
    ("numpy.core.numeric", "_frombuffer"),
    ("numpy._core.multiarray", "scalar"),
    ("numpy.core.multiarray", "scalar"),
}


class Kept:
    """The file of finished groups; without a path nothing is kept."""

    def __init__(self, path: Path | None, mark: bytes, resume: bool) -> None:
        self.path = path
        self.finished: dict[int, list[Curve]] = {}
        if path is None:
            return
        if resume and path.is_file():
            self.finished = dict(_records(path.read_bytes(), mark))
        path.write_bytes(mark)
        for number, curves in self.finished.items():
            self._append(number, curves)

    def add(self, number: int, curves: list[Curve]) -> None:
        """Keep a finished group."""
        self.finished[number] = curves
        self._append(number, curves)

    def remove(self) -> None:
        """The sweep is whole, or nothing of it is: the file is not needed."""
        if self.path is not None:
            self.path.unlink(missing_ok=True)

    def _append(self, number: int, curves: list[Curve]) -> None:
        if self.path is None:
            return
        payload = pickle.dumps(curves, protocol=5)
        with self.path.open("ab") as file:
            file.write(HEAD.pack(number, len(payload), hashlib.sha256(payload).digest()) + payload)


def fingerprint(curves: tuple[Scene, ...], method: str, table: object, size: int) -> bytes:
    """Digest of all that decides the result: the scenes, the method, the table, the groups, the version."""
    digest = hashlib.sha256(f"fcm {fcm.__version__} {method} {size} {len(curves)}".encode())
    seen: dict[int, bytes] = {}
    for scene in curves:
        digest.update(_digest(scene, seen))
    digest.update(pickle.dumps(table))
    return digest.digest()


def _digest(value: Any, seen: dict[int, bytes]) -> bytes:
    """Digest of a dataclass, an array or a plain value; shared parts are read once."""
    if id(value) not in seen:
        digest = hashlib.sha256()
        if is_dataclass(value):
            for field in fields(value):
                digest.update(_digest(getattr(value, field.name), seen))
        elif isinstance(value, np.ndarray):
            digest.update(repr((value.shape, value.dtype)).encode() + value.tobytes())
        elif isinstance(value, tuple):
            for item in value:
                digest.update(_digest(item, seen))
        else:
            return hashlib.sha256(repr(value).encode()).digest()
        seen[id(value)] = digest.digest()
    return seen[id(value)]


def _records(data: bytes, mark: bytes) -> Iterator[tuple[int, list[Curve]]]:
    """The groups of a file with this fingerprint, up to the first that is damaged."""
    at = len(mark)
    if data[:at] != mark:
        return
    while at + HEAD.size <= len(data):
        number, length, digest = HEAD.unpack_from(data, at)
        payload = data[at + HEAD.size : at + HEAD.size + length]
        if length < 0 or hashlib.sha256(payload).digest() != digest:
            return
        try:
            yield number, _Reader(io.BytesIO(payload)).load()
        except (pickle.UnpicklingError, EOFError, ValueError, TypeError, AttributeError, ImportError):
            return
        at += HEAD.size + length


class _Reader(pickle.Unpickler):
    def find_class(self, module: str, name: str) -> Any:
        if (module, name) in _ALLOWED:
            return super().find_class(module, name)
        raise pickle.UnpicklingError(f"{module}.{name} does not belong into a result")
