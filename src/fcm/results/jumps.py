"""Slow sweeps of the frequency along a curve: where they jump, and where they may have jumped."""

from __future__ import annotations

from dataclasses import replace
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from fcm.distinct_values import distinct_values
from fcm.frozen import Frozen
from fcm.model.scene import FloatArray
from fcm.results.options import RESULTS
from fcm.unknown_stability import unknown_stability

BoolArray = npt.NDArray[np.bool_]
JUMPS = RESULTS.jumps
UNKNOWN = 0.5  # between unstable, 0, and stable, 1


class Jump(Frozen):
    """Jump of a slow sweep: the frequency where it leaves a stable part of a curve, and where it lands."""

    sweep: str  # 'up' or 'down'
    frequency: float  # [rad/s]
    before: FloatArray  # (dof,) amplitude
    after: FloatArray  # (dof,) amplitude; NaN if the curve has no stable part to land on
    # forcing periods after which the motion repeats, before and after; 0 if it does not repeat, or is unknown
    periods: tuple[int, int] = (1, 1)
    known: bool = (
        True  # whether the motion after it is known to be stable, and not only not known to be unstable
    )


class UnknownStability(Frozen):
    """A stretch of a slow sweep with motions of unknown stability: the sweep may jump within it."""

    sweep: str  # 'up' or 'down'
    start: float  # [rad/s] up to which the motion is known to be stable
    end: float  # [rad/s] from which that is known again, or where the sweep jumps or ends
    before: FloatArray  # (dof,) amplitude at the start


class FrequencySweep(Frozen):
    """Jumps of a slow upward, then a slow downward sweep, and stretches of unknown stability."""

    jumps: list[Jump]
    unknown: list[UnknownStability]

    def without_flips(self) -> FrequencySweep:
        """The sweep without jumps at which the period doubles and the amplitude hardly changes."""
        change = [
            np.abs(one.after - one.before) > JUMPS.flip_tolerance * np.maximum(one.before, one.after)
            for one in self.jumps
        ]
        kept = [
            one for one, by in zip(self.jumps, change, strict=True) if by.any() or np.isnan(one.after).any()
        ]
        return replace(self, jumps=kept)

    def at(self, shown: BoolArray) -> FrequencySweep:
        """The sweep restricted to some degrees of freedom."""
        jumps = [replace(one, before=one.before[shown], after=one.after[shown]) for one in self.jumps]
        return FrequencySweep(jumps, [replace(one, before=one.before[shown]) for one in self.unknown])


def swept(
    frequency: FloatArray,
    amplitude: FloatArray,
    stable: FloatArray,
    repeats: FloatArray | None = None,
) -> FrequencySweep:
    """Jumps of slow sweeps along a curve; amplitude (point, dof), stable 1, 0, or NaN where unknown.

    repeats : (point,) forcing periods after which each motion repeats, by default 1

    A sweep begins at the first frequency with a motion that is not known to be unstable. It stays on such
    motions, and records where stability is unknown.

    >>> w = np.array([1.0, 2.0, 3.0, 2.5, 2.0, 3.0, 4.0])
    >>> found = swept(w, w[:, None] + [[0], [0], [0], [1], [2], [2], [2]], np.ones(7))
    >>> [(j.sweep, j.frequency, j.after.tolist()) for j in found.jumps], found.unknown
    ([('up', 3.0, [5.0]), ('down', 2.0, [2.0])], [])
    >>> w = np.array([1.0, 2.0, 3.0, np.nan, 2.5, 3.0])  # a stable branch leaves one that is not beyond
    >>> swept(w, np.array([[1.0, 1.0, 1.0, np.nan, 1.0, 2.0]]).T, np.array([1, 1, 0, np.nan, 1, 1])).jumps
    []
    >>> w = np.array([1.0, 2.0, np.nextafter(2.0, 1.0), 3.0])  # a peak at a corner is there twice
    >>> swept(w, w[:, None], np.ones(4)).jumps
    []
    >>> found = swept(w, w[:, None], np.array([1.0, np.nan, np.nan, 1.0]))
    >>> [(one.sweep, one.start, one.end) for one in found.unknown]
    [('up', 1.0, 3.0), ('down', 3.0, 1.0)]

    A sweep that jumps onto a motion of unknown stability records that:

    >>> w = np.array([1.0, 2.0, 1.5, 1.0, 2.0, 3.0])
    >>> jumps = swept(w, np.arange(6.0)[:, None], np.array([1, 1, 0, np.nan, np.nan, 1])).jumps
    >>> [(one.sweep, one.frequency, one.known) for one in jumps]
    [('up', 2.0, False)]
    """
    points = _Points(frequency, amplitude, stable, np.ones(stable.size) if repeats is None else repeats)
    points = _with_branch_points(_once(points))
    found = FrequencySweep([], [])
    for sweep in ("up", "down"):
        _sweep(points, sweep, found, JUMPS.amplitude_tolerance)
    return found


class _Points(NamedTuple):
    """Points of a curve, with the arrays of `swept`."""

    frequency: FloatArray
    amplitude: FloatArray
    stable: FloatArray
    repeats: FloatArray

    def periods(self, point: int) -> int:
        """Forcing periods after which the motion at a point repeats; 0 if unknown."""
        return int(np.nan_to_num(self.repeats[point]))


def _once(points: _Points) -> _Points:
    """The points without duplicates, such as a peak at a corner.

    If stability changes there, one point is stable and the other not; the stable one is kept, so that a walk
    along the stable side reaches it.
    """
    frequency, amplitude, stable, repeats = points
    again = np.abs(np.diff(frequency)) <= JUMPS.frequency_tolerance * frequency[1:]
    again &= np.isclose(amplitude[1:], amplitude[:-1], rtol=JUMPS.amplitude_tolerance, atol=0.0).all(axis=1)
    if not again.any():
        return points
    kept = np.concatenate(([0], np.flatnonzero(~again) + 1))
    best = np.maximum.reduceat(np.where(np.isnan(stable), UNKNOWN, stable), kept)
    return _Points(frequency[kept], amplitude[kept], np.where(best == UNKNOWN, np.nan, best), repeats[kept])


def _with_branch_points(points: _Points) -> _Points:
    """The curve with a stable point inserted where a stable branch leaves another branch.

    That place is between two points of the other branch, of which one is stable. The branch ends there. Or it
    continues there as its mirror image: then its frequency turns back, and it is stable on both sides.
    """
    frequency, amplitude, stable, repeats = points
    stays, rises = stable == 1.0, np.sign(np.diff(frequency))
    runs = np.diff(np.concatenate(([False], stays, [False])).astype(int))
    turns = 1 + np.flatnonzero((rises[:-1] * rises[1:] < 0.0) & stays[:-2] & stays[1:-1] & stays[2:])
    ends = distinct_values(np.flatnonzero(runs > 0), np.flatnonzero(runs < 0) - 1, turns)
    changes = np.flatnonzero(np.diff(stays) & np.isfinite(frequency[:-1] + frequency[1:]))
    places = list[tuple[int, int]]()  # index after a point, and point to insert there
    for k in changes.tolist():
        share = (frequency[ends] - frequency[k]) / (frequency[k + 1] - frequency[k])
        for end, part in zip(ends.tolist(), share.tolist(), strict=True):
            if 0.0 < part < 1.0:
                there = (1.0 - part) * amplitude[k] + part * amplitude[k + 1]
                tolerance = JUMPS.branch_point_tolerance * float(there.max())
                if (np.abs(amplitude[end] - there) <= tolerance).all():
                    places.append((k + 1, end))
    if not places:
        return points
    at, what = np.array(places).T
    return _Points(
        np.insert(frequency, at, frequency[what]),
        np.insert(amplitude, at, amplitude[what], axis=0),
        np.insert(stable, at, 1.0),
        np.insert(repeats, at, repeats[what]),
    )


def _sweep(points: _Points, sweep: str, found: FrequencySweep, same: float) -> None:
    """Walk along stable segments in the direction of the sweep, and jump where they end.

    same: relative difference up to which amplitudes are equal.
    """
    frequency, amplitude, stable, _ = points
    sign = 1.0 if sweep == "up" else -1.0
    rises = np.diff(sign * frequency)
    bears = stable != 0.0
    usable = bears[:-1] & bears[1:] & (rises != 0.0) & np.isfinite(rises)
    onwards = np.where(usable, np.sign(rises), 0.0).tolist()  # a list is faster, element by element
    if not usable.any():  # no motion to follow
        return
    lowest = np.where(usable, np.minimum(sign * frequency[:-1], sign * frequency[1:]), np.inf)
    begin = int(lowest.argmin())
    at = begin if rises[begin] > 0.0 else begin + 1
    unknown = unknown_stability(stable)
    uncertain_at = bool(unknown.any())
    visited: set[int] = set()
    start, told = (float(frequency[at]), amplitude[at]), not unknown[at]
    while at not in visited:
        walked = _walked(at, onwards)
        visited.update(walked)
        if uncertain_at:
            _note_unknown(sweep, (frequency, amplitude, unknown), walked, start, told, found)
        at = walked[-1]
        here, before = float(frequency[at]), amplitude[at]
        if here == (np.nanmax(frequency) if sweep == "up" else np.nanmin(frequency)):
            return
        there = _others(sign * frequency, usable, at)
        if not there.size:
            lost = np.full_like(before, np.nan)
            found.jumps.append(Jump(sweep, here, before, lost, (points.periods(at), 0)))
            return
        share = (here - frequency[there]) / (frequency[there + 1] - frequency[there])
        landed = amplitude[there] + share[:, None] * (amplitude[there + 1] - amplitude[there])
        meets = np.isclose(landed, before, rtol=same, atol=same * float(before.max())).all(axis=1)
        which = int(meets.argmax())  # where a closed curve begins and ends, the sweep continues on it
        onto, after = int(there[which]), landed[which]
        start, told = (here, after), not unknown[onto : onto + 2].any()
        if not meets[which]:
            periods = points.periods(at), max(points.periods(onto), points.periods(onto + 1))
            found.jumps.append(Jump(sweep, here, before, after, periods, known=told))
        at = onto + 1 if rises[onto] > 0.0 else onto


def _walked(at: int, onwards: list[float]) -> list[int]:
    """Points along stable segments that lead onwards from start to end (1), or from end to start (-1)."""
    walked = [at]
    while True:
        if at < len(onwards) and onwards[at] > 0.0:
            at += 1
        elif at > 0 and onwards[at - 1] < 0.0:
            at -= 1
        else:
            return walked
        walked.append(at)


def _note_unknown(
    sweep: str,
    curve: tuple[FloatArray, FloatArray, BoolArray],
    walked: list[int],
    start: tuple[float, FloatArray],
    told: bool,
    found: FrequencySweep,
) -> None:
    """Note the stretches of unknown stability of a walk that begins before its first point."""
    frequency, amplitude, there = curve
    unknown = np.array([not told, *there[walked].tolist()])
    if not unknown.any():
        return
    edges = np.diff(unknown.astype(int), prepend=0, append=0)
    sides = (np.flatnonzero(side).tolist() for side in (edges > 0, edges < 0))
    for first, end in zip(*sides, strict=True):
        last = walked[min(end, len(walked)) - 1]  # the first that is known again, if any
        k = walked[max(first - 2, 0)]
        begin, before = start if first < 2 else (float(frequency[k]), amplitude[k])
        if begin != frequency[last]:
            found.unknown.append(UnknownStability(sweep, begin, float(frequency[last]), before))


def _others(onwards: FloatArray, usable: BoolArray, at: int) -> npt.NDArray[np.intp]:
    """Other stable segments that continue from the same frequency: first the next one along the curve.

    Without a later one, the last of the earlier ones is first. `onwards` grows in the sweep's direction.
    """
    ends = np.sort((onwards[:-1], onwards[1:]), axis=0)
    holds = usable & (ends[0] <= onwards[at]) & (onwards[at] < ends[1])
    holds[max(at - 1, 0) : at + 1] = False
    found = np.flatnonzero(holds)
    return np.concatenate((found[found > at], found[found < at][::-1]))
