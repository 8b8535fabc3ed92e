"""Reads the tables of a TOML file, and reports in plain words what is wrong with a faulty one."""

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
from fcm.scene.options import TOML, TomlOptions

_PART = r"""(?:[\w-]++|"[^"\n]*+"|'[^'\n]*+')"""

NETCDF_BEGINS = b"\x89HDF", b"CDF"  # the first bytes of netCDF files
ARCHIVE_BEGINS = b"PK\x03\x04"  # and of .npz files


def read_toml(path: Path, source: str, options: TomlOptions = TOML) -> dict[str, Any]:
    """The tables of a TOML file, which messages call `source`."""
    text = _text(path, source, options)
    if deep := _deep_key(options.deepest_key).search(text):
        line = text.count("\n", 0, deep.start() + 1) + 1
        raise SceneError(source, [f"line {line}: unknown key, of more than {options.deepest_key} parts"])
    try:
        return tomllib.loads(text)
    except tomllib.TOMLDecodeError:
        from fcm.scene.toml_mistakes import slips

        raise SceneError(source, slips(text)) from None
    except RecursionError:
        raise SceneError(source, ["is nested too deeply"]) from None
    except ValueError:  # Python's limit on the digits of an integer, or an invalid date
        raise SceneError(source, ["has a number or a date that cannot be read"]) from None


def _deep_key(parts: int) -> re.Pattern[str]:
    """A pattern for a key of more parts, at the beginning of a line, of a header or of an inline table."""
    return re.compile(rf"(?:^|[\[{{,])[ \t]*+(?:{_PART}[ \t]*+\.[ \t]*+){{{parts}}}", re.MULTILINE)


def _from_pipe(path: Path, source: str, options: TomlOptions) -> bytes:
    """The bytes written to a pipe; reports once that it waits, as this may last for ever."""
    with os.fdopen(os.open(path, os.O_RDONLY | os.O_NONBLOCK), "rb") as pipe:
        if not select.select([pipe], [], [], options.patience)[0]:
            warnings.warn(f"{source} is a pipe: waiting until something is written to it", stacklevel=2)
            select.select([pipe], [], [])
        os.set_blocking(pipe.fileno(), True)
        return pipe.read(options.largest_file + 1)


def _text(path: Path, source: str, options: TomlOptions) -> str:
    """Reads the text of a file."""
    try:
        if not source:
            raise SceneError("SCENE", ["is empty; name a TOML file, or a bundled scene"])
        if path.is_dir():
            raise SceneError(source, ["is a folder; name the TOML file in it"])
        if not path.is_fifo() and (what := no_file(path)):
            raise SceneError(source, [what])
        pipe = _from_pipe(path, source, options) if path.is_fifo() else None
        if max(len(pipe or b""), path.stat().st_size) > options.largest_file:
            raise SceneError(source, ["is too large; keep its modes in a file of their own"])
        return (path.read_bytes() if pipe is None else pipe).decode("utf-8-sig")
    except UnicodeDecodeError as error:
        what = "is not UTF-8 text, so it is not a TOML file: save it as UTF-8"
        if error.object.startswith(NETCDF_BEGINS):
            what = "is a file of results; name the scene, a TOML file, that it is of"
        elif error.object.startswith(ARCHIVE_BEGINS):
            what = "is an archive, as of matrices; name the scene, a TOML file, that names it"
        elif error.object[:2] not in (b"\xff\xfe", b"\xfe\xff") and b"\0" not in error.object:
            what += f"; the first letter that is none is in line {error.object.count(10, 0, error.start) + 1}"
        raise SceneError(source, [what]) from None
    except OSError as error:
        raise SceneError(source, [f"cannot be read: {error.strerror or error}"]) from None
