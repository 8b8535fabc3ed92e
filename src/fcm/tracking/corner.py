"""Corners of a response as special points, at the onset of a contact's change of state.

The response turns back, or has its peak, at the corner itself while the special-point condition has opposite
signs on its two sides. The equation of the special point is then that the onset function is zero.
"""

from __future__ import annotations

import numpy as np
from scipy.linalg.lapack import dtrtrs

from fcm.continuation.corrector import Newton
from fcm.model.scene import FloatArray
from fcm.tracking.extended_system import Condition, ExtendedSystem, Kind
from fcm.tracking.onset_functions import kinds_of, onset
from fcm.tracking.options import TRACKING, TrackingOptions
from fcm.tracking.parameter_line import VariedBalance


class Corner:
    """A corner at a tracked point: the problem with the onset equation, and the condition on both sides."""

    def __init__(self, tracked: ExtendedSystem, at: Condition) -> None:
        self.of, self.at, self.options = tracked, at, tracked.options.corner
        self.problem = ExtendedSystem(tracked.varied, at, tracked.span, tracked.options)

    def nearest(self, z: FloatArray, offset: float = 0.0) -> tuple[FloatArray, FloatArray] | None:
        """The nearest point where the onset function equals offset, and the scaled tangent of its curve.

        None if Newton's method does not converge.
        """
        self.problem.offset = offset
        scale = np.asarray(self.problem.scale)
        z = np.array(z)
        for _ in range(self.options.max_iterations):
            self.problem.evaluate(z)
            matrix = np.asarray(self.problem.jacobian) * scale / scale[:-1, None]
            Q, R = np.linalg.qr(matrix.T, mode="complete")  # the last column of Q is the null vector
            along, singular = dtrtrs(R[:-1], -np.asarray(self.problem.residual) / scale[:-1], trans=1)
            if singular:
                return None
            step = Q[:, :-1] @ along
            z += scale * step
            if np.linalg.norm(step) < self.options.tolerance:
                return z, Q[:, -1].copy()
        return None

    def special_root(self, z: FloatArray, side: int | None, offset: float = 0.0) -> FloatArray | None:
        """The root of the special-point condition along the corner (offset 0) or beside it, or None.

        side 0 or 1 takes the condition of that side of the corner, None the condition at the point itself.
        The secant method starts at the point of the corner nearest to z and goes along the tangent of its
        curve.
        """
        found = self.nearest(z, offset)
        if found is None:
            return None
        scale, (start, direction) = np.asarray(self.problem.scale), found
        newton = Newton(self.problem)
        newton.scale[:] = scale
        length, last, worth = 0.0, 0.0, 0.0
        for count in range(self.options.max_iterations):
            newton.z[:], newton.row[:] = start + length * scale * direction, direction
            if abs(length) > self.options.max_distance or not newton.correct(self.of.options.pieces.reach):
                return None
            at = np.array(newton.z)
            before, worth = worth, self.special(at) if side is None else float(self.sides(at)[side])
            if count and (worth == before or abs(length - last) < self.options.tolerance):
                return at
            slope = (worth - before) / (length - last) if count else 0.0
            last, length = length, length - worth / slope if count else self.options.first_step
        return at

    def special(self, z: FloatArray, aside: float = 0.0) -> float:
        """The special-point condition beside the corner, along the response as the onset function rises.

        It is the rate of the frequency, or the growth of the amplitude. aside is a distance in the scale.
        """
        normal, there = self.normal(z), np.array(z)
        there[:-1] += aside * np.asarray(self.problem.scale)[:-1] * normal
        t, _, growth = self.problem.along(there)
        fold = self.of.condition.kind is Kind.FOLD
        found = t[-1] if fold else growth[self.of.condition.which]
        return float(np.sign(normal @ t) * found)

    def sides(self, z: FloatArray) -> FloatArray:
        """Values (2,) of the special-point condition before and after the corner."""
        side = self.options.side_distance
        return np.array([self.special(z, -side), self.special(z, side)])

    def holds(self, z: FloatArray) -> bool:
        """Whether the corner is the special point that is tracked."""
        before, after = self.sides(z)
        return bool(before * after < 0.0)

    def normal(self, z: FloatArray) -> FloatArray:
        """Unit vector (unknown + 1,) in the problem's scale along which the onset function rises."""
        slope = self.rise(z)[:-1]
        unit: FloatArray = slope / np.linalg.norm(slope)
        return unit

    def rise(self, z: FloatArray) -> FloatArray:
        """Gradient (unknown + 2,) of the onset function in the problem's scale."""
        self.problem.evaluate(z)
        rates: FloatArray = np.array(self.problem.jacobian)[-1] * np.asarray(self.problem.scale)
        return rates


def nearest_onsets(
    varied: VariedBalance, z: FloatArray, scale: FloatArray, options: TrackingOptions = TRACKING
) -> list[tuple[float, Condition]]:
    """The onsets by their scaled distance from z, the nearest first.

    A contact that is at both its limits at once begins to slip; then slip precedes the limits.
    """
    varied.set_parameter(float(z[-1]))
    width = varied.balance.width
    found = []
    for c, law in enumerate(varied.balance.laws):
        block = slice(c * width, (c + 1) * width)
        for kind in kinds_of(law):
            one = onset(law, np.ascontiguousarray(z[block]), kind, varied.harmonics, options)
            slope = float(np.linalg.norm(one.slope * scale[block]))
            if slope > 0.0:
                off = abs(one.value) / slope
                off = off if off > options.corner.rounding else 0.0
                found.append((off, Condition(Kind.ONSET, c, kind)))
    return sorted(found, key=lambda pair: pair[0])
