"""The motion of a schedule, written here by hand and drawn."""

from dataclasses import replace
from itertools import pairwise

import netCDF4
import numpy as np
import pytest

from fcm.plot import PlotError
from fcm.plot.history import draw_history
from fcm.plot.history_file import read_history

NAN = np.nan
CYCLES = 100  # of the first phase, of 2 s each; then half a cycle of 4 s


@pytest.fixture
def path(tmp_path):
    """Two curves, four samples a cycle; the second was interrupted after its third cycle."""
    path = tmp_path / "history.nc"
    count = CYCLES + 1
    instants = 4 * CYCLES + 3
    motion = np.tile([0.0, 3.0, 0.0, -1.0], count)[:instants] + np.zeros((2, 1))
    motion[1, 12:] = NAN
    least, greatest = np.full((2, count), -1.0), np.full((2, count), 3.0)
    mean = np.full((2, count), 1.0)
    mean[0, -1] = 2.0
    for values in (least, greatest, mean):
        values[1, 3:] = NAN
    elapsed = np.arange(instants) / 4
    elapsed[-1] = CYCLES + 0.5
    begin = np.append(2.0 * np.arange(CYCLES), 2.0 * CYCLES)
    sizes = {"curve": 2, "dof": 2, "instant": instants, "cycle": count, "schedule_phase": 2}
    variables = {
        "dof": (("dof",), np.array(["tip", "root"], object)),
        "contact.a.n_0": (("curve",), np.array([5.0, -1.0])),
        "time": (("instant",), np.where(elapsed > CYCLES, 4.0 * elapsed - 2.0 * CYCLES, 2.0 * elapsed)),
        "cycles": (("instant",), elapsed),
        "cycle_start": (("cycle",), begin),
        "cycle_elapsed": (("cycle",), np.arange(count, dtype=float)),
        "cycle_part": (("cycle",), np.append(np.ones(CYCLES), 0.5)),
        "schedule_frequency": (("schedule_phase",), np.array([0.5, 0.25])),
        "schedule_cycles": (("schedule_phase",), np.array([CYCLES, 0.5])),
        "schedule_start": (("schedule_phase",), np.array([0.0, 2.0 * CYCLES])),
    }
    of_dofs = {"displacement": motion, "cycle_least": least, "cycle_greatest": greatest, "cycle_mean": mean}
    for name, values in of_dofs.items():
        dims = ("curve", "instant" if name == "displacement" else "cycle", "dof")
        variables[name] = (dims, np.stack([values, -values], axis=2))
    with netCDF4.Dataset(path, "w") as data:
        data.frequency_unit = "Hz"
        for name, size in sizes.items():
            data.createDimension(name, size)
        for name, (dims, values) in variables.items():
            data.createVariable(name, str if values.dtype == object else float, dims)[...] = values
        data["contact.a.n_0"].long_name = "swept value of contact.a.n_0"
    return path


def test_a_motion_is_read_as_far_as_it_goes(path):
    history = read_history(path)
    whole, part = history.motions
    assert (history.dof, history.unit, history.axis) == ("tip", "Hz", "cycles")
    assert history.boundaries.tolist() == [0, CYCLES, CYCLES + 0.5]
    assert whole.edges.tolist() == [*range(CYCLES + 1), CYCLES + 0.5] and whole.displacement.size == 403
    assert part.edges.tolist() == [0, 1, 2, 3] and part.displacement.size == 12
    assert part.parameters == {"contact.a.n_0": -1.0}
    assert np.isnan(whole.mean[-1]) and (whole.mean[:-1] == 1.0).all()  # not of half a cycle


def test_times_and_other_dofs(path):
    history = read_history(path, "root", "time")
    assert history.boundaries.tolist() == [0, 2 * CYCLES, 2 * CYCLES + 2]
    assert history.motions[1].edges.tolist() == [0, 2, 4, 6]
    assert history.motions[0].greatest[0] == -3.0


def test_of_many_cycles_the_extent_is_drawn(path):
    first, second = draw_history(read_history(path)).axes
    band = first.patches[0]
    low, high = band.get_path().vertices[:, 1].min(), band.get_path().vertices[:, 1].max()
    assert (low, high) == (-1.0, 3.0)
    assert first.get_xlim() == (0, CYCLES + 0.5) == second.get_xlim()
    assert second.get_xlabel() == "Cycles" and "Displacement tip" in first.get_ylabel()
    assert "$n_{0}$ = 5" in first.get_ylabel() and "$n_{0}$ = −1" in second.get_ylabel()
    assert first.figure.legends and not second.patches  # three cycles are a line
    assert second.lines[0].get_ydata().tolist() == [0.0, 3.0, 0.0, -1.0] * 3


@pytest.mark.slow
def test_phases_are_bounded_and_named(path):
    axes = draw_history(read_history(path)).axes[0]
    (bound,) = (line for line in axes.lines if line.get_linestyle() != "-")
    assert bound.get_xdata()[0] == CYCLES
    (above,) = axes.child_axes
    assert [label.get_text() for label in above.get_xticklabels()] == ["I\n0.50", "II\n0.25"]
    assert above.get_xlabel() == "Frequency $f$ (Hz)"
    axes = draw_history(read_history(path), (3.0, 20.0)).axes[0]
    assert [label.get_text() for label in axes.child_axes[0].get_xticklabels()] == ["I\n0.50"]


@pytest.mark.parametrize("phases", [3, 10, 40, 300])
def test_names_of_phases_do_not_touch(path, phases):
    bounds = CYCLES * np.sort(np.random.default_rng(phases).uniform(size=phases + 1))
    bounds[[0, -1]] = 0.0, CYCLES
    history = replace(read_history(path), boundaries=bounds, frequency=np.linspace(118.25, 131.5, phases))
    figure = draw_history(history)
    figure.canvas.draw()
    labels = figure.axes[0].child_axes[0].get_xticklabels()
    boxes = [label.get_window_extent() for label in labels]
    assert len(labels) >= min(phases, 3)
    assert all(left.x1 < right.x0 for left, right in pairwise(boxes))
    assert boxes[0].x0 > 0.0 and boxes[-1].x1 < figure.bbox.width


def test_in_a_window_the_motion_is_drawn(path):
    axes = draw_history(read_history(path, axis="time"), (10.0, 14.0)).axes[0]
    assert axes.get_xlim() == (10.0, 14.0)
    line = axes.lines[0]
    assert line.get_xdata()[0] <= 10.0 and line.get_xdata()[-1] >= 14.0 and line.get_xdata().size < 20


def test_no_line_where_cycles_were_not_sampled(path):
    with netCDF4.Dataset(path, "a") as data:
        cycles = data["cycles"][:]
        cycles[8:] += 10.0
        data["cycles"][:] = cycles
    x = draw_history(read_history(path), (0.0, 13.0)).axes[0].lines[0].get_xdata()
    assert np.isnan(x).sum() == 1 and np.flatnonzero(np.isnan(x)) == [8]


@pytest.mark.parametrize("window", [(5.0, 5.0), (6.0, 5.0), (200.0, 300.0), (-5.0, 0.0), (NAN, 5.0)])
def test_windows_that_show_nothing(path, window):
    with pytest.raises(PlotError, match=r"shows nothing; the motion is from 0 to 100\.5 cycles"):
        draw_history(read_history(path), window)


def test_files_that_hold_no_motion(path):
    with pytest.raises(PlotError, match='no degree of freedom "x"; the file has "tip", "root"'):
        read_history(path, "x")
    with netCDF4.Dataset(path, "a") as data:
        for name in ("cycle_least", "displacement"):
            data[name][...] = NAN
    with pytest.raises(PlotError, match="holds no cycle"):
        read_history(path)
    with netCDF4.Dataset(path, "a") as data:
        data.renameVariable("cycles", "other")
    with pytest.raises(PlotError, match="has no variable cycles; try fcm plot history"):
        read_history(path)
    with pytest.raises(PlotError, match="is not there"):
        read_history(path.with_name("none.nc"))


def test_too_many_curves_are_refused(path):
    history = read_history(path)
    with pytest.raises(PlotError, match="choose at most 6"):
        draw_history(replace(history, motions=history.motions[:1] * 7))


def test_the_axis_has_the_unit_and_the_power_and_the_dof_is_one_that_the_scene_asks_for(path):
    """The power of ten stood on a number of the axis above."""
    with netCDF4.Dataset(path, "a") as data:
        data.output = '["root"]'
        data["displacement"].units = "m"
        for name in ("cycle_least", "cycle_greatest", "cycle_mean"):
            data[name][...] = 1e-4 * data[name][...]
    history = read_history(path)
    assert history.dof == "root" and read_history(path, "tip").dof == "tip"
    axes = draw_history(history).axes[0]
    assert axes.get_ylabel().split("\n")[0] == "Displacement root ($10^{-4}$ m)"
    assert "= 5" in axes.get_ylabel() and not axes.yaxis.get_offset_text().get_visible()
