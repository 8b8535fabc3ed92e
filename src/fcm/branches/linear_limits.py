"""Responses with linear contacts, all as at rest, stuck or open, and the levels of the forces that they tell.

Up to the least level the contacts do nothing but what they do at rest; beyond the highest none begins to
slip, opens or closes.
"""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterable, Iterator, Sequence

import numpy as np
import numpy.typing as npt

from fcm.branches.options import LINEAR_LIMITS
from fcm.harmonic_balance.system import System
from fcm.model.scene import Contact, FloatArray
from fcm.structure.linear import Linear

ComplexArray = npt.NDArray[np.complex128]


class _ResponseCache(threading.local):
    """The linear responses that each thread found last, by what they are of."""

    def __init__(self) -> None:
        self.by_key: dict[tuple[object, ...], ComplexArray] = {}


_RESPONSES = _ResponseCache()


def linear_responses(system: System, omega: float, level: float) -> Iterator[FloatArray]:
    """Unknowns about rest with the contacts as they are there, then all stuck, then all open."""
    for ports in _on_ports(system, omega):
        yield _unknowns(system, level * ports)


def _on_ports(system: System, omega: float) -> ComplexArray:
    """Of the ports, (3, driven, port), with the contacts as in `linear_responses`; kept in the system."""
    if omega not in system.port_responses:
        precompute(system, (omega,))
    return system.port_responses[omega]


def precompute(system: System, frequencies: Sequence[float]) -> None:
    """Find the linear responses at all frequencies at which solutions will be asked for, at once.

    Those of the last systems are still known: of a sweep most are the same.
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
    """Of the ports with springs held (case, port): (frequency, case, driven, port)."""
    cases, ports = held.shape
    linear = system.linear
    if type(linear) is Linear and linear.natural.size < ports:
        return np.moveaxis(linear.answers_with(held, np.array(frequencies, dtype=np.float64)), 0, 1)
    found = np.empty((len(frequencies), cases, len(linear.driven), ports), dtype=np.complex128)
    for answer, omega in zip(found, frequencies, strict=True):
        for k, (G, X) in enumerate(zip(*linear.at(omega), strict=True)):
            for one, springs in zip(answer[:, k], held, strict=True):  # many contacts: large ones
                matrix = G * springs
                matrix.flat[:: X.size + 1] += 1.0
                one[:] = np.linalg.solve(matrix, X)
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
    """A level beyond those at which a contact opens, closes or slips, all being stuck or open."""
    levels, loads = [1.0], [abs(load) for load in system.loads_at_rest]
    for ports in _on_ports(system, omega)[1:]:
        for load, (variation, slip, contact) in zip(loads, _motions(system, ports, max), strict=True):
            levels += [load / variation] if variation > 0.0 else []
            levels += [2.0 * contact.mu * load / sum(slip)] if sum(slip) > 0.0 else []
    return min(LINEAR_LIMITS.level_factor * max(levels), LINEAR_LIMITS.max_level)


def lowest_linear_limit(system: System, omega: float) -> float:
    """The least level at which a contact is not as it is at rest; 0 where static loads, or laws of one's own,
    have a say in that."""
    if system.scene.loads or system.own_laws:
        return 0.0
    levels = [LINEAR_LIMITS.max_level]
    for variation, slip, contact in _motions(system, _on_ports(system, omega)[0], sum):
        levels += [abs(contact.n_0) / variation] if variation > 0.0 else []
        closed = contact.n_0 > 0.0 and contact.mu > 0.0 and max(slip) > 0.0
        levels += [contact.mu * contact.n_0 / max(slip)] if closed else [0.0] if contact.n_0 == 0.0 else []
    return min(levels)


def _motions(
    system: System, ports: ComplexArray, together: Callable[[Iterable[float]], float]
) -> Iterator[tuple[float, tuple[float, float], Contact]]:
    """Of each contact the variation of its load, and the sizes of the motions of its two limits.

    Those of the driven harmonics together: their sum is never less than that of the motion, and the greatest
    of them no more than 4 / pi times it.
    """
    directions = system.layout.directions
    every = ports.reshape(len(ports), -1, directions).swapaxes(0, 1).tolist()
    for contact, each in zip(system.scene.contacts, every, strict=True):
        across = [contact.mu * contact.k_v * V for *_, V in each]
        pairs = [
            (
                together([abs(contact.k_u * U[d] - a) for U, a in zip(each, across, strict=True)]),
                together([abs(contact.k_u * U[d] + a) for U, a in zip(each, across, strict=True)]),
            )
            for d in range(directions - 1)
        ]
        yield together([contact.k_v * abs(V) for *_, V in each]), max(pairs, key=sum), contact
