"""Corners of a response as special points: at the onset of something a contact does.

The response then turns, or is greatest, at the corner itself as long as what is special of it has opposite
signs on both sides. Another equation holds there: that the onset's function is zero.
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
    """A corner of a tracked point: the problem with the onset's equation, and the conditions on its sides."""

    def __init__(self, tracked: ExtendedSystem, at: Condition) -> None:
        self.of, self.at, self.options = tracked, at, tracked.options.corner
        self.problem = ExtendedSystem(tracked.varied, at, tracked.span, tracked.options)

    def nearest(self, z: FloatArray, offset: float = 0.0) -> tuple[FloatArray, FloatArray] | None:
        """The nearest point where the function is the offset, and the curve's direction there, scaled."""
        self.problem.offset = offset
        scale = np.asarray(self.problem.scale)
        z = np.array(z)
        for _ in range(self.options.max_iterations):
            self.problem.evaluate(z)
            matrix = np.asarray(self.problem.jacobian) * scale / scale[:-1, None]
            Q, R = np.linalg.qr(matrix.T, mode="complete")  # the last column of Q is across all equations
            along, singular = dtrtrs(R[:-1], -np.asarray(self.problem.residual) / scale[:-1], trans=1)
            if singular:
                return None
            step = Q[:, :-1] @ along
            z += scale * step
            if np.linalg.norm(step) < self.options.tolerance:
                return z, Q[:, -1].copy()
        return None

    def special_root(self, z: FloatArray, side: int | None, offset: float = 0.0) -> FloatArray | None:
        """The root of the condition along the corner or beside it: on a side of it, or on it.

        By the secant along the direction of the corner's curve, from the point of it that is nearest to z.
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
        """The special-point condition beside the corner, along the response as the onset's function rises.

        The rise of the frequency, or the growth of the amplitude; aside in the extent of the unknowns.
        """
        normal, there = self.normal(z), np.array(z)
        there[:-1] += aside * np.asarray(self.problem.scale)[:-1] * normal
        t, _, growth = self.problem.along(there)
        fold = self.of.condition.kind is Kind.FOLD
        found = t[-1] if fold else growth[self.of.condition.which]
        return float(np.sign(normal @ t) * found)

    def sides(self, z: FloatArray) -> FloatArray:
        """Values of the special-point condition before and after the corner, (2,)."""
        side = self.options.side_distance
        return np.array([self.special(z, -side), self.special(z, side)])

    def holds(self, z: FloatArray) -> bool:
        """Whether the corner is the special point that is tracked."""
        before, after = self.sides(z)
        return bool(before * after < 0.0)

    def normal(self, z: FloatArray) -> FloatArray:
        """Unit vector in the problem's scale along which the onset's function rises, (unknown + 1,)."""
        slope = self.rise(z)[:-1]
        unit: FloatArray = slope / np.linalg.norm(slope)
        return unit

    def rise(self, z: FloatArray) -> FloatArray:
        """Rates of the onset's function in the problem's scale, (unknown + 2,)."""
        self.problem.evaluate(z)
        rates: FloatArray = np.array(self.problem.jacobian)[-1] * np.asarray(self.problem.scale)
        return rates


def nearest_onsets(
    varied: VariedBalance, z: FloatArray, scale: FloatArray, options: TrackingOptions = TRACKING
) -> list[tuple[float, Condition]]:
    """The onsets by their distance from z in a scale of its numbers, the nearest first.

    Where a contact is at both its limits at once, so that it comes to slip, slip is before them.
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
