"""Optimum of the numbers of a scene: those with the least peak, and the response with them."""

from __future__ import annotations

import time
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np

from fcm.model.scene import Optimum, Scene
from fcm.response.accuracy_shortfall import remedy
from fcm.response.least_peak import Found, PeakTask, still, with_values
from fcm.response.nearly_least import nearly_least, unstable_peaks
from fcm.response.options import OPTIMUM, ResponseOptions
from fcm.response.request import ResponseError, request_of
from fcm.response.rigid_body_limits import rigid_fault
from fcm.response.ring_limits import check_no_ring, refuse_own_laws
from fcm.response.sweep import trace
from fcm.response.tracking_task import STATES
from fcm.results.curve_extracts import extract_of, without_points
from fcm.results.peak import Peak, stability_at_top
from fcm.results.result import INTERRUPTED, Curve, Response
from fcm.results.tracked import Optimal, TrackedCurve, Tracking
from fcm.run import IN_THIS_PROCESS, CheckpointFile, Execution, Progress, Results, fingerprint
from fcm.run.progress import part
from fcm.scene.address import replaced
from fcm.scene.draft import Draft, Number, number_of
from fcm.scene.errors import counted
from fcm.table import Table
from fcm.tracking.kept_steps import KeptSteps, steps_of
from fcm.tracking.options import SEARCH
from fcm.tracking.peak_envelope import INCOMPLETE


def optimise(
    scene: Scene,
    method: str | Table = "table",
    execution: Execution = IN_THIS_PROCESS,
    *,
    harmonics: int | Sequence[int] | None = None,
    accuracy: float | None = None,
    options: ResponseOptions | None = None,
) -> Response:
    """Find the optima of a scene with an [optimum], one for each curve of its sweep, and trace the responses.

    Parameters
    ----------
    harmonics, accuracy
        As of `trace`: with an accuracy, as many harmonics as the response at the optimum needs.
    method, execution
        As of `trace`: the checkpoint keeps the optima found, and then the curves of the response.
    options : ResponseOptions, optional
        Tolerances and limits; with `peaks_only` of the sweep, points are dropped after the optima are
        checked.

    Raises
    ------
    ResponseError
        If there is no peak in the range, a minimised quantity does not move, or a number changes the
        rigid-body motions.
    KeyboardInterrupt
        If nothing has been found; else the least peak so far is returned, without a response.
    """
    assert scene.optimum is not None
    check_no_ring(scene, "optima")
    refuse_own_laws(scene, "an optimum")
    begin = time.perf_counter()
    numbers, free = _freed(scene, scene.optimum.vary)
    for number, bounds in zip(numbers, scene.optimum.bounds, strict=True):
        if fault := rigid_fault(free, number, bounds):
            raise ResponseError(f"optimum: bounds {bounds[0]:g} to {bounds[1]:g}: {fault}")
    request = request_of(scene, harmonics, accuracy, options)
    tasks = [PeakTask(curve, numbers, request.accuracy, request.options) for curve in free.each_curve()]
    with execution.checkpoint() as checkpoint:
        found, stopped = optima(
            tasks, request.harmonics, checkpoint, part(execution.progress, 0.0, OPTIMUM.search_share)
        )
        tracking = _tracking(scene.optimum, found)
        if stopped:
            return _unfinished(free, tracking, len(tasks), begin)
        there, chosen = _at(free, numbers, tracking.optima), request.options
        all_points = replace(chosen, sweep=replace(chosen.sweep, peaks_only=False))
        rest = replace(execution, keep=checkpoint).stage(OPTIMUM.search_share, 1.0)
        response = trace(there, method, rest, harmonics=tracking.harmonics, options=all_points)
        if not response.interrupted:
            execution.discard(checkpoint)
    for one, curve in zip(tracking.optima, response.curves, strict=True):
        _check_moves(one, curve)
    tracking.optima = [
        replace(
            _with_error(one, curve),
            higher=_missed_peak(one, curve),
            nearly=nearly_least(one, tracking.curves, list(curve.peaks), OPTIMUM.nearly),
            unstable=unstable_peaks(one, tracking.curves, list(curve.peaks)),
        )
        for one, curve in zip(tracking.optima, response.curves, strict=True)
    ]
    tracking.problems += [
        f"at the optimum there is a higher {one.higher[0]}, {one.higher[1]:.6g}, than was followed"
        for one in tracking.optima
        if one.higher is not None
    ]
    if request.harmonics is None:
        _say_what_is_short(tracking, response, request.accuracy)
    response.tracking = tracking
    if chosen.sweep.peaks_only:
        response.curves, response.peaks_only = [without_points(one) for one in response.curves], True
    response.seconds = time.perf_counter() - begin
    return response


def _freed(scene: Scene, keys: Iterable[str]) -> tuple[list[Number], Scene]:
    """The numbers with some keys, and the scene with these numbers free."""
    numbers = [number_of(scene, key) for key in keys]
    for number in numbers:
        scene = number.freed(scene)
    return numbers, scene


def _unfinished(free: Scene, tracking: Tracking, count: int, begin: float) -> Response:
    """The response after an interrupted search: the optima so far, without curves."""
    unknown = [(np.nan,) * len(one.active) for one in tracking.optima]
    tracking.optima = [
        replace(one, stable=none, residual=none) for one, none in zip(tracking.optima, unknown, strict=True)
    ]
    tracking.interrupted = True
    finished = sum(one.kind != INCOMPLETE for one in tracking.optima)
    said = "" if count == 1 else f" (of {count}, {finished} are)"
    tracking.problems.append(
        f"{INTERRUPTED} before the optimum was found{said} and the response with it traced"
    )
    response = Response.without_curves(free)
    response.tracking, response.seconds = tracking, time.perf_counter() - begin
    return response


def _tracking(aim: Optimum, found: list[Found]) -> Tracking:
    """The optima and the curves of peaks that led to them, for a file."""
    key = aim.vary[0] if len(aim.vary) == 1 else ""
    curves = [curve for _, tracked in found for curve in tracked]
    tracking = Tracking(key, "optimum", aim.bounds[0], found[0][0].harmonics, curves)
    tracking.optima = [one for one, _ in found]
    return tracking


def scenes_at(scene: Scene, optima: list[Optimal]) -> tuple[Scene, ...]:
    """The scenes of the curves of `optimise`, as if their optimal numbers had been given."""
    numbers, free = _freed(scene, optima[0].values)
    found = []
    for curve, one in zip(free.each_curve(), optima, strict=True):
        assert curve.draft is not None
        parts = curve.draft.fixed(curve).parts
        for number, value in zip(numbers, one.values.values(), strict=True):
            for address, number_there in number.values(value).items():
                parts = replaced(parts, address, number_there)
        there = with_values(curve, numbers, np.array(list(one.values.values())))
        found.append(replace(there, draft=Draft(parts, ()), parameters={}, curves=()))
    return tuple(found)


def _at(free: Scene, numbers: list[Number], optima: list[Optimal]) -> Scene:
    """The scene with one curve for each optimum."""
    curves = []
    for curve, found in zip(free.each_curve(), optima, strict=True):
        there = with_values(curve, numbers, np.array(list(found.values.values())))
        curves.append(replace(there, parameters={**curve.parameters, **found.values}, curves=(), draft=None))
    return replace(free, curves=tuple(curves))


def _check_moves(found: Optimal, curve: Curve) -> None:
    """Raise ResponseError where a minimised peak is mere rounding."""
    unmoved = [dof for dof, _ in found.active if curve.peaks[dof].amplitude == 0.0]
    if unmoved and found.value > 0.0:
        raise ResponseError(f"optimum: {still(' and '.join(unmoved), len(unmoved))}")


def _with_error(found: Optimal, curve: Curve) -> Optimal:
    """Add to an optimum the estimated error, stability and residual change of its greatest peaks."""
    there = [_known_of_peak(curve, dof, omega) for dof, omega in found.active]
    error = float(np.max([one.error for one in there])) if there else np.nan
    stable, residual = (tuple(getattr(one, name) for one in there) for name in ("stable", "residual"))
    return replace(found, error=error, stable=stable, residual=residual)


def _known_of_peak(curve: Curve, dof: str, omega: float) -> Peak:
    """The peak of a degree of freedom at a frequency, with its error and stability, NaN where unknown.

    It need not be the greatest amplitude, which may be at an end of the range.
    """
    greatest, d = curve.peaks[dof], list(curve.peaks).index(dof)
    if abs(greatest.frequency - omega) <= OPTIMUM.frequency_tolerance * omega:
        return greatest
    at = np.flatnonzero(np.abs(curve.frequency - omega) <= OPTIMUM.frequency_tolerance * omega)
    residual = np.nan if curve.undetermined else 0.0
    if not at.size:
        return Peak(np.nan, omega, residual=residual)
    stable = float(stability_at_top(curve.amplitude[at], curve.stable[at])[d])
    top = at[curve.amplitude[at, d].argmax()]
    return Peak(float(curve.amplitude[top, d]), omega, float(curve.error[top, d]), stable, residual)


def _say_what_is_short(tracking: Tracking, response: Response, accuracy: float) -> None:
    """Set `short_of` of curves that miss the accuracy, as more harmonics take too long or change nothing."""
    for one, curve in zip(tracking.optima, response.curves, strict=True):
        exact = one.error <= accuracy
        if curve.complete and not (exact and one.end_error <= accuracy):
            off = one.end_error if exact else one.error
            error = "is unknown" if np.isnan(off) else f"is estimated as {off:.1e}"
            higher = "the number at which a higher peak ends"
            if one.kind != "end":
                higher = "a higher peak beside it, which decides the number,"
            of = higher if exact else "the least peak"
            curve.short_of = f"{_with(one.harmonics)} the error of {of} {error}"
            if one.fewer is not None:
                at = ", ".join(f"{key} = {value:.6g}" for key, value in one.fewer.values.items())
                curve.short_of += f"; {_with(one.fewer.harmonics)} it is {one.fewer.value:.6g} at {at}"
            curve.short_of += f". {remedy(one.harmonics)}"


def _with(harmonics: tuple[int, ...]) -> str:
    return f"with {counted(len(harmonics), 'harmonic')}"


def _missed_peak(found: Optimal, curve: Curve) -> tuple[str, float] | None:
    """The highest peak in the response, of a minimised quantity, that the search has missed; else None."""
    ends, higher = (curve.extract or extract_of(curve)).ends, list[tuple[float, str]]()
    for name in found.minimised:
        what, _, dof = name.partition(".")
        peak = curve.peaks[dof]
        inside = what == "greatest" or peak.frequency not in ends
        if inside and peak.amplitude > found.value * (1.0 + 10.0 * SEARCH.height_tolerance):
            higher.append((peak.amplitude, name))
    if not higher:
        return None
    value, name = max(higher)
    return name, float(value)


KINDS = (Optimal, TrackedCurve)  # classes of results that are kept


def optima(
    tasks: list[PeakTask],
    harmonics: tuple[int, ...] | None,
    checkpoint: CheckpointFile | None,
    progress: Progress | None,
) -> tuple[list[Found], bool]:
    """The optimum of each task, all with the same harmonics, and whether the search was interrupted.

    After an interruption it returns the optima so far.

    Raises
    ------
    KeyboardInterrupt
        If nothing has been found.
    """
    found: list[Found] = []
    try:
        for one in _optima(tasks, harmonics, checkpoint, progress):
            found.append(one)
        return found if harmonics else _with_the_same(tasks, found, checkpoint), False
    except KeyboardInterrupt:
        last = tasks[len(found)].least_traced() if len(found) < len(tasks) else None
        found += [] if last is None else [(last, [])]
        if not found:
            raise
        return found, True


def _optima(
    tasks: list[PeakTask],
    harmonics: tuple[int, ...] | None,
    checkpoint: CheckpointFile | None,
    progress: Progress | None,
) -> Iterator[Found]:
    """Yield the optimum of each task; it is saved when found, as are the steps that lead to it.

    Optima saved by an earlier run are yielded as they are.
    """
    kept = Results() if checkpoint is None else _kept(tasks, harmonics, checkpoint)
    for i, task in enumerate(tasks):
        if i not in kept.finished:
            shown = part(progress, i / len(tasks), (i + 1) / len(tasks))
            task.steps = KeptSteps(steps_of(kept.states.get(i, ())), partial(kept.save, i))
            kept.add(i, [task.optimum(harmonics, shown)])
        yield kept.finished[i][0]


def _kept(tasks: list[PeakTask], harmonics: tuple[int, ...] | None, checkpoint: CheckpointFile) -> Results:
    """The saved results of these tasks, identified by everything that decides their optima."""
    scenes = [replace(task.scene, name="", title="", curves=()) for task in tasks]
    mark = fingerprint(
        "optima", harmonics, [(task.numbers, task.accuracy, task.options) for task in tasks], scenes
    )
    return checkpoint.results(mark, (*KINDS, *STATES), lambda i, found: _fits(tasks, i, found))


def _fits(tasks: list[PeakTask], number: int, results: Any) -> bool:
    """Whether results read from a file can be the optimum of the task with this number."""
    if not (0 <= number < len(tasks) and isinstance(results, list) and len(results) == 1):
        return False
    found = results[0]
    if not (isinstance(found, tuple) and len(found) == 2 and isinstance(found[1], list)):
        return False
    curves = all(isinstance(curve, TrackedCurve) for curve in found[1])
    return curves and isinstance(found[0], Optimal) and found[0].parameters == tasks[number].scene.parameters


def _with_the_same(
    tasks: list[PeakTask], found: list[Found], checkpoint: CheckpointFile | None
) -> list[Found]:
    """The optima with the same harmonics, those that any of them needs, as curves of a response have."""
    every = {h for one, _ in found for h in one.harmonics}
    if all(len(one.harmonics) == len(every) for one, _ in found):
        return found
    for _ in range(tasks[0].options.optimum.max_rounds):
        chosen = tuple(sorted(every))
        others = [task for task, one in zip(tasks, found, strict=True) if one[0].harmonics != chosen]
        again = _optima(others, chosen, checkpoint, None)
        found = [one if one[0].harmonics == chosen else next(again) for one in found]
        for task, one in zip(tasks, found, strict=True):
            every |= set(task.needed(one[0], chosen))
        if len(every) == len(chosen):
            break
    return found
