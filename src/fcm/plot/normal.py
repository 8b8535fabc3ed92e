"""The coefficients of the variable normal load against its preload, figure 12."""

from __future__ import annotations

from typing import TYPE_CHECKING

from fcm.plot.read import FloatArray
from fcm.plot.style import COLUMN, LAYOUT, house_style, new_figure, sequence_colours

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def draw_normal(n0_star: FloatArray, N_b: FloatArray, N_s: FloatArray) -> Figure:
    """N_b solid, N_s dashed, as in the paper; the thin lines are the limits of the intermittent contact."""
    with house_style():
        figure = new_figure(COLUMN, LAYOUT.row_height)
        axes = figure.add_subplot()
        for limit in (-1.0, 1.0):
            axes.axvline(limit, color="0.6", linewidth=0.5, label="_limit")
        dark, light = sequence_colours(2)
        axes.plot(n0_star, N_b, color=dark, linewidth=1.3, label="mean $N_b$")
        axes.plot(n0_star, N_s, color=light, linewidth=1.3, linestyle=(0, (4, 1.6)), label="stiffness $N_s$")
        axes.set_xlabel(r"Preload $n_0^* = n_0 / k_v b$ (–)")
        axes.set_ylabel("Coefficients of the normal load $N_b$, $N_s$ (–)")
        axes.margins(x=0.0, y=0.05)
        axes.minorticks_on()
        axes.legend(loc="upper center")
    return figure
