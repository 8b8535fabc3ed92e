"""The greatest amplitudes of a corrected curve, and where they cannot be told."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import numpy.typing as npt

from fcm.continuation import Mark
from fcm.harmonic.believed import runs
from fcm.harmonic.corrected import TOGETHER, Corrected, Indices
from fcm.harmonic.shifted import rises
from fcm.harmonic.stretch import TRIES, effort_of, heights
from fcm.scene.model import FloatArray

RIVAL = 0.8  # of the greatest amplitude: what is this high may become the greatest
LEAP = 4.0  # times what it changes along itself, and is displaced at its ends: a stretch rises by no more
GAP = 0.2  # of a change of an amplitude, by which it may be more in the gap that a moved corner leaves
FEW = 8  # points in a row without a displacement, as beside a corner: those around them tell enough


def settling_at_ends(corrected: Corrected, growth: FloatArray, tops: Indices) -> FloatArray:
    """By how much (dof,) the corrected amplitudes at the ends of a path, if tops are there, still change at
    the frequencies of the tops until they settle; growth (point, dof) of the amplitudes along the path.
    """
    path, more = corrected.path, np.zeros(len(tops))
    for end in {0, len(path.z) - 1}.intersection(tops.tolist()):
        settled, rate = corrected.settled_at(end), path.direction[end, -1]
        if settled is None or rate == 0.0:
            continue
        off = settled - corrected.change[end]
        along = growth[end] / rate * path.parameter[end]  # change of the amplitudes over that of frequency
        at = corrected.unit[end] * off[1:] - along * off[0]
        more = np.where((tops == end) & np.isfinite(at), at, more)
    return more


def crests(corrected: Corrected, growth: FloatArray, change: FloatArray, tops: Indices) -> FloatArray:
    """Greatest amplitudes of the corrected curve (dof,).

    That is of a curve with growth (point, dof) of the amplitudes along it, which change (point, dof), and are
    greatest at the tops. Unknown where the corrected curve is not known at the highest point, or along a
    stretch that is nearly as high and may become the highest.
    """
    amplitude = corrected.amplitude
    d = np.arange(len(tops))
    now = amplitude[tops, d]
    change, places = _highest(corrected, change)
    value = amplitude[places, d] + corrected.unit[places, d] * change[places, d]
    greatest = corrected.settled(places, value)
    greatest += rise_beside(corrected, growth, corrected.unit * change, places)
    for top in np.unique(tops[(corrected.path.mark[tops] & Mark.CORNER) > 0]).tolist():
        if _gap(corrected, growth, top):
            beyond = heights(corrected, top - 1, top + 1)
            greatest = (
                greatest if beyond is None else np.maximum(greatest, np.where(tops == top, beyond, 0.0))
            )
    stretches = list(_rivals(corrected, change, tops, now))
    unknown = _too_long(corrected, stretches, len(tops))
    for first, end, rivals in stretches:
        rivals = rivals & ~unknown
        if rivals.any():
            followed = heights(corrected, first - 1, end)
            more = None if followed is None else _settling(corrected, (first - 1, end))
            if followed is None or more is None:
                unknown |= rivals
            else:
                greatest = np.maximum(greatest, followed * (1.0 + more))
    known: FloatArray = np.where(unknown, np.nan, greatest)
    return known


def _rivals(
    corrected: Corrected, change: FloatArray, tops: Indices, now: FloatArray
) -> Iterator[tuple[int, int, npt.NDArray[np.bool_]]]:
    """Stretches without displacements, first to before end, with those (dof,) that may be highest there."""
    for first, end in runs(np.isnan(change[:, 0])):
        rivals = (first <= tops) & (tops < end)
        if end - first > FEW:
            rivals |= _may_exceed(corrected, change, first, end, now)
        yield first, end, rivals


def _too_long(
    corrected: Corrected, stretches: list[tuple[int, int, npt.NDArray[np.bool_]]], dofs: int
) -> npt.NDArray[np.bool_]:
    """Those (dof,) whose stretches, each of which must be followed, together take more than is left of the
    effort: then none of them need be."""
    effort = np.zeros(dofs)
    for first, end, rivals in stretches:
        if rivals.any():
            effort += rivals * effort_of(corrected, first - 1, end)
    long: npt.NDArray[np.bool_] = effort > corrected.effort
    return long


def _settling(corrected: Corrected, ends: tuple[int, int]) -> FloatArray | None:
    """By how much (dof,) amplitudes beside a stretch change, relative, until they settle: of both ends, or
    of points near them, which is more. None where more harmonics lead nowhere at an end: with those that the
    stretch is followed with, it is of no branch that others have, too. Not looked for where that is dear."""
    path, found = corrected.path, [np.zeros(corrected.amplitude.shape[1])]
    if not corrected.corrector.ranking.cheap:
        return found[0]
    for end, way in zip(ends, (-1, 1), strict=True):
        places = [i for i in range(end, end + way * TRIES, way) if 0 <= i < len(path.z)]
        corrected.find(np.array(places, dtype=np.intp))
        for i in places:
            settled = corrected.corrector.settled(path.z[i], path.direction[i], corrected.amplitude[i])
            if np.isfinite(settled + corrected.change[i]).all():
                once = corrected.amplitude[i] + corrected.unit[i] * corrected.change[i, 1:]
                found.append((settled[1:] - once) / corrected.unit[i])
                break
        else:
            if places:
                return None
    return max(found, key=lambda change: float(np.abs(change).max()))


def _highest(corrected: Corrected, change: FloatArray) -> tuple[FloatArray, Indices]:
    """Changes (point, dof) and where (dof,) with them a corrected curve is highest of the points where it is
    found: also at those near the highest that are expected to be higher, as an interpolated one may be."""
    change, count, near = change.copy(), len(change), np.arange(-TOGETHER, TOGETHER + 1)[:, None]
    while True:
        expected = corrected.amplitude + corrected.unit * change
        found = corrected.known[:, None] & np.isfinite(change)
        value = np.where(found, expected, 0.0)
        places = value.argmax(axis=0)
        d, around = np.arange(len(places)), np.clip(places + near, 0, count - 1)
        higher = ~corrected.known[around] & (expected[around, d] > value[places, d])
        if not higher.any():
            return change, places
        new = np.unique(around[higher])
        corrected.find(new, True)
        change[new] = corrected.change[new, 1:]


def rise_beside(corrected: Corrected, growth: FloatArray, moved: FloatArray, places: Indices) -> FloatArray:
    """By how much (dof,) a curve whose amplitudes are moved (point, dof) is higher between its highest points
    and the next; places: the indices of the highest.

    Of the amplitudes that is the cubic with their growth, of what they are moved by a straight line. Nothing
    is told of what lies between a point and a corner.
    """
    corner = ((corrected.path.mark & Mark.CORNER) > 0).view(np.uint8)
    return rises(corrected.place, corrected.amplitude, growth, moved, corner, places)


def _may_exceed(
    corrected: Corrected, change: FloatArray, first: int, end: int, now: FloatArray
) -> npt.NDArray[np.bool_]:
    """Whether the corrected curve (dof,) may be higher than now along a stretch without displacements."""
    inside, ends = corrected.amplitude[first:end], [i for i in (first - 1, end) if 0 <= i < len(change)]
    highest = inside.max(axis=0)
    may: npt.NDArray[np.bool_] = highest > RIVAL * now
    if ends:
        moved = (np.abs(change[ends]) * corrected.unit[ends]).max(axis=0)
        may &= highest + LEAP * (np.ptp(inside, axis=0) + moved) > now
    return may


def _gap(corrected: Corrected, growth: FloatArray, top: int) -> bool:
    """Whether a corner moves so far along the curve that no point of the corrected one is near its top.

    Of the two pieces of the corrected curve beside it one then goes on beyond what is displaced to it.
    """
    path, beside = corrected.path, np.array([top - 1, top + 1])
    if top == 0 or top == len(path.z) - 1:
        return False
    corrected.find(beside)
    moved = path.parameter[beside] * corrected.change[beside, 0]
    slope = np.abs(growth[beside] / path.direction[beside, -1][:, None]).min(axis=0)
    higher = np.abs(moved[1] - moved[0]) * slope
    changed = np.abs(corrected.change[beside, 1:]).max(axis=0) * corrected.unit[top]
    top_of = corrected.amplitude[top] >= corrected.amplitude.max(axis=0)
    return bool((higher > GAP * changed)[top_of].any())
