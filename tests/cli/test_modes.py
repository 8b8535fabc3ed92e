"""``fcm plot modes``: the modes of a scene, listed before anything is solved."""

from __future__ import annotations

import json

import numpy as np
import pytest

from ..program import called

SCENE = """
frequency_unit = "Hz"
[modal]
dofs = ["u", "v", "w"]
mass = [2.0, 3.0, 1.0]
frequency = [1.0, 4.0, 5.0]
damping = [0.01, 0.0, 0.02]
shapes = [[1.0, 0.5, 0.0], [0.2, 1.0, 0.0], [0.0, 1.0, 0.0]]
[[contact]]
name = "shroud"
tangential = "u"
normal = "w"
mu = 0.3
k_u = 1
k_v = 1
n_0 = 1
[[force]]
dof = "v"
amplitude = 1
[response]
frequency = [2, 4.5]
"""


@pytest.fixture
def listed(tmp_path):
    def run(text, *options):
        (tmp_path / "scene.toml").write_text(text)
        return called("plot", "modes", tmp_path / "scene.toml", *options)

    return run


def test_participation_is_the_share_of_the_static_flexibility(listed):
    found = json.loads(listed(SCENE, "--json").out)
    flexibility = np.array([0.25 / (2.0 * 1.0), 1.0 / (3.0 * 16.0), 1.0 / 25.0])  # along v, of each mode
    shares = [mode["participation"]["force.v"] for mode in found["modes"]]
    assert shares == pytest.approx(flexibility / flexibility.sum())
    assert [mode["frequency"] for mode in found["modes"]] == pytest.approx([1.0, 4.0, 5.0])
    assert [mode["displacement"]["contact.shroud.tangential"] for mode in found["modes"]] == pytest.approx(
        [1 / np.sqrt(2), 0.2 / np.sqrt(3), 0.0]
    )
    assert found["normalisation"] == "largest value 1; modal masses from 1 to 3"


def test_forces_stay_in_the_table_beside_many_contacts_and_what_does_not_fit_is_said(listed):
    contact = SCENE[SCENE.index("[[contact]]") : SCENE.index("[[force]]")]
    second, third = (contact.replace("shroud", name) for name in ("root", "tip"))
    found = listed(SCENE.replace("[[force]]", f"{second}{third}[[force]]"))
    assert "force.v" in found.out.splitlines()[0]
    assert "6 of 7 directions of contacts and forces: --json has all" in found.err
    assert "directions" not in listed(SCENE).err
    long = listed(
        SCENE.replace("shroud", "an interlocked shroud of the outer ring").replace(
            "[[force]]", f"{second}[[force]]"
        )
    )
    assert max(map(len, long.out.splitlines())) <= 120 and "force.v" in long.out.splitlines()[0]
    assert "2 of 5 directions of contacts and forces: --json has all" in long.err


def test_a_second_force_takes_no_place_of_the_first_contacts_normal(listed):
    """It was left out, where names are so long that three directions fit."""
    name = "an interlocked shroud ring 1"
    force = 'amplitude = 1\n[[force]]\ndof = "u"\namplitude = 1\n'
    found = listed(SCENE.replace('"shroud"', f'"{name}"').replace("amplitude = 1\n", force, 1))
    head = found.out.splitlines()[0]
    assert f"{name}.normal" in head and "force.v" in head and "force.u" not in head
    assert "3 of 4 directions of contacts and forces: --json has all" in found.err


def test_what_is_amiss_is_said_before_anything_is_solved(listed):
    warnings = json.loads(listed(SCENE, "--json").out)["warnings"]
    assert "contact.shroud.normal: no mode moves along it" in warnings
    assert "within the range, without damping: mode 2" in warnings
    assert any("the highest mode is at 5" in warning for warning in warnings)


def test_a_line_for_each_mode(listed):
    done = listed(SCENE.replace("frequency = [1.0,", "frequency = [0.0,"))
    header, *lines = done.out.partition("\n\n")[0].splitlines()
    assert header.split()[:4] == ["mode", "at", "Hz", "damping"] and len(lines) == 3
    assert lines[0].endswith("rigid body") and lines[0].split()[4] == "-"
    assert "- no share: under a static load there the rigid-body modes move without limit" in done.err
    assert "no share" not in listed(SCENE).err
    assert "warning: contact.shroud.normal: no mode moves along it" in done.err


def test_modes_that_stand_for_flexibility_are_marked(listed):
    modal = SCENE[SCENE.index("[modal]") : SCENE.index("[[contact]]")]
    spring = np.diag([2.0] * 40) - np.eye(40, k=1) - np.eye(40, k=-1)
    structure = f"""
[structure]
dofs = {json.dumps([f"{i}x" for i in range(37)] + ["u", "v", "w"])}
stiffness = {(1e4 * spring).tolist()}
mass = {[1.0] * 40}
damping = 0.01
modes = 3
"""
    text = SCENE.replace(modal, structure)
    found = json.loads(listed(text, "--json").out)
    kinds, shown = [mode["kind"] for mode in found["modes"]], listed(text)
    count = shown.out.count("flexibility")  # a line for the first few, which no one looks up
    beyond = kinds.count("flexibility") - count
    assert count <= 5 and (not beyond or f"{beyond} more modes stand for flexibility" in shown.err)
    assert kinds[:3] == ["mode"] * 3 and set(kinds[3:]) == {"flexibility"}
    for name in ("contact.shroud.tangential", "contact.shroud.normal", "force.v"):
        assert sum(mode["participation"][name] for mode in found["modes"]) == pytest.approx(1.0)
    assert found["notes"][0].startswith("structure: 3 modes of 40 degrees of freedom are kept")


def test_resonances_of_modes_with_contacts_are_told_with_one_prefix(listed):
    said = [line for line in listed(SCENE).err.splitlines() if "first resonances" in line]
    assert len(said) == 1 and said[0].startswith("read: first resonances with all contacts open: ")


def test_a_scene_with_mistakes_is_refused(listed):
    done = listed(SCENE.replace('dof = "v"', 'dof = "x"'))
    assert done.code == 2 and 'unknown degree of freedom "x"' in done.err


def test_matrices_whose_modes_are_all_kept_lack_none(listed):
    kept = "frequency_unit = 'rad/s'\n[structure]\ndofs = ['u', 'v', 'w']\nmass = [1, 1, 1]\n"
    stiffness = "stiffness = [[2, -1, 0], [-1, 2, -1], [0, -1, 1]]\ndamping = 0.01\n"
    text = (kept + stiffness + SCENE[SCENE.index("[[contact]]") :]).replace("[2, 4.5]", "[0.2, 4.5]")
    assert json.loads(listed(text, "--json").out)["warnings"] == []
    fewer = text.replace("damping", "modes = 2\nflexibility = false\ndamping", 1)
    (said,) = json.loads(listed(fewer, "--json").out)["warnings"]
    assert "a contact lacks the flexibility of all modes above" in said


MATRICES = """
[structure]
dofs = ["u", "v"]
mass = "M.mtx"
stiffness = "K.mtx"
damping = 0.01
[[force]]
dof = "u"
amplitude = 1.0
[response]
frequency = [{}, {}]
"""


@pytest.fixture
def matrices(tmp_path):
    head = "%%MatrixMarket matrix coordinate real symmetric\n2 2 {}\n"
    (tmp_path / "K.mtx").write_text(head.format(3) + "1 1 5.0e4\n2 1 -1.0e4\n2 2 1.0e4\n")
    (tmp_path / "M.mtx").write_text(head.format(2) + "1 1 1.0\n2 2 1.0\n")


def test_what_was_read_of_matrices_is_told(listed, matrices):
    """Their frequencies, by the eigenvalues: 87.44 and 228.7 rad/s."""
    done = listed(MATRICES.format(50, 300))
    low, high = np.sqrt(np.linalg.eigvalsh([[5e4, -1e4], [-1e4, 1e4]]))
    assert "read: stiffness: K.mtx: 2 rows, 4 entries that are not 0, symmetric" in done.err
    assert "read: mass: M.mtx: 2 rows, 2 entries that are not 0, diagonal" in done.err
    hertz = low / (2 * np.pi), high / (2 * np.pi)
    assert (
        f"read: no rigid-body mode; others from {hertz[0]:.6g} to {hertz[1]:.6g} Hz, which are {low:.6g} to "
        f"{high:.6g} rad/s" in done.err
    )
    assert "the range would hold" not in done.err


@pytest.mark.parametrize(
    ("ends", "more", "said"),
    [
        ((13, 20), "", 'frequency_unit = "Hz"'),
        ((80, 300), 'frequency_unit = "Hz"\n', 'frequency_unit = "rad/s"'),
        ((2500, 3500), "", "give the mass in t"),
        ((2.5, 3.5), "", "give the mass in kg"),
        ((1e7, 2e7), "", ""),
    ],
)
def test_units_that_look_mixed_are_asked_about(listed, matrices, ends, more, said):
    found = json.loads(listed(more + MATRICES.format(*ends), "--json").out)["read"]
    asked = [text for text in found if "the range would hold" in text]
    assert [said in text for text in asked] == ([True] if said else [])


def test_units_that_look_mixed_are_asked_about_where_a_curve_is_traced_too(matrices, tmp_path):
    for ends, asked in (((13, 20), 1), ((50, 300), 0)):
        scene = tmp_path / "range.toml"
        scene.write_text(MATRICES.format(*ends))
        done = called("respond", scene)
        assert done.code == 0 and done.err.count('were in Hz: frequency_unit = "Hz"') == asked


@pytest.mark.parametrize("rows", [3, 60])  # from 51 on those alone are kept that something is attached to
def test_a_structure_alone_is_enough(listed, rows):
    """Without contacts, forces and a range: a chain between walls, w_i = 2 sin(i pi / (2 n + 2))."""
    chain = 2.0 * np.eye(rows) - np.eye(rows, k=1) - np.eye(rows, k=-1)
    text = (
        f"[structure]\ndofs = {[f'u{i}' for i in range(rows)]}\nmass = {np.eye(rows).tolist()}\n"
        f"stiffness = {chain.tolist()}\ndamping = 0.01"
    )
    found = json.loads(listed(text, "--json").out)
    frequency = [mode["frequency"] for mode in found["modes"]]
    exact = 2.0 * np.sin(np.arange(1, len(frequency) + 1) * np.pi / (2 * rows + 2))
    assert frequency == pytest.approx(exact, rel=1e-9)
    assert found["normalisation"].startswith("mass-normalised") and not found["warnings"]
    assert listed(text).code == 0


def test_modes_alone_are_enough_but_not_to_be_solved(listed, tmp_path):
    text = SCENE[: SCENE.index("[[contact]]")]
    assert listed(text).out.splitlines()[0].split() == ["mode", "at", "Hz", "damping", "mass"]
    done = called("respond", tmp_path / "scene.toml")
    assert done.code == 2 and "response: missing" in done.err and "force: missing" in done.err


def test_resonances_and_damping_with_contacts_open_and_stuck(listed):
    """Against the complex eigenvalues of the matrices with the springs of the contact."""
    shapes, mass = np.array([[1.0, 0.5, 0.0], [0.2, 1.0, 0.0], [0.0, 1.0, 1.0]]), np.array([2.0, 3.0, 1.0])
    scene = SCENE.replace("[0.0, 1.0, 0.0]]", "[0.0, 1.0, 1.0]]").replace("k_u = 1\n", "k_u = 400\n")
    inverse, omega = np.linalg.inv(shapes), 2 * np.pi * np.array([1.0, 4.0, 5.0])
    M, K, C = (
        inverse @ np.diag(mass * each) @ inverse.T
        for each in (np.ones(3), omega**2, 2.0 * np.array([0.01, 0.0, 0.02]) * omega)
    )
    stiff = np.linalg.solve(M, K + np.diag([400.0, 0.0, 1.0]))
    values = np.linalg.eigvals(np.block([[np.zeros((3, 3)), np.eye(3)], [-stiff, -np.linalg.solve(M, C)]]))
    values = sorted(values[values.imag > 0.0], key=abs)
    said = next(line for line in listed(scene).err.splitlines() if "with all stuck" in line)
    numbers = [float(word.strip(",;.")) for word in said.split() if word[0].isdigit()]
    assert numbers[:3] == [1.0, 4.0, 5.0]
    assert numbers[3:6] == pytest.approx([abs(one) / (2.0 * np.pi) for one in values], rel=1e-4)
    assert numbers[6:] == pytest.approx([-one.real / abs(one) for one in values], rel=5e-3)


def test_damping_of_a_mode_in_which_a_contact_holds_a_rigid_body(listed):
    """The ratio given is that without contacts: here half of it is left."""
    text = """
    [structure]
    dofs = ["1x", "2x"]
    stiffness = [[4.0, 0.0], [0.0, 0.0]]
    mass = [[1.0, 0.0], [0.0, 3.0]]
    damping = 0.01
    [[contact]]
    name = "joint"
    tangential = { 1x = 1.0, 2x = -1.0 }
    normal = "1x"
    mu = 0.5
    k_u = 1e6
    k_v = 0.0
    n_0 = 10.0
    """
    said = listed(text).err
    # together 4 kg on a stiffness of 4: 1 rad/s; the damper of 2 * 0.01 * 2 gives it 0.04 / (2 * 4)
    assert (
        "with all contacts open: 0 (1 rigid-body mode), 2 rad/s; with all stuck: 1, 1154.7 rad/s, by shape "
        "those at 0, 2 rad/s open. Their" in said
    )
    assert "damping ratios while stuck: 0.005," in said
    assert "rigid-body modes have none" in said and "structure: its mass along x is 4, without" in said


FLOATING = """
[structure]
dofs = ["u", "v", "d", "e"]
stiffness = [[1e4, 0, 0, 0], [0, 9e4, 0, 0], [0, 0, 0, 0], [0, 0, 0, 4e4]]
mass = [1.0, 1.0, 0.01, 2.0]
damping = 0.01
[[contact]]
name = "damper"
tangential = { u = 1.0, d = -1.0 }
normal = { v = 1.0, d = -1.0 }
mu = 0.5
k_u = 1e4
k_v = 2e4
n_0 = 10.0
[[force]]
dof = "u"
amplitude = 1.0
"""  # a blade that moves u and v, a damper d that only the contact holds, and another body


def test_resonances_stand_beside_the_open_mode_of_their_shape(listed):
    """By number all were shifted by the damper's rigid-body mode."""
    K, M = np.diag([1e4, 9e4, 0.0, 4e4]), np.diag([1.0, 1.0, 0.01, 2.0])
    for k, along in ((1e4, np.array([1.0, 0.0, -1.0, 0.0])), (2e4, np.array([0.0, 1.0, -1.0, 0.0]))):
        K = K + k * np.outer(along, along)
    squares, shapes = np.linalg.eig(np.linalg.solve(M, K))
    order = np.argsort(squares)
    stuck, shapes = np.sqrt(squares[order]), shapes[:, order]
    assert list(np.abs(shapes).argmax(axis=0)) == [0, 3, 1, 2]  # u, e, v, d
    found = json.loads(listed(FLOATING, "--json").out)["resonances"]
    assert [one["stuck"] for one in found] == pytest.approx(stuck)
    assert [one["open"] for one in found] == pytest.approx([100.0, np.sqrt(2e4), 300.0, 0.0])
    assert [one["open_mode"] for one in found] == [2, 3, 4, 1]
    mass = np.diag(M)
    share = mass * shapes.T**2 / (shapes.T**2 @ mass)[:, None]
    assert [one["mac"] for one in found] == pytest.approx(
        [share[0, 0], share[1, 3], share[2, 1], share[3, 2]]
    )
    done = listed(FLOATING)
    said = "open: the mode without contacts of the most alike shape, MAC: how alike, 1 the same"
    assert said in done.out and "MAC" in done.out
    row = next(line.split() for line in done.out.splitlines() if f"  {stuck[0]:.6g}" in line)
    assert row[1:4] == [f"{stuck[0]:.6g}", "100.000", f"{share[0, 0]:.3f}"]
    assert (
        f"{stuck[0]:.5g}, 141.42, {stuck[2]:.5g} rad/s, by shape those at 100, 141.42, 300 rad/s" in done.err
    )
    assert found[1]["friction_damping"] == 0.0  # the other body, but for rounding


def test_the_stiffness_beside_a_floating_body_is_that_of_the_elastic_modes(listed):
    """The blade's: the table had dashes alone."""
    (found,) = json.loads(listed(FLOATING, "--json").out)["stiffness"].values()
    assert found["structure_tangential"] is None and found["structure_normal"] is None
    assert found["elastic_tangential"] == pytest.approx(1e4) and found["elastic_normal"] == pytest.approx(9e4)
    out = listed(FLOATING).out
    assert ["damper", "1e+04", "1e+04'", "1'", "2e+04", "9e+04'", "0.2222'"] in map(
        str.split, out.splitlines()
    )
    assert "' of elastic modes alone" in out
    ground = FLOATING.replace("{ u = 1.0, d = -1.0 }", '"d"').replace("{ v = 1.0, d = -1.0 }", '"v"')
    out = listed(ground).out  # no elastic mode moves along it
    assert ["damper", "1e+04", "-", "-", "2e+04", "9e+04", "0.2222"] in map(str.split, out.splitlines())
    assert "of elastic modes alone" not in out


@pytest.mark.parametrize(
    ("frequency", "beside"),
    [
        ([1.0, 1.0, 9.0], ["1.00000 1.000", "9.00000 1.000", "1.00000 1.000"]),
        ([1.0, 1.01, 1.02], ["- 0.333"]),  # in the last one all three move alike
    ],
)
def test_modes_of_one_frequency_count_together_and_shapes_of_none_have_none(listed, frequency, beside):
    scene = SCENE.replace("[1.0, 4.0, 5.0]", str(frequency)).replace("mass = [2.0, 3.0, 1.0]\n", "")
    scene = scene.replace(
        "[[1.0, 0.5, 0.0], [0.2, 1.0, 0.0], [0.0, 1.0, 0.0]]", "[[1, 0, 0], [0, 1, 0], [0, 0, 1]]"
    )
    along = "{ u = 1.0, v = 1.0 }" if frequency[-1] > 2.0 else "{ u = 1.0, v = 1.0, w = 1.0 }"
    out = listed(
        scene.replace('tangential = "u"', f"tangential = {along}").replace("k_u = 1\n", "k_u = 1e4\n")
    ).out
    table = out[out.index("resonance  stuck") :].partition("\n\n")[0].splitlines()[1:4]
    assert [" ".join(row.split()[2:4]) for row in table][-len(beside) :] == beside


def test_proportional_damping_that_leaves_no_resonance_is_asked_about(listed):
    """Of a factor in other units: nothing was said, and the ratios stood among many."""
    rest = SCENE[SCENE.index("[[contact]]") :].replace('"w"', '"v"')
    text = '[structure]\ndofs = ["u", "v"]\nstiffness = [[3.0, -1.0], [-1.0, 2.0]]\nmass = [[1, 0], [0, 1]]\n'
    for factor, asked in ((0.01, False), (8.0, True)):
        said = listed(f"{text}damping = {{ stiffness = {factor} }}\n{rest}").err
        assert (
            "structure.damping: is it right? It damps each of these more than critically" in said
        ) == asked


def test_stiffness_and_mass_in_each_others_place(tmp_path):
    """Nothing was said: the response of so heavy a structure is small, and an error of none."""
    matrices = 'dofs = ["u", "v"]\nstiffness = {}\nmass = {}\ndamping = 0.01\n'
    soft, light = "[[3e6, -1e6], [-1e6, 2e6]]", "[[0.2, 0.0], [0.0, 0.3]]"
    rest = SCENE[SCENE.index("[[contact]]") :].replace('"w"', '"v"').replace("[2, 4.5]", "[300, 900]")
    for pair, amiss in (((soft, light), False), ((light, soft), True)):
        text = f'frequency_unit = "Hz"\n[structure]\n{matrices.format(*pair)}{rest}'
        (tmp_path / "scene.toml").write_text(text)
        done = called("respond", tmp_path / "scene.toml")
        assert ("Stiffness and mass are in each other's place" in done.err) == amiss
        assert done.code == (2 if amiss else 0)
        if amiss:
            K, M = (np.array(json.loads(text)) for text in (soft, light))
            first = np.sqrt(np.linalg.eigvals(np.linalg.solve(M, K)).real.min()) / (2.0 * np.pi)
            assert f"they have a mode at {first:.6g} Hz" in done.err


def test_a_structure_below_the_range_whose_contacts_reach_it_is_in_place(tmp_path):
    """Two soft bodies of 1 and 2 kg that a contact joins: resonance by its stiffness alone.

    Their own frequencies are below the range, and the exchanged ones within it.
    """
    text = """
    [structure]
    dofs = ["u", "v"]
    stiffness = [[1e-6, 0.0], [0.0, 1e-6]]
    mass = [[1.0, 0.0], [0.0, 2.0]]
    damping = 0.01
    [[contact]]
    name = "joint"
    tangential = { u = 1.0, v = -1.0 }
    normal = "v"
    mu = 0.5
    k_u = 1e6
    k_v = 0.0
    n_0 = 10.0
    [[force]]
    dof = "u"
    amplitude = 1.0
    [response]
    frequency = [900.0, 1500.0]
    harmonics = 1
    """
    (tmp_path / "scene.toml").write_text(text)
    done = called("respond", tmp_path / "scene.toml")
    assert done.code == 0 and "each other's place" not in done.err and "structure: 2 modes" in done.err


def test_the_stiffness_of_the_structure_at_a_contact_is_that_by_a_unit_load(listed, tmp_path):
    """Two masses on springs of 200 and 300 N/m: a load on the second meets both in series, 120 N/m."""
    matrices = """
[structure]
dofs = ["a", "b"]
mass = [2.0, 1.0]
stiffness = [[500.0, -300.0], [-300.0, 300.0]]
damping = 0.01
"""
    scene = matrices + SCENE[SCENE.index("[[contact]]") :].replace('"u"', '"a"').replace('"w"', '"b"')
    scene = scene.replace('"v"', '"a"').replace("k_u = 1", "k_u = 20").replace("k_v = 1", "k_v = 60")
    found = json.loads(listed(scene, "--json").out)["stiffness"]
    assert found["shroud"] == pytest.approx(
        {
            "k_u": 20.0,
            "structure_tangential": 200.0,
            "elastic_tangential": 200.0,
            "k_v": 60.0,
            "structure_normal": 120.0,
            "elastic_normal": 120.0,
        }
    )
    rows = [line.split() for line in listed(scene).out.splitlines()]
    assert ["shroud", "20", "200", "0.1", "60", "120", "0.5"] in rows
    assert ["contact", "k_u", "along", "ratio", "k_v", "across", "ratio"] in rows


def test_in_a_plane_the_softer_direction_counts(listed):
    scene = SCENE.replace('tangential = "u"', 'tangential = ["u", "v"]')
    shapes = "shapes = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]"
    scene = scene.replace(SCENE[SCENE.index("shapes") : SCENE.index("[[contact]]")], f"{shapes}\n")
    (found,) = json.loads(listed(scene, "--json").out)["stiffness"].values()
    assert found["structure_tangential"] == pytest.approx(2.0 * (2.0 * np.pi) ** 2)
    assert found["structure_normal"] == pytest.approx(25.0 * (2.0 * np.pi) ** 2)


def test_where_rigid_bodies_move_the_structure_has_no_stiffness(listed):
    scene = SCENE.replace("frequency = [1.0, 4.0, 5.0]", "frequency = [0.0, 4.0, 5.0]")
    scene = scene.replace("[0.0, 1.0, 0.0]]", "[0.0, 1.0, 1.0]]")  # only an elastic mode moves the normal
    (found,) = json.loads(listed(scene, "--json").out)["stiffness"].values()
    assert found["structure_tangential"] is None
    assert found["structure_normal"] == pytest.approx((10.0 * np.pi) ** 2)
    assert found["elastic_tangential"] == pytest.approx(3.0 * (2.0 * np.pi * 4.0) ** 2 / 0.2**2)


def test_of_many_contacts_those_of_the_greatest_ratio_are_listed(listed):
    contact = SCENE[SCENE.index("[[contact]]") : SCENE.index("[[force]]")]
    more = "".join(contact.replace("shroud", f"c{i}").replace("k_u = 1", f"k_u = {i + 2}") for i in range(12))
    out = listed(SCENE.replace("[[force]]", f"{more}[[force]]")).out
    table = out[out.index("the stiffness of each contact") :]
    assert [line.split()[0] for line in table.splitlines()[2:-1]] == [f"c{i}" for i in range(2, 12)]
    assert table.rstrip().endswith("and 3 more contacts: --json has all")


@pytest.mark.parametrize(
    ("units", "springs", "preload"),
    [
        ('length = "mm"\nforce = "N"', " [N/mm],", "n_0 [N]"),
        ('force = "N"', ",", "n_0 [N]"),
        ("", ",", "n_0"),
    ],
)
def test_stiffnesses_and_preloads_have_the_units_of_the_scene(listed, units, springs, preload):
    out = listed(f"{SCENE}\n[units]\n{units}\n").out
    assert f"the stiffness of each contact{springs} beside" in out
    (heads,) = [line for line in out.splitlines() if line.startswith("resonance ")]
    assert heads.endswith(f"  {preload}")


ONE_MASS = """
[structure]
dofs = ["u", "v"]
stiffness = [1.0, 1e4]
mass = [1.0, 1.0]
damping = 0.01
[[contact]]
name = "c"
tangential = "u"
normal = "v"
mu = 0.5
k_u = {k_u}
k_v = 0.0
n_0 = 1.0
[[force]]
dof = "u"
amplitude = 1.0
[response]
frequency = [0.1, 2.0]
"""


@pytest.mark.parametrize("k_u", [0.1, 30.0, 1e4])
def test_friction_that_damps_more_than_critically_is_told(listed, k_u):
    """Of one mass on a spring of 1 the ratio is k_i / (2 (1 + k_r)), by the areas of Jenkins loops."""
    theta = np.linspace(0.0, np.pi, 2_000)
    k_r, k_i = (theta - np.sin(theta) * np.cos(theta)) / np.pi, np.sin(theta) ** 2 / np.pi
    most = (k_u * k_i / (2.0 * (1.0 + k_u * k_r))).max()
    over = bool(most > 1.0)
    done = listed(ONE_MASS.format(k_u=k_u))
    (line,) = (one for one in done.out.splitlines() if " c  " in one and "%" in one)
    cell = line.split()[4]
    assert float(cell.rstrip("+")) == pytest.approx(most, rel=0.05) and cell.endswith("+") is over
    assert ("overdamped: the ratio is that of a linear damper" in done.out) is over


@pytest.mark.slow
def test_a_nonlinear_mode_that_friction_damps_more_than_critically_is_told(tmp_path):
    for k_u, over in ((0.1, False), (1e3, True)):
        (tmp_path / "scene.toml").write_text(ONE_MASS.format(k_u=k_u))
        done = called(
            "respond",
            tmp_path / "scene.toml",
            "--mode",
            1,
            "--level",
            "1e-5:1",
            "--harmonics",
            1,
            "--force-level",
            0.3,
        )
        assert done.code == 0 and ("+ overdamped: " in done.out) is over
        assert ("no peak over the frequency: damped by more than 0.71" in done.out) is over


@pytest.mark.parametrize("nodes", ["", 'nodes = [["1", "2"]]', 'nodes = [["1"], ["2"]]'])
def test_preloads_are_of_a_pair_where_there_are_pairs(listed, nodes):
    """The sentence stood there for each scene with friction."""
    along = 'tangential = "x"\nnormal = "y"' if nodes else 'tangential = "1x"\nnormal = "1y"'
    text = f"""
    [structure]
    dofs = ["1x", "1y", "2x", "2y"]
    stiffness = [1.0, 2.0, 3.0, 4.0]
    mass = [1.0, 1.0, 1.0, 1.0]
    damping = 0.01
    [[contact]]
    name = "c"
    {nodes}
    {along}
    mu = 0.5
    k_u = 1.0
    k_v = 1.0
    n_0 = 1.0
    """
    done = listed("\n".join(line.strip() for line in text.splitlines()))
    assert done.code == 0 and "that friction can add to each resonance" in done.out
    assert ("n_0 is that of a pair" in done.out) is bool(nodes)


def test_a_preload_that_pairs_share_is_the_total_that_the_scene_has(listed):
    """It was that of a pair, beside a total in the scene."""
    text = """
    [structure]
    dofs = ["1x", "1y", "2x", "2y"]
    stiffness = [1.0, 1.5, 1.0, 1.5]
    mass = [1.0, 1.0, 1.0, 1.0]
    damping = 0.01
    [[contact]]
    name = "c"
    nodes = [["1"], ["2"]]
    tangential = "x"
    normal = "y"
    mu = 0.5
    k_u = 1.0
    k_v = 1.0
    n_0 = 1.0
    [[force]]
    dof = "1x"
    amplitude = 1.0
    """
    text = "\n".join(line.strip() for line in text.splitlines())
    pair, total = (listed(text.replace("n_0", f"{areas}n_0")) for areas in ("", "areas = [3.0, 1.0]\n"))
    assert "n_0 is the total of all pairs" in total.out and "n_0 is that of a pair" in pair.out


def test_of_a_ring_the_modes_of_the_diameters_that_forces_meet_are_listed(fcm):
    few, every = (fcm("plot", "modes", "bladed-disk", *more) for more in ((), ("--all",)))
    said = json.loads(fcm("plot", "modes", "bladed-disk", "--json").out)["modes"]
    met = [one for one in said if one["met"]]
    assert 0 < len(met) < len(said)
    assert len(few.out.splitlines()) < len(every.out.splitlines())
    assert {row.split()[1] for row in few.out.splitlines()[1:]} == {str(one["nodal_diameter"]) for one in met}
    assert f"{len(said) - len(met)} more modes are of nodal diameters that no force meets" in few.err
    assert "no force meets" not in every.err and "are not made of a ring, whose modes travel" in few.err
