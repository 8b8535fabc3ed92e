"""The equations of a curve at a point, closed by a row and linear there: factored once, then solved with.

The n equations for the n + 1 numbers z and the row make a square matrix, the bordered one, in coordinates
made dimensionless by the problem's scale. Its solutions are the step of Newton's method, the direction of the
curve, and the step that rounding makes; the sign of its determinant is the curve's orientation.
"""

from __future__ import annotations

from typing import Any

import cython
import numpy as np
from cython.cimports.libc.math import fabs, isfinite, sqrt

from fcm.continuation.dense_solver import Solver
from fcm.continuation.options import NewtonOptions
from fcm.continuation.problem import Problem

EPS = cython.declare(cython.double, 2.220446049250313e-16)
DIVERGED = cython.declare(
    cython.double, 1e30
)  # a step of this length, in the curve's own size, leads nowhere


@cython.cclass
class BorderedSystem:
    """Fill z, scale, row and guess; `factor` makes the matrix at z, the others solve with it.

    z, guess, scale, row, tangent: (n + 1,), the parameter last; row and tangent in scaled coordinates. The
    tangent is a unit vector on the side of the row. delta holds a right side, then its solution.
    """

    def __init__(self, problem: Problem) -> None:
        size = problem.unknowns + 1
        self.problem = problem
        self.solver = Solver(0 if problem.rank else size)
        self.delta, self.weights = np.zeros(size), np.zeros(size)
        self.z, self.guess = np.zeros(size), np.zeros(size)
        self.scale, self.row, self.tangent = np.ones(size), np.zeros(size), np.zeros(size)
        self.orientation, self.sign, self.moved = 0.0, 0.0, 0.0
        self.evaluations = 0
        self.poll: Any = None  # called before each evaluation of a costly problem, which it may interrupt

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def factor(self) -> cython.bint:
        """The system closed by the row, at z."""
        i: cython.Py_ssize_t
        j: cython.Py_ssize_t
        n: cython.Py_ssize_t = self.problem.unknowns
        unit: cython.double
        if self.poll is not None and self.problem.costly:
            self.poll()
        self.problem.evaluate(self.z)
        self.evaluations += 1
        if self.problem.rank:
            self.sign = self.problem.factor(self.row, self.scale)
            return self.sign != 0.0
        for i in range(n):
            unit = 1.0 / self.scale[i]
            for j in range(n + 1):
                self.solver.matrix[i, j] = self.problem.jacobian[i, j] * (self.scale[j] * unit)
        for j in range(n + 1):
            self.solver.matrix[n, j] = self.row[j]
        found: cython.bint = self.solver.factor()
        self.sign = self.solver.orientation
        return found

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
        return self.problem.solve(self.delta)

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
        return sqrt(total) if isfinite(total) else 2.0 * DIVERGED

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def compute_tangent(self) -> cython.bint:
        """Tangent and orientation from the system as it is factored, and how far z is from the guess."""
        i: cython.Py_ssize_t
        size: cython.Py_ssize_t = self.problem.unknowns + 1
        total: cython.double = 0.0
        moved: cython.double = 0.0
        self.orientation = self.sign
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
    def rounding(self, options: NewtonOptions) -> cython.double:
        """Length of the Newton step that a relative error of EPS in every number makes, after Skeel.

        Less than that, but more than the last step, where errors of chosen signs already make such a step.
        """
        i: cython.Py_ssize_t
        j: cython.Py_ssize_t
        n: cython.Py_ssize_t = self.problem.unknowns
        least: cython.double = 0.0
        step: cython.double = 0.0
        error: cython.double[::1] = self.weights
        if self.problem.rank:
            return options.rounding_multiple * EPS * sqrt(n + 1)
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
        if sqrt(step) < options.rounding_multiple * sqrt(least):
            return sqrt(least)
        return float(np.linalg.norm(np.abs(self.solver.inverse()) @ np.asarray(error)))
