"""Fourier coefficients of the normal load, equations (28) to (31)."""

import numpy as np
import pytest

from fcm import normal_coefficients, normal_gradients

from . import reference

ENDS = [s * (1.0 + e) for s in (-1.0, 1.0) for e in (0.0, 2.0**-52, -(2.0**-53), 1e-12, -1e-12, 1e-6, -1e-6)]
EVERYWHERE = [*ENDS, 0.0, 1e-300, -1e-300, 1e-12, *np.linspace(-3.0, 3.0, 61), 1e12, -1e12, 1e300, -1e300]


def test_against_the_integrals():
    exact = np.array([reference.normal_coefficients(x) for x in map(float, EVERYWHERE)], dtype=float).T
    N_b, N_s = normal_coefficients(EVERYWHERE)
    np.testing.assert_allclose(N_b, exact[0], rtol=1e-15, atol=1e-15)
    np.testing.assert_allclose(N_s, exact[1], rtol=1e-15, atol=1e-15)


def test_gradients_against_the_integrals():
    inside = np.array([*np.linspace(-0.999, 0.999, 41), 1.0 - 1e-9, 1e-9 - 1.0, -2.0, 2.0])
    step = reference.STEP
    with reference.mp.workdps(100):
        at = [reference.mpf(float(x)) for x in inside]
        ahead, behind = ([reference.normal_coefficients(x + s) for x in at] for s in (step, -step))
        exact = [
            [(p - m) / (2 * step) for p, m in zip(*pair, strict=True)]
            for pair in zip(ahead, behind, strict=True)
        ]
    np.testing.assert_allclose(np.array(normal_gradients(inside)).T, np.array(exact, dtype=float), atol=2e-15)


def test_finite_at_the_ends():
    assert np.all(np.isfinite(normal_gradients(EVERYWHERE)))


def test_fully_open_and_never_open():
    np.testing.assert_array_equal(normal_coefficients([-1.0, -5.0, -np.inf]), np.zeros((2, 3)))
    np.testing.assert_array_equal(
        normal_coefficients([1.0, 5.0, np.inf]), [[1.0, 5.0, np.inf], [1.0, 1.0, 1.0]]
    )


def test_half_open_at_no_preload():
    N_b, N_s = normal_coefficients(0.0)
    assert N_b == pytest.approx(1.0 / np.pi, abs=1e-16)
    assert N_s == 0.5


def test_nan_in_nan_out_of_any_shape():
    N_b, N_s = normal_coefficients([[np.nan, 0.0]])
    assert N_b.shape == N_s.shape == (1, 2)
    np.testing.assert_array_equal(np.isnan(N_b), [[True, False]])
    np.testing.assert_array_equal(np.isnan(N_s), [[True, False]])
    assert np.all(np.isnan(normal_gradients(np.nan)))
