"""Reads columns of numbers from a text file, with a given count of numbers on each line."""

from __future__ import annotations

import io
import re
from collections.abc import Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from fcm.scene.errors import quoted
from fcm.scene.files import UnreadableError
from fcm.scene.number_text import fault_of_number, number_in

COMMENT = b"**"
MARK = b"\xef\xbb\xbf"  # byte-order mark of UTF-8, which some editors write at the beginning


class Columns(NamedTuple):
    """Integers (line, whole column), reals (line,), and the number of each line in the file."""

    whole: npt.NDArray[np.int64]
    real: npt.NDArray[np.float64]
    line: npt.NDArray[np.int64]


def read_columns(path: Path, whole: int, between: str | None = None) -> Columns:
    """Reads lines with a count (whole) of integers and a real number; skips blank lines and comments.

    Any other line raises UnreadableError with its number and what it must contain.
    """
    content = path.read_bytes().removeprefix(MARK)
    if not _holds_something(content):
        raise UnreadableError("it is empty")
    kind = np.dtype([("whole", np.int64, (whole,)), ("real", np.float64)])
    try:
        found = _loaded(content, kind, between)
    except (ValueError, UnicodeDecodeError):
        found = _line_by_line(content, kind, between)
    count = content.count(b"\n") + (not content.endswith(b"\n"))
    every = found.size == count  # a quick test for millions of lines
    lines = np.arange(1, count + 1) if every else _numbers_of_lines(content)
    good = np.isfinite(found["real"])
    if not good.all():
        raise UnreadableError(f"line {lines[int(good.argmin())]}: is no finite number")
    return Columns(found["whole"], found["real"], lines)


def _holds_something(content: bytes) -> bool:
    """Whether a line holds more than a comment."""
    return any(one.partition(COMMENT)[0].strip() for one in io.BytesIO(content))


def _loaded(content: bytes, kind: np.dtype[Any], between: str | None) -> npt.NDArray[Any]:
    """Reads the lines by numpy; replaces comment marks of two letters, with which numpy is slow."""
    mark: str | None = COMMENT.decode()
    if COMMENT not in content:
        mark = None
    elif b"#" not in content:
        content, mark = content.replace(COMMENT, b"#"), "#"
    return np.loadtxt(io.BytesIO(content), kind, delimiter=between, comments=mark, ndmin=1)


def _numbers_of_lines(content: bytes) -> npt.NDArray[np.int64]:
    """The numbers, from 1, of the lines that hold more than a comment."""
    lines = content.split(b"\n")
    return np.array(
        [i for i, one in enumerate(lines, 1) if one.partition(COMMENT)[0].strip()], dtype=np.int64
    )


def _line_by_line(content: bytes, kind: np.dtype[Any], between: str | None) -> npt.NDArray[Any]:
    """Reads the lines one by one, with numbers as written by Fortran; raises for the first wrong line."""
    try:
        text = content.decode("utf-8")
    except UnicodeDecodeError:
        raise UnreadableError("it is no text in UTF-8; save it as that") from None
    found = []
    for number, line in enumerate(text.split("\n"), 1):
        words = line.partition(COMMENT.decode())[0].strip()
        if words:
            found.append(_row([one.strip() for one in words.split(between)], kind, number, between))
    return np.array(found, dtype=kind)


def _row(words: Sequence[str], kind: np.dtype[Any], number: int, between: str | None) -> tuple[Any, float]:
    count = kind["whole"].shape[0] + 1
    if len(words) != count:
        apart = "commas" if between == "," else "blanks"
        has = f"line {number} has {len(words)} {'entry' if len(words) == 1 else 'entries'}"
        raise UnreadableError(f"{has}; {count} are needed, with {apart} between")
    places = []
    for word in words[:-1]:
        if not re.fullmatch(r"[+-]?\d{1,18}", word, re.ASCII):
            raise UnreadableError(f"line {number}: {quoted(word)} must be a whole number")
        places.append(int(word))
    return tuple(places), real_of(words[-1], number)


def real_of(word: str, line: int) -> float:
    """The number in a word; UnreadableError with the line and what to write if it is not a number.

    >>> real_of("1.005D+02", 7)
    100.5
    """
    value = number_in(word)
    if value is None:
        raise UnreadableError(f"line {line}: {fault_of_number(word)}")
    return value
