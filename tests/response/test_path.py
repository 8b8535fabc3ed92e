"""The path follower on curves that are known exactly."""

from dataclasses import dataclass

import numpy as np
import pytest

from fcm.response.path import COMPLETE, RETURNED, follow


@dataclass
class Planar:
    """f(x, p) = 0 for the first of five unknowns; the others stay zero."""

    f: object
    by_x: object
    by_p: object

    residual = jacobian = by_omega = None

    def evaluate(self, x, p):
        curves = x.shape[0]
        out = Planar(self.f, self.by_x, self.by_p)
        out.residual = x.copy()
        out.jacobian = np.tile(np.eye(5), (curves, 1, 1))
        out.by_omega = np.zeros_like(x)
        out.residual[:, 0] = self.f(x[:, 0], p)
        out.jacobian[:, 0, 0] = self.by_x(x[:, 0], p)
        out.by_omega[:, 0] = self.by_p(x[:, 0], p)
        return out

    def take(self, index):
        return self


def traced(problem, x, low, high, step=0.05):
    z = np.zeros((1, 6))
    z[0, 0], z[0, -1] = x, low
    path = follow(problem, z, np.array([low]), np.array([high]), step)
    return path, path.z[:, 0], path.z[:, -1]


@pytest.mark.parametrize("step", [0.2, 0.05, 0.01])
def test_an_s_shaped_curve_through_both_folds(step):
    """p = x^3 - x + 2: folds at x = -+1/sqrt(3)."""
    cubic = Planar(
        lambda x, p: x**3 - x + 2.0 - p, lambda x, p: 3.0 * x**2 - 1.0, lambda x, p: -np.ones_like(p)
    )
    path, x, p = traced(cubic, np.cbrt(-1.0) * 1.3247179572447460, 1.0, 3.0, step)
    assert path.status[0] == COMPLETE
    assert np.all(np.diff(x) > 0.0)
    assert x**3 - x + 2.0 == pytest.approx(p, abs=1e-6)
    assert np.count_nonzero(np.diff(np.sign(path.direction[:, -1]))) == 2


@pytest.mark.parametrize("step", [0.2, 0.05, 0.01])
@pytest.mark.parametrize("back", [0.5, 2.0, 20.0])
def test_a_corner_at_which_the_curve_turns_back(step, back):
    """p rises with x up to the corner, falls with slope -back for 1, and rises again."""

    def p_of(x):
        return np.where(x < 2.0, x, np.where(x < 3.0, 2.0 - back * (x - 2.0), 2.0 - back + 2.0 * (x - 3.0)))

    def slope(x):
        return np.where(x < 2.0, 1.0, np.where(x < 3.0, -back, 2.0))

    zigzag = Planar(lambda x, p: p_of(x) - p, lambda x, p: slope(x), lambda x, p: -np.ones_like(p))
    low = min(1.0, 2.0 - back - 0.5)
    path, x, p = traced(zigzag, low, low, 6.0, step)
    assert path.status[0] == COMPLETE
    assert np.all(np.diff(x) > 0.0)
    assert p_of(x) == pytest.approx(p, abs=1e-6)
    assert p[x < 2.5].max() == pytest.approx(2.0, abs=1e-3)


def test_a_closed_loop_comes_back_to_its_start():
    """(x - 3)^2 + (p - 2)^2 = 4 cut at p = 1: the path leaves the range where it entered."""
    circle = Planar(
        lambda x, p: (x - 3.0) ** 2 + (p - 2.0) ** 2 - 4.0,
        lambda x, p: 2.0 * (x - 3.0),
        lambda x, p: 2.0 * (p - 2.0),
    )
    path, x, p = traced(circle, 3.0 - np.sqrt(3.0), 1.0, 5.0)
    assert path.status[0] == RETURNED
    assert x[-1] == pytest.approx(3.0 + np.sqrt(3.0), abs=1e-6)
    assert p.max() == pytest.approx(4.0, abs=1e-2)
