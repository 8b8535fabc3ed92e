"""The resistance to a slow drift against the friction law marched in small steps."""

import numpy as np
import pytest

from fcm.contact.drag import drift_resistance

STEPS, CYCLES, DRIFT = 8000, 3, 1e-2  # steps a cycle; the loop is steady from the second cycle on
MARCHED = 3e-4  # error of the marched difference: DRIFT squared, and a step [rad], times the force


def marched_mean(n0, b, phi, drift):
    """Mean of f over the last cycle: trial f + du, clipped to the limits (return map)."""
    theta = np.linspace(0.0, 2.0 * np.pi * CYCLES, STEPS * CYCLES + 1)
    du = np.diff(np.sin(theta) + drift * theta)
    limit = np.maximum(n0 + b * np.sin(theta[1:] + phi), 0.0)
    f, forces = 0.0, []
    for step, n in zip(du, limit, strict=True):
        f = min(max(f + step, -n), n)
        forces.append(f)
    return np.mean(forces[-STEPS:])


@pytest.mark.parametrize(
    ("n0", "b", "phi"),
    [
        (0.5, 0.0, 0.0),  # constant load
        (0.84, 0.47, -0.46),
        (-0.27, 1.13, 0.23),  # a gap
        (0.24, 0.2, -0.58),
        (0.04, 0.73, 2.88),
        (0.63, 0.92, 2.5),
    ],
)
def test_against_the_marched_law(n0, b, phi):
    forward, backward = (marched_mean(n0, b, phi, drift) for drift in (DRIFT, -DRIFT))
    found = drift_resistance(np.array([n0]), np.array([b]), np.array([phi]))[0]
    assert found == pytest.approx((forward - backward) / (2.0 * DRIFT), abs=MARCHED)


def test_an_open_contact_resists_nothing_and_a_stuck_one_most():
    n0, b = np.array([-2.0, 0.3, 5.0]), np.array([1.0, 0.3, 1.0])
    open_, slipping, stuck = drift_resistance(n0, b, np.full(3, 0.7))
    assert open_ == 0.0 < slipping < stuck == pytest.approx(np.pi)
