"""``fcm respond --method exact`` and ``--at``: files, messages, refusals, and the picture with its points."""

import csv
import json
import shutil
from pathlib import Path

import netCDF4
import numpy as np
import pytest

from ..computed import nowhere

AT = ["--method", "exact", "--at", "0.9", "--at", "1.1:1.3:3"]


def test_a_traced_curve_is_printed_and_written(fcm, scene, tmp_path):
    scene.write_text(scene.read_text().replace("[0.8, 1.6]", "[1.2, 1.4]"))
    done = fcm(
        "respond", scene, "--method", "exact", "--max-step", "0.2", "-o", "a.nc", "--csv", "a.csv", "--json"
    )
    (curve,) = json.loads(done.out)["curves"]
    assert done.code == 0 and curve["complete"] and curve["truncation_error"] == curve["table_error"] == 0.0
    assert 0.0 < curve["closure_error"] < 1e-9
    error, result = done.err.splitlines()[-2:]
    assert "by which a period does not close" in error
    closes = f"periods close to {curve['closure_error']:.1e}"
    assert result == f"result: complete; every peak shown is stable; {closes}"
    with netCDF4.Dataset(tmp_path / "a.nc") as data:
        amplitude, fundamental = data["amplitude"][0, :, 0], data["fundamental"][0, :, 0]
        assert "peak-to-peak" in data["amplitude"].long_name and "Floquet" in data["stable"].long_name
        assert set(data["sweep"][:].ravel()) == {""}
    with (tmp_path / "a.csv").open(newline="") as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == curve["points"] == len(amplitude)
    assert [float(row["amplitude u"]) for row in rows] == amplitude.tolist()
    assert [float(row["fundamental u"]) for row in rows] == fundamental.tolist()


def test_the_curve_is_near_the_balanced_one(fcm, scene):
    peaks = [
        json.loads(fcm("respond", scene, "--json", "--max-step", "0.2", "--method", method).out)["curves"][0][
            "peak"
        ]
        for method in ("exact", "closed-form")
    ]
    assert peaks[0]["u"]["amplitude"] == pytest.approx(peaks[1]["u"]["amplitude"], rel=0.02)


def test_frequencies_are_visited_up_and_down(fcm, scene, tmp_path):
    done = fcm("respond", scene, *AT, "-o", "a.nc")
    assert done.code == 0
    up = [0.9, 1.1, 1.2, 1.3]
    with netCDF4.Dataset(tmp_path / "a.nc") as data:
        assert data["frequency"][0].tolist() == pytest.approx(up + up[::-1])
        assert data["sweep"][0].tolist() == ["up"] * 4 + ["down"] * 4
    one = fcm("respond", scene, "--method", "exact", "--at", "1.1")
    assert one.code == 0 and "end of the range" not in one.out  # there is none


def test_the_greatest_of_visited_frequencies_is_called_no_peak(fcm, scene, tmp_path):
    done = fcm("respond", scene, *AT, "-o", "a.nc")
    assert (
        done.out.split()[:2] == ["greatest", "u"] and "\ngreatest of 4 frequencies: no peak was" in done.out
    )
    result = done.err.splitlines()[-1]
    assert result.startswith(
        "result: complete; greatest of 4 frequencies, and no peak; every motion shown is"
    )
    (curve,) = json.loads(fcm("respond", scene, *AT, "--json").out)["curves"]
    assert curve["visited"] == 4 and curve["peak"]["u"]["error"] is None
    assert "error_at_frequency" not in curve["peak"]["u"]
    with netCDF4.Dataset(tmp_path / "a.nc") as data:
        assert np.isnan(np.ma.filled(data["peak_error"][:], np.nan)).all()


def test_python_gives_the_same(fcm, scene, tmp_path):
    from fcm import load_scene, respond

    assert fcm("respond", scene, *AT, "-o", "a.nc").code == 0
    data = respond(load_scene(str(scene)), "exact", at=[0.9, *np.linspace(1.1, 1.3, 3)])
    with netCDF4.Dataset(tmp_path / "a.nc") as file:
        np.testing.assert_array_equal(file["amplitude"][:], data.amplitude.values)


@pytest.mark.slow
def test_points_are_drawn_over_curves(fcm, scene, tmp_path):
    assert fcm("respond", scene, "-o", "curves.nc").code == 0
    assert fcm("respond", scene, *AT, "-o", "exact.nc").code == 0
    done = fcm("plot", "response", "curves.nc", "--points", "exact.nc", "-o", "a.png")
    assert done.code == 0 and (tmp_path / "a.png").read_bytes().startswith(b"\x89PNG")
    done = fcm("plot", "response", "exact.nc", "--points", "curves.nc", "-o", "b.png")
    assert done.code == 2 and "--method exact" in done.err and not (tmp_path / "b.png").exists()


@pytest.mark.parametrize(
    ("args", "said"),
    [
        (["--at", "1"], "--at needs --method exact"),
        (["--method", "closed-form", "--at", "1"], "--at needs --method exact"),
        (["--method", "exact", "--at", "0"], "greater than 0"),
        (["--method", "exact", "--at", "nan"], "greater than 0"),
        (["--method", "exact", "--at", "1:2"], "FROM:TO:COUNT"),
        (["--method", "exact", "--at", "1:2:3:4"], "FROM:TO:COUNT"),
        (["--method", "exact", "--at", "1:2:x"], "FROM:TO:COUNT"),
        (["--method", "exact", "--at", ""], "FROM:TO:COUNT"),
        (["--method", "exact", "--at", "1:2:0"], "the count must be"),
        (["--method", "exact", "--at", "1:2:1"], "the count must be from 2, both ends"),
        (["--method", "exact", "--at", "2:1:5"], "must rise"),
        (["--method", "exact", "--at", "2:2:5"], "must rise"),
        (["--method", "exact", "--at", "1", "--max-step", "0.1"], "--max-step is of no use with --at"),
        (["--method", "exact", "--table", "t.nc"], "--table is of no use"),
    ],
)
def test_options_that_do_not_fit_are_refused(fcm, scene, args, said):
    done = fcm("respond", scene, *args, place=nowhere)
    assert done.code == 2 and done.out == "" and said in done.err and "Traceback" not in done.err


def test_a_resonance_without_damping_is_named_and_the_rest_written(fcm, scene, tmp_path):
    text = scene.read_text().replace("damping = 0.05", "damping = 0").replace("n_0 = 5.0", "n_0 = -1e15")
    scene.write_text(text)
    done = fcm("respond", scene, "--method", "exact", "--max-step", "0.2", "-o", "a.nc")
    assert done.code == 3 and "add damping" in done.out and "error: the curve stopped early; " in done.err
    with netCDF4.Dataset(tmp_path / "a.nc") as data:
        known = data["frequency"][0].compressed()
        assert known.min() == 0.8 and known.max() == 1.6  # both sides of it


def test_a_curve_without_points_is_a_header(fcm, scene, tmp_path):
    done = fcm("respond", scene, "--method", "exact", "--at", "1e-12", "--csv", "a.csv")
    assert done.code == 3 and "wrote a.csv" in done.err
    assert (tmp_path / "a.csv").read_text().startswith("curve,branch,frequency [rad/s],amplitude u")
    assert len((tmp_path / "a.csv").read_text().splitlines()) == 1


SCENES = Path(__file__).parents[1] / "shooting/scenes"


@pytest.mark.slow
def test_the_table_of_jumps_says_after_how_many_periods_motions_repeat(fcm):
    visits = [x for at in (288, 292, 293, 301, 302) for x in ("--at", at)]
    run = fcm("respond", SCENES / "two_beside_one.toml", "--method", "exact", *visits)
    head, *rows = run.out[run.out.index("jump at rad/s") :].splitlines()
    assert head.split()[:5] == ["jump", "at", "rad/s", "periods", "d0"]
    told = [(row.split()[1:4], row.split()[-1]) for row in rows[:3]]
    assert told == [(["2", "to", "2"], "up"), (["2", "to", "1"], "up"), (["1", "to", "2"], "down")]
    alone = fcm("respond", "yang1998-n5", "--method", "exact", "--at", 1.235, "--at", 1.24)
    assert "jump at rad/s  u before" in alone.out


@pytest.mark.slow
def test_points_that_are_one_of_many_or_do_not_repeat_are_named(fcm, tmp_path):
    """In words, in the summary, in the file and in the CSV."""
    args = ("--method", "exact", "--json", "--csv", "points.csv", "-o", "points.nc")
    run = fcm("respond", SCENES / "two_periods.toml", *args, "--at", 2.0, "--at", 2.031)
    (curve,) = json.loads(run.out)["curves"]
    assert run.code == 0 and curve["repeats"] == [1, 2]
    assert "repeat only after several periods of the force (repeats): 2" in run.err
    with netCDF4.Dataset(tmp_path / "points.nc") as data:
        assert data["repeats"][0].tolist() == [1, 2, 2, 1]
        assert (data["cycle_least"][0, 1] < data["cycle_greatest"][0, 1]).all()
    rows = list(csv.DictReader((tmp_path / "points.csv").open()))
    assert [row["repeats"] for row in rows] == ["1", "2", "2", "1"]
    run = fcm("respond", SCENES / "not_unique.toml", *args, "--at", 1.5)
    (curve,) = json.loads(run.out)["curves"]
    least, greatest = curve["peak_range"]["v"]
    assert least < 1.36 and greatest > 2.90 and curve["not_unique"] == 2
    assert "points that are not unique: 2" in run.err and "[start] friction chooses" in run.err
    assert "may_not_be_unique" not in curve


@pytest.mark.slow
@pytest.mark.parametrize("method", [(), ("--method", "exact")])
def test_curves_say_at_how_many_points_the_motion_may_be_one_of_many(fcm, method):
    """Contact B never slips below 1.5 rad/s or so, and A, without friction, closes and opens."""
    run = fcm("respond", SCENES / "not_unique.toml", "--json", *method)
    (curve,) = json.loads(run.out)["curves"]
    assert 0 < curve["may_not_be_unique"] < curve["points"]
    assert all(one["residual_change"] == 0.0 for one in curve["peak"].values())  # there B slips
    assert "its past decides: it changes none of the greatest peaks" in run.err


@pytest.mark.slow
def test_a_time_limit_ends_a_run_as_ctrl_c_does(fcm, scene):
    """A curve of thousands of points is not finished in a second; what there is of it is kept and written."""
    args = ("respond", scene, "--method", "exact", "--max-step", "0.0001", "-o", "a.nc", "--json")
    run = fcm(*args, "--time-limit", "1")
    assert run.code == 3 and "the time limit of 1 s is over" in run.err
    assert "kept in a.nc.unfinished: continue with --resume" in run.err
    (curve,) = json.loads(run.out)["curves"]
    assert not curve["complete"] and curve["points"] > 0 and curve["reason"].startswith("interrupted at ")
    shutil.copy("a.nc", before := "before.nc")
    again = json.loads(fcm(*args, "--time-limit", "1", "--resume").out)["curves"][0]
    assert again["points"] > curve["points"] == points(before)
    assert points("a.nc") == again["points"]
    assert fcm(*args, "--time-limit", "0.001", "--resume").code == 3 and points("a.nc") == again["points"]


def points(path):
    """That a file has."""
    with netCDF4.Dataset(path) as data:
        return int(np.isfinite(data["frequency"][:].filled(np.nan)).sum())


@pytest.mark.parametrize("value", ["0", "-1", "nan", "inf", "x"])
def test_a_time_limit_is_a_number_of_seconds(fcm, scene, value):
    run = fcm("respond", scene, "--time-limit", value)
    assert run.code == 2 and "--time-limit" in run.err


def test_only_peaks_says_so(fcm, scene):
    run = fcm("respond", scene, "--method", "exact", "--only", "peaks", "--json")
    whole = json.loads(fcm("respond", scene, "--method", "exact", "--json").out)["curves"][0]
    (curve,) = json.loads(run.out)["curves"]
    assert run.code == 0 and curve["only"] == "peaks" and curve["points"] < whole["points"]
    assert "folds and jumps. Lower peaks are left out, too" in run.err
    assert curve["peak"]["u"]["amplitude"] == pytest.approx(whole["peak"]["u"]["amplitude"], rel=1e-8)
    for wrong in ([], ["--method", "exact", "--at", "1"]):
        refused = fcm("respond", scene, "--only", "peaks", *wrong)
        assert refused.code == 2 and "--only needs --method exact" in refused.err


def test_a_step_over_a_jump_has_no_amplitude_where_the_motion_beyond_does_not_reach_it(fcm):
    """Above 36.39 Hz the motion is irregular up to 36.41 Hz: what is steady beyond ends there."""
    scene = Path(__file__).parents[1] / "branches/scenes/stops_and_second_harmonic.toml"
    done = fcm("respond", scene, "--method", "exact", "--at", "36:40:2", "--json")
    (up,) = (one for one in json.loads(done.out)["curves"][0]["jumps"] if one["sweep"] == "up")
    assert up["frequency"] == pytest.approx(36.3906, abs=1e-3)
    assert up["after"]["1x"] is None and up["after_stable"] is None and up["periods"] == [1, 0]
