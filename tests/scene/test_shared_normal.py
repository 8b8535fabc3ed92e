"""Several contacts along one normal: their preload and normal stiffness add up, which is said."""

from __future__ import annotations

import pytest

import fcm
from fcm.scene import scene_from_dict

CONTACT = {"mu": 0.3, "k_u": 1.0, "k_v": 2.0, "n_0": 5.0}
NORMAL = {"az": 1.0, "bz": -1.0}
SAID = "have the same normal displacement and different tangential ones"


def scene(*contacts):
    dofs = ["ax", "ay", "az", "bx", "by", "bz"]
    shapes = [[1.0 if i == j else 0.1 for j in range(6)] for i in range(6)]
    data = {
        "modal": {
            "dofs": dofs,
            "frequency": [1.0 + 0.3 * i for i in range(6)],
            "damping": 0.05,
            "shapes": shapes,
        },
        "contact": [CONTACT | {"normal": NORMAL, "name": f"c{i}"} | one for i, one in enumerate(contacts)],
        "force": [{"dof": "ax", "amplitude": 1.0}, {"dof": "az", "amplitude": 2.0}],
        "response": {"frequency": [0.5, 1.2], "harmonics": 1, "max_step": 0.2},
    }
    return scene_from_dict(data)


X, Y = {"tangential": {"ax": 1.0, "bx": -1.0}}, {"tangential": {"ay": 1.0, "by": -1.0}}
TURNED = {"normal": {"az": -3.0, "bz": 3.0}}


@pytest.mark.parametrize("other", [Y, Y | TURNED])
def test_two_directions_of_one_place_are_told_what_to_write(other):
    (note,) = (one for one in scene(X, other).notes if SAID in one)
    assert 'contacts "c0" and "c1"' in note
    assert 'write it once with two directions, as in tangential = ["x", "y"]' in note


@pytest.mark.parametrize(
    "contacts",
    [
        (X,),
        (X, X),  # layers of one joint
        (X, X | TURNED | {"tangential": {"ax": -2.0, "bx": 2.0}}),
        (X, Y | {"normal": {"az": 1.0}}),  # another place
        (X, Y | {"k_v": 0.0, "n_0": 0.0}),
        (X, Y | {"mu": 0.0}),
    ],
)
def test_others_are_not(contacts):
    assert not any(SAID in one for one in scene(*contacts).notes)


def test_two_contacts_of_one_place_press_twice():
    """So that a second one, which holds nothing along itself, changes the answer."""
    still = {"tangential": {"ay": 1.0}, "k_u": 0.0, "mu": 1.0}
    one, two = (fcm.respond(each, "closed-form") for each in (scene(X), scene(X, Y | still)))
    peaks = [float(each["peak_amplitude"].sel(dof="az")[0]) for each in (one, two)]
    assert abs(peaks[1] / peaks[0] - 1.0) > 1e-2
