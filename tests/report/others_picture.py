"""Error against processor time of several packages: one line for each and each number of harmonics."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from fcm.plot.style import house_style, new_figure

if TYPE_CHECKING:
    from matplotlib.figure import Figure

WIDTH, HEIGHT = 5.5, 4.2  # [inch]
LEAST_ERROR = 1e-12  # what is less is drawn here
COLOURS = ("#0072b2", "#d55e00", "#009e73", "#cc79a7")  # Okabe and Ito's, safe for the colour-blind
MARKERS = ("o", "^", "s", "D")  # by the number of harmonics


@dataclass(frozen=True)
class Points:
    """A line: a package with so many harmonics, by its samples."""

    package: str
    harmonics: int
    seconds: Sequence[float]
    median: Sequence[float]  # relative error of the peaks
    greatest: Sequence[float]


def draw_others(lines: Sequence[Points]) -> Figure:
    """Every package in a colour of its own, every number of harmonics with a marker of its own.

    >>> figure = draw_others([Points("fcm", 1, [0.1], [1e-9], [1e-8])])
    >>> [text.get_text() for text in figure.legends[0].get_texts()]
    ['fcm, 1 harmonic']
    """
    packages = list(dict.fromkeys(line.package for line in lines))
    counts = sorted({line.harmonics for line in lines})
    with house_style():
        figure = new_figure(WIDTH, HEIGHT)
        axes = figure.subplots()
        for line in lines:
            colour, marker = COLOURS[packages.index(line.package)], MARKERS[counts.index(line.harmonics)]
            middle = [max(error, LEAST_ERROR) for error in line.median]
            axes.vlines(
                line.seconds,
                middle,
                [max(e, LEAST_ERROR) for e in line.greatest],
                color=colour,
                linewidth=0.7,
            )
            axes.plot(
                line.seconds, middle, color=colour, marker=marker, markersize=4.5, linewidth=1.0,
                label=f"{line.package}, {line.harmonics} harmonic{'s' if line.harmonics > 1 else ''}",
            )  # fmt: skip
        axes.set(xscale="log", yscale="log")
        axes.set_xlabel("Processor time of eight curves (s)")
        axes.set_ylabel("Relative error of the peaks (–)")
        figure.legend(loc="outside lower center", ncols=3)
    return figure
