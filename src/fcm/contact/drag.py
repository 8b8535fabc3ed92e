"""Resistance of a contact to a slow drift of its tangential displacement.

While a contact sticks it remembers where it began to, and a drift adds to its elongation until it slips.
With u = a (sin(theta) + e theta), a stick region of length L adds e L^2 / 2 to the integral of the friction
force; its beginning and its end, where the force is continuous, and a slip region, add nothing to first
order. So the mean friction force, over k_u a, grows by e times the sum of L^2 / (4 pi).
"""

from __future__ import annotations

import numpy as np

from fcm.contact.limits import FloatArray
from fcm.contact.record import Cycles, Record

STUCK, SLIPPING = 0, 1  # as in `cycle`


def drift_resistance(n0_bar: FloatArray, b_bar: FloatArray, phi: FloatArray) -> FloatArray:
    """Derivative of F_b by a drift e [-] of u = a (sin(theta) + e theta); arguments and result (point,).

    A contact that never slips holds on for ever; it is given that of one that lets go once in a cycle.

    >>> drift_resistance(np.array([0.0, 0.5, 9.0]), np.zeros(3), np.zeros(3)).round(6).tolist()
    [0.0, 0.392699, 3.141593]
    """
    cycles = Record().of(np.stack((n0_bar, b_bar, phi)))
    total = np.where(cycles.behaviour == STUCK, (2.0 * np.pi) ** 2, 0.0)
    total = np.where(cycles.behaviour == SLIPPING, _squares(cycles), total)
    resistance: FloatArray = total / (4.0 * np.pi)
    return resistance


def _squares(cycles: Cycles) -> FloatArray:
    """Sum of the squared lengths of the stick regions of a cycle; one may extend over several spans."""
    total, length = np.zeros_like(cycles.theta_1), np.zeros_like(cycles.theta_1)
    for whole, slip in zip(cycles.spans.length, cycles.spans.slip, strict=True):
        length = length + (whole - slip)
        total += np.where(slip > 0.0, length * length, 0.0)
        length = np.where(slip > 0.0, 0.0, length)
    return total + length * length
