"""Normal modes from a universal file (.uff, .unv): its datasets 55 and 2414, data at nodes.

Each dataset holds one mode: lines of text, the definition (6I10), integers, reals, then for each node its
number and values. Where they stand is all that the two differ in.
Source: SDRC I-DEAS Test Data Universal File Format, datasets 55 and 2414, as published by the University of
Cincinnati.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import combinations
from math import ceil, pi
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from fcm.scene.errors import choices, quoted
from fcm.scene.files import DataFileError
from fcm.scene.uff_contents import contents, units

DIRECTIONS = {1: ("",), 3: ("x", "y", "z"), 6: ("x", "y", "z", "rx", "ry", "rz")}  # by values per node
NORMAL_MODE, AT_NODES = 2, 1
MOTIONS = (8, 11, 12)  # displacement, velocity, acceleration: each is a mode's shape
REAL, COMPLEX = (2, 4), (5, 6)  # data types: of single and of double precision
PER_LINE = 6  # reals on a line
SAME = 1e-6  # relative difference of what two datasets write of one mode
COLLINEAR = 1e-4  # of a shape: what may be left when it is turned to be real
_NUMBER = re.compile(r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[EeDd][-+]?\d+)?")


class _Layout(NamedTuple):
    """Lines of a dataset, counted from 0."""

    definition: int
    reals: int | None  # where they begin; None after as many lines as the integers take
    nodes: int  # where the nodes begin, if the reals have their place
    frequency: int  # among the reals; then modal mass, viscous and hysteretic damping at these places
    rest: tuple[int, int, int]


_LAYOUTS = {"55": _Layout(5, None, 0, 0, (1, 2, 3)), "2414": _Layout(8, 11, 13, 1, (3, 4, 5))}


@dataclass(frozen=True)
class _Mode:
    hertz: float
    mass: float
    damping: float
    values: dict[str, complex]  # at each degree of freedom


def read_uff(path: Path) -> dict[str, Any]:
    """Dofs such as "12x" (node 12, direction x) and the modes' arrays; frequencies are angular.

    A modal mass or a damping that is zero in every mode was not given, and is left out.
    """
    datasets = list(_datasets(path))
    blocks = [(kind, block) for kind, block in datasets if _is_normal_mode(kind, block)]
    if not blocks:
        raise ValueError(f"it has no normal mode; {contents(datasets)}")
    faults: list[str] = []
    modes = [_intact(kind, block, number, faults) for number, (kind, block) in enumerate(blocks, 1)]
    dofs = list(dict.fromkeys(dof for mode in modes for dof in mode.values))
    found: dict[str, Any] = {
        "dofs": dofs,
        "angular_frequency": 2 * pi * np.array([mode.hertz for mode in modes]),
        "shapes": np.array([_real(mode, dofs, number, faults) for number, mode in enumerate(modes, 1)]),
        "notes": units(datasets),
    }
    if not faults:
        faults = _twice(found["angular_frequency"], found["shapes"])
        found["notes"] += _unlike(modes, dofs, path.name)
    if faults:
        raise DataFileError(*(f"{quoted(path.name)} cannot be read: {fault}" for fault in faults))
    given = {"mass": [mode.mass for mode in modes], "damping": [mode.damping for mode in modes]}
    return found | {key: np.array(values) for key, values in given.items() if any(values)}


def _datasets(path: Path) -> Iterator[tuple[str, list[str]]]:
    """The number and the lines of each dataset, between its marks -1; ValueError if the last has no end."""
    block: list[str] | None = None
    for line in path.read_text("latin-1").split("\n"):
        if line.strip() != "-1":
            if block is not None:
                block.append(line.rstrip("\r"))
            continue
        if block:
            yield block[0].strip(), block[1:]
        block = [] if block is None else None
    if block and any(line.strip() for line in block):
        raise ValueError(f"it is cut off within a dataset {quoted(block[0].strip(), 6)}, without a -1 behind")


def _is_normal_mode(kind: str, block: Sequence[str]) -> bool:
    """Whether a dataset is a normal mode: real, or complex by its numbers only."""
    layout = _LAYOUTS.get(kind)
    if layout is None or len(block) <= layout.definition + 2:
        return False
    if kind == "2414" and _integers(block[2])[:1] != [AT_NODES]:
        return False
    definition = _integers(block[layout.definition])
    if len(definition) != 6:
        return False
    _, analysis, _, result, data, _ = definition
    return analysis == NORMAL_MODE and result in MOTIONS and data in REAL + COMPLEX


def _intact(kind: str, block: Sequence[str], number: int, faults: list[str]) -> _Mode:
    try:
        return _mode(_LAYOUTS[kind], block)
    except (IndexError, ValueError) as error:
        faults.append(f"its normal mode {number} is damaged: {error}")
        return _Mode(0.0, 0.0, 0.0, {})


def _mode(layout: _Layout, block: Sequence[str]) -> _Mode:
    *_, data, per_node = _integers(block[layout.definition])
    if per_node not in DIRECTIONS:
        raise ValueError(f"it has {per_node} values at a node; those read are 1, 3 and 6")
    if layout.reals is None:
        at = layout.definition + 1
        begin, nodes = at + 1, at + 1 + ceil(_integers(block[at])[1] / PER_LINE)
    else:
        begin, nodes = layout.reals, layout.nodes
    reals = [*_reals(block[begin:nodes]), *[0.0] * PER_LINE]
    mass, viscous, hysteretic = (reals[place] for place in layout.rest)
    values = _values(block[nodes:], per_node, data in COMPLEX)
    return _Mode(reals[layout.frequency], mass, viscous + hysteretic / 2, values)


def _values(lines: Sequence[str], per_node: int, pairs: bool) -> dict[str, complex]:
    """The mode's value at each degree of freedom."""
    values: dict[str, complex] = {}
    count = per_node * (2 if pairs else 1)
    filled = [line for line in lines if line.strip()]
    start = 0
    while start < len(filled):
        node = _integers(filled[start])[0]
        numbers: list[float] = []
        start += 1
        while len(numbers) < count and start < len(filled):
            numbers += _reals(filled[start : start + 1])
            start += 1
        parts = (
            zip(numbers[::2], numbers[1::2], strict=True) if pairs else ((value, 0.0) for value in numbers)
        )
        names = (f"{node}{direction}" for direction in DIRECTIONS[per_node])
        values |= zip(names, (complex(*part) for part in parts), strict=True)
    return values


def _real(mode: _Mode, dofs: list[str], number: int, faults: list[str]) -> list[float]:
    """The shape as real numbers; a complex one of which all values have one phase is turned to be real."""
    shape = np.array([mode.values.get(dof, 0.0) for dof in dofs])
    if shape.imag.any():
        turned = shape * np.exp(-0.5j * np.angle((shape * shape).sum()))
        if np.linalg.norm(turned.imag) > COLLINEAR * np.linalg.norm(turned):
            faults.append(f"its normal mode {number} is complex; a real one is needed")
        shape = turned
    return shape.real.tolist()  # type: ignore[no-any-return]


def _unlike(modes: list[_Mode], dofs: list[str], name: str) -> list[str]:
    """Which modes have no values where others have: they are taken not to move there."""
    said = []
    for number, mode in enumerate(modes, 1):
        lacking = [dof for dof in dofs if dof not in mode.values]
        if lacking:
            at = f"{choices(lacking, 3)}, where others have"
            said.append(f"modal: normal mode {number} of {name} has no value at {at}: taken as 0")
    return said


def _twice(frequency: npt.NDArray[np.float64], shapes: npt.NDArray[np.float64]) -> list[str]:
    """Which modes are there twice, as in a file that has them in datasets of both kinds."""
    said = []
    for one, other in combinations(range(frequency.size), 2):
        near = abs(frequency[one] - frequency[other]) <= SAME * frequency[other]
        if near and np.abs(shapes[one] - shapes[other]).max() <= SAME * np.abs(shapes[other]).max():
            said.append(f"its normal modes {one + 1} and {other + 1} are the same; leave one out")
    return said


def _integers(line: str) -> list[int]:
    fields = (line[start : start + 10].strip() for start in range(0, len(line), 10))
    return [int(field) for field in fields if field]


def _reals(lines: Sequence[str]) -> list[float]:
    """Numbers beside each other, with or without space between; a FORTRAN exponent may be a D."""
    found = []
    for line in lines:
        if _NUMBER.sub("", line).strip():
            raise ValueError(f"{line.strip()[:40]!r} is no line of numbers")
        found += [float(text.upper().replace("D", "E")) for text in _NUMBER.findall(line)]
    return found
