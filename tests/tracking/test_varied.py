"""The rates of a balance by a number of its scene, where the number has moved from what the scene says."""

from __future__ import annotations

import numpy as np
import pytest

import fcm
from fcm.harmonic_balance.system import System
from fcm.scene import scene_from_dict
from fcm.scene.draft import number_of
from fcm.tracking.parameter_line import ParameterLine, VariedBalance, line_along

Z = np.array([0.0, 0.0, 1.0, 0.0, 0.0, 0.5, 1.2])
STEP = 1e-5


def residual(varied, s):
    varied.set_parameter(s)
    varied.balance.evaluate(Z)
    return np.array(varied.balance.residual)


@pytest.mark.parametrize(
    "key, s",
    [("modal.frequency.0", 0.5), ("force.u.phase", 2.0), ("level", 1.3), ("force.v.amplitude", 0.4)],
)
def test_rates_are_those_where_the_number_is(key, s):
    system = System(fcm.load_scene("yang1998-n5"))
    varied = VariedBalance(system, line_along(number_of(system.scene, key)))
    difference = (residual(varied, s + STEP) - residual(varied, s - STEP)) / (2.0 * STEP)
    residual(varied, s)
    assert np.abs(difference).max() > 0.01
    assert varied.by_s(Z).residual == pytest.approx(difference, rel=1e-6, abs=1e-8)


@pytest.mark.parametrize(
    "key, s",
    [
        ("level", 1.3),
        ("force.v.amplitude", -0.4),
        ("contact.shroud.n_0", 7.0),
        ("contact.shroud.mu", 0.1),
        ("contact.shroud.k_v", 2.5),
    ],
)
def test_a_balance_whose_number_moved_is_that_of_the_scene_with_it(key, s):
    scene = fcm.load_scene("yang1998-n5")
    number = number_of(scene, key)
    varied, there = (
        VariedBalance(System(scene), line_along(number)),
        System(number.put(scene, s)).new_balance(),
    )
    residual(varied, 0.9)
    there.evaluate(Z)
    assert residual(varied, s) == pytest.approx(np.array(there.residual), rel=1e-14, abs=1e-15)
    assert np.array(varied.balance.jacobian) == pytest.approx(np.array(there.jacobian), rel=1e-14, abs=1e-15)
    assert number.value(varied.system.scene) == pytest.approx(s) or key == "level"


@pytest.mark.parametrize("load", ["n_0", "gap"])  # a gap is a preload by the product with k_v
def test_numbers_that_move_together_are_those_of_the_scene_with_them(load):
    contact = {"name": "shroud", "tangential": "u", "normal": "v", "mu": 0.4, "k_u": 1.0, "k_v": 1.0}
    scene = scene_from_dict(
        {
            "modal": {"dofs": ["u", "v"], "frequency": [1.0, 1.2], "damping": 0.01, "shapes": np.eye(2)},
            "contact": [contact | {load: 0.3}],
            "force": [{"dof": "u", "amplitude": 1.0}],
            "response": {"frequency": [0.5, 1.5]},
        }
    )
    numbers = tuple(number_of(scene, f"contact.shroud.{key}") for key in (load, "mu", "k_v"))
    line = ParameterLine(numbers, np.array([0.2, 0.5, 1.5]), np.array([0.4, -0.1, 0.3]))
    varied = VariedBalance(System(scene), line)
    for s in (0.7, -0.2):
        there, by_hand = System(line.scene(scene, s)).new_balance(), residual(varied, s)
        there.evaluate(Z)
        assert by_hand == pytest.approx(np.array(there.residual), rel=1e-14, abs=1e-15)
        difference = (residual(varied, s + STEP) - residual(varied, s - STEP)) / (2.0 * STEP)
        residual(varied, s)
        assert np.abs(difference).max() > 0.01
        assert varied.by_s(Z).residual == pytest.approx(difference, rel=1e-6, abs=1e-8)
