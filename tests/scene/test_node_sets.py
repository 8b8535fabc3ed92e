"""Contacts over the nodes of two sets: partners, sides, fitted normals; what is ambiguous is refused."""

from __future__ import annotations

import numpy as np
import pytest

from fcm.model.question import Question
from fcm.scene import SceneError, scene_from_dict

NORMAL, ACROSS = np.array([0.6, 0.8, 0.0]), np.array([0.8, -0.6, 0.0])
GRID = [(i, j) for i in range(3) for j in range(4)]
NUMBERS = {"mu": 0.3, "k_u": 1.0, "k_v": 2.0, "n_0": 6.0}
SETS = {"sets": ["LEFT", "RIGHT"], "mesh": "two.inp", "tolerance": 0.1}


def places(gap, shift=0.0):
    """Two sides (node, 3) of a plane whose normal is NORMAL, the second beyond a gap, in another order."""
    first = np.array([i * ACROSS + [0.0, 0.0, 1.2 * j] for i, j in GRID]) + 5.0
    return first, (first + gap * NORMAL + shift * ACROSS)[::-1]


def deck(first, second, more=""):
    """An input file with the nodes 1.. of one set and 101.. of the other."""
    lines = ["*NODE"]
    for begin, side in ((1, first), (101, second)):
        lines += [f"{begin + k}, {x:.12g}, {y:.12g}, {z:.12g}" for k, (x, y, z) in enumerate(side)]
    last = len(first), 100 + len(second)
    lines += ["*NSET, NSET=left, GENERATE", f"1, {last[0]}", "*NSET, NSET=right, GENERATE", f"101, {last[1]}"]
    return "\n".join(lines) + f"\n{more}"


def read(folder, contact=(), nodes=(), text=None, gap=0.05):
    first, second = places(gap)
    (folder / "two.inp").write_text(text or deck(first, second))
    dofs = [f"{n}{d}" for begin in (1, 101) for n in range(begin, begin + 14) for d in "xyz"]
    shapes = np.random.default_rng(1).normal(size=(3, len(dofs)))
    modal = {"dofs": dofs, "frequency": [1.0, 2.0, 3.0], "damping": 0.05, "shapes": shapes}
    one = {"name": "shroud", "nodes": SETS | dict(nodes), "normal": "fitted", "tangential": "fitted"}
    data = {"modal": modal, "force": [{"dof": "1x", "amplitude": 1.0}], "response": {"frequency": [0.8, 1.2]}}
    return scene_from_dict(data | {"contact": [one | NUMBERS | dict(contact)]}, "test.toml", folder)


def refused(folder, *args, **options):
    with pytest.raises(SceneError) as caught:
        read(folder, *args, **options)
    return str(caught.value)


def weights(scene, direction):
    return {dof: weight for dof, weight in zip(scene.modal.dofs, direction.tolist(), strict=True) if weight}


def test_each_node_has_the_nearest_as_its_partner_along_the_fitted_normal(tmp_path):
    scene = read(tmp_path)
    assert [one.name for one in scene.contacts] == [f"shroud_{i}" for i in range(1, 13)]
    for k, contact in enumerate(scene.contacts):
        normal, one, other = (weights(scene, along) for along in (contact.normal, *contact.directions[:2]))
        mine, its = 1 + k, 112 - k  # the other side is numbered the other way round
        assert normal == pytest.approx({f"{mine}x": 0.6, f"{mine}y": 0.8, f"{its}x": -0.6, f"{its}y": -0.8})
        assert one == pytest.approx({f"{mine}z": 1.0, f"{its}z": -1.0})
        assert other == pytest.approx({f"{mine}x": 0.8, f"{mine}y": -0.6, f"{its}x": -0.8, f"{its}y": 0.6})
    text = "\n".join(scene.notes)
    assert 'contact "shroud": 12 pairs, 0.05 apart' in text
    assert "normal +0.6 x +0.8 y, 36.9 degrees from y" in text


def test_sides_that_coincide_are_told_by_the_elements(tmp_path):
    first, second = places(0.0)
    behind = first[0] - NORMAL
    tip = f"*NODE\n200, {behind[0]}, {behind[1]}, {behind[2]}\n"
    ahead = second[0] + NORMAL
    tip += f"*NODE\n201, {ahead[0]}, {ahead[1]}, {ahead[2]}\n"
    cells = "*ELEMENT, TYPE=C3D4\n1, 1, 2, 5, 200\n2, 101, 102, 105, 201\n"
    scene = read(tmp_path, text=deck(first, second, tip + cells))
    assert weights(scene, scene.contacts[0].normal)["1x"] == pytest.approx(0.6)
    turned = cells.replace("200", "300").replace("201", "200").replace("300", "201")
    scene = read(tmp_path, text=deck(first, second, tip + turned))
    assert weights(scene, scene.contacts[0].normal)["1x"] == pytest.approx(-0.6)
    assert "which side is which is unknown: neither gaps nor elements" in refused(tmp_path, gap=0.0)


def test_a_given_normal_is_taken_and_asked_about(tmp_path):
    scene = read(tmp_path, {"normal": {"x": 0.6, "y": 0.8}, "tangential": "z"})
    assert weights(scene, scene.contacts[0].tangential) == {"1z": 1.0, "112z": -1.0}
    assert not any("is it meant?" in note for note in scene.notes)
    scene = read(tmp_path, {"normal": {"x": -0.6, "y": -0.8}, "tangential": "z"})
    assert any("normal points from RIGHT to LEFT" in note for note in scene.notes)
    assert not any("leans by" in note for note in scene.notes)
    scene = read(tmp_path, {"normal": "y", "tangential": "z"})  # the face's own is (0.6, 0.8)
    assert any("its normal leans by 37 degrees from that of the plane" in note for note in scene.notes)


def test_tangential_directions_are_fitted_to_a_given_normal(tmp_path):
    contact = read(tmp_path, {"normal": "y"}).contacts[0]
    scene = read(tmp_path, {"normal": "y"})
    assert weights(scene, contact.tangential) == {"1x": 1.0, "112x": -1.0}
    assert weights(scene, contact.second) == {"1z": -1.0, "112z": 1.0}


def test_nodes_without_a_partner_are_said(tmp_path):
    first, second = places(0.05)
    second = np.concatenate((second, [[50.0, 0.0, 0.0]]))
    first = np.concatenate((first, [[-50.0, 0.0, 0.0], [-60.0, 0.0, 0.0]]))
    scene = read(tmp_path, text=deck(first, second))
    assert len(scene.contacts) == 12
    text = "\n".join(scene.notes)
    assert "2 nodes of LEFT without a partner (13, 14)" in text
    assert "1 node of RIGHT without a partner (113)" in text


def test_sets_may_be_files_and_one_may_touch_the_ground(tmp_path):
    (tmp_path / "left.nam").write_text("** of a mesher\n*NSET, NSET=left\n1, 2,\n3\n")
    (tmp_path / "right.txt").write_text("112 111 110  # the others\n")
    scene = read(tmp_path, {"normal": "y", "tangential": "z"}, {"sets": ["left.nam", "right.txt"]})
    assert [weights(scene, one.tangential) for one in scene.contacts] == [
        {f"{a}z": 1.0, f"{b}z": -1.0} for a, b in ((1, 112), (2, 111), (3, 110))
    ]
    data = {"sets": ["left.nam"], "mesh": "two.inp"}
    scene = read(tmp_path, {"nodes": data, "normal": "y", "tangential": "z"})
    assert [weights(scene, one.normal) for one in scene.contacts] == [{"1y": 1.0}, {"2y": 1.0}, {"3y": 1.0}]


def test_nodes_that_touch_the_ground_press_out_of_their_elements(tmp_path):
    first, second = places(0.05)
    for side, sign in ((-1.0, 1.0), (1.0, -1.0)):  # of the element, and of the normal
        tip = first[0] + side * NORMAL
        cells = f"*NODE\n200, {tip[0]}, {tip[1]}, {tip[2]}\n*ELEMENT, TYPE=C3D4\n1, 1, 2, 5, 200\n"
        data = {"sets": ["LEFT"], "mesh": "two.inp"}
        scene = read(tmp_path, {"nodes": data, "areas": "equal"}, text=deck(first, second, cells))
        assert len(scene.contacts) == 12
        found = weights(scene, scene.contacts[3].normal)
        assert found == pytest.approx({"4x": 0.6 * sign, "4y": 0.8 * sign})
        assert [one.n_0 for one in scene.contacts] == pytest.approx([0.5] * 12)
    text = refused(tmp_path, {"nodes": data})
    assert "which side is which is unknown: the elements of the mesh" in text


def test_totals_are_shared_by_areas_of_the_pairs(tmp_path):
    scene = read(tmp_path, {"areas": [1.0] * 11 + [13.0]})
    assert [one.n_0 for one in scene.contacts] == pytest.approx([0.25] * 11 + [3.25])


AMISS = {
    "tangential: is 36.9 degrees out of the fitted plane": {"contact": {"tangential": "x"}},
    "no node of the first set is within 0.01 of the second; the nearest is 0.05 away": {
        "nodes": {"tolerance": 0.01}
    },
    '"MIDDLE" is no set of the mesh, and no file: its sets are "LEFT", "RIGHT"': {
        "nodes": {"sets": ["LEFT", "MIDDLE"]}
    },
    "nodes.sets: nodes 1, 2, 3, 4, 5, ... are in both sets": {"nodes": {"sets": ["LEFT", "LEFT"]}},
    'there is none.inp" is not there': {"nodes": {"mesh": "there is none.inp"}},
    "nodes.mesh: missing": {"contact": {"nodes": {"sets": ["LEFT", "RIGHT"], "tolerance": 0.1}}},
    "nodes.tolerance: missing": {"contact": {"nodes": {"sets": ["LEFT", "RIGHT"], "mesh": "two.inp"}}},
    "nodes.near: unknown key": {"nodes": {"near": 1.0}},
    'give two sets, as ["LEFT", "RIGHT"]': {"nodes": {"sets": ["A", "B", "C"]}},
}


@pytest.mark.parametrize("said", AMISS)
def test_what_is_amiss_is_said(tmp_path, said):
    assert said in refused(tmp_path, **AMISS[said])


def test_two_nodes_that_want_the_same_partner_are_refused(tmp_path):
    first, second = places(0.05)
    text = refused(tmp_path, text=deck(first, second[:-1] * 1.0), nodes={"tolerance": 1.5})
    assert "nodes 1, 5 of the first set all have node 108 of the second as the nearest" in text


def test_nodes_on_a_line_have_no_plane(tmp_path):
    first = np.array([[float(k), 0.0, 0.0] for k in range(5)])
    text = refused(tmp_path, text=deck(first, first + np.array([0.0, 0.0, 0.05])))
    assert "normal: cannot be fitted: the points lie on a line" in text


def test_a_file_of_pairs_does_not_tell_its_sides(tmp_path):
    (tmp_path / "pairs.csv").write_text("node,other,x,y,z\n1,101,0,0,0\n2,102,1,0,0\n3,103,0,1,zero\n")
    text = refused(tmp_path, {"nodes": "pairs.csv"})
    assert "line 4: z:" in text
    (tmp_path / "pairs.csv").write_text("node,other,x,y,z\n1,101,0,0,0\n2,102,1,0,0\n3,103,0,1,0\n")
    assert "normal: cannot be fitted to a file of pairs" in refused(tmp_path, {"nodes": "pairs.csv"})
    scene = read(tmp_path, {"nodes": "pairs.csv", "normal": "z"})
    assert weights(scene, scene.contacts[0].tangential) == {"1x": 1.0, "101x": -1.0}
    assert scene.interfaces[0].first.tolist()[2] == [0.0, 1.0, 0.0]


def of_file(folder, partners, contact=(), nodes=(), rows="", text=""):
    """The scene of pairs 1.. with partners, by a file, or its text, and the mesh of both sides."""
    rows = rows or "node,other\n" + "".join(f"{1 + k},{node}\n" for k, node in enumerate(partners))
    (folder / "pairs.csv").write_text(rows)
    (folder / "two.inp").write_text(text or deck(*places(0.05)))
    given = {"pairs": "pairs.csv", "mesh": "two.inp"} | dict(nodes)
    modal = {"dofs": [f"{n}{d}" for b in (1, 101) for n in range(b, b + 12) for d in "xyz"]}
    shapes = np.random.default_rng(1).normal(size=(3, len(modal["dofs"])))
    modal |= {"frequency": [1.0, 2.0, 3.0], "damping": 0.05, "shapes": shapes}
    one = {"name": "shroud", "nodes": given, "normal": "fitted", "tangential": "fitted"}
    data = {"modal": modal, "force": [{"dof": "1x", "amplitude": 1.0}], "response": {"frequency": [0.8, 1.2]}}
    return scene_from_dict(data | {"contact": [one | NUMBERS | dict(contact)]}, "test.toml", folder)


RIGHT = [112 - k for k in range(12)]  # the second side is numbered the other way round


def test_a_file_of_pairs_and_a_mesh_are_as_two_sets(tmp_path):
    of_sets, scene = read(tmp_path), of_file(tmp_path, RIGHT)
    for one, other in zip(of_sets.contacts, scene.contacts, strict=True):
        assert weights(scene, other.normal) == pytest.approx(weights(of_sets, one.normal))
        assert weights(scene, other.tangential) == pytest.approx(weights(of_sets, one.tangential))
    assert scene.notes[0] in of_sets.notes and scene.notes[0].startswith(
        'contact "shroud": 12 pairs, 0.05 apart'
    )
    assert scene.interfaces[0].second == pytest.approx(of_sets.interfaces[0].second)


def test_a_column_that_is_shifted_by_a_row_is_seen_by_the_distances(tmp_path):
    scene = of_file(tmp_path, [*RIGHT[1:], RIGHT[0]])
    farthest = np.hypot(2.0, 3 * 1.2)  # of the last node, whose partner is the first one's
    assert f"to {np.hypot(farthest, 0.05):.3g} apart" in scene.notes[0]
    assert "12 pairs are not of nearest nodes: 112 is nearer to 1 than its partner 111" in scene.notes[0]


@pytest.mark.parametrize(
    "partners, nodes, words",
    [
        ([*RIGHT[1:], RIGHT[0]], {"tolerance": 0.1}, "nodes 12 and 112 are 4.119 apart, more than 0.1"),
        ([*RIGHT[:-1], 999], {}, "nodes.pairs: has nodes that the mesh has not: 999"),
        (RIGHT, {"sets": ["LEFT", "RIGHT"]}, "nodes: has both sets and pairs; give one of them"),
        ([*RIGHT[:-1], RIGHT[-1], RIGHT[-1]], {}, "nodes that the mesh has not: 13"),
    ],
)
def test_what_is_amiss_with_a_file_and_a_mesh_is_said(tmp_path, partners, nodes, words):
    with pytest.raises(SceneError) as caught:
        of_file(tmp_path, partners, nodes=nodes)
    assert words in str(caught.value)


def sides_of(scene):
    return [note for note in scene.notes if isinstance(note, Question) and "its normal points" in note]


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_a_normal_of_the_wrong_sign_is_asked_about_where_a_mesh_shows_the_sides(tmp_path, sign):
    """Of a file of pairs, and of nodes that touch the ground: it was asked of two sets alone."""
    given = {"normal": {"x": 0.6 * sign, "y": 0.8 * sign}, "tangential": "z"}
    said = sides_of(of_file(tmp_path, RIGHT, given))
    assert len(said) == (sign < 0.0)
    assert all(
        "from the others to its first nodes, so that it presses where they part" in one for one in said
    )
    first, second = places(0.05)
    tip = first[0] - NORMAL
    cells = f"*NODE\n200, {tip[0]}, {tip[1]}, {tip[2]}\n*ELEMENT, TYPE=C3D4\n1, 1, 2, 5, 200\n"
    ground = given | {"nodes": {"sets": ["LEFT"], "mesh": "two.inp"}, "areas": "equal"}
    said = sides_of(read(tmp_path, ground, text=deck(first, second, cells)))
    assert len(said) == (sign < 0.0)
    assert all("into the elements at its nodes, so that it presses where these leave" in one for one in said)
    assert sides_of(read(tmp_path, ground)) == []  # without elements nothing shows it


def test_nodes_in_one_place_show_no_side(tmp_path):
    first, _ = places(0.0)
    turned = {"normal": {"x": -0.6, "y": -0.8}, "tangential": "z"}
    assert sides_of(of_file(tmp_path, RIGHT, turned, text=deck(first, first[::-1]))) == []


WRONG = [
    (lambda at: at, None),
    (lambda at: at + 0.025 * NORMAL, None),  # between both nodes
    (lambda at: np.round(at, 1), None),
    (lambda at: 1000.0 * at, "12 pairs are not where"),
    (lambda at: at[:, [1, 0, 2]], "pairs are not where"),
    (
        lambda at: at + np.outer(np.arange(12) == 4, [0.0, 0.0, 1.0]),
        "1 pair is not where the mesh has its nodes. Node 5 is",
    ),
]


@pytest.mark.parametrize("moved, words", WRONG)
def test_coordinates_of_a_file_that_are_not_those_of_the_mesh_are_asked_about(tmp_path, moved, words):
    lines = ["node,other,x,y,z"]
    lines += [
        f"{1 + k},{RIGHT[k]},{x},{y},{z}" for k, (x, y, z) in enumerate(moved(places(0.05)[0]).tolist())
    ]
    scene = of_file(tmp_path, RIGHT, rows="\n".join(lines) + "\n")
    asked = [note for note in scene.notes if "coordinates of the file" in note]
    assert len(asked) == (words is not None) and all(words in note for note in asked)
    assert scene.interfaces[0].first == pytest.approx(places(0.05)[0])
