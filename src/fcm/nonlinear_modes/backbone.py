"""Nonlinear modes: frequency and damping ratio of a mode of a structure with contacts, against amplitude."""

from __future__ import annotations

from dataclasses import replace
from functools import partial

import numpy as np
import numpy.typing as npt

from fcm.continuation import FollowOptions, Path
from fcm.continuation.corrector import Newton
from fcm.continuation.follow import Progress
from fcm.continuation.nearby_solution import solution_near
from fcm.frozen import Frozen
from fcm.harmonic_balance.contact_cycles import contact_loads_along
from fcm.harmonic_balance.system import System
from fcm.model.scene import FloatArray
from fcm.nonlinear_modes.extended_periodic_motion import AutonomousProblem, ComplexArray, ModeGuess
from fcm.nonlinear_modes.options import NONLINEAR_MODE, NonlinearModeOptions, TruncationOptions
from fcm.nonlinear_modes.restart import follow_past_corners
from fcm.scene.options import LIMITS


class ModeError(ValueError):
    """Raised for a mode that does not exist; the message lists those that do."""


class Mode(Frozen):
    """Points of a nonlinear mode: modal amplitude a, frequency, damping ratio, and modal motion over a."""

    system: System
    problem: AutonomousProblem
    path: Path
    amplitude: FloatArray  # (point,) a, the root of sum_i |a Q_i|^2 over the modes of mass 1
    omega: FloatArray  # (point,)
    damping: FloatArray  # (point,)
    mean: FloatArray  # (point, mode) from rest
    Q: ComplexArray  # (point, harmonic, mode)

    @property
    def contacts(self) -> FloatArray:
        """Unknowns of the contacts as in `contact_law`, and the frequency, (point, unknown + 1)."""
        count = self.problem.contact_unknowns
        z = [self.problem.contact_motion(z) for z in self.path.z]
        return np.column_stack((np.reshape(z, (-1, count)), self.omega))

    def displacements(self) -> tuple[ComplexArray, FloatArray]:
        """Harmonics (point, harmonic, dof) and means (point, dof) of the degrees of freedom."""
        linear, a = self.system.linear, self.amplitude
        return a[:, None, None] * (self.Q @ linear.dofs), self.rest + a[:, None] * (self.mean @ linear.dofs)

    @property
    def power(self) -> FloatArray:
        """Shares (point, harmonic) of each harmonic in the power of the negative damping -2 D omega M x'.

            P_h / P = h^2 sum_i |Q_hi|^2 / sum_hi h^2 |Q_hi|^2

        Forces in resonance do work only on harmonic 1. If the others have much of the power, as at an
        internal resonance, the damping is not that of a forced response.
        """
        size: FloatArray = (np.abs(self.Q) ** 2).sum(axis=2) * np.array(self.system.harmonics) ** 2
        share: FloatArray = size / size.sum(axis=1, keepdims=True)
        return share

    @property
    def rest(self) -> FloatArray:
        """Displacements of the degrees of freedom under the static loads, (dof,)."""
        found: FloatArray = self.modes_at_rest @ self.system.linear.dofs
        return found

    @property
    def modes_at_rest(self) -> FloatArray:
        """Displacements of the modes under the static loads, (mode,)."""
        linear, force = self.system.linear, self.problem.contacts.means_at_rest()
        found: FloatArray = linear.flexibility @ (linear.load - linear.ports @ force)
        return found + self.system.adrift_at_rest


def nonlinear_mode(
    system: System,
    number: int,
    span: tuple[float, float],
    max_step: float,
    options: NonlinearModeOptions = NONLINEAR_MODE,
    progress: Progress | None = None,
) -> Mode:
    """Follow the mode with a number from the linear mode at the least amplitude of the span.

    Modes are counted from 1, the lowest, without rigid-body modes. They are those of the structure with its
    contacts as at rest: stuck if they are pressed, else open.

    Raises
    ------
    ModeError
        If there are fewer modes.
    RestError
        If there is no equilibrium with the static loads.
    """
    guesses, followed = linear_modes(system, number, options), without_even(system)
    low, high = (float(np.log(a)) for a in span)
    for guess in guesses:
        problem = AutonomousProblem(system, guess, options)
        new_problem = partial(AutonomousProblem, followed, guess, options)
        first = new_problem()
        following = FollowOptions(max_step, newton=first.precision)
        path = follow_past_corners(
            new_problem, first.start(low), (low, high), following, options.restart, progress
        )
        if path.z.shape[0]:
            break
    if followed is not system:
        fewer = new_problem()
        z, direction = (
            np.array([problem.with_harmonics_of(one, fewer) for one in points]).reshape(-1, problem.n + 1)
            for points in (path.z, path.direction)
        )
        path = replace(path, z=z, direction=direction)
    return mode_at(system, problem, path)


def without_even(system: System) -> System:
    """The system without even harmonics, if the mode has none as the halves of its cycle are opposite.

    If no contact's load varies, and none is strained at rest, opposite motions have opposite forces, and all
    even harmonics are 0 from the linear mode on. With them, other motions with the same friction branch off,
    where steps would make no progress.
    """
    odd = tuple(h for h in system.harmonics if h % 2)
    symmetric = all(contact.k_v == 0.0 for contact in system.scene.contacts) and not system.rest.any()
    return system.with_harmonics(odd) if symmetric and odd != system.harmonics else system


def mode_at(system: System, problem: AutonomousProblem, path: Path) -> Mode:
    """The mode at the points of a path."""
    found = [problem.motion(z) for z in path.z]
    modes = system.linear.natural.size
    omega, damping = (np.array([getattr(one, name) for one in found]) for name in ("omega", "damping"))
    Q = np.array([one.Q for one in found], dtype=np.complex128).reshape(-1, len(system.harmonics), modes)
    return Mode(
        system,
        problem,
        path,
        np.array([one.amplitude for one in found]),
        omega,
        np.where(np.abs(damping) <= damping_rounding(system, omega, Q, problem.options), 0.0, damping),
        np.array([one.mean for one in found]).reshape(-1, modes),
        Q,
    )


def damping_rounding(
    system: System, omega: FloatArray, Q: ComplexArray, options: NonlinearModeOptions = NONLINEAR_MODE
) -> FloatArray:
    """Damping ratios (point,) up to which damping is rounding.

    The work of a cycle is a small difference of forces of the stiffness, omega^2, and of the contacts'
    springs. Its error is `last_digits` units in the last digit of their sum, over 2 omega^2.
    """
    springs = system.springs(stuck=True)
    stretched = (np.abs(Q @ system.linear.ports) ** 2 @ springs).sum(axis=1)
    units = options.rounding.last_digits * np.finfo(np.float64).eps
    found: FloatArray = units * (omega**2 + stretched) / (2.0 * omega**2)
    return found


def linear_modes(
    system: System, number: int, options: NonlinearModeOptions = NONLINEAR_MODE
) -> list[ModeGuess]:
    """Guesses of the mode at very small amplitude: one, or three if a contact just touches, and may open."""
    linear = system.linear
    loads = system.loads_at_rest
    touching = any(load == 0.0 for load in loads)
    d = system.layout.directions
    halves = options.linear.contact_shares[: None if touching else 1]
    shares = [np.repeat([_closed(load, half) for load in loads], d) for half in halves]
    squares, _ = _squares(system, shares[0])
    elastic = np.flatnonzero(squares > options.linear.rigid_tolerance * squares.max(initial=0.0))
    if not 1 <= number <= elastic.size:
        raise ModeError(f"there is no mode {number}; the structure has the modes 1 to {elastic.size}")
    i = elastic[number - 1]
    low, high = (np.sqrt(max(_squares(system, share)[0][i], 0.0)) for share in (False, True))
    near = options.linear.frequency_ratio
    kept = np.flatnonzero((linear.natural >= low / near) & (linear.natural <= near * high))
    guesses = []
    for share in shares:
        squares, shapes = _squares(system, share)
        omega, Q = float(np.sqrt(squares[i])), shapes[:, i]
        damping = float((linear.damping * linear.natural) @ Q**2) / omega
        guesses.append(ModeGuess(Q, omega, damping, kept))
    return guesses


def _closed(load: float, half: float) -> float:
    """Share of a contact's springs that act at rest, by its normal load; half if it just touches."""
    return half if load == 0.0 else float(load > 0.0)


def _squares(system: System, share: FloatArray | bool) -> tuple[FloatArray, FloatArray]:
    """Squares of the frequencies and shapes (mode, mode) with the springs of some contacts."""
    linear = system.linear
    stiffness = np.diag(linear.natural**2)
    stiffness = stiffness + (linear.ports * (system.springs(stuck=True) * share)) @ linear.ports.T
    squares, shapes = np.linalg.eigh(stiffness)
    return squares, shapes


def truncation(mode: Mode, options: NonlinearModeOptions | None = None) -> tuple[FloatArray, FloatArray]:
    """Truncation error (point,), and contact loads (point, contact, 4), both by twice as many harmonics.

    The error is the relative change of the frequency or of the damping, whichever is greater; the damping is
    relative to its greatest value along the mode. NaN where there is no such motion. With many unknowns the
    error is computed at some points only, and NaN at the others. The options are those of the mode unless
    given.
    """
    system, old = mode.system, mode.problem
    options = options or old.options
    highest = min(2 * system.harmonics[-1] + 1, LIMITS.harmonics)
    larger = without_even(system.with_harmonics(tuple(range(1, highest + 1))))
    finer = AutonomousProblem(larger, old.guess, options)
    newton = Newton(finer, finer.precision)
    error = np.full(mode.omega.size, np.nan)
    contacts = np.zeros((mode.omega.size, finer.contact_unknowns + 1))
    for i in _truncation_points(mode, finer.n, options.truncation) if mode.omega.size else ():
        start = finer.with_harmonics_of(mode.path.z[i], old)
        z = solution_near(newton, start)
        if z is not None:
            omega, damping = z[-3:-1]
            of_damping = abs(damping - mode.damping[i]) / max(
                mode.damping.max(), options.truncation.damping_floor
            )
            error[i] = max(abs(omega - mode.omega[i]) / mode.omega[i], of_damping)
            contacts[i] = *finer.contact_motion(z), omega
    contact_loads = contact_loads_along(larger, contacts)
    contact_loads[np.isnan(error)] = np.nan
    return error, contact_loads


def _truncation_points(mode: Mode, unknowns: int, options: TruncationOptions) -> npt.NDArray[np.intp]:
    """The points at which the truncation error is computed, for a number of unknowns with more harmonics."""
    points = len(mode.path.z)
    if unknowns < options.many_unknowns:
        return np.arange(points)
    affordable = int(options.time_fraction * points * (mode.problem.n / unknowns) ** 3)
    spread = np.linspace(0, points - 1, max(affordable, options.min_points) + 1)
    return np.unique(spread[1:].round().astype(np.intp))
