"""Points of the exact motion over the curves of harmonic balance: triangles for sweeps up and down."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from fcm.frozen import Frozen
from fcm.plot.dof import column_of
from fcm.plot.errors import PlotError
from fcm.plot.labels import short_names
from fcm.plot.options import READ
from fcm.plot.read import LEVEL, DrawnCurve, DrawnResponse, opened_response, response_in
from fcm.plot.reader_process import apart
from fcm.plot.style import LAYOUT

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.lines import Line2D

MARKERS = {"up": "^", "down": "v", "": "o"}  # by the sweep that visited a point; '' for a traced curve
WORDS = {"up": "exact motion, swept up", "down": "swept down", "": "exact motion"}
ALONE = {"up": "#0072B2", "down": "#D55E00", "": "#0072B2"}  # colours for one curve; the markers differ too
NEUTRAL = "#404040"  # of legend handles for several curves
SIZE, SMALL = 4.0, 3.0  # [point] of a marker; of several curves' markers


class DrawnPoints(Frozen):
    """A response of exact motions, and for each of its curves the sweep of every point."""

    response: DrawnResponse
    sweeps: tuple[npt.NDArray[np.str_], ...]


@apart
def read_points(path: Path) -> DrawnPoints:
    """Read what ``fcm respond --method exact -o`` has written; PlotError if the file is something else."""
    with opened_response(path) as dataset:
        if "sweep" not in dataset.variables:
            raise PlotError(f"{path}: no exact motions; fcm respond --method exact -o FILE writes them")
        response = response_in(dataset)
        rows = np.asarray(dataset.variables["sweep"][:], dtype=str)
        sweeps = tuple(row[: len(c.frequency)] for row, c in zip(rows, response.curves, strict=True))
    return DrawnPoints(response, sweeps)


def draw_points(
    axes: Axes, points: DrawnPoints, dof: str, unit: str, curves: Sequence[DrawnCurve], colours: Sequence[str]
) -> None:
    """Draw the points of the curves that are drawn, each in the colour of its curve.

    Raises
    ------
    PlotError
        If the points lack the degree of freedom, belong to other curves, or are over the other axis.
    """
    theirs = points.response
    if (theirs.frequency_unit == LEVEL) != (unit == LEVEL):
        over = ("frequency", "the level of the forces")
        ours = over[unit == LEVEL]
        raise PlotError(
            f"the curves are over {ours}, the points over {over[unit != LEVEL]}; "
            f"--points takes points over {ours}"
        )
    column, factor = (
        column_of(theirs.dofs, dof, "the points have"),
        frequency_factor(theirs.frequency_unit, unit),
    )
    several = len(curves) > 1
    for curve, sweep in zip(theirs.curves, points.sweeps, strict=True):
        number = match(curve.parameters, [one.parameters for one in curves], "points")
        for way in (way for way in MARKERS if way in sweep):
            chosen = np.flatnonzero((sweep == way) & np.isfinite(curve.frequency))
            if not way:
                chosen = chosen[:: max(1, chosen.size // LAYOUT.marked_points)]
            axes.plot(
                factor * curve.frequency[chosen], curve.amplitude[chosen, column], MARKERS[way],
                color=colours[number] if several else ALONE[way], markerfacecolor="none",
                markeredgewidth=LAYOUT.point_edge,
                markersize=SMALL if several else SIZE, label=f"_{WORDS[way]}",
            )  # fmt: skip


def names_of_points(axes: Axes) -> dict[str, Line2D]:
    """Legend handles of the line and the markers, by their names."""
    from matplotlib.lines import Line2D

    drawn = {str(line.get_label()): line for line in axes.get_lines()}
    ways = [way for way, word in WORDS.items() if f"_{word}" in drawn]
    alone = sum(line.get_label() == f"_{WORDS[ways[0]]}" for line in axes.get_lines()) == 1 if ways else True
    handles = [Line2D([], [], color=NEUTRAL, linewidth=1.1)]
    for way in ways:
        colour = ALONE[way] if alone else NEUTRAL
        handle = Line2D([], [], linestyle="none", marker=MARKERS[way], color=colour, markersize=SIZE)
        handle.set(markerfacecolor="none", markeredgewidth=LAYOUT.point_edge)
        handles.append(handle)
    words = ["harmonic balance", *(WORDS[way] for way in ways)]
    return dict(zip(words, handles, strict=True))


def frequency_factor(theirs: str, ours: str) -> float:
    """Factor that converts frequencies of one unit to another."""
    units = {"rad/s": 1.0, "Hz": 2.0 * np.pi}
    return units.get(theirs, 1.0) / units.get(ours, 1.0)


def match(own: Mapping[str, float], curves: Sequence[Mapping[str, float]], what: str) -> int:
    """Number of the first curve that has the swept values of points or of a mode.

    Raises
    ------
    PlotError
        If no curve has them. A single curve matches, too, if it or the points are of a scene without a sweep.
    """
    if len(curves) == 1 and not (own and curves[0]):
        return 0
    for number, values in enumerate(curves):
        if same_parameters(own, values):
            return number
    names = short_names(own)
    told = ", ".join(f"{names[key]} = {value:.6g}" for key, value in own.items())
    theirs = f"with {told}" if told else "of a scene without a sweep"
    raise PlotError(f"no curve of the file is that of the {what} {theirs}; the curves have {_swept(curves)}")


def _swept(curves: Sequence[Mapping[str, float]]) -> str:
    """The values of each swept quantity; only the first of many."""
    told = []
    for key, name in short_names(curves[0]).items():
        values = list(dict.fromkeys(f"{values[key]:.6g}" for values in curves))
        more = ", ..." * (len(values) > READ.values_named)
        told.append(f"{name} = {', '.join(values[: READ.values_named])}{more}")
    return "; ".join(told) or "no swept values"


def same_parameters(one: Mapping[str, float], other: Mapping[str, float]) -> bool:
    """Whether the swept values are the same."""
    return one.keys() == other.keys() and all(np.isclose(one[k], other[k], rtol=1e-12, atol=0.0) for k in one)
