"""Which degrees of freedom are in the results."""

from __future__ import annotations

import numpy as np
import pytest

import fcm
from fcm.scene import SceneError, load_scene, scene_from_dict

NODES = 20
DOFS = [f"{node}{direction}" for node in range(1, NODES + 1) for direction in "xyz"]


def scene(dofs=DOFS, **response):
    shapes = np.random.default_rng(1).normal(size=(2, len(dofs)))
    modal = {"dofs": dofs, "frequency": [1.0, 3.0], "damping": 0.05, "shapes": shapes}
    contact = {"name": "c", "tangential": {"1x": 1.0, "2x": -1.0}, "normal": "1y", "mu": 0.3}
    data = {
        "modal": modal,
        "contact": [contact | {"k_u": 0.1, "k_v": 0.1, "n_0": 1.0}],
        "force": [{"dof": "3z", "amplitude": 1.0}],
        "response": {"frequency": [0.8, 1.2]} | response,
    }
    return scene_from_dict(data)


def test_of_many_only_those_of_contacts_and_forces():
    assert scene().reported == ("1x", "1y", "2x", "3z")


def test_of_few_all():
    assert scene(DOFS[:30]).reported == tuple(DOFS[:30])


@pytest.mark.parametrize(
    "output, more",
    [
        (["7y"], ["7y"]),
        (["7:2"], ["7y"]),
        ("7*", ["7x", "7y", "7z"]),
        (["[78]z", "1x"], ["7z", "8z"]),
        ([], []),
    ],
)
def test_output_adds_names_and_patterns(output, more):
    assert set(scene(output=output).reported) == {"1x", "1y", "2x", "3z", *more}


def test_an_empty_list_asks_for_no_more_than_those_of_few():
    assert scene(DOFS[:30], output=[]).reported == ("1x", "1y", "2x", "3z")


@pytest.mark.parametrize(
    "output, words",
    [
        (["7q"], 'response.output[0]: no degree of freedom matches "7q"; there are "1x", "1y", '),
        (["1x", "99*"], 'response.output[1]: no degree of freedom matches "99*"'),
        (3, "response.output: must be a list of degrees of freedom, or of patterns"),
        ([3], 'response.output[0]: must be a degree of freedom or a pattern such as "40*", is 3'),
    ],
)
def test_mistakes(output, words):
    with pytest.raises(SceneError) as caught:
        scene(output=output)
    assert words in str(caught.value)


def test_every_wrong_entry_is_named_whatever_the_others_are():
    with pytest.raises(SceneError) as caught:
        scene(output=[3, "7*", "7q", ["1x"]])
    said = caught.value.mistakes
    assert [one.split(":")[0] for one in said] == [f"response.output[{i}]" for i in (0, 2, 3)]
    with pytest.raises(SceneError, match=r"output\[0\](.|\n)*dofs|dofs(.|\n)*output\[0\]"):
        scene(dofs=[1, 2], output=[3])


def test_results_have_these_and_the_same_numbers():
    """With the same harmonics, which the accuracy of those that are asked for would choose."""
    few, all_of_them = (scene(output=[one], harmonics=3) for one in ("9x", "*"))
    one, other = fcm.respond(few, "closed-form"), fcm.respond(all_of_them, "closed-form")
    assert one.dof.values.tolist() == ["1x", "1y", "2x", "3z", "9x"] and other.dof.size == 60
    assert one.peak_amplitude.values == pytest.approx(other.peak_amplitude.sel(dof=one.dof).values, rel=1e-6)


def test_a_scene_in_use_has_the_degrees_of_freedom_that_are_needed():
    whole = load_scene("yang1998")
    assert whole.in_use() is whole
    few = scene().in_use()
    assert few.modal.dofs == few.reported and few.modal.shapes.shape == (2, 4)
    assert few.contacts[0].tangential.tolist() == [1, 0, -1, 0]
