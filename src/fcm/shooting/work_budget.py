"""Time limit of the search for starts of further branches."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, TypeVar

import numpy as np

from fcm.shooting.options import SHOOTING, ShootingOptions
from fcm.shooting.periodic_orbit import Poll

if TYPE_CHECKING:
    from fcm.branches.trace import Traced

Found = TypeVar("Found")


@dataclass
class UncertainFrequencies:
    """Frequencies [rad/s] at which the balance that gives starts of exact motions may lack branches.

    levels: where the curve in the level of the forces was not followed to its end; folds: where its folds
    were not.
    """

    levels: list[float] = field(default_factory=list)
    folds: list[float] = field(default_factory=list)

    def replace_with(self, found: Traced) -> None:
        """Replace the frequencies by those of a traced balance."""
        self.levels[:] = [one.omega for one in found.found if not one.complete]
        self.folds[:] = found.folds_lost


class BranchBudget:
    """Limit of the processor time of the search for starts of further branches.

    outside : poll that is always called; `poll` is to be called during the search.
    given_up : reasons why branches may be missing, empty if the search is complete.
    """

    def __init__(
        self,
        outside: Poll,
        most: float,
        options: ShootingOptions = SHOOTING,
        clock: Callable[[], float] = time.process_time,
    ) -> None:
        self.options, self.clock = options, clock
        self.outside, self.most, self.given_up = outside, most, list[str]()
        self._begin = self._ask = 0.0
        self._end, self._left = np.inf, most

    def poll(self) -> None:
        """Raise `WorkLimitError` if the search has used up its time."""
        from fcm.harmonic_balance.work_budget import WorkLimitError

        self.outside()
        if self._end < np.inf and time.monotonic() > self._ask:
            if self.clock() > self._end:
                raise WorkLimitError
            self._ask = time.monotonic() + self.options.search.poll_interval

    def each(self, finds: Iterator[Found]) -> Iterator[Found]:
        """Yield the results of a search; only the search itself uses up its time, not the caller."""
        from fcm.harmonic_balance.work_budget import WorkLimitError

        while True:
            self._begin = self.clock()
            self._end = self._begin + self._left
            try:
                found = next(finds, None)
            except WorkLimitError:
                self.add_reason(f"it takes more than {self.most:.3g} s")
                return
            self._left -= self.clock() - self._begin
            if found is None:
                return
            yield found

    def share(self, count: int) -> float:
        """Start the next of count searches, with an equal share [s] of the remaining time; return it."""
        found = self._left / count
        self._end = self._begin + found
        return found

    def add_reason(self, why: str) -> None:
        """Add a reason why the search is not complete."""
        self.given_up.append(f"the search for further branches was given up: {why}")
