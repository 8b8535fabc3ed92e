"""Cases with a known answer, and what the contact law says of every case."""

import numpy as np
import pytest

from fcm import fourier_coefficients, normal_coefficients

from .cases import all_boundaries, points

CLASSES = [
    "linear",
    "logarithmic",
    "near_boundaries",
    "near_degenerate",
    "faint",
    "between_sequences",
    "large",
]
RNG = np.random.default_rng(3)
ANY_PHASE = RNG.uniform(-7.0, 7.0, 200)


def test_constant_load():
    """b = 0: theta* = arccos(1 - 2 n0) of slip a half cycle, F_s = (theta* - sin(2 theta*) / 2) / pi, ..."""
    n0 = np.concatenate((RNG.uniform(0.0, 1.0, 150), 10.0 ** RNG.uniform(-9.0, 0.0, 50)))
    F_b, F_s, F_c = fourier_coefficients(n0, 0.0, ANY_PHASE)
    theta = 2.0 * np.arcsin(np.sqrt(n0))
    np.testing.assert_allclose(F_b, 0.0, atol=1e-15)
    np.testing.assert_allclose(F_s, (theta - 0.5 * np.sin(2.0 * theta)) / np.pi, atol=1e-15)
    np.testing.assert_allclose(F_c, 4.0 * n0 * (1.0 - n0) / np.pi, atol=1e-15)


def test_coulomb():
    """A rigid-plastic contact: the square wave n0 sign(du), 4 n0 / pi."""
    n0 = 10.0 ** np.linspace(-12.0, -5.0, 8)
    _, F_s, F_c = fourier_coefficients(n0, 0.0, 0.0)
    np.testing.assert_allclose(F_c, 4.0 * n0 / np.pi, rtol=2e-5, atol=1e-15)
    assert np.all(np.abs(F_s) <= 8.0 * n0**1.5)


def test_stuck_and_open():
    np.testing.assert_array_equal(fourier_coefficients([1.0, 2.0, 1e300, np.inf], 0.0, ANY_PHASE[:4])[1], 1.0)
    for F in fourier_coefficients([0.0, -1.0, -1e300, -np.inf], [0.0, 1.0, 1e300, 7.0], ANY_PHASE[:4]):
        np.testing.assert_array_equal(F, 0.0)


def test_mean_force_of_a_stuck_contact():
    """The admissible mean nearest to zero; not zero for (ell_1 + ell_2) / 2 < n0 < max(ell_1, ell_2)."""
    b, phi = RNG.uniform(0.0, 2.0, 200), ANY_PHASE
    ell_1, ell_2 = (np.sqrt(1.0 + b * b + s * 2.0 * b * np.cos(phi)) for s in (-1.0, 1.0))
    least, most = np.maximum(0.5 * (ell_1 + ell_2), b), np.maximum(np.maximum(ell_1, ell_2), b)
    n0 = least + RNG.uniform(0.0, 1.2, 200) * (most - least) + 1e-9
    F_b, F_s, F_c = fourier_coefficients(n0, b, phi)
    np.testing.assert_allclose(F_b, np.minimum(np.maximum(0.0, ell_2 - n0), n0 - ell_1), atol=1e-14)
    assert np.count_nonzero(F_b) > 50
    np.testing.assert_array_equal(F_s, 1.0)
    np.testing.assert_array_equal(F_c, 0.0)


@pytest.mark.parametrize(("phi", "sign"), [(0.0, 1.0), (2.0 * np.pi, 1.0), (np.pi, -1.0), (-np.pi, -1.0)])
@pytest.mark.parametrize("b", [1.0 + 1e-9, 1.5, 10.0, 1e3])
def test_load_in_phase_with_the_motion(phi, sign, b):
    """phi = 0, b > 1: sticks while closed, from f = 0, so f = n / b and dissipates nothing."""
    n0 = b * np.linspace(-0.999, 0.999, 41)
    F_b, F_s, F_c = fourier_coefficients(n0, b, phi)
    N_b, N_s = normal_coefficients(n0 / b)
    np.testing.assert_allclose(F_b, sign * N_b, atol=2e-15)
    np.testing.assert_allclose(F_s, N_s, atol=2e-15)
    np.testing.assert_allclose(F_c, 0.0, atol=2e-15)


def test_load_in_phase_that_never_opens():
    """phi = 0, b < n0 < 1, by hand.

    P ends at u = 1, f = n0 + b; N begins y later, 1 - cos(y) = 2 (n0 + b) / (1 + b), moving w by (1 + b) du.
    N ends at u = -1, f = b - n0; P begins z later, 1 - cos(z) = 2 (n0 - b) / (1 - b), moving w by (1 - b) du.
    The loop encloses pi F_c, the integral of u dw. Below, y and z are the two versines.
    """
    b = RNG.uniform(0.0, 0.9, 200)
    n0 = b + RNG.uniform(0.0, 1.0, 200) * (1.0 - b)
    y, z = 2.0 * (n0 + b) / (1.0 + b), 2.0 * (n0 - b) / (1.0 - b)
    _, _, F_c = fourier_coefficients(n0, b, 0.0)
    enclosed = 0.5 * ((1.0 + b) * y * (2.0 - y) + (1.0 - b) * z * (2.0 - z))
    np.testing.assert_allclose(np.pi * F_c, enclosed, atol=2e-15)


@pytest.mark.parametrize("b", [1e12, 1e100, 1e300])
def test_load_that_varies_much(b):
    """b to infinity: sticks from the moment it closes till it opens."""
    ratio, phi = RNG.uniform(-0.99, 0.99, 200), RNG.uniform(-3.0, 3.0, 200)
    closes, opens = -phi - np.arcsin(ratio), np.pi - phi + np.arcsin(ratio)
    w, length = np.sin(closes), opens - closes
    F_b = (np.cos(closes) - np.cos(opens) - w * length) / (2.0 * np.pi)
    F_s = (
        0.5 * length
        - 0.25 * (np.sin(2.0 * opens) - np.sin(2.0 * closes))
        + w * (np.cos(opens) - np.cos(closes))
    )
    F_c = 0.5 * (np.sin(opens) ** 2 - np.sin(closes) ** 2) - w * (np.sin(opens) - np.sin(closes))
    exact = F_b, F_s / np.pi, F_c / np.pi
    np.testing.assert_allclose(fourier_coefficients(ratio * b, b, phi), exact, atol=20.0 / b + 1e-14)


@pytest.mark.parametrize("name", CLASSES)
def test_half_a_turn_of_phase_turns_the_mean(name):
    """phi to phi + pi: the same loop upside down. pi is not exact in float64, and large b magnifies it."""
    n0, b, phi = points(name, 1000)
    keep = b <= 10.0
    here, there = (np.array(fourier_coefficients(n0, b, p))[:, keep] for p in (phi, phi + np.pi))
    allowed = 4.0 / np.pi * b[keep] * np.spacing(np.abs(phi[keep]) + np.pi) + 2e-15
    assert np.all(np.abs(here - np.array([[-1.0], [1.0], [1.0]]) * there) <= allowed)


@pytest.mark.parametrize("name", [*CLASSES, "largest", "between_sequences_at_large_b"])
def test_bounds(name):
    assert_bounds(*points(name, 5000))


def test_bounds_on_every_boundary():
    assert_bounds(*all_boundaries())


def assert_bounds(n0, b, phi):
    """Dissipates, and has no force beyond the normal load's."""
    F_b, F_s, F_c = fourier_coefficients(n0, b, phi)
    assert np.all(F_c >= -1e-15)
    greatest = np.maximum(n0 + b, 0.0)
    assert np.all(np.abs(F_b) <= np.minimum(greatest, 2.0) + 1e-15)
    assert np.all(np.hypot(F_s, F_c) <= 4.0 / np.pi * greatest + 1e-15)
