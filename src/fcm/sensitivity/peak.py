"""One peak of a curve: its point, whether it is smooth or a corner, and its derivatives by a number."""

from __future__ import annotations

from dataclasses import replace
from enum import Enum
from functools import cached_property

import numpy as np
import numpy.typing as npt
from scipy.linalg import lu_factor, lu_solve
from scipy.optimize import brentq

from fcm.continuation.corrector import Newton
from fcm.frozen import Frozen
from fcm.harmonic_balance.dense_jacobian import jacobian_of
from fcm.harmonic_balance.residual import Balance
from fcm.harmonic_balance.system import System
from fcm.model.scene import FloatArray, Scene
from fcm.scene.draft import Number
from fcm.sensitivity.options import SENSITIVITY, SensitivityOptions
from fcm.sensitivity.parameter_derivatives import Rates, growth_of

STENCIL = ((1, 2.0 / 3.0), (2, -1.0 / 12.0))  # central differences of fourth order, first derivative
ONE_SIDED = ((0, -25.0 / 12.0), (1, 4.0), (2, -3.0), (3, 4.0 / 3.0), (4, -0.25))  # for numbers at a limit


class PeakKind(Enum):
    """Kind of a peak, which decides how its derivatives are computed."""

    SMOOTH = "smooth"
    CORNER = "corner"
    EDGE = "end of range"
    UNKNOWN = "unknown"


class Unknown(Enum):
    """Why the derivatives of a peak, or its derivative by one number, are unknown."""

    NOTHING = ""  # they are known
    AT_REST = "nothing moves there"
    NOT_SOLVED = "its motion is not found again from its point"
    ONE_SIDED = "the curve is not found on both sides of it"
    NO_MAXIMUM = "no maximum is found beside its point"
    SEVERAL = "several contacts change their states there at once, so that each side has its own derivative"
    RIGID = "the structure has rigid-body motions, which the number may change"
    LOST = "the peak is not found again with the number a little larger or smaller"


class ParameterStencil(Frozen):
    """Difference quotient by a number: weights, each with the balance at a changed value of the number."""

    terms: list[tuple[float, Newton]]


def moved_by(
    scene: Scene, number: Number, harmonics: tuple[int, ...], options: SensitivityOptions = SENSITIVITY
) -> ParameterStencil:
    each = number.each(scene)
    size = max(abs(value) for _, value, _ in each)
    step = options.step * (size or 1.0)
    inside = all(not number.rule.fault(value - 2.0 * step) for _, value, _ in each)
    terms = [(sign * k, sign * w) for k, w in STENCIL for sign in (1, -1)] if inside else list(ONE_SIDED)
    draft = scene.draft
    assert draft is not None
    found = []
    for k, weight in terms:
        values = {one.addresses[0]: value + k * step * share for one, value, share in each}
        moved = replace(draft.curve(scene, {}, values), draft=None)
        found.append((weight / step, Newton(System(moved, harmonics).new_balance())))
    return ParameterStencil(found)


class PeakSolution:
    """One peak: its point, the tangent of the curve there, and its kind."""

    def __init__(
        self, system: System, dof: int, z: FloatArray, edge: bool, options: SensitivityOptions = SENSITIVITY
    ) -> None:
        self.options = options
        self.dof, self.newton, self.edge = dof, Newton(system.new_balance()), edge
        self.kind, self.margin, self.curvature = PeakKind.UNKNOWN, -1, np.nan
        self.why = Unknown.NOT_SOLVED  # the reason if the kind is unknown
        balance = self.newton.problem
        balance.evaluate_scale(z)
        self.scale = np.array(balance.scale)
        self.unit = np.eye(z.size)[-1]  # normal of the plane of solutions, in scaled coordinates
        self.z = np.array(z)
        if not edge:
            self.newton.scale[:], self.newton.z[:], self.newton.row[:] = self.scale, z, self.unit
            if not self.newton.take_tangent():
                return
            self.unit = np.array(self.newton.tangent)
        point = self.solved(self.newton, z)
        if point is None:
            return
        self.z = point
        self.kind, self.why = (PeakKind.EDGE, Unknown.NOTHING) if edge else self._kind()

    def solved(self, newton: Newton, guess: FloatArray) -> FloatArray | None:
        """The point of a curve in the plane normal to `unit` through the guess, or None; sets the tangent."""
        newton.scale[:], newton.z[:], newton.row[:] = self.scale, guess, self.unit
        if not newton.correct(1.0):
            return None
        point = np.array(newton.z)
        return point if newton.take_tangent() else None

    def slope(self, newton: Newton, z: FloatArray) -> float:
        """Derivative of the amplitude by length along the curve, at the last solved point."""
        newton.problem.evaluate(z)
        newton.problem.evaluate_outputs(z, np.ascontiguousarray(np.asarray(newton.tangent) * self.scale))
        return float(newton.problem.growth[self.dof])

    def along(self, length: float) -> FloatArray:
        """A guess at a distance along the tangent of the curve."""
        guess: FloatArray = self.z + length * self.scale * self.unit
        return guess

    def _kind(self) -> tuple[PeakKind, Unknown]:
        """Finds the peak next to the given point, and returns its kind, or why this is unknown."""
        before, after = (
            self._at_length(-self.options.side_distance),
            self._at_length(self.options.side_distance),
        )
        size = self._height(self.newton, self.z)
        if before is None or after is None:
            return PeakKind.UNKNOWN, Unknown.ONE_SIDED
        flat = max(abs(before[0]), abs(after[0])) < self.options.flat_slope * size
        changed = np.flatnonzero(before[1] * after[1] < 0.0)
        if flat or not changed.size:  # a steep peak without a corner is a narrow smooth one
            found = self._climb()
            return (PeakKind.SMOOTH, Unknown.NOTHING) if found else (PeakKind.UNKNOWN, Unknown.NO_MAXIMUM)
        if changed.size > 1:
            return PeakKind.UNKNOWN, Unknown.SEVERAL
        self.margin = int(changed[0])
        return PeakKind.CORNER, Unknown.NOTHING

    def _at_length(self, length: float) -> tuple[float, FloatArray] | None:
        """Slope and margins at a distance along the curve; None if no solution is found."""
        point = self.solved(self.newton, self.along(length))
        if point is None:
            return None
        self.newton.problem.evaluate_margins(point)
        return self.slope(self.newton, point), np.array(self.newton.problem.margin)

    def _climb(self) -> bool:
        """Moves by Newton's method along the curve to a maximum, where the slope is 0; False if it fails."""
        for _ in range(self.options.max_iterations):
            self.curvature = bend = self.bend()
            point = self.solved(self.newton, self.z)
            if point is None or not bend < 0.0:
                return False
            step = -self.slope(self.newton, point) / bend
            if abs(step) < self.options.tolerance:
                self.z = point
                self.unit = np.array(self.newton.tangent)
                return True
            if abs(step) > self.options.step:
                return False
            moved = self.solved(self.newton, self.along(step))
            if moved is None:
                return False
            self.z = moved
        return False

    def bend(self) -> float:
        """Derivative of the slope along the curve."""
        terms = ((sign * k, sign * w) for k, w in STENCIL for sign in (1, -1))
        total = 0.0
        for k, weight in terms:
            point = self.solved(self.newton, self.along(k * self.options.step))
            total += np.nan if point is None else weight / self.options.step * self.slope(self.newton, point)
        return total

    def derivatives(self, rates: Rates, moved: ParameterStencil) -> tuple[float, float]:
        """Derivatives of the height and the frequency of the peak by a number."""
        if self.kind is PeakKind.UNKNOWN:
            return np.nan, np.nan
        if self.kind is PeakKind.CORNER:
            return self._of_corner(moved)
        balance = self.newton.problem
        assert isinstance(balance, Balance)
        R_p, X = rates.at(balance, self.z)
        across = lu_solve(self._factors, np.append(-R_p / self.scale[:-1], 0.0)) * self.scale
        balance.evaluate_outputs(self.z, np.ascontiguousarray(across))
        height = float(growth_of(balance, X)[self.dof] + balance.growth[self.dof])
        if self.kind is PeakKind.EDGE:
            return height, 0.0
        alpha = -self._slope_by_number(moved) / self.curvature
        return height, float(across[-1] + alpha * self.unit[-1] * self.scale[-1])

    @cached_property
    def _factors(self) -> tuple[FloatArray, npt.NDArray[np.int32]]:
        """LU factors of the bordered Jacobian, for motions of the point in the plane normal to the curve."""
        balance = self.newton.problem
        assert isinstance(balance, Balance)
        balance.evaluate(self.z)
        inner = jacobian_of(balance) * self.scale
        factors: tuple[FloatArray, npt.NDArray[np.int32]] = lu_factor(
            np.vstack((inner / self.scale[:-1, None], self.unit))
        )
        return factors

    def _slope_by_number(self, moved: ParameterStencil) -> float:
        """c_p: derivative of the slope by the number, in the plane normal to the curve."""
        total = 0.0
        for weight, newton in moved.terms:
            point = self.solved(newton, self.z)
            total += np.nan if point is None else weight * self.slope(newton, point)
        return total

    def _of_corner(self, moved: ParameterStencil) -> tuple[float, float]:
        """Derivatives of the height and the frequency of a corner by the number."""
        total = np.zeros(2)
        for weight, newton in moved.terms:
            point = self._landed(newton)
            total += np.nan if point is None else weight * np.array([self._height(newton, point), point[-1]])
        return float(total[0]), float(total[1])

    def _landed(self, newton: Newton) -> FloatArray | None:
        """The corner of a curve next to the peak; None if there is none."""

        def margin(length: float) -> float:
            point = self.solved(newton, self.along(length))
            if point is None:
                raise ArithmeticError
            newton.problem.evaluate_margins(point)
            return float(newton.problem.margin[self.margin])

        try:
            at = brentq(margin, -self.options.corner, self.options.corner, xtol=self.options.corner_tolerance)
            return self.solved(newton, self.along(at))
        except (ArithmeticError, ValueError):  # no curve there, or no such corner
            return None

    def _height(self, newton: Newton, z: FloatArray) -> float:
        newton.problem.evaluate(z)
        newton.problem.evaluate_outputs(z, np.zeros(z.size))
        return float(newton.problem.output[self.dof])
