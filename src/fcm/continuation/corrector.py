"""Newton's method for a point of a curve: the corrector, and the bordered system that it solves.

The n equations for the n + 1 numbers z and the row make a square matrix, the bordered one, in coordinates
made dimensionless by the problem's scale. Its solutions are the step of Newton's method and the direction of
the curve; the sign of its determinant is the curve's orientation.

The point is sought in the plane through the guess whose normal is the row that closes the equations. A row
along the curve gives the next point; a row along the parameter holds that. One step across a path tells how
far it is from the curve of a problem nearby: `distances`.
"""

from __future__ import annotations

from typing import Any

import cython
import numpy as np
from cython.cimports.libc.math import fabs, isfinite, sqrt

from fcm.continuation.dense_solver import Solver
from fcm.continuation.options import NEWTON, NewtonOptions
from fcm.continuation.path import FloatArray
from fcm.continuation.problem import Problem

EPS = cython.declare(cython.double, 2.220446049250313e-16)
INFINITY = cython.declare(cython.double, float("inf"))


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
        self.delta = np.zeros(size)
        self.z, self.guess = np.zeros(size), np.zeros(size)
        self.scale, self.row, self.tangent = np.ones(size), np.zeros(size), np.zeros(size)
        self.orientation, self.sign, self.moved = 0.0, 0.0, 0.0
        self.evaluations = 0
        self.poll: Any = None  # called before each evaluation of a costly problem, which it may interrupt

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def factor(self) -> cython.bint:
        """Evaluate the problem at z and factor its equations, closed by the row; false if they are
        singular."""
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
        """Compute the Newton step, which is left in delta, and return its scaled length."""
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
        return sqrt(total) if isfinite(total) else INFINITY

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def compute_tangent(self) -> cython.bint:
        """Compute tangent and orientation from the system as it is factored, and how far z was moved."""
        i: cython.Py_ssize_t
        size: cython.Py_ssize_t = self.problem.unknowns + 1
        total: cython.double = 0.0
        moved: cython.double = 0.0
        for i in range(size):
            self.delta[i] = 0.0
        self.delta[size - 1] = 1.0
        self.solve()
        self.orientation = self.problem.solved_sign() if self.problem.rank else self.sign
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
    def is_solved(self, errors: cython.double) -> cython.bint:
        """Whether no equation is off by more than what so many relative errors of EPS in every number make.

        That is the backward error of each (Oettli, Prager, 1964). Next to the onset of a root a step may be
        no longer than that of rounding elsewhere, and the equation is off by far more. A number that is 0
        comes of others as large as its unit.
        """
        i: cython.Py_ssize_t
        j: cython.Py_ssize_t
        n: cython.Py_ssize_t = self.problem.unknowns
        error: cython.double
        for i in range(n):
            error = 0.0
            for j in range(n + 1):
                error += fabs(self.problem.jacobian[i, j]) * max(fabs(self.z[j]), self.scale[j])
            if not fabs(self.problem.residual[i]) <= errors * EPS * error:
                return False
        return True


@cython.cclass
class Newton(BorderedSystem):
    """Fill z, scale and row; `correct` moves z to the curve and leaves its tangent and orientation.

    tolerance: the error that a point may have, estimated from the convergence.
    """

    def __init__(self, problem: Problem, options: NewtonOptions = NEWTON) -> None:
        BorderedSystem.__init__(self, problem)
        self.options = options
        self.tolerance = self.options.tolerance
        self.rounding_step = 0.0  # length of the last step of `correct`, if rounding made it

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def correct(self, reach: cython.double, most: cython.double = INFINITY) -> cython.bint:
        """Whether z came to the curve; moved is then how far, and tangent and orientation are those there.

        reach is the length, in scaled coordinates, that stands before the first step. Where that is longer
        than the most, or the second neither slight nor much shorter, it is given up; moved is then the first.
        A point counts as converged by the order 1.5, that of a force whose slope changes as a root.
        """
        i: cython.Py_ssize_t
        for i in range(self.z.shape[0]):  # a copy of all at once takes ten times as long
            self.guess[i] = self.z[i]
        if self.converges(reach, most):
            return True
        return self.problem.has_root_margins and most == INFINITY and self.correct_by_half_steps(reach)

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def single_step(self) -> cython.bint:
        """Take one Newton step from z; false if there is none."""
        self.guess[:] = self.z
        if not self.factor() or not self.step() < self.options.max_step:
            return False
        _move(self)
        return True

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def correct_by_half_steps(self, reach: cython.double) -> cython.bint:
        """Correct z from the guess once more, by half steps first; false also where these grow.

        Where the equations begin as the root of a distance d > 0, as where a circle begins to slip, a whole
        step leads from d to 2 sqrt(d d0) - d. That is beyond the corner if d > 4 d0. Half a step leads to
        sqrt(d d0). So half steps approach d0 from any distance, and the whole ones converge from less than 4
        d0.
        """
        count: cython.int
        i: cython.Py_ssize_t
        step: cython.double
        before: cython.double = reach
        self.z[:] = self.guess
        for count in range(self.options.half_steps):
            if not self.factor():
                return False
            step = self.step()
            if not step < self.options.max_step or (count > 1 and step > before):
                return False
            for i in range(self.z.shape[0]):
                self.z[i] += 0.5 * self.scale[i] * self.delta[i]
            before = step
        return self.converges(reach, INFINITY)

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def converges(self, reach: cython.double, most: cython.double) -> cython.bint:
        """Correct z by whole Newton steps; whether they converge. See `correct`."""
        count: cython.int
        step: cython.double
        ratio: cython.double
        before: cython.double = reach
        self.rounding_step = 0.0
        for count in range(self.options.max_iterations):
            if not self.factor():
                return False
            step = self.step()
            if most < INFINITY and self.too_far(step, before, most, count):
                return False
            if self.problem.labelled and self.at_rounding(step, step / before, count):
                return self.compute_tangent()
            stays: cython.bint = count > 0 and step > self.options.rounding_ratio * before
            noise: cython.bint = stays and self.is_rounding(step, count)
            hasten: cython.bint = self.problem.labelled or self.problem.costly
            worse: cython.double = self.options.divergence_ratio if hasten else self.options.max_growth
            if not step < self.options.max_step or (count > 2 and step > worse * before and not noise):
                return False
            if noise:
                self.rounding_step = step
                return self.compute_tangent()
            _move(self)
            ratio = step / before
            # the first step says nothing of the convergence yet; that to a corner that is not seen never
            if self.problem.labelled:
                if count > 0 and step * ratio < self.options.chord_step and self.chord_steps(step):
                    return self.compute_tangent()
                before = step
                continue
            if (count > 0 and step * ratio * sqrt(ratio) < self.tolerance) or step < self.options.final_step:
                return self.compute_tangent()
            # the Jacobian hardly changes along a step that is shorter than the square of the one before
            steady: cython.bint = count > 0 and (self.problem.costly or step < before * before)
            if steady and step < self.options.last_chord_step and _last_chord_step(self, step):
                return self.compute_tangent()
            before = step
        return False

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def too_far(
        self, step: cython.double, before: cython.double, most: cython.double, count: cython.int
    ) -> cython.bint:
        """Whether the first step is longer than the most, or the second neither slight nor much shorter."""
        if count == 0:
            self.moved = step
            return not step < most
        if count == 1:  # of short steps the first may be rounding, in a stiff direction
            slight: cython.double = self.options.small_second_step * most
            return not step < max(self.options.max_second_ratio * before, slight)
        return not step < self.options.max_step

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def is_rounding(self, step: cython.double, count: cython.int) -> cython.bint:
        """Whether a step that has not shrunk is one that rounding makes.

        Equations may lose digits to cancellation within them, of which their derivatives know nothing: a step
        that stalls is rounding, too, but where they begin as a root. Of those that are condensed the
        derivatives are not known, and the length of the step tells.
        """
        if self.problem.labelled:
            return False
        most: cython.double = self.options.rounding_multiple
        stalled: cython.bint = count > 2 and step < self.options.stalled_rounding
        if stalled and (self.problem.rank or not self.problem.has_root_margins):
            return True
        if self.problem.rank:
            return step < most * most * EPS * sqrt(self.problem.unknowns + 1)
        return step < self.options.max_rounding and self.is_solved(most)

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def at_rounding(self, step: cython.double, ratio: cython.double, count: cython.int) -> cython.bint:
        """Whether z, from which a step would lead on, is as near to the curve as rounding lets it be.

        Of the steps that rounding makes the next one may be longer.
        """
        if step < self.options.negligible_step and ratio < 1.0:
            return True
        return (
            count > 0
            and ratio > self.options.rounding_ratio
            and step < (self.options.stalled_rounding if ratio < 1.0 else self.options.growing_rounding)
        )

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def chord_steps(self, before: cython.double) -> cython.bint:
        """Take Newton steps with the same Jacobian from the end of a step; whether they come to the curve."""
        return _chord_steps(self, before, self.options.max_chord_steps, self.options.chord_contraction)

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def take_tangent(self) -> cython.bint:
        """Compute tangent and orientation at z as it stands; false if they are not determined there."""
        self.guess[:] = self.z
        return self.factor() and self.compute_tangent()


@cython.cfunc
@cython.exceptval(-1, check=False)
def _last_chord_step(newton: Newton, before: cython.double) -> cython.bint:
    """Take a last Newton step with the same Jacobian, if it leads to the curve; whether it does.

    before: the length of the step before. What the last one leaves is less by as much again; one that does
    not lead to the curve is not taken.
    """
    newton.problem.evaluate_residual(newton.z)
    step: cython.double = newton.step()
    if not step * step < newton.tolerance * before:
        return False
    _move(newton)
    return True


def correct_with_kept_jacobian(newton: Newton, most: float) -> bool:
    """Correct newton's z where the direction does not matter: whether it came to the curve.

    As `Newton.correct` from a length of 1; a Jacobian is kept as long as steps with it shrink.
    """
    count: cython.int
    step: cython.double
    before: cython.double = 1.0
    newton.guess[:] = newton.z
    for count in range(newton.options.max_iterations):
        if not newton.factor():
            return False
        step = newton.step()
        if newton.too_far(step, before, most, count):
            return False
        _move(newton)
        if step < newton.options.final_step or _chord_steps(
            newton, step, newton.options.max_cheap_chord_steps, newton.options.cheap_chord_contraction
        ):
            return bool(newton.compute_tangent())
        before = step
    return False


@cython.cfunc
@cython.exceptval(-1, check=False)
def _chord_steps(
    newton: Newton, before: cython.double, most: cython.int, ratio: cython.double
) -> cython.bint:
    """Whether at most so many steps with the same Jacobian lead from z, the end of a step, to the curve.

    Each has to be shorter than the one before by a ratio."""
    count: cython.int
    step: cython.double
    for count in range(most):  # noqa: B007
        newton.problem.evaluate_residual(newton.z)
        step = newton.step()
        if step < newton.options.negligible_step:
            return True
        if not step < ratio * before:
            return False
        _move(newton)
        before = step
    return False


@cython.cfunc
@cython.exceptval(check=False)
def _move(newton: Newton) -> cython.void:
    """Add the Newton step that is in delta to newton's z."""
    i: cython.Py_ssize_t
    for i in range(newton.problem.unknowns + 1):
        newton.z[i] += newton.scale[i] * newton.delta[i]


def distances(newton: Newton, z: FloatArray, direction: FloatArray) -> FloatArray:
    """Scaled lengths (point,) of the Newton steps from points z (point, n + 1) to the curve, else NaN.

    Each step is taken across a direction at its point, (point, n + 1).
    """
    found = np.full(len(z), np.nan)
    _fill(newton, z, direction, found)
    return found


def _fill(
    newton: Newton, z: cython.double[:, ::1], direction: cython.double[:, ::1], found: cython.double[::1]
) -> None:
    i: cython.Py_ssize_t
    k: cython.Py_ssize_t
    for i in range(z.shape[0]):
        newton.problem.evaluate_scale(z[i])
        total: cython.double = 0.0
        for k in range(z.shape[1]):
            newton.scale[k], newton.z[k] = newton.problem.scale[k], z[i, k]
            newton.row[k] = direction[i, k] / newton.scale[k]
            total += newton.row[k] * newton.row[k]
        for k in range(z.shape[1]):
            newton.row[k] /= sqrt(total)
        if newton.single_step():
            total = 0.0
            for k in range(z.shape[1]):
                total += ((newton.z[k] - z[i, k]) / newton.scale[k]) ** 2
            found[i] = sqrt(total)
