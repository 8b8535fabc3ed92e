"""The functions of a contact that are zero at corners, against its motion sampled, and differences."""

import numpy as np
import pytest

from fcm.harmonic_balance.system import System
from fcm.scene import load_scene
from fcm.tracking.onset_functions import KINDS, LIMITS, onset

H = (1, 3)
X = np.array([0.3, 0.1, 1.0, -0.4, 0.5, 0.2, 0.2, 0.3, -0.1, 0.15])  # means, then u and v of each harmonic
FIELDS = ("mu", "k_u", "k_v", "n_0")
NUMBERS = (0.4, 1.3, 0.9, 2.0)


def law(numbers=NUMBERS):
    found = System(load_scene("yang1998-n5"), H).laws()[0]
    for field, value in zip(FIELDS, numbers, strict=True):
        setattr(found, field, value)
    return found


@pytest.mark.parametrize("kind", KINDS + LIMITS)
def test_value_and_slopes(kind):
    theta = np.linspace(0.0, 2.0 * np.pi, 20001)
    u, v = (
        X[i]
        + sum(
            (X[2 + 4 * j + 2 * i] + 1j * X[3 + 4 * j + 2 * i]) * np.exp(1j * h * theta)
            for j, h in enumerate(H)
        ).real
        for i in (0, 1)
    )
    mu, k_u, k_v, n_0 = NUMBERS
    load, push = n_0 + k_v * v, k_u * u
    upper, lower = (push + mu * load).min(), (push - mu * load).max()
    expected = dict(zip(KINDS + LIMITS, (load.min(), load.max(), upper - lower, upper, lower), strict=True))
    found = onset(law(), X, kind, H)
    assert found.value == pytest.approx(expected[kind], abs=1e-6)
    for i in range(X.size):
        step = 1e-6 * np.eye(X.size)[i]
        rise = onset(law(), X + step, kind, H).value - onset(law(), X - step, kind, H).value
        assert found.slope[i] == pytest.approx(rise / 2e-6, abs=1e-8)
    for i in range(4):
        ends = [tuple(n + by * (j == i) for j, n in enumerate(NUMBERS)) for by in (1e-6, -1e-6)]
        rise = np.subtract(*(onset(law(end), X, kind, H).value for end in ends))
        assert found.by_number[i] == pytest.approx(rise / 2e-6, abs=1e-8)
