"""The error of a table over the plane (n0_bar, b_bar) at one phase."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from fcm.contact.fourier import fourier_coefficients
from fcm.contact.surface import CELLS, COEFFICIENTS, Edges, ParameterPlane, boundaries, edges
from fcm.frozen import Frozen
from fcm.table.atlas import FloatArray
from fcm.table.error import Interpolant
from fcm.table.options import MAP_OPTIONS

CORNER = np.geomspace(1e-4, 0.1, 25)  # distances from b_bar = 1 of additional points


class ErrorMap(Frozen):
    """Absolute error of one coefficient against its closed form, at the midpoint of each cell of a plane."""

    coefficient: str
    plane: ParameterPlane
    n0_bar: FloatArray  # (i + 1,) [-] edges of the cells
    b_bar: FloatArray  # (j + 1,) [-]
    error: FloatArray  # (j, i) [-]
    edges: Edges  # between the regimes
    worst: tuple[float, float]  # n0_bar and b_bar of the greatest error
    largest: float  # the error there [-]


def error_map(
    coefficient: str, plane: ParameterPlane, table: Interpolant, steps: tuple[int, int] = CELLS
) -> ErrorMap:
    """The error of a table in one of COEFFICIENTS; its maximum is also sought between the midpoints."""

    def error_at(n0: FloatArray, b: FloatArray) -> FloatArray:
        index = COEFFICIENTS.index(coefficient)
        return np.abs(table(n0, b, plane.phi)[index] - fourier_coefficients(n0, b, plane.phi)[index])

    n0, b = plane.centres(steps)
    error = error_at(n0[None, :], b[:, None])
    step = (n0[1] - n0[0], b[1] - b[0])
    starts = _peaks(error, *np.broadcast_arrays(n0[None, :], b[:, None]))
    places = _points_near_boundaries(plane)
    starts += _peaks(error_at(*places), *places)
    worst, largest = max((_zoomed(error_at, plane, at, step) for at in starts), key=lambda one: one[1])
    return ErrorMap(coefficient, plane, *plane.nodes(steps), error, edges(plane), worst, largest)


def _zoomed(
    error_at: Callable[[FloatArray, FloatArray], FloatArray],
    plane: ParameterPlane,
    at: tuple[float, float],
    step: tuple[float, float],
) -> tuple[tuple[float, float], float]:
    """The greatest error near a point, within a step of it and then within ever smaller ones."""
    largest = 0.0
    for shrink in MAP_OPTIONS.finer ** -np.arange(float(MAP_OPTIONS.zooms)):
        axes = (
            np.clip(x + h * shrink * np.linspace(-1.0, 1.0, 2 * MAP_OPTIONS.finer + 1), *ends)
            for x, h, ends in zip(at, step, (plane.n0_range, plane.b_range), strict=True)
        )
        n0, b = np.meshgrid(*axes)
        at, largest = _greatest(error_at(n0, b), n0, b)
    return at, largest


def _points_near_boundaries(plane: ParameterPlane) -> tuple[FloatArray, FloatArray]:
    """Points (j, i) graded towards b_bar = 1 and the lines between the regimes, where errors have ridges."""
    low, high = plane.b_range
    rows = np.concatenate([np.linspace(low, high, MAP_OPTIONS.rows), 1.0 + CORNER, 1.0 - CORNER])
    rows = np.unique(np.clip(rows, low, high))
    lines = np.stack([*boundaries(rows, plane.phi).values()], axis=1)  # (j, line)
    share = 0.5 - 0.5 * np.cos(np.linspace(0.0, np.pi, MAP_OPTIONS.boundary_points))
    between = lines[:, :-1, None] + np.diff(lines, axis=1)[:, :, None] * share
    n0 = np.clip(between.reshape(len(rows), -1), *plane.n0_range)
    return n0, np.broadcast_to(rows[:, None], n0.shape)


def _peaks(error: FloatArray, n0: FloatArray, b: FloatArray) -> list[tuple[float, float]]:
    """Places of the greatest error in those rows of points that are worse than their neighbours."""
    of_row = error.max(axis=1)
    padded = np.pad(of_row, 1)
    rows = np.flatnonzero((of_row >= padded[:-2]) & (of_row >= padded[2:]))
    rows = rows[np.argsort(of_row[rows])[-MAP_OPTIONS.starts :]]
    columns = error[rows].argmax(axis=1)
    return [(float(n0[place]), float(b[place])) for place in zip(rows, columns, strict=True)]


def _greatest(error: FloatArray, n0: FloatArray, b: FloatArray) -> tuple[tuple[float, float], float]:
    """Place (n0, b) and value of the greatest error."""
    index = np.unravel_index(np.argmax(error), error.shape)
    return (float(n0[index]), float(b[index])), float(error[index])
