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

    def condense(self, row: FloatArray, matrix: FloatArray) -> int:
        self.inner.condense(row, matrix)
        return 0

    def shorten(self, right: FloatArray, out: FloatArray) -> int:
        self.inner.shorten(right, out)
        return 0

    def lengthen(self, reduced: FloatArray, out: FloatArray) -> int:
        self.inner.lengthen(reduced, out)
        return 0
