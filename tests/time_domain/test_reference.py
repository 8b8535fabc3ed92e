"""The exact motion against two independent integrations."""

from __future__ import annotations

import numpy as np
import pytest

from fcm.time_domain import simulate

from .cases import SCENES
from .reference import integrate, marched

CASES = [
    ("n_0 = 5", 1.3),
    ("n_0 = -2", 1.15),
    ("one mode", 1.1),
    ("two contacts", 1.3),
    ("two contacts", 2.3),
    ("three harmonics", 0.9),
]


@pytest.mark.slow
@pytest.mark.parametrize(("name", "omega"), CASES)
def test_against_solve_ivp_with_events(name, omega):
    motion = simulate(SCENES[name], omega, 20)
    times = np.linspace(0.0, motion.duration, 401)[:-1]
    expected = integrate(SCENES[name], omega, 20, times)
    assert len(motion.transitions()) > 20
    assert np.abs(motion.displacement(times) - expected).max() < 1e-10 * np.abs(expected).max()


@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "omega"), [("n_0 = 5", 1.3), ("two contacts", 1.3), ("three harmonics", 0.9)]
)
def test_a_fixed_step_march_converges_to_it(name, omega):
    """A scheme of second order: four times nearer with every halving of its step."""
    motion = simulate(SCENES[name], omega, 5)
    times = np.linspace(0.0, motion.duration, 101)
    exact = motion.displacement(times)
    errors = []
    for steps in (200, 400, 800):
        errors.append(np.abs(marched(SCENES[name], omega, 5, steps)[:: steps // 20] - exact).max())
    assert errors[0] / errors[1] == pytest.approx(4.0, abs=1.0)
    assert errors[1] / errors[2] == pytest.approx(4.0, abs=1.0)
    extrapolated = errors[2] / np.abs(exact).max()
    assert extrapolated < 1e-3
