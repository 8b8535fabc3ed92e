"""The end of a higher peak that determines the least peak, and the error of the number at which it ends."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from fcm.tracking.curve import SpecialPointCurve
from fcm.tracking.error import truncation_error
from fcm.tracking.peak_envelope import EnvelopeMinimum
from fcm.tracking.tracked_point import Ending, TrackingSetup


class EndingPeak(NamedTuple):
    """The end of the higher peak that ends closest to a least peak.

    error: relative error of the number at which it ends, NaN if unknown. beside: a number at which it still
    exists. leaves_range: frequency [rad/s] at which it leaves the traced range, or NaN.
    """

    error: float
    beside: float
    leaves_range: float = np.nan


def ending_peak(
    setup: TrackingSetup, curves: Sequence[SpecialPointCurve], least: EnvelopeMinimum
) -> EndingPeak:
    """The end of the higher peak that ends closest to a least peak, with its error.

    If its curve turns there, the error is that of the turn, from the turn of the curve with more harmonics.
    For other ends the error is unknown.
    """
    ends = [
        (abs(float(curve.s[i]) - least.s), curve, i)
        for curve in curves
        for i in _ends(curve)
        if curve.amplitude[i, curve.condition.which] > least.value
    ]
    if not ends:
        return EndingPeak(np.nan, least.s)
    _, curve, i = min(ends, key=lambda one: one[0])
    if i == 0:
        curve, i = _turned(curve), len(curve.points) - 1
    leaves = i == len(curve.points) - 1 and curve.endings[-1] is Ending.RANGE
    of_an_end = (
        curve.frequency[i] in setup.system.scene.frequency_range
    )  # a curve of the amplitude at an end of the range
    at = float(curve.frequency[i]) if leaves or of_an_end else np.nan
    before = np.flatnonzero(abs(curve.s[:i] - least.s) >= setup.options.error.before_end * abs(least.s))
    begin = int(before[-1]) if before.size else 0
    beside = float(curve.s[begin])
    if not curve.points[i].turn or least.s == 0.0:
        return EndingPeak(np.nan, beside, at)
    return EndingPeak(truncation_error(setup, curve, i, begin).number / abs(least.s), beside, at)


def leaves_range(curves: Sequence[SpecialPointCurve], least: EnvelopeMinimum) -> float:
    """The frequency [rad/s] at which the curve of a least peak leaves the traced range, or NaN.

    If it leaves, there is no peak within the range beyond this number.
    """
    for curve in curves:
        for i, ending in zip((0, -1), curve.endings, strict=True):
            if ending is Ending.RANGE and curve.s[i] == least.s:
                return float(curve.frequency[i])
    return np.nan


def _ends(curve: SpecialPointCurve) -> list[int]:
    """Points where a curve of peaks ends, or becomes a trough."""
    changes = np.flatnonzero(curve.greatest[:-1] & ~curve.greatest[1:]).tolist()
    return sorted({0, len(curve.points) - 1, *changes})


def _turned(curve: SpecialPointCurve) -> SpecialPointCurve:
    """The curve in reverse order."""
    points = tuple(replace(one, direction=-one.direction) for one in curve.points[::-1])
    return replace(
        curve,
        points=points,
        s=curve.s[::-1],
        frequency=curve.frequency[::-1],
        amplitude=curve.amplitude[::-1],
        greatest=curve.greatest[::-1],
        endings=curve.endings[::-1],
    )
