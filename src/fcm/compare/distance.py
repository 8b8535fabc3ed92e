"""Distance of a response curve from a reference, also valid at folds and on steep flanks.

An error of amplitude at equal frequency is unbounded where a curve is steep, and has no meaning between
folds. So curves are compared as sets of points (ln omega, X_1, ..., X_n). The distance d is the root of

    (difference of ln omega)^2 + mean over the degrees of freedom of (difference of X_j / max X_j)^2,

from each point of one curve to the nearest point of the other. It is dimensionless, and does not depend on
the range of frequencies, on units or on the positions of the points along the curves.
"""

from __future__ import annotations

import numpy as np
from scipy.interpolate import Akima1DInterpolator
from scipy.spatial import cKDTree

from fcm.compare.lines import FloatArray, Line
from fcm.compare.options import COMPARE


class Shape:
    """A line as a fine chain of points in the coordinates of the distance.

    smooth : interpolate by Akima's local cubics, which do not overshoot at corners; else by straight pieces.
    """

    def __init__(self, line: Line, size: FloatArray, smooth: bool) -> None:
        parts = [_coordinates(w, a, size) for w, a in line.branches()]
        self.points = np.concatenate([*parts, np.empty((0, size.size + 1))])
        self.chains = [_fine(part, smooth) for part in parts]
        chain = np.concatenate([*self.chains, np.empty((0, size.size + 1))])
        self.chain = chain
        if chain.size:
            lengths = [part.shape[0] for part in self.chains]
            # the piece after each point; zero at the end of a chain
            step = np.vstack((np.diff(chain, axis=0), np.zeros(chain.shape[1])))
            step[np.cumsum(lengths) - 1] = 0.0
            self._step, self._tree = step, cKDTree(chain)

    def from_(self, points: FloatArray) -> FloatArray:
        """Distance of each of the points (point, 1 + dof) from this chain."""
        if self.chain.size == 0:
            return np.full(points.shape[0], np.nan)
        _, nearest = self._tree.query(points)
        before = np.maximum(nearest - 1, 0)
        return np.minimum(self._from_piece(points, nearest), self._from_piece(points, before))

    def _from_piece(self, points: FloatArray, first: np.ndarray) -> FloatArray:
        start, step = self.chain[first], self._step[first]
        square = (step * step).sum(axis=1)
        along = ((points - start) * step).sum(axis=1) / np.where(square > 0.0, square, 1.0)
        foot = start + np.clip(along, 0.0, 1.0)[:, None] * step
        return np.asarray(np.sqrt(((points - foot) ** 2).sum(axis=1)))


def size_of(line: Line) -> FloatArray:
    """Greatest amplitude of each degree of freedom, the unit of its errors: (dof,)."""
    greatest = np.nanmax(np.where(np.isfinite(line.amplitude), line.amplitude, 0.0), axis=0, initial=0.0)
    return np.where(greatest > 0.0, greatest, 1.0)


def of_points(shape: Shape, reference: Shape) -> float:
    """Greatest distance of a line's own points from the reference: the error of the points."""
    return _greatest(reference.from_(shape.points))


def of_curve(shape: Shape, reference: Shape) -> float:
    """Greatest distance between the two, either way: counts wrong, missing and too coarse parts."""
    return max(_greatest(reference.from_(shape.chain)), _greatest(shape.from_(reference.chain)))


def resolution(line: Line, size: FloatArray) -> float:
    """Estimated error of a smooth line between its points: half the error of a line with every other point.

    The odd points are left out, then the even ones, and the distance of those left out is measured. With
    twice the spacing the error is eight times as large where the curve is smooth, about twice at a corner.
    """
    worst = 0.0
    for w, a in line.branches():
        for first in (0, 1):
            keep = np.arange(w.size) % 2 == first
            keep[0] = keep[-1] = True
            thinned = Line(w[keep], a[keep], {}, (), True)
            left_out = _coordinates(w[~keep], a[~keep], size)
            missed = Shape(thinned, size, smooth=True).from_(left_out)
            worst = max(worst, 0.5 * float(missed.max(initial=0.0)))
    return worst


def _coordinates(frequency: FloatArray, amplitude: FloatArray, size: FloatArray) -> FloatArray:
    return np.column_stack((np.log(frequency), amplitude / (size * np.sqrt(size.size))))


def _fine(points: FloatArray, smooth: bool) -> FloatArray:
    length = np.sqrt((np.diff(points, axis=0) ** 2).sum(axis=1))
    chain = COMPARE.chain
    kept = points[np.concatenate(([True], length > chain.distinct_length))]
    if kept.shape[0] < 2:
        return kept
    arc = np.concatenate(([0.0], np.cumsum(np.sqrt((np.diff(kept, axis=0) ** 2).sum(axis=1)))))
    fine = min(max(chain.chain_points // kept.shape[0], chain.min_fineness), chain.max_fineness)
    share = np.arange(fine) / fine
    at = np.append((arc[:-1, None] + share * np.diff(arc)[:, None]).ravel(), arc[-1])
    if smooth and kept.shape[0] > 2:
        return np.asarray(Akima1DInterpolator(arc, kept)(at))
    return np.column_stack([np.interp(at, arc, column) for column in kept.T])


def _greatest(distance: FloatArray) -> float:
    return float(distance.max()) if distance.size else float("nan")
