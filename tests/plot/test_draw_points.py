"""Exact motions marked over curves: which markers are where, and what does not fit is said."""

from dataclasses import replace

import numpy as np
import pytest

from fcm.plot import DrawnCurve, DrawnPoints, DrawnResponse, PlotError, draw_response
from fcm.plot.measured import read_measured_points

KEY = "contact.shroud.n_0"
FREQUENCY = np.linspace(1.0, 2.0, 21)


def curve(n_0, frequency=FREQUENCY, **more):
    amplitude = 5.0 / (1.0 + (20.0 * (frequency - 1.5)) ** 2) + n_0
    parameters = {} if n_0 == 0.0 else {KEY: n_0}
    return DrawnCurve(parameters, frequency, np.column_stack([amplitude, 2.0 * amplitude]), **more)


def swept(*curves, unit="rad/s", dofs=("u", "v")):
    """Points of each curve at three frequencies upwards and then downwards."""
    at = np.array([1.2, 1.4, 1.6])
    both = np.concatenate((at, at[::-1])) / (2.0 * np.pi if unit == "Hz" else 1.0)
    marked = tuple(DrawnCurve(c.parameters, both, np.tile([[3.0, 4.0]], (6, 1))) for c in curves)
    ways = np.array(["up"] * 3 + ["down"] * 3)
    return DrawnPoints(DrawnResponse(dofs, unit, marked), (ways,) * len(curves))


def markers(figure):
    return [line for line in figure.axes[0].get_lines() if line.get_marker() in ("^", "v", "o")]


@pytest.mark.parametrize("unit", ["rad/s", "Hz"])
def test_triangles_point_where_the_sweep_went(unit):
    figure = draw_response(
        DrawnResponse(("u", "v"), "rad/s", (curve(0.0),)), "v", points=swept(curve(0.0), unit=unit)
    )
    up, down = markers(figure)
    assert (up.get_marker(), down.get_marker()) == ("^", "v")
    assert up.get_xdata() == pytest.approx([1.2, 1.4, 1.6])
    assert down.get_xdata() == pytest.approx([1.6, 1.4, 1.2])
    assert set(up.get_ydata()) == {4.0}
    (legend,) = figure.legends
    words = [text.get_text() for text in legend.get_texts()]
    assert words == ["harmonic balance", "exact motion, swept up", "swept down"]


def test_names_stay_within_the_frame_where_legends_above_and_below_take_room():
    curves = [
        curve(n_0, stable=FREQUENCY < 1.3, unknown=FREQUENCY > 1.8, truncation_error=0.5 * (FREQUENCY - 1.0))
        for n_0 in (1.0, 4.0)
    ]
    figure = draw_response(
        DrawnResponse(("u", "v"), "rad/s", tuple(curves)), points=swept(*curves), errors=False
    )
    figure.draw_without_rendering()
    axes, frame = figure.axes[0], figure.axes[0].get_window_extent()
    assert [len(legend.get_texts()) for legend in figure.legends] == [3, 4] and len(axes.texts) == 2
    assert all(text.get_window_extent().y1 < frame.y1 for text in axes.texts)


def test_points_have_the_colour_of_their_curve_in_any_order():
    curves = curve(1.0), curve(2.0)
    figure = draw_response(DrawnResponse(("u", "v"), "rad/s", curves), points=swept(curves[1], curves[0]))
    lines = [line for line in figure.axes[0].get_lines() if len(line.get_xdata()) == FREQUENCY.size]
    colours = [line.get_color() for line in markers(figure)]
    assert colours == [lines[i].get_color() for i in (1, 1, 0, 0)]


def test_a_traced_curve_is_marked_by_circles():
    traced = curve(0.0)
    points = DrawnPoints(DrawnResponse(("u", "v"), "rad/s", (traced,)), (np.full(FREQUENCY.size, ""),))
    figure = draw_response(DrawnResponse(("u", "v"), "rad/s", (traced,)), points=points)
    (circles,) = markers(figure)
    assert circles.get_marker() == "o"
    np.testing.assert_array_equal(circles.get_xdata(), FREQUENCY)


@pytest.mark.parametrize(
    ("points", "said"),
    [
        (swept(curve(3.0)), "that of the points with n_0 = 3; the curves have n_0 = 1, 2$"),
        (swept(curve(0.0)), "of the points of a scene without a sweep; the curves have n_0 = 1, 2$"),
        (swept(curve(1.0), unit="level"), "the curves are over frequency, the points over the level of the"),
        (swept(curve(1.0), dofs=("x", "y")), 'no degree of freedom "u"'),
    ],
)
def test_points_of_something_else_are_refused(points, said):
    with pytest.raises(PlotError, match=said):
        draw_response(DrawnResponse(("u", "v"), "rad/s", (curve(1.0), curve(2.0))), points=points)


def test_curves_without_room_for_their_names_are_named_in_a_legend_beside_points():
    """That legend names the curves alone: it once took the points for curves, too."""
    curves = tuple(curve(1.0 + 1e-9 * i) for i in range(12))
    figure = draw_response(DrawnResponse(("u", "v"), "rad/s", curves), points=swept(*curves))
    assert not figure.axes[0].texts
    named = [[text.get_text() for text in legend.get_texts()] for legend in figure.legends]
    assert len(named[-1]) == 12 and named[0] == ["harmonic balance", "exact motion, swept up", "swept down"]


def test_points_over_frequency_are_not_drawn_over_levels(tmp_path):
    """They were, with frequencies on the axis of the level."""
    over_levels = DrawnResponse(("u", "v"), "level", (curve(0.0),))
    with pytest.raises(PlotError, match="--points takes points over the level of the forces"):
        draw_response(over_levels, points=swept(curve(0.0)))
    path = tmp_path / "a.csv"
    path.write_text("frequency,amplitude\n1,2\n")
    with pytest.raises(
        PlotError, match=r"a\.csv: measured points are over frequency, the curves over the level"
    ):
        read_measured_points(path, "level")


def backbones(*parameters):
    x = np.array([1.3, 1.45, 1.55])
    each = tuple(DrawnCurve(one, x, np.column_stack((x, [3.0, 5.0, 9.0]))) for one in parameters)
    return DrawnResponse(("u", "v"), "rad/s", each)


@pytest.mark.slow
def test_a_backbone_of_other_swept_values_is_refused_and_the_forces_may_be_other_ones():
    """That of another preload was drawn over all curves."""
    response = DrawnResponse(("u", "v"), "rad/s", (curve(1.0), curve(2.0)))
    for own, said in (({KEY: 3.0}, "the mode with n_0 = 3"), ({}, "the mode of a scene without a sweep")):
        with pytest.raises(PlotError, match=f"no curve of the file is that of {said}; .* n_0 = 1, 2$"):
            draw_response(response, backbone=backbones({KEY: 1.0}, own))
    (line,) = backbone_lines(draw_response(response, backbone=backbones({KEY: 2.0})))
    curves = draw_response(response).axes[0].get_lines()
    assert line.get_color() == curves[1].get_color()
    levels = [replace(curve(0.0), parameters={"excitation.level": one}) for one in (1.0, 2.0)]
    assert backbone_lines(draw_response(replace(response, curves=tuple(levels)), backbone=backbones({})))


def test_a_backbone_ends_at_the_height_of_the_curves():
    """It left the axes at their top."""
    response = DrawnResponse(("u", "v"), "rad/s", (curve(0.0),))
    (line,) = backbone_lines(draw_response(response, "v", backbone=backbones({})))
    highest = 10.0
    assert np.nanmax(line.get_ydata()) == 9.0 < highest
    low = DrawnResponse(("u", "v"), "rad/s", (replace(curve(0.0), amplitude=0.6 * curve(0.0).amplitude),))
    (line,) = backbone_lines(draw_response(low, "v", backbone=backbones({})))
    there = np.isfinite(line.get_ydata())
    assert line.get_ydata()[there] == pytest.approx([3.0, 5.0, 6.0])
    assert line.get_xdata()[there] == pytest.approx([1.3, 1.45, 1.475])


def backbone_lines(figure):
    return [line for line in figure.axes[0].get_lines() if line.get_label() == "_backbone"]
