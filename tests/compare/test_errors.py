"""Errors against a reference, and how they are shown: a number, or a limit, or nothing."""

from dataclasses import replace

import numpy as np
import pytest

from fcm.compare.comparison import Comparison
from fcm.compare.errors import MEASURES, Reference, reference, worst
from fcm.compare.lines import Line
from fcm.compare.methods import CLOSED_FORM, EXACT, Run
from fcm.scene import load_scene


def line(peak=2.0, at=1.5, folds=(1.2, 1.1), complete=True):
    omega = np.linspace(1.0, 2.0, 50)
    amplitude = peak - np.abs(omega - at)[:, None] * np.ones(2)
    return Line(omega, amplitude, {"u": (peak, at), "v": (peak, at)}, folds, complete)


def test_peaks_and_folds_are_relative():
    errors = Reference("exact", 0.1, [line()]).errors([line(2.02, 1.515, (1.206, 1.1))])
    assert errors["peak"] == pytest.approx([0.01])
    assert errors["peak_frequency"] == pytest.approx([0.01])
    assert errors["fold"] == pytest.approx([0.005])


def test_different_numbers_of_folds_are_no_error_but_none():
    errors = Reference("exact", 0.1, [line(), line(folds=())]).errors([line(folds=(1.2,)), line(folds=())])
    assert np.isnan(errors["fold"]).all()
    assert np.isfinite(errors["peak"]).all()


def test_a_reference_that_is_not_complete_tells_nothing():
    errors = Reference("exact", 0.1, [line(complete=False), line()]).errors([line(), line()])
    assert all(np.isnan(errors[measure][0]) for measure in MEASURES)
    assert errors["peak"][1] == 0.0


def test_the_error_of_a_reference_is_what_longer_steps_change():
    one = reference("exact", 0.1, [line()], [line(2.002)], closure=1e-9)
    assert one.own["peak"] == pytest.approx([1e-3])
    assert one.own["peak_frequency"] == pytest.approx([1e-9])


def test_it_is_at_least_the_distance_of_the_points_of_the_other_run():
    """A corner between two points, which the other run has met."""
    there, bend = line(), line()
    lacking = replace(
        there, frequency=np.delete(there.frequency, 25), amplitude=np.delete(there.amplitude, 25, axis=0)
    )
    one = reference("exact", 0.1, [lacking], [bend], closure=0.0)
    assert one.own["points"] >= Reference("exact", 0.1, [lacking]).errors([bend])["points"] > 1e-4


@pytest.mark.parametrize(
    ("errors", "own", "text"),
    [
        ([1e-3, 2e-3], [1e-4, 1e-4], "2.0e-03"),
        ([1e-3, 2e-3], [1e-3, 1e-5], "< 1e-02"),  # the first may be anything below
        ([1e-3, 2e-2], [1e-3, 1e-5], "2.0e-02"),
        ([1e-9, 0.0], [2.1e-9, 1e-9], "< 3e-08"),
        ([np.nan, 5e-2], [np.nan, 1e-9], "5.0e-02"),
        ([np.nan], [1e-9], "-"),
    ],
)
def test_nothing_is_shown_that_is_less_than_ten_times_the_references_own(errors, own, text):
    assert str(worst(np.array(errors), np.array(own))) == text


def test_a_table_as_it_is_that_ends_a_curve_says_how_far_it_jumps():
    scene = load_scene("yang1998-n5")
    known = {name: Reference(name, 0.1, [line()]) for name in (CLOSED_FORM, EXACT)}
    stopped = Run("fast table", False, False, 0.05, [line(complete=False)], 1.0, 1.0, 10)
    made = Comparison(scene, references=known, runs=[stopped], seams={"fast table": 1.3e-3})
    (said,) = made.notes
    assert "fast table, as it is" in said and "curves stopped early with the longest step 0.05" in said
    assert "jump by up to 1.3e-03 at n0_bar = b_bar" in said
    (said,) = replace(made, runs=[replace(stopped, corrected=True)]).notes
    assert said.endswith("step 0.05")
    coarse = replace(stopped, max_step=0.2)
    (said,) = replace(made, runs=[stopped, coarse, replace(coarse, lines=[line()])]).notes  # said once
    assert "step 0.05, 0.2;" in said
