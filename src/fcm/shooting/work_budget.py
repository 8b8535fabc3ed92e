"""Time limit of the search for what leads to further branches."""

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
    """Frequencies [rad/s] at which the balance that exact motions begin near may lack branches.

    levels: where the level of the forces was not followed to its end; folds: from where its folds were not.
    """

    levels: list[float] = field(default_factory=list)
    folds: list[float] = field(default_factory=list)

    def replace_with(self, found: Traced) -> None:
        """Take the uncertain frequencies of a traced balance, in the place of others."""
        self.levels[:] = [one.omega for one in found.found if not one.complete]
        self.folds[:] = found.folds_lost


class BranchBudget:
    """Limit of the processor time of the search for what leads to further branches.

    outside : called now and then, all the while; `poll` is to be called while it is sought.
    given_up : why there may be more branches than those, empty if all was sought.
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
        """Raise `WorkLimitError` when the search has taken its time."""
        from fcm.harmonic_balance.work_budget import WorkLimitError

        self.outside()
        if self._end < np.inf and time.monotonic() > self._ask:
            if self.clock() > self._end:
                raise WorkLimitError
            self._ask = time.monotonic() + self.options.search.poll_interval

    def each(self, finds: Iterator[Found]) -> Iterator[Found]:
        """Results one after the other; what is done with them in between takes nothing of their time."""
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
        """An equal share [s] of the time that is left, for the next of so many searches."""
        found = self._left / count
        self._end = self._begin + found
        return found

    def add_reason(self, why: str) -> None:
        """Add a reason why the search is not complete."""
        self.given_up.append(f"the search for further branches was given up: {why}")
