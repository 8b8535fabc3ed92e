"""Points evenly along a curve, of which those behind corners are crowded."""

from __future__ import annotations

import numpy as np
import pytest

from fcm.stability.spaced_points import SpacedPoints


def line(places):
    """Points of a straight curve."""
    return np.column_stack((np.full(len(places), 1.0), places))


@pytest.mark.parametrize(("count", "interval"), [(41, 10), (41, 16), (3, 16), (2, 4), (1, 4)])
def test_of_even_points_every_so_many_are_nodes(count, interval):
    spaced = SpacedPoints(line(1.002 ** np.arange(count)), True)
    nodes = spaced.nodes(0, count - 1, interval)
    assert nodes[0] == 0 and nodes[-1] == count - 1
    assert max(np.diff(nodes), default=0) <= interval
    assert len(nodes) <= 2 + (count - 1) // interval
    if count > 2:
        assert spaced.middle(0, count - 1) == (count - 1) // 2


def test_points_behind_a_corner_count_as_few():
    """A thousand of them in the middle of forty."""
    places = np.concatenate(
        (np.linspace(1.0, 1.1, 21), 1.1 + 1e-7 * np.arange(1, 1000), np.linspace(1.11, 1.2, 20))
    )
    crowded, each = SpacedPoints(line(places), True), SpacedPoints(line(places), False)
    last = len(places) - 1
    assert len(each.nodes(0, last, 16)) > 60
    nodes = crowded.nodes(0, last, 16)
    assert len(nodes) < 6
    assert max(np.diff(places[nodes])) < 17 * 0.005
    assert abs(places[crowded.middle(0, last)] - 1.1) < 0.01


def test_points_at_one_place_are_no_way():
    assert SpacedPoints(line(np.full(5, 1.0)), True).nodes(0, 4, 2)[-1] == 4
