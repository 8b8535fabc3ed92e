"""Steps along a curve whose margins are labels, which tell no distance to their change.

A label is what hybrid systems call the discrete state: the number of the regime in which a contact moves.

The length of a step is chosen by how far from its prediction the curve is, in the curve's own size: what is
smaller than that is passed. A step that is good has no corner in it, whatever its labels are. One that is
short and still not good has. Then the change of label is approached until it is met. The next step follows
the tangent of the equations beyond it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from itertools import product
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from fcm.continuation.options import LabelOptions
from fcm.continuation.path import FloatArray, Mark, Status
from fcm.continuation.problem import PointStore
from fcm.continuation.step_control import Stepper, next_corner

if TYPE_CHECKING:
    from fcm.continuation.follow import Follower


def step_factor(options: LabelOptions, error: float, cubic: bool) -> float:
    """Ratio of the next step to one whose prediction missed the curve by an error, for the miss aimed at.

    The prediction is a parabola, and what it misses grows as the third power; or a cubic: as the fourth.
    """
    ratio = options.target_error / max(error, options.min_error)
    return float(options.safety * ratio ** (1.0 / 4.0 if cubic else 1.0 / 3.0))


def clipped(value: float, low: float, high: float) -> float:
    """The value, or the nearest limit if it lies outside of both."""
    return min(max(value, low), high)


class LabelledSwitching:
    """Steps of a curve with labels: how they are chosen, and how corners are left.

    It counts how often a corner has been tried that is not left yet.
    """

    def __init__(self, stepper: Stepper, store: PointStore) -> None:
        self.stepper, self.store, self.options = stepper, store, stepper.options.labels
        self.control, self.switching = stepper.options.step, stepper.options.switching
        self.departures = 0  # corners at one point
        self.departure = 0.0  # length beyond the last of them at which the direction was found
        self.incoming: FloatArray = np.zeros(0)  # direction in which the curve came there,
        self.incoming_label: FloatArray = np.zeros(0)  # and its labels before

    def advance(self, follower: Follower, step: float) -> object:
        """Take one step along the curve; a status where the curve ends, else None.

        Close to a change of label there may be no curve to be found.
        """
        stepper = self.stepper
        # what led to a corner may have been shorter
        step = asked = max(
            step, self.control.step_after_corner, self.options.departure_factor * self.departure
        )
        # a step that ends short of there is in the corner yet
        while step > max(self.control.min_step, self.departure):
            if stepper.try_step(step) and self.acceptable(follower):
                at = follower.fold_pair() if step > self.control.any_turn_step else 0.0
                if at == 0.0:
                    return self.accept_step(
                        follower,
                        self.options.max_factor_after_rejection if step < asked else self.options.max_factor,
                    )
                step = at
                continue
            if step > self.control.any_turn_step:
                shorter = step_factor(self.options, stepper.newton.moved, stepper.predictor.cubic)
                step = max(
                    self.control.any_turn_step, step * clipped(shorter, *self.options.rejection_factors)
                )
                continue
            corner = next_corner(stepper, step)
            if corner < min(step, max(self.switching.reached_distance, self.departure)):
                return self.search_beyond(follower, min(corner, self.switching.reached_distance))
            if (
                corner < step
                and stepper.try_step(corner * (1.0 - self.options.margin_fraction))
                and self.acceptable(follower)
            ):
                status = self.accept_step(follower, self.options.max_factor)
                follower.limit_step(self.control.any_turn_step, False)
                return status
            step = self.options.retreat * min(step, corner)
        return self.search_beyond(
            follower, 0.0 if self.departure else next_corner(stepper, self.options.reached_distance)
        )

    def acceptable(self, follower: Follower) -> bool:
        """Whether the step is good, and does not go back: no margin tells a reversal from a corner."""
        stepper = self.stepper
        same = stepper.there.orientation == stepper.here.orientation
        near = stepper.miss * stepper.step < self.options.max_error_ratio * self.options.target_error
        if stepper.step <= self.control.any_turn_step:
            passes = same or (
                self.goes_straight() and np.array_equal(stepper.there.margin, stepper.here.margin)
            )
            return (
                passes
                and (near or self.turned_at_corner())
                and self.stays_on_branch()
                and follower.acceptable()
            )
        if self.hides_fold_pair() or self.misses_parameter():
            return False
        gently = stepper.miss < self.options.max_miss and stepper.cosine > self.options.min_cosine
        return follower.acceptable() or (same and near and gently)

    def stays_on_branch(self) -> bool:
        """Whether a short step led no further aside than its turn explains, and so not to another branch."""
        return bool(
            np.linalg.norm(self.step_vector()) * self.stepper.cosine
            < self.options.max_length_ratio * self.stepper.step
        )

    def turned_at_corner(self) -> bool:
        """Whether the step turned at a corner ahead, which is no fold, and went in the new direction."""
        way, here, there = self.step_vector(), self.stepper.here, np.asarray(self.stepper.there.tangent)
        straight = way @ there > self.options.straight_cosine * np.linalg.norm(way)
        return bool(here.tangent[-1] * there[-1] > 0.0 and straight)

    def step_vector(self) -> FloatArray:
        """The step from here to there in the size of the curve itself."""
        return np.array((np.array(self.stepper.there.z) - self.stepper.here.z) / self.stepper.newton.scale)

    def goes_straight(self) -> bool:
        """Whether a step went straight on; what it misses by more than the turn explains is beside it."""
        allowed_miss = (
            2.0 * (1.0 - self.options.straight_cosine)
        ) ** 0.5  # by which a step that turns as much misses it
        return self.stepper.cosine > self.options.straight_cosine and self.stepper.miss < allowed_miss

    def hides_fold_pair(self) -> bool:
        """Whether the parameter went against the direction at both ends: there are two folds between."""
        here, there = self.stepper.here, self.stepper.there
        went = there.z[-1] - here.z[-1]
        return bool(went * here.tangent[-1] < 0.0 and went * there.tangent[-1] < 0.0)

    def misses_parameter(self) -> bool:
        """Whether the parameter was missed by much of what it changes along the step."""
        rise = max(abs(self.stepper.here.tangent[-1]), abs(self.stepper.there.tangent[-1]))
        return bool(self.stepper.parameter_miss > self.options.max_parameter_miss * rise)

    def accept_step(self, follower: Follower, longer: float) -> object:
        """Go on to the point there; the next step may be so many times as long."""
        count = self.store.count
        step, cubic = self.stepper.step, self.stepper.predictor.cubic
        error = self.stepper.miss * step
        status = follower.accept_step()
        if status is None and self.repeats_fold(count):
            return Status.STALLED
        if self.store.count > count:
            follower.limit_step(
                step * clipped(step_factor(self.options, error, cubic), self.options.min_factor, longer), True
            )
            follower.limit_step(step * longer, False)
            self.departures, self.departure = 0, 0.0
        return status

    def repeats_fold(self, count: int) -> bool:
        """Whether a fold beyond the first so many points is an old one: a step has led to a closed curve."""
        if self.store.count < count + 2:  # nothing within the step
            return False
        kept = self.store.points()
        folds = np.flatnonzero(kept.mark & Mark.FOLD)
        new = folds[folds >= count]
        if not new.size:
            return False
        old = folds[folds < count - self.options.min_loop_points]
        away = (kept.z[old] - kept.z[new[-1]]) / np.asarray(self.stepper.newton.scale)
        return bool((np.abs(away).max(axis=1, initial=0.0) < self.options.fold_tolerance).any())

    def search_beyond(self, follower: Follower, corner: float) -> object:
        """Leave a corner, a change of label this near; if nothing new leads on, look further beyond it."""
        stepper = self.stepper
        if self.departures > self.options.max_departures:
            return Status.STALLED
        if self.departures == 0:
            self.incoming = np.array(stepper.here.tangent)
            self.incoming_label = np.array(stepper.here.margin)
            self.incoming_point = self.store.tail()
        while self.departures < self.options.max_departures:
            np.asarray(stepper.here.tangent)[:] = self.incoming
            stepper.predictor.reset()
            self.store.drop()
            self.store.put(*self.incoming_point)
            past = max(self.switching.departure_length, 3.0 * corner) * 10.0**self.departures
            self.departures += 1
            follower.leave_corner(stepper.here, 0.0, past)
            new = np.array(stepper.here.tangent)
            stepper.problem.evaluate_margins(
                np.asarray(stepper.here.z) + past * np.asarray(stepper.newton.scale) * new
            )
            cosine = float(new @ self.incoming)
            turned = cosine < self.options.straight_cosine
            if self.is_new_direction(cosine) and (turned or self.departures == self.options.max_departures):
                self.departure = past if turned else 0.0
                if cosine > self.options.reversal_cosine:  # it is found from here
                    np.asarray(stepper.offset)[:] = 0.0
                return None
        np.asarray(stepper.offset)[:] = 0.0
        return None if self.search_around(follower) else Status.STALLED

    def is_new_direction(self, cosine: float) -> bool:
        """Whether a direction at that angle to the old one is another, the problem being bound on the way."""
        new = not np.array_equal(np.asarray(self.stepper.problem.margin), self.incoming_label)
        return cosine > (self.options.spike_cosine if new else self.options.reversal_cosine)

    def search_around(self, follower: Follower) -> bool:
        """Whether the curve leaves a corner by any way that is tried around it: then it is left there."""
        stepper = self.stepper
        if self.departures > self.options.max_departures:
            return False
        self.departures += 1
        way = direction_beyond(stepper, self.incoming, self.is_new_direction)
        if way is None:
            return False
        np.asarray(stepper.here.tangent)[:] = way.direction
        np.asarray(stepper.here.margin)[:] = stepper.problem.margin
        stepper.predictor.reset()
        np.asarray(stepper.offset)[:] = way.offset
        self.departure = 0.0
        follower.limit_step(way.length, True)
        return True


class DirectionBeyond(NamedTuple):
    """A way from a corner to a point of the curve at about a length from it."""

    length: float
    direction: FloatArray  # (unknown + 1,) scaled, that of the piece in which it is
    offset: FloatArray  # (unknown + 1,) scaled, from where that direction leads to the point's guess


def direction_beyond(
    stepper: Stepper, incoming: FloatArray, is_new_direction: Callable[[float], bool]
) -> DirectionBeyond | None:
    """The first way on that is found from the corner at `here`; None without any.

    Parameters
    ----------
    incoming : (unknown + 1,)
        Direction in which the curve came to the corner.
    is_new_direction : callable
        Whether a direction at an angle of that cosine to it is another; the problem is bound there.
    """
    for length in stepper.options.labels.departure_lengths:
        for probe, offset in _guesses(stepper.options.labels, length, incoming):
            direction = _direction(stepper, probe)
            if direction is not None and _found(
                stepper, incoming, DirectionBeyond(length, direction, offset), is_new_direction
            ):
                return DirectionBeyond(length, direction, offset)
    return None


def _guesses(
    options: LabelOptions, length: float, incoming: FloatArray
) -> Iterator[tuple[FloatArray, FloatArray]]:
    """Places near a corner, relative to it: where a tangent is taken, and where that leads from."""
    for probe, offset in product(options.departure_fractions, options.departure_fractions):
        yield probe * length * incoming, offset * length * incoming
    around = np.random.default_rng(0).normal(size=(options.random_directions, incoming.size))
    for direction in around / np.linalg.norm(around, axis=1, keepdims=True):
        yield length * direction, np.zeros(incoming.size)


def _direction(stepper: Stepper, probe: FloatArray) -> FloatArray | None:
    """The tangent of the equations at a place near the corner, with the orientation of here."""
    newton = stepper.newton
    np.asarray(newton.row)[:] = probe / np.linalg.norm(probe)
    np.asarray(newton.z)[:] = np.asarray(stepper.here.z) + np.asarray(newton.scale) * probe
    if not newton.take_tangent():
        return None
    return np.array(newton.tangent) * (1.0 if newton.orientation == stepper.here.orientation else -1.0)


def _found(
    stepper: Stepper,
    incoming: FloatArray,
    departure: DirectionBeyond,
    is_new_direction: Callable[[float], bool],
) -> bool:
    """Whether a way leads to a point at which the curve goes on from here; the problem is bound there."""
    newton, here, scale = stepper.newton, np.asarray(stepper.here.z), np.asarray(stepper.newton.scale)
    np.asarray(newton.row)[:] = departure.direction
    np.asarray(newton.z)[:] = here + scale * (departure.length * departure.direction + departure.offset)
    if not newton.correct(2.0 * departure.length) or newton.orientation != stepper.here.orientation:
        return False
    step = (np.asarray(newton.z) - here) / scale
    length = float(np.linalg.norm(step))
    stepper.problem.evaluate_margins(newton.z)
    least = stepper.options.labels.min_way_cosine * length
    forward = bool(np.asarray(newton.tangent) @ step > least)
    return forward and is_new_direction(float(incoming @ step) / length)
