"""Nonlinear modes: frequency, damping ratio and error against the modal amplitude."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from fcm.frozen import Frozen
from fcm.plot.curve_names import name_at_side, write_beside
from fcm.plot.dof import asked_for
from fcm.plot.error_panel import RANGE, draw_greatest, greatest_between, together
from fcm.plot.errors import PlotError
from fcm.plot.labels import frequency_label
from fcm.plot.measured import (
    BACKBONE,
    FittedNumber,
    MeasuredBackbone,
    backbones_of,
    draw_backbones,
    fitted_of,
    name_measured,
)
from fcm.plot.options import READ
from fcm.plot.read import BoolArray, FloatArray, floats, opened, swept_units, swept_values
from fcm.plot.reader_process import apart
from fcm.plot.style import DOTS, LAYOUT, house_style, new_figure, sequence_colours, split
from fcm.plot.summary import summary_of
from fcm.plot.unfinished import NO_SPAN, Unfinished, mark_unfinished, say_unfinished, unfinished_of
from fcm.rotational_dofs import dof_unit, greatest_first

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from matplotlib.lines import Line2D

_NEEDED = ("frequency", "modal_amplitude", "damping_ratio")
_ERROR, _STEADY = "truncation_error", "steady_state"
_LOST = "no steady state"  # what is dotted
_PERCENT = 100.0
ESTIMATE = (
    "resonance with the scene's forces, an estimate as if the mode alone answered:\n"
    "damping puts it below the frequency of the mode"
)
_GREATEST = "greatest damping"
_DIAMOND: dict[str, Any] = {"marker": "D", "color": "black", "markersize": 4.0}
_RING: dict[str, Any] = {"marker": "o", "markersize": 6, "markerfacecolor": "none", "markeredgewidth": 1.0}
_DOT: dict[str, Any] = {"marker": ".", "markersize": 4.0}
_NOTHING: FloatArray = np.zeros(0)


class DrawnMode(Frozen):
    """One curve of a nonlinear mode, without its padding."""

    parameters: dict[str, float]
    frequency: FloatArray  # (point,) in the file's unit
    amplitude: FloatArray  # (point,) modal
    damping: FloatArray  # (point,) ratio
    error: FloatArray = field(
        default_factory=lambda: _NOTHING
    )  # (point,) relative, NaN where unknown; or (0,)
    resonances: tuple[tuple[float, float, float], ...] = ()  # level of the forces, amplitude, frequency
    steady: BoolArray | None = None  # (point,) where there is a steady state; None: everywhere
    # of degrees of freedom at a modal amplitude of 1, by the mode at the least amplitude, if the file says it
    displacement: Mapping[str, float] = field(default_factory=dict)

    def smooth(self, values: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Amplitudes and a line (PCHIP) through the values, which does not overshoot between two points.

        If the amplitude turns back anywhere, the points are returned as they are.
        """
        known = np.isfinite(values)
        amplitude, values = self.amplitude[known], values[known]
        if not self._is_smooth(known):
            return amplitude, values
        from scipy.interpolate import PchipInterpolator

        way = np.log(amplitude)
        fine = np.interp(_places(way.size), np.arange(way.size), way)
        return np.exp(fine), PchipInterpolator(way, values)(fine)

    def lost(self, values: FloatArray) -> BoolArray:
        """Mask of the places of `smooth` without a steady state at either of the neighbouring points."""
        known = np.isfinite(values)
        lost = np.zeros(known.sum(), np.bool_) if self.steady is None else ~self.steady[known]
        if not self._is_smooth(known):
            return lost
        at = _places(lost.size)
        return lost[np.floor(at).astype(np.intp)] | lost[np.ceil(at).astype(np.intp)]

    def _is_smooth(self, known: BoolArray) -> bool:
        amplitude = self.amplitude[known]
        return amplitude.size > 2 and bool((np.diff(amplitude) > 0.0).all())


def _places(count: int) -> FloatArray:
    """Places on a line through points, as fractional point numbers."""
    return np.arange((count - 1) * LAYOUT.line_places + 1) / LAYOUT.line_places


class DrawnModes(Frozen):
    title: str
    frequency_unit: str
    modes: tuple[DrawnMode, ...]
    units: Mapping[str, str] = field(default_factory=dict)  # of swept keys, if the file says them
    measured: tuple[MeasuredBackbone, ...] = ()  # that numbers were fitted to
    unfinished: Unfinished = field(
        default_factory=Unfinished
    )  # of all curves, those without a point among them
    fitted: tuple[FittedNumber, ...] = ()  # that a fit found
    length: str = ""  # unit of displacements, if the file says it


@apart
def read_modes(path: Path) -> DrawnModes:
    """Read what ``fcm respond --mode -o`` has written; PlotError if the file is something else."""
    what = "a file of nonlinear modes (fcm respond --mode)"
    with opened(path, what, _NEEDED, (_ERROR, _STEADY, "complete", *BACKBONE)) as data:
        frequency, amplitude, damping = (floats(data.variables[name]) for name in _NEEDED)
        told = _ERROR in data.variables
        error = floats(data.variables[_ERROR]) if told else np.full(frequency.shape, np.nan)
        held = floats(data.variables[_STEADY]) if _STEADY in data.variables else np.ones(frequency.shape)
        swept, resonances = swept_values(data.variables), resonances_of(data)
        displacements = _displacements(data)
        found = [
            DrawnMode(
                {key: float(values[i]) for key, values in swept.items()},
                frequency[i][known],
                amplitude[i][known],
                damping[i][known],
                error[i][known],
                tuple(one[:3] for one in resonances[i]) if i < len(resonances) else (),
                held[i][known] != 0.0,
                displacements[i] if i < len(displacements) else {},
            )
            for i, one in enumerate(frequency)
            if (known := np.isfinite(one)).any()
        ]
        if not found:
            raise PlotError(f"{path}: the file holds no point of any mode")
        unit = str(getattr(data, "frequency_unit", "rad/s"))
        return DrawnModes(
            str(getattr(data, "title", "")),
            unit,
            tuple(found),
            swept_units(data.variables, swept),
            backbones_of(data.variables),
            replace(unfinished_of(data), span=NO_SPAN),  # the range is of frequencies
            fitted_of(data),
            str(summary_of(data).get("units", {}).get("length", "")),
        )


def _displacements(data: Any) -> list[dict[str, float]]:
    """Displacements of degrees of freedom at a modal amplitude of 1, for each curve, from the file's summary.

    Only the degrees of freedom that the scene asks for, if it asks for any.
    """
    found = []
    for curve in summary_of(data).get("curves", ()):
        moved = {str(dof): _number(x) for dof, x in curve.get("mode", {}).get("displacement", {}).items()}
        asked = asked_for(getattr(data, "output", ""), list(moved))
        found.append({dof: moved[dof] for dof in asked or moved})
    return found


class DrawnResonance(NamedTuple):
    """Resonance of a mode with the scene's forces, in the units of the file."""

    level: float  # of the forces
    modal: float  # amplitude
    frequency: float
    damping: float  # ratio
    amplitude: dict[str, float]  # of each degree of freedom


def resonances_of(data: Any) -> list[tuple[DrawnResonance, ...]]:
    """Resonances of each curve, from the file's summary."""
    try:
        curves = summary_of(data).get("curves", ())
        return [
            tuple(
                DrawnResonance(
                    _number(one["level"]),
                    _number(one["modal_amplitude"]),
                    _number(one["frequency"]),
                    _number(one.get("damping")),
                    {str(dof): _number(value) for dof, value in one.get("amplitude", {}).items()},
                )
                for one in curve.get("mode", {}).get("resonances", ())
            )
            for curve in curves
        ]
    except (AttributeError, LookupError, TypeError) as error:
        raise ValueError("its attribute summary is not of nonlinear modes") from error


def _number(value: object) -> float:
    """The number, NaN for None: a mode with too much damping has no resonance frequency."""
    return np.nan if value is None else float(value)  # type: ignore[arg-type]


def draw_modes(drawn: DrawnModes) -> Figure:
    """The figure: frequency, damping and errors in panels, over the modal amplitude on a logarithmic axis.

    For a single mode, diamonds mark the resonances with forces of given levels.
    """
    modes = drawn.modes
    told = any(_is_line(mode.error) for mode in modes)
    with house_style():
        lines: list[Line2D] = []
        figure = new_figure(LAYOUT.width, (1.8 if told else 1.5) * LAYOUT.height)
        panels = figure.subplots(2 + told, 1, sharex=True, height_ratios=[1.0, 1.0, 0.5][: 2 + told])
        upper, lower = panels[:2]
        for mode, colour in zip(modes, sequence_colours(len(modes)), strict=True):
            lines.append(_draw_line(upper, mode, mode.frequency, colour))
            _draw_line(lower, mode, _PERCENT * mode.damping, colour)
            if told and not together(len(modes)):
                _draw_error(panels[2], mode, colour)
            _mark_greatest(lower, mode, colour, drawn.frequency_unit if len(modes) == 1 else "")
        if told:
            if together(len(modes)):
                _draw_greatest_error(panels[2], modes)
            _finish_errors(panels[2], modes)
        upper.set_xscale("log")
        upper.set_ylabel(frequency_label(drawn.frequency_unit))
        lower.set_ylabel("Damping ratio (%)")
        panels[-1].set_xlabel(_amplitude_label(drawn), parse_math=False)
        lower.set_ylim(bottom=0.0)
        for axes in panels:
            axes.margins(x=0.0)
        draw_backbones(upper, lower, drawn.measured)
        lower.set_ylim(top=1.12 * lower.get_ylim()[1])
        say_unfinished(upper, drawn.unfinished)
        if not told:
            _say_errors(lower, modes)
        if len(modes) == 1:
            for axes, values in ((upper, modes[0].frequency), (lower, _PERCENT * modes[0].damping)):
                mark_unfinished(axes, [(modes[0].amplitude, values)], drawn.unfinished)
        _name_lost(upper, modes)
        beside = name_at_side(figure, lines, [one.parameters for one in modes], drawn.units)
        if drawn.measured:
            name_measured(figure, drawn.fitted, beside=beside)
        notes = _notes(panels, modes)
        if notes:
            figure.legend(notes.values(), notes.keys(), loc="outside lower center")
        if len(modes) == 1:
            _mark_resonances(figure, upper, lower, modes[0])
    return figure


def _amplitude_label(drawn: DrawnModes) -> str:
    """Label of the modal amplitude; for a single mode with the displacement that 1 means, if known."""
    said = "Modal amplitude, of the mode of mass 1"
    if len(drawn.modes) != 1 or not (found := drawn.modes[0].displacement):
        return said
    dofs = list(found)
    dof = dofs[greatest_first(dofs, list(found.values()))[0]]
    size = f"{found[dof]:.3g} {dof_unit(dof, drawn.length)}".rstrip()
    return f"{said}\n(1 means {size} of {dof}, at the least amplitude)"


def _notes(panels: Sequence[Axes], modes: Sequence[DrawnMode]) -> dict[str, Line2D]:
    """Legend handles of the marks, by their names."""
    from matplotlib.lines import Line2D

    notes = {}
    if len(modes) == 1 and any(np.isfinite(one[2]) for one in modes[0].resonances):
        notes[ESTIMATE] = Line2D([], [], linestyle="none", **_DIAMOND)
    if any(line.get_marker() == "o" for line in panels[1].get_lines()):
        notes[_GREATEST] = Line2D([], [], linestyle="none", color="black", **_RING)
    if len(panels) > 2:
        one = " (greatest)" * together(len(modes))
        mark = {} if one else _DOT
        notes[f"below: error by harmonics left out{one}"] = Line2D(
            [], [], color="black", linewidth=1.1, **mark
        )
    return notes


def _draw_line(axes: Axes, mode: DrawnMode, values: FloatArray, colour: str) -> Line2D:
    """Draw a line against the amplitude, dotted without a steady state; return the solid part."""
    amplitude, line = mode.smooth(values)
    lost = mode.lost(values)
    held, creeping = split(line, lost)
    (solid,) = axes.plot(amplitude, held, color=colour, linewidth=1.1)
    if lost.any():
        axes.plot(amplitude, creeping, color=colour, linewidth=1.1, linestyle=DOTS)
    return solid


def _name_lost(axes: Axes, modes: Sequence[DrawnMode]) -> None:
    """Say what is dotted, if anything is."""
    if any(mode.steady is not None and not mode.steady.all() for mode in modes):
        from matplotlib.lines import Line2D

        dots = Line2D([], [], color="black", linewidth=1.1, linestyle=DOTS)
        axes.legend([dots], [_LOST], loc="best")


def _is_line(error: FloatArray) -> bool:
    """Whether errors are known at neighbouring points; with many contacts one or two points have them."""
    known = error > LAYOUT.linear_error
    return bool((known[1:] & known[:-1]).any())


def _say_errors(axes: Axes, modes: Sequence[DrawnMode]) -> None:
    """Title the axes with the greatest error if too few are known for a panel, or where it is unknown.

    Where the motion is linear there is no error to estimate, only rounding.
    """
    every = np.concatenate([mode.error for mode in modes])
    known = every[every > LAYOUT.linear_error]
    if known.size:
        points = f"{known.size} point{'s' * (known.size > 1)}"
        most = f"{'at most ' * (known.size > 1)}{float(known.max()):.2g}"
        said = f"unknown but at {points}, {most}" if np.isnan(every).any() else f"{most}, at {points}"
    elif np.isfinite(every).any() and np.isnan(every).any():
        ends = [float(np.nanmax(np.where(np.isnan(mode.error), 0.0, mode.amplitude))) for mode in modes]
        said = f"unknown beyond {min(ends):.2g}, up to where the motion is linear"
    else:
        return
    axes.set_title(f"error by the harmonics left out: {said}", loc="right", fontsize=LAYOUT.small_text)


def _draw_error(axes: Axes, mode: DrawnMode, colour: str) -> None:
    """Dots where the error is known, joined where it is at neighbouring points."""
    error = np.where(mode.error > 0.0, mode.error, np.nan)
    axes.plot(mode.amplitude, error, color=colour, linewidth=1.1, **_DOT)


def _draw_greatest_error(axes: Axes, modes: Sequence[DrawnMode]) -> None:
    """One line for the errors of many modes."""
    amplitudes = [mode.amplitude for mode in modes]
    every = np.concatenate(amplitudes)
    edges = np.geomspace(every.min(), every.max(), LAYOUT.error_bins + 1)
    draw_greatest(axes, edges, greatest_between(edges, amplitudes, [mode.error for mode in modes]))


def _finish_errors(axes: Axes, modes: Sequence[DrawnMode]) -> None:
    axes.set_yscale("log")
    axes.set_ylim(RANGE[0], max([RANGE[1], *(float(np.nanmax(mode.error, initial=0.0)) for mode in modes)]))
    axes.set_ylabel("Relative error")


def _mark_resonances(figure: Figure, upper: Axes, lower: Axes, mode: DrawnMode) -> None:
    """A diamond at each resonance of the forces, below the frequency of the mode, and on its damping."""
    along, frequency = mode.smooth(mode.frequency)
    _, damping = mode.smooth(_PERCENT * mode.damping)
    names = []
    for level, amplitude, resonance in mode.resonances:
        if not np.isfinite(resonance):
            continue
        upper.plot([amplitude], [resonance], **_DIAMOND)
        names.append((f"resonance, forces × {level:g}", (amplitude, resonance)))
        k = int(np.argmin(np.abs(np.log(along / amplitude)) + np.abs(frequency / resonance - 1.0)))
        lower.plot([along[k]], [damping[k]], **_DIAMOND)
    write_beside(figure, upper, [(along, frequency)], names)


def _inwards(mode: DrawnMode, amplitude: float) -> int:
    """Side of an amplitude with more room on a logarithmic axis: -1 is the left."""
    return -1 if amplitude**2 > mode.amplitude[0] * mode.amplitude[-1] else 1


def _mark_greatest(axes: Axes, mode: DrawnMode, colour: str, unit: str) -> None:
    """A ring where the mode is damped most, with the values beside it where there is one mode."""
    top = int(mode.damping.argmax())
    if mode.damping[top] <= READ.higher_fraction * max(
        mode.damping[0], mode.damping[-1]
    ):  # at an end, or by rounding
        return
    x, y = float(mode.amplitude[top]), float(_PERCENT * mode.damping[top])
    axes.plot([x], [y], color=colour, **_RING)
    if unit:
        text = f"{y:.3g} % at {mode.frequency[top]:.4g} {unit}"
        inwards = _inwards(mode, x)
        axes.annotate(
            text, (x, y), xytext=(8 * inwards, 4), textcoords="offset points", fontsize=8,
            ha="right" if inwards < 0 else "left",
        )  # fmt: skip
