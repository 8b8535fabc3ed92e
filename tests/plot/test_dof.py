"""A degree of freedom is found as a scene's are, however its node and direction are written."""

from __future__ import annotations

import pytest

from fcm.plot.dof import column_of
from fcm.plot.errors import PlotError


@pytest.mark.parametrize(
    "asked, place",
    [("2x", 1), ("2:1", 1), ("2:x", 1), ("2 1", 1), ("7:3", 2), ("7z", 2), ("tip", 0), (None, 0)],
)
def test_it_is_found(asked, place):
    assert column_of(("tip", "2:1", "7z"), asked) == place


def test_of_two_the_one_that_is_written_so():
    assert column_of(("1x", "x", "1:1:x"), "x") == 1


def test_what_is_not_there_is_said_with_what_is():
    with pytest.raises(PlotError, match='no degree of freedom "tpi"; the file has "tip", "2x"; did you mean'):
        column_of(("tip", "2x"), "tpi")
    with pytest.raises(PlotError, match=r'"11x", \.\.\. \(30 in all\)'):
        column_of([f"{node}x" for node in range(30)], "2y")
