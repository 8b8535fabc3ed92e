"""Names of the directions of contacts that slide in a plane, and positions of contacts, in a scene."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from fcm.model.scene import FloatArray, Scene

SHOWN = 6  # digits of a weight


def directions_of(scene: Scene) -> dict[str, tuple[str, ...]]:
    """Names, in the scene, of the directions of each contact in a plane.

    >>> import fcm
    >>> directions_of(fcm.load_scene("yang1998"))
    {}
    """
    names = scene.modal.dofs
    return {
        one.name: tuple(_combination(along, names) for along in one.directions)
        for one in scene.contacts
        if one.second is not None
    }


def positions_of(scene: Scene) -> dict[str, FloatArray]:
    """Midpoint (3,) between the nodes of each contact whose nodes have known positions.

    >>> import fcm
    >>> positions_of(fcm.load_scene("yang1998"))
    {}
    """
    return {
        f"{one.name}_{i + 1}": 0.5 * (first + second)
        for one in scene.interfaces
        for i, (first, second) in enumerate(zip(one.first, one.second, strict=True))
    }


def _combination(direction: FloatArray, names: Sequence[str]) -> str:
    """A direction as text, such as "ax - bx" or "0.6 ax + 0.8 ay"."""
    text = ""
    for i in np.flatnonzero(direction).tolist():
        weight = float(direction[i])
        sign = "-" if weight < 0.0 else "+"
        size = "" if abs(weight) == 1.0 else f"{abs(weight):.{SHOWN}g} "
        text += f" {sign} {size}{names[i]}" if text else f"{'-' if weight < 0.0 else ''}{size}{names[i]}"
    return text
