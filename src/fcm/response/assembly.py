"""Corrected points of all curves made into results: displacements, regimes, folds, peaks."""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from fcm.contact.limits import FloatArray
from fcm.contact.loop import sequences
from fcm.response.balance import Balance
from fcm.response.displacement import amplitude_growth, displacements
from fcm.response.extrema import locate, peak_rate
from fcm.response.path import COMPLETE, REASONS, BoolArray
from fcm.response.points import NEARLY_HIGHEST, Points
from fcm.response.result import Curve
from fcm.response.stability import stable_points
from fcm.response.structure import IntArray
from fcm.response.truncation import truncation_error
from fcm.scene.model import Scene


class Assembly:
    """Corrected points of all curves, made into results."""

    def __init__(self, exact: Balance, points: Points, status: IntArray, lost: BoolArray) -> None:
        self.exact, self.points, self.status, self.lost = exact, points, status, lost
        self.z = z = points.z
        at_points = exact.take(points.curve)
        self.X, self.mean = displacements(at_points, z[:, :-1], z[:, -1])
        arguments = at_points.law.arguments(z[:, :-1].reshape(z.shape[0], exact.group.contacts, 5))
        self.regime = sequences(*arguments)
        self.truncation_error = truncation_error(at_points, z)
        self.stable = stable_points(at_points, z)
        self.same = points.curve[1:] == points.curve[:-1]  # whether a point and the next are of one curve

    def curves(self, scenes: tuple[Scene, ...], dofs: tuple[str, ...]) -> list[Curve]:
        bounds = np.searchsorted(self.points.curve, np.arange(len(scenes) + 1))
        peaks = self._peaks(bounds)
        results = []
        for i, scene in enumerate(scenes):
            part = slice(bounds[i], bounds[i + 1])
            status = int(self.status[i])
            results.append(
                Curve(
                    parameters=dict(scene.parameters),
                    frequency=self.z[part, -1],
                    amplitude=np.abs(self.X[part]),
                    phase=np.angle(self.X[part]),
                    mean=self.mean[part],
                    regime=self.regime[part, : len(scene.contacts)],
                    table_error=self.points.shift[part],
                    complete=status == COMPLETE,
                    reason=self._reason(i, status, bounds),
                    peaks={d: (float(peaks[i, j, 0]), float(peaks[i, j, 1])) for j, d in enumerate(dofs)},
                    folds=self.z[part, -1][self.points.fold[part]].tolist(),
                    seconds=0.0,
                    truncation_error=self.truncation_error[part],
                    stable=self.stable[part],
                )
            )
        return results

    def _reason(self, curve: int, status: int, bounds: IntArray) -> str:
        if self.lost[curve]:
            return "no solution was found at the low end of the range; try another frequency to begin with"
        where = "" if status == COMPLETE else f"stopped at {self.z[bounds[curve + 1] - 1, -1]:.8g} rad/s: "
        return where + REASONS[status]

    def _peaks(self, bounds: IntArray) -> FloatArray:
        """(curve, dof, 2): amplitude and frequency of the greatest peak."""
        size = np.abs(self.X)
        peaks = np.full((bounds.size - 1, size.shape[1], 2), np.nan)
        for i, (first, last) in enumerate(pairwise(bounds)):
            if last > first:
                highest = first + size[first:last].argmax(axis=0)
                peaks[i] = np.column_stack((size[highest, np.arange(size.shape[1])], self.z[highest, -1]))
        at, which, before, after = self._summits(size, peaks[:, :, 0])
        segments = self.points.segments(at, self.exact)
        z, _ = locate(self.exact, segments, peak_rate, before, after, which)
        X, _ = displacements(self.exact.take(segments.curve), z[:, :-1], z[:, -1])
        for point, curve, dof, value in zip(z, segments.curve, which, np.abs(X), strict=True):
            if value[dof] > peaks[curve, dof, 0]:
                peaks[curve, dof] = value[dof], point[-1]
        return peaks

    def _summits(
        self, size: FloatArray, highest: FloatArray
    ) -> tuple[IntArray, IntArray, FloatArray, FloatArray]:
        """Segments that hold a maximum of a degree of freedom which may be the greatest of its curve.

        Points where they begin, degrees of freedom, and growth at both ends.
        """
        curve = self.points.curve
        growth = amplitude_growth(self.exact.take(curve), self.z, self.points.direction)
        rises = (growth[:-1] > 0.0) & (growth[1:] < 0.0) & self.same[:, None]
        near = np.maximum(size[:-1], size[1:]) > NEARLY_HIGHEST * highest[curve[:-1]]
        at, dof = np.nonzero(rises & near)
        return at, dof, growth[at, dof], growth[at + 1, dof]
