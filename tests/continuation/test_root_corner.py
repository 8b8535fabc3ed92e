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
        self.has_root_margins, self.pull = True, pull

    def squared_margin(self, kind: int, z: FloatArray) -> float:
        x, y, p = z
        return float(p + self.pull * x - 0.3 * y + 0.5 * x * y)

    def evaluate_margins(self, z: FloatArray) -> int:
        g = self.squared_margin(0, z)
        self.margin[0] = np.sign(g) * np.sqrt(abs(g))
        return 0

    def evaluate(self, z: FloatArray) -> int:
        (x, y, p), g = z, self.squared_margin(0, z)
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
    sides = np.sign([problem.squared_margin(0, z) for z in path.z])
    assert (sides[:corner] == 1.0).all()
    assert (sides[corner + 1 :] == -1.0).all()


class MirroredRoots(Problem):
    """Two roots as of `Root`, of unknowns x_1, y_1, x_2, y_2: what is unlike in both acts on their squares.

    Both squares vanish at once, or the second a shift apart. Where both roots are the same, what is unlike
    has its own determinant, which changes its sign in the corner and where a root is half of `unlike`.
    """

    def __init__(self, unlike: float, shift: float) -> None:
        Problem.__init__(self, 4, 2, 0)
        self.has_root_margins, self.pull, self.unlike, self.shift = True, 0.01, unlike, shift

    def squared_margin(self, kind: int, z: FloatArray) -> float:
        x, y, other, p = z[2 * kind], z[2 * kind + 1], z[2 - 2 * kind], z[4]
        apart = 0.5 * (self.unlike - self.pull)
        return float(p + self.pull * x + apart * (x - other) - 0.3 * y + 0.5 * x * y + kind * self.shift)

    def evaluate_margins(self, z: FloatArray) -> int:
        for kind in range(2):
            g = self.squared_margin(kind, z)
            self.margin[kind] = np.sign(g) * np.sqrt(abs(g))
        return 0

    def evaluate(self, z: FloatArray) -> int:
        apart = 0.5 * (self.unlike - self.pull)
        for kind in range(2):
            i, k = 2 * kind, 2 - 2 * kind
            x, y, g = z[i], z[i + 1], self.squared_margin(kind, z)
            root = np.sqrt(abs(g))
            slope = np.zeros(5)
            slope[[i, i + 1, k, 4]] = self.pull + apart + 0.5 * y, 0.5 * x - 0.3, -apart, 1.0
            slope *= np.sign(g) / (2.0 * max(root, 1e-150))
            self.residual[i], self.residual[i + 1] = x - root, y - 0.7 * root - z[4]
            unit = np.eye(5)
            self.jacobian[i, :] = unit[i] - slope
            self.jacobian[i + 1, :] = unit[i + 1] - unit[4] - 0.7 * slope
        return 0


@pytest.mark.parametrize("shift", [0.0, 1e-12, 1e-9, 1e-6])
@pytest.mark.parametrize("unlike", [0.3, 0.03, 0.0003, -0.03, -0.00003])
def test_mirrored_corners_are_crossed_one_at_a_time(unlike: float, shift: float) -> None:
    """Two branches on which both roots are the same meet two others; a shift joins one of these to each.

    Without a shift they are joined, too. A curve that changed its orientation would go around for ever.
    """
    problem = MirroredRoots(unlike, shift)
    start = np.array([0.0, 1.0, 0.0, 1.0, 1.0])
    path = follow(problem, start, (-1.0, 1.0), forward=False)
    assert path.status is Status.COMPLETE and path.z[-1, 4] == -1.0
    assert path.z[-1, :2] == pytest.approx(path.z[-1, 2:4], abs=10.0 * shift + 1e-12)
    corners = np.flatnonzero(path.mark & Mark.CORNER)
    sides = np.sign([[problem.squared_margin(kind, z) for z in path.z] for kind in range(2)])
    assert (sides[:, : corners[0]] == 1.0).all()
    assert (sides[:, corners[-1] + 1 :] == -1.0).all()
    between = sides[:, corners[0] + 1 : corners[-1]]
    assert (between[0] != between[1]).any()
    changes = np.count_nonzero(np.diff(path.orientation))
    assert changes == (0 if shift else path.where(Mark.BRANCH).size)
