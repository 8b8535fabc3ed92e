"""The schedule of a scene for each of its curves."""

from __future__ import annotations

import time
from dataclasses import dataclass

from fcm.motion.errors import SimulationError
from fcm.motion.plan import Plan
from fcm.motion.record import INTERRUPTED, Record, record, unfinished
from fcm.motion.run import Progress
from fcm.scene.model import Scene


@dataclass(frozen=True)
class Histories:
    """A schedule simulated for each curve of a scene."""

    scene: Scene
    plan: Plan
    records: list[Record]  # one for each curve
    seconds: float

    @property
    def complete(self) -> bool:
        """Whether every curve was simulated to the end of the schedule."""
        return all(one.complete for one in self.records)


def histories(scene: Scene, progress: Progress | None = None) -> Histories:
    """Simulate the schedule of a scene, for each combination of its swept values.

    Parameters
    ----------
    scene : Scene
        From `fcm.load_scene`, with a schedule.
    progress : optional
        Called now and then with the finished fraction and a text.

    Raises
    ------
    SimulationError
        If the scene has no schedule.
    KeyboardInterrupt
        If it is interrupted before its first cycle is finished; later, what is finished is returned.

    Examples
    --------
    >>> import fcm
    >>> found = histories(fcm.load_scene("yang1998-jump"))
    >>> [phase.states for phase in found.records[0].phases]
    [('SPEN',), ('E',), ('E',)]
    """
    if not scene.schedule:
        raise SimulationError("the scene has no [[schedule]]; give it one, or simulate one frequency")
    begin, curves, plan = time.perf_counter(), scene.each_curve(), _plan(scene)
    records: list[Record] = []
    for number, curve in enumerate(curves):
        made = record(curve, plan, _share(progress, number, len(curves)))
        records.append(made)
        if made.reason == INTERRUPTED:
            break
    if not any(one.cycles for one in records) and records[-1].reason == INTERRUPTED:
        raise KeyboardInterrupt
    records += [unfinished(curve, plan) for curve in curves[len(records) :]]
    return Histories(scene, plan, records, time.perf_counter() - begin)


def _share(progress: Progress | None, number: int, count: int) -> Progress | None:
    """The progress of one curve among several."""
    if progress is None or count == 1:
        return progress
    return lambda part, text: progress((number + part) / count, f"curve {number + 1}, {text}")


def not_begun(scene: Scene) -> Histories:
    """The histories of a calculation that was interrupted before their turn."""
    plan = _plan(scene)
    return Histories(scene, plan, [unfinished(curve, plan) for curve in scene.each_curve()], 0.0)


def _plan(scene: Scene) -> Plan:
    return Plan(scene.schedule, len(scene.modal.dofs) * len(scene.each_curve()))
