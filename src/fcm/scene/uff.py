"""Reads normal modes from a universal file (.uff, .unv): its datasets 55 and 2414, data at nodes.

Each dataset holds one mode: lines of text, the definition (6I10), integers, reals, then for each node its
number and values. The two kinds of dataset differ only in the positions of these.
Source: SDRC I-DEAS Test Data Universal File Format, datasets 55 and 2414, as published by the University of
Cincinnati.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterable, Iterator
from itertools import combinations
from math import ceil, pi
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from fcm.frozen import Frozen
from fcm.scene.errors import choices, counted, quoted
from fcm.scene.files import DataFileError
from fcm.scene.modal_units import FileUnits
from fcm.scene.number_text import NUMBER, fault_of_number, number_in
from fcm.scene.options import TOLERANCES
from fcm.scene.uff_datasets import Dataset, read_datasets, system_of

DIRECTIONS = {1: ("",), 3: ("x", "y", "z"), 6: ("x", "y", "z", "rx", "ry", "rz")}  # by values per node
NORMAL_MODE, AT_NODES = 2, 1
MOTIONS = (8, 11, 12)  # displacement, velocity, acceleration: each gives a mode shape
REAL, COMPLEX, DOUBLE = (2, 4), (5, 6), (4, 6)  # data types; the first two of single and double precision
PER_LINE = 6  # reals on a line
OF_DOUBLE = 3  # values at a node on a line, as some programs write double precision
PER_LINE_OF_INTEGERS = 8
_NUMBER = re.compile(NUMBER, re.ASCII)
_BESIDE = re.compile(rf"{NUMBER}(?:(?=[-+]){NUMBER})*", re.ASCII)  # numbers separated only by their signs


# Positions among the reals of the frequency, the modal mass, the viscous and the hysteretic damping.
_PLACES = {"55": (0, 1, 2, 3), "2414": (1, 3, 4, 5)}
_REALS_2414 = 12  # on two lines


class _Mode(Frozen):
    hertz: float
    mass: float
    damping: float
    values: dict[str, complex]  # at each degree of freedom


def read_uff(path: Path) -> dict[str, Any]:
    """Dofs such as "12x" (node 12, direction x) and the arrays of the modes; frequencies are angular.

    Modal masses or damping that are zero in every mode count as not given, and are left out. "units" are
    those of the file, if it states them.
    """
    datasets = read_datasets(path)
    of_modes = [one for one in datasets if _is_normal_mode(one)]
    if not of_modes:
        raise DataFileError(
            f"{quoted(path.name)} cannot be read: it has no normal mode; {contents(datasets)}. A mode is a "
            "dataset 55 or 2414 at nodes, of analysis type 2 (normal mode): export the mode shapes"
        )
    faults: list[str] = []
    modes = [_intact(one, number, faults) for number, one in enumerate(of_modes, 1)]
    dofs = list(dict.fromkeys(dof for mode in modes for dof in mode.values))
    found: dict[str, Any] = {
        "dofs": dofs,
        "angular_frequency": 2 * pi * np.array([mode.hertz for mode in modes]),
        "shapes": np.array([_real(mode, dofs, number, faults) for number, mode in enumerate(modes, 1)]),
        "notes": [],
    }
    if not faults:
        faults = _twice(found["angular_frequency"], found["shapes"])
        found["notes"] += _unlike(modes, dofs, path.name)
    if faults:
        raise DataFileError(*(f"{quoted(path.name)} cannot be read: {fault}" for fault in faults))
    if (own := FileUnits(_name_of_units(datasets), system_of(datasets))) != FileUnits("", None):
        found["units"] = own
    given = {"mass": [mode.mass for mode in modes], "damping": [mode.damping for mode in modes]}
    return found | {key: np.array(values) for key, values in given.items() if any(values)}


def _is_normal_mode(one: Dataset) -> bool:
    """Whether a dataset is a normal mode, with real or complex numbers."""
    if one.kind not in _PLACES or (one.kind == "2414" and not one.at_nodes()):
        return False
    definition = one.integers(one.definition())
    if len(definition) != 6:
        return False
    _, analysis, _, result, data, _ = definition
    return analysis == NORMAL_MODE and result in MOTIONS and data in REAL + COMPLEX


def _intact(one: Dataset, number: int, faults: list[str]) -> _Mode:
    try:
        return _mode(one)
    except _DamagedError as error:
        faults.append(f"its normal mode {number} is damaged: {error}")
        return _Mode(0.0, 0.0, 0.0, {})


class _DamagedError(ValueError):
    """Raised for a faulty mode; the message says what is wrong."""


class _Rows:
    """Reads the lines of a dataset that are not blank, one after the other."""

    def __init__(self, one: Dataset, begin: int) -> None:
        self.one = one
        self.left = [at for at in range(begin, len(one.lines)) if one.lines[at].strip()][::-1]

    def next(self, what: str) -> int:
        """Index of the next line."""
        if not self.left:
            raise _DamagedError(f"there is no line of {what}")
        return self.left.pop()

    def integers(self, what: str) -> list[int]:
        """The whole numbers of the next line."""
        at = self.next(what)
        if not (found := self.one.integers(at)):
            raise _DamagedError(f"{self._line(at)} is no line of whole numbers")
        return found

    def reals(self, count: int, what: str, fewer: int = PER_LINE) -> list[float]:
        """Reads `count` numbers; all lines but the last have six numbers, or all have `fewer`."""
        found: list[float] = []
        per_line = PER_LINE
        while len(found) < count and len(found) % per_line == 0:
            at = self.next(what)
            found += _reals(self.one.lines[at], self._line(at))
            per_line = fewer if len(found) == fewer else per_line
        if len(found) != count:
            of = f"{self._line(at)} has {counted(len(found), 'number')}"
            raise _DamagedError(f"{of}, and {what} {'is' if count == 1 else 'are'} {count}")
        return found

    def _line(self, at: int) -> str:
        return f"line {self.one.first + at}, {quoted(self.one.lines[at].strip(), 40)},"


def _mode(one: Dataset) -> _Mode:
    begin = one.definition()
    *_, data, per_node = one.integers(begin)
    if per_node not in DIRECTIONS:
        raise _DamagedError(f"it has {per_node} values at a node; those read are 1, 3 and 6")
    rows = _Rows(one, begin + 1)
    if one.kind == "55":
        integers, count = [*rows.integers("the mode's numbers"), 0, 0][:2]
        for _ in range(ceil((2 + integers) / PER_LINE_OF_INTEGERS) - 1):
            rows.integers("the mode's numbers")
    else:
        for _ in range(2):
            rows.integers("the mode's numbers")
        count = _REALS_2414
    reals = rows.reals(count, "the mode's frequency and damping")
    places = _PLACES[one.kind]
    if len(reals) <= places[0]:
        raise _DamagedError("it has no frequency")
    hertz, mass, viscous, hysteretic = ([*reals, *[0.0] * PER_LINE][place] for place in places)
    return _Mode(
        hertz, mass, viscous + hysteretic / 2, _values(rows, per_node, data in COMPLEX, data in DOUBLE)
    )


def _values(rows: _Rows, per_node: int, pairs: bool, double: bool) -> dict[str, complex]:
    """The value of the mode at each degree of freedom."""
    values: dict[str, complex] = {}
    while rows.left:
        node = rows.integers("nodes")[0]
        if f"{node}{DIRECTIONS[per_node][0]}" in values:
            raise _DamagedError(f"it has node {node} twice")
        numbers = rows.reals(
            per_node * (2 if pairs else 1), f"the values at node {node}", OF_DOUBLE if double else PER_LINE
        )
        parts = numbers[::2] if pairs else numbers
        imaginary = numbers[1::2] if pairs else [0.0] * per_node
        for direction, real, imag in zip(DIRECTIONS[per_node], parts, imaginary, strict=True):
            values[f"{node}{direction}"] = complex(real, imag)
    return values


def _real(mode: _Mode, dofs: list[str], number: int, faults: list[str]) -> list[float]:
    """The shape as real numbers; a complex shape with a common phase of all values is rotated to be real."""
    shape = np.array([mode.values.get(dof, 0.0) for dof in dofs])
    if shape.imag.any():
        turned = shape * np.exp(-0.5j * np.angle((shape * shape).sum()))
        if np.linalg.norm(turned.imag) > TOLERANCES.collinear * np.linalg.norm(turned):
            faults.append(f"its normal mode {number} is complex; a real one is needed")
        shape = turned
    return shape.real.tolist()  # type: ignore[no-any-return]


def _unlike(modes: list[_Mode], dofs: list[str], name: str) -> list[str]:
    """Notes on modes without values where others have them; these count as zero."""
    said = []
    for number, mode in enumerate(modes, 1):
        lacking = [dof for dof in dofs if dof not in mode.values]
        if lacking:
            at = f"{choices(lacking, 3)}, where others have"
            said.append(f"modal: normal mode {number} of {name} has no value at {at}: taken as 0")
    return said


def _twice(frequency: npt.NDArray[np.float64], shapes: npt.NDArray[np.float64]) -> list[str]:
    """Sentences on modes that occur twice, as in a file with datasets of both kinds."""
    said = []
    for one, other in combinations(range(frequency.size), 2):
        near = abs(frequency[one] - frequency[other]) <= TOLERANCES.same_mode * frequency[other]
        if (
            near
            and np.abs(shapes[one] - shapes[other]).max()
            <= TOLERANCES.same_mode * np.abs(shapes[other]).max()
        ):
            said.append(f"its normal modes {one + 1} and {other + 1} are the same; leave one out")
    return said


def _reals(line: str, where: str) -> Iterator[float]:
    """Yields numbers that are separated by blanks, or only by their signs."""
    for word in line.split():
        numbers = _NUMBER.findall(word) if _BESIDE.fullmatch(word) else [word]
        for text in numbers:
            value = number_in(text)
            if value is None:
                raise _DamagedError(f"{where} is no line of numbers: {fault_of_number(text)}")
            yield value


DATASETS = {
    "15": "nodes", "18": "coordinate systems", "55": "data at nodes", "56": "data at elements",
    "57": "data at nodes on elements", "58": "functions", "82": "trace lines", "151": "header",
    "164": "units", "781": "nodes", "1858": "qualifiers of functions", "2400": "model header",
    "2411": "nodes", "2412": "elements", "2414": "analysis data", "2420": "coordinate systems",
    "2467": "groups", "2477": "groups",
}  # fmt: skip
ANALYSES = {
    0: "of an unknown analysis", 1: "static", 2: "normal modes", 3: "complex modes", 4: "transient",
    5: "frequency responses", 6: "buckling", 7: "complex modes", 9: "static, non-linear",
}  # fmt: skip
RESULTS = {2: "stress", 3: "strain", 5: "temperature", 8: "displacement", 9: "reaction force"}
FUNCTIONS = {
    0: "functions", 1: "time responses", 2: "auto spectra", 3: "cross spectra",
    4: "frequency response functions", 5: "transmissibilities", 6: "coherences", 9: "power spectra",
}  # fmt: skip


def contents(datasets: Iterable[Dataset]) -> str:
    """Sentence on the datasets of a file, with the number of each kind.

    >>> contents([Dataset("151", (), 3), Dataset("15", (), 6), Dataset("15", (), 9)])
    'it holds 151 ×1: header; 15 ×2: nodes'
    """
    counts = Counter((one.kind[:6], _what(one)) for one in datasets)
    if not counts:
        return "it holds no dataset at all"
    return "it holds " + "; ".join(f"{kind} ×{count}: {what}" for (kind, what), count in counts.items())


def _name_of_units(datasets: Iterable[Dataset]) -> str:
    """The name of the units of a file; empty if it has none."""
    names = (one.lines[0][10:30].strip() for one in datasets if one.kind == "164" and one.lines)
    return next((name for name in names if name and name.isprintable()), "")


def _what(one: Dataset) -> str:
    """Describes one dataset in words."""
    number = one.kind.rstrip("b")[:6].strip()
    if number == "58":
        return FUNCTIONS.get(_first(one, 5), "functions")
    if number not in ("55", "2414") or one.kind.endswith("b"):
        return DATASETS.get(number, "of another kind")
    definition = [*one.integers(one.definition()), -1, -1, -1, -1]
    analysis = ANALYSES.get(definition[1], "of another analysis")
    result = RESULTS.get(definition[3], "values")
    where = "" if number == "55" or one.at_nodes() else ", not at nodes"
    return f"{analysis}, {result}{where}"


def _first(one: Dataset, line: int) -> int:
    """The whole number at the beginning of a line; -1 if there is none."""
    word = (one.lines[line].split() if len(one.lines) > line else [])[:1]
    return int(word[0]) if word and re.fullmatch(r"\d{1,9}", word[0], re.ASCII) else -1
