"""A contact without friction and without a tangential direction: a stop."""

from __future__ import annotations

import numpy as np
import pytest

import fcm
from fcm.scene import SceneError, scene_from_dict

STOP = {"name": "stop", "normal": "u", "mu": 0, "k_v": 3.0, "gap": 0.8}
SHAPES = [[1.0, 0.2], [0.1, 1.0]]


def data(*contacts, **more):
    return {
        "modal": {"dofs": ["u", "w"], "frequency": [1.0, 5.0], "damping": 0.03, "shapes": SHAPES},
        "contact": list(contacts),
        "force": [{"dof": "u", "amplitude": 0.2}],
        "response": {"frequency": [0.6, 1.6], "harmonics": 3},
    } | more  # fmt: skip


def refused(*contacts, **more):
    with pytest.raises(SceneError) as error:
        scene_from_dict(data(*contacts, **more))
    return str(error.value)


@pytest.mark.parametrize("direction", ["u", "w"])
def test_its_peak_is_that_of_a_contact_that_could_slide_anywhere(direction):
    sliding = STOP | {"tangential": direction, "k_u": 7.0}
    peaks = [
        np.nanmax(fcm.respond(scene_from_dict(data(one))).amplitude.sel(dof="u")) for one in (STOP, sliding)
    ]
    assert peaks[0] == pytest.approx(peaks[1], rel=1e-9)


def test_it_raises_the_frequency_of_the_peak():
    """From 1 rad/s with the stop open, to at most 2 rad/s, where it would always be closed."""
    response = fcm.respond(scene_from_dict(data(STOP)))
    at = int(response.amplitude.sel(dof="u").values[0].argmax())
    assert 1.02 < float(response.frequency[0, at]) < 2.0


def test_stops_at_nodes():
    nodes = {"nodes": [["a"], ["b"]], "normal": "z", "areas": [1.0, 2.0]}
    modal = {"dofs": ["az", "bz"], "frequency": [1.0, 5.0], "damping": 0.03, "shapes": SHAPES}
    force = [{"dof": "az", "amplitude": 0.2}]
    given = {key: value for key, value in STOP.items() if key != "normal"} | nodes
    scene = scene_from_dict(data(given, modal=modal, force=force))
    assert [one.k_v for one in scene.contacts] == pytest.approx([1.0, 2.0])
    assert [one.n_0 for one in scene.contacts] == pytest.approx([-0.8, -1.6])
    assert [one.normal.tolist() for one in scene.contacts] == [[1.0, 0.0], [0.0, 1.0]]


@pytest.mark.parametrize("key", ["contact.stop.mu", "contact.0.mu", "contact.*.mu", "contact.stop.k_u"])
def test_its_friction_is_not_swept(key):
    said = refused(STOP, sweep={key: [0.0, 0.3]})
    assert said.endswith("; as it has no tangential direction, it has no friction")


def test_friction_takes_a_direction():
    said = refused(STOP | {"mu": 0.3})
    assert 'contact[0] "stop".k_u: missing' in said and 'contact[0] "stop".tangential: missing' in said
