"""The natural frequencies of a ring of sectors by nodal diameter, its contacts open and stuck."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fcm.model.scene import FloatArray, Scene
from fcm.structure.linear import with_springs


@dataclass(frozen=True)
class Diameter:
    """Natural frequencies [rad/s] in ascending order, (mode,) each."""

    number: int
    opened: FloatArray  # without the contacts
    stuck: FloatArray  # with k_u, k_v of every contact; k_v alone where there is no friction


def nodal_diameters(scene: Scene) -> list[Diameter]:
    """Those that have modes, from 0 to half of the sectors.

    >>> import fcm
    >>> disk = nodal_diameters(fcm.load_scene("bladed-disk"))
    >>> [round(float(one.opened[0] / 2 / np.pi), 4) for one in disk[:3]]
    [88.2637, 169.3441, 189.3019]
    """
    ring = scene.ring
    assert ring is not None
    rows = scene.directions_of_contacts()
    directions = np.array(rows).reshape(len(rows), len(scene.modal.dofs)).T
    along = scene.directions_of_contact - 1
    each = [(*[one.k_u if one.mu > 0.0 else 0.0] * along, one.k_v) for one in scene.contacts]
    springs = np.array(each).ravel()
    found = []
    for number in sorted(set(ring.diameter.tolist())):
        which = ring.diameter == number
        natural, own = ring.frequency[which], int((~ring.added[which]).sum())
        stuck = with_springs(natural, ring.shapes[which] @ directions, springs)
        found.append(Diameter(number, np.sort(natural[~ring.added[which]]), stuck[:own]))
    return found
