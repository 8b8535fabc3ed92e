"""Bands of the response over random draws: percentiles of the amplitude at each frequency."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fcm.plot.errors import PlotError
from fcm.plot.labels import curve_label, frequency_label, symbols, with_unit
from fcm.plot.read import LEVEL, DrawnCurve, DrawnResponse, FloatArray, ends, wide
from fcm.plot.style import house_style, logarithmic_axis, new_figure, sequence_colours

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

PLACES = 600  # frequencies at which percentiles are taken
_FAINT = 0.28
_DECADE = 10.0  # medians that span more are drawn on a logarithmic axis
_MOST_NAMES = 12


@dataclass(frozen=True)
class Band:
    """Of the curves that differ in drawn numbers alone; NaN where none of them reaches."""

    parameters: dict[str, float]  # the swept values that are not drawn
    frequency: FloatArray  # (place,)
    low: FloatArray
    median: FloatArray
    high: FloatArray


def bands_of(response: DrawnResponse, column: int, span: tuple[float, float]) -> list[Band]:
    """A band for each combination of the swept values that are not drawn, of percentiles."""
    if not response.drawn:
        raise PlotError("nothing was drawn at random in this sweep, so that it has no bands")
    if response.frequency_unit == LEVEL:
        raise PlotError("the curves are against the level of the forces; bands are over frequencies")
    curves = [curve for curve in response.curves if np.isfinite(curve.amplitude[:, column]).any()]
    if not curves:
        raise PlotError("the file holds no point of any curve")
    low, high = ends(curves)
    places = (np.geomspace if wide(curves) else np.linspace)(low, high, PLACES)
    groups: dict[tuple[tuple[str, float], ...], list[FloatArray]] = {}
    for curve in curves:
        key = tuple((k, v) for k, v in curve.parameters.items() if k not in response.drawn)
        groups.setdefault(key, []).append(greatest_at(curve, column, places))
    return [_band(dict(key), places, values, span) for key, values in groups.items()]


def greatest_at(curve: DrawnCurve, column: int, places: FloatArray) -> FloatArray:
    """The greatest stable amplitude at frequencies, by interpolation; NaN where there is none."""
    x, y = curve.frequency, curve.amplitude[:, column]
    stable = np.ones(x.size, bool) if curve.stable is None else curve.stable
    if x.size == 1:
        return np.where(places == x[0], y[0], np.nan)
    out = np.full(places.size, np.nan)
    for k in np.flatnonzero(np.isfinite(np.diff(x)) & stable[:-1] & stable[1:]):
        one, other = (k, k + 1) if x[k] <= x[k + 1] else (k + 1, k)
        at = slice(*np.searchsorted(places, (x[one], x[other]), side="left") + np.array([0, 1]))
        inside = places[at][places[at] <= x[other]]
        if inside.size:
            value = np.interp(inside, x[[one, other]], y[[one, other]])
            out[at.start : at.start + inside.size] = np.fmax(out[at.start : at.start + inside.size], value)
    return out


def _band(
    parameters: dict[str, float], places: FloatArray, values: Sequence[FloatArray], span: tuple[float, float]
) -> Band:
    stack = np.array(values)
    known = np.isfinite(stack).any(axis=0)
    found = np.full((3, places.size), np.nan)
    found[:, known] = np.nanpercentile(stack[:, known], (span[0], 50.0, span[1]), axis=0)
    return Band(parameters, places, *found)


def draw_bands(
    response: DrawnResponse, dof: str | None, span: tuple[float, float], log: bool | None
) -> Figure:
    """The figure of one degree of freedom: a band with its median, for each that there is."""
    if dof is not None and dof not in response.dofs:
        raise PlotError(f"no degree of freedom {dof!r}; the file has {', '.join(response.dofs)}")
    column = 0 if dof is None else response.dofs.index(dof)
    bands = bands_of(response, column, span)
    with house_style():
        figure = new_figure()
        axes = figure.add_subplot()
        for band, colour in zip(bands, sequence_colours(len(bands)), strict=True):
            shade = "#5b7fa6" if len(bands) == 1 else colour
            axes.fill_between(band.frequency, band.low, band.high, color=shade, alpha=_FAINT, linewidth=0.0)
            axes.plot(band.frequency, band.median, color=colour, linewidth=1.1)
        axes.set_xlabel(frequency_label(response.frequency_unit))
        name = response.dofs[column]
        axes.set_ylabel(with_unit(f"Amplitude of {name}", response.length), parse_math=False)
        axes.margins(x=0.0)
        axes.minorticks_on()
        if wide(response.curves):
            axes.set_xscale("log")
        _finish(axes, bands, log)
        axes.set_title(f"median, and {span[0]:g} to {span[1]:g} % of the draws", loc="right", fontsize=8)
        _name(figure, axes, bands)
    return figure


def _finish(axes: Axes, bands: Sequence[Band], log: bool | None) -> None:
    tops = [np.nanmax(band.median) for band in bands]
    if log if log is not None else max(tops) > _DECADE * min(tops) > 0.0:
        logarithmic_axis(axes)
    else:
        axes.set_ylim(bottom=0.0)


def _name(figure: Figure, axes: Axes, bands: Sequence[Band]) -> None:
    keys = list(bands[0].parameters)
    if not keys:
        return
    lines = axes.get_lines()
    shown = range(len(bands)) if len(bands) <= _MOST_NAMES else (0, len(bands) - 1)
    figure.legend(
        [lines[i] for i in shown],
        [curve_label(bands[i].parameters, False) for i in shown],
        title=",\n".join(symbols(keys)),
        loc="outside right upper",
    )
