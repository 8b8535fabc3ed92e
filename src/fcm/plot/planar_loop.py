"""The loop of a contact in its plane: paths of displacement, slider and force, and two loops of these."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from fcm.at_rest import RestOptions, at_rest
from fcm.contact.plane.loop import PlanarLoop
from fcm.frozen import Frozen
from fcm.plot.labels import plain, power_to_label
from fcm.plot.loop import STATES
from fcm.plot.loop_marks import name_marks
from fcm.plot.read import FloatArray
from fcm.plot.style import LAYOUT, TWO_COLUMNS, house_style, new_figure

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

SLIDER = "#009e73"
DISC = "0.75"
LIMIT = "0.45"


class DrawnPlanarLoop(Frozen):
    """A loop with its title, the names of its directions, and units of length and force where known.

    dimensionless: displacements are in units of an amplitude a, forces in units of k_u a.
    """

    loop: PlanarLoop
    title: str
    directions: tuple[str, str] = ("x", "y")
    units: tuple[str, str] | None = None
    instants: int = LAYOUT.planar_instants
    dimensionless: bool = False


class DrawnPath(Frozen):
    """A cycle sampled: theta, disc's radius, states (sample,); displacement u, slider w, force f (sample, 2).

    Without tangential stiffness nothing drags the slider: w = u, and the disc has radius 0.
    """

    theta: FloatArray
    u: FloatArray
    w: FloatArray
    f: FloatArray
    radius: FloatArray
    states: npt.NDArray[np.str_]


def path_of(loop: PlanarLoop) -> DrawnPath:
    """Sample a cycle, transitions included; values are 0 in a direction that has only rounding."""
    theta = np.unique(np.concatenate((np.linspace(0.0, 2.0 * np.pi, LAYOUT.planar_samples + 1), loop.angles)))
    u, stiff = loop.displacement(theta), loop.k_u > 0.0
    w = loop.slider(theta) if stiff else u
    radius = loop.slip_limit(theta) / loop.k_u if stiff else np.zeros_like(theta)
    u, w, f = (_without_rounding(one) for one in (u, w, loop.force(theta)))
    return DrawnPath(theta, u, w, f, radius, np.asarray(loop.states(theta)))


def _without_rounding(values: FloatArray) -> FloatArray:
    """Values (sample, 2) in both directions, with 0 for a direction that is rounding of the other."""
    rest = at_rest(np.abs(values).max(axis=0), RestOptions(displacement=LAYOUT.planar_rest))
    return np.where(rest, 0.0, values)


def draw_planar_loop(drawn: DrawnPlanarLoop) -> Figure:
    """Draws the loop of a contact in its plane.

    The left panels show the paths of u and the slider with discs, and below them the path of the force
    between its limits. The right panels show the force over the displacement, for each direction.
    """
    path = path_of(drawn.loop)
    length, force = (f" ({unit.replace('$', '')})" for unit in drawn.units) if drawn.units else ("", "")
    if drawn.dimensionless:
        length, force = "$/a$", "$/(k_u a)$"
    with house_style():
        figure = new_figure(TWO_COLUMNS, LAYOUT.planar_height)
        grid = figure.add_gridspec(2, 2)
        plane = figure.add_subplot(grid[0, 0])
        _draw_plane(plane, drawn, path)
        along = [
            _of_direction(f"$u_{k}$", name, length) for k, name in zip("xy", drawn.directions, strict=True)
        ]
        plane.set(xlabel=along[0], ylabel=along[1])
        loops = [figure.add_subplot(grid[i, 1]) for i in range(2)]
        for i, axes in enumerate(loops):
            _draw_direction(axes, path, i)
        for axes, other, motion in zip(loops, loops[::-1], path.u.T, strict=True):
            if not motion.any():
                axes.set(xlim=other.get_xlim(), ylim=other.get_ylim())
                axes.text(0.5, 0.75, "no motion", transform=axes.transAxes, ha="center", fontsize=7)
        for axes, name, displacement in zip(loops, "xy", along, strict=True):
            axes.set(xlabel=displacement, ylabel=f"$f_{name}${force}")
        limits = figure.add_subplot(grid[1, 0])
        _draw_forces(limits, drawn.loop, path)
        limits.set_xlabel(f"$f_x${force}")
        limits.set_ylabel(f"$f_y${force}")
        handles, labels = map(list, plane.get_legend_handles_labels())
        for handle, label in zip(*limits.get_legend_handles_labels(), strict=True):
            handles.append(handle)
            labels.append(label)
        figure.legend(handles, labels, loc="outside lower center", ncols=len(labels), fontsize=7)
        figure.suptitle(drawn.title, fontsize=8)
        figure.draw_without_rendering()
        power_to_label(plane.xaxis, plane.yaxis, *(axes.xaxis for axes in loops))
        for axis in (limits.xaxis, limits.yaxis, *(axes.yaxis for axes in loops)):
            power_to_label(axis)
        figure.draw_without_rendering()  # so that the plane has its final size
        instants = _instants(path, drawn.instants)
        points = [(float(x), float(y)) for x, y in path.u[instants]]
        angles = [f"{np.degrees(path.theta[at]):.0f}°" for at in instants]
        name_marks(plane, points, angles, np.concatenate((path.u, path.w)), 6.5)
    return figure


def _draw_plane(axes: Axes, drawn: DrawnPlanarLoop, path: DrawnPath) -> None:
    """The discs |u - w| <= mu n / k_u about u at some instants, with the force as a line from the slider."""
    from matplotlib.patches import Circle

    axes.set_aspect("equal", adjustable="box")
    radius = path.radius
    for k, at in enumerate(_instants(path, drawn.instants)):
        centre = float(path.u[at, 0]), float(path.u[at, 1])
        disc = Circle(centre, float(radius[at]), facecolor="none", edgecolor=DISC, linewidth=0.8, zorder=1)
        disc.set_label("disc of radius $\\mu n/k_u$" if k == 0 else "_")
        axes.add_patch(disc)
        axes.plot(
            [path.w[at, 0], path.u[at, 0]], [path.w[at, 1], path.u[at, 1]],
            color=DISC, linewidth=0.8, zorder=1, label="force$/k_u$" if k == 0 else "_",
        )  # fmt: skip
        axes.plot(*centre, marker="o", markersize=2.6, color="black", zorder=4)
        axes.plot(*path.w[at], marker="s", markersize=2.6, color=SLIDER, zorder=4)
    shown = np.where((path.states == "S")[:, None], np.nan, path.w)
    axes.plot(shown[:, 0], shown[:, 1], color=SLIDER, linewidth=1.1, zorder=2, label="slider $w$")
    for state in dict.fromkeys("EPS"):
        if (path.states == state).any():
            x, y = _only(path.u, path.states == state).T
            poll = STATES[state][1]
            name = {"E": "$u$, stick", "P": "$u$, slip", "S": "$u$, separation"}[state]
            axes.plot(x, y, zorder=3, label=name, **poll)
    shown_at = _instants(path, drawn.instants)
    low = np.minimum(path.u.min(axis=0), (path.u[shown_at] - radius[shown_at, None]).min(axis=0))
    high = np.maximum(path.u.max(axis=0), (path.u[shown_at] + radius[shown_at, None]).max(axis=0))
    half, (x, y) = LAYOUT.planar_room * float((high - low).max()), 0.5 * (low + high)
    axes.set_xlim(x - half, x + half)
    axes.set_ylim(y - half, y + half)


def _draw_forces(axes: Axes, loop: PlanarLoop, path: DrawnPath) -> None:
    """The path of the friction force, and the circles of its least and greatest limit over the cycle."""
    from matplotlib.patches import Circle

    axes.set_aspect("equal", adjustable="box")
    limit = loop.slip_limit(path.theta)
    low, high = float(limit.min()), float(limit.max())
    radii = (high, low) if low < LAYOUT.same_circle * high else (high,)
    which = ", least and greatest" if len(radii) > 1 else ""
    for radius in radii:
        look = {"facecolor": "none", "edgecolor": LIMIT, "linewidth": 0.8, "linestyle": "--"}
        circle = Circle((0.0, 0.0), radius, **look)
        circle.set_label(f"radius $\\mu n${which}" if radius == high else "_")
        axes.add_patch(circle)
    for state in "EPS":
        if (at := path.states == state).any():
            axes.plot(*_only(path.f, at).T, zorder=3, label="_", **STATES[state][1])
    half = LAYOUT.planar_room * 2.0 * max(high, float(np.abs(path.f).max())) or 1.0
    axes.set(xlim=(-half, half), ylim=(-half, half))


def _draw_direction(axes: Axes, path: DrawnPath, i: int) -> None:
    axes.axhline(0.0, color="0.85", linewidth=0.5, zorder=0)
    axes.axvline(0.0, color="0.85", linewidth=0.5, zorder=0)
    for state in "EPS":
        if (path.states == state).any():
            at = path.states == state
            axes.plot(_only(path.u[:, i], at), _only(path.f[:, i], at), **STATES[state][1])
    axes.margins(0.12)


def _instants(path: DrawnPath, count: int) -> list[int]:
    """Indices of the samples at angles evenly spread over the cycle."""
    wanted = np.linspace(0.0, 2.0 * np.pi, count, endpoint=False)
    return [int(np.abs(path.theta - angle).argmin()) for angle in wanted]


def _only(values: FloatArray, which: npt.NDArray[np.bool_]) -> FloatArray:
    """Values where `which` holds and at the first sample after it; NaN elsewhere."""
    shown = which | np.concatenate((which[:1], which[:-1]))
    found: FloatArray = np.where(shown if values.ndim == 1 else shown[:, None], values, np.nan)
    return found


def _of_direction(symbol: str, name: str, unit: str) -> str:
    """The label of a displacement, with its unit or as a multiple of a; a long name is left out."""
    scaled, short = unit.startswith("$"), len(name) <= LAYOUT.direction_name
    named = f"{unit if scaled else ''} = {plain(name)}" if short else ""
    return f"Displacement {symbol}{named}{unit}"
