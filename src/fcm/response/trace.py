"""From a scene to its response: start, follow, correct with the closed form, locate folds and peaks."""

from __future__ import annotations

import time
from collections.abc import Callable
from itertools import pairwise

import numpy as np

from fcm.contact.limits import FloatArray
from fcm.contact.loop import sequences
from fcm.response.balance import Balance
from fcm.response.displacement import amplitude_growth, displacements
from fcm.response.extrema import Segments, fold_rate, locate, peak_rate
from fcm.response.law import ClosedForm, Coefficients
from fcm.response.path import (
    COMPLETE,
    REASONS,
    STALLED,
    BoolArray,
    Trace,
    amplitudes,
    correct,
    follow,
    scales,
)
from fcm.response.result import Curve, Response
from fcm.response.start import starting_points
from fcm.response.structure import IntArray, group_of
from fcm.scene.model import Scene

METHODS = ("table", "closed-form")
EXACT = 1e-9  # a last Newton step this short leaves a residual at rounding level
Progress = Callable[[float, str], None]


class ResponseError(ValueError):
    """The calculation cannot be begun; the message says why."""


def trace(
    scene: Scene,
    method: str = "table",
    table: Coefficients | None = None,
    progress: Progress | None = None,
) -> Response:
    """Trace the response curves of a scene.

    Parameters
    ----------
    scene : Scene
        From `fcm.load_scene`; one curve for each combination of its swept values.
    method : {"table", "closed-form"}
        Coefficients that the solver uses on its way. Either way every point is then corrected with the
        closed form; the shift is its `table_error`.
    table : optional
        An open table; the shipped one by default.
    progress : optional
        Called now and then with the finished fraction and a text.

    Raises
    ------
    ResponseError
        If the method is unknown.
    """
    if method not in METHODS:
        raise ResponseError(f"method {method!r} is not one of {', '.join(METHODS)}")
    begin = time.perf_counter()
    curves = scene.each_curve()
    group = group_of(curves)
    exact = Balance(group, ClosedForm())
    used = exact if method == "closed-form" else Balance(group, table or _default_table())
    path, lost = _follow(used, np.array([c.max_step for c in curves]), progress)
    z, direction, shift = _with_closed_form(exact, path)
    table_error = _relative_shift(exact, path, z, shift) if used is not exact else np.zeros(len(z))
    made = _Assembly(exact, path, z, direction, np.where(shift, table_error, np.nan), lost)
    results = made.curves(curves, scene.modal.dofs)
    response = Response(
        scene.title, scene.modal.dofs, tuple(c.name for c in scene.contacts), results, method,
        scene.frequency_unit,
    )  # fmt: skip
    response.seconds = time.perf_counter() - begin
    share = response.seconds / max(sum(c.points for c in results), 1)
    for curve in results:  # curves advance together: each is charged by its points
        curve.seconds = share * curve.points
    return response


def _default_table() -> Coefficients:
    from fcm.table import open_table

    return open_table()


def _follow(balance: Balance, max_step: FloatArray, progress: Progress | None) -> tuple[Trace, BoolArray]:
    """Trace all curves; those without a starting point are lost and have no points."""
    low, high = (np.broadcast_to(x, max_step.shape).copy() for x in (balance.group.low, balance.group.high))
    x, found = starting_points(balance, low)
    some = np.flatnonzero(found)
    unknowns = x.shape[1] + 1
    status = np.full(max_step.size, STALLED)
    if some.size == 0:
        nothing = np.empty((0, unknowns))
        return Trace(np.empty(0, dtype=np.intp), nothing, nothing, status, max_step, 0), ~found
    z = np.column_stack((x[some], low[some]))
    path = follow(balance.take(some), z, low[some], high[some], max_step[some], progress)
    status[some] = path.status
    return Trace(some[path.curve], path.z, path.direction, status, path.last_step, path.ticks), ~found


def _with_closed_form(exact: Balance, path: Trace) -> tuple[FloatArray, FloatArray, BoolArray]:
    """Every point corrected along the normal of its curve; where that fails the point stays, marked False."""
    x = path.z[:, :-1]
    if x.shape[0] == 0:
        return path.z, path.direction, np.zeros(0, dtype=bool)
    extent = np.broadcast_to(exact.group.high - exact.group.low, path.status.shape)[path.curve]
    scale = scales(x, amplitudes(x), extent)
    row = path.direction / scale
    row /= np.sqrt((row * row).sum(axis=1, keepdims=True))
    new = correct(exact.take(path.curve), path.z, scale, row, close=EXACT, iterations=12)
    good = new.converged
    z = np.where(good[:, None], new.z, path.z)
    return z, np.where(good[:, None], scale * new.tangent, path.direction), good


def _relative_shift(exact: Balance, path: Trace, z: FloatArray, good: BoolArray) -> FloatArray:
    """Greatest shift of a degree of freedom by the correction, relative to the greatest amplitude."""
    balance = exact.take(path.curve)
    before, _ = displacements(balance, path.z[:, :-1], path.z[:, -1])
    after, _ = displacements(balance, z[:, :-1], z[:, -1])
    size = np.abs(after).max(axis=1)
    shift: FloatArray = np.abs(after - before).max(axis=1) / np.where(size > 0.0, size, 1.0)
    return shift


class _Assembly:
    """Corrected points of all curves, made into results."""

    def __init__(
        self,
        exact: Balance,
        path: Trace,
        z: FloatArray,
        direction: FloatArray,
        table_error: FloatArray,
        lost: BoolArray,
    ) -> None:
        self.exact, self.path, self.z, self.direction = exact, path, z, direction
        self.table_error, self.lost = table_error, lost
        self.extent = np.broadcast_to(exact.group.high - exact.group.low, path.status.shape)
        at_points = exact.take(path.curve)
        self.X, self.mean = displacements(at_points, z[:, :-1], z[:, -1])
        arguments = at_points.law.arguments(z[:, :-1].reshape(z.shape[0], -1, 5))
        self.regime = sequences(*arguments)
        self.same = path.curve[1:] == path.curve[:-1]  # whether a point and the next are of one curve

    def curves(self, scenes: tuple[Scene, ...], dofs: tuple[str, ...]) -> list[Curve]:
        folds, fold_curve = self._folds()
        bounds = np.searchsorted(self.path.curve, np.arange(len(scenes) + 1))
        peaks = self._peaks(bounds)
        results = []
        for i, scene in enumerate(scenes):
            part = slice(bounds[i], bounds[i + 1])
            status = int(self.path.status[i])
            results.append(
                Curve(
                    parameters=dict(scene.parameters),
                    frequency=self.z[part, -1],
                    amplitude=np.abs(self.X[part]),
                    phase=np.angle(self.X[part]),
                    mean=self.mean[part],
                    regime=self.regime[part, : len(scene.contacts)],
                    table_error=self.table_error[part],
                    complete=status == COMPLETE,
                    reason=self._reason(i, status, bounds),
                    peaks={d: (float(peaks[i, j, 0]), float(peaks[i, j, 1])) for j, d in enumerate(dofs)},
                    folds=[float(w) for w in folds[fold_curve == i]],
                    seconds=0.0,
                )
            )
        return results

    def _reason(self, curve: int, status: int, bounds: IntArray) -> str:
        if self.lost[curve]:
            return "no solution was found at the low end of the range; try another frequency to begin with"
        where = "" if status == COMPLETE else f"stopped at {self.z[bounds[curve + 1] - 1, -1]:.8g} rad/s: "
        return where + REASONS[status]

    def _folds(self) -> tuple[FloatArray, IntArray]:
        """Frequencies of the folds in order along the curves, and the curve of each."""
        rate = self.direction[:, -1]
        at = np.flatnonzero(self.same & (np.sign(rate[1:]) * np.sign(rate[:-1]) < 0.0))
        segments = self._segments(at, rate[at], rate[at + 1], np.zeros_like(at))
        return locate(self.exact, segments, fold_rate, self.extent)[:, -1], segments.curve

    def _peaks(self, bounds: IntArray) -> FloatArray:
        """(curve, dof, 2): amplitude and frequency of the greatest peak."""
        dofs = self.X.shape[1]
        peaks = np.full((bounds.size - 1, dofs, 2), np.nan)
        highest, column = self._highest(bounds)
        curve = self.path.curve[highest]
        peaks[curve, column, 0] = np.abs(self.X[highest, column])
        peaks[curve, column, 1] = self.z[highest, -1]
        growth = amplitude_growth(
            self.exact.take(curve), self.z[highest], self.direction[highest]
        )[np.arange(highest.size), column]  # fmt: skip
        first = np.where(
            growth > 0.0, highest, highest - 1
        )  # the peak lies after or before the highest point
        inside = (first >= bounds[curve]) & (first + 1 < bounds[curve + 1])
        first, column = first[inside], column[inside]
        rates = [
            amplitude_growth(self.exact.take(self.path.curve[k]), self.z[k], self.direction[k])[
                np.arange(k.size), column
            ]
            for k in (first, first + 1)
        ]
        bracket = (rates[0] > 0.0) & (rates[1] < 0.0)
        first, column = first[bracket], column[bracket]
        segments = self._segments(first, rates[0][bracket], rates[1][bracket], column)
        z = locate(self.exact, segments, peak_rate, self.extent)
        if z.shape[0]:
            X, _ = displacements(self.exact.take(segments.curve), z[:, :-1], z[:, -1])
            size = np.abs(X)[np.arange(column.size), column]
            better = size >= peaks[segments.curve, column, 0]
            peaks[segments.curve[better], column[better]] = np.column_stack((size, z[:, -1]))[better]
        return peaks

    def _highest(self, bounds: IntArray) -> tuple[IntArray, IntArray]:
        """Point of greatest amplitude of each degree of freedom on each curve, and the degree of freedom."""
        size = np.abs(self.X)
        points, columns = [], []
        for first, last in pairwise(bounds):
            if last > first:
                points.append(first + size[first:last].argmax(axis=0))
                columns.append(np.arange(size.shape[1]))
        empty = [np.empty(0, dtype=np.intp)]
        return np.concatenate(points or empty), np.concatenate(columns or empty)

    def _segments(self, at: IntArray, before: FloatArray, after: FloatArray, which: IntArray) -> Segments:
        return Segments(self.path.curve[at], self.z[at], self.z[at + 1], before, after, which)
