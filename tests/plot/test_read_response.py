"""A response file as the design describes it, written here by hand and read for drawing."""

import netCDF4
import numpy as np
import pytest

from fcm.plot import PlotError, draw_response, read_response
from fcm.plot.read import opened

NAN = np.nan


@pytest.fixture
def path(tmp_path):
    """Two curves of three and two points, the second padded; of the first the middle is unstable."""
    path = tmp_path / "response.nc"
    with netCDF4.Dataset(path, "w") as data:
        data.frequency_unit = "Hz"
        for name, size in {"curve": 2, "point": 3, "dof": 1, "contact": 1}.items():
            data.createDimension(name, size)
        variables = {
            "dof": (("dof",), np.array(["tip"], object)),
            "contact.a.n_0": (("curve",), np.array([5.0, -1.0])),
            "complete": (("curve",), np.array([1.0, 1.0])),
            "frequency": (("curve", "point"), np.array([[1.0, 2.0, 1.5], [1.0, 3.0, NAN]])),
            "amplitude": (
                ("curve", "point", "dof"),
                np.array([[[7.0], [8.0], [9.0]], [[1.0], [2.0], [NAN]]]),
            ),
            "stable": (("curve", "point"), np.array([[1.0, 0.0, 1.0], [1.0, 1.0, NAN]])),
            "regime": (
                ("curve", "point", "contact"),
                np.array([[["E"], ["EPEN"], ["E"]], [["S"], ["S"], [""]]], object),
            ),
        }
        for name, (dims, values) in variables.items():
            kind = str if values.dtype == object else float
            data.createVariable(name, kind, dims)[...] = values
        data["contact.a.n_0"].long_name = "swept value of contact.a.n_0"
    return path


def test_curves_come_without_their_padding(path):
    response = read_response(path)
    first, second = response.curves
    assert response.dofs == ("tip",) and response.frequency_unit == "Hz"
    assert first.parameters == {"contact.a.n_0": 5.0} and second.parameters == {"contact.a.n_0": -1.0}
    assert first.frequency.tolist() == [1.0, 2.0, 1.5] and second.frequency.tolist() == [1.0, 3.0]
    assert second.amplitude.tolist() == [[1.0], [2.0]]
    assert first.stable.tolist() == [True, False, True] and second.stable.tolist() == [True, True]
    assert first.regimes == {"E", "EPEN"} and second.regimes == {"S"}


def test_what_is_not_told_is_not_stable(path):
    """Neither is it unstable; padding is no point of which anything could be told."""
    with netCDF4.Dataset(path, "a") as data:
        data["stable"][1, 0] = NAN
    first, second = read_response(path).curves
    assert first.unknown.tolist() == [False] * 3 and second.unknown.tolist() == [True, False]


def test_its_unstable_part_is_drawn_dashed(path):
    (axes,) = draw_response(read_response(path)).axes
    assert [line.get_linestyle() for line in axes.lines] == ["-", "--", "-"]
    assert axes.get_xlabel() == "Frequency $f$ (Hz)" and axes.get_ylabel() == "Amplitude of tip"


def test_branches_are_not_joined(path):
    with netCDF4.Dataset(path, "a") as data:
        data["frequency"][0, 1] = NAN
        data["amplitude"][0, 1] = NAN
        data["stable"][0, 1] = NAN
        data["regime"][0, 1] = np.array([""], object)
    response = read_response(path)
    assert response.curves[0].regimes == {"E"}
    line, *others = [line for line in draw_response(response).axes[0].lines if line.get_marker() != "."]
    np.testing.assert_array_equal(line.get_xdata(), [1.0, NAN, 1.5])
    np.testing.assert_array_equal(line.get_ydata(), [7.0, NAN, 9.0])
    assert len(others) == 1


@pytest.mark.slow
def test_curves_of_which_stability_is_nowhere_told_are_dotted(path):
    """A solid line is a claim that they are stable."""
    with netCDF4.Dataset(path, "a") as data:
        data["stable"][:] = NAN
    figure = draw_response(read_response(path))
    solid, dotted = figure.axes[0].lines[::2], figure.axes[0].lines[1::2]
    assert not any(np.isfinite(line.get_ydata()).any() for line in solid)
    assert [line.get_xdata().tolist() for line in dotted] == [[1.0, 2.0, 1.5], [1.0, 3.0]]
    assert [text.get_text() for text in figure.legends[0].get_texts()] == ["stability unknown"]


def test_no_line_leads_across_a_jump_of_a_sweep(path):
    """The sweep up jumps between its points, the one down does not; of the other curve nothing is said."""
    with netCDF4.Dataset(path, "a") as data:
        data["frequency"][0] = [1.0, 2.0, 1.0]
        data.createVariable("sweep", str, ("curve", "point"))[...] = np.array(
            [["up", "up", "down"], ["up"] * 3]
        )
        data.summary = '{"curves": [{"jumps": [{"sweep": "up", "frequency": 1.7}]}]}'
    first, second = read_response(path).curves
    assert np.array_equal(first.frequency, [1.0, NAN, 2.0, 1.0], equal_nan=True)
    assert np.array_equal(first.amplitude[:, 0], [7.0, NAN, 8.0, 9.0], equal_nan=True)
    assert first.stable.tolist() == [True, True, False, True]
    assert second.frequency.tolist() == [1.0, 3.0]


@pytest.mark.parametrize(
    "text",
    [
        "[]",
        "{",
        '{"curves": 5}',
        '{"curves": [5]}',
        '{"curves": [{"jumps": [{}]}]}',
        '{"curves": [{"jumps": 5}]}',
    ],
)
def test_jumps_that_are_none_are_said(path, text):
    with netCDF4.Dataset(path, "a") as data:
        data.createVariable("sweep", str, ("curve", "point"))[...] = np.array([["up"] * 3] * 2)
        data.summary = text
    with pytest.raises(PlotError, match=r"response\.nc: not a response file"):
        read_response(path)


def test_points_alone_are_seen(path):
    """A file of peaks alone has no two points side by side; lines draw nothing of them."""
    with netCDF4.Dataset(path, "a") as data:
        data["frequency"][0], data["frequency"][1] = [1.0, NAN, 1.2], [1.5, NAN, NAN]
        data["stable"][0] = [1.0, NAN, 0.0]
    figure = draw_response(read_response(path))
    (axes,) = figure.axes
    assert "a point, unstable or of unknown stability" in [
        text.get_text() for text in figure.legends[0].get_texts()
    ]
    dots = {
        (x, y): line.get_markerfacecolor() == line.get_color()
        for line in axes.lines
        if line.get_marker() == "."
        for x, y in zip(line.get_xdata(), line.get_ydata(), strict=True)
        if np.isfinite(y)
    }
    assert dots == {(1.0, 7.0): True, (1.2, 9.0): False, (1.5, 1.0): True}


def test_a_file_without_stability_and_regimes_is_read(path):
    with netCDF4.Dataset(path, "a") as data:
        data.renameVariable("stable", "x")
        data.renameVariable("regime", "y")
    assert all(curve.stable is None and not curve.regimes for curve in read_response(path).curves)


def test_a_curve_without_points_is_not_drawn(path):
    with netCDF4.Dataset(path, "a") as data:
        data["frequency"][1] = NAN
        data["amplitude"][1] = NAN
    assert len(draw_response(read_response(path)).axes[0].lines) == 2


@pytest.mark.parametrize("cut", [0, 10, 1000, -100])
def test_a_file_that_was_cut_off_is_said(path, cut):
    path.write_bytes(path.read_bytes()[:cut])
    with pytest.raises(PlotError, match=r"response\.nc: (not a |damaged, or cut off)"):
        read_response(path)


def test_what_draws_a_file_is_said_if_something_does(path):
    with (
        pytest.raises(PlotError, match="no variable sensitivity; try fcm plot response"),
        opened(path, "a file of sensitivities", ["sensitivity"]),
    ):
        pass
    with netCDF4.Dataset(path, "a") as data:
        data.renameVariable("frequency", "something")
    with pytest.raises(PlotError, match=r"it has no variable frequency$"):
        read_response(path)


def test_errors_come_with_their_curves(path):
    with netCDF4.Dataset(path, "a") as data:
        data.createVariable("table_error", float, ("curve", "point"))[...] = [
            [1.0, 2.0, 3.0],
            [4.0, 5.0, NAN],
        ]
    first, second = read_response(path).curves
    assert first.table_error.tolist() == [1.0, 2.0, 3.0] and second.table_error.tolist() == [4.0, 5.0]
    assert first.truncation_error is None


@pytest.mark.parametrize(
    ("quantity", "phase", "axis", "power"),
    [
        ("acceleration", NAN, "Acceleration of tip, fundamental", 2),
        ("displacement", 0.5, "Displacement of tip, fundamental", 0),
        ("displacement", NAN, "Amplitude of tip", None),
    ],
)
def test_a_fit_is_drawn_in_the_quantity_that_was_measured(path, quantity, phase, axis, power):
    """Crosses were fundamentals beside curves of half the peak-to-peak."""
    with netCDF4.Dataset(path, "a") as data:
        data.createDimension("data", 1)
        data.createDimension("measured", 2)
        own = {
            "data_frequency": [1.0, 2.0], "data_amplitude": [60.0, 70.0], "data_displacement": [6.0, 7.0],
            "data_level": [1.0, 1.0], "data_phase": [phase, phase],
        }  # fmt: skip
        for name, values in own.items():
            data.createVariable(name, float, ("data", "measured"))[...] = [values]
        for name, value in {"data_dof": "tip", "data_quantity": quantity}.items():
            data.createVariable(name, str, ("data",))[...] = np.array([value], object)
        fundamental = 0.9 * data["amplitude"][...]
        data.createVariable("fundamental", float, ("curve", "point", "dof"))[...] = fundamental
    axes = draw_response(read_response(path)).axes[0]
    (crosses,) = (line for line in axes.lines if line.get_label() == "_measured")
    drawn = np.array([7.0, 8.0, 9.0])
    if power is not None:
        drawn = 0.9 * drawn * (2.0 * np.pi * np.array([1.0, 2.0, 1.5])) ** power
    assert axes.get_ylabel() == axis
    assert crosses.get_ydata().tolist() == ([60.0, 70.0] if power is not None else [6.0, 7.0])
    assert np.nanmax(axes.lines[0].get_ydata()) == pytest.approx(drawn[[0, 2]].max())
