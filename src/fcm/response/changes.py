"""Where a contact of a traced curve begins to slip, to open, to stick: points on both sides of each change.

A response curve has its corners there, and a pair of folds may begin at one which is shorter than a step.
"""

from __future__ import annotations

import numpy as np

from fcm.contact.cycle import OPEN, STUCK, behaviour, stuck_force
from fcm.contact.limits import FloatArray, slip_limits, within_range
from fcm.response.balance import Balance
from fcm.response.branches import hang_together
from fcm.response.law import UNKNOWNS, Law
from fcm.response.points import Points, inserted
from fcm.response.segment import Segments
from fcm.response.structure import IntArray

HALVINGS = 10  # of a segment, until the change lies between two points
SHORTEST = (
    1e-4  # a segment of less than this part of the curve's size is short enough: the follower's corners
)


def with_changes(exact: Balance, points: Points) -> Points:
    """Two more points in each segment at whose ends the contacts are in different regimes."""
    regime = _regimes(exact.take(points.curve).law, points.z)
    differs = np.any(regime[1:] != regime[:-1], axis=1)
    at = np.flatnonzero(differs & hang_together(points.branch))
    segments = points.segments(at, exact)
    at, segments = at[segments.length > SHORTEST], segments.take(np.flatnonzero(segments.length > SHORTEST))
    law = exact.take(segments.curve).law
    share = np.stack((np.zeros(at.size), np.ones(at.size)))  # before and beyond the first change
    z = np.full((2, *segments.start.shape), np.nan)
    direction = z.copy()
    for count in range(HALVINGS if at.size else 0):
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
    product: FloatArray = (step * direction / segments.scale**2).sum(axis=1)
    return product


def _regimes(law: Law, z: FloatArray) -> IntArray:
    """A number for each contact at each point, (point, contact): equal where the force is smooth between."""
    n0_bar, b_bar, phi = law.arguments(z[:, :-1].reshape(z.shape[0], law.mu.shape[1], UNKNOWNS))
    n0_bar, b_bar = within_range(n0_bar, b_bar)
    limits = slip_limits(b_bar, phi)
    code = behaviour(n0_bar, b_bar, limits)
    separates = (n0_bar < b_bar) & (code != OPEN)
    drawn = np.where(code == STUCK, np.sign(stuck_force(n0_bar, b_bar, limits)), 0.0)
    regime: IntArray = (100 * code + 10 * separates + drawn).astype(np.intp)
    return regime
