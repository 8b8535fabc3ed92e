"""The coefficients over (n0_bar, b_bar): surfaces in space as in figures 10 and 11, or filled contours."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from scipy.ndimage import distance_transform_edt, minimum_filter

from fcm.contact.surface import CoefficientSurface, Regions
from fcm.plot.plane import (
    B_SYMBOL,
    MEANING,
    N0_SYMBOL,
    boundary_legend,
    draw_boundaries,
    finish_plane,
    panel_titles,
    panels,
    shared_range,
)
from fcm.plot.read import FloatArray
from fcm.plot.style import LAYOUT, house_style

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.colors import Colormap
    from matplotlib.figure import Figure


_LETTER, _HEIGHT = 0.068, 0.125  # [inch] width of a letter, height of a name, with the space around them


def draw_regions(axes: Axes, found: Regions) -> None:
    """Lines between the regions within the separation regime; its own boundaries are not repeated."""
    for where in found.where.values():
        inside = np.where(found.separates, where, np.nan)
        if np.nanmin(inside, initial=1.0) < np.nanmax(inside, initial=0.0):
            axes.contour(found.n0_bar, found.b_bar, inside, levels=[0.5], colors="black", linewidths=0.4)


def name_regions(axes: Axes, found: Regions) -> None:
    """Write each sequence in the middle of its region, unless that is too small.

    The panel must have its final size.
    """
    frame, dpi = axes.get_window_extent(), axes.figure.dpi
    for name, where in found.where.items():
        size = _HEIGHT * dpi / frame.height, _LETTER * (len(name) + 0.5) * dpi / frame.width
        place = _place(where, size)
        if place is not None:
            at = found.n0_bar[place[1]], found.b_bar[place[0]]
            axes.text(*at, name, ha="center", va="center", fontsize=LAYOUT.small_text)


def _place(where: FloatArray, size: tuple[float, float]) -> tuple[int, int] | None:
    """The cell with most room for a box whose size is a share of the panel; None if it fits nowhere."""
    cells = [max(1, round(share * count)) for share, count in zip(size, where.shape, strict=True)]
    fits = minimum_filter(where, size=cells, mode="constant", cval=0.0)
    if not fits.any():
        return None
    rows, columns = where.shape
    room = distance_transform_edt(np.pad(fits, 1), sampling=(1.0 / rows, 1.0 / columns))[1:-1, 1:-1]
    row, column = np.unravel_index(np.argmax(room), room.shape)
    return int(row), int(column)


_SPACE_HEIGHT, _FLAT_HEIGHT = 2.3, 2.5  # [inch] of a row of panels
_VIEW = (24.0, -125.0)  # [degree] elevation and azimuth


def draw_surfaces(surfaces: Sequence[CoefficientSurface]) -> Figure:
    """A surface in space for each coefficient and phase; the heights of one coefficient are comparable."""
    with house_style():
        figure, axes = panels(len(surfaces), _SPACE_HEIGHT, projection="3d")
        for one, drawn, title in zip(axes, surfaces, _titles(surfaces), strict=True):
            _draw_in_space(one, drawn, _range(surfaces, drawn.coefficient))
            one.set_title(title, y=0.97)
    return figure


def draw_contours(surfaces: Sequence[CoefficientSurface], found: Sequence[Regions]) -> Figure:
    """Filled contours with the lines between the regimes, and the sequence of states in each region."""
    with house_style():
        figure, axes = panels(len(surfaces), _FLAT_HEIGHT)
        for one, drawn, where, title in zip(axes, surfaces, found, _titles(surfaces), strict=True):
            _draw_bands(one, drawn, _range(surfaces, drawn.coefficient))
            draw_regions(one, where)
            draw_boundaries(one, where.edges)
            one.set_title(title)
        finish_plane(axes, surfaces[0].plane)
        boundary_legend(figure)
        figure.draw_without_rendering()  # the panels take their places
        for one, where in zip(axes, found, strict=True):
            name_regions(one, where)
    return figure


def _titles(surfaces: Sequence[CoefficientSurface]) -> list[str]:
    return panel_titles([(one.coefficient, one.plane.phi) for one in surfaces])


def _range(surfaces: Sequence[CoefficientSurface], coefficient: str) -> tuple[float, float]:
    values = [one.values for one in surfaces if one.coefficient == coefficient]
    return shared_range(values, signed=coefficient == "F_b")


def _colours(signed: bool) -> Colormap:
    """Colours that are safe for the colour-blind and light enough for black lines and names."""
    import matplotlib
    from matplotlib.colors import ListedColormap

    if signed:
        return ListedColormap(matplotlib.colormaps["RdBu_r"](np.linspace(0.15, 0.85, 256)))
    return ListedColormap(matplotlib.colormaps["YlGnBu"](np.linspace(0.0, 0.75, 256)))


def _draw_in_space(axes: Any, drawn: CoefficientSurface, span: tuple[float, float]) -> None:
    from matplotlib.ticker import MaxNLocator

    n0, b = np.meshgrid(drawn.n0_bar, drawn.b_bar)
    axes.plot_surface(
        n0,
        b,
        drawn.values,
        rstride=1,
        cstride=1,
        cmap=_colours(drawn.coefficient == "F_b"),
        vmin=span[0],
        vmax=span[1],
        edgecolor="black",
        linewidth=0.1,
    )
    axes.set(xlim=drawn.plane.n0_range, ylim=drawn.plane.b_range, zlim=span)
    axes.set_xlabel(N0_SYMBOL, labelpad=-4)
    axes.set_ylabel(B_SYMBOL, labelpad=-2)
    axes.set_zlabel(MEANING[drawn.coefficient], labelpad=-5)
    for axis in (axes.xaxis, axes.yaxis, axes.zaxis):
        corner = "lower" if axis is axes.xaxis else None  # two numbers in one corner would touch
        axis.set_major_locator(MaxNLocator(LAYOUT.surface_ticks, steps=[1, 2, 5, 10], prune=corner))
        axis.set_tick_params(pad=-1, labelsize=7)
    axes.view_init(*_VIEW)
    axes.set_box_aspect((1.2, 1.0, 0.75), zoom=0.9)


def _draw_bands(axes: Axes, drawn: CoefficientSurface, span: tuple[float, float]) -> None:
    from matplotlib.ticker import MaxNLocator

    signed = drawn.coefficient == "F_b"
    levels = np.array(MaxNLocator(LAYOUT.surface_levels, steps=[1, 2, 5, 10]).tick_values(*span))
    step = levels[1] - levels[0]
    ticks = [level for level in levels if round(level / step) % 2 == 0]
    if signed:  # the band in the middle is white and holds 0
        levels = np.append(levels - 0.5 * step, levels[-1] + 0.5 * step)
    levels[0] -= 1e-9 * span[1]  # what is exactly on the lowest level has a colour too
    bands = axes.contourf(drawn.n0_bar, drawn.b_bar, drawn.values, levels=levels, cmap=_colours(signed))
    axes.figure.colorbar(bands, ax=axes, label=MEANING[drawn.coefficient], ticks=ticks, pad=0.02)
