"""Files with pieces lost, changed, doubled and moved: refused in words for their owner, or read as they are.

Whatever is read must be in the file: each number of a text file among its words, and of a packed file the
number that was written, as its checksums would tell of another.
"""

from __future__ import annotations

import os
import re

import numpy as np
import pytest
import scipy.io
import scipy.sparse

from fcm.scene import SceneError, scene_from_dict

from ..program import python
from ..scale import SCALE
from .test_matrix_formats import ABAQUS_K, BOEING, PUNCH, ROWS
from .test_uff import NX, PERMAS, TRANSLATION, times

CASES = int(40 * SCALE)
PIECES = [
    b"",
    b" ",
    b"\n",
    b",",
    b".",
    b"-",
    b"D+02",
    b"kN",
    b"1",
    b"9",
    b"nan",
    b"\xef\xbb\xbf",
    b"\xff",
    b"e",
    b"-1\n",
]
PYTHON = re.compile(  # as its messages begin
    r"literal|argument|codec|unpack|NoneType|not subscriptable|index out|list index|convert string|"
    r"out of range for|has no attribute|object|reshape|Traceback|buffer|KeyError|not supported between|"
    r"\bdtype\b|\bstr\b|\bint\b"
)
K = np.array([[4.25, -1.5, 0.0], [-1.5, 3.125, -0.0625], [0.0, -0.0625, 2.75]])
COLUMNS = {"K.pch": (8, 16), "K.hb": (0, 14)}  # where they begin, and how wide they are
NUMBER = re.compile(rb"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eEdD][-+]?\d+|[-+]\d{3})?")


def damaged(rng, content):
    """A content with one to three pieces changed."""
    for _ in range(rng.integers(1, 4)):
        at, size = int(rng.integers(len(content) + 1)), int(rng.choice([0, 1, 1, 3, 20]))
        piece = PIECES[rng.integers(len(PIECES))]
        begin, end = sorted(rng.integers(len(content) + 1, size=2))
        lines = content.split(b"\n")
        line = int(rng.integers(len(lines)))
        content = [
            content[:at] + piece + content[at + size :],
            content[:at] + content[at + max(size, 1) :],
            content[:at] + rng.bytes(size or 1) + content[at + size :],
            content[:at],
            content[:begin] + content[end:] if end - begin < 200 else content[:at],
            b"\n".join([*lines[:line], *lines[line + 1 :]]),
            b"\n".join([*lines[: line + 1], *lines[line:]]),
            content[:at] + content[begin:end][:60] + content[at:],
        ][rng.integers(8)]
    return content


def words(content):
    """The numbers that can be read anywhere in a text, by Python alone; of two that touch, each."""
    found = {0.0, 1.0}
    for number, exponent in re.findall(rb"(\d+\.\d*|\.\d+)([-+]\d{1,3})", content):  # as Nastran writes
        found |= {float(f"{number.decode()}e{exponent.decode()}")}
    for line in content.split(b"\n"):
        for part in (line, *line.split()):
            for text in NUMBER.findall(part):
                text = text.decode().lower().replace("d", "e")
                text = re.sub(r"(?<=[\d.])([-+]\d{3})$", r"e\1", text) if "e" not in text else text
                found |= {abs(float(text))}
    return found


def in_columns(content, begin, width):
    """A text with a blank between its columns, where numbers may touch."""
    lines = content.split(b"\n")
    parts = [[line[at : at + width] for at in range(begin, len(line), width)] for line in lines]
    return b"\n".join(b" ".join(one) for one in parts)


def scene(folder, table):
    force, response = [{"dof": "1x", "amplitude": 1.0}], {"frequency": [0.5, 1.5]}
    return scene_from_dict({**table, "force": force, "response": response}, "t.toml", folder)


def each(folder, name, content, table, seed):
    """Each damaged content that is read, with its scene; of those that are not, what is said is looked at."""
    rng = np.random.default_rng([seed, len(content)])
    refused = 0
    for _ in range(CASES):
        changed = damaged(rng, content)
        (folder / name).write_bytes(changed)
        try:
            found = scene(folder, table)
        except SceneError as error:
            refused += 1
            said = str(error)
            assert not PYTHON.search(re.sub(r'"(?:[^"\\]|\\.)*"', "", said)), (said, changed)
            assert len(said) < 20_000 and all(len(one.splitlines()) == 1 for one in error.mistakes)
        else:
            yield changed, found
    assert refused > CASES // 10


def matrix_read(folder, name):
    from fcm.scene.files import Files
    from fcm.scene.matrix_file import read_matrix

    return read_matrix(name, Files(folder)).matrix.toarray()


def of_matrix(name, rows=("1x", "1y", "1z")):
    mass = [1.0] * len(rows)
    return {"structure": {"dofs": list(rows), "stiffness": name, "mass": mass, "damping": 0.1}}


@pytest.mark.parametrize("form", ["symmetric", "general", "array"])
def test_matrix_market(tmp_path, form):
    matrix = K if form == "array" else scipy.sparse.coo_array(K)
    scipy.io.mmwrite(tmp_path / "K.mtx", matrix, symmetry="general" if form == "array" else form)
    content = (tmp_path / "K.mtx").read_bytes().replace(b"4.25", b"4.25D+00").replace(b"2.75", b"0.275E+001")
    for changed, _ in each(tmp_path, "K.mtx", content, of_matrix("K.mtx"), 1):
        assert set(np.abs(matrix_read(tmp_path, "K.mtx")).ravel().tolist()) <= words(changed), changed


@pytest.mark.parametrize("name", ["55", "2414", "complex", "binary"])
def test_universal_files(tmp_path, name):
    values = "  1.00000E+00  0.00000E+00 -2.50000E-01  0.00000E+00  3.00000E+00  0.00000E+00"
    text = {
        "55": TRANSLATION.encode(), "2414": PERMAS.encode(), "binary": times() + TRANSLATION.encode(),
        "complex": NX.format(mass="1.50000E+00", values=values).replace("3992", "   1").encode(),
    }[name]  # fmt: skip
    table = {"modal": {"file": "m.uff", "damping": 0.01, "mass": 1.0}}
    for changed, found in each(tmp_path, "m.uff", text, table, 2):
        shapes, known = np.abs(found.modal.shapes).ravel(), words(changed)
        assert set(shapes.tolist()) <= known or name == "complex", changed
        hertz = found.modal.frequency / (2.0 * np.pi)
        assert all(min(abs(one - k) for k in known) <= 1e-14 * one for one in hertz.tolist()), changed


@pytest.mark.parametrize(
    "name, text",
    [
        ("K.sti", "1 1 1.5D+00\n2 1 -2.5e-1\n2 2 3.25\n3 3 4.5\n"),
        ("K.mtx", ABAQUS_K),
        ("K.hb", BOEING),
        ("K.pch", PUNCH.replace("MAAX", "LAAX")),
    ],
)
def test_matrices_of_other_programs(tmp_path, name, text):
    given = f"{name}:KAAX" if name == "K.pch" else name
    rows = ("1x", "1y", "1z") if name == "K.sti" else ROWS
    count = 0
    for changed, _ in each(tmp_path, name, text.encode(), of_matrix(given, rows), 8):
        count += 1
        read = set(np.abs(matrix_read(tmp_path, given)).ravel().tolist())
        assert read <= words(changed) | words(in_columns(changed, *COLUMNS.get(name, (0, 999)))), changed
    assert count


def test_tables_of_pairs(tmp_path):
    """A preload of each pair in a table with commas."""
    names = ["1x", "1y", "2x", "2y"]
    structure = {"dofs": names, "stiffness": [4.0, 5.0, 6.0, 7.0], "mass": [1.0] * 4, "damping": 0.1}
    contact = {
        "name": "c",
        "nodes": "pairs.csv",
        "tangential": "x",
        "normal": "y",
        "mu": 0.3,
        "k_u": 1,
        "k_v": 1,
    }
    content = b"node,other,n_0\n1,2,12.5\n1,,3.25D+00 # alone\n2,,7\n"
    table = {"structure": structure, "contact": [contact]}
    for changed, found in each(tmp_path, "pairs.csv", content, table, 9):
        assert {abs(one.n_0) for one in found.contacts} <= words(changed), changed


def test_archives(tmp_path):
    """Each array has a checksum."""
    scipy.sparse.save_npz(tmp_path / "K.npz", scipy.sparse.csr_array(K))
    content = (tmp_path / "K.npz").read_bytes()
    for changed, _ in each(tmp_path, "K.npz", content, of_matrix("K.npz"), 3):
        assert (matrix_read(tmp_path, "K.npz") == K).all(), changed


def test_names_of_rows(tmp_path):
    """A name that is read is on a line of its own, but for the blank between a node and a direction."""
    np.savez(tmp_path / "K.npz", K=K)
    table = {"structure": {"file": "names.txt", "stiffness": "K.npz", "mass": [1, 2, 3], "damping": 0.1}}
    content = b"# rows\n1x\n1 y # up\n1:3\n"
    for changed, found in each(tmp_path, "names.txt", content, table, 4):
        text = changed.decode("utf-8-sig")
        lines = {re.sub(r"[\s,:]", "", line.partition("#")[0]) for line in text.splitlines()}
        assert {name.replace(":", "") for name in found.modal.dofs} <= lines, changed


def test_names_of_rows_of_calculix(tmp_path):
    """Each is the node and the direction of a line of its own."""
    np.savez(tmp_path / "K.npz", K=K)
    table = {"structure": {"dofs": "job.dof", "stiffness": "K.npz", "mass": [1, 2, 3], "damping": 0.1}}
    content = b"1.1\n1.2\n40.6\n"
    for changed, found in each(tmp_path, "job.dof", content, table, 10):
        lines = [line.strip() for line in changed.decode("utf-8-sig").splitlines() if line.strip()]
        pairs = (line.split(".") for line in lines)
        names = [f"{int(node)}{['x', 'y', 'z', 'rx', 'ry', 'rz'][int(axis) - 1]}" for node, axis in pairs]
        assert list(found.modal.dofs) == names, changed


def test_scenes(tmp_path):
    """A scene's own file: a damaged line is named, or the scene is another."""
    from fcm.scene import load_scene

    text = '[modal]\ndofs = ["1x", "1y"]\nfrequency = [1.0, 2.5]\ndamping = 0.01\n'
    text += "shapes = [[1.0, 0.5], [0.5, -1.0]]\n"
    text += '[[force]]\ndof = "1x"\namplitude = 1.0\nphase = "45deg"\n[response]\nfrequency = [0.5, 1.5]\n'
    rng = np.random.default_rng(5)
    for _ in range(CASES):
        (tmp_path / "s.toml").write_bytes(changed := damaged(rng, text.encode()))
        try:
            load_scene(tmp_path / "s.toml")
        except SceneError as error:
            said = re.sub(r'"(?:[^"\\]|\\.)*"|line \d+, .*?: ', "", str(error))
            assert not PYTHON.search(said), (said, changed)


# The readers of other packages end their process where they crash: each case has one, made by fork.
READER = """
import os, sys
from contextlib import suppress
from pathlib import Path
import scipy.io, scipy.sparse
from fcm.scene import reader_process
with suppress(ImportError):
    import pyyeti.nastran.op4

folder, null = Path(sys.argv[1]), os.open(os.devnull, os.O_RDWR)
for path in sorted(folder.glob("case*")):
    process = os.fork()
    if not process:
        os.dup2(os.open(path.with_name(f"out-{path.name}"), os.O_CREAT | os.O_WRONLY), 1)
        os.dup2(os.open(path.with_name(f"err-{path.name}"), os.O_CREAT | os.O_WRONLY), 2)
        reader_process.child([str(path), "1000000"])
        sys.stdout.flush()
        os._exit(0)
    print(path.name, os.waitstatus_to_exitcode(os.waitpid(process, 0)[1]))
"""


def with_bytes_changed(rng, content):
    """A content of the same length, with one to three bytes changed."""
    found = bytearray(content)
    for at in rng.integers(len(found), size=rng.integers(1, 4)).tolist():
        found[at] = rng.integers(256)
    return bytes(found)


def read_apart(folder, ending, content, seed, change=damaged):
    """The arrays that are read of each damaged content; what is said of the others is looked at."""
    rng = np.random.default_rng([seed, len(content)])
    changed = [change(rng, content) for _ in range(max(CASES // 4, 5))]
    for number, one in enumerate(changed):
        (folder / f"case{number:05d}{ending}").write_bytes(one)
    done = python("-c", READER, folder)
    assert done.code == 0, done.err
    for line, one in zip(done.out.splitlines(), changed, strict=True):
        name, status = line.split()
        assert int(status) <= 3, (name, status)
        if int(status) == 3:
            said = (folder / f"err-{name}").read_text()
            assert said and not PYTHON.search(re.sub(r'"[^"]*"', "", said)), (said, one)
        elif int(status) == 0:
            with np.load(folder / f"out-{name}", allow_pickle=False) as archive:
                yield one, {key: archive[key] for key in archive.files}


@pytest.mark.slow
@pytest.mark.skipif(not hasattr(os, "fork"), reason="needs fork")
def test_packed_matlab_files(tmp_path):
    """What is packed has a checksum: it is what was written, or nothing."""
    scipy.io.savemat(tmp_path / "K.mat", {"K": K}, do_compression=True)
    for changed, found in read_apart(tmp_path, ".mat", (tmp_path / "K.mat").read_bytes(), 6):
        assert all((found[name] == K).all() for name in found if name == "K"), changed


@pytest.mark.slow
@pytest.mark.skipif(not hasattr(os, "fork"), reason="needs fork")
@pytest.mark.parametrize("kind", ["K.mat", "K.h5", "matlab 7.3", "K.op4"])
def test_binary_files_without_checksums(tmp_path, kind):
    """Each number that is read stands in the file by its bytes, of either order."""
    name = "K.mat" if kind == "matlab 7.3" else kind
    if kind == "K.mat":
        scipy.io.savemat(tmp_path / name, {"K": K})
    elif kind == "K.op4":
        op4 = pytest.importorskip("pyyeti.nastran.op4")
        op4.write(str(tmp_path / name), {"K": K}, binary=True, sparse="dense")
    else:
        h5py = pytest.importorskip("h5py")
        with h5py.File(tmp_path / name, "w", userblock_size=512 * (kind == "matlab 7.3")) as file:
            file["K"] = K
            if kind == "matlab 7.3":
                file["K"].attrs["MATLAB_class"] = np.bytes_("double")
        if kind == "matlab 7.3":
            head = b"MATLAB 7.3 MAT-file, Platform: GLNXA64".ljust(116) + bytes(8) + b"\x00\x02IM"
            content = (tmp_path / name).read_bytes()
            (tmp_path / name).write_bytes(head.ljust(512, b"\0") + content[512:])
    count = 0
    content = (tmp_path / name).read_bytes()
    for changed, found in read_apart(tmp_path, name[1:], content, 8, with_bytes_changed):
        for array in (one for key, one in found.items() if "." not in key and one.dtype.kind == "f"):
            count += 1
            assert all(one.tobytes() in changed or one.tobytes()[::-1] in changed for one in array.ravel())
    assert count


@pytest.mark.slow
@pytest.mark.skipif(not hasattr(os, "fork"), reason="needs fork")
@pytest.mark.parametrize("form", ["dense", "nonbigmat"])
def test_nastran_output4_as_text(tmp_path, form):
    op4 = pytest.importorskip("pyyeti.nastran.op4")
    op4.write(str(tmp_path / "K.op4"), {"K": K}, binary=False, sparse=form)
    for changed, found in read_apart(tmp_path, ".op4", (tmp_path / "K.op4").read_bytes(), 7):
        for name, array in found.items():
            if name.endswith(".data") or "." not in name:
                known = words(changed) | words(in_columns(changed, 0, 23))
                parts = np.abs(np.concatenate((array.real.ravel(), array.imag.ravel())))
                assert set(parts.tolist()) <= known, (name, array, changed)


@pytest.mark.slow
def test_nastran_output4_with_a_format_narrower_than_its_numbers(tmp_path):
    """The rest of each line would be left out."""
    op4 = pytest.importorskip("pyyeti.nastran.op4")
    op4.write(str(tmp_path / "K.op4"), {"K": K}, binary=False, sparse="dense")
    text = (tmp_path / "K.op4").read_text()
    assert (matrix_read(tmp_path, "K.op4") == K).all()
    (tmp_path / "K.op4").write_text(text.replace("3E23.16", "3E2"))
    with pytest.raises(SceneError, match="a format of numbers is narrower than they are"):
        scene(tmp_path, of_matrix("K.op4"))


def test_an_archive_whose_list_of_names_is_damaged(tmp_path):
    """Names have no checksum of their own: the masses, by another name, would be taken as 1."""
    np.savez(tmp_path / "m.npz", dofs=["1x"], frequency=[1.0], damping=[0.1], shapes=[[1.0]], mass=[2.0])
    content = (tmp_path / "m.npz").read_bytes()
    at = content.rindex(b"mass.npy")
    (tmp_path / "m.npz").write_bytes(content[:at] + b"tass.npy" + content[at + 8 :])
    with pytest.raises(SceneError, match=r"m\.npz"):
        scene(tmp_path, {"modal": {"file": "m.npz"}})
