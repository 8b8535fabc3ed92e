"""Random draws in pictures of peaks: their median and their scatter, without a line between draws."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from fcm.plot.labels import symbols
from fcm.rotational_dofs import unit_of

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from fcm.plot.peak import Peaks
    from fcm.plot.read import BoolArray, FloatArray

COLOUR = "#c03020"
_WIDTH = 0.6  # [point]


def draw_scatter(panels: Sequence[tuple[Axes, FloatArray]], peaks: Peaks, key: str, known: BoolArray) -> None:
    """The median of the draws, and their scatter: lines across where nothing else was swept.

    Against a number that was not drawn there is a median at each value, with a bar for the scatter. Where
    the axis is of a drawn number and others were swept, there is neither: the colours tell these apart.
    """
    from fcm.results.scatter import spread_of  # and all that makes results

    if len(peaks.random) == len(peaks.parameters):
        found = spread_of(panels[0][1][known])
        for value, style in ((found.median, "-"), (found.low, "--"), (found.high, "--")):
            panels[0][0].axhline(value, color=COLOUR, linewidth=_WIDTH, linestyle=style, zorder=0)
        return
    if key in peaks.random:
        return
    groups = _groups(peaks, known)
    x = [float(peaks.parameters[key][rows[0]]) for rows in groups.values()]
    for axes, values in panels:
        each = [spread_of(values[rows]) for rows in groups.values()]
        middle = np.array([one.median for one in each])
        reach = np.abs(np.array([[one.low, one.high] for one in each]).T - middle)
        axes.errorbar(
            x, middle, reach, fmt="_", color=COLOUR, linewidth=_WIDTH, markersize=8.0, capsize=2.5, zorder=3
        )  # fmt: skip


def say_scatter(axes: Axes, peaks: Peaks, key: str, column: int, known: BoolArray) -> None:
    """Writes what was drawn, and what is drawn of its scatter; nobody chooses a draw."""
    from fcm.results.scatter import draws_beyond, spread_of

    names = ", ".join(symbols(peaks.random))
    each = [spread_of(peaks.amplitude[rows, column]) for rows in _groups(peaks, known).values()]
    few = f"5 to 95 % take {draws_beyond(5.0)}"
    said = f"random draws of {names}"
    if len(peaks.random) == len(peaks.parameters):
        (found,) = each
        own = unit_of(peaks.dofs[column], peaks.length)
        ends = f"{found.low:.4g} to {found.high:.4g} {own}".rstrip()
        said = f"{found.count} {said}:\nmedian {found.median:.4g}, " + (
            f"5 to 95 % are {ends}" if found.percents else f"all are {ends} ({few})"
        )
    elif key not in peaks.random:
        whole = all(found.percents for found in each)
        said += ": medians, and bars of " + ("5 to 95 %" if whole else f"all draws ({few})")
    axes.set_title(said, loc="right", fontsize=8, color=COLOUR)


def _groups(peaks: Peaks, known: BoolArray) -> dict[tuple[float, ...], list[int]]:
    """Curves with the same swept values that were not drawn, by these values."""
    given = [values for name, values in peaks.parameters.items() if name not in peaks.random]
    groups: dict[tuple[float, ...], list[int]] = {}
    for i in np.flatnonzero(known).tolist():
        groups.setdefault(tuple(float(values[i]) for values in given), []).append(i)
    return groups
