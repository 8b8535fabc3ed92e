"""Jumps of the response when the frequency is swept slowly up or down along the stable parts of a curve."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fcm.contact.limits import FloatArray
from fcm.response.path import BoolArray


@dataclass(frozen=True)
class Jump:
    """Where a slow sweep leaves one stable part of a curve, and what it finds on the next."""

    sweep: str  # 'up' or 'down'
    frequency: float  # [rad/s]
    before: FloatArray  # (dof,) amplitude
    after: FloatArray  # (dof,) amplitude; NaN where the curve has no stable part to land on


def jumps(frequency: FloatArray, amplitude: FloatArray, stable: BoolArray) -> list[Jump]:
    """Jumps of an upward, then of a downward sweep along a curve; amplitude (point, dof).

    >>> w = np.array([1.0, 2.0, 3.0, 2.5, 2.0, 3.0, 4.0])
    >>> found = jumps(w, w[:, None] + [[0], [0], [0], [1], [2], [2], [2]], w == w)
    >>> [(j.sweep, j.frequency, j.after.tolist()) for j in found]
    [('up', 3.0, [5.0]), ('down', 2.0, [2.0])]
    """
    up = _sweep(frequency, amplitude, stable, "up")
    return up + _sweep(frequency[::-1], amplitude[::-1], stable[::-1], "down")


def _sweep(frequency: FloatArray, amplitude: FloatArray, stable: BoolArray, sweep: str) -> list[Jump]:
    ahead = np.diff(frequency) * (1.0 if sweep == "up" else -1.0) > 0.0
    goes_on = ahead & stable[:-1] & stable[1:]  # the segments along which the sweep can move
    found: list[Jump] = []
    at = 0
    while True:
        ends = np.flatnonzero(~goes_on[at:])
        if ends.size == 0:
            return found
        at += int(ends[0])
        start, end = frequency[at + 1 : -1], frequency[at + 2 :]
        holds = (frequency[at] - start) * (frequency[at] - end) <= 0.0
        landing = np.flatnonzero(holds & goes_on[at + 1 :])
        if landing.size == 0:
            found.append(
                Jump(sweep, float(frequency[at]), amplitude[at], np.full_like(amplitude[at], np.nan))
            )
            return found
        k = at + 1 + int(landing[0])
        share = (frequency[at] - frequency[k]) / (frequency[k + 1] - frequency[k])
        after = amplitude[k] + share * (amplitude[k + 1] - amplitude[k])
        found.append(Jump(sweep, float(frequency[at]), amplitude[at], after))
        at = k + 1
