"""Exact periodic solutions of every curve of a scene, as a response: traced, or visited by sweeps."""

from __future__ import annotations

import os
import time
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from fcm.response.groups import Finished, Group, Work, lost_curve, one_by_one
from fcm.response.kept import Kept, fingerprint
from fcm.response.path import Progress
from fcm.response.result import UNIT, Curve, Response
from fcm.response.sweep import INTERRUPTED
from fcm.response.trace import ResponseError
from fcm.scene.model import Scene
from fcm.simulate.branch import shown
from fcm.simulate.errors import SimulationError
from fcm.simulate.explore import Explorer
from fcm.simulate.orbit_curve import traced_curve, visited_curve
from fcm.simulate.visit import Visitor

METHOD = "exact"
STOPPED = "interrupted at "  # how the reason of a curve begins that an interruption has cut off


def trace_exact(
    scene: Scene,
    at: Sequence[float] | None = None,
    progress: Progress | None = None,
    *,
    jobs: int = 1,
    keep: Path | None = None,
    resume: bool = False,
) -> Response:
    """The curves of exact periodic solutions of a scene, in the layout of `fcm.response.trace`.

    Every point is a periodic solution of the exact motion, found by shooting: no harmonic is left out, no
    table is used. Its `amplitude` is half the peak-to-peak displacement, `phase` that of the fundamental,
    `regime` the states over the cycle, `stable` by its Floquet multipliers; `orbits` has the rest.

    Parameters
    ----------
    scene : Scene
        From `fcm.load_scene`; one curve for each combination of its swept values.
    at : sequence of float, optional
        Frequencies in the scene's unit. The steady motion is visited there by an upward and then by a
        downward sweep, each point continuing the last; without it the curve is followed through its range.
    progress : optional
        Called now and then with the finished fraction and a text.
    jobs, keep, resume
        As in `fcm.response.trace`.

    Raises
    ------
    ResponseError
        If a frequency cannot be visited.

    Examples
    --------
    >>> import fcm
    >>> response = trace_exact(fcm.load_scene("yang1998-n5"))
    >>> [round(fold, 6) for fold in response.curves[0].folds]
    [1.239829, 1.193559]
    """
    begin = time.perf_counter()
    work = ExactWork(METHOD, None, _checked(scene, at))
    curves = _Sweep(work, scene.each_curve(), progress, jobs or os.cpu_count() or 1).run(keep, resume)
    contacts = tuple(contact.name for contact in scene.each_curve()[0].contacts)
    response = Response(scene.title, scene.modal.dofs, contacts, curves, METHOD, scene.frequency_unit)
    response.seconds = time.perf_counter() - begin
    return response


def _checked(scene: Scene, at: Sequence[float] | None) -> tuple[float, ...] | None:
    """The frequencies to visit, upward [rad/s]."""
    if at is None and not scene.has_range:
        raise ResponseError("the scene has no [response] with frequency = [from, to], so no curve to trace")
    if at is None:
        return None
    frequencies = np.unique(np.asarray(at, dtype=np.float64).ravel())
    wrong = frequencies[~(np.isfinite(frequencies) & (frequencies > 0.0))]
    if frequencies.size == 0 or wrong.size:
        what = f"{wrong[0]:g} is none" if wrong.size else "none is given"
        raise ResponseError(f"frequencies to visit must be positive numbers; {what}")
    return tuple((frequencies * UNIT[scene.frequency_unit]).tolist())


@dataclass(frozen=True)
class ExactWork(Work):
    """How each curve is made: traced, or visited at frequencies."""

    at: tuple[float, ...] | None  # [rad/s]

    def traced(self, group: Group, progress: Progress | None) -> list[Curve]:
        return [self._curve(scene, progress) for scene in group]

    def _curve(self, scene: Scene, progress: Progress | None) -> Curve:
        begin = time.perf_counter()
        curve = _traced(scene, progress) if self.at is None else _visited(scene, self.at, progress)
        return replace(curve, seconds=time.perf_counter() - begin)


def _traced(scene: Scene, progress: Progress | None) -> Curve:
    explorer, stopped = Explorer(scene, progress), ""
    try:
        explorer.run()
    except KeyboardInterrupt:
        stopped = STOPPED + (shown(scene, explorer.at) if explorer.branches else "the start")
    curve = traced_curve(scene, explorer.branches, stopped or explorer.reason)
    if curve.orbits is not None:
        curve.orbits.periods = explorer.equations.periods
    return curve


def _visited(scene: Scene, at: tuple[float, ...], progress: Progress | None) -> Curve:
    visitor, reason = Visitor(replace(scene, frequency_range=(0.0, at[-1]))), ""
    try:
        visitor.run(at, progress)
    except KeyboardInterrupt:
        reason = STOPPED + (shown(scene, visitor.points[-1].frequency) if visitor.points else "the start")
    except SimulationError as error:
        reason = str(error)
    return visited_curve(scene, visitor, reason)


@dataclass
class _Sweep:
    """The curves of a scene, each on its own; what is finished survives an interruption."""

    work: ExactWork
    scenes: Sequence[Scene]
    progress: Progress | None
    jobs: int

    def run(self, keep: Path | None, resume: bool) -> list[Curve]:
        several = keep if len(self.scenes) > 1 else None
        mark = b""
        if several is not None:
            mark = fingerprint(tuple(self.scenes), METHOD, self.work.at, len(self.scenes))
        kept = Kept(several, mark, resume)
        left: dict[int, Group] = {
            i: (scene,) for i, scene in enumerate(self.scenes) if i not in kept.finished
        }
        done = {number: curves[0] for number, curves in kept.finished.items()}
        try:
            for number, curves in self._finished(left):
                done[number] = curves[0]
                if curves[0].reason.startswith(STOPPED):
                    break
                kept.add(number, curves)
        except KeyboardInterrupt:
            if not done:
                kept.remove()
                raise
        if len(kept.finished) in (0, len(self.scenes)):  # nothing to go on with, or nothing left
            kept.remove()
        return [done.get(i) or lost_curve(scene, INTERRUPTED) for i, scene in enumerate(self.scenes)]

    def _finished(self, groups: dict[int, Group]) -> Finished:
        if self.jobs > 1 and len(groups) > 1:
            from fcm.response.cores import on_cores

            return on_cores(self.work, groups, self.jobs, self.progress)
        return one_by_one(self.work, groups, self.progress)
