"""The coefficients over (n0_bar, b_bar): surfaces in space as in figures 10 and 11, or filled contours."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from fcm.contact.surface import Regions, Surface
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
from fcm.plot.regions import draw_regions, name_regions
from fcm.plot.style import LAYOUT, house_style

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.colors import Colormap
    from matplotlib.figure import Figure

_SPACE_HEIGHT, _FLAT_HEIGHT = 2.3, 2.5  # [inch] of a row of panels
_VIEW = (24.0, -125.0)  # [degree] elevation and azimuth


def draw_surfaces(surfaces: Sequence[Surface]) -> Figure:
    """A surface in space for each coefficient and phase; the heights of one coefficient are comparable."""
    with house_style():
        figure, axes = panels(len(surfaces), _SPACE_HEIGHT, projection="3d")
        for one, drawn, title in zip(axes, surfaces, _titles(surfaces), strict=True):
            _draw_in_space(one, drawn, _range(surfaces, drawn.coefficient))
            one.set_title(title, y=0.97)
    return figure


def draw_contours(surfaces: Sequence[Surface], found: Sequence[Regions]) -> Figure:
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


def _titles(surfaces: Sequence[Surface]) -> list[str]:
    return panel_titles([(one.coefficient, one.plane.phi) for one in surfaces])


def _range(surfaces: Sequence[Surface], coefficient: str) -> tuple[float, float]:
    values = [one.values for one in surfaces if one.coefficient == coefficient]
    return shared_range(values, signed=coefficient == "F_b")


def _colours(signed: bool) -> Colormap:
    """Told apart by the colour-blind, and light enough for black lines and names."""
    import matplotlib
    from matplotlib.colors import ListedColormap

    if signed:
        return ListedColormap(matplotlib.colormaps["RdBu_r"](np.linspace(0.15, 0.85, 256)))
    return ListedColormap(matplotlib.colormaps["YlGnBu"](np.linspace(0.0, 0.75, 256)))


def _draw_in_space(axes: Any, drawn: Surface, span: tuple[float, float]) -> None:
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


def _draw_bands(axes: Axes, drawn: Surface, span: tuple[float, float]) -> None:
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
