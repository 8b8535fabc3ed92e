"""Where stability changes between two points of an exact curve.

While the sequence of states stays, the multipliers change smoothly; where it changes they may jump, as where
a contact begins to slip. A contact that always sticks has a multiplier 1 on either side and tells nothing.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from fcm.continuation import Between, Path
from fcm.continuation.soft import TOUCHED
from fcm.orbit.periodic import STABLE
from fcm.orbit.problem import OrbitProblem
from fcm.scene.model import FloatArray

LOOKS = 60  # at most
SURE = 0.01 * STABLE  # by which a multiplier may differ from where stability ends, to be there
FALLEN = 0.5  # of the excess at an end of the bracket: a secant that leaves more has met no smooth change


class Place(NamedTuple):
    """A place between two points of a path."""

    part: float  # of the way: 0 and 1 are the points
    excess: float  # of the greatest multiplier over where stability ends, on a logarithmic scale
    z: FloatArray
    direction: FloatArray

    @property
    def there(self) -> bool:
        """Whether stability ends there, as far as can be told."""
        return abs(self.excess) <= 0.5 * SURE


def crossing(problem: OrbitProblem, path: Path, first: int) -> Place | None:
    """The last place of the stable side between a point of a path and the next; None if it is not found.

    By secants, and in the middle where one does not come nearer. What jumps is located as closely as a
    change of label is.
    """
    ends = [_place(problem, float(i), path.z[first + i], path.direction[first + i]) for i in (0, 1)]
    between, jumps = Between(problem, path, first), False
    for _ in range(LOOKS):
        low, high = ends
        stable = min(ends, key=lambda place: place.excess)
        if stable.there or (high.part - low.part) * between.length < TOUCHED:
            return stable
        part = _next(low, high, jumps)
        if not between.put(part):
            if jumps:
                break
            jumps = True
            continue
        new = _place(problem, part, between.z, between.direction)
        side = 0 if (new.excess < 0.0) == (low.excess < 0.0) else 1
        jumps = abs(new.excess) > FALLEN * abs(ends[side].excess)
        if new.there:
            return new
        ends[side] = new
    stable = min(ends, key=lambda place: place.excess)
    return stable if 0.0 < stable.part < 1.0 else None


def _next(low: Place, high: Place, jumps: bool) -> float:
    """The part of the way at which is looked next."""
    share = 0.5 if jumps else low.excess / (low.excess - high.excess)
    return low.part + share * (high.part - low.part)


def _place(problem: OrbitProblem, part: float, z: FloatArray, direction: FloatArray) -> Place:
    """Its excess is counted from half of what is sure below the limit, so that what is there is stable."""
    shot = problem.shot(z)
    others = np.zeros(0) if shot is None else np.abs(shot.others)
    excess = np.log(others.max(initial=1e-300)) - np.log1p(STABLE) + 0.5 * SURE
    return Place(part, float(excess), z, direction)
