"""The normal force of a contact without friction, over its normal motion and over a cycle."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from fcm.contact.periodic.loop import PeriodicLoop
from fcm.contact.pieces import waves_at
from fcm.contact.sampled import Part, parts
from fcm.frozen import Frozen
from fcm.plot.labels import plain, power_to_label
from fcm.plot.loop import MARK, STATES
from fcm.plot.loop_marks import name_marks
from fcm.plot.read import FloatArray
from fcm.plot.style import COLUMN, LAYOUT, house_style, new_figure

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_LOOKS: dict[str, tuple[str, dict[str, Any]]] = {
    "E": ("closed", STATES["E"][1]),
    "S": ("open", STATES["S"][1]),
}


class DrawnNormalForce(Frozen):
    """A cycle whose normal force is drawn, with its title, and units of length and force where known.

    The cycle has no tangential motion: it sticks while closed.
    """

    cycle: PeriodicLoop
    title: str
    units: tuple[str, str] | None = None

    def points(self, theta: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Normal displacement v and normal force n at angles [rad]."""
        return waves_at(self.cycle.v, theta), self.cycle.normal_load(theta)


def draw_normal_force(drawn: DrawnNormalForce) -> Figure:
    """Draws the normal force over the normal displacement, and below it over the angle of the cycle."""
    length, force = (f" ({plain(unit)})" for unit in drawn.units) if drawn.units else ("", "")
    with house_style():
        figure = new_figure(COLUMN, LAYOUT.normal_force_height)
        above, below = figure.subplots(2, 1, height_ratios=(5, 3))
        for axes in (above, below):
            axes.axhline(0.0, color="0.85", linewidth=0.5, zorder=0)
            axes.margins(x=LAYOUT.loop_room, y=LAYOUT.loop_room)
        for part in parts(drawn.cycle):
            name, look = _LOOKS[part.state]
            above.plot(*_to_and_fro(*drawn.points(part.theta)), label=name, **look)
            _over_angle(below, part, drawn, look)
        below.set(xlim=(0.0, 360.0), xticks=[0, 90, 180, 270, 360], xlabel=r"Angle $\theta$ (°)")
        above.set(xlabel=f"Normal displacement $v${length}", ylabel=f"Normal force $n${force}")
        below.set_ylabel(f"Normal force{force}")
        handles, labels = above.get_legend_handles_labels()
        once = dict(zip(labels, handles, strict=True))
        figure.legend(list(once.values()), list(once), loc="outside lower center", ncols=2)
        above.set_title(drawn.title, fontsize=8)
        figure.draw_without_rendering()
        power_to_label(above.xaxis)
        figure.draw_without_rendering()  # the panels take their places
        _mark_contact(above, drawn)
    return figure


def _to_and_fro(v: FloatArray, n: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Sort the points of a line along v: drawn to and fro, its dashes would fill the gaps."""
    order = np.argsort(v, kind="stable")
    return v[order], n[order]


def _over_angle(axes: Axes, part: Part, drawn: DrawnNormalForce, look: dict[str, Any]) -> None:
    """The force of a part; one that passes the end of the turn is drawn again at its beginning."""
    force, degrees = drawn.points(part.theta)[1], np.degrees(part.theta)
    for turn in (degrees, degrees - 360.0):
        axes.plot(turn, force, **look)


def _mark_contact(axes: Axes, drawn: DrawnNormalForce) -> None:
    """Draw a ring where the contact closes and opens, with the angles unless there are many."""
    angles = drawn.cycle.angles
    if not angles.size:
        return
    v, n = drawn.points(angles)
    closing, *_ = zip(v.tolist(), n.tolist(), strict=True)
    axes.plot(*closing, color="black", linestyle="", zorder=3, **MARK)
    if angles.size > LAYOUT.loop_named:
        return
    begins = zip(drawn.cycle.sequence, np.degrees(angles).tolist(), strict=True)
    text = ", ".join(f"{'opens' if state == 'S' else 'closes'} at {at:.1f}°" for state, at in begins)
    curve = np.concatenate([np.column_stack(drawn.points(part.theta)) for part in parts(drawn.cycle)])
    name_marks(axes, [closing], [text], curve, LAYOUT.small_text)
