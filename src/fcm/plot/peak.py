"""Peak amplitude and peak frequency against what was swept: of the preload, the curve to design by."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from fcm.plot.dof import asked_for, leading_column
from fcm.plot.errors import PlotError
from fcm.plot.labels import curve_label, frequency_label, staying, symbols, with_unit
from fcm.plot.read import BoolArray, FloatArray, floats, opened, swept_units, swept_values
from fcm.plot.reader_process import apart
from fcm.plot.style import LAYOUT, house_style, logarithmic_axis, new_figure, sequence_colours, swept_axis
from fcm.rotational_dofs import unit_of

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

IntArray = npt.NDArray[np.intp]

_NEEDED = ("dof", "peak_amplitude", "peak_frequency", "complete")
_MARK = "#c03020"
_WHOLE = ("cyclic.engine_order",)  # whole numbers, between which there is nothing


@dataclass(frozen=True)
class Peaks:
    """The greatest amplitudes of the curves of a sweep; a curve that is not complete may have a greater."""

    dofs: tuple[str, ...]
    frequency_unit: str
    parameters: dict[str, FloatArray]  # (curve,) each
    amplitude: FloatArray  # (curve, dof)
    frequency: FloatArray  # (curve, dof) in the file's unit
    complete: BoolArray  # (curve,)
    length: str = ""  # unit of displacements, if the file says it
    stable: FloatArray | None = None  # (curve, dof) 1, 0 or NaN as of a point; None: the file does not say it
    units: Mapping[str, str] = field(default_factory=dict)  # of swept keys, if the file says them
    asked: tuple[str, ...] = ()  # degrees of freedom that the scene asks for, if it says so


@apart
def read_peaks(path: Path) -> Peaks:
    """Read the peaks of what ``fcm respond -o`` has written; PlotError if the file is something else."""
    with opened(path, "a response file", _NEEDED, ("peak_stable",)) as data:
        variables = data.variables
        if "damping_ratio" in variables:
            raise PlotError(f"{path}: it is of nonlinear modes, which have no peaks; try fcm plot mode")
        dofs = tuple(str(name) for name in np.atleast_1d(variables["dof"][:]))
        amplitude, frequency, complete = (floats(variables[name]) for name in _NEEDED[1:])
        swept = swept_values(variables)
        stable = floats(variables["peak_stable"]) if "peak_stable" in variables else None
        unit, length = getattr(data, "frequency_unit", "rad/s"), getattr(variables[_NEEDED[1]], "units", "")
        units, asked = swept_units(variables, swept), asked_for(getattr(data, "output", ""), dofs)
    return Peaks(
        dofs, str(unit), swept, amplitude, frequency, complete == 1, str(length), stable, units, asked
    )


def draw_peak(peaks: Peaks, dof: str | None = None, against: str | None = None) -> Figure:
    """The figure of one degree of freedom (by default see `leading_column`) against one swept quantity, by
    default the first."""
    column = leading_column(peaks.dofs, dof, peaks.amplitude[peaks.complete], peaks.asked)
    key = _key(peaks, against)
    known = np.isfinite(peaks.amplitude[:, column]) & peaks.complete
    if not known.any():
        raise PlotError("the file holds no complete curve")
    lines = _lines(peaks, key, known)
    with house_style():
        figure = new_figure(LAYOUT.width, 1.3 * LAYOUT.height)
        upper, lower = figure.subplots(2, 1, sharex=True, height_ratios=(3, 2))
        for axes, values in ((upper, peaks.amplitude), (lower, peaks.frequency)):
            _draw(axes, peaks.parameters[key], values[:, column], known, lines, key not in _WHOLE)
        _finish_axes(upper, lower, peaks, key, column, known)
        if len(lines) > 1:
            _name_lines(figure, upper, peaks, _others(peaks, key, known), lines)
        _mark_least(upper, lower, peaks, key, column, known)
        _mark_unstable((upper, lower), peaks, key, column, known)
    return figure


def _key(peaks: Peaks, against: str | None) -> str:
    if not peaks.parameters:
        raise PlotError(
            "nothing was swept: the file holds one curve, and one peak; give the scene a [sweep], or follow "
            "its peaks by fcm respond --track peaks --over KEY"
        )
    if against is not None and against not in peaks.parameters:
        raise PlotError(f"{against!r} was not swept; the file has {', '.join(peaks.parameters)}")
    return next(iter(peaks.parameters)) if against is None else against


def _lines(peaks: Peaks, key: str, known: BoolArray) -> list[IntArray]:
    """Curves with the same other swept values, each in the order of the key; none if there are too many."""
    x = peaks.parameters[key]
    others = [peaks.parameters[name] for name in _others(peaks, key, known)]
    groups: dict[tuple[float, ...], list[int]] = {}
    for i in np.flatnonzero(known).tolist():
        groups.setdefault(tuple(float(values[i]) for values in others), []).append(i)
    if len(groups) > LAYOUT.peak_lines:
        return []
    return [np.array(group)[np.argsort(x[group], kind="stable")] for group in groups.values()]


def _others(peaks: Peaks, key: str, known: BoolArray) -> list[str]:
    """The other swept keys, without those that rise or fall with this one, as paired ones do."""
    x = peaks.parameters[key][known]
    order = np.argsort(x, kind="stable")

    def in_step(values: FloatArray) -> bool:
        rises = np.sign(np.diff(values[known][order]))
        return bool(rises.size and np.diff(x[order]).all() and rises[0] and (rises == rises[0]).all())

    return [name for name, values in peaks.parameters.items() if name != key and not in_step(values)]


def _draw(
    axes: Axes, x: FloatArray, y: FloatArray, known: BoolArray, lines: Sequence[IntArray], joined: bool
) -> None:
    """Lines, or their points alone where nothing is between them; a cloud of points where there are none."""
    if not lines:
        axes.plot(x[known], y[known], "o", color="black", markersize=1.5, markeredgewidth=0.0)
        return
    for line, colour in zip(lines, sequence_colours(len(lines)), strict=True):
        if joined:
            mark = "o" if line.size <= LAYOUT.marked_points else ""
            axes.plot(x[line], y[line], color=colour, linewidth=1.1, marker=mark, markersize=2.5)
        else:
            axes.plot(x[line], y[line], "o", color=colour, markersize=4.0)


def _finish_axes(upper: Axes, lower: Axes, peaks: Peaks, key: str, column: int, known: BoolArray) -> None:
    from matplotlib.ticker import MaxNLocator, NullLocator

    (symbol,) = symbols([key])
    (in_unit,) = symbols([key], peaks.units)
    name = in_unit if symbol == key else f"{in_unit}  ({key})"
    x = peaks.parameters[key][known]
    lower.set_xlabel(name, parse_math=symbol != key)
    dof = peaks.dofs[column]
    upper.set_ylabel(with_unit(f"Peak amplitude of {dof}", unit_of(dof, peaks.length)), parse_math=False)
    lower.set_ylabel(frequency_label(peaks.frequency_unit).replace("Frequency", "Peak frequency"))
    swept_axis(lower, float(x.min()), float(x.max()))
    y = peaks.amplitude[known, column]
    if y.max() > 10.0 * y.min() > 0.0:
        logarithmic_axis(upper)
    else:
        upper.set_ylim(0.0, LAYOUT.headroom * float(y.max()) or 1.0)
    lower.minorticks_on()
    if key in _WHOLE:
        lower.xaxis.set_major_locator(MaxNLocator(integer=True))
        lower.xaxis.set_minor_locator(NullLocator())


def _name_lines(
    figure: Figure, axes: Axes, peaks: Peaks, others: Sequence[str], lines: Sequence[IntArray]
) -> None:
    values = [{name: float(peaks.parameters[name][line[0]]) for name in others} for line in lines]
    names = [curve_label(each, units=peaks.units) for each in values]
    figure.legend(axes.get_lines(), names, loc="outside right upper")


def ring_at(upper: Axes, lower: Axes, x: float, y: float, color: str) -> None:
    """A ring around a peak, and a thin line down to its frequency."""
    upper.plot([x], [y], "o", markersize=7, markerfacecolor="none", color=color, markeredgewidth=1.0)
    for axes in (upper, lower):
        axes.axvline(x, color=color, linewidth=0.5, linestyle=(0, (4, 3)), zorder=0)


def _mark_least(upper: Axes, lower: Axes, peaks: Peaks, key: str, column: int, known: BoolArray) -> None:
    """A ring around the least peak of all, a thin line down to its frequency, and its values above."""
    curves = np.flatnonzero(known)
    least = curves[np.argmin(peaks.amplitude[curves, column])]
    x, y = float(peaks.parameters[key][least]), float(peaks.amplitude[least, column])
    ring_at(upper, lower, x, y, _MARK)
    values = {name: float(values[least]) for name, values in peaks.parameters.items()}
    where = curve_label(values, units=peaks.units)
    stays = "" if peaks.stable is None or y == 0.0 else staying(float(peaks.stable[least, column]))
    least_peak = f"{y:.4g} {unit_of(peaks.dofs[column], peaks.length)}".rstrip()
    upper.set_title(f"least peak {least_peak}{stays} at {where}", loc="right", fontsize=8, color=_MARK)


def _mark_unstable(both: tuple[Axes, Axes], peaks: Peaks, key: str, column: int, known: BoolArray) -> None:
    """A cross on each peak at which no motion stays, and what it means."""
    if peaks.stable is None or not (at := known & (peaks.stable[:, column] == 0.0)).any():
        return
    for axes, values in zip(both, (peaks.amplitude, peaks.frequency), strict=True):
        axes.plot(peaks.parameters[key][at], values[at, column], "x", color=_MARK, markersize=4)
    both[1].set_title("\u00d7 the motion is not stable there", loc="left", fontsize=8, color=_MARK)
