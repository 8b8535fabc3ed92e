r"""Residuals of a measured response: the distance of each point from the nearest branch of the model.

A point y = (omega, A), or (omega, Re A, Im A) if the phase was measured, is compared with the curve
c(s) = (omega, A) of the model, both in units of the errors. Its residual is c(s) - y at the nearest point of
the curve, where (c - y) . c' = 0. Folds and jumps need no special treatment: the nearest point exists even
where the amplitude is not a function of the frequency. A change of a number p of the model moves the curve by

    dc = c_z . w,    R_z w = -R_p,    t . w = 0

with the residual R(z) of harmonic balance and the tangent t of the curve. The component of dc along the curve
does not change the distance. For small errors of the frequency the residual is the ordinary difference of
amplitudes.
Source: orthogonal distance regression, as in Boggs, Byrd and Schnabel, SIAM J. Sci. Stat. Comput. 8 (1987).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import numpy.typing as npt

from fcm.branches.trace import traced
from fcm.continuation.corrector import Newton
from fcm.fit.least_squares_rows import ResidualRows
from fcm.fit.options import NEAREST, FitOptions, NearestOptions
from fcm.frozen import Frozen
from fcm.harmonic_balance.dense_jacobian import jacobian_of
from fcm.harmonic_balance.reported_quantities import recorded
from fcm.harmonic_balance.residual import Balance
from fcm.harmonic_balance.system import System
from fcm.model.scene import FloatArray, Measured, Scene
from fcm.scene.address import LEVEL
from fcm.scene.draft import number_of
from fcm.sensitivity.parameter_derivatives import Rates, growth_of, rates_of
from fcm.units import QUANTITIES

ComplexArray = npt.NDArray[np.complex128]


class NoMotionError(ArithmeticError):
    """Raised when the model has no response in the range of the data."""


class DataErrors(Frozen):
    """Errors (point,) of the frequencies and amplitudes of measured points."""

    frequency: FloatArray
    amplitude: FloatArray


def errors_of(data: Measured, blurred: bool, options: FitOptions) -> DataErrors:
    """Errors of measured points: stated or estimated; if blurred, a share of the extent of the data."""
    top = float(data.amplitude.max())
    if blurred:
        width = max(float(np.ptp(data.frequency)), 1e-3 * float(data.frequency.max()))
        return DataErrors(
            np.full(data.points, options.search_error * width),
            np.full(data.points, options.search_error * top),
        )
    of_frequency = options.frequency_error if data.frequency_error is None else data.frequency_error
    if data.estimated is not None:
        return DataErrors(of_frequency * data.frequency, data.estimated[:, 0])
    of_amplitude = options.amplitude_error if data.amplitude_error is None else data.amplitude_error
    return DataErrors(of_frequency * data.frequency, of_amplitude * top / np.sqrt(data.weight))


class Observed:
    """The measured quantities of a solution, (omega, A) or (omega, Re A, Im A), and their rates."""

    def __init__(self, data: Measured, system: System) -> None:
        self.balance = system.new_balance()
        self.dof = list(system.scene.modal.dofs).index(data.dof)
        self.first = system.harmonics.index(1)
        self.power = QUANTITIES[data.quantity]
        self.phased = data.phase is not None
        self.fundamental = self.phased or self.power > 0

    def along(self, z: FloatArray, direction: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Observable of the last evaluated solution, and its rates along a direction (unknown + 1,)."""
        self.balance.evaluate_outputs(z, np.ascontiguousarray(direction))
        displacements, d, j = self.balance.displacements, self.dof, self.first
        X, dX = (
            complex(displacements.re[j, d], displacements.im[j, d]),
            complex(displacements.d_re[j, d], displacements.d_im[j, d]),
        )
        value = self._measured(z[-1], X, dX, direction[-1], self.balance.output[d], self.balance.growth[d])
        return value

    def by_number(self, z: FloatArray, direction: FloatArray, X: ComplexArray) -> FloatArray:
        """Rates of the observable if the solution moves along a direction, and displacements also by X."""
        self.balance.evaluate_outputs(z, np.ascontiguousarray(direction))
        displacements, d, j = self.balance.displacements, self.dof, self.first
        growth = self.balance.growth[d] + growth_of(self.balance, X)[d]
        dX = complex(displacements.d_re[j, d], displacements.d_im[j, d]) + X[j, d]
        now = complex(displacements.re[j, d], displacements.im[j, d])
        return self._measured(z[-1], now, dX, direction[-1], self.balance.output[d], growth)[1]

    def _measured(
        self, omega: float, X: complex, dX: complex, d_omega: float, amplitude: float, growth: float
    ) -> tuple[FloatArray, FloatArray]:
        if not self.fundamental:
            return np.array([omega, amplitude]), np.array([d_omega, growth])
        turn = 1j * (1j * omega) ** self.power  # phases refer to sin(omega t + phase)
        value = turn * X
        rate = turn * dX + self.power * d_omega / omega * value
        if self.phased:
            return np.array([omega, value.real, value.imag]), np.array([d_omega, rate.real, rate.imag])
        size = abs(value)
        return np.array([omega, size]), np.array([d_omega, (value.conjugate() * rate).real / (size or 1.0)])

    def of_path(self, omega: FloatArray, X: ComplexArray, amplitude: FloatArray) -> FloatArray:
        """Observables (point, component) at the points of a curve."""
        if not self.fundamental:
            return np.column_stack((omega, amplitude[:, self.dof]))
        value = 1j * (1j * omega) ** self.power * X[:, self.first, self.dof]
        parts = (value.real, value.imag) if self.phased else (np.abs(value),)
        return np.column_stack((omega, *parts))


def measured_points(data: Measured) -> FloatArray:
    """Measured points as observables (point, component)."""
    if data.phase is None:
        return np.column_stack((data.frequency, data.amplitude))
    value = data.amplitude * np.exp(1j * data.phase)
    return np.column_stack((data.frequency, value.real, value.imag))


def forced_rows(
    scene: Scene,
    keys: Sequence[str],
    harmonics: tuple[int, ...],
    data: Measured,
    errors: DataErrors,
    options: FitOptions,
) -> ResidualRows:
    """Residuals of the points of a data set, and their rates by numbers of the scene.

    Raises
    ------
    NoMotionError
        If no response is found in the range of the data.
    ValueError
        If a number changes which rigid-body motions the structure has.
    """
    scene = replace(scene, frequency_range=range_of(data, options))
    system = System(scene, harmonics)
    observed = Observed(data, system)
    rates = [rates_of(system, key) for key in keys]
    units = _units(data, errors)
    y = measured_points(data) / units
    residual, by_number = np.empty(y.shape), np.zeros((*y.shape, len(keys)))
    unreached = np.zeros(data.points)
    for level, rows in _by_level(data.level, options):
        curve = _curve(scene, level, harmonics, observed)
        for i in rows:
            nearest = Nearest(observed, units[i], y[i], float(data.level[i]))
            z = nearest.found(*curve.start(y[i], units[i]))
            residual[i] = nearest.at(z)[0] - y[i]
            if rates:
                by_number[i] = nearest.rates(z, rates)
            low, high = scene.frequency_range
            unreached[i] = float(not low < z[-1] < high)
    return ResidualRows(residual, by_number, unreached, data.values)


def range_of(data: Measured, options: FitOptions) -> tuple[float, float]:
    """The frequency range that is traced for a data set."""
    low, high = float(data.frequency.min()), float(data.frequency.max())
    beyond = options.margin * (high - low or high)
    return max(low - beyond, 0.5 * low), high + beyond


def _units(data: Measured, errors: DataErrors) -> FloatArray:
    """Errors (point, component) of the components of each measured point."""
    parts = [errors.frequency] + [errors.amplitude] * (1 if data.phase is None else 2)
    return np.column_stack(parts)


def _by_level(level: FloatArray, options: FitOptions) -> list[tuple[float, npt.NDArray[np.intp]]]:
    """Force levels to trace, each with the points whose level is nearest to it.

    Each point is then solved at its own level, so that the traced level only has to be near.
    """
    apart = np.unique(level)
    steps = np.log(apart[-1] / apart[0]) / np.log(options.level_step)
    most = min(options.max_levels, 1 + int(np.ceil(steps)))
    if apart.size > most:
        apart = np.geomspace(apart[0], apart[-1], most)
    nearest = np.abs(np.log(level[:, None] / apart)).argmin(axis=1)
    return [(float(one), rows) for k, one in enumerate(apart) if (rows := np.flatnonzero(nearest == k)).size]


class _Curve(Frozen):
    """Segments of the branches of a response: observables (segment, component) and unknowns at their ends."""

    begin: FloatArray
    end: FloatArray
    z_begin: FloatArray
    z_end: FloatArray

    def start(self, y: FloatArray, unit: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Unknowns on the segment nearest to a point y (in units), at its nearer end, and its direction."""
        a, b = self.begin / unit, self.end / unit
        along = b - a
        length = np.maximum((along**2).sum(axis=1), 1e-300)
        part = np.clip(((y - a) * along).sum(axis=1) / length, 0.0, 1.0)
        i = int((((a + part[:, None] * along) - y) ** 2).sum(axis=1).argmin())
        direction = self.z_end[i] - self.z_begin[i]
        end = self.z_begin[i] if part[i] < 0.5 else self.z_end[i]
        return self.z_begin[i] + part[i] * direction, end, direction


def _curve(scene: Scene, level: float, harmonics: tuple[int, ...], observed: Observed) -> _Curve:
    """The response curve at a force level."""
    number = number_of(scene, LEVEL)
    system = System(number.put(scene, level), harmonics)
    paths = [path for path in traced(system).branches.paths if len(path.z) > 1]
    if not paths:
        raise NoMotionError
    record = recorded(system, paths)
    c = observed.of_path(record.z[:, -1], record.X, record.amplitude)
    inside = np.flatnonzero(np.diff(record.path) == 0)
    return _Curve(c[inside], c[inside + 1], record.z[inside], record.z[inside + 1])


class Nearest:
    """Finds the point of the response nearest to a measured one, at a force level."""

    def __init__(
        self,
        observed: Observed,
        unit: FloatArray,
        y: FloatArray,
        level: float,
        options: NearestOptions = NEAREST,
    ) -> None:
        self.observed, self.unit, self.y, self.options = observed, unit, y, options
        self.newton = Newton(observed.balance)
        observed.balance.load = level

    def found(self, start: FloatArray, end: FloatArray, direction: FloatArray) -> FloatArray:
        """The nearest point z (unknown + 1,), by Newton steps along the curve.

        start, end, direction: the unknowns that `_Curve.start` returns.

        Raises
        ------
        NoMotionError
            If the corrector converges neither from start nor from end.
        """
        self.newton.problem.evaluate_scale(start)
        row = direction / np.asarray(self.newton.problem.scale)
        row /= np.linalg.norm(row)
        z = self._corrected(start, row)
        z = self._corrected(end, row) if z is None else z
        if z is None:
            raise NoMotionError
        for _ in range(self.options.max_steps):
            value, along = self.at(z)
            tangent, scale = np.array(self.newton.tangent), np.array(self.newton.scale)
            square = float(along @ along)
            if not square > 0.0:
                break
            step = float((self.y - value) @ along) / square
            if abs(step) * np.sqrt(square) < self.options.step_tolerance:
                break
            step = float(np.clip(step, -self.options.max_step, self.options.max_step))
            further = self._nearer(z, step, tangent, scale, float(((value - self.y) ** 2).sum()))
            if further is None:
                break
            z = further
        return z

    def _nearer(
        self, z: FloatArray, step: float, tangent: FloatArray, scale: FloatArray, before: float
    ) -> FloatArray | None:
        """A nearer point after a step along the curve, which is halved while it leads away; None if none."""
        for _ in range(self.options.max_halvings):
            there = self._corrected(z + step * scale * tangent, tangent)
            if there is not None and ((self.at(there)[0] - self.y) ** 2).sum() < before:
                return there
            step *= 0.5
        self._corrected(z, tangent)
        return None

    def _corrected(self, z: FloatArray, row: FloatArray) -> FloatArray | None:
        newton = self.newton
        newton.problem.evaluate_scale(z)
        newton.scale[:], newton.z[:], newton.row[:] = newton.problem.scale, z, row
        return np.array(newton.z) if newton.correct(1.0) else None

    def at(self, z: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Observable at z and its rates along the curve, both in units of the errors."""
        self.observed.balance.evaluate(z)
        direction = np.asarray(self.newton.tangent) * np.asarray(self.newton.scale)
        value, along = self.observed.along(z, direction)
        return value / self.unit, along / self.unit

    def rates(self, z: FloatArray, rates: Sequence[Rates]) -> FloatArray:
        """Rates (component, number) of the nearest point by numbers, without their part along the curve."""
        _, along = self.at(z)
        balance: Balance = self.observed.balance
        scale, tangent = np.asarray(self.newton.scale), np.asarray(self.newton.tangent)
        by = [one.here(balance, z) for one in rates]
        matrix = np.vstack((jacobian_of(balance) * scale / scale[:-1, None], tangent))
        right = np.column_stack([np.append(-R_p / scale[:-1], 0.0) for R_p, _ in by])
        moved = np.linalg.solve(matrix, right) * scale[:, None]
        found = np.column_stack(
            [self.observed.by_number(z, w, X) / self.unit for w, (_, X) in zip(moved.T, by, strict=True)]
        )
        square = float(along @ along)
        if square > 0.0:
            found -= np.outer(along, along @ found) / square
        return found


def sampled(
    scene: Scene, like: Measured, level: float, count: int, harmonics: tuple[int, ...], options: FitOptions
) -> Measured:
    """Points of the computed response as measured data, at the dof and over the frequencies of a data set.

    Raises
    ------
    NoMotionError
        If no response is found there, or nothing moves.
    """
    scene = replace(scene, frequency_range=range_of(like, options))
    error = like.amplitude_error
    if like.estimated is not None:
        error = float(np.sqrt((like.estimated[:, 0] ** 2).mean())) / float(like.amplitude.max())
    measured = replace(like, phase=None, estimated=None, amplitude_error=error)
    observed = Observed(measured, System(scene, harmonics))
    c = _curve(scene, level, harmonics, observed).begin
    c = c[(c[:, 0] >= like.frequency.min()) & (c[:, 0] <= like.frequency.max())]
    c = c[np.unique(np.linspace(0, len(c) - 1, min(count, len(c))).astype(np.intp))] if len(c) else c
    if not len(c) or not c[:, 1].max() > 0.0:
        raise NoMotionError
    ones = np.ones(len(c))
    return replace(measured, frequency=c[:, 0], amplitude=c[:, 1], weight=ones, level=level * ones)
