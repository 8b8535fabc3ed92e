"""Stability of the motion at the points of a tracked curve."""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from fcm.continuation.corrector import Newton
from fcm.continuation.nearby_solution import solution_near
from fcm.harmonic_balance.dense_jacobian import jacobian_of
from fcm.model.scene import FloatArray
from fcm.stability.floquet import multipliers_of
from fcm.stability.multipliers import Multipliers
from fcm.tracking.curve import SpecialPointCurve, with_points
from fcm.tracking.extended_system import ExtendedSystem, Kind
from fcm.tracking.tracked_point import TrackedPoint, TrackingSetup

Seen = tuple[TrackedPoint, float]  # a point, and its stability


def stability_along(setup: TrackingSetup, track: SpecialPointCurve) -> tuple[SpecialPointCurve, FloatArray]:
    """The curve and the stability of its points (point,): 1 stable, 0 unstable, NaN unknown.

    As along a response, a fold belongs to its stable side, and so does a corner at which the response turns
    back. The curve has two further points at each change of stability, one on either side.
    """
    return _StabilityAlongCurve(setup, track).run()


class _StabilityAlongCurve:
    """Computes the stability of the points of one curve."""

    def __init__(self, setup: TrackingSetup, track: SpecialPointCurve) -> None:
        self.setup, self.track, self.problem = setup, track, setup.tracked(track.condition)
        self.highest = setup.system.scene.frequency_range[1]
        self.known: Multipliers | None = None

    def run(self) -> tuple[SpecialPointCurve, FloatArray]:
        seen = [(point, self._at(point)) for point in self.track.points]
        found = seen[:1]
        for one, other in pairwise(seen):
            found += [*self._limit(one, other), other]
        track, tracked_points = self.track, [point for point, _ in found]
        if len(found) > len(seen):
            track = with_points(self.setup, track, tracked_points)
        return track, np.array([stable for _, stable in found])

    def _limit(self, one: Seen, other: Seen) -> list[Seen]:
        """Points on both sides of a change of stability between two points; none if it does not change."""
        before, ends = one[1], [one, other]
        if _same(before, other[1]):
            return []
        for _ in range(self.setup.options.stability.halvings):
            middle = self._middle(ends[0][0], ends[1][0])
            if middle is None:
                break
            stable = self._at(middle)
            ends[0 if _same(stable, before) else 1] = middle, stable
        return [end for end, old in zip(ends, (one, other), strict=True) if end is not old]

    def _middle(self, one: TrackedPoint, other: TrackedPoint) -> TrackedPoint | None:
        """The point of the curve in the plane that bisects the chord of two points; None if not found."""
        at = other.corner if one.switch else one.corner
        problem = self.setup.tracked(at or self.track.condition)
        z = 0.5 * (one.z + other.z)
        newton, chord = Newton(problem), other.z - one.z
        if not chord.any():
            return None
        try:
            found = solution_near(newton, z, chord, problem.options.pieces.reach)
            length = float(np.linalg.norm(chord / np.asarray(problem.scale)))
            if found is None or newton.moved > length:
                return None
        except np.linalg.LinAlgError:
            return None
        return TrackedPoint(np.array(newton.z), np.array(newton.tangent) * np.asarray(problem.scale), at)

    def _at(self, point: TrackedPoint) -> float:
        problem = self.problem
        problem.evaluate_scale(point.z)
        fold = self.track.condition.kind is Kind.FOLD
        signs = {1.0, -1.0} if fold else _signs(problem, point)
        if max(signs) < 0.0:  # an odd number of real multipliers is above 1
            return 0.0
        at_fold = min(signs) < 0.0
        return self._multipliers().classify(np.array(point.z[:-1]), at_fold).stable

    def _multipliers(self) -> Multipliers:
        """The workspace for multipliers, with the present numbers of the problem."""
        varied = self.problem.varied
        if self.known is None or varied.structure:
            known = multipliers_of(varied.system, self.highest, self.setup.options.floquet)
            assert isinstance(known, Multipliers)  # no law of one's own is tracked
            self.known = known
        self.known.take(varied.system)
        return self.known


def _same(one: float, other: float) -> bool:
    """Whether two values of stability are the same, or both unknown."""
    return one == other or bool(np.isnan(one) and np.isnan(other))


def _signs(problem: ExtendedSystem, point: TrackedPoint) -> set[float]:
    """Signs of the determinant of the balance at a point; at a corner of the response, on both sides."""
    scale, y = np.asarray(problem.scale)[:-1], np.array(point.z[:-1])
    ahead = problem.options.stability.corner_side * scale * np.asarray(problem.row)
    places = [y] if point.corner is None and not point.switch else [y - ahead, y + ahead]
    return {_sign(problem, place, scale[:-1]) for place in places}


def _sign(problem: ExtendedSystem, y: FloatArray, scale: FloatArray) -> float:
    balance = problem.varied.balance
    balance.evaluate(y)
    own = jacobian_of(balance)[:, :-1]
    return float(np.linalg.slogdet(own * scale / scale[:, None])[0])
