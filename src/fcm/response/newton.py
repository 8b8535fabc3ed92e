"""Newton's method for one step along many curves at once, in coordinates made dimensionless by each curve.

The system of n equations for n unknowns and a parameter is closed by a row: the point is sought in the plane
through a guess whose normal is that row. The same matrix gives the direction of the curve, and the sign of
its determinant the curve's orientation.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from fcm.contact.limits import FloatArray
from fcm.response.structure import BoolArray, IntArray

MAX_ITERATIONS = 7  # Newton steps before a predictor is judged too far away
CLOSE = 1e-8  # error of a point, estimated from quadratic convergence; every point is corrected later
EPS = float(np.finfo(np.float64).eps)
HUGE = 1e100  # a step of this length, in the curve's own size, leads nowhere
ROUNDINGS = 4.0  # a step that does not shrink and is no longer than this many roundings is one
COARSEST = 1e-6  # and no longer than this
OWN_FLOOR, OTHER_FLOOR = 0.1, 1e-6  # a scale is at least this much of its own, and of the greatest, maximum


class Derivatives(Protocol):
    """What the follower needs at a point of each curve."""

    @property
    def residual(self) -> FloatArray: ...  # (curve, unknown)
    @property
    def jacobian(self) -> FloatArray: ...  # (curve, unknown, unknown)
    @property
    def by_omega(self) -> FloatArray: ...  # (curve, unknown), by the parameter of the path


class Equations(Protocol):
    """residual(x, p) = 0 for a group of curves."""

    def evaluate(self, x: FloatArray, omega: FloatArray, /) -> Derivatives:
        """Residual and derivatives at x (curve, unknown) and the parameter (curve,)."""

    def take(self, index: IntArray, /) -> Equations:
        """The equations of some of the curves."""


def amplitudes(x: FloatArray) -> FloatArray:
    """Size of the tangential and the normal displacement of each contact, (curve, 2 contacts)."""
    blocks = x.reshape(x.shape[0], x.shape[1] // 5, 5)
    u = np.hypot(blocks[..., 0], blocks[..., 1])
    v = np.maximum(np.hypot(blocks[..., 2], blocks[..., 3]), np.abs(blocks[..., 4]))
    return np.stack((u, v), axis=-1).reshape(x.shape[0], 2 * blocks.shape[1])


def scales(x: FloatArray, largest: FloatArray, extent: FloatArray) -> FloatArray:
    """Units in which a curve is measured: amplitudes by their present size, the parameter by its range."""
    overall = largest.max(axis=1, initial=0.0, keepdims=True)
    size = np.maximum(amplitudes(x), np.maximum(OWN_FLOOR * largest, OTHER_FLOOR * overall))
    size = np.where(size > 0.0, size, 1.0) * np.sqrt(max(size.shape[1], 1))
    pairs = size.reshape(x.shape[0], x.shape[1] // 5, 2)
    each = np.repeat(pairs, [2, 3], axis=2).reshape(x.shape)
    return np.concatenate((each, np.broadcast_to(extent, (x.shape[0],))[:, None]), axis=1)


def solve_each(matrix: FloatArray, right: FloatArray) -> FloatArray:
    """Stacked linear solve; a singular or non-finite system gives NaN instead of stopping the others."""
    finite = np.isfinite(matrix).all(axis=(1, 2)) & np.isfinite(right).all(axis=(1, 2))
    try:
        if finite.all():
            return np.asarray(np.linalg.solve(matrix, right), dtype=np.float64)
    except np.linalg.LinAlgError:
        pass
    out = np.full(right.shape, np.nan)
    for i in np.flatnonzero(finite):
        try:
            out[i] = np.linalg.solve(matrix[i], right[i])
        except np.linalg.LinAlgError:
            continue
    return out


@dataclass
class Newton:
    """Outcome of a corrector: points, whether they converged, and the curve's direction there."""

    z: FloatArray
    converged: BoolArray
    tangent: FloatArray  # unit, scaled, on the side of the row that closed the system
    determinant: FloatArray  # sign of the bordered Jacobian


def correct(
    equations: Equations,
    z: FloatArray,
    scale: FloatArray,
    row: FloatArray,
    close: FloatArray | float = CLOSE,
    iterations: int = MAX_ITERATIONS,
    reach: FloatArray | float = 1.0,
) -> Newton:
    """Newton's method in the plane through z with normal row (scaled coordinates).

    Converged when the error that remains, estimated as length (length / length before), is below close;
    reach is the length that stands before the first step.
    """
    z = z.copy()
    size = z.shape[1]
    right = np.zeros((z.shape[0], size, 2))
    right[:, -1, 1] = 1.0
    before = np.broadcast_to(reach, (z.shape[0],))
    done, lost = np.zeros(z.shape[0], dtype=bool), np.zeros(z.shape[0], dtype=bool)
    matrix = np.empty((z.shape[0], size, size))
    tangent = row.copy()
    for _ in range(iterations):
        fill(matrix, equations.evaluate(z[:, :-1], z[:, -1]), scale, right)
        matrix[:, -1, :] = row
        solution = solve_each(matrix, right)
        # a matrix that is singular, or nearly: it stays where it is
        lost |= ~(np.abs(solution) < HUGE).all(axis=(1, 2))
        idle = (done | lost)[:, None]
        change = np.where(idle, 0.0, solution[:, :, 0])
        tangent = np.where(idle, tangent, solution[:, :, 1])
        z += scale * change
        length = np.sqrt((change * change).sum(axis=1))
        done |= (length * length < close * before) & (length < 0.1 * before)
        done |= length < 1e-2 * close
        earlier, before = before, length
        if (done | lost).all():
            break
    left = np.flatnonzero(~done & ~lost)
    if left.size:
        floor = np.minimum(ROUNDINGS * rounding(matrix[left], z[left] / scale[left]), COARSEST)
        done[left] = np.maximum(earlier[left], before[left]) < floor
    done &= ~lost
    tangent[lost] = np.nan
    norm = np.sqrt((tangent * tangent).sum(axis=1, keepdims=True))
    sign = np.linalg.slogdet(np.where(np.isfinite(matrix), matrix, 0.0))[0]
    ok = done & np.isfinite(norm[:, 0]) & (norm[:, 0] > 0.0)
    return Newton(z, ok, tangent / np.where(norm > 0.0, norm, 1.0), sign)


def rounding(matrix: FloatArray, z: FloatArray) -> FloatArray:
    """Length of the Newton step that a relative error of EPS in every number makes, (curve,), after Skeel."""
    inverse = solve_each(matrix, np.broadcast_to(np.eye(z.shape[1]), matrix.shape))
    step = np.abs(inverse) @ (np.abs(matrix) @ np.abs(z)[..., None])
    length: FloatArray = EPS * np.sqrt((step * step).sum(axis=(1, 2)))
    return np.where(np.isfinite(length), length, 0.0)


def fill(matrix: FloatArray, at: Derivatives, scale: FloatArray, right: FloatArray) -> None:
    """Rows and columns of the bordered system in scaled coordinates, and the residual."""
    rows = 1.0 / scale[:, :-1]
    matrix[:, :-1, :-1] = at.jacobian * (rows[:, :, None] * scale[:, None, :-1])
    matrix[:, :-1, -1] = at.by_omega * (rows * scale[:, -1:])
    right[:, :-1, 0] = -at.residual * rows


def oriented_tangent(
    equations: Equations, z: FloatArray, scale: FloatArray, along: FloatArray, orientation: FloatArray
) -> FloatArray:
    """Direction of the curve through z whose bordered determinant has the sign of orientation."""
    matrix = np.empty((z.shape[0], z.shape[1], z.shape[1]))
    right = np.zeros((z.shape[0], z.shape[1], 2))
    right[:, -1, 1] = 1.0
    fill(matrix, equations.evaluate(z[:, :-1], z[:, -1]), scale, right)
    matrix[:, -1, :] = along
    tangent = solve_each(matrix, right)[:, :, 1]
    tangent = np.where(np.isfinite(tangent), tangent, along)
    tangent /= np.sqrt((tangent * tangent).sum(axis=1, keepdims=True))
    matrix[:, -1, :] = tangent
    sign = np.linalg.slogdet(np.where(np.isfinite(matrix), matrix, 0.0))[0]
    oriented: FloatArray = tangent * (sign * orientation)[:, None]
    return oriented
