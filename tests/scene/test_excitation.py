"""Forces of other kinds: of a base that moves, static, in proportion to omega^2, with phases in degrees."""

from __future__ import annotations

from math import pi

import numpy as np
import pytest

import fcm
from fcm.model.question import Question
from fcm.scene import SceneError, scene_from_dict

# ground - 1 - 2 - 3, along x; node 2 has a y of its own
K = np.array([[3.0, -1, 0, 0], [-1, 2, -1, 0], [0, -1, 1, 0], [0, 0, 0, 5]])
M = np.diag([1.0, 2.0, 0.5, 2.0])
C = 0.02 * M + 0.01 * K
NAMES = ["1x", "2x", "3x", "2y"]


def data(**top):
    damping = {"mass": 0.02, "stiffness": 0.01}
    table = {"dofs": NAMES, "stiffness": K.tolist(), "mass": M.tolist(), "damping": damping}
    return {"structure": table, "response": {"frequency": [0.3, 2.0]}} | top


def read(folder=".", **top):
    return scene_from_dict(data(**top), "test.toml", folder)


def refused(folder=".", **top):
    with pytest.raises(SceneError) as caught:
        read(folder, **top)
    return str(caught.value)


def forced(scene, omega):
    """Displacements at all degrees of freedom under the harmonic forces of a scene, by its modes."""
    modal = scene.modal
    total = sum(
        one.direction * one.amplitude * omega**one.power * np.exp(1j * one.phase) for one in scene.forces
    )
    weights = modal.mass * (modal.frequency**2 - omega**2 + 2j * modal.damping * modal.frequency * omega)
    found = modal.shapes.T @ ((modal.shapes @ total) / weights)
    return found[[modal.dofs.index(name) for name in NAMES]]


def direct(force, omega):
    return np.linalg.solve(K - omega**2 * M + 1j * omega * C, force)


@pytest.mark.parametrize(
    "direction, moved",
    [
        ("x", [1, 1, 1, 0]),
        ("y", [0, 0, 0, 1]),
        ({"1x": 1, "2y": 0.5}, [1, 0, 0, 0.5]),
        ({"x": 0.6, "y": -0.8}, [0.6, 0.6, 0.6, -0.8]),
        ("3x", [0, 0, 1, 0]),
    ],
)
def test_a_base_that_moves(direction, moved):
    """Displacements relative to the base: M x'' + C x' + K x = -M d a."""
    scene = read(base={"acceleration": 2.5, "direction": direction, "phase": "90deg"})
    for omega in (0.3, 0.9, 1.7):
        exact = direct(-M @ moved * 2.5j, omega)
        assert forced(scene, omega) == pytest.approx(exact, rel=1e-10)
    assert scene.reported == tuple(NAMES)


def test_the_base_of_a_reduced_structure_keeps_the_flexibility_of_its_load():
    rows = 60
    names = [f"{i}x" for i in range(rows)]
    stiffness = 1e3 * (2 * np.eye(rows) - np.eye(rows, k=1) - np.eye(rows, k=-1))
    mass = np.linspace(1.0, 2.0, rows)
    table = {
        "dofs": names,
        "stiffness": stiffness.tolist(),
        "mass": mass.tolist(),
        "damping": 0.0,
        "modes": 3,
    }
    top = {
        "base": {"acceleration": 1.0, "direction": "x"},
        "response": {"frequency": [1.0, 2.0], "output": ["30x"]},
    }
    scene = scene_from_dict({"structure": table} | top, "test.toml")
    modal, omega = scene.modal, 2.0
    pushed = modal.shapes @ scene.forces[0].direction * scene.forces[0].amplitude
    found = modal.shapes.T @ (pushed / (modal.frequency**2 - omega**2))
    exact = np.linalg.solve(stiffness - omega**2 * np.diag(mass), -mass)
    assert found[modal.dofs.index("30x")] == pytest.approx(exact[30], rel=1e-6)


def test_results_do_not_show_what_carries_the_base():
    scene = read(base={"acceleration": 1.0, "direction": "x"})
    found = fcm.respond(scene, "closed-form")
    assert found.dof.values.tolist() == NAMES
    at = int(np.nanargmax(found.amplitude.sel(dof="3x").values))
    omega = float(found.frequency.values.ravel()[at])
    exact = np.abs(direct(-M @ [1, 1, 1, 0], omega))
    assert found.amplitude.values.reshape(-1, 4)[at] == pytest.approx(exact, rel=1e-6, abs=1e-12)


def test_the_base_of_modes_needs_their_participation():
    modal = {"dofs": ["u"], "frequency": [1.0, 2.0], "damping": 0.1, "shapes": [[1.0], [0.5]]}
    top = {"base": {"acceleration": 3.0}, "response": {"frequency": [0.5, 1.5]}}
    with pytest.raises(SceneError, match=r"base: needs \[structure\], or modal.participation"):
        scene_from_dict({"modal": modal} | top)
    scene = scene_from_dict({"modal": modal | {"participation": [0.7, -0.2]}} | top)
    (force,) = scene.forces
    assert scene.modal.shapes @ force.direction * force.amplitude == pytest.approx([-2.1, 0.6])
    assert scene.reported == ("u",)


def test_the_base_is_swept():
    curves = read(base={"acceleration": 1.0, "direction": "x"}, sweep={"base.acceleration": [1, 3]}).curves
    assert [curve.forces[0].amplitude for curve in curves] == [-1.0, -3.0]


@pytest.mark.parametrize(
    "base, words",
    [
        ({"direction": "x"}, "base.acceleration: missing; give a number"),
        ({"acceleration": 1.0}, "base.direction: missing"),
        ({"acceleration": 1.0, "direction": "z"}, 'no degree of freedom is named "z"'),
        ({"acceleration": 1.0, "direction": "up"}, "base.direction: must be x, y, z or a table of weights"),
        ({"acceleration": 1.0, "direction": {"x": "1"}}, "base.direction.x: must be a number"),
        ({"acceleration": 1.0, "direction": {"x": 0.0}}, "base.direction: has only zero weights"),
        ({"acceleration": 1.0, "direction": {"x": 1.0, "z": 1.0}}, 'or as a node and "z"'),
        ({"acceleration": 1.0, "direction": 3}, "base.direction: must be a degree of freedom or a table"),
        ({"acceleration": 1.0, "direction": "x", "phase": "x"}, "base.phase: must be a number"),
        ({"accelration": 1.0, "direction": "x"}, 'did you mean "acceleration"?'),
        (3, "base: must be a table, is 3"),
    ],
)
def test_mistakes_of_the_base(base, words):
    assert words in refused(base=base)


@pytest.mark.parametrize(
    "phase, radians", [("45deg", pi / 4), ("-90 deg", -pi / 2), (1.5, 1.5), ("1e2deg", pi / 1.8)]
)
def test_phases_in_degrees(phase, radians):
    scene = read(force=[{"dof": "1x", "amplitude": 1.0, "phase": phase}])
    assert scene.forces[0].phase == pytest.approx(radians)


@pytest.mark.parametrize("phase", ["45", "deg", "xdeg", "nandeg", "45grad"])
def test_phases_that_are_none(phase):
    message = refused(force=[{"dof": "1x", "amplitude": 1.0, "phase": phase}])
    assert "force[0].phase: must be a number" in message and 'degrees are written "45deg"' in message


def test_a_phase_with_the_sign_of_degrees_is_told_how_it_is_written():
    message = refused(force=[{"dof": "1x", "amplitude": 1.0, "phase": "90 \u00b0"}])
    assert 'degrees are written "90deg"' in message


def test_forces_in_proportion_to_the_square_of_the_frequency():
    scene = read(force=[{"dof": "3x", "amplitude": 0.2, "proportional_to": "omega^2"}])
    assert scene.forces[0].power == 2
    assert forced(scene, 1.3) == pytest.approx(direct([0, 0, 0.2 * 1.69, 0], 1.3), rel=1e-10)
    message = refused(force=[{"dof": "3x", "amplitude": 0.2, "proportional_to": "omega"}])
    assert 'force[0].proportional_to: must be "omega^2", is "omega"' in message


def test_static_loads(tmp_path):
    np.savez(tmp_path / "spin.npz", load=[1.0, 2.0, 0.5, -1.0])
    loads = [{"dof": "3x", "force": 4.0}, {"file": "spin.npz", "force": 0.5}]
    scene = read(tmp_path, load=loads, force=[{"dof": "1x", "amplitude": 1.0}])
    modal = scene.modal
    pushed = modal.shapes @ sum(load.direction * load.force for load in scene.loads)
    found = modal.shapes.T @ (pushed / modal.frequency**2)
    exact = np.linalg.solve(K, [0.5, 1.0, 4.25, -0.5])
    assert found[[modal.dofs.index(name) for name in NAMES]] == pytest.approx(exact, rel=1e-10)
    assert scene.reported == tuple(NAMES)


def test_static_loads_are_swept():
    top = {"load": [{"dof": "3x", "force": 4.0}], "force": [{"dof": "1x", "amplitude": 1.0}]}
    curves = read(sweep={"load.3x.force": [1, 2]}, **top).curves
    assert [curve.loads[0].force for curve in curves] == [1, 2]


@pytest.mark.parametrize(
    "load, words",
    [
        ({"dof": "9x", "force": 1.0}, 'load[0].dof: unknown degree of freedom "9x"'),
        ({"dof": "1x"}, "load[0].force: missing"),
        ({"force": 1.0}, "load[0].dof: missing"),
        ({"file": "gone.npz"}, 'gone.npz" is not there'),
        ({"file": "spin.npz", "dof": "1x"}, "load[0]: has both dof and file"),
        ({"file": "short.npz"}, "load[0].file: has 2 numbers, but the structure has 4 rows"),
        ({"file": "flat.npz"}, "holds a matrix; one row or column is needed"),
        ({"file": "spin.dat"}, "such a file is .npz, .mat, .h5, .hdf5, .mtx, .sti"),
    ],
)
def test_mistakes_of_loads(tmp_path, load, words):
    np.savez(tmp_path / "spin.npz", [1.0, 2.0, 0.5, -1.0])
    np.savez(tmp_path / "short.npz", [1.0, 2.0])
    np.savez(tmp_path / "flat.npz", np.ones((2, 2)))
    assert words in refused(tmp_path, load=[load], force=[{"dof": "1x", "amplitude": 1.0}])


def test_units_are_labels():
    scene = read(units={"length": "m", "force": "N"}, force=[{"dof": "1x", "amplitude": 1.0}])
    assert scene.units == ("m", "N")
    assert read(force=[{"dof": "1x", "amplitude": 1.0}]).units == ("", "")
    assert "units.length: must be a string, is 3" in refused(units={"length": 3}, force=[])
    assert 'units.lenght: unknown key; did you mean "length"?' in refused(units={"lenght": "m"}, force=[])


@pytest.mark.parametrize(
    "loads, net",
    [
        ([("1x", 3.0), ("3x", -3.0)], "net force 0 of 6 N along x, by"),  # a bolt
        ([("1x", 3.0)], "net force 3 of 3 N along x, by"),  # one side of it is missing
        (
            [({"1x": 1.0, "3x": -1.0}, 3.0), ("2x", 0.5), ("2y", -2.0)],
            "0.5 of 6.5 N along x, -2 of 2 N along y, by",
        ),
        ([("F.npz", 10.0)], "net force 70 of 70 N along x, 30 of 50 N along y, by"),
    ],
)
def test_the_net_of_static_loads_is_told(tmp_path, loads, net):
    """Of a file with several rows at one axis, too; the two masses along y are named by hand."""
    np.savez(tmp_path / "F.npz", np.array([1.0, 2.0, 4.0, 4.0, -1.0]))
    wide = np.eye(5)
    table = {"dofs": [*NAMES, "3y"], "stiffness": wide.tolist(), "mass": wide.tolist(), "damping": 0.01}
    each = [{"file" if dof == "F.npz" else "dof": dof, "force": force} for dof, force in loads]
    top = {"load": each, "units": {"length": "m", "force": "N"}, "force": [{"dof": "1x", "amplitude": 1.0}]}
    notes = read(tmp_path, structure=table, **top).notes
    assert [net in note for note in notes if note.startswith("static loads: ")] == [True]
    assert "structure: its mass along x, y is 3, 2 kg, without rows that are held" in notes


def test_the_net_of_loads_whose_directions_have_no_names_is_not_told():
    table = {"dofs": ["a", "b"], "stiffness": [2.0, 1.0], "mass": [1.0, 1.0], "damping": 0.01}
    force = [{"dof": "a", "amplitude": 1.0}]
    notes = read(structure=table, load=[{"dof": "b", "force": 2.0}], force=force).notes
    assert not any("static loads" in note or "its mass" in note for note in notes)


def chain(reduced=False, lacking=0):
    """Ten nodes of six directions between walls, each coupled to its neighbours, or to all; rows by nodes."""
    count = 10
    coupled = 2.0 * np.eye(count) - np.eye(count, k=1) - np.eye(count, k=-1)
    if reduced:
        coupled = np.eye(count) + np.ones((count, count))
    stiffness = np.kron(coupled, np.diag([3.0, 2.0, 1.0, 0.1, 0.1, 0.1]))
    mass = np.tile([1.0, 1.0, 1.0, 1e-3, 1e-3, 1e-3], count)
    kept = np.arange(6 * count) != (14 if lacking else -1)  # a z of the third node
    return stiffness[np.ix_(kept, kept)], mass[kept]


def by_node(count=10):
    return [f"{node}{axis}" for node in range(1, count + 1) for axis in ("x", "y", "z", "rx", "ry", "rz")]


def by_axis(count=10):
    return sorted(by_node(count), key=lambda dof: (len(dof.lstrip("0123456789")), dof.lstrip("0123456789")))


def asked_of_order(dofs, stiffness, mass):
    structure = {"dofs": dofs, "stiffness": stiffness.tolist(), "mass": mass.tolist(), "damping": 0.01}
    data = {"structure": structure, "force": [{"dof": "5x", "amplitude": 1.0}]}
    scene = scene_from_dict(data | {"response": {"frequency": [0.1, 9.0]}})
    return [note for note in scene.notes if "in their order?" in note]


def test_a_held_mesh_whose_rows_are_named_in_another_order_is_asked_about():
    """Its mass differed by less than what rows that are held may explain."""
    stiffness, mass = chain()
    (question,) = asked_of_order(by_axis(), stiffness, mass)
    assert isinstance(question, Question) and "though each of its nodes has rows along x, y and z" in question
    assert asked_of_order(by_node(), stiffness, mass) == []


@pytest.mark.parametrize(("difference", "asked"), [(0.04, 0), (0.06, 1)])
def test_elements_at_held_nodes_explain_a_small_difference(difference, asked):
    stiffness, mass = chain()
    mass[0::6] *= 1.0 - difference
    assert len(asked_of_order(by_node(), stiffness, mass)) == asked


def test_mass_that_differs_by_a_reduction_or_by_held_rows_is_not():
    stiffness, mass = chain(reduced=True)
    mass[0::6] *= 0.7
    assert asked_of_order(by_node(), stiffness, mass) == []
    stiffness, mass = chain(lacking=1)
    dofs = [dof for dof in by_node() if dof != "3z"]
    assert asked_of_order(dofs, stiffness, mass) == []
