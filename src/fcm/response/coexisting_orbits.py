"""Stable motions at the visited frequencies that neither sweep reaches.

A sweep follows one motion at a time. So the two sweeps reach at most two of several stable motions at a
frequency, and one if there is a single frequency. Guesses for others are the solutions of the balance that
continuation in the force level reaches from rest, and those on its branches over the scene's range.
Further guesses are the motions in which contacts stick as the scene starts, and the state of rest.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np

from fcm.frozen import Frozen
from fcm.model.scene import FloatArray, Scene
from fcm.response.options import COEXISTING
from fcm.response.resumable_branches import CurveTimeLimit
from fcm.shooting.harmonic_balance_branches import states_across
from fcm.shooting.harmonic_balance_state import balance_solutions
from fcm.shooting.initial_orbits import first_point
from fcm.shooting.linear_orbits import started_states
from fcm.shooting.options import SHOOTING, ShootingOptions
from fcm.shooting.orbit_record import OrbitRecord, recorded_point, recorded_steady
from fcm.shooting.periodic_orbit import Orbit, Poll, shoot, unloaded
from fcm.shooting.problem import OrbitProblem
from fcm.shooting.steady_state import SteadyMotion, steady
from fcm.shooting.trace import frequency_text
from fcm.shooting.work_budget import UncertainFrequencies
from fcm.time_domain.equations_of_motion import EquationsOfMotion
from fcm.time_domain.errors import SimulationError
from fcm.time_domain.state import State


class CoexistingOrbits(Frozen):
    """Motions found at one frequency."""

    frequency: float  # [rad/s]
    samples: tuple[OrbitRecord, ...]
    whole: bool = True  # whether continuation in the force level was complete there


def coexisting_orbits(
    scene: Scene,
    frequencies: Sequence[float],
    visited: Sequence[OrbitRecord],
    limit: CurveTimeLimit,
    uncertain: UncertainFrequencies,
    options: ShootingOptions = SHOOTING,
) -> Iterator[OrbitRecord]:
    """Yield the stable motions at frequencies [rad/s] that are not among those visited; each is saved.

    Frequencies at which there may be more are added to uncertain. The time limit is polled regularly.
    """
    report, poll = limit.report, limit.poll
    saved = {one.frequency: one for one in report.saved if isinstance(one, CoexistingOrbits)}
    problem = OrbitProblem(replace(scene, frequency_range=(0.0, frequencies[-1])))
    left = [omega for omega in frequencies if omega not in saved]
    across = states_across(scene, left, poll)
    for omega in frequencies:
        found = saved.get(omega)
        if found is None:
            poll()
            report(1.0, f"other motions, {frequency_text(scene, omega)}")
            here = [one for one in visited if one.frequency == omega]
            known, whole = balance_solutions(scene, omega, poll, options)
            guesses = [*known, *across.get(omega, ()), *started_states(scene, omega)]
            found = CoexistingOrbits(omega, tuple(_coexisting_at(problem, omega, guesses, here, poll)), whole)
            report.save(found)
        uncertain.levels += [] if found.whole else [omega]
        yield from found.samples


def _coexisting_at(
    problem: OrbitProblem, omega: float, guesses: Sequence[State], known: list[OrbitRecord], poll: Poll
) -> list[OrbitRecord]:
    """Stable motions at one frequency that are not known yet.

    If no periodic motion is near a guess, the motion is simulated from there. It is also simulated if the
    orbit has a multiplier below -1 or a complex pair outside the unit circle, and from rest. There is no
    simulation if a motion of several periods, or an irregular one, is known, as it may end there. Nor is
    there one if a mode is undamped, as its transient may not decay.
    """
    found, damped = list[OrbitRecord](), bool((problem.scene.modal.damping > 0.0).all())
    for guess in (*guesses, None):
        there = [*known, *found]
        simulate = damped and all(one.repeats == 1 for one in there)
        try:
            one = _orbit_from(problem, omega, guess, simulate, there, poll)
        except SimulationError:  # the motion cannot be computed, or is not determined
            continue
        if one is not None and not any(_same(one, other) for other in there):
            found.append(one)
    return found


def _orbit_from(
    problem: OrbitProblem,
    omega: float,
    guess: State | None,
    simulate: bool,
    known: Sequence[OrbitRecord],
    poll: Poll,
) -> OrbitRecord | None:
    """The stable motion that a guess (None: rest) leads to; None if there is none, or it is known."""
    if guess is None:
        return _simulated(problem, omega, unloaded(problem.scene), known, poll) if simulate else None
    orbit = shoot(EquationsOfMotion(problem.scene, omega), guess, poll)
    if simulate and (orbit is None or (not orbit.stable and _disturbance_alternates(orbit))):
        return _simulated(problem, omega, guess, known, poll)
    return _stable(problem, orbit, known, poll)


def _stable(
    problem: OrbitProblem, orbit: Orbit | None, known: Sequence[OrbitRecord], poll: Poll
) -> OrbitRecord | None:
    """The record of a motion if it is stable and not known, else None."""
    if (
        orbit is None
        or not orbit.stable
        or any(_as_large(orbit, one, COEXISTING.orbit_tolerance) for one in known)
    ):
        return None
    z = first_point(problem, orbit, poll)
    sample = recorded_point(problem, z, np.zeros(z.size))
    return sample if sample.stable else None


def _disturbance_alternates(orbit: Orbit) -> bool:
    """Whether the greatest multiplier is negative or complex, so that no stable motion need be near.

    An orbit that is unstable by a positive multiplier lies between two other motions.
    """
    greatest = complex(orbit.multipliers[0])
    return greatest.real < 0.0 or greatest.imag != 0.0


def _simulated(
    problem: OrbitProblem, omega: float, guess: State, known: Sequence[OrbitRecord], poll: Poll
) -> OrbitRecord | None:
    """The steady motion in which a simulation from a guess ends; None without one.

    A motion that repeats after each period counts only if it is not known.
    """
    system = EquationsOfMotion(problem.scene, omega)
    found = steady(system, guess, poll)
    if not isinstance(found, SteadyMotion):
        return None
    if found.periods != 1:
        return recorded_steady(omega, found)
    return _stable(problem, shoot(system, found.state, poll), known, poll)


def _same(one: OrbitRecord, other: OrbitRecord) -> bool:
    """Whether two motions are the same; irregular ones are the same if they are nearly as large."""
    return _as_large(
        one,
        other,
        SHOOTING.steady.max_distance if 0 in (one.repeats, other.repeats) else COEXISTING.orbit_tolerance,
    )


def _as_large(one: OrbitRecord | Orbit, other: OrbitRecord, near: float) -> bool:
    """Whether the greatest and least displacements of two motions are the same."""
    apart = np.abs(_displacement_range(one) - _displacement_range(other)).max(initial=0.0)
    return bool(apart <= near * np.abs(_displacement_range(one)).max(initial=0.0))


def _displacement_range(one: OrbitRecord | Orbit) -> FloatArray:
    """The greatest and least displacements of a motion: (2, dof)."""
    return np.stack((one.measure.greatest, one.measure.least))
