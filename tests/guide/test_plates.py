"""Contacts at the surface of a plate, as the page of contacts describes them."""

import doctest
import re
import tomllib

import numpy as np

from fcm.scene import scene_from_dict

from .pages import GUIDE, read

PAGE = GUIDE / "howto/contacts.md"
THICKNESS = 0.004


def block(language, word):
    (found,) = [b for b in re.findall(rf"^```{language}\n(.*?)^```", read(PAGE), re.M | re.S) if word in b]
    return found


def surface(z):
    """Displacements (2, dof) along x and y at the height z over the middle of one node, of x y z rx ry."""
    return np.array([[1.0, 0.0, 0.0, 0.0, z], [0.0, 1.0, 0.0, -z, 0.0]])


def test_the_example_moves_translations_to_the_surface():
    """A spring of the surface is then one of the translations alone, and a rigid plate stays one."""
    names = {}
    code = doctest.script_from_examples(block("pycon", "eye_array"))
    exec(code, names)
    z = names["z"]
    assert np.abs(names["K"] - np.diag([3.0, 0.0, 0.0, 0.0, 0.0])).max() < 1e-15
    turned = np.array([-z, 0.0, 0.0, 0.0, 1.0])  # about the y of the surface, which then is at rest
    assert surface(z)[0] @ turned == 0.0
    assert names["M"][4, 4] == turned @ np.diag([2.0, 2.0, 2.0, 0.1, 0.1]) @ turned


def test_the_weights_are_the_motion_of_both_surfaces():
    given = tomllib.loads(block("toml", "40ry"))["contact"][0]
    dofs = [f"{node}{one}" for node in (40, 50) for one in ("x", "y", "z", "rx", "ry")]
    table = {"dofs": dofs, "stiffness": [1.0] * 10, "mass": [1.0] * 10, "damping": 0.01}
    numbers = {"mu": 0.3, "k_u": 1.0, "k_v": 1.0, "n_0": 1.0}
    data = {"structure": table, "contact": [given | numbers], "force": [{"dof": "40x", "amplitude": 1.0}]}
    (contact,) = scene_from_dict(data | {"response": {"frequency": [0.5, 2.0]}}).contacts
    lower, upper = surface(THICKNESS / 2.0), surface(-THICKNESS / 2.0)
    assert np.array_equal([contact.tangential, contact.second], np.hstack((lower, -upper)))
