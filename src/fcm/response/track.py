"""Folds, peaks and onsets of a scene's response followed in a number of it."""

from __future__ import annotations

import time
import warnings
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from fcm.accuracy.refinement import refined_response
from fcm.frozen import Frozen
from fcm.model.scene import Scene
from fcm.quoting import quoted
from fcm.response.accuracy_shortfall import remedy
from fcm.response.master_dofs import with_master_dofs
from fcm.response.options import INPUT_LIMITS, ResponseOptions
from fcm.response.request import Request, ResponseError, request_of
from fcm.response.rigid_body_limits import rigid_fault
from fcm.response.ring_limits import check_no_ring, refuse_own_laws
from fcm.response.tracking_task import KINDS, STATES, TrackedScene, TrackingTask
from fcm.results.result import DEFECT, NOT_BEGUN, Response
from fcm.results.tracked import Tracking
from fcm.run import (
    IN_THIS_PROCESS,
    CheckpointFile,
    Execution,
    Factory,
    Lost,
    Outcome,
    Progress,
    Results,
    compute_batches,
    fingerprint,
    place_for,
)
from fcm.scene.address import LEVEL
from fcm.scene.draft import AT_REST, Number, number_of, only_force
from fcm.scene.errors import counted
from fcm.tracking.onset_functions import KINDS as ONSETS

WHAT = ("folds", "peaks", *ONSETS)


class SpanError(ResponseError):
    """The ends of a span, 0 or 1 and their values, are wrong: nothing can be followed in it."""

    def __init__(self, ends: Mapping[int, float], fault: str, digits: int = 6) -> None:
        self.ends, self.fault, self.digits = ends, fault, digits
        super().__init__(f"span {self.named('from', 'to')}")

    def named(self, *names: str) -> ResponseError:
        """The error with a caller's names of the two ends."""
        ends = " ".join(f"{names[which]} {value:.{self.digits}g}" for which, value in self.ends.items())
        return ResponseError(f"{ends}: {self.fault}")


class TrackRequest(Frozen):
    """Special points of the response that are followed in a number of the scene.

    Attributes
    ----------
    what : {"folds", "peaks", "slip", "separation", "closing"}
        The frequencies at which the response turns back (jumps), its peaks, or the onsets of slip and of
        separation, and of contact at all.
    over : str
        The number as in [sweep], "contact.shroud.n_0", or "level" of the forces. A sweep of it is left out.
    span : (from, to)
    """

    what: str
    over: str
    span: tuple[float, float]


def track(
    scene: Scene,
    asked: TrackRequest,
    execution: Execution = IN_THIS_PROCESS,
    *,
    harmonics: int | Sequence[int] | None = None,
    accuracy: float | None = None,
    options: ResponseOptions | None = None,
) -> Response:
    """Curves of special points of the response against a number of the scene.

    Parameters
    ----------
    execution : Execution, optional
        As in `fcm.response.trace`: where the curves of a sweep are followed, and what is kept of them.
    options : ResponseOptions, optional
        Tolerances and limits.

    Returns
    -------
    Response
        Without curves of its own; `tracking` holds the others. Interrupted, it has those that are finished.

    Raises
    ------
    ResponseError
        If what is asked for, or the span, is wrong.
    SceneError
        If there is no such number.
    KeyboardInterrupt
        If no curve is finished then.
    """
    what, span = asked.what, asked.span
    if what not in WHAT:
        raise ResponseError(f"track {quoted(what)} is not one of {', '.join(WHAT)}")
    number = number_of(scene, asked.over)
    _check(scene, number, span)
    begin = time.perf_counter()
    free = number.freed(scene)
    request = request_of(scene, harmonics, accuracy, options)
    asked_for = np.array([free.asks_for(dof) for dof in free.modal.dofs])
    reported = free.at_attached_and(asked_for) if free.output else free
    tracked = with_master_dofs(reported)
    curves = tracked.each_curve()
    chosen = request.harmonics or needed(curves, number, span, request)
    place = execution.place or place_for(execution.processes if len(curves) > 1 else 1)
    response = Response.without_curves(tracked)
    response.tracking, response.method = Tracking(asked.over, what, span, chosen, []), "tracked"
    with execution.checkpoint() as checkpoint:
        if what == "peaks":
            response.left_out = _untracked(len(reported.modal.dofs), len(tracked.modal.dofs))
        task = TrackingTask(number, what, span, chosen, request.options)
        outcome = _swept(task, curves, checkpoint, place, execution.progress)
        for i, one in enumerate(curves):
            _add(response, one, next(iter(outcome.of(i)), None))
        if request.harmonics is None:
            response.tracking.short_of = _short_of(response.tracking, request.accuracy)
        if not response.interrupted:
            execution.discard(checkpoint)
    response.seconds = time.perf_counter() - begin
    return response


def _untracked(every: int, tracked: int) -> list[str]:
    """Sentence on outputs whose peaks are not tracked, as they are too many."""
    if tracked == every:
        return []
    which = f"those of {tracked}, at contacts and forces and where modes move most, are tracked"
    return [f"peaks of {every - tracked} of {every} degrees of freedom: {which}; [response] output chooses"]


def _swept(
    task: TrackingTask,
    scenes: Sequence[Scene],
    checkpoint: CheckpointFile | None,
    place: Factory,
    progress: Progress | None,
) -> Outcome:
    """The results of each scene, as far as the run came."""
    batches, kept = [(replace(one, curves=()),) for one in scenes], Results()
    if checkpoint is not None:
        mark = fingerprint("tracked", task, [replace(one, name="", title="") for (one,) in batches])
        kept = checkpoint.results(mark, (*KINDS, *STATES), lambda i, found: _fits(len(batches), i, found))
    outcome = compute_batches(task, batches, place, kept, progress)
    if outcome.lost:
        warnings.warn(outcome.lost, stacklevel=2)
    return outcome


def _fits(count: int, number: int, results: Any) -> bool:
    """Whether results that were read from a file can be those of a scene."""
    return (
        0 <= number < count and isinstance(results, list) and [type(one) for one in results] == [TrackedScene]
    )


def _add(response: Response, scene: Scene, found: TrackedScene | Lost | None) -> None:
    """Add the curves followed in one scene to the response."""
    assert response.tracking is not None
    if isinstance(found, Lost):
        reason = f"{DEFECT}, {found.reason}" if found.defect else found.reason
        response.defects += [found.defect] if found.defect else []
    elif found is None:
        reason = NOT_BEGUN
    else:
        response.tracking.curves += found.curves
        response.tracking.uncertain_at += found.uncertain_at
    problems = found.problems if isinstance(found, TrackedScene) else [reason]
    cut_off = found is None or (isinstance(found, TrackedScene) and found.interrupted)
    response.tracking.interrupted |= cut_off
    where = ", ".join(f"{key} = {value:g}" for key, value in scene.parameters.items())
    response.tracking.problems += [f"{where}: {text}" if where else text for text in problems]


def _short_of(tracking: Tracking, accuracy: float) -> str:
    """Sentence on what keeps tracked curves from an accuracy; empty if nothing is known to."""
    told = [(one.relative, curve.number[one.point]) for curve in tracking.curves for one in curve.errors]
    off = [(error, number) for error, number in told if not error <= accuracy]
    if not off:
        return ""
    error, number = max(off, key=lambda one: np.inf if np.isnan(one[0]) else one[0])
    what = "the error is unknown" if np.isnan(error) else f"an estimated error of {error:.1e} remains"
    count = counted(len(tracking.harmonics), "harmonic")
    helps = remedy(tracking.harmonics)
    return f"with {count} {what} at {tracking.key} = {number:.6g}. {helps}"


def _check(scene: Scene, number: Number, span: tuple[float, float]) -> None:
    low, high = span
    check_no_ring(scene, "tracked points")
    refuse_own_laws(scene, "a tracked point")
    if not scene.has_range:
        raise ResponseError("the scene has no range of frequencies; give [response] frequency = [from, to]")
    for which, end in enumerate(span):
        if fault := number.rule.fault(end):
            raise SpanError({which: end}, f"{number.key} {fault}")
    both = dict(enumerate(span))
    if not low < high:
        swapped = f"; swap them: {high:.6g} to {low:.6g}" if high < low else ""
        raise SpanError(both, f"{number.key} must rise{swapped}")
    if high - low < INPUT_LIMITS.min_relative_width * max(abs(low), abs(high)):
        raise SpanError(both, "too narrow to follow a curve through", digits=17)
    if number.key == LEVEL and low <= 0.0:
        raise SpanError({0: low}, f"the level must be positive: {AT_REST}")
    if low <= 0.0 <= high and scene.draft is not None and only_force(scene.draft.parts, number):
        raise SpanError(both, f"{AT_REST} by {number.key}; leave 0 out")
    if fault := rigid_fault(number.freed(scene), number, span):
        raise SpanError(both, fault)


def needed(
    curves: Sequence[Scene], number: Number, span: tuple[float, float], request: Request
) -> tuple[int, ...]:
    """The harmonics that an accuracy takes, at both ends of a span and in its middle."""
    found = {1}
    for curve in (curves[0], curves[-1]) if len(curves) > 1 else curves:
        for value in np.linspace(*span, 3).tolist():
            system = request.system(number.put(curve, value), (1,))
            there = refined_response(system, request.accuracy, options=request.options.refinement)
            found |= set(there.system.harmonics)
    return tuple(sorted(found))
