"""The friction force of a contact that sticks through the whole period.

Its slip motion w may have any value between the greatest lower and the least upper slip limit, so that the
solution is one of a family. A contact that starts with some w ends with the nearest admissible w. This member
is chosen, so that the solutions over the frequency form one curve. The contact starts unstressed, w = 0,
unless static loads have made it slip, or the scene's [start] says otherwise.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from fcm.model.scene import Contact, FloatArray, Scene
from fcm.shooting.options import SHOOTING, ResidualFrictionOptions
from fcm.shooting.period_derivative import derivative_at
from fcm.time_domain.cycle_measures import Extreme, extremes_by
from fcm.time_domain.equations_of_motion import EquationsOfMotion
from fcm.time_domain.flow import NEGATIVE_SLIP, POSITIVE_SLIP, SEPARATED, STICKING
from fcm.time_domain.segments import Segments
from fcm.time_domain.state import State

BOTH_SIGNS = 1 << POSITIVE_SLIP | 1 << NEGATIVE_SLIP  # states of a contact that slips in both directions


class Choice(NamedTuple):
    """The difference between the friction force of a stuck contact and the one that is chosen for it."""

    contact: int
    gap: float  # to be added to the force
    row: FloatArray  # (2 modes + contacts,) derivative of the gap by x = (q, q', f)
    rate: float  # derivative of the gap by the frequency
    limited: bool  # whether the choice is at a slip limit, and not at the wanted w


def resting(scene: Scene) -> FloatArray:
    """The slip motions w of the contacts where the scene starts: (contact,)."""
    start = State.start(scene)
    return _resting(scene.contacts, scene.modal.shapes.T @ start.q, start.friction)


def resting_at(system: EquationsOfMotion, x: FloatArray) -> FloatArray:
    """The slip motions w of the contacts at x = (q, q', f): (contact,)."""
    displacement = system.scene.modal.shapes.T @ x[system.q]
    return _resting(system.contacts, displacement, x[system.f])


def _resting(contacts: tuple[Contact, ...], displacement: FloatArray, friction: FloatArray) -> FloatArray:
    w = np.zeros(len(contacts))
    for j, contact in enumerate(contacts):
        if contact.k_u > 0.0:
            w[j] = contact.tangential @ displacement - friction[j] / contact.k_u
    return w


def always_stuck(system: EquationsOfMotion, segments: Segments) -> list[int]:
    """The contacts that stick in all segments."""
    return stuck_of(system, segments.seen())


def stuck_of(system: EquationsOfMotion, seen: list[int]) -> list[int]:
    """The contacts that always stick, from the states of each, see `Segments.seen`."""
    return [j for j, states in enumerate(seen) if states == 1 << STICKING and system.rough[j]]


def traction_choices(
    system: EquationsOfMotion,
    segments: Segments,
    wanted: FloatArray,
    stuck: list[int],
    options: ResidualFrictionOptions = SHOOTING.traction,
) -> list[Choice]:
    """Choices of the friction for the contacts stuck, which stick in all segments.

    wanted: the wanted w of all contacts, (contact,).
    """
    if not stuck:
        return []
    y = np.asarray(segments.y)[0]
    gaps = (system.sticking @ y[: system.unknowns] - system.k_u * wanted).tolist()
    margin = {j: _margin(system, y, j, options) for j in stuck}
    # the limits need no evaluation for a gap within a bound of them, or for a negligible one
    known = {j: max(options.rounding * margin[j], segments.held(j) - margin[j]) for j in stuck}
    far = [j for j in stuck if abs(gaps[j]) > known[j]]
    room = limit_distances(system, segments, far) if far else {}
    return [
        _choice(system, segments, (j, gaps[j], margin[j]), *room[j])
        if j in room
        else Choice(j, gaps[j], system.sticking[j], 0.0, False)
        for j in stuck
    ]


def _choice(
    system: EquationsOfMotion,
    segments: Segments,
    of: tuple[int, float, float],
    above: Extreme,
    below: Extreme,
) -> Choice:
    """Choice of the force for the wanted w, or for the nearest w with |f| <= mu n through the whole period.

    of: the contact, its gap to the wanted w, and its margin. The margin is kept from the limit, so that
    rounding does not decide between stick and slip. above and below are the least of mu n - f and of mu n +
    f.
    """
    j, gap, margin = of
    sign = 1.0 if gap > 0.0 else -1.0
    ahead, behind = (above, below) if gap > 0.0 else (below, above)
    room, other = ahead.value, behind.value
    if abs(gap) <= room - margin:
        return Choice(j, gap, system.sticking[j], 0.0, False)
    there, rate = _room_derivative(system, segments, j, sign, ahead)
    if room + other > 2.0 * margin:
        return Choice(j, sign * (room - margin), sign * there, sign * rate, True)
    elsewhere, other_rate = _room_derivative(system, segments, j, -sign, behind)
    return Choice(
        j, 0.5 * sign * (room - other), 0.5 * sign * (there - elsewhere),
        0.5 * sign * (rate - other_rate), True,
    )  # fmt: skip


def _margin(system: EquationsOfMotion, y: FloatArray, j: int, options: ResidualFrictionOptions) -> float:
    contact = system.contacts[j]
    limit = contact.mu * (abs(contact.n_0) + abs(y[system.n.start + j]))
    return options.margin * float(abs(y[system.f.start + j]) + limit)


def one_sided_slips(
    system: EquationsOfMotion,
    segments: Segments,
    seen: list[int],
    options: ResidualFrictionOptions = SHOOTING.traction,
) -> list[tuple[int, float]]:
    """Contacts that slip in one direction only, each with a correction of its closure.

    With it the closure is continuous with the gap of a `Choice`. No such motion is periodic: the slip moves
    the force to its limit, where the contact then sticks.
    """
    found = []
    for j, states in enumerate(seen):
        ways = states & BOTH_SIGNS
        if ways not in (0, BOTH_SIGNS) and not states & 1 << SEPARATED and system.rough[j]:
            sign = 1.0 if ways == 1 << POSITIVE_SLIP else -1.0
            found.append((j, sign * _margin(system, np.asarray(segments.y)[0], j, options)))
    return found


def limit_distances(
    system: EquationsOfMotion, segments: Segments, contacts: list[int]
) -> dict[int, tuple[Extreme, Extreme]]:
    """Least values of mu n - f and of mu n + f over the segments, by contact."""
    found, _ = extremes_by(system.limits, system, segments)
    return {j: (found[2 * j], found[2 * j + 1]) for j in contacts}


def _room_derivative(
    system: EquationsOfMotion, segments: Segments, j: int, sign: float, place: Extreme
) -> tuple[FloatArray, float]:
    """The derivatives of the least value of mu n - sign f by x and by the frequency."""
    columns = derivative_at(system, segments, place.segment, place.position).columns
    rates = columns[:-1, : system.linear] @ system.limit_rows[2 * j + (sign < 0.0)]
    return rates[:-1], float(rates[-1])
