"""Exact curves that are interrupted while other motions are sought, or peaks alone, or irregular motions."""

from __future__ import annotations

import pickle
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import fcm
from fcm.response.curve_batches import KINDS
from fcm.response.options import RESPONSE
from fcm.response.resumable_branches import TimeOver
from fcm.results.orbits import Stuck
from fcm.run.records import unpacked
from fcm.shooting.options import SHOOTING

from ..interrupted import interrupted_after, interrupted_beyond
from ..time_domain.cases import yang
from .curves import between, curve_of, within

SCENES = Path(__file__).parent / "scenes"
AT = [1.4, 1.45, 1.5]  # up and down
EXTENT = ("family_least", "family_greatest", "family_complete")


@pytest.fixture(scope="module")
def scene():
    """One of two contacts never slips, and its residual friction decides what the other does."""
    found = fcm.load_scene(SCENES / "not_unique.toml")
    return replace(found, frequency_range=(1.4, 1.5), max_step=0.2)


class Looks:
    """Progress that counts the looks for other motions, and interrupts after so many."""

    def __init__(self, most=None):
        self.most, self.count = most, 0

    def __call__(self, _share, text):
        if "looking for other motions" in text:
            if self.count == self.most:
                raise KeyboardInterrupt
            self.count += 1


def assert_same(one, other):
    for name in ("frequency", "amplitude", "regime", "stable"):
        np.testing.assert_array_equal(getattr(one, name), getattr(other, name))
    for name in EXTENT:
        np.testing.assert_array_equal(getattr(one.orbits, name), getattr(other.orbits, name))


@pytest.mark.slow
@pytest.mark.parametrize("at", [None, AT])
def test_points_are_kept_and_extents_found_again(scene, tmp_path, at):
    whole = curve_of(scene, at=at)
    first = curve_of(scene, at=at, keep=tmp_path / "kept", progress=Looks(0))
    assert not first.complete and first.reason.startswith("interrupted at its end")
    np.testing.assert_array_equal(first.amplitude, whole.amplitude)
    known = np.isfinite(whole.orbits.family_greatest).all(axis=1)
    assert known.any() and np.isnan(first.orbits.family_greatest).all()
    assert (first.orbits.family_complete[known] == 0.0).all()
    assert_same(curve_of(scene, at=at, keep=tmp_path / "kept", resume=True), whole)


def test_extents_that_were_found_are_not_sought_again(scene, tmp_path):
    every, rest = Looks(), Looks()
    whole = curve_of(scene, at=AT, progress=every)
    first = curve_of(scene, at=AT, keep=tmp_path / "kept", progress=Looks(every.count // 2))
    told = first.orbits.family_complete == 1.0
    assert 0 < len(set(first.frequency[told])) < len(AT)
    again = curve_of(scene, at=AT, keep=tmp_path / "kept", resume=True, progress=rest)
    assert_same(again, whole)
    assert 0 < rest.count < every.count


def test_after_an_interruption_no_other_motions_are_sought(scene):
    """What was asked for is the end, not what takes longer than the curve itself."""
    looks, stops = Looks(), interrupted_after(3)

    def progress(share, text):
        looks(share, text)
        stops(share, text)

    curve = curve_of(scene, progress=progress)
    assert curve.points > 0 and curve.reason.startswith("interrupted at 1.")
    assert looks.count == 0


def test_of_a_run_that_goes_on_and_is_stopped_at_once_there_is_all_that_was(scene, tmp_path):
    """Before it has come to the curve again that was begun: nothing of that is lost."""
    first = curve_of(scene, keep=tmp_path / "kept", progress=interrupted_after(5))
    again = curve_of(scene, keep=tmp_path / "kept", resume=True, progress=interrupted_after(0))
    assert first.points > 0 and again.reason == first.reason
    np.testing.assert_array_equal(again.amplitude, first.amplitude)


@pytest.mark.slow
def test_so_there_is_of_motions_of_two_periods(tmp_path):
    """Of which the last branch that is followed is one."""
    scene = between(fcm.load_scene(SCENES / "irregular.toml"), 1.2, 1.25)
    begun, last = 0, np.inf

    def progress(share, text):
        nonlocal begun
        begun += text.endswith(": 1 points")
        if begun == last and share < 1.0:
            raise KeyboardInterrupt

    curve_of(scene, periods=2, progress=progress)
    begun, last = 0, begun
    first = curve_of(scene, keep=tmp_path / "kept", progress=progress, periods=2)
    assert set(first.orbits.repeats[np.isfinite(first.orbits.repeats)]) == {1.0, 2.0}
    again = curve_of(scene, keep=tmp_path / "kept", resume=True, periods=2, progress=interrupted_after(0))
    np.testing.assert_array_equal(again.amplitude, first.amplitude)
    np.testing.assert_array_equal(again.orbits.repeats, first.orbits.repeats)


def test_of_peaks_alone_those_that_were_found_are_kept():
    scene = between(yang(), 1.1, 1.3)
    whole = curve_of(scene, only="peaks")

    def third(_share, text):
        if re.search(r"\b[2-9] of [0-9]+ peaks and folds", text):
            raise KeyboardInterrupt

    curve = curve_of(scene, only="peaks", progress=third)
    found = curve.frequency[np.isfinite(curve.frequency)]
    assert 0 < found.size < np.isfinite(whole.frequency).sum()
    assert set(found) <= set(whole.frequency) and (np.diff(found) > 0.0).all()
    assert not curve.complete and curve.reason.startswith("interrupted at 1.")


def test_a_sweep_of_motions_that_repeat_after_two_periods_goes_on(tmp_path):
    """What was visited is there, and one more before the interruption is seen."""
    scene, keep = fcm.load_scene(SCENES / "two_periods.toml"), tmp_path / "kept"
    first = curve_of(scene, at=[2.02, 2.031], keep=keep, progress=interrupted_after(2))
    assert first.orbits.repeats.max() == 2
    again = curve_of(scene, at=[2.02, 2.031], keep=keep, resume=True, progress=interrupted_after(0))
    np.testing.assert_array_equal(again.amplitude[:-1], first.amplitude)


def test_a_curve_with_motions_beside_it_is_kept():
    """A record of it is read, of those that a run which is resumed goes on from."""
    curve = curve_of(between(yang(), 1.2, 1.21))
    curve.orbits.stuck = [Stuck(1.2, ("E",), np.zeros(1), np.ones(2), np.ones(2))]
    (kept,) = unpacked(pickle.dumps([curve]), KINDS)
    assert kept.orbits.stuck[0].states == ("E",)


@pytest.mark.slow
def test_what_lies_between_points_is_not_sought_when_there_is_no_time():
    """To find where stability is lost takes longer than the points themselves."""
    scene = between(fcm.load_scene(SCENES / "two_periods.toml"), 2.01, 2.05)
    whole = curve_of(scene)
    curve = curve_of(scene, progress=interrupted_beyond(0.8))
    assert curve.reason.startswith("interrupted at 2.0")
    assert set(curve.stable) == set(whole.stable[np.isfinite(whole.stable)]) == {0.0, 1.0}
    assert set(curve.frequency) < set(whole.frequency)


def test_of_a_curve_whose_time_is_over_no_period_is_computed_again():
    """Its points were recorded when the curve came to them, be anything else of them remembered or not."""
    looks, most = 0, np.inf

    def progress(share, _text):
        nonlocal looks
        looks += 1
        if looks > most and share < 1.0:
            raise TimeOver

    none = replace(SHOOTING, orbit=replace(SHOOTING.orbit, max_cached=0))
    forgetful, other = within(100.0, replace(RESPONSE, shooting=none)), within(100.0)
    curve_of(yang(5.0), options=forgetful, progress=progress)
    most, curves = 3 * looks // 10, []  # while the curve is followed
    for options in (forgetful, other):
        looks = 0
        curves.append(curve_of(yang(5.0), options=options, progress=progress))
    curve, remembered = curves
    assert curve.reason.startswith("not finished in 100 s") and np.isfinite(curve.amplitude).sum() > 20
    more = curve.orbits.periods - remembered.orbits.periods  # of a place that is asked for once more
    assert more < 0.25 * curve.points and remembered.orbits.periods > 100
