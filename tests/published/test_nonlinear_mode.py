"""The clamped beam with a friction contact of NLvib, another tool: its first nonlinear mode.

L = 0.71 m, height 0.05 m, width 0.06 m, E = 141.225 GPa, density 7850 kg/m^3, 15 nodes, a Jenkins element of
1e8 N/m and 106 N at the sixth, seven harmonics.
"""

import numpy as np
import pytest

from fcm import load_scene
from fcm.continuation import Status
from fcm.harmonic_balance.system import System
from fcm.nonlinear_modes.backbone import nonlinear_mode

PERCENT = 0.01


@pytest.fixture(scope="module")
def mode():
    system = System(load_scene("beam").in_use(), tuple(range(1, 8)))
    return nonlinear_mode(system, 1, (1e-6, 1e-2), 0.05)


def test_stuck_and_free_frequencies(mode):
    assert mode.omega[0] == pytest.approx(707.955, abs=1e-3)
    assert mode.omega[-1] == pytest.approx(427.007, rel=0.1 * PERCENT)  # on the way there
    assert mode.system.linear.natural[0] == pytest.approx(427.007, abs=1e-3)
    assert mode.damping[0] == pytest.approx(0.0, abs=1e-12)


def test_greatest_damping(mode):
    top = mode.damping.argmax()
    assert mode.damping[top] == pytest.approx(0.186, rel=PERCENT)
    assert mode.omega[top] == pytest.approx(519.0, rel=PERCENT)


@pytest.mark.parametrize(("omega", "damping"), [(503.4, 0.184), (429.6, 0.0331)])
def test_damping_on_the_way_to_sliding(mode, omega, damping):
    after = slice(mode.damping.argmax(), None)
    found = np.interp(omega, mode.omega[after][::-1], mode.damping[after][::-1])
    assert found == pytest.approx(damping, rel=PERCENT)


def test_even_harmonics_that_are_zero_do_not_stop_the_mode():
    """Motions with even harmonics branch off at 504 rad/s; the mode goes on, and solves all equations."""
    system = System(load_scene("beam").in_use(), tuple(range(1, 10)))
    found = nonlinear_mode(system, 1, (1e-6, 1e-2), 0.05)
    assert found.path.status is Status.COMPLETE and found.omega[-1] == pytest.approx(427.07, abs=0.01)
    assert np.abs(found.Q[:, 1::2]).max() < 1e-12 and np.abs(found.mean).max() < 1e-12
    for z in found.path.z[::10]:
        found.problem.evaluate(z)
        assert np.abs(np.asarray(found.problem.residual)).max() < 1e-11 * found.omega[0]
