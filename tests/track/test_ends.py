"""Tracked curves end where their ranges do, and their points come in the order along them."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from fcm.harmonic.system import System
from fcm.scene import load_scene
from fcm.scene.draft import number_of
from fcm.track import curves
from fcm.track.curves import tracks
from fcm.track.spot import Ending
from fcm.track.tracked import Condition, Kind
from fcm.track.varied import along

SPAN, RANGE = (0.5, 0.7), (1.45, 1.65)  # in which the peak of x0 turns back where steps are short


@pytest.fixture(scope="module")
def found():
    """Curves whose steps shrink to nothing where they turn, and which others leave by long ones."""
    path = Path(__file__).parents[1] / "harmonic" / "scenes" / "chaos.toml"
    scene = replace(load_scene(path), frequency_range=RANGE)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(curves, "STARTS", 3)
        line = along(number_of(scene, "level"))
        return tracks(System(scene, (1, 2, 3)), line, SPAN, [Condition(Kind.PEAK, 0)]).curves


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
