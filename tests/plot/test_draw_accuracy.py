"""Pictures of error against time: what is drawn from a file, and what is left out."""

import json

import netCDF4
import pytest

from fcm.plot.accuracy import draw_accuracy, read_accuracy
from fcm.plot.errors import PlotError


def run(method, step, error, corrected=True, left_out=True):
    """An error of None is known only to be below 1e-7."""
    shown = {"errors": {"curve": error}, "below": {} if error else {"curve": 1e-7}}
    return {
        "method": method, "corrected": corrected, "left_out": left_out, "max_step": step,
        "complete": corrected,
        "processor_seconds": 0.1 / step, "against": {"exact": shown, "closed form": shown},
    }  # fmt: skip


RUNS = [
    run("default table", 0.05, 1e-4),
    run("default table", 0.2, 1e-3),
    run("default table", 0.05, 1e-4, left_out=False),
    run("default table", 0.05, 2e-4, corrected=False, left_out=False),
    run("exact", 0.05, None),
]


@pytest.fixture
def file(tmp_path):
    own = {"own_error": {"curve": 1e-8}, "max_step": 0.01}
    summary = {"title": "a $ scene", "runs": RUNS, "references": {"exact": own, "closed form": own}}
    path = tmp_path / "c.nc"
    with netCDF4.Dataset(path, "w") as data:
        data.layout, data.summary = "fcm comparison 1", json.dumps(summary)
    return path


def test_a_line_for_each_method_from_long_steps_to_short(file):
    exact, harmonic = read_accuracy(file).panels
    assert exact.lines[("default table", True)] == [(0.5, 1e-3, False, True), (2.0, 1e-4, False, True)]
    assert exact.lines[("exact", True)] == [(2.0, 1e-7, True, True)]
    assert set(exact.lines) == {("default table", True), ("exact", True)}
    assert set(harmonic.lines) == {("default table", True), ("default table", False)}


def test_the_picture_has_the_references_own_error_in_view(file):
    figure = draw_accuracy(read_accuracy(file))
    for axes in figure.axes:
        assert axes.get_xscale() == axes.get_yscale() == "log"
        low, high = axes.get_ylim()
        assert low < 1e-8 and 1e-3 < high
        assert any("error of the reference" in text.get_text() for text in axes.texts)
    figure.draw_without_rendering()
    for axes in figure.axes:  # no arrow lies over the name
        (name,) = (one for one in axes.texts if one.get_text())
        low = axes.get_window_extent().y0
        line = axes.transData.transform((1.0, 1e-8))[1]
        assert low <= name.get_window_extent().y0 and name.get_window_extent().y1 < line
    above, below = figure.axes
    assert len(above.texts) == len(below.texts) + 1  # the arrow of the exact motion's limit
    assert figure.get_size_inches()[0] <= 3.4
    (legend,) = figure.legends
    names = [text.get_text() for text in legend.get_texts()]
    unfinished = "default table, as it is, not complete"  # as the summary says
    assert sorted(names) == ["default table", unfinished, "exact"]


def test_what_the_file_does_not_know_cannot_be_drawn(file):
    with pytest.raises(PlotError, match="not a sound comparison"):
        read_accuracy(file, "fold")
