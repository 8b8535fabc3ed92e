"""Normal modes from a universal file (.uff, .unv): its datasets 55, "data at nodes".

Each dataset holds one mode: five lines of text, definition (6I10), integers (8I10), reals (6E13.5: frequency
[Hz], modal mass, viscous and hysteretic damping), then for each node its number (I10) and values (6E13.5).
Source: SDRC I-DEAS Test Data Universal File Format, dataset 55, as published by the University of Cincinnati.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from math import ceil, pi
from pathlib import Path
from typing import Any

import numpy as np

DIRECTIONS = {1: ("",), 3: ("x", "y", "z"), 6: ("x", "y", "z", "rx", "ry", "rz")}  # by values per node
NORMAL_MODE, REAL = 2, 2
PER_LINE = 6  # reals on a line


@dataclass(frozen=True)
class _Mode:
    hertz: float
    mass: float
    damping: float
    values: dict[str, float]  # at each degree of freedom


def read_uff(path: Path) -> dict[str, Any]:
    """Dofs such as "12x" (node 12, direction x) and the modes' arrays; frequencies are angular.

    A modal mass or a damping that is zero in every mode was not given, and is left out.
    """
    blocks = [block for block in _datasets(path) if _is_normal_mode(block)]
    if not blocks:
        raise ValueError("it has no normal mode (dataset 55, analysis type 2, real)")
    modes = [_intact(block, number) for number, block in enumerate(blocks, 1)]
    dofs = list(dict.fromkeys(dof for mode in modes for dof in mode.values))
    found: dict[str, Any] = {
        "dofs": dofs,
        "angular_frequency": 2 * pi * np.array([mode.hertz for mode in modes]),
        "shapes": np.array([[mode.values.get(dof, 0.0) for dof in dofs] for mode in modes]),
    }
    given = {"mass": [mode.mass for mode in modes], "damping": [mode.damping for mode in modes]}
    return found | {key: np.array(values) for key, values in given.items() if any(values)}


def _datasets(path: Path) -> Iterator[list[str]]:
    """The lines of each dataset 55, between its marks -1, without its number."""
    block: list[str] | None = None
    for line in path.read_text("latin-1").split("\n"):
        if line.strip() != "-1":
            if block is not None:
                block.append(line.rstrip("\r"))
            continue
        if block is not None and block[:1] and block[0].strip() == "55":
            yield block[1:]
        block = [] if block is None else None


def _is_normal_mode(block: Sequence[str]) -> bool:
    definition = _integers(block[5]) if len(block) > 7 else []
    return len(definition) == 6 and definition[1] == NORMAL_MODE and definition[4] == REAL


def _intact(block: Sequence[str], number: int) -> _Mode:
    try:
        return _mode(block)
    except (IndexError, ValueError) as error:
        raise ValueError(f"its normal mode {number} is damaged: {error}") from None


def _mode(block: Sequence[str]) -> _Mode:
    per_node = _integers(block[5])[5]
    if per_node not in DIRECTIONS:
        raise ValueError(f"it has {per_node} values at a node; those read are 1, 3 and 6")
    counts = _integers(block[6])
    start = 7 + ceil(counts[1] / PER_LINE)
    reals = _reals(block[7:start])
    hertz, mass, viscous, hysteretic = (*reals, 0.0, 0.0, 0.0)[:4]
    return _Mode(hertz, mass, viscous + hysteretic / 2, _values(block[start:], per_node))


def _values(lines: Sequence[str], per_node: int) -> dict[str, float]:
    """The mode's value at each degree of freedom."""
    values: dict[str, float] = {}
    size = 1 + ceil(per_node / PER_LINE)
    filled = [line for line in lines if line.strip()]
    for start in range(0, len(filled), size):
        node = _integers(filled[start])[0]
        numbers = _reals(filled[start + 1 : start + size])
        names = (f"{node}{direction}" for direction in DIRECTIONS[per_node])
        values |= zip(names, numbers, strict=True)
    return values


def _integers(line: str) -> list[int]:
    return [int(field) for field in _fields(line, 10)]


def _reals(lines: Sequence[str]) -> list[float]:
    """Numbers of 13 columns; a FORTRAN exponent may be a D."""
    return [float(field.upper().replace("D", "E")) for line in lines for field in _fields(line, 13)]


def _fields(line: str, width: int) -> list[str]:
    fields = (line[start : start + width].strip() for start in range(0, len(line), width))
    return [field for field in fields if field]
