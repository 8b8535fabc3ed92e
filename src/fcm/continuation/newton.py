r"""Newton's method for a point of a curve, in coordinates made dimensionless by the problem's scale.

The n equations for the n + 1 numbers z are closed by a row: the point is sought in the plane through the
guess whose normal is the row. A row along the curve gives the next point; a row along the parameter holds
that. The same matrix gives the direction of the curve, and the sign of its determinant the orientation.
"""

from __future__ import annotations

import cython
import numpy as np
from cython.cimports.libc.math import fabs, isfinite, sqrt

from fcm.continuation.dense import Solver
from fcm.continuation.problem import Problem

ITERATIONS = cython.declare(cython.int, 8)  # Newton steps before a guess is judged too far away
CLOSE = cython.declare(cython.double, 1e-13)  # error of a point, estimated from the convergence
SMALL = cython.declare(cython.double, 1e-12)  # a step after which there is no further one
EXACT = cython.declare(cython.double, 1e-11)  # a step that is not worth another evaluation
ROUGH = cython.declare(cython.double, 1e-9)  # and one that does not shrink, though the way was long
EPS = cython.declare(cython.double, 2.220446049250313e-16)
FAR = cython.declare(cython.double, 1e30)  # a step of this length, in the curve's own size, leads nowhere
CHORD = cython.declare(cython.double, 1e-6)  # a step after which the Jacobian from before it will do
HOPELESS = cython.declare(cython.double, 0.5)  # of the step before, from the fourth on, where each is dear
SLIGHT = cython.declare(cython.double, 1e-3)  # of the most: a second step this short is no sign of failure
CHORDS = cython.declare(cython.int, 3)  # steps with that Jacobian
ROUNDINGS = cython.declare(
    cython.double, 8.0
)  # a step that does not shrink and is no longer than these is one
COARSEST = cython.declare(cython.double, 1e-6)  # and no longer than this


@cython.cclass
class Newton:
    """Fill z, scale and row; `correct` moves z to the curve and leaves its tangent and orientation.

    z, scale, row, tangent: (n + 1,), the parameter last; row and tangent in scaled coordinates. The tangent
    is a unit vector on the side of the row.
    """

    def __init__(self, problem: Problem) -> None:
        size = problem.unknowns + 1
        self.problem = problem
        self.solver = Solver(problem.rank + 1 if problem.rank else size)
        self.delta, self.closing = np.zeros(size), np.zeros(size)
        self.z, self.guess = np.zeros(size), np.zeros(size)
        self.scale, self.row, self.tangent = np.ones(size), np.zeros(size), np.zeros(size)
        self.orientation, self.moved = 0.0, 0.0
        self.unsure = 0.0  # length of the last step of `correct`, if rounding made it
        self.evaluations = 0

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def correct(self, reach: cython.double, most: cython.double = FAR) -> cython.bint:
        """Whether z came to the curve; moved is then how far, and tangent and orientation are those there.

        reach is the length, in scaled coordinates, that stands before the first step. Where that is longer
        than the most, or the second neither slight nor half as long, it is given up; moved is then the first.
        Converged is what has an error below CLOSE, for convergence of the order 1.5, that of a force whose
        slope changes as a root.
        """
        i: cython.Py_ssize_t
        size: cython.Py_ssize_t = self.problem.unknowns + 1
        count: cython.int
        step: cython.double
        ratio: cython.double
        limit: cython.double
        before: cython.double = reach
        self.guess[:] = self.z
        self.unsure = 0.0
        for count in range(ITERATIONS):
            if not self.factor():
                return False
            step = self.step()
            if most < FAR:
                if count == 0:
                    self.moved = step
                    limit = most
                elif count == 1:  # of short steps the first may be rounding, in a stiff direction
                    limit = max(0.5 * before, SLIGHT * most)
                else:
                    limit = FAR
                if not step < limit:
                    return False
            if self.problem.soft and step < before and self.settled(step, step / before, count):
                return self.direct()
            noise: cython.bint = count > 0 and step > 0.25 * before and self.noise(step, count)
            worse: cython.double = HOPELESS if self.problem.soft else 2.0
            if not step < FAR or (count > 2 and step > worse * before and not noise):
                return False
            for i in range(size):
                self.z[i] += self.scale[i] * self.delta[i]
            ratio = step / before
            # the first step says nothing of the convergence yet; that to a corner that is not seen never
            if self.problem.soft:
                if count > 0 and step * ratio < CHORD and self.chords(step):
                    return self.direct()
                before = step
                continue
            if (count > 0 and step * ratio * sqrt(ratio) < CLOSE) or step < SMALL:
                return self.direct()
            if noise:
                self.unsure = step
                return self.direct()
            before = step
        return False

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def noise(self, step: cython.double, count: cython.int) -> cython.bint:
        """Whether a step that has not shrunk is one that rounding makes.

        Of what the equations lose to cancellation within them their derivatives know nothing.
        """
        if self.problem.soft:
            return False
        return (count > 2 and step < ROUGH) or (step < COARSEST and step < ROUNDINGS * self.rounding())

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def settled(self, step: cython.double, ratio: cython.double, count: cython.int) -> cython.bint:
        """Whether z, from which a step would lead on, is as near to the curve as rounding lets it be."""
        if step < EXACT:
            return True
        return count > 0 and ratio > 0.25 and step < ROUGH

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def chords(self, before: cython.double) -> cython.bint:
        """Whether z, to which a step has led, is on the curve; else it is moved on with the same Jacobian."""
        i: cython.Py_ssize_t
        count: cython.int
        step: cython.double
        for count in range(CHORDS):  # noqa: B007
            self.problem.probe(self.z)
            step = self.step()
            if step < EXACT:
                return True
            if not step < 0.1 * before:
                return False
            for i in range(self.problem.unknowns + 1):
                self.z[i] += self.scale[i] * self.delta[i]
            before = step
        return False

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def look(self) -> cython.bint:
        """Tangent and orientation at z as it stands; false if they are not determined there."""
        self.guess[:] = self.z
        return self.factor() and self.direct()

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def factor(self) -> cython.bint:
        """The system closed by the row, at z."""
        i: cython.Py_ssize_t
        j: cython.Py_ssize_t
        n: cython.Py_ssize_t = self.problem.unknowns
        unit: cython.double
        self.problem.evaluate(self.z)
        self.evaluations += 1
        if self.problem.rank:
            for i in range(n + 1):
                self.closing[i] = self.row[i] / self.scale[i]
            self.problem.condense(self.closing, self.solver.matrix)
            return self.solver.factor()
        for i in range(n):
            unit = 1.0 / self.scale[i]
            for j in range(n + 1):
                self.solver.matrix[i, j] = self.problem.jacobian[i, j] * (self.scale[j] * unit)
        for j in range(n + 1):
            self.solver.matrix[n, j] = self.row[j]
        return self.solver.factor()

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def solve(self) -> cython.int:
        """Replace delta, a right side, by the solution of the system as it is factored."""
        i: cython.Py_ssize_t
        n: cython.Py_ssize_t = self.problem.unknowns
        if not self.problem.rank:
            for i in range(n + 1):
                self.solver.right[i] = self.delta[i]
            self.solver.solve()
            for i in range(n + 1):
                self.delta[i] = self.solver.right[i]
            return 0
        for i in range(n):
            self.delta[i] *= self.scale[i]
        self.problem.shorten(self.delta, self.solver.right)
        self.solver.solve()
        self.problem.lengthen(self.solver.right, self.delta)
        for i in range(n + 1):
            self.delta[i] /= self.scale[i]
        return 0

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def step(self) -> cython.double:
        """Length of the Newton step, which is left in delta."""
        i: cython.Py_ssize_t
        n: cython.Py_ssize_t = self.problem.unknowns
        total: cython.double = 0.0
        off: cython.double = 0.0
        for i in range(n):
            self.delta[i] = -self.problem.residual[i] / self.scale[i]
        for i in range(n + 1):
            off += self.row[i] * (self.z[i] - self.guess[i]) / self.scale[i]
        self.delta[n] = -off
        self.solve()
        for i in range(n + 1):
            total += self.delta[i] * self.delta[i]
        return sqrt(total) if isfinite(total) else 2.0 * FAR

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def direct(self) -> cython.bint:
        """Tangent and orientation from the system as it is factored, and how far z is from the guess."""
        i: cython.Py_ssize_t
        size: cython.Py_ssize_t = self.problem.unknowns + 1
        total: cython.double = 0.0
        moved: cython.double = 0.0
        self.orientation = self.solver.orientation
        for i in range(size):
            self.delta[i] = 0.0
        self.delta[size - 1] = 1.0
        self.solve()
        for i in range(size):
            total += self.delta[i] * self.delta[i]
            moved += ((self.z[i] - self.guess[i]) / self.scale[i]) ** 2
        if not (isfinite(total) and total > 0.0):
            return False
        for i in range(size):
            self.tangent[i] = self.delta[i] / sqrt(total)
        self.moved = sqrt(moved)
        return True

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def rounding(self) -> cython.double:
        """Length of the Newton step that a relative error of EPS in every number makes, after Skeel.

        Less than that, but more than the last step, where errors of chosen signs already make such a step.
        """
        i: cython.Py_ssize_t
        j: cython.Py_ssize_t
        n: cython.Py_ssize_t = self.problem.unknowns
        least: cython.double = 0.0
        step: cython.double = 0.0
        error: cython.double[::1] = self.closing
        if self.problem.rank:
            return ROUNDINGS * EPS * sqrt(n + 1)
        for i in range(n + 1):
            unit: cython.double = EPS / self.scale[i] if i < n else EPS
            error[i] = 0.0
            for j in range(n + 1):
                if i < n:
                    error[i] += unit * fabs(self.problem.jacobian[i, j] * self.z[j])
                else:
                    error[i] += unit * fabs(self.row[j] * self.z[j] / self.scale[j])
            self.solver.right[i] = error[i] if i % 2 == 0 else -error[i]
        self.solver.solve()
        for i in range(n + 1):
            least += self.solver.right[i] * self.solver.right[i]
            step += self.delta[i] * self.delta[i]
        if sqrt(step) < ROUNDINGS * sqrt(least):
            return sqrt(least)
        return float(np.linalg.norm(np.abs(self.solver.inverse()) @ np.asarray(error)))
