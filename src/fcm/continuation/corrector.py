"""Newton's method for a point of a curve: the corrector, and the bordered system that it solves.

The n equations for the n + 1 numbers z and one row make the square bordered matrix, in coordinates scaled by
the problem's scale. The system yields the Newton step and the tangent of the curve. The sign of the
determinant is the orientation of the curve.

The row is the normal of the plane through the guess in which the corrector seeks the point. A row along the
curve gives the next point; a row along the parameter holds the parameter. `distances` takes one Newton step
across a path at each point, which tells how far the path is from the curve of a nearby problem.
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
    """Bordered system: fill z, scale, row and guess; `factor` factors it at z, the other functions solve it.

    z, guess, scale, row and tangent are (n + 1,), the parameter last; row and tangent in scaled coordinates.
    The tangent is a unit vector on the side of the row. delta holds a right side, then its solution.
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
        self.poll: Any = None  # called before each evaluation of a costly problem; may interrupt it

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def factor(self) -> cython.bint:
        """Evaluate the problem at z and factor its bordered matrix; false if it is singular."""
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
        """Replace the right side delta by the solution of the factored system."""
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
        """Compute the Newton step into delta, and return its scaled length."""
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
        """Compute tangent and orientation from the factored system, and the distance of z from the guess."""
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
        """Whether the backward error of each equation is at most `errors` times EPS (Oettli, Prager, 1964).

        Near the onset of a root, a step may be as short as rounding makes it elsewhere, while the residual is
        far larger. The relative error of a number refers to its unit if the number is smaller.
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
    """The corrector: fill z, scale and row; `correct` moves z to the curve, with tangent and orientation.

    tolerance: the admissible error of a point, estimated from the convergence.
    """

    def __init__(self, problem: Problem, options: NewtonOptions = NEWTON) -> None:
        BorderedSystem.__init__(self, problem)
        self.options = options
        self.tolerance = self.options.tolerance
        self.rounding_step = 0.0  # length of the last step of `correct` if that step is rounding

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def correct(self, reach: cython.double, most: cython.double = INFINITY) -> cython.bint:
        """Move z to the curve and compute its tangent and orientation there; return whether that converges.

        `moved` is then the distance from the guess. reach is the scaled length that stands for a step before
        the first. `correct` gives up if the first step is longer than `most`, or if the second is neither
        slight nor much shorter; `moved` is then the length of the first step. The convergence test assumes
        the order 1.5, that of a force whose slope changes as a root.
        """
        i: cython.Py_ssize_t
        for i in range(self.z.shape[0]):  # copying the whole array at once takes ten times as long
            self.guess[i] = self.z[i]
        if self.converges(reach, most):
            return True
        return self.problem.has_root_margins and most == INFINITY and self.correct_by_half_steps(reach)

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def single_step(self) -> cython.bint:
        """Take one Newton step from z; false if there is none or it is too long."""
        self.guess[:] = self.z
        if not self.factor() or not self.step() < self.options.max_step:
            return False
        _move(self)
        return True

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def correct_by_half_steps(self, reach: cython.double) -> cython.bint:
        """Correct z from the guess once more, by half steps first; false also if the half steps grow.

        Some equations begin as the root of a distance d > 0, for example where a circle begins to slip. A
        whole step then leads from d to 2 sqrt(d d0) - d, which is beyond the corner if d > 4 d0. Half a step
        leads to sqrt(d d0). So half steps approach d0 from any distance, and whole steps converge from less
        than 4 d0.
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
        """Correct z by whole Newton steps; return whether they converge. See `correct`."""
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
            # the first step does not show the convergence yet; steps to a corner that no margin shows never
            # do
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
        """Whether the first step is longer than `most`, or the second neither slight nor much shorter."""
        if count == 0:
            self.moved = step
            return not step < most
        if count == 1:  # short steps: the first may be rounding in a stiff direction
            slight: cython.double = self.options.small_second_step * most
            return not step < max(self.options.max_second_ratio * before, slight)
        return not step < self.options.max_step

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def is_rounding(self, step: cython.double, count: cython.int) -> cython.bint:
        """Whether a step that has not shrunk is due to rounding.

        Cancellation within the equations loses digits, which the derivatives do not show. So a step that
        stalls is rounding as well, unless the equations begin as a root. The derivatives of a condensed
        system are not known; there the length of the step decides.
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
        """Whether z, before the step is taken, is as near to the curve as rounding permits.

        Among steps that are rounding, the next one may be longer.
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
        """Take Newton steps with the same Jacobian from the end of a step; return whether they converge."""
        return _chord_steps(self, before, self.options.max_chord_steps, self.options.chord_contraction)

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def take_tangent(self) -> cython.bint:
        """Compute tangent and orientation at the present z; false if they are not determined there."""
        self.guess[:] = self.z
        return self.factor() and self.compute_tangent()


@cython.cfunc
@cython.exceptval(-1, check=False)
def _last_chord_step(newton: Newton, before: cython.double) -> cython.bint:
    """Take a last Newton step with the same Jacobian if it converges; return whether it does.

    before: the length of the step before. The error after the last step is smaller by the same ratio. A step
    that does not converge is not taken.
    """
    newton.problem.evaluate_residual(newton.z)
    step: cython.double = newton.step()
    if not step * step < newton.tolerance * before:
        return False
    _move(newton)
    return True


def correct_with_kept_jacobian(newton: Newton, most: float) -> bool:
    """Correct newton's z where the tangent does not matter; return whether that converges.

    As `Newton.correct` with reach 1, but a Jacobian is kept as long as steps with it shrink.
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
    """Take at most `most` Newton steps with the same Jacobian from z, the end of a step, until they converge.

    Each has to be shorter than `ratio` times the one before. Return whether they converge.
    """
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
    """Scaled lengths (point,) of Newton steps from points z (point, n + 1) to the curve; NaN without a step.

    direction (point, n + 1) is the normal of the plane in which each step is taken.
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
