"""[structure]: matrices from files and written in the scene, names of their rows, damping, mistakes."""

from __future__ import annotations

import re
from math import pi

import numpy as np
import pytest
import scipy.io
import scipy.sparse

from fcm.response.request import Request
from fcm.response.trace import traced_curve
from fcm.scene import SceneError, scene_from_dict

# three masses on springs: ground - 1 - 2 - 3
K = np.array([[3.0, -1.0, 0.0], [-1.0, 2.0, -1.0], [0.0, -1.0, 1.0]])
M = np.diag([1.0, 2.0, 0.5])
NAMES = ["1x", "2x", "3x"]
EXACT = np.sqrt(np.sort(np.linalg.eigvals(np.linalg.solve(M, K)).real))


def data(top=None, **structure):
    table = {"dofs": NAMES, "stiffness": K.tolist(), "mass": M.tolist(), "damping": 0.01} | structure
    force = [{"dof": "3x", "amplitude": 1.0}]
    return {"structure": table, "force": force, "response": {"frequency": [0.1, 5.0]}} | (top or {})


def read(folder=".", top=None, **structure):
    return scene_from_dict(data(top, **structure), "test.toml", folder)


def refused(folder=".", top=None, **structure):
    with pytest.raises(SceneError) as caught:
        read(folder, top, **structure)
    return str(caught.value)


def answer(modal, omega):
    weights = modal.frequency**2 - omega**2 + 2j * modal.damping * modal.frequency * omega
    return modal.shapes.T @ (modal.shapes / (modal.mass * weights)[:, None])


def write_npz(path, matrix):
    scipy.sparse.save_npz(path, scipy.sparse.csr_array(matrix))


def write_coo(path, matrix):
    scipy.sparse.save_npz(path, scipy.sparse.coo_array(matrix))


def write_dia(path, matrix):
    scipy.sparse.save_npz(path, scipy.sparse.dia_array(matrix))


def write_mat(path, matrix):
    scipy.io.savemat(path, {"A": matrix, "note": "of no interest"})


def write_sparse_mat(path, matrix):
    scipy.io.savemat(path, {"A": scipy.sparse.csc_array(matrix)}, do_compression=True)


def write_mtx(path, matrix):
    scipy.io.mmwrite(path, scipy.sparse.coo_array(matrix), symmetry="symmetric")


WRITERS = [
    (write_npz, ".npz"),
    (write_coo, ".npz"),
    (write_dia, ".npz"),
    (lambda path, matrix: np.savez(path, A=matrix), ".npz"),
    (write_mat, ".mat"),
    (write_sparse_mat, ".mat"),
    (lambda path, matrix: scipy.io.savemat(path, {"A": matrix}, format="4"), ".mat"),
    (write_mtx, ".mtx"),
    (lambda path, matrix: scipy.io.mmwrite(path, matrix), ".mtx"),
]


@pytest.mark.slow
@pytest.mark.parametrize("write, ending", WRITERS)
def test_every_kind_of_file(tmp_path, write, ending):
    write(tmp_path / f"K{ending}", K)
    write(tmp_path / f"M{ending}", M)
    modal = read(tmp_path, stiffness=f"K{ending}", mass=f"M{ending}").modal
    assert modal.frequency == pytest.approx(EXACT, rel=1e-12)
    assert modal.dofs == ("1x", "2x", "3x") and modal.added == 0


def test_a_row_of_numbers_in_a_file_is_a_diagonal_as_a_list_is(tmp_path):
    np.savez(tmp_path / "M.npz", M=M.diagonal())
    scipy.io.savemat(tmp_path / "M.mat", {"M": M.diagonal()[:, None]})
    for name in ("M.npz", "M.mat"):
        assert read(tmp_path, mass=name).modal.frequency == pytest.approx(EXACT, rel=1e-12)


@pytest.mark.parametrize("kind", [">f8", "f2", "i2", "g"])
@pytest.mark.parametrize("name", ["K.npz", "K.mat"])
def test_numbers_of_every_kind(tmp_path, kind, name):
    """Of another byte order, of half precision, whole, of more digits than float64 has."""
    if name == "K.npz":
        np.savez(tmp_path / name, K.astype(kind))
    else:
        scipy.io.savemat(tmp_path / name, {"K": K.astype("f8" if kind in ("f2", "g") else kind)})
    assert read(tmp_path, stiffness=name).modal.frequency == pytest.approx(EXACT, rel=1e-12)


@pytest.mark.parametrize("name", ["m.mat", "m.mat:K", "m.mat:model"])
def test_a_struct_of_matrices_is_named_as_one(tmp_path, name):
    scipy.io.savemat(tmp_path / "m.mat", {"model": {"K": K}})
    assert 'm.mat" cannot be read: "model" is a struct: save its fields' in refused(tmp_path, stiffness=name)


def test_written_in_the_scene():
    modal = read(mass=[1, 2, 0.5], damping=0.0).modal
    assert modal.frequency == pytest.approx(EXACT, rel=1e-12)
    assert answer(modal, 0.7) == pytest.approx(np.linalg.inv(K - 0.49 * M), rel=1e-10)


def test_frequencies_in_hertz():
    scene = read(top={"frequency_unit": "Hz"})
    assert scene.modal.frequency == pytest.approx(EXACT, rel=1e-12)
    assert scene.frequency_range == pytest.approx((0.2 * pi, 10 * pi))


@pytest.mark.slow
def test_one_matrix_of_several_in_a_file(tmp_path):
    np.savez(tmp_path / "model.npz", K=K, M=M)
    scipy.io.savemat(tmp_path / "model.mat", {"K": K, "M": M})
    for name in ("model.npz", "model.mat"):
        modal = read(tmp_path, stiffness=f"{name}:K", mass=f"{name}:M").modal
        assert modal.frequency == pytest.approx(EXACT, rel=1e-12)
        assert f'"{name}" has "K", "M"; say which, as in "{name}:K"' in refused(tmp_path, mass=name)
        assert "structure.mass" in refused(tmp_path, mass=f"{name}:Q")


@pytest.mark.slow
def test_a_file_without_the_matrix_says_what_it_holds(tmp_path):
    scipy.io.savemat(tmp_path / "model.mat", {"text": "K"})
    scipy.io.savemat(tmp_path / "both.mat", {"K": K, "M": M})
    said = refused(tmp_path, stiffness="model.mat", mass="both.mat:Q")
    assert 'model.mat" holds no matrix; it holds "text"' in said
    assert 'structure.mass: "both.mat" holds no matrix "Q"; it holds "K", "M"' in said


def test_a_pattern_has_no_values(tmp_path):
    scipy.io.mmwrite(tmp_path / "M.mtx", scipy.sparse.coo_array(M), field="pattern")
    assert "structure.mass: " in (said := refused(tmp_path, mass="M.mtx"))
    assert "it is a pattern: places of entries without their values" in said


@pytest.mark.slow
def test_op4(tmp_path):
    op4 = pytest.importorskip("pyyeti.nastran.op4")
    op4.write(str(tmp_path / "model.op4"), {"K": K, "M": M})
    modal = read(tmp_path, stiffness="model.op4:K", mass="model.op4:m").modal
    assert modal.frequency == pytest.approx(EXACT, rel=1e-12)


def test_op4_without_its_package(tmp_path, monkeypatch):
    (tmp_path / "K.op4").write_text("")
    package = tmp_path / "packages" / "pyyeti"
    package.mkdir(parents=True)
    missing = "raise ModuleNotFoundError(\"No module named 'pyyeti'\", name='pyyeti')"
    (package / "__init__.py").write_text(missing)
    monkeypatch.syspath_prepend(package.parent)  # where the reader's own process looks, too
    assert 'K.op4" cannot be read: it needs the package pyyeti: pip install ' in refused(
        tmp_path, stiffness="K.op4"
    )


@pytest.mark.parametrize(
    "content, why",
    [
        ("import nowhere_to_be_found", "ModuleNotFoundError: No module named 'nowhere_to_be_found'"),
        ("raise AttributeError('numpy has no float_')", "AttributeError: numpy has no float_"),
    ],
)
def test_op4_with_its_package_broken(tmp_path, monkeypatch, content, why):
    (tmp_path / "K.op4").write_text("")
    package = tmp_path / "packages" / "pyyeti"
    package.mkdir(parents=True)
    (package / "__init__.py").write_text(content)
    monkeypatch.syspath_prepend(package.parent)
    said = refused(tmp_path, stiffness="K.op4")
    assert f"which is installed and cannot be imported ({why})" in said
    assert "pip install" not in said


@pytest.mark.parametrize("key", ["dofs", "file"])
@pytest.mark.parametrize("text", ["1x\n2x\n3x\n", "1 x # tip\n\n2,x\n3 x", "1:x\r\n2:x\r\n3:x"])
def test_names_from_a_text_file(tmp_path, key, text):
    (tmp_path / "dofs.txt").write_text(text)
    structure = {"stiffness": K.tolist(), "mass": [1, 2, 0.5], "damping": 0.0, key: "dofs.txt"}
    one = data() | {"structure": structure}
    assert scene_from_dict(one, "test.toml", tmp_path).forces[0].direction.tolist() == [0, 0, 1]


@pytest.mark.parametrize(
    "content, words",
    [
        ("1x, 2x, 3x\n", "line 1 has 3 words: write one name on each line"),
        ("1x\n2x\ntip of blade\n", "line 3 has 3 words"),
        ("1x 2x\n3x\n", 'line 1: "2x" is no direction (x, y, z, rx, ry, rz, or 1 to 6): write one name on'),
        ("1 x\n2 7\n3x\n", 'line 2: "7" is no direction'),
        ("1x\n2x\n3\xe9\n", "it is no text in UTF-8"),
    ],
)
def test_a_text_file_that_has_no_names(tmp_path, content, words):
    (tmp_path / "dofs.txt").write_bytes(content.encode("latin-1"))
    assert f'dofs.txt" cannot be read: {words}' in refused(tmp_path, dofs="dofs.txt")


def test_one_motion_has_one_name():
    assert 'structure.dofs: "1x" and "1:1" are the same' in refused(dofs=["1x", "1:1", "3x"])
    assert read(dofs=["1x", "1:2", "3x"]).modal.dofs == ("1x", "1:2", "3x")


@pytest.mark.parametrize("name", ["3x", "3:x", "3 X", "3:1"])
def test_a_node_and_a_direction_in_several_ways(name):
    assert read(top={"force": [{"dof": name, "amplitude": 1.0}]}).forces[0].direction.tolist() == [0, 0, 1]


@pytest.mark.parametrize(
    "structure, words",
    [
        ({"stiffness": "gone.npz"}, r'structure.stiffness: "gone.npz" is not there'),
        ({"stiffness": ""}, "structure.stiffness: is empty; name a file"),
        ({"stiffness": "K.dat"}, "such a file is .npz, .mat, .h5, .hdf5, .mtx, .sti, .mas, .pch, .op4"),
        ({"mass": 3}, "structure.mass: must be a file, or a list of rows, is 3"),
        ({"mass": [[1, 0], [0, 1]]}, "structure.mass: has 2 rows, but the stiffness has 3"),
        ({"mass": [[1, 0, 0], [0, 1]]}, "structure.mass[1]: has 2 numbers, but the first row has 3"),
        ({"mass": [[1, 0, 0]]}, "structure.mass: must be square, has 1 row and 3 columns"),
        ({"mass": [1, 2, float("nan")]}, "structure.mass[2]: must be finite"),
        ({"dofs": ["1x", "2x"]}, "structure.dofs: names 2 rows, but the stiffness has 3"),
        ({"dofs": ["1x", "1x", "2x"]}, 'structure.dofs: "1x" is there 2 times'),
        ({"dofs": "gone.txt"}, 'structure.dofs: "gone.txt" is not there'),
        ({"file": "dofs.txt"}, "structure: has both dofs and file"),
        ({"damping": -0.1}, "structure.damping: must be at least 0, is -0.1"),
        ({"damping": "high"}, "structure.damping: must be a ratio"),
        ({"damping": "1 %"}, 'is "1 %"; it has "%" behind the number: write 0.01'),
        ({"damping": (-0.1 * K).tolist()}, "structure: the damping of mode 3 is negative"),
        ({"damping": {}}, "structure.damping: is empty"),
        ({"damping": {"mas": 1}}, 'structure.damping.mas: unknown key; did you mean "mass"?'),
        ({"damping": {"loss_factor": 0.1, "mass": 1}}, "has a loss_factor beside others; give it alone"),
        ({"modes": 0}, "structure.modes: must be a whole number of at least 1, is 0"),
        ({"modes": 2.5}, "structure.modes: must be a whole number of at least 1, is 2.5"),
        ({"flexibility": 1}, "structure.flexibility: must be true or false"),
        ({"mode": 3}, 'structure.mode: unknown key; did you mean "modes"?'),
        ({"mass": [0, 0, 0]}, "structure: the mass has no entry greater than 0"),
        (
            {"stiffness": np.diag([1e-290] * 3).tolist(), "mass": [1.0] * 3},
            "has a mode whose frequency in rad/s 1e-145 is too",
        ),
        ({"stiffness": (-K).tolist()}, "structure: the stiffness has 3 negative eigenvalues"),
    ],
)
def test_mistakes(structure, words):
    assert words in refused(**structure)


def test_what_is_missing_and_what_is_there_twice():
    message = refused(top={"structure": {}, "modal": {}})
    for words in (
        "has both [modal] and [structure]",
        "stiffness: missing",
        "mass: missing",
        "damping: missing",
    ):
        assert words in message


def test_all_mistakes_at_once():
    top = {"force": [{"dof": "4x", "amplitude": "x"}]}
    message = refused(top=top, modes=-1, damping=-1, stiffness=[[1, 2], [3, 4]])
    assert message.startswith("test.toml: 7 mistakes")
    assert 'unknown degree of freedom "4x"; structure.dofs are "1x", "2x", "3x"' in refused(top=top)


@pytest.mark.parametrize(
    "structure, top",
    [({"damping": -1.0}, {}), ({"modes": 0}, {}), ({}, {"title": 3}), ({}, {"contact": [{"name": "c"}]})],
)
def test_matrices_of_no_structure_are_said_beside_other_mistakes(structure, top):
    said = refused(top=top, mass=[1.0, -2.0, 0.5], **structure)
    assert "structure: the mass has 1 negative eigenvalue" in said
    assert said.count("\n") >= 2


@pytest.mark.parametrize("rows", [3, 40])  # of which all modes are kept, or some
@pytest.mark.parametrize("damping", [0.01, "matrix"])
def test_a_mistake_elsewhere_is_all_that_is_said(rows, damping):
    chain = 2.0 * np.eye(rows) - np.eye(rows, k=1) - np.eye(rows, k=-1)
    structure = {"dofs": [f"{i}x" for i in range(rows)], "stiffness": chain.tolist(), "mass": [1.0] * rows}
    damping = (0.1 * chain).tolist() if damping == "matrix" else damping
    one = [{"dof": "1x", "amplitude": "much"}]
    said = refused(top={"force": one}, **structure, damping=damping)
    assert said == 'test.toml: force[0].amplitude: must be a number, is the string "much"'


def test_numbers_alone_are_rows_and_no_motions_of_nodes(tmp_path):
    """Row 31 is no motion of node 3 along x, be it named, paired or moved by the base."""
    said = refused(top={"force": [{"dof": "3x", "amplitude": 1.0}]}, dofs=["11", "21", "31"])
    assert 'unknown degree of freedom "3x"' in said
    said = refused(top={"base": {"acceleration": 1.0, "direction": "x"}}, dofs=["11", "21", "31"])
    assert 'no degree of freedom is named "x", or as a node and "x"' in said
    for names, written in ((["3x", "3y", "3rz"], "3"), (["3x", "3y", "3rz"], "31")):
        said = refused(top={"force": [{"dof": written, "amplitude": 1.0}]}, dofs=names)
        assert f'force[0].dof: unknown degree of freedom "{written}"' in said
        assert ('write "3x" or "3y" or "3rz"' in said) == (written == "3")
    said = refused(top={"response": {"frequency": [0.1, 0.2], "output": ["36"]}}, dofs=["36x", "361x", "3rz"])
    assert 'output[0]: no degree of freedom matches "36"; a number alone is no name: write "36x"' in said
    (tmp_path / "rows.txt").write_text("1 1\n1 2\n2 1\n")
    force = [{"dof": "1:2", "amplitude": 1.0}]
    scene = scene_from_dict(data({"force": force}, dofs="rows.txt"), "test.toml", tmp_path)
    assert scene.modal.dofs == ("1:1", "1:2", "2:1")


def test_rows_without_stiffness_and_mass_are_named():
    said = refused(mass=[1.0, 0.0, 0.0], stiffness=[1.0, 1.0, 0.0])
    assert '"3x" has neither stiffness nor mass' in said and "singular" not in said


def test_both_matrices_are_said_not_to_be_those_of_a_structure():
    said = refused(mass=[1.0, -2.0, 0.5], stiffness=(-K).tolist())
    assert "the mass has 1 negative eigenvalue" in said and "the stiffness has 3 negative" in said


def test_all_negative_eigenvalues_are_counted_of_low_modes_too():
    """Of a fixed chain the lowest modes were not: a shift against rounding had made them positive."""
    count = 60
    chain = 2.0 * np.eye(count) - np.eye(count, k=1) - np.eye(count, k=-1)
    chain[0, 0] = 100.0
    said = refused(mass=[1.0] * count, stiffness=(-chain).tolist())
    assert f"the stiffness has {count} negative eigenvalues" in said


def test_names_are_looked_for_where_their_number_does_not_fit_the_matrix():
    said = refused(top={"force": [{"dof": "9x", "amplitude": 1.0}]}, dofs=["1x", "2x"])
    assert "structure.dofs: names 2 rows, but the stiffness has 3" in said
    assert 'unknown degree of freedom "9x"' in said


def test_matrices_of_no_ring_are_said_beside_other_mistakes():
    coupling = {"stiffness": [[0, 0, 0], [0, 0, 0], [5, 0, 0]]}
    ring = {"title": 3, "cyclic": {"sectors": 4, "engine_order": 1}}
    assert "1 negative eigenvalue" in refused(top=ring, coupling=coupling)
    assert "structure.coupling: couples the sectors" in refused(coupling=coupling, modes=0)


def test_entries_that_are_not_symmetric_are_named():
    skew = K.copy()
    skew[0, 1], skew[2, 0] = -1.5, 0.25
    message = refused(stiffness=skew.tolist())
    assert "structure.stiffness: is not symmetric: 2 pairs of entries differ; " in message
    assert '("1x", "2x") is -1.5, ("2x", "1x") is -1' in message
    assert '("1x", "3x") is 0, ("3x", "1x") is 0.25' in message


@pytest.mark.parametrize("half, name", [(np.tril, "lower"), (np.triu, "upper")])
def test_one_triangle_is_not_the_matrix(half, name):
    assert f"only its {name} triangle is there: give both" in refused(stiffness=half(K).tolist())
    skew = K + 0.5 * np.eye(3, k=1)
    assert "triangle" not in refused(stiffness=skew.tolist())


def test_entries_that_are_no_numbers_are_named(tmp_path):
    broken = K.copy()
    broken[2, 1], broken[0, 0] = np.nan, 1e200
    np.savez(tmp_path / "K.npz", K=broken)
    said = refused(tmp_path, stiffness="K.npz")
    assert "[2][1] must be finite, is nan" in said and "[0][0] 1e+200 is too large" in said
    write_npz(tmp_path / "K.npz", np.full((3, 3), np.inf))
    assert "structure.stiffness: entry [0][0] must be finite" in (
        said := refused(tmp_path, stiffness="K.npz")
    )
    assert said.endswith("; 9 such entries in all")


def test_complex_numbers_without_imaginary_parts_are_real(tmp_path):
    write_npz(tmp_path / "K.npz", K + 0j)
    assert read(tmp_path, stiffness="K.npz").modal.frequency == pytest.approx(EXACT, rel=1e-12)
    write_npz(tmp_path / "K.npz", K * (1 + np.diag([0, 0, 0.02j])))
    said = refused(tmp_path, stiffness="K.npz")
    assert "holds numbers that are not real (1 of 7)" in said and "structure.damping" in said


def test_rounding_is_no_asymmetry():
    nearly = K.copy()
    nearly[0, 1] *= 1 + 1e-10
    assert read(stiffness=nearly.tolist()).modal.frequency == pytest.approx(EXACT, rel=1e-9)


def test_damping_in_proportion_is_that_of_the_matrix(tmp_path):
    C = 0.02 * M + 0.03 * K
    np.savez(tmp_path / "C.npz", C)
    for damping in ({"mass": 0.02, "stiffness": 0.03}, "C.npz", C.tolist()):
        scene = read(tmp_path, damping=damping)
        assert answer(scene.modal, 0.9) == pytest.approx(np.linalg.inv(K - 0.81 * M + 0.9j * C), rel=1e-10)
        assert not any("between modes" in note for note in scene.notes)


@pytest.mark.parametrize("dashpot", [0.2, 0.02])
def test_damping_between_modes_is_left_out_and_said(dashpot):
    """As much as it changes, anywhere within the range, of the receptances of contacts and forces."""
    C = np.diag([0.0, dashpot, 0.0])
    contact = {"tangential": "1x", "normal": "2x", "name": "a", "mu": 0.3, "k_u": 4.0, "k_v": 9.0, "n_0": 1.0}
    scene = read(top={"contact": [contact]}, damping=C.tolist())
    (note,) = (note for note in scene.notes if "between modes" in note)
    said = [float(part.split()[-1]) / 100 for part in note.split(" %")[:2]]
    shapes = scene.modal.shapes.T  # (row, mode) of mass 1
    of_modes = M @ shapes @ np.diag(np.diag(shapes.T @ C @ shapes)) @ shapes.T @ M
    for share, springs in zip(said, (np.zeros((3, 3)), np.diag([4.0, 9.0, 0.0])), strict=True):
        worst = 0.0
        for omega in np.linspace(0.1, 5.0, 3000):
            whole, alone = (
                np.linalg.inv(K + springs - omega**2 * M + 1j * omega * damper) for damper in (C, of_modes)
            )
            worst = max(worst, np.abs(whole - alone).max() / np.abs(whole).max())
        assert worst > 1e-3 and share == pytest.approx(worst, rel=0.1)


def test_a_damping_matrix_that_leaves_modes_undamped():
    """At their resonances, within the range, there is no response to compare."""
    assert (read(damping=np.zeros((3, 3)).tolist()).modal.damping == 0.0).all()


def test_a_loss_factor_is_half_of_it_at_each_resonance():
    scene = read(damping={"loss_factor": 0.02})
    assert any("half the loss factor is taken as damping ratio" in note for note in scene.notes)
    for omega in EXACT:
        hysteretic = np.linalg.inv(K * (1 + 0.02j) - omega**2 * M)[2, 2]
        assert abs(answer(scene.modal, omega)[2, 2]) == pytest.approx(abs(hysteretic), rel=5e-3)


def test_of_a_loss_factor_the_ratio_with_stuck_contacts_is_told():
    """Beside that of hysteresis: the energy of the structure alone, which the stiff contact has little of."""
    contact = {
        "tangential": "1x",
        "normal": "2x",
        "name": "a",
        "mu": 0.3,
        "k_u": 40.0,
        "k_v": 90.0,
        "n_0": 1.0,
    }
    scene = read(top={"contact": [contact]}, damping={"loss_factor": 0.02})
    (note,) = (note for note in scene.notes if "half the loss factor" in note)
    taken, meant = (float(word) for word in re.findall(r"has (\S+) in place of (\S+)\.", note)[0])
    stuck = K * (1 + 0.02j) + np.diag([40.0, 90.0, 0.0])
    omega = np.sqrt(np.sort_complex(np.linalg.eigvals(np.linalg.solve(M, stuck)))[0])
    assert meant == pytest.approx(omega.imag / abs(omega), rel=5e-3)
    shapes = scene.modal.shapes.T
    by_modes = M @ shapes @ np.diag(0.02 * scene.modal.frequency) @ shapes.T @ M
    state = np.block(
        [[np.zeros((3, 3)), np.eye(3)], [-np.linalg.solve(M, stuck.real), -np.linalg.solve(M, by_modes)]]
    )
    decay = min(np.linalg.eigvals(state), key=abs)
    assert taken == pytest.approx(-decay.real / abs(decay), rel=5e-3)
    assert abs(taken / meant - 1.0) > 0.02


def test_a_loss_factor_at_one_frequency_is_right_where_a_contact_holds_a_rigid_body():
    """As the note says: of two masses, one of which floats, the peak is F / (loss factor times stiffness)."""
    loss, stiffness = 0.02, 1e4
    matrices = {"mass": np.eye(2).tolist(), "stiffness": [[stiffness, 0.0], [0.0, 0.0]]}
    sticking = {"tangential": {"a": 1.0, "b": -1.0}, "normal": "b", "mu": 0.3, "k_u": 1e9, "k_v": 0.0}
    table = {
        "structure": {"dofs": ["a", "b"], **matrices},
        "contact": [{"name": "c", **sticking, "n_0": 1e3}],
        "force": [{"dof": "a", "amplitude": 1.0}],
        "response": {"frequency": [60.0, 80.0], "harmonics": 1},
    }
    table["structure"]["damping"] = {"stiffness": loss / np.sqrt(stiffness / 2.0)}
    curve = traced_curve(scene_from_dict(table), Request((1,), 1e-2))
    assert np.nanmax(curve.amplitude[:, 0]) == pytest.approx(1.0 / (loss * stiffness), rel=1e-3)


def test_rigid_bodies_are_recognised_and_said():
    free = K - np.diag([2.0, 0, 0])
    scene = read(stiffness=free.tolist(), damping={"mass": 0.1})
    assert scene.modal.frequency[0] == 0.0 and (scene.modal.frequency[1:] > 0.5).all()
    assert any("structure: 1 rigid-body mode, of frequency 0" in note for note in scene.notes)
    assert any("the damping of its rigid-body modes is left out" in note for note in scene.notes)


@pytest.mark.parametrize("dragged", [True, False])
def test_what_rigid_bodies_lose_of_their_damping_is_told(dragged, tmp_path):
    """A free chain of 40 masses beside its dense matrices: the bound holds and is no empty one."""
    rows, low, high = 40, 0.01, 0.2
    chain = 2.0 * np.eye(rows) - np.eye(rows, k=1) - np.eye(rows, k=-1)
    chain[0, 0] = chain[-1, -1] = 1.0
    mass, drag = np.eye(rows), 1e-3 if dragged else 0.0
    C = drag * mass + 0.02 * chain
    contact = {"tangential": "0x", "normal": "9x", "name": "a", "mu": 0.3, "k_u": 0.5, "k_v": 0.1, "n_0": 1.0}
    top = {
        "response": {"frequency": [low, high]},
        "force": [{"dof": "39x", "amplitude": 1.0}],
        "contact": [contact],
    }
    np.savez(tmp_path / "C.npz", C)
    for damping in ({"mass": drag, "stiffness": 0.02}, "C.npz"):
        matrices = {"dofs": [f"{i}x" for i in range(rows)], "stiffness": chain.tolist(), "mass": [1.0] * rows}
        scene = read(tmp_path, top=top, **matrices, damping=damping, modes=6)
        kept, *notes = scene.notes
        said = float(kept.split("off by at most ")[1].split(",")[0])
        if not dragged:
            assert said < 1e-6 and not any("left out" in note for note in notes)
            continue
        seen, worst = [0, 9, 39], 0.0
        for omega in np.linspace(low, high, 50):
            whole = np.linalg.inv(chain - omega**2 * mass + 1j * omega * C)
            rigid = 1.0 / (rows * omega**2)  # of what is pushed anywhere; the elastic ones add to it at rest
            worst = max(worst, np.abs(answer(scene.modal, omega) - whole)[np.ix_(seen, seen)].max() / rigid)
        assert 0.3 * said < worst < said
        (note,) = (note for note in notes if "left out" in note)
        why = ": a resonance that is damped mostly by what is left out is far too high"
        assert "would change by up to about" in note
        assert note.endswith(f"more than itself with all of them stuck{why}")


@pytest.mark.parametrize(("by_mass", "node", "told"), [(2.0, 0, False), (2.0, 2, True), (1e-5, 2, False)])
def test_damping_that_is_left_out_and_changes_nothing_is_not_told(by_mass, node, told):
    """A body that nothing pushes, or drag that is far too small: it was said to change 0 %, or 3e-14 %."""
    contact = {"name": "a", "tangential": "0x", "normal": "1x", "mu": 0.3, "k_u": 0.5, "k_v": 0.1, "n_0": 1.0}
    top = {
        "response": {"frequency": [0.5, 2.5]},
        "force": [{"dof": f"{node}x", "amplitude": 1.0}],
        "contact": [contact],
    }
    free = {"stiffness": [[3.0, -1.0, 0.0], [-1.0, 2.0, 0.0], [0.0, 0.0, 0.0]], "mass": [1.0, 1.0, 1.0]}
    damping = {"mass": by_mass, "stiffness": 0.01}
    notes = read(top=top, dofs=["0x", "1x", "2x"], **free, damping=damping).notes
    assert any("left out" in note for note in notes) == told


@pytest.mark.parametrize(
    "lowest, rigid", [([1e-3, 2e-3], 2), ([0.01, 0.05], 2), ([0.5, 0.7], 0), ([0.0, 1e-3], 1)]
)
def test_rigid_bodies_of_an_eigensolver(lowest, rigid):
    """As a finite-element program gives them, with some thousandths of a hertz."""
    modal = {"dofs": ["u"], "frequency": [*lowest, 52.0], "damping": 0.01, "shapes": [[1.0], [0.5], [0.2]]}
    one = {"modal": modal, "frequency_unit": "Hz", "response": {"frequency": [10, 100]}}
    scene = scene_from_dict(one | {"force": [{"dof": "u", "amplitude": 1.0}]})
    assert (scene.modal.frequency == 0.0).sum() == rigid + lowest.count(0.0)
    assert len(scene.notes) == (rigid > 0)
    assert not rigid or ": taken as 0" in scene.notes[0]


def test_rigid_bodies_of_two_bodies_that_contacts_hold_together():
    """Six of each, whose frequencies are rounding: as far from each other as from the others, or not."""
    lowest = [2e-8, 3e-8, 1e-7, 4e-5, *np.linspace(1e-4, 2e-3, 8)]
    modal = {"dofs": ["u"], "frequency": [*lowest, 52.0], "damping": 0.01, "shapes": [[1.0]] * 13}
    contact = {"name": "a", "tangential": "u", "normal": "u", "mu": 0.3, "k_u": 1e4, "k_v": 0.0, "n_0": 1.0}
    one = {"modal": modal, "frequency_unit": "Hz", "response": {"frequency": [10, 50]}, "contact": [contact]}
    scene = scene_from_dict(one | {"force": [{"dof": "u", "amplitude": 1.0}]})
    assert (scene.modal.frequency == 0.0).tolist() == [True] * 12 + [False]
    assert scene.notes == ("modal: 12 modes of 2e-08 to 0.002 Hz are rigid-body modes: taken as 0",)


def test_a_low_mode_within_reach_of_the_range_is_a_mode():
    modal = {"dofs": ["u"], "frequency": [1e-3, 52.0], "damping": 0.01, "shapes": [[1.0], [0.5]]}
    one = {"modal": modal, "response": {"frequency": [1e-3, 100]}, "force": [{"dof": "u", "amplitude": 1.0}]}
    assert scene_from_dict(one).modal.frequency[0] == 1e-3


@pytest.mark.parametrize("top", [{}, {"response": {"frequency": [0.01, 0.02]}}])
def test_modes_are_kept_for_the_frequencies_of_a_schedule_too(top):
    """Its forces may be far above those of the range, or there is none."""
    rows, omega = 80, 0.5
    chain = 2.0 * np.eye(rows) - np.eye(rows, k=1) - np.eye(rows, k=-1)
    schedule = [{"frequency": 0.02, "cycles": 1}, {"frequency": omega, "cycles": 1}]
    table = {"dofs": [f"u{i}" for i in range(rows)], "stiffness": chain.tolist(), "mass": [1.0] * rows}
    force = [{"dof": "u0", "amplitude": 1.0}]
    scene = scene_from_dict(
        top | {"structure": table | {"damping": 0.01}, "force": force, "schedule": schedule}
    )
    bound = float(scene.notes[0].split("off by at most ")[1].split(",")[0])
    values, shapes = np.linalg.eigh(chain)
    exact = (shapes[0] ** 2 / (values - omega**2 + 0.02j * np.sqrt(values) * omega)).sum()
    static = (shapes[0] ** 2 / values).sum()
    at = scene.modal.dofs.index("u0")
    assert abs(answer(scene.modal, omega)[at, at] - exact) <= bound * static < 0.01 * static


def test_numbers_of_matrices_can_be_swept():
    sweep = {"modal.damping": [0.01, 0.02], "force.3x.dof.2x": [0.0, 1.0]}
    curves = read(top={"sweep": sweep}).curves
    assert [curve.modal.damping[0] for curve in curves] == [0.01, 0.01, 0.02, 0.02]
    assert curves[1].forces[0].direction.tolist() == [0, 1, 1]


def test_a_matrix_that_says_it_is_larger_than_its_file(tmp_path):
    head = "%%MatrixMarket matrix coordinate real general\n"
    (tmp_path / "K.mtx").write_text(head + "3 3 900000000000\n1 1 2.0\n")
    assert "900000000000 entries, and there are 1" in refused(tmp_path, stiffness="K.mtx")
    (tmp_path / "K.mtx").write_text("%%MatrixMarket matrix array real general\n900000 900000\n1\n")
    assert "810000000000 entries, and there are 1" in refused(tmp_path, stiffness="K.mtx")
    (tmp_path / "K.mtx").write_text(head + "900000000 900000000 1\n1 1 2.0\n")
    assert "--largest-file" in refused(tmp_path, stiffness="K.mtx")
    parts = {"row": [0], "col": [0], "data": [1.0], "format": "coo", "shape": [900_000_000] * 2}
    np.savez(tmp_path / "K.npz", **parts)
    assert "--largest-file" in refused(tmp_path, stiffness="K.npz")


def test_equal_frequencies_are_all_found():
    """Of masses alike, each on its spring, no mode has been missed, whatever the rounding."""
    scene = read(stiffness=[3.3, 3.3, 3.3], mass=[0.7, 0.7, 0.7], damping=0.0)
    assert scene.modal.frequency == pytest.approx(np.sqrt(3.3 / 0.7), rel=1e-12)
    assert not any("missed" in note or "rounding" in note for note in scene.notes)


def test_one_mode_is_said_to_be_one():
    data = {
        "structure": {
            "dofs": ["a", "b"],
            "mass": [[1, 0], [0, 0]],
            "stiffness": [[2, -1], [-1, 2]],
            "damping": 0.01,
        },
        "force": [{"dof": "a", "amplitude": 1.0}],
        "response": {"frequency": [0.5, 2.0]},
    }
    assert "structure: 1 mode of 2 degrees of freedom is kept" in scene_from_dict(data).notes[0]


@pytest.mark.parametrize("swapped", [False, True])
def test_stiffness_and_mass_of_a_mesh_in_each_others_place(swapped):
    """All 120 modes were sought and kept: of a blade that took minutes, before anything was said."""
    count = 120
    chain = 1e6 * (2.0 * np.eye(count) - np.eye(count, k=1) - np.eye(count, k=-1))
    mass = 1e-3 * np.eye(count)
    first = 2.0 * np.sqrt(1e6 / 1e-3) * np.sin(pi / 2.0 / (count + 1))  # of equal masses between two walls
    names = [f"{i + 1}x" for i in range(count)]
    pair = (mass, chain) if swapped else (chain, mass)
    table = dict(zip(("stiffness", "mass"), (one.tolist() for one in pair), strict=True))
    top = {"response": {"frequency": [0.5 * first, 2.0 * first]}}
    if not swapped:
        assert read(top=top, dofs=names, **table).modal.frequency[0] == pytest.approx(first)
        return
    said = refused(top=top, dofs=names, **table)
    assert "in each other's place" in said and f"which is {first:.6g} rad/s" in said


@pytest.mark.parametrize("count", [8, 120])
def test_matrices_in_each_others_place_beside_a_contact(count):
    """Eight rows were a traceback: none of their modes counted as elastic while the contact sticks."""
    chain = 1e9 * (2.0 * np.eye(count) - np.eye(count, k=1) - np.eye(count, k=-1))
    contact = {"name": "c", "tangential": "1x", "normal": "2x", "mu": 0.3, "k_u": 1.0, "k_v": 1.0, "n_0": 1.0}
    first = 2.0 * np.sqrt(1e9 / 1e-3) * np.sin(pi / 2.0 / (count + 1))
    said = refused(
        top={"response": {"frequency": [0.5 * first, 2.0 * first]}, "contact": [contact]},
        dofs=[f"{i + 1}x" for i in range(count)],
        stiffness=(1e-3 * np.eye(count)).tolist(),
        mass=chain.tolist(),
    )
    assert "in each other's place" in said


def test_a_mass_a_thousand_times_too_great_is_not_called_exchanged():
    """Exchanged with the stiffness it had a mode, but none within the range."""
    chain = 1e3 * (2.0 * np.eye(4) - np.eye(4, k=1) - np.eye(4, k=-1))
    first = 2.0 * np.sqrt(1e3) * np.sin(pi / 10.0)
    scene = read(
        top={"response": {"frequency": [0.5 * first, 2.0 * first]}},
        dofs=[f"{i + 1}x" for i in range(4)],
        stiffness=chain.tolist(),
        mass=(1e3 * np.eye(4)).tolist(),
    )
    assert scene.modal.frequency[0] == pytest.approx(first / np.sqrt(1e3))


@pytest.mark.parametrize("ending", [".npy", ".txt", ".csv"])
def test_what_numpy_writes_otherwise_is_told_how_it_is_made_an_archive(ending, tmp_path, monkeypatch):
    """By doing what the message says."""
    monkeypatch.chdir(tmp_path)
    if ending == ".npy":
        np.save("M.npy", M)
    else:
        np.savetxt(f"M{ending}", M, delimiter="," if ending == ".csv" else " ")
    said = refused(tmp_path, mass=f"M{ending}")
    command = said.rpartition("; ")[2].partition(" writes one")[0]
    exec(command, {"numpy": np})
    assert read(tmp_path, mass="M.npz").modal.frequency == pytest.approx(EXACT)


@pytest.mark.parametrize("names_in_order", [True, False])
def test_the_mass_of_a_structure_that_floats_is_the_same_along_all_axes(names_in_order):
    """Four points of different masses and rods between them; with two names exchanged they differ."""
    corners = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.2, 0.0], [0.2, 0.3, 1.1]])
    K = np.zeros((12, 12))
    for a in range(4):
        for b in range(a):
            along = np.zeros(12)
            along[3 * a : 3 * a + 3] = corners[a] - corners[b]
            along[3 * b : 3 * b + 3] = corners[b] - corners[a]
            K += np.outer(along, along)
    names = [f"{node}{axis}" for node in (1, 2, 3, 4) for axis in "xyz"]
    if not names_in_order:
        names[2], names[9] = names[9], names[2]
    M = np.diag(np.repeat([1.0, 2.0, 3.0, 4.0], 3))
    contact = [{"name": "c", "tangential": "1x", "normal": "1y", "mu": 0.3, "k_u": 1, "k_v": 1, "n_0": 1}]
    scene = read(top={"contact": contact}, stiffness=K.tolist(), mass=M.tolist(), dofs=names)
    asked = [note for note in scene.notes if "it floats, but its mass differs" in note]
    assert len(asked) == (not names_in_order)


@pytest.mark.parametrize("count", [3, 120])
def test_stiffness_and_mass_that_are_the_same(count):
    """Every mode had 1 rad/s, and of a blade the curve stopped after half a minute."""
    chain = (2.0 * np.eye(count) - np.eye(count, k=1) - np.eye(count, k=-1)).tolist()
    names = [f"{i + 1}x" for i in range(count)]
    said = refused(top={"response": {"frequency": [0.5, 2.0]}}, dofs=names, stiffness=chain, mass=chain)
    assert "structure: stiffness and mass are the same matrix. Name the file of each" in said
