"""The tables of a TOML file; whatever is wrong with the file is said plainly."""

from __future__ import annotations

import os
import re
import select
import tomllib
import warnings
from pathlib import Path
from typing import Any

from fcm.files import no_file
from fcm.scene.errors import SceneError
from fcm.scene.toml_slips import slips

PATIENCE = 2.0  # [s] without a byte from a pipe before that is said
LARGEST_FILE = 10_000_000  # bytes; a larger one is a mistake, or its modes belong in a file of their own
DEEPEST_KEY = 16  # parts of a dotted key: the parser takes the square of their number in time and memory

# at the beginning of a line, a header or an inline table: a part and a dot, again and again
_PART = r"""(?:[\w-]++|"[^"\n]*+"|'[^'\n]*+')"""
_DEEP_KEY = re.compile(rf"(?:^|[\[{{,])[ \t]*+(?:{_PART}[ \t]*+\.[ \t]*+){{{DEEPEST_KEY}}}", re.MULTILINE)


def read_toml(path: Path, source: str) -> dict[str, Any]:
    """The tables of a TOML file, which messages call `source`."""
    text = _text(path, source)
    if deep := _DEEP_KEY.search(text):
        line = text.count("\n", 0, deep.start() + 1) + 1
        raise SceneError(source, [f"line {line}: unknown key, of more than {DEEPEST_KEY} parts"])
    try:
        return tomllib.loads(text)
    except tomllib.TOMLDecodeError:
        raise SceneError(source, slips(text)) from None
    except RecursionError:
        raise SceneError(source, ["is nested too deeply"]) from None
    except ValueError:  # Python's limit on the digits of an integer, or of a date
        raise SceneError(source, ["has a number or a date that cannot be read"]) from None


def _from_pipe(path: Path, source: str) -> bytes:
    """What is written to a pipe; that nothing is, which may be so for ever, is said."""
    with os.fdopen(os.open(path, os.O_RDONLY | os.O_NONBLOCK), "rb") as pipe:
        if not select.select([pipe], [], [], PATIENCE)[0]:
            warnings.warn(f"{source} is a pipe: waiting until something is written to it", stacklevel=2)
            select.select([pipe], [], [])
        os.set_blocking(pipe.fileno(), True)
        return pipe.read(LARGEST_FILE + 1)


def _text(path: Path, source: str) -> str:
    """The text of a file."""
    try:
        if not source:
            raise SceneError("SCENE", ["is empty; name a TOML file, or a bundled scene"])
        if path.is_dir():
            raise SceneError(source, ["is a folder; name the TOML file in it"])
        if not path.is_fifo() and (what := no_file(path)):
            raise SceneError(source, [what])
        pipe = _from_pipe(path, source) if path.is_fifo() else None
        if max(len(pipe or b""), path.stat().st_size) > LARGEST_FILE:
            raise SceneError(source, ["is too large; keep its modes in a file of their own"])
        return (path.read_bytes() if pipe is None else pipe).decode("utf-8-sig")
    except UnicodeDecodeError as error:
        what = "is not UTF-8 text, so it is not a TOML file: save it as UTF-8"
        if error.object[:2] not in (b"\xff\xfe", b"\xfe\xff") and b"\0" not in error.object:
            what += f"; the first letter that is none is in line {error.object.count(10, 0, error.start) + 1}"
        raise SceneError(source, [what]) from None
    except OSError as error:
        raise SceneError(source, [f"cannot be read: {error.strerror or error}"]) from None
