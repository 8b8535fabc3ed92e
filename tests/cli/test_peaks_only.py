"""Peaks, folds and errors of each curve without its points; files that are written some curves at a time."""

import json

import netCDF4
import numpy as np
import pytest

from fcm.response import trace
from fcm.results.options import NetcdfOptions
from fcm.results.output import write_netcdf
from fcm.scene import load_scene

from ..computed import by

SWEEP = 'max_step = 0.3\nharmonics = 1\n[sweep]\n"contact.shroud.n_0" = [-5.0, 3.0, 8.0]\n'
STIFF = """
title = "a mode far above the range, of which its flexibility is kept"
[modal]
dofs      = ["u", "v", "w"]
frequency = [1.0, 10.0, 5000.0]
damping   = 0.01
shapes    = [[0.707, 0.707, 0.2], [1.0, -0.5, 0.1], [0.3, 0.2, 1.0]]
[[contact]]
name       = "shroud"
tangential = "u"
normal     = "v"
mu  = 0.4
k_u = 1.0
k_v = 1.0
n_0 = 5.0
[[force]]
dof = "u"
amplitude = 1.0
[response]
frequency = [1.1, 1.4]
output = ["v", "u"]
"""
DRAWN = SWEEP.replace("[-5.0, 3.0, 8.0]", "{ normal = [3.0, 2.0], count = 6, seed = 1 }")
HIGHER_AT_THE_END = """
[modal]
dofs = ["a", "b"]
frequency = [1.0, 1.6]
damping = 0.01
shapes = [[1.0, 0.0], [0.5, 1.0]]
[[contact]]
name = "brake"
tangential = "b"
normal = { b = 0.2 }
mu = 0.4
k_u = 1.0
k_v = 1.0
n_0 = 5.0
[[force]]
dof = "a"
amplitude = 1.0
[response]
frequency = [1.05, 2.2]
harmonics = 1
[optimum]
vary = ["contact.brake.n_0"]
bounds = [[0.2, 20.0]]
minimise = "peak.a"
"""


def untimed(value):
    """A summary without what differs from run to run."""
    if isinstance(value, dict):
        return {key: untimed(item) for key, item in value.items() if key != "seconds"}
    return [untimed(item) for item in value] if isinstance(value, list) else value


@pytest.mark.parametrize("text", [None, STIFF])
def test_the_same_peaks_and_folds_and_summary_as_with_all_points(fcm, scene, text):
    scene.write_text((text or scene.read_text().replace("damping = 0.05", "damping = 0.01")) + SWEEP)
    full = fcm("respond", scene, "-o", "full.nc", "--json")
    only = fcm("respond", scene, "-o", "only.nc", "--json", "--peaks-only")
    assert full.code == only.code == 0
    assert untimed(json.loads(only.out)) == untimed(json.loads(full.out))
    assert any(curve["folds"] and curve["jumps"] for curve in json.loads(only.out)["curves"])
    with netCDF4.Dataset("full.nc") as all_points, netCDF4.Dataset("only.nc") as peaks:
        assert "point" not in peaks.dimensions
        shared = peaks.variables.keys() & all_points.variables.keys()
        assert shared >= {"contact.shroud.n_0", "peak_amplitude", "peak_frequency", "peak_error", "complete"}
        for name in shared:
            np.testing.assert_array_equal(peaks[name][:], all_points[name][:])
        for name in ("table_error", "truncation_error"):
            greatest = np.nanmax(np.ma.filled(all_points[name][:], np.nan), axis=1)
            np.testing.assert_array_equal(peaks[f"greatest_{name}"][:], greatest)
        counted = np.isfinite(np.ma.filled(all_points["frequency"][:], np.nan)).sum(axis=1)
        np.testing.assert_array_equal(peaks["points"][:], counted)


@pytest.mark.slow
def test_the_same_percentiles_of_draws_as_with_all_points(fcm, scene):
    scene.write_text(scene.read_text().replace("damping = 0.05", "damping = 0.01") + DRAWN)
    full = fcm("respond", scene, "-o", "full.nc", "--json")
    only = fcm("respond", scene, "-o", "only.nc", "--json", "--peaks-only")
    (found,) = json.loads(only.out)["scatter"]
    assert found["curves"] == 6 and found == json.loads(full.out)["scatter"][0]
    peaks = [one["peak"]["u"]["amplitude"] for one in json.loads(only.out)["curves"]]
    assert found["peak"]["u"]["amplitude"]["50"] == pytest.approx(np.median(peaks))
    with netCDF4.Dataset("full.nc") as all_points, netCDF4.Dataset("only.nc") as file:
        for name in (
            "peak_percentile",
            "peak_percentile_low",
            "peak_percentile_high",
            "peak_frequency_percentile",
            "jump_percentile",
            "jump_share",
        ):
            np.testing.assert_array_equal(file[name][:], all_points[name][:])
    assert "percentiles of 6 curves" in fcm("respond", scene, "--peaks-only").out


@pytest.mark.slow
def test_the_same_optimum_though_an_end_of_the_range_is_higher(fcm, scene):
    """Its error and stability are those of the peak that is least, and not of the end of the range."""
    scene.write_text(HIGHER_AT_THE_END)
    full, only = (fcm("respond", scene, "--json", *more) for more in ((), ("--peaks-only",)))
    assert full.code == only.code == 0, only.err
    assert untimed(json.loads(only.out)) == untimed(json.loads(full.out))
    (found,), (curve,) = (json.loads(only.out)[name] for name in ("optimum", "curves"))
    assert curve["peak"]["a"]["at_edge"] and curve["peak"]["a"]["amplitude"] > 9.0 > 1.0 > found["value"]
    assert found["error"] != curve["peak"]["a"]["error"] and [one["stable"] for one in found["at"]] == [True]
    with_nine = scene.read_text().replace("harmonics = 1", "harmonics = 9").split("[optimum]")[0]
    scene.write_text(with_nine.replace("n_0 = 5.0", f"n_0 = {found['values']['contact.brake.n_0']!r}"))
    assert fcm("respond", scene, "-o", "true.nc").code == 0
    with netCDF4.Dataset("true.nc") as file:
        above = file["frequency"][0] > 1.6
        off = file["amplitude"][0][above][:, 0].max() / found["value"] - 1.0
    assert 0.3 < found["error"] / abs(off) < 3.0


@pytest.mark.slow
def test_what_has_peaks_only_is_drawn_by_them(fcm, scene):
    scene.write_text(scene.read_text() + SWEEP)
    assert fcm("respond", scene, "-o", "only.nc", "--peaks-only").code == 0
    assert fcm("plot", "peak", "only.nc", "-o", "peak.svg").code == 0
    drawn = fcm("plot", "response", "only.nc", "-o", "response.svg")
    assert drawn.code == 2 and "the peaks alone, as by --peaks-only; try fcm plot peak" in drawn.err


def test_why_a_curve_is_not_complete_is_in_the_file(fcm, scene):
    scene.write_text(scene.read_text() + SWEEP)
    done = fcm("respond", scene, "-o", "only.nc", "--peaks-only", place=by(lambda *_: 1 / 0))
    assert done.code == 1
    with netCDF4.Dataset("only.nc") as file:
        assert file["complete"][:].tolist() == [0, 0, 0]
        assert all("ZeroDivisionError" in reason for reason in file["reason"][:])


@pytest.mark.parametrize(
    ("options", "why"),
    [
        (("--csv", "a.csv"), "--csv has a row for each point; with --peaks-only use -o FILE.nc or --json"),
        (("--method", "exact"), "--peaks-only is of no use with --method exact"),
        (("--level", "0:1", "--at", "1.2"), "--peaks-only is of no use with --level"),
        (("--compare",), "--peaks-only is of no use with --compare"),
    ],
)
def test_where_only_peaks_have_no_meaning(fcm, scene, options, why):
    done = fcm("respond", scene, "--peaks-only", *options)
    assert done.code == 2 and why in " ".join(done.err.split())


def test_some_curves_at_a_time_make_the_same_file(scene, tmp_path):
    scene.write_text(scene.read_text() + SWEEP)
    response = trace(load_scene(scene), harmonics=2)
    write_netcdf(response, tmp_path / "whole.nc")
    write_netcdf(response, tmp_path / "parts.nc", NetcdfOptions(chunk=100, contiguous=0))
    with netCDF4.Dataset(tmp_path / "whole.nc") as whole, netCDF4.Dataset(tmp_path / "parts.nc") as parts:
        assert parts["amplitude"].chunking()[0] == 1 and whole["amplitude"].chunking() == "contiguous"
        for name, variable in whole.variables.items():
            np.testing.assert_array_equal(parts[name][:], variable[:])
