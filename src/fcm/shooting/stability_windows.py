"""Windows of stability, or of instability, between two points of an exact curve with equal stability.

They are predicted by functions of the multipliers that are smooth even where the multipliers are not, see
`fcm.stability.bifurcation_functions`. Where the states of contacts change between the points, multipliers may
jump, which no function predicts: there the middle is examined.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise
from typing import NamedTuple, Protocol

import numpy as np
import numpy.typing as npt

from fcm.continuation import Path, Segment
from fcm.model.scene import FloatArray
from fcm.shooting.options import ShootingOptions
from fcm.shooting.periodic_orbit import within_unit_circle
from fcm.shooting.problem import OrbitProblem
from fcm.stability.bifurcation_functions import (
    MIN_LOGARITHM,
    MultiplierSample,
    multiplier_sample,
    predicted_minima,
    predicted_minimum,
    products,
)
from fcm.stability.classification import Bifurcation, Classification
from fcm.stability.options import StabilityOptions

ComplexArray = npt.NDArray[np.complex128]


class ClassifiedPoint(Protocol):
    """A point of a path with its multipliers and states."""

    @property
    def multipliers(self) -> ComplexArray: ...
    @property
    def stable(self) -> bool: ...
    @property
    def states(self) -> tuple[str, ...]: ...


class Window(NamedTuple):
    """A point between two points at which stability differs from that of both."""

    first: int  # index of the first of the two
    z: FloatArray
    direction: FloatArray
    orientation: float


class _PathSamples(NamedTuple):
    """Functions of the multipliers at all points of a path, (point,) each, see `MultiplierSample`."""

    length: FloatArray
    stable: npt.NDArray[np.bool_]
    growth: FloatArray
    flip: FloatArray
    pair: FloatArray

    def places(self, first: int, end: int) -> list[MultiplierSample]:
        """The samples of the points from first to end - 1."""
        rows = zip(*(values[first:end].tolist() for values in self), strict=True)
        return [MultiplierSample(*row) for row in rows]

    def suspected(self, jumps: npt.NDArray[np.bool_], options: ShootingOptions) -> list[int]:
        """Indices of the points after which there may be a window: a predicted dip, or a possible jump."""
        low, high = self.stable[:-1], self.stable[1:]
        dips = np.where(
            low,
            self._predicted_minima(options.floquet, self.flip, self.pair),
            self._predicted_minima(options.floquet, self.growth),
        )
        near = np.maximum(self.growth[:-1], self.growth[1:]) >= options.stability.safe_growth
        found: list[int] = np.flatnonzero((low == high) & near & (jumps | dips)).tolist()
        return found

    def _predicted_minima(self, options: StabilityOptions, *functions: FloatArray) -> npt.NDArray[np.bool_]:
        """Whether a minimum of any of the functions is predicted after each point but the last."""
        s, before = self.length, self.stable[:-2] == self.stable[1:-1]
        alike = before & (self.stable[1:-1] == self.stable[2:])
        found = np.zeros(max(s.size - 1, 0), dtype=bool)
        for values in functions:
            sides = predicted_minima(s, values, len(functions) > 1, options)
            for k, side in enumerate(sides):  # between the first two of three points, and the last two
                found[k : found.size - 1 + k] |= side & alike
        return found


def with_windows(
    problem: OrbitProblem, path: Path, points: Sequence[ClassifiedPoint]
) -> tuple[Path, list[int]]:
    """A path with a point added inside each window, and the indices of these points.

    points : those of the path, in its order.
    """
    if not points:
        return path, []
    known = _path_samples(path, points, problem.options.floquet)
    jumps = np.array([one.states != other.states for one, other in pairwise(points)], dtype=bool)
    looked = (
        _window(problem, path, known, k, bool(jumps[k])) for k in known.suspected(jumps, problem.options)
    )
    found = [one for one in looked if one is not None]
    if not found:
        return path, []
    behind = [one.first + 1 for one in found]

    def filled(values: FloatArray, rows: list[FloatArray] | list[float]) -> FloatArray:
        return np.asarray(np.insert(values, behind, np.array(rows), axis=0))

    whole = replace(
        path,
        z=filled(path.z, [one.z for one in found]),
        direction=filled(path.direction, [one.direction for one in found]),
        orientation=filled(path.orientation, [one.orientation for one in found]),
        mark=np.insert(path.mark, behind, np.zeros(len(found), dtype=np.int64)),
    )
    return whole, [k + i for i, k in enumerate(behind)]


def _window(problem: OrbitProblem, path: Path, known: _PathSamples, k: int, jumps: bool) -> Window | None:
    """A point in a window between points k and k + 1, if there is a predicted one; else None.

    jumps : whether multipliers may jump there.
    """
    first, (low, high) = max(k - 1, 0), known.places(k, k + 2)
    between: Segment | None = None

    def inside(
        before: Sequence[MultiplierSample],
        low: MultiplierSample,
        high: MultiplierSample,
        after: Sequence[MultiplierSample],
        times: int,
    ) -> bool:
        """Whether a window is found between low and high, after times divisions; `between` is then in it."""
        nonlocal between
        alike = [one for one in (*before, low, high, *after) if one.stable == low.stable]
        again = times < problem.options.stability.max_divisions
        length = predicted_minimum(low, high, alike, times, problem.options.floquet) if again else None
        if length is None and jumps and times == 0:
            length = 0.5 * (low.length + high.length)
        if length is None:
            return False
        between = between or Segment(problem, path, k)
        if not between.find((length - start) / width):
            return False
        shot = problem.shot(between.z)
        if shot is None:
            return False
        stable = within_unit_circle(shot.multipliers, problem.options)
        there = _multiplier_sample(length, shot.multipliers, stable, problem.options.floquet)
        return (
            there.stable != low.stable
            or inside(before, low, there, [high], times + 1)
            or inside([low], there, high, after, times + 1)
        )

    start, width = low.length, high.length - low.length
    if not inside(known.places(first, k), low, high, known.places(k + 2, k + 3), 0) or between is None:
        return None
    return Window(k, between.z, between.direction, between.orientation)


def _multiplier_sample(
    length: float, multipliers: ComplexArray, stable: bool, options: StabilityOptions
) -> MultiplierSample:
    """The sample of a point from its multipliers.

    Multipliers of exactly 1, of contacts that always stick or stay closed without friction, are left out.
    """
    values = tuple(multipliers[multipliers != 1.0].tolist()[: options.windows.max_multipliers])
    growth = math.log(max((abs(value) for value in values), default=0.0) + 1e-300)
    classified = Classification(float(stable), growth, Bifurcation.NEIMARK_SACKER, values=values)
    return multiplier_sample(length, classified, options)


def _path_samples(path: Path, points: Sequence[ClassifiedPoint], options: StabilityOptions) -> _PathSamples:
    """Samples of all points of a path at once."""
    values = np.array([point.multipliers for point in points])
    kept = (values != 1.0) & (np.cumsum(values != 1.0, axis=1) <= options.windows.max_multipliers)
    growth = np.log(np.where(kept, np.abs(values), 0.0).max(axis=1, initial=0.0) + MIN_LOGARITHM)
    stable = np.array([point.stable for point in points])
    flip, pair = (np.where(stable, each, 0.0) for each in products(np.where(kept, values, 0.0), options))
    return _PathSamples(_lengths(path), stable, growth, flip, pair)


def _lengths(path: Path) -> FloatArray:
    """Length along the path up to each point, in the greatest sizes of its unknowns."""
    size = np.maximum(np.abs(path.z).max(axis=0), np.finfo(float).tiny)
    steps = np.linalg.norm(np.diff(path.z, axis=0) / size, axis=1)
    return np.concatenate(([0.0], np.cumsum(steps)))
