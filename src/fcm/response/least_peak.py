"""Search for the numbers with the least peak of a scene, and for the harmonics that its accuracy needs."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import partial

import numpy as np

from fcm.accuracy.refinement import enlarged, every_branch, with_errors
from fcm.at_rest import at_rest
from fcm.harmonic_balance.cost_model import seconds_of_curve
from fcm.harmonic_balance.system import System
from fcm.model.scene import FloatArray, Scene
from fcm.response.options import RESPONSE, ResponseOptions
from fcm.response.request import Request, ResponseError
from fcm.response.tracking_task import as_curve
from fcm.results.tracked import Optimal, TrackedCurve
from fcm.run import Progress
from fcm.run.progress import part
from fcm.scene.draft import Number
from fcm.scene.errors import counted
from fcm.tracking.ending_peak import EndingPeak, ending_peak, leaves_range
from fcm.tracking.kept_steps import KeptSteps
from fcm.tracking.lowest_peak import LowestPeak, LowestPeakSearch
from fcm.tracking.minimax import PeakEnvelope, descend
from fcm.tracking.parameter_line import line_along
from fcm.tracking.peak_envelope import INCOMPLETE, EnvelopeMinimum, Target, spans_beside_flat
from fcm.tracking.stability import stability_along
from fcm.tracking.trials import by_trials, error_of_higher
from fcm.tracking.user_points import values_at_height, with_user_points

Found = tuple[Optimal, list[TrackedCurve]]  # an optimum, and the curves of peaks that contain it


def with_values(scene: Scene, numbers: list[Number], values: FloatArray) -> Scene:
    """The scene (of one curve) with values of some numbers."""
    assert scene.draft is not None
    every = {
        a: x
        for number, value in zip(numbers, values, strict=True)
        for a, x in number.values(float(value)).items()
    }
    return scene.draft.curve(scene, scene.parameters, every)


class PeakTask:
    """The task of finding the least peak of one scene (of one curve)."""

    def __init__(
        self, scene: Scene, numbers: list[Number], accuracy: float, options: ResponseOptions = RESPONSE
    ) -> None:
        assert scene.optimum is not None
        self.scene, self.numbers, self.accuracy, self.options = scene, numbers, accuracy, options
        self.bounds = np.array(scene.optimum.bounds)
        dofs = scene.modal.dofs
        self.targets = [Target(dofs.index(aim.dof), aim.ends) for aim in scene.optimum.minimise]
        self.seeking: LowestPeakSearch | PeakEnvelope | None = None  # the present search
        self.fewer: Optimal | None = None  # the optimum found with fewer harmonics
        self.steps = KeptSteps()  # saved steps of the search

    def system(self, scene: Scene, harmonics: tuple[int, ...]) -> System:
        """The balance of a scene."""
        return Request(harmonics, options=self.options).system(scene)

    def with_values(self, values: FloatArray) -> Scene:
        """The scene with values of the numbers."""
        return with_values(self.scene, self.numbers, values)

    def optimum(self, harmonics: tuple[int, ...] | None, progress: Progress | None) -> Found:
        """The optimum with given harmonics, or with those that the accuracy needs at the optimum."""
        return _optimum(self, harmonics, progress)

    def needed(self, found: Optimal, harmonics: tuple[int, ...]) -> tuple[int, ...]:
        """The harmonics that the accuracy needs at an optimum; they include the given ones."""
        most = self.options.balance.work.max_seconds_repeated
        return _harmonics_for_peaks(self, found.values, harmonics, most)[0]

    def least_traced(self) -> Optimal | None:
        """The least peak that an interrupted search has traced; None if it has traced none."""
        found = None if self.seeking is None else self.seeking.least_traced()
        if self.seeking is None or found is None:
            return None if self.fewer is None else replace(self.fewer, kind=INCOMPLETE)
        return replace(_optimal(self, *found, self.seeking.system.harmonics), fewer=self.fewer)


def _optimum(task: PeakTask, harmonics: tuple[int, ...] | None, progress: Progress | None) -> Found:
    """The optimum with given harmonics, or with those that the accuracy needs at the optimum."""
    rounds = task.options.optimum.max_rounds
    chosen, seconds = harmonics or (1,), task.options.balance.work.max_seconds_repeated
    known: LowestPeak | None = None
    task.fewer = None
    for i in range(rounds):
        shown = part(progress, i / rounds, (i + 1) / rounds)
        if len(task.numbers) == 1:
            search, known = _least_on_line(task, chosen, known, shown)
            if not known.checked:
                known = replace(known, best=by_trials(search))
            found = _on_line(task, known, chosen)
            if not known.checked and known.best is not None:
                found = _with_error_of_higher(task, search, known.best, found)
        else:
            found = _downhill(task, chosen, shown)
        if harmonics:
            break
        more, taken = task.steps(
            f"{chosen} harmonics at {found[0].values}",
            tuple,
            partial(_harmonics_for_peaks, task, found[0].values, chosen, seconds),
        )
        if more == chosen and not found[0].end_error <= task.accuracy:
            more, taken = task.steps(
                f"{chosen} harmonics at {found[0].beside}",
                tuple,
                partial(
                    _harmonics_for_peaks, task, found[0].beside, chosen, seconds - taken, found[0].end_error
                ),
            )
        if more == chosen:
            break
        chosen, seconds, task.fewer = more, seconds - taken, found[0]
    return replace(found[0], fewer=task.fewer), found[1]


def _least_on_line(
    task: PeakTask, harmonics: tuple[int, ...], known: LowestPeak | None, progress: Progress | None
) -> tuple[LowestPeakSearch, LowestPeak]:
    """The least peak over the bounds of one number, and its search.

    Where the peak is flat over most of the range, the rest is searched separately. If the peak is lower
    there, the bounds of the task are narrowed to this part.
    """
    task.seeking = search = _search(task, harmonics)
    found, bounds = search.run(known, _sharing(task, harmonics, progress)), task.bounds
    for span in spans_beside_flat(search.setup, found.best):
        task.bounds = np.array([span])
        task.seeking = narrow = _search(task, harmonics)
        lowest = narrow.run(None, _sharing(task, harmonics, progress))
        if found.best and lowest.best and lowest.best.kind != "flat" and lowest.best.value < found.best.value:
            search, found, bounds = narrow, lowest, task.bounds
    task.bounds, task.seeking = bounds, search
    return search, found


class _Moving:
    """Progress of a search: the share that it reports, advanced by its work since then.

    The amount of work is unknown. The work of one curve advances the progress by a quarter of the rest.
    """

    def __init__(self, task: PeakTask, harmonics: tuple[int, ...], progress: Progress) -> None:
        self.task, self.progress, self.share = task, progress, 0.0
        self.text = f"optimum with {counted(len(harmonics), 'harmonic')}"
        self.begin, self.usual = 0.0, seconds_of_curve(task.scene, len(harmonics))

    def __call__(self, share: float) -> None:
        self.share, self.begin = share, self._seconds()
        self.poll()

    def poll(self) -> None:
        """Show the progress; called regularly during the work."""
        work = self._seconds() - self.begin
        ahead = (1.0 - self.share) * work / (work + self.usual) / 2.0
        count = 0 if self.task.seeking is None else self.task.seeking.responses
        traced = f": {counted(count, 'response')} traced" if count else ""
        self.progress(self.share + ahead, f"{self.text}{traced}")

    def _seconds(self) -> float:
        return 0.0 if self.task.seeking is None else self.task.seeking.system.work.seconds


def _sharing(
    task: PeakTask, harmonics: tuple[int, ...], progress: Progress | None
) -> Callable[[float], None] | None:
    """The progress of the search of a task, advanced by its work; None without one."""
    if progress is None or task.seeking is None:
        return None
    moving = _Moving(task, harmonics, progress)
    task.seeking.system.work.poll = moving.poll
    return moving


def _with_error_of_higher(
    task: PeakTask, search: LowestPeakSearch, best: EnvelopeMinimum, found: Found
) -> Found:
    """Add the greatest error of the higher peaks beside an optimum by trials, and the number with it."""
    error, s = task.steps(
        f"{search.system.harmonics} higher beside {best.s!r}", tuple, partial(error_of_higher, search, best)
    )
    (number,) = task.numbers
    return replace(found[0], end_error=error, beside={number.key: s}), found[1]


def _harmonics_for_peaks(
    task: PeakTask,
    values: Mapping[str, float],
    harmonics: tuple[int, ...],
    seconds: float,
    error: float = 0.0,
) -> tuple[tuple[int, ...], float]:
    """The harmonics that the accuracy of the minimised peaks needs at values, and the seconds that they take.

    They include the given harmonics, and no more than a response can be followed with in `seconds`. error:
    error of a peak there that the response alone may not reach.
    """
    scene, taken = task.with_values(np.array(list(values.values()))), 0.0
    dofs = [target.dof for target in task.targets]
    while True:
        there = with_errors(every_branch(task.system(scene, harmonics)), task.accuracy)
        height = np.max([one.amplitude.max(axis=0) for one in there.quantities], axis=0, initial=0.0)[dofs]
        worst = float(
            there.peak[dofs][height > task.options.optimum.min_height * height.max()].max(initial=0.0)
        )
        worst, error = max(worst, error, key=lambda one: np.inf if np.isnan(one) else one), 0.0
        there = replace(there, max_error=worst)
        if worst <= task.accuracy:
            return harmonics, taken
        more = enlarged(there, task.accuracy, seconds - taken)
        if more == harmonics:
            return harmonics, taken
        harmonics, taken = more, taken + there.seconds_with(more)


def _search(task: PeakTask, harmonics: tuple[int, ...]) -> LowestPeakSearch:
    (number,), span = task.numbers, (float(task.bounds[0, 0]), float(task.bounds[0, 1]))
    system, options = task.system(task.scene, harmonics), task.options.optimum.search
    return LowestPeakSearch(system, line_along(number), span, task.targets, options, task.steps)


def _on_line(task: PeakTask, found: LowestPeak, harmonics: tuple[int, ...]) -> Found:
    """Convert the least peak over one number to an optimum, with the curves of the peaks."""
    if found.best is None:
        raise ResponseError(_no_peak(task))
    setup = _search(task, harmonics).setup
    best, limit = found.best.s, (1.0 + task.options.optimum.nearly) * found.best.value
    told = [best, *values_at_height(setup, found.curves, task.targets, limit)]
    followed = [with_user_points(setup, one, told) for one in found.curves]
    curves = [as_curve(task.scene, setup, *stability_along(setup, one)) for one in followed]
    optimal = _optimal(task, np.array([found.best.s]), found.best, harmonics)
    if found.best.kind == "corner":
        return replace(optimal, leaves_range=leaves_range(found.curves, found.best)), curves
    if found.best.kind != "end":
        return optimal, curves
    end = task.steps(
        f"{harmonics} end at {found.best.s!r}",
        EndingPeak,
        partial(ending_peak, setup, found.curves, found.best),
    )
    (number,) = task.numbers
    beside = {number.key: end.beside}
    return replace(optimal, end_error=end.error, beside=beside, leaves_range=end.leaves_range), curves


def _downhill(task: PeakTask, harmonics: tuple[int, ...], progress: Progress | None) -> Found:
    """The optimum of several numbers, starting from the one found with fewer harmonics."""
    task.seeking = valley = PeakEnvelope(
        task.system(task.scene, harmonics), task.numbers, task.bounds, task.targets, steps=task.steps
    )
    start = None if task.fewer is None else np.array(list(task.fewer.values.values()))
    found = descend(valley, start, _sharing(task, harmonics, progress))
    if found is None:
        raise ResponseError(_no_peak(task))
    return _optimal(task, found[0], found[1], harmonics), []


def _no_peak(task: PeakTask) -> str:
    each = [target.dof for target in task.targets]
    dofs = " and ".join(task.scene.modal.dofs[dof] for dof in each)
    branches = every_branch(task.system(task.with_values(task.bounds[:, 0]), (1,))).quantities
    height = np.max([one.amplitude.max(axis=0, initial=0.0) for one in branches], axis=0, initial=0.0)
    if height.size and at_rest(height)[each].all():
        return f"optimum: {still(dofs, len(each))}"
    have = "has" if len(each) == 1 else "have"
    why = f"{dofs} {have} no peak inside the range of frequencies at the bounds and amid them"
    return f"optimum: {why}; minimise greatest.NAME, widen the range, or give narrower bounds"


def still(dofs: str, count: int) -> str:
    """Sentence on degrees of freedom that do not move but for rounding.

    >>> still("8y", 1)
    '8y does not move, but for rounding: no force reaches it. Minimise another degree of freedom'
    """
    verb, which = ("does", "it") if count == 1 else ("do", "them")
    why = f"{dofs} {verb} not move, but for rounding: no force reaches {which}"
    return f"{why}. Minimise another degree of freedom"


def _optimal(
    task: PeakTask, values: FloatArray, best: EnvelopeMinimum, harmonics: tuple[int, ...]
) -> Optimal:
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
        between=best.between,
        tried=best.tried,
        flat={task.numbers[k].key: (low, high) for k, low, high in best.flat},
        harmonics=harmonics,
    )
