"""Tables of several layouts: error against size, and against the time of a look-up."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from fcm.plot.style import LAYOUT, house_style, new_figure, save

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from fcm.table.study import Row

LINES = {"rectilinear": ("s", "#d95f02"), "regimes": ("o", "#1f5fa8")}
DASHES = {"linear": "--", "cubic": "-"}


def draw_study(rows: list[Row]) -> Figure:
    """The figure: lines for each layout and interpolation, the rms strong and the greatest error pale."""
    from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

    figure = new_figure(1.35 * LAYOUT.width, 1.05 * LAYOUT.height)
    by_size, by_time = figure.subplots(1, 2, sharey=True)
    for layout, (marker, colour) in LINES.items():
        for interpolation, dash in DASHES.items():
            some = [row for row in rows if (row.layout, row.interpolation) == (layout, interpolation)]
            name = f"{layout}, {interpolation}"
            look = {"linestyle": dash, "marker": marker, "color": colour, "label": name, "markersize": 4}
            _line(by_size, [row.bytes / 1e6 for row in some], some, look)
            _line(by_time, [row.us_of_group for row in some], some, look)
    by_time.axvline(rows[-1].us_of_group, color="black", linestyle=":", label="closed form, exact")
    by_size.set(xlabel="Size (MB)", ylabel="Absolute error: rms (strong), greatest (pale) (–)")
    by_time.set(xlabel="Time for ten points (µs)", xlim=(20.0, None))
    for axes, subs in ((by_size, (1, 2, 5)), (by_time, (1, 2, 3, 5))):
        axes.xaxis.set_major_locator(LogLocator(subs=subs))
        axes.xaxis.set_major_formatter(FuncFormatter(lambda value, _position: f"{value:g}"))
        axes.xaxis.set_minor_formatter(NullFormatter())
    handles, labels = by_time.get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=3)
    return figure


def _line(axes: Axes, at: list[float], rows: list[Row], look: dict[str, Any]) -> None:
    axes.loglog(at, [row.rms for row in rows], **look)
    axes.loglog(at, [row.max for row in rows], **look | {"alpha": 0.3, "label": None})


def write_study_figure(rows: list[Row], path: Path) -> None:
    """Draw and save the figure in the format of the path's ending."""
    with house_style():
        save(draw_study(rows), path)
