"""The arrays of a table file, and their conversion from and to reduced coefficients.

A table is one grid of nodes (level, variation, phase). Levels go from fully open (n0_bar = -b_bar) through
separation to its onset (n0_bar = b_bar), and on through slip to the slip limit. At every node the file has
n0_bar, b_bar, phi and the coefficients F_b, F_s, F_c. Reduced coefficients are F over the factor of `atlas`.
Where both vanish, the file has the reduced ones as well: ``ratio`` on b_bar = 0 and ``slope`` in slip.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from fcm.table.atlas import FloatArray
from fcm.table.partial_table import TablePart

Arrays = dict[str, npt.NDArray[Any]]

COEFFICIENTS = {"b": "mean", "s": "sine (stiffness)", "c": "cosine (damping)"}
GRID = ("level", "variation", "phase")
VARIABLES: dict[str, tuple[tuple[str, ...], dict[str, str]]] = {
    "n0_bar": (GRID, {"long_name": "preload mu n_0 / (k_u a)", "units": "1"}),
    "b_bar": (GRID[1:], {"long_name": "normal load variation mu k_v b / (k_u a)", "units": "1"}),
    "phi": (GRID[2:], {"long_name": "phase of normal before tangential motion", "units": "radian"}),
}
for _k, _what in COEFFICIENTS.items():
    VARIABLES[f"F_{_k}"] = (
        GRID,
        {
            "long_name": f"{_what} coefficient of the friction force over k_u a",
            "units": "1",
            "coordinates": "n0_bar b_bar phi",
        },
    )
    VARIABLES[f"ratio_{_k}"] = (
        ("level_open", "phase"),
        {"long_name": f"limit of F_{_k} / b_bar in separation as b_bar vanishes", "units": "1"},
    )
    VARIABLES[f"slope_{_k}"] = (
        ("level_slip", *GRID[1:]),
        {"long_name": f"F_{_k} less its value at the slip limit, over the width of slip", "units": "1"},
    )


def encode(separation: FloatArray, slip: FloatArray, part: TablePart | None = None) -> Arrays:
    """The arrays of the file, from the reduced coefficients of the two charts, shapes (3, nu, nx, nz).

    A chart without nodes in the part has no arrays of its own.
    """
    from fcm.contact import fourier_coefficients
    from fcm.table.nodes import all_nodes

    part = part or _all_of(separation, slip)
    nodes = all_nodes(part)
    arrays: Arrays = {"n0_bar": nodes.n0_bar, "b_bar": nodes.b_bar[0], "phi": nodes.phi[0, 0]}
    F = fourier_coefficients(*nodes)
    for k, name in enumerate(COEFFICIENTS):
        arrays[f"F_{name}"] = F[k].astype(np.float32)
        if separation.size and part.variation[0] == 0:
            arrays[f"ratio_{name}"] = separation[k, ::-1, 0].astype(np.float32)
        if slip.size:
            arrays[f"slope_{name}"] = slip[k].astype(np.float32)
    return arrays


def decode(arrays: Arrays, part: TablePart) -> tuple[FloatArray, FloatArray]:
    """The reduced coefficients of the two charts: the inverse of `encode`, up to rounding."""
    F = np.stack([arrays[f"F_{name}"] for name in COEFFICIENTS])
    levels = part.separation[1] - part.separation[0]
    separation = np.empty((3, levels, *F.shape[2:]))
    first = int("ratio_b" in arrays)
    if first:
        separation[:, :, 0] = np.stack([arrays[f"ratio_{name}"] for name in COEFFICIENTS])
    b = arrays["b_bar"][first:]
    if levels:
        np.multiply(F[:, :levels, first:], (1.0 + b) / b, out=separation[:, :, first:])
    if "slope_b" not in arrays:
        return separation[:, ::-1], np.empty((3, 0, *F.shape[2:]))
    slope = np.stack([arrays[f"slope_{name}"] for name in COEFFICIENTS])
    return separation[:, ::-1], slope.astype(np.float64)


def expected(part: TablePart) -> set[str]:
    """The variables of a file with the nodes of a part."""
    left_out = {"ratio": part.variation[0] > 0 or part.separation[1] == 0, "slope": part.slip[1] == 0}
    return {key for key in VARIABLES if not left_out.get(key.split("_")[0], False)}


def _all_of(separation: FloatArray, slip: FloatArray) -> TablePart:
    nodes = separation.shape[1], slip.shape[1], *slip.shape[2:]
    return TablePart.all_of((nodes[0], nodes[1], nodes[2], nodes[3]))
