"""Files of modes with one byte changed: read in a child process, they are an answer or one sentence."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from scipy.io import savemat

from fcm.scene import SceneError, scene_from_dict

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
        data = {"modal": {"file": path.name, "damping": 0.1}, "force": [{"dof": "1x", "amplitude": 1.0}],
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


def run(path, values):
    command = [sys.executable, "-c", DRIVER, str(path), ",".join(map(str, values))]
    found = subprocess.run(command, capture_output=True, text=True, check=False)
    assert found.returncode == 0, found.stderr
    return [int(count) for count in found.stdout.split()]


def test_every_byte_of_an_archive(tmp_path):
    np.savez(tmp_path / "m.npz", **MODES)
    read, refused = run(tmp_path / "m.npz", (0, 255))
    assert read > 100 and refused > 500


def test_every_byte_of_a_universal_file(tmp_path):
    path = tmp_path / "m.uff"
    path.write_bytes((HERE / "two_modes.uff").read_bytes())
    read, refused = run(path, (0, 57, 255))
    assert read > 100 and refused > 100


# In a process for each changed byte, the reader of .mat files ends with an answer, a sentence, or a signal:
# it is scipy's, and what it may do there is what `fcm.scene.matlab` keeps away from the program.
READER = """
import os, sys
from pathlib import Path
from fcm.scene import matlab
import scipy.io

path, value = Path(sys.argv[1]), int(sys.argv[2])
whole = path.read_bytes()
ends = {}
null = os.open(os.devnull, os.O_RDWR)
for offset in range(len(whole)):
    changed = bytearray(whole)
    changed[offset] = value
    path.write_bytes(changed)
    process = os.fork()
    if not process:
        os.dup2(null, 1)
        os.dup2(null, 2)
        matlab.child([str(path), "1000000", "dofs", "mass", "frequency", "damping", "shapes"])
        sys.stdout.flush()
        os._exit(0)
    status = os.waitstatus_to_exitcode(os.waitpid(process, 0)[1])
    ends.setdefault(status, []).append(offset)
print({status: offsets if status not in (0, 3) else len(offsets) for status, offsets in ends.items()})
"""


@pytest.mark.skipif(not hasattr(__import__("os"), "fork"), reason="needs fork")
def test_every_byte_of_a_matlab_file(tmp_path):
    """Those bytes that end the reader by a signal are read again by the program, which says a sentence."""
    path = tmp_path / "m.mat"
    savemat(path, MODES)
    whole = path.read_bytes()
    command = [sys.executable, "-c", READER, str(path), "0"]
    found = subprocess.run(command, capture_output=True, text=True, check=True)
    ends = eval(found.stdout)
    assert set(ends) - {0, 3} <= {-4, -6, -7, -8, -11} and ends[0] > 100 and ends[3] > 20
    killed = [offset for status, offsets in ends.items() if status < 0 for offset in offsets]
    for offset in {*killed[:10], 248}:
        changed = bytearray(whole)
        changed[offset] = 0
        path.write_bytes(changed)
        data = {"modal": {"file": "m.mat"}, "force": [], "response": {"frequency": [0.5, 1.5]}}
        with pytest.raises(SceneError, match=r"modal.file: .*m.mat.* cannot be read: it"):
            scene_from_dict(data, "test.toml", tmp_path)


def test_the_program_says_one_sentence(tmp_path):
    """The byte at offset 248 set to 0 crashed the interpreter."""
    savemat(tmp_path / "m.mat", MODES)
    content = bytearray((tmp_path / "m.mat").read_bytes())
    content[248] = 0
    (tmp_path / "m.mat").write_bytes(content)
    text = '[modal]\nfile = "m.mat"\n[[force]]\ndof = "1x"\namplitude = 1\n[response]\nfrequency = [1, 2]\n'
    (tmp_path / "m.toml").write_text(text)
    command = [sys.executable, "-m", "fcm.cli", "respond", str(tmp_path / "m.toml")]
    found = subprocess.run(command, capture_output=True, text=True, check=False)
    assert found.returncode == 2 and found.stdout == ""
    assert len(found.stderr.splitlines()) == 1 and "m.mat" in found.stderr
