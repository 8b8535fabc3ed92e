"""Hysteresis loops side by side, as in figures 5, 6 and 8, with coloured states and marked transitions."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from fcm.contact.loop import Loop
from fcm.contact.periodic.loop import PeriodicLoop
from fcm.contact.sampled import Part, parts, shown_degrees, transitions
from fcm.frozen import Frozen
from fcm.plot.labels import plain, power_to_label
from fcm.plot.loop_marks import name_marks
from fcm.plot.read import FloatArray
from fcm.plot.style import COLUMN, LAYOUT, TWO_COLUMNS, house_style, new_figure

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

STATES: dict[str, tuple[str, dict[str, Any]]] = {  # name, and a look that survives colour blindness and grey
    "E": ("E stick", {"color": "black", "linestyle": "-", "linewidth": 1.0}),
    "P": ("P positive slip", {"color": "#d55e00", "linestyle": "-", "linewidth": 2.2}),
    "N": ("N negative slip", {"color": "#0072b2", "linestyle": (0, (2.4, 0.9)), "linewidth": 2.2}),
    "S": ("S separation", {"color": "0.45", "linestyle": (0, (0.9, 0.9)), "linewidth": 2.2}),
}
_LIMIT: dict[str, Any] = {"color": "0.6", "linewidth": 0.7, "linestyle": (0, (5, 2))}
MARK: dict[str, Any] = {"marker": "o", "markersize": 3.2, "markerfacecolor": "white", "markeredgewidth": 0.7}
_LOOP_HEIGHT, _TIME_HEIGHT = 1.75, 1.05  # [inch] of the two panels of a loop
_LABELS, _LEGEND, _TITLE = 0.35, 0.75, 0.2  # [inch] of what is around them


class DrawnLoop(Frozen):
    """A loop with its title, and the factors from its displacement and force to the drawn ones."""

    loop: Loop | PeriodicLoop
    title: str
    amplitude: float = 1.0  # a
    force: float = 1.0  # k_u a

    def points(self, part: Part) -> tuple[FloatArray, FloatArray]:
        """Displacement and force of a part, as they are drawn."""
        return self.amplitude * part.displacement, self.force * part.force


class LoopAxes(Frozen):
    """Names of the axes, and where their angle begins."""

    displacement: str = "Displacement $u/a$ (–)"
    force: str = "Friction force $f/k_u a$ (–)"
    over_angle: str = "Force (–)"  # force in the lower panel, which has less room
    limit: str = r"slip limits $\pm\mu n/k_u a$"
    from_greatest: bool = False  # angles count from the greatest displacement, u = a cos(theta)

    @classmethod
    def with_units(cls, units: tuple[str, str] | None, from_greatest: bool) -> LoopAxes:
        """Axes of displacement and force in units of length and force, named if they are known."""
        length, force = (f" ({plain(unit)})" for unit in units) if units else ("", "")
        return cls(
            f"Displacement $u${length}",
            f"Friction force $f${force}",
            f"Force{force}",
            r"slip limits $\pm\mu n$",
            from_greatest,
        )

    def degrees(self, theta: float) -> float:
        """The angle as it is shown, in [0, 360)."""
        return shown_degrees(theta, self.from_greatest)


def draw_loops(loops: Sequence[DrawnLoop], axes: LoopAxes | None = None, title: str = "") -> Figure:
    """Draws each loop: force over displacement, and below it force over angle with the slip limits."""
    names = axes or LoopAxes()
    shared = _same_scale(loops)
    with house_style():
        figure, panels = _panels(len(loops), bool(title))
        for i, (drawn, (above, below)) in enumerate(zip(loops, panels, strict=True)):
            _draw_loop(above, drawn)
            _draw_over_angle(below, drawn, names)
            _limit(above, below, loops if shared else [drawn])
            left = i % LAYOUT.loop_columns == 0
            _label(above, below, names, left=left, numbers=left or not shared)
            above.set_title(drawn.title, fontsize=8)
        _legend(figure, loops, names, any(_limits_seen(*one) for one in zip(loops, panels, strict=True)))
        figure.suptitle(title, fontsize=8)
        figure.draw_without_rendering()
        for above, _ in panels:
            power_to_label(above.xaxis)
        figure.draw_without_rendering()  # the panels take their places
        for drawn, (above, _) in zip(loops, panels, strict=True):
            _mark_transitions(above, drawn, names)
    return figure


def _panels(count: int, titled: bool) -> tuple[Figure, list[tuple[Axes, Axes]]]:
    """Two panels for each loop, one above the other.

    A single loop is one column wide, several are two.
    """
    columns = min(count, LAYOUT.loop_columns)
    rows = -(-count // columns)
    height = rows * (_LOOP_HEIGHT + _TIME_HEIGHT + _LABELS) + _LEGEND + (_TITLE if titled else 0.0)
    figure = new_figure(COLUMN, LAYOUT.loop_alone * height) if count == 1 else new_figure(TWO_COLUMNS, height)
    grid = figure.add_gridspec(2 * rows, columns, height_ratios=[_LOOP_HEIGHT, _TIME_HEIGHT] * rows)
    places = (divmod(i, columns) for i in range(count))
    return figure, [
        (figure.add_subplot(grid[2 * row, column]), figure.add_subplot(grid[2 * row + 1, column]))
        for row, column in places
    ]


def _same_scale(loops: Sequence[DrawnLoop]) -> bool:
    """Whether all loops have the same amplitude and stiffness, so that they can be compared."""
    return len({(drawn.amplitude, drawn.force) for drawn in loops}) == 1


def _draw_loop(axes: Axes, drawn: DrawnLoop) -> None:
    axes.axhline(0.0, color="0.85", linewidth=0.5, zorder=0)
    axes.axvline(0.0, color="0.85", linewidth=0.5, zorder=0)
    for part in parts(drawn.loop):
        poll = STATES[part.state][1]
        u, f = drawn.points(part)
        if part.state == "S":  # to and fro on one line: drawn once, or dashes fill the gaps
            u, f = np.array([u.min(), u.max()]), np.zeros(2)
        axes.plot(u, f, **poll)
        if part.state in "PN":
            _arrow(axes, drawn, part, poll["color"])


def _arrow(axes: Axes, drawn: DrawnLoop, part: Part, colour: str) -> None:
    """Draw the direction of the cycle as an arrow in the middle of a slip."""
    middle = part.theta.size // 2
    if part.theta[-1] - part.theta[0] < 0.5 or middle + 1 >= part.theta.size:
        return
    u, f = drawn.points(part)
    start, end = ((u[i], f[i]) for i in (middle - 1, middle + 1))
    head = {"arrowstyle": "-|>", "color": colour, "mutation_scale": 8, "shrinkA": 0, "shrinkB": 0}
    axes.annotate("", end, start, arrowprops=head)


def _draw_over_angle(axes: Axes, drawn: DrawnLoop, names: LoopAxes) -> None:
    """Force and slip limits over one turn; a part that passes its end is drawn again at its beginning."""
    axes.axhline(0.0, color="0.85", linewidth=0.5, zorder=0)
    for part in parts(drawn.loop):
        first = names.degrees(float(part.theta[0]))
        angle = first + np.degrees(part.theta - part.theta[0])
        for turn in (angle, angle - 360.0):
            for sign in (-1.0, 1.0):
                axes.plot(turn, sign * drawn.force * part.limit, label="_limit", **_LIMIT)
            axes.plot(turn, drawn.points(part)[1], **STATES[part.state][1])
            _name_state(axes, part.state, turn)
    for transition in transitions(drawn.loop):
        axes.axvline(names.degrees(transition.theta), color="0.3", linewidth=0.4, zorder=0)
    axes.set_xlim(0.0, 360.0)
    axes.set_xticks([0, 90, 180, 270, 360])


def _name_state(axes: Axes, state: str, angle: Any) -> None:
    """Write the state's letter above the panel, in the middle of the visible part of the state."""
    low, high = max(angle[0], 0.0), min(angle[-1], 360.0)
    if high - low >= LAYOUT.loop_narrowest:
        axes.text(
            0.5 * (low + high), 1.02, state, transform=axes.get_xaxis_transform(),
            ha="center", va="bottom", fontsize=LAYOUT.small_text, color=STATES[state][1]["color"],
        )  # fmt: skip


def _label(above: Axes, below: Axes, names: LoopAxes, left: bool, numbers: bool) -> None:
    """Name the axes; forces only with `left`, and their tick numbers only with `numbers`."""
    above.set_xlabel(names.displacement, fontsize=8)
    below.set_xlabel(r"Angle $\theta$ (°)", fontsize=8)
    for axes, force in ((above, names.force), (below, names.over_angle)):
        axes.tick_params(labelsize=LAYOUT.small_text, labelleft=numbers)
        axes.yaxis.get_offset_text().set(
            fontsize=LAYOUT.small_text, ha="right"
        )  # not among the letters of the states
        if left:
            axes.set_ylabel(force, fontsize=8)


def _limit(above: Axes, below: Axes, loops: Sequence[DrawnLoop]) -> None:
    """Room around the loops for their marks; slip limits far beyond the force are cut off."""
    width, low, high = np.array([_extent(drawn) for drawn in loops]).T
    room = LAYOUT.loop_room * (high.max() - low.min() or 1.0)
    above.set_xlim(-(1.0 + LAYOUT.loop_room) * width.max(), (1.0 + LAYOUT.loop_room) * width.max())
    above.set_ylim(low.min() - room, high.max() + room)
    far = max(high.max(), -low.min()) + room
    below.set_ylim(-far, far)


def _extent(drawn: DrawnLoop) -> tuple[float, float, float]:
    """Greatest displacement, least and greatest force."""
    u, f = np.concatenate([drawn.points(part) for part in parts(drawn.loop)], axis=1)
    return float(np.abs(u).max()), float(f.min()), float(f.max())


def _limits_seen(drawn: DrawnLoop, panels: tuple[Axes, Axes]) -> bool:
    """Whether slip limits come near enough to the force to be in its panel."""
    far = panels[1].get_ylim()[1]
    return any(bool((drawn.force * np.abs(part.limit) <= far).any()) for part in parts(drawn.loop))


def _legend(figure: Figure, loops: Sequence[DrawnLoop], names: LoopAxes, limits: bool) -> None:
    from matplotlib.lines import Line2D

    found = {state for drawn in loops for state in drawn.loop.sequence}
    handles = [Line2D([], [], label=name, **poll) for state, (name, poll) in STATES.items() if state in found]
    label = names.limit if limits else f"{names.limit}: beyond the panel"
    handles.append(Line2D([], [], label=label, **_LIMIT))
    if any(drawn.loop.angles.size for drawn in loops):
        handles.append(Line2D([], [], label="transition", linestyle="", color="black", **MARK))
    columns = 2 if len(loops) == 1 else len(handles)
    figure.legend(
        handles=handles, loc="outside lower center", ncols=columns, fontsize=LAYOUT.small_text,
        handlelength=2.4, columnspacing=1.0,
    )  # fmt: skip


def _mark_transitions(axes: Axes, drawn: DrawnLoop, names: LoopAxes) -> None:
    """Draw a ring at each transition, with its angle unless there are too many to be told apart."""
    found = transitions(drawn.loop)
    points = [(drawn.amplitude * t.displacement, drawn.force * t.force) for t in found]
    texts = [f"{names.degrees(t.theta):.1f}°" for t in found]
    curve = np.concatenate([np.column_stack(drawn.points(part)) for part in parts(drawn.loop)])
    for x, y in points:
        axes.plot([x], [y], color="black", linestyle="", zorder=3, **MARK)
    if len(texts) <= LAYOUT.loop_named:
        name_marks(axes, points, texts, curve, LAYOUT.small_text)
