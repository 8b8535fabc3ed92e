"""Record the points of a curve within the range of its parameter, and how it ends.

A corner is where a margin changes sign. It is located within a step, kept, and left along the tangent beyond
it. A piecewise smooth curve keeps its orientation across corners (Allgower and Georg, "Introduction to
Numerical Continuation Methods", SIAM 2003, on piecewise linear and piecewise smooth maps).
"""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import cython
import numpy as np
from cython.cimports.libc.math import sqrt

from fcm.continuation import events
from fcm.continuation.checkpoint import Checkpoint
from fcm.continuation.events import Events
from fcm.continuation.path import Mark, Path, Status
from fcm.continuation.problem import Point, PointStore
from fcm.continuation.root_corner import find_beyond
from fcm.continuation.step_control import Stepper

if cython.compiled:
    from cython.cimports.fcm.continuation.events import closes_curve, without_events
    from cython.cimports.fcm.continuation.step_control import acceptable, keeps_orientation
else:
    from fcm.continuation.events import closes_curve, without_events
    from fcm.continuation.step_control import acceptable, keeps_orientation


END = cython.declare(cython.long, int(Mark.END))
CORNER = cython.declare(cython.long, int(Mark.CORNER))
USER_POINT = cython.declare(cython.long, int(Mark.USER_POINT))


FOLD = cython.declare(cython.long, int(Mark.FOLD))
PEAK = cython.declare(cython.long, int(Mark.PEAK))


@cython.cclass
class Recorder:
    """Keeps points in `store`; `first` is the start of the curve, `initial_direction` its tangent there.

    `values` (as an array `stops`): parameters at which the curve has points, user values and the ends of the
    range. `greatest` (also `most`): the greatest of each output so far.
    """

    def __init__(self, stepper: Stepper, span: tuple[float, float], wanted: Events) -> None:
        self.stepper, self.n = stepper, stepper.problem.unknowns
        self.low, self.high = span
        self.values = [
            *(value for value in wanted.values if self.low < value < self.high),
            self.low,
            self.high,
        ]
        self.stops, self.store = np.array(self.values), PointStore(self.n + 1)
        self.greatest = np.zeros(stepper.problem.outputs)
        self.most, self.first, self.initial_direction = (
            self.greatest,
            np.zeros(self.n + 1),
            np.zeros(self.n + 1),
        )
        self.far = stepper.options.events.far_tolerance  # relative distance of points elsewhere
        self.interior = self.came_around = self.stopped = False
        self.last, self.ended_by = wanted.last, -1
        self.same = (
            stepper.options.events.point_tolerance
        )  # points closer than this, relative to the greatest unknown, are one

    def start(self, parameter: float) -> None:
        """Begin at the point of the stepper, whose parameter is set to a value."""
        here: Point = self.stepper.here
        here.z[self.n] = parameter
        self.interior = self.low < parameter < self.high
        self.first, self.initial_direction = np.array(here.z), np.array(here.tangent)
        self.store.add(here, self.stepper.newton.scale, 0 if self.interior else END)

    def restore(self, checkpoint: Checkpoint) -> None:
        """Replace the points by those of a checkpoint."""
        self.store.restore(checkpoint.kept)
        self.interior, self.greatest[:] = checkpoint.interior, checkpoint.greatest
        self.first, self.initial_direction = checkpoint.first.copy(), checkpoint.initial_direction.copy()

    def state(self) -> dict[str, Any]:
        """The part of a checkpoint that comes from the recorder."""
        return {
            "kept": self.store.state(),
            "greatest": self.greatest.copy(),
            "first": np.array(self.first),
            "initial_direction": np.array(self.initial_direction),
            "interior": bool(self.interior),
        }

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def keep_events(self, limit: cython.double) -> cython.bint:
        """Keep the events of the step up to a limit; true if the curve ends at one of them.

        It ends at an end of its range, at an event of `Events.last`, or where it comes around to an earlier
        point."""
        if without_events(self.stepper, self.stops, self.most):
            return False
        for event in events.events_within(self.stepper, limit, self.values, self.greatest):
            mark: cython.long = event.mark
            ends: cython.bint = mark & USER_POINT and event.z[self.n] in (self.low, self.high)
            mark = END if ends else mark
            self.store.put(event.z, event.direction, mark, event.orientation)
            if mark & USER_POINT and self.revisits_user_point():
                self.came_around = True
            self.stopped = self.stopped or bool(mark & self.last)
            if ends or self.came_around or self.stopped:
                return True
        return False

    def stop_at(self, length: float, number: int) -> Status:
        """Keep the events and the point at a length of the step, where the end function `number` is 0."""
        stepper = self.stepper
        if self.keep_events(length):
            return self.end_status()
        far = length > stepper.options.step.min_step
        if far and stepper.find_between(length, False, False) and stepper.sharpen(False, False):
            self.store.add(stepper.between, stepper.newton.scale, 0)
        self.stopped, self.ended_by = True, number
        return Status.EVENT

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def revisits_user_point(self) -> cython.bint:
        """Whether the last point, a user point, is an earlier user point or the start, in the same direction.

        There has to be a fold between the visits, and a point elsewhere. Otherwise two successive steps may
        have kept the same point, or the curve may have turned twice next to it.
        """
        store: PointStore = self.store
        n: cython.Py_ssize_t = self.n
        last: cython.Py_ssize_t = store.count - 1
        fold: cython.Py_ssize_t = last - 1  # the last point before it with the opposite direction
        elsewhere: cython.bint = False
        i: cython.Py_ssize_t
        rise: cython.double = store.direction[last, n]
        while fold >= 0 and store.direction[fold, n] * rise > 0.0:
            fold -= 1
        for i in range(last - 1, -1, -1):
            if not elsewhere:
                elsewhere = not store.same(i, last, self.far)
                continue
            stopped: cython.bint = i == 0 or store.mark[i] & USER_POINT
            again: cython.bint = i < fold and stopped and store.z[i, n] == store.z[last, n]
            if again and store.direction[i, n] * rise > 0.0 and store.same(i, last, self.same):
                return True
        return False

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def revisits_corner(self) -> cython.bint:
        """Whether the last point is an earlier corner in the same direction: the curve comes around.

        The curve has to have been elsewhere in between; or it comes to the identical point again from another
        corner, however near that one is.
        """
        store: PointStore = self.store
        repeated: cython.double = self.stepper.options.events.repeat_tolerance
        i: cython.Py_ssize_t
        last: cython.Py_ssize_t = store.count - 1
        elsewhere: cython.bint = False
        turned: cython.bint = False
        for i in range(last - 1, -1, -1):
            if not elsewhere:
                elsewhere = not store.same(i, last, self.far)
            if not store.mark[i] & CORNER:
                continue
            again: cython.bint = store.same(i, last, self.same if elsewhere else repeated)
            again = again and self.along(i, last)  # otherwise the curve crosses itself there
            if again and (elsewhere or turned):
                return True
            turned = turned or not again
        return False

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def along(self, i: cython.Py_ssize_t, k: cython.Py_ssize_t) -> cython.bint:
        """Whether the curve has the same direction at two points of the store."""
        j: cython.Py_ssize_t
        both: cython.double = 0.0
        one: cython.double = 0.0
        other: cython.double = 0.0
        direction: cython.double[:, ::1] = self.store.direction
        for j in range(self.n + 1):
            both += direction[i, j] * direction[k, j]
            one += direction[i, j] * direction[i, j]
            other += direction[k, j] * direction[k, j]
        return both > self.stepper.options.events.around_cosine * sqrt(one * other)

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def add(self, mark: cython.long) -> cython.int:
        """Keep the end of the step, `there`, with a mark."""
        return self.store.add(self.stepper.there, self.stepper.newton.scale, mark)

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def add_corner(self, point: Point) -> cython.int:
        """Keep a point as a corner; if it is the last point already, only mark it."""
        mark: cython.long = CORNER
        if self.store.ends_at(point):
            mark |= self.store.drop()
        return self.store.add(point, self.stepper.newton.scale, mark)

    @cython.cfunc
    @cython.exceptval(check=False)
    def update_greatest(self) -> cython.void:
        """Update the greatest outputs so far, each at least at the rounding of the greatest of all.

        On a plane of symmetry an output is 0 but for rounding, which oscillates.
        """
        k: cython.Py_ssize_t
        least: cython.double = 0.0
        for k in range(self.most.shape[0]):
            least = max(least, self.stepper.here.output[k])
        least *= self.stepper.options.events.peak_tolerance
        for k in range(self.most.shape[0]):
            self.most[k] = max(self.most[k], max(self.stepper.here.output[k], least))

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def closed(self) -> cython.bint:
        """Whether the step returns to the start of the curve, which is then closed."""
        if self.store.count < 2 or not self.interior:  # the first step begins there
            return False
        if not closes_curve(self.stepper, self.first, self.initial_direction):
            return False
        self.store.close()
        return True

    @cython.cfunc
    @cython.exceptval(check=False)
    def inside(self) -> cython.bint:
        """Whether `there` is in the range."""
        return self.low <= self.stepper.there.z[self.n] <= self.high

    def covered(self) -> float:
        """Distance of here from the start, as a fraction of the range."""
        return float(abs(self.stepper.here.z[self.n] - self.first[self.n]) / (self.high - self.low))

    def end_status(self) -> Status:
        """The status of a curve that has left its range, was stopped, or comes around."""
        if self.stopped:
            return Status.EVENT
        if self.came_around and self.interior and self.store.same(0, self.store.count - 1, self.same):
            self.store.drop()
            self.store.close()
            return Status.CLOSED
        if self.came_around:
            return Status.AROUND
        back = not self.interior and self.store.last()[self.n] == self.first[self.n]
        return Status.RETURNED if back else Status.COMPLETE

    def path(self, status: Status) -> Path:
        """The points kept so far, as a `Path` with the given status."""
        path = self.store.path(status, self.stepper.newton.evaluations)
        return replace(path, ended_by=self.ended_by) if self.ended_by >= 0 else path


def step_back(stepper: Stepper, store: PointStore, points: int) -> bool:
    """Go back to the last unmarked point that is at least `points` back; return whether there is one."""
    kept = store.points()
    plain = np.flatnonzero(kept.mark[: max(store.count - points, 0)] == 0)
    if not plain.size:
        return False
    i = int(plain[-1])
    stepper.problem.evaluate_scale(kept.z[i])
    row = kept.direction[i] / np.asarray(stepper.problem.scale)
    if not stepper.begin(kept.z[i], row / np.linalg.norm(row)):
        return False
    if stepper.here.orientation != kept.orientation[i]:
        return False
    store.cut(i + 1)
    return True


@cython.cfunc
@cython.exceptval(-1, check=True)
def before_corner(stepper: Stepper) -> cython.double:
    """Length to the first corner of the step, which is shortened to end just before it; negative if it fails.

    It fails if the curve is not found up to there, or not where it was predicted.
    """
    if not keeps_orientation(stepper):  # `there` is on another part of a curve that goes back in the corner
        return -1.0
    at: cython.double = events.first_margin(stepper)
    if at < 0.0 or not stepper.shorten((1.0 - stepper.options.switching.smooth_fraction) * at):
        return -1.0
    if not keeps_orientation(stepper) or not acceptable(stepper):
        return -1.0
    return at


@cython.cclass
class NonsmoothPoints:
    """Passes the corners of a recorder's curve; `labelled`: whether changes of label show them."""

    def __init__(self, recorder: Recorder, labelled: bool) -> None:
        self.recorder, self.labelled = recorder, labelled
        self.growth_before = np.zeros(recorder.stepper.problem.outputs)  # growth before a corner

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def pass_corner(self, point: Point, length: cython.double, past: cython.double) -> cython.bint:
        """Keep the corner, a point at a length from here, and turn beyond it; return whether the curve ends.

        past: the length beyond a change of label at which the new direction is computed.
        """
        recorder: Recorder = self.recorder
        stepper: Stepper = recorder.stepper
        recorder.add_corner(point)
        before: Point = stepper.here if point is stepper.here else stepper.there
        beyond: cython.double = 0.0
        if point is not stepper.here:
            go_to_corner(stepper, point, length)
        rise: cython.double = stepper.here.tangent[recorder.n]
        self.growth_before[:] = stepper.here.growth
        if self.labelled:
            cross_label(stepper, past)
        else:
            beyond = find_beyond(stepper, before) if stepper.problem.has_root_margins else 0.0
            if beyond > 0.0:
                turn_beyond(stepper, beyond)
            else:
                cross_corner(stepper, recorder.stops)
        fold: cython.long = FOLD if rise * stepper.here.tangent[recorder.n] < 0.0 else 0
        recorder.store.mark_last(fold | (PEAK if self.is_peak() else 0))
        recorder.update_greatest()
        if not beyond > 0.0:
            return False
        ends: cython.bint = recorder.keep_events(beyond)
        stepper.accept(stepper.there, 0.0)
        return ends

    @cython.cfunc
    @cython.exceptval(check=False)
    def is_peak(self) -> cython.bint:
        """Whether an output grew before the corner at here, and falls beyond it."""
        k: cython.Py_ssize_t
        growth: cython.double[::1] = self.recorder.stepper.here.growth
        for k in range(self.growth_before.shape[0]):
            if self.growth_before[k] > 0.0 and growth[k] < 0.0:
                return True
        return False


@cython.ccall
@cython.exceptval(-1, check=False)
def go_to_corner(stepper: Stepper, point: Point, at: cython.double) -> cython.int:
    """Go to a corner, a point at a length from here, keeping the tangent and growth before it."""
    point.tangent[:] = stepper.there.tangent  # those before the corner, whichever side the point lies on
    point.growth[:] = stepper.there.growth
    point.orientation = stepper.there.orientation
    stepper.accept(point, at)
    return 0


@cython.cfunc
@cython.exceptval(-1, check=False)
def turn_beyond(stepper: Stepper, length: cython.double) -> cython.int:
    """Make the corrector's point, a length beyond the corner at here, the end of a step with its tangent."""
    there: Point = stepper.there
    stepper.record(there, True, True)
    there.differentiate_margins(stepper.problem, stepper.newton.scale, stepper.guess)
    stepper.step, stepper.cosine = length, 1.0
    stepper.here.tangent[:] = there.tangent
    stepper.here.growth[:] = there.growth
    return 0


@cython.ccall
@cython.exceptval(-1, check=False)
def cross_corner(stepper: Stepper, stops: cython.double[::1]) -> cython.bint:
    """Continue from a corner at here to the nearest point found beyond it; return whether that succeeds.

    Several margins may vanish here or very near, so that more than two smooth pieces meet. All corners nearer
    than the point found count as one, as does a corner met immediately beyond it. If no point is found, or a
    value of the parameter lies on the way, only the new direction is taken and here remains.
    """
    count: cython.int
    length: cython.double = stepper.options.switching.departure_length
    first: cython.double = 0.0  # the nearest length with a point, though another corner follows at once
    for count in range(stepper.options.switching.departure_tries):  # noqa: B007
        if point_beyond(stepper, length):
            if not stepper.problem.has_root_margins or without_sign_change(stepper, 10.0 * length):
                accept_beyond(stepper, length, not passes_user_point(stepper, stops))
                return True
            first = first or length
        length *= 10.0
    if first > 0.0 and point_beyond(stepper, first):
        accept_beyond(stepper, first, not passes_user_point(stepper, stops))
        return True
    predict_past_label(stepper, stepper.options.switching.departure_length)
    if not predict_beyond(stepper, stepper.options.switching.departure_length):
        return False
    accept_beyond(stepper, stepper.options.switching.departure_length, False)
    return True


@cython.cfunc
@cython.exceptval(-1, check=False)
def point_beyond(stepper: Stepper, length: cython.double) -> cython.bint:
    """Whether the corrector finds a point of the curve at a length past the corner at here.

    The direction is that of the piece into which the curve comes, then that of the piece into which this
    direction leads, and so on. A point beyond the corner has the orientation of here; a point on the way to
    the corner has the opposite one.
    """
    count: cython.int
    predict_past_label(stepper, length)
    for count in range(stepper.options.switching.max_pieces):  # noqa: B007
        if not predict_beyond(stepper, length):
            return False
        stepper.between.z[:] = stepper.newton.z
        if stepper.newton.correct(length) and close_to_prediction(stepper, length):
            return True
        # whole steps may have led to another part of the curve
        if (
            stepper.problem.has_root_margins
            and stepper.newton.correct_by_half_steps(length)
            and close_to_prediction(stepper, length)
        ):
            return True
        stepper.newton.z[:] = stepper.between.z
        # along the edge of a piece, as where a circle stops slipping, only a Newton step leads across the
        # edge
        if stepper.problem.has_root_margins and not stepper.newton.single_step():
            return False
    return False


@cython.cfunc
@cython.exceptval(check=False)
def close_to_prediction(stepper: Stepper, length: cython.double) -> cython.bint:
    """Whether the corrector's point is near its prediction and has the orientation of here."""
    if not stepper.newton.moved < stepper.options.switching.max_deviation * length:
        return False
    return stepper.newton.orientation == stepper.here.orientation


@cython.cfunc
@cython.exceptval(-1, check=False)
def without_sign_change(stepper: Stepper, length: cython.double) -> cython.bint:
    """Whether no margin changes sign within a length from the corrector's point.

    A circle that starts to slip leaves its limit as the square of the length. So rounding may put the point
    found first on the side from which the curve comes.
    """
    i: cython.Py_ssize_t
    k: cython.Py_ssize_t
    there: Point = stepper.between
    stepper.record(there, True, False)
    for i in range(stepper.guess.shape[0]):
        stepper.guess[i] = there.z[i] + length * stepper.newton.scale[i] * there.tangent[i]
    stepper.problem.evaluate_margins(stepper.guess)
    for k in range(stepper.problem.margins):
        if there.margin[k] * there.margin_of_problem(k, stepper.problem) < 0.0:
            return False
    return True


@cython.cfunc
@cython.exceptval(-1, check=False)
def predict_beyond(stepper: Stepper, length: cython.double) -> cython.bint:
    """Put the corrector at a length along the tangent of the piece where it is now; whether there is one.

    The tangent has the orientation of here, which is the same in all pieces of a piecewise smooth curve.
    """
    i: cython.Py_ssize_t
    if not stepper.newton.take_tangent():
        return False
    sign: cython.double = 1.0 if stepper.newton.orientation == stepper.here.orientation else -1.0
    for i in range(stepper.here.z.shape[0]):
        stepper.newton.tangent[i] *= sign
    stepper.newton.orientation = stepper.here.orientation
    stepper.newton.row[:] = stepper.newton.tangent
    for i in range(stepper.here.z.shape[0]):
        stepper.newton.z[i] = stepper.here.z[i] + length * stepper.newton.scale[i] * stepper.newton.row[i]
    return True


@cython.cfunc
@cython.exceptval(check=False)
def passes_user_point(stepper: Stepper, stops: cython.double[::1]) -> cython.bint:
    """Whether a value of the parameter lies between here and the corrector's point."""
    n: cython.Py_ssize_t = stepper.here.z.shape[0] - 1
    k: cython.Py_ssize_t
    for k in range(stops.shape[0]):
        if (stops[k] - stepper.here.z[n]) * (stops[k] - stepper.newton.z[n]) <= 0.0:
            return True
    return False


@cython.cfunc
@cython.exceptval(-1, check=False)
def accept_beyond(stepper: Stepper, length: cython.double, go: cython.bint) -> cython.int:
    """Go to the corrector's point, a length from here, or (go false) take only its tangent and margins."""
    there: Point = stepper.between
    stepper.record(there, True, True)
    there.differentiate_margins(stepper.problem, stepper.newton.scale, stepper.guess)
    if not go:
        there.z[:] = stepper.here.z
        there.output[:] = stepper.here.output
    stepper.accept(there, 0.0)
    stepper.known_length = 0.0 if go else length
    return 0


@cython.ccall
@cython.exceptval(-1, check=False)
def cross_label(stepper: Stepper, past: cython.double) -> cython.bint:
    """Turn, at a change of label, into the tangent of the curve at a length past it.

    The labels beyond are taken even if no curve is found. The next point is predicted from that length
    beyond. Otherwise a curve that nearly goes back would be found on the side that it came from.
    """
    i: cython.Py_ssize_t
    predict_past_label(stepper, past)
    stepper.problem.evaluate_margins(stepper.newton.z)
    stepper.here.margin[:] = stepper.problem.margin
    stepper.offset[:] = 0.0
    if not predict_beyond(stepper, past):
        return False
    for i in range(stepper.guess.shape[0]):
        stepper.offset[i] = past * stepper.here.tangent[i]
    stepper.here.tangent[:] = stepper.newton.tangent
    for i in range(stepper.guess.shape[0]):
        stepper.guess[i] = stepper.newton.scale[i] * stepper.here.tangent[i]
    if stepper.problem.outputs:
        stepper.problem.evaluate_outputs(stepper.here.z, stepper.guess)
        stepper.here.growth[:] = stepper.problem.growth
    return True


@cython.cfunc
@cython.exceptval(check=False)
def predict_past_label(stepper: Stepper, past: cython.double) -> cython.void:
    """Put the corrector at a length along the tangent of here."""
    i: cython.Py_ssize_t
    for i in range(stepper.here.z.shape[0]):
        stepper.newton.row[i] = stepper.here.tangent[i]
        stepper.newton.z[i] = stepper.here.z[i] + past * stepper.newton.scale[i] * stepper.here.tangent[i]
