"""What happens on a step along a curve of special points: turns, stations, kinks, the ends of ranges."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from fcm.continuation.root_finding import Secants
from fcm.scene.model import FloatArray
from fcm.track.place import FIRST, KINK, Place
from fcm.track.spot import Ending, Spot

FINE = 1e-11  # of a step: a turn is known to this
SKIPPED = 1e-3  # a step on which a value that was asked for may be left out, but no end
LOOKS = 40  # at a turn
ASIDE = (1e-5, 1e-4)  # of it, along the curve, where it cannot be looked at itself


class Passing(Place):
    """A place with the ways to find what lies between it and the next."""

    def _turn(self, step: float, after: FloatArray) -> Spot | None:
        """Where s turns back within the step; None if that is not found."""
        sides = Secants(0.0, step, float(self.t[-1]), float(after[-1]))
        for _ in range(LOOKS):
            at = sides.at
            if not self._between(at) or self.newton.moved > step:
                return self._isolated(at)
            now = float(self.newton.tangent[-1])
            if now == 0.0 or sides.width <= FINE * step:
                break
            sides.saw(at, now)
        return replace(self._spot(np.array(self.newton.z), np.array(self.newton.tangent)), turn=True)

    def _isolated(self, at: float) -> Spot | None:
        """A turn at which the response is an isolated point, or crosses itself; None if it is not found.

        The response has no one direction there, and so the turn lies between points on both sides, up to the
        cube of their distance.
        """
        for aside in ASIDE:
            sides = []
            for there in (at - aside, at + aside):
                if self._between(there) and self.newton.moved < aside:
                    sides.append((np.array(self.newton.z), np.array(self.newton.tangent)))
            if len(sides) == 2 and sides[0][1][-1] * sides[1][1][-1] < 0.0:
                (one, before), (other, after) = sides
                scale = np.asarray(self.newton.scale)
                length = float(np.linalg.norm((other - one) / scale))
                part = before[-1] / (before[-1] - after[-1])
                way = length * part * (before + 0.5 * part * (after - before))
                t = before + part * (after - before)
                return replace(self._spot(one + scale * way, t / np.linalg.norm(t)), turn=True)
        return None

    def _passed(self, step: float, z: FloatArray, turn: Spot | None = None) -> Ending | bool:
        """Keep what lies on the way to z, over a turn if there is one; how the curve ends there, if it does.

        Else whether that could be: an end that is passed must be landed on, and other values if a shorter
        step may do so.
        """
        known, one = len(self.spots), self.z
        for spot in (None,) if turn is None else (turn, None):
            ending = self._piece(step, one, z if spot is None else spot.z)
            if ending is False:
                del self.spots[known:]
            if ending is not True:
                return ending
            if spot is not None:
                self.spots.append(spot)
                one = spot.z
        return True

    def _piece(self, step: float, one: FloatArray, other: FloatArray) -> Ending | bool:
        """As `_passed`, on a piece of the way on which s rises or falls throughout."""
        for part, i, value in sorted(self._values_between(one, other)):
            ending = self._ends(i, value, other[i] - one[i])
            guess, row = one + part * (other - one), np.zeros(one.size)
            guess[i], row[i] = value, np.sign(other[i] - one[i])
            if not self._solve(guess, row) or self.newton.moved > step:
                if ending is not None or step > SKIPPED:
                    return False
                continue
            spot = self._spot(np.array(self.newton.z), np.array(self.newton.tangent))
            spot.z[i] = value
            self.spots.append(replace(spot, station=i == -1))
            if ending is not None:
                return ending
        return True

    def _values_between(self, one: FloatArray, other: FloatArray) -> Iterator[tuple[float, int, float]]:
        """Values of s asked for, and ends of the range of frequencies: where on the way, and of what."""
        for i, values in ((-1, self.values), (-2, [self.low, self.high])):
            for value in values:
                if (value - one[i]) * (value - other[i]) < 0.0 or value == other[i] != one[i]:
                    yield (value - one[i]) / (other[i] - one[i]), i, value

    def _ends(self, i: int, value: float, rise: float) -> Ending | None:
        """How the curve ends where s (-1) or the frequency (-2) passes a value, rising or falling."""
        low, high = self.way.span if i == -1 else (self.low, self.high)
        if value != (high if rise > 0.0 else low):
            return None
        return Ending.SPAN if i == -1 else Ending.RANGE

    def _kink(self, guess: FloatArray) -> float | None:
        """The first value of s between here and a guess at which the equations have a kink."""
        passed = [k for k in self.kinks if (k - self.z[-1]) * (k - guess[-1]) < 0.0]
        return min(passed, key=lambda k: abs(k - self.z[-1]), default=None)

    def _pass(self, guess: FloatArray, kink: float, step: float) -> float | Ending | None:
        """Go on just beyond a kink, with a first step; None if it is not reached."""
        part = (kink - self.z[-1]) / (guess[-1] - self.z[-1])
        rise = float(np.sign(guess[-1] - self.z[-1]))
        there = self.z + part * (guess - self.z)
        there[-1] = kink
        if not self._solve(there, rise * self.held) or self.newton.moved > 0.5 * step:
            return None
        known, spot = len(self.spots), self._spot(np.array(self.newton.z), np.array(self.newton.tangent))
        if (ending := self._passed(step, spot.z)) is not True:
            return ending or None
        beyond = spot.z.copy()
        beyond[-1] += rise * KINK * self.smooth.span
        if (
            not self._solve(there, rise * self.held)
            or not self._holds()
            or not self._solve(beyond, rise * self.held)
        ):
            del self.spots[known:]
            return None
        if not any(one.station for one in self.spots[known:]):
            self.spots.append(spot)
        self._accept()
        return FIRST
