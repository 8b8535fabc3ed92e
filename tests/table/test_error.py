"""The error of the shipped tables at points that nothing in the package knows of."""

import numpy as np
import pytest

from fcm import fourier_coefficients
from fcm.table.error import REGIMES, disagreement, error_of, regime, sample

BOUNDS = {"default": (2e-4, 5e-6), "fast": (1.5e-3, 6e-5)}  # greatest, rms
COUNT = 60_000


def random_phases(random, count):
    near = random.choice([-np.pi, 0.0, np.pi, 2.0 * np.pi], count) + 10.0 ** random.uniform(-9, 0, count)
    return np.where(random.random(count) < 0.3, near, random.uniform(-7.0, 7.0, count))


def everywhere(random, count):
    """Linear and logarithmic, in all regimes."""
    b = np.where(
        random.random(count) < 0.5, random.uniform(0, 3, count), 10.0 ** random.uniform(-9, 9, count)
    )
    return (
        random.uniform(-1.1, 1.5, count) * b + random.normal(0, 0.1, count),
        b,
        random_phases(random, count),
    )


def onset_of_separation(random, count):
    b = 10.0 ** random.uniform(-3, 7, count)
    return (
        b + random.choice([-1, 1], count) * b * 10.0 ** random.uniform(-15, 0, count),
        b,
        random_phases(random, count),
    )


def barely_closed(random, count):
    b = 10.0 ** random.uniform(-3, 5, count)
    return -b + b * 10.0 ** random.uniform(-12, 0, count), b, random_phases(random, count)


def cone(random, count):
    """b near 1 and phi near 0 or pi, where one of the slip limits is constant."""
    b = np.abs(1.0 + random.choice([-1, 1], count) * 10.0 ** random.uniform(-9, -0.3, count))
    phi = random.choice([0.0, np.pi], count) + random.choice([-1, 1], count) * 10.0 ** random.uniform(
        -9, 0, count
    )
    return random.uniform(-1.0, 1.2, count), b, phi


def slip_limit(random, count):
    b = 10.0 ** random.uniform(-6, 3, count)
    phi = random.uniform(0.0, 2.0 * np.pi, count)
    limit = 0.5 * (np.abs(1.0 - b * np.exp(1j * phi)) + np.abs(1.0 + b * np.exp(1j * phi)))
    return limit + random.normal(0, 1, count) * 10.0 ** random.uniform(-9, 0, count), b, phi


@pytest.mark.parametrize("name", BOUNDS)
@pytest.mark.parametrize("points", [everywhere, onset_of_separation, barely_closed, cone, slip_limit])
def test_error_is_within_its_bound(name, points, request):
    table = request.getfixturevalue(name)
    n0, b, phi = points(np.random.default_rng(42), COUNT)
    error = np.abs(np.stack(table(n0, b, phi)) - np.stack(fourier_coefficients(n0, b, phi)))
    greatest, rms = BOUNDS[name]
    worst = np.argmax(error.max(axis=0))
    assert error.max() <= greatest, (n0[worst], b[worst], phi[worst])
    # the cone and the onset are where all the error is: the bound on the rms is for the domain as a whole
    assert np.sqrt(np.mean(error**2, axis=1)).max() <= rms * (
        4.0 if points in (cone, onset_of_separation) else 1.0
    )


@pytest.mark.parametrize("name", BOUNDS)
def test_recorded_error_is_true_and_within_the_promise(name, request):
    table = request.getfixturevalue(name)
    greatest, rms = BOUNDS[name]
    assert table.error["points"] == 1_000_000
    assert table.error["max"] <= greatest
    assert table.error["rms"] <= rms
    fresh = error_of(table, 50_000, seed=7)
    assert fresh["max"] <= 1.3 * table.error["max"]
    assert fresh["rms"] == pytest.approx(table.error["rms"], rel=0.1)
    assert set(fresh["regimes"]) == set(REGIMES)


def test_error_is_nothing_where_no_table_is_needed(default):
    error = error_of(default, 20_000, seed=3)["regimes"]
    assert all(error[name][k]["max"] < 1e-12 for name in ("open", "stick") for k in ("F_b", "F_s", "F_c"))


def test_worst_point_is_where_the_error_is(default):
    error = error_of(default, 20_000, seed=3)["regimes"]["separation"]["F_b"]
    found = abs(default(*error["worst"])[0] - fourier_coefficients(*error["worst"])[0])
    assert found == pytest.approx(error["max"], rel=1e-9)


def test_sample_is_reproducible_and_in_every_regime():
    assert all(np.array_equal(a, b) for a, b in zip(sample(5000), sample(5000), strict=True))
    counts = np.bincount(regime(*sample(20_000)), minlength=4)
    assert counts.min() > 500


def test_error_that_is_not_true_is_found(default):
    error = error_of(default, 20_000, seed=1)
    assert disagreement(error, error, error_of(default, 20_000, seed=2)) == ""
    assert "max" in disagreement({**error, "max": 0.5 * error["max"]}, error, error)
    assert "at other points" in disagreement(error, error, {**error, "max": 3.0 * error["max"]})
    assert "recorded" in disagreement({**error, "rms": 2.0 * error["rms"]}, error, error)


def test_error_falls_with_the_fourth_power_where_the_function_is_smooth(default, fast):
    """Far from cones and changes of sequence: what a cubic spline can do."""
    random = np.random.default_rng(5)
    n0, b, phi = random.uniform(0.5, 0.55, 500), random.uniform(0.3, 0.35, 500), random.uniform(1.0, 1.1, 500)
    exact = np.stack(fourier_coefficients(n0, b, phi))
    fine, coarse = (np.abs(np.stack(table(n0, b, phi)) - exact).max() for table in (default, fast))
    assert fine < coarse / 8.0
