r"""Special points of a response - a fold, a peak, an onset - as solutions of an extended system of equations.

The unknowns are those of the balance and its frequency, y = (x, omega); the parameter s moves numbers of the
scene. One equation g = 0 is added to the balance R = 0. With the tangent t of the response curve,

    [dR/d(x, omega); row] t = (0, 1),

g is t_omega for a fold and grad a . t for a peak of the amplitude a. Its derivatives by the unknowns are
those of w^T dR t, with w the adjoint solution of the same matrix. So two more evaluations of the exact
Jacobian, at a small distance along +-t, give all of them.
"""

from __future__ import annotations

from enum import Enum
from typing import NamedTuple

import numpy as np
from scipy.linalg.lapack import dgetrf, dgetrs

from fcm.continuation.problem import Problem
from fcm.harmonic_balance.dense_jacobian import Amplitude, jacobian_of
from fcm.model.scene import FloatArray
from fcm.tracking.onset_functions import onset, values
from fcm.tracking.options import TRACKING, TrackingOptions
from fcm.tracking.parameter_line import VariedBalance


class Kind(Enum):
    """Kinds of special points."""

    FOLD = "fold"
    PEAK = "peak"
    ONSET = "onset"
    END = "end"


class Condition(NamedTuple):
    """The condition of a special point: a fold, a peak of a degree of freedom, an onset, a frequency."""

    kind: Kind
    which: int = -1  # degree of freedom, or contact
    onset: str = ""  # one of `onset_functions.KINDS`
    omega: float = 0.0  # frequency of an end of the range


class Tangent:
    """The tangent of the response curve, t (unknown + 1,) in the problem's scale, with row . t = 1.

    The factors of its matrix (unknown + 1, unknown + 1) are kept for the adjoint. Raises LinAlgError if the
    matrix is singular.
    """

    def __init__(self, matrix: FloatArray) -> None:
        last = np.zeros(len(matrix))
        last[-1] = 1.0
        *self._factors, info = dgetrf(matrix.T, overwrite_a=True)  # the transpose needs no copy
        if info > 0:
            raise np.linalg.LinAlgError
        self.t: FloatArray = dgetrs(*self._factors, last, trans=1)[0]

    def adjoint(self, right: FloatArray) -> FloatArray:
        """The solution (unknown + 1,) of the transposed equations."""
        found: FloatArray = dgetrs(*self._factors, right)[0]
        return found


class Evaluation(NamedTuple):
    """An evaluation of the balance: its derivatives, and those of ln(amplitude) of a peak by (y, s)."""

    jacobian: FloatArray  # (unknown, unknown + 1)
    by_s: FloatArray  # (unknown,)
    growth: FloatArray  # (unknown + 2,)


class ExtendedSystem(Problem):
    """The extended system of a special point, see the module; z (unknown + 2,) = (x, omega, s)."""

    def __init__(
        self, varied: VariedBalance, condition: Condition, span: float, options: TrackingOptions = TRACKING
    ) -> None:
        self.options = options
        self.varied, self.condition, self.span = varied, condition, span
        self.n, self.offset = varied.balance.unknowns, 0.0  # wanted value of a scaled onset function
        Problem.__init__(self, self.n + 1, 0, 0)
        self.has_root_margins = varied.balance.has_root_margins
        self.row = np.zeros(self.n + 1)
        self.row[-1] = 1.0
        self.angles: FloatArray | None = None  # of the extremes of the cycle that define the peak

    def evaluate(self, z: FloatArray) -> int:
        """Fill residual and Jacobian; the last row is nan where the response crosses itself."""
        z = np.asarray(z)
        self.varied.set_parameter(float(z[-1]))
        y, n = np.array(z[:-1]), self.n
        here = self._evaluated(y)
        residual, jacobian = np.asarray(self.residual), np.asarray(self.jacobian)
        residual[:n] = self.varied.balance.residual
        jacobian[:n, : n + 1], jacobian[:n, n + 1] = here.jacobian, here.by_s
        try:
            value, gradient = self._condition(y, here)
        except np.linalg.LinAlgError:  # the response has no unique tangent there
            residual[n], jacobian[n] = np.nan, np.nan
            return 0
        unit = np.asarray(self.scale)[n]  # Newton's method divides this row by it
        residual[n], jacobian[n] = unit * value, unit * gradient
        return 0

    def surface(self, z: FloatArray) -> tuple[FloatArray, FloatArray, float]:
        """Scaled residual and Jacobian (by z) of the balance alone, and the special-point condition."""
        z, scale = np.asarray(z), np.asarray(self.scale)
        self.varied.set_parameter(float(z[-1]))
        y, n = np.array(z[:-1]), self.n
        here = self._evaluated(y)
        matrix = np.concatenate((here.jacobian, here.by_s[:, None]), axis=1) * scale / scale[:n, None]
        return np.array(self.varied.balance.residual) / scale[:n], matrix, self._special(y, here)

    def _special(self, y: FloatArray, here: Evaluation) -> float:
        """The value of `_condition` for a unit tangent, without derivatives."""
        if self.condition.kind not in (Kind.FOLD, Kind.PEAK):
            return self._condition(y, here)[0]
        scale = np.asarray(self.scale)[:-1]
        t = self._tangent(here.jacobian).t
        t /= np.linalg.norm(t)
        return float(t[-1] if self.condition.kind is Kind.FOLD else here.growth[:-1] @ (scale * t))

    def _evaluated(self, y: FloatArray) -> Evaluation:
        """Evaluate the balance at y, with its derivative by s."""
        balance = self.varied.balance
        balance.evaluate(y)
        by_s, growth = self.varied.by_s(y), np.zeros(self.n + 2)
        if self.condition.kind is Kind.PEAK:
            one = Amplitude(balance, self.condition.which)
            one.at(y, self.angles)
            growth = np.append(one.slopes, by_s.of(one)) / max(one.value, self.options.special.min_amplitude)
        return Evaluation(jacobian_of(balance), by_s.residual, growth)

    def evaluate_scale(self, z: FloatArray) -> int:
        """Fill the scale: the units of the balance, and the span for s; set row to the response's tangent.

        For a peak, this fixes the extremes of the cycle that are greatest here. From then on the amplitude is
        that of these extremes, since the amplitude itself has a kink where others become greater.
        """
        z = np.asarray(z)
        self.varied.set_parameter(float(z[-1]))
        y, balance, scale = np.array(z[:-1]), self.varied.balance, np.asarray(self.scale)
        balance.evaluate_scale(y)
        scale[:-1], scale[-1] = balance.scale, self.span
        balance.evaluate(y)
        t = _direction(jacobian_of(balance) * scale[:-1] / scale[:-2, None], self.row, self.options)
        self.row[:] = t if t @ self.row >= 0.0 else -t
        if self.condition.kind is Kind.PEAK:
            one = Amplitude(balance, self.condition.which)
            one.at(y)
            self.angles = one.angles
        return 0

    def along(self, z: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Unit tangent of the response in the problem's scale, amplitudes (dof,) and their growth along it.

        At a corner of the response it is the tangent on the side of z.
        """
        z = np.asarray(z)
        self.varied.set_parameter(float(z[-1]))
        y, balance = np.array(z[:-1]), self.varied.balance
        balance.evaluate(y)
        scale = np.asarray(self.scale)[:-1]
        t = _direction(jacobian_of(balance) * scale / scale[:-1, None], self.row, self.options)
        balance.evaluate_outputs(y, np.ascontiguousarray(t * np.asarray(self.scale)[:-1]))
        return t, np.array(balance.output), np.array(balance.growth)

    def _tangent(self, jacobian: FloatArray) -> Tangent:
        scale = np.asarray(self.scale)[:-1]
        scaled = jacobian * scale / scale[:-1, None]
        return Tangent(np.concatenate((scaled, self.row[None])))

    def _condition(self, y: FloatArray, here: Evaluation) -> tuple[float, FloatArray]:
        """The dimensionless special-point condition g, and its derivatives by (y, s)."""
        kind = self.condition.kind
        if kind is Kind.END:
            gradient = np.zeros(self.n + 2)
            gradient[-2] = 1.0 / self.varied.balance.span
            return (y[-1] - self.condition.omega) / self.varied.balance.span, gradient
        if kind is Kind.ONSET:
            return self._onset(y)
        return self._fold_or_peak(y, here)

    def _onset(self, y: FloatArray) -> tuple[float, FloatArray]:
        c, width = self.condition.which, self.varied.balance.width
        block = slice(c * width, (c + 1) * width)
        found = onset(
            self.varied.balance.laws[c], y[block], self.condition.onset, self.varied.harmonics, self.options
        )
        gradient = np.zeros(self.n + 2)
        gradient[block] = found.slope
        gradient[-1] = self.varied.contact_rates()[c] @ found.by_number
        unit = float(np.linalg.norm(gradient * np.asarray(self.scale))) or 1.0
        return found.value / unit - self.offset, gradient / unit

    def _fold_or_peak(self, y: FloatArray, here: Evaluation) -> tuple[float, FloatArray]:
        """The condition of a fold or a peak, and its derivatives: growth along t, with row . t = 1."""
        scale = np.asarray(self.scale)[:-1]
        tangent = self._tangent(here.jacobian)
        t, special = tangent.t, here.growth
        if self.condition.kind is Kind.FOLD:
            special[-2] = 1.0 / scale[-1]
        value = float(special[:-1] @ (scale * t))
        adjoint = tangent.adjoint(special[:-1] * scale)[:-1] / scale[:-1]
        ahead = scale * t / np.linalg.norm(t)
        step = self._difference_length(y, ahead)
        gradient = self._special_at(y + step * ahead, adjoint) - self._special_at(y - step * ahead, adjoint)
        gradient *= np.linalg.norm(t) / (2.0 * step)
        return value, gradient

    def _difference_length(self, y: FloatArray, ahead: FloatArray) -> float:
        """Length of a difference along the tangent, so short that no margin comes close to a sign change."""
        signs, step = self._margins(y), self.options.special.difference_length
        for there in (self._margins(y + step * ahead), self._margins(y - step * ahead)):
            crossed = signs * there < 0.0
            if crossed.any():
                part = np.abs(signs[crossed] / (signs[crossed] - there[crossed])).min()
                options = self.options.special
                step = min(
                    step,
                    max(
                        options.corner_fraction * part * options.difference_length,
                        options.min_difference_fraction,
                    ),
                )
        return step

    def jumps(self, z: FloatArray) -> bool:
        """Whether the special-point condition jumps within the least difference length about z."""
        self.varied.set_parameter(float(z[-1]))
        ahead = self.options.special.min_difference_fraction * np.asarray(self.scale)[:-1] * self.row
        sides = np.array(z[:-1]) - ahead, np.array(z[:-1]) + ahead
        if not (self._margins(sides[0]) * self._margins(sides[1]) < 0.0).any():
            return False
        before, after = (self._special(side, self._evaluated(side)) for side in sides)
        return abs(after - before) > self.options.pieces.max_jump

    def _margins(self, y: FloatArray) -> FloatArray:
        """Functions that change sign where the Jacobian is not smooth."""
        balance = self.varied.balance
        if balance.margins:
            balance.evaluate_margins(y)
            return np.array(balance.margin)
        return values(balance.laws, y, self.varied.harmonics, self.options)

    def _special_at(self, y: FloatArray, adjoint: FloatArray) -> FloatArray:
        """Derivatives (unknown + 2,) of the condition at y, with tangent and adjoint fixed."""
        here = self._evaluated(y)
        return here.growth - np.append(adjoint @ here.jacobian, adjoint @ here.by_s)

    def onset_at(self, z: FloatArray, condition: Condition) -> float:
        """Value of an onset function at z."""
        self.varied.set_parameter(float(z[-1]))
        c, width = condition.which, self.varied.balance.width
        block = np.ascontiguousarray(z[c * width : (c + 1) * width])
        return onset(
            self.varied.balance.laws[c], block, condition.onset, self.varied.harmonics, self.options
        ).value

    def amplitude_along(self, z: FloatArray, direction: FloatArray, dof: int) -> tuple[float, float]:
        """An amplitude, and its rate along a direction (unknown + 2,), including the change of s."""
        self.varied.set_parameter(float(z[-1]))
        y, balance = np.array(z[:-1]), self.varied.balance
        balance.evaluate(y)
        one = Amplitude(balance, dof)
        one.at(y)
        slopes = np.append(one.slopes, self.varied.by_s(y).of(one))
        return one.value, float(slopes @ direction)


def _direction(matrix: FloatArray, row: FloatArray, options: TrackingOptions = TRACKING) -> FloatArray:
    """Unit null vector (unknown + 1,) of a matrix (unknown, unknown + 1); row is close to it."""
    closed = np.concatenate((matrix, row[None]))
    try:
        t = np.linalg.solve(closed, np.eye(row.size)[-1])
    except np.linalg.LinAlgError:
        t = np.full(row.size, np.inf)
    size = float(np.linalg.norm(t))
    if size < options.special.max_tangent * float(np.linalg.norm(row)):
        return t / size
    last: FloatArray = np.linalg.svd(matrix)[2][-1]
    return last if last @ row >= 0.0 else -last
