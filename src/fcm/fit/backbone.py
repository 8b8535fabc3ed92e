r"""Residuals of a measured backbone: frequency and damping of a nonlinear mode against its amplitude.

The nonlinear mode R(z, ln a) = 0 of the model (`nonlinear_modes.backbone`) is solved at each measured
amplitude. A number p changes it there by w: R_z w = -R_p at constant amplitude.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from fcm.continuation.corrector import Newton
from fcm.continuation.nearby_solution import solution_near
from fcm.fit.forced import NoMotionError
from fcm.fit.least_squares_rows import ResidualRows
from fcm.fit.options import BACKBONE, FitOptions
from fcm.frozen import Frozen
from fcm.harmonic_balance.static_equilibrium import RestError
from fcm.harmonic_balance.system import System
from fcm.model.scene import FloatArray, Measured, Scene
from fcm.nonlinear_modes.backbone import Mode, linear_modes, nonlinear_mode
from fcm.nonlinear_modes.extended_periodic_motion import AutonomousProblem
from fcm.scene.draft import Number
from fcm.sensitivity.peak import STENCIL


def backbone_rows(
    scene: Scene, numbers: Sequence[Number], harmonics: tuple[int, ...], data: Measured, options: FitOptions
) -> ResidualRows:
    """Residuals (point, 2) of frequency and damping, and their rates by numbers of the scene.

    Raises
    ------
    NoMotionError
        If the mode is not found at the least amplitude, or there is no static equilibrium.
    ModeError
        If there is no such mode.
    """
    system = System(scene, harmonics)
    try:
        found = _Followed(system, data)
        moved = [_moved(scene, number, harmonics, found.problem) for number in numbers]
    except RestError:
        raise NoMotionError from None
    assert data.damping is not None
    units = backbone_errors(data, options)
    y = np.column_stack((data.frequency, data.damping))
    residual, rates = np.zeros(y.shape), np.zeros((*y.shape, len(numbers)))
    unreached = np.zeros(data.points)
    known = np.isfinite(y)
    for i, amplitude in enumerate(data.amplitude.tolist()):
        z, reached = found.at(amplitude)
        unreached[i] = float(not reached)
        value = z[-3:-1]
        residual[i] = np.where(known[i], (value - y[i]) / units[i], 0.0)
        rates[i] = np.where(known[i], 1.0 / units[i], 0.0)[:, None] * found.rates(z, moved)
    return ResidualRows(residual, rates, unreached, int(known.sum()))


def backbone_errors(data: Measured, options: FitOptions) -> FloatArray:
    """Errors (point, 2) of frequencies and damping ratios: estimated ones, or those stated."""
    if data.estimated is not None:
        return data.estimated
    assert data.damping is not None
    of_frequency = options.backbone_error if data.frequency_error is None else data.frequency_error
    of_damping = options.damping_error if data.damping_error is None else data.damping_error
    each = (of_frequency * data.frequency, np.full(data.points, of_damping * data.damping.max()))
    found: FloatArray = np.column_stack(each) / np.sqrt(data.weight[:, None])
    return found


def modal_span(system: System, data: Measured) -> tuple[float, float]:
    """Modal amplitudes over which a mode is followed: the measured ones, and somewhat beyond.

    For measured displacements the shape of the linear mode gives the modal amplitudes. The shape changes
    with amplitude, so that the mode is then followed further beyond.

    Raises
    ------
    NoMotionError
        If the degree of freedom does not move with the linear mode.
    ModeError
        If there is no such mode.
    """
    low, high = float(data.amplitude.min()), float(data.amplitude.max())
    if not data.dof:
        return low / BACKBONE.modal_amplitude_factor, high * BACKBONE.modal_amplitude_factor
    dof = list(system.scene.modal.dofs).index(data.dof)
    shape = abs(float(linear_modes(system, data.mode)[0].Q @ system.linear.dofs[:, dof]))
    if not shape > 0.0:
        raise NoMotionError
    return low / (shape * BACKBONE.amplitude_factor), high * BACKBONE.amplitude_factor / shape


def measured_span(system: System, data: Measured) -> tuple[float, float]:
    """Modal amplitudes at which a mode has the least and greatest measured amplitudes, with a margin.

    Raises
    ------
    NoMotionError, ModeError
        As `modal_span`.
    """
    if not data.dof:
        return modal_span(system, data)
    followed = _Followed(system, data)
    low, high = (
        followed.problem.modal_amplitude(followed.at(one)[0])
        for one in (float(data.amplitude.min()), float(data.amplitude.max()))
    )
    return low / BACKBONE.shown_factor, high * BACKBONE.shown_factor


class _Followed:
    """A nonlinear mode of the model over the range of measured amplitudes."""

    def __init__(self, system: System, data: Measured) -> None:
        self.dof = list(system.scene.modal.dofs).index(data.dof) if data.dof else None
        self.system = system
        self.mode: Mode = nonlinear_mode(system, data.mode, modal_span(system, data), system.scene.max_step)
        if not len(self.mode.path.z):
            raise NoMotionError
        self.problem: AutonomousProblem = self.mode.problem
        self.newton = Newton(self.problem, self.problem.precision)
        sizes = (
            self.mode.amplitude if self.dof is None else np.array([self._size(z) for z in self.mode.path.z])
        )
        self.logs = np.log(sizes)

    def _size(self, z: FloatArray, problem: AutonomousProblem | None = None) -> float:
        """The amplitude in the sense of the data: modal, or the fundamental of a displacement."""
        if self.dof is None:
            return self.problem.modal_amplitude(z)
        motion = (problem or self.problem).motion(z)
        first = self.system.harmonics.index(1)
        return motion.amplitude * abs(complex(motion.Q[first] @ self.system.linear.dofs[:, self.dof]))

    def at(self, amplitude: float) -> tuple[FloatArray, bool]:
        """The point of the mode with an amplitude, and whether the mode reaches it; if not, the nearest."""
        target, points = np.log(amplitude), self.mode.path.z
        sign = self.logs - target
        crossed = np.flatnonzero(sign[:-1] * sign[1:] <= 0.0)
        if not crossed.size:
            return points[np.abs(sign).argmin()], False
        i = int(crossed[0])
        part = 0.0 if sign[i] == sign[i + 1] else sign[i] / (sign[i] - sign[i + 1])
        z = self._solved(points[i] + part * (points[i + 1] - points[i]))
        if z is None:
            return points[i], False
        for _ in range(BACKBONE.max_steps if self.dof is not None else 0):
            off = target - np.log(self._size(z))
            if abs(off) < BACKBONE.step_tolerance:
                break
            there = self._solved(np.append(z[:-1], z[-1] + off))
            if there is None:
                break
            z = there
        return z, True

    def _solved(self, guess: FloatArray) -> FloatArray | None:
        """The corrected point, with the modal amplitude of the guess."""
        return solution_near(self.newton, guess)

    def rates(self, z: FloatArray, moved: Sequence[ResidualDerivative]) -> FloatArray:
        """Derivatives (2, number) of frequency and damping by numbers, at fixed measured amplitude."""
        self.problem.evaluate(z)
        J = np.array(self.problem.jacobian)
        right = np.column_stack([-J[:, -1], *(-one.rate(z) for one in moved)])
        answers = np.linalg.solve(J[:, :-1], right)
        by_log, by_number = answers[:, 0], answers[:, 1:]
        found = by_number[-2:].copy()
        if self.dof is not None:  # the modal amplitude changes so as to keep the displacement constant
            grown = self._growth(z, by_log, 1.0)
            for k, (direction, one) in enumerate(zip(by_number.T, moved, strict=True)):
                own = sum(weight * np.log(self._size(z, problem)) for weight, problem in one.terms)
                found[:, k] -= by_log[-2:] * (self._growth(z, direction, 0.0) + own) / grown
        return found

    def _growth(self, z: FloatArray, direction: FloatArray, of_log: float) -> float:
        """Derivative of the logarithm of the measured amplitude along (direction, of_log)."""
        step = BACKBONE.difference * np.append(direction, of_log)
        ends = [np.log(self._size(z + sign * step)) for sign in (1.0, -1.0)]
        return float(ends[0] - ends[1]) / (2.0 * BACKBONE.difference)


class ResidualDerivative(Frozen):
    """Difference quotient by a number: weights, each with the problem at a changed value of the number."""

    terms: list[tuple[float, AutonomousProblem]]

    def rate(self, z: FloatArray) -> FloatArray:
        """Derivative of the residual by the number, at fixed unknowns."""
        total = np.zeros(z.size - 1)
        for weight, problem in self.terms:
            problem.evaluate(z)
            total += weight * np.asarray(problem.residual)
        return total


def _moved(
    scene: Scene, number: Number, harmonics: tuple[int, ...], problem: AutonomousProblem
) -> ResidualDerivative:
    """Difference stencil of the residual, with the number's values on both sides."""
    value = number.value(scene)
    step = BACKBONE.difference * (abs(value) or 1.0)
    terms = []
    for k, weight in STENCIL:
        for sign in (1.0, -1.0):
            system = System(number.put(scene, value + sign * k * step), harmonics)
            terms.append((sign * weight / step, AutonomousProblem(system, problem.guess, problem.options)))
    return ResidualDerivative(terms)
