"""Frequencies at which a response may have a peak that no point away from it tells of.

A mode that hardly anything damps answers to a harmonic h of the forces within damping omega / h. A step may
lead across, where the mode moves too little away from there to be seen. Where that is depends on what the
contacts do; they do least to a mode whose peak is narrow, and what they do is bounded by all stuck, all open.
"""

from __future__ import annotations

import numpy as np

from fcm.harmonic.system import System
from fcm.structure.ring import RingLinear

MOST = 200  # places; of more the widest, and so those of the lowest harmonics, as each costs a point


def narrow(system: System) -> list[tuple[float, float]]:
    """Frequencies within the range, with the width of the peak, both [rad/s]."""
    linear, (low, high) = system.linear, system.scene.frequency_range
    if isinstance(linear, RingLinear):  # whose harmonics meet other modes each
        return []
    damping, orders = linear.damping[np.argsort(linear.natural)], np.array(system.harmonics, dtype=np.float64)
    found: dict[float, float] = {}
    for stuck in (False, True):
        natural = np.sort(linear.stiffened(system.springs(stuck)))
        for place, width in zip(
            (natural / orders[:, None]).ravel(), (damping * natural / orders[:, None]).ravel(), strict=True
        ):
            if low < place < high and width > 0.0:
                found.setdefault(float(place), float(width))
    return sorted(found.items(), key=lambda one: -one[1])[:MOST]
