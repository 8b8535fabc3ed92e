"""Peak amplitude and peak frequency against a swept quantity; against the preload, the design curve."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import field, replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from fcm.frozen import Frozen
from fcm.plot.blades import ALSO as OF_BLADES
from fcm.plot.blades import DrawnBlades, blades_of, draw_tuned_peaks, name_amplification
from fcm.plot.dof import asked_for, greatest_column, leading_column
from fcm.plot.draws import draw_scatter, say_scatter
from fcm.plot.errors import PlotError
from fcm.plot.labels import curve_label, frequency_label, staying, symbols, with_unit
from fcm.plot.mode import DrawnResonance, resonances_of
from fcm.plot.read import BoolArray, FloatArray, drawn_keys, floats, opened, swept_units, swept_values
from fcm.plot.reader_process import apart
from fcm.plot.style import LAYOUT, house_style, logarithmic_axis, new_figure, sequence_colours, swept_axis
from fcm.results.least_peak import least_peak
from fcm.rotational_dofs import dof_unit
from fcm.units import EXCITED

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

IntArray = npt.NDArray[np.intp]

_NEEDED = ("dof", "peak_amplitude", "peak_frequency", "complete")
_MARK = "#c03020"
# whole numbers, which no line joins
_WHOLE = ("cyclic.engine_order", "cyclic.mistuning.draw")


class Peaks(Frozen):
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
    drawn: tuple[str, ...] = ()  # swept keys whose values are random draws
    damping: FloatArray | None = None  # (curve,) ratio, of the resonances of nonlinear modes
    at_end: BoolArray | None = None  # (curve, dof) whether it is at an end of the range; None: none is
    error: FloatArray | None = None  # (curve, dof) estimated, relative; None: the file does not say it
    blades: DrawnBlades | None = None  # of a mistuned ring, whose worst sectors are the last columns

    @property
    def random(self) -> tuple[str, ...]:
        """Swept keys whose values are random draws."""
        return tuple(key for key in self.parameters if key in self.drawn)

    def column(self, dof: str | None) -> int:
        """The place of a degree of freedom; by default that of `leading_column`, or of the worst blade."""
        heights = self.amplitude[self.complete]
        if dof is not None or self.blades is None:
            return leading_column(self.dofs, dof, heights, self.asked)
        own = len(self.dofs) - len(self.blades.names)
        return own + greatest_column(self.blades.names, heights[:, own:], self.blades.asked(self.asked))

    def worst(self, column: int) -> int | None:
        """Index of a column among the blades' degrees of freedom; None if the column is of one sector."""
        return None if self.blades is None else self.blades.place(self.dofs, column)


@apart
def read_peaks(path: Path) -> Peaks:
    """Read the peaks of what ``fcm respond -o`` has written; PlotError if the file is something else."""
    with opened(
        path,
        "a response file",
        _NEEDED,
        ("peak_stable", "peak_error", "peak_at_end", "optimum_number", *OF_BLADES),
    ) as data:
        variables = data.variables
        dofs = tuple(str(name) for name in np.atleast_1d(variables["dof"][:]))
        unit, length = getattr(data, "frequency_unit", "rad/s"), getattr(variables[_NEEDED[1]], "units", "")
        swept, asked = swept_values(variables), asked_for(getattr(data, "output", ""), dofs)
        units, drawn = swept_units(variables, swept), drawn_keys(variables, swept)
        optima = variables["optimum_number"].shape if "optimum_number" in variables else (0, 0)
        if optima[0] == 1 < optima[1]:
            raise PlotError(
                f"{path}: an optimum of {optima[1]} numbers is one point, and what was tried is not in the "
                "file. Sweep them beside it by [sweep], and draw that"
            )
        if "damping_ratio" in variables:
            resonances = resonances_of(data)
            none = np.zeros((0, len(dofs)))
            whole = np.zeros(0, np.bool_)
            told = Peaks(dofs, str(unit), swept, none, none, whole, str(length), None, units, asked, drawn)
            return _of_modes(told, resonances, path)
        amplitude, frequency, complete = (floats(variables[name]) for name in _NEEDED[1:])
        stable = floats(variables["peak_stable"]) if "peak_stable" in variables else None
        error = floats(variables["peak_error"]) if "peak_error" in variables else None
        at_end = floats(variables["peak_at_end"]) == 1 if "peak_at_end" in variables else None
        blades = blades_of(variables)
    found = Peaks(
        dofs, str(unit), swept, amplitude, frequency, complete == 1, str(length), stable, units, asked, drawn,
        at_end=at_end, error=error,
    )  # fmt: skip
    return found if blades is None else _with_worst(found, blades)


def _with_worst(peaks: Peaks, blades: DrawnBlades) -> Peaks:
    """The peaks with those of the worst blade of each curve as further columns."""
    from fcm.model.ring import of_sector

    place = {dof: column for column, dof in enumerate(peaks.dofs)}
    columns = np.array(
        [
            [place[of_sector(name, int(k))] for name, k in zip(blades.names, row, strict=True)]
            for row in np.nan_to_num(blades.sector)
        ]
    )

    def more(values: FloatArray) -> FloatArray:
        return np.append(values, np.take_along_axis(values, columns, axis=1), axis=1)

    return replace(
        peaks, dofs=(*peaks.dofs, *blades.names), amplitude=more(peaks.amplitude), blades=blades,
        frequency=more(peaks.frequency), stable=None if peaks.stable is None else more(peaks.stable),
        at_end=None if peaks.at_end is None else more(peaks.at_end.astype(float)) == 1.0,
        error=None if peaks.error is None else more(peaks.error),
    )  # fmt: skip


def _of_modes(told: Peaks, found: Sequence[Sequence[DrawnResonance]], path: Path) -> Peaks:
    """The resonances of nonlinear modes with the scene's forces, as the peaks of a sweep.

    Of several resonances at a level, the one of the greatest modal amplitude counts. Several levels become a
    further swept quantity.
    """
    levels = sorted({one.level for each in found for one in each})
    if not levels:
        raise PlotError(f"{path}: it has no resonance of a nonlinear mode; try fcm plot mode")
    rows = [(i, level) for i in range(len(found)) for level in levels]
    best = [
        max((one for one in found[i] if one.level == level), key=lambda one: one.modal, default=None)
        for i, level in rows
    ]
    amplitude, frequency = (np.full((len(rows), len(told.dofs)), np.nan) for _ in range(2))
    damping = np.full(len(rows), np.nan)
    for row, one in enumerate(best):
        if one is not None:
            amplitude[row] = [one.amplitude.get(dof, np.nan) for dof in told.dofs]
            frequency[row], damping[row] = one.frequency, one.damping
    swept = {key: values[[i for i, _ in rows]] for key, values in told.parameters.items()}
    swept |= {EXCITED: np.array([level for _, level in rows])} if len(levels) > 1 else {}
    return replace(
        told, parameters=swept, amplitude=amplitude, frequency=frequency, damping=damping,
        complete=np.full(len(rows), True),
    )  # fmt: skip


def draw_peak(peaks: Peaks, dof: str | None = None, against: str | None = None) -> Figure:
    """The figure of one degree of freedom against one swept quantity.

    The default degree of freedom is that of `Peaks.column`, the default quantity the first.
    """
    column = peaks.column(dof)
    key = _key(peaks, against)
    known = np.isfinite(peaks.amplitude[:, column]) & peaks.complete
    if not known.any():
        raise PlotError("the file holds no complete curve")
    lines = _lines(peaks, key, known)
    with house_style():
        worst = peaks.worst(column)
        further = peaks.damping is not None or worst is not None
        figure = new_figure(LAYOUT.width, (1.6 if further else 1.3) * LAYOUT.height)
        shares = (3, 2, 2) if further else (3, 2)
        panels = figure.subplots(len(shares), 1, sharex=True, height_ratios=shares)
        upper, lower = panels[:2]
        joined = key not in _WHOLE and not peaks.random
        drawn = [(upper, peaks.amplitude[:, column]), (lower, peaks.frequency[:, column])]
        if peaks.damping is not None:
            drawn.append((panels[2], 100.0 * peaks.damping))
            panels[2].set_ylabel("Damping ratio (%)")
        elif worst is not None and peaks.blades is not None:
            drawn.append((panels[2], name_amplification(panels[2], peaks.blades, worst)))
        for axes, values in drawn:
            _draw(axes, peaks.parameters[key], values, known, lines, joined)
        _finish_axes(panels, peaks, key, column, known)
        if len(lines) > 1:
            _name_lines(figure, upper, peaks, _others(peaks, key, known), lines)
        if worst is not None and peaks.blades is not None:
            draw_tuned_peaks(figure, upper, peaks.blades, worst, peaks.parameters[key])
        if peaks.random:
            from fcm.results.spread import spreads_of  # and all that makes results

            found = spreads_of(peaks.parameters, peaks.random, [values for _, values in drawn], known)
            draw_scatter([axes for axes, _ in drawn], found, peaks, key)
            say_scatter(upper, found, peaks, key, column)
        else:
            _mark_least(panels, peaks, key, column, known)
        _mark_unstable((upper, lower), peaks, key, column, known)
        _mark_unknown((upper, lower), peaks, key, column, known)
        _mark_at_end((upper, lower), peaks, key, column, known)
        _say_left_out(lower, peaks)
    return figure


def _key(peaks: Peaks, against: str | None) -> str:
    if not peaks.parameters:
        raise PlotError(
            "nothing was swept: the file holds one curve, and one peak. Give the scene a [sweep], or follow "
            "its peaks by fcm respond --track peaks --over KEY"
        )
    if against is not None and against not in peaks.parameters:
        from fcm.scene.errors import choices, quoted

        raise PlotError(f"{quoted(against)} was not swept; the file has {choices(peaks.parameters)}")
    return next(iter(peaks.parameters)) if against is None else against


def _lines(peaks: Peaks, key: str, known: BoolArray) -> list[IntArray]:
    """Groups of curves with equal other swept values, each sorted by the key; none if there are too many."""
    x = peaks.parameters[key]
    others = [peaks.parameters[name] for name in _others(peaks, key, known)]
    groups: dict[tuple[float, ...], list[int]] = {}
    for i in np.flatnonzero(known).tolist():
        groups.setdefault(tuple(float(values[i]) for values in others), []).append(i)
    if len(groups) > LAYOUT.peak_lines:
        return []
    return [np.array(group)[np.argsort(x[group], kind="stable")] for group in groups.values()]


def _others(peaks: Peaks, key: str, known: BoolArray) -> list[str]:
    """The other swept keys that tell lines apart.

    Keys that rise or fall in step with this one, as paired ones do, are left out, and so are random draws,
    which no line joins.
    """
    x = peaks.parameters[key][known]
    order = np.argsort(x, kind="stable")

    def in_step(values: FloatArray) -> bool:
        rises = np.sign(np.diff(values[known][order]))
        return bool(rises.size and np.diff(x[order]).all() and rises[0] and (rises == rises[0]).all())

    given = {name: values for name, values in peaks.parameters.items() if name not in peaks.random}
    return [name for name, values in given.items() if name != key and not in_step(values)]


def _draw(
    axes: Axes, x: FloatArray, y: FloatArray, known: BoolArray, lines: Sequence[IntArray], joined: bool
) -> None:
    """Draw the lines, or only their points if not `joined`; without lines, a cloud of points."""
    if not lines:
        axes.plot(x[known], y[known], "o", color="black", markersize=1.5, markeredgewidth=0.0)
        return
    for line, colour in zip(lines, sequence_colours(len(lines)), strict=True):
        if joined:
            mark = "o" if line.size <= LAYOUT.marked_points else ""
            axes.plot(x[line], y[line], color=colour, linewidth=1.1, marker=mark, markersize=2.5)
        else:
            size = 4.0 if line.size <= LAYOUT.marked_points else 2.0
            axes.plot(x[line], y[line], "o", color=colour, markersize=size, markeredgewidth=0.0)


def _finish_axes(panels: Sequence[Axes], peaks: Peaks, key: str, column: int, known: BoolArray) -> None:
    from matplotlib.ticker import MaxNLocator, NullLocator

    (symbol,) = symbols([key])
    (in_unit,) = symbols([key], peaks.units)
    name = in_unit if symbol == key else f"{in_unit}  ({key})"
    x = peaks.parameters[key][known]
    (upper, lower), last = panels[:2], panels[-1]
    last.set_xlabel(name, parse_math=symbol != key)
    dof, what = peaks.dofs[column], "Peak" if peaks.damping is None else "Resonance"
    called = f"{what} amplitude of {dof}"
    if peaks.worst(column) is not None and peaks.blades is not None:
        called = f"Greatest peak of {dof} in {peaks.blades.sectors} sectors"
    called = with_unit(called, dof_unit(dof, peaks.length))
    upper.set_ylabel(called, parse_math=False)
    lower.set_ylabel(frequency_label(peaks.frequency_unit).replace("Frequency", f"{what} frequency"))
    if peaks.damping is not None:
        top = float(np.nanmax(100.0 * peaks.damping[known]))
        last.set_ylim(0.0, LAYOUT.headroom * top or 1.0)
    swept_axis(lower, float(x.min()), float(x.max()))
    y = peaks.amplitude[known, column]
    if y.max() > 10.0 * y.min() > 0.0:
        logarithmic_axis(upper)
    elif peaks.random and y.max() < LAYOUT.narrow_scatter * y.min():
        upper.margins(y=LAYOUT.scatter_room)  # from 0 on the scatter would be a flat line
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
    ring_over((upper, lower), x, y, color)


def ring_over(panels: Sequence[Axes], x: float, y: float, color: str) -> None:
    """A ring around a peak in the first of panels, and a thin line through all."""
    panels[0].plot([x], [y], "o", markersize=7, markerfacecolor="none", color=color, markeredgewidth=1.0)
    for axes in panels:
        axes.axvline(x, color=color, linewidth=0.5, linestyle=(0, (4, 3)), zorder=0)


def _mark_least(panels: Sequence[Axes], peaks: Peaks, key: str, column: int, known: BoolArray) -> None:
    """Mark the least peak of all with a ring, a thin line down to its frequency, and its values above.

    A greatest amplitude at an end of the range of frequencies is no peak. At an end of the sweep the least
    peak is no minimum: a lower one may lie beyond, or before the next value. Nothing is marked over the level
    of the forces, which nobody chooses.
    """
    if key == EXCITED:
        return
    at_end = np.zeros_like(known) if peaks.at_end is None else peaks.at_end[:, column]
    found = least_peak(peaks.amplitude[:, column], peaks.parameters[key], known, at_end)
    if found is None:
        return
    least = found.curve
    x, y = float(peaks.parameters[key][least]), float(peaks.amplitude[least, column])
    ring_over(panels, x, y, _MARK)
    values = {name: float(values[least]) for name, values in peaks.parameters.items()}
    where = curve_label(values, units=peaks.units)
    stays = "" if peaks.stable is None or y == 0.0 else staying(float(peaks.stable[least, column]))
    what = "peak" if peaks.damping is None else "resonance"
    height = f"{y:.4g} {dof_unit(peaks.dofs[column], peaks.length)}".rstrip()
    errs = "" if peaks.error is None or y == 0.0 else _erring(float(peaks.error[least, column]))
    said = f"least {what} {height} at {where}{stays}{errs}"
    if key not in _WHOLE and found.at_end_of_sweep:
        (symbol,) = symbols([key])
        said += f"\nan end of the sweep of {symbol}: less may be beyond, or before the next value"
    panels[0].set_title(said, loc="right", fontsize=8, color=_MARK)


def _erring(error: float) -> str:
    """Text beside a peak whose relative error is great, or unknown.

    >>> _erring(0.002), _erring(0.42), _erring(float("nan"))
    ('', ', error 42 %', ', error unknown')
    """
    if error != error:
        return ", error unknown"
    return f", error {100.0 * error:.0f} %" if error > LAYOUT.great_error else ""


def _say_left_out(axes: Axes, peaks: Peaks) -> None:
    """How many curves are not complete, or have no resonance, and are not drawn."""
    out, what = ~peaks.complete, "NOT COMPLETE"
    if peaks.damping is not None:
        out, what = np.isnan(peaks.damping), "no resonance within the amplitudes"
    if out.any():
        said = f"{what}: {int(out.sum())} of {out.size} curves, left out"
        axes.set_title(said, loc="right", fontsize=8, color=_MARK)


def _mark_unstable(both: tuple[Axes, Axes], peaks: Peaks, key: str, column: int, known: BoolArray) -> None:
    """Mark each unstable peak with a cross, and explain it."""
    if peaks.stable is None or not (at := known & (peaks.stable[:, column] == 0.0)).any():
        return
    for axes, values in zip(both, (peaks.amplitude, peaks.frequency), strict=True):
        axes.plot(peaks.parameters[key][at], values[at, column], "x", color=_MARK, markersize=4)
    _say_mark(both[1], "\u00d7 the motion is not stable there")


def _mark_unknown(both: tuple[Axes, Axes], peaks: Peaks, key: str, column: int, known: BoolArray) -> None:
    """Mark each peak of unknown stability with a square, and explain it."""
    if peaks.stable is None:
        return
    at = known & np.isnan(peaks.stable[:, column]) & (peaks.amplitude[:, column] > 0.0)
    if not at.any():
        return
    for axes, values in zip(both, (peaks.amplitude, peaks.frequency), strict=True):
        x, y = peaks.parameters[key][at], values[at, column]
        axes.plot(x, y, "s", markerfacecolor="none", markeredgewidth=0.7, color=_MARK, markersize=5)
    _say_mark(both[1], "\u25a1 whether the motion is stable there is unknown")


def _say_mark(axes: Axes, said: str) -> None:
    """Explains a mark, below other explanations."""
    lines = "\n".join(filter(None, (axes.get_title(loc="left"), said)))
    axes.set_title(lines, loc="left", fontsize=8, color=_MARK)


def _mark_at_end(both: tuple[Axes, Axes], peaks: Peaks, key: str, column: int, known: BoolArray) -> None:
    """Mark greatest amplitudes at an end of the range of frequencies with a triangle, and explain it."""
    if peaks.at_end is None or not (at := known & peaks.at_end[:, column]).any():
        return
    x = peaks.parameters[key][at]
    for axes, values in zip(both, (peaks.amplitude, peaks.frequency), strict=True):
        axes.plot(x, values[at, column], "^", markerfacecolor="white", color=_MARK, markersize=6)
    _say_mark(both[1], "\u25b3 no peak: it rises to an end of the range of frequencies; widen that")
