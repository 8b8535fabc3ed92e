"""The multipliers of the guide's picture: each way drawn, and the balance's come to the exact ones."""

import numpy as np
import pytest

from ..time_domain.cases import yang
from .multipliers import ways_of
from .multipliers_picture import draw_multipliers


@pytest.fixture(scope="module")
def ways():
    return ways_of(yang(0.0), [0.72, 0.745, 0.78], (1, 9))


def test_with_more_harmonics_they_come_to_those_of_the_exact_motion(ways):
    one, nine, exact = (np.hypot(way.real, way.imaginary).max(axis=1) for way in ways)
    assert [way.name for way in ways] == ["1 harmonic", "9 harmonics", "exact"]
    assert np.abs(nine - exact).max() < 1e-3 < 5e-3 < np.abs(one - exact).max()
    assert (exact > 1.0).tolist() == [False, True, False]


def test_the_greatest_of_each_and_all_of_the_last_are_drawn(ways):
    left, right = draw_multipliers(ways).axes
    for line, way in zip(left.lines, ways, strict=False):
        assert line.get_ydata().tolist() == np.hypot(way.real, way.imaginary).max(axis=1).tolist()
    drawn = {(x, y) for line in right.lines[1:] for x, y in zip(*line.get_data(), strict=True)}
    last = ways[-1]
    assert drawn == set(zip(np.ravel(last.real).tolist(), np.ravel(last.imaginary).tolist(), strict=True))
