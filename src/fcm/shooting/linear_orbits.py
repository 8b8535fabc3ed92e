"""Periodic motions in which no contact changes its state: linear, and found without iteration.

A contact that sticks may be held closed by its own residual friction, wedged in the strained structure. Such
a motion may be far from every other, and no branch need lead to it. The residual friction of the sticking
contacts changes only the mean, and linearly. So a linear program decides whether some residual friction keeps
these contacts from slipping and opening, and the open ones open.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from itertools import product

import numpy as np
import numpy.typing as npt

from fcm.frozen import Frozen
from fcm.harmonic_balance.wave_extremes import greatest
from fcm.model.scene import FloatArray, Scene, has_friction
from fcm.shooting.options import SHOOTING, ShootingOptions
from fcm.shooting.periodic_orbit import unloaded
from fcm.shooting.residual_traction import resting
from fcm.signals import undisturbed
from fcm.time_domain.equations_of_motion import EquationsOfMotion
from fcm.time_domain.state import State


class LinearOrbit(Frozen):
    """A motion in which no contact changes its state."""

    states: tuple[str, ...]  # of each contact: E sticks, or is closed without friction; S is open
    residual: FloatArray  # (contact,) k_u w of the slip motions w
    mean: FloatArray  # (mode,)
    wave: npt.NDArray[np.complex128]  # (driven, mode) of Im(sum_h wave_h exp(i h omega t))
    state: State  # at the forces' angle 0


def linear_motions(
    scene: Scene, omega: float, as_started: bool = False, options: ShootingOptions = SHOOTING
) -> list[LinearOrbit]:
    """Motions at a frequency [rad/s] in which a contact with friction sticks and none changes its state.

    Held contacts are included. The residual friction is the nearest to that of the scene's start, or with
    as_started exactly that.
    """
    whole = scene.whole()
    system, count = EquationsOfMotion(whole, omega), len(whole.contacts)
    wanted = system.k_u * resting(whole)
    closed = (
        product((True, False), repeat=count) if count <= options.linear.max_combined else [(True,) * count]
    )
    found = (_motion(system, np.array(one, dtype=bool), wanted, as_started, options) for one in closed)
    return [one for one in found if one is not None]


def started_states(scene: Scene, omega: float, options: ShootingOptions = SHOOTING) -> list[State]:
    """Guesses from linear motions whose sticking contacts rest where the scene starts."""
    computed = scene.computed()
    found = linear_motions(scene, omega, as_started=True, options=options)
    return [replace(one.state, friction=one.state.friction[computed]) for one in found]


def about_rest(scene: Scene, omega: float, level: float) -> Iterator[State]:
    """Yield guesses at a level of the forces: contacts as at rest, then all stuck, then all open."""
    whole, computed = scene.whole(), scene.computed()
    system, rest = EquationsOfMotion(whole, omega).at_level(level), unloaded(whole)
    at_rest = system.preload + system.stiffness * (system.normal @ rest.q) > 0.0
    for closed in (at_rest, np.ones_like(at_rest), np.zeros_like(at_rest)):
        stuck = [j for j in np.flatnonzero(closed).tolist() if has_friction(whole.contacts[j])]
        wave = linear_answer(system, closed, stuck)[0]
        still, orders = wave.sum(axis=0), np.array(system.harmonics)
        friction = np.where(closed, rest.friction, 0.0)
        friction[stuck] += system.k_u[stuck] * (system.tangential[stuck] @ still.imag)
        yield State(rest.q + still.imag, omega * (orders @ wave.real), friction[computed])


def _motion(
    system: EquationsOfMotion,
    closed: npt.NDArray[np.bool_],
    wanted: FloatArray,
    as_started: bool,
    options: ShootingOptions = SHOOTING,
) -> LinearOrbit | None:
    """The linear motion with some contacts closed; None if no residual friction admits it."""
    stuck = [j for j in np.flatnonzero(closed).tolist() if has_friction(system.scene.contacts[j])]
    if not stuck:
        return None
    try:
        wave, mean, by_residual = linear_answer(system, closed, stuck)
    except np.linalg.LinAlgError:  # a mode is free to drift, or resonates without damping
        return None
    limits = list(_limits(system, closed, stuck, wave, mean, by_residual))
    rows, least = np.array([row for row, _ in limits]), np.array([least for _, least in limits])
    inside = _nearest_inside(rows, least, wanted[stuck], as_started, options)
    if inside is None:
        return None
    mean = mean + by_residual @ inside
    q, residual, friction = mean + wave.imag.sum(axis=0), np.zeros(closed.size), np.zeros(closed.size)
    residual[stuck] = inside
    friction[stuck] = system.k_u[stuck] * (system.tangential[stuck] @ q) - inside
    state = State(q, system.omega * (np.array(system.harmonics) @ wave.real), friction)
    return LinearOrbit(tuple("E" if one else "S" for one in closed), residual, mean, wave, state)


def linear_answer(
    system: EquationsOfMotion, closed: npt.NDArray[np.bool_], stuck: list[int]
) -> tuple[npt.NDArray[np.complex128], FloatArray, FloatArray]:
    """Response of the modes: harmonics (driven, mode), mean without residual friction, and its derivative.

    The derivative (mode, stuck contact) is that of the mean by residual friction.
    """
    modal, across, along = system.scene.modal, system.normal, system.tangential
    stiffness, steady = np.diag(modal.mass * modal.frequency**2), np.array(system.static, dtype=np.float64)
    for contact, row, shut in zip(system.scene.contacts, across, closed, strict=True):
        load = contact.n_0 if shut else 0.0
        stiffness += shut * contact.k_v * np.outer(row, row)
        steady -= (load - max(contact.n_0, 0.0)) * row
    for j in stuck:
        stiffness += system.k_u[j] * np.outer(along[j], along[j])
    damping = 2.0 * modal.mass * modal.damping * modal.frequency
    rates = [harmonic * system.omega for harmonic in system.harmonics]
    dynamic = [stiffness + np.diag(rate * (1j * damping - modal.mass * rate)) for rate in rates]
    wave = np.linalg.solve(dynamic, system.wave[..., None])[..., 0].astype(np.complex128)
    still = np.linalg.solve(stiffness, np.column_stack((steady, along[stuck].T))).astype(np.float64)
    return wave, still[:, 0], still[:, 1:]


def _limits(
    system: EquationsOfMotion,
    closed: npt.NDArray[np.bool_],
    stuck: list[int],
    wave: npt.NDArray[np.complex128],
    mean: FloatArray,
    by_residual: FloatArray,
) -> Iterator[tuple[FloatArray, float]]:
    """Yield the conditions that keep every contact in its state: rows, and lower bounds of row @ residual."""
    for j, contact in enumerate(system.scene.contacts):
        if j not in stuck:
            press, sign = contact.k_v * system.normal[j], 1.0 if closed[j] else -1.0
            yield (
                sign * (press @ by_residual),
                _greatest_descent(system, sign * (wave @ press)) - sign * (contact.n_0 + press @ mean),
            )
        else:
            yield from sticking(system, j, np.array(stuck) == j, wave, mean, by_residual)


def sticking(
    system: EquationsOfMotion,
    j: int,
    own: npt.NDArray[np.bool_],
    wave: npt.NDArray[np.complex128],
    mean: FloatArray,
    by_residual: FloatArray,
) -> Iterator[tuple[FloatArray, float]]:
    """Yield the conditions that keep contact j from slipping in either direction, as `_limits`.

    own: mask of its own entry in the residual friction.
    """
    contact = system.scene.contacts[j]
    press, pull = contact.k_v * system.normal[j], contact.k_u * system.tangential[j]
    load = press @ by_residual, contact.n_0 + press @ mean, wave @ press
    force = pull @ by_residual - own, pull @ mean, wave @ pull
    for sign in (1.0, -1.0):
        row, constant, swing = (contact.mu * n - sign * f for n, f in zip(load, force, strict=True))
        yield row, _greatest_descent(system, swing) - constant


def _greatest_descent(system: EquationsOfMotion, swing: npt.NDArray[np.complex128]) -> float:
    """Depth below zero of the least value of Im(sum_h swing_h exp(i h theta)), swing (driven,)."""
    if swing.size == 1:
        return float(abs(swing[0]))
    return float(greatest(1j * swing[None, :, None], np.array(system.harmonics))[0, 0])


def _nearest_inside(
    rows: FloatArray,
    least: FloatArray,
    wanted: FloatArray,
    just_that: bool,
    options: ShootingOptions = SHOOTING,
) -> FloatArray | None:
    """The residual friction nearest to wanted with rows @ residual >= least, or None."""
    size = float(np.abs(least).max()) or 1.0
    if (rows @ wanted >= least + options.linear.min_limit_distance * size).all():
        return wanted
    if just_that:
        return None
    nearest = _nearest_number if wanted.size == 1 else _nearest
    tried = (
        nearest(rows, least + kept * size, wanted)
        for kept in (options.linear.limit_distance, options.linear.min_limit_distance)
    )
    return next((one for one in tried if one is not None), None)


def _nearest_number(rows: FloatArray, least: FloatArray, wanted: FloatArray) -> FloatArray | None:
    """The nearest residual friction for a single contact that sticks, see `_nearest_inside`."""
    row = rows[:, 0]
    if (least[row == 0.0] > 0.0).any():
        return None
    low = (least[row > 0.0] / row[row > 0.0]).max(initial=-np.inf)
    high = (least[row < 0.0] / row[row < 0.0]).min(initial=np.inf)
    return np.clip(wanted, low, high) if low <= high else None


def _nearest(rows: FloatArray, least: FloatArray, wanted: FloatArray) -> FloatArray | None:
    """The nearest residual friction in the 1-norm, by a linear program."""
    with undisturbed():  # an import that is interrupted cannot be repeated
        from scipy.optimize import linprog  # loading takes a tenth of a second

    count = wanted.size
    one, none = np.eye(count), np.zeros((len(rows), count))
    upper = np.block([[-rows, none], [one, -one], [-one, -one]])
    bounds = [(None, None)] * count + [(0.0, None)] * count
    found = linprog(
        np.repeat((0.0, 1.0), count), upper, np.concatenate((-least, wanted, -wanted)), bounds=bounds
    )
    return found.x[:count] if found.status == 0 else None
