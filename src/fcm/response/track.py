"""Folds, peaks and onsets of a scene's response followed in a number of it."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence

import numpy as np

from fcm.harmonic.choice import accurate
from fcm.harmonic.system import System
from fcm.response.around import check_no_ring
from fcm.response.trace import ResponseError, Wanted, wanted_of
from fcm.results.result import INTERRUPTED, Response
from fcm.results.tracked import TrackedCurve, TrackedError, Tracking
from fcm.run import Progress
from fcm.run.progress import part
from fcm.scene.draft import Number, number_of
from fcm.scene.model import Scene
from fcm.track.curve import Track
from fcm.track.curves import Tracks, tracks
from fcm.track.error import change, places
from fcm.track.onset import KINDS
from fcm.track.spot import Way
from fcm.track.tracked import Condition, Kind
from fcm.track.varied import along

WHAT = ("folds", "peaks", *KINDS)
STOPPED = f"{INTERRUPTED}, so that curves and errors may be missing"


def track(
    scene: Scene,
    what: str,
    over: str,
    span: tuple[float, float],
    *,
    harmonics: int | Sequence[int] | None = None,
    accuracy: float | None = None,
    progress: Progress | None = None,
) -> Response:
    """Curves of special points of the response against a number of the scene.

    Parameters
    ----------
    what : {"folds", "peaks", "slip", "separation", "closing"}
        The frequencies at which the response turns back (jumps), its peaks, or the onsets of slip and of
        separation, and of contact at all.
    over : str
        The number as in [sweep], "contact.shroud.n_0", or "level" of the forces. A sweep of it is left out.
    span : (from, to)

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
    if what not in WHAT:
        raise ResponseError(f"track {what!r} is not one of {', '.join(WHAT)}")
    number = number_of(scene, over)
    assert number is not None
    _check(scene, number, span)
    begin = time.perf_counter()
    free = number.freed(scene)
    wanted = wanted_of(scene, harmonics, accuracy)
    curves = free.each_curve()
    chosen = wanted.harmonics or needed(curves, number, span, wanted)
    tracking = Tracking(over, what, span, chosen, [])
    for i, one in enumerate(curves):
        shown = None if progress is None else part(progress, i / len(curves), (i + 1.0) / len(curves))
        system, line = System(one, chosen), along(number)
        found = tracks(system, line, span, conditions_of(one, what), (), _named(number, shown))
        stopped = _add(tracking, one, found, Way(system, line, span, (), one.max_step))
        if stopped and not tracking.curves:
            raise KeyboardInterrupt
        if stopped:
            break
    response = Response.without_curves(scene)
    response.tracking, response.method = tracking, "tracked"
    response.seconds = time.perf_counter() - begin
    return response


def _check(scene: Scene, number: Number, span: tuple[float, float]) -> None:
    low, high = span
    check_no_ring(scene, "tracked points")
    if not scene.has_range:
        raise ResponseError("the scene has no range of frequencies; give [response] frequency = [from, to]")
    for end in span:
        if fault := number.rule.fault(end):
            raise ResponseError(f"{number.key} {fault}")
    if not low < high:
        raise ResponseError(f"{number.key} is from {low:g} to {high:g}, but must rise")


def needed(
    curves: Sequence[Scene], number: Number, span: tuple[float, float], wanted: Wanted
) -> tuple[int, ...]:
    """The harmonics that an accuracy takes, at both ends of a span and in its middle."""
    found = {1}
    for curve in (curves[0], curves[-1]) if len(curves) > 1 else curves:
        for value in np.linspace(*span, 3).tolist():
            found |= set(accurate(System(number.put(curve, value)), wanted.accuracy).system.harmonics)
    return tuple(sorted(found))


def _named(number: Number, progress: Progress | None) -> Callable[[float], None] | None:
    return None if progress is None else lambda share: progress(share, number.key)


def conditions_of(scene: Scene, what: str) -> list[Condition]:
    """What is tracked: for peaks, of every degree of freedom; for onsets, of every contact."""
    if what == "folds":
        return [Condition(Kind.FOLD)]
    if what == "peaks":
        return [
            Condition(Kind.PEAK, dof) for dof, name in enumerate(scene.modal.dofs) if _is_shown(scene, name)
        ]
    return [Condition(Kind.ONSET, i, what) for i in range(len(scene.contacts))]


def _is_shown(scene: Scene, name: str) -> bool:
    return not scene.reported or name in scene.reported


def _add(tracking: Tracking, scene: Scene, found: Tracks, way: Way) -> bool:
    """The curves of one scene to those of all, with their errors; whether that was interrupted.

    After an interruption nothing is estimated any more.
    """
    where = ", ".join(f"{key} = {value:g}" for key, value in scene.parameters.items())
    problems, stopped = list(found.problems), found.interrupted
    for one in found.curves:
        told: tuple[TrackedError, ...] = ()
        try:
            told = () if stopped else errors(way, one)
        except KeyboardInterrupt:
            stopped = True
        tracking.curves.append(as_curve(scene, one, told))
    if stopped:
        problems.append(STOPPED)
    tracking.problems += [f"{where}: {text}" if where else text for text in problems]
    return stopped


def errors(way: Way, one: Track) -> tuple[TrackedError, ...]:
    """What the harmonics left out change at a track's ends, turns, least and greatest peak."""
    told = []
    for point, place in places(one).items():
        by = change(way, one, point)
        told.append(TrackedError(point, place, by.relative, by.number if one.spots[point].turn else np.nan))
    return tuple(told)


def as_curve(scene: Scene, one: Track, told: tuple[TrackedError, ...] = ()) -> TrackedCurve:
    """A track in the words of its scene, with its errors as far as they were estimated."""
    corners = ["" if spot.corner is None else named(scene, spot.corner) for spot in one.spots]
    stopped = [ending for ending in one.endings if not ending.whole]
    end = one.s[0] if not one.endings[0].whole else one.s[-1]
    return TrackedCurve(
        parameters=dict(scene.parameters),
        what=named(scene, one.condition),
        number=one.s,
        frequency=one.frequency,
        amplitude=one.amplitude,
        corner=np.array(corners, dtype=str),
        turn=np.array([bool(spot.turn) for spot in one.spots]),
        trough=~one.greatest,
        closings=tuple(one.turns()),
        complete=one.whole,
        reason=f"stopped at {end:.6g}: {stopped[0].value}" if stopped else "",
        errors=told,
    )


def named(scene: Scene, condition: Condition) -> str:
    """What a condition is, in words."""
    if condition.kind is Kind.PEAK:
        return f"peak of {scene.modal.dofs[condition.which]}"
    if condition.kind is Kind.ONSET:
        return f"{condition.onset} of {scene.contacts[condition.which].name or condition.which}"
    return "fold" if condition.kind is Kind.FOLD else "end of the range"
