"""The peaks of a sweep as drawn: lines, a cloud, the least of all; from the file to the picture."""

from dataclasses import replace

import numpy as np
import pytest

from fcm.plot.errors import PlotError
from fcm.plot.peak import Peaks, draw_peak, read_peaks
from fcm.response import trace
from fcm.results.output import write_netcdf
from fcm.scene import load_scene

from ..program import called

N_0, MU = "contact.shroud.n_0", "contact.shroud.mu"


def peaks(**parameters):
    """Least at n_0 = 10 for mu = 0.4, higher for any other mu."""
    swept = {{"n_0": N_0, "mu": MU}[key]: np.asarray(values, float) for key, values in parameters.items()}
    n_0, mu = swept[N_0], swept.get(MU, np.full(len(swept[N_0]), 0.4))
    amplitude = 6.0 + np.abs(n_0 - 10.0) / 5.0 + 10.0 * np.abs(mu - 0.4)
    amplitude = np.column_stack([amplitude, 0.1 * amplitude[::-1]])
    frequency = np.column_stack([1.0 + n_0 / 100.0, 1.0 + n_0 / 200.0])
    return Peaks(("u", "v"), "rad/s", swept, amplitude, frequency, np.full(len(n_0), True))


def title(axes):
    return axes.get_title(loc="right")


def test_the_least_peak_is_marked_on_a_line_in_order():
    upper, lower = draw_peak(peaks(n_0=[50, 10, -20, 0])).axes
    line, ring = upper.lines[:2]
    assert line.get_xdata().tolist() == [-20, 0, 10, 50]
    assert line.get_ydata().tolist() == pytest.approx([12, 8, 6, 14])
    assert (ring.get_xdata()[0], ring.get_ydata()[0]) == (10.0, 6.0)
    assert title(upper) == "least peak 6 at $n_{0}$ = 10"
    assert lower.lines[0].get_ydata().tolist() == pytest.approx([0.8, 1.0, 1.1, 1.5])
    assert "contact.shroud.n_0" in lower.get_xlabel() and "rad/s" in lower.get_ylabel()


def test_peaks_that_are_nearly_equal_lie_within_the_axes():
    found = peaks(n_0=[8, 10, 12])
    found.amplitude[:] = [[6.0, 1.0], [5.8, 1.0], [5.9, 1.0]]
    low, high = draw_peak(found).axes[0].get_ylim()
    assert low == 0.0 and 1.02 * 6.0 < high < 1.2 * 6.0


def test_frequencies_that_are_nearly_equal_are_read_from_their_ticks():
    found = peaks(n_0=[8, 10, 12])
    found.frequency[:] = np.array([[197.989], [197.993], [197.991]])
    figure = draw_peak(found)
    figure.canvas.draw()
    axis = figure.axes[1].yaxis
    assert axis.get_offset_text().get_text() == ""
    assert any("197.991" in label.get_text() for label in axis.get_ticklabels())


def test_another_degree_of_freedom():
    upper, _ = draw_peak(peaks(n_0=[0, 10, 50]), dof="v").axes
    assert upper.lines[0].get_ydata().tolist() == pytest.approx([1.4, 0.6, 0.8])
    assert upper.get_ylabel() == "Peak amplitude of v"


def test_a_line_for_each_of_the_other_values():
    n_0, mu = (x.ravel() for x in np.meshgrid([0, 10, 20], [0.2, 0.4], indexing="ij"))
    figure = draw_peak(peaks(n_0=n_0, mu=mu))
    upper, _ = figure.axes
    assert [line.get_xdata().tolist() for line in upper.lines[:2]] == [[0, 10, 20]] * 2
    assert [text.get_text() for text in figure.legends[0].get_texts()] == ["$\\mu$ = 0.2", "$\\mu$ = 0.4"]
    assert title(upper) == "least peak 6 at $n_{0}$ = 10, $\\mu$ = 0.4"
    assert draw_peak(peaks(n_0=n_0, mu=mu), against=MU).axes[1].get_xlabel().startswith("$\\mu$")


def test_nothing_is_drawn_between_engine_orders():
    one = peaks(n_0=[3, 2, 4])
    whole = {"cyclic.engine_order": one.parameters[N_0]}
    figure = draw_peak(Peaks(one.dofs, "Hz", whole, one.amplitude, one.frequency, one.complete))
    for axes, drawn in zip(figure.axes, (one.amplitude, one.frequency), strict=True):
        points = axes.lines[0]
        assert (points.get_linestyle(), points.get_marker()) == ("None", "o")
        assert points.get_xdata().tolist() == [2, 3, 4]
        assert points.get_ydata().tolist() == drawn[[1, 0, 2], 0].tolist()
    assert all(value == round(value) for value in figure.axes[1].get_xticks())


def test_keys_that_go_in_step_are_one_line_without_a_name():
    figure = draw_peak(peaks(n_0=[10, 30, 20, 40], mu=[0.1, 0.3, 0.2, 0.4]))
    assert figure.axes[0].lines[0].get_xdata().tolist() == [10, 20, 30, 40]
    assert not figure.legends


def test_random_draws_are_points_without_lines():
    random = np.random.default_rng(0)
    upper, lower = draw_peak(peaks(n_0=random.normal(10, 3, 50), mu=random.normal(0.4, 0.05, 50))).axes
    assert upper.lines[0].get_linestyle() == lower.lines[0].get_linestyle() == "None"
    assert len(upper.lines[0].get_xdata()) == 50


def test_a_curve_that_is_not_complete_is_not_drawn():
    some = peaks(n_0=[0, 10, 20])
    some.complete[1] = False
    upper, lower = draw_peak(some).axes
    assert upper.lines[0].get_xdata().tolist() == [0, 20]
    assert title(lower) == "NOT COMPLETE: 1 of 3 curves, left out"
    some.complete[:] = False
    with pytest.raises(PlotError, match="no complete curve"):
        draw_peak(some)


def test_peaks_at_which_no_motion_stays_are_crossed():
    some = replace(peaks(n_0=[0, 10, 20]), stable=np.array([[0.0, 1], [1, 1], [0, 1]]))
    upper, lower = draw_peak(some).axes
    for axes, values in ((upper, some.amplitude), (lower, some.frequency)):
        (cross,) = (line for line in axes.lines if line.get_marker() == "x")
        assert cross.get_xdata().tolist() == [0, 20]
        assert cross.get_ydata().tolist() == values[[0, 2], 0].tolist()
    assert "not stable" in lower.get_title(loc="left")
    for settled in (draw_peak(some, dof="v"), draw_peak(peaks(n_0=[0, 10, 20]))):
        assert not any(line.get_marker() == "x" for axes in settled.axes for line in axes.lines)


def test_peaks_of_unknown_stability_have_squares():
    some = replace(peaks(n_0=[0, 10, 20]), stable=np.array([[0.0, 1], [np.nan, 1], [1, 1]]))
    upper, lower = draw_peak(some).axes
    for axes, values in ((upper, some.amplitude), (lower, some.frequency)):
        (square,) = (line for line in axes.lines if line.get_marker() == "s")
        assert square.get_xdata().tolist() == [10] and square.get_ydata().tolist() == [values[1, 0]]
    crosses, squares = lower.get_title(loc="left").split("\n")
    assert "not stable" in crosses and squares == "\u25a1 whether the motion is stable there is unknown"
    settled = draw_peak(some, dof="v")
    assert not any(line.get_marker() == "s" for axes in settled.axes for line in axes.lines)


def test_what_rises_to_an_end_of_the_range_is_no_least_peak():
    """It was ringed: where the contact sticks its resonance may lie beyond the range."""
    some = replace(peaks(n_0=[0, 10, 20]), at_end=np.array([[False, False], [True, False], [False, False]]))
    upper, lower = draw_peak(some).axes
    assert title(upper).startswith("least peak 8 at $n_{0}$ = ")
    for axes, values in ((upper, some.amplitude), (lower, some.frequency)):
        (triangle,) = (line for line in axes.lines if line.get_marker() == "^")
        assert triangle.get_xdata().tolist() == [10] and triangle.get_ydata().tolist() == [values[1, 0]]
    assert "widen" in lower.get_title(loc="left")
    some.at_end[:, 0] = True
    assert "least" not in title(draw_peak(some).axes[0])


def test_a_file_says_which_peaks_are_at_an_end_of_the_range(tmp_path):
    scene = load_scene("yang1998-n5")
    for high, at_end in ((1.7, None), (1.0, [True, True])):
        found = trace(replace(scene, frequency_range=(0.7, high)), harmonics=1)
        write_netcdf(found, tmp_path / "peaks.nc")
        told = read_peaks(tmp_path / "peaks.nc").at_end
        assert told is at_end if at_end is None else told.tolist() == [at_end]


@pytest.mark.parametrize(
    ("stable", "said"), [(1.0, ""), (0.0, ", unstable"), (np.nan, ", stability unknown")]
)
def test_the_least_peak_is_not_told_without_its_stability(stable, said):
    some = replace(peaks(n_0=[0, 10, 20]), stable=np.array([[1, 1], [stable, 1], [1, 1]]))
    assert title(draw_peak(some).axes[0]) == f"least peak 6 at $n_{{0}}$ = 10{said}"


def test_decades_of_positive_values_are_logarithmic():
    upper, lower = draw_peak(peaks(n_0=[0.01, 1.0, 100.0])).axes
    assert lower.get_xscale() == "log" and upper.get_yscale() == "linear"


@pytest.mark.parametrize(
    ("more", "said"),
    [
        ({"dof": "w"}, 'no degree of freedom "w"; the file has "u", "v"'),
        ({"against": "x"}, '"x" was not swept; the file has "contact.shroud.n_0"'),
    ],
)
def test_what_is_not_there(more, said):
    with pytest.raises(PlotError, match=said):
        draw_peak(peaks(n_0=[0, 10]), **more)


def test_the_optimal_preload_of_the_paper(tmp_path):
    path = tmp_path / "a.nc"
    write_netcdf(trace(load_scene("yang1998")), path)
    upper, _ = draw_peak(read_peaks(path)).axes
    assert title(upper) == "least peak 6.236 at $n_{0}$ = 10"


def test_a_file_without_a_sweep(tmp_path):
    path = tmp_path / "a.nc"
    write_netcdf(trace(load_scene("yang1998-n5")), path)
    with pytest.raises(PlotError, match="nothing was swept"):
        draw_peak(read_peaks(path))


@pytest.mark.slow
def test_the_resonances_of_nonlinear_modes_are_the_peaks_of_a_sweep(tmp_path):
    """Of the levels of the forces, too; a level whose resonance is beyond the amplitudes has none."""
    levels = [x for level in (0.5, 1, 20) for x in ("--force-level", level)]
    path = tmp_path / "mode.nc"
    made = called(
        "respond", "yang1998", "--mode", 1, "--level", "5:30", "--harmonics", 1, *levels, "-o", path
    )
    assert made.code == 0
    found, rows = read_peaks(path), made.out.split("times the level:\n")[1].splitlines()
    assert rows[0].split()[:4] == ["n_0", "level", "at", "rad/s"] and list(found.parameters) == [
        N_0,
        "excitation.level",
    ]
    there = np.isfinite(found.amplitude[:, 0])
    told = np.array(
        [
            [float(x) for x in row.split()]
            for row in rows[1 : 1 + int(np.isfinite(found.amplitude[:, 0]).sum())]
        ]
    )
    assert rows[1 + len(told)].startswith("these are estimates, as if the mode alone answered")
    mine = [*found.parameters.values(), found.frequency[:, 0], found.damping, found.amplitude[:, 0]]
    assert told[:, [0, 1, 2, 3, 5]] == pytest.approx(np.transpose(mine)[there], rel=1e-3)
    upper, middle, lowest = draw_peak(found).axes
    none = f"{np.isnan(found.damping).sum()} of {found.damping.size} curves, left out"
    assert title(middle) == f"no resonance within the amplitudes: {none}" and not there.all()
    assert "least resonance" in title(upper) and lowest.get_ylabel() == "Damping ratio (%)"
    assert upper.get_ylabel().startswith("Resonance amplitude of u")
    over_levels = draw_peak(found, against="excitation.level").axes
    assert not any("least" in title(axes) for axes in over_levels)  # less force is no choice of design


def test_a_mode_without_resonances_is_said_to_have_none(tmp_path):
    path = tmp_path / "mode.nc"
    assert called("respond", "yang1998-n5", "--mode", "1", "--level", "1:2", "-o", path).code == 0
    with pytest.raises(PlotError, match="no resonance of a nonlinear mode; try fcm plot mode"):
        read_peaks(path)


def test_a_least_peak_at_an_end_of_the_sweep_is_no_minimum():
    said = title(draw_peak(peaks(n_0=[10, 20, 50])).axes[0])
    assert (
        said.splitlines()[1] == "an end of the sweep of $n_{0}$: less may be beyond, or before the next value"
    )
    assert "end of the sweep" not in title(draw_peak(peaks(n_0=[0, 10, 20])).axes[0])


def test_random_draws_have_no_best_one():
    """Nobody chooses a draw: the middle of the peaks and their scatter are told, and no ring is drawn."""
    some = draws(50)
    upper, _ = draw_peak(some).axes
    low, middle, high = np.percentile(some.amplitude[:, 0], (5, 50, 95))
    assert title(upper) == (
        f"50 random draws of $n_{{0}}$:\nmedian {middle:.4g}, 5 to 95 % are {low:.4g} to {high:.4g}"
    )
    assert not any(line.get_markersize() == 7 for line in upper.lines)


def draws(count, **others):
    random = np.random.default_rng(0)
    return replace(peaks(n_0=random.normal(10, 3, count), **others), drawn=(N_0,))


def test_a_narrow_scatter_fills_its_axis():
    """From 0 on it was a flat line."""
    some = draws(50)
    low, high = draw_peak(some).axes[0].get_ylim()
    assert 0.0 < low < some.amplitude[:, 0].min() < some.amplitude[:, 0].max() < high
    wide = replace(some, amplitude=some.amplitude * np.linspace(0.3, 1.0, 50)[:, None])
    assert draw_peak(wide).axes[0].get_ylim()[0] == 0.0


def test_random_draws_of_one_number_are_points_that_no_line_joins():
    for axes in draw_peak(draws(50)).axes:
        points = axes.lines[0]
        assert (points.get_linestyle(), points.get_marker(), len(points.get_xdata())) == ("None", "o", 50)


@pytest.mark.parametrize(("count", "percents"), [(20, True), (19, False)])
def test_of_few_draws_the_extremes_are_told_as_such(count, percents):
    """With fewer than 20 draws 5 and 95 % are no more than these: none is beyond."""
    some = draws(count)
    upper, _ = draw_peak(some).axes
    own = some.amplitude[:, 0]
    low, high = np.percentile(own, (5, 95)) if percents else (own.min(), own.max())
    words = f"5 to 95 % are {low:.4g} to {high:.4g}"
    if not percents:
        words = f"all are {low:.4g} to {high:.4g} (5 to 95 % take 20)"
    assert title(upper).endswith(words)
    across = [line.get_ydata()[0] for line in upper.lines if line.get_linestyle() == "--"]
    assert across == pytest.approx([low, high])


def test_draws_at_each_value_of_a_sweep_have_a_median_and_a_bar_there():
    """Their scatter was told over all values of the sweep together, and each draw had a line."""
    mu = np.tile(np.random.default_rng(0).normal(0.4, 0.05, 30), 2)
    some = replace(peaks(n_0=np.repeat([10, 50], 30), mu=mu), drawn=(MU,))
    figure = draw_peak(some)
    upper = figure.axes[0]
    assert upper.lines[0].get_linestyle() == "None" and not figure.legends
    assert title(upper) == "random draws of $\\mu$: medians, and bars of 5 to 95 %"
    (bars,) = upper.collections
    for n_0, segment in zip((10, 50), bars.get_segments(), strict=True):
        own = some.amplitude[some.parameters[N_0] == n_0, 0]
        assert segment[:, 0].tolist() == [n_0, n_0]
        assert segment[:, 1] == pytest.approx(np.percentile(own, (5, 95)))
    figure = draw_peak(some, against=MU)
    assert [text.get_text() for text in figure.legends[0].get_texts()] == ["$n_{0}$ = 10", "$n_{0}$ = 50"]
    assert [len(line.get_xdata()) for line in figure.axes[0].lines[:2]] == [30, 30]
    assert title(figure.axes[0]) == "random draws of $\\mu$"


def test_the_least_peak_has_its_unit():
    drawn = replace(peaks(n_0=[5.0, 10.0, 20.0]), length="mm")
    assert title(draw_peak(drawn).axes[0]) == "least peak 6 mm at $n_{0}$ = 10"
