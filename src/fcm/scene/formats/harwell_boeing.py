"""Reads matrices in the Harwell-Boeing text format (.hb, .rsa, .rua; Ansys writes .matrix by HBMAT).

The header has the numbers of lines of pointers, indices and values, and the Fortran format of each. For a
symmetric matrix (RSA) one triangle is stored. Right-hand sides after the values are skipped.
Source: Duff, Grimes and Lewis, Users' guide for the Harwell-Boeing sparse matrix collection (1992).
"""

from __future__ import annotations

import re
from pathlib import Path
from typing import NamedTuple

import numpy as np
import numpy.typing as npt
import scipy.sparse

from fcm.scene.files import UnreadableError
from fcm.scene.formats.columns import real_of
from fcm.scene.formats.labelled import Labelled, symmetric_from

FORMAT = re.compile(r"\(\s*(?:\d+P\s*,?\s*)?(\d*)\s*([IEDFG])\s*(\d+)(?:\.\d+(?:E\d+)?)?\s*\)", re.IGNORECASE)
HEAD = 4  # number of lines before the pointers; one more if there are right-hand sides


class Fields(NamedTuple):
    """A Fortran format: the number of fields on a line, and their width."""

    number: int
    width: int


def read_harwell_boeing(path: Path, largest: int) -> dict[str, Labelled]:
    """The matrix of a file, by the name "matrix"; its rows have no names."""
    content = path.read_bytes()
    lines = content.decode("latin-1").splitlines()
    if len(lines) < HEAD:
        raise UnreadableError("it has no header of the Harwell-Boeing format")
    cards = [_count(lines[1], i, 2) for i in range(5)]
    kind = lines[2][:3].upper()
    if kind not in ("RSA", "RUA"):
        raise UnreadableError(
            f'line 3: "{lines[2][:3]}" is the kind of matrix; RSA or RUA, real and assembled, is read'
        )
    rows, columns, entries = (_count(lines[2], i, 3) for i in range(1, 4))
    if rows != columns:
        raise UnreadableError(f"line 3: it has {rows} rows and {columns} columns; a square matrix is needed")
    if 8 * max(rows, entries) > largest:
        raise MemoryError
    formats = [_format(lines[3][i:end]) for i, end in ((0, 16), (16, 32), (32, 52))]
    begin = HEAD + (cards[4] > 0)
    parts = []
    for card, form, size in zip(cards[1:4], formats, (columns + 1, entries, entries), strict=True):
        parts.append(_numbers(lines, begin, card, form, size))
        begin += card
    if begin == len(lines) and len(lines[-1]) % formats[2].width and not content.endswith((b"\n", b"\r")):
        raise UnreadableError(f"it is cut off: line {begin} ends within a number")
    pointer, index, value = _whole(parts[0]), _whole(parts[1]), parts[2]
    steps = np.diff(pointer)
    if pointer[0] != 1 or pointer[-1] != entries + 1 or (steps < 0).any():
        raise UnreadableError("its pointers of columns do not rise from 1 to the number of entries")
    if entries and (index.min() < 1 or index.max() > rows):
        raise UnreadableError(f"it has indices of rows beyond 1 to {rows}")
    column = np.repeat(np.arange(columns), steps)
    if kind == "RSA":
        line = HEAD + (cards[4] > 0) + cards[1] + np.arange(entries) // formats[1].number + 1
        return {"matrix": Labelled(symmetric_from(index - 1, column, line, value, rows))}
    return {"matrix": Labelled(scipy.sparse.coo_array((value, (index - 1, column)), shape=(rows, rows)))}


def _count(line: str, field: int, number: int) -> int:
    """A whole number of the header, in fields of 14 characters."""
    word = line[14 * field : 14 * (field + 1)].strip()
    if field == 4 and not word:  # no right-hand sides
        return 0
    if not (word.isascii() and word.isdecimal()):
        raise UnreadableError(
            f'line {number}: "{word}" in columns {14 * field + 1} on must be a whole number'
        )
    return int(word)


def _format(word: str) -> Fields:
    """The format given by a word of the fourth line."""
    found = FORMAT.fullmatch(word.strip())
    if not found:
        raise UnreadableError(f'line 4: "{word.strip()}" is no Fortran format such as (10I8) or (4E20.13)')
    return Fields(int(found[1] or 1), int(found[3]))


def _numbers(lines: list[str], begin: int, cards: int, form: Fields, size: int) -> npt.NDArray[np.float64]:
    """Reads `size` numbers from some lines of one format."""
    if cards * form.number < size or begin + cards > len(lines):
        raise UnreadableError(f"it is cut off: line {begin + 1} on must hold {size} numbers")
    for number, line in enumerate(lines[begin : begin + cards], begin + 1):
        if line[form.number * form.width :].strip():
            right = f"{form.number} of {form.width} characters"
            raise UnreadableError(f"line {number} is longer than the numbers of its format, {right}")
    at_once = _at_once(lines[begin : begin + cards], form, size)
    if at_once is not None:
        return at_once
    found = list[float]()
    for number, line in enumerate(lines[begin : begin + cards], begin + 1):
        for i in range(min(form.number, size - len(found))):
            word = line[i * form.width : (i + 1) * form.width].strip()
            found.append(real_of(word, number))
    if len(found) < size:
        raise UnreadableError(
            f"it is cut off: line {begin + 1} on must hold {size} numbers, has {len(found)}"
        )
    return np.array(found)


def _at_once(lines: list[str], form: Fields, size: int) -> npt.NDArray[np.float64] | None:
    """Reads the numbers of lines by numpy at once; None if they must be read one by one."""
    full = form.number * form.width
    joined = "".join(line[:full].ljust(full) for line in lines).encode("latin-1")
    words = np.frombuffer(joined, dtype=f"S{form.width}")[:size]
    if b"_" in joined or not size:
        return None
    try:
        found = np.char.replace(np.char.upper(words), b"D", b"E").astype(np.float64)
    except ValueError:
        return None
    return found if np.isfinite(found).all() else None


def _whole(numbers: npt.NDArray[np.float64]) -> npt.NDArray[np.int64]:
    whole = numbers.astype(np.int64)
    if (whole != numbers).any():
        raise UnreadableError("a pointer or an index is no whole number")
    return whole


def ansys_names(lines: list[str]) -> list[str]:
    """Names of rows from a mapping file of Ansys: the equation, its node, and UX to ROTZ.

    >>> ansys_names(["Matrix Eqn  Node  DOF", "  1   7  UX", "  2   7  ROTZ"])
    ['7x', '7rz']
    """
    found: list[str] = []
    for number, line in enumerate(lines, 1):
        words = line.split()
        if len(words) != 3 or not re.fullmatch(r"\d+ \d+", " ".join(words[:2]), re.ASCII):
            if found and words:
                raise UnreadableError(f"line {number}: must be an equation, a node and UX to ROTZ")
            continue
        direction = re.fullmatch(r"(U|ROT)([XYZ])", words[2].upper())
        if not direction:
            raise UnreadableError(
                f'line {number}: "{words[2]}" is no displacement UX to UZ or rotation ROTX to ROTZ'
            )
        if int(words[0]) != len(found) + 1:
            raise UnreadableError(f"line {number}: equation {words[0]} comes where {len(found) + 1} should")
        found.append(f"{int(words[1])}{'r' if direction[1] == 'ROT' else ''}{direction[2].lower()}")
    return found
