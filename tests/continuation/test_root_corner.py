"""Corners at which the equations begin as a root, so that the curve may leave to where it came from."""

from __future__ import annotations

import numpy as np
import pytest

from fcm.continuation import Mark, Problem, Status, follow
from fcm.continuation.options import FOLLOW
from fcm.continuation.path import FloatArray

MET = float(np.sqrt(FOLLOW.switching.root_distance))  # so far a corner is met on a root


class Root(Problem):
    """x = r, y = p + 0.7 r with the root r of the size of a square that vanishes where x, y, p do.

    On both sides x is positive: the curve turns back where the square vanishes.
    """

    def __init__(self, pull: float) -> None:
        Problem.__init__(self, 2, 1, 0)
        self.rooted, self.pull = True, pull

    def square(self, kind: int, z: FloatArray) -> float:
        x, y, p = z
        return float(p + self.pull * x - 0.3 * y + 0.5 * x * y)

    def bound(self, z: FloatArray) -> int:
        g = self.square(0, z)
        self.margin[0] = np.sign(g) * np.sqrt(abs(g))
        return 0

    def evaluate(self, z: FloatArray) -> int:
        (x, y, p), g = z, self.square(0, z)
        root = np.sqrt(abs(g))
        slope = np.sign(g) / (2.0 * max(root, 1e-150)) * np.array([self.pull + 0.5 * y, 0.5 * x - 0.3, 1.0])
        self.residual[0], self.residual[1] = x - root, y - 0.7 * root - p
        self.jacobian[0, :] = [1.0, 0.0, 0.0] - slope
        self.jacobian[1, :] = [0.0, 1.0, -1.0] - 0.7 * slope
        return 0


@pytest.mark.parametrize("pull", [0.1, 0.01, 0.001, 0.0001])
def test_a_curve_that_leaves_to_where_it_came_from(pull: float) -> None:
    """Without knowledge of the square it comes back to p = 1 along itself, or stalls."""
    problem = Root(pull)
    path = follow(problem, np.array([0.0, 1.0, 1.0]), (-1.0, 1.0), forward=False)
    assert path.status is Status.COMPLETE
    (corner,) = np.flatnonzero(path.mark & Mark.CORNER)
    assert path.z[corner] == pytest.approx(np.zeros(3), abs=MET)
    sides = np.sign([problem.square(0, z) for z in path.z])
    assert (sides[:corner] == 1.0).all()
    assert (sides[corner + 1 :] == -1.0).all()
