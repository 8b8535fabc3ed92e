"""Files and names that are a scene, and those that are not."""

from __future__ import annotations

import os
import threading
from dataclasses import FrozenInstanceError
from math import pi
from pathlib import Path

import numpy as np
import pytest

import fcm
from fcm.scene import SceneError, bundled_scenes, load_scene, scene_from_dict
from fcm.scene.options import TomlOptions
from fcm.scene.toml import read_toml

from ..program import python


def refused(path: str | Path) -> str:
    with pytest.raises(SceneError) as caught:
        load_scene(path)
    return str(caught.value)


def test_every_bundled_scene_is_valid():
    assert {"yang1998", "yang1998-n5", "two-contacts"} <= set(bundled_scenes())
    for name in bundled_scenes():
        scene = load_scene(name)
        assert scene.name == name and scene.title


def test_the_papers_oscillator():
    scene = fcm.load_scene("yang1998")
    modal, (contact,) = scene.modal, scene.contacts
    assert modal.dofs == ("u", "v")
    assert [*modal.mass, *modal.frequency, *modal.damping] == [1, 1, 1, 10, 0.01, 0.01]
    assert modal.shapes.tolist() == [[0.707, 0.707], [1.0, -0.5]]
    assert (contact.mu, contact.k_u, contact.k_v) == (0.4, 1.0, 1.0)
    assert [force.direction.tolist() for force in scene.forces] == [[1, 0], [0, 1]]
    assert all((force.amplitude, force.phase) == (1, 0) for force in scene.forces)
    assert scene.frequency_range == (0.7, 1.7) and scene.max_step == 0.05
    assert [curve.contacts[0].n_0 for curve in scene.curves] == [100, 50, 20, 10, 5, 2, 0, -5, -20, -60]


def test_one_preload_of_it():
    scene = load_scene("yang1998-n5")
    assert scene.each_curve() == (scene,)
    assert scene.contacts[0].n_0 == 5.0


def test_every_field_of_a_file(tmp_path, text):
    path = tmp_path / "test.toml"
    path.write_text(text)
    scene = load_scene(path)
    shroud, damper = scene.contacts
    assert (scene.title, scene.name, scene.frequency_unit) == ("a test", str(path), "rad/s")
    assert shroud.tangential.tolist() == [1, 0, 0] and shroud.normal.tolist() == [0, 1, -0.5]
    assert (damper.mu, damper.k_u, damper.k_v, damper.n_0) == (0.3, 1.5, 2.5, -7.5)
    assert [(force.amplitude, force.phase) for force in scene.forces] == [(1, 0), (2, 0.5)]
    assert scene.forces[1].direction.tolist() == [1, -1, 0]
    assert [(phase.frequency, phase.cycles) for phase in scene.schedule] == [(1.2, 10)]


def test_frequencies_in_hertz_become_angular(data):
    plain = scene_from_dict(data)
    scene = scene_from_dict(data | {"frequency_unit": "Hz"})
    assert scene.frequency_unit == "Hz"
    assert scene.modal.frequency == pytest.approx(2 * pi * plain.modal.frequency, rel=1e-15)
    assert scene.frequency_range == pytest.approx((0.7 * 2 * pi, 1.7 * 2 * pi), rel=1e-15)
    assert scene.schedule[0].frequency == pytest.approx(1.2 * 2 * pi, rel=1e-15)
    assert scene.schedule[0].cycles == 10


def test_a_schedule_needs_no_range(data):
    for change in (data.__delitem__, lambda key: data.__setitem__(key, {"max_step": 0.1})):
        change("response")
        scene = scene_from_dict(data)
        assert not scene.has_range and len(scene.schedule) == 1 and scene.start is None


def test_where_a_schedule_starts(data):
    scene = scene_from_dict(data | {"start": {"displacement": [1, -2.5], "angle": 0.5}})
    assert scene.start.displacement.tolist() == [1, -2.5] and scene.start.velocity.tolist() == [0, 0]
    assert scene.start.friction.tolist() == [0, 0] and scene.start.angle == 0.5
    assert all(curve.start is scene.start for curve in scene.curves)


def test_nothing_has_to_move_where_nothing_is_traced(data):
    for force in data["force"]:
        force["amplitude"] = 0.0
    del data["response"], data["sweep"]
    assert scene_from_dict(data).schedule


def test_defaults(data):
    del data["modal"]["mass"], data["sweep"], data["schedule"], data["contact"], data["title"]
    data["modal"]["damping"] = 0.03
    scene = scene_from_dict(data)
    assert scene.modal.mass.tolist() == [1, 1] and scene.modal.damping.tolist() == [0.03, 0.03]
    assert scene.contacts == scene.schedule == scene.curves == ()
    assert scene.title == ""


def test_a_rigid_body_mode_is_a_mode(data):
    data["modal"]["frequency"] = [0, 10]
    assert scene_from_dict(data).modal.frequency.tolist() == [0, 10]


def test_a_scene_cannot_be_changed(data):
    scene = scene_from_dict(data)
    with pytest.raises(FrozenInstanceError):
        scene.title = "another"
    with pytest.raises(ValueError, match="read-only"):
        scene.curves[0].contacts[0].normal[0] = 1.0
    with pytest.raises(ValueError, match="read-only"):
        scene.modal.shapes[0, 0] = 1.0


def test_arrays_are_as_good_as_lists_and_are_not_changed(data):
    shapes = np.array(data["modal"]["shapes"])
    data["modal"] |= {"shapes": shapes, "mass": np.array([1, 2]), "damping": np.float32(0.5)}
    scene = scene_from_dict(data)
    assert scene.modal.mass.tolist() == [1, 2] and scene.modal.damping.tolist() == [0.5, 0.5]
    shapes[0, 0] = 9.0
    assert scene.modal.shapes[0, 0] == 0.7


def test_a_byte_order_mark_and_windows_line_ends_do_no_harm(tmp_path, text):
    path = tmp_path / "windows.toml"
    path.write_bytes(b"\xef\xbb\xbf" + text.replace("\n", "\r\n").encode())
    assert load_scene(path).title == "a test"


def test_a_bundled_name_goes_before_a_folder_of_that_name(tmp_path, monkeypatch):
    (tmp_path / "yang1998").mkdir()
    monkeypatch.chdir(tmp_path)
    assert load_scene("yang1998").name == "yang1998"


@pytest.mark.parametrize("name", ["yang199", "Yang1998", "yang1998.toml", "yang-1998"])
def test_a_misspelt_name_is_guessed(name):
    message = refused(name)
    assert message.startswith(f"{name}: no such file, and not a bundled scene; those are")
    assert 'did you mean "yang1998"?' in message


def test_a_name_like_no_other_gets_no_guess():
    message = refused("/nowhere/at/all.toml")
    assert '"yang1998"' in message and "did you mean" not in message


@pytest.mark.parametrize(
    "content, words",
    [
        (b"", "is empty"),
        (b"# only a comment\n", "is empty"),
        (b"\xff\xfe\x00binary", "is not UTF-8 text"),
        (b"\x89PNG\r\n\x1a\n", "is not UTF-8 text"),
        (b"\x89HDF\r\n\x1a\n", "is a file of results; name the scene, a TOML file, that it is of"),
        (b"PK\x03\x04\x00\xff", "is an archive, as of matrices; name the scene, a TOML file, that names it"),
        (b"[modal\n", r"line 1, \[modal: a table begins with its name in brackets: write \[modal\]"),
        (b"title = 'x'\ntitle = 'y'\n", "line 2, title = 'y': the key title is there twice: it is in line 1"),
        (b"x = " + b"[" * 100_000, "nested too deeply"),
        (b"x = " + b"9" * 5000, "a number or a date that cannot be read"),
        (b"x = 2023-02-31", "line 1, x = 2023-02-31"),
        (b"a." * 1000 + b"a = 1", "unknown key"),
    ],
)
def test_files_that_are_no_scene(tmp_path, content, words):
    path = tmp_path / "broken.toml"
    path.write_bytes(content)
    with pytest.raises(SceneError, match=f"(?s)broken.toml: .*({words})"):
        load_scene(path)


def test_paths_that_are_no_file(tmp_path):
    assert "is a folder" in refused(tmp_path)
    assert "no such file" in refused(tmp_path / "no.toml")
    assert "is a device" in refused("/dev/zero")
    assert '"a\\u0000b": no such file' in refused("a\0b")
    assert "cannot be read" in refused("a" * 5000)
    assert "SCENE: is empty" in refused("")


def test_a_file_without_permission(tmp_path, monkeypatch):
    path = tmp_path / "locked.toml"
    path.write_text("")

    def denied(self):
        raise PermissionError(13, "Permission denied")

    monkeypatch.setattr(Path, "read_bytes", denied)
    assert "cannot be read: Permission denied" in refused(path)


def test_a_file_too_large_is_not_read(tmp_path):
    path = tmp_path / "large.toml"
    with path.open("wb") as file:
        file.truncate(10**9)
    assert "is too large" in refused(path)


@pytest.mark.parametrize("late", [False, True])
def test_a_pipe_is_a_scene_and_waiting_for_it_is_said(tmp_path, text, late):
    options = TomlOptions(patience=0.05 if late else 60.0)
    os.mkfifo(tmp_path / "pipe")
    writer = threading.Timer(0.5 if late else 0.0, (tmp_path / "pipe").write_text, [text])
    writer.start()
    if late:
        with pytest.warns(UserWarning, match="pipe is a pipe: waiting until something is written"):
            data = read_toml(tmp_path / "pipe", "pipe", options)
    else:
        data = read_toml(tmp_path / "pipe", "pipe", options)
    writer.join()
    assert scene_from_dict(data).modal.dofs == ("u", "v", "w.x")


def test_a_scene_imports_no_more_than_numpy():
    heavy = ("scipy", "click", "xarray", "matplotlib", "netCDF4", "pandas")
    code = f"import sys, fcm; fcm.load_scene('yang1998'); print([m for m in {heavy} if m in sys.modules])"
    assert python("-c", code).out == "[]\n"
