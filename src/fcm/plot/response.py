"""Amplitude against frequency: one line per curve, labelled with its swept values; errors below."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Literal

import numpy as np

from fcm.plot.backbone import NAME as BACKBONE
from fcm.plot.backbone import draw_backbone
from fcm.plot.blades import draw_blades
from fcm.plot.curve_names import label_at_peaks, varying
from fcm.plot.error_panel import SHARES, draw_errors, has_errors, name_errors
from fcm.plot.errors import PlotError
from fcm.plot.labels import curve_label, frequency_label, symbols
from fcm.plot.measured import as_measured, draw_measured, name_measured
from fcm.plot.points import NEUTRAL, DrawnPoints, draw_points, names_of_points
from fcm.plot.read import LEVEL, BoolArray, DrawnCurve, DrawnResponse, wide
from fcm.plot.style import (
    DOTS,
    LAYOUT,
    colour_bar,
    has_decades,
    house_style,
    logarithmic_axis,
    new_figure,
    sequence_colours,
    split,
)
from fcm.plot.unfinished import mark_unfinished, say_unfinished
from fcm.plot.window import Window, within

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from matplotlib.legend import Legend
    from matplotlib.lines import Line2D

DRAWS = "#31688e"  # colour of random draws, which need no names
_WIDTH, _THIN = 1.1, 0.4  # [point] of a line; of one among very many
LineStyle = Literal["-"] | tuple[float, tuple[float, float]]
_LINE: LineStyle = "-"
_DASHES: LineStyle = (0, (3.0, 1.6))
# legend text for both reasons why a stretch is faded
_FADED = f"may err by more than {100 * LAYOUT.doubtful_error:g} %, or by an unknown amount"
_STABLE = "stable curve"  # solid line, if there are others
_NOT_STABLE = "unstable"  # dashed line
_UNKNOWN = "stability unknown"  # dotted line
_HOLLOW = "a point, unstable or of unknown stability"  # hollow dot
_UNNAMED = "_unnamed"  # label of all parts but the first; the underscore keeps it out of legends


def draw_response(
    response: DrawnResponse,
    dof: str | None = None,
    log: bool | None = None,
    errors: bool = True,
    points: DrawnPoints | None = None,
    backbone: DrawnResponse | None = None,
    window: Window | None = None,
) -> Figure:
    """The figure of one degree of freedom, by default that of `DrawnResponse.column`.

    Unstable parts are dashed, parts of unknown stability dotted. Errors that the file knows have a panel
    below the curves, unless errors is false. Points of the exact motion and a backbone of nonlinear modes
    are drawn over the curves. window is the part of the axis to draw. For a mistuned ring, the envelope over
    its sectors is drawn, unless dof is that of one sector.
    """
    alone = points is None and backbone is None
    column = (response if window is None else within(response, window)).column(dof, alone)
    called = ""
    if alone:  # the others are half peak-to-peak
        response, called = as_measured(response, column)
    response = response if window is None else within(response, window)
    numbers, curves = _drawable(response, column, bool(log))
    envelope, blades = response.envelope(column), response.blades
    with house_style():
        figure, axes, below = _panels(errors and has_errors(curves))
        draws = _draws(response, curves)
        colours = _colours_of_draws(draws) if draws else sequence_colours(len(curves))
        width = _WIDTH if len(curves) <= LAYOUT.bar_names else _THIN
        axes.set_prop_cycle(color=colours)
        lines = [_draw_curve(axes, curve, column, width) for curve in curves]
        of_blades = {} if envelope is None else draw_blades(axes, response, envelope, numbers, colours)
        others: dict[str, Line2D] = {}
        if points is not None:
            draw_points(axes, points, response.dofs[column], response.frequency_unit, curves, colours)
            others = names_of_points(axes)
        marked = draw_measured(axes, response.measured, response.dofs[column], curves, colours)
        above = name_measured(figure, response.fitted, others) if marked else None
        if others and not marked:
            figure.legend(others.values(), others.keys(), loc="outside upper center", ncols=len(others))
        ends = [(curve.frequency, curve.amplitude[:, column]) for curve in response.curves]
        mark_unfinished(axes, ends, response.unfinished)
        say_unfinished(axes, response.unfinished)
        if wide(curves) and response.frequency_unit != LEVEL:
            axes.set_xscale("log")
        if window is not None:
            axes.set_xlim(window)
        _finish_axes(axes, response, column, _logarithmic(curves, column) if log is None else log)
        if called:
            axes.set_ylabel(called, parse_math=False)
        if below is not None:
            draw_errors(below, curves, colours, width)
            below.set_xlabel(axes.get_xlabel())
            axes.set_xlabel("")
        look = colours[0] if len(set(colours)) == 1 else NEUTRAL  # of legend handles for all curves
        notes = of_blades | _notes(axes, curves, column, look, width)
        if backbone is not None:
            notes[BACKBONE] = draw_backbone(axes, backbone, response, column, curves, colours)
        if below is not None:
            name_errors(figure, curves, look, width, notes)
        elif notes:
            figure.legend(notes.values(), notes.keys(), loc="outside lower center")
        # last: the height of the axes decides whether names have room at the peaks
        if draws:
            _name_draws(figure, axes, response, draws, lines)
            return figure
        if blades is not None:
            notes_of_blades = blades.labels(envelope, numbers)
            curves = [replace(one, note=note) for one, note in zip(curves, notes_of_blades, strict=True)]
        beside = _name_curves(figure, axes, curves, lines, column, response.units)
        if above is not None and beside is not None:
            above.remove()
            name_measured(figure, response.fitted, others, beside)
    return figure


def _drawable(response: DrawnResponse, column: int, log: bool) -> tuple[list[int], list[DrawnCurve]]:
    """The curves that have points of a degree of freedom, with their numbers."""
    numbers = [i for i, one in enumerate(response.curves) if np.isfinite(one.amplitude[:, column]).any()]
    curves = [response.curves[i] for i in numbers]
    if not curves:
        raise PlotError("the file holds no point of any curve")
    if log and not any((curve.amplitude[:, column] > 0.0).any() for curve in curves):
        name = response.dofs[column]
        raise PlotError(f"{name} does not move, so that its amplitude has no logarithmic axis; try --linear")
    return numbers, curves


def _draws(response: DrawnResponse, curves: list[DrawnCurve]) -> list[DrawnCurve]:
    """The curves without their randomly drawn values, if there are too many to be named; else none."""
    if len(curves) <= LAYOUT.bar_names or not set(curves[0].parameters) & set(response.drawn):
        return []
    kept = [{k: v for k, v in one.parameters.items() if k not in response.drawn} for one in curves]
    return [replace(curve, parameters=one) for curve, one in zip(curves, kept, strict=True)]


def _colours_of_draws(draws: Sequence[DrawnCurve]) -> list[str]:
    """A colour for all draws with the same other values."""
    groups = list(dict.fromkeys(tuple(one.parameters.values()) for one in draws))
    colours = [DRAWS] if len(groups) == 1 else sequence_colours(len(groups))
    return [colours[groups.index(tuple(one.parameters.values()))] for one in draws]


def _name_draws(
    figure: Figure, axes: Axes, response: DrawnResponse, draws: Sequence[DrawnCurve], lines: Sequence[Line2D]
) -> None:
    """Name the randomly drawn quantities above the axes, and the other swept values beside them."""
    first = {tuple(one.parameters.values()): i for i, one in reversed(list(enumerate(draws)))}
    places = sorted(first.values())
    names = ", ".join(symbols(key for key in response.curves[0].parameters if key in response.drawn))
    each = f"{len(draws)} curves, random draws of {names}"
    axes.set_title(each, loc="right", fontsize=8)
    if len(places) > 1:
        _legend(figure, [draws[i] for i in places], [lines[i] for i in places], response.units)


def _panels(errors: bool) -> tuple[Figure, Axes, Axes | None]:
    """A figure with the axes of the curves, and below those of their errors."""
    if not errors:
        figure = new_figure()
        return figure, figure.add_subplot(), None
    figure = new_figure(height=LAYOUT.height_with_errors)
    axes, below = figure.subplots(2, sharex=True, height_ratios=SHARES)
    return figure, axes, below


def _logarithmic(curves: list[DrawnCurve], column: int) -> bool:
    return has_decades([float(np.nanmax(curve.amplitude[:, column])) for curve in curves])


def _draw_curve(axes: Axes, curve: DrawnCurve, column: int, width: float) -> Line2D:
    """Draw a curve: solid where stable, dashed where unstable, dotted where its stability is unknown.

    Without stability in the file the curve is solid. Parts are faded where they are `doubtful`. A point
    without neighbours, as in files of peaks only, is a dot, hollow unless it is stable.
    """
    amplitude = curve.amplitude[:, column]
    unstable = np.zeros(len(amplitude), np.bool_) if curve.stable is None else ~curve.stable
    told, dashed = split(amplitude, unstable)
    solid, dotted = split(told, np.zeros_like(unstable) if curve.unknown is None else curve.unknown)
    trusted, faded = split(solid, doubtful(curve))
    (line,) = axes.plot(curve.frequency, trusted, linewidth=width)
    others = [(faded, _LINE, LAYOUT.doubtful_opacity)]
    for values, style in ((dashed, _DASHES), (dotted, DOTS)):
        sure, unsure = split(values, doubtful(curve))
        others += [(sure, style, 1.0), (unsure, style, LAYOUT.doubtful_opacity)]
    for values, style, alpha in others:
        if np.isfinite(values).any():
            axes.plot(
                curve.frequency, values, color=line.get_color(), linewidth=width, linestyle=style,
                alpha=alpha, label=_UNNAMED,
            )  # fmt: skip
    alone, hollow = _alone(curve, column), _not_stable(curve)
    for which, face in ((alone & ~hollow, line.get_color()), (alone & hollow, "none")):
        if which.any():
            axes.plot(
                curve.frequency[which], amplitude[which], ".", color=line.get_color(), markerfacecolor=face,
                label=_UNNAMED, clip_on=False,
            )  # fmt: skip
    return line


def _alone(curve: DrawnCurve, column: int) -> BoolArray:
    """Mask of points without neighbours, which no line reaches."""
    there = np.isfinite(curve.frequency) & np.isfinite(curve.amplitude[:, column])
    around = np.concatenate(([False], there, [False]))
    alone: BoolArray = there & ~around[:-2] & ~around[2:]
    return alone


def _notes(axes: Axes, curves: list[DrawnCurve], column: int, colour: str, width: float) -> dict[str, Line2D]:
    """Legend handles, by their texts, that explain faded, dashed and dotted parts of curves.

    Parts that are too short to be seen have none.
    """
    from matplotlib.lines import Line2D

    notes = {}
    if any(_seen(axes, curve, column, doubtful(curve)) for curve in curves):
        notes[_FADED] = Line2D([], [], color=colour, linewidth=width, alpha=LAYOUT.doubtful_opacity)
    if any(curve.stable is not None and _seen(axes, curve, column, ~curve.stable) for curve in curves):
        notes[_NOT_STABLE] = Line2D([], [], color=colour, linewidth=width, linestyle=_DASHES)
    if any(curve.unknown is not None and _seen(axes, curve, column, curve.unknown) for curve in curves):
        notes[_UNKNOWN] = Line2D([], [], color=colour, linewidth=width, linestyle=DOTS)
    if any((_alone(curve, column) & _not_stable(curve)).any() for curve in curves):
        notes[_HOLLOW] = Line2D([], [], color=colour, linestyle="none", marker=".", markerfacecolor="none")
    solid = any(_seen(axes, curve, column, ~_not_stable(curve)) for curve in curves)
    if solid and notes.keys() & {_NOT_STABLE, _UNKNOWN}:
        return {_STABLE: Line2D([], [], color=colour, linewidth=width), **notes}
    return notes


def _seen(axes: Axes, curve: DrawnCurve, column: int, which: BoolArray) -> bool:
    """Whether a stretch of a curve is long enough for its line style to be seen."""
    if not which.any():
        return False
    drawn = split(curve.amplitude[:, column], which)[1]  # with its neighbours
    place = axes.transData.transform(np.column_stack((curve.frequency, drawn)))
    steps = np.hypot(*np.diff(place, axis=0).T) * 72.0 / axes.get_figure(root=True).dpi  # type: ignore[union-attr]
    length = np.concatenate(([0.0], np.nancumsum(steps)))
    broken = np.concatenate(([0], np.flatnonzero(np.isnan(steps)) + 1, [steps.size]))
    return bool((np.diff(length[broken]) > LAYOUT.shortest_stretch).any())


def _not_stable(curve: DrawnCurve) -> BoolArray:
    """Mask of points at which a curve is unstable, or its stability unknown."""
    found = np.zeros(len(curve.frequency), np.bool_)
    for here in (None if curve.stable is None else ~curve.stable, curve.unknown):
        found = found if here is None else found | here
    return found


def doubtful(curve: DrawnCurve) -> BoolArray:
    """Mask of points where the truncation error exceeds a fifth, or is unknown over a wide stretch.

    Short stretches without an error do not count: it is never known beside a fold. If the error is known
    nowhere, as for exact motions, no point is doubtful.
    """
    error = curve.truncation_error
    if error is None or not np.isfinite(error).any():
        return np.zeros(len(curve.frequency), np.bool_)
    found: BoolArray = np.nan_to_num(error) > LAYOUT.doubtful_error
    unknown = np.isnan(error) & np.isfinite(curve.frequency)
    ends = np.flatnonzero(np.diff(np.concatenate(([False], unknown, [False]))))
    for first, end in ends.reshape(-1, 2).tolist():
        own = curve.frequency[first:end]
        found[first:end] |= bool(np.ptp(own) > LAYOUT.fold_width * own.max())
    return found


def _named(curve: DrawnCurve, units: Mapping[str, str], names: bool = True) -> str:
    state = {frozenset({"E"}): " (stuck)", frozenset({"S"}): " (open)"}.get(curve.regimes, "")
    return f"{curve_label(curve.parameters, names, units)}{state}\n{curve.note}".strip()


def _finish_axes(axes: Axes, response: DrawnResponse, column: int, log: bool) -> None:
    axes.set_xlabel(frequency_label(response.frequency_unit))
    axes.set_ylabel(response.amplitude_label(column), parse_math=False)
    axes.margins(x=0.0, y=0.07)
    axes.minorticks_on()
    if log:
        logarithmic_axis(axes)
    else:  # a flat curve would be drawn on the frame
        axes.set_ylim(0.0, max(axes.get_ylim()[1], LAYOUT.headroom * axes.dataLim.y1))


def _name_curves(
    figure: Figure,
    axes: Axes,
    curves: list[DrawnCurve],
    drawn: list[Line2D],
    column: int,
    units: Mapping[str, str],
) -> Legend | None:
    """Writes the curves' names at the peaks if there is room, otherwise in a legend beside the axes."""
    names = [_named(curve, units, i == 0) for i, curve in enumerate(curves)]
    lines = [(curve.frequency, curve.amplitude[:, column]) for curve in curves]
    if len(curves) <= LAYOUT.bar_names and label_at_peaks(figure, axes, lines, names):
        return None
    return _legend(figure, curves, drawn, units) if any(names) else None


def _legend(
    figure: Figure, curves: list[DrawnCurve], lines: list[Line2D], units: Mapping[str, str]
) -> Legend | None:
    """Draws a legend beside the axes; several swept quantities are named once, above their values."""
    several = len(curves[0].parameters) > 1
    parameters, title = varying([curve.parameters for curve in curves], units)
    curves = [replace(curve, parameters=one) for curve, one in zip(curves, parameters, strict=True)]
    if len(lines) > LAYOUT.bar_names:
        names = [_named(curve, units, names=False) for curve in curves]
        colour_bar(figure, names, ", ".join(title))
        return None
    return figure.legend(
        lines,
        [_named(curve, units, not several) for curve in curves],
        title=",\n".join(title) if several else None,
        loc="outside right upper",
    )
