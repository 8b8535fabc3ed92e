"""Reads the time simulation of a scene: the phases of its schedule and its initial state.

On curves, the friction of that state also applies to contacts that never slip.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from fcm.model.scene import Contact, FloatArray, Phase, Scene, Start
from fcm.scene.errors import quoted
from fcm.scene.keys import names
from fcm.scene.options import LIMITS, MESSAGES
from fcm.scene.rules import ANY, POSITIVE, RULES
from fcm.scene.section import Section, described
from fcm.units import UNIT


def read_schedule(top: Section, unit: str) -> tuple[Phase, ...]:
    """The phases of a time simulation."""
    phases = []
    for section in top.tables("schedule"):
        section.only(*names("schedule"))
        frequency = section.number("frequency", POSITIVE) * UNIT[unit]
        phases.append(Phase(frequency, _whole(section.number("cycles", POSITIVE))))
    total = sum(phase.cycles for phase in phases)
    if total > LIMITS.cycles:
        top.wrong("schedule", f"asks for {total:g} cycles; there can be {LIMITS.cycles}")
    return tuple(phases)


def with_schedule(ends: tuple[float, float], schedule: tuple[Phase, ...]) -> tuple[float, float]:
    """Lowest and highest frequency of the forces, from the traced range and the phases.

    >>> with_schedule((np.nan, np.nan), (Phase(3.0, 10.0), Phase(2.0, 10.0)))
    (2.0, 3.0)
    """
    every = np.array([*ends, *(phase.frequency for phase in schedule)])
    if np.isnan(every).all():
        return ends
    return float(np.nanmin(every)), float(np.nanmax(every))


def _whole(cycles: float) -> float:
    """The number of cycles, rounded to a whole number if it differs from one by rounding only.

    >>> _whole(0.1 * 30), _whole(2.5)
    (3.0, 2.5)
    """
    nearest = float(np.rint(cycles))
    return nearest if nearest and abs(cycles - nearest) <= 1e-12 * nearest else cycles


def read_start(top: Section, parts: Mapping[str, Any]) -> Start | None:
    """The initial state of the schedule; None, which means rest, without a [start] table.

    If a contact never slips, many motions are possible; the friction of the state then selects one.
    """
    section = top.table("start", "") if "start" in top.data else None
    if section is None:
        return None
    section.only(*names("start"))
    if not top.data.get("schedule"):
        _without_schedule(section)
    frequency = parts["modal"]["frequency"]
    modes = None if frequency is None else len(frequency)
    displacement, velocity = (_vector(section, key, modes, "mode") for key in ("displacement", "velocity"))
    angle = section.number("angle", RULES["phase"], default=0.0)
    first, second = _friction(section, parts["contact"]).T
    in_plane = any("second" in one for one in parts["contact"])
    return Start(displacement, velocity, first, angle, second if in_plane else None)


def _friction(section: Section, contacts: Sequence[Mapping[str, Any]]) -> FloatArray:
    """Friction forces (contact, 2), from a number for each contact on a line, a pair for each planar one."""
    found = np.zeros((len(contacts), 2))
    found.flags.writeable = False
    if "friction" not in section.data:
        return found
    given = section.data["friction"]
    given = given.tolist() if isinstance(given, np.ndarray) else given
    pairs = ", or a pair if it slides in a plane" if any("second" in one for one in contacts) else ""
    if not isinstance(given, list | tuple):
        section.wrong(
            "friction", f"must be a list with one number for each contact{pairs}, is {described(given)}"
        )
    elif len(given) != len(contacts):
        right = f"must have one number for each contact{pairs}, {len(contacts)} in all"
        section.wrong("friction", f"{right}, has {len(given)}")
    else:
        each = zip(given, contacts, strict=True)
        found = np.array([_of_contact(section, i, one, contact) for i, (one, contact) in enumerate(each)])
        found = found.reshape(-1, 2)
    return found


def _of_contact(section: Section, i: int, given: object, contact: Mapping[str, Any]) -> tuple[float, float]:
    """The friction force of a contact along its one or two directions; 0 after a mistake."""
    path, several, name = f"friction[{i}]", isinstance(given, list | tuple), quoted(contact["name"])
    if "second" not in contact:
        if not several:
            return section.checked(given, section.at(path), ANY), 0.0
        section.wrong(path, f"must be one number, is {described(given)}: contact {name} slides on a line")
    elif isinstance(given, list | tuple) and len(given) == 2:
        x, y = (section.checked(one, section.at(f"{path}[{k}]"), ANY) for k, one in enumerate(given))
        return x, y
    else:
        what = f"must be a pair of numbers, as [0.1, 0.0], is {described(given)}"
        section.wrong(path, f"{what}: contact {name} slides in a plane")
    return 0.0, 0.0


def _without_schedule(section: Section) -> None:
    unused = [key for key in section.data if key != "friction"]
    for key in unused if "friction" in section.data else [""]:
        section.wrong(key, "is of no use without a [[schedule]], which starts from it")


def _vector(section: Section, key: str, count: int | None, each: str) -> FloatArray:
    """Reads a list with one number for each mode, zeros by default."""
    zeros = np.zeros(count or 0)
    given = section.vector(key, ANY) if key in section.data else zeros
    if given is not None and count is not None and len(given) != count:
        section.wrong(key, f"must have one number for each {each}, {count} in all, has {len(given)}")
    values = zeros if given is None else given
    values.flags.writeable = False
    return values


def note_of_start(scene: Scene) -> list[str]:
    """Notes on contacts whose friction in [start] exceeds their limit there, in any curve."""
    return [_sentence(scene, place, beyond) for place, beyond in _beyond(scene).items()]


def _beyond(scene: Scene) -> dict[int, list[tuple[Scene, float]]]:
    """By place of such a contact, the curves in which its friction exceeds its limit, with these limits."""
    found = dict[int, list[tuple[Scene, float]]]()
    for curve in scene.each_curve():
        start = curve.start
        if start is None:
            continue
        for place in np.flatnonzero(start.friction_size).tolist():
            limit = _limit(curve, curve.contacts[place], start)
            if start.friction_size[place] > limit * (1.0 + MESSAGES.start_rounding):
                found.setdefault(place, []).append((curve, limit))
    return found


def _limit(scene: Scene, contact: Contact, start: Start) -> float:
    """The greatest friction force of a contact in the initial state."""
    if contact.k_u == 0.0:
        return 0.0
    displacement = scene.modal.shapes.T @ start.displacement
    return contact.mu * max(contact.n_0 + contact.k_v * float(contact.normal @ displacement), 0.0)


def _sentence(scene: Scene, place: int, beyond: list[tuple[Scene, float]]) -> str:
    first, limit = beyond[0]
    assert first.start is not None
    swept = ", ".join(f"{key} = {value:g}" for key, value in first.parameters.items())
    count = f"{len(beyond)} of {len(scene.each_curve())}"
    where = f" in {count} curves, the first with {swept}," if swept else ""
    begins = "A [[schedule]] starts from the limit. " if scene.schedule else ""
    contact = first.contacts[place]
    ways = zip(contact.directions[:-1], first.start.forces, strict=False)
    given = ", ".join(f"{force[place]:g}" for _, force in ways)
    given = given if contact.second is None else f"[{given}]"
    return (
        f"start.friction[{place}]: {given} is beyond what {contact.name} can carry there,{where} "
        f"mu n = {limit:g}. {begins}Curves take that residual friction where the motion itself holds it, "
        "else the nearest"
    )
