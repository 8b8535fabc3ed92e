"""Frequencies at which a response may have a peak so narrow that steps may miss it.

A lightly damped mode responds to a harmonic h of the forces only within damping omega / h. A step may pass
over such a peak, as the mode hardly moves away from there. Its place depends on the contacts. They affect a
mode with a narrow peak least, and their effect lies between those of all stuck and all open.
"""

from __future__ import annotations

import numpy as np

from fcm.branches.options import LINEAR_LIMITS
from fcm.harmonic_balance.system import System
from fcm.model.scene import FloatArray
from fcm.structure.linear import Linear
from fcm.structure.ring import RingLinear


def narrow_resonances(system: System) -> list[tuple[float, float]]:
    """Frequencies within the range and widths of the peaks, both [rad/s], the widest first."""
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
    """Natural frequencies with springs of the modes that a harmonic excites, in order; their damping."""
    if isinstance(linear, RingLinear):  # each harmonic excites other modes
        wave = linear.wave(order)
        return np.sort(wave.stiffened(springs)), wave.damping[np.argsort(wave.natural)]
    return np.sort(linear.stiffened(springs)), linear.damping[np.argsort(linear.natural)]
