"""The error of a table over the plane (n0_bar, b_bar) at one phase."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fcm.contact.fourier import fourier_coefficients
from fcm.contact.surface import CELLS, COEFFICIENTS, Edges, Plane, edges
from fcm.table.atlas import FloatArray
from fcm.table.measure import Interpolant

ZOOMS = 4  # times that the worst point is looked for on a finer grid around it
FINER = 10  # steps to each side of such a grid, as wide as one step of the grid before


@dataclass(frozen=True)
class ErrorMap:
    """Absolute difference of one coefficient from its closed form, in the middle of each cell of a plane."""

    coefficient: str
    plane: Plane
    n0_bar: FloatArray  # (i + 1,) [-] edges of the cells
    b_bar: FloatArray  # (j + 1,) [-]
    error: FloatArray  # (j, i) [-]
    edges: Edges  # between the regimes
    worst: tuple[float, float]  # n0_bar and b_bar of the greatest error
    largest: float  # the error there [-]


def error_map(coefficient: str, plane: Plane, table: Interpolant, steps: tuple[int, int] = CELLS) -> ErrorMap:
    """The error of a table in one of COEFFICIENTS; its greatest is sought between the cells' middles too."""
    n0, b = plane.centres(steps)
    error = _error(coefficient, plane.phi, table, n0, b)
    worst, largest = _greatest(error, n0, b)
    step_n0, step_b = n0[1] - n0[0], b[1] - b[0]
    for _ in range(ZOOMS):
        near_n0 = np.clip(worst[0] + step_n0 * np.linspace(-1, 1, 2 * FINER + 1), *plane.n0_range)
        near_b = np.clip(worst[1] + step_b * np.linspace(-1, 1, 2 * FINER + 1), *plane.b_range)
        worst, largest = _greatest(_error(coefficient, plane.phi, table, near_n0, near_b), near_n0, near_b)
        step_n0, step_b = step_n0 / FINER, step_b / FINER
    return ErrorMap(coefficient, plane, *plane.nodes(steps), error, edges(plane), worst, largest)


def _error(coefficient: str, phi: float, table: Interpolant, n0: FloatArray, b: FloatArray) -> FloatArray:
    index = COEFFICIENTS.index(coefficient)
    at = n0[None, :], b[:, None], phi
    error: FloatArray = np.abs(table(*at)[index] - fourier_coefficients(*at)[index])
    return error


def _greatest(error: FloatArray, n0: FloatArray, b: FloatArray) -> tuple[tuple[float, float], float]:
    row, column = np.unravel_index(np.argmax(error), error.shape)
    return (float(n0[column]), float(b[row])), float(error[row, column])
