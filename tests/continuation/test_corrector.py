"""Newton's method where a problem is soft."""

from __future__ import annotations

import numpy as np
import pytest

from fcm.continuation.corrector import Newton
from fcm.continuation.problem import Problem

NARROW = 0.005  # width of the arctangent


class Steep(Problem):
    """atan(x / NARROW) = 0: from 1.2 NARROW Newton's steps are 2.14, 1.42, 0.55 and 0.07 NARROW long."""

    def __init__(self):
        super().__init__(1, 0, 0)
        self.labelled, self.evaluations = True, 0

    def evaluate(self, z):
        self.evaluations += 1
        x = z[0] / NARROW
        self.residual[0] = np.arctan(x)
        self.jacobian[0, 0], self.jacobian[0, 1] = 1.0 / (1.0 + x * x) / NARROW, 0.0
        return 0


@pytest.mark.parametrize("start, found", [(1.2, True), (2.0, False)])
def test_a_second_step_that_is_slight_may_be_as_long_as_the_first(start, found):
    """From beyond 1.39 widths they grow, and it is given up at once or when they are long."""
    newton = Newton(Steep())
    for place, values in ((newton.z, (start * NARROW, 1.0)), (newton.scale, 1.0), (newton.row, (0.0, 1.0))):
        np.asarray(place)[:] = values
    assert newton.correct(1.0, 0.5) is found
    if found:
        assert abs(newton.z[0]) < 1e-12
        assert newton.problem.evaluations < 8


ONSET = 1e-8  # distance from where the root begins
SOFT = 1e-9  # by which two equations differ: rounding moves their unknowns by some 1e-7


class RootBesideSoft(Problem):
    """sqrt(x - p) = sqrt(ONSET), beside two equations that are nearly the same."""

    def __init__(self):
        super().__init__(3, 0, 0)

    def evaluate(self, z):
        x, y, w, p = z
        off = x - p
        root, slope = np.sqrt(abs(off)), 0.5 / np.sqrt(max(abs(off), 1e-300))
        residual, jacobian = np.asarray(self.residual), np.asarray(self.jacobian)
        residual[:] = (
            np.sign(off) * root - np.sqrt(ONSET),
            y + w - 0.3,
            y + (1.0 + SOFT) * w - 0.3 - 0.1 * SOFT,
        )
        jacobian[:] = [[slope, 0.0, 0.0, -slope], [0.0, 1.0, 1.0, 0.0], [0.0, 1.0, 1.0 + SOFT, 0.0]]
        return 0


@pytest.mark.parametrize("start", [0.003, 0.1, 1.5, 3.0, 3.95])
def test_an_equation_that_is_off_is_not_hidden_by_the_rounding_of_others(start):
    """The steps to the root, no longer than those that rounding makes, are taken to their end."""
    newton = Newton(RootBesideSoft())
    z = np.asarray(newton.z)
    z[:], np.asarray(newton.row)[:] = [1.0 + start * ONSET, 0.2, 0.1, 1.0], [0.0, 0.0, 0.0, 1.0]
    assert newton.correct(1.0)
    assert z[0] - z[3] == pytest.approx(ONSET, rel=1e-6)
    assert newton.rounding_step > 1e-9
