"""Steps along a curve whose margins are labels, which do not tell how far away they change.

A label is what hybrid systems call the discrete state: the number of the regime in which a contact moves.

The step length follows from the scaled distance between prediction and curve; events smaller than that are
stepped over. A step is acceptable whatever its labels are. If even a short step is not acceptable, there is a
corner in it. The change of label is then bracketed until it is met, and the next step follows the tangent of
the equations beyond it.
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
    """Ratio of the next step to the last, so that the error of the prediction becomes the target error.

    The error grows as the third power of the step for the parabola, as the fourth for the cubic.
    """
    ratio = options.target_error / max(error, options.min_error)
    return float(options.safety * ratio ** (1.0 / 4.0 if cubic else 1.0 / 3.0))


def clipped(value: float, low: float, high: float) -> float:
    """The value, limited to the interval from low to high."""
    return min(max(value, low), high)


class LabelledSwitching:
    """Step control of a curve with labels: it chooses steps and leaves corners.

    It counts the attempts to leave a corner.
    """

    def __init__(self, stepper: Stepper, store: PointStore) -> None:
        self.stepper, self.store, self.options = stepper, store, stepper.options.labels
        self.control, self.switching = stepper.options.step, stepper.options.switching
        self.departures = 0  # attempts to leave the present corner
        self.departure = 0.0  # length beyond the corner at which the direction was found
        self.incoming: FloatArray = np.zeros(0)  # direction in which the curve came to the corner
        self.incoming_label: FloatArray = np.zeros(0)  # labels before the corner

    def advance(self, follower: Follower, step: float) -> object:
        """Take one step along the curve; return a status if the curve ends, else None.

        Close to a change of label the curve may not be found.
        """
        stepper = self.stepper
        # the step that led to a corner may have been shorter
        step = asked = max(
            step, self.control.step_after_corner, self.options.departure_factor * self.departure
        )
        # a step that ends before that length is still in the corner
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
        """Whether the step is good and does not go back; no margin distinguishes a reversal from a corner."""
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
        """Whether a short step went no further aside than its turn explains, and so not to another branch."""
        return bool(
            np.linalg.norm(self.step_vector()) * self.stepper.cosine
            < self.options.max_length_ratio * self.stepper.step
        )

    def turned_at_corner(self) -> bool:
        """Whether the step turned at a corner ahead that is no fold, and continued in the new direction."""
        way, here, there = self.step_vector(), self.stepper.here, np.asarray(self.stepper.there.tangent)
        straight = way @ there > self.options.straight_cosine * np.linalg.norm(way)
        return bool(here.tangent[-1] * there[-1] > 0.0 and straight)

    def step_vector(self) -> FloatArray:
        """The step from here to there in scaled coordinates."""
        return np.array((np.array(self.stepper.there.z) - self.stepper.here.z) / self.stepper.newton.scale)

    def goes_straight(self) -> bool:
        """Whether a step went straight on: its turn and its miss are within `straight_cosine`."""
        allowed_miss = (
            2.0 * (1.0 - self.options.straight_cosine)
        ) ** 0.5  # miss of a step that turns by that angle
        return self.stepper.cosine > self.options.straight_cosine and self.stepper.miss < allowed_miss

    def hides_fold_pair(self) -> bool:
        """Whether the parameter changed against its direction at both ends: two folds lie between."""
        here, there = self.stepper.here, self.stepper.there
        went = there.z[-1] - here.z[-1]
        return bool(went * here.tangent[-1] < 0.0 and went * there.tangent[-1] < 0.0)

    def misses_parameter(self) -> bool:
        """Whether the error of the predicted parameter is too large for its change along the step."""
        rise = max(abs(self.stepper.here.tangent[-1]), abs(self.stepper.there.tangent[-1]))
        return bool(self.stepper.parameter_miss > self.options.max_parameter_miss * rise)

    def accept_step(self, follower: Follower, longer: float) -> object:
        """Go to the end of the step; the next one may be longer by at most the factor `longer`."""
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
        """Whether a fold after the first `count` points is an old one: a step went to a closed curve."""
        if self.store.count < count + 2:  # no event within the step
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
        """Leave a corner close ahead, a change of label; look ever further beyond for a new direction."""
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
                if cosine > self.options.reversal_cosine:  # the next point is then predicted from here
                    np.asarray(stepper.offset)[:] = 0.0
                return None
        np.asarray(stepper.offset)[:] = 0.0
        return None if self.search_around(follower) else Status.STALLED

    def is_new_direction(self, cosine: float) -> bool:
        """Whether a direction with that cosine to the incoming one is new, by the margins evaluated last."""
        new = not np.array_equal(np.asarray(self.stepper.problem.margin), self.incoming_label)
        return cosine > (self.options.spike_cosine if new else self.options.reversal_cosine)

    def search_around(self, follower: Follower) -> bool:
        """Leave the corner by any way found around it; return whether there is one."""
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
    """A way from a corner to a point of the curve at about a given length from it."""

    length: float
    direction: FloatArray  # (unknown + 1,) scaled tangent in the smooth piece of the point
    offset: FloatArray  # (unknown + 1,) scaled, from the corner to where the direction begins


def direction_beyond(
    stepper: Stepper, incoming: FloatArray, is_new_direction: Callable[[float], bool]
) -> DirectionBeyond | None:
    """The first way that leads on from the corner at `here`; None if there is none.

    Parameters
    ----------
    incoming : (unknown + 1,)
        Direction in which the curve came to the corner.
    is_new_direction : callable
        Whether a direction with that cosine to the incoming one is new; uses the margins evaluated last.
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
    """Offsets from a corner: where the tangent is computed, and from where it is followed to a guess."""
    for probe, offset in product(options.departure_fractions, options.departure_fractions):
        yield probe * length * incoming, offset * length * incoming
    around = np.random.default_rng(0).normal(size=(options.random_directions, incoming.size))
    for direction in around / np.linalg.norm(around, axis=1, keepdims=True):
        yield length * direction, np.zeros(incoming.size)


def _direction(stepper: Stepper, probe: FloatArray) -> FloatArray | None:
    """The tangent at an offset from the corner, with the orientation of here; None if it is undetermined."""
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
    """Whether a way leads to a point from which the curve continues; evaluates the margins there."""
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
