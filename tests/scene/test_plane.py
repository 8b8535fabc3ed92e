"""Contacts of a scene that slide in a plane: what is read, what is refused, what is said."""

from __future__ import annotations

import numpy as np
import pytest

import fcm
from fcm.model.question import Question
from fcm.scene import SceneError, scene_from_dict

DOFS = ["ax", "ay", "az", "bx", "by", "bz"]
CONTACT = {"name": "joint", "normal": {"az": 1.0, "bz": -1.0}, "mu": 0.3, "k_u": 1.0, "k_v": 2.0, "n_0": 5.0}
PLANE = {"tangential": [{"ax": 1.0, "bx": -1.0}, {"ay": 1.0, "by": -1.0}]}
NODES = {"nodes": [["a", "b"]], "tangential": ["x", "y"], "normal": "z"}


def data(contact, **more):
    shapes = [[1.0 if i == j else 0.1 for j in range(6)] for i in range(6)]
    return {
        "modal": {
            "dofs": DOFS, "frequency": [1.0 + 0.3 * i for i in range(6)], "damping": 0.05, "shapes": shapes,
        },
        "contact": [CONTACT | contact],
        "force": [{"dof": "ax", "amplitude": 1.0}],
        "response": {"frequency": [0.5, 1.2], "harmonics": 1, "max_step": 0.2},
    } | more  # fmt: skip


def refused(contact, **more):
    with pytest.raises(SceneError) as error:
        scene_from_dict(data(contact, **more))
    return str(error.value)


def test_two_directions_of_a_contact():
    (contact,) = scene_from_dict(data(PLANE)).contacts
    assert contact.second is not None
    assert contact.tangential.tolist() == [1.0, 0.0, 0.0, -1.0, 0.0, 0.0]
    assert contact.second.tolist() == [0.0, 1.0, 0.0, 0.0, -1.0, 0.0]


def test_pairs_of_nodes_have_the_same():
    (of_nodes,), (written,) = (scene_from_dict(data(one)).contacts for one in (NODES, PLANE))
    for one, other in zip(of_nodes.directions, written.directions, strict=True):
        assert one.tolist() == other.tolist()


def test_turned_axes_of_nodes():
    turned = NODES | {"tangential": [{"x": 0.6, "y": 0.8}, {"x": -0.8, "y": 0.6}]}
    (contact,) = scene_from_dict(data(turned)).contacts
    assert contact.second[:2].tolist() == [-0.8, 0.6]


@pytest.mark.parametrize(
    "directions",
    [
        ["x", {"y": 0.866, "z": 0.5}],  # as of the face of a damper: their length is 0.99998
        [{"x": 0.577, "y": 0.577, "z": 0.577}, {"x": 0.707, "y": -0.707}],
        [{"x": 0.267, "y": 0.535, "z": 0.802}, {"x": 0.873, "y": 0.218, "z": -0.436}],  # 0.02 degrees off
    ],
)
def test_weights_of_three_digits_are_at_right_angles_and_of_one_scale(directions):
    scene = scene_from_dict(data(NODES | {"tangential": directions}))
    assert not any("share degrees of freedom" in note for note in scene.notes)


@pytest.mark.parametrize(
    ("contact", "said"),
    [
        (NODES | {"tangential": ["x", {"y": 1.003}]}, "of different scale, the second 1.003 times the first"),
        (NODES | {"tangential": ["x", {"x": 0.003, "y": 1.0}]}, "these are 89.83 degrees apart"),
        ({"tangential": ["ax"]}, "must be one direction, or two directions at right angles"),
        ({"tangential": ["ax", "ay", "az"]}, "is a list of 3"),
        ({"tangential": []}, "is a list of 0"),
        ({"tangential": ["ax", "ax"]}, "no displacement distinguishes them"),
        ({"tangential": ["ax", {"ax": -2.0}]}, "no displacement distinguishes them"),
        ({"tangential": ["ax", {"ay": 2.0}]}, "of different scale, the second 2 times the first"),
        ({"tangential": ["ax", "nowhere"]}, "unknown degree of freedom"),
        ({"tangential": ["ax", {"ay": 0.0}]}, "has only zero weights"),
        ({"tangential": ["ax", 3]}, "must be a degree of freedom or a table of weights, is 3"),
        (NODES | {"tangential": ["x", "x"]}, "these are 0 degrees apart"),
        (NODES | {"tangential": ["x", {"x": 0.6, "y": 0.8}]}, "these are 53.13 degrees apart"),
        (NODES | {"tangential": ["x", {"y": 3.0}]}, "of different scale, the second 3 times the first"),
        (NODES | {"tangential": ["x", "w"]}, "must be one of"),
    ],
)
def test_directions_that_cannot_be_right_are_refused(contact, said):
    assert said in refused(contact)


def test_a_rotation_is_no_direction_of_a_plane():
    """Its unit is another: k_u and mu n are those of displacements."""
    dofs = ["21u", "21w", "21th", "bx", "by", "bz"]
    modal = data(PLANE)["modal"] | {"dofs": dofs}
    more = {"modal": modal, "force": [{"dof": "21u", "amplitude": 1.0}]}
    said = refused({"tangential": ["21w", "21th"], "normal": "21u"}, **more)
    assert 'are of different units: "21th" is a rotation' in said


def test_all_mistakes_of_both_directions_at_once():
    text = refused({"tangential": ["nowhere", {"ay": "one"}]})
    assert "tangential[0]" in text
    assert "tangential[1].ay" in text


def test_a_schedule_is_refused():
    text = refused(PLANE, schedule=[{"frequency": 1.0, "cycles": 3}])
    assert "schedule: simulates contacts on a line alone" in text


def test_directions_that_share_displacements_are_asked_about():
    oblique = {"tangential": ["ax", {"ax": 0.6, "ay": 0.8}]}
    (note,) = (one for one in scene_from_dict(data(oblique)).notes if "right angles" in one)
    assert '"joint"' in note
    assert not any("right angles" in one for one in scene_from_dict(data(PLANE)).notes)


def test_weights_are_swept_by_the_number_of_their_direction():
    swept = scene_from_dict(data(PLANE, sweep={"contact.joint.tangential.1.by": [-1.0, -0.9]}))
    assert [curve.contacts[0].second[4] for curve in swept.curves] == [-1.0, -0.9]
    with pytest.raises(SceneError, match="no such number"):
        scene_from_dict(data(PLANE, sweep={"contact.joint.tangential.by": [-1.0, -0.9]}))


def test_modes_of_a_structure_keep_the_second_direction():
    """Matrices instead of modes: rows that only the second direction needs are kept, and its flexibility."""
    K = np.diag([2.0, 2.2, 2.4, 2.6, 2.8, 3.0]) + 0.1
    structure = {"dofs": DOFS, "mass": np.eye(6).tolist(), "stiffness": K.tolist(), "damping": 0.05}
    whole = data(PLANE, structure=structure | {"modes": 6})
    whole.pop("modal")
    few = data(PLANE, structure=structure | {"modes": 3})
    few.pop("modal")
    answers = [fcm.respond(scene_from_dict(one), "closed-form") for one in (whole, few)]
    peaks = [one["peak_amplitude"].sel(dof="ax").item() for one in answers]
    assert peaks[1] == pytest.approx(peaks[0], rel=5e-3)


NAMED = {
    "dofs": ["7x", "7y", "7z", "8x", "8y", "8z", "7rx", "7rz", "q", "9z"],
    "frequency": [1.0 + 0.3 * i for i in range(10)],
    "damping": 0.05,
    "shapes": np.eye(10).tolist(),
}
TURNED = {"normal": {"x": 1.0, "y": 1.0}, "tangential": {"x": -1.0, "y": 1.0}}


OF_DOFS = CONTACT | {"tangential": {"7x": 1.0, "8x": -1.0}, "normal": {"7z": 1.0, "8z": -1.0}}
OF_NODES = CONTACT | NODES | {"nodes": [["7", "8"]]}


def questions(*contacts):
    scene = scene_from_dict(
        data({}, force=[{"dof": "7x", "amplitude": 1.0}]) | {"modal": NAMED, "contact": contacts}
    )
    return [one for one in scene.notes if " meant? Its length " in one]


def test_a_direction_of_another_length_acts_as_the_question_says():
    """With u = L u', v = L v' the forces along t / L and n / L are L f and L n: k L^2, n_0 L, and mu."""
    (question,) = questions(OF_NODES | TURNED)
    assert isinstance(question, Question)
    assert question == (
        'contact "joint": is tangential = { x = -1, y = 1 } meant? Its length is 1.41421, so that the '
        "contact acts as one of length 1 with 2 times k_u and 1.41421 times mu. { x = -0.707107, y = "
        "0.707107 } is of length 1; is normal = { x = 1, y = 1 } meant? Its length is 1.41421, so that the "
        "contact acts as one of length 1 with 2 times k_v, 1.41421 times n_0 and 0.707107 times mu. { x = "
        "0.707107, y = 0.707107 } is of length 1"
    )
    half = float(np.sqrt(0.5))
    unit = {"normal": {"x": half, "y": half}, "tangential": {"x": -half, "y": half}}
    same = unit | {"k_u": 2.0, "k_v": 4.0, "n_0": 5.0 * 2.0**0.5}
    long, short = (scene_from_dict(data(NODES | one)) for one in (TURNED, same))
    assert not any(" meant? " in note for note in short.notes)
    one, other = (fcm.respond(scene, harmonics=1) for scene in (long, short))
    assert float(one.peak_amplitude[0, 0]) == pytest.approx(float(other.peak_amplitude[0, 0]), rel=1e-4)


@pytest.mark.parametrize(
    ("contact", "words"),
    [
        (
            OF_NODES | {"normal": {"z": 2.0}, "n_0": None, "gap": 0.1},
            "4 times k_v, 0.5 times gap and 0.5 times",
        ),
        (OF_NODES | {"normal": {"y": 0.71, "z": 0.71}}, "Its length is 1.00409"),
        (OF_NODES | {"tangential": [{"x": 2.0}, {"y": 2.0}]}, "[{ x = 1 }, { y = 1 }] is of length 1"),
        ({"tangential": {"7x": 0.5, "8x": -0.5}}, '{ "7x" = 1, "8x" = -1 } is of length 1'),
        ({"tangential": {"7x": 1.0, "7y": 1.0}}, "2 times k_u and 1.41421 times mu"),
    ],
)
def test_directions_of_another_length_are_asked_about(contact, words):
    given = {key: value for key, value in (OF_DOFS | contact).items() if value is not None}
    (question,) = questions(given)
    assert words in question


@pytest.mark.parametrize(
    "contact",
    [
        {"normal": {"7z": 1.0}},
        {"tangential": {"7x": 0.5, "8x": 0.5}},  # halfway between nodes
        {"tangential": {"7x": 1.0, "8x": -0.4}},  # levers
        {"tangential": {"7x": 0.707, "7y": 0.707}},
        {"tangential": {"7x": 1.0, "7rz": 0.3}},
        {"tangential": {"7rz": 0.3}},
        {"normal": {"9z": 0.2}},  # a node without rows along the other axes
        {"tangential": {"q": 0.2}},
        OF_NODES | {"normal": {"z": 1.0, "rx": 0.2}, "nodes": [["7"]]},
    ],
)
def test_other_weights_are_not(contact):
    assert questions(OF_DOFS | contact) == []


def test_several_contacts_are_asked_about_once():
    other = OF_DOFS | {"tangential": {"7x": 3.0}}
    (question,) = questions(other, other | {"name": "b"}, other | {"name": "c"})
    assert question.endswith('. The same of "b" and "c"')
