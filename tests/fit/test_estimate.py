"""Standard errors, intervals and what is not told, of rows that are known functions."""

from dataclasses import replace

import numpy as np
import pytest

from fcm.fit.estimate import estimated
from fcm.fit.least_squares_rows import ResidualRows
from fcm.fit.parameters import Parameters

POINTS = 40


def parameters(count):
    """Numbers that are their own unknowns."""
    zeros, ones = np.zeros(count), np.ones(count)
    return Parameters(None, (), zeros, np.full(count, -np.inf), np.full(count, np.inf), zeros, ones)


def line(rng, spread=0.1):
    """A straight line through points with errors; the least-squares fit of it."""
    x = np.linspace(0.0, 1.0, POINTS)
    design = np.column_stack((np.ones(POINTS), x))
    y = design @ [1.0, 2.0] + spread * rng.standard_normal(POINTS)
    values = np.linalg.lstsq(design, y, rcond=None)[0]
    return (
        design,
        values,
        ResidualRows((design @ values - y)[:, None], design[:, None, :], np.zeros(POINTS), POINTS),
    )


def test_the_errors_are_those_of_a_straight_line_in_textbooks():
    design, values, rows = line(np.random.default_rng(3))
    x = design[:, 1] - design[:, 1].mean()
    variance = (rows.residual**2).sum() / (POINTS - 2)
    told = estimated(parameters(2), values, rows)
    slope = np.sqrt(variance / (x**2).sum())
    mean = np.sqrt(variance * (1.0 / POINTS + design[:, 1].mean() ** 2 / (x**2).sum()))
    assert told.error == pytest.approx([mean, slope], rel=1e-10)
    assert told.correlation[0, 1] == pytest.approx(-design[:, 1].mean() * slope / mean, rel=1e-9)


def test_intervals_hold_the_truth_as_often_as_they_say():
    rng, held = np.random.default_rng(0), np.zeros(2)
    draws = 1000
    for _ in range(draws):
        _, values, rows = line(rng)
        told = estimated(parameters(2), values, rows)
        held += (told.interval[:, 0] <= [1.0, 2.0]) & (told.interval[:, 1] >= [1.0, 2.0])
    assert (held > 0.93 * draws).all() and (held < 0.98 * draws).all()


def rows_with(columns):
    rng = np.random.default_rng(1)
    rates = np.column_stack(columns)
    return ResidualRows(0.01 * rng.standard_normal((POINTS, 1)), rates[:, None, :], np.zeros(POINTS), POINTS)


def test_numbers_of_which_none_has_an_effect_are_all_without():
    """As of data far from the range: a traceback."""
    told = estimated(parameters(2), np.array([1.0, 1.0]), rows_with([np.zeros(POINTS), np.zeros(POINTS)]))
    assert told.without_effect.tolist() == [1.0, 1.0] and told.alike == () and (told.error == np.inf).all()


def test_a_number_without_effect_has_no_error_and_spoils_no_other():
    x = np.linspace(0.5, 1.0, POINTS)
    alone = estimated(parameters(1), np.array([1.0]), rows_with([x]))
    told = estimated(parameters(2), np.array([1.0, 1.0]), rows_with([x, np.zeros(POINTS)]))
    assert told.without_effect.tolist() == [0.0, 1.0] and told.error[1] == np.inf
    assert told.error[0] == pytest.approx(alone.error[0], rel=1e-12)


def test_numbers_with_the_same_effect_are_not_told_apart():
    x = np.linspace(0.5, 1.0, POINTS)
    told = estimated(parameters(2), np.array([1.0, 1.0]), rows_with([x, 3.0 * x]))
    ((i, j, power),) = told.alike
    assert (i, j) == (0, 1) and power == pytest.approx(3.0)
    assert np.isinf(told.error).all() or (told.error > 1e3).all()


def test_numbers_with_small_errors_are_told_apart_however_correlated():
    """They were said to be known by their product alone, with standard errors of a few thousandths."""
    x = np.linspace(0.5, 1.0, POINTS)
    columns = [1e3 * x, 1e3 * (3.0 * x + 0.1 * x**2)]
    told = estimated(parameters(2), np.array([1.0, 1.0]), rows_with(columns))
    assert abs(told.correlation[0, 1]) > 0.98 and (told.error < 0.01).all()
    assert told.alike == ()
    vague = estimated(parameters(2), np.array([1.0, 1.0]), rows_with([one / 1e3 for one in columns]))
    assert len(vague.alike) == 1 and (vague.error > 0.05).any()


def test_a_pair_is_alike_by_its_correlation_and_not_by_its_columns():
    """A pair whose correlation is -0.32 was said, for its columns are parallel where the third is held."""
    correlation = np.array([[1.0, 0.235, -0.996], [0.235, 1.0, -0.32], [-0.996, -0.32, 1.0]])
    information = np.linalg.inv(correlation)
    unit = 1.0 / np.sqrt(np.diag(information))
    assert abs(information * np.outer(unit, unit))[1, 2] > 0.98
    spread = np.linalg.qr(np.random.default_rng(1).standard_normal((POINTS, 3)))[0]
    J = spread @ np.linalg.cholesky(information).T
    told = estimated(parameters(3), np.ones(3), rows_with(0.01 * J.T))
    assert told.correlation == pytest.approx(correlation, rel=1e-9)
    ((i, j, power),) = told.alike
    assert (i, j) == (0, 2) and power == pytest.approx(0.996, rel=1e-9)


@pytest.mark.parametrize("log", [0.0, 1.0])
def test_an_end_of_an_interval_beyond_the_bounds_is_not_determined(log):
    """Intervals such as 1e-255 to 1e252 were printed; numbers were compared with the data from 0.5 to 4."""
    x = np.linspace(0.5, 1.0, POINTS)
    free = parameters(1)
    known = estimated(replace(free, log=np.array([log])), np.ones(1), rows_with([x]))
    ((low, high),) = known.interval
    assert 0.9 < low < 1.0 < high < 1.1
    reach = max(1.0 - low, high - 1.0)
    for weak, beyond in ((1.0, (False, False)), (0.8 / reach, (True, False)), (1e3 / reach, (True, True))):
        bounded = replace(free, log=np.array([log]), low=np.array([0.5]), high=np.array([4.0]))
        ((*ends,),) = estimated(bounded, np.ones(1), rows_with([x / weak])).interval.tolist()
        assert tuple(np.isnan(ends)) == beyond
        wide = estimated(replace(free, log=np.array([log])), np.ones(1), rows_with([x / weak])).interval[0]
        assert all(np.isnan(one) or one == other for one, other in zip(ends, wide.tolist(), strict=True))
