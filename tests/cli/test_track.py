"""``fcm respond --track`` and scenes with an [optimum], from the command to files and pictures."""

import csv
import json
import re
from dataclasses import replace
from pathlib import Path

import netCDF4
import numpy as np
import pytest
from matplotlib.text import Text

import fcm as package
from fcm.cli.track import incomplete, lower_ended
from fcm.cli.verdict import verdict
from fcm.plot.tracked import DrawnTrack, DrawnTracking, draw_tracked, read_tracked
from fcm.response.track import TrackRequest, track
from fcm.results.summary import without_nan
from fcm.results.tracked import TrackedCurve, TrackedError, Tracking
from fcm.scene import load_scene
from fcm.tracking import lowest_peak, minimax

from ..interrupted import Interrupting

SCENES = Path(package.__file__).parent / "scenes"
OPTIMUM = '\n[optimum]\nvary = ["contact.shroud.n_0"]\nbounds = [[2.0, 20.0]]\nminimise = "peak.u"\n'
FOLDS = ("--track", "folds", "--over", "contact.shroud.n_0", "--harmonics", "1", "--from")


@pytest.fixture
def optimum(scene):
    scene.write_text(scene.read_text() + OPTIMUM)
    return scene


@pytest.mark.slow
def test_an_optimum_is_written_drawn_and_told(fcm, optimum):
    done = fcm("respond", optimum, "--harmonics", "1", "-o", "best.nc")
    assert done.code == 0 and done.out.startswith("least peak.u: ")
    with netCDF4.Dataset("best.nc") as data:
        value, peak = float(data["optimum_number"][0, 0]), float(data["optimum_peak"][0])
        number, height = np.array(data["tracked_number"][0]), np.array(data["tracked_amplitude"][0, :, 0])
        assert data["peak_amplitude"][0, 0] == pytest.approx(peak, rel=1e-9)  # of the response with it
        assert data["contact.shroud.n_0"][0] == value and data["varied"][0] == "contact.shroud.n_0"
    assert number.min() == 2.0 and number.max() == 20.0 and 2.0 < value < 20.0
    assert peak <= height.min() * (1.0 + 1e-9)
    done = fcm("plot", "peak", "best.nc", "-o", "best.png")
    assert (done.code, done.err) == (0, "wrote best.png\n")
    assert fcm("plot", "peak", "best.nc", "--folds").code == 2


@pytest.mark.slow
def test_an_optimum_is_the_same_in_whatever_bounds(fcm, optimum):
    """Where they were wide it was said to be at a corner, as slopes were compared with the whole range."""
    found = []
    for bounds in ("2.0, 20.0", "0.0, 1e4"):
        optimum.write_text(re.sub(r"bounds *= *\[.*\]", f"bounds = [[{bounds}]]", optimum.read_text()))
        found += json.loads(fcm("respond", optimum, "--harmonics", "1", "--json").out)["optimum"]
    assert [one["kind"] for one in found] == ["smooth", "smooth"]
    values = [one["values"]["contact.shroud.n_0"] for one in found]
    assert values[1] == pytest.approx(values[0], rel=1e-7)


def test_as_json_an_optimum_has_its_error_and_harmonics(fcm, optimum):
    done = fcm("respond", optimum, "--accuracy", "0.01", "--json")
    (found,) = json.loads(done.out)["optimum"]
    assert done.code == 0 and found["kind"] == "smooth" and found["harmonics"][0] == 1
    assert 0.0 < found["error"] < 0.01


@pytest.mark.slow
def test_optima_of_a_sweep_have_the_harmonics_that_any_of_them_takes(fcm, tmp_path):
    """One of them takes the second, with which alone the other is less accurate than with none."""
    text = (SCENES / "yang1998-n5.toml").read_text("utf-8").replace("harmonics = 1", "accuracy = 1e-3")
    sweep = '\n[sweep]\n"contact.shroud.mu" = [0.4, 0.8]\n'
    (tmp_path / "swept.toml").write_text(text + OPTIMUM.replace("20.0", "16.0") + sweep, "utf-8")
    done = fcm("respond", "swept.toml", "--json")
    found = json.loads(done.out)
    assert done.code == 0
    for one, curve in zip(found["optimum"], found["curves"], strict=True):
        assert one["harmonics"] == curve["harmonics"] and one["error"] < 1.1e-3
        assert one["value"] == pytest.approx(curve["peak"]["u"]["amplitude"], rel=1e-9)


@pytest.mark.slow
def test_tracked_folds_are_written_drawn_and_told(fcm, tmp_path):
    done = fcm("respond", "yang1998", *FOLDS, "4", "--to", "10", "-o", "folds.nc", "--csv", "folds.csv")
    assert done.code == 0 and "cusp" in done.out
    with netCDF4.Dataset("folds.nc") as data:
        assert data["track_what"][0] == "fold" and data["tracked_number"].key == "contact.shroud.n_0"
        points = int(np.isfinite(np.ma.filled(data["tracked_number"][:], np.nan)).sum())
        assert np.ma.filled(data["tracked_turn"][:], 0.0).any()
    rows = list(csv.reader((tmp_path / "folds.csv").read_text("utf-8").splitlines()))
    assert len(rows) == 1 + points
    assert fcm("plot", "peak", "folds.nc", "--folds", "-o", "folds.svg").code == 0
    done = fcm("plot", "response", "folds.nc", "-o", "no.svg")
    assert done.code == 2 and done.err.endswith("; try fcm plot peak\n")


def test_the_tracked_number_has_a_unit_in_files_and_pictures(fcm, tmp_path):
    text = (SCENES / "yang1998.toml").read_text("utf-8")
    (tmp_path / "mm.toml").write_text(text + '\n[units]\nlength = "mm"\nforce = "N"\n', "utf-8")
    args = ("respond", "mm.toml", *FOLDS, "4", "--to", "4.5", "-o", "folds.nc", "--csv", "folds.csv")
    assert fcm(*args).code == 0
    assert (tmp_path / "folds.csv").read_text("utf-8").split(",")[2] == "contact.shroud.n_0 [N]"
    drawn = read_tracked(tmp_path / "folds.nc")
    assert drawn is not None
    assert draw_tracked(drawn).axes[0].get_xlabel() == "$n_{0}$ (N)  (contact.shroud.n_0)"


def test_peaks_of_very_different_heights_are_all_to_be_seen_and_no_name_lies_on_them():
    number, none = np.linspace(1.0, 2.0, 5), np.zeros(5)
    heights = np.outer(number, (1.0, 1e-3))
    tracks = (DrawnTrack(f"peak of {d}", number, number, heights, none, none, none + 1.0) for d in "uv")
    figure = draw_tracked(DrawnTracking("contact.c.n_0", ("u", "v"), "Hz", tuple(tracks)))
    upper, (legend,) = figure.axes[0], figure.legends
    assert upper.get_yscale() == "log" and upper.get_legend() is None
    assert [text.get_text() for text in legend.get_texts()] == ["peak of u", "peak of v"]


def test_peaks_of_several_names_that_coincide_are_all_to_be_seen():
    """The last lay over the others; now it is the thinnest."""
    number, none = np.linspace(1.0, 2.0, 5), np.zeros(5)
    both = np.column_stack((number, number))
    tracks = [DrawnTrack(f"peak of {dof}", number, number, both, none, none, none + 1.0) for dof in "uv"]
    figure = draw_tracked(DrawnTracking("contact.c.n_0", ("u", "v"), "Hz", tuple(tracks)))
    for axes in figure.axes[:2]:
        under, over = axes.lines
        assert under.get_linewidth() > 1.5 * over.get_linewidth()


def test_peaks_of_one_name_have_one_colour_in_both_panels_each_its_own():
    """So that it is seen which height and which frequency belong together."""
    number, none = np.linspace(1.0, 2.0, 5), np.zeros(5)
    heights, frequencies = (1.0 + number, 3.0 - number), (7.0 + none, 5.0 + none)
    tracks = [
        DrawnTrack("peak of u", number, f, h[:, None], none, none, none + 1.0)
        for f, h in zip(frequencies, heights, strict=True)
    ]
    figure = draw_tracked(DrawnTracking("contact.c.n_0", ("u",), "Hz", tuple(tracks)))
    upper, lower = ([line for line in axes.lines if len(line.get_xdata()) == 5] for axes in figure.axes[:2])
    colours = [[line.get_color() for line in lines] for lines in (upper, lower)]
    assert colours[0] == colours[1] and len(set(colours[0])) == 2 and not figure.legends


def test_what_lines_mean_is_within_the_picture():
    """Of peaks of every kind the sentence was cut off at the edge."""
    number, f = np.linspace(1.0, 2.0, 5), np.linspace(10.0, 11.0, 5)
    stable, trough = np.array([1.0, 0.0, np.nan, 1.0, 1.0]), np.array([0.0, 0.0, 0.0, 1.0, 0.0])
    tracks = tuple(
        DrawnTrack("peak of u", number, f + k, f[:, None], 0.0 * f, trough, stable) for k in range(2)
    )
    tried = np.array([[1.0, 40.0], [1.5, 30.0]])
    figure = draw_tracked(DrawnTracking("contact.c.n_0", ("u",), "Hz", tracks, (1.5, 30.0), tried=tried))
    figure.draw_without_rendering()
    (said,) = figure.findobj(lambda one: isinstance(one, Text) and "trough" in one.get_text())
    assert (
        said.get_window_extent().x1 <= figure.bbox.x1 and "crosses: peaks that were tried" in said.get_text()
    )
    (crosses,) = (line for line in figure.axes[0].lines if line.get_marker() == "x")
    np.testing.assert_array_equal(crosses.get_xydata(), tried)


def test_a_peak_that_falls_by_decades_is_to_be_seen_at_its_least_and_named():
    number, none = np.linspace(1.0, 2.0, 5), np.zeros(5)
    heights = np.array([[1.0], [0.1], [0.01], [0.001], [0.002]])
    track = DrawnTrack("peak of u", number, number, heights, none, none, none + 1.0)
    upper = draw_tracked(DrawnTracking("contact.c.n_0", ("u",), "Hz", (track,))).axes[0]
    assert upper.get_yscale() == "log" and upper.get_ylabel() == "Peak amplitude of u"


def test_onsets_are_called_so_with_what_they_are_of_and_the_dof_is_one_that_the_scene_asks_for():
    """They were called peaks, of the first degree of freedom without its name."""
    number, none = np.linspace(1.0, 2.0, 5), np.zeros(5)
    both = np.column_stack((number, 3.0 * number))
    tracks = [
        DrawnTrack(f"slip of {c}", number, number, both, none, none, none + 1.0) for c in ("tip", "mid")
    ]
    drawn = DrawnTracking("level", ("u", "v"), "Hz", tuple(tracks), length="mm", asked=("v",))
    upper, lower = draw_tracked(drawn).axes[:2]
    assert upper.get_ylabel() == "Amplitude of v (mm)" and lower.get_ylabel() == "Frequency $f$ (Hz)"
    assert upper.get_title("left") == "at the onset of slip"
    assert upper.lines[0].get_ydata().tolist() == (3.0 * number).tolist()
    one = draw_tracked(replace(drawn, tracks=drawn.tracks[:1]), "u").axes[0]
    assert one.get_title("left") == "at the onset of slip of tip" and "of u" in one.get_ylabel()


def test_a_gap_in_a_tracked_peak_is_explained():
    number, none = np.linspace(1.0, 2.0, 5), np.zeros(5)
    trough = np.array([0.0, 1.0, 1.0, 0.0, 0.0])
    track = DrawnTrack("peak of u", number, number, number[:, None], none, trough, none + 1.0)
    axes = draw_tracked(DrawnTracking("contact.c.n_0", ("u",), "Hz", (track,))).axes[:2]
    assert axes[1].get_title(loc="left") == "gap: it is no peak but a trough"
    for line in (one.lines[0] for one in axes):
        assert np.isnan(line.get_ydata()).tolist() == trough.astype(bool).tolist()


def test_dots_of_fold_curves_are_named():
    number, none = np.array([1.0, 2.0, 3.0, 2.0, 1.0]), np.zeros(5)
    for turn, said in ((none, ""), (np.eye(5)[2], "; dots: a window ends")):
        track = DrawnTrack("fold", number, 5.0 + number, number[:, None], turn, none, none + 1.0)
        axes = draw_tracked(DrawnTracking("contact.c.n_0", ("u",), "Hz", (track,))).axes[0]
        assert axes.get_title(loc="right") == f"shaded: several solutions{said}"


def test_folds_that_go_from_end_to_end_have_their_window_between_them():
    """Each was shaded down to its own chord. Two of one swept value have one window, others have none."""
    number, none = np.linspace(1.0, 2.0, 5), np.zeros(5)

    def track(frequency, swept):
        return DrawnTrack("fold", number, frequency, number[:, None], none, none, none + 1.0, (swept,))

    low, high, alone = track(1.0 + number**2, 3.0), track(2.0 + number**2, 3.0), track(9.0 + number, 4.0)
    swept = {"contact.c.mu": ""}
    figure = draw_tracked(DrawnTracking("level", ("u",), "Hz", (low, high, alone), swept=swept))
    (patch,) = figure.axes[0].patches
    assert patch.get_path().contains_point((1.5, 3.75)) and not patch.get_path().contains_point((1.5, 3.2))
    assert [text.get_text() for text in figure.legends[0].get_texts()] == ["3", "4"]


def test_peaks_of_a_sweep_have_the_colours_of_what_was_swept():
    number, none = np.linspace(1.0, 2.0, 5), np.zeros(5)
    heights = np.outer(number, (1.0, 2.0))
    tracks = tuple(
        DrawnTrack(f"peak of {dof}", number, number, value * heights, none, none, none + 1.0, (value,))
        for value in (3.0, 4.0) for dof in "uv"
    )  # fmt: skip
    swept = {"contact.c.n_0": "N"}
    for dof, column in ((None, 0), ("v", 1)):
        figure = draw_tracked(DrawnTracking("level", ("u", "v"), "Hz", tracks, swept=swept), dof)
        upper, (legend,) = figure.axes[0], figure.legends
        assert legend.get_title().get_text() == "$n_{0}$ (N)" and "uv"[column] in upper.get_ylabel()
        drawn = [(line.get_color(), line.get_ydata()[0]) for line in upper.lines]
        named = [line.get_color() for line in legend.get_lines()]
        assert drawn == list(zip(named, [3.0 * (column + 1), 4.0 * (column + 1)], strict=True))


@pytest.mark.parametrize("low, scale", [(1.0, "log"), (100.0, "linear"), (0.0, "linear"), (-5.0, "linear")])
def test_a_number_over_decades_has_a_logarithmic_axis(low, scale):
    number, none = np.linspace(low, 200.0, 5), np.zeros(5)
    tracks = [
        DrawnTrack("peak of u", number, number, none[:, None] + height, none, none, none + 1.0)
        for height in (1.0, 2.0)
    ]
    figure = draw_tracked(DrawnTracking("contact.c.n_0", ("u",), "Hz", tuple(tracks)))
    assert [axes.get_xscale() for axes in figure.axes] == [scale, scale]
    assert figure.axes[1].get_title(loc="left") == "a colour for each peak"


@pytest.mark.slow
def test_the_error_of_tracked_curves_is_told_or_said_to_be_unknown(fcm):
    """Two of three cusps that lie close together move too far by more harmonics to be found again."""
    done = fcm("respond", "yang1998", *FOLDS, "4", "--to", "10", "-o", "folds.nc", "--json")
    (curve,) = json.loads(done.out)["tracked"]["curves"]
    told = [one["error"] for one in curve["errors"]]
    assert [one["place"] for one in curve["errors"]].count("cusp") == len(curve["turns"])
    assert None in told and all(0.0 < one < 0.01 for one in told if one is not None)
    with netCDF4.Dataset("folds.nc") as data:
        known = np.ma.filled(data["tracked_error_told"][0], np.nan)
        error = np.ma.filled(data["tracked_error"][0], np.nan)
    assert (known == 0.0).sum() == told.count(None) and (known == 1.0).sum() + told.count(None) == len(told)
    assert error[known == 1.0].tolist() == [one for one in told if one is not None]
    assert np.isnan(error[known != 1.0]).all()
    assert "unknown" in fcm("respond", "yang1998", *FOLDS, "4", "--to", "10").out


@pytest.mark.slow
def test_curves_of_a_sweep_say_of_which_values_they_are(fcm, scene):
    sweep = '\n[sweep]\n"contact.shroud.n_0" = [-5.0, -20.0]\n'
    scene.write_text(scene.read_text() + sweep)
    args = (
        "respond",
        scene,
        "--track",
        "peaks",
        "--over",
        "contact.shroud.mu",
        "--from",
        "0.3",
        "--to",
        "0.4",
    )
    one, two = (fcm(*args, "--harmonics", "1", "--jobs", jobs) for jobs in ("1", "2"))
    rows = [line.split() for line in one.out.splitlines() if " peak of u " in line]
    assert one.code == 0 and one.out == two.out and {row[0] for row in rows} == {"-5", "-20"}
    assert one.out.startswith("n_0")


@pytest.mark.parametrize(
    ("args", "said"),
    [
        (["--over", "contact.shroud.n_0"], "--over needs --track"),
        (["--track", "folds"], "--track needs --over, --from, --to"),
        (["--track", "peaks", *FOLDS, "4", "--to", "5"], "--track is given 2 times (peaks, folds)"),
        ([*FOLDS, "5", "--to", "4"], "--from 5 --to 4: contact.shroud.n_0 must rise; swap them: 4 to 5"),
        ([*FOLDS, "5", "--to", "5.0000000000001"], "too narrow"),
        (
            [*FOLDS, "4", "--to", "5", "--over", "level"],
            "--over is given 2 times (contact.shroud.n_0, level)",
        ),
        ([*FOLDS, "4", "--to", "5", "--sensitivity"], "--sensitivity is of no use with --track"),
        ([*FOLDS, "4", "--to", "5", "--peaks-only"], "--peaks-only is of no use with --track"),
        ([*FOLDS[:3], "modal.frequency.1", "--from", "0", "--to", "9"], "more rigid-body motions"),
        (
            [*FOLDS[:3], "force.u.amplitude", "--from", "-1", "--to", "4"],
            "--from -1 --to 4: at 0 nothing moves by force.u.amplitude; leave 0 out",
        ),
        ([*FOLDS[:3], "level", "--from", "0", "--to", "4"], "--from 0: the level must be positive"),
        (
            [*FOLDS[:3], "contact.shroud.mu", "--from", "-1", "--to", "4"],
            "--from -1: contact.shroud.mu must be at least 0",
        ),
        ([*FOLDS[:3], "contact.shroud.n0", "--from", "1", "--to", "4"], "did you mean"),
        ([*FOLDS, "1", "--to", "4", "--resume"], "--resume needs the -o FILE"),
        ([*FOLDS[:4], "--from", "1", "--to", "4", "--method", "exact"], "--method exact"),
        ([*FOLDS[:4], "--from", "nan", "--to", "4"], "--from nan: contact.shroud.n_0 must be finite"),
    ],
)
def test_what_is_wrong_is_said_and_nothing_is_written(fcm, scene, tmp_path, args, said):
    done = fcm("respond", scene, *args, *(["-o", "a.nc"] if "--resume" not in args else []))
    assert done.code == 2 and said in done.err and done.out == ""
    assert not (tmp_path / "a.nc").exists()


@pytest.mark.parametrize(
    ("over", "span", "said"),
    [
        ("contact.shroud.n_0", (5.0, 4.0), "span from 5 to 4: contact.shroud.n_0 must rise"),
        ("contact.shroud.mu", (0.1, -1.0), "span to -1: contact.shroud.mu must be at least 0"),
        ("level", (0.0, 1.0), "span from 0: the level must be positive"),
    ],
)
def test_the_library_names_the_span_that_it_was_given(scene, over, span, said):
    with pytest.raises(ValueError, match="^" + re.escape(said)):
        track(load_scene(scene), TrackRequest("folds", over, span))


def test_an_optimum_excludes_what_is_for_numbers_already_chosen(fcm, optimum):
    assert "[optimum]" in fcm("respond", optimum, "--method", "exact").err
    optimum.write_text(optimum.read_text() + "[[schedule]]\nfrequency = 1.0\ncycles = 2\n")
    assert "[[schedule]]" in fcm("respond", optimum).err


@pytest.mark.parametrize(
    ("frequency", "vary", "bounds", "said"),
    [
        (
            1.0,
            "modal.frequency.0",
            "0, 2",
            "at one end of modal.frequency.0 the structure has more rigid-body",
        ),
        (
            0.0,
            "modal.frequency.1",
            "9, 11",
            "modal.frequency.1 changes the rigid-body motions of the structure",
        ),
        (0.0, "contact.shroud.k_v", "0, 2", "at 0 contact.shroud.k_v changes the rigid-body motions"),
    ],
)
def test_a_number_that_changes_rigid_body_motions_is_refused(fcm, scene, frequency, vary, bounds, said):
    """They ended as a defect, after a while."""
    text = scene.read_text().replace("frequency = [1.0, 10.0]", f"frequency = [{frequency}, 10.0]")
    scene.write_text(f'{text}[optimum]\nvary = "{vary}"\nbounds = [[{bounds}]]\nminimise = "peak.u"\n')
    done = fcm("respond", scene, "--harmonics", "1")
    assert done.code == 2 and said in done.err and "optimum: bounds" in done.err
    ends = bounds.split(", ")
    track = ("--track", "peaks", "--over", vary, "--from", ends[0], "--to", ends[1])
    done = fcm("respond", scene, "--harmonics", "1", *track)
    assert done.code == 2 and said in done.err and done.out == ""


def test_no_peak_in_the_range_is_said(fcm, optimum):
    optimum.write_text(optimum.read_text().replace("[0.8, 1.6]", "[0.3, 0.4]"))
    done = fcm("respond", optimum, "--harmonics", "1")
    assert done.code == 2 and "no peak inside the range" in done.err


@pytest.mark.parametrize(
    ("table", "said"),
    [
        ("", ["optimum.vary: missing", "optimum.minimise: missing"]),
        (
            'vary = ["contact.shroud.n_1"]\nminimise = "peak.x"',
            ["no such number", 'no degree of freedom "x"'],
        ),
        ('vary = []\nminimise = "least.u"\nof = 1', ["an empty list", "must be peak.NAME", "unknown key"]),
        ('vary = "level"\nminimise = "peak.u"\nbounds = [[3, 2]]', ["must rise"]),
        ('vary = "contact.shroud.mu"\nminimise = "peak.u"\nbounds = [[-1, 2]]', ["must be at least 0"]),
        (
            'vary = ["level", "contact.shroud.x", "contact.shroud.mu", "contact.shroud.mu"]\n'
            'minimise = "peak.u"\nbounds = [[1, 2], [2, 1], [-1, 2], [0.1, "a"]]',
            ["there can be 3", "no such number", "the same number", "must be at least 0", "two numbers"],
        ),
        (
            'vary = ["level", "level"]\nminimise = "peak.u"\nbounds = [[1, 2]]',
            ["the same number", "for each of"],
        ),
        ('vary = "level"\nminimise = "peak.u"\nbounds = [[0, 2]]', ["bounds of level: at 0 nothing moves"]),
        (
            'vary = "force.u.amplitude"\nminimise = "peak.u"',  # by default from 0
            ["bounds of force.u.amplitude: at 0 nothing moves; leave 0 out"],
        ),
        ('vary = "level"\nminimise = ["peak.u", "peak.v", "greatest.u"]', ['names "u" twice']),
    ],
)
def test_all_mistakes_of_the_table_are_named_at_once(fcm, scene, table, said):
    scene.write_text(f"{scene.read_text()}[optimum]\n{table}\n")
    done = fcm("respond", scene)
    assert done.code == 2 and all(text in done.err for text in said), done.err


TWO = OPTIMUM.replace('"]', '", "contact.shroud.mu"]').replace("]]", "], [0.2, 0.6]]")


@pytest.mark.parametrize("wanted", [OPTIMUM, TWO], ids=["one number", "two"])
def test_the_least_so_far_of_an_interrupted_search_is_kept(fcm, scene, wanted):
    """All that had been traced was lost. What is kept is the peak of the ordinary response there."""
    text = scene.read_text()
    scene.write_text(text + wanted)
    options = ("--harmonics", "1", "-o", "best.nc", "--sensitivity")
    done = fcm("respond", scene, *options, messages=Interrupting(": 1 response traced"))
    assert done.code == 3 and "the least so far" in done.out and "the optimum was sought for" in done.err
    assert done.err.endswith("; what was traced is reported and written\n")
    assert "what is finished is kept in best.nc.unfinished: continue with --resume" in done.err
    with netCDF4.Dataset("best.nc") as data:
        numbers, peak = np.array(data["optimum_number"][0]), float(data["optimum_peak"][0])
        assert data["optimum_kind"][0] == "unfinished" and np.ma.is_masked(data["optimum_error"][0])
    drawn = fcm("plot", "response", "best.nc", "-o", "best.png")
    assert drawn.code == 2 and "the search for its optimum was interrupted" in drawn.err
    for name, value in zip(("n_0", "mu"), numbers, strict=False):
        text = re.sub(rf"^{name} *= .*$", f"{name} = {float(value)!r}", text, flags=re.MULTILINE)
    scene.write_text(text)
    (there,) = json.loads(fcm("respond", scene, "--harmonics", "1", "--json").out)["curves"]
    assert peak == pytest.approx(there["peak"]["u"]["amplitude"], rel=1e-9)


@pytest.mark.slow
@pytest.mark.parametrize("wanted", [OPTIMUM, TWO], ids=["one number", "two"])
def test_an_interrupted_search_goes_on_to_the_same_optimum(fcm, scene, wanted, monkeypatch):
    """No response that was traced before is traced again, and the result is that of a run in one go."""
    scene.write_text(scene.read_text() + wanted)
    traced = []
    for module in (lowest_peak, minimax):

        def special(system, *others, original=module.special_points):
            found = original(system, *others)
            traced.append(system.scene)
            return found

        monkeypatch.setattr(module, "special_points", special)
    options = ("--harmonics", "1", "--json")
    whole = json.loads(fcm("respond", scene, *options).out)["optimum"]
    once = len(traced)
    traced.clear()
    stopped = fcm("respond", scene, *options, "-o", "best.nc", messages=Interrupting(": 1 response traced"))
    before = len(traced)
    assert stopped.code == 3 and 0 < before < once
    done = fcm("respond", scene, *options, "-o", "best.nc", "--resume")
    assert done.code == 0 and json.loads(done.out)["optimum"] == whole
    assert len(traced) == once and not Path("best.nc.unfinished").exists()


def test_of_a_search_that_found_nothing_before_it_was_interrupted_nothing_is_said(fcm, optimum):
    done = fcm("respond", optimum, "--harmonics", "1", "-o", "best.nc", messages=Interrupting("optimum"))
    assert (done.code, done.out) == (3, "") and not Path("best.nc").exists()


def test_a_tracked_curve_that_stopped_says_what_shows_the_rest():
    """Not where it was interrupted, nor of the level, which no [sweep] has."""
    curves = [{"complete": False}, {"complete": True}]
    tracked = {"what": "peaks", "over": "contact.a.mu", "complete": False, "problems": [], "curves": curves}
    said = incomplete({"tracked": tracked})
    assert said.startswith("1 of 2 tracked curves stopped early: a [sweep] of contact.a.mu shows ")
    for other in ({"problems": ["interrupted"]}, {"over": "level"}, {"what": "optimum"}):
        assert "[sweep]" not in incomplete({"tracked": tracked | other})


def peaks_over(number, height, complete, **more):
    count = len(number)
    data = {
        "parameters": {}, "what": "peak of u", "number": np.array(number), "frequency": np.ones(count),
        "amplitude": np.array(height)[:, None], "corner": np.full(count, ""), "turn": np.zeros(count, bool),
        "trough": np.zeros(count, bool), "stable": np.ones(count), "closings": (), "complete": complete,
        "reason": "" if complete else "it ends at a corner",
    }  # fmt: skip
    return TrackedCurve(**(data | more))


@pytest.mark.parametrize(("height", "lower"), [([1.0, 1.2], True), ([1.0, 3.5], False)])
def test_a_lower_peak_that_ends_early_is_a_remark_and_no_failure(height, lower):
    """Where a greater one is complete; one that rises above it may be the greatest beyond its end."""
    curves = [peaks_over([1.0, 3.0], [2.0, 3.0], True), peaks_over([1.0, 2.0], height, False)]
    found = Tracking("contact.a.n_0", "peaks", (1.0, 3.0), (1,), curves)
    result = {"tracked": found.summary("rad/s", ("u", "v")), "curves": []}
    assert not found.complete and bool(incomplete(result)) is not lower
    assert bool(lower_ended(result)) is lower
    ends = "complete" if lower else "1 of 2 tracked curves stopped early"
    assert verdict(result, 0).startswith(f"result: {ends}; every motion tracked is stable; errors of amp")
    alone = Tracking("contact.a.n_0", "peaks", (1.0, 3.0), (1,), curves[1:])
    assert not lower_ended({"tracked": alone.summary("rad/s", ("u", "v"))})


def test_the_last_line_on_tracked_curves_is_the_result_in_short():
    errors = (TrackedError(0, "end", 2e-3), TrackedError(1, "cusp", float("nan"), 0.1))
    curve = peaks_over([1.0, 2.0], [1.0, 1.0], True, errors=errors, turn=np.array([False, True]))
    unstable = replace(curve, stable=np.array([0.0, 1.0]))
    for what, curves, words in (
        ("peaks", [curve, unstable], "of 2 tracked curves, 1 unstable in part; errors of amplitudes are"),
        (
            "folds",
            [curve],
            "errors of frequencies are at most 2.0e-03 at 1 of 2 places, elsewhere unknown, of the number at",
        ),
        ("slip", [], "nothing to follow was found"),
    ):
        found = Tracking("contact.a.n_0", what, (1.0, 2.0), (1,), curves)
        result = without_nan({"tracked": found.summary("rad/s", ("u",)), "curves": []})
        assert verdict(result, 0).startswith(f"result: complete; {words}")


@pytest.mark.slow
def test_an_optimum_at_a_bound_is_told_in_the_last_line(fcm, optimum):
    optimum.write_text(optimum.read_text().replace("2.0, 20.0", "5.0, 6.0"))
    done = fcm("respond", optimum, "--harmonics", "1")
    assert "(followed no further)" in done.out and "; the optimum is at a bound" in done.err.splitlines()[-1]


@pytest.mark.slow
def test_an_optimum_of_several_numbers_is_no_picture(fcm, optimum):
    """It was a single dot."""
    text = optimum.read_text().replace(
        '["contact.shroud.n_0"]', '["contact.shroud.n_0", "contact.shroud.mu"]'
    )
    optimum.write_text(text.replace("[[2.0, 20.0]]", "[[2.0, 20.0], [0.3, 0.4]]"))
    assert fcm("respond", optimum, "--harmonics", "1", "-o", "a.nc").code == 0
    done = fcm("plot", "peak", "a.nc")
    assert done.code == 2 and "an optimum of 2 numbers is one point" in done.err and "[sweep]" in done.err
