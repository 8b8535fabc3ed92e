"""Node pairs of contacts, seen along the normal of their plane: their distances, and nodes left alone."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from fcm.mesh import MeshError
from fcm.mesh.pairing import fitted_plane
from fcm.model.interface import Interface
from fcm.plot.errors import PlotError
from fcm.plot.labels import plain, with_unit
from fcm.plot.read import FloatArray
from fcm.plot.style import LAYOUT, TWO_COLUMNS, house_style, new_figure

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_ALONE = ("#D55E00", "#0072B2")  # of the first set, of the second
_SIZE = (4.0, 60.0)  # [point^2] of a mark, for many pairs and for few


def view_of(interface: Interface) -> FloatArray:
    """Two directions (2, 3) in the plane of an interface, see `plane_view`."""
    if interface.plane is not None:
        return _forward(interface.plane.first, interface.plane.second)
    places = (interface.first, interface.second, interface.alone, interface.other_alone)
    return plane_view(np.concatenate(places))


def plane_view(places: FloatArray) -> FloatArray:
    """Two directions (2, 3) in the plane of some places (place, 3); for a line, along and across it.

    The greatest component of each direction is positive.

    >>> along = plane_view(np.array([[0.0, 0, 1], [0, 2, 1]]))
    >>> along[0].tolist()
    [0.0, 1.0, 0.0]
    """
    try:
        plane = fitted_plane(places)
    except MeshError:
        _, _, axes = np.linalg.svd(places - places.mean(axis=0), full_matrices=True)
        return _forward(*axes[:2])
    return _forward(plane.first, plane.second)


def _forward(*directions: FloatArray) -> FloatArray:
    return np.stack([one * np.sign(one[np.abs(one).argmax()]) for one in directions])


def direction_name(direction: FloatArray, axes: Sequence[str] = "xyz") -> str:
    """A direction in words, as "x", or "0.6 x − 0.8 z".

    >>> direction_name(np.array([1.0, 0.0, 0.0])), direction_name(np.array([0.6, 0.0, -0.8]))
    ('x', '0.6 x − 0.8 z')
    """
    there = [
        (float(w), axis) for w, axis in zip(direction, axes, strict=True) if abs(w) > LAYOUT.least_weight
    ]
    if len(there) == 1 and there[0][0] > 0.0:
        return there[0][1]
    words = [f"{'−' if weight < 0.0 else '+'} {abs(weight):.3g} {axis}" for weight, axis in there]
    return " ".join(words).removeprefix("+ ")


def draw_pairs(interfaces: Sequence[Interface], length: str = "") -> Figure:
    """The figure: a panel for each contact, its pairs coloured by their distance, nodes alone as crosses.

    Raises
    ------
    PlotError
        If there is no contact whose pairs have places, or more than a picture has room for.
    """
    if not interfaces:
        raise PlotError(
            "no contact has pairs with places. Give nodes = { sets = , mesh = , tolerance = }, or "
            "x, y, z in a file of pairs"
        )
    if len(interfaces) > LAYOUT.panels:
        raise PlotError(
            f"{len(interfaces)} contacts have pairs; a picture has room for {LAYOUT.panels}: "
            "choose by --contact"
        )
    count, columns = len(interfaces), min(len(interfaces), 2)
    rows = -(-count // columns)
    with house_style():
        figure = new_figure(TWO_COLUMNS if columns > 1 else LAYOUT.width, LAYOUT.pairs_height * rows)
        grid = figure.subplots(rows, columns, squeeze=False)
        for axes in grid.flat[count:]:
            axes.set_axis_off()
        for axes, one in zip(grid.flat, interfaces, strict=False):
            _draw(figure, axes, one, length)
    return figure


def _draw(figure: Figure, axes: Any, one: Interface, length: str) -> None:
    """Draws the node pairs of one contact."""
    along = view_of(one)
    seen = [side @ along.T for side in (one.first, one.second)]
    apart = np.linalg.norm(one.second - one.first, axis=1)
    size = float(np.clip(1500.0 / max(len(apart), 1), *_SIZE))
    for start, end in zip(*seen, strict=True):
        axes.plot(*np.stack((start, end)).T, color="#808080", linewidth=0.6, zorder=1)
    rounding = (
        LAYOUT.touch_roundings
        * np.finfo(np.float64).eps
        * max(np.abs(one.first).max(), np.abs(one.second).max())
    )
    touch = bool(apart.max() <= rounding)
    marks = axes.scatter(
        *seen[0].T, c=np.zeros_like(apart) if touch else apart, s=size, cmap="viridis", vmin=0.0,
        edgecolors="black", linewidths=0.3,
    )  # fmt: skip
    for side, colour, name in zip((one.alone, one.other_alone), _ALONE, one.sets[:2], strict=False):
        if len(side):
            label = plain(f"{name}, alone ({len(side)})")
            axes.scatter(*(side @ along.T).T, c=colour, marker="x", s=size, label=label)
    if axes.get_legend_handles_labels()[0]:
        axes.legend()
    if len(one.sets) == 2 and not touch:
        figure.colorbar(marks, ax=axes, label=with_unit("Distance between the nodes of a pair", length))
    axes.set_aspect("equal", adjustable="datalim")
    what = "nodes" if len(one.sets) == 1 else "pairs of coincident nodes" if touch else "pairs"
    axes.set_title(f"{one.name}: {len(apart)} {what}", parse_math=False)
    for direction, name in zip(along, ("x", "y"), strict=True):
        getattr(axes, f"set_{name}label")(with_unit(direction_name(direction), length))
