"""Frequencies at which a response may have a peak that no point away from it tells of.

A mode that hardly anything damps answers to a harmonic h of the forces within damping omega / h. A step may
lead across, where the mode moves too little away from there to be seen. Where that is depends on what the
contacts do; they do least to a mode whose peak is narrow, and what they do is bounded by all stuck, all open.
"""

from __future__ import annotations

import numpy as np

from fcm.branches.options import LINEAR_LIMITS
from fcm.harmonic_balance.system import System
from fcm.model.scene import FloatArray
from fcm.structure.linear import Linear
from fcm.structure.ring import RingLinear


def narrow_resonances(system: System) -> list[tuple[float, float]]:
    """Frequencies within the range, with the width of the peak, both [rad/s]."""
    low, high = system.scene.frequency_range
    found: dict[float, float] = {}
    for stuck in (False, True):
        springs = system.springs(stuck)
        for order in system.harmonics:
            natural, damping = _excited_modes(system.linear, order, springs)
            for place, width in zip(natural / order, damping * natural / order, strict=True):
                if low < place < high and width > 0.0:
                    found.setdefault(float(place), float(width))
    return sorted(found.items(), key=lambda one: -one[1])[: LINEAR_LIMITS.max_resonances]


def _excited_modes(linear: Linear, order: int, springs: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Natural frequencies that a harmonic meets, with springs, in order; and the damping of the modes."""
    if isinstance(linear, RingLinear):  # whose harmonics meet other modes each
        wave = linear.wave(order)
        return np.sort(wave.stiffened(springs)), wave.damping[np.argsort(wave.natural)]
    return np.sort(linear.stiffened(springs)), linear.damping[np.argsort(linear.natural)]
