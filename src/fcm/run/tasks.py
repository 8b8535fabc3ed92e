"""Compute one batch: a failure loses only its item, and an interruption returns the finished part."""

from __future__ import annotations

import traceback
from collections.abc import Callable, Sequence
from typing import Any

from fcm.frozen import Frozen
from fcm.signals import interrupted

Progress = Callable[[float, str], None]  # finished fraction and a text
Batch = Sequence[Any]


class Report:
    """Progress report of a running computation, and its states from which it can go on.

    ``saved`` are the states that the computation saved before an interruption, in order. It may continue from
    them, to the same result, or ignore them.
    """

    def __init__(
        self, show: Progress, saved: Sequence[Any] = (), save: Callable[[Any], None] | None = None
    ) -> None:
        self.show, self.saved, self._save = show, saved, save
        self._said, self._steps = (0.0, ""), 0

    def __call__(self, fraction: float, text: str) -> None:
        """Reports the finished fraction; raises an interruption, if there is one."""
        self._said, self._steps = (fraction, text), 0
        self.show(fraction, text)

    def begins(self, text: str) -> None:
        """Name the stage that the next steps belong to."""
        self._said, self._steps = (self._said[0], text), 0

    def again(self) -> None:
        """Report a further step at the same fraction, to show that a long stage goes on."""
        self._steps += 1
        fraction, text = self._said
        self.show(fraction, f"{text}, step {self._steps}" if text else f"step {self._steps}")

    def save(self, state: Any) -> None:
        """Save a state, in addition to earlier ones."""
        if self._save is not None:
            self._save(state)


Compute = Callable[[Batch, Report], list[Any]]  # one result for each item of a batch


class Interrupted(KeyboardInterrupt):
    """Raised by a `Compute` that was interrupted and has a part of its results."""

    def __init__(self, results: list[Any]) -> None:
        super().__init__()
        self.results = results


class Lost(Frozen):
    """Stands for a result that could not be computed, with the reason."""

    reason: str
    defect: str = ""  # the traceback, if the reason is a defect of the program


class Attempt(Frozen):
    """Outcome of computing a batch."""

    results: list[Any]
    interrupted: bool = False  # then the results are a part, or empty


def attempt(compute: Compute, batch: Batch, report: Report) -> Attempt:
    """Compute a batch; if that fails, compute each item alone, and mark those that fail as `Lost`."""
    try:
        return Attempt(compute(batch, report))
    except Interrupted as stopped:
        return Attempt(stopped.results, interrupted=True)
    except KeyboardInterrupt:
        return Attempt([], interrupted=True)
    except Exception as error:
        if interrupted(error):
            return Attempt([], interrupted=True)
        if len(batch) == 1:
            return Attempt([_lost(error)])
    alone: list[Any] = []
    for item in batch:
        one = attempt(compute, (item,), Report(report.show))
        if one.interrupted:
            return Attempt([], interrupted=True)
        alone += one.results
    return Attempt(alone)


def _lost(error: Exception) -> Lost:
    what = f"{type(error).__name__}: {error}"
    if isinstance(error, MemoryError):
        return Lost(what)
    return Lost(what, "".join(traceback.format_exception(error)))
