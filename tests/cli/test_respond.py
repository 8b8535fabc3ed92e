"""``fcm respond``: what it prints and writes, and what it refuses."""

import csv
import dataclasses
import json
import resource
from pathlib import Path

import netCDF4
import numpy as np
import pytest

import fcm as package
from fcm.results.peak import Peak

from ..computed import by, nowhere
from ..oscillator import oscillator

SCENES = Path(package.__file__).parent / "scenes"


def files(folder):
    return sorted(path.name for path in folder.iterdir())


def test_the_table_has_a_line_for_each_curve(fcm):
    done = fcm("respond", "yang1998")
    header, *lines = done.out.partition("\n\n")[0].splitlines()
    assert done.code == 0
    assert header.split()[:3] == ["n_0", "peak", "u"] and "at rad/s" in header and "folds" in header
    rows = {line.split()[0]: line.split() for line in lines}
    assert list(rows) == ["100", "50", "20", "10", "5", "2", "0", "-5", "-20", "-60"]
    assert float(rows["10"][1]) == pytest.approx(6.236, abs=2e-3)  # the paper's optimum
    assert [float(fold) for fold in rows["5"][-2:]] == pytest.approx([1.2388, 1.1875], abs=2e-4)
    assert rows["10"][-1] == "none"


@pytest.mark.parametrize(("text", "number"), [("1%", "0.01"), ("0.05 %", "5e-4")])
def test_an_accuracy_may_be_in_percent(fcm, text, number):
    shares, percents = (
        json.loads(fcm("respond", "yang1998-n5", "--accuracy", one, "--json").out) for one in (number, text)
    )
    (share,), (percent,) = shares["curves"], percents["curves"]
    assert share["peak"] == percent["peak"] and share["harmonics"] == percent["harmonics"]


@pytest.mark.parametrize("text", ["0%", "100%", "1%%", "one", "", "nan"])
def test_what_is_no_accuracy_is_refused_with_one_that_is(fcm, text):
    done = fcm("respond", "yang1998-n5", "--accuracy", text)
    assert done.code == 2
    assert f'"{text}" is not a relative error between 0 and 1, such as 0.01 or 1%' in " ".join(
        done.err.split()
    )


def test_a_second_table_has_the_jumps_of_a_slow_sweep(fcm):
    header, *lines = fcm("respond", "yang1998-n5").out.split("\n\n")[1].splitlines()
    assert " ".join(header.split()) == "jump at rad/s u before u after v before v after sweep"
    jumps = (line.split() for line in lines)
    (up, *_, to_up, way_up), (down, from_down, *_, way_down) = ([*map(_cell, line)] for line in jumps)
    assert (way_up, way_down) == ("up", "down")
    assert (up, down) == pytest.approx((1.2388, 1.1875), abs=2e-4)
    assert to_up > 10 and from_down > 10


def _cell(text):
    return text if text.isalpha() else float(text)


def test_without_jumps_there_is_one_table(fcm, scene):
    assert "\n\n" not in fcm("respond", scene).out


def test_the_last_lines_say_what_it_cost_and_how_wrong_it_is(fcm, scene):
    cost, error, _ = fcm("respond", scene).err.splitlines()[-3:]
    assert cost.startswith("1 curve, ") and " points in " in cost and cost.endswith(" s")
    assert error.startswith("largest relative error: ") and "by the harmonics left out" in error


@pytest.mark.parametrize(
    ("options", "said"), [((), 0), (("--method", "table"), 1), (("-v",), 1), (("--method", "closed-form"), 0)]
)
def test_how_far_the_table_is_off_is_told_once_where_it_is_asked_for(fcm, scene, options, said):
    """It is no error of the curve, and stood first among those of every curve of one harmonic."""
    first = [one for one in options if one == "-v"]
    done = fcm(*first, "respond", scene, "--harmonics", 1, *(one for one in options if one != "-v"))
    assert done.code == 0 and done.err.count("solutions by it alone would be off by up to ") == said
    (line,) = (one for one in done.err.splitlines() if one.startswith("largest relative error: "))
    assert "table" not in line


@pytest.mark.parametrize(("frequency", "count"), [("[0.8, 1.6]", 0), ("[0.8, 1.35]", 2)])
def test_the_last_line_is_the_result_in_short(fcm, scene, frequency, count):
    """By what --json has of the peaks, here one of each degree of freedom."""
    scene.write_text(scene.read_text().replace("[0.8, 1.6]", frequency))
    done = fcm("respond", scene, "--json", "--accuracy", "1e-3")
    (curve,) = json.loads(done.out)["curves"]
    peaks = curve["peak"].values()
    assert curve["complete"] and all(one["stable"] for one in peaks) and "peaks" not in curve
    assert sum(one["at_edge"] for one in peaks) == count
    ends = f", {count} at an end of the range" if count else ""
    error = max(one["error"] for one in peaks)
    assert done.err.splitlines()[-1] == (
        f"result: complete; every peak shown is stable{ends}; errors of peaks are at most {error:.1e}"
    )


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"stable": 0.0}, "of {} peaks shown, {} unstable; errors"),
        ({"stable": np.nan}, "of {} peaks shown, {} of unknown stability; errors"),
        ({"error": np.nan}, "every peak shown is stable; errors of peaks are unknown"),
        ({"error": 1.5}, "errors of peaks are up to more than 100 %"),
    ],
)
def test_the_result_in_short_hides_no_doubt(fcm, scene, change, words):
    def computed(compute, *given):
        return [
            dataclasses.replace(one, peaks={dof: peak._replace(**change) for dof, peak in one.peaks.items()})
            for one in compute(*given)
        ]

    done = fcm("respond", scene, "--harmonics", "1", place=by(computed))
    result = next(line for line in done.err.splitlines() if line.startswith("result: "))
    assert words.format(2, 2) in result
    said = [
        line for line in done.err.splitlines() if line.startswith(("the harmonics are given", "no stable"))
    ]
    assert (f"; {len(said)} remark" in result and result.endswith(" on it above")) == bool(said)


def test_a_row_of_a_peak_has_the_error_of_its_height_and_that_at_its_frequency(fcm, scene, tmp_path):
    """Beside 15 harmonics. The error of the height alone stood there, among errors at equal frequency."""
    scene.write_text(oscillator("[response]\nfrequency = [0.8, 1.6]\n", damping=0.02, n_0=1.0))
    rows = {}
    for name, harmonics in (("one", 1), ("more", 15)):
        given = ("--harmonics", harmonics, "--max-step", 0.01, "--csv", f"{name}.csv", "-o", f"{name}.nc")
        assert fcm("respond", scene, *map(str, given)).code == 0
        with (tmp_path / f"{name}.csv").open() as file:
            rows[name] = list(csv.DictReader(file))
    names = ("frequency [rad/s]", "amplitude u", "error u", "error_at_frequency u")
    omega, height, error, at_frequency = (
        np.array([float(row[name]) for row in rows["one"]]) for name in names
    )
    other, exact = (np.array([float(row[name]) for row in rows["more"]]) for name in names[:2])
    top = int(height.argmax())
    assert np.flatnonzero(error != at_frequency).tolist() == [top]
    assert error[top] == pytest.approx(abs(exact.max() / height[top] - 1.0), rel=0.02)
    assert at_frequency[top] == pytest.approx(
        abs(np.interp(omega[top], other, exact) / height[top] - 1.0), rel=0.02
    )
    assert at_frequency[top] > 1.1 * error[top]
    with netCDF4.Dataset(tmp_path / "one.nc") as data:
        assert data["error_at_frequency"][0, :, 0].tolist() == at_frequency.tolist()


@pytest.mark.parametrize("asked", [(), ("--method", "table")])
def test_a_table_that_has_no_effect_is_said_where_it_is_asked_for(fcm, asked):
    done = fcm("respond", "platform-damper", "--harmonics", "1", *asked)
    said = [line for line in done.err.splitlines() if "the table: forces of contacts in a plane" in line]
    assert done.code == 0 and len(said) == bool(asked)


def test_json_is_all_of_standard_output(fcm, scene):
    done = fcm("respond", scene, "--json")
    result = json.loads(done.out, parse_constant=lambda name: pytest.fail(f"{name} is not JSON"))
    (curve,) = result["curves"]
    assert curve["complete"] and curve["points"] > 10
    assert set(curve["peak"]) == {"u", "v"} and curve["peak"]["u"]["amplitude"] > 0
    assert {"left_out", "seconds"} <= set(result)


def test_a_number_that_does_not_exist_is_null(fcm, scene):
    unknown = changed(peaks={"u": Peak(np.nan, np.nan), "v": Peak(np.nan, np.nan)})
    done = fcm("respond", scene, "--json", place=unknown)
    peak = json.loads(done.out)["curves"][0]["peak"]["u"]
    assert peak.pop("greatest_stable")["amplitude"] > 0.0  # that of the points, as the peak may not be stable
    assert peak == {
        "amplitude": None,
        "frequency": None,
        "error": None,
        "frequency_error": None,
        "stable": None,
        "at_edge": False,
        "residual_change": None,
    }
    assert fcm("respond", scene, place=unknown).out.splitlines()[1].split()[:2] == ["-", "-"]


def test_files_hold_the_points_that_were_reported(fcm, scene, tmp_path):
    done = fcm("respond", scene, "-o", "a.nc", "--csv", "a.csv", "--json")
    points = json.loads(done.out)["curves"][0]["points"]
    assert files(tmp_path) == ["a.csv", "a.nc", "scene.toml"]
    with netCDF4.Dataset(tmp_path / "a.nc") as data:
        assert data["amplitude"].shape == (1, points, 2)
    with (tmp_path / "a.csv").open(newline="") as file:
        assert len(list(csv.DictReader(file))) == points
    assert "wrote a.nc" in done.err and "wrote a.csv" in done.err


@pytest.mark.slow
def test_a_file_that_was_there_is_said_to_be_replaced(fcm, scene, tmp_path):
    """Also one that a command names itself, as a picture beside its file."""
    first = fcm("respond", scene, "-o", "a.nc", "--csv", "a.csv").err.splitlines()
    assert "wrote a.nc" in first and "wrote a.csv" in first
    (tmp_path / "a.csv").unlink()
    again = fcm("respond", scene, "-o", "a.nc", "--csv", "a.csv").err.splitlines()
    assert "wrote a.nc (replaced)" in again and "wrote a.csv" in again
    assert [fcm("plot", "response", "a.nc").err for _ in range(2)] == [
        "wrote a.png\n",
        "wrote a.png (replaced)\n",
    ]


def test_without_output_options_nothing_is_written(fcm, scene, tmp_path):
    assert fcm("respond", scene).code == 0
    assert files(tmp_path) == ["scene.toml"]


def test_quiet_leaves_standard_error_empty(fcm, scene):
    for args in (["-q", "respond", scene], ["respond", scene, "-q"]):
        done = fcm(*args)
        assert done.code == 0 and done.err == "" and "peak u" in done.out


def test_the_closed_form_and_the_table_agree(fcm, scene):
    peaks = [
        json.loads(fcm("respond", scene, "--json", "--method", method).out)["curves"][0]["peak"]["u"]
        for method in ("table", "closed-form")
    ]
    assert peaks[0]["amplitude"] == pytest.approx(peaks[1]["amplitude"], rel=1e-6)


def test_a_shorter_step_gives_more_points(fcm, scene):
    coarse, fine = (
        json.loads(fcm("respond", scene, "--json", "--max-step", step).out)["curves"][0]["points"]
        for step in ("0.05", "0.01")
    )
    assert fine > 2 * coarse


@pytest.mark.parametrize(
    ("args", "said"),
    [
        (["-o", "folder"], "the name has to end in .nc"),
        (["-o", "folder.nc"], "it is a folder"),
        (["-o", "a.txt"], "the name has to end in .nc"),
        (["--csv", "a.nc"], "the name has to end in .csv"),
        (["-o", "no/where/a.nc"], 'there is no folder "no/where"'),
        (["-o", "scene.toml/a.nc"], '"scene.toml" is a file, and no folder'),
        (["-o", "x" * 300 + ".nc"], "it cannot be written: File name too long"),
        (["-o", "\udcff.nc"], "the name is not valid text"),
        (["--max-step", "0"], "must be greater than 0"),
        (["--max-step", "nan"], "must be finite"),
        (["--max-step", "2"], "must be greater than 0 and at most 1"),
        (["--max-step", "x"], "not a valid float"),
        (["--method", "magic"], "table"),
        (["--method", "closed-form", "--table", "t.nc"], "--table is of no use"),
    ],
)
def test_wrong_options_are_refused_before_anything_is_computed(fcm, scene, tmp_path, args, said):
    (tmp_path / "folder.nc").mkdir()
    done = fcm("respond", scene, *args, place=nowhere)
    assert done.code == 2 and done.out == "" and said in done.err
    assert files(tmp_path) == ["folder.nc", "scene.toml"]


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("", "modal"),
        ("[modal", "scene.toml"),
        ("\x00\xff", "scene.toml"),
        ("[[contact]]\nmu = 'much'", "mu"),
    ],
)
def test_a_wrong_scene_is_refused_and_nothing_written(fcm, scene, tmp_path, text, said):
    scene.write_bytes(text.encode("latin-1"))
    done = fcm("respond", scene, "-o", "a.nc", "--json")
    assert done.code == 2 and done.out == "" and said in done.err and "Traceback" not in done.err
    assert files(tmp_path) == ["scene.toml"]


@pytest.mark.parametrize("name", ["no-such-scene", "no/such/scene.toml", ".", "", "a\nb"])
def test_a_scene_that_is_not_there_is_wrong_input(fcm, name):
    done = fcm("respond", name)
    assert done.code == 2 and "Traceback" not in done.err and "defect" not in done.err


@pytest.mark.parametrize("content", [None, b"", b"not a table", b"\x89HDF\r\n\x1a\n" + bytes(100)])
def test_a_wrong_table_is_refused(fcm, scene, tmp_path, content):
    if content is not None:
        (tmp_path / "t.nc").write_bytes(content)
    done = fcm("respond", scene, "--table", "t.nc")
    assert done.code == 2 and "t.nc" in done.err and "Traceback" not in done.err


def changed(**changes):
    """A place where every curve comes out of the solver with these attributes."""
    return by(lambda compute, *given: [dataclasses.replace(one, **changes) for one in compute(*given)])


def test_a_curve_that_stopped_is_reported_and_written(fcm, scene, tmp_path):
    short = changed(complete=False, reason="stopped at 1.2 rad/s: the step became too short")
    done = fcm("respond", scene, "-o", "a.nc", place=short)
    assert done.code == 3
    assert "NOT COMPLETE: stopped at 1.2 rad/s" in done.out
    result, error = done.err.splitlines()[-2:]
    assert result.startswith("result: the curve stopped early; ") and "the curve stopped early" in error
    assert files(tmp_path) == ["a.nc", "scene.toml"]


def test_a_defect_is_one_only_if_it_takes_every_curve(fcm, scene):
    """One curve, or all of a sweep, lost to a defect: 1; some of a sweep: 3, for the others are there."""

    def fails_below(limit):
        def computed(compute, batch, report):
            if any(one.contacts[0].n_0 < limit for one in batch):
                raise ZeroDivisionError("of zero")
            return compute(batch, report)

        return by(computed)

    done = fcm("respond", scene, place=fails_below(1e9))
    assert done.code == 1 and "a defect of fcm, ZeroDivisionError: of zero" in done.out
    assert "\nresult: the curve stopped early\n" in done.err
    scene.write_text(scene.read_text() + '\n[sweep]\n"contact.shroud.n_0" = [5, 1]\n')
    assert fcm("respond", scene, place=fails_below(1e9)).code == 1
    done = fcm("respond", scene, place=fails_below(3.0))
    assert done.code == 3 and "1 of 2 curves stopped early" in done.err


def test_a_full_disk_does_not_take_the_result_away(fcm, scene, tmp_path):
    """Here files may have no more bytes than the curve takes while it is not written."""
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (60_000, before[1]))
    try:
        done = fcm("respond", scene, "-o", "a.nc")
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)
    assert done.code == 3 and "peak u" in done.out
    kept, error = done.err.splitlines()
    assert kept.endswith("kept in a.nc.unfinished: continue with --resume")
    assert error == "fcm: error: a.nc: File too large"
    done = fcm("respond", scene, "-o", "a.nc", "--resume", place=nowhere)
    assert done.code == 0 and "begins anew" not in done.err
    assert files(tmp_path) == ["a.nc", "scene.toml"]


def test_where_nothing_is_kept_to_go_on_with_it_says_that_it_begins_afresh(fcm, scene):
    fresh = "a.nc: no unfinished run is kept: this one begins anew"
    assert fresh in fcm("respond", scene, "-o", "a.nc", "--resume").err.splitlines()
    assert fresh in fcm("respond", scene, "-o", "a.nc", "--resume").err  # of a run that was finished
    assert "begins anew" not in fcm("respond", scene, "-o", "a.nc").err


def test_an_interrupted_run_says_so_and_leaves_nothing(program, scene, tmp_path):
    code = (
        "import os, signal, fcm.response\n"
        "fcm.response.trace = lambda *a, **k: os.kill(os.getpid(), signal.SIGINT) or signal.pause()\n"
    )
    done = program("respond", "scene.toml", "-o", "a.nc", before=code)
    assert done.returncode == 3
    said = ["fcm: ending, which may take some seconds"]
    said += ["fcm: warning: nothing is finished, so nothing is kept"]
    assert done.err.splitlines() == [*said, "fcm: interrupted: the calculation was not completed"]
    assert files(tmp_path) == ["scene.toml"]


def test_modes_within_the_range_that_are_not_kept_are_warned_of(fcm, tmp_path):
    scene = tmp_path / "scene.toml"
    text = (SCENES / "beam.toml").read_text()
    for name in ("beam-mass.mtx", "beam-stiffness.mtx"):
        (tmp_path / name).write_bytes((SCENES / name).read_bytes())
    for old, new in (
        ("modes     = 28", "modes = 1"),
        ("damping   = 0.0", "damping = 0.01"),
        ("[350.0, 800.0]", "[350.0, 5000.0]"),
    ):
        text = text.replace(old, new)
    scene.write_text(text)
    done = fcm("respond", scene, "--harmonics", "1")
    assert "\nfcm: warning: structure: there are modes within the range that are not kept" in f"\n{done.err}"
    result = done.err.splitlines()[-1]
    assert " by harmonics left out, unknown by modes left out" in result and "remark" in result
    scene.write_text(scene.read_text().replace("modes = 1", "modes = 8"))
    done = fcm("respond", scene, "--harmonics", "1")
    assert "not kept" not in done.err and "modes left out" not in done.err
