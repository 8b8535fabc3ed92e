"""What a message tells to write is a key that the scene has, in its units; and it works."""

from __future__ import annotations

import numpy as np
import pytest

from fcm.scene import SceneError, scene_from_dict
from fcm.shooting import periodic
from fcm.time_domain.errors import SimulationError

from ..program import called

CONTACT = {"name": "c", "tangential": "1x", "normal": "1y", "mu": 0.3, "k_u": 1.0, "k_v": 1.0, "n_0": 1.0}
STRUCTURE = {"dofs": ["1x", "1y"], "stiffness": [4.0, 9.0], "mass": [1.0, 2.0], "damping": 0.01}
MODAL = {"dofs": ["1x", "1y"], "frequency": [2.0, 3.0], "damping": 0.01, "shapes": [[1.0, 0.0], [0.0, 1.0]]}
COUPLED = STRUCTURE | {"coupling": {"stiffness": [-1.0, -1.0]}}


def scene(**data):
    force, response = [{"dof": "1x", "amplitude": 1.0}], {"frequency": [0.1, 0.5]}
    given = {"contact": [CONTACT], "force": force, "response": response, "frequency_unit": "Hz"} | data
    return {key: value for key, value in given.items() if value is not None}


def refused(folder=".", **data):
    with pytest.raises(SceneError) as caught:
        scene_from_dict(scene(**data), "t.toml", folder)
    return str(caught.value)


@pytest.mark.parametrize(
    "tables, key",
    [
        ({"structure": STRUCTURE}, "structure.dofs are"),
        ({"structure": STRUCTURE | {"dofs": "names.txt"}}, "structure.dofs are"),
        ({"structure": {**STRUCTURE, "file": "names.txt", "dofs": None}}, "those of structure.file are"),
        ({"structure": COUPLED, "cyclic": {"sectors": 8, "engine_order": 2}}, "structure.dofs are"),
        ({"modal": MODAL}, "modal.dofs are"),
    ],
)
def test_an_unknown_degree_of_freedom(tmp_path, tables, key):
    (tmp_path / "names.txt").write_text("1x\n1y\n")
    tables = {name: {k: v for k, v in table.items() if v is not None} for name, table in tables.items()}
    said = refused(tmp_path, **tables, force=[{"dof": "q", "amplitude": 1.0}])
    assert f'unknown degree of freedom "q"; {key} "1x", "1y"' in said


def test_what_of_a_structure_can_be_swept():
    said = refused(structure=STRUCTURE, sweep={"structure.damping": [0.01, 0.02]})
    assert 'the damping ratios of its modes are "modal.damping"' in said
    swept = scene_from_dict(scene(structure=STRUCTURE, sweep={"modal.damping": [0.01, 0.02]}))
    assert [curve.modal.damping.tolist() for curve in swept.curves] == [[0.01] * 2, [0.02] * 2]
    said = refused(structure=STRUCTURE, sweep={"structure.stiffness": [1.0, 2.0]})
    assert "matrices and what is read with them cannot be swept" in said and "modal." not in said
    assert "no such number" in refused(modal=MODAL, sweep={"structure.damping": [0.01]})


@pytest.mark.parametrize("direction", ["x", {"x": 1.0}])
@pytest.mark.parametrize("names", [["x", "y"], ["X", "1y"], ["1x", "1y"]])
def test_a_base_moves_along_what_is_called_as_an_axis(direction, names):
    """The force on each mass is its own times the acceleration, along x alone."""
    contact = CONTACT | {"tangential": names[0], "normal": names[1]}
    given = {"structure": STRUCTURE | {"dofs": names}, "contact": [contact], "force": None}
    found = scene_from_dict(scene(**given, base={"acceleration": 3.0, "direction": direction}))
    (force,) = found.forces
    acting = found.modal.shapes @ force.direction * force.amplitude  # on each mode of modal mass 1
    assert np.sort(np.abs(acting)) == pytest.approx([0.0, 3.0])


def test_a_direction_along_which_nothing_is_called():
    said = refused(structure=STRUCTURE, force=None, base={"acceleration": 1.0, "direction": "z"})
    assert 'no degree of freedom is named "z", or as a node and "z"' in said and '{ "1x" = 1.0 }' in said
    assert "direction: missing; give x, y, z" in refused(structure=STRUCTURE, base={"acceleration": 1.0})


def test_frequencies_are_said_in_the_unit_of_the_scene(tmp_path):
    """A free block that slides, followed exactly: its modes do not determine where it is."""
    text = (
        'frequency_unit = "UNIT"\n[modal]\ndofs = ["x"]\nfrequency = [0.0]\ndamping = 0.0\nshapes = [[1.0]]\n'
    )
    text += 'participation = [1.0]\n[[contact]]\nname = "floor"\ntangential = "x"\nnormal = "x"\nmu = 0.1\n'
    text += "k_u = 9e5\nk_v = 0\nn_0 = 10\n[base]\nacceleration = 3.0\n[response]\nfrequency = [0.5, 3]\n"
    for unit, other in (("Hz", "rad/s"), ("rad/s", "Hz")):
        (tmp_path / "s.toml").write_text(text.replace("UNIT", unit))
        done = called("respond", "--method", "exact", tmp_path / "s.toml")
        assert f"the solution at 0.5 {unit} to start from" in done.out
        assert other not in done.out + done.err


def test_a_period_that_is_not_found_is_said_in_the_unit_of_the_scene():
    free = {"dofs": ["1x", "1y"], "frequency": [1.0, 3.0], "damping": 0.0, "shapes": MODAL["shapes"]}
    contact = CONTACT | {"mu": 0.0}
    given = scene_from_dict(scene(modal=free, contact=[contact], response={"frequency": [0.5, 1.5]}))
    with pytest.raises(SimulationError, match=r" at 1 Hz "):
        periodic(given, 2.0 * np.pi)


def test_a_node_that_no_row_has_may_be_held(tmp_path):
    of_rows = refused(structure=STRUCTURE, force=[{"dof": "9x", "amplitude": 1.0}])
    assert "; one that is held has no row" in of_rows
    assert "held" not in refused(modal=MODAL, force=[{"dof": "9x", "amplitude": 1.0}])
