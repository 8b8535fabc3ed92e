"""How much following the partners of a response may take."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from fcm.accuracy.options import PAIR, PairOptions
from fcm.harmonic_balance.work_budget import Work


@dataclass
class Budget:
    """Seconds of work that are left, as of `harmonic_balance.cost_model`: those who follow take from it."""

    left: float = PAIR.seconds

    @classmethod
    def of(cls, work: Work, options: PairOptions, part: float = 1.0) -> Budget:
        """In proportion to the work that the response itself took, so that its error never takes much more;
        for a part of it the same part.

        >>> from fcm.harmonic_balance.work_budget import Work
        >>> work = Work()
        >>> work.take(1.0)
        >>> Budget.of(work, PairOptions(part=0.3, unnoticed=0.1)).left
        0.3
        """
        return cls(part * min(max(options.part * work.seconds, options.unnoticed), options.seconds))

    @classmethod
    def elsewhere(cls, work: Work, options: PairOptions, part: float = 1.0) -> Budget:
        """The same for what the partners have elsewhere."""
        most = max(options.elsewhere * work.seconds, options.unnoticed_elsewhere)
        return cls(part * min(most, options.seconds_elsewhere))

    def shares(self, count: int) -> Iterator[Budget]:
        """One after the other for so many: what one leaves is for the others, too."""
        for number in range(count):
            share = self.left / (count - number)
            one = Budget(share)
            yield one
            self.left -= share - one.left


def share_of(evaluations: Sequence[int], first: int) -> float:
    """Part of the evaluations that following all paths took, of the paths from the first on.

    >>> share_of([300, 60, 40], 1)
    0.25
    """
    return sum(evaluations[first:]) / max(sum(evaluations), 1)
