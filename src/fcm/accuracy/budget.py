"""Budgets of work (in seconds) for following the references of a response."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from fcm.accuracy.options import PAIR, PairOptions
from fcm.harmonic_balance.work_budget import WorkCount


@dataclass
class Budget:
    """Seconds of work left, counted as in `harmonic_balance.cost_model`; each user deducts its own work."""

    seconds: float = PAIR.max_seconds

    @classmethod
    def of(cls, work: WorkCount, options: PairOptions, part: float = 1.0) -> Budget:
        """The budget for the errors of a response, in proportion to the work that the response itself took.

        The error estimate then never takes much more than the response; `part` scales the budget for a part
        of it.

        >>> from fcm.harmonic_balance.work_budget import WorkCount
        >>> work = WorkCount()
        >>> work.add(1.0)
        >>> Budget.of(work, PairOptions(work_fraction=0.3, min_seconds=0.1)).seconds
        0.3
        >>> Budget.of(work, PairOptions(work_fraction=2.0, max_seconds=0.5, long_fraction=0.8)).seconds
        0.8
        """
        most = max(options.max_seconds, options.long_fraction * work.seconds)
        return cls(part * min(max(options.work_fraction * work.seconds, options.min_seconds), most))

    @classmethod
    def elsewhere(cls, work: WorkCount, options: PairOptions, part: float = 1.0) -> Budget:
        """The budget for following references away from the curve, relative to the response's work."""
        most = max(options.work_fraction_elsewhere * work.seconds, options.min_seconds_elsewhere)
        return cls(part * min(most, options.max_seconds_elsewhere))

    def shares(self, count: int) -> Iterator[Budget]:
        """Yield one budget after another for `count` users; what one leaves goes to those after it."""
        for number in range(count):
            share = self.seconds / (count - number)
            one = Budget(share)
            yield one
            self.seconds -= share - one.seconds


def share_of(evaluations: Sequence[int], first: int) -> float:
    """Fraction of all evaluations spent on the paths from number `first` on.

    >>> share_of([300, 60, 40], 1)
    0.25
    """
    return sum(evaluations[first:]) / max(sum(evaluations), 1)
