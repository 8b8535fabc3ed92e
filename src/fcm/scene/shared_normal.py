"""What is said of several contacts that press along the same normal: preload and normal stiffness add up."""

from __future__ import annotations

import numpy as np

from fcm.model.scene import Contact, FloatArray, Scene
from fcm.scene.errors import counted, quoted

SAME = 1e-9  # relative: directions that differ by no more are one
MOST_NAMED = 3  # groups of contacts in the sentence


def note_of_shared_normals(scene: Scene) -> list[str]:
    """One sentence on contacts with the same normal displacement and different tangential ones.

    Up to sign and scale: each then carries its whole preload and normal stiffness, and the place all of them
    together. Nothing is said where at most one of them has a preload or a normal stiffness, nor where the
    tangential displacements are the same, as of several layers.
    """
    groups: dict[bytes, list[Contact]] = {}
    for contact in scene.contacts:
        if contact.normal.any():
            groups.setdefault(_line(contact.normal), []).append(contact)
    doubled = [group for group in groups.values() if _counts_twice(group)]
    if not doubled:
        return []
    names = "; ".join(" and ".join(quoted(one.name) for one in group[:3]) for group in doubled[:MOST_NAMED])
    more = f"; {counted(len(doubled), 'such place')} in all" if len(doubled) > MOST_NAMED else ""
    return [
        f"contacts {names} have the same normal displacement and different tangential ones{more}: their "
        "preloads and normal stiffnesses add up there, as those of several contacts side by side. If it is "
        "one contact that slides in a plane, write it once with two directions, as in "
        'tangential = ["x", "y"]'
    ]


def _counts_twice(group: list[Contact]) -> bool:
    """Whether several contacts of one normal carry a load, in different directions of friction."""
    carrying = [one for one in group if one.n_0 != 0.0 or one.k_v != 0.0]
    return len({tuple(map(_line, one.directions[:-1])) for one in carrying if one.mu > 0.0}) > 1


def _line(direction: FloatArray) -> bytes:
    """The same of directions that are equal up to sign and scale."""
    largest = direction[int(np.abs(direction).argmax())]
    return (np.round(direction / largest / SAME) * SAME + 0.0).tobytes() if largest else b""
