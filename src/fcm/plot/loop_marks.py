"""Angles written beside the marks of a loop, where they touch neither each other nor the loop."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from fcm.plot.read import BoolArray, FloatArray
from fcm.plot.style import LAYOUT

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.text import Annotation
    from matplotlib.transforms import Bbox

_DISTANCES = (5.0, 9.0, 14.0, 20.0, 27.0, 35.0)  # [point] from the mark to the nearer side of its text
_LEADER = {"arrowstyle": "-", "linewidth": 0.4, "shrinkA": 0.5, "shrinkB": 2.0}
_OUTSIDE, _TOUCHED, _CROSSED = 1e6, 1e4, 1e2  # cost: beyond the panel, a text on one, a leader on one


def name_marks(
    axes: Axes, points: Sequence[tuple[float, float]], texts: Sequence[str], curve: FloatArray, size: float
) -> None:
    """Write each text beside its point (x, y); one without room is written where it covers least.

    The panel must have its final size. The texts should not touch the points curve (i, 2).
    """
    if not points:
        return
    pixels = axes.transData.transform(_dense(curve))
    marks = axes.transData.transform(np.array(points))
    centre = 0.5 * (pixels.min(axis=0) + pixels.max(axis=0))
    pixels = np.concatenate((pixels, marks))
    panel = _Panel(axes, pixels, size)
    for point, mark, text in zip(points, marks, texts, strict=True):
        outward = float(np.arctan2(*(mark - centre)[::-1]))
        box, leader = _write(panel, point, text, outward)
        panel.taken.append(box)
        panel.pixels = np.concatenate((panel.pixels, leader))


@dataclass
class _Panel:
    """A panel in which texts are written, and what they should not touch."""

    axes: Axes
    pixels: FloatArray  # (i, 2) of curves, marks and leaders
    size: float  # [point] of the texts
    taken: list[Bbox] = field(default_factory=list)  # by texts


def _write(panel: _Panel, point: tuple[float, float], text: str, outward: float) -> tuple[Bbox, FloatArray]:
    """Write the text at the first free place, nearest and outward first; return its box and leader."""
    axes, taken, size = panel.axes, panel.taken, panel.size
    trial = _text(axes, point, text, (0.0, 0.0), size)
    extent = trial.get_window_extent()
    trial.remove()
    mark = axes.transData.transform(point)
    best, least = (0.0, 0.0), np.inf
    for offset in (_offset(outward + turn, d) for d in _DISTANCES for turn in _turns()):
        box, leader = _box(axes, mark, offset, extent), _leader(axes, mark, offset)
        cost = _covered(box, axes, taken, panel.pixels) + _CROSSED * sum(
            _inside(b, leader).any() for b in taken
        )
        if cost < least:
            best, least = offset, cost
        if cost == 0.0:
            break
    _text(axes, point, text, best, size)
    return _box(axes, mark, best, extent), _leader(axes, mark, best)


def _leader(axes: Axes, mark: FloatArray, offset: tuple[float, float]) -> FloatArray:
    """Points [pixel] of the line from a mark to a text, (i, 2); none where the text is near enough."""
    if np.hypot(*offset) <= LAYOUT.mark_leader:
        return np.empty((0, 2))
    way = np.array(offset) * axes.figure.dpi / 72.0
    line: FloatArray = mark + np.linspace(0.2, 1.0, LAYOUT.mark_leader_points)[:, None] * way
    return line


def _box(axes: Axes, mark: FloatArray, offset: tuple[float, float], extent: Bbox) -> Bbox:
    """Box [pixel] of a text with an extent, written at an offset [point] from a mark."""
    from matplotlib.transforms import Bbox

    across, up = _alignment(offset)
    x, y = mark + np.array(offset) * axes.figure.dpi / 72.0
    left = x - {"left": 0.0, "center": 0.5, "right": 1.0}[across] * extent.width
    bottom = y - {"bottom": 0.0, "center": 0.5, "top": 1.0}[up] * extent.height
    return Bbox.from_bounds(left, bottom, extent.width, extent.height).padded(LAYOUT.name_margin)


def _turns() -> list[float]:
    """Angles from the outward direction, the smallest first."""
    half = [k * 2.0 * np.pi / LAYOUT.mark_directions for k in range(LAYOUT.mark_directions // 2 + 1)]
    return [0.0, *(sign * turn for turn in half[1:] for sign in (1.0, -1.0))]


def _offset(direction: float, distance: float) -> tuple[float, float]:
    return distance * float(np.cos(direction)), distance * float(np.sin(direction))


def _alignment(offset: tuple[float, float]) -> tuple[str, str]:
    """The side of a text that is towards its mark."""
    across, up = offset
    horizontal = (
        "center" if abs(up) > LAYOUT.mark_steep * abs(across) else "left" if across > 0.0 else "right"
    )
    vertical = "center" if abs(across) > LAYOUT.mark_steep * abs(up) else "bottom" if up > 0.0 else "top"
    return horizontal, vertical


def _text(
    axes: Axes, point: tuple[float, float], text: str, offset: tuple[float, float], size: float
) -> Annotation:
    ha, va = _alignment(offset)
    leader = _LEADER if np.hypot(*offset) > LAYOUT.mark_leader else None
    return axes.annotate(
        text, point, offset, textcoords="offset points", fontsize=size, ha=ha, va=va, arrowprops=leader
    )


def _covered(box: Bbox, axes: Axes, taken: list[Bbox], pixels: FloatArray) -> float:
    """Cost of what a text there would cover: other texts, frame and ticks, points of the loop (1 each)."""
    frame = axes.get_window_extent().padded(-LAYOUT.tick * axes.figure.dpi / 72.0)
    outside = bool(box.x0 < frame.x0 or box.x1 > frame.x1 or box.y0 < frame.y0 or box.y1 > frame.y1)
    others = sum(bool(box.overlaps(other)) for other in taken)
    return _OUTSIDE * outside + _TOUCHED * others + float(_inside(box, pixels).sum())


def _inside(box: Bbox, pixels: FloatArray) -> BoolArray:
    within = (pixels > (box.x0, box.y0)) & (pixels < (box.x1, box.y1))
    return np.logical_and(within[:, 0], within[:, 1])


def _dense(curve: FloatArray) -> FloatArray:
    """Points between those of a loop, so close that none of its pieces jumps over a text."""
    at = np.linspace(0, len(curve) - 1, 4 * (len(curve) - 1) + 1)
    nodes = np.arange(len(curve))
    return np.column_stack([np.interp(at, nodes, curve[:, i]) for i in (0, 1)])
