"""Quantities that are reported along a path: displacements, amplitudes, contact forces."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from fcm.continuation import Path
from fcm.frozen import Frozen
from fcm.harmonic_balance.residual import PointQuantities
from fcm.harmonic_balance.system import System
from fcm.model.scene import FloatArray

ComplexArray = npt.NDArray[np.complex128]


class ReportedQuantities(Frozen):
    """The quantities reported along a path, as of a `PointRecord`.

    growth (point, dof): of the amplitude along the path's direction. linear (point,): where no contact slips
    or separates.
    """

    X: ComplexArray
    mean: FloatArray
    amplitude: FloatArray
    force: FloatArray
    growth: FloatArray
    linear: npt.NDArray[np.bool_]

    def with_rows(self, after: npt.NDArray[np.intp], other: ReportedQuantities) -> ReportedQuantities:
        """The quantities with those at the points of another inserted after some points."""
        rows = zip(vars(self).values(), vars(other).values(), strict=True)
        return ReportedQuantities(*(np.insert(mine, after + 1, its, axis=0) for mine, its in rows))

    def part(self, rows: slice | npt.NDArray[np.intp]) -> ReportedQuantities:
        """The quantities at some points."""
        return ReportedQuantities(*(mine[rows] for mine in vars(self).values()))


def reported_quantities(system: System, path: Path) -> ReportedQuantities:
    """The reported quantities at the points of a path."""
    return reported_at(system, path.z, path.direction)


def reported_at(system: System, z: FloatArray, direction: FloatArray) -> ReportedQuantities:
    """The reported quantities at points z with directions there, both (point, unknown + 1)."""
    points = PointQuantities(system.shared_balance, len(z))
    points.evaluate(z, direction, np.ones(len(z)))
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
