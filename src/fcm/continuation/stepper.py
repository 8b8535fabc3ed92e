"""A step along a curve: where it begins, where it ends, how that is found, and points between the two.

The end is predicted, then corrected. Lengths are measured in the problem's scale at the point `here`. A point
at the length s lies in the plane through here + s tangent whose normal is that tangent.
"""

from __future__ import annotations

import cython
import numpy as np
from cython.cimports.libc.math import fabs, sqrt

from fcm.continuation.corrector import Newton
from fcm.continuation.options import FOLLOW, FollowOptions
from fcm.continuation.problem import Point, Problem

if cython.compiled:
    from cython.cimports.fcm.continuation.predictor import MIN_COSINE, Predictor, dot
else:
    from fcm.continuation.predictor import MIN_COSINE, Predictor, dot


@cython.cclass
class Stepper:
    """`try_step` finds the point there, at a step from here; `find_between` and others points between;
    `accept` goes on.

    cosine: that of the angle by which the direction there differs from that here; step: the length.
    """

    def __init__(self, problem: Problem, options: FollowOptions = FOLLOW) -> None:
        self.problem, self.options = problem, options
        self.newton, self.predictor = Newton(problem, options.newton), Predictor(problem.unknowns + 1)
        self.here, self.there, self.between = Point(problem), Point(problem), Point(problem)
        self.guess = np.zeros(problem.unknowns + 1)
        self.step, self.cosine, self.miss, self.parameter_miss = 0.0, 1.0, 0.0, 0.0
        self.next_margin = -1  # the margin of which a change of sign was found last ahead of here
        self.reset(options)  # close: to the curve, where a step ends
        self.known_length = 0.0  # up to here the margins beyond a corner are taken as known
        # from the prediction to where the next point is looked for, scaled: to the far side of a corner here
        self.offset = np.zeros(problem.unknowns + 1)

    def reset(self, options: FollowOptions) -> None:
        """Be ready for another curve, with options."""
        self.options, self.newton.options, self.newton.evaluations = options, options.newton, 0
        self.newton.tolerance, self.max_newton_step = options.newton.tolerance, options.labels.max_newton_step
        self.tolerance = (
            options.newton.preliminary_tolerance if options.stations_only else options.newton.tolerance
        )

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def begin(self, z: cython.double[::1], row: cython.double[::1]) -> cython.int:
        """Start from near z, moved to the curve in the plane of row; 0 if there is no curve."""
        self.known_length = 0.0
        self.here.slope[:] = 0.0
        self.problem.measure(z)
        self.newton.scale[:] = self.problem.scale
        self.newton.z[:] = z
        self.newton.row[:] = row
        if not self.newton.correct(1.0):
            return 0
        self.problem.measure(self.newton.z)  # the guess may have been far larger than the solution
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
        """Find the point there at a step; missed and cosine say how well it was predicted.

        strayed is the part of missed, of the length of the step, that the parameter has.
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
        # shorter steps would miss the curve by as much where rounding made the miss
        rounding: cython.double = self.options.newton.rounding_multiple * self.newton.rounding_step
        strayed: cython.double = fabs(self.newton.z[n] - self.guess[n]) / self.newton.scale[n]
        self.step, self.miss = step, max(sqrt(missed) - rounding, 0.0) / step
        self.parameter_miss = max(strayed - rounding, 0.0) / step
        self.cosine = dot(self.here.tangent, self.newton.tangent)
        self.record(self.there, True, True)
        return True

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def differentiate_margins(self) -> cython.int:
        """Give the margins here and there their slopes, if they have none yet."""
        if not self.there.has_margin_slopes:
            self.there.differentiate_margins(self.problem, self.newton.scale, self.guess)
        if not self.here.has_margin_slopes:
            self.here.differentiate_margins(self.problem, self.newton.scale, self.guess)
        return 0

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def update_tangent(self) -> cython.bint:
        """Give the corrector the direction exactly where it is, if the problem is labelled.

        That from before its last step may be of another smooth piece, and no margin tells so.
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
        """Correct the point there."""
        if self.problem.labelled and step > self.options.step.any_turn_step:
            return self.newton.correct(step, self.max_newton_step * step)
        return self.correct_to(step, self.tolerance)

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def correct_to(self, step: cython.double, close: cython.double) -> cython.bint:
        """Correct the point there, so that it is as close to the curve as that."""
        self.newton.tolerance = close
        found: cython.bint = self.newton.correct(step)
        self.newton.tolerance = self.options.newton.tolerance
        return found

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def accept(self, point: Point, length: cython.double) -> cython.int:
        """Go on from a point at a length from here, 0 beyond a corner, in the scale that is right for it."""
        self.problem.measure(point.z)
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
        """Go on by a step so short that the point predicted is on the curve, if no nearer one is found."""
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
        """Find the point between here and there at a length from here, with its margins, its outputs."""
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
        """Find the point between here and there at a length, from a guess, with its outputs; its direction
        is that exactly there."""
        self.newton.z[:] = guess
        self.newton.row[:] = self.here.tangent
        return self.correct_to(at, self.tolerance) and self.sharpen(False, True)

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def find_at_parameter(self, parameter: cython.double) -> cython.bint:
        """Find the point between here and there with a value of the parameter between theirs."""
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
        """Give the point between here and there the direction that it has exactly there.

        That of the corrector is from before its last step.
        """
        if not self.newton.take_tangent():
            return False
        self.record(self.between, margins, outputs)
        return True

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def shorten(self, at: cython.double) -> cython.bint:
        """Make the point at a length from here the one there, with the direction that it has exactly
        there."""
        if not self.find_between(at, False, False) or not self.sharpen(True, True):
            return False
        self.step, self.cosine = at, dot(self.here.tangent, self.between.tangent)
        self.there, self.between = self.between, self.there
        return True

    @cython.ccall
    @cython.exceptval(-1e300, check=False)
    def length(self, point: Point) -> cython.double:
        """Of the way from here to the plane that a point lies in."""
        i: cython.Py_ssize_t
        total: cython.double = 0.0
        for i in range(point.z.shape[0]):
            total += self.here.tangent[i] * (point.z[i] - self.here.z[i]) / self.newton.scale[i]
        return total

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def record(self, point: Point, margins: cython.bint, outputs: cython.bint) -> cython.int:
        """The corrector's result as a point, with its margins, its outputs."""
        i: cython.Py_ssize_t
        point.orientation, point.has_margin_slopes = self.newton.orientation, False
        for i in range(point.z.shape[0]):
            point.z[i], point.tangent[i] = self.newton.z[i], self.newton.tangent[i]
        if margins and self.problem.margins:
            self.problem.bound(point.z)
            point.set_margins(self.problem)
        if outputs and self.problem.outputs:
            for i in range(point.z.shape[0]):
                self.guess[i] = self.newton.scale[i] * point.tangent[i]
            self.problem.report(point.z, self.guess)
            for i in range(self.problem.outputs):
                point.output[i], point.growth[i] = self.problem.output[i], self.problem.growth[i]
        return 0

    @cython.cfunc
    @cython.exceptval(check=False)
    def clipped_cosine(self) -> cython.double:
        """Length in the plane of here that a length along the tangent there has: the cosine."""
        return self.cosine if self.cosine > MIN_COSINE else MIN_COSINE

    @cython.cfunc
    @cython.exceptval(check=False)
    def interpolate(self, at: cython.double) -> cython.void:
        """The cubic through here and there with their tangents."""
        i: cython.Py_ssize_t
        x: cython.double = at / self.step
        slope: cython.double = self.step / self.clipped_cosine()
        for i in range(self.guess.shape[0]):
            self.guess[i] = (
                self.here.z[i] * (1.0 + 2.0 * x) * (1.0 - x) * (1.0 - x)
                + self.there.z[i] * x * x * (3.0 - 2.0 * x)
                + self.newton.scale[i]
                * (
                    self.step * self.here.tangent[i] * x * (1.0 - x) * (1.0 - x)
                    - slope * self.there.tangent[i] * x * x * (1.0 - x)
                )
            )
