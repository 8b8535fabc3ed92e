"""A bar of the colours of very many lines, in the place of a legend."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from fcm.plot.style import LAYOUT, sequence_colours

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def colour_bar(figure: Figure, names: Sequence[str], title: str) -> None:
    """The colours of lines in their order, with the names of some of them."""
    from matplotlib.cm import ScalarMappable
    from matplotlib.colors import BoundaryNorm, ListedColormap

    count = len(names)
    each = BoundaryNorm(np.arange(count + 1) - 0.5, count)
    colours = ScalarMappable(each, ListedColormap(sequence_colours(count)))
    shown = np.unique(np.linspace(0, count - 1, LAYOUT.bar_ticks).round().astype(int)).tolist()
    bar = figure.colorbar(colours, ax=figure.axes, ticks=shown, pad=0.02)
    bar.ax.set_yticklabels([names[i] for i in shown])
    bar.ax.minorticks_off()
    bar.set_label(title)
