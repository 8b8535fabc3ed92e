"""Corners, where a switching function changes its sign: found in a step, kept, left in the direction beyond.

A piecewise smooth curve keeps its orientation across them (Allgower and Georg, "Introduction to Numerical
Continuation Methods", SIAM 2003, on piecewise linear and piecewise smooth maps).
"""

from __future__ import annotations

import cython
import numpy as np

from fcm.continuation import events
from fcm.continuation.path import Mark
from fcm.continuation.point import Point
from fcm.continuation.recorder import Recorder
from fcm.continuation.stepper import Stepper

if cython.compiled:
    from cython.cimports.fcm.continuation.step_control import acceptable, keeps_orientation
else:
    from fcm.continuation.step_control import acceptable, keeps_orientation

FOLD = cython.declare(cython.long, int(Mark.FOLD))
PEAK = cython.declare(cython.long, int(Mark.PEAK))


@cython.cfunc
@cython.exceptval(-1, check=True)
def before_corner(stepper: Stepper) -> cython.double:
    """Length to the first corner of the step, which is shortened to end just before; negative if it is none.

    That is where the curve is not found up to there, or not where it was predicted.
    """
    if not keeps_orientation(
        stepper
    ):  # what is there is another part of a curve that goes back in the corner
        return -1.0
    at: cython.double = events.first_margin(stepper)
    if at < 0.0 or not stepper.shorten((1.0 - stepper.options.switching.smooth_fraction) * at):
        return -1.0
    if not keeps_orientation(stepper) or not acceptable(stepper):
        return -1.0
    return at


@cython.cclass
class NonsmoothPoints:
    """At corners of the curve of a `recorder`; `labelled` where a change of label is what tells of them."""

    def __init__(self, recorder: Recorder, labelled: bool) -> None:
        self.recorder, self.labelled = recorder, labelled
        self.growth_before = np.zeros(recorder.stepper.problem.outputs)  # growth before a corner

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def pass_corner(self, point: Point, length: cython.double, past: cython.double) -> cython.int:
        """Keep the corner, a point at a length from here, and take the direction beyond it.

        past: the length at which that is looked for where the corner is a change of label.
        """
        recorder: Recorder = self.recorder
        stepper: Stepper = recorder.stepper
        recorder.add_corner(point)
        if point is not stepper.here:
            go_to_corner(stepper, point, length)
        rise: cython.double = stepper.here.tangent[recorder.n]
        self.growth_before[:] = stepper.here.growth
        if self.labelled:
            cross_label(stepper, past)
        else:
            cross_corner(stepper, recorder.stops)
        fold: cython.long = FOLD if rise * stepper.here.tangent[recorder.n] < 0.0 else 0
        recorder.store.mark_last(fold | (PEAK if self.is_peak() else 0))
        recorder.update_greatest()
        return 0

    @cython.cfunc
    @cython.exceptval(check=False)
    def is_peak(self) -> cython.bint:
        """Whether an output grew before the corner that is here, and falls beyond it."""
        k: cython.Py_ssize_t
        growth: cython.double[::1] = self.recorder.stepper.here.growth
        for k in range(self.growth_before.shape[0]):
            if self.growth_before[k] > 0.0 and growth[k] < 0.0:
                return True
        return False


@cython.ccall
@cython.exceptval(-1, check=False)
def go_to_corner(stepper: Stepper, point: Point, at: cython.double) -> cython.int:
    """Go to a corner, a point at a length from here, as from before it."""
    point.tangent[:] = stepper.there.tangent  # that before the corner, on whichever side it was put
    point.growth[:] = stepper.there.growth
    point.orientation = stepper.there.orientation
    stepper.accept(point, at)
    return 0


@cython.ccall
@cython.exceptval(-1, check=False)
def cross_corner(stepper: Stepper, stops: cython.double[::1]) -> cython.bint:
    """Go on, from a corner that is here, to the nearest point that the curve is found to have beyond.

    Several margins may be zero here or very near, so that more than two smooth pieces meet; all that is
    nearer is one corner, as is what the curve comes to at once beyond it. Where no point is found, or a value
    of the parameter is passed that is to be landed on, only the direction of the curve is taken and here
    remains.
    """
    count: cython.int
    length: cython.double = stepper.options.switching.departure_length
    first: cython.double = 0.0  # the nearest, though another corner is as near
    for count in range(stepper.options.switching.departure_tries):  # noqa: B007
        if point_beyond(stepper, length):
            if not stepper.problem.rooted or without_sign_change(stepper, 10.0 * length):
                accept_beyond(stepper, length, not passes_station(stepper, stops))
                return True
            first = first or length
        length *= 10.0
    if first > 0.0 and point_beyond(stepper, first):
        accept_beyond(stepper, first, not passes_station(stepper, stops))
        return True
    predict_past_label(stepper, stepper.options.switching.departure_length)
    if not predict_beyond(stepper, stepper.options.switching.departure_length):
        return False
    accept_beyond(stepper, stepper.options.switching.departure_length, False)
    return True


@cython.cfunc
@cython.exceptval(-1, check=False)
def point_beyond(stepper: Stepper, length: cython.double) -> cython.bint:
    """Whether the corrector comes to a point of the curve that is a length past the corner that is here.

    It is looked for in the direction of the piece into which the curve comes, then in that of the piece into
    which this direction leads, and so on. A point beyond has the orientation of here in the direction in
    which it was looked for; one on the way to the corner has the other.
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
            stepper.problem.rooted
            and stepper.newton.correct_by_half_steps(length)
            and close_to_prediction(stepper, length)
        ):
            return True
        stepper.newton.z[:] = stepper.between.z
        # along the edge of a piece, as where a circle ceases to slip, only the equations lead across it
        if stepper.problem.rooted and not stepper.newton.single_step():
            return False
    return False


@cython.cfunc
@cython.exceptval(check=False)
def close_to_prediction(stepper: Stepper, length: cython.double) -> cython.bint:
    """Whether the corrector has come to a point beyond a corner that is where it was looked for."""
    if not stepper.newton.moved < stepper.options.switching.max_deviation * length:
        return False
    return stepper.newton.orientation == stepper.here.orientation


@cython.cfunc
@cython.exceptval(-1, check=False)
def without_sign_change(stepper: Stepper, length: cython.double) -> cython.bint:
    """Whether no margin changes its sign within a length from where the corrector is.

    A circle that starts to slip leaves its limit as the square of the length: what is found first may be
    beside that by rounding, on the side from where the curve comes.
    """
    i: cython.Py_ssize_t
    k: cython.Py_ssize_t
    there: Point = stepper.between
    stepper.record(there, True, False)
    for i in range(stepper.guess.shape[0]):
        stepper.guess[i] = there.z[i] + length * stepper.newton.scale[i] * there.tangent[i]
    stepper.problem.bound(stepper.guess)
    for k in range(stepper.problem.margins):
        if there.margin[k] * there.margin_of_problem(k, stepper.problem) < 0.0:
            return False
    return True


@cython.cfunc
@cython.exceptval(-1, check=False)
def predict_beyond(stepper: Stepper, length: cython.double) -> cython.bint:
    """Put the corrector a length along the direction that the curve has in the piece where it is now.

    With the orientation that it has here, which is the same in all pieces of a piecewise smooth curve.
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
def passes_station(stepper: Stepper, stops: cython.double[::1]) -> cython.bint:
    """Whether a value of the parameter lies between here and where the corrector is."""
    n: cython.Py_ssize_t = stepper.here.z.shape[0] - 1
    k: cython.Py_ssize_t
    for k in range(stops.shape[0]):
        if (stops[k] - stepper.here.z[n]) * (stops[k] - stepper.newton.z[n]) <= 0.0:
            return True
    return False


@cython.cfunc
@cython.exceptval(-1, check=False)
def accept_beyond(stepper: Stepper, length: cython.double, go: cython.bint) -> cython.int:
    """Go to where the corrector is, a length from here, or take only the direction and the margins there."""
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
    """Turn, where a label changes, into the direction that the curve has a length past it.

    The labels are those beyond, even if no curve is found. The next point is looked for from as far beyond:
    a curve that nearly goes back is else found on the side that it came from.
    """
    i: cython.Py_ssize_t
    predict_past_label(stepper, past)
    stepper.problem.bound(stepper.newton.z)
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
        stepper.problem.report(stepper.here.z, stepper.guess)
        stepper.here.growth[:] = stepper.problem.growth
    return True


@cython.cfunc
@cython.exceptval(check=False)
def predict_past_label(stepper: Stepper, past: cython.double) -> cython.void:
    """Put the corrector a length along the tangent of here."""
    i: cython.Py_ssize_t
    for i in range(stepper.here.z.shape[0]):
        stepper.newton.row[i] = stepper.here.tangent[i]
        stepper.newton.z[i] = stepper.here.z[i] + past * stepper.newton.scale[i] * stepper.here.tangent[i]
