"""Stable motions at the frequencies that are visited, to which neither of the sweeps comes.

A sweep is on one motion at a time, so of several stable ones at a frequency two are met at most, and at a
single frequency one. All solutions of the balance lead to others: those reached from rest by the level of the
forces, and those of its branches over the range of the scene, if it has one. So do the motions in which
contacts stick as the scene starts, and the one from rest.
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
    """Motions that were found at one frequency."""

    frequency: float  # [rad/s]
    samples: tuple[OrbitRecord, ...]
    whole: bool = True  # whether the level of the forces was followed to its end there


def coexisting_orbits(
    scene: Scene,
    frequencies: Sequence[float],
    visited: Sequence[OrbitRecord],
    limit: CurveTimeLimit,
    uncertain: UncertainFrequencies,
    options: ShootingOptions = SHOOTING,
) -> Iterator[OrbitRecord]:
    """The stable motions at each of some frequencies [rad/s] that are none of those visited; each saved.

    uncertain take the frequencies at which there may be more. The limit of time is asked now and then.
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

    Where no periodic motion is near a guess, or one with a multiplier below -1 or a complex pair outside the
    unit circle, the motion is simulated from there, and from rest. It is not where a motion of several
    periods, or an irregular one, is known: the simulation may come to that. Nor is it where a mode has no
    damping, as its transient may stay.
    """
    found, damped = list[OrbitRecord](), bool((problem.scene.modal.damping > 0.0).all())
    for guess in (*guesses, None):
        there = [*known, *found]
        simulate = damped and all(one.repeats == 1 for one in there)
        try:
            one = _orbit_from(problem, omega, guess, simulate, there, poll)
        except SimulationError:  # it cannot be computed, or is not determined
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
    """The stable motion that a guess, or rest, leads to, if it does and that is not known."""
    if guess is None:
        return _simulated(problem, omega, unloaded(problem.scene), known, poll) if simulate else None
    orbit = shoot(EquationsOfMotion(problem.scene, omega), guess, poll)
    if simulate and (orbit is None or (not orbit.stable and _disturbance_alternates(orbit))):
        return _simulated(problem, omega, guess, known, poll)
    return _stable(problem, orbit, known, poll)


def _stable(
    problem: OrbitProblem, orbit: Orbit | None, known: Sequence[OrbitRecord], poll: Poll
) -> OrbitRecord | None:
    """The record of a motion that is stable and not known; else None."""
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
    """Whether disturbances grow from side to side, or around; beside others two motions lie, each near."""
    greatest = complex(orbit.multipliers[0])
    return greatest.real < 0.0 or greatest.imag != 0.0


def _simulated(
    problem: OrbitProblem, omega: float, guess: State, known: Sequence[OrbitRecord], poll: Poll
) -> OrbitRecord | None:
    """The steady motion that a simulation from a guess comes to.

    If it repeats after each period, only one that is not known; None without any.
    """
    system = EquationsOfMotion(problem.scene, omega)
    found = steady(system, guess, poll)
    if not isinstance(found, SteadyMotion):
        return None
    if found.periods != 1:
        return recorded_steady(omega, found)
    return _stable(problem, shoot(system, found.state, poll), known, poll)


def _same(one: OrbitRecord, other: OrbitRecord) -> bool:
    """Whether two motions are one; of those that do not repeat, whether they are as large."""
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
