"""Random draws in pictures of peaks: their median and their scatter, without a line between draws."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from fcm.plot.labels import symbols
from fcm.rotational_dofs import dof_unit

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from fcm.plot.peak import Peaks
    from fcm.results.spread import DrawnSpread

COLOUR = "#c03020"
_WIDTH = 0.6  # [point]


def draw_scatter(panels: Sequence[Axes], found: Sequence[DrawnSpread], peaks: Peaks, key: str) -> None:
    """Draw the median and the scatter of the random draws.

    If nothing else was swept, they are lines across the first panel. Against a number that was not drawn,
    each value has a median, with a bar for the scatter. If the axis is a drawn number and others were swept,
    nothing is drawn: the colours tell these apart. The spreads of `found` are by panel, the amplitude first.
    """
    if len(peaks.random) == len(peaks.parameters):
        of_all = found[0].spreads[0]
        for value, style in ((of_all.median, "-"), (of_all.low, "--"), (of_all.high, "--")):
            panels[0].axhline(value, color=COLOUR, linewidth=_WIDTH, linestyle=style, zorder=0)
        return
    if key in peaks.random:
        return
    x = [one.parameters[key] for one in found]
    for panel, axes in enumerate(panels):
        each = [one.spreads[panel] for one in found]
        middle = np.array([one.median for one in each])
        reach = np.abs(np.array([[one.low, one.high] for one in each]).T - middle)
        axes.errorbar(
            x, middle, reach, fmt="_", color=COLOUR, linewidth=_WIDTH, markersize=8.0, capsize=2.5, zorder=3
        )  # fmt: skip


def say_scatter(axes: Axes, found: Sequence[DrawnSpread], peaks: Peaks, key: str, column: int) -> None:
    """Title the axes with the numbers drawn at random and the scatter shown.

    No least peak is marked, since nobody chooses a draw.
    """
    from fcm.results.scatter import draws_beyond

    names = ", ".join(symbols(peaks.random))
    amplitudes = [one.spreads[0] for one in found]
    few = f"5 to 95 % take {draws_beyond(5.0)}"
    said = f"random draws of {names}"
    if len(peaks.random) == len(peaks.parameters):
        (of_all,) = amplitudes
        own = dof_unit(peaks.dofs[column], peaks.length)
        ends = f"{of_all.low:.4g} to {of_all.high:.4g} {own}".rstrip()
        said = f"{of_all.count} {said}:\nmedian {of_all.median:.4g}, " + (
            f"5 to 95 % are {ends}" if of_all.percents else f"all are {ends} ({few})"
        )
    elif key not in peaks.random:
        whole = all(one.percents for one in amplitudes)
        said += ": medians, and bars of " + ("5 to 95 %" if whole else f"all draws ({few})")
    axes.set_title(said, loc="right", fontsize=8, color=COLOUR)
