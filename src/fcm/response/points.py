"""Points of curves made exact: corrected with the closed form, and more where the response needs them."""

from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np

from fcm.contact.limits import FloatArray
from fcm.response.balance import Balance
from fcm.response.branches import Branches, hang_together
from fcm.response.displacement import displacement_rates, displacements
from fcm.response.extrema import fold_rate, locate
from fcm.response.newton import amplitudes, scales
from fcm.response.segment import Segments, correct_exactly
from fcm.response.structure import AnyArray, BoolArray, IntArray

NEARLY_HIGHEST = 0.7  # a maximum between points may exceed them by this factor
FINE = 0.08  # distance of points near a summit, so that no maximum hides between two of them
CHANGE = 0.2  # greatest relative change of a degree of freedom between points
FLOOR = 0.1  # of its greatest amplitude: below this a change is not followed
ROUNDING = 1e-13  # of the greatest of all: a degree of freedom that moves less is not followed
SHORTEST = 1e-6  # arc below which nothing is cut
MOST_PIECES, ROUNDS = 8, 6


@dataclass
class Points:
    """Points of all curves in order along each."""

    curve: IntArray  # (point,)
    branch: IntArray  # (point,) several of a curve if they do not hang together
    z: FloatArray  # (point, unknown + 1), the frequency last
    direction: FloatArray  # (point, unknown + 1) along the curve
    shift: FloatArray  # (point,) relative, by the correction
    fold: BoolArray  # (point,) where the frequency turns

    def take(self, which: BoolArray) -> Points:
        """Some of the points."""
        return Points(*(getattr(self, f.name)[which] for f in fields(self)))

    def segments(self, at: IntArray, exact: Balance) -> Segments:
        """The segments from points at (segment,) to the points that follow them."""
        curve, z, d = self.curve[at], self.z, self.direction
        return Segments(curve, z[at], z[at + 1], d[at], d[at + 1], extent(exact, curve))


def corrected(exact: Balance, branches: Branches, curves: int) -> tuple[Points, IntArray]:
    """Every point corrected with the closed form along the normal of its curve.

    A point for which that fails stays as it was traced, and is counted, (curve,).
    """
    path = branches.trace
    curve = branches.curve[path.curve]
    x = path.z[:, :-1]
    scale = scales(x, amplitudes(x), extent(exact, curve))
    row = path.direction / scale
    omega = path.z[:, -1]
    ends = (omega == _of(exact.group.low, curve)) | (omega == _of(exact.group.high, curve))
    row[ends] = np.eye(path.z.shape[1])[-1]  # the ends of the range stay where they are
    row /= np.sqrt((row * row).sum(axis=1, keepdims=True))
    balance = exact.take(curve)
    new = correct_exactly(balance, path.z, scale, row)
    z = np.where(new.converged[:, None], new.z, path.z)
    z[ends, -1] = path.z[ends, -1]
    before, _ = displacements(balance, path.z[:, :-1], path.z[:, -1])
    after, _ = displacements(balance, z[:, :-1], z[:, -1])
    size = np.abs(after).max(axis=1, initial=0.0)
    shift = np.abs(after - before).max(axis=1, initial=0.0) / np.where(size > 0.0, size, 1.0)
    along = np.sign((new.tangent * path.direction / scale).sum(axis=1, keepdims=True))
    direction = np.where(new.converged[:, None], along * scale * new.tangent, path.direction)
    points = Points(curve, path.curve, z, direction, shift, np.zeros(shift.size, dtype=bool))
    return _in_order(exact, points), np.bincount(curve[~new.converged], minlength=curves)


def _in_order(exact: Balance, points: Points) -> Points:
    """Without points that their correction has moved past a neighbour, closer than the table's error was."""
    for _ in range(ROUNDS):
        same = hang_together(points.branch)
        segments = points.segments(np.arange(same.size), exact)
        step = segments.chord / segments.scale**2
        ahead = [(step * d).sum(axis=1) for d in (segments.direction_start, segments.direction_end)]
        back = np.flatnonzero(same & (ahead[0] < 0.0) & (ahead[1] < 0.0))
        if back.size == 0:
            break
        inner = np.concatenate(([False], same)) & np.concatenate((same, [False]))
        later = points.shift[back + 1] > points.shift[back]
        moved = back + np.where(inner[back] & inner[back + 1], later, inner[back + 1])
        keep = np.ones(points.curve.size, dtype=bool)
        keep[moved[inner[moved]]] = False
        points = points.take(keep)
    return points


def refined(exact: Balance, points: Points) -> Points:
    """More points where the contacts hardly move but some degree of freedom changes much, and at summits."""
    for _ in range(ROUNDS):
        pieces = _pieces(exact, points)
        if not np.any(pieces > 1):
            break
        points = _subdivided(exact, points, pieces)
    return points


def _pieces(exact: Balance, points: Points) -> IntArray:
    """Into how many pieces each segment between neighbouring points is to be cut, (point - 1,)."""
    if points.curve.size < 2:
        return np.ones(0, dtype=np.intp)
    X, dX = displacement_rates(exact.take(points.curve), points.z, points.direction)
    size = np.abs(X)
    highest = np.zeros((points.curve.max() + 1, size.shape[1]))
    np.maximum.at(highest, points.curve, size)
    highest = highest[points.curve]
    noise = ROUNDING * highest.max(axis=1, keepdims=True)
    x = points.z[:, :-1]
    scale = scales(x, amplitudes(x), extent(exact, points.curve))
    arc = np.sqrt(((np.diff(points.z, axis=0) / scale[:-1]) ** 2).sum(axis=1))
    speed = np.sqrt(((points.direction / scale) ** 2).sum(axis=1))[:, None]
    unit = np.maximum(np.maximum(size, FLOOR * highest), noise)
    unit = np.where(unit > 0.0, unit, 1.0)
    rate = np.max(np.abs(dX) / (unit * speed), axis=1)  # relative change of a degree of freedom per arc
    jump = np.max(np.abs(np.diff(X, axis=0)) / np.maximum(unit[1:], unit[:-1]), axis=1)
    change = np.maximum(jump, arc * np.maximum(rate[1:], rate[:-1]))
    high = np.any((size > NEARLY_HIGHEST * highest) & (highest > noise), axis=1)
    finer = np.maximum(change / CHANGE, np.where(high[1:] | high[:-1], arc / FINE, 0.0))
    finer = np.where(hang_together(points.branch) & (arc > SHORTEST), finer, 1.0)
    pieces: IntArray = np.ceil(np.clip(finer, 1.0, MOST_PIECES)).astype(np.intp)
    return pieces


def _subdivided(exact: Balance, points: Points, pieces: IntArray) -> Points:
    at = np.repeat(np.arange(pieces.size), pieces - 1)
    number = np.arange(at.size) - np.repeat(np.cumsum(pieces - 1) - (pieces - 1), pieces - 1) + 1
    share = number / pieces[at]
    new = points.segments(at, exact).points(exact, share)
    ok = new.converged
    return inserted(points, (at + share)[ok], new.z[ok], new.tangent[ok], fold=False)


def with_folds(exact: Balance, points: Points) -> Points:
    """The folds as points of their own, so that each part between them is one branch."""
    rate, same = points.direction[:, -1], hang_together(points.branch)
    at = np.flatnonzero(same & (np.sign(rate[1:]) * np.sign(rate[:-1]) < 0.0))
    segments = points.segments(at, exact)
    z, direction = locate(exact, segments, fold_rate, rate[at], rate[at + 1], at)
    return inserted(points, at + np.float64(0.5), z, direction, fold=True)


def inserted(points: Points, place: FloatArray, z: FloatArray, direction: FloatArray, fold: bool) -> Points:
    """Points between others: place k + share lies between the points k and k + 1."""
    order = np.argsort(np.concatenate((np.arange(points.curve.size), place)))
    at = place.astype(np.intp)
    # these never saw the table; the error that their neighbours had
    shift = np.maximum(points.shift[at], points.shift[at + 1])

    def merged(old: AnyArray, extra: AnyArray) -> AnyArray:
        return np.concatenate((old, extra))[order]

    return Points(
        merged(points.curve, points.curve[at]),
        merged(points.branch, points.branch[at]),
        merged(points.z, z),
        merged(points.direction, direction),
        merged(points.shift, shift),
        merged(points.fold, np.full(at.size, fold)),
    )


def extent(exact: Balance, curve: IntArray) -> FloatArray:
    """Length of the frequency range of each of the curves."""
    return _of(exact.group.high - exact.group.low, curve)


def _of(value: FloatArray, curve: IntArray) -> FloatArray:
    """A value of each curve, or one that all share, at some of the curves."""
    return np.broadcast_to(value, curve.shape) if value.size == 1 else value[curve]
