"""The time simulation of a scene: the phases of its schedule and the state that they start from."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from fcm.model.scene import Contact, FloatArray, Phase, Scene, Start
from fcm.scene.keys import names
from fcm.scene.options import LIMITS, MESSAGES
from fcm.scene.rules import ANY, POSITIVE, RULES
from fcm.scene.section import Section
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
    """Lowest and highest frequency of the forces, from the range that is traced and the phases.

    >>> with_schedule((np.nan, np.nan), (Phase(3.0, 10.0), Phase(2.0, 10.0)))
    (2.0, 3.0)
    """
    every = np.array([*ends, *(phase.frequency for phase in schedule)])
    if np.isnan(every).all():
        return ends
    return float(np.nanmin(every)), float(np.nanmax(every))


def _whole(cycles: float) -> float:
    """The cycles, without a rounding error beside a whole number of them.

    >>> _whole(0.1 * 30), _whole(2.5)
    (3.0, 2.5)
    """
    nearest = float(np.rint(cycles))
    return nearest if nearest and abs(cycles - nearest) <= 1e-12 * nearest else cycles


def read_start(top: Section, parts: Mapping[str, Any]) -> Start | None:
    """The state that the schedule starts from; None, which is rest, without a [start] table.

    Its friction alone also says which motion is meant where a contact never slips, of which there are many.
    """
    section = top.table("start", "") if "start" in top.data else None
    if section is None:
        return None
    section.only(*names("start"))
    if not top.data.get("schedule"):
        _without_schedule(section)
    frequency = parts["modal"]["frequency"]
    modes = None if frequency is None else len(frequency)
    return Start(
        _vector(section, "displacement", modes, "mode"),
        _vector(section, "velocity", modes, "mode"),
        _vector(section, "friction", len(parts["contact"]), "contact"),
        section.number("angle", RULES["phase"], default=0.0),
    )


def _without_schedule(section: Section) -> None:
    unused = [key for key in section.data if key != "friction"]
    for key in unused if "friction" in section.data else [""]:
        section.wrong(key, "is of no use without a [[schedule]], which starts from it")


def _vector(section: Section, key: str, count: int | None, each: str) -> FloatArray:
    """Reads one number for each mode or contact, zeros by default."""
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
    """The contacts with their limits in those curves."""
    found = dict[int, list[tuple[Scene, float]]]()
    for curve in scene.each_curve():
        start = curve.start
        for place, contact in enumerate(curve.contacts if start is not None and start.friction.any() else ()):
            assert start is not None
            limit = _limit(curve, contact, start)
            if abs(start.friction[place]) > limit * (1.0 + MESSAGES.start_rounding):
                found.setdefault(place, []).append((curve, limit))
    return found


def _limit(scene: Scene, contact: Contact, start: Start) -> float:
    """The greatest friction force of a contact where the scene starts."""
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
    return (
        f"start.friction[{place}]: {first.start.friction[place]:g} is beyond what {contact.name} can carry "
        f"there,{where} mu n = {limit:g}. {begins}Exact curves take that residual friction where the motion "
        "itself holds it, else the nearest"
    )
