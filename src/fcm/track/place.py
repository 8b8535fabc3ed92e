"""Where a follower of special points has come to: the place, the direction, and the equations in force."""

from __future__ import annotations

import numpy as np

from fcm.continuation.corrector import Newton
from fcm.scene.model import FloatArray
from fcm.track.corner import Corner
from fcm.track.onset import values
from fcm.track.spot import Spot, Way, kinks
from fcm.track.tracked import Condition, Kind

FIRST = 1e-3  # step, in the problem's scale
KINK = 1e-9  # of the span, by which a kink is passed


class Place:
    """z, t: the place it has come to, and the direction there in the problem's scale, a unit vector."""

    z: FloatArray
    t: FloatArray
    bend: FloatArray  # change of the direction over a length along the curve
    spots: list[Spot]

    def __init__(self, way: Way, condition: Condition) -> None:
        self.way, self.condition = way, condition
        self.smooth = way.tracked(condition)
        self.low, self.high = way.system.scene.frequency_range
        self.turns = condition.kind in (Kind.FOLD, Kind.PEAK)
        self.values = sorted({*way.span, *way.stations})
        self.kinks, self.first = kinks(way), FIRST
        self.held = np.eye(self.smooth.n + 2)[-1]
        self._use(None)

    def _use(self, at: Condition | None) -> None:
        """Go on with the equation of a corner, or with that of the smooth curve."""
        self.corner = None if at is None else Corner(self.smooth, at)
        self.newton = Newton(self.smooth if self.corner is None else self.corner.problem)

    def _holds(self) -> bool:
        """Whether the point found is a corner that is what is tracked; any is, that is not a corner."""
        return self.corner is None or self.corner.holds(np.array(self.newton.z))

    def _solve(self, guess: FloatArray, row: FloatArray) -> bool:
        self.newton.z[:], self.newton.row[:] = guess, row
        try:
            return bool(self.newton.correct(1e-3)) and bool(np.isfinite(self.newton.z).all())
        except np.linalg.LinAlgError:
            return False

    def _measure(self, z: FloatArray) -> None:
        """Units, and the row of the tangent, at a place."""
        self.smooth.measure(z)
        if self.corner is not None:
            self.corner.problem.row[:] = self.smooth.row
            self.corner.problem.measure(z)
        self.newton.scale[:] = self.smooth.scale

    def _accept(self) -> None:
        """Go on from the point found."""
        self.z = np.array(self.newton.z)
        t = np.asarray(self.newton.tangent) * np.asarray(self.newton.scale)
        self._measure(self.z)
        t = t / np.asarray(self.newton.scale)
        self.t = t / np.linalg.norm(t)
        self.bend = np.zeros(self.z.size)

    def _spot(self, z: FloatArray, t: FloatArray) -> Spot:
        at = None if self.corner is None else self.corner.at
        return Spot(z, t * np.asarray(self.newton.scale), at)

    def _between(self, at: float) -> bool:
        """Find the point at a length of the step from here."""
        scale = np.asarray(self.newton.scale)
        return self._solve(self.z + scale * (at * self.t + 0.5 * at * at * self.bend), self.t)

    def _crosses(self) -> bool:
        """Whether a corner of the response lies between here and the point found; it is to be landed on."""
        if self.corner is not None or not self.turns:
            return False
        here, there = (self._signs(z) for z in (self.z, np.array(self.newton.z)))
        return bool((here * there < 0.0).any())

    def _signs(self, z: FloatArray) -> FloatArray:
        """Signs of the functions of all onsets."""
        varied = self.smooth.varied
        varied.put(float(z[-1]))
        return np.sign(values(varied.balance.laws, z, varied.harmonics))

    def _outside(self, s: float) -> bool:
        low, high = self.way.span
        return not low - KINK * self.smooth.span < s < high + KINK * self.smooth.span
