"""The [fit] table of a scene, and the files of measured points that it names."""

import csv
import struct

import numpy as np
import pytest

from fcm.model.question import Question
from fcm.plot.errors import PlotError
from fcm.plot.measured import read_measured_points
from fcm.scene import SceneError
from fcm.scene.load import load_scene

from ..oscillator import oscillator
from ..program import called

RANGE = "[response]\nfrequency = [0.7, 1.7]\n"
FIT = '[fit]\nvary = ["contact.shroud.mu"]\n[[fit.data]]\nfile = "a.csv"\ndof = "u"\n'
POINTS = "frequency,amplitude\n0.9,1.5\n1.1,2.5\n1.3,1.0\n"


@pytest.fixture
def written(tmp_path):
    """Writes a scene with a [fit] and a file beside it; gives the path of the scene."""

    def write(fit=FIT, points=POINTS, name="a.csv", scene=None):
        content = points if isinstance(points, bytes) else points.encode()
        (tmp_path / name).write_bytes(content)
        path = tmp_path / "scene.toml"
        path.write_text((oscillator(RANGE) if scene is None else scene) + fit)
        return path

    return write


def mistakes(path):
    with pytest.raises(SceneError) as caught:
        load_scene(path)
    return str(caught.value)


def test_what_is_read(written):
    fit = (
        FIT.replace("vary", "bounds = [[0.1, 1.0]]\nvary")
        + 'level = 2.0\nquantity = "velocity"\namplitude_error = 0.03\n'
    )
    points = "# of a sweep\namplitude;frequency;phase;weight\n1.5;0.9;0.1;1\n2.5;1.1;-1.5;0.5\n"
    found = load_scene(written(fit, points)).fit
    assert (found.vary, found.bounds) == (("contact.shroud.mu",), ((0.1, 1.0),))
    (one,) = found.data
    assert one.frequency.tolist() == [0.9, 1.1] and one.amplitude.tolist() == [1.5, 2.5]
    assert one.phase.tolist() == [0.1, -1.5] and one.weight.tolist() == [1.0, 0.5]
    assert one.level.tolist() == [2.0, 2.0] and one.quantity == "velocity" and one.amplitude_error == 0.03


def test_points_of_weight_0_are_left_out(written):
    """Their errors were infinite."""
    points = "frequency,amplitude,phase,weight\n0.9,1.5,0.1,1\n1.0,9.0,0.3,0\n1.1,2.5,-1.5,0.5\n"
    (one,) = load_scene(written(points=points)).fit.data
    assert one.frequency.tolist() == [0.9, 1.1] and one.phase.tolist() == [0.1, -1.5]
    assert one.weight.tolist() == [1.0, 0.5] and one.level.tolist() == [1.0, 1.0]


def test_a_star_stands_for_all_modes(written):
    found = load_scene(written(FIT.replace("contact.shroud.mu", "modal.damping.*"))).fit
    assert found.vary == ("modal.damping.*",)
    with pytest.raises(SceneError, match="sets the same number"):
        load_scene(written(FIT.replace('contact.shroud.mu"', 'modal.damping.*", "modal.damping.0"')))


def test_frequencies_are_in_the_unit_of_the_scene(written):
    scene = 'frequency_unit = "Hz"\n' + oscillator(RANGE)
    (one,) = load_scene(written(scene=scene)).fit.data
    assert one.frequency == pytest.approx(2.0 * np.pi * np.array([0.9, 1.1, 1.3]), rel=1e-15)


def test_data_outside_the_range_are_asked_about(written):
    """Of frequencies in Hz for rad/s the fit ended anywhere, at no effect of its numbers."""
    for points, asked in ((POINTS, False), ("frequency,amplitude\n90,1\n110,2\n", True)):
        notes = load_scene(written(FIT, points)).notes
        said = [
            one for one in notes if one.startswith("fit: a.csv has frequencies from 90 to 110 rad/s, none")
        ]
        assert len(said) == asked


def test_a_column_of_forces_is_a_level_of_each_point(written):
    points = "frequency amplitude F\n0.9 1.5 2.0\n1.1 2.5 1.0\n"
    scene = oscillator(RANGE, amplitude=4.0)
    (one,) = load_scene(written(FIT + 'level = "F"\n', points, scene=scene)).fit.data
    assert one.level.tolist() == [0.5, 0.25]


def test_a_backbone(written):
    fit = '[fit]\nvary = "contact.shroud.k_u"\n[[fit.data]]\nbackbone = "b.csv"\nmode = 2\n'
    (one,) = load_scene(
        written(fit, "amplitude,damping,frequency\n1,0.01,1.2\n2,0.02,1.1\n", "b.csv")
    ).fit.data
    assert one.damping.tolist() == [0.01, 0.02] and one.mode == 2 and one.dof == ""


BACKBONE = '[fit]\nvary = "contact.shroud.k_u"\n[[fit.data]]\nbackbone = "a.csv"\n'


def test_columns_may_have_the_names_that_fcm_gives_them(written):
    points = "curve,frequency [Hz],modal_amplitude,damping_ratio,amplitude u,regime shroud\n"
    points += "0,0.2,1,0.01,0.7,E\n0,0.19,2,0.02,1.4,EPEN\n"
    (one,) = load_scene(written(BACKBONE, points)).fit.data
    assert one.frequency == pytest.approx([0.4 * np.pi, 0.38 * np.pi])
    assert one.amplitude.tolist() == [1.0, 2.0] and one.damping.tolist() == [0.01, 0.02]
    (one,) = load_scene(written(BACKBONE + 'dof = "u"\n', points)).fit.data
    assert one.amplitude.tolist() == [0.7, 1.4] and one.dof == "u"
    (one,) = load_scene(written(FIT, points)).fit.data
    assert one.amplitude.tolist() == [0.7, 1.4]
    own = points.replace("curve", "amplitude").replace("\n0,", "\n5,")
    (one,) = load_scene(written(BACKBONE, own)).fit.data
    assert one.amplitude.tolist() == [5.0, 5.0]  # a column of the documented name goes before another


def test_names_that_are_accepted_are_said(written):
    said = mistakes(written(BACKBONE, "frequency,amplitude,zeta\n1,1,0.01\n0.9,2,0.02\n"))
    assert 'has no column "damping" (or "damping_ratio"); it has "frequency", "amplitude", "zeta"' in said
    several = "curve,frequency,amplitude u\n0,1,2\n1,1,3\n"
    assert "column curve: it has 2 curves; leave the points of one" in mistakes(written(FIT, several))
    of_others = "frequency [orders],amplitude\n1,1\n2,3\n"
    assert 'its frequency is in "orders"; known are "rad/s", "Hz", "kHz", "rpm"' in mistakes(
        written(FIT, of_others)
    )


METRES = oscillator(RANGE, amplitude=2.0) + '[units]\nlength = "m"\nforce = "N"\n'


@pytest.mark.parametrize(
    ("head", "data", "factor", "quantity"),
    [
        ("amplitude", "", 1.0, "displacement"),
        ("amplitude [m]", "", 1.0, "displacement"),
        ("amplitude u [mm]", "", 1e-3, "displacement"),
        ("amplitude [um]", "level = 3.0\n", 1e-6, "displacement"),
        ("amplitude [mm/s]", 'quantity = "velocity"\n', 1e-3, "velocity"),
        ("amplitude [m/s²]", 'quantity = "acceleration"\n', 1.0, "acceleration"),
        ("amplitude [g]", "", 9.80665, "acceleration"),
        ("amplitude [mm/N]", "level = 3.0\n", 6e-3, "displacement"),
        ("amplitude [(in/s)/lbf]", "", 2.0 * 0.0254 / 4.4482216152605, "velocity"),
    ],
)
@pytest.mark.parametrize("phased", [False, True])
def test_amplitudes_of_a_table_in_another_unit_are_converted(written, head, data, factor, quantity, phased):
    """By what its head says, as those of a universal file; another unit of length was refused."""
    more = (",phase", ",0.5", ",-1") if phased else ("", "", "")
    points = f"frequency,{head}{more[0]}\n0.9,1{more[1]}\n1.1,3{more[2]}\n"
    (one,) = load_scene(written(FIT + data, points, scene=METRES)).fit.data
    assert one.amplitude.tolist() == pytest.approx([factor, 3.0 * factor], rel=1e-12)
    assert one.quantity == quantity
    assert one.phase is None if not phased else one.phase.tolist() == pytest.approx([0.5, -1.0])


def test_what_was_converted_is_said_once_and_what_the_scene_does_not_say_is_asked(written):
    points = "frequency,amplitude [mm]\n0.9,1\n1.1,3\n"

    def said(scene):
        return [one for one in load_scene(written(FIT, points, scene=scene)).notes if one.startswith("fit:")]

    assert said(METRES) == ["fit: a.csv is in mm, converted to m"]
    (question,) = said(oscillator(RANGE))
    assert question == (
        "fit: a.csv is in mm: is the scene, too? With its [units] of length and force it is converted"
    )
    assert isinstance(question, Question)


@pytest.mark.parametrize(
    ("head", "data", "words"),
    [
        ("amplitude [V]", "", 'its amplitude is in "V", no unit of a motion that is known. Units are'),
        (
            "amplitude [m/s]",
            'quantity = "displacement"\n',
            'quantity: is "displacement", and "a.csv" says that',
        ),
        ("amplitude [deg]", "", 'is in deg, the unit of a rotation, and "u" is a displacement'),
        ("amplitude [kg]", "", 'its amplitude is in "kg", no unit of a motion'),
    ],
)
def test_units_of_another_quantity_are_refused(written, head, data, words):
    points = f"frequency,{head}\n0.9,1\n1.1,3\n"
    assert words in mistakes(written(FIT + data, points, scene=METRES))


@pytest.mark.parametrize(("head", "size"), [("kHz", 2e3 * np.pi), ("rpm", np.pi / 30.0), ("Hz", 2.0 * np.pi)])
def test_frequencies_of_a_table_in_another_unit_are_converted(written, head, size):
    (one,) = load_scene(written(points=f"frequency [{head}],amplitude\n1,1\n2,3\n")).fit.data
    assert one.frequency.tolist() == pytest.approx([size, 2.0 * size], rel=1e-14)


@pytest.mark.parametrize(("head", "size"), [("F", 1.0), ("F [N]", 1.0), ("F [kN]", 1e3), ("F [V]", None)])
def test_a_column_of_forces_in_another_unit_is_converted(written, head, size):
    """A level of kN was a thousandth of itself."""
    path = written(FIT + 'level = "F"\n', f"frequency,amplitude,{head}\n1,1,4\n2,3,6\n", scene=METRES)
    if size is None:
        assert '"a.csv" has levels in "V", which is no known unit of force' in mistakes(path)
    else:
        assert load_scene(path).fit.data[0].level.tolist() == pytest.approx([2.0 * size, 3.0 * size])


def test_a_backbone_in_another_unit(written):
    points = "frequency,amplitude [{}],damping\n1,1,0.01\n0.9,2,0.02\n"
    of_dof = BACKBONE + 'dof = "u"\n'
    (one,) = load_scene(written(of_dof, points.format("mm"), scene=METRES)).fit.data
    assert one.amplitude.tolist() == pytest.approx([1e-3, 2e-3])
    assert "in mm/N, and a backbone is of" in mistakes(written(of_dof, points.format("mm/N"), scene=METRES))
    assert 'says that it is "velocity"' in mistakes(written(of_dof, points.format("mm/s"), scene=METRES))
    said = mistakes(written(BACKBONE, points.format("mm"), scene=METRES))
    assert 'its amplitude is modal, and in "mm"; give it without' in said


def test_drawn_points_of_a_table_are_in_the_unit_of_the_curves(tmp_path):
    path = tmp_path / "a.csv"
    for head, unit, expected in (
        ("amplitude [mm]", "m", [1e-3, 3e-3]),
        ("amplitude [m]", "m", [1.0, 3.0]),
        ("amplitude", "m", [1.0, 3.0]),
        ("amplitude [m/s]", "mm", [1e3 / 2.0, 3e3 / 4.0]),
    ):
        path.write_text(f"frequency [rad/s],{head}\n2,1\n4,3\n")
        assert read_measured_points(path, "rad/s", unit).amplitude.tolist() == pytest.approx(expected)
    path.write_text("frequency,amplitude [V]\n2,1\n4,3\n")
    with pytest.raises(PlotError, match='its amplitude is in "V", no unit of a motion'):
        read_measured_points(path, "rad/s", "m")


def test_a_unit_in_a_head_is_converted_or_refused(written):
    """A damping in percent was taken for a ratio, and a phase in degrees for one in rad."""
    in_percent = "frequency,amplitude,damping [%]\n1,1,0.5\n0.9,2,2\n"
    (one,) = load_scene(written(BACKBONE, in_percent)).fit.data
    assert one.damping.tolist() == [0.005, 0.02]
    in_degrees = "frequency,amplitude,phase [deg]\n1,1,-90\n0.9,2,180\n"
    (one,) = load_scene(written(FIT, in_degrees)).fit.data
    assert one.phase.tolist() == pytest.approx([-np.pi / 2, np.pi])
    said = mistakes(written(BACKBONE, in_percent.replace("%", "dB")))
    assert 'its damping is in "dB"; known are "1", "%"' in said


@pytest.mark.parametrize("of", ["response", "backbone"])
def test_what_fcm_wrote_is_read(tmp_path, of):
    """The points of a CSV file of its own are those that it computed."""
    (tmp_path / "scene.toml").write_text(oscillator(RANGE))
    mode = ("--mode", "1", "--level", "1:5") if of == "backbone" else ()
    done = called("respond", tmp_path / "scene.toml", "--harmonics", 1, *mode, "--csv", tmp_path / "a.csv")
    assert done.code == 0, done.err
    with (tmp_path / "a.csv").open(newline="") as file:
        rows = list(csv.DictReader(file))
    (tmp_path / "scene.toml").write_text(oscillator(RANGE) + (BACKBONE if mode else FIT))
    (one,) = load_scene(tmp_path / "scene.toml").fit.data
    assert one.frequency.tolist() == [float(row["frequency [rad/s]"]) for row in rows]
    amplitude = "modal_amplitude" if mode else "amplitude u"
    assert one.amplitude.tolist() == [float(row[amplitude]) for row in rows]
    if mode:
        assert one.damping.tolist() == [float(row["damping_ratio"]) for row in rows]


@pytest.mark.parametrize(
    "fit, points, said",
    [
        (FIT.replace("shroud.mu", "shroud.muu"), POINTS, 'fit.vary[0]: there is no such number in the scene'),
        (FIT.replace('shroud.mu"', 'shroud.mu", "contact.*.mu"'), POINTS, "sets the same number"),
        (FIT.replace("contact.shroud.mu", "level"), POINTS, "the level of the forces belongs to the data"),
        (FIT.replace("vary", "bounds = [[2.0, 1.0]]\nvary"), POINTS, "must rise, are [2, 1]"),
        (FIT.replace("vary", "bounds = [[-1.0, 1.0]]\nvary"), POINTS, "must be at least 0, is -1"),
        (FIT.replace('dof = "u"', 'dof = "w"'), POINTS, 'there is no degree of freedom "w"'),
        (FIT + 'quantity = "speed"\n', POINTS, 'must be "displacement", "velocity", "acceleration"'),
        (FIT + "mode = 1\n", POINTS, "means nothing with a response"),
        (FIT + "level = 0.0\n", POINTS, "must be greater than 0, is 0"),
        (FIT + 'level = "F"\n', POINTS, 'has no column "F"'),
        (FIT, "frequency,amplitude\n0.9,1,5\n", "line 2 has 3 entries; the first line names 2"),
        (FIT, "frequency,amplitude\n0.9,1.5 m\n", 'line 2: amplitude: "1.5 m" has "m" behind the number'),
        (FIT, "frequency,amplitude\n-0.9,1.5\n", "frequency of point 1 must be greater than 0, is -0.9"),
        (FIT, "f,amplitude\n0.9,1.5\n", 'has no column "frequency"; it has "f", "amplitude"'),
        (FIT, "0.9,1.5\n1.0,2.0\n", "must name its columns, as frequency,amplitude"),
        (FIT, "frequency,amplitude\n", "holds no points"),
        (FIT, "", "is empty"),
        (FIT, "frequency,amplitude\n1.0,0.0\n", "all amplitudes are 0"),
        (FIT.replace("a.csv", "a.xls"), POINTS, "measured points are read from"),
        ('[fit]\nvary = ["contact.shroud.mu"]\n', POINTS, "missing; give [[fit.data]]"),
        (FIT + FIT[FIT.index("[[") :], POINTS, "fit.data[1]: is there twice"),
        (FIT + '[sweep]\n"contact.shroud.n_0" = [1.0]\n', POINTS, "is of no use with [sweep]"),
        (FIT.replace("vary", "starts = 0\nvary"), POINTS, "must be a whole number from 1 to 100, is 0"),
        (FIT.replace("vary", 'starts = "a"\nvary'), POINTS, 'must be a number, is the string "a"'),
        (FIT, "frequency,amplitude\n1.0,1.5\n", "has 1 measured value for 1 number; give more"),
        (FIT, "frequency,amplitude,weight\n1.0,1.5,0\n1.1,2.0,0\n", "all weights are 0"),
        (FIT, "frequency,amplitude\n1.0,1e300\n1.1,2.0\n", "amplitude of point 1 must be at most 1e+100"),
    ],
)  # fmt: skip
def test_mistakes_are_said(written, fit, points, said):
    name = "a.xls" if "a.xls" in fit else "a.csv"
    assert said in mistakes(written(fit, points, name))


def test_arrays_of_npz_and_mat(written, tmp_path):
    from scipy.io import savemat

    arrays = {"frequency": np.array([0.9, 1.1]), "amplitude": np.array([[1.5], [2.5]]), "other": np.eye(3)}
    np.savez(tmp_path / "b.npz", **arrays)
    savemat(tmp_path / "b.mat", arrays)
    for name in ("b.npz", "b.mat"):
        (one,) = load_scene(written(FIT.replace("a.csv", name))).fit.data
        assert one.frequency.tolist() == [0.9, 1.1] and one.amplitude.tolist() == [1.5, 2.5]
    np.savez(tmp_path / "b.npz", **(arrays | {"amplitude": np.array([1.0, np.nan])}))
    assert "amplitude[1] is nan" in mistakes(written(FIT.replace("a.csv", "b.npz")))


def uff58(values, function=4, binary=None, even=True, ordinate=0):
    """A dataset 58 over 10, 10.5, ... Hz; binary: the byte order of struct."""
    head = ["NONE"] * 5 + [f"{function:5d}{0:10d}{1:5d}{0:10d} NONE{1:10d}{3:4d} NONE{1:10d}{3:4d}"]
    head += [f"{6:10d}{len(values):10d}{int(even):10d}{10.0:13.5e}{0.5:13.5e}{0.0:13.5e}"]
    axes = (18, ordinate, 13, 0)
    head += [f"{kind:10d}{0:5d}{0:5d}{0:5d} NONE NONE" for kind in axes]
    rows = []
    if binary is None:
        for i, one in enumerate(values):
            at = "" if even else f"{10.0 + 0.5 * i:13.5e}"
            rows.append(f"{at}{one.real:20.12e}{one.imag:20.12e}")
        text = "\n".join(["    -1", "    58", *head, *rows, "    -1", ""])
        return text.encode()
    data = b"".join(struct.pack(f"{binary}2d", one.real, one.imag) for one in values)
    order = {"<": 1, ">": 2}[binary]
    first = f"    58b{order:6d}{2:6d}{11:12d}{len(data):12d}{0:6d}{0:6d}{0:12d}{0:12d}"
    return "\n".join(["    -1", first, *head, ""]).encode() + data + b"\n    -1\n"


VALUES = (1.0 + 0.5j, 0.0 - 2.0j, -0.25 + 0.125j)


@pytest.mark.parametrize("options", [{}, {"even": False}, {"binary": "<"}, {"binary": ">"}])
@pytest.mark.parametrize("function", [4, 12])
def test_functions_of_a_universal_file(written, options, function):
    """Frequency response functions are per unit of the force, whose amplitude is 2 at a level of 3."""
    scene = 'frequency_unit = "Hz"\n' + oscillator(RANGE, amplitude=2.0)
    fit = FIT.replace("a.csv", "a.unv") + "level = 3.0\n"
    (one,) = load_scene(written(fit, uff58(VALUES, function, **options), "a.unv", scene=scene)).fit.data
    assert one.frequency == pytest.approx(2.0 * np.pi * np.array([10.0, 10.5, 11.0]), rel=1e-6)
    assert one.amplitude == pytest.approx(np.abs(VALUES) * (6.0 if function == 4 else 1.0), rel=1e-12)
    assert one.phase == pytest.approx(np.angle(VALUES), rel=1e-12)


@pytest.mark.parametrize(
    ("ordinate", "quantity"), [(8, "displacement"), (11, "velocity"), (12, "acceleration")]
)
def test_a_universal_file_says_what_was_measured(written, ordinate, quantity):
    """Accelerations were taken for displacements where the scene did not say it again."""
    content, fit = uff58(VALUES, ordinate=ordinate), FIT.replace("a.csv", "a.unv")
    (one,) = load_scene(written(fit, content, "a.unv")).fit.data
    assert one.quantity == quantity
    (one,) = load_scene(written(fit + f'quantity = "{quantity}"\n', content, "a.unv")).fit.data
    assert one.quantity == quantity
    other = "velocity" if quantity == "displacement" else "displacement"
    said = mistakes(written(fit + f'quantity = "{other}"\n', content, "a.unv"))
    assert f'is "{other}", and "a.unv" says that it is "{quantity}"' in said


def test_accelerations_of_a_universal_file_are_drawn_as_displacements(tmp_path):
    (tmp_path / "a.unv").write_bytes(uff58(VALUES, 12, ordinate=12))
    found = read_measured_points(tmp_path / "a.unv", "Hz")
    omega = 2.0 * np.pi * np.array([10.0, 10.5, 11.0])
    assert found.frequency == pytest.approx(omega / (2.0 * np.pi))
    assert found.amplitude == pytest.approx(np.abs(VALUES) / omega**2)


def test_a_universal_file_without_a_response_says_what_it_holds(written):
    fit = FIT.replace("a.csv", "a.unv")
    said = mistakes(written(fit, uff58(VALUES, 1), "a.unv"))
    assert "has 0 responses over the frequency among its functions (a time response)" in said
    cut = uff58(VALUES)[:-60] + b"\n    -1\n"
    assert "says 3 values, and" in mistakes(written(fit, cut, "a.unv"))


def test_a_file_that_is_not_there_is_said_beside_other_mistakes(written):
    said = mistakes(written(FIT.replace("a.csv", "no.csv").replace('dof = "u"', 'dof = "q"')))
    assert 'no.csv" is not there' in said and 'there is no degree of freedom "q"' in said


@pytest.mark.parametrize(
    ("points", "said"),
    [
        ("Frequency (Hz),amplitude\n1,2\n", 'write "Frequency (Hz)" as "frequency [Hz]"'),
        ("frequency[rad/s],AMPLITUDE\n1,2\n", 'write "frequency[rad/s]" as "frequency [rad/s]"'),
        ("frequency[rad/s],AMPLITUDE\n1,2\n", 'write "AMPLITUDE" as "amplitude"'),
        ("frequency,amplitude,größe\n1,2,3\n".encode("latin-1"),
         "it is no text in UTF-8, from line 1 on: save it as UTF-8"),
    ],
)  # fmt: skip
def test_what_to_write_is_said_of_heads_and_of_other_encodings(written, points, said):
    assert said in mistakes(written(points=points))


@pytest.mark.parametrize(("head", "asked"), [("phase", True), ("phase [deg]", False)])
def test_phases_that_may_be_degrees_are_asked_about(written, head, asked):
    notes = load_scene(written(points=f"frequency,amplitude,{head}\n0.9,1,-20\n1.1,2,-170\n")).notes
    sentence = "fit: a.csv has a phase of 170 rad. Are they in degrees? Call the column phase [deg]"
    assert (sentence in notes) == asked


def test_resonances_are_said_to_be_of_the_numbers_before_a_fit(written):
    """They stood above the fitted numbers, whose peaks lay beside them, as if they were theirs."""
    said = "resonances of the numbers before the fit with all contacts open"
    assert said in called("plot", "modes", written()).err
    plain = called("plot", "modes", written(fit="")).err
    assert "first resonances with all contacts open" in plain and "before the fit" not in plain


@pytest.mark.parametrize(("second", "asked"), [("0.9,1", True), ("0.9,1.01", False)])
def test_points_that_are_there_twice_are_asked_about(written, second, asked):
    """A measurement at the same frequency is one of its own, unless all its numbers are the same."""
    notes = load_scene(written(points=f"frequency,amplitude\n0.9,1\n1.1,2\n{second}\n")).notes
    assert any("fit: a.csv has 1 of its 3 points again" in str(note) for note in notes) == asked
