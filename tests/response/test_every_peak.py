"""Peaks of a curve beside the highest: which are told, in the summary and in the table."""

import json
from pathlib import Path

import numpy as np
import pytest

from fcm.response import trace
from fcm.results.lower_peaks import lower_peaks
from fcm.scene import load_scene

from ..program import called

TWO_MODES = """
modal = { dofs = ["u", "v"], frequency = [1, 2], damping = [0.01, 0.02], shapes = [[1, 0.5], [0.3, -1]] }
force = [{ dof = "u", amplitude = 1.0 }]
contact = [{ name = "pad", tangential = "u", normal = "v", mu = 0.3, k_u = 0.1, k_v = 0.0, n_0 = 1e6 }]
response = { frequency = [0.5, 3.0], harmonics = 1, output = ["u"] }
"""


def peaks_of_linear(dof):
    """Local maxima of the linear response with the stuck spring, by a grid and a parabola."""
    shapes = np.array([[1.0, 0.5], [0.3, -1.0]])
    inverse = np.linalg.inv(shapes)
    of_modes = [np.array([1.0, 4.0]), 2.0 * np.array([0.01 * 1.0, 0.02 * 2.0])]
    K, C = (inverse @ np.diag(one) @ inverse.T for one in of_modes)
    M = inverse @ inverse.T
    K[0, 0] += 0.1
    omega = np.linspace(0.5, 3.0, 40001)
    x = np.array([abs(np.linalg.solve(K - w * w * M + 1j * w * C, [1.0, 0.0])[dof]) for w in omega])
    tops = np.flatnonzero((x[1:-1] > x[:-2]) & (x[1:-1] > x[2:])) + 1
    return omega[tops], x[tops]


@pytest.fixture(scope="module")
def summary(tmp_path_factory):
    path = tmp_path_factory.mktemp("peaks") / "a.toml"
    path.write_text(TWO_MODES)
    done = called("respond", path, "--json")
    assert done.code == 0, done.err
    return json.loads(done.out)


@pytest.mark.slow
def test_every_resonance_of_a_degree_of_freedom_is_told_by_frequency(summary):
    (curve,) = summary["curves"]
    for d, dof in enumerate("uv"):
        omega, height = peaks_of_linear(d)
        assert len(omega) == 2
        told = curve["peaks"][dof]
        assert [one["frequency"] for one in told] == pytest.approx(omega, rel=1e-3)
        assert max(one["amplitude"] for one in told) == curve["peak"][dof]["amplitude"]
        assert all(one["stable"] and not one["at_edge"] for one in told)
        for one, true in zip(
            told, height, strict=True
        ):  # errors are true: 0 is that of a peak that is located
            off = abs(one["amplitude"] / true - 1.0)
            assert off < 1.5 * one["error"] + 2e-6 and one["error"] < 1e-3
        low, high = sorted(told, key=lambda one: one["amplitude"])
        assert high["error"] == 0.0 < low["error"]


def test_the_table_has_those_of_the_output(tmp_path, summary):
    (tmp_path / "a.toml").write_text(TWO_MODES)
    out = called("respond", tmp_path / "a.toml").out
    _, table = out.split("degrees of freedom with several peaks, in order of frequency:\n")
    header, *rows = table.splitlines()
    assert header.split() == ["peak", "u", "at", "rad/s", "error"]
    told = summary["curves"][0]["peaks"]["u"]
    assert [row.split()[:2] for row in rows[:2]] == [
        [f"{one['amplitude']:#.6g}", f"{one['frequency']:#.6g}"] for one in told
    ]
    assert "several peaks" not in called("respond", "yang1998-n5").out  # it has one


def test_peaks_without_their_points_are_the_same(tmp_path, summary):
    (tmp_path / "a.toml").write_text(TWO_MODES)
    done = called("respond", tmp_path / "a.toml", "--peaks-only", "--json")
    assert json.loads(done.out)["curves"][0]["peaks"] == summary["curves"][0]["peaks"]


def test_ripples_and_what_is_far_below_are_none():
    ripple = np.array([0.0, 1.0, 0.995, 1.2, 0.9, 5.0, 0.1, 0.11, 0.09, 0.004, 0.0049, 0.001])
    assert lower_peaks(ripple[:, None]).tolist() == [[0, 3], [0, 7]]


def test_a_maximum_is_of_one_branch_and_no_end():
    nan = np.nan
    two = np.array([1.0, 3.0, 2.0, nan, 2.5, 1.0, 2.0, 1.5, nan, 9.0, 1.0])
    assert lower_peaks(two[:, None]).tolist() == [[0, 1], [0, 6]]
    assert lower_peaks(np.array([[1.0], [2.0]])).tolist() == []
    around = np.array([0.0, 5.0, 5.0 - 1e-15, 5.0, 1.0, 3.0, 0.0])  # one peak, but for rounding
    assert lower_peaks(around[:, None]).tolist() == [[0, 5]]


def test_where_the_error_of_a_peak_is_unknown_that_of_its_point_is_there():
    response = trace(load_scene("yang1998-n5"), harmonics=1)
    (curve,) = response.curves
    assert "error_at_frequency" not in curve.summary()["peak"]["u"]
    curve.peaks["u"] = curve.peaks["u"]._replace(error=np.nan)
    top = int(np.nanargmax(curve.amplitude[:, 0]))
    assert curve.summary()["peak"]["u"]["error_at_frequency"] == curve.error[top, 0] > 0.0


BRANCHES = Path(__file__).parents[1] / "branches/scenes"


@pytest.mark.slow
def test_a_peak_on_an_isolated_branch_is_marked():
    """The stop's isolated branch lies between its two folds, and the higher peak is on the other branch."""
    done = called("respond", BRANCHES / "closed_impact.toml", "--json")
    (curve,) = json.loads(done.out)["curves"]
    ((low, high),) = curve["isolated_branches"]
    assert (low, high) == pytest.approx((1.492, 1.969), rel=3e-3)  # of the exact motion
    assert min(abs(np.array(curve["folds"]) - low)) < 1e-3 > min(abs(np.array(curve["folds"]) - high))
    marked = [low <= one["frequency"] <= high and one["amplitude"] < 1.0 for one in curve["peaks"]["y"]]
    assert marked == [one.get("on_isolated_branch", False) for one in curve["peaks"]["y"]] == [True, False]
    done = called("respond", BRANCHES / "closed_impact.toml")
    assert f"{curve['peaks']['y'][0]['frequency']:.5f}^" in done.out and "^ on an isolated branch" in done.out


@pytest.mark.slow
def test_a_closed_branch_that_another_crosses_is_not_isolated():
    """Unsymmetric motions make a loop from the symmetric ones and back: a sweep may go on to it."""
    (curve,) = trace(load_scene(BRANCHES / "equal_stops.toml")).curves
    known, even = np.isfinite(curve.frequency), np.array(curve.harmonics) % 2 == 0
    unsymmetric = np.abs(curve.harmonic[:, even]).max(axis=(1, 2)) / np.abs(curve.harmonic).max(axis=(1, 2))
    loops = []
    for k in np.unique(curve.branch[known]):
        rows = np.flatnonzero((curve.branch == k) & known)
        ends = [np.append(curve.harmonic[i].ravel(), curve.frequency[i]) for i in rows[[0, -1]]]
        if np.allclose(*ends, rtol=1e-6, atol=1e-12) and curve.frequency[rows[0]] not in (0.6, 2.0):
            loops.append(unsymmetric[rows])
    assert len(loops) == 1 and loops[0].min() < 1e-12 and loops[0].max() > 0.01
    assert "isolated_branches" not in curve.summary()
