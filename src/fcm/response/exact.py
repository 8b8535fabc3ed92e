"""Exact periodic solutions of every curve of a scene, as a response: traced, or visited by sweeps."""

from __future__ import annotations

import os
import time
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from fcm.continuation import Path as Followed
from fcm.harmonic.rigid import too_stiff
from fcm.harmonic.system import System
from fcm.motion.errors import SimulationError
from fcm.orbit.branch import explore, incomplete, reached, shown
from fcm.orbit.problem import OrbitProblem
from fcm.reduction.held import foreseen as foreseen_held
from fcm.reduction.held import lost_by, on_contacts
from fcm.reduction.leave_out import TOLERANCE, leave_out_modes
from fcm.reduction.mode_effect import effect, foreseen
from fcm.reduction.sentences import on_modes
from fcm.response.around import refuse_ring
from fcm.response.curve_sweep import CurveSweep, checkpoint_of
from fcm.response.groups import Group, lost_curve
from fcm.response.legs import LEGS, Legs, TimeOver
from fcm.response.only_peaks import peaks_alone, peaks_of
from fcm.response.orbit_curve import orbit_curve, visited_curve
from fcm.response.trace import traced_curve as balance_of
from fcm.response.visit import STATES, Visitor
from fcm.response.wanted import ResponseError
from fcm.results.result import INTERRUPTED, Curve, Response
from fcm.run import Checkpoint, Factory, Interrupted, Progress, Report, fingerprint
from fcm.scene.model import Held, Scene
from fcm.units import UNIT

METHOD = "exact"
ONLY = "of the exact curves all points but their peaks, folds and jumps"
FEWEST = 2  # contacts of a scene of which some may be foreseen to keep their state
HIGHEST = 3  # harmonic up to which modes are kept as they are; what that does is measured
ENOUGH = 10.0  # [s] of processor time for a curve that a stiff contact may keep from ever being finished
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
    limit: float | None = None,
    tolerance: float | None = TOLERANCE,
    only: str | None = None,
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
    limit : float, optional
        Processor time for each curve [s]; what there is of it then, is the result.
    tolerance : float, optional
        Greatest relative change of the amplitudes by modes that are left out; 0 leaves out only those that
        have no effect, None nothing.
    only : {"peaks"}, optional
        Of the curves the peaks, folds and jumps alone, sought near those of the harmonic balance.

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
    begin, frequencies = time.perf_counter(), _checked(scene, at)
    with checkpoint_of(keep, resume) as checkpoint:
        work = ExactWork(frequencies, limit, only is not None, tolerance is None)
        run = _Run(work, CurveSweep(jobs or os.cpu_count() or 1, checkpoint, place))
        response = run.response(scene, tolerance, progress)
        if isinstance(keep, Path) and checkpoint is not None and not response.interrupted:
            checkpoint.done()
    response.defects = run.sweep.defects
    response.seconds = time.perf_counter() - begin
    return response


@dataclass(frozen=True)
class _Run:
    """One after the other the sweeps of a run, the second with all modes where they turn out to be needed."""

    work: ExactWork
    sweep: CurveSweep

    def response(self, scene: Scene, tolerance: float | None, progress: Progress | None) -> Response:
        """The curves without the modes that they do not need."""
        scenes = scene.each_curve()
        if tolerance is None:
            return self._swept(scene, scenes, progress)  # the comparison's, which leaves out by itself
        lighter = leave_out_modes(scenes, tolerance, HIGHEST)
        if lighter.above is not None and 2.0 * foreseen(lighter) > tolerance:
            lighter = leave_out_modes(scenes, 0.0, HIGHEST)
        response, said = self._swept(scene, lighter.curves, progress), list(lighter.sentences)
        if lighter.above is not None and not response.interrupted:
            change = effect(response, lighter)
            if 2.0 * change <= tolerance:
                said.append(on_modes(lighter, change))
            else:
                response = self._swept(scene, lighter.exact, progress)
        said += on_contacts(response.curves, scenes[0].contacts)
        response.left_out = [*said, *([ONLY] if self.work.only_peaks else [])]
        return response

    def _swept(self, scene: Scene, scenes: Sequence[Scene], progress: Progress | None) -> Response:
        mark = fingerprint(METHOD, replace(self.work, limit=None))
        batches = [(one,) for one in scenes]
        curves = self.sweep.curves(self.work, batches, mark, progress, (*STATES, *LEGS))
        contacts = tuple(contact.name for contact in scenes[0].contacts)
        return Response(scene.title, scene.modal.dofs, contacts, curves, METHOD, scene.frequency_unit)


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
    limit: float | None = None  # [s] of processor time for a curve
    only_peaks: bool = False
    whole: bool = False  # nothing is to be left out

    def __call__(self, group: Group, report: Report) -> list[Curve]:
        return [self._curve(scene, report) for scene in group]

    def _curve(self, scene: Scene, report: Report) -> Curve:
        begin = time.perf_counter()
        try:
            curve = self._made(scene, report)
        except SimulationError as error:  # there is no rest to begin with
            curve = lost_curve(scene, str(error))
        curve = replace(curve, seconds=time.perf_counter() - begin)
        if curve.reason.startswith(STOPPED):
            raise Interrupted([curve])
        return curve

    def _made(self, scene: Scene, report: Report) -> Curve:
        if self.only_peaks:
            alone = peaks_alone(scene, report)
            return peaks_of(*_followed(scene, report, self.limit)) if alone is None else alone
        if self.at is None and (self.whole or len(scene.contacts) < FEWEST):
            return _traced(scene, report, self.limit)
        if self.at is None:
            return _traced_lightly(scene, report, self.limit)
        return _visited(scene, self.at, report, self.limit)


def _traced_lightly(scene: Scene, report: Report, limit: float | None) -> Curve:
    """The curve, followed without the contacts that keep their state all along it."""
    held = foreseen_held(scene, balance_of(scene))
    end = None if limit is None else time.process_time() + limit
    while True:
        left = None if end is None else end - time.process_time()
        curve = _held_or_lost(scene, held, report, left) if held else _traced(scene, report, left)
        lost = np.zeros(0) if curve.orbits is None else lost_by(curve.orbits.held)
        if not (held and (lost.size or not curve.points)):
            return curve
        if curve.reason.startswith(STOPPED) or (end is not None and time.process_time() > end):
            return lost_curve(scene, curve.reason)  # what there is of it is not the motion of these contacts
        held = tuple(one for one in held if curve.points and one.place not in lost)


def _held_or_lost(scene: Scene, held: tuple[Held, ...], report: Report, limit: float | None) -> Curve:
    """The curve with contacts held; without a point, if it cannot be begun."""
    try:
        return _traced(scene.holding(held), report, limit)
    except SimulationError as error:
        return lost_curve(scene, str(error))


def _traced(scene: Scene, report: Report, limit: float | None) -> Curve:
    return orbit_curve(*_followed(scene, report, limit))


def _followed(scene: Scene, report: Report, limit: float | None) -> tuple[OrbitProblem, list[Followed], str]:
    """All branches, and why they are not complete, else ''.

    Where a contact is too stiff for that to end, it is said after so long; a limit of one's own is kept.
    """
    stiff, limit = _too_stiff(scene, limit)
    problem, legs = OrbitProblem(scene), Legs(scene.frequency_range, report, limit)
    try:
        paths, without = explore(problem, legs, legs.look)
        reason = incomplete(scene, paths, without)
    except (KeyboardInterrupt, TimeOver) as stop:
        legs.keep()
        paths = legs.paths()
        reason = _cut_off(stop, limit) + reached(scene, paths)
    return problem, paths, reason + stiff if reason else ""


def _cut_off(stop: BaseException, limit: float | None) -> str:
    """How the reason of a curve begins that has been stopped."""
    return f"not finished in {limit:g} s of processor time, at " if isinstance(stop, TimeOver) else STOPPED


def _too_stiff(scene: Scene, limit: float | None) -> tuple[str, float | None]:
    """Which contact is too stiff for its motion to be followed, and what to take instead; else ''.

    And the limit of time, if there is none of one's own.
    """
    whole = scene.whole()
    resists = whole.contacts and whole.modal.frequency.all()
    stiff = too_stiff(System(whole, (1,)), moves=True) if resists else ""
    return stiff, ENOUGH if stiff and limit is None else limit


def _visited(scene: Scene, at: tuple[float, ...], report: Report, limit: float | None) -> Curve:
    around = replace(scene, frequency_range=(0.0, at[-1]))
    stiff, limit = _too_stiff(replace(scene, frequency_range=(at[0], at[-1])), limit)
    visitor, reason = Visitor(around, Legs(around.frequency_range, report, limit).look), ""
    try:
        visitor.run(at, report)
    except (KeyboardInterrupt, TimeOver) as stop:
        where = shown(scene, visitor.points[-1].frequency) if visitor.points else "the start"
        reason = _cut_off(stop, limit) + where
    except SimulationError as error:
        reason = str(error)
    reason = reason or visitor.reason
    return visited_curve(scene, visitor, reason + stiff if reason else "")
