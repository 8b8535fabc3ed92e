"""Simulation of the schedule of a scene; finished parts are kept."""

from __future__ import annotations

from typing import Any

from fcm.model.scene import Scene
from fcm.response.curve_batches import anonymous
from fcm.run import CheckpointFile, Progress, fingerprint
from fcm.time_domain import Energy, Histories, State, histories
from fcm.time_domain.schedule_record import CompletedPhase, PhaseResult, ScheduleRecord

_KINDS = (ScheduleRecord, PhaseResult, CompletedPhase, State, Energy)  # classes of saved data


def simulated(
    scene: Scene, progress: Progress | None = None, keep: CheckpointFile | None = None
) -> Histories:
    """Simulate the motion through the schedule for each curve of a scene.

    The checkpoint keeps finished curves, and the finished phases of the present one; these are not simulated
    again.

    Raises
    ------
    SimulationError
        If the scene has no schedule.
    KeyboardInterrupt
        If it is interrupted before its first cycle is finished; later, the finished part is returned.
    """
    if keep is None:
        return histories(scene, progress)
    curves, phases = scene.each_curve(), len(scene.schedule)
    mark = fingerprint("schedule", anonymous(curves))
    kept = keep.results(mark, _KINDS, lambda number, found: _fit(curves, number, found))
    kept.states = {number: found for number, found in kept.states.items() if _begun(found, phases)}
    return histories(scene, progress, kept)


def _fit(curves: tuple[Scene, ...], number: int, found: Any) -> bool:
    """Whether an object read from a file can be the record of the curve with this number."""
    if not 0 <= number < len(curves) or not isinstance(found, list) or len(found) != 1:
        return False
    return isinstance(found[0], ScheduleRecord) and found[0].parameters == curves[number].parameters


def _begun(found: list[Any], phases: int) -> bool:
    """Whether an object read from a file can be the first phases of a curve."""
    return len(found) < phases and all(isinstance(one, CompletedPhase) for one in found)
