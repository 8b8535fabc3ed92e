"""What happens on a step along a curve of special points: turns, stations, kinks, the ends of ranges."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise

import numpy as np

from fcm.continuation.secants import Secants
from fcm.scene.model import FloatArray
from fcm.track.place import FIRST, KINK, Place
from fcm.track.spot import Ending

FINE = 1e-11  # of a step: a turn is known to this
LOOKS = 40  # at a turn


class Passing(Place):
    """A place with the ways to find what lies between it and the next."""

    def _turn(self, step: float, after: FloatArray) -> None:
        """Keep where s turns back within the step."""
        sides = Secants(0.0, step, float(self.t[-1]), float(after[-1]))
        for _ in range(LOOKS):
            at = sides.at
            if sides.width <= FINE * step or not self._between(at):
                break
            now = float(self.newton.tangent[-1])
            if now == 0.0:
                break
            sides.saw(at, now)
        self.spots.append(
            replace(self._spot(np.array(self.newton.z), np.array(self.newton.tangent)), turn=True)
        )

    def _stations(self, step: float, z: FloatArray, t: FloatArray) -> bool:
        """Keep the values of s that were asked for within the step; whether s leaves its span there."""
        way = [(self.z, None), *((spot.z, spot) for spot in self.spots[-1:] if spot.turn), (z, None)]
        for (one, _), (other, _) in pairwise(way):
            rise = other[-1] - one[-1]
            passed = [v for v in self.values if (v - one[-1]) * (v - other[-1]) < 0.0 or v == other[-1]]
            for value in sorted(passed, reverse=bool(rise < 0.0)):
                guess = one + (other - one) * ((value - one[-1]) / rise)
                if not self._solve(guess, self.held * np.sign(rise)) or self.newton.moved > step:
                    continue
                self.spots.append(
                    replace(self._spot(np.array(self.newton.z), np.array(self.newton.tangent)), station=True)
                )
                if value in self.way.span and rise * (value - sum(self.way.span) / 2.0) > 0.0:
                    return True
        return False

    def _out(self, step: float, z: FloatArray) -> Ending:
        """Keep the point at the end of the range of frequencies."""
        end = self.low if z[-2] < self.low else self.high
        part = (end - self.z[-2]) / (z[-2] - self.z[-2])
        guess, row = self.z + part * (z - self.z), np.eye(z.size)[-2]
        guess[-2] = end
        if self._solve(guess, row if z[-2] > self.z[-2] else -row):
            self.spots.append(self._spot(np.array(self.newton.z), np.array(self.newton.tangent)))
        return Ending.RANGE

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
        z, t = np.array(self.newton.z), np.array(self.newton.tangent)
        if self._stations(step, z, t):
            return Ending.SPAN
        beyond = z.copy()
        beyond[-1] += rise * KINK * self.smooth.span
        if not self._holds() or not self._solve(beyond, rise * self.held):
            return None
        self.spots.append(self._spot(z, t))
        self._accept()
        return FIRST
