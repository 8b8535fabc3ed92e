"""Rotational degrees of freedom: recognises them by name, with units and the order for reports."""

from __future__ import annotations

import re
from collections.abc import Sequence

MOST_DOFS = 4  # number of degrees of freedom whose peaks fit on one line of a table
_ROTATION = re.compile(r"(\d+|.+[: _])[: _]?(r[xyz]|rot[xyz]?|th[xyz]?|theta[xyz]?)|\d+:[456]", re.IGNORECASE)


def is_rotation(dof: str) -> bool:
    """Whether a degree of freedom is a rotation of a node, by its name.

    >>> [is_rotation(dof) for dof in ("40rz", "40:6", "21th", "tip_rz", "40z", "tip")]
    [True, True, True, True, False, False]
    """
    return _ROTATION.fullmatch(dof) is not None


def dof_unit(dof: str, length: str) -> str:
    """The unit of a displacement: that of length, or rad for a rotation; empty if length has none.

    >>> dof_unit("40z", "mm"), dof_unit("40rz", "mm"), dof_unit("40rz", "")
    ('mm', 'rad', '')
    """
    return "rad" if length and is_rotation(dof) else length


def greatest_first(dofs: Sequence[str], heights: Sequence[float]) -> list[int]:
    """The indices of degrees of freedom by descending height: first all displacements, then all rotations.

    >>> greatest_first(["1x", "1rx", "2x"], [1.0, 9.0, 7.0])
    [2, 0, 1]
    """
    return sorted(range(len(dofs)), key=lambda d: (is_rotation(dofs[d]), -heights[d]))
