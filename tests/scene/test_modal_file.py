"""Modes from files, as their own writers write them."""

from __future__ import annotations

import shutil
from math import pi
from pathlib import Path

import numpy as np
import pytest
from scipy.io import savemat

from fcm.model.question import Question
from fcm.scene import SceneError, scene_from_dict

HERE = Path(__file__).parent
MODES = {
    "dofs": np.array(["u", "v", "w.x"]),
    "mass": np.array([1.0, 2.0]),
    "frequency": np.array([1.0, 10.0]),
    "damping": np.array([0.01, 0.02]),
    "shapes": np.array([[0.7, 0.7, 0.1], [1.0, -0.5, 0.2]]),
}
FORCE = [{"dof": "u", "amplitude": 1.0}]


def save_npz(path, modes):
    np.savez(path, **modes)


def save_mat(path, modes):
    savemat(path, modes)


def save_mat_4(path, modes):
    savemat(path, modes, format="4")


def save_cells(path, modes):
    savemat(path, modes | {"dofs": np.array(modes["dofs"], dtype=object)}, oned_as="column")


WRITERS = [(save_npz, "m.npz"), (save_mat, "m.mat"), (save_mat_4, "m.mat"), (save_cells, "M.MAT")]


def scene_of(folder, name, force=FORCE, **keys):
    top = {"frequency_unit": keys.pop("unit", "rad/s")}
    modal = {"file": name, **keys}
    data = {"modal": modal, "force": force, "response": {"frequency": [0.5, 1.5]}, **top}
    return scene_from_dict(data, "test.toml", folder)


@pytest.mark.parametrize("save, name", WRITERS)
def test_a_round_trip(tmp_path, save, name):
    save(tmp_path / name, MODES)
    modal = scene_of(tmp_path, name).modal
    assert modal.dofs == ("u", "v", "w.x")
    for key in ("mass", "frequency", "damping", "shapes"):
        assert np.array_equal(getattr(modal, key), MODES[key])


@pytest.mark.parametrize("save, name", WRITERS)
def test_one_mode_one_damping_and_no_mass(tmp_path, save, name):
    modes = {
        "dofs": MODES["dofs"],
        "frequency": np.array([1.0]),
        "shapes": MODES["shapes"][:1],
        "damping": 0.01,
    }
    save(tmp_path / name, modes)
    modal = scene_of(tmp_path, name).modal
    assert (modal.mass, modal.frequency, modal.damping) == ([1], [1], [0.01])
    assert modal.shapes.shape == (1, 3)


@pytest.mark.parametrize("save, name", WRITERS)
def test_one_damping_for_all_modes_and_integers(tmp_path, save, name):
    save(tmp_path / name, MODES | {"damping": 0.05, "mass": np.array([3, 4])})
    modal = scene_of(tmp_path, name, unit="Hz").modal
    assert modal.damping.tolist() == [0.05, 0.05] and modal.mass.tolist() == [3, 4]
    assert modal.frequency == pytest.approx([2 * pi, 20 * pi])


def test_keys_of_the_scene_go_before_those_of_the_file(tmp_path):
    np.savez(tmp_path / "m.npz", **MODES)
    modal = scene_of(tmp_path, "m.npz", damping=0.3, dofs=["u", "b", "c"]).modal
    assert modal.damping.tolist() == [0.3, 0.3] and modal.dofs == ("u", "b", "c")


def test_numbers_from_a_file_can_be_swept(tmp_path):
    np.savez(tmp_path / "m.npz", **MODES)
    modal = {"file": "m.npz"}
    data = {"modal": modal, "force": FORCE, "response": {"frequency": [0.5, 1.5]}}
    curves = scene_from_dict(data | {"sweep": {"modal.shapes.1.w.x": [3, 4]}}, "test", tmp_path).curves
    assert [curve.modal.shapes[1, 2] for curve in curves] == [3, 4]


@pytest.mark.slow
def test_arrays_under_names_that_are_no_keys_are_named_where_one_lacks(tmp_path):
    other = {"f_n": MODES["frequency"], **{key: MODES[key] for key in ("dofs", "damping", "shapes")}}
    for save, name in WRITERS:
        save(tmp_path / name, other)
        with pytest.raises(
            ValueError, match=rf'modal\.file: "f_n" of {name} is not used, but there is no freq'
        ):
            scene_of(tmp_path, name)
    assert scene_of(tmp_path, "m.npz", frequency=[1.0, 2.0]).notes == ('modal: "f_n" of m.npz is not used',)


def test_a_universal_file_is_in_hertz(tmp_path):
    shutil.copy(HERE / "two_modes.uff", tmp_path)
    force = [{"dof": "12x", "amplitude": 1.0}]
    modal = scene_of(tmp_path, "two_modes.uff", force).modal
    assert modal.dofs == ("1x", "1y", "1z", "12x", "12y", "12z")
    assert modal.frequency == pytest.approx([20 * pi, 51 * pi])
    assert modal.mass.tolist() == [1.5, 2.5] and modal.damping.tolist() == [0.01, 0.02]
    assert modal.shapes.tolist() == [[0.5, 0.25, 0, -1, 0.125, 2], [1, -0.5, 0, 0.75, 0, -0.25]]
    hertz = scene_of(tmp_path, "two_modes.uff", force, unit="Hz").modal
    assert hertz.frequency == pytest.approx(modal.frequency, rel=1e-15)


def test_a_universal_file_with_less_and_with_more(tmp_path):
    """No damping, six values a node over one line, FORTRAN exponents, a node that does not move."""
    head = ["    -1", "    55", *["NONE"] * 5, "         1         2         3         8         2         6"]
    real = "".join(f"{value:13.5E}" for value in (2.0, 0.0, 0.0, 0.0))
    node = "".join(f"{value:13.5E}" for value in range(6)).replace("E", "D")
    tail = ["         2         4         1         1", real]
    first = [*head, *tail, "         7", node, "    -1"]
    second = [*head, *tail, "         8", node, "    -1"]
    (tmp_path / "m.unv").write_text("\r\n".join([*first, *second]))
    scene = scene_of(tmp_path, "m.unv", [{"dof": "7rx", "amplitude": 1}], damping=0.01, mass=1.0)
    said = [note for note in scene.notes if "has no value at" in note]
    assert len(said) == 2 and 'mode 2 of m.unv has no value at "7x", "7y", "7z", ... (6 in all)' in said[1]
    modal = scene.modal
    assert modal.dofs[:6] == ("7x", "7y", "7z", "7rx", "7ry", "7rz")
    assert modal.shapes.tolist() == [[0, 1, 2, 3, 4, 5, 0, 0, 0, 0, 0, 0], [0] * 6 + [0, 1, 2, 3, 4, 5]]
    assert modal.mass.tolist() == [1, 1]
    with pytest.raises(ValueError, match=r"modal\.damping: missing"):
        scene_of(tmp_path, "m.unv", [{"dof": "7rx", "amplitude": 1}], mass=1.0)


@pytest.mark.parametrize(
    "name, content, words",
    [
        ("gone.npz", None, 'modal.file: "[^"]*gone.npz" is not there'),
        ("m.txt", b"", r'modal.file: "m.txt" cannot be read: a file of modes is .npz, .mat, .uff, .unv'),
        ("m.npz", b"", "modal.file: .* cannot be read"),
        ("m.npz", b"rubbish", "modal.file: .* cannot be read"),
        ("m.npz", b"PK\x03\x04rubbish", "modal.file: .* cannot be read"),
        ("m.mat", b"", "modal.file: .* cannot be read"),
        ("m.mat", b"rubbish" * 100, "modal.file: .* cannot be read"),
        (
            "m.mat",
            b"MATLAB 7.3 MAT-file".ljust(124) + b"\x00\x02IM" + bytes(100),
            "it is damaged, or no .mat file",
        ),
        ("m.uff", b"", "modal.file: .* it has no normal mode"),
        ("m.uff", bytes(range(256)), "modal.file: .* it has no normal mode"),
    ],
)
def test_files_that_hold_no_modes(tmp_path, name, content, words):
    if content is not None:
        (tmp_path / name).write_bytes(content)
    with pytest.raises(ValueError, match=words):
        scene_of(tmp_path, name)


def test_a_damaged_mode_is_named(tmp_path):
    text = (HERE / "two_modes.uff").read_text()
    (tmp_path / "m.uff").write_text(text.replace("-5.00000e-01", "-5.00x00e-01"))
    with pytest.raises(ValueError, match="its normal mode 2 is damaged"):
        scene_of(tmp_path, "m.uff")


def test_a_folder_and_a_name_that_is_no_string(tmp_path):
    (tmp_path / "m.npz").mkdir()
    with pytest.raises(ValueError, match=r'modal\.file: "[^"]*m\.npz" is a folder'):
        scene_of(tmp_path, "m.npz")
    with pytest.raises(ValueError, match=r"modal\.file: must be a string, is 3"):
        scene_of(tmp_path, 3)
    with pytest.raises(ValueError, match=r"modal.file"):
        scene_of(tmp_path, "a\0.npz")


def test_pickles_are_not_read(tmp_path):
    np.savez(tmp_path / "m.npz", **(MODES | {"dofs": np.array(["u", None], dtype=object)}))
    with pytest.raises(ValueError, match=r"modal\.file: .* cannot be read: Object arrays cannot be loaded"):
        scene_of(tmp_path, "m.npz")


@pytest.mark.parametrize(
    "change, words",
    [
        (
            {"shapes": MODES["shapes"].T},
            "modal.shapes: has 3 rows of 2 numbers, but .* 2 modes and 3 dofs: transpose",
        ),
        ({"frequency": np.array([1.0, -1.0])}, r"modal.frequency\[1\]: must be at least 0"),
        ({"frequency": np.array([1j, 1.0])}, "frequency must hold real numbers, and holds complex ones"),
        ({"frequency": np.array([[1.0, 1.0]])}, r"modal.frequency\[0\]: must be a number"),
        ({"mass": np.array(["a", "b"])}, "mass must hold real numbers, and holds words"),
        ({"shapes": np.array([[1, 2, np.nan]] * 2)}, r"modal.shapes\[0\]\[2\]: must be finite"),
        ({"shapes": np.array([1.0, 2.0])}, "modal.shapes: must be a list of lists"),
    ],
)
def test_arrays_of_a_file_are_checked_like_lists(tmp_path, change, words):
    np.savez(tmp_path / "m.npz", **(MODES | change))
    with pytest.raises(ValueError, match=words):
        scene_of(tmp_path, "m.npz")


def test_a_file_without_shapes(tmp_path):
    np.savez(tmp_path / "m.npz", **{key: MODES[key] for key in ("dofs", "frequency", "damping")})
    with pytest.raises(ValueError, match=r"modal\.shapes: missing"):
        scene_of(tmp_path, "m.npz")


def test_a_large_file_is_read_in_a_moment(tmp_path):
    dofs = [f"node{i}" for i in range(20_000)]
    shapes = np.random.default_rng(0).normal(size=(20, 20_000))
    np.savez(tmp_path / "m.npz", dofs=dofs, frequency=np.arange(1, 21.0), damping=0.01, shapes=shapes)
    scene = scene_of(tmp_path, "m.npz", [{"dof": "node7", "amplitude": 1}])
    assert scene.modal.shapes.shape == (20, 20_000)


@pytest.mark.slow
@pytest.mark.parametrize("save, name", WRITERS)
def test_a_modal_mass_under_another_name_is_used_and_said(tmp_path, save, name):
    """Shapes scaled to 1 and read without their masses gave 845 Hz for 590 without a word."""
    modes = {key: value for key, value in MODES.items() if key != "mass"}
    save(tmp_path / name, modes | {"modal_mass": MODES["mass"]})
    scene = scene_of(tmp_path, name)
    assert scene.modal.mass.tolist() == [1.0, 2.0]
    assert scene.notes == (f'modal: "modal_mass" of {name} is taken as mass',)
    save(tmp_path / name, MODES | {"modal_mass": MODES["mass"]})
    with pytest.raises(ValueError, match='has "mass" and "modal_mass"; keep one'):
        scene_of(tmp_path, name)


@pytest.mark.slow
@pytest.mark.parametrize("other", ["mass_of_mode", "m"])
@pytest.mark.parametrize("save, name", WRITERS)
def test_what_may_be_a_modal_mass_is_refused(tmp_path, save, name, other):
    modes = {key: value for key, value in MODES.items() if key != "mass"}
    save(tmp_path / name, modes | {other: MODES["mass"]})
    with pytest.raises(ValueError, match=f'has "{other}", which may be the modal mass'):
        scene_of(tmp_path, name)
    save(tmp_path / name, MODES | {other: MODES["mass"]})
    assert any("not used" in note for note in scene_of(tmp_path, name).notes)


@pytest.mark.parametrize("save, name", WRITERS)
def test_what_is_not_used_is_said(tmp_path, save, name):
    save(tmp_path / name, MODES | {"m": np.array([3.0, 4.0])})
    assert scene_of(tmp_path, name).notes == (f'modal: "m" of {name} is not used',)


def test_shapes_scaled_to_one_without_their_masses(tmp_path):
    modes = {key: value for key, value in MODES.items() if key != "mass"}
    np.savez(tmp_path / "m.npz", **(modes | {"shapes": np.array([[1.0, 0.2, 0.3], [0.1, -1.0, 0.5]])}))
    (note,) = scene_of(tmp_path, "m.npz").notes
    assert isinstance(note, Question) and "scaled to a largest value of 1. Are they mass-normal" in note
    assert scene_of(tmp_path, "m.npz", mass=[0.3, 0.4]).notes == ()
    np.savez(tmp_path / "m.npz", **modes)
    assert scene_of(tmp_path, "m.npz").notes == ()


def test_all_faults_of_a_file_are_said_at_once(tmp_path):
    faulty = MODES | {"zeta": MODES["damping"], "omega": MODES["frequency"], "Mass": MODES["mass"]}
    faulty["shapes"] = MODES["shapes"] + 0.1j
    del faulty["mass"]
    np.savez(tmp_path / "m.npz", **faulty)
    with pytest.raises(SceneError) as caught:
        scene_of(tmp_path, "m.npz", title=3)
    for words in (
        'has "damping" and "zeta"; keep one',
        "has frequency and angular_frequency; keep one",
        'has "Mass", which may be the modal mass',
        "shapes must hold real numbers",
        "modal.title: unknown key",
    ):
        assert words in str(caught.value)


def test_lengths_are_said_beside_other_faults(tmp_path):
    np.savez(tmp_path / "m.npz", **MODES | {"zeta": 0.1, "frequency": np.array([1.0, 2.0, 3.0])})
    with pytest.raises(SceneError) as caught:
        scene_of(tmp_path, "m.npz")
    for key in ("mass", "damping", "shapes"):
        assert f"its {key} is of 2 modes, its frequency of 3" in str(caught.value)


def test_names_of_bytes_and_numbers_of_another_byte_order(tmp_path):
    """As h5py and Fortran programs hand them to numpy."""
    modes = {key: one if key == "dofs" else one.astype(">f8") for key, one in MODES.items()}
    save_npz(tmp_path / "m.npz", modes | {"dofs": MODES["dofs"].astype("S")})
    modal = scene_of(tmp_path, "m.npz").modal
    assert modal.dofs == ("u", "v", "w.x")
    assert np.array_equal(modal.shapes, MODES["shapes"])


@pytest.mark.parametrize("name", ["modes", "model"])
def test_a_struct_is_named_as_one(tmp_path, name):
    savemat(tmp_path / "m.mat", {name: MODES})
    with pytest.raises(SceneError, match=f'm.mat" cannot be read: "{name}" is a struct: save its'):
        scene_of(tmp_path, "m.mat")


@pytest.mark.parametrize(("high", "said"), [(12.0, True), (8.0, False)])
def test_a_range_beyond_the_highest_mode_asks_for_more_modes(high, said):
    """Six of twelve modes gave a peak 30 % too low, with an error of 5e-3 told."""
    contact = {"name": "c", "tangential": "u", "normal": "v", "mu": 0.3, "k_u": 1.0, "k_v": 1.0, "n_0": 1.0}
    modal = {key: value.tolist() for key, value in MODES.items()}
    data = {"modal": modal, "contact": [contact], "force": FORCE, "response": {"frequency": [0.5, high]}}
    assert any("is a mode missing?" in note for note in scene_from_dict(data).notes) == said
    square = modal | {"dofs": ["u", "v"], "shapes": [row[:2] for row in modal["shapes"]]}
    assert not any("is a mode missing?" in note for note in scene_from_dict(data | {"modal": square}).notes)
