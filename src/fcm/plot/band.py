"""Bands of the response over random draws."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from fcm.plot.curve_names import name_at_side
from fcm.plot.errors import PlotError
from fcm.plot.labels import frequency_label
from fcm.plot.read import LEVEL, DrawnResponse, wide
from fcm.plot.response import doubtful
from fcm.plot.style import LAYOUT, has_decades, house_style, logarithmic_axis, new_figure, sequence_colours
from fcm.plot.unfinished import say_unfinished

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from fcm.results.bands import Band


def banded_column(response: DrawnResponse, dof: str | None) -> int:
    """Column of the degree of freedom to draw; PlotError says why it has no bands."""
    column = response.column(dof)
    if not response.drawn:
        raise PlotError(
            "nothing was drawn at random in this sweep, so that it has no bands. [sweep] draws a number by "
            "{ normal = [5.0, 0.5], count = 40 }"
        )
    if response.frequency_unit == LEVEL:
        raise PlotError("the curves are against the level of the forces; bands are over frequencies")
    if not any(np.isfinite(curve.amplitude[:, column]).any() for curve in response.curves):
        raise PlotError("the file holds no point of any curve")
    return column


def draw_bands(
    response: DrawnResponse, column: int, bands: Sequence[Band], span: tuple[float, float], log: bool | None
) -> Figure:
    """The figure of one degree of freedom: each band with its median."""
    with house_style():
        figure = new_figure()
        axes = figure.add_subplot()
        for band, colour in zip(bands, sequence_colours(len(bands)), strict=True):
            shade = "#5b7fa6" if len(bands) == 1 else colour
            axes.fill_between(
                band.frequency, band.low, band.high, color=shade, alpha=LAYOUT.band_opacity, linewidth=0.0
            )
            axes.plot(band.frequency, band.median, color=colour, linewidth=1.1)
        axes.set_xlabel(frequency_label(response.frequency_unit))
        axes.set_ylabel(response.amplitude_label(column), parse_math=False)
        axes.margins(x=0.0)
        axes.minorticks_on()
        if wide(response.curves):
            axes.set_xscale("log")
        _finish(axes, bands, log)
        axes.set_title(_said(bands, span) + _doubt(response, column), loc="right", fontsize=8)
        say_unfinished(axes, response.unfinished)
        name_at_side(figure, axes.get_lines(), [band.parameters for band in bands], response.units)
    return figure


def _said(bands: Sequence[Band], span: tuple[float, float]) -> str:
    """Title: percentiles of the band, number of draws, and how many draws its ends need if these are few."""
    from fcm.results.quantile_interval import draws_needed
    from fcm.results.scatter import draws_beyond

    fewest = min(bands, key=lambda band: band.draws)
    count, reached = fewest.draws, fewest.reached
    if reached != span:
        own = " and ".join(f"{end:g}" for end, other in zip(span, reached, strict=True) if end != other)
        takes = max(draws_beyond(end) for end, other in zip(span, reached, strict=True) if end != other)
        ends = (f"{reached[0]:g} %" if reached[0] else "least", f"{reached[1]:g} %")
        to = f"{ends[0]} to {'greatest' if reached[1] == 100.0 else ends[1]}"
        return f"median, and {to} of {count} draws: too few for {own} %, which take {takes}"
    needed = max(map(draws_needed, span))
    few = f": too few to bound these, {needed:g} are needed" if count < needed < np.inf else ""
    return f"median, and {span[0]:g} to {span[1]:g} % of {count} draws{few}"


def _doubt(response: DrawnResponse, column: int) -> str:
    """Title line that counts the curves whose error at the peak is large or unknown; '' if there are none."""
    tops = [
        doubtful(curve)[np.nanargmax(curve.amplitude[:, column])]
        for curve in response.curves
        if np.isfinite(curve.amplitude[:, column]).any()
    ]
    if not any(tops):
        return ""
    largest = f"{100 * LAYOUT.doubtful_error:g} %"
    many = f"peaks of {sum(tops)} of {len(tops)} draws may"
    return f"\n{many} err by more than {largest}, or by an unknown amount: take more harmonics"


def _finish(axes: Axes, bands: Sequence[Band], log: bool | None) -> None:
    if log if log is not None else has_decades([float(np.nanmax(band.median)) for band in bands]):
        logarithmic_axis(axes)
    else:
        axes.set_ylim(bottom=0.0)
