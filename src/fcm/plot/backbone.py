"""Nonlinear modes over response curves: the amplitude of a degree of freedom against the mode's frequency."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from fcm.plot.dof import column_of
from fcm.plot.errors import PlotError
from fcm.plot.points import frequency_factor, same_parameters
from fcm.plot.read import LEVEL, DrawnCurve, DrawnResponse, opened, read_response
from fcm.plot.reader_process import apart

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.lines import Line2D

NAME = "nonlinear mode (backbone)"
COLOUR, WIDTH, DASHES = "#D55E00", 1.0, (0, (6.0, 1.5, 1.0, 1.5))


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
    """Draw the modes within the axes, which stay as they are; what stands for them in a legend.

    A mode with the swept values of a curve has its colour.

    Raises
    ------
    PlotError
        If the modes have other degrees of freedom, or nothing within the axes.
    """
    from matplotlib.lines import Line2D

    if response.frequency_unit == LEVEL:
        raise PlotError("the curves are against the level of the forces; a backbone is over frequencies")
    own = column_of(modes.dofs, response.dofs[column], "the modes have")
    factor = frequency_factor(modes.frequency_unit, response.frequency_unit)
    (low, high), top = axes.get_xlim(), axes.get_ylim()[1]
    seen = False
    for mode in modes.curves:
        x, y = factor * mode.frequency, mode.amplitude[:, own]
        seen |= bool(((x >= low) & (x <= high) & (y <= top)).any())
        same = [
            colour
            for curve, colour in zip(curves, colours, strict=True)
            if len(curves) > 1 and same_parameters(mode.parameters, curve.parameters)
        ]
        axes.plot(
            x, y, color=same[0] if same else COLOUR, linewidth=WIDTH, linestyle=DASHES,
            label="_backbone", scalex=False, scaley=False,
        )  # fmt: skip
    if not seen:
        every = np.concatenate([mode.frequency for mode in modes.curves] or [np.zeros(1)])
        ends = f"{factor * np.nanmin(every):.6g} to {factor * np.nanmax(every):.6g} {response.frequency_unit}"
        raise PlotError(f"the modes, from {ends}, are not within the range and heights of the curves")
    return Line2D([], [], color=COLOUR, linewidth=WIDTH, linestyle=DASHES)
