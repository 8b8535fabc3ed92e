"""Plot the error against the processor time: a line for each method, a mark for each longest step."""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from fcm.frozen import Frozen
from fcm.plot.errors import PlotError
from fcm.plot.options import READ
from fcm.plot.read import opened, read
from fcm.plot.reader_process import apart
from fcm.plot.style import LAYOUT, house_style, new_figure, plain_ticks

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

COLUMN, HEIGHT = 3.35, 5.0  # [inch]: 85 mm, the column of a journal
STYLES = {  # of each method: marker and colour (Okabe and Ito's, safe for the colour-blind)
    "exact": ("D", "#000000"),
    "closed form": ("^", "#009e73"),
    "default table": ("o", "#0072b2"),
    "fast table": ("s", "#d55e00"),
}
OTHER = ("P", "#cc79a7")  # a table of the user's own
TITLES = {
    "exact": "against the exact periodic motion",
    "closed form": "against single-harmonic balance itself",
}
QUANTITIES = {
    "curve": "Error of the curve (–)",
    "points": "Error of the points (–)",
    "peak": "Error of the peaks (–)",
    "peak_frequency": "Error of the peaks' frequencies (–)",
    "fold": "Error of the folds' frequencies (–)",
}


class DrawnRun(NamedTuple):
    """One run: processor time [s], error, whether this is only a limit, whether its curves are complete."""

    seconds: float
    error: float
    below: bool
    complete: bool


class AccuracyPanel(Frozen):
    """Runs compared with one reference: the marks of each method, from long steps to short ones."""

    reference: str
    own_error: float | None
    max_step: float  # of the reference
    lines: Mapping[tuple[str, bool], list[DrawnRun]]  # keys: method, and whether its points are corrected


class Accuracy(Frozen):
    """Contents of a picture of accuracy over cost."""

    title: str
    quantity: str
    panels: tuple[AccuracyPanel, ...]


@apart
def read_accuracy(path: Path, quantity: str = "curve") -> Accuracy:
    """Read what ``fcm respond --compare -o`` has written; PlotError if the file is something else."""
    with opened(path, "a comparison", ()) as file:
        layout, text = getattr(file, "layout", ""), getattr(file, "summary", "{}")
    if not str(layout).startswith("fcm comparison"):
        raise PlotError(f"{path}: not a comparison; `fcm respond SCENE --compare -o FILE.nc` writes one")
    unsound = (LookupError, TypeError, AttributeError, ValueError)  # of a text that may hold anything
    with read(path, "not a sound comparison", unsound):
        summary = json.loads(text)
        panels = [_panel(summary, name, quantity) for name in ("exact", "closed form")]
        title = str(summary["title"])
    known = tuple(panel for panel in panels if panel.lines)
    if not known:
        raise PlotError(f"{path}: it has no error of that kind: {quantity}")
    return Accuracy(title, quantity, known)


def _panel(summary: Any, reference: str, quantity: str) -> AccuracyPanel:
    lines: dict[tuple[str, bool], list[DrawnRun]] = {}
    for run in sorted(summary["runs"], key=lambda run: -run["max_step"]):
        if run["corrected"] and not run["left_out"]:
            continue  # the same line once more
        if reference == "closed form" and run["method"] == "exact":
            continue  # its difference from harmonic balance is not its error
        if reference == "exact" and not run["corrected"]:
            continue  # there the error of the single harmonic hides that of the table
        shown = run["against"][reference]
        error, below = shown["errors"][quantity], shown["below"].get(quantity)
        if error or below:
            seconds, complete = _number(run["processor_seconds"]), bool(run["complete"])
            mark = DrawnRun(seconds, _number(error or below), error is None, complete)
            lines.setdefault((run["method"], bool(run["corrected"])), []).append(mark)
    one = summary["references"][reference]
    own = one["own_error"][quantity]
    return AccuracyPanel(reference, None if own is None else _number(own), _number(one["max_step"]), lines)


def _number(value: Any) -> float:
    """A time, an error or a step read from a file, checked to be a plausible number."""
    number = float(value)
    if not 0.0 <= number <= READ.max_number:
        raise ValueError(f"it holds {number:g} in the place of a time, an error or a step")
    return number


def draw_accuracy(accuracy: Accuracy) -> Figure:
    """Draw a panel for each reference; a dotted line marks the reference's own error."""
    with house_style():
        figure = new_figure(COLUMN, HEIGHT if len(accuracy.panels) > 1 else 0.62 * HEIGHT)
        all_axes = figure.subplots(len(accuracy.panels), 1, sharex=True, squeeze=False)[:, 0]
        for axes, panel in zip(all_axes, accuracy.panels, strict=True):
            _draw_panel(axes, panel)
            axes.set_ylabel(QUANTITIES[accuracy.quantity])
        all_axes[-1].set_xlabel("Processor time to solve (s)")
        handles: dict[str, Any] = {}
        for axes in all_axes:
            handles |= dict(zip(*reversed(axes.get_legend_handles_labels()), strict=True))
        figure.legend(handles.values(), handles.keys(), loc="outside lower center", ncols=2)
        figure.suptitle(accuracy.title, fontsize=8, parse_math=False, wrap=True)
    return figure


def _draw_panel(axes: Axes, panel: AccuracyPanel) -> None:
    for (method, corrected), marks in panel.lines.items():
        marker, colour = STYLES.get(method, OTHER)
        label = method if corrected else f"{method}, as it is"
        x, y = [mark.seconds for mark in marks], [mark.error for mark in marks]
        label += "" if all(mark.complete for mark in marks) else ", not complete"
        fill = colour if corrected else "white"
        style = "-" if corrected else "--"
        axes.plot(
            x, y, style, color=colour, marker=marker, markersize=4.5, markerfacecolor=fill,
            linewidth=1.0, label=label,
        )  # fmt: skip
        for mark in (mark for mark in marks if mark.below):
            axes.annotate(
                "", (mark.seconds, mark.error), (0, -14), textcoords="offset points",
                arrowprops={"arrowstyle": "<-", "color": colour, "linewidth": 0.8},
            )  # fmt: skip
    axes.set(xscale="log", yscale="log")
    axes.set_title(TITLES[panel.reference], fontsize=8)
    if panel.own_error:
        axes.axhline(panel.own_error, color="0.35", linestyle=":", linewidth=1.0)
        axes.annotate(
            f"error of the reference, {_power(panel.own_error)}", (0.98, panel.own_error), (0, -2),
            xycoords=("axes fraction", "data"), textcoords="offset points",
            ha="right", va="top", fontsize=7, color="0.35",
        )  # fmt: skip
        room = (axes.get_ylim()[1] / panel.own_error) ** LAYOUT.below_reference
        axes.set_ylim(bottom=panel.own_error / max(room, 2.0))  # the text stands below, the arrows above
    plain_ticks(axes.xaxis, 300.0)


def _power(value: float) -> str:
    mantissa, exponent = f"{value:.0e}".split("e")
    return rf"${mantissa} \times 10^{{{int(exponent)}}}$"
