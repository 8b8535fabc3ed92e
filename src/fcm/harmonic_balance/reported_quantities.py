"""Quantities reported at the points of traced paths: displacements, amplitudes, contact forces."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from fcm.continuation import Path
from fcm.continuation.corrector import distances
from fcm.frozen import Frozen
from fcm.harmonic_balance.residual import PointQuantities
from fcm.harmonic_balance.system import System
from fcm.model.scene import FloatArray

IntArray = npt.NDArray[np.intp]
ComplexArray = npt.NDArray[np.complex128]


class PointRecord(Frozen):
    """Points of several paths, concatenated; x(theta) = mean + Re sum_j X_j exp(i h_j theta)."""

    path: IntArray  # (point,) number of the path
    z: FloatArray  # (point, unknown + 1)
    mark: npt.NDArray[np.int64]  # (point,)
    X: ComplexArray  # (point, harmonic, dof)
    mean: FloatArray  # (point, dof)
    amplitude: FloatArray  # (point, dof) half the peak-to-peak
    force: FloatArray  # (point, unknown) of the contacts, laid out as the unknowns
    tangent: FloatArray  # (point, unknown + 1) along the path
    orientation: FloatArray  # (point,)
    linear: npt.NDArray[np.bool_]  # (point,) where no contact slips or separates


class ReportedQuantities(Frozen):
    """The quantities reported along a path, with the shapes of `PointRecord`.

    growth (point, dof): rate of the amplitude along the path's direction. linear (point,): where no contact
    slips or separates.
    """

    X: ComplexArray
    mean: FloatArray
    amplitude: FloatArray
    force: FloatArray
    growth: FloatArray
    linear: npt.NDArray[np.bool_]

    def with_rows(self, after: IntArray, other: ReportedQuantities) -> ReportedQuantities:
        """The quantities, with each point of other inserted after a point of this one."""
        rows = zip(vars(self).values(), vars(other).values(), strict=True)
        return ReportedQuantities(*(np.insert(mine, after + 1, its, axis=0) for mine, its in rows))

    def part(self, rows: slice | IntArray) -> ReportedQuantities:
        """The quantities at some points."""
        return ReportedQuantities(*(mine[rows] for mine in vars(self).values()))


def reported_quantities(system: System, path: Path) -> ReportedQuantities:
    """The reported quantities at the points of a path."""
    return reported_at(system, path.z, path.direction)


def reported_at(
    system: System, z: FloatArray, direction: FloatArray | None = None, level: FloatArray | None = None
) -> ReportedQuantities:
    """The reported quantities at points z (point, unknown + 1).

    direction (point, unknown + 1): without it growth is 0. level (point,): factor of the harmonic forces, 1
    by default.
    """
    points = PointQuantities(system.shared_balance, len(z))
    along = np.zeros_like(z) if direction is None else direction
    times = np.ones(len(z)) if level is None else np.ascontiguousarray(level)
    points.evaluate(np.ascontiguousarray(z), along, times)
    X = np.empty(np.shape(points.re), dtype=np.complex128)
    X.real, X.imag = points.re, points.im
    return ReportedQuantities(
        X=X,
        mean=np.asarray(points.mean),
        amplitude=np.asarray(points.amplitude),
        force=np.asarray(points.force),
        growth=np.asarray(points.growth),
        linear=np.asarray(points.linear) > 0,
    )


def recorded(
    system: System, paths: Sequence[Path], quantities: Sequence[ReportedQuantities] | None = None
) -> PointRecord:
    """The record of the points of paths; quantities (one for each path) are computed if not given."""
    z = np.concatenate([path.z for path in paths])
    if quantities is None:
        quantities = [reported_quantities(system, path) for path in paths]
    X, mean, amplitude, force, linear = (
        joined([getattr(one, name) for one in quantities])
        for name in ("X", "mean", "amplitude", "force", "linear")
    )
    number = np.repeat(np.arange(len(paths)), [path.z.shape[0] for path in paths])
    names = ("mark", "direction", "orientation")
    mark, tangent, orientation = (np.concatenate([getattr(p, name) for p in paths]) for name in names)
    return PointRecord(number, z, mark, X, mean, amplitude, force, tangent, orientation, linear)


def table_errors(system: System, points: PointRecord) -> FloatArray:
    """Errors (point,) that the table alone would make: the length of one Newton step of its balance.

    They are relative to the size of the unknowns; 0 where no contact slips or separates, or without a table.
    """
    error = np.zeros(points.path.size)
    if system.table_balance is None:
        return error
    system.table_balance.reset_balance()
    slips = ~points.linear
    z, tangent = (np.ascontiguousarray(of[slips]) for of in (points.z, points.tangent))
    # the scale of an unknown is the size times the root of the number of ports
    error[slips] = distances(system.table_balance.shared_stepper.newton, z, tangent) * np.sqrt(
        system.layout.ports
    )
    return error


def joined(parts: list[npt.NDArray[Any]]) -> npt.NDArray[Any]:
    """Concatenate arrays; a single array is not copied."""
    return parts[0] if len(parts) == 1 else np.concatenate(parts)
