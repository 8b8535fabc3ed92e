"""What may be passed, what comes back, and what is refused."""

import numpy as np
import pytest

from fcm import fourier_coefficients, hysteresis_loop
from fcm.contact.loop import sequences

EXTREMES = [0.0, -0.0, 1.0, 5e-324, 1e-300, 1e154, 1e155, 1e300, 1e308, np.finfo(float).max]


def test_scalars_give_scalars():
    for F in fourier_coefficients(1, 0, 0):
        assert F.shape == ()
        assert F.dtype == np.float64


def test_broadcasting():
    n0, b, phi = np.linspace(-1.0, 2.0, 5)[:, None, None], np.linspace(0.0, 2.0, 4)[:, None], [0.0, 0.5, 3.0]
    F = fourier_coefficients(n0, b, phi)
    for i, j, k in np.ndindex(5, 4, 3):
        alone = fourier_coefficients(n0[i, 0, 0], b[j, 0], phi[k])
        assert tuple(x[i, j, k] for x in F) == alone


def test_any_layout_and_type():
    n0 = np.asfortranarray(np.linspace(-1.0, 2.0, 12).reshape(3, 4))
    expected = fourier_coefficients(n0.copy(order="C"), 1.0, 0.5)
    for same in (n0, n0.tolist(), n0[::-1][::-1]):
        np.testing.assert_array_equal(fourier_coefficients(same, 1, 0.5), expected)
    np.testing.assert_array_equal(
        fourier_coefficients(np.float32(0.5), np.int8(1), True), fourier_coefficients(0.5, 1.0, 1.0)
    )


def test_empty():
    assert [F.shape for F in fourier_coefficients(np.empty((0, 3)), 1.0, 0.5)] == [(0, 3)] * 3
    assert sequences([], 1.0, 0.5).shape == (0,)


def test_arguments_are_left_alone():
    n0, b, phi = np.array([np.nan, 0.5, np.inf, 1e305]), np.array([1.0, 0.5, 1.0, 1e305]), np.array([0.0] * 4)
    copies = n0.copy(), b.copy(), phi.copy()
    fourier_coefficients(n0, b, phi)
    sequences(n0, b, phi)
    for changed, copy in zip((n0, b, phi), copies, strict=True):
        np.testing.assert_array_equal(changed, copy)


def test_a_point_does_not_depend_on_its_neighbours():
    """The last bit of each is the same in any company."""
    rng = np.random.default_rng(1)
    x = rng.uniform(0.0, 2.0, (3, 1000))
    together = np.array(fourier_coefficients(*x))
    for i in (0, 1, 500, 999):
        np.testing.assert_array_equal(together[:, i], fourier_coefficients(*x[:, i]))


@pytest.mark.parametrize("position", [0, 1, 2])
def test_nan_in_nan_out(position):
    arguments = [np.array([0.5, 0.5]), np.array([0.3, 0.3]), np.array([1.0, 1.0])]
    arguments[position][0] = np.nan
    for F in fourier_coefficients(*arguments):
        np.testing.assert_array_equal(np.isnan(F), [True, False])


@pytest.mark.parametrize("b", [-1.0, -5e-324, -np.inf, [0.5, -0.1], [np.nan, -1.0]])
def test_negative_variation_is_refused(b):
    with pytest.raises(ValueError, match="b_bar is an amplitude and must not be negative"):
        fourier_coefficients(1.0, b, 0.0)


def test_loop_refuses_what_has_none():
    with pytest.raises(ValueError, match="must not be negative"):
        hysteresis_loop(1.0, -1.0, 0.0)
    for bad in ((np.nan, 1.0, 0.0), (1.0, np.inf, 0.0), (1.0, 1.0, np.nan)):
        with pytest.raises(ValueError, match="finite"):
            hysteresis_loop(*bad)


def test_infinite_preload_is_stuck_and_infinite_gap_is_open():
    for b in EXTREMES:
        np.testing.assert_array_equal(fourier_coefficients(np.inf, b, 1.0), (0.0, 1.0, 0.0))
        np.testing.assert_array_equal(fourier_coefficients(-np.inf, b, 1.0), (0.0, 0.0, 0.0))
    assert sequences([np.inf, -np.inf, np.nan], 1.0, 0.0).tolist() == ["E", "S", ""]


@pytest.mark.parametrize("phi", [0.0, np.pi, 0.5 * np.pi, -np.pi, 1e6, -1e6, 1e300])
def test_no_overflow_at_the_ends_of_float64(phi):
    """Nothing raised (see conftest), nothing but numbers."""
    n0, b = np.meshgrid([s * x for s in (1.0, -1.0) for x in EXTREMES], EXTREMES)
    assert np.all(np.isfinite(fourier_coefficients(n0, b, phi)))
    assert np.all(sequences(n0, b, phi) != "")


def test_infinite_variation_or_phase_has_no_answer():
    for F in fourier_coefficients(1.0, [np.inf, 1.0], [0.0, np.inf]):
        assert np.all(np.isnan(F))
