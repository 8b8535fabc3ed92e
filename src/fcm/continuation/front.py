"""The advancing end of a curve: the place it has come to, the next one, and places between the two.

Lengths are measured in the problem's scale at the place `here`. A place at the length s lies in the plane
through here + s tangent whose normal is that tangent.
"""

from __future__ import annotations

import cython
import numpy as np
from cython.cimports.libc.math import sqrt

from fcm.continuation import sharp
from fcm.continuation.newton import Newton
from fcm.continuation.place import Place
from fcm.continuation.problem import Problem

if cython.compiled:
    from cython.cimports.fcm.continuation.prediction import FLAT, Prediction, along
else:
    from fcm.continuation.prediction import FLAT, Prediction, along

NAN = cython.declare(cython.double, float("nan"))
ASTRAY = cython.declare(cython.double, 0.3)  # of a step: approximate equations that move it further mislead
SHARP = cython.declare(cython.double, sharp.SHARP)
MISLED = cython.declare(cython.double, 0.5)  # of a step of a soft problem: one that misses by more is refused
ROUNDINGS = cython.declare(cython.double, 8.0)  # a miss that is no longer than these is one


@cython.cclass
class Front:
    """See the module. `go` finds the place there, `put` one between, `accept` makes one of them here."""

    def __init__(self, problem: Problem) -> None:
        size = problem.unknowns + 1
        self.problem, self.newton = problem, Newton(problem)
        self.here, self.there, self.between = Place(problem), Place(problem), Place(problem)
        self.prediction, self.guess = Prediction(size), np.zeros(size)
        self.step, self.missed, self.turn, self.which = 0.0, 0.0, 1.0, -1
        self.past = 0.0  # up to here the margins beyond a corner are taken as known

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def begin(self, z: cython.double[::1], row: cython.double[::1]) -> cython.int:
        """Start from near z, moved to the curve in the plane of row; 0 if there is no curve."""
        self.past, self.here.shift, self.there.shift = 0.0, 0.0, 0.0
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
        self.prediction.straighten()
        return 1

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def go(self, step: cython.double) -> cython.bint:
        """Find the place there at a step; missed and turn say how well it was predicted."""
        i: cython.Py_ssize_t
        missed: cython.double = 0.0
        self.prediction.put(self.here, self.newton.scale, step, self.guess)
        self.newton.z[:] = self.guess
        self.newton.row[:] = self.here.tangent
        if not self.sought(step) or not self.exactly():
            return False
        for i in range(self.guess.shape[0]):
            missed += ((self.newton.z[i] - self.guess[i]) / self.newton.scale[i]) ** 2
        # shorter steps would miss the curve by as much where rounding made the miss
        missed = max(sqrt(missed) - ROUNDINGS * self.newton.unsure, 0.0)
        self.step, self.missed = step, missed / step
        self.turn = along(self.here.tangent, self.newton.tangent)
        self.record(self.there, True, True)
        self.there.incline(self.problem, self.newton.scale, self.guess)
        return True

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def exactly(self) -> cython.bint:
        """Give the corrector the direction exactly where it is, if the problem is soft.

        That from before its last step may be of another smooth piece, and no margin tells so.
        """
        moved: cython.double = self.newton.moved
        if not self.problem.soft:
            return True
        found: cython.bint = self.newton.look()
        self.newton.moved = moved
        return found

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def sought(self, step: cython.double) -> cython.bint:
        """Correct the place there, with the approximate equations first if there are any.

        What the exact ones then change is its shift; NaN where the approximate ones had no solution.
        """
        near: cython.bint = False
        if self.problem.coarse:
            self.problem.refine(False)
            near = self.newton.correct(step) and self.newton.moved < ASTRAY * step
            self.problem.refine(True)
            near = near and self.newton.correct(step) and self.newton.moved < ASTRAY * step
            if near:
                self.there.shift = self.newton.moved
                return True
            self.newton.z[:] = self.guess
            self.there.shift = NAN
        if self.problem.soft and step > SHARP:
            return self.newton.correct(step, MISLED * step)
        return self.newton.correct(step)

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def put(self, at: cython.double, margins: cython.bint, outputs: cython.bint) -> cython.bint:
        """Find the place between here and there at a length from here, with its margins, its outputs."""
        self.interpolate(at)
        self.newton.z[:] = self.guess
        self.newton.row[:] = self.here.tangent
        if not self.newton.correct(at):
            return False
        self.record(self.between, margins, outputs)
        return True

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def near(self, at: cython.double, guess: cython.double[::1]) -> cython.bint:
        """Find the place between here and there at a length, from a guess, with its outputs; its direction
        is that exactly there."""
        self.newton.z[:] = guess
        self.newton.row[:] = self.here.tangent
        return self.newton.correct(at) and self.sharpen(False, True)

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def land(self, parameter: cython.double) -> cython.bint:
        """Find the place between here and there with a value of the parameter between theirs."""
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
    def accept(self, place: Place, length: cython.double) -> cython.int:
        """Go on from a place at a length from here, 0 beyond a corner, in the scale that is right for it."""
        self.problem.measure(place.z)
        scale: cython.double[::1] = self.newton.scale
        new: cython.double[::1] = self.problem.scale
        if self.problem.soft:
            self.prediction.learn(self.here, place, scale, new, length)
        unit: cython.double = self.prediction.turn(self.here, place, scale, new, length)
        self.newton.scale[:] = self.problem.scale
        self.here.like(place, unit)
        self.past = 0.0
        return 0

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def sharpen(self, margins: cython.bint, outputs: cython.bint) -> cython.bint:
        """Give the place between here and there the direction that it has exactly there.

        That of the corrector is from before its last step.
        """
        if not self.newton.look():
            return False
        self.record(self.between, margins, outputs)
        return True

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def shorten(self, at: cython.double) -> cython.bint:
        """Make the place at a length from here the one there, with the direction that it has exactly
        there."""
        if not self.put(at, False, False) or not self.sharpen(True, True):
            return False
        self.step, self.turn = at, along(self.here.tangent, self.between.tangent)
        self.there, self.between = self.between, self.there
        return True

    @cython.ccall
    @cython.exceptval(-1e300, check=False)
    def length(self, place: Place) -> cython.double:
        """Of the way from here to the plane that a place lies in."""
        i: cython.Py_ssize_t
        total: cython.double = 0.0
        for i in range(place.z.shape[0]):
            total += self.here.tangent[i] * (place.z[i] - self.here.z[i]) / self.newton.scale[i]
        return total

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def drift(self, step: cython.double) -> cython.int:
        """Go on by a step so short that the place predicted is on the curve, if no nearer one is found."""
        self.prediction.put(self.here, self.newton.scale, step, self.guess)
        self.newton.z[:] = self.guess
        self.newton.row[:] = self.here.tangent
        if self.newton.correct(step) and self.newton.moved < step:
            self.here.z[:] = self.newton.z
        else:
            self.here.z[:] = self.guess
        return 0

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def record(self, place: Place, margins: cython.bint, outputs: cython.bint) -> cython.int:
        """The corrector's result as a place, with its margins, its outputs."""
        i: cython.Py_ssize_t
        place.orientation = self.newton.orientation
        for i in range(place.z.shape[0]):
            place.z[i], place.tangent[i] = self.newton.z[i], self.newton.tangent[i]
        if margins and self.problem.margins:
            self.problem.bound(place.z)
            place.bounded(self.problem)
        if outputs and self.problem.outputs:
            for i in range(place.z.shape[0]):
                self.guess[i] = self.newton.scale[i] * place.tangent[i]
            self.problem.report(place.z, self.guess)
            for i in range(self.problem.outputs):
                place.output[i], place.growth[i] = self.problem.output[i], self.problem.growth[i]
        return 0

    @cython.cfunc
    @cython.exceptval(check=False)
    def spread(self) -> cython.double:
        """Length in the plane of here that a length along the tangent there has: the cosine of the turn."""
        return self.turn if self.turn > FLAT else FLAT

    @cython.cfunc
    @cython.exceptval(check=False)
    def interpolate(self, at: cython.double) -> cython.void:
        """The cubic through here and there with their tangents."""
        i: cython.Py_ssize_t
        x: cython.double = at / self.step
        slope: cython.double = self.step / self.spread()
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
