"""The advancing end of a curve: the step from the place it has come to, and how that is made.

The next place is predicted, then corrected; see `step` for the places between.
"""

from __future__ import annotations

import cython
import numpy as np
from cython.cimports.libc.math import fabs, sqrt

from fcm.continuation import sharp
from fcm.continuation.place import Place
from fcm.continuation.problem import Problem
from fcm.continuation.step import Step

if cython.compiled:
    from cython.cimports.fcm.continuation.bordered import ROUNDINGS
    from cython.cimports.fcm.continuation.newton import CLOSE
    from cython.cimports.fcm.continuation.prediction import Prediction, along
else:
    from fcm.continuation.bordered import ROUNDINGS
    from fcm.continuation.newton import CLOSE
    from fcm.continuation.prediction import Prediction, along

NAN = cython.declare(cython.double, float("nan"))
ASTRAY = cython.declare(cython.double, 0.3)  # of a step: approximate equations that move it further mislead
# error of a place that is corrected once more, or from which the next is looked for and nothing else
PRELIMINARY = cython.declare(cython.double, 1e-9)
SHARP = cython.declare(cython.double, sharp.SHARP)
MISLED = cython.declare(cython.double, 0.5)  # of a step of a soft problem: one that misses by more is refused


@cython.cclass
class Front(Step):
    """`go` finds the place there, `accept` makes that, or one between, the place here."""

    def __init__(self, problem: Problem) -> None:
        Step.__init__(self, problem)
        self.prediction = Prediction(problem.unknowns + 1)
        self.missed, self.strayed = 0.0, 0.0
        self.which = -1  # the margin of which a change of sign was found last ahead of here
        self.close = CLOSE  # to the curve, where a step ends
        self.past = 0.0  # up to here the margins beyond a corner are taken as known
        # from the prediction to where the next place is looked for, scaled: to the far side of a corner here
        self.aside = np.zeros(problem.unknowns + 1)

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def begin(self, z: cython.double[::1], row: cython.double[::1]) -> cython.int:
        """Start from near z, moved to the curve in the plane of row; 0 if there is no curve."""
        self.past, self.here.shift, self.there.shift, self.between.shift = 0.0, 0.0, 0.0, 0.0
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
        self.here.inclined = True
        self.prediction.straighten()
        return 1

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def go(self, step: cython.double) -> cython.bint:
        """Find the place there at a step; missed and cosine say how well it was predicted.

        strayed is the part of missed, of the length of the step, that the parameter has.
        """
        i: cython.Py_ssize_t
        n: cython.Py_ssize_t = self.problem.unknowns
        missed: cython.double = 0.0
        self.prediction.put(self.here, self.newton.scale, step, self.guess)
        for i in range(self.guess.shape[0]):
            self.guess[i] += self.newton.scale[i] * self.aside[i]
            self.newton.z[i], self.newton.row[i] = self.guess[i], self.here.tangent[i]
        if not self.sought(step) or not self.exactly():
            return False
        for i in range(self.guess.shape[0]):
            missed += ((self.newton.z[i] - self.guess[i]) / self.newton.scale[i]) ** 2
        # shorter steps would miss the curve by as much where rounding made the miss
        rounding: cython.double = ROUNDINGS * self.newton.unsure
        strayed: cython.double = fabs(self.newton.z[n] - self.guess[n]) / self.newton.scale[n]
        self.step, self.missed = step, max(sqrt(missed) - rounding, 0.0) / step
        self.strayed = max(strayed - rounding, 0.0) / step
        self.cosine = along(self.here.tangent, self.newton.tangent)
        self.record(self.there, True, True)
        return True

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def incline(self) -> cython.int:
        """Give the margins here and there their slopes, if they have none yet."""
        if not self.there.inclined:
            self.there.incline(self.problem, self.newton.scale, self.guess)
        if not self.here.inclined:
            self.here.incline(self.problem, self.newton.scale, self.guess)
        return 0

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
        """Correct the place there, with the approximate equations first if there are any."""
        if self.problem.soft and step > SHARP:
            return self.newton.correct(step, MISLED * step)
        if self.problem.coarse and self.twice(step):
            return True
        return self.roughly(step, self.close)

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def roughly(self, step: cython.double, close: cython.double) -> cython.bint:
        """Correct the place there, so that it is as close to the curve as that."""
        self.newton.close = close
        found: cython.bint = self.newton.correct(step)
        self.newton.close = CLOSE
        return found

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def twice(self, step: cython.double) -> cython.bint:
        """Correct the place there with the approximate equations, then with the exact ones.

        What those change is its shift; NaN where the approximate ones had no solution. Where both are the
        same there is nothing to change; whether they are is as it was where they were evaluated last, mostly.
        """
        close: cython.double = PRELIMINARY if self.problem.differs() else CLOSE
        self.problem.refine(False)
        near: cython.bint = self.roughly(step, close) and self.newton.moved < ASTRAY * step
        self.problem.refine(True)
        self.there.shift = 0.0
        if near and close == CLOSE and not self.problem.differs():
            return True
        if near and self.newton.correct(step) and self.newton.moved < ASTRAY * step:
            self.there.shift = self.newton.moved if self.problem.differs() else 0.0
            return True
        self.newton.z[:] = self.guess
        self.there.shift = NAN
        return False

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def accept(self, place: Place, length: cython.double) -> cython.int:
        """Go on from a place at a length from here, 0 beyond a corner, in the scale that is right for it."""
        self.problem.measure(place.z)
        scale: cython.double[::1] = self.newton.scale
        new: cython.double[::1] = self.problem.scale
        if self.problem.soft:
            self.prediction.learn(self.here, place, scale, new, length)
        unit: cython.double = self.prediction.rescale(self.here, place, scale, new, length)
        self.newton.scale[:] = self.problem.scale
        self.here.like(place, unit)
        self.past = 0.0
        self.aside[:] = 0.0
        return 0

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
