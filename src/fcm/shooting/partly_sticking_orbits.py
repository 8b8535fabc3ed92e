"""Motions in which some contacts always stick, on their own residual friction, while others slip.

Like those of `linear_orbits` they may be far from every motion of a curve: with other residual friction the
sticking contacts would open or slip. Residual friction that may hold these contacts is computed as if the
others stuck, slid without friction or were open. Then the sticking contacts are held with it, and the motion
with the others is simulated.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import combinations, product

import numpy as np

from fcm.frozen import Frozen
from fcm.model.scene import FloatArray, HeldContact, Scene, has_friction
from fcm.shooting.linear_orbits import linear_answer, sticking
from fcm.shooting.options import SHOOTING, ShootingOptions
from fcm.shooting.periodic_orbit import (
    Orbit,
    Poll,
    closed,
    converged,
    never_interrupt,
    shoot,
    within_unit_circle,
)
from fcm.shooting.residual import Shot
from fcm.shooting.residual_traction import always_stuck, resting, resting_at
from fcm.shooting.traction_families import Family, family
from fcm.time_domain.equations_of_motion import EquationsOfMotion
from fcm.time_domain.errors import SimulationError
from fcm.time_domain.simulation import cycles_from
from fcm.time_domain.state import State

Choices = list[FloatArray]


class PartlyStickingOrbit(Frozen):
    """A stable motion in which some contacts always stick, and its family over residual friction."""

    states: tuple[str, ...]  # of each contact over the period
    residual: FloatArray  # (contact,) k_u w of the slip motions w; 0 for contacts that do not stick
    family: Family


def partly_stuck_motions(
    scene: Scene,
    omega: float,
    known: list[Family],
    poll: Poll = never_interrupt,
    options: ShootingOptions = SHOOTING,
) -> list[PartlyStickingOrbit]:
    """Partly sticking motions at a frequency [rad/s] that belong to no known family.

    Held contacts are included. With more contacts than `options.linear.max_combined` none are sought.
    """
    whole, found, families = scene.whole(), list[PartlyStickingOrbit](), list(known)
    system = EquationsOfMotion(whole, omega)
    for stuck, residual in _residual_guesses(system, poll, options):
        if any(_has_family(one, stuck, residual) for one in families):
            continue
        poll()
        orbit = _with_held(system, stuck, residual, poll, options)
        if orbit is None or any(_contains(one, orbit, options) for one in families):
            continue
        one = _with_family(orbit, poll, options)
        if one is not None:
            found.append(one)
            families.append(one.family)
    return found


def partly_stuck_as_started(
    scene: Scene, omega: float, poll: Poll = never_interrupt, options: ShootingOptions = SHOOTING
) -> list[State]:
    """Guesses from partly sticking motions whose sticking contacts rest where the scene starts."""
    whole, computed = scene.whole(), scene.computed()
    system = EquationsOfMotion(whole, omega)
    wanted = system.k_u * resting(whole)
    return [
        State(orbit.state.q, orbit.state.velocity, orbit.state.friction[computed])
        for stuck in _sets(whole, options)
        if _choices(system, stuck, wanted[list(stuck)], options)
        and (orbit := _with_held(system, stuck, wanted[list(stuck)], poll, options)) is not None
    ]


def _sets(scene: Scene, options: ShootingOptions = SHOOTING) -> Iterator[tuple[int, ...]]:
    """Yield sets of contacts that may stick while others do not."""
    rough = [j for j, contact in enumerate(scene.contacts) if has_friction(contact)]
    count = len(scene.contacts)
    for size in range(1, count if count <= options.linear.max_combined else 1):
        yield from combinations(rough, size)


def _residual_guesses(
    system: EquationsOfMotion, poll: Poll, options: ShootingOptions = SHOOTING
) -> Iterator[tuple[tuple[int, ...], FloatArray]]:
    """Yield sets of contacts, and residual friction with which they may stick."""
    for stuck in _sets(system.scene, options):
        poll()
        for residual in _spread_out(_choices(system, stuck, options=options), options):
            yield stuck, residual


def _choices(
    system: EquationsOfMotion,
    stuck: tuple[int, ...],
    just: FloatArray | None = None,
    options: ShootingOptions = SHOOTING,
) -> Choices:
    """Residual friction that keeps contacts stuck, for each combination of linear states of the others."""
    scene, found = system.scene, Choices()
    others = [j for j in range(len(scene.contacts)) if j not in stuck]
    for letters in product("EFS", repeat=len(others)):  # stuck, closed without friction, open
        pairs = list(zip(others, letters, strict=True))
        closed = np.array([dict(pairs).get(j) != "S" for j in range(len(scene.contacts))])
        springs = [*stuck, *(j for j, letter in pairs if letter == "E" and has_friction(scene.contacts[j]))]
        try:
            wave, mean, by_residual = linear_answer(system, closed, springs)
        except np.linalg.LinAlgError:  # a mode is free to drift, or resonates without damping
            continue
        free = by_residual[:, : len(stuck)]
        limits = [one for j in stuck for one in sticking(system, j, np.array(stuck) == j, wave, mean, free)]
        rows, least = np.array([row for row, _ in limits]), np.array([number for _, number in limits])
        if just is None:
            found += _inside(rows, least, options)
        elif (rows @ just >= least).all():
            found.append(just)
    return found


def _inside(rows: FloatArray, least: FloatArray, options: ShootingOptions = SHOOTING) -> Choices:
    """Points near the vertices of the region rows @ x >= least, and first their mean."""
    size, count, found = float(np.abs(least).max()) or 1.0, rows.shape[1], Choices()
    for kept in options.partly_sticking.limit_distances:
        beyond = least + kept * size
        for pair in combinations(range(len(rows)), count):
            one = rows[list(pair)]
            if np.linalg.cond(one) < 1.0 / np.finfo(float).eps:
                corner: FloatArray = np.linalg.solve(one, beyond[list(pair)]).astype(np.float64)
                if (rows @ corner >= beyond - 1e-9 * size).all():
                    found.append(corner)
    return [np.mean(found, axis=0), *found] if found else found


def _spread_out(choices: Choices, options: ShootingOptions = SHOOTING) -> Choices:
    """Choices that are not close to one another; earlier ones take precedence."""
    kept, size = Choices(), float(np.ptp(choices, axis=0).max(initial=0.0)) if choices else 0.0
    for one in choices:
        if all(np.abs(one - other).max() > options.partly_sticking.min_distance * size for other in kept):
            kept.append(one)
    return kept[: options.partly_sticking.max_tries]


def _has_family(known: Family, stuck: tuple[int, ...], residual: FloatArray) -> bool:
    """Whether a complete family of exactly these contacts includes this residual friction."""
    if not known.complete or known.contacts != stuck:
        return False
    return bool(((-known.friction[:, 1] <= residual) & (residual <= -known.friction[:, 0])).all())


def _contains(known: Family, orbit: Orbit, options: ShootingOptions = SHOOTING) -> bool:
    """Whether a motion shares a sticking contact with a family, and its amplitudes lie within the family."""
    room = options.partly_sticking.amplitude_tolerance * known.greatest
    amplitude = orbit.measure.amplitude
    inside = (amplitude >= known.least - room) & (amplitude <= known.greatest + room)
    stuck = always_stuck(orbit.cycle.system, orbit.cycle.segments)
    return bool(inside.all()) and not set(stuck).isdisjoint(known.contacts)


def _with_held(
    system: EquationsOfMotion,
    stuck: tuple[int, ...],
    residual: FloatArray,
    poll: Poll,
    options: ShootingOptions = SHOOTING,
) -> Orbit | None:
    """The stable motion found with contacts held on residual friction, if they also stick when released."""
    contacts = system.scene.contacts
    rest = {j: float(force) / contacts[j].k_u for j, force in zip(stuck, residual, strict=True)}
    held = system.scene.holding([HeldContact(j, contacts[j], False, w) for j, w in rest.items()])
    try:
        orbit = _approached(EquationsOfMotion(held, system.omega), poll, options)
        return None if orbit is None else _released(system, orbit.state, rest, poll, options)
    except SimulationError:  # the motion cannot be computed
        return None


def _approached(system: EquationsOfMotion, poll: Poll, options: ShootingOptions = SHOOTING) -> Orbit | None:
    """The stable motion that a simulation from zero displacement soon approaches; None without one."""
    state = State.unloaded(system.scene)
    for count in options.partly_sticking.cycles:
        for _, end in cycles_from(system, count, state):
            poll()
            state = end
        orbit = shoot(system, state, poll, options)
        if orbit is not None and orbit.stable:
            return orbit
    return None


def _released(
    system: EquationsOfMotion,
    state: State,
    rest: dict[int, float],
    poll: Poll,
    options: ShootingOptions = SHOOTING,
) -> Orbit | None:
    """The motion with the held contacts released, if it is stable and they always stick; else None."""
    contacts, displacement = system.scene.contacts, system.scene.modal.shapes.T @ state.q
    friction = np.zeros(len(contacts))
    friction[[j for j in range(friction.size) if j not in rest]] = state.friction
    for j, w in rest.items():
        friction[j] = contacts[j].k_u * (contacts[j].tangential @ displacement - w)
    shot = Shot(system, np.concatenate((state.q, state.velocity, friction)))
    sticks = set(rest) <= set(always_stuck(system, shot.segments))
    found = (
        converged(shot, poll=poll, options=options)
        if sticks and shot.residual < options.partly_sticking.closure_tolerance
        else None
    )
    return closed(*found) if found is not None and within_unit_circle(found[0].multipliers, options) else None


def _with_family(orbit: Orbit, poll: Poll, options: ShootingOptions = SHOOTING) -> PartlyStickingOrbit | None:
    """The motion with its family; None if the family is unknown."""
    system, state = EquationsOfMotion(orbit.scene, orbit.frequency), orbit.state
    x = np.concatenate((state.q, state.velocity, state.friction))
    try:
        found = family(orbit.scene, orbit.frequency, state, poll=poll, options=options)
    except SimulationError:
        return None
    if found is None:
        return None
    residual, stuck = np.zeros(len(orbit.states)), list(found.contacts)
    residual[stuck] = (system.k_u * resting_at(system, x))[stuck]
    return PartlyStickingOrbit(orbit.states, residual, found)
