"""Stretches of a curve beside which the corrected curve is not found point by point: it is followed there.

Where a corner or a pair of folds has moved, no point of the corrected curve lies normal to the curve. But it
does on both sides, and from one of them the corrected curve can be followed to the other.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from fcm.continuation import follow
from fcm.harmonic.corrected import Corrected
from fcm.harmonic.points import Points
from fcm.scene.model import FloatArray

STEP = 0.1  # longest, along the corrected curve
PATIENCE = 30  # reports of the follower, of 16 steps each, before it is given up
SAME = 0.02  # relative difference of amplitudes, up to which the curve has come to the other side
BEYOND = 1.0  # times the width of a stretch, how far beyond it the curve is followed
TRIES = 8  # points at an end of a stretch, from which it is sought


class _LostError(Exception):
    """The curve leads too far."""


def heights(corrected: Corrected, first: int, last: int) -> FloatArray | None:
    """Greatest amplitudes (dof,) of the corrected curve from point first to point last of the path.

    These are the last points before and behind a stretch at which it was found. None if it does not lead from
    one to the other.
    """
    path = corrected.path
    if first < 0 or last >= len(path.z):
        return None
    more = corrected.sets(np.unique(np.linspace(first, last, 5).astype(np.intp)))
    before = _end(corrected, more, range(first, max(first - TRIES, -1), -1))
    behind = _end(corrected, more, range(last, min(last + TRIES, len(path.z))))
    if before is None or behind is None:
        return None
    part = path.parameter[before.number : behind.number + 1]
    span = _span(np.append(part, (before.z[-1], behind.z[-1])))
    found = _across(corrected, more, before, behind, span, before.rises)
    return _across(corrected, more, behind, before, span, not behind.rises) if found is None else found


@dataclass(frozen=True)
class _End:
    """A point of the corrected curve at an end of a stretch, and whether the frequency rises there."""

    number: int
    z: FloatArray
    amplitude: FloatArray
    rises: bool


def _end(corrected: Corrected, more: tuple[int, ...], places: Iterable[int]) -> _End | None:
    """At the first of some places where there is one."""
    path, lifted = corrected.path, corrected.corrector.lifted(more)
    for i in places:
        if lifted.beside(path.z[i], path.direction[i]):
            rises = lifted.newton.tangent[-1] > 0.0
            return _End(i, np.array(lifted.newton.z), np.array(lifted.found[1:]), bool(rises))
    return None


def _across(
    corrected: Corrected,
    more: tuple[int, ...],
    begin: _End,
    end: _End,
    span: tuple[float, float],
    forward: bool,
) -> FloatArray | None:
    """Greatest amplitudes of the corrected curve from one end to the other, if it leads there."""
    balance = corrected.corrector.system.with_harmonics(more).balance()
    reports = 0

    def count(_: float) -> None:
        nonlocal reports
        reports += 1
        if reports > PATIENCE:
            raise _LostError

    try:
        path = follow(balance, begin.z, span, forward, STEP, (float(end.z[-1]),), count)
    except _LostError:
        return None
    points = Points(balance, len(path.z))
    points.take(path.z, path.direction, np.ones(len(path.z)))
    amplitude = np.asarray(points.amplitude)
    off = np.abs(amplitude - end.amplitude).max(axis=1, initial=0.0)
    arrived = np.flatnonzero((path.parameter == end.z[-1]) & (off < SAME * end.amplitude.max()))
    if not arrived.size:
        return None
    greatest: FloatArray = amplitude[: arrived[0] + 1].max(axis=0)
    return greatest


def _span(inside: FloatArray) -> tuple[float, float]:
    """Frequencies, and beyond them, as folds may have moved."""
    low, high = float(inside.min()), float(inside.max())
    return low - BEYOND * (high - low), high + BEYOND * (high - low)
