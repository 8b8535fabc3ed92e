"""Shared parts of pictures over the plane (n0_bar, b_bar): panels, labels, lines between regimes."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from fcm.contact.surface import Edges, ParameterPlane
from fcm.plot.read import FloatArray
from fcm.plot.style import LAYOUT, new_figure

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

N0_LABEL = r"Preload $\bar{n}_0 = \mu n_0 / k_u a$ (–)"
B_LABEL = r"Load variation $\bar{b} = \mu k_v b / k_u a$ (–)"
N0_SYMBOL, B_SYMBOL = r"$\bar{n}_0$ (–)", r"$\bar{b}$ (–)"
SYMBOLS = {"F_b": "$F_b$", "F_s": "$F_s$", "F_c": "$F_c$"}
MEANING = {"F_b": "Mean force $F_b$ (–)", "F_s": "Stiffness $F_s$ (–)", "F_c": "Damping $F_c$ (–)"}
BOUNDARIES: dict[str, tuple[str, Any]] = {  # name: label, line style
    "open": (r"fully open, $\bar{n}_0 = -\bar{b}$", (0, (1, 1.2))),
    "separation": (r"onset of separation, $\bar{n}_0 = \bar{b}$", (0, (4, 1.6))),
    "slip": (r"slip limit, $\bar{n}_0 = (\ell_1 + \ell_2)/2$", "-"),
}


def phase_name(phi: float) -> str:
    """The phase, in degrees if these have at most two decimals, else in radians.

    >>> phase_name(math.radians(15.0)), phase_name(0.5)
    ('$\\\\phi$ = 15°', '$\\\\phi$ = 0.5 rad')
    """
    degrees = math.degrees(phi)
    whole = abs(degrees - round(degrees, 2)) < 1e-9
    text = f"{round(degrees, 2):g}°" if whole else f"{phi:.4g} rad"
    return f"$\\phi$ = {text}".replace("-", "−")


def panel_titles(shown: list[tuple[str, float]]) -> list[str]:
    """(a), (b), ... with the coefficient and the phase of each panel; one alone needs no letter."""
    names = [f"{SYMBOLS[coefficient]}, {phase_name(phi)}" for coefficient, phi in shown]
    if len(names) == 1:
        return names
    return [f"({chr(ord('a') + index)}) {name}" for index, name in enumerate(names)]


def panels(count: int, height: float, **more: Any) -> tuple[Figure, list[Axes]]:
    """Axes in rows of two, or one alone and larger; a row of two has the given height [inch]."""
    columns = min(count, 2)
    rows = -(-count // columns)
    figure = new_figure(LAYOUT.width, height * rows if count > 1 else LAYOUT.plane_alone * height)
    axes = [figure.add_subplot(rows, columns, index + 1, **more) for index in range(count)]
    return figure, axes


def draw_boundaries(axes: Axes, edges: Edges) -> None:
    """Draw the lines between the regimes; the limits of the axes cut off what is outside the plane."""
    for name, n0 in edges.n0_bar.items():
        label, style = BOUNDARIES[name]
        axes.plot(n0, edges.b_bar, color="black", linestyle=style, linewidth=1.0, label=label)


def finish_plane(axes: list[Axes], plane: ParameterPlane) -> None:
    """Limits of every panel, and the axes' labels at the outer ones only."""
    for index, one in enumerate(axes):
        one.set_xlim(plane.n0_range)
        one.set_ylim(plane.b_range)
        if index % 2 == 0:
            one.set_ylabel(B_LABEL)
        if index + 2 >= len(axes):
            one.set_xlabel(N0_LABEL)


def boundary_legend(figure: Figure) -> None:
    """Draws one legend of the regime boundaries, below all panels."""
    from matplotlib.lines import Line2D

    handles = [
        Line2D([], [], color="black", linestyle=style, linewidth=1.0, label=label)
        for label, style in BOUNDARIES.values()
    ]
    figure.legend(handles=handles, loc="outside lower center", ncols=3, handlelength=2.2, columnspacing=1.2)


def shared_range(values: list[FloatArray], signed: bool) -> tuple[float, float]:
    """Value range for all panels: from 0, or symmetric about it, to the largest value."""
    largest = max(float(np.max(np.abs(one))) for one in values)
    largest = largest if largest > 0.0 else 1.0
    return (-largest if signed else 0.0), largest
