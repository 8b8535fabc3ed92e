"""A step along a curve and the step rule: which step is accepted, and how long the next one is.

`Stepper` holds where a step begins and ends, and finds points between the two. It predicts the end, then
corrects it. Lengths are measured in the problem's scale at `here`. A point at the length s lies in the plane
through here + s tangent normal to that tangent.

A step is good if the point was near its prediction, the curve turned gently and kept its orientation, and the
outputs changed as predicted. The length of the next step aims at the turn, the miss and the output error of
`StepOptions`.

Within a step a margin may change its sign twice, or the parameter or an output may turn back twice. Values
and slopes at both ends show that.
"""

from __future__ import annotations

import cython
import numpy as np
from cython.cimports.libc.math import acos, fabs, sqrt

from fcm.continuation.corrector import Newton
from fcm.continuation.options import FOLLOW, FollowOptions, StepOptions
from fcm.continuation.problem import Point, Problem

if cython.compiled:
    from cython.cimports.fcm.continuation.predictor import Predictor, dot
    from cython.cimports.fcm.cubic import cubic, powers
else:
    from fcm.continuation.predictor import Predictor, dot
    from fcm.cubic import cubic, powers


@cython.cclass
class Stepper:
    """A step along a curve: where it begins (`here`), where it ends (`there`), and points `between` the two.

    `try_step` finds the point there; `find_between` and others find points between; `accept` goes on.

    step: its length; cosine: that of the angle between the tangents here and there.
    """

    def __init__(self, problem: Problem, options: FollowOptions = FOLLOW) -> None:
        self.problem, self.options = problem, options
        self.newton, self.predictor = (
            Newton(problem, options.newton),
            Predictor(problem.unknowns + 1, options.step.min_cubic_cosine),
        )
        self.here, self.there, self.between = Point(problem), Point(problem), Point(problem)
        self.guess = np.zeros(problem.unknowns + 1)
        self.step, self.cosine, self.miss, self.parameter_miss = 0.0, 1.0, 0.0, 0.0
        self.rounding = 0.0  # scaled length by which rounding may have moved the point there
        self.next_margin = -1  # the margin whose sign change ahead of here was found last
        self.reset(options)  # sets tolerance: the corrector's at the end of a step
        self.known_length = 0.0  # up to this length the margins beyond a corner count as known
        # scaled, from the prediction to the guess of the next point: to the far side of a corner at here
        self.offset = np.zeros(problem.unknowns + 1)

    def reset(self, options: FollowOptions) -> None:
        """Prepare for another curve, with options."""
        self.options, self.newton.options, self.newton.evaluations = options, options.newton, 0
        self.newton.tolerance, self.max_newton_step = options.newton.tolerance, options.labels.max_newton_step
        self.predictor.min_cosine = options.step.min_cubic_cosine
        self.tolerance = (
            options.newton.preliminary_tolerance if options.user_points_only else options.newton.tolerance
        )

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def begin(self, z: cython.double[::1], row: cython.double[::1]) -> cython.int:
        """Start at the point of the curve in the plane through z normal to row; 0 if none is found."""
        self.known_length = 0.0
        self.here.slope[:] = 0.0
        self.problem.evaluate_scale(z)
        self.newton.scale[:] = self.problem.scale
        self.newton.z[:] = z
        self.newton.row[:] = row
        if not self.newton.correct(1.0):
            return 0
        self.problem.evaluate_scale(self.newton.z)  # the guess may have been far larger than the solution
        self.newton.scale[:] = self.problem.scale
        if not self.newton.correct(1.0):
            return 0
        self.record(self.here, True, True)
        self.here.has_margin_slopes = True
        self.predictor.reset()
        return 1

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def try_step(self, step: cython.double) -> cython.bint:
        """Find the point there at a step from here; return whether it is found.

        miss is the distance of the point from its prediction, relative to the step; parameter_miss is that of
        the parameter alone. cosine is that of the turn.
        """
        i: cython.Py_ssize_t
        n: cython.Py_ssize_t = self.problem.unknowns
        missed: cython.double = 0.0
        self.predictor.predict(self.here, self.newton.scale, step, self.guess)
        for i in range(self.guess.shape[0]):
            self.guess[i] += self.newton.scale[i] * self.offset[i]
            self.newton.z[i], self.newton.row[i] = self.guess[i], self.here.tangent[i]
        if not self.correct_step(step) or not self.update_tangent():
            return False
        for i in range(self.guess.shape[0]):
            missed += ((self.newton.z[i] - self.guess[i]) / self.newton.scale[i]) ** 2
        # a miss due to rounding does not shrink with the step
        rounding: cython.double = self.options.newton.rounding_multiple * self.newton.rounding_step
        self.rounding = rounding
        strayed: cython.double = fabs(self.newton.z[n] - self.guess[n]) / self.newton.scale[n]
        self.step, self.miss = step, max(sqrt(missed) - rounding, 0.0) / step
        self.parameter_miss = max(strayed - rounding, 0.0) / step
        self.cosine = dot(self.here.tangent, self.newton.tangent)
        self.record(self.there, True, True)
        return True

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def differentiate_margins(self) -> cython.int:
        """Compute the slopes of the margins at here and there if they are not known yet."""
        if not self.there.has_margin_slopes:
            self.there.differentiate_margins(self.problem, self.newton.scale, self.guess)
        if not self.here.has_margin_slopes:
            self.here.differentiate_margins(self.problem, self.newton.scale, self.guess)
        return 0

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def update_tangent(self) -> cython.bint:
        """For a labelled problem, compute the tangent exactly at the corrector's point.

        The tangent from before the last Newton step may belong to another smooth piece; no margin shows that.
        """
        moved: cython.double = self.newton.moved
        if not self.problem.labelled:
            return True
        found: cython.bint = self.newton.take_tangent()
        self.newton.moved = moved
        return found

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def correct_step(self, step: cython.double) -> cython.bint:
        """Correct the prediction of the point there; return whether that converges."""
        if self.problem.labelled and step > self.options.step.any_turn_step:
            return self.newton.correct(step, self.max_newton_step * step)
        return self.correct_to(step, self.tolerance)

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def correct_to(self, step: cython.double, close: cython.double) -> cython.bint:
        """Correct the prediction of a point to a tolerance; return whether that converges."""
        self.newton.tolerance = close
        found: cython.bint = self.newton.correct(step)
        self.newton.tolerance = self.options.newton.tolerance
        return found

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def accept(self, point: Point, length: cython.double) -> cython.int:
        """Go on from a point at a length from here, 0 beyond a corner, with the scale of that point."""
        self.problem.evaluate_scale(point.z)
        scale: cython.double[::1] = self.newton.scale
        new: cython.double[::1] = self.problem.scale
        if self.problem.labelled:
            self.predictor.update(self.here, point, scale, new, length)
        unit: cython.double = self.predictor.rescale(self.here, point, scale, new, length)
        self.newton.scale[:] = self.problem.scale
        self.here.copy_from(point, unit)
        self.known_length = 0.0
        self.offset[:] = 0.0
        return 0

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def move_short(self, step: cython.double) -> cython.int:
        """Go a step so short that the prediction counts as on the curve if none is found nearer."""
        self.predictor.predict(self.here, self.newton.scale, step, self.guess)
        self.newton.z[:] = self.guess
        self.newton.row[:] = self.here.tangent
        if self.newton.correct(step) and self.newton.moved < step:
            self.here.z[:] = self.newton.z
        else:
            self.here.z[:] = self.guess
        return 0

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def find_between(self, at: cython.double, margins: cython.bint, outputs: cython.bint) -> cython.bint:
        """Find the point between here and there at a length from here; with margins and outputs if asked."""
        i: cython.Py_ssize_t
        self.interpolate(at)
        for i in range(self.guess.shape[0]):
            self.newton.z[i], self.newton.row[i] = self.guess[i], self.here.tangent[i]
        if not self.correct_to(at, self.tolerance):
            return False
        self.record(self.between, margins, outputs)
        return True

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def find_from_guess(self, at: cython.double, guess: cython.double[::1]) -> cython.bint:
        """Find the point between here and there at a length, from a guess, with its outputs.

        The tangent is that exactly at the point."""
        self.newton.z[:] = guess
        self.newton.row[:] = self.here.tangent
        return self.correct_to(at, self.tolerance) and self.sharpen(False, True)

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def find_at_parameter(self, parameter: cython.double) -> cython.bint:
        """Find the point between here and there at a given value of the parameter."""
        n: cython.Py_ssize_t = self.problem.unknowns
        rise: cython.double = self.there.z[n] - self.here.z[n]
        self.interpolate(self.step * (parameter - self.here.z[n]) / rise)
        self.newton.z[:] = self.guess
        self.newton.z[n] = parameter
        self.newton.row[:] = 0.0
        self.newton.row[n] = 1.0 if rise > 0.0 else -1.0
        if not self.newton.correct(self.step) or self.newton.moved > self.step:
            return False
        self.newton.z[n] = parameter
        self.record(self.between, False, False)
        return True

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def sharpen(self, margins: cython.bint, outputs: cython.bint) -> cython.bint:
        """Compute the tangent exactly at the point between here and there.

        The corrector's tangent is from before its last step.
        """
        if not self.newton.take_tangent():
            return False
        self.record(self.between, margins, outputs)
        return True

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def shorten(self, at: cython.double) -> cython.bint:
        """Make the point at a length from here the end of the step, with the tangent exactly there."""
        if not self.find_between(at, False, False) or not self.sharpen(True, True):
            return False
        self.step, self.cosine = at, dot(self.here.tangent, self.between.tangent)
        self.there, self.between = self.between, self.there
        return True

    @cython.ccall
    @cython.exceptval(-1e300, check=False)
    def length(self, point: Point) -> cython.double:
        """Length from here to the plane in which a point lies."""
        i: cython.Py_ssize_t
        total: cython.double = 0.0
        for i in range(point.z.shape[0]):
            total += self.here.tangent[i] * (point.z[i] - self.here.z[i]) / self.newton.scale[i]
        return total

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def record(self, point: Point, margins: cython.bint, outputs: cython.bint) -> cython.int:
        """Copy the corrector's result to a point, with margins and outputs if asked."""
        i: cython.Py_ssize_t
        point.orientation, point.has_margin_slopes = self.newton.orientation, False
        for i in range(point.z.shape[0]):
            point.z[i], point.tangent[i] = self.newton.z[i], self.newton.tangent[i]
        if margins and self.problem.margins:
            self.problem.evaluate_margins(point.z)
            point.set_margins(self.problem)
        if outputs and self.problem.outputs:
            for i in range(point.z.shape[0]):
                self.guess[i] = self.newton.scale[i] * point.tangent[i]
            self.problem.evaluate_outputs(point.z, self.guess)
            for i in range(self.problem.outputs):
                point.output[i], point.growth[i] = self.problem.output[i], self.problem.growth[i]
        return 0

    @cython.cfunc
    @cython.exceptval(check=False)
    def clipped_cosine(self) -> cython.double:
        """Cosine of the turn of the step, limited from below by `min_cubic_cosine`."""
        return max(self.cosine, self.predictor.min_cosine)

    @cython.cfunc
    @cython.exceptval(check=False)
    def interpolate(self, at: cython.double) -> cython.void:
        """Fill the guess from the cubic through here and there with their tangents, at a length."""
        i: cython.Py_ssize_t
        x: cython.double = at / self.step
        along: cython.double = self.step / self.clipped_cosine()
        for i in range(self.guess.shape[0]):
            self.guess[i] = cubic(
                self.here.z[i],
                self.there.z[i],
                self.step * self.here.tangent[i],
                along * self.there.tangent[i],
                self.newton.scale[i],
                x,
            )


@cython.cfunc
@cython.exceptval(-1, check=False)
def hidden_sign_change(stepper: Stepper) -> cython.double:
    """Length at which a margin is beyond zero between two ends of the same sign; 0 if none is.

    The cubic with the values and slopes at both ends decides.
    """
    i: cython.Py_ssize_t
    k: cython.Py_ssize_t
    at: cython.double
    first: cython.double = stepper.step
    for k in range(stepper.problem.margins):
        i = stepper.here.matching_margin(k, stepper.there.kind, stepper.there.angle)
        if i >= 0 and stepper.here.margin[k] * stepper.there.margin[i] > 0.0:
            at = cubic_beyond_zero(
                stepper.here.margin[k],
                stepper.here.slope[k] * stepper.step,
                stepper.there.margin[i],
                stepper.there.slope[i] * stepper.step / stepper.clipped_cosine(),
            )
            if 0.0 < at * stepper.step < first:
                first = at * stepper.step
    return first if first < stepper.step else 0.0


@cython.cfunc
@cython.exceptval(-1, check=False)
def hidden_reversal(stepper: Stepper, greatest: cython.double[::1]) -> cython.double:
    """Length at which the parameter or an output may go back between two ends where it goes on; 0 if none.

    Then there are two folds between the ends, or a peak and a minimum. The cubics with the values and slopes
    at both ends decide; of the outputs, only those near their greatest count. A reversal within rounding does
    not count, nor one within the corrector's error of an output that hardly moves, as across a plane of
    symmetry.
    """
    k: cython.Py_ssize_t
    size: cython.double
    step: cython.double = stepper.step
    along: cython.double = step / stepper.clipped_cosine()
    if step <= stepper.options.events.rounding_step:
        return 0.0
    at: cython.double = parameter_reversal(stepper)
    left: cython.double = 0.0
    for k in range(stepper.problem.outputs):
        left = max(left, stepper.options.events.min_reversal * greatest[k])
    for k in range(stepper.problem.outputs):
        size = max(stepper.here.output[k], stepper.there.output[k])
        if at == 0.0 and size >= stepper.options.events.peak_threshold * greatest[k]:
            at = cubic_reversal(
                stepper.there.output[k] - stepper.here.output[k],
                stepper.here.growth[k] * step,
                stepper.there.growth[k] * along,
                # between two values a cubic is 1.5 times as steep as the chord
                size * (stepper.options.events.min_growth * step + 1.5 * stepper.rounding) + left,
                stepper.options.events.doubtful_slope,
            )
    return at * step


@cython.cfunc
@cython.exceptval(-1, check=False)
def parameter_reversal(stepper: Stepper) -> cython.double:
    """Part of the step at which the parameter may go back between its ends; 0 if nowhere."""
    n: cython.Py_ssize_t = stepper.problem.unknowns
    unit: cython.double = stepper.step * stepper.newton.scale[n]
    return cubic_reversal(
        stepper.there.z[n] - stepper.here.z[n],
        stepper.here.tangent[n] * unit,
        stepper.there.tangent[n] * unit / stepper.clipped_cosine(),
        0.0,
        stepper.options.events.doubtful_slope,
    )


@cython.cfunc
@cython.exceptval(-1, check=False)
def parameter_is_even(stepper: Stepper) -> cython.bint:
    """Whether the parameter changes so evenly that corners within the step hide no pair of folds.

    Beyond a corner its slope may change as a root, and change back at the next one. Then the slopes at the
    ends differ, or the rise differs from that with the mean slope. Each difference alone may vanish.
    """
    n: cython.Py_ssize_t = stepper.problem.unknowns
    unit: cython.double = stepper.step * stepper.newton.scale[n]
    begin: cython.double = stepper.here.tangent[n] * unit
    end: cython.double = stepper.there.tangent[n] * unit / stepper.clipped_cosine()
    off: cython.double = fabs(2.0 * (stepper.there.z[n] - stepper.here.z[n]) - (begin + end))
    return begin * end > 0.0 and max(off, fabs(end - begin)) < stepper.options.events.max_slope_change * min(
        fabs(begin), fabs(end)
    )


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def cubic_reversal(
    rise: cython.double,
    begin: cython.double,
    end: cython.double,
    least: cython.double,
    doubtful: cython.double,
) -> cython.double:
    """Where in (0, 1) a cubic with slopes of one sign at 0 and 1 goes back fastest; 0 if nowhere.

    rise: its change from 0 to 1; begin, end: its slopes there. It counts as going back if its least slope is
    below `doubtful` times the lesser end slope, minus `least`.
    """
    if not begin * end > 0.0:
        return 0.0
    sign: cython.double = 1.0 if begin > 0.0 else -1.0
    a: cython.double = sign * begin
    b, c = powers(sign * rise, a, sign * end)
    if not c > 0.0:
        return 0.0
    x: cython.double = -b / (3.0 * c)
    return x if 0.0 < x < 1.0 and a + x * b < doubtful * min(a, sign * end) - least else 0.0


@cython.cfunc
@cython.exceptval(-1, check=False)
def changes_sign(stepper: Stepper) -> cython.bint:
    """Whether a margin changes sign from here to there."""
    k: cython.Py_ssize_t
    for k in range(stepper.problem.margins):
        if stepper.here.margin[k] * stepper.here.margin_at(k, stepper.there) < 0.0:
            return True
    return False


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def cubic_beyond_zero(
    before: cython.double, begin: cython.double, after: cython.double, end: cython.double
) -> cython.double:
    """Where in (0, 1) a cubic with values of one sign at 0 and 1 is furthest beyond 0; 0 if nowhere.

    before, after: the values; begin, end: the slopes there.
    """
    sign: cython.double = 1.0 if before > 0.0 else -1.0
    a: cython.double = sign * begin
    b, c = powers(sign * (after - before), a, sign * end)
    root: cython.double = b * b - 3.0 * a * c
    if not (a < 0.0 and sign * end > 0.0 and root > 0.0):
        return 0.0
    x: cython.double = -a / (b + sqrt(root)) if b > 0.0 else (sqrt(root) - b) / (3.0 * c)
    return x if 0.0 < x < 1.0 and sign * before + x * (a + x * (b + x * c)) < 0.0 else 0.0


@cython.ccall
@cython.exceptval(-1, check=False)
def next_corner(stepper: Stepper, step: cython.double) -> cython.double:
    """Length at which the prediction meets the first sign change of a margin; the step if it meets none.

    `next_margin` is then the number of that margin.
    """
    count: cython.int
    at: cython.double
    before: cython.double
    after: cython.double
    low: cython.double = stepper.known_length
    high: cython.double = step
    width: cython.double = 2.0 * step
    known: cython.double = stepper.options.switching.distance_tolerance
    aside: cython.double = known / 3.0  # distance from the root, to enclose it from either side
    if stepper.problem.labelled:
        return next_label_change(stepper, step)
    if stepper.problem.margins == 0 or step <= low or not prediction_changes_sign(stepper, step):
        return step
    before, after = (
        stepper.here.margin[stepper.next_margin],
        stepper.here.margin_of_problem(stepper.next_margin, stepper.problem),
    )
    for count in range(stepper.options.switching.max_predictions):
        if high - low < known * high:
            break
        at = (low * after - high * before) / (after - before) + aside * high
        if not low < at < high or (count % 3 == 2 and high - low > 0.5 * width):
            at = 0.5 * (low + high)
        width = high - low if count % 3 == 0 else width
        which: cython.Py_ssize_t = stepper.next_margin
        if prediction_changes_sign(stepper, at):
            high, after, aside = (
                at,
                stepper.here.margin_of_problem(stepper.next_margin, stepper.problem),
                -known / 3.0,
            )
            before = before if which == stepper.next_margin else -after  # another margin: first bisect
        else:
            low, aside = at, known / 3.0
            before = stepper.here.margin_of_problem(which, stepper.problem) or before
    return high


@cython.cfunc
@cython.exceptval(-1, check=False)
def next_extrapolated_root(stepper: Stepper) -> cython.double:
    """Length at which the first margin vanishes by extrapolation from here; 0 if none approaches zero.

    A margin that is the root of the distance from a corner is as straight as the curve. The prediction, along
    which the distance itself is straight, meets the corner halfway.
    """
    k: cython.Py_ssize_t
    first: cython.double = 0.0
    length: cython.double = stepper.problem.difference_length
    if not stepper.here.has_margin_slopes:
        stepper.here.differentiate_margins(stepper.problem, stepper.newton.scale, stepper.guess)
    for k in range(stepper.problem.margins):
        if stepper.here.margin[k] * stepper.here.slope[k] < 0.0:
            here: cython.double = stepper.here.margin[k]
            ahead: cython.double = here + length * stepper.here.slope[k]
            # the square of such a root falls half as fast along the tangent as along the curve
            at: cython.double = 2.0 * length * here * here / (here * here - ahead * ahead)
            if here * ahead > 0.0 and (first == 0.0 or at < first):
                first = at
    return first


@cython.cfunc
@cython.exceptval(-1, check=False)
def next_label_change(stepper: Stepper, step: cython.double) -> cython.double:
    """Length at which a label of the prediction changes, by bisection; the step if none changes."""
    count: cython.int
    low: cython.double = 0.0
    high: cython.double = step
    if stepper.problem.margins == 0 or not prediction_changes_sign(stepper, step):
        return step
    for count in range(stepper.options.switching.max_predictions):  # noqa: B007
        if high - low < stepper.options.switching.label_tolerance * high:
            break
        if prediction_changes_sign(stepper, 0.5 * (low + high)):
            high = 0.5 * (low + high)
        else:
            low = 0.5 * (low + high)
    return high


@cython.cfunc
@cython.exceptval(-1, check=False)
def prediction_changes_sign(stepper: Stepper, step: cython.double) -> cython.bint:
    """Whether the prediction a step ahead has a margin of the other sign than here, or another label.

    `next_margin` is then the number of such a margin.
    """
    k: cython.Py_ssize_t
    stepper.predictor.predict(stepper.here, stepper.newton.scale, step, stepper.guess)
    stepper.problem.evaluate_margins(stepper.guess)
    for k in range(stepper.problem.margins):
        if stepper.problem.labelled:
            changed: cython.bint = stepper.problem.margin[k] != stepper.here.margin[k]
        else:
            changed = stepper.here.margin_of_problem(k, stepper.problem) * stepper.here.margin[k] < 0.0
        if changed:
            stepper.next_margin = k
            return True
    return False


@cython.ccall
@cython.exceptval(-1, check=False)
def acceptable(stepper: Stepper) -> cython.bint:
    """Whether a step is good: the point was near its prediction, and the curve continued smoothly."""
    options: StepOptions = stepper.options.step
    if stepper.step <= options.any_turn_step:
        changed: cython.bint = not keeps_orientation(stepper)
        # where branches only nearly meet, each turns away, and a step across leads to the other branch
        if changed and not stepper.problem.labelled and not passes_branch_point(stepper):
            return False
        # beyond a corner that turns by more than a right angle, the way back is as near as the way on
        back: cython.bint = (
            stepper.problem.has_root_margins and changed and stepper.cosine < options.min_cosine
        )
        # for labelled curves `LabelledSwitching` decides what a short step may miss
        near: cython.bint = stepper.problem.labelled or within_turn(stepper)
        return stepper.cosine > 0.0 and not back and near
    if not (
        keeps_orientation(stepper) and stepper.miss < options.max_miss and stepper.cosine > options.min_cosine
    ):
        return False
    return output_error(stepper) < options.max_output_error_ratio * options.target_output_error


@cython.cfunc
@cython.exceptval(-1, check=False)
def passes_branch_point(stepper: Stepper) -> cython.bint:
    """Whether a short step that changes the orientation crosses a point where branches meet.

    Branches that only nearly meet are hyperbolas. A step from one to the other misses it, and turns, by about
    the squared distance of the branches over the squared step. Where branches meet, the miss is due to
    curvature and to rounding, which grows near the branch point; at corners that nearly coincide, to their
    angles.
    """
    turned: cython.double = sqrt(max(1.0 - stepper.cosine * stepper.cosine, 0.0))
    return stepper.step * sqrt(stepper.miss + turned) <= stepper.options.step.max_branch_distance


@cython.cfunc
@cython.exceptval(-1, check=False)
def within_turn(stepper: Stepper) -> cython.bint:
    """Whether a short step misses the curve by no more than its turn explains; otherwise it left its branch.

    The miss may be the tangent of the turn if the corner is at the start, and twice that if the curve bends
    as a root. A miss so short that corners within it are not distinguished is always admitted.
    """
    turned: cython.double = sqrt(max(1.0 - stepper.cosine * stepper.cosine, 0.0))
    options: StepOptions = stepper.options.step
    if stepper.miss * stepper.step < options.any_turn_step:
        return True
    return stepper.cosine * stepper.miss < 2.0 * turned + options.max_miss


@cython.cfunc
@cython.exceptval(-1, check=False)
def keeps_orientation(stepper: Stepper) -> cython.bint:
    """Whether the orientation is the same here and there; otherwise the step may have passed a corner."""
    return stepper.there.orientation == stepper.here.orientation


@cython.ccall
@cython.exceptval(-1, check=False)
def smooth_step(stepper: Stepper, step: cython.double) -> cython.bint:
    """Whether a step of a length, up to before a corner, is good and changes no margin's sign."""
    return (
        stepper.try_step(step)
        and keeps_orientation(stepper)
        and acceptable(stepper)
        and not changes_sign(stepper)
    )


@cython.ccall
@cython.exceptval(-1, check=False)
def next_step(stepper: Stepper) -> cython.double:
    """Length of the step after a good one."""
    options: StepOptions = stepper.options.step
    growth: cython.double = options.target_turn / max(acos(min(stepper.cosine, 1.0)), 1e-9)
    growth = min(growth, sqrt(options.target_miss / max(stepper.miss, 1e-9)))
    growth = min(growth, options.target_output_error / max(output_error(stepper), 1e-9))
    most: cython.double = options.max_factor_hasty if stepper.options.user_points_only else options.max_factor
    return min(
        stepper.step * min(max(options.safety * growth, options.min_factor), most), stepper.options.max_step
    )


@cython.ccall
@cython.exceptval(-1, check=False)
def output_error(stepper: Stepper) -> cython.double:
    """Greatest change of an output's slope over the step, as a change of the output relative to its size.

    Outputs within the rounding of the greatest are left out.
    """
    k: cython.Py_ssize_t
    worst: cython.double = 0.0
    least: cython.double = 0.0
    size: cython.double
    for k in range(stepper.problem.outputs):
        least = max(least, stepper.there.output[k])
    least *= stepper.options.events.peak_tolerance
    for k in range(stepper.problem.outputs):
        size = max(stepper.here.output[k], stepper.there.output[k])
        if size > least:
            worst = max(worst, fabs(stepper.there.growth[k] - stepper.here.growth[k]) * stepper.step / size)
    return worst


@cython.ccall
@cython.exceptval(-1, check=False)
def solution_size(stepper: Stepper) -> cython.double:
    """Size of the solution: the greatest unit of the unknowns."""
    i: cython.Py_ssize_t
    most: cython.double = 0.0
    for i in range(stepper.problem.unknowns):
        most = max(most, stepper.newton.scale[i])
    return most
