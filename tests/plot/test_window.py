"""A part of the axis of response curves."""

import numpy as np
import pytest

from fcm.plot import PlotError, draw_response
from fcm.plot.measured import DrawnMeasured
from fcm.plot.read import DrawnCurve, DrawnResponse
from fcm.plot.unfinished import COLOUR, Unfinished
from fcm.plot.window import within

from ..program import called

X = np.array([1.0, 2.0, 3.0, 4.0, 3.5, 2.5, 5.0])  # folded
CURVE = DrawnCurve({}, X, np.column_stack((10.0 * X, np.ones(7))))


def response(*curves, **others):
    return DrawnResponse(("u", "v"), "Hz", curves or (CURVE,), **others)


def test_a_curve_is_cut_where_its_line_passes_the_ends():
    (curve,) = within(response(), (2.25, 3.75)).curves
    there = np.isfinite(curve.frequency)
    assert curve.frequency[there] == pytest.approx([2.25, 3.0, 3.75, 3.5, 2.5, 3.75])
    assert curve.amplitude[there, 0] == pytest.approx(10.0 * curve.frequency[there])
    assert X.tolist() == CURVE.frequency.tolist() == [1.0, 2.0, 3.0, 4.0, 3.5, 2.5, 5.0]


def test_measured_points_beyond_are_left_out_and_only_ends_within_have_a_cross():
    points = DrawnMeasured("u", np.array([0.5, 3.0]), np.array([90.0, 30.0]))
    shown = response(measured=(points,), unfinished=Unfinished(("it stopped",), (1.0, 9.0)))
    assert within(shown, (2.25, 3.75)).measured[0].amplitude.tolist() == [30.0]
    for window, crosses in (((2.25, 3.75), 0), ((2.25, 6.0), 1)):
        (axes,) = draw_response(shown, window=window).axes
        assert axes.get_xlim() == window and axes.get_ylim()[1] < 60.0
        assert sum(line.get_color() == COLOUR for line in axes.lines) == crosses


@pytest.mark.slow
def test_a_window_that_shows_nothing_is_refused(tmp_path):
    with pytest.raises(PlotError, match="7 to 8 shows nothing; the curves go from 1 to 5"):
        within(response(), (7.0, 8.0))
    with pytest.raises(
        PlotError, match=r"nothing: no point lies between those at 2\.5 and 3; take a wider one"
    ):
        within(response(), (2.6, 2.61))
    path = tmp_path / "n5.nc"
    assert called("respond", "yang1998-n5", "--harmonics", 1, "-o", path).code == 0
    for options, said in (
        ((1.2, 1.1), "give the lower end first"),
        ((1.1, 1.2, "-o", tmp_path / "a.html"), "--window is of curves in .png"),
    ):
        assert said in called("plot", "response", path, "--window", *options).err
    done = called("plot", "response", path, "--window", 1.1, 1.3, "-o", tmp_path / "a.png")
    assert done.code == 0 and (tmp_path / "a.png").stat().st_size > 1000
