"""Pairs of a file whose nodes are not where it says: rigid-body modes tell, without a mesh."""

from __future__ import annotations

import numpy as np
import pytest

from fcm.scene import scene_from_dict

GRID = np.array([[0.1 * i, 0.03 * j, 0.0] for i in range(4) for j in range(3)])
LOWER, UPPER = range(1, 13), range(101, 113)


def read(folder, partners, places=GRID, bodies=((101, GRID),), places_in_file=True):
    """A plate on a floating one, node for node; the motions of the floating bodies are modes."""
    heads = "node,other,x,y,z" if places_in_file else "node,other"
    rows = [
        ",".join(map(str, (node, other, *place) if places_in_file else (node, other)))
        for node, other, place in zip(LOWER, partners, places, strict=True)
    ]
    (folder / "pairs.csv").write_text("\n".join([heads, *rows]) + "\n")
    dofs = [f"{node}{axis}" for node in (*LOWER, *UPPER) for axis in "xyz"]
    shapes = []
    for first, there in bodies:
        for k in range(6):
            shift, turn = np.eye(6)[k][:3], np.eye(6)[k][3:]
            moved = np.zeros((24, 3))
            moved[12 + first - 101 : 12 + first - 101 + len(there)] = shift + np.cross(turn, there)
            shapes.append(moved.ravel())
    elastic = np.random.default_rng(1).normal(size=(4, len(dofs)))
    modal = {"dofs": dofs, "frequency": [*[0.0] * len(shapes), 10.0, 20.0, 30.0, 40.0], "damping": 0.01}
    one = {"name": "lap", "nodes": "pairs.csv", "tangential": ["x", "y"], "normal": "z"}
    contact = one | {"mu": 0.3, "k_u": 1.0, "k_v": 1.0, "n_0": 1.0}
    data = {"modal": modal | {"shapes": [*shapes, *elastic]}, "contact": [contact]}
    more = {"force": [{"dof": "1z", "amplitude": 1.0}], "response": {"frequency": [5.0, 15.0]}}
    scene = scene_from_dict(data | more, "test.toml", folder)
    return [note for note in scene.notes if "no rigid body" in note]


def test_places_that_fit_are_not_asked_about(tmp_path):
    assert read(tmp_path, UPPER) == []
    from_elsewhere = GRID + np.array([5.0, -2.0, 0.004])  # from another origin, at the surface
    assert read(tmp_path, UPPER, places=from_elsewhere) == []


@pytest.mark.parametrize("by", [1, 2])
def test_a_column_that_is_shifted_is_asked_about(tmp_path, by):
    (note,) = read(tmp_path, np.roll(UPPER, -by))
    assert 'contact "lap": its other nodes move as no rigid body does at their places' in note
    assert "Is a column of the file shifted" in note


def test_a_wrong_coordinate_is_asked_about(tmp_path):
    places = GRID.copy()
    places[5, 1] += 0.1
    (note,) = read(tmp_path, UPPER, places=places)
    assert "node 106 is off most" in note


def test_nothing_is_asked_where_nothing_can_be_told(tmp_path):
    shifted = np.roll(UPPER, -1)
    assert read(tmp_path, shifted, places_in_file=False) == []
    assert read(tmp_path, shifted, bodies=[(101, GRID[:6]), (107, GRID[6:])]) == []  # of two bodies
    assert read(tmp_path, shifted, bodies=[(101, GRID[:6])]) == []  # the others are held
    assert read(tmp_path, shifted, bodies=[]) == []
