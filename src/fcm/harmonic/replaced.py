"""Equations made of those of a balance, for the same unknowns."""

from __future__ import annotations

from fcm.continuation.problem import Problem
from fcm.harmonic.balance import Balance
from fcm.scene.model import FloatArray


class Replaced(Problem):
    """A problem whose Newton steps are condensed as those of a balance, `inner`, as it was evaluated last."""

    def __init__(self, inner: Balance, margins: int = 0, outputs: int = 0) -> None:
        Problem.__init__(self, inner.unknowns, margins, outputs, inner.rank)
        self.inner = inner

    def factor(self, row: FloatArray, scale: FloatArray) -> float:
        return float(self.inner.factor(row, scale))

    def solve(self, right: FloatArray) -> int:
        return int(self.inner.solve(right))
