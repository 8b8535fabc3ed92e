"""Hysteresis loops: what is drawn, its labels and units, and that nothing overlaps; no pixels."""

from itertools import combinations

import numpy as np
import pytest
from matplotlib.colors import to_rgb
from matplotlib.text import Text

import fcm
from fcm.plot.loop import STATES, DrawnLoop, LoopAxes, draw_loops

FIGURE_8 = [fcm.hysteresis_loop(0.32, 0.4, np.radians(phi)) for phi in (0.0, 45.0, 90.0, 135.0)]


def drawn(loops, axes=None, **scales):
    return draw_loops([DrawnLoop(loop, loop.sequence, **scales) for loop in loops], axes)


def panels(figure):
    """(loop, force over angle) of each."""
    above = [axes for axes in figure.axes if axes.get_title()]
    return list(zip(above, (axes for axes in figure.axes if axes not in above), strict=True))


def states(axes):
    """The states drawn, by their colours."""
    by_colour = {to_rgb(poll["color"]): state for state, (_, poll) in STATES.items()}
    lines = [line for line in axes.lines if line.get_linewidth() >= 1.0 and line.get_linestyle() != "None"]
    return [by_colour[to_rgb(line.get_color())] for line in lines]


def test_a_loop_of_several_harmonics_is_drawn_in_its_own_units():
    loop = fcm.periodic_loop([0.2, -2j, 0.0, 1.0], [0.0, 1.5], 0.4, 3.0, 1.0, 0.8)
    ((above, below),) = panels(drawn([loop]))
    assert states(above) == list(loop.sequence)
    assert set(states(below)) == set(loop.sequence)
    rings = [line for line in above.lines if line.get_marker() == "o"]
    assert [line.get_xdata()[0] for line in rings] == pytest.approx(loop.displacement(loop.angles))
    assert [line.get_ydata()[0] for line in rings] == pytest.approx(loop.force(loop.angles), abs=1e-12)
    theta = np.linspace(0.0, 2.0 * np.pi, 500)
    (left, right), (low, high) = above.get_xlim(), above.get_ylim()
    assert left < loop.displacement(theta).min() and loop.displacement(theta).max() < right
    assert low < loop.force(theta).min() and loop.force(theta).max() < high


def test_every_state_is_a_line_of_its_own_and_every_transition_marked():
    for loop, (above, below) in zip(FIGURE_8, panels(drawn(FIGURE_8)), strict=True):
        assert states(above) == list(loop.sequence)
        rings = [line for line in above.lines if line.get_marker() == "o"]
        assert [line.get_xdata()[0] for line in rings] == pytest.approx(np.sin(loop.angles))
        angles = {f"{np.degrees(angle) % 360.0:.1f}°" for angle in loop.angles}
        assert {text.get_text() for text in above.texts if text.get_text()} == angles
        assert set(states(below)) == set(loop.sequence)
        assert below.get_xlim() == (0.0, 360.0)


@pytest.mark.slow
def test_angles_of_hundreds_of_transitions_are_left_out():
    """There is no room for them, and to look for it would take minutes."""
    figure = drawn([fcm.periodic_loop([0, 1, *[0] * 48, 1], [0, 1], mu=0.4, k_u=1, k_v=1, n_0=1)])
    above = figure.axes[0]
    rings = [line for line in above.lines if line.get_marker() == "o"]
    assert len(rings) > 100 and not above.texts


def test_slip_limits_bound_the_force():
    (_, below), *_ = panels(drawn(FIGURE_8[1:2]))
    limits = [line for line in below.lines if line.get_label() == "_limit"]
    theta, upper = np.concatenate([line.get_xydata() for line in limits[1::2]]).T
    expected = np.maximum(0.32 + 0.4 * np.sin(np.radians(theta + 45.0)), 0.0)
    np.testing.assert_allclose(upper, expected, atol=1e-12)


@pytest.mark.slow
def test_slip_limits_that_are_not_seen_are_said_to_be_far():
    """The legend named a line that is nowhere in the picture."""
    stuck = drawn([fcm.hysteresis_loop(50.0, 0.1, 0.0)]).legends[0].get_texts()
    near = drawn(FIGURE_8[1:2]).legends[0].get_texts()
    assert [any("beyond the panel" in text.get_text() for text in texts) for texts in (stuck, near)] == [
        True,
        False,
    ]


def test_the_looks_are_told_apart_without_colour():
    looks = [poll for _, poll in STATES.values()]
    assert len({(str(poll["linestyle"]), poll["linewidth"]) for poll in looks}) == len(looks)
    grey = sorted(np.dot(to_rgb(poll["color"]), (0.299, 0.587, 0.114)) for poll in looks)
    assert grey[0] < 0.05


@pytest.mark.slow
def test_axes_without_dimension_and_with_units():
    (above, below), *_ = panels(drawn(FIGURE_8))
    assert (above.get_xlabel(), above.get_ylabel()) == (
        "Displacement $u/a$ (–)",
        "Friction force $f/k_u a$ (–)",
    )
    assert (below.get_xlabel(), below.get_ylabel()) == (r"Angle $\theta$ (°)", "Force (–)")
    figure = drawn(FIGURE_8[:1], LoopAxes.with_units(("mm", "N"), False), amplitude=2e-3, force=50.0)
    ((above, below),) = panels(figure)
    assert above.get_xlabel() == "Displacement $u$ ($10^{-3}$ mm)"  # of 2e-3 mm
    assert above.get_ylabel() == "Friction force $f$ (N)"
    assert below.get_ylabel() == "Force (N)"
    line = above.lines[3]  # after the two axes through zero and the separation
    np.testing.assert_allclose(line.get_ydata(), 50.0 * FIGURE_8[0].force(np.arcsin(line.get_xdata() / 2e-3)))


def test_angles_from_the_greatest_displacement():
    figure = drawn(FIGURE_8[1:2], LoopAxes(from_greatest=True))
    ((above, _),) = panels(figure)
    shown = sorted(float(text.get_text()[:-1]) for text in above.texts if text.get_text())
    assert shown == pytest.approx(sorted((np.degrees(FIGURE_8[1].angles) - 90.0) % 360.0), abs=0.051)


@pytest.mark.slow
@pytest.mark.parametrize(
    "parameters",
    [
        [(2.0, 0.1, 0.0)],
        [(-2.0, 1.0, 0.0)],
        [(1e6, 1e6, 1.0)],
        [(0.3, 2.0, phi) for phi in (0.0, 1e-3, np.pi)],
        [(0.32, 0.4, np.radians(phi)) for phi in range(0, 360, 30)],
    ],
)
def test_texts_touch_neither_each_other_nor_leave_the_picture(parameters):
    figure = drawn([fcm.hysteresis_loop(*one) for one in parameters])
    figure.draw_without_rendering()
    found = [figure.legends[0].get_texts()]  # and all but the numbers at the ticks
    for axes in figure.axes:
        found += [[axes.title, axes.xaxis.label, axes.yaxis.label], axes.texts]
    texts = [text for some in found for text in some if text.get_text().strip()]
    assert min(text.get_fontsize() for text in texts) >= 7.0
    boxes = [(text.get_text(), Text.get_window_extent(text).padded(-2)) for text in texts]
    assert [(a, b) for (a, x), (b, y) in combinations(boxes, 2) if x.overlaps(y)] == []
    assert all(box.x0 >= 0.0 and box.x1 <= figure.bbox.x1 for _, box in boxes)


@pytest.mark.slow
def test_angles_do_not_touch_the_ticks_of_the_frame():
    figure = drawn([fcm.hysteresis_loop(0.48, 0.4, np.radians(80.5)), *FIGURE_8])
    figure.draw_without_rendering()
    for above, _ in panels(figure):
        ticks = max(line.get_markersize() for line in above.get_xticklines() + above.get_yticklines())
        frame = above.get_window_extent().padded(-ticks * figure.dpi / 72.0)
        boxes = [Text.get_window_extent(text) for text in above.texts]
        assert len(boxes) > 3 and ticks > 0.0
        assert all(frame.contains(*corner) for box in boxes for corner in (box.min, box.max))


@pytest.mark.slow
@pytest.mark.parametrize(("count", "millimetres"), [(1, 85.0), (2, 170.0), (5, 170.0)])
def test_pictures_are_as_wide_as_columns(count, millimetres):
    figure = drawn([fcm.hysteresis_loop(0.5, 0.4, 0.1 * i) for i in range(count)])
    assert figure.get_figwidth() * 25.4 == pytest.approx(millimetres)
