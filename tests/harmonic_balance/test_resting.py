"""Stability where no contact slips, but an extreme of its limit just holds the slider."""

from __future__ import annotations

import numpy as np
import pytest

from fcm.response import trace
from fcm.response.exact import trace_exact
from fcm.scene import scene_from_dict
from fcm.time_domain import State, simulate

SPAN, OMEGA = (1.5, 1.58), 1.5333
SHAPES = np.array([[0.6, 0.5, 0.6], [1.0, -0.3, 0.2], [0.3, 0.8, -0.9]])
NATURAL, DAMPING = np.array([0.4, 1.0, 2.3]), np.array([0.02, 0.02, 0.01])
ALONG, ACROSS = SHAPES @ [1.0, 0.0, -0.5], SHAPES @ [0.0, 1.0, 0.0]


def wedged():
    """A contact whose load the residual friction raises by more than its limit needs: it can lock itself."""
    contact = {"name": "c", "tangential": {"x": 1.0, "z": -0.5}, "normal": "y"}
    return scene_from_dict(
        {
            "modal": {
                "dofs": ["x", "y", "z"],
                "frequency": NATURAL.tolist(),
                "damping": DAMPING.tolist(),
                "shapes": SHAPES.tolist(),
            },
            "contact": [contact | {"mu": 1e3, "k_u": 2.0, "k_v": 1.0, "n_0": 1.0}],
            "force": [{"dof": "z", "amplitude": 1.0}],
            "response": {"frequency": list(SPAN), "harmonics": 1},
        }
    )


def stuck(omega):
    """The response of the structure with the contact's springs, linear."""
    stiffness = np.diag(NATURAL**2) + 2.0 * np.outer(ALONG, ALONG) + 1.0 * np.outer(ACROSS, ACROSS)
    dynamic = stiffness - omega**2 * np.eye(3) + 2j * omega * np.diag(DAMPING * NATURAL)
    return np.linalg.solve(dynamic, SHAPES @ [0.0, 0.0, 1.0])


def test_the_motion_with_a_slider_held_at_its_limit_is_stable():
    """With less residual friction the slider rests, in the same linear motion, to which what is disturbed
    comes back: no more of the motion is asked for than of any other that always sticks."""
    (curve,) = trace(wedged()).curves
    assert set(curve.regime[:, 0]) == {"E"} and (curve.stable == 1.0).all()
    linear = [np.abs(stuck(omega) @ SHAPES) for omega in curve.frequency]
    assert curve.amplitude == pytest.approx(np.array(linear), rel=1e-9)
    assert np.ptp(curve.mean[:, 1]) > 0.01  # the slider is held: the load would be lost without its friction
    rest = simulate(wedged(), OMEGA, 400)
    for size in (-0.1, 0.1):
        begin = State(rest.end.q * (1.0 + size), rest.end.velocity * (1.0 - size), rest.end.friction)
        amplitude = simulate(wedged(), OMEGA, 400, begin).measures(last=1)[0].amplitude
        assert amplitude == pytest.approx(np.abs(stuck(OMEGA) @ SHAPES), rel=1e-6)


def beside_a_smooth_one(mu):
    """A slider held by its limit, beside a contact that slides to and fro with a friction mu."""
    shapes = [[-0.712, -0.985, -0.777, 0.236, -0.29, -0.707], [-0.843, 0.722, 0.089, 0.684, 0.264, -1.744]]
    return scene_from_dict(
        {
            "modal": {
                "dofs": [f"d{i}" for i in range(6)],
                "frequency": [1.0, 6.04],
                "damping": [0.00057, 0.0182],
                "shapes": shapes,
            },
            "contact": [
                {"name": "tight", "tangential": "d1", "normal": "d4"}
                | {"mu": 1.69, "k_u": 93.8, "k_v": 694.0, "n_0": 0.011},
                {"name": "smooth", "tangential": "d3", "normal": "d1"}
                | {"mu": mu, "k_u": 0.224, "k_v": 0.0252, "n_0": 64.2},
            ],
            "force": [{"dof": "d5", "amplitude": 1.0}],
            "response": {"frequency": [0.391, 1.96], "harmonics": 1},
        }
    )


@pytest.mark.slow
def test_a_contact_that_slides_without_friction_takes_part_in_no_change():
    """The motion is linear as without it, whatever else holds a slider: its exact multipliers are below 1."""
    scene = beside_a_smooth_one(0.0)
    (curve,) = trace(scene).curves
    at = [1.87, 1.9, 1.95]
    (exact,) = trace_exact(scene, at).curves
    held = curve.regime[:, 0] == "E"  # beside a branch on which the slider slips
    assert held.any() and (curve.stable[held] == 1.0).all()
    for omega in at:  # beside motions of several periods
        found = np.interp(omega, curve.frequency[held], curve.amplitude[held, 5])
        same = (exact.frequency == omega) & (np.abs(exact.amplitude[:, 5] / found - 1.0) < 1e-3)
        assert same.any() and (exact.stable[same] == 1.0).all() and (exact.orbits.repeats[same] == 1).all()


@pytest.mark.parametrize("mu", [1e-9, 1e-6])
def test_what_flips_only_while_a_slider_is_pushed_is_not_called_unstable(mu):
    """The exact motion, that of no friction but for mu, is stable; which the linearised ones cannot tell."""
    (curve,) = trace(beside_a_smooth_one(mu)).curves
    (exact,) = trace_exact(beside_a_smooth_one(mu), [1.9]).curves
    assert exact.stable[0] == 1.0
    assert not (curve.stable == 0.0).any()
