"""Where stability changes without a fold, and what is said of the motion there."""

import numpy as np

from fcm.response import trace
from fcm.scene import scene_from_dict
from fcm.shooting import periodic

IMPACTS = {
    "modal": {
        "dofs": ["v", "u"],
        "frequency": [1.0, 1.2582842, 2.85299346, 5.54227839],
        "damping": [0.04331497, 0.04100975, 0.02242228, 0.00786675],
        "shapes": [
            [-0.48189249, 0.47660481], [-0.32858932, -1.22364971], [-0.70504428, 0.76333511],
            [0.12380564, -0.44183514],
        ],
    },
    "contact": [
        {"name": "c", "tangential": "u", "normal": "v", "mu": 0.041613, "k_u": 6.75169, "k_v": 28.95705,
         "n_0": -15.09486},
    ],
    "force": [{"dof": "u", "amplitude": 1.0}],
    "response": {"frequency": [1.24, 1.29]},
}  # fmt: skip


def test_what_further_harmonics_move_a_crossing_across_is_not_called_stable():
    """Beside light impacts the period doubles up to 1.2695 rad/s, and up to 1.2650 by the balance with five
    harmonics."""
    scene = scene_from_dict(IMPACTS)
    (curve,) = trace(scene, harmonics=5).curves
    exact = _stable_from_above(scene, curve.frequency)
    told = curve.stable
    assert not (told[~exact] == 1.0).any() and not (told[exact] == 0.0).any()
    assert (told == 1.0).sum() > 10 < (told == 0.0).sum() and np.isnan(told).sum() < 6


def test_where_stability_changes_the_point_belongs_to_neither_side_and_the_jump_is_told():
    scene = scene_from_dict(IMPACTS | {"response": {"frequency": [1.38, 1.41]}})
    (curve,) = trace(scene, harmonics=9).curves
    (at,) = np.flatnonzero(np.isnan(curve.stable))
    np.testing.assert_array_equal(curve.stable[:at], 1.0)
    np.testing.assert_array_equal(curve.stable[at + 1 :], 0.0)
    sides = np.delete(curve.frequency, at)
    np.testing.assert_array_equal(_stable_from_above(scene, sides), sides < curve.frequency[at])
    swept = curve.swept()
    assert swept.jumps[0].frequency == curve.frequency[at] and swept.unknown == []


def _stable_from_above(scene, frequencies):
    """Of the exact motion at frequencies that rise, followed from the last to the first."""
    found, state = [], None
    for omega in frequencies[::-1]:
        orbit = periodic(scene, omega, state)
        state = orbit.state
        found.append(orbit.stable)
    return np.array(found[::-1])
