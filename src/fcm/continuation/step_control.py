"""The step rule: which step is accepted, and how long the next one is.

A step is good if the curve was where the parabola foretold it, turned gently, kept its orientation, and if
what is reported changed as foreseen. The next step aims at what `StepOptions` says of turn, miss
and unevenness.
"""

from __future__ import annotations

import cython
from cython.cimports.libc.math import acos, fabs, sqrt

from fcm.continuation.options import StepOptions
from fcm.continuation.stepper import Stepper

if cython.compiled:
    from cython.cimports.fcm.continuation.switching_functions import changes_sign
else:
    from fcm.continuation.switching_functions import changes_sign


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
