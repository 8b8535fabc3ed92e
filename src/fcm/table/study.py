"""Comparison of layouts: the error of a table, by its size and the time of a look-up.

*rectilinear* is the usual grid of F on a box in n0_bar, b_bar, phi; *regimes* is the atlas. Each is measured
with linear interpolation (scipy's) and cubic splines (ours), and so is the closed form. All use the same
points, those of `fcm.table.error.sample` that lie in the box.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from fcm.contact import fourier_coefficients
from fcm.table import spline
from fcm.table.atlas import FloatArray
from fcm.table.build import charts
from fcm.table.error import sample
from fcm.table.lookup import Table
from fcm.table.nodes import PRESETS
from fcm.table.options import STUDY_OPTIONS, StudyOptions
from fcm.table.partial_table import TablePart
from fcm.table.tabulated import NODES_BETWEEN, Cubic, Resolution, locate

Coefficients = Callable[[FloatArray, FloatArray, FloatArray], Any]
Progress = Callable[[float, str], None]


class Row(NamedTuple):
    """Result of one layout at one resolution: errors [-], and time [us] of a small look-up and of a point.

    The errors are the maximum, the 99.9 % quantile and the rms.
    """

    layout: str
    interpolation: str
    nodes: int
    bytes: int
    max: float
    p999: float
    rms: float
    us_of_group: float
    us_per_point: float


def study(progress: Progress | None = None, options: StudyOptions = STUDY_OPTIONS) -> list[Row]:
    """Measure every layout at every resolution; takes half a minute."""
    n0, b, phi = sample(options.points, seed=2024)
    inside = (np.abs(n0) <= options.box) & (b <= options.box)
    points = n0[inside], b[inside], phi[inside]
    exact = np.stack(fourier_coefficients(*points))
    rows: list[Row] = []
    count = 4 * len(options.shares) + 1
    for layout, interpolation, nodes, coefficients in _candidates(options):
        if progress is not None:
            progress(len(rows) / count, f"{layout} {interpolation}")
        error = np.abs(np.stack(coefficients(*points)) - exact)
        rms = float(np.sqrt(np.mean(error * error)))
        rows.append(
            Row(
                layout, interpolation, nodes, 12 * nodes,
                float(error.max()), float(np.quantile(error, 0.999)), rms,
                _seconds(coefficients, points, options.group, 100, options.repeats) * 1e6,
                _seconds(coefficients, points, points[0].size, 1, options.repeats) / points[0].size * 1e6,
            )
        )  # fmt: skip
    return rows


def _seconds(
    coefficients: Coefficients, points: tuple[FloatArray, ...], count: int, calls: int, repeats: int
) -> float:
    """Least time [s] of a look-up of the first `count` points."""
    some = [x[:count] for x in points]
    best = np.inf
    for _ in range(repeats):
        began = time.perf_counter()
        for _ in range(calls):
            coefficients(*some)
        best = min(best, (time.perf_counter() - began) / calls)
    return float(best)


def _candidates(options: StudyOptions) -> Iterator[tuple[str, str, int, Coefficients]]:
    """Yield layout, interpolation, number of nodes and look-up function, resolution by resolution."""
    for share in options.shares:
        resolution = _scaled(PRESETS["default"], share)
        nodes = (resolution[0] + resolution[1]) * resolution[2] * resolution[3]
        shape = _box_shape(nodes)
        values = _box_values(shape, options.box)
        yield "rectilinear", "linear", values[0].size, _box_linear(values, options.box)
        yield "rectilinear", "cubic", values[0].size, _box_cubic(values, options.box)
        parts = charts(TablePart.all_of(resolution))
        yield "regimes", "linear", nodes, _regimes_linear(resolution, *parts)
        yield "regimes", "cubic", nodes, Table(*parts)
    yield "closed form", "", 0, fourier_coefficients


def _scaled(resolution: Resolution, share: float) -> Resolution:
    first, second, third, fourth = (max(5, 2 * round(share * (n - 1) / 2) + 1) for n in resolution)
    return first, second, third, fourth


def _box_shape(nodes: int) -> tuple[int, int, int]:
    """Odd numbers of nodes in the ratio of 4 to 2 to 1, with about `nodes` nodes in all."""
    side = (nodes / 8.0) ** (1.0 / 3.0)
    first, second, third = (2 * round(factor * side / 2) + 1 for factor in (4, 2, 1))
    return first, second, third


def _box_axes(shape: tuple[int, ...], box: float) -> list[FloatArray]:
    limits = ((-box, box), (0.0, box), (0.0, np.pi))
    return [np.linspace(*limit, count) for limit, count in zip(limits, shape, strict=True)]


def _box_values(shape: tuple[int, int, int], box: float) -> FloatArray:
    return np.stack(fourier_coefficients(*np.meshgrid(*_box_axes(shape, box), indexing="ij")))


def _linear(axes: list[FloatArray], values: FloatArray) -> Callable[[FloatArray], FloatArray]:
    from scipy.interpolate import RegularGridInterpolator

    inner = RegularGridInterpolator(axes, np.ascontiguousarray(np.moveaxis(values, 0, -1)))

    def at(points: FloatArray) -> FloatArray:
        return np.asarray(inner(points.T)).T

    return at


def _fold(phi: FloatArray) -> tuple[FloatArray, FloatArray]:
    """phi modulo pi, and the sign of F_b that belongs to it."""
    turns, folded = np.divmod(phi, np.pi)
    return folded, 1.0 - 2.0 * np.mod(turns, 2.0)


def _signed(F: FloatArray, sign: FloatArray) -> FloatArray:
    F[0] *= sign
    return F


def _box_linear(values: FloatArray, box: float) -> Coefficients:
    at = _linear(_box_axes(values.shape[1:], box), values)

    def coefficients(n0: FloatArray, b: FloatArray, phi: FloatArray) -> FloatArray:
        folded, sign = _fold(phi)
        return _signed(at(np.array((n0, b, np.clip(folded, 0.0, np.pi)))), sign)

    return coefficients


def _box_cubic(values: FloatArray, box: float) -> Coefficients:
    shape = values.shape[1:]
    cubic = Cubic(spline.stack(spline.interpolate(values, ((spline.FREE, spline.FREE),) * 3)))
    ends = [(axis[0], (axis.size - 1) / (axis[-1] - axis[0])) for axis in _box_axes(shape, box)]

    def coefficients(n0: FloatArray, b: FloatArray, phi: FloatArray) -> FloatArray:
        folded, sign = _fold(phi)
        q = np.array([(x - start) * per for x, (start, per) in zip((n0, b, folded), ends, strict=True)])
        return _signed(cubic.many(np.maximum(q, 0.0), False)[:, 0], sign)

    return coefficients


def _regimes_linear(resolution: Resolution, separation: FloatArray, slip: FloatArray) -> Coefficients:
    """The charts in sequence along u, with a gap between them that contains no point."""
    gap = np.zeros_like(separation[:, : NODES_BETWEEN - 1])
    values = np.concatenate((separation, gap, slip), axis=1)
    at = _linear([np.arange(float(count)) for count in values.shape[1:]], values)
    last = np.array(values.shape[1:])[:, None] - 1.0

    def coefficients(n0: FloatArray, b: FloatArray, phi: FloatArray) -> FloatArray:
        place = locate(np.stack((n0, b, phi)), resolution)
        G = at(np.clip(place.q, 0.0, last))
        return _signed(G * place.scale + place.base, place.sign)

    return coefficients


def order(rows: list[Row], layout: str, interpolation: str) -> float:
    """Order of convergence of the rms error in the number of nodes along an axis."""
    chosen = [row for row in rows if (row.layout, row.interpolation) == (layout, interpolation)]
    nodes: npt.NDArray[np.float64] = np.log([row.nodes for row in chosen]) / 3.0
    return float(-np.polyfit(nodes, np.log([row.rms for row in chosen]), 1)[0])
