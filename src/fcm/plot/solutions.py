"""The solutions of a curve at a frequency, a level or a modal amplitude; a folded curve has several."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from fcm.plot.errors import PlotError
from fcm.plot.read import FloatArray


class Solution(NamedTuple):
    """A point of a curve: one of its solutions at a place."""

    point: int
    number: int  # 1 for the solution of the greatest amplitude
    among: int  # how many solutions are there

    def __str__(self) -> str:
        """Which of several it is, as ``1 of 3``; empty if it is the only one."""
        return f"{self.number} of {self.among}" if self.among > 1 else ""


def solutions_at(
    along: FloatArray, place: float, amplitude: FloatArray, number: int | None = None
) -> list[Solution]:
    """The points of a curve nearest to a place within it, one for each solution, greatest amplitude first.

    along, amplitude: (point,). Each piece of the curve that passes the place gives its nearer end. A number
    selects one solution; PlotError if there are fewer.
    """
    start, end = along[:-1] - place, along[1:] - place
    passing = np.flatnonzero(start * end <= 0.0)
    nearer = np.unique(passing + (np.abs(end[passing]) < np.abs(start[passing])))
    if not nearer.size:  # a point alone, or beside a gap
        nearer = np.array([int(np.nanargmin(np.abs(along - place)))])
    ordered = nearer[np.argsort(-amplitude[nearer], kind="stable")].tolist()
    found = [Solution(k, i + 1, len(ordered)) for i, k in enumerate(ordered)]
    if number is None:
        return found
    if number > len(found):
        there = "1 solution" if len(found) == 1 else f"{len(found)} solutions"
        raise PlotError(f"--solution {number}: the curve has {there} at {place:.6g}")
    return [found[number - 1]]
