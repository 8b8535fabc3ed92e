"""A step along a curve: the place where it begins, that where it ends, and places between the two.

Lengths are measured in the problem's scale at the place `here`. A place at the length s lies in the plane
through here + s tangent whose normal is that tangent.
"""

from __future__ import annotations

import cython
import numpy as np

from fcm.continuation.newton import Newton
from fcm.continuation.place import Place
from fcm.continuation.problem import Problem

if cython.compiled:
    from cython.cimports.fcm.continuation.prediction import FLAT, along
else:
    from fcm.continuation.prediction import FLAT, along


@cython.cclass
class Step:
    """From `here` to `there`, which is `step` long; `put` and others find the place `between`.

    cosine: that of the angle by which the direction there differs from that here.
    """

    def __init__(self, problem: Problem) -> None:
        self.problem, self.newton = problem, Newton(problem)
        self.here, self.there, self.between = Place(problem), Place(problem), Place(problem)
        self.guess = np.zeros(problem.unknowns + 1)
        self.step, self.cosine = 0.0, 1.0

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def put(self, at: cython.double, margins: cython.bint, outputs: cython.bint) -> cython.bint:
        """Find the place between here and there at a length from here, with its margins, its outputs."""
        i: cython.Py_ssize_t
        self.interpolate(at)
        for i in range(self.guess.shape[0]):
            self.newton.z[i], self.newton.row[i] = self.guess[i], self.here.tangent[i]
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
        there; the shift of the step stays."""
        if not self.put(at, False, False) or not self.sharpen(True, True):
            return False
        self.step, self.cosine = at, along(self.here.tangent, self.between.tangent)
        self.between.shift = self.there.shift
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

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def record(self, place: Place, margins: cython.bint, outputs: cython.bint) -> cython.int:
        """The corrector's result as a place, with its margins, its outputs."""
        i: cython.Py_ssize_t
        place.orientation, place.inclined = self.newton.orientation, False
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
        """Length in the plane of here that a length along the tangent there has: the cosine."""
        return self.cosine if self.cosine > FLAT else FLAT

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
