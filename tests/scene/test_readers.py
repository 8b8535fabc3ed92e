"""Readers of one's own, installed as entry points: matrices with and without names of rows, modes, faults."""

import json

import numpy as np
import pytest

from fcm.scene import SceneError, load_scene, readers

READERS = """
import json
import numpy as np

def matrices(path):
    held = json.loads(path.read_text())
    if held.get("broken"):
        raise ValueError("line 1: broken, where K and M are needed")
    if held.get("defect"):
        raise KeyError("K")
    if held.get("list"):
        return [1.0]
    rows = held.pop("rows", None)
    found = {name: np.array(one) for name, one in held.items()}
    return {name: (one, rows) for name, one in found.items()} if rows else found
"""
SCENE = """
[structure]
dofs = ["a", "b"]
mass = "model.blade:M"
stiffness = "model.blade:K"
damping = 0.01
[[contact]]
name = "joint"
tangential = "a"
normal = "b"
mu = 0.4
k_u = 1.0
k_v = 1.0
n_0 = 5.0
[[force]]
dof = "a"
amplitude = 1.0
[response]
frequency = [0.7, 1.7]
"""
ROWS = SCENE.replace('dofs = ["a", "b"]\n', "")
K, M = [[2.0, -1.0], [-1.0, 2.0]], [[1.0, 0.0], [0.0, 1.0]]


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """Where a package with a reader of .blade files is installed, and one that is not there any more."""
    site = tmp_path / "site"
    about = site / "blade_reader-1.0.dist-info"
    about.mkdir(parents=True)
    (about / "METADATA").write_text("Metadata-Version: 2.1\nName: blade-reader\nVersion: 1.0\n")
    (about / "entry_points.txt").write_text(
        "[fcm.readers]\nblade = blade_reader:matrices\ngone = blade_reader:nothing\n"
    )
    (site / "blade_reader.py").write_text(READERS)
    monkeypatch.syspath_prepend(site)
    readers.installed_readers.cache_clear()
    yield tmp_path
    readers.installed_readers.cache_clear()


def loaded(folder, scene, held):
    (folder / "scene.toml").write_text(scene)
    (folder / "model.blade").write_text(json.dumps(held))
    return load_scene(folder / "scene.toml")


def test_matrices(folder):
    scene = loaded(folder, SCENE, {"K": K, "M": M})
    assert np.allclose(scene.modal.frequency, [1.0, np.sqrt(3.0)])  # w^2 = 1 and 3


def test_names_of_rows(folder):
    scene = loaded(folder, ROWS, {"K": K, "M": M, "rows": ["a", "b"]})
    assert set(scene.modal.dofs) == {"a", "b"}


def test_modes(folder):
    text = SCENE[SCENE.index("[[contact]]") :]
    modes = {"dofs": ["a", "b"], "frequency": [1.0, 3.0], "damping": 0.01, "shapes": [[1.0, 0.2], [0.1, 1.0]]}
    scene = loaded(folder, '[modal]\nfile = "model.blade"\n' + text, modes)
    assert scene.modal.dofs == ("a", "b") and scene.modal.frequency.tolist() == [1.0, 3.0]


@pytest.mark.parametrize(
    ("held", "said"),
    [
        ({"broken": 1}, 'model.blade" cannot be read: line 1: broken, where K and M are needed'),
        ({"defect": 1}, "the reader blade_reader:matrices of .blade files failed: KeyError: 'K'"),
        ({"list": 1}, "the reader blade_reader:matrices of .blade files returned "),
        ({"K": K, "M": M, "rows": ["a"]}, '"K" has 2 rows and 1 names of rows'),
        ({"K": K}, 'has no matrix "M"; it has "K"'),
    ],
)
def test_what_cannot_be_read_is_said_of_the_file(folder, held, said):
    with pytest.raises(SceneError) as caught:
        loaded(folder, ROWS, held)
    assert said in str(caught.value)


def test_a_reader_that_is_not_there(folder):
    (folder / "model.gone").write_text("")
    with pytest.raises(SceneError, match=r"the reader blade_reader:nothing of \.gone files cannot be loaded"):
        loaded(folder, SCENE.replace(".blade:K", ".gone:K"), {"M": M})


def test_endings_without_a_reader_name_those_that_have_one(folder):
    with pytest.raises(SceneError, match=r"such a file is \.npz, .*\.matrix, \.blade, \.gone"):
        loaded(folder, SCENE.replace(".blade:K", ".other"), {"M": M})
