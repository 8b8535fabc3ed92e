"""Pictures of nonlinear modes: how many lines are named, and where the greatest damping is marked."""

import json
import re
from dataclasses import replace
from pathlib import Path

import netCDF4
import numpy as np
import pytest
from matplotlib.text import Text
from tests.program import called

import fcm
from fcm.plot import draw_response, read_response
from fcm.plot.error_panel import RANGE
from fcm.plot.mode import DrawnMode, DrawnModes, draw_modes, read_modes
from fcm.plot.unfinished import Unfinished

SCENES = Path(fcm.__file__).parent / "scenes"
AMPLITUDE = np.geomspace(0.1, 10.0, 41)


def modes(count, damping):
    each = [
        DrawnMode({"contact.shroud.n_0": float(n)}, np.full(41, 1.0 + n / 100), AMPLITUDE, damping)
        for n in range(count)
    ]
    return DrawnModes("", "Hz", tuple(each))


def rings(figure):
    return [line for line in figure.axes[1].lines if line.get_marker() == "o"]


def test_of_very_many_modes_the_colours_are_named_by_a_bar():
    few, many = (draw_modes(modes(count, np.full(41, 0.01))) for count in (20, 25))
    assert len(few.axes) == 2 and len(few.legends[0].get_texts()) == 20
    assert not many.legends
    (bar,) = (axes for axes in many.axes if axes.get_ylabel() == "$n_{0}$")
    assert [text.get_text() for text in bar.get_yticklabels()] == [str(n) for n in range(0, 25, 3)]


@pytest.mark.slow
def test_the_greatest_damping_is_marked_where_it_is_more_than_rounding():
    hill = 0.01 + 0.02 * np.exp(-(np.log(AMPLITUDE) ** 2))
    (ring,) = rings(draw_modes(modes(1, hill)))
    assert (ring.get_xdata()[0], ring.get_ydata()[0]) == (AMPLITUDE[20], 100.0 * hill[20])
    rounded = np.full(41, 0.007)
    rounded[7] = np.nextafter(0.007, 1.0)
    for damping in (rounded, np.linspace(0.01, 0.02, 41), np.linspace(0.02, 0.01, 41)):
        assert not rings(draw_modes(modes(1, damping)))


@pytest.mark.slow
def test_the_greatest_damping_is_named_inside_the_axes():
    for top in (0.15, 1.0, 8.0):
        figure = draw_modes(modes(1, 0.01 + 0.02 * np.exp(-(np.log(AMPLITUDE / top) ** 2))))
        figure.draw_without_rendering()
        (named,) = figure.axes[1].texts
        box, axes = named.get_window_extent(), figure.axes[1].get_window_extent()
        assert axes.x0 < box.x0 and box.x1 < axes.x1


def test_a_line_through_few_points_is_smooth_and_passes_them():
    """Of the exact curve 1 / (1 + a^2), of nine points; straight lines between these are farther off."""
    few = np.geomspace(0.1, 10.0, 9)
    mode = DrawnMode({}, 1.0 / (1.0 + few**2), few, np.zeros(9))
    amplitude, frequency = mode.smooth(mode.frequency)
    assert np.interp(few, amplitude, frequency) == pytest.approx(mode.frequency)
    exact = 1.0 / (1.0 + amplitude**2)
    straight = np.interp(np.log(amplitude), np.log(few), mode.frequency)
    assert np.abs(frequency - exact).max() < 0.5 * np.abs(straight - exact).max()
    assert frequency.min() >= mode.frequency.min() and frequency.max() <= mode.frequency.max()


def test_resonances_of_the_forces_are_marked_and_errors_drawn():
    """Each where it is told, and its damping on the line below it."""
    damping, error = np.full(41, 0.3), np.full(41, np.nan)
    error[5:7] = 0.02
    one = DrawnMode({}, np.full(41, 10.0), AMPLITUDE, damping, error, ((4.0, 2.0, 9.06),))
    upper, lower, below = draw_modes(DrawnModes("", "Hz", (one,))).axes
    (diamond,) = (line for line in upper.lines if line.get_marker() == "D")
    assert (diamond.get_xdata()[0], diamond.get_ydata()[0]) == (2.0, 9.06)
    assert [text.get_text() for text in upper.texts] == ["resonance, forces × 4"]
    (diamond,) = (line for line in lower.lines if line.get_marker() == "D")
    assert diamond.get_xdata()[0] == pytest.approx(2.0, rel=1e-2)
    assert diamond.get_ydata()[0] == pytest.approx(30.0)
    assert np.nansum(below.lines[0].get_ydata()) == 0.04


@pytest.mark.slow
def test_a_resonance_is_named_beside_the_line_and_within_the_axes():
    """Written over it, and over the frame above a line that is highest there."""
    for frequency in (np.full(41, 10.0), 10.0 - AMPLITUDE**2 / 20.0, 10.0 + AMPLITUDE**2 / 20.0):
        one = DrawnMode({}, frequency, AMPLITUDE, np.full(41, 0.3), resonances=((1.0, 1.0, 10.0),))
        figure = draw_modes(DrawnModes("", "Hz", (one,)))
        figure.draw_without_rendering()
        axes = figure.axes[0]
        (named,) = axes.texts
        box, frame = (
            Text.get_window_extent(named),
            axes.get_window_extent(),
        )  # without a thin line to the point
        assert frame.y0 < box.y0 and box.y1 < frame.y1 and frame.x0 < box.x0 and box.x1 < frame.x1
        fine = np.geomspace(AMPLITUDE[0], AMPLITUDE[-1], 2001)
        x, y = axes.transData.transform(np.column_stack([fine, np.interp(fine, AMPLITUDE, frequency)])).T
        assert not ((x > box.x0) & (x < box.x1) & (y > box.y0) & (y < box.y1)).any()


FREE = """
[modal]
dofs = ["x", "y"]
mass = [1.0, 1.0]
frequency = [0.0, 3.0]
damping = [0.0, 0.02]
shapes = [[1.0, 0.0], [0.5, 1.0]]
[[contact]]
name = "c"
tangential = "x"
normal = "y"
mu = 0.4
k_u = 1.0
k_v = 1.0
n_0 = 5.0
[[force]]
dof = "x"
amplitude = 1.0
[response]
frequency = [0.3, 4.0]
harmonics = 1
"""


@pytest.mark.slow
@pytest.mark.parametrize("number", [1, 2])
def test_where_there_is_no_steady_state_a_mode_is_dotted(number, tmp_path):
    """Nothing holds x but friction, which pushes one way as soon as the contact slips all the time.

    The first mode has two resonances, and is damped too much for one of them to have a frequency.
    """
    (tmp_path / "free.toml").write_text(FREE)
    options = ("--mode", number, "--level", "0.01:50", "-o", tmp_path / "m.nc", "--csv", tmp_path / "m.csv")
    done = called("respond", tmp_path / "free.toml", *options)
    assert done.code == 3 and "friction pushes the structure one way" in done.out
    (mode,) = read_modes(tmp_path / "m.nc").modes
    said = float(re.search(r"from modal amplitude (\S+) to 50", done.out)[1])
    assert mode.amplitude[~mode.steady].min() == pytest.approx(said, rel=1e-4)
    figure = draw_modes(read_modes(tmp_path / "m.nc"))
    for axes in figure.axes[:2]:
        solid, dotted = axes.lines[:2]
        assert np.nanmax(solid.get_xdata()[np.isfinite(solid.get_ydata())]) < said
        assert np.nanmax(dotted.get_xdata()[np.isfinite(dotted.get_ydata())]) == pytest.approx(50.0)
        assert dotted.get_linestyle() == "--" and solid.get_linestyle() == "-"  # of any dashes
    assert [text.get_text() for text in figure.axes[0].get_legend().get_texts()] == ["no steady state"]
    held = mode.amplitude[mode.steady].max()
    assert called("plot", "contacts", tmp_path / "m.nc").err.count(f"modal amplitude {held:.4g}") == 1
    assert f"modal amplitude {held:.4g}" in called("plot", "loop", tmp_path / "m.nc").err


def test_a_mode_is_drawn_by_a_degree_of_freedom_as_a_plain_line(tmp_path):
    """It was dotted as of unknown stability, above an empty panel of errors, with a cross where it begins."""
    (tmp_path / "free.toml").write_text(FREE)
    done = called(
        "respond", tmp_path / "free.toml", "--mode", 2, "--level", "0.01:50", "-o", tmp_path / "m.nc"
    )
    assert done.code == 3
    (axes,) = draw_response(read_response(tmp_path / "m.nc")).axes
    line, cross = axes.lines
    assert line.get_linestyle() == "-" and np.isfinite(line.get_ydata()).all()
    assert cross.get_marker() == "x" and cross.get_xdata().tolist() == [line.get_xdata()[-1]]
    assert axes.get_legend() is None


def test_few_errors_have_a_line_and_no_panel():
    error = np.full(41, np.nan)
    error[[5, 40]] = 0.02, 0.14
    one = DrawnMode({}, np.full(41, 10.0), AMPLITUDE, np.full(41, 0.3), error)
    _, lower = draw_modes(DrawnModes("", "Hz", (one,))).axes
    assert lower.get_title(loc="right").endswith("unknown but at 2 points, at most 0.14")
    error[40] = np.nan
    _, lower = draw_modes(DrawnModes("", "Hz", (one,))).axes
    assert lower.get_title(loc="right").endswith("unknown but at 1 point, 0.02")


def test_errors_of_linear_motions_alone_are_no_estimate():
    """A mode that slips beyond its fifth point said: at most 3.3e-17."""
    error = np.full(41, np.nan)
    error[:5] = 0.0, 3e-17, 0.0, 3e-17, 3e-17
    one = DrawnMode({}, np.full(41, 10.0), AMPLITUDE, np.full(41, 0.3), error)
    _, lower = draw_modes(DrawnModes("", "Hz", (one,))).axes
    end = f"unknown beyond {AMPLITUDE[4]:.2g}, up to where the motion is linear"
    assert lower.get_title(loc="right").endswith(end)


def test_a_mode_that_stopped_early_says_so_and_where():
    one = DrawnMode({}, np.full(41, 10.0), AMPLITUDE, np.full(41, 0.3))
    upper, _ = draw_modes(DrawnModes("", "Hz", (one,), unfinished=Unfinished(("stopped at 10",)))).axes
    (cross,) = (line for line in upper.lines if line.get_marker() == "x")
    assert cross.get_xdata().tolist() == [AMPLITUDE[-1]]
    assert upper.get_title(loc="left") == "NOT COMPLETE: stopped at 10"


def legend_of(figure):
    return [text.get_text() for legend in figure.legends for text in legend.get_texts()]


def test_marks_of_a_mode_are_named_and_resonances_are_said_to_be_estimates():
    """Diamonds and rings had no names, and the errors drawn are not those of the diamonds."""
    damping, error = 0.3 - 0.01 * np.abs(np.arange(41) - 20.0), np.full(41, 0.02)
    one = DrawnMode({}, np.full(41, 10.0), AMPLITUDE, damping, error, ((4.0, 2.0, 9.06),))
    marks = ["greatest damping", "below: error by harmonics left out"]
    assert legend_of(draw_modes(DrawnModes("", "Hz", (one,)))) == [
        "resonance with the scene's forces, an estimate as if the mode alone answered:\n"
        "damping puts it below the frequency of the mode",
        *marks,
    ]
    assert legend_of(draw_modes(DrawnModes("", "Hz", (replace(one, resonances=()),)))) == marks
    flat = replace(one, resonances=(), damping=np.full(41, 0.3), error=np.zeros(0))
    assert legend_of(draw_modes(DrawnModes("", "Hz", (flat,)))) == []


def test_the_axis_says_what_a_modal_amplitude_means(tmp_path):
    path = tmp_path / "beam.nc"
    done = called("respond", "beam", "--mode", 1, "--level", "1e-6:1e-5", "--harmonics", 1, "-o", path)
    read = read_modes(path)
    told = re.search(r"w15 ([\d.]+) m", done.out)[1]
    of_w15 = f"(1 means {float(told):.3g} m of w15, at the least amplitude)"
    assert draw_modes(read).axes[-1].get_xlabel() == f"Modal amplitude, of the mode of mass 1\n{of_w15}"
    several = replace(read, modes=read.modes * 2)
    assert draw_modes(several).axes[-1].get_xlabel() == "Modal amplitude, of the mode of mass 1"


def test_the_axis_says_it_of_what_the_scene_asks_for(tmp_path):
    """It was of whatever moves most, which are those of contacts, too."""
    text = (
        (SCENES / "yang1998-n5.toml")
        .read_text(encoding="utf-8")
        .replace("[response]", '[response]\noutput = ["v"]')
    )
    (tmp_path / "one.toml").write_text(text, encoding="utf-8")
    path = tmp_path / "one.nc"
    run = ("--mode", 1, "--level", "0.1:1", "--harmonics", 1, "-o", path)
    assert called("respond", tmp_path / "one.toml", *run).code == 0
    (mode,) = read_modes(path).modes
    assert list(mode.displacement) == ["v"]
    with netCDF4.Dataset(path) as data:
        assert set(json.loads(data.summary)["curves"][0]["mode"]["displacement"]) == {"u", "v"}


@pytest.mark.parametrize(("count", "lines"), [(6, 6), (7, 0)])
def test_the_errors_of_many_modes_are_one_line_the_greatest_of_all(count, lines):
    error = np.full(41, np.nan)
    error[[3, 4, 9]] = 0.01  # the last without a neighbour
    many = [
        DrawnMode({"contact.a.n_0": n}, np.full(41, 10.0), AMPLITUDE, np.full(41, 0.3), (n + 1) * error)
        for n in range(count)
    ]
    figure = draw_modes(DrawnModes("", "Hz", tuple(many)))
    below = figure.axes[2]
    assert len(below.lines) == lines
    if not lines:
        greatest, edges, _ = below.patches[-1].get_data()
        for k in (3, 4, 9):
            assert greatest[np.searchsorted(edges, AMPLITUDE[k], side="right") - 1] == pytest.approx(0.07)
        assert greatest[-1] < RANGE[0]
