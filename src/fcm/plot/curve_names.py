"""Names of curves: at their peaks, where they touch neither each other nor a line, or beside the axes."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from fcm.plot.labels import curve_label, plain, symbols
from fcm.plot.style import LAYOUT, colour_bar

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from matplotlib.legend import Legend
    from matplotlib.lines import Line2D
    from matplotlib.text import Annotation
    from matplotlib.transforms import Bbox

FloatArray = npt.NDArray[np.float64]

_OFFSETS = (  # [point] from the peak, with the alignment of the text, best first
    (0, 3, "center", "bottom"),
    (4, 2, "left", "bottom"),
    (-4, 2, "right", "bottom"),
    (6, 0, "left", "center"),
    (-6, 0, "right", "center"),
    (0, -4, "center", "top"),
    (10, 11, "center", "bottom"),
    (-10, 11, "center", "bottom"),
    (14, 3, "left", "center"),
    (-14, 3, "right", "center"),
    (14, 12, "left", "bottom"),
    (-14, 12, "right", "bottom"),
    (26, 4, "left", "center"),
    (-26, 4, "right", "center"),
    (4, -4, "left", "top"),
    (-4, -4, "right", "top"),
    (14, -12, "left", "top"),
    (-14, -12, "right", "top"),
)
_LEADER = {"arrowstyle": "-", "linewidth": 0.4, "shrinkA": 0.5, "shrinkB": 0.5}


def label_at_peaks(
    figure: Figure, axes: Axes, lines: Sequence[tuple[FloatArray, FloatArray]], names: Sequence[str]
) -> bool:
    """Write each name at the highest point of its line; if one has no room, write none and return False."""
    figure.draw_without_rendering()
    pixels = np.concatenate([axes.transData.transform(_dense(x, y)) for x, y in lines])
    texts: list[Annotation] = []
    taken: list[Bbox] = []
    for (x, y), name in zip(lines, names, strict=True):
        if not name:
            continue
        peak = (x[np.nanargmax(y)], np.nanmax(y))
        text = _find_room(axes, name, peak, taken, pixels)
        if text is None:
            for earlier in texts:
                earlier.remove()
            return False
        texts.append(text)
    return True


def write_beside(
    figure: Figure,
    axes: Axes,
    lines: Sequence[tuple[FloatArray, FloatArray]],
    names: Sequence[tuple[str, tuple[float, float]]],
) -> None:
    """Write names beside points where they touch no other name, no line and not the legend.

    A name without room is left out.
    """
    figure.draw_without_rendering()
    pixels = np.concatenate([axes.transData.transform(_dense(x, y)) for x, y in lines])
    legend = axes.get_legend()
    taken: list[Bbox] = [] if legend is None else [legend.get_window_extent()]
    for name, point in names:
        _find_room(axes, name, point, taken, pixels)


def _find_room(
    axes: Axes, name: str, peak: tuple[float, float], taken: list[Bbox], pixels: FloatArray
) -> Annotation | None:
    """Write the name at the first free offset, clear of ticks too, and add its box to `taken`; else None."""
    frame = axes.get_window_extent().padded(-LAYOUT.tick * axes.figure.dpi / 72.0)
    for dx, dy, ha, va in _OFFSETS:
        text = axes.annotate(name, peak, (dx, dy), textcoords="offset points", ha=ha, va=va, fontsize=8)
        box = text.get_window_extent().padded(LAYOUT.name_margin)
        inside = frame.x0 < box.x0 and box.x1 < frame.x1 and frame.y0 < box.y0 and box.y1 < frame.y1
        if inside and not any(box.overlaps(other) for other in taken) and not _touched(box, pixels):
            taken.append(box)
            if abs(dx) < LAYOUT.name_leader:
                return text
            text.remove()
            return axes.annotate(
                name, peak, (dx, dy), textcoords="offset points", ha=ha, va=va, fontsize=8, arrowprops=_LEADER
            )
        text.remove()
    return None


def _touched(box: Bbox, pixels: FloatArray) -> bool:
    return bool(((pixels > (box.x0, box.y0)) & (pixels < (box.x1, box.y1))).all(axis=1).any())


def _dense(x: FloatArray, y: FloatArray) -> FloatArray:
    """Points along the drawn line, close enough that none of its pieces jumps over a name."""
    at = np.linspace(0, len(x) - 1, LAYOUT.name_points * (len(x) - 1) + 1)
    nodes = np.arange(len(x))
    return np.column_stack([np.interp(at, nodes, x), np.interp(at, nodes, y)])


def name_at_side(
    figure: Figure,
    lines: Sequence[Line2D],
    parameters: Sequence[Mapping[str, float]],
    units: Mapping[str, str],
) -> Legend | None:
    """Name lines by their swept values in a legend beside the axes; very many by a colour bar."""
    if not parameters[0]:
        return None
    differing, title = varying(parameters, units)
    names = [curve_label(one, False) for one in differing]
    if len(names) > LAYOUT.bar_names:
        colour_bar(figure, names, ", ".join(title))
        return None
    return figure.legend(lines, names, title=",\n".join(title), loc="outside right upper")


def varying(
    parameters: Sequence[Mapping[str, float]], units: Mapping[str, str]
) -> tuple[list[dict[str, float]], list[str]]:
    """The swept values that differ between curves, and a title; it gives the values of those that do not.

    If no value differs, all are kept.
    """
    same = {
        key: value for key, value in parameters[0].items() if all(one[key] == value for one in parameters)
    }
    if len(same) == len(parameters[0]):
        same = {}
    title = symbols(parameters[0], units)
    for i, (key, name) in enumerate(zip(parameters[0], symbols(parameters[0]), strict=True)):
        if key in same:
            unit = plain(units.get(key, ""))
            title[i] = f"{name} = {curve_label({key: same[key]}, False)} {unit}".rstrip()
    return [{key: one[key] for key in one if key not in same} for one in parameters], title
