r"""Truncation errors at chosen points of a tracked curve, by the harmonics left out.

The same extended system with the harmonics of the reference's reference is solved at the same value of the
number. Where the number turns back that has no solution on one side: there the curve with more harmonics is
followed from beside the turn to its own turn.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from fcm.accuracy.options import AT_POINTS
from fcm.accuracy.reference_harmonics import reference_harmonics
from fcm.harmonic_balance.residual_spectrum import FurtherHarmonics
from fcm.tracking.curve import SpecialPointCurve
from fcm.tracking.extended_system import Condition, Kind
from fcm.tracking.nonsmooth_continuation import follow_special_point, land
from fcm.tracking.options import TRACKING, TrackingOptions
from fcm.tracking.peak_check import is_top
from fcm.tracking.tracked_point import Ending, TrackedPoint, TrackingSetup


class TruncationError(NamedTuple):
    """Error by the harmonics left out: relative, and that of the number at a turn.

    The relative one is that of a peak's amplitude, else of the frequency.
    """

    relative: float
    number: float  # 0 where the number is given; NaN both where it is unknown


UNKNOWN = TruncationError(np.nan, np.nan)


@dataclass
class _RefinedPoint:
    """A point of a tracked curve with the harmonics of its setup."""

    setup: TrackingSetup
    point: TrackedPoint

    def value(self, condition: Condition) -> float:
        """The quantity whose error is estimated: the amplitude of a peak, or else the frequency."""
        if condition.kind is not Kind.PEAK:
            return float(self.point.z[-2])
        problem = self.setup.tracked(condition)
        problem.evaluate_scale(self.point.z)
        return float(problem.along(self.point.z)[1][condition.which])


def error_points(track: SpecialPointCurve) -> dict[int, str]:
    """Numbers of the points at which the error is estimated, with their kinds."""
    ends = [] if Ending.CLOSED in track.endings else [0, len(track.points) - 1]
    marks = [*((i, "end") for i in dict.fromkeys(ends)), *((i, kind) for i, kind in track.turns())]
    if track.condition.kind is Kind.PEAK and track.greatest.any():
        height = np.where(track.greatest, track.amplitude[:, track.condition.which], np.nan)
        marks += [(int(np.nanargmin(height)), "least"), (int(np.nanargmax(height)), "greatest")]
    found: dict[int, str] = {}
    for i, mark in sorted(marks):
        found[i] = f"{found[i]}, {mark}" if i in found else mark
    return found


def truncation_error(
    setup: TrackingSetup, track: SpecialPointCurve, i: int, begin: int | None = None
) -> TruncationError:
    """The error at one point: the difference from the reference with more harmonics.

    That of a turn is looked for from a point before, by default one that is near.
    """
    here = _RefinedPoint(setup, track.points[i])
    begin = beginning(track, i, setup.options) if begin is None else begin
    start = here if begin is None else _RefinedPoint(setup, track.points[begin])
    return _difference(track.condition, here, start, begin is not None)


def error_of_peak(setup: TrackingSetup, condition: Condition, point: TrackedPoint) -> float:
    """The relative error of a peak by the harmonics left out; NaN where the reference has no peak near it."""
    here = _RefinedPoint(setup, point)
    return _difference(condition, here, here, False).relative


def _difference(
    condition: Condition, here: _RefinedPoint, start: _RefinedPoint, turns: bool
) -> TruncationError:
    """How far the reference's point is from one here; that of a turn follows the reference's point beside the
    start."""
    value, more = here.value(condition), _more(here)
    if more == here.setup.system.harmonics:
        return TruncationError(0.0, 0.0)
    wider = replace(here.setup, system=here.setup.system.with_harmonics(more), user_values=())
    there = _landed(wider, condition, start, here.point, turns)
    if there is None:
        return UNKNOWN
    off = abs(there.value(condition) - value) / abs(value)
    return TruncationError(off, abs(float(there.point.z[-1]) - float(here.point.z[-1])))


def beginning(track: SpecialPointCurve, i: int, options: TrackingOptions = TRACKING) -> int | None:
    """The point from which a turn is sought, some before it and not beyond another turn."""
    if not track.points[i].turn:
        return None
    j = i
    while j > max(0, i - options.error.points_before) and not track.points[j - 1].turn:
        j -= 1
    return j


def _more(found: _RefinedPoint) -> tuple[int, ...]:
    """The harmonics of the reference; none more where nothing slips or opens."""
    z, s = found.point.z, float(found.point.z[-1])
    system = found.setup.system.with_scene(found.setup.line.scene(found.setup.system.scene, s))
    further, y = FurtherHarmonics(system), z[None, :-1]
    if further.linear(y).all():
        return system.harmonics
    problem = found.setup.tracked(Condition(Kind.FOLD))
    problem.evaluate_scale(z)
    amplitude = problem.along(z)[1]
    share = further.shares(y, amplitude[None])[0]
    return reference_harmonics(system.harmonics, share, system.layout.ports, AT_POINTS)


def _landed(
    wider: TrackingSetup, condition: Condition, start: _RefinedPoint, turn: TrackedPoint, turns: bool
) -> _RefinedPoint | None:
    """The point with more harmonics: that beside the start, or the turn that follows it."""
    landed = land(wider, condition, wider.system.extended(start.point.z, start.setup.system.harmonics))
    if landed is None or not _same_kind(wider, condition, landed, start):
        return None
    if not turns:
        return _RefinedPoint(wider, landed)
    s, rise = float(start.point.z[-1]), float(turn.z[-1] - start.point.z[-1])
    if rise == 0.0:
        return None
    near = replace(
        wider,
        span=(
            min(s, s + wider.options.error.span_factor * rise),
            max(s, s + wider.options.error.span_factor * rise),
        ),
        peaks_only=True,
    )
    tracked_points, _ = follow_special_point(near, condition, landed, rise > 0.0)
    if not tracked_points or not tracked_points[-1].turn:
        return None
    return _RefinedPoint(wider, tracked_points[-1])


def _same_kind(wider: TrackingSetup, condition: Condition, point: TrackedPoint, start: _RefinedPoint) -> bool:
    """Whether a peak stays one, and a trough one."""
    if condition.kind is not Kind.PEAK:
        return True
    tops = []
    for setup, one in ((wider, point), (start.setup, start.point)):
        problem = setup.tracked(condition)
        problem.evaluate_scale(one.z)
        tops.append(is_top(problem, one))
    return tops[0] == tops[1]
