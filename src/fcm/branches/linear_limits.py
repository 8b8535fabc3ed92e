"""Responses with linear contacts (as at rest, all stuck, all open), and the limits of the level they give.

Up to the lowest limit, all contacts stay as they are at rest. Beyond the highest limit, no contact begins to
slip, opens or closes.
"""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterator, Sequence

import numpy as np
import numpy.typing as npt

from fcm.branches.options import LINEAR_LIMITS
from fcm.harmonic_balance.system import System
from fcm.model.scene import FloatArray
from fcm.structure.linear import Linear

ComplexArray = npt.NDArray[np.complex128]


class _ResponseCache(threading.local):
    """The linear responses that each thread found last, by system, frequencies and springs."""

    def __init__(self) -> None:
        self.by_key: dict[tuple[object, ...], ComplexArray] = {}


_RESPONSES = _ResponseCache()


def linear_responses(system: System, omega: float, level: float) -> Iterator[FloatArray]:
    """Yield the linear response with the contacts as at rest, then all stuck, then all open."""
    for ports in _on_ports(system, omega):
        yield _unknowns(system, level * ports)


def _on_ports(system: System, omega: float) -> ComplexArray:
    """Responses of the ports (3, driven, port), in the order of `linear_responses`; the system keeps them."""
    if omega not in system.port_responses:
        precompute(system, (omega,))
    return system.port_responses[omega]


def precompute(system: System, frequencies: Sequence[float]) -> None:
    """Compute the linear responses at all frequencies at which solutions will be needed, at once.

    Those of the last systems are kept, as most are the same in a sweep.
    """
    at_rest = closed_at_rest(system)
    held = system.springs(stuck=True) * np.array([at_rest, np.ones(at_rest.size), np.zeros(at_rest.size)])
    key = (*system.linear.numbers, *frequencies, held.tobytes())
    known = _RESPONSES.by_key
    if key not in known or system.scene.ring is not None:
        if len(known) == LINEAR_LIMITS.max_kept:
            known.clear()
        known[key] = _with_springs(system, frequencies, held)
    system.port_responses.update(zip(frequencies, known[key], strict=True))


def _with_springs(system: System, frequencies: Sequence[float], held: FloatArray) -> ComplexArray:
    """Responses of the ports with springs held (case, port): (frequency, case, driven, port)."""
    cases, ports = held.shape
    linear = system.linear
    if type(linear) is Linear and linear.natural.size < ports:
        return np.moveaxis(linear.answers_with(held, np.array(frequencies, dtype=np.float64)), 0, 1)
    found = np.empty((len(frequencies), cases, len(linear.driven), ports), dtype=np.complex128)
    unit = np.eye(ports)
    for answer, omega in zip(found, frequencies, strict=True):
        for k, (G, X) in enumerate(zip(*linear.at(omega), strict=True)):
            answer[:, k] = np.linalg.solve(G * held[:, None] + unit, X[:, None])[..., 0]
    return found


def closed_at_rest(system: System) -> npt.NDArray[np.bool_]:
    """Whether the contact of each port (port,) is closed at rest."""
    return np.repeat([load > 0.0 for load in system.loads_at_rest], system.layout.directions)


def _unknowns(system: System, ports: ComplexArray) -> FloatArray:
    x, layout = np.zeros(system.layout.unknowns), system.layout
    x[layout.mean_at] = system.rest
    for harmonic, answer in zip(system.linear.driven, ports, strict=True):
        driven = layout.waves_at[system.harmonics.index(harmonic)]
        x[driven], x[driven + 1] = answer.real, answer.imag
    return x


def highest_linear_limit(system: System, omega: float) -> float:
    """A level beyond those at which a contact opens, closes or slips, if all are stuck or all open."""
    loads = np.abs(system.loads_at_rest)
    variation, slip = _motions(system, _on_ports(system, omega)[1:], np.max)
    friction = 2.0 * np.array([one.mu for one in system.scene.contacts]) * loads
    levels = (1.0, *_ratios(loads, variation), *_ratios(friction, slip.sum(axis=-1)))
    return min(LINEAR_LIMITS.level_factor * float(max(levels)), LINEAR_LIMITS.max_level)


def lowest_linear_limit(system: System, omega: float) -> float:
    """The least level at which a contact leaves its state at rest.

    It is 0 with static loads, friction of [start], or contact laws of its own.
    """
    if system.scene.strained or system.own_laws:
        return 0.0
    return float(lowest_linear_limits(system, [omega])[0])


def lowest_linear_limits(system: System, frequencies: Sequence[float]) -> FloatArray:
    """Least levels (frequency,) at which a contact leaves its state at rest; no static loads or own laws."""
    contacts = system.scene.contacts
    ports = np.array([_on_ports(system, omega)[0] for omega in frequencies])
    n_0, mu = (np.array([getattr(one, name) for one in contacts], dtype=np.float64) for name in ("n_0", "mu"))
    levels = np.full(len(frequencies), LINEAR_LIMITS.max_level)
    if not contacts:
        return levels
    variation, slip = _motions(system, ports, np.sum)
    friction = np.where((n_0 > 0.0) & (mu > 0.0), mu * n_0, np.inf)
    for limit, motion in ((np.abs(n_0), variation), (friction, slip.max(axis=-1))):
        at = np.divide(limit, motion, out=np.full_like(motion, np.inf), where=motion > 0.0)
        levels = np.minimum(levels, at.min(axis=-1))
    return np.zeros_like(levels) if (n_0 == 0.0).any() else levels  # without a preload no level is low enough


def _ratios(limit: FloatArray, motion: FloatArray) -> FloatArray:
    """Levels at which motions (case, contact) reach limits (contact,)."""
    moves = motion > 0.0
    levels: FloatArray = np.broadcast_to(limit, motion.shape)[moves] / motion[moves]
    return levels


def _motions(
    system: System, ports: ComplexArray, together: Callable[..., FloatArray]
) -> tuple[FloatArray, FloatArray]:
    """Variation of each contact's load (..., contact), and of its two limits (..., contact, 2).

    ports is (..., driven, port). In a plane the limits are those in the direction in which they are greater.

    `together` combines the driven harmonics. Their sum is never less than the motion's amplitude; the
    greatest of them is no more than 4 / pi times it.
    """
    contacts, directions = system.scene.contacts, system.layout.directions
    mu, k_u, k_v = (np.array([getattr(one, name) for one in contacts]) for name in ("mu", "k_u", "k_v"))
    each = ports.reshape(*ports.shape[:-1], len(contacts), directions)
    along, across = k_u[:, None] * each[..., :-1], (mu * k_v * each[..., -1])[..., None]
    limits = together(np.abs(np.stack((along - across, along + across), axis=-1)), axis=-4)
    if directions > 2:
        greater = limits.sum(axis=-1).argmax(axis=-1)[..., None, None]
        limits = np.take_along_axis(limits, greater, axis=-2)
    return together(k_v * np.abs(each[..., -1]), axis=-2), limits[..., 0, :]
