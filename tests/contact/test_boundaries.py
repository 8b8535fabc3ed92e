"""The boundaries between regimes as signed functions: their zeros, their signs, their derivatives."""

import numpy as np
import pytest
from mpmath import mp

from fcm.contact.closed_form import Boundaries
from fcm.contact.limits import regime_boundaries
from fcm.contact.loop import sequences

from .cases import all_boundaries, points


def slip_limit(b, phi):
    """(25) with fifty digits."""
    with mp.workdps(50):
        turned = b * mp.expj(phi)
        return (abs(1 - turned) + abs(1 + turned)) / 2


def multiplier_sample():
    n0, b, phi = points("linear", 200)
    exact = [(x + y, x - y, x - slip_limit(y, z)) for x, y, z in zip(n0, b, phi, strict=True)]
    np.testing.assert_allclose(regime_boundaries(n0, b, phi), np.array(exact, dtype=float).T, atol=1e-15)


@pytest.mark.parametrize("name", ["linear", "logarithmic", "near_boundaries", "near_degenerate", "largest"])
def test_signs_are_those_of_the_sequences(name):
    n0, b, phi = points(name, 3000)
    touches, stays_closed, sticks = regime_boundaries(n0, b, phi)
    found = sequences(n0, b, phi)
    assert np.all((found == "S")[touches < 0.0]) and np.all((touches <= 0.0)[found == "S"])
    assert np.all((found == "E")[(stays_closed >= 0.0) & (sticks >= 0.0) & (touches > 0.0)])
    slips = (stays_closed > 0.0) & (sticks < -1e-15)
    assert np.all((found == "EPEN")[slips]) and np.all(
        ((stays_closed >= 0.0) & (sticks < 0.0))[found == "EPEN"]
    )


def test_derivatives():
    rng = np.random.default_rng(4)
    at = np.array((rng.uniform(-3.0, 3.0, 50), rng.uniform(0.0, 3.0, 50), rng.uniform(-4.0, 4.0, 50)))
    slopes = Boundaries().many(*at, True)[3:].reshape(3, 3, -1)
    assert np.all(slopes[:2, :2] == np.array([[1, 1], [1, -1]])[..., None]) and not slopes[:2, 2].any()
    for k, (_, b, phi) in enumerate(at.T):
        by_b, by_phi = mp.diff(slip_limit, (b, phi), (1, 0)), mp.diff(slip_limit, (b, phi), (0, 1))
        np.testing.assert_allclose(slopes[2, :, k], np.array([1, -by_b, -by_phi], dtype=float), atol=1e-10)


def test_finite_on_every_boundary_and_nan_where_there_is_none():
    assert np.all(np.isfinite(Boundaries().many(*all_boundaries(), True)))
    assert np.all(np.isnan(Boundaries().many([np.nan, 0.5], [1.0, np.inf], 0.0, True)))
