"""Intervals of percentiles of random draws: ranks of the ordered values, and errors of the values."""

import numpy as np
import pytest
from scipy.stats import binom

from fcm.results.quantile_interval import draws_needed, intervals, ranks

PERCENTS = (5.0, 25.0, 50.0, 75.0, 95.0)


@pytest.mark.parametrize("percent", PERCENTS)
@pytest.mark.parametrize("count", [2, 4, 5, 12, 58, 59, 200, 1000])
def test_ranks_are_the_innermost_whose_tails_are_a_twentieth_at_most(count, percent):
    """By another function of scipy, rank by rank."""
    lower, upper = ranks(count, percent)
    number = binom(count, percent / 100.0)  # of draws below the quantile
    assert lower == 0 or number.cdf(lower - 1) <= 0.05
    assert number.cdf(lower) > 0.05
    assert upper == count + 1 or number.sf(upper - 1) <= 0.05
    assert number.sf(upper - 2) > 0.05


def test_the_median_of_ten_is_between_the_second_and_the_ninth():
    """The sign test: two tails of (1 + 10) / 1024."""
    assert ranks(10, 50.0) == (2, 9)


@pytest.mark.parametrize("percent", PERCENTS)
def test_as_many_draws_are_needed_as_bound_both_ends(percent):
    """59 of Wilks (1941) for 5 and 95 %."""
    needed = draws_needed(percent)
    for count, bounded in ((needed - 1, False), (needed, True)):
        lower, upper = ranks(count, percent)
        assert (lower > 0 and upper <= count) == bounded
    assert draws_needed(95.0) == 59 == draws_needed(5.0)


def test_intervals_hold_the_quantile_as_often_as_they_claim():
    """Of exponential draws, whose quantiles are known; more often, as ranks are whole numbers."""
    generator, trials, count = np.random.default_rng(3), 2000, 80
    quantile = -np.log1p(-np.array(PERCENTS) / 100.0)
    inside = np.zeros(len(PERCENTS))
    for _ in range(trials):
        found = intervals(generator.exponential(size=count), np.zeros(count), PERCENTS, 0.9)
        inside += (found[:, 0] <= quantile) & (quantile <= found[:, 1])
    deviation = np.sqrt(0.09 / trials)
    assert (inside / trials > 0.9 - 3.0 * deviation).all()
    assert (inside / trials < 1.0).all()


def test_errors_of_the_values_widen_the_interval():
    """True values within a tenth of those given: the bounds of the true ones are within those found."""
    generator = np.random.default_rng(5)
    true, errors = generator.normal(10.0, 1.0, 60), np.full(60, 0.1)
    given = true / (1.0 + generator.uniform(-0.1, 0.1, 60))
    exact, found = (
        intervals(values, error, PERCENTS, 0.9) for values, error in ((true, 0 * errors), (given, errors))
    )
    assert (found[:, 0] <= exact[:, 0]).all() and (exact[:, 1] <= found[:, 1]).all()
    alone = intervals(given, 0 * errors, PERCENTS, 0.9)
    assert found == pytest.approx(alone * [0.9, 1.1])


def test_an_unknown_error_opens_the_ends_that_it_may_move():
    """Of eleven values 1 to 11 the quarter is between ranks 1 and 6: the first is lost, the sixth is now the
    seventh, as the unknown value may be any."""
    values, errors = np.arange(1.0, 12.0), np.zeros(11)
    (known,) = intervals(values, errors, (25.0,), 0.9)
    assert known.tolist() == [1.0, 6.0]
    errors[2] = np.nan
    (found,) = intervals(values, errors, (25.0,), 0.9)
    assert np.isnan(found[0]) and found[1] == 7.0


def test_what_does_not_move_has_no_error_and_what_is_lost_does_not_count():
    values = np.array([0.0, 0.0, 0.0, 0.0, 0.0, np.nan])
    assert intervals(values, np.full(6, np.nan), (50.0,), 0.9).tolist() == [[0.0, 0.0]]


def test_an_error_above_the_value_leaves_the_least_bound_at_zero():
    (found,) = intervals(np.ones(5), np.full(5, 3.0), (50.0,), 0.9)
    assert found.tolist() == [0.0, 4.0]
