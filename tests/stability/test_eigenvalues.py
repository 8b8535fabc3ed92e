"""Eigenvalues of small matrices: known ones, and what rounding may do to them."""

from __future__ import annotations

import numpy as np
import pytest

from fcm.stability.eigenvalues import eigenvalues


def found(matrix: np.ndarray) -> np.ndarray:
    (values,) = eigenvalues([matrix])
    assert values is not None
    return np.array(values, dtype=complex)


def apart(values: np.ndarray, others: np.ndarray) -> float:
    """Greatest distance of values from those of others that are theirs, each of which is taken once."""
    left, most = list(others), 0.0
    for value in values:
        nearest = min(left, key=lambda one: abs(one - value))
        left.remove(nearest)
        most = max(most, abs(nearest - value))
    return most


def test_pairs_are_conjugate_and_real_ones_exactly_real():
    turn = np.array([[np.cos(0.3), -np.sin(0.3)], [np.sin(0.3), np.cos(0.3)]])
    matrix = np.zeros((5, 5))
    matrix[:2, :2], matrix[2:4, 2:4], matrix[4, 4] = 0.9 * turn, [[0.5, 1.0], [0.0, -0.25]], 1.5
    base = np.linalg.qr(np.random.default_rng(1).standard_normal((5, 5)))[0]
    values = found(base @ matrix @ base.T)
    pair = values[values.imag != 0.0]
    assert pair.size == 2 and pair[0] == pair[1].conjugate()
    expected = np.array([0.9 * np.exp(0.3j), 0.9 * np.exp(-0.3j), 0.5, -0.25, 1.5])
    assert apart(values, expected) < 1e-14


@pytest.mark.parametrize("rows", [2, 3, 4, 7, 12])
def test_a_cycle_has_the_roots_of_one(rows):
    """All of one magnitude: the usual shifts lead nowhere."""
    cycle = np.roll(np.eye(rows), 1, axis=1)
    assert apart(found(cycle), np.exp(2j * np.pi * np.arange(rows) / rows)) < 1e-14


def test_badly_scaled_rows_and_columns_lose_no_digits():
    """Those of a matrix and of one with the unknowns in other units are the same."""
    rng = np.random.default_rng(4)
    for _ in range(50):
        matrix, unit = rng.standard_normal((5, 5)), 10.0 ** rng.uniform(-8.0, 8.0, 5)
        assert apart(found(matrix * unit / unit[:, None]), found(matrix)) < 1e-11


def test_a_defective_one_errs_by_the_root_of_rounding():
    """Four of them together: by the fourth root."""
    base = np.linalg.qr(np.random.default_rng(2).standard_normal((4, 4)))[0]
    jordan = 0.5 * np.eye(4) + np.diag(np.ones(3), 1)
    assert np.abs(found(base @ jordan @ base.T) - 0.5).max() < 1e-3


@pytest.mark.parametrize("matrix", [np.zeros((4, 4)), np.diag([3.0, -1.0, 0.0]), np.triu(np.ones((6, 6)))])
def test_a_triangle_has_its_diagonal(matrix):
    assert apart(found(matrix), np.diagonal(matrix)) == 0.0


def test_nothing_is_said_of_what_is_no_number():
    for wrong in (np.nan, np.inf):
        matrix = np.eye(3)
        matrix[0, 2] = wrong
        assert eigenvalues([matrix]) == [None]


def test_one_that_is_no_number_does_not_hide_the_others():
    """Of several of the same size each is as alone; so are those of another size between them."""
    rng = np.random.default_rng(3)
    matrices = [rng.standard_normal((n, n)) for n in (3, 5, 3, 3)]
    matrices.insert(2, np.full((3, 3), np.nan))
    assert eigenvalues(matrices) == [eigenvalues([one])[0] for one in matrices]
    assert eigenvalues(matrices)[2] is None
