"""Where a contact of a traced curve begins to slip, to open, to stick: points on both sides of each change.

A response curve has its corners there, and a pair of folds may begin at one which is shorter than a step.
"""

from __future__ import annotations

import numpy as np

from fcm.contact.fourier import fourier_coefficients
from fcm.contact.limits import FloatArray, regime_boundaries
from fcm.response.balance import Balance
from fcm.response.branches import hang_together
from fcm.response.law import UNKNOWNS, Law
from fcm.response.points import Points, inserted
from fcm.response.segment import Segments
from fcm.response.structure import BoolArray, IntArray

ROUNDS = 3  # changes of a segment that are looked for
HALVINGS = 8  # of a segment, until the change lies between two points
SHORT = 1e-3  # a segment of less than this part of the curve's size needs no more points
GRADES = np.array([0.125, 0.25, 0.5])  # shares of a segment next to a change, from the change


def with_changes(exact: Balance, points: Points) -> Points:
    """More points where the contacts' regimes change: on both sides of each change, and closer next to it."""
    for _ in range(ROUNDS):
        regime = _regimes(exact.take(points.curve).law, points.z)
        at, segments = _long(exact, points, np.flatnonzero(_changes(points, regime)))
        if at.size == 0:
            break
        points = _bracketed(exact, points, regime, at, segments)
    return _graded(exact, points)


def _changes(points: Points, regime: IntArray) -> BoolArray:
    """Whether the regimes differ at the ends of each segment."""
    changes: BoolArray = np.any(regime[1:] != regime[:-1], axis=1) & hang_together(points.branch)
    return changes


def _long(exact: Balance, points: Points, at: IntArray) -> tuple[IntArray, Segments]:
    segments = points.segments(at, exact)
    some = np.flatnonzero(segments.length > SHORT)
    return at[some], segments.take(some)


def _graded(exact: Balance, points: Points) -> Points:
    """Points at GRADES of the segments before and after each change: there a curve bends most."""
    changes = _changes(points, _regimes(exact.take(points.curve).law, points.z))
    around = np.concatenate(([False], changes, [False]))
    inside = hang_together(points.branch) & ~changes
    after, before = (_long(exact, points, np.flatnonzero(inside & s))[0] for s in (around[:-2], around[2:]))
    place = [at[:, None] + shares for at, shares in ((after, GRADES), (before, 1.0 - GRADES))]
    where = np.unique(np.concatenate([part.reshape(-1) for part in place]))
    at = where.astype(np.intp)
    new = points.segments(at, exact).points(exact, where - at)
    ok = new.converged
    return inserted(points, where[ok], new.z[ok], new.tangent[ok], fold=False)


def _bracketed(exact: Balance, points: Points, regime: IntArray, at: IntArray, segments: Segments) -> Points:
    """Two more points in each of the segments, on both sides of its first change."""
    law = exact.take(segments.curve).law
    share = np.stack((np.zeros(at.size), np.ones(at.size)))  # before and beyond the first change
    z = np.full((2, *segments.start.shape), np.nan)
    direction = z.copy()
    for count in range(HALVINGS):
        cut = 0.5 if count % 2 == 0 else 0.45  # elsewhere, should there be no point in the middle
        middle = share[0] + cut * (share[1] - share[0])
        new = segments.points(exact, middle)
        now = _regimes(law, new.z)
        before = np.all(now == regime[at], axis=1)
        backward = _along(segments, new.z - segments.start, segments.direction_start) < 0.0
        at_last = np.all(now == regime[at + 1], axis=1)
        overshot = _along(segments, segments.end - new.z, segments.direction_end) < 0.0
        new.converged &= ~(before & backward) & ~(at_last & overshot)  # beyond an end: not of this segment
        for side, which in enumerate((new.converged & before, new.converged & ~before)):
            share[side, which] = middle[which]
            z[side, which], direction[side, which] = new.z[which], new.tangent[which]
    known = np.isfinite(z[..., 0])
    return inserted(points, (at + share)[known], z[known], direction[known], fold=False)


def _along(segments: Segments, step: FloatArray, direction: FloatArray) -> FloatArray:
    """Whether steps go along directions: scaled, (segment,)."""
    product: FloatArray = ((step / segments.scale) * (direction / segments.scale)).sum(axis=1)
    return product


def _regimes(law: Law, z: FloatArray) -> IntArray:
    """A number for each contact at each point, (point, contact): equal where the force is smooth between."""
    contacts = law.arguments(z[:, :-1].reshape(z.shape[0], law.mu.shape[1], UNKNOWNS))
    touches, stays_closed, sticks = (side >= 0.0 for side in regime_boundaries(*contacts))
    stuck = stays_closed & sticks
    drawn = np.where(stuck, np.sign(fourier_coefficients(*contacts)[0]), 0.0)
    regime: IntArray = (100 * stuck + 20 * stays_closed + 10 * touches + drawn).astype(np.intp)
    return regime
