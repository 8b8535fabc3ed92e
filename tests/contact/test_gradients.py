"""Analytic derivatives against differences of the many-digit coefficients; finite wherever a node may be."""

import numpy as np
import pytest

from fcm import fourier_coefficients
from fcm.contact import fourier_gradients

from . import reference
from .cases import all_boundaries, points


@pytest.mark.parametrize(
    ("name", "allowed"),
    # faint contacts: a slip ends within sqrt(n0) of the next, which is known to sqrt(1e-16) at worst
    [("linear", 1e-12), ("turned_often", 1e-12), ("logarithmic", 1e-8)],
)
def test_derivatives(name, allowed):
    n0, b, phi = points(name, 70)
    exact = [reference.derivatives(*x) for x in zip(n0, b, phi, strict=True)]
    exact = np.array(exact, dtype=float).transpose(1, 2, 0)
    _, dF = fourier_gradients(n0, b, phi)
    error = np.max(np.abs(dF - exact) / np.maximum(1.0, np.abs(exact)), axis=(0, 1))
    worst = np.argmax(error)
    at = ", ".join(repr(float(x[worst])) for x in (n0, b, phi))
    assert error[worst] <= allowed, f"{error[worst]:.2e} at {at}"


def test_derivatives_of_large_variations():
    """Up to b = 1e8, at points that are on no boundary."""
    rng = np.random.default_rng(5)
    b = 10.0 ** rng.uniform(3.0, 8.0, 40)
    n0, phi = b * rng.uniform(-0.99, 0.99, 40), rng.uniform(-3.0, 3.0, 40)
    exact = np.array([reference.derivatives(*x) for x in zip(n0, b, phi, strict=True)], dtype=float)
    _, dF = fourier_gradients(n0, b, phi)
    np.testing.assert_allclose(dF, exact.transpose(1, 2, 0), rtol=1e-9, atol=1e-12)


@pytest.mark.parametrize(
    "name",
    [
        "near_boundaries",
        "near_degenerate",
        "faint",
        "between_sequences",
        "between_sequences_at_large_b",
        "large",
        "largest",
    ],
)
def test_finite_and_with_the_same_coefficients(name):
    assert_finite(*points(name, 5000))


def test_finite_on_every_boundary():
    assert_finite(*all_boundaries())


def assert_finite(n0, b, phi):
    F, dF = fourier_gradients(n0, b, phi)
    assert np.all(np.isfinite(dF))
    np.testing.assert_array_equal(F, fourier_coefficients(n0, b, phi))


@pytest.mark.parametrize("name", ["near_boundaries", "near_degenerate", "between_sequences"])
def test_bounded_as_the_force_is(name):
    """The force moves by no more than the normal load does: |dF| <= 4 / pi (1, 1, b), kinks included."""
    n0, b, phi = points(name, 5000)
    _, dF = fourier_gradients(n0, b, phi)
    load = np.stack((np.ones_like(b), np.ones_like(b), b))
    assert np.all(np.abs(dF) <= 4.0 / np.pi * load * (1.0 + 1e-9) + 1e-9)


def test_shapes():
    F, dF = fourier_gradients(np.zeros((4, 1)), np.ones(3), 0.5)
    assert F.shape == (3, 4, 3)
    assert dF.shape == (3, 3, 4, 3)
    F, dF = fourier_gradients(0.5, 1.0, 0.5)
    assert F.shape == (3,)
    assert dF.shape == (3, 3)


def test_nan_in_nan_out():
    F, dF = fourier_gradients([np.nan, 0.5], [1.0, np.nan], 0.0)
    assert np.all(np.isnan(F))
    assert np.all(np.isnan(dF))
