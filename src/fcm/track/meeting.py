"""Corners of the response that a curve of special points comes to: along them, across them, off them."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from fcm.scene.model import FloatArray
from fcm.track.corner import nearest
from fcm.track.passing import Passing
from fcm.track.place import FIRST
from fcm.track.spot import Ending, Spot
from fcm.track.tracked import Condition

NEAR = 1e-2  # a corner further away than this does not end a curve
SHORTEST = 1e-7  # distance to a corner that has been reached
LEAP = (1e-5, 1e-4, 1e-6, 1e-3)  # beyond a corner at which what is tracked is looked for again
CONTINUOUS = 1e-4  # of what is special: less is no jump at a corner
AHEAD = 0.5  # cosine of the angle with the direction, of what lies ahead


class Meeting(Passing):
    """A place from which corners are met and left."""

    first: float  # step after a corner

    def _meet(self) -> float | Ending | None:
        """The next step if the curve comes to a corner of the response, tracked from there on, or crossed.

        Or how it ends before that.
        """
        if self.corner is not None or not self.turns:
            return None
        z, before, known = self.z, float(self.t[-1]), len(self.spots)
        came = self.t * np.asarray(self.newton.scale)
        for off, at in nearest(self.smooth.varied, z, np.asarray(self.newton.scale)):
            if off > NEAR:
                break
            self._use(at)
            self._measure(z)
            assert self.corner is not None
            self.corner.problem.offset = 0.0
            self.corner.problem.evaluate(z)
            side = int(self.corner.problem.residual[-1] > 0.0)
            there = self.corner.zero(z, side)
            if there is None or not self._is_ahead(there):
                continue
            ending = self._until(there, at)
            if isinstance(ending, Ending):
                return ending
            if ending and self._go_on(there, side, came, before):
                return self.first
            del self.spots[known:]
        self._use(None)
        self._measure(z)
        return None

    def _until(self, corner: FloatArray, at: Condition) -> Ending | bool:
        """As `_passed`, by the equations of the smooth curve, up to a corner."""
        if not any(self._values_between(self.z, corner)):
            return True
        self._use(None)
        self._measure(self.z)
        ending = self._passed(NEAR, corner)
        self._use(at)
        self._measure(self.z)
        return ending

    def _is_ahead(self, corner: FloatArray) -> bool:
        """Whether a corner lies where the curve leads."""
        off = (corner - self.z) / np.asarray(self.newton.scale)
        far = float(np.linalg.norm(off))
        return far < NEAR and (far < SHORTEST or bool(off @ self.t > AHEAD * far))

    def _go_on(self, there: FloatArray, side: int, came: FloatArray, before: float) -> bool:
        """Go on from a corner that was come to from a side: along it, or on its other side."""
        assert self.corner is not None
        if abs(self.corner.sides(there)[1 - side]) > CONTINUOUS:
            return self._begin(there, came, before)
        exact = self.corner.zero(there, None)
        return exact is not None and self._beyond(exact, came, before, 1 - 2 * side)

    def _begin(self, z: FloatArray, came: FloatArray, before: float) -> bool:
        """Go on along the corner that was landed on, to the side on which it holds."""
        assert self.corner is not None
        found = self.corner.reach(z)
        if found is None:
            return False
        scale, t = np.array(self.newton.scale), found[1]
        ways = [t, -t] if t @ (came / scale) > 0.0 else [-t, t]
        for way in ways:
            if self._solve(z + scale * LEAP[1] * way, way) and self._holds():
                self.newton.z[:], self.newton.tangent[:] = z, way
                self._accept()
                self.first = FIRST
                self.spots.append(replace(self._spot(z, way), switch=True, turn=before * way[-1] < 0.0))
                return True
        return False

    def _beyond(self, z: FloatArray, came: FloatArray, before: float, sign: int) -> bool:
        """Go on with the smooth curve from a corner, to the side where its function has a sign."""
        corner = self.corner
        assert corner is not None
        for leap in LEAP:
            self._use(corner.at)
            self._measure(z)
            there = self.corner.zero(z, None, sign * leap) if self.corner is not None else None
            if there is None:
                continue
            self._use(None)
            self._measure(there)
            row = (there - z) / np.asarray(self.newton.scale)
            if self._solve(there, row / np.linalg.norm(row)) and self.newton.moved < 1e-6:
                self._accept()
                self.first = leap
                turn = bool(before * self.t[-1] < 0.0)
                self.spots += [Spot(z, came, None, turn, switch=True), self._spot(self.z, self.t)]
                return True
        self._use(corner.at)
        self._measure(z)
        return False

    def _leave(self, step: float) -> float | Ending:
        """The corner is no more what is tracked: go on with the smooth curve on the side that has it."""
        low, high = 0.0, step
        assert self.corner is not None
        for _ in range(30):
            middle = 0.5 * (low + high)
            if self._between(middle) and self._holds():
                low = middle
            else:
                high = middle
        self._between(low)
        z, before = np.array(self.newton.z), float(self.t[-1])
        came = self.t * np.asarray(self.newton.scale)
        if (ending := self._passed(step, z)) is not True:
            return ending or Ending.STALLED
        for side in np.argsort(np.abs(self.corner.sides(z))):
            there = self.corner.zero(z, int(side))
            if there is not None and self._beyond(there, came, before, 2 * int(side) - 1):
                return self.first
        return Ending.STALLED
