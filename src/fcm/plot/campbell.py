"""Frequencies of a ring of sectors against the nodal diameter, and what an engine order meets (SAFE diagram).

At the rotor speed W an engine order n has the frequency n W, and the sectors see it as a nodal diameter. The
lines of all engine orders run up and down between the diameters 0 and half of the number of sectors.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from fcm.frozen import Frozen
from fcm.plot.labels import frequency_label
from fcm.plot.style import LAYOUT, house_style, new_figure, sequence_colours

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

FloatArray = npt.NDArray[np.float64]

_NUMBER = (
    0.12,
    0.01,
    0.045,
)  # room of a number: beside it in diameters, below and above its foot in axis heights


class DrawnRing(Frozen):
    """Contents of a Campbell diagram of a ring, in the scene's unit of frequency."""

    title: str
    sectors: int
    engine_orders: tuple[int, ...]
    span: tuple[float, float] | None  # range of the excitation, if there is one
    unit: str
    diameters: tuple[int, ...]
    opened: tuple[FloatArray, ...]  # (mode,) for each diameter
    stuck: tuple[FloatArray, ...]


class DrawnOrder(Frozen):
    """A harmonic of an engine order, over the range of the excitation."""

    order: int
    harmonic: int
    low: float
    high: float


def draw_campbell(ring: DrawnRing) -> Figure:
    """The figure: families of modes over the nodal diameters, and the lines of the engine orders."""
    from matplotlib.ticker import MaxNLocator

    top = _top(ring)
    with house_style():
        figure = new_figure(1.15 * LAYOUT.width, 1.2 * LAYOUT.height)
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
        axes.set_title(_title(ring), loc="right", fontsize=8)
        figure.legend(loc="outside right upper")
    return figure


def _title(ring: DrawnRing) -> str:
    """Title of the diagram; tells how many of the engine orders are shown."""
    count = len(ring.engine_orders)
    text = f"{ring.sectors} sectors"
    return (
        text
        if count <= LAYOUT.campbell_orders
        else f"{text}; the first {LAYOUT.campbell_orders} of {count} engine orders"
    )


def _top(ring: DrawnRing) -> float:
    """Upper end of the frequency axis, above the modes of interest."""
    end = 0.0 if ring.span is None else ring.span[1]
    limit = LAYOUT.campbell_top * end if end else np.inf
    every = np.concatenate((*ring.opened, *ring.stuck))
    return LAYOUT.campbell_headroom * max(end, float(every[every < limit].max(initial=0.0))) or 1.0


def _families(axes: Axes, diameters: Sequence[int], frequencies: Sequence[FloatArray], state: str) -> None:
    """Join the lowest modes of all diameters by a line, then the second ones, and so on."""
    x = np.array(diameters)
    most = max(len(one) for one in frequencies)
    for number in range(most):
        y = np.array([one[number] if number < len(one) else np.nan for one in frequencies])
        axes.plot(
            x, y, "o-", color="black" if state == "open" else "#0072b2", linewidth=0.5, markersize=3.5,
            markerfacecolor="white" if state == "open" else "#0072b2", markeredgewidth=0.8,
            label=f"contacts {state}" if number == 0 else None,
        )  # fmt: skip


def _orders(axes: Axes, ring: DrawnRing, top: float) -> None:
    """Draw the harmonics of each engine order and the line of its highest rotor speed.

    A single order also has the line of its lowest speed. Without a range nothing is drawn.
    """
    if ring.span is None:
        return
    shown = ring.engine_orders[: LAYOUT.campbell_orders]
    colours = dict(zip(shown, _colours(len(shown)), strict=True))
    _bars(axes, ring, ring.span, colours, top)
    for order, colour in colours.items():
        if order:
            low, high = (abs(end / order) for end in ring.span)
            lines = ((low, (0, (1, 2))), (high, (0, (4, 2))))
            for speed, dashes in lines if len(shown) == 1 else lines[1:]:
                axes.plot(
                    *_zigzag(ring.sectors, speed, top), color=colour, linewidth=0.7, linestyle=dashes,
                    zorder=0, label=f"all orders at {_speed(speed, ring.unit)}",
                )  # fmt: skip


def _bars(
    axes: Axes, ring: DrawnRing, span: tuple[float, float], colours: dict[int, str], top: float
) -> None:
    """Draws the harmonics of engine orders as bars; those at one diameter stand side by side."""
    placed = [
        one
        for x, bars in _met(ring.sectors, span, tuple(colours), top).items()
        for one in _placed(ring, x, bars)
    ]
    for bar, middle, width in sorted(placed, key=lambda one: tuple(colours).index(one[0].order)):
        axes.bar(
            middle, bar.high - bar.low, width, bar.low, color=colours[bar.order], alpha=0.35, zorder=1,
            linewidth=0.0, label=f"order {bar.order}, numbers: its harmonics" if bar.harmonic == 1 else None,
        )  # fmt: skip
    named: dict[tuple[int, int], list[tuple[DrawnOrder, float]]] = {}
    for bar, middle, _ in placed:
        named.setdefault((round(middle), bar.harmonic), []).append((bar, middle))
    for (_, harmonic), some in named.items():
        centre = sum(middle for _, middle in some) / len(some)
        _number(axes, ring, harmonic, centre, some[0][0].high, top)


def _number(axes: Axes, ring: DrawnRing, harmonic: int, x: float, end: float, top: float) -> None:
    """Write the number of a harmonic where its bars end, with a halo against lines that cross it."""
    from matplotlib.patheffects import withStroke

    axes.annotate(
        f"{harmonic}", (x, free_height(ring, x, end, top)), xytext=(0, 1), textcoords="offset points",
        fontsize=7, ha="center", va="bottom", zorder=4,
        path_effects=[withStroke(linewidth=LAYOUT.halo, foreground="white")],
    )  # fmt: skip


def free_height(ring: DrawnRing, x: float, end: float, top: float) -> float:
    """Height of a number at the end of a bar: above the end and above the modes in its way.

    It is below the end if the axis has no room above.
    """
    room_of_number, below, above = _NUMBER
    modes = [
        frequency
        for diameter, *both in zip(ring.diameters, ring.opened, ring.stuck, strict=True)
        for frequency in np.concatenate(both).tolist()
        if abs(diameter - x) < room_of_number
    ]
    height = min(end, LAYOUT.campbell_labelled * top)
    for direction in (1.0, -1.0):
        found = height
        for frequency in sorted(modes, reverse=direction < 0.0):
            if -below * top < frequency - found < above * top:
                found = frequency + (below if direction > 0.0 else -above) * top
        if found <= LAYOUT.campbell_labelled * top:
            return found
    return height


def _placed(ring: DrawnRing, x: float, bars: list[DrawnOrder]) -> list[tuple[DrawnOrder, float, float]]:
    """The bars at a diameter, with their middles and widths."""
    lanes = lanes_of([(bar.low, bar.high) for bar in bars])
    count = max(lanes) + 1
    room = min(LAYOUT.campbell_bar * (ring.sectors // 2 + 1), LAYOUT.campbell_filled / count)
    return [
        (bar, x + room * (lane - 0.5 * (count - 1)), room if bar.harmonic == 1 else 0.5 * room)
        for bar, lane in zip(bars, lanes, strict=True)
    ]


def _met(
    sectors: int, span: tuple[float, float], orders: Sequence[int], top: float
) -> dict[float, list[DrawnOrder]]:
    """The bars at each nodal diameter, without those that begin above the axis."""
    met: dict[float, list[DrawnOrder]] = {}
    for order in orders:
        for harmonic in range(1, LAYOUT.campbell_harmonics + 1):
            low, high = (harmonic * end for end in span)
            if low < top:
                met.setdefault(folded(harmonic * order, sectors), []).append(
                    DrawnOrder(order, harmonic, low, high)
                )
    return met


def lanes_of(spans: Sequence[tuple[float, float]]) -> list[int]:
    """Assign spans to as few lanes as possible so that those in one lane do not overlap.

    >>> lanes_of([(1, 2), (1, 2), (2, 4), (1.5, 3)])
    [0, 1, 0, 2]
    """
    ends: list[float] = []  # of the last span in each lane
    lanes = [0] * len(spans)
    for i in sorted(range(len(spans)), key=lambda i: spans[i][0]):
        low, high = spans[i]
        free = [lane for lane, end in enumerate(ends) if end <= low]
        lanes[i] = free[0] if free else len(ends)
        ends[lanes[i] : lanes[i] + 1] = [high]
    return lanes


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
    """The nodal diameter as which the sectors see a wave with `turns` periods around the ring.

    >>> folded(3, 24), folded(21, 24), folded(25, 24), folded(-3, 24)
    (3, 3, 1, 3)
    """
    rest = turns % sectors
    return min(rest, sectors - rest)
