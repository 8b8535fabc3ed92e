"""The step rule: which step is accepted, how long the next one is, and what a step may have stepped over.

A step is good if the curve was where the parabola foretold it, turned gently, kept its orientation, and if
what is reported changed as foreseen. The next step aims at what `StepOptions` says of turn, miss
and unevenness.

Switching functions (margins) that change their sign twice within it, or a parameter or output that turns back
twice, show in what both ends tell of the way between them.
"""

from __future__ import annotations

import cython
from cython.cimports.libc.math import acos, fabs, sqrt

from fcm.continuation.options import StepOptions
from fcm.continuation.stepper import Stepper

if cython.compiled:
    from cython.cimports.fcm.continuation.problem import DIFFERENCE_LENGTH
else:
    from fcm.continuation.problem import DIFFERENCE_LENGTH


@cython.cfunc
@cython.exceptval(-1, check=False)
def hidden_sign_change(stepper: Stepper) -> cython.double:
    """Length at which a margin of one sign here and there has the other between them; 0 if none has.

    As far as the cubic through both ends, with their slopes, tells.
    """
    i: cython.Py_ssize_t
    k: cython.Py_ssize_t
    at: cython.double
    first: cython.double = stepper.step
    for k in range(stepper.problem.margins):
        i = stepper.here.partner(k, stepper.there.kind, stepper.there.angle)
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
    """Length at which the parameter, or an output, may go the other way than here and there; 0 if none does.

    There are two folds, or a peak and the least value after it, between then. As far as the cubics through
    both ends tell; of outputs those near their greatest.
    """
    k: cython.Py_ssize_t
    size: cython.double
    step: cython.double = stepper.step
    along: cython.double = step / stepper.clipped_cosine()
    if step <= stepper.options.events.rounding_step:
        return 0.0
    at: cython.double = parameter_reversal(stepper)
    for k in range(stepper.problem.outputs):
        size = max(stepper.here.output[k], stepper.there.output[k])
        if at == 0.0 and size >= stepper.options.events.peak_threshold * greatest[k]:
            at = cubic_reversal(
                stepper.there.output[k] - stepper.here.output[k],
                stepper.here.growth[k] * step,
                stepper.there.growth[k] * along,
                stepper.options.events.min_growth * size * step,
                stepper.options.events.doubtful_slope,
            )
    return at * step


@cython.cfunc
@cython.exceptval(-1, check=False)
def parameter_reversal(stepper: Stepper) -> cython.double:
    """The part of the step where the parameter may go the other way than here and there; 0 if nowhere."""
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
    """Whether the parameter goes on so evenly that corners within the step hide no pair of folds.

    Beyond a corner its slope may change as a root, and back at the next one: the slope at the ends then
    differs, or the way does from that at their mean. Either alone vanishes somewhere.
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
    """Where in (0, 1) the cubic that rises so much, with slopes of one sign at 0 and 1, goes the other way
    most, or hardly onwards; 0 if it goes on, or the other way by less than the least slope.
    """
    if not begin * end > 0.0:
        return 0.0
    sign: cython.double = 1.0 if begin > 0.0 else -1.0
    a: cython.double = sign * begin
    b: cython.double = sign * (3.0 * rise - 2.0 * begin - end)
    c: cython.double = sign * (begin + end - 2.0 * rise)
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
    """Where in (0, 1) the cubic with values of one sign and slopes at 0 and 1 is furthest beyond 0; 0 if it
    is not."""
    sign: cython.double = 1.0 if before > 0.0 else -1.0
    a: cython.double = sign * begin
    b: cython.double = sign * (3.0 * (after - before) - 2.0 * begin - end)
    c: cython.double = sign * (begin + end - 2.0 * (after - before))
    root: cython.double = b * b - 3.0 * a * c
    if not (a < 0.0 and sign * end > 0.0 and root > 0.0):
        return 0.0
    x: cython.double = -a / (b + sqrt(root)) if b > 0.0 else (sqrt(root) - b) / (3.0 * c)
    return x if 0.0 < x < 1.0 and sign * before + x * (a + x * (b + x * c)) < 0.0 else 0.0


@cython.ccall
@cython.exceptval(-1, check=False)
def next_corner(stepper: Stepper, step: cython.double) -> cython.double:
    """The step, or where on it the prediction comes to the first change of sign of a margin: of which."""
    count: cython.int
    at: cython.double
    before: cython.double
    after: cython.double
    low: cython.double = stepper.known_length
    high: cython.double = step
    width: cython.double = 2.0 * step
    known: cython.double = stepper.options.switching.distance_tolerance
    aside: cython.double = known / 3.0  # of the root, to come to either side of it
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
            before = before if which == stepper.next_margin else -after  # of another: by halves at first
        else:
            low, aside = at, known / 3.0
            before = stepper.here.margin_of_problem(which, stepper.problem) or before
    return high


@cython.cfunc
@cython.exceptval(-1, check=False)
def next_extrapolated_root(stepper: Stepper) -> cython.double:
    """Length at which the first margin vanishes that goes on as it does here; 0 if none approaches zero.

    A margin that is the root of the distance from a corner is as straight as the curve; the prediction,
    along which that distance is as straight, meets the corner halfway.
    """
    k: cython.Py_ssize_t
    first: cython.double = 0.0
    if not stepper.here.has_margin_slopes:
        stepper.here.differentiate_margins(stepper.problem, stepper.newton.scale, stepper.guess)
    for k in range(stepper.problem.margins):
        if stepper.here.margin[k] * stepper.here.slope[k] < 0.0:
            here: cython.double = stepper.here.margin[k]
            ahead: cython.double = here + DIFFERENCE_LENGTH * stepper.here.slope[k]
            # the square of such a root falls half as fast along the tangent as it does along the curve
            at: cython.double = 2.0 * DIFFERENCE_LENGTH * here * here / (here * here - ahead * ahead)
            if here * ahead > 0.0 and (first == 0.0 or at < first):
                first = at
    return first


@cython.cfunc
@cython.exceptval(-1, check=False)
def next_label_change(stepper: Stepper, step: cython.double) -> cython.double:
    """The step, or where on it a label of the prediction changes: a label has no root, but halves."""
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
    """Whether the prediction a step ahead has a margin of the other sign than here, or a label of
    another value; which is then one of those."""
    k: cython.Py_ssize_t
    stepper.predictor.predict(stepper.here, stepper.newton.scale, step, stepper.guess)
    stepper.problem.bound(stepper.guess)
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
    """Whether the curve was where it was predicted, and went on as it did."""
    options: StepOptions = stepper.options.step
    if stepper.step <= options.any_turn_step:
        # beyond a corner that turns by more than a right angle the way back is as near
        back: cython.bint = (
            stepper.problem.rooted and not keeps_orientation(stepper) and stepper.cosine < options.min_cosine
        )
        # of labelled curves `LabelledSwitching` tells what a short step may miss
        near: cython.bint = stepper.problem.labelled or within_turn(stepper)
        return stepper.cosine > 0.0 and not back and near
    if not (
        keeps_orientation(stepper) and stepper.miss < options.max_miss and stepper.cosine > options.min_cosine
    ):
        return False
    return output_error(stepper) < options.max_output_error_ratio * options.target_output_error


@cython.cfunc
@cython.exceptval(-1, check=False)
def within_turn(stepper: Stepper) -> cython.bint:
    """Whether a short step misses the curve by no more than its turn explains: otherwise it is another part.

    By the tangent of the turn, where the corner is at the start; by twice that, where it bends as a root; and
    by what is so short that corners there are not told apart.
    """
    turned: cython.double = sqrt(max(1.0 - stepper.cosine * stepper.cosine, 0.0))
    options: StepOptions = stepper.options.step
    if stepper.miss * stepper.step < options.any_turn_step:
        return True
    return stepper.cosine * stepper.miss < 2.0 * turned + options.max_miss


@cython.cfunc
@cython.exceptval(-1, check=False)
def keeps_orientation(stepper: Stepper) -> cython.bint:
    """Whether the orientation is the same here and there: otherwise there may be the far side of a corner."""
    return stepper.there.orientation == stepper.here.orientation


@cython.ccall
@cython.exceptval(-1, check=False)
def smooth_step(stepper: Stepper, step: cython.double) -> cython.bint:
    """Whether there is a good step of a length before a corner, and no margin changes its sign on it."""
    return (
        stepper.try_step(step)
        and keeps_orientation(stepper)
        and acceptable(stepper)
        and not changes_sign(stepper)
    )


@cython.ccall
@cython.exceptval(-1, check=False)
def next_step(stepper: Stepper) -> cython.double:
    """Length of the step that follows a good one."""
    options: StepOptions = stepper.options.step
    growth: cython.double = options.target_turn / max(acos(min(stepper.cosine, 1.0)), 1e-9)
    growth = min(growth, sqrt(options.target_miss / max(stepper.miss, 1e-9)))
    growth = min(growth, options.target_output_error / max(output_error(stepper), 1e-9))
    most: cython.double = options.max_factor_hasty if stepper.options.stations_only else options.max_factor
    return min(
        stepper.step * min(max(options.safety * growth, options.min_factor), most), stepper.options.max_step
    )


@cython.ccall
@cython.exceptval(-1, check=False)
def output_error(stepper: Stepper) -> cython.double:
    """Greatest change of the growth of an output over the step, as a change of the output over its
    size."""
    k: cython.Py_ssize_t
    worst: cython.double = 0.0
    size: cython.double
    for k in range(stepper.problem.outputs):
        size = max(stepper.here.output[k], stepper.there.output[k])
        if size > 0.0:
            worst = max(worst, fabs(stepper.there.growth[k] - stepper.here.growth[k]) * stepper.step / size)
    return worst


@cython.ccall
@cython.exceptval(-1, check=False)
def solution_size(stepper: Stepper) -> cython.double:
    """Greatest unit of the unknowns: the size of the solution."""
    i: cython.Py_ssize_t
    most: cython.double = 0.0
    for i in range(stepper.problem.unknowns):
        most = max(most, stepper.newton.scale[i])
    return most
