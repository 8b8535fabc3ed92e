"""The energy balance of a motion: what the forces did, where it went."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple
from weakref import WeakKeyDictionary

import numpy as np

from fcm.scene.model import Contact, FloatArray
from fcm.simulate.cycle import NODES, WEIGHTS
from fcm.simulate.flow import ORDER, Flow
from fcm.simulate.march import Segment
from fcm.simulate.motion import Motion
from fcm.simulate.system import NEGATIVE, POSITIVE, System

MOST_STEPS = 1024  # at once
_AT_NODES: WeakKeyDictionary[Flow, FloatArray] = WeakKeyDictionary()


class Energy(NamedTuple):
    """Work over the motion: `work` = `slip` + `damping` + `stored`, but for rounding."""

    work: float  # of the external forces
    slip: float  # dissipated by friction, integral of f dw
    damping: float  # dissipated by the modes
    stored: float  # change of the kinetic and elastic energy, contacts included
    turnover: float  # sum of the magnitudes of all powers over time, to which the error is relative

    @property
    def error(self) -> float:
        """What is missing, relative to the turnover."""
        missing = abs(self.work - self.slip - self.damping - self.stored)
        return missing / self.turnover if self.turnover > 0.0 else missing


def energy(motion: Motion) -> Energy:
    """The energy balance over a motion, by Gauss quadrature that is exact to rounding.

    Examples
    --------
    >>> import fcm
    >>> from fcm.simulate import simulate
    >>> balance = energy(simulate(fcm.load_scene("yang1998-n5"), 1.3, 10))
    >>> balance.slip > 0 and balance.error < 1e-12
    True
    """
    work = slip = damping = turnover = 0.0
    for cycle in motion.cycles:
        for segment in cycle.segments:
            parts = _segment(cycle.system, segment)
            work, slip, damping = work + parts[0], slip + parts[1], damping + parts[2]
            turnover += parts[3]
    first, last = motion.cycles[0], motion.cycles[-1]
    start, end = first.segments[0], last.segments[-1]
    stored = _stored(last.system, _end(end)) - _stored(first.system, start.y)
    return Energy(work, slip, damping, stored, turnover + abs(stored))


def _end(segment: Segment) -> FloatArray:
    return segment.flow.at(segment.y, segment.length)


def _segment(system: System, segment: Segment) -> tuple[float, float, float, float]:
    """Work, slip, damping and turnover of a segment."""
    modal = system.scene.modal
    damper = 2.0 * modal.mass * modal.damping * modal.frequency
    total = np.zeros(4)
    for y, weights in _states(segment):
        p = y[:, system.p]
        power = (p @ system.sine) * y[:, -3] + (p @ system.cosine) * y[:, -2]
        modal_loss = (p * p) @ damper
        slip = np.zeros(len(weights))
        for j, (contact, state) in enumerate(zip(system.contacts, segment.states, strict=True)):
            if state in (POSITIVE, NEGATIVE):
                slip += y[:, system.f][:, j] * _slip_velocity(system, contact, j, p, state)
        total += [weights @ x for x in (power, slip, modal_loss, np.abs(power) + slip + modal_loss)]
    return float(total[0]), float(total[1]), float(total[2]), float(total[3])


def _slip_velocity(system: System, contact: Contact, j: int, p: FloatArray, state: str) -> FloatArray:
    """w' of (6), (8)."""
    sign = 1.0 if state == POSITIVE else -1.0
    row = system.tangential[j] - sign * contact.mu * contact.k_v / contact.k_u * system.normal[j]
    velocity: FloatArray = p @ row
    return velocity


def _states(segment: Segment) -> Iterator[tuple[FloatArray, FloatArray]]:
    """State vectors at the quadrature's nodes, (node, d), and their weights [s]."""
    flow, y, whole = segment.flow, segment.y, int(segment.length)
    part = segment.length - whole
    while whole:
        steps = min(whole, MOST_STEPS)
        grid = flow.grid(y, steps)
        yield (
            np.concatenate([grid @ matrix.T for matrix in _at_nodes(flow)]),
            np.repeat(WEIGHTS * flow.step, steps),
        )
        y, whole = flow.advance(y, steps), whole - steps
    inside = (part * NODES[:, None]) ** np.arange(ORDER + 1.0)
    yield inside @ (flow.series @ y), WEIGHTS * part * flow.step


def _at_nodes(flow: Flow) -> FloatArray:
    """exp(A h x) at the quadrature's nodes x, (node, d, d): the same for every cycle."""
    if flow not in _AT_NODES:
        _AT_NODES[flow] = np.array([flow.matrix_within(x) for x in NODES])
    return _AT_NODES[flow]


def _stored(system: System, y: FloatArray) -> float:
    """Kinetic and elastic energy, with the preload's potential; the springs' own slips do not count."""
    modal = system.scene.modal
    q, p = y[system.q], y[system.p]
    total = 0.5 * float(modal.mass @ (p * p + (modal.frequency * q) ** 2))
    for j, (contact, f, n) in enumerate(zip(system.contacts, y[system.f], system.loads(y), strict=True)):
        total += 0.5 * f * f / contact.k_u if contact.k_u > 0.0 else 0.0
        total += _normal_energy(contact, float(system.normal[j] @ q), float(n))
    return float(total)


def _normal_energy(contact: Contact, v: float, n: float) -> float:
    """Potential of max(n, 0) - max(n_0, 0) over v, 0 at v = 0."""
    if contact.k_v == 0.0:
        return 0.0
    if contact.n_0 <= 0.0:
        return 0.5 * max(n, 0.0) ** 2 / contact.k_v
    if n >= 0.0:
        return 0.5 * contact.k_v * v * v
    return -contact.n_0 * (0.5 * contact.n_0 / contact.k_v + v)
