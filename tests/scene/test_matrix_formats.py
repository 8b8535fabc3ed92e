"""Matrices as other programs write them: CalculiX, Abaqus, Nastran, HDF5, Harwell-Boeing; what is refused."""

from __future__ import annotations

import shutil
from pathlib import Path

import numpy as np
import pytest
import scipy.sparse
from tests.program import ended

from fcm.scene import SceneError, scene_from_dict

BEAM = Path(__file__).parent / "data" / "calculix"
# eigenvalues [rad^2/s^2] of the same input that CalculiX 2.20 prints for *FREQUENCY
EIGENVALUES = np.array([0.1889912e8, 0.2197218e8, 0.2779981e9, 0.7681027e9, 0.8013973e9])
# two masses of two directions, their natural frequencies known: x of 1 and 2 coupled, y of each alone
K = np.array([[1.1e5, 0, -1e5, 0], [0, 2e5, 0, 0], [-1e5, 0, 1.1e5, 0], [0, 0, 0, 2.5e5]])
EXACT = np.sqrt(np.sort([1e4, 2.1e5, 2e5, 2.5e5]))
ROWS = ("1x", "1y", "2x", "2y")
ABAQUS_K = """** Assembled nodal matrices
1,1, 1,1,  1.100000000000000e+05
1,2, 1,2,  2.000000000000000e+05
2,1, 1,1, -1.000000000000000e+05
2,1, 2,1,  1.100000000000000e+05
2,2, 2,2,  2.500000000000000e+05
"""
ABAQUS_M = "1,1, 1,1, 1.0\n1,2, 1,2, 1.0\n2,1, 2,1, 1.0\n2,2, 2,2, 1.0\n"
PUNCH = """$TITLE = beam
DMIG    KAAX           0       6       2       0                       4
DMIG*   KAAX                           1               1
*                      1               1 1.100000000D+05
DMIG*   KAAX                           1               2
*                      1               2 2.000000000D+05
DMIG*   KAAX                           2               1
*                      1               1-1.000000000D+05
*                      2               1 1.100000000D+05
DMIG*   KAAX                           2               2
*                      2               2 2.500000000D+05
ASET1   123     1       2
DMIG    MAAX    0       6       1       0
DMIG    MAAX    1       1               1       1       1.0
DMIG    MAAX    1       2               1       2       1.0
DMIG,MAAX,2,1,,2,1,1.0
DMIG,MAAX,2,2,,2,2,1.0+0
"""
BOEING = """Stiffness of two masses                                                 K
             5             1             1             3             0
RSA                        4             4             5             0
(5I4)           (5I4)           (2E14.7)
   1   3   4   5   6
   1   3   2   3   4
 1.1000000E+05-1.0000000E+05
 2.0000000E+05 1.1000000D+05
 2.5000000E+05
"""


def data(dofs=None, mass=(1, 1, 1, 1), force="1x", **structure):
    table = {"mass": mass if isinstance(mass, str) else list(mass), "damping": 0.01} | structure
    table |= {} if dofs is None else {"dofs": dofs}
    top = {"force": [{"dof": force, "amplitude": 1.0}], "response": {"frequency": [50.0, 600.0]}}
    return {"structure": table} | top


def modal(folder, **structure):
    return scene_from_dict(data(**structure), "test.toml", folder).modal


def refused(folder, **structure):
    with pytest.raises(SceneError) as caught:
        scene_from_dict(data(**structure), "test.toml", folder)
    return str(caught.value)


def test_a_format_that_is_narrower_than_the_numbers(tmp_path):
    """The rest of each line would be left out, and 1.1e5 read as 1.1."""
    (tmp_path / "K.hb").write_text(BOEING.replace("2E14.7", "2E4.7"))
    said = refused(tmp_path, dofs=list(ROWS), stiffness="K.hb")
    assert "line 7 is longer than the numbers of its format, 2 of 4 characters" in said


def write(folder, **texts):
    for name, text in texts.items():
        (folder / name.replace("__", ".")).write_text(text)


def test_calculix_has_the_frequencies_that_it_prints():
    found = modal(BEAM, stiffness="beam.sti", mass="beam.mas", force="16z")
    assert found.frequency[:5] ** 2 == pytest.approx(EIGENVALUES, rel=1e-6)
    assert found.dofs[:3] == ("2x", "2y", "2z")  # node 1 is held


def test_calculix_names_its_rows_in_the_file_of_another_job(tmp_path):
    for ending in ("sti", "mas"):
        shutil.copy(BEAM / f"beam.{ending}", tmp_path / f"K.{ending}")
    shutil.copy(BEAM / "beam.dof", tmp_path)
    found = modal(tmp_path, stiffness="K.sti", mass="K.mas", dofs="beam.dof", force="16z")
    assert found.frequency[:5] ** 2 == pytest.approx(EIGENVALUES, rel=1e-6)


@pytest.mark.skipif(shutil.which("ccx") is None, reason="CalculiX is not installed")
def test_calculix_itself_writes_such_files(tmp_path):
    shutil.copy(BEAM / "beam.inp", tmp_path)
    assert ended("ccx", "beam", cwd=tmp_path).code == 0
    found = modal(tmp_path, stiffness="beam.sti", mass="beam.mas", force="16z")
    assert found.frequency[:5] ** 2 == pytest.approx(EIGENVALUES, rel=1e-6)


@pytest.mark.parametrize("both", [False, True])
def test_abaqus_names_its_rows(tmp_path, both):
    mirrored = "1,1, 2,1, -1.0D+05\n" if both else ""
    write(tmp_path, K__mtx=ABAQUS_K + mirrored, M__mtx=ABAQUS_M)
    found = modal(tmp_path, stiffness="K.mtx", mass="M.mtx")
    assert found.dofs == ROWS and found.frequency == pytest.approx(EXACT, rel=1e-12)


def test_rows_come_in_the_order_of_the_names_that_are_given(tmp_path):
    write(tmp_path, K__mtx=ABAQUS_K, M__mtx=ABAQUS_M)
    dofs = ["2y", "1:1", "2x", "1y"]
    found = modal(tmp_path, stiffness="K.mtx", mass="M.mtx", dofs=dofs)
    assert found.dofs == tuple(dofs)
    highest = found.shapes[np.argmax(found.frequency)]
    assert np.abs(highest) == pytest.approx([1.0, 0.0, 0.0, 0.0], abs=1e-9)  # 2y alone at sqrt(2.5e5)


def test_a_row_without_mass_is_left_out_of_a_file_of_masses(tmp_path):
    write(tmp_path, K__mtx=ABAQUS_K, M__mtx=ABAQUS_M.replace("1,2, 1,2, 1.0\n", ""))
    found = modal(tmp_path, stiffness="K.mtx", mass="M.mtx")
    assert found.dofs == ROWS
    assert found.frequency[:3] == pytest.approx(EXACT[[0, 2, 3]], rel=1e-9)


def test_a_punch_file_holds_several_matrices(tmp_path):
    write(tmp_path, model__pch=PUNCH)
    found = modal(tmp_path, stiffness="model.pch:kaax", mass="model.pch:MAAX")
    assert found.dofs == ROWS and found.frequency == pytest.approx(EXACT, rel=1e-12)
    assert '"KAAX", "MAAX"; say which' in refused(tmp_path, stiffness="model.pch")


def test_harwell_boeing_with_the_mapping_of_ansys(tmp_path):
    mapping = "Matrix Eqn    Node    DOF\n 1 7 UX\n 2 7 UY\n 3 9 UX\n 4 9 ROTZ\n"
    write(tmp_path, K__matrix=BOEING, K__mapping=mapping)
    found = modal(tmp_path, stiffness="K.matrix", dofs="K.mapping", force="9rz")
    assert found.dofs == ("7x", "7y", "9x", "9rz")
    assert found.frequency == pytest.approx(EXACT, rel=1e-9)


def test_rows_without_names_beside_named_ones_are_not_guessed(tmp_path):
    """The mass was taken in the order of the other file: a peak at 19.1 rad/s in place of 23.3."""
    write(tmp_path, model__pch=PUNCH, M__matrix=BOEING.replace("E+05", "E+00").replace("D+05", "E+00"))
    assert "dofs in its order" in refused(tmp_path, stiffness="model.pch:KAAX", mass="M.matrix")
    assert modal(tmp_path, stiffness="model.pch:KAAX", mass="M.matrix", dofs=list(ROWS)).dofs == ROWS


@pytest.mark.parametrize("key", ["structure.damping", "cyclic.mistuning.stiffness"])
def test_further_matrices_without_names_beside_named_ones_are_not_guessed(tmp_path, key):
    write(tmp_path, model__pch=PUNCH)
    rows = np.diag([2.0, 1.0, 1.0, 3.0]).tolist()
    one = data(stiffness="model.pch:KAAX", mass="model.pch:MAAX")
    if key == "structure.damping":
        write(tmp_path, C__matrix=BOEING)
        one["structure"]["damping"] = "C.matrix"
    else:
        one["cyclic"] = {
            "sectors": 4,
            "engine_order": 1,
            "mistuning": {"stiffness": rows, "factors": [1.0] * 4},
        }
    with pytest.raises(SceneError) as caught:
        scene_from_dict(one, "test.toml", tmp_path)
    said = f"{key}: its rows have no names, as other matrices have; give structure.dofs in its order"
    assert said in str(caught.value)


def test_harwell_boeing_that_ends_within_a_number_is_cut_off(tmp_path):
    write(tmp_path, K__matrix=BOEING.rstrip()[:-6])
    assert "line 9 ends within a number" in refused(tmp_path, stiffness="K.matrix", dofs=list(ROWS))
    write(tmp_path, L__matrix=BOEING.rstrip())
    assert modal(tmp_path, stiffness="L.matrix", dofs=list(ROWS)).dofs == ROWS


@pytest.mark.parametrize("kind", ["dense", "sparse by columns", "sparse by rows", "matlab", "matlab sparse"])
def test_hdf5(tmp_path, kind):
    h5py = pytest.importorskip("h5py")
    matlab = kind.startswith("matlab")
    name = "model.mat" if matlab else "model.h5"
    with h5py.File(tmp_path / name, "w", userblock_size=512 if matlab else 0) as file:
        if kind in ("dense", "matlab"):
            file["blade/K"] = K
        else:
            by_row = kind == "sparse by rows"
            matrix = (scipy.sparse.csr_array if by_row else scipy.sparse.csc_array)(K)
            names = ("data", "ir", "jc") if matlab else ("data", "indices", "indptr")
            group = file.create_group("blade/K")
            for one, values in zip(names, (matrix.data, matrix.indices, matrix.indptr), strict=True):
                group[one] = values
            group.attrs["MATLAB_sparse" if matlab else "format"] = 4 if matlab else "csr" if by_row else "csc"
    if matlab:
        header = b"MATLAB 7.3 MAT-file, Platform: GLNXA64".ljust(124) + b"\x00\x02IM"
        with (tmp_path / name).open("r+b") as file:
            file.write(header)
    found = modal(tmp_path, stiffness=f"{name}:blade/K", dofs=list(ROWS))
    assert found.frequency == pytest.approx(EXACT, rel=1e-9)


def test_modes_of_matlab_7_3(tmp_path):
    h5py = pytest.importorskip("h5py")
    with h5py.File(tmp_path / "modes.mat", "w", userblock_size=512) as file:
        file["frequency"] = np.array([[10.0], [20.0]])  # of 1 x 2
        file["shapes"] = np.array([[1.0, 0.5], [0.0, -1.0]]).T
        cells = []
        for number, text in enumerate(("u", "tip")):
            file[f"#refs#/{number}"] = np.array([[ord(letter)] for letter in text], dtype=np.uint16)
            cells.append([file[f"#refs#/{number}"].ref])
        file.create_dataset("dofs", data=np.array(cells, dtype=h5py.ref_dtype), dtype=h5py.ref_dtype)
    header = b"MATLAB 7.3 MAT-file".ljust(124) + b"\x00\x02IM"
    with (tmp_path / "modes.mat").open("r+b") as file:
        file.write(header)
    scene = {
        "modal": {"file": "modes.mat", "damping": 0.01},
        "force": [{"dof": "tip", "amplitude": 1.0}],
        "response": {"frequency": [5.0, 30.0]},
    }
    found = scene_from_dict(scene, "test.toml", tmp_path).modal
    assert found.dofs == ("u", "tip") and found.shapes.tolist() == [[1.0, 0.5], [0.0, -1.0]]


@pytest.mark.slow
def test_hdf5_numbers_of_another_form_are_not_converted(tmp_path):
    """A bias of the exponent that one damaged byte has changed makes other numbers of all."""
    h5py = pytest.importorskip("h5py")
    with h5py.File(tmp_path / "K.h5", "w") as file:
        file["K"] = K
    form = h5py.h5t.IEEE_F64LE.copy()
    form.set_ebias(1000)
    with h5py.File(tmp_path / "odd.h5", "w") as file:
        space = h5py.h5s.create_simple(K.shape)
        h5py.h5d.create(file.id, b"K", form, space).write(h5py.h5s.ALL, h5py.h5s.ALL, K)
    assert modal(tmp_path, stiffness="K.h5", mass=[1.0] * 4, dofs=list(ROWS)).frequency == pytest.approx(
        EXACT
    )
    odd = refused(tmp_path, stiffness="odd.h5", mass=[1.0] * 4, dofs=list(ROWS))
    assert "holds numbers that are no IEEE ones of 16 to 64 bits" in odd


REFUSED = [
    ("K.sti", "1 1 1.0\n2 2\n", "line 2 has 2 entries; 3 are needed"),
    ("K.sti", "1 1 1.0\n1 2 3,5\n", 'line 2: "3,5" has a decimal comma'),
    ("K.sti", "1 1 1.0\n2 1 3.0\n1 2 3.5\n", "lines 2 and 3: the entry of 1 and 2 is 3.5 and 3 across"),
    ("K.sti", "1 1 1.0\n1 1 1.0\n", "lines 1 and 2: the entry of 1 and 1 is there twice"),
    ("K.sti", "0 1 1.0\n", "line 1: rows and columns are counted from 1"),
    ("K.sti", "1 1 inf\n", "is no"),
    ("K.sti", "\u0661 1 2.0\n", "must be a whole number"),
    ("K.sti", "1 1 0x1p3\n", '"0x1p3" is hexadecimal: write it in decimals'),
    ("K.sti", "1,1,2\n", "line 1 has 1 entry; 3 are needed, with blanks between"),
    ("K.mtx", "1,1, 1,1, 1,5\n", "line 1 has 6 entries; 5 are needed, with commas between"),
    ("K.mtx", "1,1, 1,1, 1.0\n1,1, 2,1, 1.0, 3\n", "line 2 has 6 entries; 5 are needed, with commas between"),
    ("K.mtx", "1,1, 1,1, 1.0kN\n", 'line 1: "1.0kN" has "kN" behind'),
    ("K.mtx", "1,0, 1,1, 1.0\n", "line 1: directions are counted from 1"),
    ("K.pch", "GRID,1\n", "holds no DMIG entries"),
    ("K.pch", PUNCH.replace("   0       6       2", "   0       6       4"),
     "line 2: DMIG KAAX is complex (type 4), and real ones are read; hysteretic damping is"),
    ("K.pch", PUNCH[PUNCH.index("DMIG*"):], "line 1: DMIG KAAX has no header"),
    ("K.pch", PUNCH.replace("2,2,1.0+0", "2,2,1.0,3.0"), 'is real: behind a value the field must be blank'),
    ("K.pch", PUNCH.replace("2,2,1.0+0", "2,2,1.0,,,4.0"), "line 17 has 11 fields"),
    ("K.pch", PUNCH.replace("2,2,,2,2", "2,2,x,2,2"), 'the column the field must be blank, but holds "x"'),
    ("K.pch", PUNCH.replace("1       1.0\n", "1       12345.6789\n"), 'holds "89"'),
    ("K.pch", PUNCH.replace("1       1.0\n", "1       1,5\n"), '"1,5" has a decimal comma: write 1.5'),
    ("K.pch", PUNCH.replace("DMIG,MAAX,2,2,,2,2", "DMIG,MAAX,2,9,,2,9"), "no point 2, component 9"),
    ("K.pch", PUNCH.replace("2.000000000D+05", "2.0000x0000D+05"), "has \"x0000D+05\" behind"),
    ("K.hb", BOEING.replace("RSA", "CSA"), "CSA"),
    ("K.hb", BOEING.replace("   1   3   4   5", "   1   4   3   5"), "pointers of columns do not rise"),
    ("K.hb", BOEING.replace("   1   3   2   3   4", "   1   3   2   3   5"), "indices of rows beyond 1 to 4"),
    ("K.hb", BOEING.replace(" 2.5000000E+05\n", ""), "it is cut off: line 7 on must hold 5 numbers"),
    ("K.hb", BOEING.replace("-1.0000000E+05", "-1.0000x00E+05"), "has \"x00E+05\" behind"),
]  # fmt: skip


@pytest.mark.parametrize("name, text, words", REFUSED)
def test_what_is_refused(tmp_path, name, text, words):
    (tmp_path / name).write_text(text)
    assert words in refused(tmp_path, stiffness=name, dofs=list(ROWS))


def test_names_that_are_no_rows(tmp_path):
    write(tmp_path, K__mtx=ABAQUS_K, M__mtx=ABAQUS_M)
    names = ["1x", "1y", "2x", "3y"]
    assert '"3y" is no row of the matrices' in refused(tmp_path, stiffness="K.mtx", mass="M.mtx", dofs=names)
    fewer = refused(tmp_path, stiffness="K.mtx", mass="M.mtx", dofs=["1x", "1y", "2x"])
    assert 'has rows that dofs does not name: "2y"' in fewer
