"""Changes of stability between two points of an exact curve.

While the sequence of states stays, the multipliers change smoothly; where it changes they may jump, as where
a contact begins to slip. A contact that always sticks has a multiplier 1 on either side and tells nothing.
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
    """A place between two points of a path."""

    part: float  # of the way: 0 and 1 are the points
    excess: float  # of the greatest multiplier over where stability ends, on a logarithmic scale
    z: FloatArray
    direction: FloatArray
    there: bool  # stability ends there, as far as can be told


def crossing(problem: OrbitProblem, path: Path, first: int) -> CrossingPoint | None:
    """The last place of the stable side between a point of a path and the next; None if it is not found.

    By secants, and in the middle where one does not come nearer. What jumps is located as closely as a
    change of label is.
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
    """The place between two points with its excess.

    The excess is counted from half of what is sure below the limit, so that what is there is stable.
    """
    shot = problem.shot(z)
    others = np.zeros(0) if shot is None else np.abs(shot.other_multipliers)
    excess = problem.options.floquet.classification.growth_tolerance
    room = 0.5 * problem.options.stability.certain_fraction * excess
    beyond = float(np.log(others.max(initial=1e-300)) - np.log1p(excess) + room)
    return CrossingPoint(part, beyond, z, direction, abs(beyond) <= room)
