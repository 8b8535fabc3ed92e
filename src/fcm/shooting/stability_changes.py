"""Location of changes of stability between two points of an exact curve.

The multipliers are smooth while the sequence of states stays the same. Where it changes they may jump, as
where a contact begins to slip. The multiplier 1 of a contact that always sticks gives no information.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from fcm.continuation import Path, Segment
from fcm.continuation.events import SignChange
from fcm.continuation.options import FOLLOW
from fcm.model.scene import FloatArray
from fcm.shooting.problem import OrbitProblem


class CrossingPoint(NamedTuple):
    """A point between two points of a path."""

    part: float  # of the interval: 0 and 1 are the two points
    excess: float  # logarithm of the greatest multiplier over the stability limit
    z: FloatArray
    direction: FloatArray
    there: bool  # whether it is at the stability limit within the tolerance


def crossing(problem: OrbitProblem, path: Path, first: int) -> CrossingPoint | None:
    """The last stable point between a point of a path and the next; None if it is not found.

    It is located by the secant method, with bisection where this fails. A jump of the multipliers is located
    as closely as a change of label.
    """
    ends = [_place(problem, float(i), path.z[first + i], path.direction[first + i]) for i in (0, 1)]
    bracket = problem.options.stability.sign_change
    sides = SignChange(0.0, 1.0, ends[0].excess, ends[1].excess, True, bracket)
    between, stable = Segment(problem, path, first), min(ends, key=lambda place: place.excess)
    for _ in range(problem.options.stability.max_evaluations):
        if stable.there or sides.width * between.length < FOLLOW.switching.reached_distance:
            return stable
        tried = sides.at, 0.5 * (sides.low + sides.high)
        part = next((at for at in tried if between.find(at)), None)
        if part is None:
            break
        new = _place(problem, part, between.z, between.direction)
        sides.update(part, new.excess)
        if new.excess < 0.0 or new.there:
            stable = new
    return stable if 0.0 < stable.part < 1.0 else None


def _place(problem: OrbitProblem, part: float, z: FloatArray, direction: FloatArray) -> CrossingPoint:
    """The point at a part of the interval, with its excess.

    The excess counts from slightly below the limit, half the tolerance, so that a located point is stable.
    """
    shot = problem.shot(z)
    others = np.zeros(0) if shot is None else np.abs(shot.other_multipliers)
    excess = problem.options.floquet.classification.growth_tolerance
    room = 0.5 * problem.options.stability.certain_fraction * excess
    beyond = float(np.log(others.max(initial=1e-300)) - np.log1p(excess) + room)
    return CrossingPoint(part, beyond, z, direction, abs(beyond) <= room)
