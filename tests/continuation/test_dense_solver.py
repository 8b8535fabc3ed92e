"""Dense systems of all sizes beside numpy: eliminated with pivots in columns, in rows, and by LAPACK."""

import numpy as np
import pytest

from fcm.continuation.dense_solver import Solver


def solver(matrix):
    one = Solver(len(matrix))
    np.asarray(one.matrix)[:] = matrix
    return one


@pytest.mark.parametrize("size", [1, 2, 7, 39, 40, 41, 42, 43, 97, 399, 400])
def test_solutions_and_the_sign_of_the_determinant(size):
    rng = np.random.default_rng(size)
    matrix = rng.normal(size=(size, size))
    matrix[0, 0] = 0.0 if size > 1 else -2.0  # there has to be a pivot elsewhere
    one, (sign, _) = solver(matrix), np.linalg.slogdet(matrix)
    assert one.factor() and one.orientation == sign
    for right in rng.normal(size=(2, size)):
        np.asarray(one.right)[:] = right
        one.solve()
        assert one.right == pytest.approx(np.linalg.solve(matrix, right), rel=1e-9, abs=1e-10)


@pytest.mark.parametrize("size", [3, 50, 402])
def test_what_has_no_solution_is_said(size):
    singular = np.ones((size, size))
    assert not solver(singular).factor()
    singular[1, 1] = np.nan
    assert not solver(singular).factor()


@pytest.mark.parametrize("size", [45, 119, 402])
def test_a_stiff_row_costs_no_digits_of_the_others(size):
    rng = np.random.default_rng(0)
    matrix = np.eye(size) + 0.1 * rng.normal(size=(size, size))
    exact = rng.normal(size=size)
    matrix[3] *= 1e12  # the equation of a stiff contact
    one = solver(matrix)
    assert one.factor()
    np.asarray(one.right)[:] = matrix @ exact
    one.solve()
    assert one.right == pytest.approx(exact, rel=1e-8, abs=1e-10)
