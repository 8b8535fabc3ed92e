r"""Errors of the frequencies at which stability is lost, against a balance with more harmonics.

Places of the curve around a crossing are displaced to the curve of a balance with the further harmonics that
would change it most. The growth of disturbances changes its sign on that curve at the crossing of more
harmonics.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from fcm.accuracy.options import AT_POINTS, STABILITY_LIMITS
from fcm.accuracy.reference_harmonics import keep_for_next, prolongation_to, reference_harmonics
from fcm.accuracy.required_harmonics import RequiredHarmonics, needed
from fcm.continuation import Path, Segment
from fcm.continuation.events import SignChange
from fcm.frozen import Frozen
from fcm.harmonic_balance.prolongation import Prolongation
from fcm.harmonic_balance.reported_quantities import reported_at
from fcm.harmonic_balance.residual_spectrum import FurtherHarmonics
from fcm.harmonic_balance.system import System
from fcm.scene.options import LIMITS
from fcm.stability.along_branch import EITHER
from fcm.stability.floquet import multipliers_of
from fcm.stability.inserted_points import MultiplierCrossing


class StabilityLimit(Frozen):
    """A crossing of multipliers and the relative error of its frequency; NaN where that is unknown.

    `harmonics` are those that the accuracy requires.
    """

    frequency: float  # [rad/s] of the crossing
    error: float
    harmonics: tuple[int, ...]


def stability_limits(
    system: System, path: Path, crossings: Sequence[MultiplierCrossing], accuracy: float = 0.0
) -> list[StabilityLimit]:
    """Errors of the crossings of a path, computed no more precisely than the accuracy needs."""
    known: dict[tuple[int, ...], _ReferenceGrowth] = {}
    found = [_lost(system, path, one, accuracy, known) for one in crossings]
    for more, beside in known.items():
        keep_for_next(beside.prolongation, system, more, AT_POINTS)
    return found


def distances_from(lost: Sequence[StabilityLimit], fewer: Sequence[StabilityLimit]) -> list[StabilityLimit]:
    """The crossings; unknown errors become the distance to the same crossing with fewer harmonics."""
    return [_moved(one, lost, fewer) if math.isnan(one.error) else one for one in lost]


def _moved(
    one: StabilityLimit, lost: Sequence[StabilityLimit], fewer: Sequence[StabilityLimit]
) -> StabilityLimit:
    off, *others = sorted([math.inf, math.inf, *(abs(other.frequency - one.frequency) for other in fewer)])
    others += [abs(other.frequency - one.frequency) for other in lost if other is not one]
    return (
        replace(one, error=off / one.frequency)
        if off < STABILITY_LIMITS.crossing_distance * min(others)
        else one
    )


def _lost(
    system: System,
    path: Path,
    one: MultiplierCrossing,
    accuracy: float,
    known: dict[tuple[int, ...], _ReferenceGrowth],
) -> StabilityLimit:
    """The `StabilityLimit` at one crossing; `known` caches the curves with more harmonics."""
    z, direction = one.z[None], one.direction[None]
    amplitude = reported_at(system, z, direction).amplitude[0]
    share = FurtherHarmonics(system).shares(z, amplitude[None])[0]
    more = reference_harmonics(system.harmonics, share, system.layout.ports, AT_POINTS)
    if more == system.harmonics:  # nothing is left out
        return StabilityLimit(one.frequency, 0.0, more)
    if more not in known:
        known[more] = _ReferenceGrowth(
            system.with_harmonics(more), path, prolongation_to(system, more, AT_POINTS), system
        )
    found = known[more].crossing(one, STABILITY_LIMITS.relative_tolerance * accuracy)
    error = abs(found / one.frequency - 1.0)
    required = RequiredHarmonics(
        0.0 if math.isnan(error) else error, not math.isnan(error), share[: LIMITS.harmonics], more
    )
    return StabilityLimit(one.frequency, error, needed(required, system.harmonics, accuracy))


class _ReferenceGrowth:
    """The curve with more harmonics beside a path; a place is a point number with a fraction."""

    def __init__(self, finer: System, path: Path, prolongation: Prolongation, system: System) -> None:
        self.path, self.prolongation, self.balance = path, prolongation, system.new_balance()
        self.multipliers = multipliers_of(finer, float(path.parameter.max()))
        self.frequency = math.nan  # of the last place

    def growth(self, place: float) -> float:
        """Growth of disturbances on the curve with more harmonics beside a place; NaN if unknown.

        The finer motion of so many harmonics is accurate enough. Its further harmonics are balanced, which is
        expensive, only if it gives no growth.
        """
        k = min(int(place), len(self.path.z) - 2)
        z, direction = self.path.z[k], self.path.direction[k]
        if place != k:
            between = Segment(self.balance, self.path, k)
            if not between.find(place - k):
                return math.nan
            z, direction = between.z, between.direction
        if not self.prolongation.find_normal(np.ascontiguousarray(z), np.ascontiguousarray(direction)):
            return math.nan
        self.frequency = float(self.prolongation.newton.z[-1])
        z = np.array(self.prolongation.newton.z)
        alone = self.multipliers.classify(z, sufficient=EITHER).growth
        growth = self.multipliers.classify(z).growth if math.isnan(alone) else alone
        return max(growth, STABILITY_LIMITS.min_growth)

    def crossing(self, one: MultiplierCrossing, fine: float) -> float:
        """Frequency at which the growth changes sign next to a crossing; NaN if it is not found.

        It is located to `StabilityLimitOptions.tolerance`. The search also ends when two successive
        frequencies differ by less than fine (relative), or by less than
        `StabilityLimitOptions.relative_tolerance` of their distance from the crossing.
        """
        near = self._enclosed(one.place)
        if near is None:
            return math.nan
        for _ in range(STABILITY_LIMITS.max_evaluations):
            at, before = near.at, self.frequency
            value = self.growth(at)
            if math.isnan(value) or near.width < STABILITY_LIMITS.tolerance:
                break
            off = max(
                fine * one.frequency,
                STABILITY_LIMITS.relative_tolerance * abs(self.frequency - one.frequency),
            )
            if abs(self.frequency - before) < off:
                break
            near.update(at, value)
            if near.converged(STABILITY_LIMITS.tolerance):
                break
        return self.frequency if not math.isnan(value) else math.nan

    def _enclosed(self, place: float) -> SignChange | None:
        """Bracket the growth's sign change nearest to a place, on either side of it.

        None if there is none up to where the growth is unknown, or up to the greatest distance.
        """
        now, last, near = self.growth(place), float(len(self.path.z) - 1), STABILITY_LIMITS.first_distance
        before = {} if math.isnan(now) else {1.0: (place, now), -1.0: (place, now)}
        while before and near <= STABILITY_LIMITS.max_distance:
            for sign, (known, growth) in list(before.items()):
                at = place + sign * near
                value = self.growth(at) if 0.0 <= at <= last else math.nan
                if (value > 0.0) != (growth > 0.0) and not math.isnan(value):
                    (low, one), (high, other) = sorted(((known, growth), (at, value)))
                    bracket = STABILITY_LIMITS.sign_change
                    return SignChange(low, high, one, other, True, bracket)
                before[sign] = (at, value)
            before = {sign: side for sign, side in before.items() if not math.isnan(side[1])}
            near *= 2.0
        return None
