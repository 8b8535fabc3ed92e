"""Files of modes with one byte changed: read in a child process, they are an answer or one sentence."""

from __future__ import annotations

import ast
import os
from pathlib import Path

import numpy as np
import pytest
import scipy.sparse
from scipy.io import mmwrite, savemat

from fcm.scene import SceneError, scene_from_dict

from ..program import AS_A_MODULE, python

HERE = Path(__file__).parent
MODES = {
    "dofs": ["1x", "12z"],
    "mass": np.array([1.0, 2.0]),
    "frequency": np.array([1.0, 10.0]),
    "damping": np.array([0.01, 0.02]),
    "shapes": np.array([[0.7, 0.1], [1.0, -0.5]]),
}

# Reads a file as often as it has bytes, each time with one of them changed; counts the answers.
DRIVER = """
import sys, warnings
from pathlib import Path
import numpy as np
from fcm.scene import Scene, SceneError, scene_from_dict

warnings.simplefilter("error")
path, values = Path(sys.argv[1]), [int(value) for value in sys.argv[2].split(",")]
whole = path.read_bytes()
read = refused = 0
for offset in range(len(whole)):
    for value in values:
        changed = bytearray(whole)
        changed[offset] = value
        path.write_bytes(changed)
        structure = {"dofs": ["1x", "12z"], "stiffness": path.name, "mass": [1, 2], "damping": 0.1}
        table = {"file": path.name, "damping": 0.1} if sys.argv[3] == "modal" else structure
        data = {sys.argv[3]: table, "force": [{"dof": "1x", "amplitude": 1.0}],
                "response": {"frequency": [0.5, 1.5]}}
        try:
            scene = scene_from_dict(data, "test.toml", path.parent)
        except SceneError as error:
            refused += 1
            assert "\\n" not in str(error.mistakes[0]) and len(str(error)) < 20_000
        else:
            read += 1
            assert np.isfinite(scene.modal.shapes).all()
print(read, refused)
"""


def run(path, values, kind="modal"):
    done = python("-c", DRIVER, path, ",".join(map(str, values)), kind)
    assert done.code == 0, done.err
    return [int(count) for count in done.out.split()]


@pytest.mark.slow
def test_every_byte_of_an_archive(tmp_path):
    np.savez(tmp_path / "m.npz", **MODES)
    read, refused = run(tmp_path / "m.npz", (0, 255))
    assert read > 100 and refused > 500


@pytest.mark.slow
def test_every_byte_of_a_sparse_matrix(tmp_path):
    scipy.sparse.save_npz(tmp_path / "K.npz", scipy.sparse.csr_array(np.array([[3.0, -1.0], [-1.0, 2.0]])))
    read, refused = run(tmp_path / "K.npz", (255,), "structure")
    assert read > 100 and refused > 300


@pytest.mark.slow
def test_every_byte_of_a_universal_file(tmp_path):
    path = tmp_path / "m.uff"
    path.write_bytes((HERE / "two_modes.uff").read_bytes())
    read, refused = run(path, (0, 57))
    assert read > 100 and refused > 100


# The reader of .mat files may end by a signal on a damaged one: it is scipy's, and what it may do is what
# `fcm.scene.reader_process` keeps from the program. Each changed byte has a process of its own, twice: with
# the tags checked, as the program does it, and without.
READER = """
import os, sys
from pathlib import Path
from fcm.scene import reader_process
import scipy.io

path, values = Path(sys.argv[1]), [int(value) for value in sys.argv[2].split(",")]
if sys.argv[3] == "unchecked":
    reader_process.check_tags = lambda *_: None
whole = path.read_bytes()
ends = {}
null = os.open(os.devnull, os.O_RDWR)
for offset in range(len(whole)):
    for value in values:
        changed = bytearray(whole)
        changed[offset] = value
        path.write_bytes(changed)
        process = os.fork()
        if not process:
            os.dup2(null, 1)
            os.dup2(null, 2)
            reader_process.child([str(path), "1000000", "dofs", "mass", "frequency", "damping", "shapes"])
            sys.stdout.flush()
            os._exit(0)
        status = os.waitstatus_to_exitcode(os.waitpid(process, 0)[1])
        ends[status] = ends.get(status, 0) + 1
print(ends)
"""


def ends_of_reader(path, values, how):
    """How often the reader ended with each exit code; those of signals are negative."""
    done = python("-c", READER, path, ",".join(map(str, values)), how)
    assert done.code == 0, done.err
    return ast.literal_eval(done.out)


@pytest.mark.slow
@pytest.mark.skipif(not hasattr(os, "fork"), reason="needs fork")
@pytest.mark.parametrize("compressed", [False, True])
def test_every_byte_of_a_matlab_file(tmp_path, compressed):
    path = tmp_path / "m.mat"
    savemat(path, MODES, do_compression=compressed)
    ends = ends_of_reader(path, (0, 255), "checked")
    assert set(ends) == {0, 3} and ends[0] > 50 and ends[3] > 50


def test_every_byte_of_a_matrix_market_file(tmp_path):
    mmwrite(tmp_path / "K.mtx", scipy.sparse.coo_array(np.array([[3.0, -1.0], [-1.0, 2.0]])))
    read, refused = run(tmp_path / "K.mtx", (0, 57), "structure")
    assert read >= 3 and refused > 100


@pytest.mark.skipif(not hasattr(os, "fork"), reason="needs fork")
def test_a_signal_becomes_a_sentence(tmp_path, monkeypatch):
    """Were a file to end the reader all the same, the program would say so."""
    savemat(tmp_path / "m.mat", MODES)
    (tmp_path / "sitecustomize.py").write_text("import os; os.kill(os.getpid(), 11)")
    monkeypatch.syspath_prepend(tmp_path)  # where the reader's own process looks, too
    data = {"modal": {"file": "m.mat"}, "force": [], "response": {"frequency": [0.5, 1.5]}}
    with pytest.raises(SceneError, match=r"m.mat.* cannot be read: it is damaged: what it says of itself"):
        scene_from_dict(data, "test.toml", tmp_path)


def test_the_program_says_one_sentence(tmp_path):
    """A type set to 0 crashed the interpreter."""
    savemat(tmp_path / "m.mat", MODES)
    content = bytearray((tmp_path / "m.mat").read_bytes())
    content[176] = 0
    (tmp_path / "m.mat").write_bytes(content)
    text = '[modal]\nfile = "m.mat"\n[[force]]\ndof = "1x"\namplitude = 1\n[response]\nfrequency = [1, 2]\n'
    (tmp_path / "m.toml").write_text(text)
    done = python(*AS_A_MODULE, "respond", tmp_path / "m.toml")
    assert done.code == 2 and done.out == ""
    assert len(done.err.splitlines()) == 1 and "m.mat" in done.err
