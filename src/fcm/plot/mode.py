"""Nonlinear modes: frequency, damping ratio and error against the modal amplitude."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from fcm.plot.curve_names import name_at_side
from fcm.plot.error_panel import RANGE
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
_ALSO = ("truncation_error", "resonant_level")
_PERCENT = 100.0
_BETWEEN = 16  # places of a line between two points of a mode
_NOTHING: FloatArray = np.zeros(0)


@dataclass(frozen=True)
class DrawnMode:
    """One curve without its padding."""

    parameters: dict[str, float]
    frequency: FloatArray  # (point,) in the file's unit
    amplitude: FloatArray  # (point,) modal
    damping: FloatArray  # (point,) ratio
    error: FloatArray = field(
        default_factory=lambda: _NOTHING
    )  # (point,) relative, NaN where unknown; or (0,)
    level: FloatArray = field(
        default_factory=lambda: _NOTHING
    )  # (point,) of the forces in resonance; or (0,)

    def smooth(self, values: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Amplitudes and a line through values of the points, which does not exceed them between two points.

        Where the amplitude turns back it is straight.
        """
        known = np.isfinite(values)
        amplitude, values = self.amplitude[known], values[known]
        if amplitude.size < 3 or not (np.diff(amplitude) > 0.0).all():
            return amplitude, values
        from scipy.interpolate import PchipInterpolator

        way = np.log(amplitude)
        places = np.arange((way.size - 1) * _BETWEEN + 1) / _BETWEEN
        fine = np.interp(places, np.arange(way.size), way)
        return np.exp(fine), PchipInterpolator(way, values)(fine)

    def at_level(self, level: float, values: FloatArray) -> list[tuple[float, float]]:
        """Amplitudes and values where the forces times a level are in resonance."""
        if not self.level.size:
            return []
        beyond = self.level - level
        found = []
        for k in np.flatnonzero(beyond[:-1] * beyond[1:] < 0.0):
            part = beyond[k] / (beyond[k] - beyond[k + 1])
            amplitude = self.amplitude[k] ** (1.0 - part) * self.amplitude[k + 1] ** part
            found.append((float(amplitude), float(values[k] + part * (values[k + 1] - values[k]))))
        return found


@dataclass(frozen=True)
class DrawnModes:
    title: str
    frequency_unit: str
    modes: tuple[DrawnMode, ...]
    units: Mapping[str, str] = field(default_factory=dict)  # of swept keys, if the file says them
    levels: tuple[float, ...] = ()  # of the forces, at which the response was predicted


@apart
def read_modes(path: Path) -> DrawnModes:
    """Read what ``fcm respond --mode -o`` has written; PlotError if the file is something else."""
    what = "a file of nonlinear modes (fcm respond --mode)"
    with opened(path, what, _NEEDED, (*_ALSO, "force_level")) as data:
        frequency, amplitude, damping = (floats(data.variables[name]) for name in _NEEDED)
        unknown = np.full(frequency.shape, np.nan)
        error, level = (floats(data.variables[name]) if name in data.variables else unknown for name in _ALSO)
        levels = floats(data.variables["force_level"]) if "force_level" in data.variables else _NOTHING
        swept = swept_values(data.variables)
        found = [
            DrawnMode({key: float(values[i]) for key, values in swept.items()}, *(x[known] for x in one))
            for i, one in enumerate(zip(frequency, amplitude, damping, error, level, strict=True))
            if (known := np.isfinite(one[0])).any()
        ]
        if not found:
            raise PlotError(f"{path}: the file holds no point of any mode")
        unit = str(getattr(data, "frequency_unit", "rad/s"))
        return DrawnModes(
            str(getattr(data, "title", "")),
            unit,
            tuple(found),
            swept_units(data.variables, swept),
            tuple(levels.tolist()),
        )


def draw_modes(drawn: DrawnModes) -> Figure:
    """The figure: frequency above, damping below, the modal amplitude on a logarithmic axis; below errors.

    Of a mode alone diamonds are where forces of a level are in resonance.
    """
    modes = drawn.modes
    told = any((mode.error > 0.0).any() for mode in modes)
    with house_style():
        figure = new_figure(LAYOUT.width, (1.6 if told else 1.3) * LAYOUT.height)
        panels = figure.subplots(2 + told, 1, sharex=True, height_ratios=[1.0, 1.0, 0.5][: 2 + told])
        upper, lower = panels[:2]
        for mode, colour in zip(modes, sequence_colours(len(modes)), strict=True):
            upper.plot(*mode.smooth(mode.frequency), color=colour, linewidth=1.1)
            lower.plot(*mode.smooth(_PERCENT * mode.damping), color=colour, linewidth=1.1)
            if told:
                _draw_error(panels[2], mode, colour)
            _mark_greatest(lower, mode, colour, drawn.frequency_unit if len(modes) == 1 else "")
        upper.set_xscale("log")
        upper.set_ylabel(frequency_label(drawn.frequency_unit))
        lower.set_ylabel("Damping ratio (%)")
        panels[-1].set_xlabel("Modal amplitude (of a mode of mass 1)")
        lower.set_ylim(bottom=0.0)
        for axes in panels:
            axes.margins(x=0.0)
        lower.set_ylim(top=1.12 * lower.get_ylim()[1])
        if len(modes) == 1:
            _mark_levels(upper, lower, modes[0], drawn.levels)
        name_at_side(figure, upper.get_lines(), [one.parameters for one in modes], drawn.units)
    return figure


def _draw_error(axes: Axes, mode: DrawnMode, colour: str) -> None:
    """Dots where the error is known, joined where it is at neighbouring points."""
    error = np.where(mode.error > 0.0, mode.error, np.nan)
    axes.plot(mode.amplitude, error, color=colour, linewidth=1.1, marker=".", markersize=4.0)
    axes.set_yscale("log")
    axes.set_ylim(RANGE[0], max(RANGE[1], float(np.nanmax(error, initial=0.0))))
    axes.set_ylabel("Relative error")


def _mark_levels(upper: Axes, lower: Axes, mode: DrawnMode, levels: Sequence[float]) -> None:
    """A diamond where the forces times each level are in resonance: at omega sqrt(1 - 2 D^2), which is below
    the frequency of the mode."""
    resonance = mode.frequency * np.sqrt(np.maximum(1.0 - 2.0 * mode.damping**2, 0.0))
    for level in levels:
        for amplitude, frequency in mode.at_level(level, resonance):
            upper.plot([amplitude], [frequency], "D", color="black", markersize=4.0)
            upper.annotate(
                f"resonance, forces × {level:g}",
                (amplitude, frequency),
                xytext=(6, 4),
                textcoords="offset points",
                fontsize=LAYOUT.small_text,
            )
        for amplitude, damping in mode.at_level(level, _PERCENT * mode.damping):
            lower.plot([amplitude], [damping], "D", color="black", markersize=4.0)


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
