"""Whether a motion stays at tracked peaks and at the least peak, against the exact motion there."""

import json
import re
from pathlib import Path

import netCDF4
import numpy as np
import pytest

from fcm.response.exact import trace_exact
from fcm.response.track import TrackRequest, track
from fcm.scene import load_scene
from fcm.scene.draft import number_of

from ..response.test_unknown_stability import SCENE

OPTIMUM = '[optimum]\nvary = ["contact.c0.n_0"]\nbounds = [[-1.8, -1.6]]\nminimise = "peak.d0"\n'
NEAR = 0.02  # relative, by which an amplitude of so few harmonics may differ from the true one


@pytest.fixture
def narrow(tmp_path):
    """The scene with another range."""

    def made(low, high, more=""):
        path = tmp_path / "narrow.toml"
        path.write_text(SCENE.replace("[0.915, 2.509]", f"[{low}, {high}]") + more)
        return path

    return made


@pytest.mark.slow
@pytest.mark.parametrize(("span", "harmonics", "count"), [((1.08, 1.13), 3, 2), ((2.2, 2.3), 1, 1)])
def test_a_tracked_peak_is_stable_where_the_exact_motion_stays_there(narrow, span, harmonics, count):
    scene = load_scene(narrow(*span))
    curves = track(scene, TrackRequest("peaks", "level", (0.98, 1.02)), harmonics=harmonics).tracking.curves
    peaks = [one for one in curves if one.what == "peak of d0"]
    assert len(peaks) == count
    for one in peaks:
        assert np.ptp(one.stable) == 0.0 and not one.trough.any()
        i = np.argmin(np.abs(one.number - 1.0))
        there = number_of(scene, "level").put(scene, float(one.number[i]))
        (exact,) = trace_exact(there, (float(one.frequency[i]),)).curves
        off = np.abs(exact.orbits.cycle_greatest / one.amplitude[i] - 1.0).max()
        assert (off < NEAR) == (one.stable[i] == 1.0)
    assert min(one.stable[0] for one in peaks) == 0.0


@pytest.mark.slow
def test_tracked_peaks_that_no_motion_stays_at_are_told_written_and_drawn(fcm, narrow):
    command = ("respond", narrow(2.2, 2.3), "--track", "peaks", "--over", "level", "--from", "0.98")
    done = fcm(*command, "--to", "1.02", "--harmonics", "1", "-o", "a.nc")
    assert done.code == 0 and "where no motion is stable, or" in done.out and "0.98  1.02" in done.out
    with netCDF4.Dataset("a.nc") as file:
        stable = np.ma.filled(file["tracked_stable"][:], np.nan)
        assert (stable[np.isfinite(file["tracked_number"][:].filled(np.nan))] == 0.0).all()
        curves = json.loads(file.summary)["tracked"]["curves"]
    assert [one["not_stable"][0]["number"] for one in curves] == [[0.98, 1.02]] * len(curves)
    assert fcm("plot", "peak", "a.nc", "-o", "a.svg").code == 0
    assert "dashed: no motion stays there" in Path("a.svg").read_text("utf-8")


@pytest.mark.slow
def test_the_least_peak_has_a_mark_where_no_motion_stays(fcm, narrow):
    scene = narrow(2.2, 2.3, OPTIMUM)
    done = fcm("respond", scene, "--harmonics", "1", "-o", "a.nc")
    least, place, said = done.out.splitlines()[:3]
    assert ", at which no stable motion was found (error" in least
    assert (
        done.code == 0
        and place.endswith("rad/s!")
        and said.startswith("! unstable: with these harmonics the motion is not stable there")
    )
    assert fcm("plot", "peak", "a.nc", "-o", "a.svg").code == 0
    assert re.search(r"least peak [0-9.e-]+ at .*, unstable", Path("a.svg").read_text("utf-8"))
    with netCDF4.Dataset("a.nc") as file:
        assert file["optimum_stable"][:].tolist() == [[0.0]]
        (found,) = json.loads(file.summary)["optimum"]
    (at,) = found["at"]
    assert at["stable"] is False
    (exact,) = trace_exact(
        number_of(load_scene(scene), "contact.c0.n_0").put(
            load_scene(scene), found["values"]["contact.c0.n_0"]
        ),
        (at["frequency"],),
    ).curves
    assert exact.orbits.cycle_greatest[:, 0].max() < 0.5 * found["value"]


@pytest.mark.slow
def test_an_onset_is_unstable_between_the_folds_that_pass_it():
    """On the branch between the folds of the response, which meet the onset at turns of their own curve."""
    scene, span = load_scene("yang1998-n5"), (6.0, 8.0)
    onsets = track(scene, TrackRequest("separation", "contact.shroud.n_0", span), harmonics=1).tracking.curves
    folds = track(scene, TrackRequest("folds", "contact.shroud.n_0", span), harmonics=1).tracking.curves
    turns = np.array([(one.number[i], one.frequency[i]) for one in folds for i, _ in one.closings])
    (stretch,) = [one for curve in onsets for one in curve.summary("rad/s").get("not_stable", ())]
    for end in zip(stretch["number"], stretch["frequency"], strict=True):
        assert np.abs(turns - end).max(axis=1).min() < 1e-4  # a ten thousandth of a step of a tenth
