"""Displacement through the phases of a schedule: the motion itself, or the extent of each cycle."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from fcm.plot.errors import PlotError
from fcm.plot.history_file import DrawnHistory, DrawnMotion
from fcm.plot.labels import curve_label, frequency_label, plain, power_to_label, with_unit
from fcm.plot.read import FloatArray
from fcm.plot.style import LAYOUT, house_style, new_figure
from fcm.rotational_dofs import dof_unit

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

Window = tuple[float, float]

_HEIGHT, _PANEL = 2.5, 1.5  # [inch] of a single panel; of each further one
_BAND, _EDGE, _MEAN = "#a6c8e0", "#1f4e79", "#b34700"
_ROMAN = ("I", "II", "III", "IV", "V", "VI", "VII", "VIII", "IX", "X", "XI", "XII")


def draw_history(history: DrawnHistory, window: Window | None = None) -> Figure:
    """The figure of every motion, a panel each, within a window of the axis.

    Few cycles are drawn as motion; many are drawn as the extent and the mean of each.
    """
    motions = [motion for motion in history.motions if motion.least.size]
    if len(motions) > LAYOUT.history_panels:
        raise PlotError(f"the file has {len(motions)} curves; choose at most {LAYOUT.history_panels} of them")
    shown = _window(history, window)
    with house_style():
        figure = new_figure(LAYOUT.column, _HEIGHT + _PANEL * (len(motions) - 1))
        panels = figure.subplots(len(motions), sharex=True, squeeze=False)[:, 0]
        for axes, motion in zip(panels, motions, strict=True):
            _draw_motion(axes, motion, shown)
            _mark_phases(axes, history, shown)
            axes.use_sticky_edges = False
            axes.margins(y=0.05)
            axes.set_xlim(shown)
            axes.minorticks_on()
            name = plain(with_unit(f"Displacement {history.dof}", dof_unit(history.dof, history.length)))
            axes.set_ylabel(name)
        panels[-1].set_xlabel("Time (s)" if history.axis == "time" else "Cycles")
        _name_phases(panels[0], history, shown)
        if handles := max((axes.get_legend_handles_labels()[0] for axes in panels), key=len):
            figure.legend(handles=handles, loc="outside lower center", ncols=2)
        figure.draw_without_rendering()
        for axes, motion in zip(panels, motions, strict=True):
            power_to_label(axes.yaxis)
            named = curve_label(motion.parameters, units=history.units)
            axes.set_ylabel("\n".join(filter(None, (axes.get_ylabel(), *named.split(", ")))))
    return figure


def _window(history: DrawnHistory, window: Window | None) -> Window:
    """The part of the axis that is drawn: what was simulated, or less."""
    end = max(float(motion.edges[-1]) for motion in history.motions if motion.least.size)
    if window is None:
        return 0.0, end
    if not (window[0] < window[1] and window[0] < end and window[1] > 0.0):
        last = f"{end:g} {'s' if history.axis == 'time' else 'cycles'}"
        raise PlotError(
            f"the window {window[0]:g} to {window[1]:g} shows nothing; the motion is from 0 to {last}"
        )
    return max(window[0], 0.0), min(window[1], end)


def _draw_motion(axes: Axes, motion: DrawnMotion, shown: Window) -> None:
    inside = (motion.edges[1:] > shown[0]) & (motion.edges[:-1] < shown[1])
    if int(inside.sum()) <= LAYOUT.history_cycles:
        _draw_line(axes, motion, shown)
        return
    first, last = np.flatnonzero(inside)[[0, -1]]
    cycles = slice(first, last + 1)
    edges = motion.edges[first : last + 2]
    low, high, mean = motion.least[cycles], motion.greatest[cycles], motion.mean[cycles]
    axes.stairs(high, edges, baseline=low, fill=True, color=_BAND, label="extent of each cycle")
    for bound in (low, high):
        axes.stairs(bound, edges, baseline=None, color=_EDGE, linewidth=0.6)
    axes.stairs(mean, edges, baseline=None, color=_MEAN, linewidth=0.9, label="its mean")


def _draw_line(axes: Axes, motion: DrawnMotion, shown: Window) -> None:
    """The samples in the window and one beyond each end; no line where cycles were not sampled."""
    x, u = motion.position, motion.displacement
    first, last = np.searchsorted(x, shown[0], "right") - 1, np.searchsorted(x, shown[1], "left") + 1
    x, u = x[max(first, 0) : last], u[max(first, 0) : last]
    steps = np.diff(x)
    gaps = np.flatnonzero(steps > 4.0 * np.median(steps if steps.size else 0.0)) + 1
    axes.plot(np.insert(x, gaps, np.nan), np.insert(u, gaps, np.nan), color=_EDGE, linewidth=0.8)


def _mark_phases(axes: Axes, history: DrawnHistory, shown: Window) -> None:
    """A dashed line where a phase begins, unless they are too many to be told apart."""
    inside = [x for x in history.boundaries[1:-1] if shown[0] < x < shown[1]]
    if len(inside) <= LAYOUT.history_boundaries:
        for boundary in inside:
            axes.axvline(boundary, color="0.35", linewidth=0.6, linestyle=(0, (4, 3)))


def _name_phases(axes: Axes, history: DrawnHistory, shown: Window) -> None:
    """The number of each phase and its frequency above the panel, where there is room."""
    bounds = np.clip(history.boundaries, *shown)
    names = _alike(history.frequency)
    if len(names) <= len(_ROMAN):
        names = [f"{roman}\n{name}" for roman, name in zip(_ROMAN, names, strict=False)]
    room, taken = shown[1] - shown[0], -np.inf
    ticks: list[tuple[float, str]] = []
    for low, high, name in zip(bounds[:-1], bounds[1:], names, strict=True):
        centre, half = 0.5 * (low + high), 0.5 * LAYOUT.letter * room * max(map(len, name.splitlines()))
        if high > low and centre - half > taken:
            ticks.append((centre, name))
            taken = centre + half
    above = axes.secondary_xaxis("top")
    above.set_xticks(
        [centre for centre, _ in ticks], [name for _, name in ticks], fontsize=8, linespacing=0.9
    )
    above.tick_params(length=0.0, pad=1.0)
    above.minorticks_off()
    above.set_xlabel(frequency_label(history.unit), fontsize=8, labelpad=3.0)
    axes.tick_params(top=False, which="both")


def _alike(values: FloatArray) -> list[str]:
    """Numbers of up to six digits, all with the same number of decimals."""
    texts = [f"{value:.6g}" for value in values]
    if any("e" in text for text in texts):
        return texts
    decimals = max(len(text.partition(".")[2]) for text in texts)
    return [f"{value:.{decimals}f}" for value in values]
