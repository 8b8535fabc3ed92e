"""The friction force of a contact that sticks all through the period.

Its slip motion w can have any value between the greatest lower and the least upper slip limit, and the
solution is one of a family. A contact that starts unstressed, w = 0, ends with the w nearest to 0: that
one is chosen, so that the solutions over the frequency are one curve.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from fcm.scene.model import FloatArray
from fcm.simulate.cycle import taylor
from fcm.simulate.floquet import derivative_at
from fcm.simulate.march import Segment
from fcm.simulate.measure import extreme
from fcm.simulate.system import NEGATIVE, OPEN, POSITIVE, STICK, System, has_friction

MARGIN = 1e-9  # distance from the slip limit, relative to the forces


class Choice(NamedTuple):
    """How far a stuck contact's friction force is from the one that is chosen."""

    contact: int
    gap: float  # to be added to the force
    row: FloatArray  # (2 modes + contacts,) derivative of the gap by x = (q, q', f)
    limited: bool  # whether it is a limit of slip, and not w = 0


def choices(system: System, segments: list[Segment]) -> list[Choice]:
    """The choices for all contacts that stick all through the segments."""
    return [
        _choice(system, segments, j)
        for j, contact in enumerate(system.contacts)
        if has_friction(contact) and all(segment.states[j] == STICK for segment in segments)
    ]


def _choice(system: System, segments: list[Segment], j: int) -> Choice:
    """The force for w = 0, or the nearest to it that keeps |f| <= mu n for all of the period.

    It keeps a little away from the limit, so that rounding does not decide between stick and slip.
    """
    contact, y, force = system.contacts[j], segments[0].y, system.f.start + j
    margin = _margin(system, y, j)
    row = np.zeros(system.size)
    row[system.q], row[force] = contact.k_u * system.tangential[j], -1.0
    wanted = float(row @ y)
    if wanted == 0.0:
        return Choice(j, 0.0, row[: system.n.start], False)
    sign = 1.0 if wanted > 0.0 else -1.0
    room, there = _room(system, segments, j, sign)
    if abs(wanted) <= room - margin:
        return Choice(j, wanted, row[: system.n.start], False)
    other, elsewhere = _room(system, segments, j, -sign)
    if room + other > 2.0 * margin:
        return Choice(j, sign * (room - margin), sign * there, True)
    return Choice(j, 0.5 * sign * (room - other), 0.5 * sign * (there - elsewhere), True)


def _margin(system: System, y: FloatArray, j: int) -> float:
    contact = system.contacts[j]
    limit = contact.mu * (abs(contact.n_0) + abs(y[system.n.start + j]))
    return MARGIN * float(abs(y[system.f.start + j]) + limit)


def overshoots(system: System, segments: list[Segment]) -> list[tuple[int, float]]:
    """Contacts that slip in one direction only, with what their gap lacks to continue that of a `Choice`.

    None of these is periodic: the slip takes the force to its limit, where the contact sticks.
    """
    found = []
    for j, contact in enumerate(system.contacts):
        letters = {segment.states[j] for segment in segments}
        if has_friction(contact) and OPEN not in letters and len(letters & {POSITIVE, NEGATIVE}) == 1:
            found.append((j, (1.0 if POSITIVE in letters else -1.0) * _margin(system, segments[0].y, j)))
    return found


def _room(system: System, segments: list[Segment], j: int, sign: float) -> tuple[float, FloatArray]:
    """The least of mu n - sign f over the segments, and its derivative by x."""
    contact = system.contacts[j]
    limit = np.zeros(system.size)
    limit[system.f.start + j], limit[system.n.start + j] = -sign, contact.mu
    limit[-1] = contact.mu * contact.n_0
    room, at, position = _least(segments, limit)
    return room, limit @ derivative_at(system, segments, at, position)


def _least(segments: list[Segment], row: FloatArray) -> tuple[float, int, float]:
    """The least value of row @ y over the segments, in which of them and where (in steps)."""
    best = (np.inf, 0, 0.0)
    for i, segment in enumerate(segments):
        steps = int(np.ceil(segment.length))
        if steps == 0:
            continue
        powers = -taylor(segment, row[None], segment.flow.grid(segment.y, steps))
        value, position = extreme(powers, np.minimum(segment.length - np.arange(steps), 1.0))
        if -value < best[0]:
            best = (-value, i, position)
    return best
