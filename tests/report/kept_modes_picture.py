"""Errors of peaks against the number of modes that are kept, with and without what the others give."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from matplotlib.ticker import NullLocator

from fcm.plot.style import house_style, new_figure

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

WIDTH, HEIGHT = 6.2, 3.4  # [inch]
PANELS = ("height", "frequency")
STYLES = (("with flexibility", "o", "#0072b2"), ("without", "s", "#d55e00"))


@dataclass(frozen=True)
class Kept:
    """Greatest relative errors over the curves of a scene, and the bound that the run stated."""

    modes: int
    with_flexibility: tuple[float, float]  # of the peak's height and frequency
    without: tuple[float, float]
    bound: tuple[float, float]  # of a resonance's damping and of receptances, nan where none is stated


def draw_kept_modes(rows: Sequence[Kept]) -> Figure:
    """Beside each other the errors of height and frequency.

    >>> rows = [Kept(count, (3e-3, 1e-5), (0.3, 0.05), (9e-3, 2e-4)) for count in (3, 30)]
    >>> [axes.get_title() for axes in draw_kept_modes(rows).axes]
    ["Peak's height", "Peak's frequency"]
    """
    with house_style():
        figure = new_figure(WIDTH, HEIGHT)
        panels = figure.subplots(1, 2, sharey=True)
        for number, (axes, name) in enumerate(zip(panels, PANELS, strict=True)):
            _draw_panel(axes, rows, number)
            axes.set_title(f"Peak's {name}")
        panels[0].set_ylabel("Greatest relative error")
        figure.legend(*panels[0].get_legend_handles_labels(), loc="outside lower center", ncols=3)
    return figure


def _draw_panel(axes: Axes, rows: Sequence[Kept], number: int) -> None:
    modes = [one.modes for one in rows]
    for (label, marker, colour), errors in zip(
        STYLES, ([one.with_flexibility for one in rows], [one.without for one in rows]), strict=True
    ):
        axes.plot(modes, [pair[number] for pair in errors], marker=marker, color=colour, label=label)
    axes.plot(modes, [one.bound[number] for one in rows], linestyle=":", color="0.4", label="bound")
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.set_xticks(modes, [str(count) for count in modes])
    axes.xaxis.set_minor_locator(NullLocator())
    axes.set_xlabel("Modes kept")
