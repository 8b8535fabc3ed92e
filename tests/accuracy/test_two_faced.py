"""A shroud with two faces: even harmonics move its contacts against each other, and the output hardly.

The spectrum at the output does not show that they change its peak.
"""

from __future__ import annotations

import numpy as np
import pytest

import fcm
from fcm.accuracy.options import RefinementOptions
from fcm.accuracy.refinement import refined_response
from fcm.accuracy.required_harmonics import RequiredHarmonics, needed
from fcm.harmonic_balance.system import System
from fcm.scene.load import scene_from_dict

ACCURACY = 1e-2


def two_faced(preload):
    face = {"mu": 0.3, "k_u": 2.8, "k_v": 2.8, "n_0": preload}
    right = {"tangential": {"x": 1.0, "r": -1.42}, "normal": {"y": 1.0}}
    left = {"tangential": {"x": 1.0, "r": 1.42}, "normal": {"y": -1.0}}
    return scene_from_dict(
        {
            "modal": {
                "dofs": ["x", "y", "r"],
                "frequency": [1.0, 1.057, 7.93, 5.306],
                "damping": 0.01,
                "shapes": [[1, 0, 0], [0, 1, 0], [0, 0, 1], [0.7, 0.3, 0]],
            },
            "contact": [{"name": "right", **right, **face}, {"name": "left", **left, **face}],
            "force": [{"dof": dof, "amplitude": 1.813} for dof in ("x", "y")],
            "response": {"frequency": [0.7, 2.2], "output": ["x", "y"]},
        }
    )


def test_harmonics_that_move_the_contacts_alone_are_taken():
    """Without the even harmonics the peak of x is 80 % too high."""
    one = two_faced(4.04)
    found = refined_response(System(one), ACCURACY)
    exact = fcm.respond(one, method="exact").amplitude.values[0]
    error = found.quantities[0].amplitude.max(axis=0) / np.nanmax(exact, axis=0) - 1.0
    assert found.reached
    assert np.abs(error[:2]).max() < ACCURACY
    by_the_spectrum = refined_response(System(one), ACCURACY, options=RefinementOptions(max_gain=np.inf))
    assert not by_the_spectrum.reached


def required(change, share):
    """What is required if the reference has harmonics up to 9, the change known."""
    return RequiredHarmonics(change, True, np.array(share), tuple(range(1, 10)))


def test_where_the_spectrum_does_not_explain_the_change_low_harmonics_are_taken_without_gaps():
    odd = np.zeros(49)
    odd[4:9:2] = 0.01, 0.005, 0.002
    assert needed(required(0.02, odd), (1, 2, 3), ACCURACY) == (1, 2, 3, 5, 7)
    assert needed(required(4.0, odd), (1, 2, 3), ACCURACY) == (1, 2, 3, 4, 5, 6, 7, 9)


@pytest.mark.parametrize("preload", [6.0, 12.0])
def test_where_no_contact_slips_or_opens_the_truncation_error_is_zero(preload):
    """The difference of a peak elsewhere counted: 0.35 and 0.065."""
    found = fcm.respond(two_faced(preload), harmonics=1)
    linear = (found.regime.values[0] == "E").all(axis=1)
    error = found.truncation_error.values[0]
    assert linear.sum() > 20 and np.all(error[linear] == 0.0)
    assert np.nanmax(error) > 0.1
