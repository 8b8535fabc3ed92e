"""Values between those that are known along a curve, its length, and how steep it is."""

from __future__ import annotations

import numpy as np
import pytest

from fcm.accuracy.curve_distance import PartialInterpolant, arc_lengths, steepness

ALL = np.arange(9)


def filled(known, values):
    place = np.array([0.0, 0.4, 1.0, 1.1, 2.0, 2.5, 3.0, 3.7, 4.0])
    value = values(place)
    flags = np.isin(ALL, known)
    return place, value, PartialInterpolant(place, value * flags[:, None], flags.view(np.uint8))


def parabolas(x):
    return np.column_stack((1.0 + x - 2.0 * x**2, 3.0 * x**2, 5.0 + 0.0 * x))


@pytest.mark.parametrize("known", [[0, 2, 4, 6, 8], [0, 3, 7, 8]])
def test_parabolas_are_met_exactly_where_there_are_neighbours(known):
    _, value, between = filled(known, parabolas)
    out = np.empty((9, 3))
    between.interpolate(ALL, out)
    inner = slice(known[1], known[-2] + 1)
    assert np.abs(out[inner] - value[inner]).max() < 1e-12
    assert np.abs(out - value)[known].max() == 0.0


@pytest.mark.parametrize("known", [[0, 8], [1, 2, 6]])
def test_straight_lines_are_met_exactly_also_beyond_the_known_points(known):
    _, value, between = filled(known, lambda x: np.column_stack((2.0 - x, 3.0 * x)))
    out = np.empty((9, 2))
    between.interpolate(ALL, out)
    assert np.abs(out - value).max() < 1e-14


def test_one_known_point_speaks_for_all():
    _, value, between = filled([5], parabolas)
    out = np.empty((9, 3))
    between.interpolate(ALL, out)
    assert (out == value[5]).all()


def test_beside_a_gap_the_slope_is_that_of_the_other_side():
    """A straight line stays one, and nothing is said of what is next to the missing one."""
    place, value, between = filled([0, 2, 4, 6, 8], lambda x: np.column_stack((x, 2.0 * x)))
    value[6] = np.nan
    between = PartialInterpolant(place, value, np.isin(ALL, [0, 2, 4, 6, 8]).view(np.uint8))
    out = np.empty((9, 2))
    between.interpolate(ALL, out)
    assert np.isnan(out[[5, 6, 7]]).all()
    assert np.abs(out[:5, 0] - place[:5]).max() < 1e-15


def test_what_is_off_is_unforeseen_and_so_is_what_comes_or_goes():
    value = np.ones((9, 2))
    value[[1, 3], 1] = 1.3, 1.05
    value[5] = np.nan
    between = PartialInterpolant(np.arange(9.0), value, np.ones(9, dtype=np.uint8))
    middle = np.array([1, 3, 5, 5, 7])
    points = np.array((middle - 1, middle, middle + 1))
    expected = np.ones((5, 2))
    expected[[2, 4]] = np.nan
    out = np.zeros(5, dtype=np.uint8)
    between.misses_expected(points, expected, np.ones(9), 0.2, 1e-6, out)
    assert out.tolist() == [1, 0, 0, 1, 1]
    expected[:] = 1.0
    expected[1, 0] = 0.95  # of the first value, which the weight makes large
    weight, points = np.where(np.arange(9) == 3, 10.0, 1.0), np.array([[2], [3], [4]])
    between.misses_expected(points, expected[1:2], weight, 0.01, 0.0, out[:1])
    assert out[0] == 1
    between.misses_expected(points, expected[1:2], weight, 0.2, 1.0, out[:1])
    assert out[0] == 0


def test_a_circle_is_as_long_as_its_angle():
    """In units of its greatest coordinate, and of the range of the parameter."""
    angle = np.linspace(0.0, 2.0 * np.pi, 200)
    z = np.column_stack((3.0 * np.sin(angle), 0.5 * np.cos(angle)))
    direction = np.column_stack((3.0 * np.cos(angle), -0.5 * np.sin(angle)))
    out = np.zeros(200)
    arc_lengths(z, direction, 0.5, out)
    assert np.abs(out - angle).max() < 1e-3


def test_steep_is_what_grows_faster_than_the_parameter():
    """A power of the parameter by that power; what stands still counts as one, a step as the most."""
    x = np.linspace(1.0, 1.01, 50)
    out = np.zeros(50)
    steepness(x, np.column_stack((x**7, 4.0 * x)), 100.0, out)
    assert out[1:-1] == pytest.approx(7.0, rel=1e-4)
    steepness(x, np.ones((50, 2)), 100.0, out)
    assert (out == 1.0).all()
    jump = np.where(np.arange(50) < 25, 1.0, 2.0)[:, None]
    steepness(x, jump, 100.0, out)
    assert out[24] == out[25] == 100.0 and out[10] == 1.0
