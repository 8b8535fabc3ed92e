"""Values printed in Yang, Chu and Menq (1998)."""

import numpy as np
import pytest

from fcm import fourier_coefficients, hysteresis_loop

# Figure 5 counts its angle from the greatest displacement, u = A cos(theta): ours is 90 degrees ahead of it.
FIGURE_5 = {"b_bar": 0.4, "phi": np.radians(80.5)}
SLIP_ENDS = 22.9, 159.7  # degrees


@pytest.mark.parametrize("n0_bar", [0.41, 0.6, 0.9])
def test_figure_5_ends_of_slip(n0_bar):
    """Printed to 0.1 degrees, for every preload at which it slips without opening."""
    loop = hysteresis_loop(n0_bar, **FIGURE_5)
    assert loop.sequence == "EPEN"
    ends = np.mod(np.degrees(loop.angles[[2, 0]]) - 90.0, 360.0)
    assert ends == pytest.approx(SLIP_ENDS, abs=0.05)


def test_figure_5_slip_outlasts_one_reversal_and_stops_before_the_other():
    loop = hysteresis_loop(0.6, **FIGURE_5)
    assert loop.states(np.radians(90.0 + np.array([0.0, 10.0, 22.8]))).tolist() == ["P", "P", "P"]
    assert loop.states(np.radians(90.0 + np.array([159.8, 170.0, 180.0]))).tolist() == ["E", "E", "E"]


def test_figure_10_no_damping_in_phase_beyond_one():
    b, n0 = np.linspace(1.001, 4.0, 40), np.linspace(-2.0, 5.0, 71)[:, None]
    _, _, F_c = fourier_coefficients(n0, b, 0.0)
    np.testing.assert_allclose(F_c, 0.0, atol=1e-15)


def test_slip_limit_25():
    """2 n0 = sqrt(1 + b^2 - 2 b cos(phi)) + sqrt(1 + b^2 + 2 b cos(phi)): stuck above, slipping below."""
    b, phi = np.meshgrid(np.linspace(0.0, 0.9, 10), np.linspace(0.0, np.pi, 13))
    limit = 0.5 * sum(np.sqrt(1.0 + b**2 + s * 2.0 * b * np.cos(phi)) for s in (-1, 1))
    for n0, sequence in ((limit + 1e-9, "E"), (np.maximum(limit - 1e-9, b + 1e-12), "EPEN")):
        names = {hysteresis_loop(*x).sequence for x in zip(n0.flat, b.flat, phi.flat, strict=True)}
        assert names == {sequence}
