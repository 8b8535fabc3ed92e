"""Higher harmonics against a discrete Fourier transform of the loop."""

import numpy as np
import pytest

from fcm.contact import hysteresis_loop
from fcm.contact.harmonics import friction_harmonics, normal_harmonics

SAMPLES = 1 << 14
THETA = 2.0 * np.pi * np.arange(SAMPLES) / SAMPLES
ORDERS = [2, 3, 4, 5, 8]


def transformed(values):
    """F_k of the sum of Im(F_k exp(i k theta))."""
    return 2j * np.fft.rfft(values)[ORDERS] / SAMPLES


@pytest.mark.parametrize("seed", range(40))
def test_friction_harmonics(seed):
    rng = np.random.default_rng(seed)
    b = rng.uniform(0.0, 3.0)
    n0, phi = rng.uniform(-b, b + 0.8), rng.uniform(-np.pi, np.pi)
    loop = hysteresis_loop(n0, b, phi)
    force = friction_harmonics(np.array([n0]), np.array([b]), np.array([phi]), ORDERS)[:, 0]
    assert force == pytest.approx(transformed(loop.force(THETA)), abs=2e-7)


@pytest.mark.parametrize("n0_star", [-3.0, -1.0, -0.7, 0.0, 0.4, 0.999, 1.0, 5.0])
def test_normal_harmonics(n0_star):
    load = normal_harmonics(np.array([n0_star]), ORDERS)[:, 0]
    assert load == pytest.approx(transformed(np.maximum(n0_star + np.sin(THETA), 0.0)), abs=2e-7)
