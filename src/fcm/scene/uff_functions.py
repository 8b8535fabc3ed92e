"""Reads measured functions over frequency from dataset 58 of a universal file.

The sixth line has the type of function (4 frequency response function, 12 spectrum), and name, node and
direction of response and reference. The seventh has the type of the values (2 and 4 real, 5 and 6 complex, of
single and double precision), their number, and whether the frequencies are evenly spaced. The next three have
the type of abscissa, ordinate and denominator (18 frequency, 8 displacement, 13 force), and their units. Text
values are in columns of 13 or 20 (Fortran's E13.5 and E20.12), with as many points as fit into 80 columns.
Source: SDRC I-DEAS Test Data Universal File Format, dataset 58, as published by the University of Cincinnati.
"""

from __future__ import annotations

from pathlib import Path
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from fcm.frozen import Frozen
from fcm.model.scene import FloatArray
from fcm.scene.errors import counted, quoted
from fcm.scene.files import DataFileError
from fcm.scene.measured_units import hertz_of
from fcm.scene.names import DIRECTIONS, motion_of
from fcm.scene.number_text import fault_of_number, number_in
from fcm.scene.uff_datasets import Dataset, read_datasets, system_of
from fcm.scene.uff_qualifiers import Qualifiers, qualifiers_of

ComplexArray = npt.NDArray[np.complex128]
HEAD = 11  # number of lines before the values
FUNCTION, FORM, ABSCISSA, ORDINATE, DENOMINATOR = 5, 6, 7, 8, 9  # lines with these data, from 0
RESPONSE, SPECTRUM = 4, 12
KINDS = {
    RESPONSE: "a frequency response function", SPECTRUM: "a spectrum", 1: "a time response",
    2: "an auto spectrum", 3: "a cross spectrum", 6: "a coherence",
}  # fmt: skip
AXES = {
    2: "stress", 3: "strain", 5: "temperature", 6: "heat flux", 8: "displacement", 9: "reaction force",
    11: "velocity", 12: "acceleration", 13: "force", 15: "pressure", 16: "mass", 17: "time",
    18: "frequency", 19: "rpm", 20: "order", 21: "sound pressure", 22: "sound intensity", 23: "sound power",
}  # fmt: skip
FREQUENCIES = ("", "frequency", "rpm")
SINGLE, COMPLEX, TYPES = (2, 5), (5, 6), (2, 4, 5, 6)
WIDTH_SINGLE, WIDTH_DOUBLE = 13, 20  # columns of a value; an abscissa always has the first width
LINE = 80  # columns of a line
ENTITIES = ((31, 41, 51, 55), (56, 66, 76, 80))  # columns of name, node and direction on the sixth line
UNITS_AT = 46  # columns before the unit of an axis: type, three exponents, label of the axis


class Location(NamedTuple):
    """The place of a response or its reference: a name, a node, and a direction with its sign."""

    entity: str = ""
    node: int = 0
    direction: int = 0

    @property
    def dof(self) -> str:
        """Node and direction as the name of a degree of freedom; empty if they are not given."""
        known = self.node > 0 and 1 <= abs(self.direction) <= len(DIRECTIONS)
        return f"{self.node}{DIRECTIONS[abs(self.direction) - 1]}" if known else ""

    @property
    def sign(self) -> float:
        """-1 for a direction against the axis, else 1."""
        return -1.0 if self.direction < 0 else 1.0

    def may_be(self, name: str) -> bool:
        """Whether this can be the degree of freedom with a name, by node and direction, or by the name."""
        return bool(name) and (self.dof == motion_of(name) if motion_of(name) else self.entity == name)


class Axis(NamedTuple):
    """The quantity of the values along an axis, and their unit; empty if the file does not state them."""

    what: str = ""
    unit: str = ""


class Function(Frozen):
    """A response over frequency, and what its file states about it."""

    hertz: FloatArray
    value: ComplexArray  # along the positive axes
    phased: bool
    per_reference: bool  # whether values are per unit of the reference
    response: Location
    reference: Location
    ordinate: Axis
    denominator: Axis
    system: tuple[float, float] | None  # unit of length [m] and of force [N] of the whole file
    unknown_unit: str = ""  # unknown unit of the frequencies, which are then taken as Hz
    qualifiers: Qualifiers | None = None  # None if the file has no dataset 1858
    of_table: bool = False  # whether it comes from columns, not from a universal file


def read_function(path: Path, dof: str = "", forced: str = "") -> Function:
    """The response over frequency in a file; of several, the one at a degree of freedom.

    dof, forced : degrees of freedom of the measurement and of the force; empty if unknown.

    Raises
    ------
    DataFileError
        If the file has no response over frequency, or several, or values that are not numbers.
    """
    every = read_datasets(path)
    functions = [one for one in every if one.kind in ("58", "58b")]
    said = [(one, _kind(one)) for one in functions]
    chosen = [one for one, kind in said if kind in (RESPONSE, SPECTRUM)]
    for at, name in ((0, dof), (1, forced)):
        if len(chosen) > 1:
            chosen = [one for one in chosen if _places(one)[at].may_be(name)] or chosen
    if len(chosen) != 1:
        others = ", ".join(dict.fromkeys(KINDS.get(kind, f"function {kind}") for _, kind in said)) or "none"
        held = ", ".join(dict.fromkeys(f"dataset {one.kind}" for one in every)) or "no dataset"
        what = f"has {counted(len(chosen), 'response')} over the frequency among its functions ({others})"
        which = f" at {dof}" if dof and len(chosen) > 1 else ""
        raise DataFileError(f"{quoted(path.name)} {what}; one{which} is right. The file holds {held}")
    return _function(chosen[0], path, system_of(every), qualifiers_of(every, chosen[0], path))


def _function(
    one: Dataset, path: Path, system: tuple[float, float] | None, qualifiers: Qualifiers | None
) -> Function:
    abscissa, ordinate, denominator = (_axis(one, line) for line in (ABSCISSA, ORDINATE, DENOMINATOR))
    if abscissa.what not in FREQUENCIES:
        where = f"{quoted(path.name)}, line {one.first + ABSCISSA}"
        raise DataFileError(f"{where}: its values are over the {abscissa.what}, not over the frequency")
    frequency, value, phased = _values(one, path)
    unit = hertz_of(abscissa.unit or ("rpm" if abscissa.what == "rpm" else "Hz"))
    response, reference = _places(one)
    per_reference = _kind(one) == RESPONSE
    return Function(
        hertz=(unit or 1.0) * frequency,
        value=response.sign * (reference.sign if per_reference else 1.0) * value,
        phased=phased,
        per_reference=per_reference,
        response=response,
        reference=reference,
        ordinate=ordinate,
        denominator=denominator,
        system=system,
        unknown_unit="" if unit else abscissa.unit,
        qualifiers=qualifiers,
    )


def _kind(one: Dataset) -> int:
    found = one.integers(FUNCTION) or [
        int(word) for word in _line(one, FUNCTION).split()[:1] if word.isdecimal()
    ]
    return found[0] if found else -1


def _line(one: Dataset, at: int) -> str:
    return one.lines[at] if at < len(one.lines) else ""


def _places(one: Dataset) -> tuple[Location, Location]:
    """Places of response and reference, by words; or by columns if a name has a space or touches its node."""
    text = _line(one, FUNCTION)
    words = text.split()
    parts = [words[4:7], words[7:10]] if len(words) == 10 else []
    if not all(_whole(word) is not None for part in parts for word in part[1:]):
        parts = []
    parts = parts or [[text[a:b], text[b:c], text[c:d]] for a, b, c, d in ENTITIES]
    first, second = (
        Location(_said(entity), _whole(node) or 0, _whole(direction) or 0)
        for entity, node, direction in parts
    )
    return first, second


def _whole(word: str) -> int | None:
    digits = word.strip().removeprefix("-").removeprefix("+")
    return int(word) if digits.isdecimal() and len(digits) <= 10 else None


def _said(text: str) -> str:
    """A label; empty if it is NONE or another word for nothing."""
    word = text.strip()
    return "" if word.upper() in ("NONE", "-", "UNKNOWN") else word


def _axis(one: Dataset, line: int) -> Axis:
    """Quantity and unit of an axis; its label has twenty columns and may have spaces."""
    text = _line(one, line)
    words = text.split()
    kind = _whole(words[0]) if words else None
    unit = text[UNITS_AT:] if len(text) > UNITS_AT else (words[5] if len(words) == 6 else "")
    return Axis(AXES.get(kind or 0, ""), _said(_decoded(unit[:21])))


def _decoded(text: str) -> str:
    """A text that was read as Latin-1, decoded as UTF-8 if possible, for units such as m/s²."""
    try:
        return text.encode("latin-1").decode("utf-8")
    except UnicodeError:
        return text


def _values(one: Dataset, path: Path) -> tuple[FloatArray, ComplexArray, bool]:
    """Abscissae, values, and whether the values are complex in the file."""
    words = _line(one, FORM).split()
    where = f"{quoted(path.name)}, line {one.first + FORM}"
    numbers = [number_in(word) for word in words[:5]]
    if len(numbers) < 5 or any(number is None for number in numbers):
        raise DataFileError(
            f"{where}: must be type, count, spacing, first, step; is {quoted(_line(one, FORM), 60)}"
        )
    kind, count, even = (int(number or 0) for number in numbers[:3])
    first, step = (float(number or 0.0) for number in numbers[3:5])
    if kind not in TYPES:
        raise DataFileError(f"{where}: its values are of type {kind}; known are 2 and 4 (real), 5 and 6")
    flat = _binary(one, kind, even) if one.kind == "58b" else _text(one, kind, even, path)
    each = (2 if kind in COMPLEX else 1) + (0 if even else 1)
    if flat.size != count * each:
        raise DataFileError(f"{where}: says {count} values, and {flat.size / each:g} follow")
    table = flat.reshape(count, each)
    abscissa = np.asarray(first + step * np.arange(count) if even else table[:, 0], dtype=np.float64)
    if kind in COMPLEX:
        return abscissa, table[:, -2] + 1j * table[:, -1], True
    if (table[:, -1] < 0.0).any():
        raise DataFileError(
            f"{where}: its values are real, and some are negative: export amplitudes, or complex values"
        )
    return abscissa, table[:, -1].astype(np.complex128), False


def _text(one: Dataset, kind: int, even: int, path: Path) -> FloatArray:
    """The numbers in text, which may touch one another in their columns."""
    width = WIDTH_SINGLE if kind in SINGLE else WIDTH_DOUBLE
    point = [*([] if even else [WIDTH_SINGLE]), *[width] * (2 if kind in COMPLEX else 1)]
    widths = point * (LINE // sum(point))
    found = []
    for number, line in enumerate(one.lines[HEAD:], one.first + HEAD):
        at, words = 0, []
        for columns in widths:
            if word := line[at : at + columns].strip():
                words.append(word)
            at += columns
        beyond = bool(line[at:].strip())
        if beyond or len(line.split()) == len(words) or any(number_in(word) is None for word in words):
            words = line.split()
        values = [number_in(word) for word in words]
        for word, value in zip(words, values, strict=True):
            if value is None:
                raise DataFileError(f"{quoted(path.name)}, line {number}: {fault_of_number(word)}")
        found += values
    return np.array(found, dtype=np.float64)


def _binary(one: Dataset, kind: int, even: int) -> FloatArray:
    """The numbers in the bytes, which are little-endian unless the file says otherwise."""
    order = ">" if one.big_endian else "<"
    real = np.dtype(f"{order}f{4 if kind in SINGLE else 8}")
    row = np.dtype([*([] if even else [("x", real)]), ("y", real, 2 if kind in COMPLEX else 1)])
    rows = np.frombuffer(one.payload[: len(one.payload) // row.itemsize * row.itemsize], row)
    parts = [rows[name].reshape(rows.size, -1) for name in row.names or ()]
    return np.hstack(parts).astype(np.float64).ravel()
