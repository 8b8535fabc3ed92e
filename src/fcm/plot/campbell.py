"""Frequencies of a ring of sectors against the nodal diameter, and what an engine order meets (SAFE diagram).

At the rotor speed W an engine order n has the frequency n W, and as seen by the sectors a nodal diameter: the
lines of all engine orders run up and down between the diameters 0 and half of the sectors.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from fcm.plot.labels import frequency_label
from fcm.plot.style import HEIGHT, WIDTH, house_style, new_figure, sequence_colours

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

FloatArray = npt.NDArray[np.float64]

_BEYOND = 2.5  # times the range's end: so far up modes are shown
_ROOM = 1.08  # above the highest of them
_MOST_HARMONICS = 5  # of an engine order that are marked
_MOST_ORDERS = 6  # that have a line each


@dataclass(frozen=True)
class Ring:
    """What is drawn, in the scene's unit of frequency."""

    title: str
    sectors: int
    engine_orders: tuple[int, ...]
    span: tuple[float, float]  # range of the excitation
    unit: str
    diameters: tuple[int, ...]
    opened: tuple[FloatArray, ...]  # (mode,) for each diameter
    stuck: tuple[FloatArray, ...]


def draw_campbell(ring: Ring) -> Figure:
    """The figure: families of modes over the nodal diameters, and the lines of the engine orders."""
    from matplotlib.ticker import MaxNLocator

    top = _top(ring)
    with house_style():
        figure = new_figure(1.15 * WIDTH, 1.2 * HEIGHT)
        axes = figure.subplots()
        _orders(axes, ring, top)
        _families(axes, ring.diameters, ring.stuck, "stuck")
        _families(axes, ring.diameters, ring.opened, "open")
        half = ring.sectors // 2
        axes.set_xlim(-0.5, half + 0.5)
        axes.set_ylim(0.0, top)
        axes.xaxis.set_major_locator(MaxNLocator(integer=True))
        axes.set_xlabel("Nodal diameter")
        axes.set_ylabel(frequency_label(ring.unit))
        axes.set_title(f"{ring.sectors} sectors", loc="right", fontsize=8)
        figure.legend(loc="outside right upper")
    return figure


def _top(ring: Ring) -> float:
    """Where the frequency axis ends: above the modes that are of interest."""
    limit = _BEYOND * ring.span[1]
    every = np.concatenate((*ring.opened, *ring.stuck))
    return _ROOM * max(ring.span[1], float(every[every < limit].max(initial=0.0)))


def _families(axes: Axes, diameters: Sequence[int], frequencies: Sequence[FloatArray], state: str) -> None:
    """The lowest modes of all diameters joined, the second ones, ..."""
    x = np.array(diameters)
    most = max(len(one) for one in frequencies)
    for number in range(most):
        y = np.array([one[number] if number < len(one) else np.nan for one in frequencies])
        axes.plot(
            x, y, "o-", color="black" if state == "open" else "#0072b2", linewidth=0.5, markersize=3.5,
            markerfacecolor="white" if state == "open" else "#0072b2", markeredgewidth=0.8,
            label=f"contacts {state}" if number == 0 else None,
        )  # fmt: skip


def _orders(axes: Axes, ring: Ring, top: float) -> None:
    """For each engine order where its harmonics are, and the line of its highest speed; if alone, of both."""
    shown = ring.engine_orders[:_MOST_ORDERS]
    for order, colour in zip(shown, _colours(len(shown)), strict=True):
        if order:
            low, high = (abs(end / order) for end in ring.span)
            lines = ((low, (0, (1, 2))), (high, (0, (4, 2))))
            for speed, dashes in lines if len(shown) == 1 else lines[1:]:
                axes.plot(
                    *_zigzag(ring.sectors, speed, top), color=colour, linewidth=0.7, linestyle=dashes,
                    zorder=0, label=f"all orders at {_speed(speed, ring.unit)}",
                )  # fmt: skip
        for harmonic in range(1, _MOST_HARMONICS + 1):
            x, ends = folded(harmonic * order, ring.sectors), [harmonic * end for end in ring.span]
            if ends[0] < top:
                axes.plot(
                    [x, x], ends, color=colour, linewidth=5.0 if harmonic == 1 else 2.5, alpha=0.35, zorder=1,
                    solid_capstyle="butt", label=f"order {order}, its harmonics" if harmonic == 1 else None,
                )  # fmt: skip
                axes.annotate(
                    f"{harmonic}", (x, min(ends[1], 0.97 * top)), xytext=(4, -1), textcoords="offset points",
                    fontsize=7, color=colour, va="top",
                )  # fmt: skip


def _speed(speed: float, unit: str) -> str:
    """The speed of the rotor, by the unit of frequencies."""
    return f"{speed:.4g} {'rev/s' if unit == 'Hz' else unit}"


def _colours(count: int) -> list[str]:
    return ["#c03020"] if count == 1 else sequence_colours(count)


def _zigzag(sectors: int, speed: float, top: float) -> tuple[FloatArray, FloatArray]:
    """The line of all engine orders at a speed, up to a frequency."""
    turns = np.append(np.arange(0.0, 2.0 * top / speed / sectors) * sectors / 2.0, top / speed)
    return np.array([folded(turn, sectors) for turn in turns.tolist()]), turns * speed


def folded(turns: float, sectors: int) -> float:
    """The nodal diameter that so many turns around the ring look like.

    >>> folded(3, 24), folded(21, 24), folded(25, 24), folded(-3, 24)
    (3, 3, 1, 3)
    """
    rest = turns % sectors
    return min(rest, sectors - rest)
