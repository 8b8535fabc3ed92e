"""The errors of response curves over the frequency, in a panel below them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np

from fcm.plot.read import DrawnCurve, FloatArray, ends, wide
from fcm.plot.style import LAYOUT

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from matplotlib.lines import Line2D

SHARES = (3.1, 1.0)  # heights of the curves and of the panel
RANGE = (1e-8, 1.0)  # of errors; the same in every picture, so that pictures can be compared
_GREY, _WIDTH = "0.8", 1.0


def has_errors(curves: Sequence[DrawnCurve]) -> bool:
    """Whether any curve has an error that is known and not 0."""
    errors = [error for c in curves for error in (c.table_error, c.truncation_error) if error is not None]
    return any(bool((error > 0.0).any()) for error in errors)


def draw_errors(axes: Axes, curves: Sequence[DrawnCurve], colours: Sequence[str], width: float) -> None:
    """Draw a line for each curve's truncation error, and an area for the greatest table error of all.

    Many curves have one line: the greatest truncation error of any.
    """
    edges, table = _largest(curves, [curve.table_error for curve in curves])
    axes.stairs(
        np.maximum(table, LAYOUT.least_error), edges, baseline=LAYOUT.least_error, fill=True, color=_GREY
    )
    if together(len(curves)):
        greatest = _largest(curves, [curve.truncation_error for curve in curves])[1]
        draw_greatest(axes, edges, greatest)
        _finish(axes, float(greatest.max()))
        return
    for curve, colour in zip(curves, colours, strict=True):
        if curve.truncation_error is not None:
            error = np.maximum(curve.truncation_error, LAYOUT.least_error)
            axes.plot(curve.frequency, error, color=colour, linewidth=width)
    _finish(axes)


def together(count: int) -> bool:
    """Whether lines of the errors of so many curves would be a tangle."""
    return count > LAYOUT.error_lines


def name_errors(
    figure: Figure,
    curves: Sequence[DrawnCurve],
    colour: str,
    width: float,
    notes: Mapping[str, Line2D],
) -> None:
    """Names the lines and the area of the error panel, and adds notes on lines of the curves."""
    from matplotlib.lines import Line2D
    from matplotlib.patches import Patch

    names: dict[str, Line2D | Patch] = {**notes}
    one = together(len(curves))
    names["below: error by harmonics left out" + " (greatest)" * one] = Line2D(
        [], [], color="black" if one else colour, linewidth=_WIDTH if one else width
    )
    if (_largest(curves, [curve.table_error for curve in curves])[1] > 0.0).any():
        of_all = " (greatest)" if len(curves) > 1 else ""
        names[f"below: error by the table{of_all}"] = Patch(color=_GREY)
    figure.legend(names.values(), names.keys(), loc="outside lower center", ncols=2)


def _finish(axes: Axes, highest: float = 0.0) -> None:
    """Set scales and limits; highest: the greatest error that is not drawn as a line."""
    from matplotlib.ticker import LogLocator, NullLocator

    top = max(
        [RANGE[1], highest, *(float(np.nanmax(line.get_ydata(), initial=0.0)) for line in axes.get_lines())]
    )
    axes.margins(x=0.0)
    axes.set_yscale("log")
    axes.set_ylim(RANGE[0], top)
    axes.yaxis.set_major_locator(LogLocator(numticks=6))
    axes.yaxis.set_minor_locator(NullLocator())
    axes.set_ylabel("Relative error")


def _largest(
    curves: Sequence[DrawnCurve], errors: Sequence[FloatArray | None]
) -> tuple[FloatArray, FloatArray]:
    """Edges of equal bins over the frequencies, and the greatest error in each, of any curve."""
    edges = (np.geomspace if wide(curves) else np.linspace)(*ends(curves), LAYOUT.error_bins + 1)
    return edges, greatest_between(edges, [curve.frequency for curve in curves], errors)


def greatest_between(
    edges: FloatArray, places: Sequence[FloatArray], errors: Sequence[FloatArray | None]
) -> FloatArray:
    """The greatest error in each bin, of any curve that passes through it; 0 where none is known."""
    bins = edges.size - 1
    largest = np.zeros(bins)
    for place, own in zip(places, errors, strict=True):
        if own is None:
            continue
        # 0 * place is NaN between branches, where no error is known
        known = own + 0.0 * place
        error = np.nan_to_num(np.maximum(known[:-1], known[1:]))
        # the bins that each piece of the curve passes through
        at = np.clip(np.searchsorted(edges, place, side="right") - 1, 0, bins - 1)
        np.maximum.at(largest, at, np.nan_to_num(known))  # isolated points, too
        first, last = np.minimum(at[:-1], at[1:]), np.maximum(at[:-1], at[1:])
        count = last - first + 1
        before = np.cumsum(count) - count
        through = np.repeat(first - before, count) + np.arange(count.sum())
        np.maximum.at(largest, through, np.repeat(error, count))
    return largest


def draw_greatest(axes: Axes, edges: FloatArray, largest: FloatArray) -> None:
    """One line for the errors of many curves."""
    axes.stairs(
        np.maximum(largest, LAYOUT.least_error), edges, baseline=None, color="black", linewidth=_WIDTH
    )
