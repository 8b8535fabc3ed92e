"""Exact periodic solutions of every curve of a scene, as a response: traced, or visited by sweeps."""

from __future__ import annotations

import os
import time
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from fcm.motion.errors import SimulationError
from fcm.response.around import refuse_ring
from fcm.response.curve_sweep import CurveSweep, checkpoint_of
from fcm.response.groups import Group, lost_curve
from fcm.response.result import INTERRUPTED, Curve, Response
from fcm.response.trace import ResponseError
from fcm.run import Checkpoint, Factory, Interrupted, Progress, Report, fingerprint
from fcm.scene.model import Scene
from fcm.simulate.branch import shown
from fcm.simulate.explore import Explorer
from fcm.simulate.orbit_curve import traced_curve, visited_curve
from fcm.simulate.visit import STATES, Visitor
from fcm.units import UNIT

METHOD = "exact"
STOPPED = f"{INTERRUPTED} at "  # how the reason of a curve begins that an interruption has cut off


def trace_exact(
    scene: Scene,
    at: Sequence[float] | None = None,
    progress: Progress | None = None,
    *,
    jobs: int = 1,
    place: Factory | None = None,
    keep: Path | Checkpoint | None = None,
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
    jobs, place, keep, resume
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
    refuse_ring(scene, "the exact motion")
    begin, scenes, frequencies = time.perf_counter(), scene.each_curve(), _checked(scene, at)
    with checkpoint_of(keep, resume) as checkpoint:
        sweep = CurveSweep(jobs or os.cpu_count() or 1, checkpoint, place)
        mark = fingerprint(METHOD, frequencies)
        curves = sweep.curves(ExactWork(frequencies), [(one,) for one in scenes], mark, progress, STATES)
        contacts = tuple(contact.name for contact in scenes[0].contacts)
        response = Response(scene.title, scene.modal.dofs, contacts, curves, METHOD, scene.frequency_unit)
        if isinstance(keep, Path) and checkpoint is not None and not response.interrupted:
            checkpoint.done()
    response.defects = sweep.defects
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
class ExactWork:
    """How each curve is made: traced, or visited at frequencies."""

    at: tuple[float, ...] | None  # [rad/s]

    def __call__(self, group: Group, report: Report) -> list[Curve]:
        return [self._curve(scene, report) for scene in group]

    def _curve(self, scene: Scene, report: Report) -> Curve:
        begin = time.perf_counter()
        try:
            curve = _traced(scene, report) if self.at is None else _visited(scene, self.at, report)
        except SimulationError as error:  # there is no rest to begin with
            curve = lost_curve(scene, str(error))
        curve = replace(curve, seconds=time.perf_counter() - begin)
        if curve.reason.startswith(STOPPED):
            raise Interrupted([curve])
        return curve


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


def _visited(scene: Scene, at: tuple[float, ...], report: Report) -> Curve:
    visitor, reason = Visitor(replace(scene, frequency_range=(0.0, at[-1]))), ""
    try:
        visitor.run(at, report)
    except KeyboardInterrupt:
        reason = STOPPED + (shown(scene, visitor.points[-1].frequency) if visitor.points else "the start")
    except SimulationError as error:
        reason = str(error)
    return visited_curve(scene, visitor, reason)
