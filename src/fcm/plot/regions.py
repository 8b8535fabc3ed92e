"""The regions of the sequences of states: thin lines between them, names where there is room."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from scipy.ndimage import distance_transform_edt, minimum_filter

from fcm.contact.surface import Regions
from fcm.plot.read import FloatArray
from fcm.plot.style import LAYOUT

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_LETTER, _HEIGHT = 0.068, 0.125  # [inch] width of a letter, height of a name, with the space around them


def draw_regions(axes: Axes, found: Regions) -> None:
    """Lines between the regions within the separation regime; its own boundaries are not repeated."""
    for where in found.where.values():
        inside = np.where(found.separates, where, np.nan)
        if np.nanmin(inside, initial=1.0) < np.nanmax(inside, initial=0.0):
            axes.contour(found.n0_bar, found.b_bar, inside, levels=[0.5], colors="black", linewidths=0.4)


def name_regions(axes: Axes, found: Regions) -> None:
    """Each sequence in the middle of its region, unless it is too small; the panel has its final size."""
    frame, dpi = axes.get_window_extent(), axes.figure.dpi
    for name, where in found.where.items():
        size = _HEIGHT * dpi / frame.height, _LETTER * (len(name) + 0.5) * dpi / frame.width
        place = _place(where, size)
        if place is not None:
            at = found.n0_bar[place[1]], found.b_bar[place[0]]
            axes.text(*at, name, ha="center", va="center", fontsize=LAYOUT.small_text)


def _place(where: FloatArray, size: tuple[float, float]) -> tuple[int, int] | None:
    """The cell with most room around it for a box of a size, a share of the panel; None if nowhere."""
    cells = [max(1, round(share * count)) for share, count in zip(size, where.shape, strict=True)]
    fits = minimum_filter(where, size=cells, mode="constant", cval=0.0)
    if not fits.any():
        return None
    rows, columns = where.shape
    room = distance_transform_edt(np.pad(fits, 1), sampling=(1.0 / rows, 1.0 / columns))[1:-1, 1:-1]
    row, column = np.unravel_index(np.argmax(room), room.shape)
    return int(row), int(column)
