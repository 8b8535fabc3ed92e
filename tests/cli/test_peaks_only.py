"""Peaks, folds and errors of each curve without its points; files that are written some curves at a time."""

import json

import netCDF4
import numpy as np
import pytest

from fcm.results import output, padded

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


def test_what_has_peaks_only_is_drawn_by_them(fcm, scene):
    scene.write_text(scene.read_text() + SWEEP)
    assert fcm("respond", scene, "-o", "only.nc", "--peaks-only").code == 0
    assert fcm("plot", "peak", "only.nc", "-o", "peak.svg").code == 0
    drawn = fcm("plot", "response", "only.nc", "-o", "response.svg")
    assert drawn.code == 2 and "no variable frequency, amplitude; try fcm plot peak" in drawn.err


def test_why_a_curve_is_not_complete_is_in_the_file(fcm, scene):
    scene.write_text(scene.read_text() + SWEEP)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("fcm.response.groups.traced_curve", lambda *_: 1 / 0)
        done = fcm("respond", scene, "-o", "only.nc", "--peaks-only", "--jobs", 1)
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


def test_some_curves_at_a_time_make_the_same_file(fcm, scene, monkeypatch):
    scene.write_text(scene.read_text() + SWEEP)
    assert fcm("respond", scene, "-o", "whole.nc", "--harmonics", 2).code == 0
    monkeypatch.setattr(padded, "CHUNK", 100)
    monkeypatch.setattr(output, "SMALL", 0)
    assert fcm("respond", scene, "-o", "parts.nc", "--harmonics", 2).code == 0
    with netCDF4.Dataset("whole.nc") as whole, netCDF4.Dataset("parts.nc") as parts:
        assert parts["amplitude"].chunking()[0] == 1 and whole["amplitude"].chunking() == "contiguous"
        for name, variable in whole.variables.items():
            np.testing.assert_array_equal(parts[name][:], variable[:])
