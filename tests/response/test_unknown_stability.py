"""Where stability is not told: what is said of slow sweeps that come there."""

from __future__ import annotations

import json
import pickle
from dataclasses import replace

import netCDF4
import numpy as np
import pytest

import fcm as package
from fcm.response import trace
from fcm.response.curve_batches import KINDS
from fcm.response.exact import trace_exact
from fcm.results.curve_extracts import without_points
from fcm.results.curve_summary import curve_summary
from fcm.results.jumps import swept
from fcm.run.records import unpacked
from fcm.scene import scene_from_dict

SCENE = """
[modal]
dofs = ["d0", "d1", "d2", "d3"]
frequency = [1.0, 1.7363, 2.1874, 5.7427]
damping = [0.01277, 0.04284, 0.00404, 0.01221]
shapes = [[0.448, -0.314, 0.105, -0.104], [0.204, -0.088, -0.089, -0.467],
          [-0.395, -1.056, -0.751, -0.167], [-0.02, -0.93, 0.505, 0.826]]
[[contact]]
name = "c0"
tangential = "d3"
normal = "d0"
mu = 0.607
k_u = 0.536
k_v = 1.517
n_0 = -1.696
[[contact]]
name = "c1"
tangential = "d2"
normal = "d0"
mu = 0.06
k_u = 0.383
k_v = 4.052
n_0 = -0.256
[[force]]
dof = "d2"
amplitude = 0.599
phase = 0.24
[[force]]
dof = "d1"
amplitude = 0.142
phase = 3.426
[response]
frequency = [0.915, 2.509]
"""


def test_the_greatest_stable_motion_is_told_where_the_peak_is_none():
    """Of a curve with its points, and of one that has little more than its gist."""
    (curve,) = trace(replace(package.load_scene("yang1998-n5"), curves=()), harmonics=1).curves
    assert all("greatest_stable" not in one for one in curve_summary(curve, "rad/s")["peak"].values())
    high, marks = curve.amplitude[:, 0] > 8.0, iter((0.0, np.nan))
    peaks = {dof: peak._replace(stable=next(marks)) for dof, peak in curve.peaks.items()}
    lower = replace(curve, stable=np.where(high, 0.0, curve.stable), peaks=peaks)
    for one in (lower, without_points(lower)):
        for d, told in enumerate(curve_summary(one, "rad/s")["peak"].values()):
            stays = told["greatest_stable"]
            heights = {
                float(curve.amplitude[i, d]): (float(curve.frequency[i]), float(curve.error[i, d]))
                for i in range(len(high))
                if curve.stable[i] == 1.0 and not high[i]
            }
            assert stays["amplitude"] == max(heights) < told["amplitude"]
            assert (stays["frequency"], stays["error"]) == heights[stays["amplitude"]]


@pytest.fixture(scope="module")
def scene(tmp_path_factory):
    path = tmp_path_factory.mktemp("unknown") / "scene.toml"
    path.write_text(SCENE)
    return path


@pytest.fixture(scope="module")
def curve(scene):
    (curve,) = trace(package.load_scene(scene)).curves
    return curve


@pytest.mark.slow
def test_the_motion_jumps_where_it_is_said_that_it_may(scene, curve):
    """The exact motion, swept upwards in steps, leaves its branch long before the balance's own jump."""
    loaded = package.load_scene(scene)
    (exact,) = trace_exact(loaded, tuple(np.linspace(1.06, 1.16, 11))).curves
    (true,) = (jump for jump in exact.jumps() if jump.sweep == "up")
    first = next(one for one in curve.swept().unknown if one.sweep == "up")
    assert first.start < true.frequency < first.end
    assert next(jump.frequency for jump in curve.jumps() if jump.sweep == "up") > 1.5 * true.frequency


def test_at_the_peak_no_motion_stays(scene, curve):
    """What the exact motion does at its frequency, after the periodic one is lost, is far less."""
    peak = curve.peaks["d0"]
    assert peak.stable == 0.0
    (exact,) = trace_exact(package.load_scene(scene), (peak.frequency,)).curves
    assert exact.orbits.cycle_greatest[:, 0].max() < 0.5 * peak.amplitude


@pytest.mark.slow
def test_of_peaks_alone_a_loss_of_stability_is_where_the_whole_curve_has_it(scene):
    """No fold tells where, and the balance does not know: the whole curve is followed."""
    loaded = package.load_scene(scene)
    (whole,), (alone,) = (trace_exact(loaded, only=only).curves for only in (None, "peaks"))
    assert not whole.folds and alone.points < whole.points
    jumps = [[(jump.sweep, jump.frequency) for jump in one.jumps()] for one in (whole, alone)]
    assert jumps[0] == jumps[1] and {sweep for sweep, _ in jumps[0]} == {"up", "down"}


@pytest.mark.parametrize(("name", "harmonics"), [("yang1998-n5", 3), ("platform-damper", 1)])
def test_motions_across_contacts_are_read_again(name, harmonics):
    """In several harmonics, and in a plane: else a resumed run begins anew."""
    (one,) = trace(package.load_scene(name), harmonics=harmonics).curves
    (kept,) = unpacked(pickle.dumps([one]), KINDS)
    assert np.array_equal(kept.across.motion, one.across.motion, equal_nan=True)


def test_what_is_kept_of_an_interrupted_run_is_read_again(scene, curve):
    """Of a curve without its points, and of exact peaks alone: what sweeps meet is kept with them."""
    (alone,) = trace_exact(package.load_scene(scene), only="peaks").curves
    for one, said in ((without_points(curve), lambda c: c.extract.swept), (alone, lambda c: c.swept())):
        (kept,) = unpacked(pickle.dumps([one]), KINDS)
        met, found = (
            ([w.start for w in of.unknown], [jump.frequency for jump in of.jumps])
            for of in (said(one), said(kept))
        )
        assert any(met) and met == found


def test_it_begins_at_the_last_point_that_is_known_to_be_stable(curve):
    for one in curve.swept().unknown:
        (at,) = np.flatnonzero(curve.frequency == one.start)
        beside = curve.stable[[at - 1, at + 1]]
        assert curve.stable[at] == 1.0 and np.isnan(beside).any()
        assert one.before.tolist() == curve.amplitude[at].tolist()


def test_summary_and_file_say_the_same(fcm, scene, tmp_path, curve):
    (printed,) = json.loads(fcm("respond", str(scene), "--json", "-o", "a.nc").out)["curves"]
    found = [(one["sweep"], one["from"], one["to"]) for one in printed["stability_untold"]]
    assert found == [(one.sweep, one.start, one.end) for one in curve.swept().unknown]
    with netCDF4.Dataset(tmp_path / "a.nc") as file:
        (kept,) = json.loads(file.summary)["curves"]
        assert file["peak_stable"][:].tolist() == [[0.0] * 4]
    assert [peak["stable"] for peak in printed["peak"].values()] == [False] * 4
    assert kept["stability_untold"] == printed["stability_untold"]


@pytest.mark.parametrize("unknown", [(), (1, 2), (5, 6), (0,), (4, 5)])
def test_upwards_a_sweep_is_in_doubt_on_what_it_passes_alone(unknown):
    """Up along 0 to 3, jump at 3.0 onto the middle between 5 and 6, and on: by hand."""
    w = np.array([1.0, 2.0, 2.5, 3.0, 2.0, 2.5, 3.5, 4.0])
    a = np.array([1.0, 1.0, 1.0, 1.0, 3.0, 3.0, 3.0, 3.0])[:, None]
    stable = np.ones(8)
    stable[list(unknown)] = np.nan
    expected = {
        (): [],
        (1, 2): [(1.0, 3.0, 1.0)],
        (5, 6): [(3.0, 4.0, 3.0)],
        (0,): [(1.0, 2.0, 1.0)],
        (4, 5): [(3.0, 3.5, 3.0)],
    }
    found = swept(w, a, stable)
    assert [jump.frequency for jump in found.jumps if jump.sweep == "up"] == [3.0]
    ups = [one for one in found.unknown if one.sweep == "up"]
    assert [(one.start, one.end, one.before[0]) for one in ups] == expected[unknown]


def test_all_that_is_known_to_be_unstable_is_no_doubt():
    w = np.array([1.0, 2.0, 3.0])
    found = swept(w, w[:, None], np.zeros(3))
    assert found.jumps == found.unknown == []


@pytest.mark.parametrize("begin", range(8))
def test_where_a_closed_curve_begins_there_is_no_jump(begin):
    """A stable closed curve above another, wherever along it the first of its points is the last again."""
    angle = np.linspace(0.0, -2.0 * np.pi, 9)[:-1]
    closed = np.stack((2.0 + np.cos(angle), 5.0 + np.sin(angle), np.where(np.sin(angle) > -1e-9, 1.0, 0.0)))
    closed = np.roll(closed, -begin, axis=1)
    closed = np.concatenate((closed, closed[:, :1]), axis=1)
    below = np.array([[0.0, 1.5, 1.75, 4.0], [1.0, 1.0, 1.0, 1.0], [1.0, 1.0, 0.0, 1.0]])  # lost at 1.5
    w, a, stable = np.concatenate((below, np.full((3, 1), np.nan), closed), axis=1)
    up = [one for one in swept(w, a[:, None], stable).jumps if one.sweep == "up"]
    assert [one.frequency for one in up] == [1.5, 3.0]
    assert np.isnan(up[1].after)  # of the lower curve, beyond 1.75, no stable segment is left at 3


def test_sweeps_begin_with_a_stable_motion():
    """Of several at an end of the range, and further in where there is none: nothing jumps before."""
    w = np.array([1.0, 2.0, np.nan, 1.0, 2.0, 3.0, 4.0])
    a = np.array([1.0, 1.0, np.nan, 5.0, 6.0, 7.0, 8.0])
    stable = np.array([0.0, 0.0, np.nan, 1.0, 1.0, 1.0, 0.0])
    jumps = swept(w, a[:, None], stable).jumps
    assert [(one.sweep, one.frequency, one.before.item()) for one in jumps] == [("up", 3.0, 7.0)]


def test_where_a_growth_ends_in_what_is_not_told_no_point_alone_is_called_stable():
    """A light impact: unstable below 1.164 rad/s, and up to 1.17 or so it cannot be told."""
    given = {
        "modal": {
            "dofs": ["u", "v"],
            "frequency": [1.0, 1.374],
            "damping": [0.0083903, 0.017088],
            "shapes": [[1.2943, -2.167], [-0.71544, 0.76463]],
        },
        "contact": [
            {"name": "c", "tangential": "u", "normal": "v", "mu": 0.21551, "k_u": 0.66602, "k_v": 5.0822,
             "n_0": -0.12538},
        ],
        "force": [{"dof": "v", "amplitude": 1.0}],
        "response": {"frequency": [1.14, 1.2], "harmonics": 5},
    }  # fmt: skip
    curve = trace(scene_from_dict(given)).curves[0]
    assert (curve.stable == 0.0).any() and np.isnan(curve.stable).any()
    stable = np.concatenate(([False], curve.stable == 1.0, [False]))
    assert not (stable[1:-1] & ~stable[:-2] & ~stable[2:]).any()


@pytest.mark.parametrize("side", [1, -1])
@pytest.mark.parametrize("beyond", [0.0, np.nan])
def test_a_sweep_comes_to_a_change_of_stability_at_a_point_that_is_there_twice(side, beyond):
    """As one at a corner is, of which the first copy belongs to the side that is not stable."""
    frequency = np.array([1.0, 1.5, 2.0, 2.0, 2.5, 3.0])[::side]
    stable = np.array([0.0, 0.0, beyond, 1.0, 1.0, 1.0])[::side]
    found = swept(frequency, frequency[:, None], stable)
    assert [(one.sweep, one.frequency) for one in found.jumps] == [("down", 2.0)] and not found.unknown
