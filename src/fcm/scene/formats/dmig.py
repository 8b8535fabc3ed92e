"""Reads matrices of Nastran from a punch file (.pch): DMIG entries, in fields of 8, of 16, or with commas.

The header of a matrix has its form (6 symmetric, 1 square) and type (1, 2 real; 3, 4 complex). Each further
entry is a column: its point and component, then point, component and value of each row.
Source: MSC Nastran Quick Reference Guide, DMIG.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from fcm.scene.files import UnreadableError
from fcm.scene.formats.columns import real_of
from fcm.scene.formats.labelled import DIRECTIONS, Labelled, labelled_from

SMALL, LARGE = 8, 16  # characters of a field
FREE = 10  # a comma within so many columns means free format
NUMERIC = re.compile(r"[-.\d]", re.ASCII)  # first character of a number, not of a continuation mark
SYMMETRIC, SQUARE = 6, 1  # forms
REAL = (1, 2)  # types


@dataclass
class Entries:
    """Entries of one matrix while it is read."""

    form: int
    line: list[int] = field(default_factory=list)
    places: list[tuple[int, int, int, int]] = field(default_factory=list)
    value: list[float] = field(default_factory=list)


def read_dmig(path: Path, largest: int) -> dict[str, Labelled]:
    """Reads all matrices of a punch file, by their names, with the names of their rows."""
    found: dict[str, Entries] = {}
    try:
        text = path.read_text("utf-8-sig")
    except UnicodeDecodeError:
        raise UnreadableError("it is no text in UTF-8; save it as that") from None
    for number, fields in _entries(text):
        _take(found, number, fields)
    if not found:
        raise UnreadableError("it holds no DMIG entries; Nastran punches matrices by EXTSEOUT(DMIGPCH)")
    return {name: _labelled(name, one) for name, one in found.items() if one.value}


def _entries(text: str) -> Iterator[tuple[int, list[str]]]:
    """Yields the number of the first line and the fields of each DMIG entry, continuations joined."""
    first, fields = 0, list[str]()
    for number, line in enumerate(text.splitlines(), 1):
        body = line.partition("$")[0].rstrip()
        if not body:
            continue
        if body[0] in "*+" or (body[0] == "," and fields) or (body[0] == " " and fields):
            if fields:  # otherwise it continues an entry that is not read
                fields += _fields(body, number)[1:]
            continue
        if fields:
            yield first, fields
        kind = body.replace(",", " ").split()[0].upper()
        first, fields = number, _fields(body, number) if kind in ("DMIG", "DMIG*") else []
    if fields:
        yield first, fields


def _fields(line: str, number: int) -> list[str]:
    """Fields of a line without its continuation mark; the first is the entry's name.

    Too many fields raise UnreadableError.
    """
    if "," in line[:FREE]:
        words = [one.strip() for one in line.split(",")]
        count = 5 if words[0].endswith("*") else 9
        if any(words[count + 1 :]) or NUMERIC.match("".join(words[count : count + 1])):
            raise UnreadableError(f"line {number} has {len(words)} fields; there are {count} and a mark")
        return words[:count] + [""] * (count - len(words))
    line = line.expandtabs(SMALL)
    wide = LARGE if "*" in line[:SMALL] else SMALL
    count = 4 if wide == LARGE else 8
    body = line[SMALL:].ljust(count * wide)
    return [line[:SMALL].strip(), *(body[i * wide : (i + 1) * wide].strip() for i in range(count))]


def _take(found: dict[str, Entries], number: int, fields: list[str]) -> None:
    """Adds one entry, a header or a column, to found."""
    name, body = fields[1], fields[2:]
    if (body[0] == "0") == (name in found):
        what = "two headers" if name in found else "no header before its columns"
        raise UnreadableError(f"line {number}: DMIG {name} has {what}")
    if name not in found:
        form, kind = (_whole(one, number) for one in (body[1], body[2]))
        if form not in (SYMMETRIC, SQUARE):
            raise UnreadableError(f"line {number}: DMIG {name} is of form {form}; 6 (symmetric) or 1 is read")
        if kind not in REAL:
            raise UnreadableError(
                f"line {number}: DMIG {name} is complex (type {kind}), and real ones are read; "
                "hysteretic damping is structure.damping = { loss_factor = }"
            )
        found[name] = Entries(form)
        return
    entries, column = found[name], (_whole(body[0], number), _whole(body[1] or "0", number))
    _blank(body[2], number, f"DMIG {name}: behind the column")
    _components(column, number)
    rest = body[3:]  # a blank field follows the column
    for start in range(0, len(rest), 4):
        group = rest[start : start + 3]
        if not any(group):
            continue
        if len(group) < 3 or not group[0] or not group[2]:
            raise UnreadableError(f"line {number}: DMIG {name} has a row without a point, or without a value")
        _blank("".join(rest[start + 3 : start + 4]), number, f"DMIG {name} is real: behind a value")
        value = nastran_real(group[2], number)
        entries.line.append(number)
        row = _whole(group[0], number), _whole(group[1] or "0", number)
        _components(row, number)
        entries.places.append((*row, *column))
        entries.value.append(value)


def _blank(word: str, number: int, where: str) -> None:
    """Raises UnreadableError if a field that is not read is not blank."""
    if word:
        raise UnreadableError(f'line {number}: {where} the field must be blank, but holds "{word}"')


def _components(place: tuple[int, int], number: int) -> None:
    """Raises UnreadableError for an invalid point or component."""
    if place[0] < 1 or not 0 <= place[1] <= len(DIRECTIONS):
        what = f"point {place[0]}, component {place[1]}"
        raise UnreadableError(f"line {number}: there is no {what}: points are from 1, components 0 to 6")


def nastran_real(word: str, line: int) -> float:
    """A real number of Nastran, which may omit the letter of the exponent: 1.0+5.

    >>> nastran_real("1.5+3", 1), nastran_real("-2.D-1", 1), nastran_real("1.5E3", 1)
    (1500.0, -0.2, 1500.0)
    """
    return real_of(re.sub(r"(?<=[\d.])([+-])", r"E\1", word), line)


def _whole(word: str, number: int) -> int:
    if not re.fullmatch(r"[+-]?\d{1,18}", word, re.ASCII):
        raise UnreadableError(f'line {number}: "{word}" must be a whole number')
    return int(word)


def _labelled(name: str, entries: Entries) -> Labelled:
    places = np.array(entries.places, dtype=np.int64)
    node, direction = places[:, 0::2], places[:, 1::2]
    line, value = np.array(entries.line, dtype=np.int64), np.array(entries.value)
    try:
        return labelled_from(node, direction, line, value, mirrored=entries.form == SYMMETRIC)
    except ValueError as error:
        raise UnreadableError(f"DMIG {name}, {error}") from None
