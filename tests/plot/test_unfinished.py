"""Curves that stopped early say so in their pictures, and where they end."""

import json
from dataclasses import replace

import netCDF4
import numpy as np
import pytest

from fcm.plot import DrawnCurve, DrawnResponse, draw_response, read_response
from fcm.plot.unfinished import Unfinished
from fcm.plot.window import within

from ..interrupted import Interrupting
from ..oscillator import oscillator

SCENE = 'title = "cut off"' + oscillator("[response]\nfrequency = [0.8, 1.6]\n", damping=0.05)


def drawn(reasons, *curves):
    response = DrawnResponse(("u",), "Hz", curves)
    return replace(response, unfinished=Unfinished(reasons, (1.0, 2.0)))


def curve(*frequencies):
    x = np.array(frequencies)
    return DrawnCurve({}, x, 3.0 - x[:, None])


def crosses(axes):
    return [line.get_xdata().tolist() for line in axes.lines if line.get_label() == "_unfinished"]


def test_a_cross_is_where_it_ends_and_the_axis_has_all_that_was_sought():
    response = drawn(("stopped at 1.4 Hz: no further point",), curve(1.0, 1.2, 1.4, np.nan, 2.0, 1.7))
    (axes,) = draw_response(response).axes
    assert crosses(axes) == [[1.4, 1.7]]
    assert axes.get_title(loc="left") == "NOT COMPLETE: stopped at 1.4 Hz: no further point"
    response = drawn(("stopped at 1.4 Hz",), curve(1.0, 1.2, 1.4))
    (axes,) = draw_response(response).axes
    assert axes.get_xlim() == (1.0, 2.0)


def test_a_curve_of_several_that_is_cut_off_is_counted():
    response = drawn(("", "interrupted before its stability was known", "stopped"), *(curve(1.0, 2.0),) * 3)
    (axes,) = draw_response(response).axes
    assert crosses(axes) == []  # both come to the end of the range
    said = axes.get_title(loc="left")
    assert said == "NOT COMPLETE: 2 of 3 curves; the first: interrupted before its stability was known"


@pytest.mark.slow
def test_a_fit_that_was_interrupted_is_said_over_whole_curves(tmp_path, fcm):
    """Its picture looked like that of the best numbers."""
    (tmp_path / "scene.toml").write_text(SCENE)
    assert fcm("respond", "scene.toml", "-o", "a.nc").code == 0
    titles = []
    for fitted in ({"final": False, "interrupted": True}, {"final": True, "interrupted": False}):
        with netCDF4.Dataset("a.nc", "a") as data:
            data.summary = json.dumps(json.loads(data.summary) | {"fitted": fitted})
        axes, *_ = draw_response(read_response(tmp_path / "a.nc")).axes
        titles.append(axes.get_title(loc="left").replace("\n", " "))
    assert titles == ["FIT NOT COMPLETE: interrupted: the numbers are the best so far", ""]


def test_a_part_of_the_axis_keeps_the_title_of_a_fit_that_is_not_complete():
    whole = drawn(("",), curve(1.0, 1.2, 1.4))
    whole = replace(whole, unfinished=replace(whole.unfinished, fit="interrupted"))
    (axes,) = draw_response(within(whole, (1.1, 1.3))).axes
    assert axes.get_title(loc="left") == "FIT NOT COMPLETE: interrupted"


def test_whole_curves_have_neither():
    (axes,) = draw_response(drawn(("",), curve(1.0, 1.5))).axes
    assert crosses(axes) == [] and axes.get_title(loc="left") == ""


@pytest.mark.parametrize("text", ["[1]", '{"curves": 3}', '{"curves": [3]}'])
def test_a_summary_that_is_of_something_else_is_refused(tmp_path, fcm, text):
    path = tmp_path / "a.nc"
    (tmp_path / "scene.toml").write_text(SCENE)
    assert fcm("respond", "scene.toml", "-o", path).code == 0
    with netCDF4.Dataset(path, "a") as data:
        data["complete"][:], data.summary = 0, text
    done = fcm("plot", "response", path)
    assert done.code == 2 and "its attribute summary is not of" in done.err


def test_an_interrupted_run_has_a_picture_that_says_so_and_no_doubts_of_what_was_not_sought(tmp_path, fcm):
    """Its stability was not looked for: rows said that a sweep may jump anywhere."""
    (tmp_path / "scene.toml").write_text(SCENE)
    done = fcm("respond", "scene.toml", "-o", "a.nc", messages=Interrupting("now its errors"))
    assert done.code == 3 and "NOT COMPLETE: interrupted" in done.out
    assert "between these stability is unknown" not in done.out
    assert read_response(tmp_path / "a.nc").unfinished.span == pytest.approx((0.8, 1.6))
    (axes, *_) = draw_response(read_response(tmp_path / "a.nc")).axes
    assert "NOT COMPLETE: interrupted before" in axes.get_title(loc="left")
