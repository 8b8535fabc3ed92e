"""Steps along a curve whose problem is soft: margins are labels, which tell no distance to their change.

The length of a step is chosen by how far from its prediction the curve is, in the curve's own size: what is
smaller than that is passed. A step that is good has no corner in it, whatever its labels are. One that is
short and still not good has: the change of label is approached until it is met, and the curve is left in the
direction that the equations have beyond it.
"""

from __future__ import annotations

from typing import Protocol

import numpy as np

from fcm.continuation.ahead import ahead
from fcm.continuation.front import Front
from fcm.continuation.path import FloatArray, Mark, Status
from fcm.continuation.place import Place
from fcm.continuation.sharp import SHARP
from fcm.continuation.trail import Trail
from fcm.continuation.way_out import way_out

SHORTEST = 1e-9  # a step that is still too long then leads nowhere
ERROR = 5e-4  # distance of the curve from where it is predicted, in its own size, that a step aims at
MOST = 4.0  # of that, with which a step is good
STRAYED = 0.5  # of the parameter's change, by which a step may miss it: more may be the way past two folds
GENTLY = 0.5  # cosine of the turn of a step
ASTRAY = 0.5  # of its length, by which a step may miss the curve
SHORTER, REFUSED, LONGER = 0.3, (0.1, 0.5), 3.0  # of a step to the next, to the one in its place: limits
WARY = 1.0  # and to the one after a shortened one
# cosine beyond which a change of orientation is a branch point and not a way back, a step has a direction,
# and what was taken for a corner is none: labels leave out what is short, so that it is further on
STRAIGHT = 0.999
ASIDE = 2.0  # times as long as its turn alone makes it, a short step may be
BESIDE = (2.0 * (1.0 - STRAIGHT)) ** 0.5  # of its length, by which a step that turns less misses the curve
SHORT_OF = 3e-3  # of the way to where a label changes, by which a step ends before it
BEYOND = 1e-7  # length past a corner at which the curve's new direction is looked for, at least
TOUCHED = 1e-8  # a change of label this near is met: less than BEYOND
MET = 1e-6  # and this near, where no curve is found up to there
LOOKS = 5  # looks beyond one place, each ten times as far
AWAY = 10.0  # times as far from the corner is the next place, at least: its guess is beyond by as much
BACK = -0.99  # cosine below which a curve goes back on the way that it came, unless its label there is new:
SPIKE = -1.0 + 1e-6  # then below this one. Where damping is light, most unknowns may turn back at a corner
SAME, LOOP = 1e-8, 20  # distance of two folds that are one; points that a closed curve has at least
AFTER = 1e-5  # the first step beyond a corner, and the least


class Follower(Protocol):
    """What a step needs of the one that follows the curve."""

    def good(self) -> bool:
        """Whether the curve was where it was predicted, and went on as it did."""

    def turning(self) -> float:
        """Length at which the step passes by two folds; 0 if it does not."""

    def smooth(self) -> object:
        """Go on to the place there; a status where the curve ends."""

    def leave(self, place: Place, at: float, past: float) -> object:
        """Keep the corner, a place at a length from here, and take the direction beyond it."""

    def aim(self, step: float, longer: bool) -> None:
        """Make the next step at most that long, or at least."""


def growth(error: float, cubic: bool = False) -> float:
    """Of a step that has missed the curve by so much, to one that misses it by what is aimed at.

    The prediction is a parabola, and what it misses grows as the third power; or a cubic: as the fourth.
    """
    return float(0.9 * (ERROR / max(error, 1e-12)) ** (0.25 if cubic else 1.0 / 3.0))


def within(value: float, low: float, high: float) -> float:
    """The value, or the limit that is nearest to it."""
    return min(max(value, low), high)


class Soft:
    """The steps, and how often a corner has been tried that is not left yet."""

    def __init__(self, front: Front, trail: Trail) -> None:
        self.front, self.trail = front, trail
        self.repeated = 0  # corners at one point
        self.past = 0.0  # length beyond the last of them at which the direction was found
        self.came: FloatArray = np.zeros(0)  # direction in which the curve came there,
        self.label: FloatArray = np.zeros(0)  # and its labels before

    def advance(self, follower: Follower, step: float) -> object:
        """One step; a status where the curve ends. Close to a change there may be no curve to be found."""
        front = self.front
        step = asked = max(step, AFTER, AWAY * self.past)  # what led to a corner may have been shorter
        while step > max(SHORTEST, self.past):  # one that ends short of there is in the corner yet
            if front.go(step) and self.good(follower):
                at = follower.turning() if step > SHARP else 0.0
                if at == 0.0:
                    return self.smooth(follower, WARY if step < asked else LONGER)
                step = at
                continue
            if step > SHARP:
                step = max(SHARP, step * within(growth(front.newton.moved, front.prediction.cubic), *REFUSED))
                continue
            reach = ahead(front, step)
            if reach < min(step, max(TOUCHED, self.past)):
                return self.leave(follower, min(reach, TOUCHED))
            if reach < step and front.go(reach * (1.0 - SHORT_OF)) and self.good(follower):
                status = self.smooth(follower, LONGER)
                follower.aim(SHARP, False)
                return status
            step = 0.25 * min(step, reach)
        return self.leave(follower, 0.0 if self.past else ahead(front, MET))

    def good(self, follower: Follower) -> bool:
        """Whether a step was, and does not go back: there is no margin to tell that of a corner."""
        front = self.front
        same = front.there.orientation == front.here.orientation
        near = front.missed * front.step < MOST * ERROR
        if front.step <= SHARP:
            passes = same or (self.straight() and np.array_equal(front.there.margin, front.here.margin))
            return passes and (near or self.turned()) and self.went_on() and follower.good()
        return (
            not self.turned_twice()
            and not self.strayed()
            and (follower.good() or (same and near and front.missed < ASTRAY and front.cosine > GENTLY))
        )

    def went_on(self) -> bool:
        """Whether a short step led no further aside than its turn explains, and so not to another branch."""
        return bool(np.linalg.norm(self.way()) * self.front.cosine < ASIDE * self.front.step)

    def turned(self) -> bool:
        """Whether it went as the curve does there: it turned at a corner ahead, which is not a fold."""
        way, here, there = self.way(), self.front.here, np.asarray(self.front.there.tangent)
        return bool(here.tangent[-1] * there[-1] > 0.0 and way @ there > STRAIGHT * np.linalg.norm(way))

    def way(self) -> FloatArray:
        """Of a step, from here to there, in the curve's own size."""
        return np.array((np.array(self.front.there.z) - self.front.here.z) / self.front.newton.scale)

    def straight(self) -> bool:
        """Whether a step went straight on; what it misses by more than the turn explains is beside it."""
        return self.front.cosine > STRAIGHT and self.front.missed < BESIDE

    def turned_twice(self) -> bool:
        """Whether the parameter went against the direction at both ends: there are two folds between."""
        here, there = self.front.here, self.front.there
        went = there.z[-1] - here.z[-1]
        return bool(went * here.tangent[-1] < 0.0 and went * there.tangent[-1] < 0.0)

    def strayed(self) -> bool:
        """Whether the parameter was missed by much of what it changes along the step."""
        rise = max(abs(self.front.here.tangent[-1]), abs(self.front.there.tangent[-1]))
        return bool(self.front.strayed > STRAYED * rise)

    def smooth(self, follower: Follower, longer: float) -> object:
        """Go on to the place there; the next step may be so many times as long."""
        count = self.trail.count
        step, error, cubic = self.front.step, self.front.missed * self.front.step, self.front.prediction.cubic
        status = follower.smooth()
        if status is None and self.goes_round(count):
            return Status.STALLED
        if self.trail.count > count:
            follower.aim(step * within(growth(error, cubic), SHORTER, longer), True)
            follower.aim(step * longer, False)
            self.repeated, self.past = 0, 0.0
        return status

    def goes_round(self, count: int) -> bool:
        """Whether a fold beyond the first so many points is an old one: a step has led to a closed curve."""
        if self.trail.count < count + 2:  # nothing within the step
            return False
        kept = self.trail.points()
        folds = np.flatnonzero(kept.mark & Mark.FOLD)
        new = folds[folds >= count]
        if not new.size:
            return False
        away = (kept.z[folds[folds < count - LOOP]] - kept.z[new[-1]]) / np.asarray(self.front.newton.scale)
        return bool((np.abs(away).max(axis=1, initial=0.0) < SAME).any())

    def leave(self, follower: Follower, reach: float) -> object:
        """Leave a corner, a change of label this near; if nothing new leads on, look further beyond it."""
        front = self.front
        if self.repeated > LOOKS:
            return Status.STALLED
        if self.repeated == 0:
            self.came = np.array(front.here.tangent)
            self.label = np.array(front.here.margin)
            self.came_so = self.trail.tail()
        while self.repeated < LOOKS:
            np.asarray(front.here.tangent)[:] = self.came
            front.prediction.straighten()
            self.trail.drop()
            self.trail.put(*self.came_so)
            past = max(BEYOND, 3.0 * reach) * 10.0**self.repeated
            self.repeated += 1
            follower.leave(front.here, 0.0, past)
            new = np.array(front.here.tangent)
            front.problem.bound(np.asarray(front.here.z) + past * np.asarray(front.newton.scale) * new)
            cosine = float(new @ self.came)
            if self.leads_on(cosine) and (cosine < STRAIGHT or self.repeated == LOOKS):
                self.past = past if cosine < STRAIGHT else 0.0
                if cosine > BACK:  # it is found from here
                    np.asarray(front.aside)[:] = 0.0
                return None
        np.asarray(front.aside)[:] = 0.0
        return None if self.sought(follower) else Status.STALLED

    def leads_on(self, cosine: float) -> bool:
        """Whether a direction at that angle to the old one is another, the problem being bound on the way."""
        new = not np.array_equal(np.asarray(self.front.problem.margin), self.label)
        return cosine > (SPIKE if new else BACK)

    def sought(self, follower: Follower) -> bool:
        """Whether the curve leaves a corner by any way that is tried around it: then it is left there."""
        front = self.front
        if self.repeated > LOOKS:
            return False
        self.repeated += 1
        way = way_out(front, self.came, self.leads_on)
        if way is None:
            return False
        np.asarray(front.here.tangent)[:] = way.direction
        np.asarray(front.here.margin)[:] = front.problem.margin
        front.prediction.straighten()
        np.asarray(front.aside)[:] = way.aside
        self.past = 0.0
        follower.aim(way.reach, True)
        return True
