"""The best curve that there is while more harmonics are looked for, and what is said of it."""

from __future__ import annotations

import math
import time
from collections.abc import Callable

from fcm.accuracy.unchecked_response import UncheckedResponse
from fcm.continuation.follow import Progress
from fcm.model.scene import FloatArray
from fcm.response.options import SWEEP
from fcm.results.result import INTERRUPTED
from fcm.scene.errors import counted

Tell = Callable[[str], None]  # what there is, and what is at work


class BestSoFar:
    """The best response that was traced until now; receives each, as `fcm.accuracy.refinement.OnTraced`.

    found is the last, and stable (path,) whether each of its points is, once that is known.

    How often all is traced again nobody knows. So each response takes half of what is left of the progress,
    and half of that while it is traced. Of what comes then it is taken that it lasts as long as all before.
    """

    def __init__(self, tell: Tell | None, progress: Progress | None = None) -> None:
        self.tell, self.error, self.next = tell, math.nan, 0
        self.progress, self.left, self.told, self.share = progress, 1.0, 0.0, 0.0
        self.begun = self.since = self.shown = time.monotonic()
        self.found: UncheckedResponse | None = None
        self.cut = False  # whether that does not come to its end
        self.stable: list[FloatArray] = []

    def __call__(self, found: UncheckedResponse, error: float, more: tuple[int, ...]) -> None:
        self.found, self.error, self.next, self.stable = found, error, len(more), []
        self.left *= 0.5
        self.covered(0.0)
        if more:
            self.tell_work(counted(len(more), "harmonic"))

    def tell_work(self, at_work: str) -> None:
        """Tell what there is, and what is at work."""
        if self.tell is not None:
            there = f"{self._harmonics_reached()}; " if self.found is not None else ""
            self.tell(f"{there}now {at_work}")

    def covered(self, share: float) -> None:
        """Show that the response being traced has come to a share of the range of frequencies."""
        self.told, self.since = 1.0 - self.left * (1.0 - 0.5 * min(share, 1.0)), time.monotonic()
        self._show(self.told)

    def poll(self) -> None:
        """Move the progress, also where nobody tells what share is done; called now and then."""
        now = time.monotonic()
        if now - self.shown >= SWEEP.progress_interval:
            spent, before = now - self.since, self.since - self.begun
            end = 1.0 - 0.5 * self.left
            self._show(self.told + (end - self.told) * spent / (spent + before))

    def _show(self, share: float) -> None:
        if self.progress is not None:
            self.shown, self.share = time.monotonic(), max(self.share, share)
            self.progress(self.share)

    def take_stability(self, found: UncheckedResponse, stable: list[FloatArray]) -> None:
        """Take the stability of the response found, which more harmonics may still confirm."""
        self.found, self.stable = found, stable

    def take_part(self, found: UncheckedResponse) -> None:
        """Take a response that was interrupted, if there is no other."""
        if self.found is None:
            self.found, self.cut = found, True

    def _harmonics_reached(self) -> str:
        assert self.found is not None
        has = counted(len(self.found.system.harmonics), "harmonic")
        return f"{has}, {'error not estimated yet' if math.isnan(self.error) else f'error {self.error:.1e}'}"

    def reason(self) -> str:
        """Reason why the curve is not complete, and what is missing."""
        unknown = " before its stability was confirmed" if self.stable else " before its stability was known"
        missing = f" before it was traced with {self.next}" if self.next else unknown
        missing = " before it came to its end" if self.cut else missing
        lacks = "not confirmed by more harmonics" if self.stable else "missing"
        part, reached = "the part up to there" if self.cut else "the curve", self._harmonics_reached()
        return f"{INTERRUPTED}{missing}: this is {part} with {reached}; its stability is {lacks}"
