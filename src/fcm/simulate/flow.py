"""The exact motion y' = A y of one combination of contact states, without a decomposition of A.

Over a step h = 1 / rate the exponential's series is complete to rounding after `ORDER` terms, whatever A
is: defective, singular, resonant without damping. Whole steps are powers of exp(A h). The functions
that end the combination are known on all steps at once from a table of their rows times those powers.
Positions are counted in steps.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from fcm.scene.model import FloatArray

ORDER = 19  # 1 / 20! is below rounding
SHORTEST, LONGEST = 16, 256  # steps that are looked at together
BoolArray = npt.NDArray[np.bool_]


class Flow:
    """Motion in one combination of states; rows g of y are its exits.

    Parameters
    ----------
    matrix : (d, d)
    rate : float
        Bound of the rates of the motion [1/s].
    rows : (exit, d)
        Functions g = rows @ y that are positive while the combination lasts.
    owners : list of (contact, state)
        For each row the contact that it belongs to, and the state to which it leads.
    """

    def __init__(
        self, matrix: FloatArray, rate: float, rows: FloatArray, owners: list[tuple[int, str]]
    ) -> None:
        self.matrix, self.rows, self.owners = matrix, rows, owners
        self.step = 1.0 / rate
        self.series = _series(matrix * self.step)  # (ORDER + 1, d, d), term j belongs to position**j
        self.exits = rows @ self.series  # (ORDER + 1, exit, d)
        self.rounding = np.abs(self.exits)
        self._sizes = np.abs(self.series[:3]).sum(axis=0)
        self._powers = [self.series[::-1].sum(axis=0)]  # exp(A h) to the power 2**j
        watched = (self.exits[0], self.exits[1], 24.0 * self.exits[4])  # g, g' h, g'''' h**4
        self._table = np.stack(watched).reshape(1, 3 * len(owners), matrix.shape[0])

    def power(self, j: int) -> FloatArray:
        """exp(A h 2**j), (d, d)."""
        while len(self._powers) <= j:
            self._powers.append(self._powers[-1] @ self._powers[-1])
        power: FloatArray = self._powers[j]
        return power

    def advance(self, y: FloatArray, steps: int) -> FloatArray:
        """The state, or states as columns, after whole steps."""
        j = 0
        while steps >> j:
            if steps >> j & 1:
                y = self.power(j) @ y
            j += 1
        return y

    def within(self, y: FloatArray, position: float) -> FloatArray:
        """The state, or states as columns, at a position in [0, 1] of a step."""
        powers = position ** np.arange(ORDER + 1.0)
        if y.ndim == 1:
            inside: FloatArray = powers @ (self.series @ y)
            return inside
        return self.matrix_within(position) @ y

    def matrix_within(self, position: float) -> FloatArray:
        """exp(A h position), (d, d), for a position in [0, 1]."""
        powers = position ** np.arange(ORDER + 1.0)
        matrix: FloatArray = np.tensordot(powers, self.series, axes=1)
        return matrix

    def at(self, y: FloatArray, position: float) -> FloatArray:
        """The state, or states as columns, at any position >= 0."""
        whole = int(position)
        return self.within(self.advance(y, whole), position - whole)

    def terms(self, y: FloatArray) -> FloatArray:
        """The size of the terms from which each component of y is summed over a step."""
        size: FloatArray = self._sizes @ np.abs(y)
        return size

    def grid(self, y: FloatArray, steps: int) -> FloatArray:
        """The states at positions 0, 1, ..., steps - 1: (steps, d)."""
        states, j = y[None], 0
        while states.shape[0] < steps:
            states, j = np.concatenate((states, states @ self.power(j).T)), j + 1
        return states[:steps]

    def watch(self, y: FloatArray, steps: int) -> FloatArray:
        """g, g' h and g'''' h**4 of the exits at positions 0 to steps: (steps + 1, 3, exit)."""
        while self._table.shape[0] <= steps:
            j = self._table.shape[0].bit_length() - 1
            self._table = np.concatenate((self._table, self._table @ self.power(j)))
        return (self._table[: steps + 1] @ y).reshape(steps + 1, 3, -1)


def _series(a: FloatArray) -> FloatArray:
    """a**j / j! for j = 0 ... ORDER."""
    terms = np.empty((ORDER + 1, *a.shape))
    terms[0] = np.eye(a.shape[0])
    for j in range(1, ORDER + 1):
        terms[j] = terms[j - 1] @ a / j
    return terms
