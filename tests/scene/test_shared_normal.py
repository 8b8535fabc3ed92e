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


DOUBLED = {"normal": {"az": 3.0, "bz": -3.0}}


@pytest.mark.parametrize("other", [Y, Y | DOUBLED])
def test_two_directions_of_one_place_are_told_what_to_write(other):
    (note,) = (one for one in scene(X, other).notes if SAID in one)
    assert 'contacts "c0" and "c1"' in note
    as_in = "tangential = [{ ax = 1, bx = -1 }, { ay = 1, by = -1 }]"
    assert f"write it once with two directions, as in {as_in}" in note
    written = [{"ax": 1, "bx": -1}, {"ay": 1, "by": -1}]
    assert not any(SAID in one for one in scene({"tangential": written}).notes)


def test_contacts_in_planes_are_not_told_to_be_one():
    """The first directions are the same, so that there were no two to write: a traceback."""
    planes = [{"tangential": [{"ax": 1.0, "bx": -1.0}, {one: 1.0, other: -1.0}]}
              for one, other in (("ay", "by"), ("az", "bz"))]  # fmt: skip
    (note,) = (one for one in scene(*planes).notes if SAID in one)
    assert note.endswith("as those of several contacts side by side")


def test_two_directions_of_pairs_of_nodes_are_axes():
    dofs = [f"{node}{axis}" for node in (1, 2) for axis in "xyz"]
    structure = {
        "dofs": dofs,
        "mass": [1.0] * 6,
        "stiffness": [1.0, 2.0, 3.0, 4.0, 5.0, 6.0],
        "damping": 0.01,
    }
    pairs = [CONTACT | {"name": n, "nodes": [[1, 2]], "tangential": n, "normal": "z"} for n in "xy"]
    rest = {"force": [{"dof": "1x", "amplitude": 1.0}], "response": {"frequency": [0.5, 1.2]}}
    (note,) = (
        one for one in scene_from_dict({"structure": structure, "contact": pairs} | rest).notes if SAID in one
    )
    assert note.endswith('as in tangential = ["x", "y"]')


@pytest.mark.parametrize(
    ("contact", "asked"),
    [
        (X | {"normal": {"ax": -2.0, "bx": 2.0}}, True),
        ({"tangential": [{"ax": 1.0}, {"ay": 1.0}], "normal": {"ax": 0.6, "ay": 0.8}}, True),
        (X | {"normal": {"ax": 1.0, "bx": -1.0}, "k_v": 0.0}, False),  # a constant load
        (X | {"normal": {"ax": 1.0, "bx": -1.0}, "mu": 0.0}, False),  # no friction
        (X | {"normal": {"ax": 1.0, "bx": -0.9}}, True),  # a wrong weight
        (X | {"normal": {"az": 1.0, "ax": 0.005}}, False),  # rounded
        (X, False),
    ],
)
def test_of_a_normal_along_which_a_contact_slides_it_is_said_what_that_means(contact, asked):
    said = [one for one in scene(contact).notes if "slip changes the normal load" in one]
    assert len(said) == asked and all('contact "c0"' in one for one in said)


def test_a_normal_that_leans_is_told_with_its_angle():
    one = {"tangential": {"ax": 2.0}, "normal": {"ax": 0.5, "az": 3.0**0.5 / 2.0}}
    plane = {"tangential": [{"ax": 1.0}, {"ay": 1.0}], "normal": {"ax": 0.2, "ay": 0.2, "az": 0.4}}
    (said,) = [text for text in scene(one, plane, X).notes if "right angles" in text]
    assert 'contacts "c0" and "c1"' in said and "by 35 degrees at most" in said


def test_lever_arms_of_rotations_make_no_slope():
    """A shroud at a lever arm from a node: the relation of arms to 1 hangs on the unit of length."""
    dofs = ["15x", "15y", "15rz"]
    modal = {"dofs": dofs, "frequency": [1.0, 2.0, 3.0], "damping": 0.05, "shapes": [[1.0, 0.2, 0.1]] * 3}
    contact = CONTACT | {
        "name": "c0",
        "tangential": {"15x": 1.0, "15rz": -20.0},
        "normal": {"15y": 1.0, "15rz": 15.0},
    }
    rest = {"force": [{"dof": "15x", "amplitude": 1.0}], "response": {"frequency": [0.5, 1.2]}}
    said = [
        any(
            "slip changes" in one for one in scene_from_dict({"modal": modal, "contact": [each]} | rest).notes
        )
        for each in (contact, contact | {"normal": {"15y": 1.0, "15x": 1.0, "15rz": 15.0}})
    ]
    assert said == [False, True]


@pytest.mark.parametrize(
    "contacts",
    [
        (X,),
        (X, X),  # layers of one joint
        (X, X | TURNED | {"tangential": {"ax": -2.0, "bx": 2.0}}),
        (X, Y | {"normal": {"az": 1.0}}),  # another place
        (X, Y | TURNED),  # the two faces of a shroud
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
