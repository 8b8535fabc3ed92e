"""Floquet multipliers along a curve: the greatest against the frequency, and all in the complex plane."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fcm.plot.style import house_style, new_figure, sequence_colours

if TYPE_CHECKING:
    from matplotlib.figure import Figure

WIDTH, HEIGHT = 6.2, 2.9  # [inch]


@dataclass(frozen=True)
class Way:
    """The multipliers of a motion at one frequency after the other."""

    name: str
    frequency: list[float]  # (point,) [rad/s]
    real: list[list[float]]  # (point, multiplier)
    imaginary: list[list[float]]


def draw_multipliers(ways: Sequence[Way]) -> Figure:
    """The greatest of each way on the left; all of the last way on the right, beside the unit circle.

    >>> way = Way("exact", [1.0, 1.1], [[-0.9, 0.2], [-1.1, 0.2]], [[0.0, 0.0], [0.0, 0.0]])
    >>> [axes.get_xlabel() for axes in draw_multipliers([way]).axes]
    ['frequency [rad/s]', 'real part']
    """
    with house_style():
        figure = new_figure(WIDTH, HEIGHT)
        left, right = figure.subplots(1, 2)
        for way, colour in zip(ways, reversed(sequence_colours(len(ways))), strict=True):
            greatest = np.hypot(way.real, way.imaginary).max(axis=1)
            left.plot(way.frequency, greatest, color=colour, linewidth=0.9, label=way.name)
        left.axhline(1.0, color="0.5", linewidth=0.6, linestyle="--")
        left.set_xlabel("frequency [rad/s]")
        left.set_ylabel("greatest multiplier")
        figure.legend(loc="outside upper left", ncols=len(ways))
        angle = np.linspace(0.0, 2.0 * np.pi, 361)
        right.plot(np.cos(angle), np.sin(angle), color="0.5", linewidth=0.6, linestyle="--")
        last = ways[-1]
        right.plot(last.real, last.imaginary, ".", color="black", markersize=2.0)
        right.set_aspect("equal")
        right.set_xlabel("real part")
        right.set_ylabel("imaginary part")
        return figure
