"""Numbers of several contacts together: names with a *, keys in step, contacts over node pairs."""

from __future__ import annotations

import numpy as np
import pytest

from fcm.harmonic_balance.system import System
from fcm.model.question import Question
from fcm.scene import SceneError, scene_from_dict
from fcm.scene.draft import number_of
from fcm.sensitivity.parameter_derivatives import rates_of

DOFS = [f"{node}{direction}" for node in (40, 41, 50, 51) for direction in "xyz"]
PAIRS = {"name": "shroud", "nodes": [[40, 41], [50, 51]], "tangential": {"x": 0.6, "y": 0.8}, "normal": "z"}
NUMBERS = {"mu": 0.3, "k_u": 1.0, "k_v": 2.0, "n_0": 6.0}


def read(contact=None, folder=".", **top):
    modal = {"dofs": DOFS, "frequency": [1.0, 3.0], "damping": 0.05, "shapes": np.eye(2, 12) + 0.1}
    force = [{"dof": "40x", "amplitude": 1.0}]
    data = {"modal": modal, "force": force, "response": {"frequency": [0.8, 1.2]}}
    return scene_from_dict(data | {"contact": contact or [PAIRS | NUMBERS]} | top, "test.toml", folder)


def of_file(folder, contact):
    return read([contact], folder)


def refused(contact=None, **top):
    with pytest.raises(SceneError) as caught:
        read(contact, **top)
    return str(caught.value)


def weights(direction):
    return {dof: weight for dof, weight in zip(DOFS, direction.tolist(), strict=True) if weight}


def test_a_contact_for_each_pair_of_nodes():
    one, other = read().contacts
    assert (one.name, other.name) == ("shroud_1", "shroud_2")
    assert weights(one.tangential) == {"40x": 0.6, "40y": 0.8, "41x": -0.6, "41y": -0.8}
    assert weights(other.normal) == {"50z": 1.0, "51z": -1.0}
    assert (other.mu, other.k_u, other.k_v, other.n_0) == (0.3, 1.0, 2.0, 6.0)


def test_nodes_that_touch_the_ground():
    one, other = read([PAIRS | NUMBERS | {"nodes": [[40], "50"]}]).contacts
    assert weights(one.normal) == {"40z": 1.0} and weights(other.tangential) == {"50x": 0.6, "50y": 0.8}


def test_totals_are_shared_by_areas():
    scene = read([PAIRS | NUMBERS | {"areas": [1.0, 2.0]}])
    assert [contact.n_0 for contact in scene.contacts] == pytest.approx([2.0, 4.0])
    assert [contact.k_u for contact in scene.contacts] == pytest.approx([1 / 3, 2 / 3])
    assert [contact.k_v for contact in scene.contacts] == pytest.approx([2 / 3, 4 / 3])
    assert [contact.mu for contact in scene.contacts] == [0.3, 0.3]
    assert any("k_u, k_v and n_0 are totals" in note for note in scene.notes)


def test_without_areas_it_is_said_that_numbers_are_of_each_pair():
    (said,) = (note for note in read().notes if "of each" in note)
    assert said.startswith('contact "shroud": k_u, k_v and n_0 are those of each of 2 pairs.')
    (said,) = (note for note in read([PAIRS | NUMBERS | {"n_0": [5.0, -1.0]}]).notes if "of each" in note)
    assert said.startswith('contact "shroud": k_u and k_v are those of each')
    two = read([PAIRS | NUMBERS, PAIRS | NUMBERS | {"name": "root", "mu": 0.7}])
    (said,) = (note for note in two.notes if "of each" in note)
    assert said.startswith('contacts "shroud" and "root": k_u, k_v and n_0 are those of each of 2 pairs.')


@pytest.mark.parametrize("other", [PAIRS, {"name": "shroud", "tangential": "40x", "normal": "40z"}])
def test_two_contacts_of_one_name_are_refused_where_one_has_pairs(other):
    """A sweep of contact.shroud.n_0 took the single one alone, unsaid."""
    message = refused([PAIRS | NUMBERS, other | NUMBERS])
    assert message.count("a name must be there once") == 1
    assert 'contact: 2 contacts are named "shroud"' in message


def test_a_name_with_a_star_is_refused():
    message = refused([PAIRS | NUMBERS | {"name": "*"}])
    assert 'contact[0] "*".name: "*" has a *, which stands for any letters in keys' in message


def test_a_gap_is_that_of_each_pair():
    gap = {key: value for key, value in NUMBERS.items() if key != "n_0"} | {"gap": 0.1}
    contacts = read([PAIRS | gap | {"areas": [1.0, 2.0]}]).contacts
    assert [contact.n_0 for contact in contacts] == pytest.approx([-0.1 * 2 / 3, -0.1 * 4 / 3])


def test_a_list_has_a_number_for_each_pair():
    given = {"mu": [0.1, 0.2], "n_0": [5.0, -1.0], "areas": [1.0, 3.0]}
    one, other = read([PAIRS | NUMBERS | given]).contacts
    assert (one.mu, other.mu, one.n_0, other.n_0) == (0.1, 0.2, 5.0, -1.0)
    assert (one.k_u, other.k_u) == (0.25, 0.75)


FILE = """node,other,area,n_0,mu,x
40,41,1.0,1.5D+1,0.1,0.0
50,,3.0,-2,0.2,0.1  # touches the ground
"""


def test_pairs_and_their_numbers_in_a_file(tmp_path):
    (tmp_path / "pairs.csv").write_text(FILE, "utf-8-sig")
    given = {key: value for key, value in (PAIRS | NUMBERS).items() if key not in ("n_0", "mu")}
    one, other = of_file(tmp_path, given | {"nodes": "pairs.csv"}).contacts
    assert weights(one.normal) == {"40z": 1.0, "41z": -1.0} and weights(other.normal) == {"50z": 1.0}
    assert (one.n_0, other.n_0, one.mu, other.mu) == (15.0, -2.0, 0.1, 0.2)
    assert (one.k_u, other.k_u, other.k_v) == (0.25, 0.75, 1.5)


def test_columns_of_a_file_of_pairs_in_capitals_and_others_that_are_left_out(tmp_path):
    (tmp_path / "pairs.csv").write_text("Node,OTHER,n_0,Mu,colour,remark\n40,41,1,0.1,red,a\n50,,2,0.2,,b\n")
    given = {key: value for key, value in (PAIRS | NUMBERS).items() if key not in ("n_0", "mu")}
    scene = of_file(tmp_path, given | {"nodes": "pairs.csv"})
    assert [(one.n_0, one.mu) for one in scene.contacts] == [(1.0, 0.1), (2.0, 0.2)]
    (asked,) = (note for note in scene.notes if isinstance(note, Question))
    assert 'are columns "colour", "remark" of "pairs.csv" to be left out?' in asked


def test_nodes_that_other_programs_write_as_floats(tmp_path):
    """pandas does beside an empty cell, numpy's savetxt of all."""
    (tmp_path / "pairs.csv").write_text("node,other,n_0\n40.0,41.0,1.5\n50.0,,2\n")
    given = {key: value for key, value in (PAIRS | NUMBERS).items() if key != "n_0"}
    one, other = of_file(tmp_path, given | {"nodes": "pairs.csv"}).contacts
    assert weights(one.normal) == {"40z": 1.0, "41z": -1.0} and weights(other.normal) == {"50z": 1.0}
    np.savetxt(tmp_path / "n_0.txt", [[50, -1.0], [40, 3.5]])
    contacts = of_file(tmp_path, PAIRS | NUMBERS | {"n_0": "n_0.txt"}).contacts
    assert [contact.n_0 for contact in contacts] == [3.5, -1.0]


def test_a_number_in_quotes_is_no_file():
    with pytest.raises(SceneError, match=r'k_u: must be a number, is the string "4e5"; write 400000'):
        read([PAIRS | NUMBERS | {"k_u": "4e5"}])


@pytest.mark.parametrize("text", ["3.5\n-1\n", "51 -1  # by its other node\n40, 3.5\n41 8\n"])
def test_preloads_in_a_file(tmp_path, text):
    (tmp_path / "n_0.txt").write_text(text)
    contacts = of_file(tmp_path, PAIRS | NUMBERS | {"n_0": "n_0.txt"}).contacts
    assert [contact.n_0 for contact in contacts] == [3.5, -1.0]


@pytest.mark.parametrize(
    "text, words",
    [
        ("node,other,n_0,mu\n40,41,1,5,0.1\n", "line 2 has 5 entries; the first line names 4"),
        ('node,other,n_0,mu\n40,41,"1,5",0.1\n', 'line 2: n_0: "1,5" has a decimal comma: write 1.5'),
        ("node,n_0,mu\n40,1,0.1\n", 'line 1: has no column "other"'),
        ("node;other;n_0;mu\n40;41;1;0.1\n", "names have commas between, as node,other,n_0"),
        (
            "node,other,n_0,mu\n40;41;1;0.1\n",
            "line 2 has 1 entry; the first line names 4, with commas between",
        ),
        ("node,other,n_0,mu,n_0\n", 'has two columns "n_0"'),
        ("node,other,n_0,mu\n", "holds no pair of nodes"),
        ("", "is empty; its first line must name its columns"),
        ("node,other,n_0,mu\n40,40,1,0.1\n", "a pair of the same node twice, 40"),
        (
            "node,other,n_0,mu\n40,41,1,0.1\n50,51,1,0.1\n41,40,1,0.1\n",
            "line 4: pair 41, 40 is on line 2 already; each is there once",
        ),
        ("node,other,n_0,mu\n40,,1,0.1\n40,,1,0.1\n", "line 3: node 40 is on line 2 already"),
        ("node,other,n_0,mu\n40,99,1,0.1\n", "node 99 has no degree of freedom"),
        ("node,other,n_0,mu\n40,41,1,-0.1\n", "nodes (mu): must"),
        ("node,other,n_0,mu,k_u\n40,41,1,0.1,1\n", 'k_u: is given here and as a column of "pairs.csv"'),
        (
            "node,other,n_0,mu,areas\n40,41,1,0.1,1\n",
            '"pairs.csv" has a column "areas", of no meaning; did you mean "area"?',
        ),
        ("node,other,preload,mu\n40,41,1,0.1\n", 'of no meaning; did you mean "n_0"?'),
        ("node,other,n_0,mu,area\n40,41,1,0.1,0\n", "its areas must be greater than 0"),
    ],
)
def test_wrong_files_of_pairs(tmp_path, text, words):
    (tmp_path / "pairs.csv").write_text(text)
    given = {key: value for key, value in (PAIRS | NUMBERS).items() if key not in ("n_0", "mu")}
    with pytest.raises(SceneError) as caught:
        of_file(tmp_path, given | {"nodes": "pairs.csv"})
    assert words in str(caught.value)
    assert "neither n_0 nor gap" not in str(caught.value) and "missing" not in str(caught.value)


@pytest.mark.parametrize(
    "text, words",
    [
        ("1\n2\n3\n", "has 3 numbers for 2 pairs"),
        ("40 1\n40 2\n50 3\n", "has two numbers for one node"),
        ("40 1\n", 'has no number for the pair of node "50"'),
        ("40 1\n50 2\n7 3\n", '"n_0.txt" has 1 row of nodes that are in no pair, the first of node "7"'),
        ("40 1\n60 2\n61 2\n50 3\n", 'has 2 rows of nodes that are in no pair, the first of node "60"'),
        ("40 1\n2\n", "line 2: must be a number, or a node and a number"),
        ("1kN\n2\n", 'line 1: "1kN" has "kN" behind the number'),
        ("40,5\n50,5\n", '"40,5" may be a number with a decimal comma, or a node and its number'),
    ],
)
def test_wrong_files_of_numbers(tmp_path, text, words):
    (tmp_path / "n_0.txt").write_text(text)
    with pytest.raises(SceneError) as caught:
        of_file(tmp_path, PAIRS | NUMBERS | {"n_0": "n_0.txt"})
    assert words in str(caught.value)


@pytest.mark.parametrize("key", ["contact.shroud.n_0", "contact.shroud_*.n_0", "contact.*.n_0"])
def test_the_preload_of_all_is_one_swept_number(key):
    curves = read([PAIRS | NUMBERS | {"areas": [1.0, 2.0]}], sweep={key: [3.0, -9.0]}).curves
    assert [[contact.n_0 for contact in curve.contacts] for curve in curves] == [[1, 2], [-3, -6]]
    assert [curve.parameters for curve in curves] == [{key: 3.0}, {key: -9.0}]


PATTERN = PAIRS | NUMBERS | {"areas": [1.0, 2.0], "n_0": [1.0, 4.0]}
GROUP = ("contact.shroud.n_0", "contact.shroud_*.n_0", "contact.*.n_0")


def _pattern(folder, form):
    """The preloads 1 and 4 of two pairs, in each way that they can be given."""
    (folder / "n_0.txt").write_text("40 1\n50 4\n")
    (folder / "pairs.csv").write_text("node,other,area,n_0\n40,41,1,1\n50,51,2,4\n")
    if form == "file":
        return PATTERN | {"n_0": "n_0.txt"}
    if form == "list":
        return PATTERN
    return {key: value for key, value in PATTERN.items() if key not in ("n_0", "areas")} | {
        "nodes": "pairs.csv"
    }


@pytest.mark.parametrize("form", ["file", "list", "column"])
@pytest.mark.parametrize("key", GROUP)
def test_a_swept_total_scales_the_preloads_of_the_pairs(tmp_path, form, key):
    contact = _pattern(tmp_path, form)
    scene = read([contact], tmp_path, sweep={key: [10.0, -2.5, 5.0]})
    assert [one.n_0 for one in scene.contacts] == [1.0, 4.0]
    assert [[one.n_0 for one in curve.contacts] for curve in scene.curves] == [[2, 8], [-0.5, -2], [1, 4]]


def test_a_swept_total_scales_stiffnesses_of_the_pairs_too():
    own = PATTERN | {"k_u": [1.0, 3.0], "k_v": [1.0, 1.0]}
    (curve,) = read([own], sweep={"contact.shroud.k_u": [8.0], "contact.shroud.k_v": [3.0]}).curves
    assert [(one.k_u, one.k_v, one.n_0) for one in curve.contacts] == [(2.0, 1.5, 1.0), (6.0, 1.5, 4.0)]


def test_every_way_to_another_preload_means_the_total_of_the_pairs():
    scene = read([PATTERN], optimum={"vary": ["contact.shroud.n_0"], "minimise": "peak.40x"})
    assert scene.optimum.bounds == ((0.0, 50.0),)
    for key in GROUP:
        number = number_of(scene, key)
        assert number.value(scene) == 5.0
        moved = number.put(scene, 10.0)
        assert [one.n_0 for one in moved.contacts] == [2.0, 8.0]
        fixed = scene.draft.curve(scene, {}, number.values(10.0), fix=True)
        assert [one.n_0 for one in fixed.contacts] == [2.0, 8.0]
        assert number_of(fixed, key).value(fixed) == 10.0
        rates = rates_of(System(scene, (1,)), key)
        assert rates.contact[:, 3].tolist() == [0.2, 0.8]


def test_draws_of_a_preload_are_totals_of_the_pairs():
    drawn = {"contact.shroud.n_0": {"uniform": [10.0, 20.0], "count": 3, "seed": 1}}
    for curve in read([PATTERN], sweep=drawn).curves:
        one, other = (contact.n_0 for contact in curve.contacts)
        assert one + other == pytest.approx(curve.parameters["contact.shroud.n_0"], rel=1e-15)
        assert other == pytest.approx(4.0 * one, rel=1e-15)


def test_the_preload_of_one_pair_is_its_own():
    (curve,) = read([PATTERN], sweep={"contact.shroud_2.n_0": [7.0]}).curves
    assert [contact.n_0 for contact in curve.contacts] == [1.0, 7.0]
    both = {"contact.shroud.n_0": [1.0], "contact.shroud_2.n_0": [7.0]}
    assert "sets the same number" in refused([PATTERN], sweep=both)


@pytest.mark.parametrize("key", GROUP)
def test_preloads_that_add_up_to_nothing_have_no_other_total(key):
    said = refused([PATTERN | {"n_0": [3.0, -3.0]}], sweep={key: [1.0]})
    assert 'the n_0 of the pairs of contact "shroud" add up to 0, so they cannot be scaled' in said
    assert said.count("add up to 0") == 1 and "no such number" not in said


def test_one_pair_alone_is_swept_by_its_name():
    curves = read(sweep={"contact.shroud_2.mu": [0.1]}).curves
    assert [contact.mu for contact in curves[0].contacts] == [0.3, 0.1]


@pytest.mark.parametrize(
    "change, words",
    [
        ({"nodes": []}, "nodes: must be a list of pairs such as [[40, 41], [50, 51]]"),
        ({"nodes": [[40, 41, 50]]}, "nodes[0]: must be two nodes"),
        (
            {"nodes": [40, "41"]},
            'nodes: may be pairs, or nodes that touch the ground: write [[40, "41"]] or [[40], ["41"]]',
        ),
        ({"nodes": [[40, 40]]}, "nodes[0]: is the same node twice, 40"),
        ({"nodes": [[40, ""]]}, "nodes[0]: must be two nodes, or one that touches the ground"),
        ({"k_u": "300 N/mm"}, 'k_u: "300 N/mm" has "N/mm" behind the number: write 300, without quotes'),
        ({"mu": "30%"}, 'mu: "30%" has "%" behind the number: write 0.3, without quotes'),
        ({"k_u": "gone.txt"}, 'k_u: "gone.txt" is not there'),
        ({"nodes": [[40, 41], [50, 51], [41, 40]]}, "nodes[2]: is the same as nodes[0]; each is there once"),
        (
            {"nodes": [[40, 99]]},
            'nodes: node 99 has no degree of freedom along "x", "y", "z"; one that is held has no row',
        ),
        ({"nodes": [[40, 2.5]]}, "nodes[0]: must be two nodes"),
        ({"tangential": "40x"}, "tangential: must be one of x, y, z, rx, ry, rz, or a table"),
        ({"tangential": {"x": "1"}}, "tangential.x: must be a number"),
        ({"areas": [1.0]}, "areas: must have one number for each of 2 pairs, has 1"),
        ({"areas": [1.0, 0.0]}, "areas[1]: must be greater than 0"),
        ({"nodes": [[40, 40], [50, 51]], "areas": [1.0, 2.0]}, "nodes[0]: is the same node twice"),
        ({"nodes": [[40, 40], [50, 51]], "areas": [1.0]}, "one number for each of 2 pairs, has 1"),
    ],
)
def test_mistakes_of_pairs(change, words):
    assert words in refused([PAIRS | NUMBERS | change])


def test_a_sweep_over_all_contacts_is_no_mistake_beside_contacts_that_have_some():
    said = refused([PAIRS | NUMBERS | {"nodes": [40, 41, 50]}], sweep={"contact.*.n_0": [1.0]})
    assert "may be pairs" in said and "nothing in the scene matches" not in said


def test_all_nodes_that_are_not_there_are_named():
    said = refused([PAIRS | NUMBERS | {"nodes": [[40, 99], [98, 51]], "tangential": {"x": 0.6, "rz": 0.8}}])
    for node, along in ((40, '"rz"'), (99, '"x", "rz", "z"'), (98, '"x", "rz", "z"'), (51, '"rz"')):
        assert (
            f"node {node} has no degree of freedom along {along}; one that is held has no row\n"
            in f"{said}\n"
        )


def test_a_node_that_is_not_there_is_named_once():
    said = refused([PAIRS | NUMBERS | {"nodes": [[40, 99], [50, 99], [99]]}])
    assert said.count("node 99") == 1


def test_areas_without_what_they_share():
    plain = {"name": "a", "tangential": "40x", "normal": "40z", "areas": [1.0]}
    assert "areas: is of no use without nodes" in refused([plain | NUMBERS])


def several(*names, **numbers):
    plain = {"tangential": "40x", "normal": "40z"} | NUMBERS
    return [plain | {"name": name} for name in names]


def test_a_star_stands_for_all_that_match():
    curves = read(several("a1", "a2", "b"), sweep={"contact.a*.mu": [0.1, 0.2], "contact.b.mu": [0.5]}).curves
    found = [[contact.mu for contact in curve.contacts] for curve in curves]
    assert found == [[0.1, 0.1, 0.5], [0.2, 0.2, 0.5]]


def test_a_star_for_forces_with_and_without_a_name():
    force = [{"dof": "40x", "amplitude": 1.0}, {"dof": {"40x": 1.0, "41x": 1.0}, "amplitude": 1.0}]
    curves = read(force=force, sweep={"force.*.amplitude": [2.0]}).curves
    assert [one.amplitude for one in curves[0].forces] == [2.0, 2.0]


def test_stars_that_stand_for_nothing_or_not_for_all():
    assert 'nothing in the scene matches "contact.z*"' in refused(sweep={"contact.z*.n_0": [1]})
    assert '"contact.shroud_1" has no "k_t" to sweep' in refused(sweep={"contact.*.k_t": [1]})
    gap = {key: value for key, value in several("g")[0].items() if key != "n_0"} | {"gap": 0.1}
    message = refused([*several("a"), gap], sweep={"contact.*.n_0": [1]})
    assert '"contact.g" has no "n_0" to sweep; it is given by gap' in message


def test_two_keys_for_one_number():
    message = refused(several("a", "b"), sweep={"contact.*.n_0": [1], "contact.a.n_0": [2]})
    assert 'sets the same number as "contact.*.n_0"' in message


def test_keys_in_step_and_their_product_with_others():
    paired = [{"contact.a.n_0": [1, 2], "contact.b.n_0": [5, 6]}]
    curves = read(several("a", "b"), sweep={"contact.a.mu": [0.1, 0.2], "paired": paired}).curves
    found = [(curve.contacts[0].mu, *(contact.n_0 for contact in curve.contacts)) for curve in curves]
    assert found == [(0.1, 1, 5), (0.1, 2, 6), (0.2, 1, 5), (0.2, 2, 6)]
    assert list(curves[0].parameters) == ["contact.a.mu", "contact.a.n_0", "contact.b.n_0"]


def test_two_tables_of_keys_in_step():
    paired = [{"contact.a.n_0": [1, 2], "contact.b.n_0": [5, 6]}, {"contact.a.mu": [0.1, 0.2]}]
    assert len(read(several("a", "b"), sweep={"paired": paired}).curves) == 4


@pytest.mark.parametrize(
    "paired, words",
    [
        ([{"contact.a.n_0": [1, 2], "contact.b.n_0": [5]}], "its keys go in step, but have 1 and 2 values"),
        ([{"contact.a.n_0": []}], 'sweep.paired[0]."contact.a.n_0": is an empty list'),
        ([{"contact.z.n_0": [1]}], 'sweep.paired[0]."contact.z.n_0": there is no such number'),
        ({"contact.a.n_0": [1]}, "sweep.paired: must be a list of tables"),
        ([3], "sweep.paired[0]: must be a table"),
    ],
)
def test_mistakes_of_keys_in_step(paired, words):
    assert words in refused(several("a", "b"), sweep={"paired": paired})


@pytest.mark.parametrize(
    ("nodes", "said"),
    [
        ([[1, 11], [12, 2], [3, 13], [4, 14]], ['1 of 4 pairs, "joint_2", has its nodes exchanged']),
        ([[1, 11], [2, 12], [3, 13], [4, 14]], []),
        ([[11, 1], [12, 2], [13, 3], [14, 4]], []),  # which side is the first one is not known
        ([[1, 2], [3, 4], [12, 11]], []),  # within a body
        ([[1], [2], [13], [14]], []),  # to the ground
    ],
)
def test_a_pair_with_its_nodes_exchanged_is_told(nodes, said):
    """Two bodies of four nodes each, which only the contacts couple."""
    body = 4.0 * np.eye(4) - np.ones((4, 4)) + 0.1 * np.eye(4)
    names = [*range(1, 5), *range(11, 15)]
    structure = {
        "dofs": [f"{node}{axis}" for axis in "xz" for node in names],
        "stiffness": np.kron(np.eye(4), body).tolist(),
        "mass": np.ones(16).tolist(),
        "damping": 0.01,
    }
    contact = NUMBERS | {"name": "joint", "nodes": nodes, "tangential": "x", "normal": "z"}
    data = {"structure": structure, "contact": [contact], "force": [{"dof": "1x", "amplitude": 1.0}]}
    scene = scene_from_dict(data | {"response": {"frequency": [0.8, 1.2]}})
    told = [note for note in scene.notes if "exchanged" in note]
    assert len(told) == len(said) and all(words in note for words, note in zip(said, told, strict=True))


def test_so_is_one_between_two_sectors_of_a_ring():
    body = 4.0 * np.eye(4) - np.ones((4, 4)) + 0.1 * np.eye(4)
    structure = {
        "dofs": [f"{node}{axis}" for axis in "xz" for node in range(1, 5)],
        "stiffness": np.kron(np.eye(2), body).tolist(),
        "mass": np.ones(8).tolist(),
        "damping": 0.01,
    }
    nodes = [["1", "next.2"], ["next.2", "3"], ["2", "next.3"]]
    contact = NUMBERS | {"name": "shroud", "nodes": nodes, "tangential": "x", "normal": "z"}
    scene = scene_from_dict(
        {"structure": structure, "contact": [contact], "force": [{"dof": "1x", "amplitude": 1.0}]}
        | {"cyclic": {"sectors": 6, "engine_order": 1}, "response": {"frequency": [0.8, 1.2]}}
    )
    (told,) = (note for note in scene.notes if "exchanged" in note)
    assert '1 of 3 pairs, "shroud_2", has its nodes exchanged' in told
