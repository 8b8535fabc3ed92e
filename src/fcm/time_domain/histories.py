"""Simulate the schedule of a scene for each of its curves."""

from __future__ import annotations

import time
from collections.abc import Sequence
from dataclasses import replace
from typing import Any, Protocol

import numpy as np

from fcm.at_rest import at_rest
from fcm.frozen import Frozen
from fcm.model.scene import Scene
from fcm.time_domain.errors import SimulationError
from fcm.time_domain.options import TIME, TimeOptions
from fcm.time_domain.schedule_plan import Plan
from fcm.time_domain.schedule_record import CompletedPhase, ScheduleRecord, record, unfinished
from fcm.time_domain.simulation import Progress


class Histories(Frozen):
    """The schedule of a scene simulated for each of its curves."""

    scene: Scene
    plan: Plan
    records: list[ScheduleRecord]  # one for each curve
    seconds: float

    @property
    def complete(self) -> bool:
        """Whether every curve was simulated to the end of the schedule."""
        return all(one.complete for one in self.records)


class SavedRecords(Protocol):
    """Protocol of the saved results of a run, by the number of the curve (`fcm.run.Results`)."""

    finished: dict[int, list[Any]]  # one `ScheduleRecord`
    states: dict[int, list[Any]]  # `CompletedPhase`, of the first phases

    def add(self, number: int, results: list[Any], /) -> None:
        """Saves the results of a finished curve."""

    def save(self, number: int, state: Any, /) -> None:
        """Saves the state at the end of a finished phase of a curve."""


def histories(
    scene: Scene,
    progress: Progress | None = None,
    kept: SavedRecords | None = None,
    options: TimeOptions = TIME,
) -> Histories:
    """Simulate the schedule of a scene, for each combination of its swept values.

    Parameters
    ----------
    scene : Scene
        From `fcm.load_scene`, with a schedule.
    progress : optional
        Called after each cycle with the finished fraction and a text.
    kept : optional
        Saved results of an interrupted run; new results are saved to it.

    Raises
    ------
    SimulationError
        If the scene has no schedule.
    KeyboardInterrupt
        If it is interrupted before its first cycle is finished; later, the finished part is returned.

    Examples
    --------
    >>> import fcm
    >>> found = histories(fcm.load_scene("yang1998-jump"))
    >>> [phase.states for phase in found.records[0].phases]
    [('SPEN',), ('E',), ('E',)]
    """
    if not scene.schedule:
        raise SimulationError("the scene has no [[schedule]]; give it one, or simulate one frequency")
    begin, curves, plan = time.perf_counter(), scene.each_curve(), _plan(scene, options)
    records: list[ScheduleRecord] = []
    for number, curve in enumerate(curves):
        made = _record(number, curve, plan, _share(progress, number, len(curves)), kept, options)
        records.append(made)
        if made.interrupted:
            break
    if not any(one.cycles for one in records) and records[-1].interrupted:
        raise KeyboardInterrupt
    records += [unfinished(curve, plan) for curve in curves[len(records) :]]
    return Histories(scene, plan, list(map(_without_rounding, records)), time.perf_counter() - begin)


def _without_rounding(record: ScheduleRecord) -> ScheduleRecord:
    """The record with amplitudes of 0 for degrees of freedom that move only by rounding."""
    if not record.phases:
        return record
    rest = at_rest(np.fmax.reduce([phase.amplitude for phase in record.phases]))
    phases = [replace(one, amplitude=np.where(rest, 0.0, one.amplitude)) for one in record.phases]
    amplitude = np.where(rest & np.isfinite(record.amplitude), 0.0, record.amplitude)
    return replace(record, phases=phases, amplitude=amplitude)


def _record(
    number: int,
    curve: Scene,
    plan: Plan,
    progress: Progress | None,
    kept: SavedRecords | None,
    options: TimeOptions = TIME,
) -> ScheduleRecord:
    """The record of a curve, continued from its saved phases."""
    if kept is None:
        return record(curve, plan, progress, options=options)
    if number in kept.finished:
        whole: ScheduleRecord = kept.finished[number][0]
        return whole
    passed: Sequence[CompletedPhase] = kept.states.get(number, ())
    made = record(curve, plan, progress, passed, lambda one: kept.save(number, one), options)
    if not made.interrupted:
        kept.add(number, [made])
    return made


def _share(progress: Progress | None, number: int, count: int) -> Progress | None:
    """Progress callback of one curve among several."""
    if progress is None or count == 1:
        return progress
    return lambda part, text: progress((number + part) / count, f"curve {number + 1}, {text}")


def not_begun(scene: Scene) -> Histories:
    """Empty histories of a calculation that was interrupted before the schedule was simulated."""
    plan = _plan(scene)
    return Histories(scene, plan, [unfinished(curve, plan) for curve in scene.each_curve()], 0.0)


def _plan(scene: Scene, options: TimeOptions = TIME) -> Plan:
    return Plan(scene.schedule, len(scene.modal.dofs) * len(scene.each_curve()), options)
