"""Stretches beside which the corrected curve is followed: past corners, by way of corners, and not at all."""

from dataclasses import replace

import numpy as np
import pytest

import fcm
from fcm.harmonic import corrected, stretch
from fcm.harmonic.believed import runs
from fcm.response import trace


def errors(name: str) -> list[float]:
    (curve,) = trace(replace(fcm.load_scene(name), harmonics=(1,))).curves
    return [peak.error for peak in curve.peaks.values()]


def test_past_corners_and_by_way_of_them_a_curve_is_the_same(monkeypatch):
    by_way = errors("beam")
    calls = []
    monkeypatch.setattr(stretch, "DEAR", 0)
    monkeypatch.setattr(stretch, "follow", lambda *a: calls.append(a[0].margins) or follow(*a))
    follow = fcm.continuation.follow
    past = errors("beam")
    assert calls == [0]
    assert np.isfinite(by_way).all()
    assert past == pytest.approx(by_way, rel=1e-9)


def test_where_the_work_is_limited_the_error_cannot_be_told(monkeypatch):
    monkeypatch.setattr(corrected, "EFFORT", 1.0)
    assert np.isnan(errors("beam")).any()


def needed(curve, first, last) -> float:
    """The effort that a stretch takes if its further harmonics have as many more corners and folds."""
    few, more = len(curve.corrector.system.harmonics), len(curve.sets(np.array([first, last])))
    assert few < more
    unknowns = len(curve.corrector.system.scene.contacts) * (2 + 4 * more)
    return curve.path.evaluations * (last - first) / len(curve.path.z) * more / few * unknowns**2


def test_a_stretch_that_takes_too_long_with_its_further_harmonics_is_not_begun(monkeypatch):
    """They make more corners and folds, so that more evaluations are needed than the curve itself took."""
    own, begun = stretch._followed, []

    def just_short(curve, first, last):
        curve.effort = 0.9 * needed(curve, first, last)
        return heights(curve, first, last)

    heights = stretch.heights
    monkeypatch.setattr("fcm.harmonic.crest.heights", just_short)
    monkeypatch.setattr(stretch, "_followed", lambda *a: begun.append(a) or own(*a))
    assert np.isnan(errors("beam")).any()
    assert not begun


def test_of_stretches_that_together_take_too_long_none_is_begun(monkeypatch):
    """Where one fits into the effort, and is begun, it is not for the same error if that takes two."""
    own, efforts, begun = stretch.heights, [], []
    monkeypatch.setattr("fcm.harmonic.crest.heights", lambda *a: efforts.append(needed(*a)) or own(*a))
    monkeypatch.setattr(stretch, "_followed", lambda *a: begun.append(a))
    errors("beam")
    assert len(efforts) == len(begun) == 1
    monkeypatch.setattr(corrected, "EFFORT", 1.5 * efforts[0])
    monkeypatch.setattr("fcm.harmonic.crest.runs", lambda missed: 2 * list(runs(missed)))
    assert np.isnan(errors("beam")).any()
    assert len(begun) == 1


def test_where_an_error_cannot_be_told_no_other_stretch_is_followed_for_it(monkeypatch):
    asked = []
    monkeypatch.setattr("fcm.harmonic.crest.heights", lambda *a: asked.append(a))
    monkeypatch.setattr("fcm.harmonic.crest.runs", lambda missed: 2 * list(runs(missed)))
    assert np.isnan(errors("beam")).any()
    assert len(asked) == 1


def test_all_stretches_of_a_curve_share_its_effort(monkeypatch):
    """One that just does for a stretch does not do for the same one again."""
    found = []
    own = stretch.heights

    def twice(curve, *ends):
        before = curve.effort
        first = own(curve, *ends)
        taken = before - curve.effort
        curve.effort = 0.5 * taken
        found.append((first, taken, own(curve, *ends)))
        return first

    monkeypatch.setattr("fcm.harmonic.crest.heights", twice)
    errors("beam")
    ((first, taken, again),) = found
    assert first is not None and 0.0 < taken < corrected.EFFORT
    assert again is None
