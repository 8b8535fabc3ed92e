"""Error against processor time of balances with more and more harmonics: one line a scene."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from fcm.plot.style import house_style, new_figure, plain_ticks

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

WIDTH, HEIGHT = 5.5, 4.6  # [inch]
EXACT_ERROR = 1e-6  # where the exact motion is drawn, as it is what errors are measured against
STYLES = (  # marker and colour of each scene (Okabe and Ito's, safe for the colour-blind)
    ("o", "#0072b2"),
    ("s", "#d55e00"),
    ("^", "#009e73"),
    ("D", "#cc79a7"),
    ("v", "#000000"),
)


@dataclass(frozen=True)
class Balanced:
    """One curve of a balance of the harmonics up to a number."""

    harmonics: int
    error: float  # greatest relative error of the peaks
    milliseconds: float  # of processor time, where np.sin takes 10 ns a value


@dataclass(frozen=True)
class Line:
    """What is shown of a scene."""

    name: str
    balanced: Sequence[Balanced]  # by their number of harmonics
    table: Balanced  # of one harmonic by the table, its points not corrected
    exact: float  # [ms] of the exact motion
    order: float | None  # p of error ~ H**-p; None where there is none


def draw_convergence(lines: Sequence[Line]) -> Figure:
    """One line for each scene, from one harmonic to many, and what the exact motion takes below.

    >>> rows = [Balanced(1, 1e-1, 10.0), Balanced(3, 1e-3, 20.0)]
    >>> line = Line("a scene", rows, table=Balanced(1, 1e-1, 9.0), exact=99.0, order=4.2)
    >>> [text.get_text() for text in draw_convergence([line]).legends[0].get_texts()][0]
    'a scene, $p$ = 4.2'
    """
    with house_style():
        figure = new_figure(WIDTH, HEIGHT)
        axes = figure.subplots()
        for line, (marker, colour) in zip(lines, STYLES[: len(lines)], strict=True):
            _draw_line(axes, line, marker, colour)
        slowest = max(range(len(lines)), key=lambda k: lines[k].balanced[-1].milliseconds)
        _number(
            axes, lines[slowest], STYLES[slowest][1]
        )  # of one line, at the edge: of all they would overlap
        _draw_keys(axes)
        axes.set(xscale="log", yscale="log")
        axes.set_xlabel("Processor time of a curve (ms), where np.sin takes 10 ns a value")
        axes.set_ylabel("Greatest relative error of the peaks (–)")
        axes.set_ylim(bottom=0.5 * EXACT_ERROR)
        axes.margins(x=0.08)  # for the number at the last point
        plain_ticks(axes.xaxis, 300.0)
        figure.legend(
            loc="outside lower center", ncols=2, alignment="left",
            title="Scenes, and the order $p$ of error ~ $H^{-p}$ from $H$ = 2 on; numbers at points: $H$",
        )  # fmt: skip
    return figure


def _draw_line(axes: Axes, line: Line, marker: str, colour: str) -> None:
    order = "" if line.order is None else f", $p$ = {line.order:.1f}"
    times, errors = [one.milliseconds for one in line.balanced], [one.error for one in line.balanced]
    axes.plot(
        times, errors, color=colour, marker=marker, markersize=4.0, linewidth=1.0, label=line.name + order
    )
    axes.plot(
        line.table.milliseconds, line.table.error, color=colour, marker=marker, markersize=6.5,
        markerfacecolor="none", markeredgewidth=0.8,
    )  # fmt: skip
    axes.plot(
        line.exact,
        EXACT_ERROR,
        color=colour,
        marker="|",
        markersize=11.0,
        markeredgewidth=1.6,
        clip_on=False,
    )


def _number(axes: Axes, line: Line, colour: str) -> None:
    """The harmonics at the points of a line, with a white edge over what they meet."""
    from matplotlib.patheffects import withStroke

    for one in line.balanced:
        axes.annotate(
            f"{one.harmonics}", (one.milliseconds, one.error), (5, 3), textcoords="offset points",
            fontsize=8, color=colour, zorder=5, path_effects=[withStroke(linewidth=2.0, foreground="white")],
        )  # fmt: skip


def _draw_keys(axes: Axes) -> None:
    """What the marks are, whatever their colour."""
    grey = "0.35"
    axes.plot(
        [],
        [],
        color=grey,
        marker="o",
        markersize=4.0,
        linewidth=1.0,
        label="exact forces, harmonics 1 to $H$",
    )
    axes.plot(
        [], [], color=grey, marker="o", markersize=6.5, markerfacecolor="none", linestyle="none",
        label="$H$ = 1 by the table alone",
    )  # fmt: skip
    axes.plot(
        [], [], color=grey, marker="|", markersize=11.0, markeredgewidth=1.6, linestyle="none",
        label="exact motion, the reference: its time alone",
    )  # fmt: skip
