"""Universal files as programs write them; those from pyuff's test data (ladisk/pyuff, MIT) are named so."""

from __future__ import annotations

from math import pi

import numpy as np
import pytest

from fcm.model.question import Question
from fcm.scene import SceneError, scene_from_dict

# From pyuff's test data: uff55_translation.uff, its first two modes.
TRANSLATION = """\
    -1
    55
NONE
NONE
NONE
NONE
NONE
         1         2         2         8         2         3
         2         4         1         1
  1.00000e+01  0.00000e+00  0.00000e+00  0.00000e+00
         1
 -1.46518e+00 -1.46518e+00 -1.46518e+00
         2
  1.50162e-01  1.50162e-01  1.50162e-01
    -1
    -1
    55
NONE
NONE
NONE
NONE
NONE
         1         2         2         8         2         3
         2         4         1         2
  1.20000e+01  0.00000e+00  0.00000e+00  0.00000e+00
         1
  1.82904e+00  1.82904e+00  1.82904e+00
         2
 -3.98226e-02 -3.98226e-02 -3.98226e-02
    -1
"""

# The head of a mode of pyuff's NX_simulation_output.uff (Simcenter), with values of our own.
NX = """\
    -1
   164
         5mm (milli-newton)            2
  1.00000000000000000D+03  1.00000000000000000D+03  1.00000000000000000D+00
  2.73149999999999977D+02
    -1
    -1
  2414
         1
Mode shape record 1
         1
NONE
NONE
NONE
NONE
NONE
         1         2         2         8         5         3
         0         0         1         0         0         1         0         0
         0         0
  0.00000E+00  2.33832E+04  0.00000E+00  {mass}  2.00000E-02  1.00000E-02
  0.00000E+00  0.00000E+00  0.00000E+00  0.00000E+00  0.00000E+00  0.00000E+00
      3992
  {values}
    -1
"""

# The head of a mode of pyuff's 2411_and_2414.uff (PERMAS), with values of our own.
PERMAS = """\
    -1
  2414
         1
STEP_1
         1
Project:    tulay_01
Component:  DFLT_COMP       Situation:  STEP_1
12-Jul-21   09:16:13        Coordinate System:  component
Result File written by Permas Version 18.00.405     on Linux-x86_64-3.1
Mode shapes                             Column 1
         1         2         3         8         2         6
         0         0         1         0         0         1         0         0
         0         0
  0.00000E+00  9.56363E-01  0.00000E+00  0.00000E+00  0.00000E+00  0.00000E+00
  0.00000E+00  0.00000E+00  0.00000E+00  0.00000E+00  0.00000E+00  0.00000E+00
         1
 -4.37263E-18 -8.53725E-18 -7.08571E-01 -4.18149E-02  1.00000E+00 -0.00000E+00
         2
 -1.53426E-01-8.00098E-02 -6.58571E-01 -4.26430E-02  9.99891E-01 -0.00000E+00
    -1
"""


def read(folder, text, dof, **modal):
    (folder / "m.uff").write_text(text)
    data = {"modal": {"file": "m.uff", "damping": 0.01} | modal, "frequency_unit": "Hz"}
    response = {"response": {"frequency": [0.5, 1.5]}}
    return scene_from_dict(data | {"force": [{"dof": dof, "amplitude": 1.0}]} | response, "test.toml", folder)


def refused(folder, text):
    with pytest.raises(SceneError) as caught:
        read(folder, text, "1x")
    return str(caught.value)


def nx(values, mass="1.50000E+00"):
    return NX.format(mass=mass, values=values)


def test_dataset_55_without_modal_masses(tmp_path):
    scene = read(tmp_path, TRANSLATION, "1x", mass=1.0)
    assert scene.modal.dofs == ("1x", "1y", "1z", "2x", "2y", "2z")
    assert scene.modal.frequency == pytest.approx([20 * pi, 24 * pi])
    assert scene.modal.shapes[:, 3].tolist() == [0.150162, -0.0398226]
    assert scene.modal.mass.tolist() == [1.0, 1.0] and scene.notes == ()


@pytest.mark.parametrize("text, dof", [(TRANSLATION, "1x"), (PERMAS, "2x")])
def test_shapes_whose_scale_is_not_known_are_refused(tmp_path, text, dof):
    """A shape ten times as large answers a hundred times as much: nothing in the file tells the two apart."""
    with pytest.raises(SceneError) as caught:
        read(tmp_path, text, dof)
    (said,) = caught.value.mistakes
    assert said.startswith('modal.mass: missing; "m.uff" has 0 for the modal mass of each mode')
    assert "Give mass = 1 if they are mass-normalised; else phi^T M phi of each mode" in said


def test_a_modal_mass_that_one_mode_lacks_is_refused(tmp_path):
    """The file's second mode has none: its place is not taken by that of a mass-normalised one."""
    known = TRANSLATION.replace("1.00000e+01  0.00000e+00", "1.00000e+01  2.00000e+00")
    with pytest.raises(SceneError, match=r"modal\.mass\[1\]: must be greater than 0, is 0"):
        read(tmp_path, known, "1x")


def test_shapes_of_the_scene_need_no_modal_masses_of_the_file(tmp_path):
    shapes = [[1.0, 0.0, 0.0, 0.5, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0, 0.5, 0.0]]
    assert read(tmp_path, TRANSLATION, "1x", shapes=shapes).modal.mass.tolist() == [1.0, 1.0]


def test_dataset_2414_of_simcenter(tmp_path):
    """Complex by its numbers, real by its values; with modal mass, damping and units."""
    values = "1.00000E+00  0.00000E+00 -2.50000E-01  0.00000E+00  3.00000E+00  0.00000E+00"
    scene = read(tmp_path, nx(values), "3992x", damping=0.025)
    assert scene.modal.dofs == ("3992x", "3992y", "3992z")
    assert scene.modal.frequency == pytest.approx([2 * pi * 23383.2])
    assert scene.modal.mass.tolist() == [1.5] and scene.modal.shapes.tolist() == [[1, -0.25, 3]]
    assert any('the units of the file are "mm (milli-newton)"' in note for note in scene.notes)


UNITS = """\
    -1
   164
{code:10d}{name:<20}         2
  {length:.17e}  {force:.17e}  1.00000000000000000e+00
  2.73149999999999977e+02
    -1
"""
BEAM = """\
    -1
    55
NONE
NONE
NONE
NONE
NONE
         1         2         3         8         2         6
         2         4         1         1
  1.00000e+00  {mass:.6e}  0.00000e+00  0.00000e+00
         1
  0.00000e+00  1.00000e+00  0.00000e+00  0.00000e+00  0.00000e+00  {turn:.6e}
    -1
"""
METRES = {"code": 1, "name": "SI: Meter (newton)", "length": 1.0, "force": 1.0}
TONNES = {"code": 9, "name": "mm (newton)", "length": 1e3, "force": 1.0}
GRAMS = {"code": 5, "name": "mm (milli-newton)", "length": 1e3, "force": 1e3}


def beam(folder, units, length="", force="", mass=3.0, turn=0.5, modal=()):
    """Modes of a node that moves along y and turns about z, in the units of a file."""
    (folder / "m.uff").write_text(UNITS.format(**units) + BEAM.format(mass=mass, turn=turn))
    named = {key: value for key, value in (("length", length), ("force", force)) if value}
    return scene_from_dict(
        {
            "frequency_unit": "Hz", "units": named,
            "modal": {"file": "m.uff", "damping": 0.01} | dict(modal),
            "force": [{"dof": "1y", "amplitude": 1.0}], "response": {"frequency": [0.5, 1.5]},
        },
        "test.toml",
        folder,
    )  # fmt: skip


@pytest.mark.parametrize(
    ("units", "mass", "turn"), [(TONNES, 3e-3, 0.5e-3), (GRAMS, 3.0, 0.5e-3), (METRES, 3.0, 0.5)]
)
@pytest.mark.parametrize(("length", "force"), [("m", "N"), ("mm", "N"), ("mm", "mN"), ("um", "kN")])
def test_modes_are_the_same_in_whichever_units_a_file_has_them(tmp_path, units, mass, turn, length, force):
    """A mass of 3 kg, whose point turns by 0.5 rad/m, read from files in three systems of units.

    In metres a unit force gives 1 / (m omega^2), and a rotation of 0.5 times that.
    """
    scene = beam(tmp_path, units, length, force, mass, turn)
    metre, newton = {"m": 1.0, "mm": 1e-3, "um": 1e-6}[length], {"N": 1.0, "mN": 1e-3, "kN": 1e3}[force]
    y, turned = (scene.modal.shapes[0, scene.modal.dofs.index(dof)] for dof in ("1y", "1rz"))
    omega = 2.0 * pi
    moved, rotated = y * y / (scene.modal.mass[0] * omega**2), turned * y / (scene.modal.mass[0] * omega**2)
    assert moved * metre / newton == pytest.approx(1.0 / (3.0 * omega**2), rel=1e-12)
    assert rotated / newton == pytest.approx(0.5 / (3.0 * omega**2), rel=1e-12)
    own = 1.0 / units["length"], 1.0 / units["force"]
    assert bool(scene.notes) == (own != pytest.approx((metre, newton)))
    assert all(" is in " in note and f"converted to {length} and {force}" in note for note in scene.notes)


def test_what_is_converted_is_said(tmp_path):
    (note,) = beam(tmp_path, TONNES, "m", "N").notes
    said = 'm.uff is in "mm (newton)", converted to m and N: modal masses times 1000, rotations times 1000'
    assert note == f"modal: {said}"
    (note,) = beam(tmp_path, GRAMS, "m", "N", turn=0.0).notes
    assert note.endswith('"mm (milli-newton)", converted to m and N, in which its numbers are the same')


def test_units_of_a_file_that_cannot_be_compared_are_said_or_asked_about(tmp_path):
    """Nothing is converted with one unit of two; where that one differs it is asked."""
    plain, same, other = (beam(tmp_path, TONNES, length) for length in ("", "mm", "m"))
    assert all("the scene's must be the same" in one.notes[0] for one in (plain, same))
    assert not any(isinstance(one.notes[0], Question) for one in (plain, same))
    assert isinstance(other.notes[0], Question) and "is the scene, too?" in other.notes[0]
    assert [one.modal.mass.tolist() for one in (plain, same, other)] == [[3.0]] * 3


def test_masses_of_the_scene_beside_shapes_in_other_units(tmp_path):
    """Mass-normalised in tonnes: 1 there is 1000 in kg."""
    with pytest.raises(SceneError, match=r"Give mass = 1000 if they are mass-normalised"):
        beam(tmp_path, TONNES, "m", "N", mass=0.0)
    given = beam(tmp_path, TONNES, "m", "N", mass=0.0, modal={"mass": 1000.0})
    asked = [note for note in given.notes if isinstance(note, Question)]
    assert given.modal.mass.tolist() == [1000.0] and "a mass of 1 is 1000 here" in asked[0]


def test_a_shape_of_one_phase_is_turned_to_be_real(tmp_path):
    values = "6.00000E-01  8.00000E-01 -1.20000E+00 -1.60000E+00  3.00000E-01  4.00000E-01"
    shape = read(tmp_path, nx(values), "3992x").modal.shapes[0]
    assert np.abs(shape) == pytest.approx([1.0, 2.0, 0.5]) and shape[0] * shape[1] < 0 < shape[0] * shape[2]


def test_a_shape_of_several_phases_is_refused(tmp_path):
    values = "1.00000E+00  0.00000E+00  0.00000E+00  1.00000E+00  3.00000E+00  0.00000E+00"
    assert "its normal mode 1 is complex; a real one is needed" in refused(tmp_path, nx(values))


def test_dataset_2414_of_permas(tmp_path):
    """Six values a node, numbers without a space between them, no modal mass."""
    scene = read(tmp_path, PERMAS, "2x", mass=1.0)
    assert len(scene.modal.dofs) == 12 and scene.modal.dofs[:2] == ("1x", "1y")
    assert scene.modal.shapes[0, scene.modal.dofs.index("2y")] == -0.0800098


DOUBLE = [[-0.25, 1.0 / 3.0, -0.70857123456789012, 1e-101, 1.0, 0.0], [0.1, 0.2, 0.3, 0.4, 0.5, 0.6]]


@pytest.mark.parametrize("per_line", [3, 6])
def test_dataset_2414_in_double_precision(tmp_path, per_line):
    """Six values at a node, on a line or on two; real, and the same as complex ones without a phase."""
    scenes = []
    for kind, shapes in ((4, DOUBLE), (6, [[v for one in row for v in (one, 0.0)] for row in DOUBLE])):
        lines = PERMAS.splitlines()[:15]
        lines[10] = lines[10].replace("8         2", f"8         {kind}")
        for node, row in enumerate(shapes, 1):
            lines.append(f"{node:10d}")
            texts = [f"{v:26.16E}".replace("E-101", "-101") for v in row]
            lines += ["".join(texts[i : i + per_line]) for i in range(0, len(row), per_line)]
        scenes.append(read(tmp_path, "\n".join([*lines, "    -1", ""]), "1x", mass=1.0))
    for scene in scenes:
        assert scene.modal.shapes.reshape(2, 6).tolist() == pytest.approx(np.array(DOUBLE), rel=1e-15)
    text = (tmp_path / "m.uff").read_text().splitlines()
    del text[17]  # a line of values: what is next is no value
    assert "values at node 1 are 12" in refused(tmp_path, "\n".join(text))


def test_fewer_values_on_a_line_are_of_double_precision_alone(tmp_path):
    values = " -4.37263E-18 -8.53725E-18 -7.08571E-01"
    assert "values at node 1 are 6" in refused(tmp_path, PERMAS.replace(f"{values} -4.", f"{values}\n -4."))


def test_damping_viscous_and_half_of_the_hysteretic(tmp_path):
    text = nx("1.0 0.0 0.0 0.0 0.0 0.0")
    (tmp_path / "m.uff").write_text(text)
    data = {"modal": {"file": "m.uff"}, "force": [{"dof": "3992x", "amplitude": 1.0}]}
    scene = scene_from_dict(data | {"response": {"frequency": [0.5, 1.5]}}, "test.toml", tmp_path)
    assert scene.modal.damping == pytest.approx([0.025])


def block(number, *lines):
    return "\n".join(["    -1", f"{number:>6}", *lines, "    -1", ""])


def changed(text, old, new):
    """A text with integers in columns of ten changed."""
    columns = ["".join(f"{word:>10}" for word in words.split()).lstrip() for words in (old, new)]
    assert columns[0] in text
    return text.replace(*columns)


@pytest.mark.parametrize(
    "text, words",
    [
        ("", "it has no normal mode; it holds no dataset at all"),
        (
            block("58", *["NONE"] * 5, "    4         0    0         0 NONE", "1 2") * 4,
            "it has no normal mode; it holds 58 ×4: frequency response functions",
        ),
        (block("58b", *["NONE"] * 5, "    1         0", "1 2"), "58b ×1: time responses"),
        (block("151", "x") + block("82", "x") * 3, "it holds 151 ×1: header; 82 ×3: trace lines"),
        (block("999", "x"), "999 ×1: of another kind"),
        (changed(TRANSLATION, "1 2 2 8", "1 3 2 8"), "55 ×2: complex modes"),
        (changed(PERMAS, "3 8 2 6", "3 2 2 6"), "normal modes, stress"),
        (PERMAS.replace("STEP_1\n         1\n", "STEP_1\n         2\n"), "displacement, not at nodes"),
        (changed(PERMAS, "1 2 3 8", "1 1 1 5"), "2414 ×1: static, temperature"),
        (TRANSLATION.replace("1.82904e+00", "1.82x04e+00", 1), "its normal mode 2 is damaged"),
        (changed(PERMAS, "8 2 6", "8 2 7"), "it has 7 values at a node"),
    ],
)  # fmt: skip
def test_files_without_modes_say_what_they_hold(tmp_path, text, words):
    assert words in refused(tmp_path, text)


def test_every_damaged_mode_is_said(tmp_path):
    twice = TRANSLATION.replace("1.82904e+00", "1.82x04e+00", 1).replace("1.50162e-01", "1.5x162e-01", 1)
    said = refused(tmp_path, twice)
    assert said.count("is damaged") == 2 and "m.uff" in said


def test_a_mode_that_is_there_twice_is_refused(tmp_path):
    """As in a file that has its modes in datasets of both kinds: each would answer for itself."""
    said = refused(tmp_path, TRANSLATION + TRANSLATION)
    assert "its normal modes 1 and 3 are the same" in said and "modes 2 and 4 are the same" in said
    assert "the same" not in refused(tmp_path, TRANSLATION.replace("1.50162e-01", "1.5x162e-01", 1))


@pytest.mark.parametrize("lines", [5, 14, 18, 29])
def test_a_file_that_is_cut_off_within_a_dataset_is_refused(tmp_path, lines):
    """What of it is whole would be fewer modes than it has had, without a word."""
    (tmp_path / "cut.uff").write_text("\n".join(TRANSLATION.splitlines()[:lines]) + "\n")
    data = {
        "modal": {"file": "cut.uff", "damping": 0.01},
        "force": [{"dof": "1x", "amplitude": 1.0}],
        "response": {"frequency": [1.0, 100.0]},
    }
    with pytest.raises(SceneError, match='it is cut off within a dataset "55"'):
        scene_from_dict(data, "test.toml", tmp_path)


TIMES = """\
    58{b}     {order}     2          11{bytes:>12}     0     0           0           0
NONE
    -1
NONE
NONE
NONE
    1         0    0         0  NONE               1   0       NONE         0   0
         4       {points:>3}         1  0.00000e+00  1.00000e-02  0.00000e+00
        17    0    0    0 time (s)             s
        12    0    0    0 acc (g)              g
         0    0    0    0 NONE                 NONE
         0    0    0    0 NONE                 NONE
"""


def times(order=1, size=None, more=b""):
    """A binary dataset 58 whose numbers hold all that could be taken for lines, and marks among them."""
    values = (
        np.arange(40.0).astype("<f8" if order == 1 else ">f8").tobytes()
        + b"\n    -1\n    55\n\n\r\n    -1 \n"
    )
    values += bytes(-len(values) % 8)
    size = len(values) if size is None else size
    head = TIMES.format(b="b", order=order, bytes=size, points=len(values) // 8)
    return b"    -1\n" + head.encode() + values + more + b"\n    -1\n"


def read_bytes(folder, content, dof="1x"):
    (folder / "m.uff").write_bytes(content)
    modal = {"file": "m.uff", "damping": 0.01, "mass": 1.0}
    data = {"modal": modal, "force": [{"dof": dof, "amplitude": 1.0}]}
    return scene_from_dict(data | {"response": {"frequency": [0.5, 1.5]}}, "test.toml", folder)


@pytest.mark.parametrize("order", [1, 2])
@pytest.mark.parametrize("size", [None, 0, 17])
def test_modes_beside_a_binary_dataset(tmp_path, order, size):
    """It is passed by its bytes, or by its points where that number is wrong; before and behind modes."""
    modes, binary = TRANSLATION.encode(), times(order, size)
    alone = read_bytes(tmp_path, modes).modal
    for content in (binary + modes, modes + binary, binary + modes + binary, binary + binary + modes):
        modal = read_bytes(tmp_path, content).modal
        assert modal.frequency.tolist() == alone.frequency.tolist()
        assert modal.shapes.tolist() == alone.shapes.tolist()


def test_a_binary_dataset_whose_bytes_are_more_than_all_that_it_says(tmp_path):
    """As after a conversion of line ends: the mark that another dataset follows is its end."""
    content = times(size=5, more=bytes(33)) + TRANSLATION.encode()
    assert read_bytes(tmp_path, content).modal.frequency == pytest.approx([20 * pi, 24 * pi])


def test_a_binary_dataset_alone_is_listed_and_a_cut_one_is_said(tmp_path):
    with pytest.raises(SceneError, match=r"holds 58b ×2: time responses\. A mode is a dataset 55 or 2414"):
        read_bytes(tmp_path, times(1) + times(2))
    with pytest.raises(SceneError, match='line 2, it is cut off within a dataset "58b"'):
        read_bytes(tmp_path, times()[:-60])


def test_a_mark_among_the_words_at_the_head_of_a_dataset(tmp_path):
    """As pyuff's dataset_milestone_in_header.uff has one."""
    modes = read(tmp_path, TRANSLATION.replace("NONE", "    -1", 1), "1x", mass=1.0).modal
    assert modes.frequency == pytest.approx([20 * pi, 24 * pi])


@pytest.mark.parametrize("begin", ["\ufeff", "\n\n", "\ufeff\n"])
@pytest.mark.parametrize("line", range(30))
def test_blank_lines_and_a_byte_order_mark_change_nothing(tmp_path, begin, line):
    lines = TRANSLATION.splitlines()
    lines.insert(line, "" if line % 2 else "   ")
    modal = read(tmp_path, begin + "\n".join(lines), "1x", mass=1.0).modal
    assert modal.frequency == pytest.approx([20 * pi, 24 * pi])
    assert modal.shapes[:, 3].tolist() == [0.150162, -0.0398226]


@pytest.mark.parametrize("line", range(17))
def test_blank_lines_in_dataset_2414(tmp_path, line):
    lines = PERMAS.splitlines()
    lines.insert(line, "")
    assert read(tmp_path, "\n".join(lines), "2x", mass=1.0).modal.shapes[0, 6] == -0.153426


@pytest.mark.parametrize(
    "written, value",
    [
        ("1.50162-101", 1.50162e-101),
        ("1.50162D-01", 0.150162),
        ("1.50162d-1", 0.150162),
        ("1.50162E-01-2.00000-100", 0.150162),
        (".5", 0.5),
    ],
)
def test_exponents_as_fortran_writes_them(tmp_path, written, value):
    rest = "" if "-100" in written else "  1.50162e-01"
    text = TRANSLATION.replace("  1.50162e-01  1.50162e-01  1.50162e-01", f"  {written}{rest} 1.50162e-01", 1)
    assert read(tmp_path, text, "1x", mass=1.0).modal.shapes[0, 3] == value


@pytest.mark.parametrize(
    "old, new, words",
    [
        ("1.82904e+00", "1,82904", 'is no line of numbers: "1,82904" has a decimal comma: write 1.82904'),
        ("1.82904e+00", "1.82904mm", '"1.82904mm" has "mm" behind the number: write 1.82904'),
        ("1.82904e+00", "nan", '"nan" is not a number'),
        ("1.82904e+00", "1e999", '"1e999" is too large for a number'),
        (
            "1.82904e+00  1.82904e+00  1.82904e+00",
            "1.82904e+001.82904e+00  1.82904e+00",
            "is no line of numbers",
        ),
        ("  1.82904e+00\n         2", "\n         2", "and the values at node 1 are 3"),
        ("  1.82904e+00\n         2", "  1.82904e+00 1.0 2.0\n         2", "has 5 numbers"),
        ("         2\n -3.98226e-02", "         1\n -3.98226e-02", "it has node 1 twice"),
        ("         2\n -3.98226e-02", "      2.x\n -3.98226e-02", '"2.x", is no line of whole numbers'),
        (
            "  1.20000e+01  0.00000e+00",
            "  1.20000e+01",
            "has 3 numbers, and the mode's frequency and damping are 4",
        ),
        (
            "         2         4         1         2",
            "         2         0         1         2",
            "is damaged: ",
        ),
    ],
)
def test_a_damaged_mode_names_its_line(tmp_path, old, new, words):
    said = refused(tmp_path, TRANSLATION.replace(old, new, 1))
    assert "its normal mode 2 is damaged: " in said and words in said
    assert "argument" not in said and "literal" not in said


def test_text_outside_of_datasets_may_be_one_that_has_lost_its_mark(tmp_path):
    lines = TRANSLATION.splitlines()
    assert lines[15] == "    -1"
    del lines[15]
    assert 'line 16, "55", is outside of the datasets' in refused(tmp_path, "\n".join(lines))
