"""Stability along curves, and points between folds where a pair of exponents crosses the imaginary axis."""

from __future__ import annotations

import numpy as np

from fcm.contact.limits import FloatArray
from fcm.response.balance import Balance
from fcm.response.branches import hang_together
from fcm.response.extrema import locate
from fcm.response.law import UNKNOWNS
from fcm.response.points import Points, inserted
from fcm.response.regimes import regimes
from fcm.response.stability import GROWTH, growth_rates, stable_points
from fcm.response.structure import BoolArray, IntArray

NEUTRAL = 1e-6  # of the frequency: at a fold a real exponent is zero, and grows or decays by less


def with_stability(exact: Balance, points: Points) -> tuple[Points, BoolArray]:
    """The points with those where stability ends between folds, and whether each is stable, (point,)."""
    at_points = exact.take(points.curve)
    x = points.z[:, :-1].reshape(points.z.shape[0], exact.group.contacts, UNKNOWNS)
    linear = np.logical_and.reduce(np.isin(regimes(at_points.law, x), ("E", "S")), axis=1)
    stable = stable_points(at_points, points.z, linear)
    at = np.flatnonzero(hang_together(points.branch) & (stable[1:] != stable[:-1]))
    if at.size == 0:
        return points, stable
    before, after = (_growth_unless_at_fold(exact, points, end) for end in (at, at + 1))
    crosses = before * after < 0.0
    at, before, after = at[crosses], before[crosses], after[crosses]
    z, direction = locate(exact, points.segments(at, exact), growth_rate, before, after, at)
    # each is the last stable point of its part
    return inserted(points, at + np.float64(0.5), z, direction, fold=False), np.insert(stable, at + 1, True)


def growth_rate(balance: Balance, z: FloatArray, direction: FloatArray, which: IntArray) -> FloatArray:
    """Growth rate of a small disturbance, less what counts as none; its sign changes at a crossing."""
    return _growth(balance, z)


def _growth(balance: Balance, z: FloatArray) -> FloatArray:
    growth: FloatArray = growth_rates(balance, z) - GROWTH * z[:, -1]
    return growth


def _growth_unless_at_fold(exact: Balance, points: Points, at: IntArray) -> FloatArray:
    """Growth rate at some points; 0 at a fold where no other exponent than the real one is to grow."""
    z = points.z[at]
    growth = _growth(exact.take(points.curve[at]), z)
    return np.where(points.fold[at] & (np.abs(growth) < NEUTRAL * z[:, -1]), 0.0, growth)
