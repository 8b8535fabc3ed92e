"""The numbers of a scene with which a peak is least, and the response with them."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from fcm.harmonic.choice import enlarged, estimated
from fcm.harmonic.cost import PATIENCE
from fcm.harmonic.system import System
from fcm.response.around import check_no_ring
from fcm.response.sweep import trace
from fcm.response.trace import ResponseError, wanted_of
from fcm.response.tracked_work import as_curve
from fcm.results.result import Response
from fcm.results.tracked import Optimal, TrackedCurve, Tracking
from fcm.run import Progress
from fcm.run.progress import part
from fcm.scene.address import replaced
from fcm.scene.draft import Draft, Number, number_of
from fcm.scene.model import FloatArray, Scene
from fcm.track.descent import Valley, descend
from fcm.track.envelope import Least, Target
from fcm.track.lowest import HIGHER, Lowest, Search
from fcm.track.varied import along

ROUNDS = 4  # of choosing harmonics by the accuracy at the optimum
COUNTS = 1e-6  # of the greatest: peaks that are lower are none
SEEKING = 0.8  # share of the bar that is over when the optimum is found


def optimise(
    scene: Scene,
    *,
    harmonics: int | Sequence[int] | None = None,
    accuracy: float | None = None,
    progress: Progress | None = None,
    **options: Any,
) -> Response:
    """The optima of a scene with an [optimum], one for each curve of its sweep, and the responses there.

    Parameters
    ----------
    harmonics, accuracy
        As of `trace`: with an accuracy, as many harmonics as the response at the optimum takes.

    Raises
    ------
    ResponseError
        If nothing has a peak in the range.
    """
    aim = scene.optimum
    assert aim is not None
    check_no_ring(scene, "optima")
    begin = time.perf_counter()
    numbers = [number for key in aim.vary if (number := number_of(scene, key)) is not None]
    free = scene
    for number in numbers:
        free = number.freed(free)
    wanted = wanted_of(scene, harmonics, accuracy)
    key = aim.vary[0] if len(aim.vary) == 1 else ""
    tracking = Tracking(key, "optimum", aim.bounds[0], wanted.harmonics or (1,), [])
    curves = free.each_curve()
    tasks = [_Task(curve, numbers, wanted.accuracy) for curve in curves]
    found = []
    for i, task in enumerate(tasks):
        shown = part(progress, SEEKING * i / len(tasks), SEEKING * (i + 1) / len(tasks))
        found.append(_optimum(task, wanted.harmonics, shown))
    if wanted.harmonics is None:
        found = _with_the_same(tasks, found)
    tracking.harmonics = found[0][0].harmonics
    tracking.optima = [one for one, _ in found]
    tracking.curves = [curve for _, tracked in found for curve in tracked]
    shown = None if progress is None else part(progress, SEEKING, 1.0)
    response = trace(
        _at(free, numbers, tracking.optima), progress=shown, harmonics=tracking.harmonics, **options
    )
    tracking.optima = [_with_error(one, c) for one, c in zip(tracking.optima, response.curves, strict=True)]
    tracking.problems += _higher(tracking, response)
    if wanted.harmonics is None:
        _say_what_is_short(tracking, response, wanted.accuracy)
    response.tracking = tracking
    response.seconds = time.perf_counter() - begin
    return response


class _Task:
    """One scene (of one curve) with what is to be chosen."""

    def __init__(self, scene: Scene, numbers: list[Number], accuracy: float) -> None:
        assert scene.optimum is not None
        self.scene, self.numbers, self.accuracy = scene, numbers, accuracy
        self.bounds = np.array(scene.optimum.bounds)
        dofs = scene.modal.dofs
        self.targets = [Target(dofs.index(aim.dof), aim.ends) for aim in scene.optimum.minimise]

    def put(self, values: FloatArray) -> Scene:
        """The scene with values of the numbers."""
        return with_values(self.scene, self.numbers, values)


def _optimum(
    task: _Task, harmonics: tuple[int, ...] | None, progress: Progress | None
) -> tuple[Optimal, list[TrackedCurve]]:
    """With given harmonics, or with those that the accuracy takes at the optimum itself."""
    chosen = harmonics or (1,)
    known: Lowest | None = None
    for i in range(ROUNDS):
        shown = part(progress, i / ROUNDS, (i + 1) / ROUNDS)
        if len(task.numbers) == 1:
            known = _search(task, chosen).run(known, _sharing(shown))
            found = _on_line(task, known, chosen)
        else:
            found = _downhill(task, chosen)
        if harmonics:
            break
        more = _enough(task, found[0], chosen)
        if more == chosen:
            break
        chosen = more
    return found


def _with_the_same(
    tasks: list[_Task], found: list[tuple[Optimal, list[TrackedCurve]]]
) -> list[tuple[Optimal, list[TrackedCurve]]]:
    """The optima with the same harmonics, as the curves of a response have: what any of them takes."""
    every = {h for one, _ in found for h in one.harmonics}
    for _ in range(ROUNDS):
        chosen = tuple(sorted(every))
        found = [
            one if one[0].harmonics == chosen else _optimum(task, chosen, None)
            for task, one in zip(tasks, found, strict=True)
        ]
        for task, one in zip(tasks, found, strict=True):
            every |= set(_enough(task, one[0], chosen))
        if len(every) == len(chosen):
            break
    return found


def _sharing(progress: Progress | None) -> Callable[[float], None] | None:
    return None if progress is None else lambda share: progress(share, "optimum")


def _enough(task: _Task, found: Optimal, harmonics: tuple[int, ...]) -> tuple[int, ...]:
    """The harmonics that the accuracy of the peaks to be least takes at an optimum, from some on."""
    scene = task.put(np.array(list(found.values.values())))
    dofs = [target.dof for target in task.targets]
    while True:
        there = estimated(System(scene, harmonics), task.accuracy)
        height = np.max([one.amplitude.max(axis=0) for one in there.shown], axis=0, initial=0.0)[dofs]
        worst = float(there.peak[dofs][height > COUNTS * height.max()].max(initial=0.0))
        there = replace(there, worst=worst)
        if worst <= task.accuracy:
            return harmonics
        more = enlarged(there, task.accuracy)
        if more == harmonics or there.seconds_with(more) > PATIENCE:
            return harmonics
        harmonics = more


def _search(task: _Task, harmonics: tuple[int, ...]) -> Search:
    (number,), span = task.numbers, (float(task.bounds[0, 0]), float(task.bounds[0, 1]))
    return Search(System(task.scene, harmonics), along(number), span, task.targets)


def _on_line(task: _Task, found: Lowest, harmonics: tuple[int, ...]) -> tuple[Optimal, list[TrackedCurve]]:
    """Of one number, by the curves of the peaks."""
    if found.best is None:
        raise ResponseError(_nothing(task))
    curves = [as_curve(task.scene, one) for one in found.curves]
    return _optimal(task, np.array([found.best.s]), found.best, harmonics), curves


def _downhill(task: _Task, harmonics: tuple[int, ...]) -> tuple[Optimal, list[TrackedCurve]]:
    """Of several numbers."""
    found = descend(Valley(System(task.scene, harmonics), task.numbers, task.bounds, task.targets))
    if found is None:
        raise ResponseError(_nothing(task))
    return _optimal(task, found[0], found[1], harmonics), []


def _nothing(task: _Task) -> str:
    dofs = " and ".join(task.scene.modal.dofs[target.dof] for target in task.targets)
    why = f"{dofs} has no peak inside the range of frequencies"
    return f"optimum: {why}; minimise greatest.NAME, or widen the range"


def _optimal(task: _Task, values: FloatArray, best: Least, harmonics: tuple[int, ...]) -> Optimal:
    scene = task.scene
    assert scene.optimum is not None
    names = tuple(f"{'greatest' if aim.ends else 'peak'}.{aim.dof}" for aim in scene.optimum.minimise)
    active = [(scene.modal.dofs[one.dof], float(one.z[-2])) for one in best.active]
    return Optimal(
        parameters=dict(scene.parameters),
        values={number.key: float(value) for number, value in zip(task.numbers, values, strict=True)},
        minimised=names,
        value=best.value,
        active=tuple(sorted(active, key=lambda pair: pair[1])),
        kind=best.kind,
        harmonics=harmonics,
    )


def with_values(scene: Scene, numbers: list[Number], values: FloatArray) -> Scene:
    """The scene (of one curve) with values of numbers."""
    assert scene.draft is not None
    every = {
        a: x
        for number, value in zip(numbers, values, strict=True)
        for a, x in number.values(float(value)).items()
    }
    return scene.draft.curve(scene, scene.parameters, every)


def scenes_at(scene: Scene, optima: list[Optimal]) -> tuple[Scene, ...]:
    """The scenes of the curves of `optimise`, with the numbers chosen as if they had been given."""
    numbers = [number for key in optima[0].values if (number := number_of(scene, key)) is not None]
    free = scene
    for number in numbers:
        free = number.freed(free)
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
    """The scene whose curves are those at the optima."""
    curves = []
    for curve, found in zip(free.each_curve(), optima, strict=True):
        there = with_values(curve, numbers, np.array(list(found.values.values())))
        curves.append(replace(there, parameters={**curve.parameters, **found.values}, curves=(), draft=None))
    return replace(free, curves=tuple(curves))


def _with_error(found: Optimal, curve: Any) -> Optimal:
    """With the estimated error of the peaks that are greatest."""
    errors = [curve.peaks[dof].error for dof, _ in found.active]
    return replace(found, error=float(np.max(errors)) if errors else np.nan)


def _say_what_is_short(tracking: Tracking, response: Response, accuracy: float) -> None:
    """Of the accuracy that was asked for, where more harmonics would take too long or tell no more."""
    for one, curve in zip(tracking.optima, response.curves, strict=True):
        if curve.complete and not one.error <= accuracy:
            error = "cannot be told" if np.isnan(one.error) else f"is estimated as {one.error:.1e}"
            count = len(one.harmonics)
            many = f"{count} harmonic{'' if count == 1 else 's'}"
            curve.short_of = f"with {many} the error of the least peak {error}"


def _higher(tracking: Tracking, response: Response) -> list[str]:
    """What is wrong where a response has a higher peak than the ones that were followed."""
    said = []
    for found, curve in zip(tracking.optima, response.curves, strict=True):
        ends = (np.nanmin(curve.frequency), np.nanmax(curve.frequency)) if curve.points else (0.0, 0.0)
        for name in found.minimised:
            what, _, dof = name.partition(".")
            peak = curve.peaks[dof]
            inside = what == "greatest" or peak.frequency not in ends
            if inside and peak.amplitude > found.value * (1.0 + 10.0 * HIGHER):
                said.append(
                    f"at the optimum there is a higher {name}, {peak.amplitude:.6g}, than was followed"
                )
    return said
