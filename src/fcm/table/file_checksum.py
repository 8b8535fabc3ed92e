"""A seal on a file: the checksum of all its bytes, in a line after them.

HDF5 ignores what follows its own end of a file. It does not notice damage, and may then return wrong numbers
or never return. So the seal is checked before the library reads the file.
"""

from __future__ import annotations

import zlib
from pathlib import Path

START = b"\nfcm sealed crc32 "
LENGTH = len(START) + 9  # eight hexadecimal digits and the end of the line


def attach(path: Path) -> None:
    """Appends the checksum line to a file."""
    with path.open("r+b") as file:
        line = _line(file.read())
        file.write(line)


class BrokenSealError(ValueError):
    """Raised if the bytes of a file are not those that were sealed."""


def check(path: Path) -> bytes | None:
    """The content of a sealed file without its seal; None for a file without a seal, of another program.

    Raises
    ------
    BrokenSealError
        If there is a seal but the bytes before it have changed.
    OSError
        If the file cannot be read.
    """
    with path.open("rb") as file:
        size = file.seek(0, 2)
        if size < LENGTH:
            return None
        file.seek(size - LENGTH)
        seal = file.read()
        if not seal.startswith(START):
            return None
        file.seek(0)
        content = file.read(size - LENGTH)
    if _line(content) != seal:
        raise BrokenSealError("its bytes do not match their checksum")
    return content


def of(path: Path) -> str:
    """The seal of a file, or the last bytes of a file without one."""
    with path.open("rb") as file:
        file.seek(max(file.seek(0, 2) - LENGTH, 0))
        return file.read().decode("latin-1")


def _line(content: bytes) -> bytes:
    return START + f"{zlib.crc32(content):08x}\n".encode()
