"""Periodic solutions as a curve of a response: arrays over its points, peaks, folds."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import numpy.typing as npt

from fcm.contact.limits import FloatArray
from fcm.response.groups import lost_curve
from fcm.response.result import Curve, Orbits
from fcm.scene.model import Scene
from fcm.simulate.branch import Branch
from fcm.simulate.sample import Sample
from fcm.simulate.visit import Visitor

LONGEST_REGIME = 60  # letters; a contact that chatters has more, and the rest is cut off


def traced_curve(scene: Scene, branches: Sequence[Branch], reason: str) -> Curve:
    """The points of branches, with a point of NaN between one and the next; complete without a reason."""
    points: list[Sample | None] = []
    for branch in branches:
        points += [None, *branch.orbits] if points else branch.orbits
    folds = [fold.frequency for branch in branches for fold in branch.folds]
    return replace(_curve(scene, points, reason), folds=folds)


def visited_curve(scene: Scene, visitor: Visitor, reason: str) -> Curve:
    """The points at which sweeps were steady, in order; complete without a reason, its own or that one."""
    curve = _curve(scene, visitor.points, reason or visitor.reason)
    if curve.orbits is not None:
        curve.orbits.sweep, curve.orbits.jumps = np.array(visitor.sweep, dtype="<U4"), visitor.jumps
    return curve


def _curve(scene: Scene, points: Sequence[Sample | None], reason: str) -> Curve:
    empty = lost_curve(scene, reason)
    frequency = _numbers(points, "frequency")
    amplitude = _rows(points, "amplitude", empty)
    zero = np.where(np.isnan(frequency), np.nan, 0.0)  # neither a table nor a truncation
    return replace(
        empty,
        frequency=frequency,
        amplitude=amplitude,
        phase=_rows(points, "phase", empty),
        mean=_rows(points, "mean", empty),
        regime=_regimes(points, len(scene.contacts)),
        loop=np.full((len(points), *empty.loop.shape[1:]), np.nan),  # the exact cycle has none
        stable=np.array([p is not None and p.stable for p in points], dtype=bool),
        table_error=zero,
        truncation_error=zero,
        complete=not reason,
        peaks={d: _peak(amplitude[:, i], frequency) for i, d in enumerate(empty.peaks)},
        orbits=Orbits(
            _rows(points, "fundamental", empty),
            _numbers(points, "residual"),
            np.full(len(points), "", dtype="<U4"),
        ),
    )


def _numbers(points: Sequence[Sample | None], name: str) -> FloatArray:
    """A number of each point; NaN between branches."""
    return np.array([np.nan if point is None else getattr(point, name) for point in points])


def _rows(points: Sequence[Sample | None], name: str, empty: Curve) -> FloatArray:
    """A measure of each point, (point, dof)."""
    none = np.full(len(empty.peaks), np.nan)
    rows = [none if point is None else getattr(point.measure, name) for point in points]
    return np.array(rows).reshape(len(points), len(empty.peaks))


def _regimes(points: Sequence[Sample | None], contacts: int) -> npt.NDArray[np.str_]:
    rows = [[""] * contacts if point is None else [_short(s) for s in point.states] for point in points]
    return np.array(rows, dtype=str).reshape(len(points), contacts)


def _short(states: str) -> str:
    return states if len(states) <= LONGEST_REGIME else states[: LONGEST_REGIME - 3] + "..."


def _peak(amplitude: FloatArray, frequency: FloatArray) -> tuple[float, float]:
    if not np.isfinite(amplitude).any():
        return np.nan, np.nan
    at = int(np.nanargmax(amplitude))
    return float(amplitude[at]), float(frequency[at])
