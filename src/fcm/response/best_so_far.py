"""The best curve so far while more harmonics are tried, and messages about it."""

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

Tell = Callable[[str], None]  # receives the state and the present task


class BestSoFar:
    """The best response traced so far; receives each one, as `fcm.accuracy.refinement.OnTraced`.

    found is the last response. stable has the stability of its points for each path, once it is known.

    The number of repetitions is unknown. So each response takes half of the remaining progress, one half of
    that while it is traced. The checks after it are assumed to take as long as everything before.
    """

    def __init__(self, tell: Tell | None, progress: Progress | None = None) -> None:
        self.tell, self.error, self.next = tell, math.nan, 0
        self.progress, self.left, self.told, self.share = progress, 1.0, 0.0, 0.0
        self.begun = self.since = self.shown = time.monotonic()
        self.found: UncheckedResponse | None = None
        self.cut = False  # whether found is interrupted before its end
        self.stable: list[FloatArray] = []

    def __call__(self, found: UncheckedResponse, error: float, more: tuple[int, ...]) -> None:
        self.found, self.error, self.next, self.stable = found, error, len(more), []
        self.left *= 0.5
        self.covered(0.0)
        if more:
            self.tell_work(counted(len(more), "harmonic"))

    def tell_work(self, at_work: str) -> None:
        """Report the state and the present task."""
        if self.tell is not None:
            there = f"{self._harmonics_reached()}; " if self.found is not None else ""
            self.tell(f"{there}now {at_work}")

    def covered(self, share: float) -> None:
        """Show the share of the frequency range that the present response has covered."""
        self.told, self.since = 1.0 - self.left * (1.0 - 0.5 * min(share, 1.0)), time.monotonic()
        self._show(self.told)

    def poll(self) -> None:
        """Advance the progress where no share is reported; called regularly."""
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
        """Store a response with its stability, which more harmonics may still confirm."""
        self.found, self.stable = found, stable

    def take_part(self, found: UncheckedResponse) -> None:
        """Store an interrupted response, if there is no other."""
        if self.found is None:
            self.found, self.cut = found, True

    def _harmonics_reached(self) -> str:
        assert self.found is not None
        has = counted(len(self.found.system.harmonics), "harmonic")
        return f"{has}, {'error not estimated yet' if math.isnan(self.error) else f'error {self.error:.1e}'}"

    def reason(self) -> str:
        """Sentence on why the curve is incomplete, and on what is missing."""
        unknown = " before its stability was confirmed" if self.stable else " before its stability was known"
        missing = f" before it was traced with {self.next}" if self.next else unknown
        missing = " before it came to its end" if self.cut else missing
        lacks = "not confirmed by more harmonics" if self.stable else "missing"
        part, reached = "the part up to there" if self.cut else "the curve", self._harmonics_reached()
        return f"{INTERRUPTED}{missing}: this is {part} with {reached}; its stability is {lacks}"
