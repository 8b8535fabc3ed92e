"""Whether the motion is stable at the points of a tracked curve: at a peak where it is not, none stays."""

from __future__ import annotations

import numpy as np

from fcm.harmonic.multipliers import Multipliers, multipliers_of
from fcm.harmonic.whole import jacobian_of
from fcm.scene.model import FloatArray
from fcm.track.curve import Track
from fcm.track.spot import Spot, Way
from fcm.track.tracked import Kind, Tracked

BESIDE = 1e-6  # of the response's extent: on either side of a corner, where it may turn back


def stability_along(way: Way, track: Track) -> FloatArray:
    """(point,): 1 where small disturbances die out, 0 where one grows, NaN where it cannot be told.

    As along a response: a fold counts to its stable side, and so does a corner at which it turns back.
    """
    return _Along(way, track).run()


class _Along:
    """The points of one curve."""

    def __init__(self, way: Way, track: Track) -> None:
        self.track, self.problem = track, way.tracked(track.condition)
        self.highest = way.system.scene.frequency_range[1]
        self.known: Multipliers | None = None

    def run(self) -> FloatArray:
        return np.array([self._at(spot) for spot in self.track.spots])

    def _at(self, spot: Spot) -> float:
        problem = self.problem
        problem.measure(spot.z)
        fold = self.track.condition.kind is Kind.FOLD
        signs = {1.0, -1.0} if fold else _signs(problem, spot)
        if max(signs) < 0.0:  # of the real multipliers an odd number is above 1
            return 0.0
        turning = min(signs) < 0.0
        return self._multipliers().verdict(np.array(spot.z[:-1]), turning).stable

    def _multipliers(self) -> Multipliers:
        """With the numbers as the problem has them."""
        varied = self.problem.varied
        if self.known is None or varied.structure:
            self.known = multipliers_of(varied.system, self.highest)
        self.known.take(varied.system)
        return self.known


def _signs(problem: Tracked, spot: Spot) -> set[float]:
    """Of the balance's determinant at a point; at a corner of the response those on both sides."""
    scale, y = np.asarray(problem.scale)[:-1], np.array(spot.z[:-1])
    ahead = BESIDE * scale * np.asarray(problem.row)
    places = [y] if spot.corner is None and not spot.switch else [y - ahead, y + ahead]
    return {_sign(problem, place, scale[:-1]) for place in places}


def _sign(problem: Tracked, y: FloatArray, scale: FloatArray) -> float:
    balance = problem.varied.balance
    balance.evaluate(y)
    own = jacobian_of(balance)[:, :-1]
    return float(np.linalg.slogdet(own * scale / scale[:, None])[0])
