"""Periodic solutions by shooting: fixed points of the period map, and their stability."""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property

import numpy as np
import numpy.typing as npt

from fcm.frozen import Frozen
from fcm.model.scene import FloatArray, Scene
from fcm.shooting.options import SHOOTING, ShootingOptions
from fcm.shooting.residual import Shot
from fcm.shooting.residual_traction import resting
from fcm.time_domain.cycle import Cycle
from fcm.time_domain.cycle_measures import Measure, measure
from fcm.time_domain.equations_of_motion import EquationsOfMotion
from fcm.time_domain.errors import SimulationError
from fcm.time_domain.simulation import cycles_from
from fcm.time_domain.state import State
from fcm.time_domain.trajectory import Motion
from fcm.units import spoken

Poll = Callable[[], None]  # called regularly; raises an exception to end the search


def never_interrupt() -> None:
    """A `Poll` that never ends the search."""


class Orbit(Frozen):
    """A periodic solution over one period, from the instant at which the forces' angle is 0."""

    scene: Scene
    frequency: float  # [rad/s]
    state: State  # at its start
    cycle: Cycle
    multipliers: npt.NDArray[np.complex128]  # Floquet multipliers, the greatest first
    residual: float  # closure error, relative to its size
    iterations: int

    @property
    def stable(self) -> bool:
        """Whether small disturbances do not grow."""
        return within_unit_circle(self.multipliers)

    @property
    def states(self) -> tuple[str, ...]:
        """The sequence of states of each contact over the period, such as 'EPEN'."""
        return self.cycle.states

    @cached_property
    def measure(self) -> Measure:
        """Amplitudes (half the peak-to-peak, and the fundamental), phase and mean of the orbit."""
        return measure(self.cycle)

    @property
    def motion(self) -> Motion:
        """The orbit as a motion of one period."""
        return Motion(self.scene, (self.cycle,), self.state)


def within_unit_circle(multipliers: npt.NDArray[np.complex128], options: ShootingOptions = SHOOTING) -> bool:
    """Whether no multiplier exceeds 1 in magnitude, but for rounding."""
    return bool(np.abs(multipliers).max(initial=0.0) <= 1.0 + options.floquet.classification.growth_tolerance)


def periodic(
    scene: Scene, frequency: float, guess: State | None = None, options: ShootingOptions = SHOOTING
) -> Orbit:
    """Find a periodic solution of a scene, stable or not, at one frequency.

    It applies Newton's method to the closure of one period of the exact motion (shooting), with the exact
    derivative.

    Parameters
    ----------
    scene : Scene
        From `fcm.load_scene`.
    frequency : float
        Frequency of the external forces [rad/s].
    guess : State, optional
        State at the forces' angle 0, from `Motion.end`, a neighbouring `Orbit.state`, or `harmonic_state`. By
        default a simulation from rest, with the residual friction of the scene's [start], gives the guess.
        It approaches the solution, or moves around it if it is unstable.
    options : ShootingOptions, optional
        Tolerances and limits.

    Raises
    ------
    SimulationError
        If no periodic solution is found.

    Examples
    --------
    >>> import fcm
    >>> orbit = periodic(fcm.load_scene("yang1998-n5"), 1.3)
    >>> orbit.stable, orbit.states
    (True, ('SPEN',))
    """
    system = EquationsOfMotion(scene, frequency)
    if guess is not None:
        orbit = shoot(system, guess, options=options)
        if orbit is None:
            at = spoken(frequency, scene.frequency_unit)
            raise SimulationError(
                f"no periodic solution is found at {at} from this state. "
                "Simulate some cycles and start from their end, or from a solution at a frequency nearby"
            )
        return orbit
    return approached(system, options=options)


def unloaded(scene: Scene) -> State:
    """The state at rest, with the residual friction of the scene's [start]."""
    rest = State.rest(scene)
    displacement = scene.modal.shapes.T @ rest.q
    pairs = zip(scene.contacts, resting(scene), strict=True)
    friction = np.array([contact.k_u * (contact.tangential @ displacement - w) for contact, w in pairs])
    return State(rest.q, rest.velocity, friction)


def approached(
    system: EquationsOfMotion, poll: Poll = never_interrupt, options: ShootingOptions = SHOOTING
) -> Orbit:
    """The periodic solution that a simulation from rest approaches.

    Raises
    ------
    SimulationError
        If there is none.
    """
    state, unstable = unloaded(system.scene), 0
    for cycles in options.approach.cycles:
        amplitudes = list[float]()
        for cycle, end in cycles_from(system, cycles, state):
            poll()
            amplitudes.append(float(measure(cycle).amplitude.max(initial=0.0)))
            state = end
        orbit = shoot(system, state, poll, options)
        unstable += orbit is not None and not orbit.stable
        # twice near an unstable one: the motion goes around it, with a multiple of its period or irregularly
        if orbit is not None and (orbit.stable or unstable > 1):
            return orbit
    at = spoken(system.omega, system.scene.frequency_unit)
    raise SimulationError(
        f"the motion from rest at {at} has not become periodic "
        f"in {sum(options.approach.cycles)} cycles. {_description(system, np.array(amplitudes), options)}"
    )


def _description(
    system: EquationsOfMotion, amplitude: FloatArray, options: ShootingOptions = SHOOTING
) -> str:
    """Sentence on a motion that has not become periodic, from the amplitudes of its last cycles."""
    first, second = np.array_split(amplitude, 2)
    if abs(second.mean() - first.mean()) > options.approach.max_drift * np.ptp(amplitude):
        return "It may grow without end, repeat only after several periods, or need a guess"
    modal = system.scene.modal
    rate = float((modal.damping * modal.frequency).min())
    last = -np.log(options.approach.settled_fraction) / rate / system.period if rate > 0.0 else np.inf
    slow = f", or settles only in some {last:.1g} cycles" if last > sum(options.approach.cycles) else ""
    return (
        f"The amplitude of its last {amplitude.size} lies between {amplitude.min():.4g} and "
        f"{amplitude.max():.4g}, and neither grows nor decays. It is irregular, or repeats only after "
        f"several periods{slow}. --at has the extent of such a motion"
    )


def shoot(
    system: EquationsOfMotion, guess: State, poll: Poll = never_interrupt, options: ShootingOptions = SHOOTING
) -> Orbit | None:
    """The orbit by Newton's method from a state at the forces' angle 0; None if it does not converge."""
    x = np.concatenate((guess.q, guess.velocity, guess.friction))
    found = converged(Shot(system, x), poll=poll, options=options)
    return None if found is None else closed(*found)


def converged(
    shot: Shot,
    most: int | None = None,
    poll: Poll = never_interrupt,
    shortest: float | None = None,
    options: ShootingOptions = SHOOTING,
) -> tuple[Shot, int] | None:
    """The shot that closes, by Newton's method from one that does not, and the number of steps.

    None after `most` steps, if a step has to be shortened below the factor `shortest`, or if the solution is
    not determined by the forces.
    """
    found = _newton(shot, most, poll, shortest, options)
    return found if found is not None and _determined(found[0], options) else None


def _determined(shot: Shot, options: ShootingOptions) -> bool:
    """Whether the forces determine the motion, and not rounding.

    At the resonance of an undamped mode a disturbance returns unchanged. Then only a motion closes that is so
    great that, within the closure tolerance, it would also close without forces. A mode that is free to drift
    has such disturbances as well, but its motion is determined by the forces.
    """
    if np.abs(1.0 - shot.other_multipliers).min(initial=1.0) > options.closure.min_return:
        return True
    without_forces = Shot(shot.system.at_level(0.0), shot.x, shot.resting, shot.periods)
    return without_forces.residual > options.closure.tolerance


def _newton(
    shot: Shot, most: int | None, poll: Poll, shortest: float | None, options: ShootingOptions
) -> tuple[Shot, int] | None:
    """Newton's method, see `converged`."""
    most = options.closure.max_iterations if most is None else most
    shortest = options.closure.min_step if shortest is None else shortest
    for iteration in range(most):
        poll()
        if shot.residual <= options.closure.tolerance:
            return shot, iteration
        better = _improved(shot, shortest, options)
        if better is None:
            return (shot, iteration) if shot.residual <= 100.0 * options.closure.tolerance else None
        shot = better
    return None


def closed(shot: Shot, iterations: int = 0) -> Orbit:
    """The orbit of a shot that closes."""
    system = shot.system
    return Orbit(
        system.scene, system.omega, shot.state, shot.cycle, shot.multipliers, shot.residual, iterations
    )


def _step(shot: Shot, options: ShootingOptions = SHOOTING) -> FloatArray:
    """The Newton step of a shot, of minimum norm: 0 along directions in which the closure does not change."""
    matrix = shot.by_state * shot.scale / shot.scale[:, None]
    solution = np.linalg.lstsq(matrix, -shot.closure / shot.scale, rcond=options.closure.rank_tolerance)[0]
    with np.errstate(over="ignore"):  # a step that is not finite is rejected when it is tried
        step: FloatArray = solution * shot.scale
    return step


def _improved(shot: Shot, shortest: float, options: ShootingOptions = SHOOTING) -> Shot | None:
    """The shot after a Newton step, shortened until the closure error decreases; None if it never does."""
    step, size = _step(shot, options), 1.0
    while size > shortest:
        try:
            new = Shot(shot.system, shot.x + size * step, shot.resting, shot.periods)
        except SimulationError:  # too far away to be computed
            size *= 0.5
            continue
        # across corners of the map a full step may increase the residual
        if new.residual < shot.residual * (1.0 if size < 1.0 else 2.0 if shot.residual > 1e-6 else 1.0):
            return new
        size *= 0.5
    return None
