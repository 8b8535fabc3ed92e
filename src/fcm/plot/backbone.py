"""Nonlinear modes over response curves: the amplitude of a degree of freedom against the mode's frequency."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from fcm.plot.dof import column_of
from fcm.plot.errors import PlotError
from fcm.plot.points import frequency_factor, match
from fcm.plot.read import LEVEL, DrawnCurve, DrawnResponse, FloatArray, opened, read_response
from fcm.plot.reader_process import apart

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.lines import Line2D

NAME = "nonlinear mode (backbone)"
COLOUR, WIDTH, DASHES = "#D55E00", 1.0, (0, (6.0, 1.5, 1.0, 1.5))
_FORCES = ("force.", "base.", "excitation.")  # swept quantities that a mode does not depend on


@apart
def read_backbone(path: Path) -> DrawnResponse:
    """Read what ``fcm respond --mode -o`` has written; PlotError if the file is something else."""
    with opened(path, "a file of nonlinear modes (fcm respond --mode)", ("damping_ratio", "frequency")):
        pass
    return read_response(path)


def draw_backbone(
    axes: Axes,
    modes: DrawnResponse,
    response: DrawnResponse,
    column: int,
    curves: Sequence[DrawnCurve],
    colours: Sequence[str],
) -> Line2D:
    """Draw the modes up to the height of the highest curve, and return their legend handle.

    The limits of the axes do not change. A mode that belongs to one of several curves has the colour of that
    curve. The curves may differ in their forces, on which modes do not depend.

    Raises
    ------
    PlotError
        If the modes have other degrees of freedom or other swept values, or nothing within the axes.
    """
    from matplotlib.lines import Line2D

    if response.frequency_unit == LEVEL:
        raise PlotError("the curves are against the level of the forces; a backbone is over frequencies")
    own = column_of(modes.dofs, response.dofs[column], "the modes have")
    factor = frequency_factor(modes.frequency_unit, response.frequency_unit)
    (low, high), top = axes.get_xlim(), float(axes.dataLim.y1)
    seen, of_curves = False, [_without_forces(curve.parameters) for curve in curves]
    for mode in modes.curves:
        values = _without_forces(mode.parameters)
        distinct = [one for i, one in enumerate(of_curves) if one not in of_curves[:i]]
        theirs = distinct[match(values, distinct, "mode")]
        alone = len(curves) > 1 and of_curves.count(theirs) == 1
        x, y = _below(factor * mode.frequency, mode.amplitude[:, own], top)
        seen |= bool(((x >= low) & (x <= high) & np.isfinite(y)).any())
        axes.plot(
            x, y, color=colours[of_curves.index(theirs)] if alone else COLOUR, linewidth=WIDTH,
            linestyle=DASHES, label="_backbone", scalex=False, scaley=False,
        )  # fmt: skip
    if not seen:
        every = np.concatenate([mode.frequency for mode in modes.curves] or [np.zeros(1)])
        ends = f"{factor * np.nanmin(every):.6g} to {factor * np.nanmax(every):.6g} {response.frequency_unit}"
        raise PlotError(f"the modes, from {ends}, are not within the range and heights of the curves")
    return Line2D([], [], color=COLOUR, linewidth=WIDTH, linestyle=DASHES)


def _without_forces(parameters: Mapping[str, float]) -> dict[str, float]:
    """Swept values that modes depend on."""
    return {key: value for key, value in parameters.items() if not key.startswith(_FORCES)}


def _below(x: FloatArray, y: FloatArray, top: float) -> tuple[FloatArray, FloatArray]:
    """The line with its crossings of a height inserted; NaN above that height."""
    above = y - top
    passing = np.flatnonzero(above[:-1] * above[1:] < 0.0)
    part = above[passing] / (above[passing] - above[passing + 1])
    x = np.insert(x, passing + 1, x[passing] + part * (x[passing + 1] - x[passing]))
    y = np.insert(y, passing + 1, top)
    return x, np.where(y <= top, y, np.nan)
