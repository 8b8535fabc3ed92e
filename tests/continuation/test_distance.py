"""How far a path is from the curve of a problem nearby."""

import numpy as np

from fcm.continuation import Problem, follow
from fcm.continuation.corrector import Newton, distances


class Circle(Problem):
    """x^2 + p^2 = r^2."""

    def __init__(self, radius):
        Problem.__init__(self, 1, 0, 0)
        self.radius = radius

    def evaluate(self, z):
        x, p = z
        self.residual[0] = x * x + p * p - self.radius**2
        self.jacobian[0, 0], self.jacobian[0, 1] = 2.0 * x, 2.0 * p
        return 0


def test_a_circle_is_as_far_from_a_larger_one_as_their_radii_differ():
    path = follow(Circle(1.0), np.array([1.0, 0.0]), (-2.0, 2.0))
    found = distances(Newton(Circle(1.0001)), path.z, path.direction)
    np.testing.assert_allclose(found, 1e-4, rtol=1e-4)


def test_where_there_is_no_step_the_distance_is_not_known():
    class Nowhere(Circle):
        def evaluate(self, z):
            self.residual[0], self.jacobian[0, 0], self.jacobian[0, 1] = 1.0, 0.0, 0.0
            return 0

    assert np.isnan(distances(Newton(Nowhere(1.0)), np.array([[1.0, 0.0]]), np.array([[0.0, 1.0]]))).all()
