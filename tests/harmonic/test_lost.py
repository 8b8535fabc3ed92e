"""How far the frequencies are off at which stability is lost without a fold, against many harmonics."""

import numpy as np
import pytest

from fcm.harmonic.choice import estimated
from fcm.harmonic.lost import lost_along
from fcm.harmonic.stability import stability
from fcm.harmonic.system import System
from fcm.orbit import periodic
from fcm.response.exact import trace_exact
from fcm.response.trace import traced_curve
from fcm.response.wanted import Wanted
from fcm.scene import scene_from_dict

MANY = tuple(range(1, 21))
NEGLIGIBLE = 2e-6  # an error: below, a crossing may by chance be nearer than is known of it


def oscillator(frequency, damping, shapes, contact, force, span):
    """Two modes u, v with one contact c, forced along v."""
    return scene_from_dict(
        {
            "modal": {"dofs": ["u", "v"], "frequency": frequency, "damping": damping, "shapes": shapes},
            "contact": [{"name": "c", "tangential": "u", "normal": "v", **contact}],
            "force": [{"dof": "v", "amplitude": force[0], "phase": force[1]}],
            "response": {"frequency": span},
        }
    )


@pytest.fixture(scope="module")
def flips():
    """A period doubles at two frequencies, with one harmonic at others."""
    return oscillator(
        [1.0, 4.8299], [0.00367, 0.01017], [[0.44, 1.0], [-0.527, -0.463]],
        {"mu": 0.0705, "k_u": 1.164, "k_v": 2.91, "n_0": 4.633}, (1.994, 1.137), [1.55, 2.1322],
    )  # fmt: skip


def lost(scene, harmonics):
    system = System(scene, harmonics)
    paths = estimated(system, np.inf).traced.branches.paths
    return [one for path in paths for one in lost_along(system, path, stability(system, path).crossings)]


@pytest.mark.parametrize("count", [2, 3, 5])
def test_the_error_is_what_twenty_harmonics_change(flips, count):
    found = lost(flips, tuple(range(1, count + 1)))
    true = np.array([one.frequency for one in lost(flips, MANY)])
    assert len(found) == len(true) >= 2
    for one in found:
        off = np.abs(true / one.frequency - 1.0).min()
        assert off / 2.0 < one.error < 2.0 * max(off, NEGLIGIBLE)


@pytest.fixture(scope="module")
def bouncing():
    """Three modes and a gap without friction: a period doubles where ten harmonics, with which peaks and
    folds are within 1e-2, have that 4 % too early."""
    contact = {"mu": 0.0, "k_u": 0.6798, "k_v": 6.765, "n_0": -1.03}
    found = {
        "modal": {
            "dofs": ["d0", "d1", "d2"],
            "frequency": [1.0, 2.1223, 4.2626],
            "damping": [0.0048, 0.0045, 0.05735],
            "shapes": [[-0.14, 1.113, 0.072], [0.81, 0.692, 1.257], [1.672, -0.39, -1.218]],
        },
        "contact": [
            {
                "name": "c",
                "tangential": {"d1": -0.404, "d2": 0.136},
                "normal": {"d1": -1.205, "d2": -0.473},
                **contact,
            }
        ],
        "force": [
            {"dof": "d1", "amplitude": 0.6597, "phase": 4.0686},
            {"dof": "d1", "amplitude": 0.384, "phase": 1.2946},
        ],
        "response": {"frequency": [0.6828, 2.6181]},
    }
    return scene_from_dict(found)


def test_the_accuracy_holds_for_where_stability_is_lost(bouncing):
    """Swept upwards, the exact motion repeats after one period at 0.742 rad/s, and at 0.757 no more."""
    curve = traced_curve(bouncing, Wanted(None, 1e-2))
    first = next(one.frequency for one in curve.jumps() if one.sweep == "up")
    (exact,) = trace_exact(bouncing, (0.70, 0.72, 0.735, 0.742, 0.757)).curves
    up = exact.orbits.repeats[:5]
    assert up[:4].tolist() == [1.0] * 4 and up[4] != 1.0
    assert 0.742 * (1.0 - 1e-2) < first < 0.757 * (1.0 + 1e-2)
    assert not curve.short_of and not any(one.sweep == "up" for one in curve.swept().untold)


def test_stability_is_not_said_to_be_lost_where_that_cannot_be_told(bouncing):
    """With six harmonics, which 0.1 takes, multipliers are above 1 long before those of the exact motion."""
    curve = traced_curve(bouncing, Wanted(None, 0.1))
    held = [periodic(bouncing, omega).stable for omega in (0.72, 0.735, 0.742)]
    assert all(held)
    assert not (curve.stable[(curve.frequency > 0.7) & (curve.frequency < 0.742)] == 0.0).any()
    assert any(one.sweep == "up" and one.start < 0.742 and one.end > 0.757 for one in curve.swept().untold)
