"""Tracked curves end where their ranges do, or what is tracked ceases, and their points come in order."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from fcm.branches.trace import traced
from fcm.harmonic_balance.reported_quantities import reported_quantities
from fcm.harmonic_balance.system import System
from fcm.scene import load_scene
from fcm.scene.draft import number_of
from fcm.tracking import nonsmooth_continuation
from fcm.tracking.curves import tracked_curves
from fcm.tracking.extended_system import Condition, Kind
from fcm.tracking.options import TRACKING
from fcm.tracking.parameter_line import line_along
from fcm.tracking.tracked_point import Ending, TrackingSetup

SPAN, RANGE = (0.5, 0.7), (1.45, 1.65)  # in which the peak of x0 turns back where steps are short


@pytest.fixture(scope="module")
def scene():
    """With ends that are neither of the ranges."""
    path = Path(__file__).parents[1] / "harmonic_balance" / "scenes" / "chaos.toml"
    return replace(load_scene(path), frequency_range=RANGE)


def followed(scene, what, span):
    """Curves from three values of the level."""
    return tracked_curves(levels(scene, span, starts=3), [what]).curves


def levels(scene, span, starts, **more):
    """All curves over the level, from so many values of it, with more options of them."""
    options = replace(TRACKING, curves=replace(TRACKING.curves, start_values=starts, **more))
    return TrackingSetup(
        System(scene, (1, 2, 3)), line_along(number_of(scene, "level")), span, options=options
    )


@pytest.fixture(scope="module")
def found(scene):
    """Curves whose steps shrink to nothing where they turn, and which others leave by long ones."""
    return followed(scene, Condition(Kind.PEAK, 0), SPAN)


@pytest.mark.slow
def test_no_point_is_out_of_the_ranges(found):
    for one in found:
        assert SPAN[0] <= one.s.min() and one.s.max() <= SPAN[1]
        assert RANGE[0] <= one.frequency.min() and one.frequency.max() <= RANGE[1]


def test_a_curve_that_reaches_an_end_has_a_point_there(found):
    ends = [(ending, one, i) for one in found for ending, i in zip(one.endings, (0, -1), strict=True)]
    assert sum(ending is Ending.SPAN for ending, _, _ in ends) > len(found)
    for ending, one, i in ends:
        if ending is Ending.SPAN:
            assert one.s[i] in SPAN
        if ending is Ending.RANGE:
            assert one.frequency[i] in RANGE


def test_the_number_turns_back_only_where_it_is_said_to(found):
    assert any(one.turns() for one in found)
    for one in found:
        rises = np.sign(np.diff(one.s))
        back = [i + 1 for i in np.flatnonzero(rises[:-1] * rises[1:] < 0.0)]
        assert [i for i, _ in one.turns()] == back


def test_no_point_stands_twice_and_no_value_asked_for_is_passed_over(found):
    asked = np.linspace(*SPAN, 3)[1]
    assert sum((one.s == asked).any() for one in found) > 1
    for one in found:
        assert np.hypot(np.diff(one.s), np.diff(one.frequency)).min() > 0.0
        assert not ((one.s[:-1] - asked) * (one.s[1:] - asked) < 0.0).any()


@pytest.mark.slow
def test_a_curve_goes_on_where_the_response_is_an_isolated_point(scene):
    """Its peak and its trough meet there, and its folds, too: the response has no one direction."""
    span, isolated = (0.6, 0.68), 0
    narrow = replace(scene, frequency_range=(1.45, 1.56))
    pieces = TRACKING.pieces
    few = replace(TRACKING, pieces=replace(pieces, step=replace(pieces.step, max_steps=25)))
    setup = TrackingSetup(System(narrow, (1, 2, 3)), line_along(number_of(scene, "level")), span, options=few)
    made = followed(narrow, Condition(Kind.PEAK, 2), span)
    for one, (i, _) in [(curve, turn) for curve in made for turn in curve.turns()]:
        problem = setup.tracked(one.condition)
        problem.evaluate_scale(one.points[i].z)
        problem.evaluate(one.points[i].z)
        scale = np.array(problem.scale)[:-1]
        by_all = np.array(problem.jacobian)[:-1, :-1] * scale / scale[:-1, None]
        if np.linalg.svd(by_all)[1][-1] > 1e-6:
            continue
        isolated += 1
        for k in (i - 2, i - 3, i - 4):  # from wherever it is come to
            tracked_points, _ = nonsmooth_continuation.follow_special_point(
                setup, one.condition, one.points[k], one.s[k] < one.s[i]
            )
            assert next(point.z[-1] for point in tracked_points if point.turn) == pytest.approx(
                one.s[i], abs=1e-9
            )
            assert not tracked_points[-1].turn
    assert isolated > 1 and all(one.whole for one in made)


def tops(scene, dof, level, low, high):
    """Frequencies of an ordinary run's points in a window that are higher than their neighbours."""
    system = System(scene, (1, 2, 3))
    at = system.with_scene(number_of(scene, "level").put(scene, level))
    found = []
    for path in traced(at).branches.paths:
        height = reported_quantities(at, path).amplitude[:, dof]
        top = 1 + np.flatnonzero((height[1:-1] > height[:-2]) & (height[1:-1] > height[2:]))
        found += [omega for omega in path.parameter[top] if low < omega < high]
    return found


@pytest.mark.slow
def test_a_peak_ends_where_another_extreme_within_the_cycle_overtakes_it(scene):
    """The amplitude is half the range of the motion: ordinary runs have the peak before, and not beyond."""
    narrow = replace(scene, frequency_range=(1.55, 1.62), max_step=0.02)
    ends = [
        (one.s[i], one.frequency[i])
        for one in followed(narrow, Condition(Kind.PEAK, 1), (0.995, 1.02))
        for ending, i in zip(one.endings, (0, -1), strict=True)
        if ending is Ending.MET
    ]
    assert ends
    for level, omega in ends:
        counts = [len(tops(narrow, 1, level + by, omega - 4e-3, omega + 4e-3)) for by in (-8e-3, 8e-3)]
        assert max(counts) == min(counts) + 1


@pytest.mark.slow
def test_a_peak_at_which_no_curve_begins_is_told():
    """Each peak of ordinary runs at both ends of the level is on a curve, or is said to be on none.

    One stands out by 3e-6 of its height, at a corner. By default so little begins no curve.
    """
    other, span = (
        load_scene(Path(__file__).parents[1] / "harmonic_balance" / "scenes" / "sub.toml"),
        (0.7, 1.3),
    )
    made = tracked_curves(levels(other, span, starts=2, min_prominence=0.0), [Condition(Kind.PEAK, 0)])
    assert made.lost and made.curves
    for level in span:
        told = [z[-2] for _, z in made.lost if z[-1] == level]
        there = np.concatenate([one.frequency[one.s == level] for one in made.curves] + [told])
        expected = tops(other, 0, level, *other.frequency_range)
        assert expected and all(np.abs(there / omega - 1.0).min() < 1e-3 for omega in expected)
