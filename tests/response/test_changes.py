"""Points on both sides of every change of a contact's regime, and what they find."""

import numpy as np
import pytest

from fcm.response import trace
from fcm.scene import load_scene

from .random_scenes import AGREE, outcome


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
