"""The surface of a balance's solutions at all frequencies and levels of the forces, and its folds.

The solutions of the n equations F(x, omega, lambda) = 0 for the displacements x, the frequency omega and the
level lambda form a surface, also where dF/dx is singular. Two axes e_1, e_2 through a known place c, in the
scaled unknowns z = (x, omega, lambda), determine another place on it:

    F(z) = 0,   e_1 . (z - c) = a,   e_2 . (z - c) = b.

The same matrix gives the tangents t_1, t_2 of the surface there: DF t = 0; e_i . t_j = 1 if i = j, else 0.
Where the surface folds over (omega, lambda), the tangents' components in these two are dependent:

    g = t_1,omega t_2,lambda - t_1,lambda t_2,omega = 0,

which is the bordered test function of a fold with a border of two rows (Govaerts, "Numerical Methods for
Bifurcations of Dynamical Equilibria", 2000, chapters 3 and 4). Its sign changes also at a fold in a corner.

With many contacts, a condensed system determines displacements and frequency y = (x, omega) at one level,
closed by a row r. Its solutions for the right sides -F_lambda and r . y = 1 alone are y_l and y_r. Then
y = y_0 + y_l lambda + y_r rho, and the two axes give two equations for lambda and rho (block elimination,
Govaerts 2000, section 3.2). The row is the combination of the axes that does not change the level.

`FoldSteps` are the steps along a curve of folds, see `fcm.branches.fold_continuation`.
"""

from __future__ import annotations

from collections.abc import Callable
from enum import Enum
from itertools import pairwise

import cython
import numpy as np
from cython.cimports.libc.math import atan2, cos, fabs, isfinite, sin, sqrt

from fcm.branches.options import SURFACE, FoldOptions, SurfaceOptions
from fcm.continuation.dense_solver import Solver
from fcm.harmonic_balance.residual import Balance
from fcm.model.scene import FloatArray


@cython.cclass
class Surface:
    """Points of the surface of solutions at all frequencies and levels, about a centre.

    Call `begin` at a place, then `find` for places near it: z is the place, value its test function g.

    z, centre, scale (n + 2,): displacements, frequency [rad/s], level. axes, tangents (2, n + 2): scaled.
    """

    def __init__(self, balance: Balance, options: SurfaceOptions = SURFACE) -> None:
        n: cython.int = balance.unknowns
        self.level_floor, self.diverged_step, self.max_iterations = (
            options.level_floor,
            options.diverged_step,
            options.max_iterations,
        )
        self.tolerance, self.singular_step = options.tolerance, options.singular_step
        self.balance, self.n, self.evaluations, self.value = balance, n, 0, 0.0
        self.z, self.centre, self.right = np.zeros(n + 2), np.zeros(n + 2), np.zeros(n + 2)
        self.scale, self.balance_point = np.ones(n + 2), np.zeros(n + 1)
        self.axes, self.tangents = np.zeros((2, n + 2)), np.zeros((2, n + 2))
        self.condensed = balance.rank > 0
        self.row, self.at_level, self.by_level = np.zeros((3, n + 1))
        self.solver = Solver(2 if self.condensed else n + 2)

    def begin(self, z: cython.double[::1], along: cython.double[::1], across: cython.double[::1]) -> bool:
        """Go to the surface from near it, in the plane across two directions (n + 2,), in the units of z.

        False if no place is found. The first axis is then the tangent nearest to the first direction.
        """
        self.z[:] = z
        if not (self.recentre(across, along) and self.find(0.0, 0.0)):
            return False
        return bool(self.recentre(np.asarray(self.tangents)[1] * self.scale, across))

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def recentre(self, along: cython.double[::1], across: cython.double[::1]) -> cython.bint:
        """Take z as the centre, with other axes (n + 2,), in the units of z; false if these are dependent."""
        i: cython.Py_ssize_t
        self.centre[:] = self.z
        self.evaluate_scale(self.z)
        for i in range(self.n + 2):
            self.axes[0, i], self.axes[1, i] = along[i] / self.scale[i], across[i] / self.scale[i]
        return self.orthonormalise()

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def evaluate_scale(self, z: cython.double[::1]) -> cython.int:
        """Set the units of lengths at a place: those of the balance, and the level's own size."""
        i: cython.Py_ssize_t
        for i in range(self.n + 1):
            self.balance_point[i] = z[i]
        self.balance.evaluate_scale(self.balance_point)
        for i in range(self.n + 1):
            self.scale[i] = self.balance.scale[i]
        self.scale[self.n + 1] = max(fabs(z[self.n + 1]), self.level_floor)
        return 0

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def orthonormalise(self) -> cython.bint:
        """Make the axes orthonormal; false if they are dependent."""
        i: cython.Py_ssize_t
        first: cython.double = 0.0
        along: cython.double = 0.0
        second: cython.double = 0.0
        for i in range(self.n + 2):
            first += self.axes[0, i] * self.axes[0, i]
            along += self.axes[0, i] * self.axes[1, i]
        if not (first > 0.0 and isfinite(first)):
            return False
        for i in range(self.n + 2):
            self.axes[1, i] -= along / first * self.axes[0, i]
            second += self.axes[1, i] * self.axes[1, i]
        if not (second > 0.0 and isfinite(second)):
            return False
        first, second = sqrt(first), sqrt(second)
        for i in range(self.n + 2):
            self.axes[0, i] /= first
            self.axes[1, i] /= second
        return True

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def find(self, ahead: cython.double, aside: cython.double) -> cython.bint:
        """Find the place at these lengths along the axes, starting from z; false if there is none."""
        i: cython.Py_ssize_t
        count: cython.int
        step: cython.double
        one: cython.double = ahead
        other: cython.double = aside
        for i in range(self.n + 2):
            one -= self.axes[0, i] * (self.z[i] - self.centre[i]) / self.scale[i]
            other -= self.axes[1, i] * (self.z[i] - self.centre[i]) / self.scale[i]
        for i in range(self.n + 2):
            self.z[i] += self.scale[i] * (one * self.axes[0, i] + other * self.axes[1, i])
        for count in range(self.max_iterations):  # noqa: B007
            if not self.factor():
                return False
            step = self.correct(ahead, aside)
            if not step < self.diverged_step:
                return False
            if step < self.tolerance:
                return (step < self.singular_step or self.factor()) and self.compute_tangents()
        return False

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def evaluate(self) -> cython.int:
        """Evaluate the balance at z, with its frequency and level."""
        i: cython.Py_ssize_t
        for i in range(self.n + 1):
            self.balance_point[i] = self.z[i]
        self.balance.load = self.z[self.n + 1]
        self.balance.evaluate(self.balance_point)
        self.evaluations += 1
        return 0

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def forces(self, out: cython.double[::1]) -> cython.int:
        """Fill out (n,) with -F_lambda, scaled: the response of the free structure to the harmonic forces."""
        i: cython.Py_ssize_t
        p: cython.Py_ssize_t
        h: cython.int
        k: cython.int
        unit: cython.double
        b: Balance = self.balance
        for i in range(self.n):
            out[i] = 0.0
        for h in range(b.receptance.count):
            k = b.receptance.forced[h]
            for p in range(b.ports if k >= 0 else 0):
                i = b.receptance.wave_at[p] + b.receptance.stride * h
                unit = self.scale[self.n + 1] / self.scale[i]
                out[i] = b.receptance.X_re[k, p] * unit
                out[i + 1] = b.receptance.X_im[k, p] * unit
        return 0

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def factor(self) -> cython.bint:
        """Evaluate and factor the equations at z, closed by the two axes."""
        self.evaluate()
        return self.factor_condensed() if self.condensed else self.factor_dense()

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def factor_dense(self) -> cython.bint:
        """Factor the whole matrix of the equations, closed by the two axes."""
        n: cython.Py_ssize_t = self.n
        i: cython.Py_ssize_t
        j: cython.Py_ssize_t
        unit: cython.double
        jacobian: cython.double[:, ::1] = self.balance.jacobian
        self.forces(self.right)
        for i in range(n):
            unit = 1.0 / self.scale[i]
            for j in range(n + 1):
                self.solver.matrix[i, j] = jacobian[i, j] * (self.scale[j] * unit)
            self.solver.matrix[i, n + 1] = -self.right[i]
        for j in range(n + 2):
            self.solver.matrix[n, j] = self.axes[0, j]
            self.solver.matrix[n + 1, j] = self.axes[1, j]
        return self.solver.factor()

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def factor_condensed(self) -> cython.bint:
        """Factor the condensed system at a level, and the two equations of the axes for lambda and rho."""
        n: cython.Py_ssize_t = self.n
        i: cython.Py_ssize_t
        k: cython.Py_ssize_t
        square: cython.double = 0.0
        for i in range(n + 1):
            self.row[i] = self.axes[0, i] * self.axes[1, n + 1] - self.axes[1, i] * self.axes[0, n + 1]
            square += self.row[i] * self.row[i]
        if square == 0.0:  # neither axis changes the level
            self.row[:] = self.axes[0, : n + 1]
            square = 1.0
        for i in range(n + 1):
            self.row[i] /= sqrt(square)
        if self.balance.factor(self.row, self.scale[: n + 1]) == 0.0:
            return False
        system = self.balance.condensed
        assert system is not None
        self.forces(self.by_level)
        self.by_level[n] = 0.0
        system.solve(np.asarray(self.by_level), False)
        for i in range(n):
            self.at_level[i] = 0.0
        self.at_level[n] = 1.0
        system.solve(np.asarray(self.at_level), False)
        for k in range(2):
            self.solver.matrix[k, 0], self.solver.matrix[k, 1] = self.axes[k, n + 1], 0.0
            for i in range(n + 1):
                self.solver.matrix[k, 0] += self.axes[k, i] * self.by_level[i]
                self.solver.matrix[k, 1] += self.axes[k, i] * self.at_level[i]
        return self.solver.factor()

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def solve(self, equations: cython.bint) -> cython.int:
        """Replace the right side (n + 2,) by the solution.

        equations: whether the right side of the balance's equations is not zero.
        """
        n: cython.Py_ssize_t = self.n
        i: cython.Py_ssize_t
        k: cython.Py_ssize_t
        if not self.condensed:
            for i in range(n + 2):
                self.solver.right[i] = self.right[i]
            self.solver.solve()
            for i in range(n + 2):
                self.right[i] = self.solver.right[i]
            return 0
        for k in range(2):
            self.solver.right[k] = self.right[n + k]
        if equations:
            self.right[n] = 0.0
            self.balance.solve(self.right[: n + 1])
            for k in range(2):
                for i in range(n + 1):
                    self.solver.right[k] -= self.axes[k, i] * self.right[i]
        else:
            for i in range(n + 1):
                self.right[i] = 0.0
        self.solver.solve()
        for i in range(n + 1):
            self.right[i] += self.solver.right[0] * self.by_level[i] + self.solver.right[1] * self.at_level[i]
        self.right[n + 1] = self.solver.right[0]
        return 0

    @cython.cfunc
    @cython.exceptval(-2, check=False)
    def correct(self, ahead: cython.double, aside: cython.double) -> cython.double:
        """Move z by a Newton step, and return its length."""
        n: cython.Py_ssize_t = self.n
        i: cython.Py_ssize_t
        total: cython.double = 0.0
        for i in range(n):
            self.right[i] = -self.balance.residual[i] / self.scale[i]
        self.right[n], self.right[n + 1] = ahead, aside
        for i in range(n + 2):
            self.right[n] -= self.axes[0, i] * (self.z[i] - self.centre[i]) / self.scale[i]
            self.right[n + 1] -= self.axes[1, i] * (self.z[i] - self.centre[i]) / self.scale[i]
        self.solve(True)
        for i in range(n + 2):
            self.z[i] += self.scale[i] * self.right[i]
            total += self.right[i] * self.right[i]
        return sqrt(total) if isfinite(total) else 2.0 * self.diverged_step

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def compute_tangents(self) -> cython.bint:
        """Compute the tangents and the test function from the factored equations; false if not finite."""
        n: cython.Py_ssize_t = self.n
        i: cython.Py_ssize_t
        k: cython.Py_ssize_t
        for k in range(2):
            for i in range(n + 2):
                self.right[i] = 0.0
            self.right[n + k] = 1.0
            self.solve(False)
            for i in range(n + 2):
                self.tangents[k, i] = self.right[i]
        self.value = (
            self.tangents[0, n] * self.tangents[1, n + 1] - self.tangents[0, n + 1] * self.tangents[1, n]
        )
        return isfinite(self.value)


PI = cython.declare(cython.double, np.pi)


class FoldCurveEnding(Enum):
    """The reason why a curve of folds ended."""

    RANGE = "it left the range of frequencies"
    LEVEL = "it left the levels that are looked at"
    CLOSED = "it came back to where it began"
    STALLED = "no further fold was found"
    LONG = "it has too many points"


Point = tuple[FloatArray, FloatArray]  # z, and the direction in which the displacements alone change


@cython.cclass
class Side:
    """A place on one side of the curve of folds: its angle, test function, and direction of the circle."""

    angle: cython.double
    value: cython.double
    across: cython.double[::1]

    def __init__(self, size: int) -> None:
        self.angle, self.value, self.across = 0.0, 0.0, np.zeros(size)


@cython.cclass
class Departure:
    """A step from the centre to a place of the curve of folds.

    radius, angle: its length and angle. along, across (n + 2,): directions to that place and across the
    curve, in the units of z. left: the sign of the test function on its left.
    """

    radius = cython.declare(cython.double, visibility="readonly")
    angle = cython.declare(cython.double, visibility="readonly")
    left = cython.declare(cython.double, visibility="readonly")
    along = cython.declare(cython.double[::1], visibility="readonly")
    across = cython.declare(cython.double[::1], visibility="readonly")

    def __init__(
        self,
        radius: cython.double,
        angle: cython.double,
        along: FloatArray,
        across: FloatArray,
        left: cython.double,
    ) -> None:
        self.radius, self.angle, self.left = radius, angle, left
        self.along, self.across = along, across


@cython.cclass
class FoldSteps:
    """Steps along a curve of folds: `departures` from a start, then `run` along each of them."""

    surface: Surface
    options: FoldOptions
    low: cython.double  # of the frequency [rad/s]
    high: cython.double
    charge_work: Callable[[], None]
    n: cython.int
    angle_tolerance: cython.double  # of the options, here for speed
    max_tangent: cython.double
    target_turn: cython.double
    max_turn: cython.double
    corner_roundness: cython.double
    widest: cython.double  # [rad] widest gap between angles that are tried in turn

    def __init__(
        self,
        surface: Surface,
        span: tuple[float, float],
        options: FoldOptions,
        charge_work: Callable[[], None],
    ) -> None:
        self.surface, self.options, self.charge_work = surface, options, charge_work
        self.low, self.high, self.n = span[0], span[1], surface.n + 2
        self.angle_tolerance, self.max_tangent = options.angle_tolerance, options.max_tangent
        self.target_turn, self.max_turn, self.corner_roundness = (
            options.target_turn,
            options.max_turn,
            options.corner_roundness,
        )
        self.widest = 2.0 * PI / options.circle_points

    def departures(self, start: FloatArray, singular: FloatArray) -> list[Departure]:
        """The two ways in which the curve of folds leaves its start."""
        if not self.begin(start, singular):
            return []
        for wider in self.options.start_circles:
            found = self.around(self.options.initial_step * wider, 0.0)
            pairs = [(a, b) for i, a in enumerate(found) for b in found[i + 1 :]]
            if pairs:
                opposite = np.argmin([np.cos(one.angle - other.angle) for one, other in pairs])
                return list(pairs[opposite])
        return []

    def run(
        self, start: FloatArray, singular: FloatArray, way: Departure
    ) -> tuple[list[Point], FoldCurveEnding]:
        """Follow the curve from the start along one of its departures."""
        options, surface, side = self.options, self.surface, Side(self.n)
        self.begin(start, singular)
        self.test_value(side, way.radius, way.angle)
        if not surface.recentre(way.along, way.across):
            return [], FoldCurveEnding.STALLED
        points = [(np.array(surface.centre), np.array(way.across))]
        ways, retreats = [way], options.max_retreats  # to each of the points
        step: cython.double = options.initial_step
        bend: cython.double = 0.0
        for count in range(options.max_steps):
            found = self.next_departure(step, bend, way.left)
            off: cython.double = 2.0 * self.angle_tolerance * way.radius
            crossed: cython.bint = False
            while found is None and step > options.min_step:
                self.charge_work()
                step, bend = 0.3 * step, 0.0
                if step < 10.0 * off and self.correct_centre(off, way.left):
                    off *= self.angle_tolerance
                thin: cython.bint = step < options.strip_width and not crossed
                aside = self.other_side(options.strip_width, way.left) if thin else 0.0
                if aside:  # the strip ends if it does not go on at steps of about its own width
                    crossed = True  # not back again
                    step = 2.0 * abs(aside)
                    found = None if step < options.min_step else self.next_departure(step, 0.0, way.left)
                    if found is not None or not self.cross_strip(aside):
                        break
                found = self.next_departure(step, bend, way.left) or self.around_corner(step, way.left)
            if found is None and retreats and len(points) > 1:  # the last step led to another part
                retreats, step, bend = retreats - 1, 0.3 * way.radius, 0.0
                points.pop()
                ways.pop()
                way = ways[len(ways) - 1]
                back: cython.double[::1] = points[len(points) - 1][0]
                surface.z[:] = back
                surface.recentre(way.along, way.across)
                continue
            if found is None:
                return points, FoldCurveEnding.STALLED
            before, way = np.array(surface.centre), found
            if not surface.recentre(way.along, way.across):
                return points, FoldCurveEnding.STALLED
            z = np.array(surface.z)
            ways.append(way)
            points.append((z, self.singular(way.across)))
            if count % options.report_interval == 0:
                self.charge_work()
            if not self.low <= surface.z[self.n - 2] <= self.high:
                return points, FoldCurveEnding.RANGE
            if not options.covers(surface.z[self.n - 1]):
                return points, FoldCurveEnding.LEVEL
            if count > 2 and self.passes(points[0][0], before, z):
                return [*points, points[0]], FoldCurveEnding.CLOSED
            longer: cython.double = min(max(self.target_turn / max(fabs(way.angle), 1e-3), 0.4), 2.0) * step
            longer = min(longer, options.max_step)
            bend, step = 0.5 * way.angle * (1.0 + longer / step), longer
        return points, FoldCurveEnding.LONG

    def begin(self, start: FloatArray, singular: FloatArray) -> bool:
        """Go to the surface at the start, with the frequency along and a direction across."""
        other = np.zeros(self.n)
        other[self.n - 2] = self.high - self.low
        return bool(self.surface.begin(np.array(start), other, np.array(singular)))

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def test_value(self, side: Side, radius: cython.double, angle: cython.double) -> cython.int:
        """Evaluate the test function at a place on a circle about the centre; NaN if there is no place."""
        surface: Surface = self.surface
        c: cython.double = cos(angle)
        s: cython.double = sin(angle)
        length: cython.double = 0.0
        i: cython.Py_ssize_t
        side.angle, side.value = angle, np.nan
        if not surface.find(radius * c, radius * s):
            surface.z[:] = surface.centre
            return 0
        for i in range(self.n):
            side.across[i] = c * surface.tangents[1, i] - s * surface.tangents[0, i]
            length += side.across[i] * side.across[i]
        length = sqrt(length)
        for i in range(self.n):
            side.across[i] /= length
        if length < self.max_tangent:
            side.value = surface.value
        return 0

    def around(self, radius: float, left: float) -> list[Departure]:
        """Departures to the changes of sign on a circle about the centre.

        left: the sign of the test function on the left of a departure, or 0 for any.
        """
        self.surface.z[:] = self.surface.centre
        circle, sides, found = self.options.circle_points, list[Side](), list[Departure]()
        for k in range(circle + 1):
            side = Side(self.n)
            self.test_value(side, radius, 2.0 * PI * k / circle - PI)
            sides.append(side)
        for low, high in pairwise(sides):
            a: Side = low
            b: Side = high
            if a.value * b.value < 0.0 and (left == 0.0 or left * b.value > 0.0):
                angle: cython.double = a.angle
                again = Side(self.n)
                self.test_value(again, radius, angle)
                way = self.sign_change(radius, again, b)
                if way is not None:
                    found.append(way)
        return found

    @cython.cfunc
    def sign_change(self, radius: cython.double, low: Side, high: Side) -> object:
        """The departure between two sides, with z left at its end; None if a place is missing."""
        at: cython.double = high.angle
        of_low: cython.double = 1.0  # weights of the method of Illinois
        of_high: cython.double = 1.0
        now: Side = Side(self.n)
        while high.angle - low.angle > self.angle_tolerance:
            before: cython.double = of_low * low.value
            after: cython.double = of_high * high.value
            width: cython.double = high.angle - low.angle
            slope: cython.double = fabs(high.value - low.value)
            at = low.angle - before * width / (after - before)
            at = min(max(at, low.angle + 0.05 * width), high.angle - 0.05 * width)
            self.test_value(now, radius, at)
            if not isfinite(now.value):
                return None
            value: cython.double = now.value
            if now.value * low.value > 0.0:
                low, now, of_low, of_high = now, Side(self.n), 1.0, 0.5 * of_high
            else:
                high, now, of_low, of_high = now, Side(self.n), 0.5 * of_low, 1.0
            if fabs(value) * width < self.angle_tolerance * slope:
                break
        surface: Surface = self.surface
        along, across = np.empty(self.n), np.empty(self.n)
        to: cython.double[::1] = along
        aside: cython.double[::1] = across
        i: cython.Py_ssize_t
        for i in range(self.n):
            to[i] = surface.z[i] - surface.centre[i]
            aside[i] = surface.scale[i] * (low.across[i] + high.across[i])
        return Departure(radius, at, along, across, 1.0 if high.value > 0.0 else -1.0)

    @cython.cfunc
    def next_departure(self, step: cython.double, bend: cython.double, left: cython.double) -> object:
        """The departure to the next place, near the angle of a bend; None if it is not found."""
        most: cython.double = self.max_turn
        one: Side = Side(self.n)
        other: Side = Side(self.n)
        self.surface.z[:] = self.surface.centre
        self.test_value(one, step, min(max(bend, -most), most))
        width: cython.double = 2.0 * self.angle_tolerance  # wider ones would miss a thin strip
        while isfinite(one.value):
            sign: cython.double = one.value * left
            then: cython.double = one.angle - (width if sign > 0.0 else -width if sign < 0.0 else 0.0)
            if fabs(then) > most:
                return None
            self.test_value(other, step, then)
            if one.value * other.value <= 0.0:
                return (
                    self.sign_change(step, one, other)
                    if one.angle <= other.angle
                    else self.sign_change(step, other, one)
                )
            one, other, width = other, one, 2.0 * width
        return None

    def correct_centre(self, off: float, left: float) -> bool:
        """Move the centre across the curve onto it, by no more than off; false if it is not there.

        A short step needs a centre that is nearer to the curve than the last step left it.
        """
        surface: Surface = self.surface
        axes = np.array(surface.axes) * np.asarray(surface.scale)
        side: Side = Side(self.n)
        surface.z[:] = surface.centre
        self.test_value(side, 0.0, 0.0)
        here: cython.double = side.value
        angle: cython.double = -0.5 * PI * float(np.sign(here * left))
        self.test_value(side, off, angle)
        if not here * side.value < 0.0:
            return False
        low: cython.double = 0.0
        high: cython.double = off
        while high - low > self.angle_tolerance * off:
            middle: cython.double = 0.5 * (low + high)
            self.test_value(side, middle, angle)
            if side.value * here > 0.0:
                low = middle
            else:
                high = middle
        return bool(surface.recentre(axes[0], axes[1]))

    def other_side(self, thin: float, left: float) -> float:
        """Distance from the centre to the other side of the strip beside the curve, positive to the left.

        Zero if there is no strip as thin as `thin`.
        """
        surface: Surface = self.surface
        side: Side = Side(self.n)
        surface.z[:] = surface.centre
        self.test_value(side, thin, 0.5 * PI)
        beyond: cython.double = side.value
        self.test_value(side, thin, -0.5 * PI)
        if not beyond * side.value > 0.0:
            return 0.0
        angle: cython.double = -0.5 * PI if beyond * left > 0.0 else 0.5 * PI
        surface.z[:] = surface.centre
        high: cython.double = thin
        low: cython.double = thin
        while not side.value * beyond < 0.0:
            if low < self.angle_tolerance * self.angle_tolerance * thin:
                return 0.0
            high = low
            low *= 0.7
            self.test_value(side, low, angle)
        while high - low > self.angle_tolerance * low:
            middle: cython.double = 0.5 * (low + high)
            self.test_value(side, middle, angle)
            if side.value * beyond < 0.0:
                low = middle
            else:
                high = middle
        return float(low if angle > 0.0 else -low)

    def cross_strip(self, aside: float) -> bool:
        """Move the centre to the curve on the other side of the strip, and reverse the direction."""
        surface: Surface = self.surface
        axes = np.array(surface.axes) * np.asarray(surface.scale)
        surface.z[:] = surface.centre
        return bool(surface.find(0.0, aside) and surface.recentre(-axes[0], axes[1]))

    def around_corner(self, step: float, left: float) -> Departure | None:
        """The departure nearest ahead, of the first ones to the left and to the right of the way back.

        Between the way back and either of them, the test function keeps its sign: one side of the curve.
        """
        ways = [way for side in (1.0, -1.0) if (way := self.beside_way_back(step, side, left)) is not None]
        if not ways:
            return None
        nearest: Departure = min(ways, key=lambda way: abs(way.angle))
        self.test_value(Side(self.n), step, nearest.angle)
        return nearest

    @cython.cfunc
    def beside_way_back(self, step: cython.double, side: cython.double, left: cython.double) -> object:
        """The first departure on one side of the way back, by growing angles; None if a place is missing."""
        off: cython.double = 2.0 * self.angle_tolerance
        width: cython.double = off
        one: Side = Side(self.n)
        other: Side = Side(self.n)
        self.surface.z[:] = self.surface.centre
        self.test_value(one, step, side * (PI - off))
        while side * left * one.value > 0.0 and off < 2.0 * PI - 2.0 * self.angle_tolerance:
            off = min(off + width, 2.0 * PI - 2.0 * self.angle_tolerance)
            width = min(2.0 * width, self.widest)
            self.test_value(other, step, side * (PI - off))
            if one.value * other.value < 0.0:
                return (
                    self.sign_change(step, other, one) if side > 0.0 else self.sign_change(step, one, other)
                )
            one, other = other, one
        return None

    @cython.cfunc
    def singular(self, across: cython.double[::1]) -> object:
        """The direction in the surface that changes frequency and level least, in the units of z.

        At a corner it is the direction across the curve.
        """
        surface: Surface = self.surface
        i: cython.Py_ssize_t
        t: cython.double[:, ::1] = surface.tangents
        a: cython.double = t[0, self.n - 2] ** 2 + t[0, self.n - 1] ** 2
        b: cython.double = t[0, self.n - 2] * t[1, self.n - 2] + t[0, self.n - 1] * t[1, self.n - 1]
        c: cython.double = t[1, self.n - 2] ** 2 + t[1, self.n - 1] ** 2
        # the directions cos(angle) t_0 + sin(angle) t_1 change frequency and level by an ellipse
        spread: cython.double = sqrt(0.25 * (a - c) ** 2 + b * b)
        if 0.5 * (a + c) - spread > self.corner_roundness * (0.5 * (a + c) + spread):
            return np.array(across)
        angle: cython.double = 0.5 * (atan2(2.0 * b, a - c) + PI)
        way = np.empty(self.n)
        out: cython.double[::1] = way
        length: cython.double = 0.0
        for i in range(self.n):
            out[i] = cos(angle) * t[0, i] + sin(angle) * t[1, i]
            length += out[i] * out[i]
        length = sqrt(length)
        for i in range(self.n):
            out[i] *= surface.scale[i] / length
        return way

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def passes(
        self, first: cython.double[::1], before: cython.double[::1], after: cython.double[::1]
    ) -> cython.bint:
        """Whether a step passes the first place of a curve."""
        square: cython.double = 0.0
        product: cython.double = 0.0
        off: cython.double = 0.0
        i: cython.Py_ssize_t
        for i in range(self.n):
            way: cython.double = (after[i] - before[i]) / self.surface.scale[i]
            to: cython.double = (first[i] - before[i]) / self.surface.scale[i]
            square += way * way
            product += way * to
            off += to * to
        if not 0.0 < product <= square:
            return False
        return sqrt(max(off - product * product / square, 0.0)) < 0.3 * sqrt(square)
