r"""Folds of the force level, followed as curves in (frequency, level).

At a fixed frequency the force level turns back at folds. As the frequency varies, they form curves on which
the test function g of `surface` is zero. Such a curve is followed by predictor and corrector on the surface
of all solutions: the next place is the zero of g on an arc of a circle ahead. See Allgower and Georg,
"Introduction to Numerical Continuation Methods", SIAM 2003, and Rheinboldt, Numer. Math. 53 (1988) 165, for
the local axes of a surface. Only the sign of g counts, so that no second derivatives are needed. A fold in a
corner of the solutions, where g jumps, is followed like any other.

Cusps, where two folds meet, are ordinary places of such a curve. Where two curves touch on the surface, and
the strip between them vanishes, the curve turns back along the other side of the strip. Places are located to
a small part of the width of such a strip, and steps are short beside wider ones, so that the curve does not
jump to another.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from fcm.branches.options import FOLDS, FoldOptions
from fcm.branches.surface import FoldCurveEnding, FoldSteps, Point, Surface
from fcm.frozen import Frozen
from fcm.model.scene import FloatArray


class Folds(Frozen):
    """Folds along a curve, in order.

    z (point, n + 2): displacements, frequency [rad/s], level; singular (point, n + 2): the direction in which
    the displacements alone change, in the units of z.
    """

    z: FloatArray
    singular: FloatArray
    endings: tuple[FoldCurveEnding, FoldCurveEnding]

    @property
    def frequency(self) -> FloatArray:
        """Frequency [rad/s] of each fold (point,)."""
        return self.z[:, -2]

    @property
    def level(self) -> FloatArray:
        """Level of the forces at each fold (point,)."""
        return self.z[:, -1]

    @property
    def lost(self) -> list[float]:
        """Frequencies [rad/s] of the ends at which the curve was lost; none if it is closed.

        An end that comes back to the start is lost, too, if the other end leaves the range or levels: it has
        jumped to another curve.
        """
        open_ends = {FoldCurveEnding.RANGE, FoldCurveEnding.LEVEL} & set(self.endings)
        if FoldCurveEnding.CLOSED in self.endings and not open_ends:
            return []
        short = (FoldCurveEnding.STALLED, FoldCurveEnding.LONG, FoldCurveEnding.CLOSED)
        ends = zip(self.endings, self.frequency[[0, -1]].tolist(), strict=True)
        return [omega for ending, omega in ends if ending in short]


def folds_from(
    surface: Surface,
    start: FloatArray,
    across: Sequence[FloatArray],
    span: tuple[float, float],
    options: FoldOptions = FOLDS,
    paid: Callable[[], None] = lambda: None,
) -> Folds | None:
    """Follow the curve of folds through a start both ways; None if there is none near the start.

    Parameters
    ----------
    surface : Surface
        Surface of the balance's solutions.
    start : (n + 2,)
        A fold.
    across : sequence of (n + 2,)
        Directions of the surface across the curve there, such as those of the solutions at that frequency.
        The first one is used from which the curve departs both ways.
    span : (low, high)
        Range of the frequency [rad/s].
    paid : callable
        Called from time to time, to charge the work.
    """
    follower = FoldSteps(surface, span, options, paid)
    for singular in across:
        ways = follower.departures(start, singular)
        if ways:
            break
    else:
        return None
    ahead, ending = follower.run(start, singular, ways[0])
    if ending is FoldCurveEnding.CLOSED:
        return _joined(ahead, (ending, ending))
    back, other = follower.run(start, singular, ways[1])
    return _joined([*reversed(back), *ahead], (other, ending))


def _joined(points: list[Point], endings: tuple[FoldCurveEnding, FoldCurveEnding]) -> Folds:
    return Folds(np.array([z for z, _ in points]), np.array([v for _, v in points]), endings)
