"""Points on both sides of every change of a contact's regime, and what they find."""

from dataclasses import replace

import numpy as np
import pytest

from fcm.response import trace
from fcm.scene import load_scene

from .random_scenes import AGREE, outcome, random_scene


@pytest.mark.slow
@pytest.mark.parametrize(("seed", "gap"), [(86, 1.2e-3), (182, 3e-5)])
def test_a_pair_of_folds_shorter_than_the_longest_step(seed, gap):
    # the pairs begin where a contact stops or begins to slip: a step of 0.1 went past them
    result = outcome(seed)
    assert result.disagreement < AGREE
    assert np.abs(np.diff(result.curves[0].folds)).min() < gap


@pytest.mark.slow
def test_the_curve_does_not_step_back_at_a_sharp_corner():
    # between a stuck contact and a slipping one this curve turns by more than a right angle
    assert outcome(3).disagreement < AGREE


@pytest.mark.slow
def test_a_corner_of_a_stiff_contact_past_a_right_angle_is_turned_at():
    """A contact that is 4e5 times as stiff as the structure opens, and the curve turns by 92 degrees."""
    scene = replace(random_scene(19), harmonics=(1, 2, 3, 4))
    curves = [trace(replace(scene, max_step=step)).curves[0] for step in (0.05, 0.02)]
    assert all(curve.complete for curve in curves)
    heights = [[peak.amplitude for peak in curve.peaks.values()] for curve in curves]
    np.testing.assert_allclose(*heights, rtol=1e-6)
    np.testing.assert_allclose(*(sorted(curve.folds) for curve in curves), rtol=1e-6)


@pytest.mark.slow
def test_points_closer_than_the_error_of_the_table_stay_in_their_order():
    # at the step of 0.1 the correction moved a point past its neighbour, which made two folds
    assert outcome(139).disagreement < AGREE


def test_the_regime_changes_between_points_close_to_each_other():
    curve = trace(load_scene("yang1998-n5")).curves[0]
    n0_bar, b_bar = curve.loop[:, 0, 0], curve.loop[:, 0, 1]
    opens = n0_bar < b_bar
    change = np.flatnonzero(opens[1:] != opens[:-1])
    assert change.size
    # at the onset of separation n0_bar = b_bar
    np.testing.assert_allclose(n0_bar[change], b_bar[change], rtol=2e-3)
    np.testing.assert_allclose(n0_bar[change + 1], b_bar[change + 1], rtol=2e-3)
