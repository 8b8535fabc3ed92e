"""How far the frequencies are off at which stability is lost without a fold, against many harmonics."""

import numpy as np
import pytest

from fcm.accuracy.stability_limits import StabilityLimit, distances_from, stability_limits
from fcm.harmonic_balance.system import System
from fcm.response.exact import trace_exact
from fcm.response.request import Request
from fcm.response.trace import traced_curve
from fcm.scene import scene_from_dict
from fcm.shooting import periodic
from fcm.stability.bifurcations import stability

from .calibration import with_estimated_errors

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
    paths = with_estimated_errors(system, np.inf).traced.branches.paths
    return [
        one for path in paths for one in stability_limits(system, path, stability(system, path).crossings)
    ]


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


@pytest.mark.slow
def test_the_accuracy_holds_for_where_stability_is_lost(bouncing):
    """Swept upwards, the exact motion repeats after one period at 0.742 rad/s, and at 0.757 no more."""
    curve = traced_curve(bouncing, Request(None, 1e-2))
    first = next(one.frequency for one in curve.jumps() if one.sweep == "up")
    (exact,) = trace_exact(bouncing, (0.70, 0.72, 0.735, 0.742, 0.757)).curves
    up = exact.orbits.repeats[:5]
    assert up[:4].tolist() == [1.0] * 4 and up[4] != 1.0
    assert 0.742 * (1.0 - 1e-2) < first < 0.757 * (1.0 + 1e-2)
    assert not curve.short_of and not any(one.sweep == "up" for one in curve.swept().unknown)


@pytest.mark.slow
def test_stability_is_not_said_to_be_lost_where_that_cannot_be_told(bouncing):
    """With few harmonics, as 0.1 takes, multipliers are above 1 before those of the exact motion."""
    curve = traced_curve(bouncing, Request(None, 0.1))
    held = [periodic(bouncing, omega).stable for omega in (0.72, 0.735, 0.742)]
    assert all(held)
    assert not (curve.stable[(curve.frequency > 0.7) & (curve.frequency < 0.742)] == 0.0).any()
    unknown = [one for one in curve.swept().unknown if one.sweep == "up"]
    lost = [one.frequency for one in curve.jumps() if one.sweep == "up"]
    assert (
        any(one.start < 0.742 and one.end > 0.757 for one in unknown) or 0.9 * 0.742 < lost[0] < 1.1 * 0.757
    )


@pytest.mark.slow
def test_where_it_cannot_be_told_how_far_the_loss_of_stability_is_off_more_harmonics_are_taken():
    """Three harmonics, enough for peaks and folds, do not tell it; the exact motion is unstable between."""
    tangential = ({"x": 1.0}, {"y": -1.06, "x": 0.188}, {"x": 1.0})
    normal = ({"y": 1.0}, {"y": -0.506, "x": -0.334}, {"y": 1.0})
    numbers = ((0.526, 0.27, 5.43, 0.394), (0.249, 0.648, 0.428, -0.0483), (0.614, 0.57, 2.09, 0.0508))
    contacts = [
        {"name": name, "tangential": t, "normal": n} | dict(zip(("mu", "k_u", "k_v", "n_0"), of, strict=True))
        for name, t, n, of in zip("abc", tangential, normal, numbers, strict=True)
    ]
    scene = scene_from_dict(
        {
            "modal": {
                "dofs": ["x", "y"],
                "frequency": [1.0, 1.78, 3.38],
                "damping": [0.023, 0.00529, 0.00821],
                "shapes": [[-1.14, 0.0405], [0.551, 0.542], [0.914, -0.469]],
            },
            "contact": contacts,
            "force": [{"dof": "y", "amplitude": 1.0}],
            "response": {"frequency": [0.5, 2.2]},
        }
    )
    curve = traced_curve(scene, Request(None, 1e-2))
    assert not curve.short_of and len(curve.harmonics) > 3
    between = (curve.frequency > 0.885) & (curve.frequency < 0.9)
    assert [periodic(scene, omega).stable for omega in (0.885, 0.892, 0.9)] == [True, False, True]
    assert (curve.stable[between] == 0.0).any()


def test_a_crossing_that_fewer_harmonics_have_too_is_as_far_off_as_it_moved():
    """One that another is nearly as near to may be that other, and one that is told stays as it is."""
    fewer = [
        StabilityLimit(1.0, 0.1, (1, 2)),
        StabilityLimit(2.0, np.nan, (1, 2)),
        StabilityLimit(2.1, 0.1, (1, 2)),
    ]
    more = [
        StabilityLimit(1.001, np.nan, (1, 2, 3)),
        StabilityLimit(2.05, np.nan, (1, 2, 3)),
        StabilityLimit(2.3, 0.2, (1, 2, 3)),
    ]
    error = [one.error for one in distances_from(more, fewer)]
    assert error[0] == pytest.approx(1e-3, rel=1e-2) and np.isnan(error[1]) and error[2] == 0.2
    assert np.isnan(distances_from(more[:1], [])[0].error)
