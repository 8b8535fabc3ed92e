"""Nonlinear modes: frequency and damping ratio against the modal amplitude."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from fcm.plot.curve_names import name_at_side
from fcm.plot.errors import PlotError
from fcm.plot.labels import frequency_label
from fcm.plot.options import READ
from fcm.plot.read import FloatArray, floats, opened, swept_units, swept_values
from fcm.plot.reader_process import apart
from fcm.plot.style import LAYOUT, house_style, new_figure, sequence_colours

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_NEEDED = ("frequency", "modal_amplitude", "damping_ratio")
_PERCENT = 100.0


@dataclass(frozen=True)
class DrawnMode:
    """One curve without its padding."""

    parameters: dict[str, float]
    frequency: FloatArray  # (point,) in the file's unit
    amplitude: FloatArray  # (point,) modal
    damping: FloatArray  # (point,) ratio


@dataclass(frozen=True)
class DrawnModes:
    title: str
    frequency_unit: str
    modes: tuple[DrawnMode, ...]
    units: Mapping[str, str] = field(default_factory=dict)  # of swept keys, if the file says them


@apart
def read_modes(path: Path) -> DrawnModes:
    """Read what ``fcm respond --mode -o`` has written; PlotError if the file is something else."""
    with opened(path, "a file of nonlinear modes (fcm respond --mode)", _NEEDED) as data:
        frequency, amplitude, damping = (floats(data.variables[name]) for name in _NEEDED)
        swept = swept_values(data.variables)
        found = [
            DrawnMode({key: float(values[i]) for key, values in swept.items()}, *(x[known] for x in one))
            for i, one in enumerate(zip(frequency, amplitude, damping, strict=True))
            if (known := np.isfinite(one[0])).any()
        ]
        if not found:
            raise PlotError(f"{path}: the file holds no point of any mode")
        unit = str(getattr(data, "frequency_unit", "rad/s"))
        return DrawnModes(
            str(getattr(data, "title", "")), unit, tuple(found), swept_units(data.variables, swept)
        )


def draw_modes(drawn: DrawnModes) -> Figure:
    """The figure: frequency above, damping below, the modal amplitude on a logarithmic axis."""
    modes = drawn.modes
    with house_style():
        figure = new_figure(LAYOUT.width, 1.3 * LAYOUT.height)
        upper, lower = figure.subplots(2, 1, sharex=True)
        for mode, colour in zip(modes, sequence_colours(len(modes)), strict=True):
            upper.plot(mode.amplitude, mode.frequency, color=colour, linewidth=1.1)
            lower.plot(mode.amplitude, _PERCENT * mode.damping, color=colour, linewidth=1.1)
            _mark_greatest(lower, mode, colour, drawn.frequency_unit if len(modes) == 1 else "")
        upper.set_xscale("log")
        upper.set_ylabel(frequency_label(drawn.frequency_unit))
        lower.set_ylabel("Damping ratio (%)")
        lower.set_xlabel("Modal amplitude")
        lower.set_ylim(bottom=0.0)
        lower.margins(x=0.0)
        lower.set_ylim(top=1.12 * lower.get_ylim()[1])
        name_at_side(figure, upper.get_lines(), [one.parameters for one in modes], drawn.units)
    return figure


def _mark_greatest(axes: Axes, mode: DrawnMode, colour: str, unit: str) -> None:
    """A ring where the mode is damped most, with the values beside it where there is one mode."""
    top = int(mode.damping.argmax())
    if mode.damping[top] <= READ.higher_fraction * max(
        mode.damping[0], mode.damping[-1]
    ):  # at an end, or by rounding
        return
    x, y = float(mode.amplitude[top]), float(_PERCENT * mode.damping[top])
    axes.plot([x], [y], "o", markersize=6, markerfacecolor="none", color=colour, markeredgewidth=1.0)
    if unit:
        text = f"{y:.3g} % at {mode.frequency[top]:.4g} {unit}"
        inwards = -1 if x * x > mode.amplitude[0] * mode.amplitude[-1] else 1  # from the middle of a log axis
        axes.annotate(
            text, (x, y), xytext=(8 * inwards, 4), textcoords="offset points", fontsize=8,
            ha="right" if inwards < 0 else "left",
        )  # fmt: skip
