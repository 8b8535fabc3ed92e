"""Curves followed one after the other in this process, with the results left by an interruption."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

from fcm.response.curve_batches import KINDS, fits
from fcm.results.cause import Cause
from fcm.results.result import INTERRUPTED, Curve
from fcm.run import IN_THIS_PROCESS, Execution, Progress, Results


class Tell:
    """Reports the progress of one of the curves; the report may raise an interruption.

    The number of repetitions of a curve is unknown. So each one takes half of its remaining progress.
    """

    def __init__(self, progress: Progress | None, number: int, count: int) -> None:
        self.progress, self.number, self.count = progress, number, count
        self.text, self.left, self.done = "", 1.0, 0.0

    def __call__(self, text: str) -> None:
        """Report what is followed now; empty at the start."""
        self.left *= 0.5 if text else 1.0
        self.text = text
        self.covered(0.0)

    def covered(self, share: float) -> None:
        """Report the share of its span that the curve has covered."""
        self.done = max(self.done, 1.0 - self.left * (1.0 - 0.5 * min(share, 1.0)))
        if self.progress is not None:
            of = f"{self.number} of {self.count} curves{', ' if self.text else ''}{self.text}"
            self.progress((self.number + self.done) / self.count, of)


Task = tuple[Curve, Callable[[Tell], Curve]]  # the curve without points, and the function that follows it


def one_by_one(
    tasks: Sequence[Task], execution: Execution = IN_THIS_PROCESS, mark: bytes = b""
) -> list[Curve]:
    """The curves of all tasks; those that an interruption leaves out are the tasks' curves without points.

    The checkpoint keeps finished curves, which are not followed again.

    mark : digest of all that decides the results.

    Raises
    ------
    KeyboardInterrupt
        If no curve is finished.
    """
    with execution.checkpoint() as checkpoint:
        kept = Results()
        if checkpoint is not None:
            kept = checkpoint.results(mark, KINDS, lambda i, found: _fit(tasks, i, found))
        curves = _followed(tasks, execution.progress, kept)
        if not _cut_off(curves[-1]):
            execution.discard(checkpoint)
    return curves


def _followed(tasks: Sequence[Task], progress: Progress | None, kept: Results) -> list[Curve]:
    curves: list[Curve] = []
    for i, (none, followed) in enumerate(tasks):
        if curves and _cut_off(curves[-1]):
            curves.append(none)
            continue
        if i in kept.finished:
            curves += kept.finished[i]
            continue
        tell = Tell(progress, i, len(tasks))
        try:
            tell("")
            curves.append(followed(tell))
            if not _cut_off(curves[-1]):
                kept.add(i, [curves[-1]])
        except KeyboardInterrupt:
            if not curves:
                raise
            if len(curves) == i:
                curves.append(replace(none, reason=f"{INTERRUPTED} at the start", cause=Cause.INTERRUPTED))
    return curves


def _cut_off(curve: Curve) -> bool:
    """Whether an interruption has cut a curve off."""
    return not curve.complete and curve.cause is Cause.INTERRUPTED


def _fit(tasks: Sequence[Task], number: int, results: object) -> bool:
    """Whether results read from a file can be the curve of the task with this number."""
    if not 0 <= number < len(tasks) or not isinstance(results, list) or len(results) != 1:
        return False
    return fits(tasks[number][0], results[0])
