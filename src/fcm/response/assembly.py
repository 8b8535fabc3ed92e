"""Corrected points of all curves made into results: displacements, regimes, folds, peaks."""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from fcm.contact.limits import FloatArray
from fcm.response import drift
from fcm.response.balance import Balance
from fcm.response.branches import Branches, hang_together, outcome
from fcm.response.displacement import amplitude_growth, displacements
from fcm.response.extrema import locate, peak_rate
from fcm.response.law import UNKNOWNS
from fcm.response.path import REASONS, STALLED
from fcm.response.points import NEARLY_HIGHEST, Points
from fcm.response.regimes import regimes
from fcm.response.result import Curve
from fcm.response.structure import AnyArray, BoolArray, IntArray, unknown_contacts
from fcm.response.truncation import truncation_error
from fcm.scene.model import Scene
from fcm.units import in_unit


class Assembly:
    """Corrected points of all curves, and whether they are stable, made into results."""

    def __init__(self, exact: Balance, points: Points, stable: BoolArray, branches: Branches) -> None:
        self.exact, self.points, self.stable, self.branches = exact, points, stable, branches
        self.z = z = points.z
        at_points = exact.take(points.curve)
        self.X, self.mean = displacements(at_points, z[:, :-1], z[:, -1])
        x = z[:, :-1].reshape(z.shape[0], exact.group.contacts, UNKNOWNS)
        self.loop, self.regime = at_points.law.loops(x), regimes(at_points.law, x)
        self.truncation_error = truncation_error(at_points, z)
        self.undetermined = drift.undetermined(at_points, z)
        for without_rest in self.undetermined.values():
            self.stable = self.stable & ~without_rest
        self.same = hang_together(points.branch)

    def curves(self, scenes: tuple[Scene, ...], dofs: tuple[str, ...]) -> list[Curve]:
        bounds = np.searchsorted(self.points.curve, np.arange(len(scenes) + 1))
        peaks = self._peaks(bounds)
        results = []
        for i, scene in enumerate(scenes):
            part = self._with_gaps(bounds[i], bounds[i + 1])
            complete, status = outcome(self.branches, i)
            reason = "" if complete else self._reason(i, status, scene)
            if undetermined := self._undetermined(part[part >= 0], scene):
                complete, reason = False, undetermined
            results.append(
                Curve(
                    parameters=dict(scene.parameters),
                    frequency=_pick(self.z[:, -1], part),
                    amplitude=_pick(np.abs(self.X), part),
                    phase=_pick(np.angle(self.X), part),
                    mean=_pick(self.mean, part),
                    regime=_pick(self.regime[:, : unknown_contacts(scene)], part),
                    loop=_pick(self.loop[:, : unknown_contacts(scene)], part),
                    stable=_pick(self.stable, part),
                    table_error=_pick(self.points.shift, part),
                    truncation_error=_pick(self.truncation_error, part),
                    complete=complete,
                    reason=reason,
                    peaks={d: (float(peaks[i, j, 0]), float(peaks[i, j, 1])) for j, d in enumerate(dofs)},
                    folds=self.z[part[self.points.fold[part] & (part >= 0)], -1].tolist(),
                    seconds=0.0,
                )
            )
        return results

    def _with_gaps(self, first: int, last: int) -> IntArray:
        """Points of a curve, with -1 between its branches."""
        part = np.arange(first, last)
        return np.insert(part, np.flatnonzero(~self.same[first : max(last - 1, first)]) + 1, -1)

    def _reason(self, curve: int, status: int, scene: Scene) -> str:
        branch = np.flatnonzero((self.branches.curve == curve) & (self.branches.status == status))
        rigid = self.exact.group.frequency.min() == 0.0 and status == STALLED
        why = "; rigid-body modes are at rest only while closed contacts hold them" if rigid else ""
        if branch.size == 0:
            return f"no solution was found at either end of the range; try another range{why}"
        last = self.branches.trace.z[self.branches.trace.curve == branch[0], -1][-1]
        unit = scene.frequency_unit
        return f"stopped at {in_unit(last, unit):.8g} {unit}: {REASONS[status]}{why}"

    def _undetermined(self, part: IntArray, scene: Scene) -> str:
        """Where and why a curve's points are no steady states; empty if they are."""
        for why, which in self.undetermined.items():
            if which[part].any():
                frequency = in_unit(self.z[part[which[part]], -1], scene.frequency_unit)
                unit = scene.frequency_unit
                return f"from {frequency.min():.5g} to {frequency.max():.5g} {unit} {drift.REASONS[why]}"
        return ""

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


def _pick(values: AnyArray, part: IntArray) -> AnyArray:
    """Rows of a curve; where part is -1, a gap: NaN, '' or False."""
    rows = values[part]
    rows[part < 0] = {"f": np.nan, "U": "", "b": False}[values.dtype.kind]
    return rows
