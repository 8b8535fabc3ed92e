"""Section 4.3 and 4.4 by simulation: peaks, the two states at n_0 = 5, figure 15."""

from __future__ import annotations

import pytest

from fcm.response import trace
from fcm.scene import Phase
from fcm.time_domain import simulate, simulate_phases

from .cases import yang


def swept(scene, frequencies, cycles=150):
    """Amplitude of u at the end of each frequency, each continuing the last."""
    state, out = None, {}
    for omega in frequencies:
        motion = simulate(scene, omega, cycles, state)
        state = motion.end
        out[omega] = motion.measures(last=1)[0].amplitude[0]
    return out, state


@pytest.mark.parametrize(("n_0", "peak"), [(90.0, 34.2235), (100.0, 35.1325)])
def test_peak_near_the_fully_stuck_case(n_0, peak):
    scene = yang(n_0)
    omega = trace(scene, "closed-form").curves[0].peaks["u"][1]
    motion = simulate(scene, omega, 600)
    assert motion.measures(last=1)[0].amplitude[0] == pytest.approx(peak, abs=1e-4)


def test_the_upper_state_at_n_0_5_ends_between_1195_and_1190():
    found, _ = swept(yang(), [1.25, 1.24, 1.23, 1.22, 1.21, 1.2, 1.195, 1.19])
    assert found[1.195] == pytest.approx(14.7229, abs=1e-3)
    assert found[1.19] == pytest.approx(1.7088, abs=1e-3)
    assert max(found.values()) == pytest.approx(14.8, abs=0.1)


def test_the_lower_state_at_n_0_5_ends_between_1235_and_1240():
    found, _ = swept(yang(), [1.2, 1.21, 1.22, 1.23, 1.235, 1.24])
    assert found[1.235] == pytest.approx(2.5641, abs=1e-3)
    assert found[1.24] > 10.0


def test_figure_15():
    """Upper branch at 1.195; lost at 1.190; not found again at 1.195."""
    _, start = swept(yang(), [1.25, 1.23, 1.21, 1.2], 60)
    phases = [Phase(1.195, 100), Phase(1.19, 120), Phase(1.195, 30)]
    motion = simulate_phases(yang(), phases, start)
    amplitude = [m.amplitude[0] for m in motion.measures()]
    assert len(amplitude) == 250
    assert amplitude[99] == pytest.approx(14.73, abs=0.02)
    assert amplitude[219] < 2.0
    assert amplitude[249] == pytest.approx(1.74, abs=0.03)
