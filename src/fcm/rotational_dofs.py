"""Degrees of freedom that are rotations, the unit of each, and which are told first."""

from __future__ import annotations

import re
from collections.abc import Sequence

MOST_DOFS = 4  # degrees of freedom whose peaks fit beside each other on a line of a table
_ROTATION = re.compile(r"(\d+|.+[: _])[: _]?(r[xyz]|rot[xyz]?|th[xyz]?|theta[xyz]?)|\d+:[456]", re.IGNORECASE)


def is_rotation(dof: str) -> bool:
    """Whether a degree of freedom is that of a node about an axis, by its name.

    >>> [is_rotation(dof) for dof in ("40rz", "40:6", "21th", "tip_rz", "40z", "tip")]
    [True, True, True, True, False, False]
    """
    return _ROTATION.fullmatch(dof) is not None


def dof_unit(dof: str, length: str) -> str:
    """The unit of a displacement where lengths have one: a rotation is in radians.

    >>> dof_unit("40z", "mm"), dof_unit("40rz", "mm"), dof_unit("40rz", "")
    ('mm', 'rad', '')
    """
    return "rad" if length and is_rotation(dof) else length


def greatest_first(dofs: Sequence[str], heights: Sequence[float]) -> list[int]:
    """The places of degrees of freedom from the greatest height down: all displacements, then all rotations.

    >>> greatest_first(["1x", "1rx", "2x"], [1.0, 9.0, 7.0])
    [2, 0, 1]
    """
    return sorted(range(len(dofs)), key=lambda d: (is_rotation(dofs[d]), -heights[d]))
