"""Folds and peaks located along traced curves: where a rate along the arc changes its sign.

At a smooth extreme the rate passes through zero; at a corner it jumps. A bracketing search serves both.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from fcm.contact.limits import FloatArray
from fcm.response.balance import Balance
from fcm.response.displacement import amplitude_growth
from fcm.response.segment import Segments
from fcm.response.structure import IntArray

WIDTH = 1e-10  # arc within which an extreme is known, relative to the curve's own size
MAX_HALVINGS = 60
Rate = Callable[[Balance, FloatArray, FloatArray, IntArray], FloatArray]


def fold_rate(balance: Balance, z: FloatArray, direction: FloatArray, which: IntArray) -> FloatArray:
    """d omega / ds, which vanishes at a fold."""
    return direction[:, -1]


def peak_rate(balance: Balance, z: FloatArray, direction: FloatArray, which: IntArray) -> FloatArray:
    """Growth of one degree of freedom's amplitude, which vanishes at its peak."""
    return amplitude_growth(balance, z, direction)[np.arange(z.shape[0]), which]


def locate(
    exact: Balance, segments: Segments, rate: Rate, at_start: FloatArray, at_end: FloatArray, which: IntArray
) -> tuple[FloatArray, FloatArray]:
    """The point of each segment where the rate changes its sign, and the curve's direction there.

    Both (segment, unknown + 1). at_start and at_end are the rates at the ends; which is passed to the rate.
    """
    z, direction = segments.start.copy(), segments.direction_start.copy()
    low, high = np.zeros(z.shape[0]), np.ones(z.shape[0])
    f_low, f_high = at_start.copy(), at_end.copy()
    missed = np.zeros(z.shape[0], dtype=bool)
    left = np.flatnonzero(segments.length > WIDTH)
    for count in range(MAX_HALVINGS):
        if left.size == 0:
            break
        some, lo, hi = segments.take(left), low[left], high[left]
        by_rate = _next_share(lo, hi, f_low[left], f_high[left], count)
        share = np.where(missed[left], _any_share(lo, hi, count), by_rate)
        new = some.points(exact, share)
        f = rate(exact.take(some.curve), new.z, new.tangent, which[left])
        missed[left] = ~new.converged
        use = left[new.converged]
        share, f = share[new.converged], f[new.converged]
        z[use], direction[use] = new.z[new.converged], new.tangent[new.converged]
        before = np.sign(f) == np.sign(at_start[use])
        low[use], f_low[use] = np.where(before, (share, f), (low[use], f_low[use]))
        high[use], f_high[use] = np.where(before, (high[use], f_high[use]), (share, f))
        zero = use[f == 0.0]
        low[zero] = high[zero]
        left = left[(high - low)[left] * some.length > WIDTH]
    return z, direction


def _any_share(low: FloatArray, high: FloatArray, count: int) -> FloatArray:
    """Where no point was found: elsewhere in the bracket, by the golden ratio."""
    return low + (high - low) * ((count + 1) * 0.6180339887498949 % 1.0)


def _next_share(
    low: FloatArray, high: FloatArray, f_low: FloatArray, f_high: FloatArray, count: int
) -> FloatArray:
    """Secant through the ends, kept off them so that both close in; every third step halves."""
    middle = 0.5 * (low + high)
    if count % 3 == 2:
        return middle
    difference = f_low - f_high
    safe = np.where(difference != 0.0, difference, 1.0)
    secant = low + (high - low) * f_low / safe
    # overshoot the root slightly on alternate steps, so that the bracket shrinks from both sides
    nudge = 1e-3 * (high - low) * (1.0 if count % 3 == 0 else -1.0)
    inside = low + (high - low) * np.clip(
        (secant + nudge - low) / np.where(high > low, high - low, 1.0), 0.001, 0.999
    )
    return np.where(difference != 0.0, inside, middle)
