"""What is drawn: the lines, their labels, the axes; no pixels."""

from dataclasses import replace

import numpy as np
import pytest
from matplotlib.colors import to_rgb
from matplotlib.text import Annotation

from fcm.plot import DrawnCurve, DrawnResponse, PlotError, draw_response, save
from fcm.plot.measured import DrawnMeasured, FittedNumber
from fcm.plot.points import NEUTRAL, DrawnPoints

FREQUENCY = np.linspace(0.7, 1.7, 201)


def resonance(peak, at, n_0, **more):
    amplitude = peak / np.hypot(1.0, (FREQUENCY - at) * peak / 2)
    columns = np.column_stack([amplitude, amplitude / 4])
    return DrawnCurve({"contact.shroud.n_0": n_0}, FREQUENCY, columns, **more)


def response(*curves, unit="rad/s"):
    return DrawnResponse(("u", "v"), unit, curves)


def three():
    return response(
        resonance(35.0, 1.5, 100.0, regimes=frozenset({"E"})),
        resonance(6.2, 1.345, 10.0, regimes=frozenset({"E", "EPEN", "SEP"})),
        resonance(50.0, 1.0, -60.0, regimes=frozenset({"S"})),
    )


def names(axes):
    return [text.get_text() for text in axes.texts if isinstance(text, Annotation)]


def test_one_line_a_curve_holds_its_data():
    curves = three()
    (axes,) = draw_response(curves).axes
    assert len(axes.lines) == 3
    for line, curve in zip(axes.lines, curves.curves, strict=True):
        np.testing.assert_array_equal(line.get_xdata(), curve.frequency)
        np.testing.assert_array_equal(line.get_ydata(), curve.amplitude[:, 0])
        assert line.get_linestyle() == "-"


@pytest.mark.parametrize(
    ("unit", "label"), [("rad/s", "Frequency $\\omega$ (rad/s)"), ("Hz", "Frequency $f$ (Hz)")]
)
def test_axes_say_what_and_in_which_unit(unit, label):
    (axes,) = draw_response(response(resonance(9.0, 1.2, 5.0), unit=unit), dof="v").axes
    assert axes.get_xlabel() == label
    assert axes.get_ylabel() == "Amplitude of v"
    np.testing.assert_array_equal(axes.lines[0].get_ydata().max(), 9.0 / 4)


def test_of_many_degrees_of_freedom_that_of_the_greatest_peak_is_drawn():
    """Displacements before rotations, whose numbers are radians; of the few of a small scene the first."""
    peaks = {"1x": 1.0, "1y": np.nan, "2x": 3.0, "2y": 5.0, "2rz": 9.0}
    curves = [DrawnCurve({}, FREQUENCY, np.outer(np.ones(201), [*peaks.values()]) * k) for k in (1.0, 2.0)]
    (axes,) = draw_response(DrawnResponse(tuple(peaks), "rad/s", tuple(curves))).axes
    assert axes.get_ylabel() == "Amplitude of 2y" and axes.lines[0].get_ydata().max() == 5.0
    (axes,) = draw_response(DrawnResponse(tuple(peaks), "rad/s", tuple(curves)), dof="1x").axes
    assert axes.get_ylabel() == "Amplitude of 1x"
    few = [replace(curve, amplitude=curve.amplitude[:, [0, 1, 2, 3]]) for curve in curves]
    (axes,) = draw_response(DrawnResponse(tuple(peaks)[:4], "rad/s", tuple(few))).axes
    assert axes.get_ylabel() == "Amplitude of 1x"


def test_curves_carry_what_was_swept_at_their_peaks():
    (axes,) = draw_response(three()).axes
    assert names(axes) == ["$n_{0}$ = 100 (stuck)", "10", "−60 (open)"]
    for text, curve in zip(axes.texts, three().curves, strict=True):
        peak = curve.amplitude[:, 0].argmax()
        assert text.xy == (curve.frequency[peak], curve.amplitude[peak, 0])


def test_names_touch_neither_each_other_nor_a_line():
    figure = draw_response(three())
    figure.draw_without_rendering()
    (axes,) = figure.axes
    boxes = [text.get_window_extent() for text in axes.texts]
    assert not any(a.overlaps(b) for i, a in enumerate(boxes) for b in boxes[:i])
    for line in axes.lines:
        path = line.get_path().transformed(axes.transData)
        assert not any(path.intersects_bbox(box, filled=False) for box in boxes)


def test_names_touch_no_tick():
    """The ticks of the frame's upper edge went into the name of the highest curve."""
    curves = [replace(one, truncation_error=np.full(201, 1e-3)) for one in three().curves]
    figure = draw_response(response(*curves))
    figure.draw_without_rendering()
    axes, frame = figure.axes[0], figure.axes[0].get_window_extent()
    boxes = [text.get_window_extent() for text in axes.texts if isinstance(text, Annotation)]
    shown = [tick for tick in axes.xaxis.get_major_ticks() if 0.7 <= tick.get_loc() <= 1.7]
    assert len(boxes) == 3 and len(shown) >= 5
    for tick in shown:
        x, _ = axes.transData.transform((tick.get_loc(), 0.0))
        end = frame.y1 - tick.tick2line.get_markersize() * figure.dpi / 72.0
        assert not any(box.x0 < x < box.x1 and box.y1 > end for box in boxes)


def test_curves_that_leave_no_room_for_names_have_a_legend():
    same = [resonance(9.0, 1.2, float(n)) for n in range(8)]
    figure = draw_response(response(*same))
    (legend,) = figure.legends
    assert [text.get_text() for text in legend.get_texts()] == [f"$n_{{0}}$ = {n}" for n in range(8)]
    assert names(figure.axes[0]) == []


def test_several_swept_quantities_are_named_once_above_their_values_with_those_that_stay():
    keys = ("contact.a.n_0", "contact.b.n_0", "contact.a.mu")
    values = [(1.0, 2.0, 0.4), (1.0, 3.0, 0.4)]
    same = resonance(9.0, 1.2, 0.0)
    curves = [replace(same, parameters=dict(zip(keys, value, strict=True))) for value in values]
    (legend,) = draw_response(response(*curves * 5)).legends
    assert legend.get_title().get_text() == "contact.a.n_0 = 1,\ncontact.b.n_0,\n$\\mu$ = 0.4"
    assert [text.get_text() for text in legend.get_texts()][:2] == ["2", "3"]


def test_names_hold_no_mathematics_of_their_own():
    curves = [replace(resonance(9.0, 1.2, 0.0), parameters={"contact.$a_{.tangential.$u": n}) for n in (1, 2)]
    figure = draw_response(DrawnResponse(("$u_{", "v"), "rad/s", tuple(curves * 4)))
    figure.draw_without_rendering()
    assert figure.axes[0].get_ylabel() == "Amplitude of $u_{"


def test_of_very_many_curves_the_colours_are_named_by_a_bar():
    many = [resonance(5.0 + n / 10, 0.9 + n / 200, float(n)) for n in range(100)]
    figure = draw_response(response(*many))
    assert not figure.legends
    (bar,) = (axes for axes in figure.axes if axes.get_ylabel() == "$n_{0}$")
    names = [text.get_text() for text in bar.get_yticklabels()]
    assert (names[0], names[-1], len(names)) == ("0", "99", 9)
    assert [float(name) for name in names] == [round(place) for place in bar.get_yticks()]
    assert len(figure.axes[0].lines) == 100


def test_a_scene_without_a_sweep_has_one_unnamed_black_line():
    figure = draw_response(response(DrawnCurve({}, FREQUENCY, np.ones((201, 2)))))
    (axes,) = figure.axes
    assert to_rgb(axes.lines[0].get_color()) == (0, 0, 0)
    assert not figure.legends and not axes.texts


def test_unstable_parts_are_dashed_and_join_the_stable_ones():
    stable = np.ones(201, bool)
    stable[80:90] = False
    figure = draw_response(response(resonance(9.0, 1.2, 5.0, stable=stable)))
    solid, dashed = figure.axes[0].lines
    assert solid.get_linestyle() == "-" and dashed.get_linestyle() == "--"
    assert solid.get_color() == dashed.get_color()
    assert np.flatnonzero(np.isnan(solid.get_ydata())).tolist() == list(range(80, 90))
    assert np.flatnonzero(np.isfinite(dashed.get_ydata())).tolist() == list(range(79, 91))
    assert [text.get_text() for text in figure.legends[0].get_texts()] == ["stable curve", "unstable"]


def test_parts_of_which_stability_is_not_told_are_dotted_and_the_legend_says_so():
    stable, unknown = np.ones((2, 201), bool)
    stable[80:90], unknown[:] = False, False
    unknown[120:140] = True
    figure = draw_response(response(resonance(9.0, 1.2, 5.0, stable=stable, unknown=unknown)))
    solid, dashed, dotted = figure.axes[0].lines
    assert np.isnan(solid.get_ydata()).sum() == 30 and np.isfinite(dashed.get_ydata()).sum() == 12
    assert np.flatnonzero(np.isfinite(dotted.get_ydata())).tolist() == list(range(119, 141))
    assert [text.get_text() for text in figure.legends[0].get_texts()] == [
        "stable curve",
        "unstable",
        "stability unknown",
    ]


@pytest.mark.parametrize(
    ("least", "log", "scale"),
    [(6.0, None, "linear"), (4.0, None, "log"), (4.0, False, "linear"), (6.0, True, "log")],
)
def test_axis_is_logarithmic_when_peaks_span_a_decade_or_on_request(least, log, scale):
    curves = response(resonance(50.0, 1.0, 0.0), resonance(least, 1.3, 1.0))
    assert draw_response(curves, log=log).axes[0].get_yscale() == scale


def test_logarithmic_ticks_are_plain_numbers():
    figure = draw_response(three(), log=True)
    figure.draw_without_rendering()
    assert {"1", "2", "5", "10"} <= {tick.get_text() for tick in figure.axes[0].get_yticklabels()}


def test_colours_go_from_dark_to_light():
    colours = [to_rgb(line.get_color()) for line in draw_response(three()).axes[0].lines]
    light = [np.dot((0.2126, 0.7152, 0.0722), colour) for colour in colours]
    assert light == sorted(light) and light[-1] < 0.75


def test_what_cannot_be_drawn_is_said():
    with pytest.raises(PlotError, match='no degree of freedom "w"; the file has "u", "v"'):
        draw_response(three(), dof="w")
    with pytest.raises(PlotError, match="no point"):
        draw_response(response(DrawnCurve({}, np.empty(0), np.empty((0, 2)))))


def test_a_curve_of_one_point_is_drawn():
    figure = draw_response(response(DrawnCurve({"contact.a.n_0": 1.0}, FREQUENCY[:1], np.ones((1, 2)))))
    shown = [
        line.get_xydata().tolist() for line in figure.axes[0].lines if line.get_marker() not in ("None", "")
    ]
    assert [[FREQUENCY[0], 1.0]] in shown


@pytest.mark.slow
@pytest.mark.parametrize("ending", [".png", ".svg", ".pdf"])
def test_the_same_figure_gives_the_same_bytes(tmp_path, ending):
    for name in "ab":
        save(draw_response(three()), tmp_path / (name + ending))
    first, second = ((tmp_path / (name + ending)).read_bytes() for name in "ab")
    assert first == second
    assert first.startswith({".png": b"\x89PNG", ".svg": b"<?xml", ".pdf": b"%PDF"}[ending])


def with_errors(curve, table, truncation):
    return replace(curve, table_error=table, truncation_error=truncation)


def test_the_legend_of_all_that_lines_mean_is_within_the_picture():
    """With errors of the table and of the harmonics, unstable, unknown and doubtful parts of two curves."""
    large, table = np.where(FREQUENCY < 1.1, 0.5, 1e-3), np.full(201, 1e-6)
    stable, unknown = np.abs(FREQUENCY - 1.3) > 0.05, np.abs(FREQUENCY - 1.5) < 0.05
    curves = [
        replace(with_errors(resonance(peak, 1.2, 5.0), table, large), stable=stable, unknown=unknown)
        for peak in (9.0, 7.0)
    ]
    figure = draw_response(response(*curves))
    figure.draw_without_rendering()
    legend = next(one for one in figure.legends if len(one.get_texts()) > 3)
    box = legend.get_window_extent()
    assert len(legend.get_texts()) == 6 and figure.bbox.x0 <= box.x0 and box.x1 <= figure.bbox.x1


def test_errors_are_drawn_below_the_curves():
    table = np.where(FREQUENCY < 1.2, 1e-6, 0.0)
    truncation = np.where(np.abs(FREQUENCY - 1.2) < 0.1, 1e-3, 0.0)
    curves = [with_errors(resonance(9.0, 1.2, 5.0), table, truncation), resonance(7.0, 1.3, 1.0)]
    axes, below = draw_response(response(*curves)).axes
    (line,), (area,) = below.lines, below.patches
    assert below.get_yscale() == "log" and below.get_ylabel() == "Relative error"
    assert below.get_xlabel() == "Frequency $\\omega$ (rad/s)" and axes.get_xlabel() == ""
    assert line.get_color() == axes.lines[0].get_color()
    known = truncation > 0.0
    np.testing.assert_array_equal(line.get_ydata()[known], 1e-3)
    assert line.get_ydata()[~known].max() < below.get_ylim()[0]  # drawn down to the axis, not broken off
    values, edges, _ = area.get_data()
    assert set(values[edges[1:] < 1.19]) == {1e-6} and values[edges[:-1] > 1.21].max() < below.get_ylim()[0]


def test_the_area_holds_the_largest_error_of_the_table():
    small, large = np.full(201, 1e-7), np.full(201, 1e-5)
    large[:100] = 0.0
    curves = [
        with_errors(resonance(p, 1.2, p), error, 0.0 * error) for p, error in ((9.0, small), (7.0, large))
    ]
    figure = draw_response(response(*curves))
    (area,) = figure.axes[1].patches
    values, edges, _ = area.get_data()
    assert set(values[edges[1:] < 1.19]) == {1e-7} and set(values[edges[:-1] > 1.2]) == {1e-5}
    assert [text.get_text() for text in figure.legends[0].get_texts()] == [
        "below: error by harmonics left out",
        "below: error by the table (greatest)",
    ]  # fmt: skip
    stands = [line.get_color() for line in figure.legends[0].get_lines()]
    assert stands == [NEUTRAL]  # it had the colour of the first curve
    alone = draw_response(response(curves[0]))
    assert alone.legends[0].get_lines()[0].get_color() == alone.axes[0].get_lines()[0].get_color()


def test_the_area_is_not_drawn_between_branches():
    apart = FREQUENCY.copy()
    apart[50:150] = np.nan
    curve = with_errors(replace(resonance(9.0, 1.2, 5.0), frequency=apart), np.full(201, 1e-6), np.zeros(201))
    (area,) = draw_response(response(curve)).axes[1].patches
    values, edges, _ = area.get_data()
    assert values[(edges[:-1] > 0.96) & (edges[1:] < 1.44)].max() < 1e-8 < values[0]


@pytest.mark.slow
def test_no_panel_without_errors_or_when_not_wanted():
    none = with_errors(resonance(9.0, 1.2, 5.0), np.zeros(201), np.zeros(201))
    some = with_errors(resonance(9.0, 1.2, 5.0), np.zeros(201), np.full(201, 1e-3))
    assert len(draw_response(response(none)).axes) == 1
    assert len(draw_response(response(some), errors=False).axes) == 1
    figure = draw_response(response(some))
    assert len(figure.axes) == 2 and len(figure.legends[0].get_texts()) == 1


def test_errors_above_one_and_of_a_single_point_are_drawn():
    one = DrawnCurve(
        {}, FREQUENCY[:1], np.ones((1, 2)), table_error=np.ones(1), truncation_error=np.full(1, 3.0)
    )
    figure = draw_response(response(one))
    figure.draw_without_rendering()
    assert figure.axes[1].get_ylim()[1] == 3.0


def test_frequencies_over_decades_are_on_a_logarithmic_axis():
    curve = resonance(35.0, 1.5, 100.0, truncation_error=np.full(201, 0.1), table_error=np.full(201, 1e-3))
    far = replace(curve, frequency=np.geomspace(1e-3, 1e3, 201))
    for axes in draw_response(response(far)).axes:
        assert axes.get_xscale() == "log"
    for axes in draw_response(response(curve)).axes:
        assert axes.get_xscale() == "linear"


def test_the_table_error_is_found_at_its_place_on_a_logarithmic_axis():
    frequency = np.geomspace(1e-4, 1e4, 201)
    error = np.where(frequency < 1.0, 1e-3, 0.0)
    curve = replace(resonance(35.0, 1.5, 100.0), frequency=frequency, table_error=error)
    below = draw_response(response(curve)).axes[1]
    (area,) = below.patches
    values, edges, _baseline = area.get_data()
    assert edges[60] == pytest.approx(1.0)
    assert (values[:59] == 1e-3).all() and (values[61:] < 1e-20).all()


def test_what_does_not_move_has_no_logarithmic_axis():
    curve = resonance(35.0, 1.5, 100.0)
    still = replace(curve, amplitude=0.0 * curve.amplitude)
    draw_response(response(still))
    with pytest.raises(PlotError, match="does not move"):
        draw_response(response(still), log=True)


@pytest.mark.parametrize(("last", "faded"), [(1.3, True), (1.005, False)])
def test_a_wide_stretch_whose_error_is_not_known_is_faded_and_the_legend_says_so(last, faded):
    """One as narrow as that of a fold is not."""
    error = np.where((FREQUENCY >= 1.0) & (FREQUENCY <= last), np.nan, 1e-3)
    curve = with_errors(resonance(9.0, 1.2, 5.0), np.zeros(201), error)
    figure = draw_response(response(curve))
    faint = [line.get_xydata() for line in figure.axes[0].lines if line.get_alpha() is not None]
    faint = [line[np.isfinite(line[:, 1]), 0] for line in faint if line[np.isfinite(line[:, 1])].size]
    said = [text.get_text() for legend in _legends(figure) for text in legend.get_texts()]
    assert any("unknown amount" in one for one in said) == faded
    if faded:
        assert any(abs(x[0] - 1.0) < 0.01 and abs(x[-1] - last) < 0.01 for x in faint)


def _legends(figure):
    own = [axes.get_legend() for axes in figure.axes]
    return [*figure.legends, *(one for one in own if one is not None)]


def test_a_level_curve_is_below_the_frame():
    height = np.full((201, 2), 1e-8)
    height[::2] += 1e-20
    (axes,) = draw_response(response(replace(resonance(35.0, 1.5, 100.0), amplitude=height))).axes
    bottom, top = axes.get_ylim()
    assert bottom == 0.0 and top > 1.04e-8


def test_a_unit_of_length_is_in_the_label():
    one = replace(response(resonance(5.0, 1.0, 1.0)), length="mm")
    assert draw_response(one).axes[0].get_ylabel().endswith("(mm)")


def test_the_numbers_that_a_fit_found_stand_beside_what_was_measured():
    found = (
        FittedNumber("contact.shroud.mu", 0.301234, 0.0042),
        FittedNumber("contact.shroud.n_0", 9.0, np.nan),
    )
    points = DrawnMeasured("u", FREQUENCY[:3], FREQUENCY[:3])
    drawn = replace(response(resonance(9.0, 1.2, 5.0)), measured=(points,), fitted=found)
    (legend,) = draw_response(drawn).legends
    assert [text.get_text() for text in legend.get_texts()] == [
        "measured",
        "contact.shroud.mu = 0.3012 ± 0.0042",
        "contact.shroud.n_0 = 9, standard error unknown",
    ]


def test_the_names_of_fitted_numbers_lie_within_the_picture():
    """Three beside each other were cut off at its left."""
    found = [
        FittedNumber(f"contact.shroud_of_blade.{key}", 0.123456, 0.00042) for key in ("mu", "k_u", "k_v")
    ]
    points = DrawnMeasured("u", FREQUENCY[:3], FREQUENCY[:3])
    figure = draw_response(
        replace(response(resonance(9.0, 1.2, 5.0)), measured=(points,), fitted=tuple(found))
    )
    figure.draw_without_rendering()
    (legend,) = figure.legends
    assert len(legend.get_texts()) == 4
    assert legend.get_window_extent().x0 >= 0.0


@pytest.mark.parametrize("count", [1, 3, 6])
@pytest.mark.parametrize("errors", [False, True])
def test_fitted_numbers_and_names_of_curves_do_not_overlap(count, errors):
    """Names of equal curves find no room at their peaks, and stood upon the numbers."""
    numbers = tuple(FittedNumber(f"contact.shroud.number_{k}", 1.23e-4, 0.5e-6) for k in range(count))
    points = DrawnMeasured("u", FREQUENCY[:3], FREQUENCY[:3])
    error = np.full(FREQUENCY.size, 1e-3) if errors else None
    curves = [
        resonance(9.0, 1.2, n_0, truncation_error=error, regimes=frozenset("E")) for n_0 in range(100, 108)
    ]
    figure = draw_response(replace(response(*curves), measured=(points,), fitted=numbers))
    figure.draw_without_rendering()
    boxes = [legend.get_window_extent() for legend in figure.legends]
    boxes += [axes.get_tightbbox() for axes in figure.axes]
    assert len(figure.legends) == 2 + errors
    for i, one in enumerate(boxes):
        assert figure.bbox.x0 <= one.x0 and one.x1 <= figure.bbox.x1
        assert not any(one.overlaps(other) for other in boxes[:i])


def test_points_of_the_exact_motion_and_measured_ones_share_a_legend():
    curve = resonance(9.0, 1.2, 5.0)
    exact = DrawnPoints(response(curve), (np.full(FREQUENCY.size, "up"),))
    drawn = replace(response(curve), measured=(DrawnMeasured("u", FREQUENCY[:3], FREQUENCY[:3]),))
    (legend,) = draw_response(drawn, points=exact).legends
    names = [text.get_text() for text in legend.get_texts()]
    assert names == ["harmonic balance", "exact motion, swept up", "measured"]


def test_the_legend_names_no_line_that_is_too_short_to_be_seen():
    """A hook a hundred-thousandth of the range wide is unstable, and nobody finds its dashes."""
    for width, named in ((1e-6, False), (0.1, True)):
        x = np.sort(np.concatenate((FREQUENCY, 1.2 + width * np.array([-2, -1, 1, 2]))))
        stable = np.abs(x - 1.2) > width * 1.01
        one = DrawnCurve({}, x, np.full((x.size, 2), 2.0), stable)
        legends = draw_response(response(one)).legends
        assert bool(legends) is named
        assert not named or [text.get_text() for text in legends[0].get_texts()] == [
            "stable curve",
            "unstable",
        ]


@pytest.mark.slow
def test_a_backbone_is_drawn_within_the_axes_of_the_curves():
    """In the unit of the curves, of the same degree of freedom; else it is said why not."""
    mode = DrawnCurve(
        {}, 2.0 * np.pi * np.array([1.3, 1.2, 1.1]), np.array([[0.1, 1.0], [2.0, 3.0], [99.0, 9.0]])
    )
    modes = DrawnResponse(("v", "u"), "rad/s", (mode,))
    drawn = response(resonance(9.0, 1.2, 5.0), unit="Hz")
    (axes,) = draw_response(drawn, backbone=modes).axes
    (line,) = (line for line in axes.lines if line.get_label() == "_backbone")
    assert line.get_xdata() == pytest.approx([1.3, 1.2, 1.1]) and line.get_ydata().tolist() == [1.0, 3.0, 9.0]
    (before,) = draw_response(drawn).axes
    assert axes.get_xlim() == before.get_xlim() and axes.get_ylim() == before.get_ylim()
    with pytest.raises(PlotError, match=r"from 96\.9115 to 98\.1681 rad/s, are not within the range"):
        draw_response(
            response(resonance(9.0, 1.2, 5.0)),
            backbone=replace(modes, curves=(replace(mode, frequency=mode.frequency + 90),)),
        )
    with pytest.raises(PlotError, match='the modes have "v", "w"'):
        draw_response(drawn, backbone=replace(modes, dofs=("v", "w")))


@pytest.mark.parametrize(("count", "lines"), [(6, 6), (7, 0)])
def test_the_errors_of_many_curves_are_one_line_the_greatest_of_all(count, lines):
    """Lines of all were a tangle."""
    error = 1e-6 * np.linspace(1.0, 5.0, 201)
    curves = [resonance(9.0, 1.2, float(n), truncation_error=(n + 1) * error) for n in range(count)]
    figure = draw_response(response(*curves))
    below = next(axes for axes in figure.axes if axes.get_ylabel() == "Relative error")
    assert len(below.lines) == lines
    named = [text.get_text() for legend in figure.legends for text in legend.get_texts()]
    together = "below: error by harmonics left out (greatest)"
    assert (together in named) == (not lines)
    if not lines:
        greatest, edges, _ = below.patches[-1].get_data()
        middle = np.interp(0.5 * (edges[1:] + edges[:-1]), FREQUENCY, count * error)
        assert (greatest >= middle * (1.0 - 1e-12)).all() and greatest == pytest.approx(middle, rel=0.05)
        assert below.get_ylim()[1] >= greatest.max()


def test_many_random_draws_are_told_apart_by_what_else_was_swept_alone():
    """A bar had their values, in the order of drawing, as if colours were a scale."""
    mu = np.random.default_rng(0).normal(0.4, 0.05, 15)
    curves = [
        replace(one, parameters={**one.parameters, "contact.shroud.mu": value})
        for n_0 in (5.0, 8.0)
        for value in mu.tolist()
        for one in [resonance(9.0 + value, 1.2, n_0)]
    ]
    both = ("contact.shroud.n_0", "contact.shroud.mu")
    for drawn, colours, names in ((both, 1, []), (both[1:], 2, ["$n_{0}$ = 5", "$n_{0}$ = 8"])):
        figure = draw_response(replace(response(*curves), drawn=drawn))
        (axes,) = figure.axes
        assert len({line.get_color() for line in axes.lines}) == colours
        assert [text.get_text() for legend in figure.legends for text in legend.get_texts()] == names
        said = ", ".join({both[0]: "$n_{0}$", both[1]: "$\\mu$"}[key] for key in drawn)
        assert axes.get_title(loc="right") == f"30 curves, random draws of {said}"
