"""Continuation of folds, peaks and onsets of a scene's response in one of its numbers."""

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
    """Ends of a span (0 or 1, with their values) are invalid: nothing can be followed in it."""

    def __init__(self, ends: Mapping[int, float], fault: str, digits: int = 6) -> None:
        self.ends, self.fault, self.digits = ends, fault, digits
        super().__init__(f"span {self.named('from', 'to')}")

    def named(self, *names: str) -> ResponseError:
        """The error with the caller's names of the two ends."""
        ends = " ".join(f"{names[which]} {value:.{self.digits}g}" for which, value in self.ends.items())
        return ResponseError(f"{ends}: {self.fault}")


class TrackRequest(Frozen):
    """Request to follow special points of the response in a number of the scene.

    Attributes
    ----------
    what : {"folds", "peaks", "slip", "separation", "closing"}
        Folds, at which the response turns back (jumps), peaks, or the onsets of slip, of separation and of
        first contact.
    over : str
        The number, as in [sweep], such as "contact.shroud.n_0", or "level" of the forces. A sweep of it is
        left out.
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
    """Follow special points of the response in a number of the scene.

    Parameters
    ----------
    execution : Execution, optional
        As in `fcm.response.trace`: where the curves of a sweep are followed, and the checkpoint.
    options : ResponseOptions, optional
        Tolerances and limits.

    Returns
    -------
    Response
        It has no response curves; `tracking` has the tracked curves, after an interruption the finished ones.

    Raises
    ------
    ResponseError
        If the kind of points or the span is invalid.
    SceneError
        If there is no such number.
    KeyboardInterrupt
        If no curve is finished.
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
    """Sentence on outputs whose peaks are not tracked, as there are too many."""
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
    """The results of each scene, as far as they are finished."""
    batches, kept = [(replace(one, curves=()),) for one in scenes], Results()
    if checkpoint is not None:
        mark = fingerprint("tracked", task, [replace(one, name="", title="") for (one,) in batches])
        kept = checkpoint.results(mark, (*KINDS, *STATES), lambda i, found: _fits(len(batches), i, found))
    outcome = compute_batches(task, batches, place, kept, progress)
    if outcome.lost:
        warnings.warn(outcome.lost, stacklevel=2)
    return outcome


def _fits(count: int, number: int, results: Any) -> bool:
    """Whether results read from a file can be those of a scene."""
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
    """Sentence on the greatest error of tracked curves if it misses an accuracy, else empty."""
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
    """The harmonics that an accuracy needs, at both ends of a span and in its middle.

    Of several curves, only the first and the last are traced.
    """
    found = {1}
    for curve in (curves[0], curves[-1]) if len(curves) > 1 else curves:
        for value in np.linspace(*span, 3).tolist():
            system = request.system(number.put(curve, value), (1,))
            there = refined_response(system, request.accuracy, options=request.options.refinement)
            found |= set(there.system.harmonics)
    return tuple(sorted(found))
