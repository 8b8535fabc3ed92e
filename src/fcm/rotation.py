"""Degrees of freedom that are rotations, and the unit of each."""

from __future__ import annotations

import re

_ROTATION = re.compile(r"\d+[: _]?r[xyz]|\d+:[456]", re.IGNORECASE)


def is_rotation(dof: str) -> bool:
    """Whether a degree of freedom is that of a node about an axis, by its name.

    >>> [is_rotation(dof) for dof in ("40rz", "40:6", "40z", "tip")]
    [True, True, False, False]
    """
    return _ROTATION.fullmatch(dof) is not None


def unit_of(dof: str, length: str) -> str:
    """The unit of a displacement where lengths have one: a rotation is in radians.

    >>> unit_of("40z", "mm"), unit_of("40rz", "mm"), unit_of("40rz", "")
    ('mm', 'rad', '')
    """
    return "rad" if length and is_rotation(dof) else length
