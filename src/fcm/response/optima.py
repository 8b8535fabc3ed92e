"""The optima of all curves of a scene; what an earlier run has finished is not sought again."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import Any

from fcm.response.least_peak import Found, PeakTask
from fcm.results.tracked import Optimal, TrackedCurve
from fcm.run import Checkpoint, Progress, Results, fingerprint
from fcm.run.progress import part

KINDS = (Optimal, TrackedCurve)  # what is kept consists of these


def optima(
    tasks: list[PeakTask],
    harmonics: tuple[int, ...] | None,
    checkpoint: Checkpoint | None,
    progress: Progress | None,
) -> tuple[list[Found], bool]:
    """That of each task, all with the same harmonics; or those so far, and that it was interrupted.

    Raises
    ------
    KeyboardInterrupt
        If nothing is found then.
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
    checkpoint: Checkpoint | None,
    progress: Progress | None,
) -> Iterator[Found]:
    """That of each task, kept as soon as it is found; an optimum that is kept already is as it was."""
    kept = Results() if checkpoint is None else _kept(tasks, harmonics, checkpoint)
    for i, task in enumerate(tasks):
        if i not in kept.finished:
            shown = part(progress, i / len(tasks), (i + 1) / len(tasks))
            kept.add(i, [task.optimum(harmonics, shown)])
        yield kept.finished[i][0]


def _kept(tasks: list[PeakTask], harmonics: tuple[int, ...] | None, checkpoint: Checkpoint) -> Results:
    """What is finished of these tasks; they are known by all that decides their optima."""
    scenes = [replace(task.scene, name="", title="", curves=()) for task in tasks]
    mark = fingerprint(
        "optima", harmonics, [(task.numbers, task.accuracy, task.options) for task in tasks], scenes
    )
    return checkpoint.results(mark, KINDS, lambda i, found: _fits(tasks, i, found))


def _fits(tasks: list[PeakTask], number: int, results: Any) -> bool:
    """Whether results that were read from a file can be the optimum of the task with this number."""
    if not (0 <= number < len(tasks) and isinstance(results, list) and len(results) == 1):
        return False
    found = results[0]
    if not (isinstance(found, tuple) and len(found) == 2 and isinstance(found[1], list)):
        return False
    curves = all(isinstance(curve, TrackedCurve) for curve in found[1])
    return curves and isinstance(found[0], Optimal) and found[0].parameters == tasks[number].scene.parameters


def _with_the_same(tasks: list[PeakTask], found: list[Found], checkpoint: Checkpoint | None) -> list[Found]:
    """The optima with the same harmonics, as the curves of a response have: what any of them takes."""
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
