"""Steps along a curve whose margins are labels, which tell no distance to their change.

The length of a step is chosen by how far from its prediction the curve is, in the curve's own size: what is
smaller than that is passed. A step that is good has no corner in it, whatever its labels are. One that is
short and still not good has: the change of label is approached until it is met, and the curve is left in the
direction that the equations have beyond it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from itertools import product
from typing import NamedTuple, Protocol

import numpy as np

from fcm.continuation.options import LabelOptions
from fcm.continuation.path import FloatArray, Mark, Status
from fcm.continuation.point import Point, PointStore
from fcm.continuation.stepper import Stepper
from fcm.continuation.switching_functions import ahead


class Follower(Protocol):
    """What a step needs of the one that follows the curve."""

    def good(self) -> bool:
        """Whether the curve was where it was predicted, and went on as it did."""

    def turning(self) -> float:
        """Length at which the step passes by two folds; 0 if it does not."""

    def smooth(self) -> object:
        """Go on to the point there; a status where the curve ends."""

    def leave(self, point: Point, at: float, past: float) -> object:
        """Keep the corner, a point at a length from here, and take the direction beyond it."""

    def aim(self, step: float, longer: bool) -> None:
        """Make the next step at most that long, or at least."""


def growth(aim: float, error: float, cubic: bool = False) -> float:
    """Of a step that has missed the curve by an error, to one that misses it by what is aimed at.

    The prediction is a parabola, and what it misses grows as the third power; or a cubic: as the fourth.
    """
    return float(0.9 * (aim / max(error, 1e-12)) ** (0.25 if cubic else 1.0 / 3.0))


def within(value: float, low: float, high: float) -> float:
    """The value, or the limit that is nearest to it."""
    return min(max(value, low), high)


class LabelledSwitching:
    """The steps, and how often a corner has been tried that is not left yet."""

    def __init__(self, stepper: Stepper, store: PointStore) -> None:
        self.stepper, self.store, self.options = stepper, store, stepper.options.labels
        self.control, self.switching = stepper.options.step, stepper.options.switching
        self.repeated = 0  # corners at one point
        self.past = 0.0  # length beyond the last of them at which the direction was found
        self.came: FloatArray = np.zeros(0)  # direction in which the curve came there,
        self.label: FloatArray = np.zeros(0)  # and its labels before

    def advance(self, follower: Follower, step: float) -> object:
        """One step; a status where the curve ends. Close to a change there may be no curve to be found."""
        stepper = self.stepper
        # what led to a corner may have been shorter
        step = asked = max(step, self.control.after, self.options.away * self.past)
        # a step that ends short of there is in the corner yet
        while step > max(self.control.shortest, self.past):
            if stepper.go(step) and self.good(follower):
                at = follower.turning() if step > self.control.sharp else 0.0
                if at == 0.0:
                    return self.smooth(follower, self.options.wary if step < asked else self.options.longer)
                step = at
                continue
            if step > self.control.sharp:
                shorter = growth(self.options.error, stepper.newton.moved, stepper.predictor.cubic)
                step = max(self.control.sharp, step * within(shorter, *self.options.refused))
                continue
            reach = ahead(stepper, step)
            if reach < min(step, max(self.switching.touched, self.past)):
                return self.leave(follower, min(reach, self.switching.touched))
            if reach < step and stepper.go(reach * (1.0 - self.options.short_of)) and self.good(follower):
                status = self.smooth(follower, self.options.longer)
                follower.aim(self.control.sharp, False)
                return status
            step = 0.25 * min(step, reach)
        return self.leave(follower, 0.0 if self.past else ahead(stepper, self.options.met))

    def good(self, follower: Follower) -> bool:
        """Whether a step was, and does not go back: there is no margin to tell that of a corner."""
        stepper = self.stepper
        same = stepper.there.orientation == stepper.here.orientation
        near = stepper.missed * stepper.step < self.options.most * self.options.error
        if stepper.step <= self.control.sharp:
            passes = same or (self.straight() and np.array_equal(stepper.there.margin, stepper.here.margin))
            return passes and (near or self.turned()) and self.went_on() and follower.good()
        if self.turned_twice() or self.strayed():
            return False
        gently = stepper.missed < self.options.astray and stepper.cosine > self.options.gently
        return follower.good() or (same and near and gently)

    def went_on(self) -> bool:
        """Whether a short step led no further aside than its turn explains, and so not to another branch."""
        return bool(np.linalg.norm(self.way()) * self.stepper.cosine < self.options.aside * self.stepper.step)

    def turned(self) -> bool:
        """Whether it went as the curve does there: it turned at a corner ahead, which is not a fold."""
        way, here, there = self.way(), self.stepper.here, np.asarray(self.stepper.there.tangent)
        straight = way @ there > self.options.straight * np.linalg.norm(way)
        return bool(here.tangent[-1] * there[-1] > 0.0 and straight)

    def way(self) -> FloatArray:
        """Of a step, from here to there, in the curve's own size."""
        return np.array((np.array(self.stepper.there.z) - self.stepper.here.z) / self.stepper.newton.scale)

    def straight(self) -> bool:
        """Whether a step went straight on; what it misses by more than the turn explains is beside it."""
        beside = (2.0 * (1.0 - self.options.straight)) ** 0.5  # by which a step that turns as much misses it
        return self.stepper.cosine > self.options.straight and self.stepper.missed < beside

    def turned_twice(self) -> bool:
        """Whether the parameter went against the direction at both ends: there are two folds between."""
        here, there = self.stepper.here, self.stepper.there
        went = there.z[-1] - here.z[-1]
        return bool(went * here.tangent[-1] < 0.0 and went * there.tangent[-1] < 0.0)

    def strayed(self) -> bool:
        """Whether the parameter was missed by much of what it changes along the step."""
        rise = max(abs(self.stepper.here.tangent[-1]), abs(self.stepper.there.tangent[-1]))
        return bool(self.stepper.strayed > self.options.strayed * rise)

    def smooth(self, follower: Follower, longer: float) -> object:
        """Go on to the point there; the next step may be so many times as long."""
        count = self.store.count
        step, cubic = self.stepper.step, self.stepper.predictor.cubic
        error = self.stepper.missed * step
        status = follower.smooth()
        if status is None and self.goes_round(count):
            return Status.STALLED
        if self.store.count > count:
            follower.aim(
                step * within(growth(self.options.error, error, cubic), self.options.shorter, longer), True
            )
            follower.aim(step * longer, False)
            self.repeated, self.past = 0, 0.0
        return status

    def goes_round(self, count: int) -> bool:
        """Whether a fold beyond the first so many points is an old one: a step has led to a closed curve."""
        if self.store.count < count + 2:  # nothing within the step
            return False
        kept = self.store.points()
        folds = np.flatnonzero(kept.mark & Mark.FOLD)
        new = folds[folds >= count]
        if not new.size:
            return False
        old = folds[folds < count - self.options.loop]
        away = (kept.z[old] - kept.z[new[-1]]) / np.asarray(self.stepper.newton.scale)
        return bool((np.abs(away).max(axis=1, initial=0.0) < self.options.same).any())

    def leave(self, follower: Follower, reach: float) -> object:
        """Leave a corner, a change of label this near; if nothing new leads on, look further beyond it."""
        stepper = self.stepper
        if self.repeated > self.options.looks:
            return Status.STALLED
        if self.repeated == 0:
            self.came = np.array(stepper.here.tangent)
            self.label = np.array(stepper.here.margin)
            self.came_so = self.store.tail()
        while self.repeated < self.options.looks:
            np.asarray(stepper.here.tangent)[:] = self.came
            stepper.predictor.straighten()
            self.store.drop()
            self.store.put(*self.came_so)
            past = max(self.switching.beyond, 3.0 * reach) * 10.0**self.repeated
            self.repeated += 1
            follower.leave(stepper.here, 0.0, past)
            new = np.array(stepper.here.tangent)
            stepper.problem.bound(np.asarray(stepper.here.z) + past * np.asarray(stepper.newton.scale) * new)
            cosine = float(new @ self.came)
            turned = cosine < self.options.straight
            if self.leads_on(cosine) and (turned or self.repeated == self.options.looks):
                self.past = past if turned else 0.0
                if cosine > self.options.back:  # it is found from here
                    np.asarray(stepper.aside)[:] = 0.0
                return None
        np.asarray(stepper.aside)[:] = 0.0
        return None if self.leave_corner(follower) else Status.STALLED

    def leads_on(self, cosine: float) -> bool:
        """Whether a direction at that angle to the old one is another, the problem being bound on the way."""
        new = not np.array_equal(np.asarray(self.stepper.problem.margin), self.label)
        return cosine > (self.options.spike if new else self.options.back)

    def leave_corner(self, follower: Follower) -> bool:
        """Whether the curve leaves a corner by any way that is tried around it: then it is left there."""
        stepper = self.stepper
        if self.repeated > self.options.looks:
            return False
        self.repeated += 1
        way = direction_beyond(stepper, self.came, self.leads_on)
        if way is None:
            return False
        np.asarray(stepper.here.tangent)[:] = way.direction
        np.asarray(stepper.here.margin)[:] = stepper.problem.margin
        stepper.predictor.straighten()
        np.asarray(stepper.aside)[:] = way.aside
        self.past = 0.0
        follower.aim(way.reach, True)
        return True


class DirectionBeyond(NamedTuple):
    """To a point of the curve that is about a reach from the corner."""

    reach: float
    direction: FloatArray  # (unknown + 1,) scaled, that of the piece in which it is
    aside: FloatArray  # (unknown + 1,) scaled, from where that direction leads to the point's guess


def direction_beyond(
    stepper: Stepper, came: FloatArray, leads_on: Callable[[float], bool]
) -> DirectionBeyond | None:
    """The first that is found from the corner that is here; None without any.

    Parameters
    ----------
    came : (unknown + 1,)
        Direction in which the curve came to the corner.
    leads_on : callable
        Whether a way at an angle of that cosine to it is another, the problem being bound there.
    """
    for reach in stepper.options.labels.reaches:
        for poll, aside in _guesses(stepper.options.labels, reach, came):
            direction = _direction(stepper, poll)
            if direction is not None and _found(
                stepper, came, DirectionBeyond(reach, direction, aside), leads_on
            ):
                return DirectionBeyond(reach, direction, aside)
    return None


def _guesses(
    options: LabelOptions, reach: float, came: FloatArray
) -> Iterator[tuple[FloatArray, FloatArray]]:
    """Where a direction is looked for, and from where it is taken, both from the corner."""
    for poll, aside in product(options.parts, options.parts):
        yield poll * reach * came, aside * reach * came
    around = np.random.default_rng(0).normal(size=(options.around, came.size))
    for way in around / np.linalg.norm(around, axis=1, keepdims=True):
        yield reach * way, np.zeros(came.size)


def _direction(stepper: Stepper, poll: FloatArray) -> FloatArray | None:
    """That which the equations have there, with the orientation of here."""
    newton = stepper.newton
    np.asarray(newton.row)[:] = poll / np.linalg.norm(poll)
    np.asarray(newton.z)[:] = np.asarray(stepper.here.z) + np.asarray(newton.scale) * poll
    if not newton.take_tangent():
        return None
    return np.array(newton.tangent) * (1.0 if newton.orientation == stepper.here.orientation else -1.0)


def _found(
    stepper: Stepper, came: FloatArray, way: DirectionBeyond, leads_on: Callable[[float], bool]
) -> bool:
    """Whether a way leads to a point at which the curve goes on from here; the problem is bound there."""
    newton, here, scale = stepper.newton, np.asarray(stepper.here.z), np.asarray(stepper.newton.scale)
    np.asarray(newton.row)[:] = way.direction
    np.asarray(newton.z)[:] = here + scale * (way.reach * way.direction + way.aside)
    if not newton.correct(2.0 * way.reach) or newton.orientation != stepper.here.orientation:
        return False
    step = (np.asarray(newton.z) - here) / scale
    length = float(np.linalg.norm(step))
    stepper.problem.bound(newton.z)
    forward = bool(np.asarray(newton.tangent) @ step > 0.5 * length)
    return forward and leads_on(float(came @ step) / length)
