"""Scenes and files that ask for too much, or for what no file of results can hold: refused on loading."""

from __future__ import annotations

import unicodedata

import numpy as np
import pytest
from scipy.io import savemat

from fcm.scene import SceneError, load_scene, scene_from_dict
from fcm.scene.errors import shown

MODES = {"dofs": ["u", "v"], "frequency": np.array([1.0, 2.0]), "damping": 0.1, "shapes": np.eye(2)}


def refused(folder, name, **limits):
    data = {
        "modal": {"file": name},
        "force": [{"dof": "u", "amplitude": 1.0}],
        "response": {"frequency": [0.5, 1.5]},
    }
    with pytest.raises(SceneError) as caught:
        scene_from_dict(data, "test.toml", folder, **limits)
    return str(caught.value)


def test_masses_that_lose_one_another(data, mistakes):
    data["modal"]["mass"] = [1e-50, 1]
    assert "the modal masses, from 1e-50 to 1, differ by more than 1e+20" in mistakes(data)


def test_masses_that_a_sweep_drives_apart(data, mistakes):
    data["sweep"] = {"modal.mass.0": [1.0, 1e-50]}
    assert "sweep with modal.mass.0 = 1e-50: the modal masses" in mistakes(data)


@pytest.mark.parametrize("amplitude", [1e-320, -1e-120])
def test_forces_of_which_displacements_would_be_no_numbers(data, mistakes, amplitude):
    data["force"][0]["amplitude"] = amplitude
    assert f"force[0].amplitude: {shown(amplitude)} is too small to calculate with" in mistakes(data)
    data["force"][0]["amplitude"] = 1.0
    data["sweep"] = {"force.0.amplitude": [1.0, amplitude]}
    assert f"{shown(amplitude)} is too small to calculate with" in mistakes(data)


def test_a_file_without_a_name(data, mistakes):
    data["modal"] = {"file": ""}
    assert mistakes(data).splitlines()[0] == "test.toml: modal.file: is empty; name a file of modes"


@pytest.mark.parametrize("name", ["x" * 101, "é" * 51])
def test_names_too_long_for_a_file(data, mistakes, name):
    data["contact"][0]["name"] = data["modal"]["dofs"][0] = name
    del data["sweep"]
    data["contact"][0]["tangential"] = data["force"][0]["dof"] = name
    data["force"][1]["dof"] = name
    message = mistakes(data)
    assert "modal.dofs[0]: is too long for a name" in message
    assert ".name: is too long for a name" in message


def test_names_that_differ_in_their_characters_only(data, mistakes):
    composed, apart = (unicodedata.normalize(form, "Schaufelfuß é") for form in ("NFC", "NFD"))
    assert composed != apart
    data["contact"][0]["name"], data["contact"][1]["name"] = composed, apart
    data["modal"]["dofs"] += [composed, apart]
    data["modal"]["shapes"] = [[*row, 0, 0] for row in data["modal"]["shapes"]]
    del data["sweep"]
    message = mistakes(data)
    assert "contact: 2 contacts are named" in message and "in other Unicode characters" in message
    assert "modal.dofs: " in message


@pytest.mark.parametrize("high", [1.200000000000002, 1.2 * (1 + 9e-11)])
def test_a_range_of_a_few_roundings(data, mistakes, high):
    data["response"]["frequency"] = [1.2, high]
    assert "is too narrow to follow a curve through" in mistakes(data)


def test_a_narrow_range_that_can_be_followed(data):
    data["response"]["frequency"] = [1.2, 1.2 * (1 + 2e-10)]
    assert scene_from_dict(data).has_range


@pytest.mark.parametrize(
    "head, tail",
    [("", " = 1"), ("[", "]"), ("[[", "]]"), ("x = {", " = 1}"), ("x = {y = 1, ", " = 1}"), ("  ", " = 1")],
)
@pytest.mark.parametrize("part", ["a", '"a"', "'a b'", "a-1"])
def test_a_key_of_very_many_parts(tmp_path, head, tail, part):
    """Of 50 000 parts, the parser would take over a minute and 3 GB."""
    path = tmp_path / "deep.toml"
    path.write_text('title = "one. two"\n' + head + " . ".join([part] * 50_000) + tail)
    with pytest.raises(SceneError, match=r"deep.toml: line 2: unknown key, of more than 16 parts"):
        load_scene(path)


def test_dots_that_are_no_key(tmp_path, text):
    path = tmp_path / "dots.toml"
    path.write_text("# " + "a." * 100 + "\n" + text.replace("a test", "see " + "a. " * 100))
    assert load_scene(path).title.startswith("see a.")


def test_a_scene_too_large(tmp_path):
    path = tmp_path / "large.toml"
    path.write_bytes(b"#" * 10_000_001)
    with pytest.raises(SceneError, match="is too large; keep its modes in a file of their own"):
        load_scene(path)


@pytest.mark.slow
def test_files_larger_than_the_limit_when_unpacked(tmp_path):
    zeros = MODES | {"shapes": np.zeros((2, 500_000))}
    np.savez_compressed(tmp_path / "m.npz", **zeros)
    savemat(tmp_path / "m.mat", zeros, do_compression=True)
    (tmp_path / "m.uff").write_bytes(b"x" * 2_000_000)
    assert all((tmp_path / name).stat().st_size < 100_000 for name in ("m.npz", "m.mat"))
    for name in ("m.npz", "m.mat", "m.uff"):
        assert "--largest-file" in refused(tmp_path, name, largest_file=1_000_000)
        assert "--largest-file" not in refused(tmp_path, name, largest_file=10_000_000)


def test_an_archive_that_says_it_holds_more_than_it_does(tmp_path):
    np.savez(tmp_path / "m.npz", **MODES)
    content = (tmp_path / "m.npz").read_bytes()
    assert content.count(b"'shape': (2, 2)") == 1
    (tmp_path / "m.npz").write_bytes(content.replace(b"'shape': (2, 2), }   ", b"'shape': (2, 9**9), }"))
    assert "cannot be read" in refused(tmp_path, "m.npz")
    (tmp_path / "m.npz").write_bytes(content.replace(b"'shape': (2, 2), }   ", b"'shape': (2,9999), } "))
    assert "cannot be read" in refused(tmp_path, "m.npz")
