"""The error of a table over (n0_bar, b_bar), with its worst point."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from fcm.plot.plane import boundary_legend, draw_boundaries, finish_plane, panel_titles, panels
from fcm.plot.style import LAYOUT, house_style

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from fcm.table.error_map import ErrorMap

RANGE = (-9.0, -3.0)  # log10 of the error; the same in every picture, so that pictures can be compared
_BELOW = "0.92"  # grey of what is below the range: exact
_WORST: dict[str, Any] = {"marker": "o", "markersize": 7.0, "markerfacecolor": "none", "markeredgewidth": 1.3}


def draw_errors(maps: Sequence[ErrorMap], title: str = "") -> Figure:
    """A panel for each coefficient and phase; the greatest error of each is marked and in its title."""
    with house_style():
        figure, axes = panels(len(maps), LAYOUT.row_height)
        names = panel_titles([(one.coefficient, one.plane.phi) for one in maps])
        for one, drawn, name in zip(axes, maps, names, strict=True):
            colours = _draw_error(one, drawn)
            one.set_title(f"{name}\n{_worst(drawn)}", fontsize=8)
        finish_plane(axes, maps[0].plane)
        label = r"$\log_{10}\,|F_{\mathrm{table}} - F_{\mathrm{exact}}|$ (–)"
        ticks = np.arange(RANGE[0], RANGE[1] + 0.5)
        figure.colorbar(colours, ax=axes, label=label, extend="both", ticks=ticks, pad=0.02)
        boundary_legend(figure)
        figure.suptitle(title, fontsize=9, parse_math=False)
    return figure


def _draw_error(axes: Axes, drawn: ErrorMap) -> Any:
    import matplotlib
    from matplotlib.patheffects import withStroke

    colours = matplotlib.colormaps["YlOrRd"].with_extremes(under=_BELOW)
    logarithm = np.log10(np.maximum(drawn.error, LAYOUT.table_error))
    mesh = axes.pcolormesh(
        drawn.n0_bar, drawn.b_bar, logarithm, cmap=colours, vmin=RANGE[0], vmax=RANGE[1], rasterized=True
    )
    draw_boundaries(axes, drawn.edges)
    ring = [withStroke(linewidth=2.6, foreground="white")]
    axes.plot(
        *drawn.worst,
        linestyle="none",
        color="black",
        clip_on=False,
        label="worst",
        path_effects=ring,
        **_WORST,
    )
    return mesh


def _worst(drawn: ErrorMap) -> str:
    """The greatest error and where it is."""
    if drawn.largest == 0.0:
        return "no error"
    mantissa, exponent = f"{drawn.largest:.1e}".split("e")
    n0, b = (f"{value:.3g}" for value in drawn.worst)
    point = rf"$\bar{{n}}_0$ = {n0}, $\bar{{b}}$ = {b}".replace("-", "−")
    return rf"worst ${mantissa} \times 10^{{{int(exponent)}}}$ at {point}"
