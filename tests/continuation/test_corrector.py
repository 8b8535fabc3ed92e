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
