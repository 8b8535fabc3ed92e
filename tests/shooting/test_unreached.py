"""Stable motions at single frequencies to which no sweep comes."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from fcm import load_scene
from fcm.cli.exact import remarks
from fcm.response.coexisting_orbits import coexisting_orbits
from fcm.response.exact import trace_exact
from fcm.response.resumable_branches import CurveTimeLimit
from fcm.run import Report
from fcm.shooting.work_budget import UncertainFrequencies
from fcm.time_domain import simulate

from ..interrupted import interrupted_after
from ..program import called
from ..time_domain.cases import yang
from .curves import curve_of

HARMONIC = Path(__file__).parent.parent / "harmonic_balance" / "scenes"


@pytest.mark.parametrize(
    ("name", "omega", "marched"), [("isola", 1.22, (1.838, 18.047)), ("isola-stuck", 1.5, (0.6025, 12.680))]
)
def test_a_single_frequency_has_both_motions(name, omega, marched):
    """The fundamentals of v that marches of the contact's law in small steps have come to."""
    curve = curve_of(load_scene(HARMONIC / f"{name}.toml"), at=[omega])
    assert curve.complete and curve.orbits.sweep.tolist() == ["up", "down", ""]
    assert curve.fundamental[1:, 1] == pytest.approx(marched, rel=3e-4)
    assert (curve.stable == 1.0).all()


def test_single_frequencies_have_what_sweeps_from_far_come_to():
    """Between the folds there are two, beyond them one, which is not told twice."""
    curve = curve_of(yang(), at=[1.0, 1.21, 1.6])
    swept = curve.amplitude[curve.frequency == 1.21]
    alone = curve_of(yang(), at=[1.21]).amplitude[1:]
    np.testing.assert_allclose(alone, swept, rtol=1e-8)
    assert "" not in curve.orbits.sweep and curve_of(yang(), at=[1.0, 1.05]).points == 4


def test_they_go_on_as_they_are():
    scene = load_scene(HARMONIC / "isola.toml")
    limit = CurveTimeLimit(None, Report(lambda *_: None))
    _, found = coexisting_orbits(scene, [1.22], [], limit, UncertainFrequencies())
    last = simulate(scene, 1.22, 200, found.state).measures(last=1)[0]
    assert last.amplitude == pytest.approx(found.measure.amplitude, rel=1e-9)


def test_a_run_that_is_interrupted_goes_on_to_the_same(tmp_path):
    scene, at, keep = load_scene(HARMONIC / "isola.toml"), [1.2, 1.22], tmp_path / "kept"
    whole = curve_of(scene, at=at)
    first = curve_of(scene, at=at, keep=keep, progress=interrupted_after(5))
    assert first.reason.startswith("interrupted at") and first.points < whole.points
    again = curve_of(scene, at=at, keep=keep, resume=True)
    np.testing.assert_array_equal(again.amplitude, whole.amplitude)
    assert again.orbits.sweep.tolist() == ["up", "up", "down", "down", "", ""]


def test_they_are_said():
    run = called("respond", HARMONIC / "isola.toml", "--method", "exact", "--at", "1.22", "--json")
    (curve,) = json.loads(run.out)["curves"]
    (found,) = curve["unreached"]
    assert found["frequency"] == 1.22 and found["regime"] == ["SEPEN"]
    assert found["amplitude"]["v"] == curve["peak"]["v"]["amplitude"] > 17.0
    assert "neither sweep comes to (points without a sweep): 1, at 1.22 rad/s with u 8.3" in run.err


def test_from_rest_a_motion_of_three_periods_is_come_to():
    """Beside a motion of one period, which the balance has: least and greatest amplitude of its cycles by a
    march of the contact's law in 4000 steps a period, by Verlet's differences."""
    stop = load_scene(Path(__file__).parent / "scenes" / "stop.toml")
    response = trace_exact(stop, at=[1.074])
    (curve,) = response.curves
    assert curve.orbits.repeats.tolist() == [1, 1, 3]
    assert any("1, at 1.074 rad/s one of 3 periods with" in said for said in remarks(response))
    assert curve.orbits.cycle_least[2, 0] == pytest.approx(1.1344, abs=1e-3)
    assert curve.orbits.cycle_greatest[2, 0] == pytest.approx(1.9960, abs=1e-3)


def test_where_nothing_damps_what_it_begins_with_is_no_other_motion():
    scene = yang(-1e15)
    curve = curve_of(replace(scene, modal=replace(scene.modal, damping=np.zeros(2))), at=[0.9])
    assert curve.orbits.sweep.tolist() == ["up", "down"]


def test_branches_of_the_balance_lead_to_what_no_level_leads_to():
    """They do not hang together with rest there, and sweeps are irregular; the amplitudes are of a march
    in 80000 steps a period by Verlet's differences."""
    scene = load_scene(Path(__file__).parent / "scenes" / "hard_stop.toml")
    curve = curve_of(scene, at=[0.71058])
    assert curve.orbits.repeats.tolist() == [0, 0, 1] and curve.stable[2] == 1.0
    assert curve.amplitude[2] == pytest.approx([1.1080, 2.48515], rel=1e-3)
