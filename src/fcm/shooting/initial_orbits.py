"""Periodic motions from which the curves of a scene start: near its harmonic balance, or from rest."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from contextlib import suppress
from itertools import islice
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from fcm.continuation.corrector import Newton
from fcm.model.scene import FloatArray, Scene
from fcm.shooting.damping_homotopy import less_damped, more_damped
from fcm.shooting.harmonic_balance_branches import Place, is_stable, states_of_branches
from fcm.shooting.harmonic_balance_state import balanced_states, computed_state
from fcm.shooting.linear_orbits import started_states
from fcm.shooting.options import SHOOTING, ShootingOptions
from fcm.shooting.partly_sticking_orbits import partly_stuck_as_started
from fcm.shooting.periodic_orbit import Orbit, Poll, approached, never_interrupt, shoot
from fcm.shooting.problem import OrbitProblem, correct_at_frequency
from fcm.shooting.residual import Shot
from fcm.shooting.traction_families import member_at_start
from fcm.time_domain.equations_of_motion import EquationsOfMotion
from fcm.time_domain.errors import SimulationError
from fcm.time_domain.state import State
from fcm.units import spoken

if TYPE_CHECKING:
    from fcm.accuracy.unchecked_response import UncheckedResponse


class InitialOrbits(NamedTuple):
    """Points from which branches are followed, and reasons where there are none."""

    points: list[FloatArray]  # z, from which branches are followed
    missed: dict[float, str]  # reasons by the ends of the range that have none
    sought: bool  # whether they come from elsewhere in the range, as the usual frequencies gave none
    away_from_balance: (
        bool  # whether the balance has more solutions than there are points: see `converged_balance`
    )


def find_initial_orbits(problem: OrbitProblem, poll: Poll = never_interrupt) -> InitialOrbits:
    """Find points from which branches are followed.

    At both ends of the range, and at the resonances inside, the guesses are all solutions of the balance and
    motions in which contacts stick as the scene starts. Without a stable motion at an end, the motion from
    rest is simulated there. If nothing is found at all, frequencies across the range are tried, first with
    solutions of the balance of one harmonic. Last, the damping is raised and taken away in steps.

    poll is called regularly.
    """
    scene, found, missed = problem.scene, list[FloatArray](), dict[float, str]()
    inside, apart = inner_resonances(scene), False
    for omega in (*scene.frequency_range, *inside):
        guesses, before = balanced_states(scene, omega, poll, problem.options), len(found)
        orbits = [
            *_shot(scene, omega, guesses, poll, problem.options),
            *_shot(scene, omega, started_states(scene, omega, problem.options), poll, problem.options),
        ]
        if scene.start is not None:
            orbits += _shot(
                scene,
                omega,
                partly_stuck_as_started(scene, omega, poll, problem.options),
                poll,
                problem.options,
            )
        try:
            if omega not in inside and not any(orbit.stable for orbit in orbits):
                orbits += _from_rest(scene, omega, bool(orbits), poll, problem.options)
        except SimulationError as error:
            missed[omega] = str(error)
        for orbit in orbits:
            try:
                _add_distinct(problem, found, first_point(problem, orbit, poll))
            except SimulationError as error:
                missed[omega] = str(error)
        apart = apart or len(found) - before < len(guesses)
    at_ends = {omega: missed[omega] for omega in missed if omega not in inside}
    return InitialOrbits(found or _first_anywhere(problem, poll), at_ends, not found, apart)


class BalanceOrbits(NamedTuple):
    """Points found from the branches of a balance, and whether each is as high as the balance there.

    unreached: frequencies [rad/s] and heights of ends and tops at which the balance is stable, but no orbit
    of that height was found.
    """

    points: list[FloatArray]
    near_balance: bool
    unreached: list[tuple[float, float]]


def orbits_along_balance(
    problem: OrbitProblem, found: UncheckedResponse, poll: Poll = never_interrupt
) -> BalanceOrbits:
    """Points near the ends and tops of a balance's branches.

    The points of `find_initial_orbits` need not lead to them: some branches are isolas, perhaps only for the
    exact motion. poll is called regularly.
    """
    points, alike, unreached = list[FloatArray](), True, list[tuple[float, float]]()
    for height, top, places in states_of_branches(problem.scene, found, problem.options):
        there, high = list[tuple[float, FloatArray]](), False
        for place in islice(places, problem.options.start.max_guesses):
            there += [(height_of(problem, z), z) for z in _points(problem, place, poll)]
            high = bool(there) and there[-1][0] >= problem.options.start.min_height * height
            if high:
                break
        if there:  # the others may be on a lower branch
            _add_distinct(problem, points, max(there, key=lambda one: one[0])[1])
        alike = alike and high
        if not high and is_stable(found, top):
            unreached.append((float(top[-1]), height))
    return BalanceOrbits(points, alike, unreached)


def height_of(problem: OrbitProblem, z: FloatArray) -> float:
    """The greatest amplitude of all degrees of freedom."""
    shot = problem.shot(z)
    return 0.0 if shot is None else float(shot.amplitude.max())


def _points(problem: OrbitProblem, place: Place, poll: Poll) -> Iterator[FloatArray]:
    """Yield the motion near a guess, if there is one, as a point of a curve."""
    omega, guess = place
    for orbit in _shot(problem.scene, omega, [guess], poll, problem.options):
        with suppress(SimulationError):
            yield first_point(problem, orbit, poll)


def _first_anywhere(problem: OrbitProblem, poll: Poll) -> list[FloatArray]:
    """The first point found from the balance, or else by damping, at frequencies across the range."""
    scene = problem.scene
    for omega in np.linspace(*scene.frequency_range, problem.options.start.frequencies + 1)[::-1].tolist():
        for orbit in _shot(
            scene, omega, _corrected_states(scene, omega, poll, problem.options), poll, problem.options
        ):
            try:
                return [first_point(problem, orbit, poll)]
            except SimulationError:
                continue
    return next(_by_damping(problem, poll), [])


def _by_damping(problem: OrbitProblem, poll: Poll) -> Iterator[list[FloatArray]]:
    """Yield points found from motions with more damping, at frequencies across the range."""
    scene = problem.scene
    more = more_damped(scene, problem.options)
    if more is None:
        return
    easier, factor = more
    for omega in np.linspace(*scene.frequency_range, problem.options.start.damped_frequencies + 1).tolist():
        for orbit in near_balance(easier, omega, poll, problem.options):
            poll()
            with suppress(SimulationError):
                z = less_damped(
                    scene,
                    first_point(OrbitProblem(easier, options=problem.options), orbit, poll),
                    factor,
                    problem.options,
                )
                if z is not None:
                    yield [z]


def _corrected_states(
    scene: Scene, omega: float, poll: Poll, options: ShootingOptions = SHOOTING
) -> Iterator[State]:
    """Yield guesses from the balance of one harmonic, if possible corrected with more harmonics.

    Continuation in the level of the forces with as many harmonics would take a hundred times as long.
    """
    whole = scene.whole()
    if not (whole.modal.frequency.all() and whole.contacts):
        return
    from fcm.branches.force_level import solutions
    from fcm.harmonic_balance.system import System

    one = System(whole, options.start.harmonics, other_options=options.balance.others)
    more = System(whole, options.start.corrected_harmonics)
    newton = Newton(more.new_balance())
    one.work.poll = poll
    for solution in solutions(one, omega).solutions:
        z = more.extended(solution, options.start.harmonics)
        yield computed_state(
            scene,
            options.start.corrected_harmonics,
            np.array(newton.z) if correct_at_frequency(newton, z) else z,
            options,
        )


def solution_at(
    scene: Scene, omega: float, poll: Poll = never_interrupt, options: ShootingOptions = SHOOTING
) -> Orbit:
    """A stable solution near the balance, else the one that a simulation from rest approaches, else any.

    With a [start] in the scene, solutions in which contacts stick with that friction come first. poll is
    called regularly.

    Raises
    ------
    SimulationError
        If there is none.
    """
    near = list[Orbit]()
    if scene.start is not None:
        near += _shot(scene, omega, started_states(scene, omega, options), poll, options)
        near += _shot(scene, omega, partly_stuck_as_started(scene, omega, poll, options), poll, options)
    near += near_balance(scene, omega, poll, options)
    stable = [orbit for orbit in near if orbit.stable]
    return (stable or _from_rest(scene, omega, bool(near), poll, options) or near)[0]


def near_balance(
    scene: Scene, omega: float, poll: Poll = never_interrupt, options: ShootingOptions = SHOOTING
) -> Iterator[Orbit]:
    """Yield the motions that shooting finds from the solutions of the balance."""
    return _shot(scene, omega, balanced_states(scene, omega, poll, options), poll, options)


def _shot(
    scene: Scene,
    omega: float,
    guesses: Iterable[State],
    poll: Poll = never_interrupt,
    options: ShootingOptions = SHOOTING,
) -> Iterator[Orbit]:
    """Yield the motions that shooting finds from guesses."""
    for guess in guesses:
        try:
            orbit = shoot(EquationsOfMotion(scene, omega), guess, poll, options)
        except SimulationError:
            continue
        if orbit is not None:
            yield orbit


def _from_rest(
    scene: Scene,
    omega: float,
    others: bool,
    poll: Poll = never_interrupt,
    options: ShootingOptions = SHOOTING,
) -> list[Orbit]:
    """The motion that a simulation from rest approaches; empty without one if there are others."""
    try:
        return [approached(EquationsOfMotion(scene, omega), poll, options)]
    except SimulationError:
        if others:
            return []
        raise


def inner_resonances(scene: Scene) -> list[float]:
    """Natural frequencies inside the range, with all contacts stuck or open; empty without a balance."""
    from fcm.branches.force_level import linear_resonances
    from fcm.harmonic_balance.system import System

    scene = scene.whole()
    return linear_resonances(System(scene)) if scene.modal.frequency.all() and scene.contacts else []


def _add_distinct(problem: OrbitProblem, found: list[FloatArray], z: FloatArray) -> None:
    problem.evaluate_scale(z)
    scale = np.asarray(problem.scale)
    if all(np.linalg.norm((z - other) / scale) > problem.options.start.distinct_distance for other in found):
        found.append(z)


def first_point(problem: OrbitProblem, orbit: Orbit, poll: Poll = never_interrupt) -> FloatArray:
    """The point z of a solution whose stuck contacts rest as near as possible to where the scene starts.

    Raises
    ------
    SimulationError
        If the solution is not determined.
    """
    z = problem.z(orbit.state, orbit.frequency)
    near = problem.shot(z)
    member = None if near is None else member_at_start(near, problem.shooting.resting, poll, problem.options)
    if member is not None:
        z = np.append(member.x[problem.free], orbit.frequency)
    newton = Newton(problem)
    if not correct_at_frequency(newton, z):
        if near is not None and member is None and any(choice.gap for choice in near.chosen):
            raise SimulationError(start_reason(problem.scene, orbit, near))
        raise SimulationError(undetermined_reason(orbit, problem.options))
    return np.array(newton.z)


def undetermined_reason(orbit: Orbit, options: ShootingOptions = SHOOTING) -> str:
    """Message on why a solution is not determined."""
    unit = orbit.scene.frequency_unit
    where = f"the solution at {spoken(orbit.frequency, unit)} to start from is not determined"
    ratio = orbit.frequency / float(orbit.scene.modal.frequency.max(initial=0.0) or np.inf)
    if ratio > options.search.rounding_frequency:
        return (
            f"{where}: that is {ratio:.1g} times the frequency of the highest mode, which hardly moves in "
            "one period of the force. Take a lower frequency"
        )
    return (
        f"{where}: a mode is free to drift, or resonates without damping. Hold it by a soft spring, add "
        "damping, or try another range"
    )


def start_reason(scene: Scene, orbit: Orbit, near: Shot) -> str:
    """Message that contacts cannot rest where the scene starts."""
    names = " and ".join(scene.contacts[choice.contact].name for choice in near.chosen if choice.gap)
    at = spoken(orbit.frequency, scene.frequency_unit)
    return (
        f"in the solution found at {at} the contact {names} always sticks, on residual friction of its own. "
        "With that of [start] there is none near it: give [start] another friction"
    )
