r"""Truncation errors at chosen points of a tracked curve, by the harmonics left out.

The extended system is solved with as many harmonics as the reference of the reference has (`AT_POINTS`), at
the same value of the number. Where the number turns back, this may have no solution. There the curve with
more harmonics is followed to its own turn, from a point before it.
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
    """Error by the harmonics left out; both are NaN if it is unknown."""

    relative: float  # of a peak's amplitude, else of the frequency
    number: float  # of the number at a turn; 0 where the number is given


UNKNOWN = TruncationError(np.nan, np.nan)


@dataclass
class _RefinedPoint:
    """A point of a tracked curve, with the setup that has its harmonics."""

    setup: TrackingSetup
    point: TrackedPoint

    def value(self, condition: Condition) -> float:
        """The quantity whose error is estimated: the amplitude of a peak, else the frequency."""
        if condition.kind is not Kind.PEAK:
            return float(self.point.z[-2])
        problem = self.setup.tracked(condition)
        problem.evaluate_scale(self.point.z)
        return float(problem.along(self.point.z)[1][condition.which])


def error_points(track: SpecialPointCurve) -> dict[int, str]:
    """Indices of the points at which the error is estimated, with their kinds."""
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
    """The error at point i: the difference from the reference with more harmonics.

    The reference's turn is sought from point begin, by default a near one before the turn.
    """
    here = _RefinedPoint(setup, track.points[i])
    begin = beginning(track, i, setup.options) if begin is None else begin
    start = here if begin is None else _RefinedPoint(setup, track.points[begin])
    return _difference(track.condition, here, start, begin is not None)


def error_of_peak(setup: TrackingSetup, condition: Condition, point: TrackedPoint) -> float:
    """The relative error of a peak by the harmonics left out; NaN if the reference has no peak near it."""
    here = _RefinedPoint(setup, point)
    return _difference(condition, here, here, False).relative


def _difference(
    condition: Condition, here: _RefinedPoint, start: _RefinedPoint, turns: bool
) -> TruncationError:
    """The difference of the reference's point from `here`; for a turn, sought from `start` on."""
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
    """Index of the point from which a turn is sought: some points before it, but not beyond another turn.

    None if point i is no turn.
    """
    if not track.points[i].turn:
        return None
    j = i
    while j > max(0, i - options.error.points_before) and not track.points[j - 1].turn:
        j -= 1
    return j


def _more(found: _RefinedPoint) -> tuple[int, ...]:
    """The harmonics of the reference; those of the system if no contact slips or opens."""
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
    """The point with more harmonics: near the start, or the turn that follows it; None if not found."""
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
    """Whether a point is a peak, or a trough, with more harmonics as with fewer."""
    if condition.kind is not Kind.PEAK:
        return True
    tops = []
    for setup, one in ((wider, point), (start.setup, start.point)):
        problem = setup.tracked(condition)
        problem.evaluate_scale(one.z)
        tops.append(is_top(problem, one))
    return tops[0] == tops[1]
