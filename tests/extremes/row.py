"""One scene of the catalogue measured, in every respect that `verdict` judges."""

from __future__ import annotations

import time
from dataclasses import dataclass, field

import numpy as np

from fcm.response import Curve, trace
from fcm.scene import bundled_scenes, load_scene

from .beside import Beside, beside_exact
from .conditioning import condition_number
from .residual import BALANCED, Unbalanced, unbalanced

COLLECTION = "extreme/"


@dataclass
class Row:
    """A scene of the catalogue measured; frequencies in rad/s, errors relative."""

    name: str  # without the collection
    title: str
    complete: bool
    reason: str  # why it is not complete
    points: int
    seconds: float  # by the table, all included
    residual: float  # greatest along the curve, measured by what is allowed there
    tolerance: float  # at that point
    table: float  # greatest difference of peaks and folds by table and by closed form
    condition: float
    exact: list[Beside] = field(default_factory=list)

    @property
    def compared(self) -> list[Beside]:
        """The points at which an exact motion was found."""
        return [point for point in self.exact if np.isfinite(point.difference)]


def catalogue() -> tuple[str, ...]:
    """Names of the stiff and extreme scenes, without that of their collection.

    >>> "stiff-normal" in catalogue()
    True
    """
    return tuple(name.removeprefix(COLLECTION) for name in bundled_scenes() if name.startswith(COLLECTION))


def measured(name: str) -> Row:
    """Measure one scene of the catalogue.

    >>> row = measured("slip-limit-met")
    >>> row.complete, row.residual < 1e-12, row.table < 1e-12
    (True, True, True)
    """
    scene = load_scene(COLLECTION + name)
    begin = time.perf_counter()
    by_table = trace(scene).curves[0]
    seconds = time.perf_counter() - begin
    curve = trace(scene, "closed-form").curves[0]
    residual, tolerance = _greatest(unbalanced(scene, curve))
    return Row(
        name=name,
        title=scene.title,
        complete=by_table.complete and curve.complete,
        reason=by_table.reason or curve.reason,
        points=by_table.points,
        seconds=seconds,
        residual=residual,
        tolerance=tolerance,
        table=difference(by_table, curve),
        condition=condition_number(scene, curve),
        exact=beside_exact(scene, curve),
    )


def _greatest(left: Unbalanced) -> tuple[float, float]:
    """The residual that is greatest against what is allowed, and the tolerance at that point."""
    if left.force.size == 0:
        return float("nan"), float("nan")
    worst = int((left.force / (BALANCED + left.tolerance)).argmax())
    return float(left.force[worst]), float(left.tolerance[worst])


def difference(one: Curve, other: Curve) -> float:
    """Greatest relative difference of peaks and folds; infinite where there are not as many folds.

    The unit of a peak is the greatest of all degrees of freedom, so that one which does not move is none.
    """
    if len(one.folds) != len(other.folds) or not (one.points and other.points):
        return float("inf")
    peaks = np.array([[curve.peaks[dof][0] for dof in other.peaks] for curve in (one, other)])
    folds = np.array([one.folds, other.folds])
    apart = np.abs(peaks[0] - peaks[1]).max() / max(float(peaks[1].max()), np.finfo(np.float64).tiny)
    return float(max(apart, (np.abs(folds[0] - folds[1]) / folds[1]).max(initial=0.0)))
