r"""Errors of the peaks of a curve against those of its reference, in height and in frequency.

A peak of a degree of freedom is a local maximum of its amplitude a(s) along the curve. The reference's peak
is that of a(s) + e(s) between the same two minima, where e is the displacement to the reference. Both are the
tops of parabolas through three points.
"""

from __future__ import annotations

from itertools import pairwise
from typing import NamedTuple

import numpy as np

from fcm.accuracy.reference_curve import Indices, ReferenceCurve
from fcm.accuracy.reference_stretch import ReferencePiece
from fcm.frozen import Frozen
from fcm.local_maxima import local_maxima
from fcm.model.scene import FloatArray


class PeakErrors(Frozen):
    """Errors of the peaks (peak,) along a path, each with its point and degree of freedom.

    `height` is the difference as an amplitude, `frequency` the relative difference. Peaks without a peak of
    the reference beside them are left out.
    """

    point: Indices
    dof: Indices
    height: FloatArray
    frequency: FloatArray

    def at(self, tops: Indices) -> tuple[FloatArray, FloatArray]:
        """Errors (dof,) of heights and of frequencies at points tops (dof,); NaN where there is no peak."""
        height, frequency = np.full((2, len(tops)), np.nan)
        at_top = self.point == tops[self.dof]
        height[self.dof[at_top]], frequency[self.dof[at_top]] = self.height[at_top], self.frequency[at_top]
        return height, frequency


class _Tops(NamedTuple):
    """Heights and frequencies (peak,) of the tops of parabolas through three points each."""

    height: FloatArray
    frequency: FloatArray


def peak_errors(reference: ReferenceCurve, change: FloatArray) -> PeakErrors:
    """Errors of all peaks of a curve where displacements (point, 1 + dof) or the reference are known."""
    curve, arc = reference.amplitude, reference.arc
    parameter = reference.path.parameter
    of_reference = curve + reference.unit * change[:, 1:]
    frequency = parameter * (1.0 + change[:, 0])
    rows = list[tuple[int, int, int]]()  # point, dof, point that is displaced to the reference's peak
    beside = list[tuple[int, int, float, float]]()  # point, dof, height and frequency of the reference's
    for d, (own, moved) in enumerate(zip(curve.T, of_reference.T, strict=True)):
        for i, low, high in _between_minima(own, reference.options.least_peak):
            top = _displaced_top(moved, i, low, high)
            if top is not None:
                rows.append((i, d, top))
            elif (found := _followed_top(reference, d, i)) is not None:
                beside.append((i, d, *found))
    point, dof, to = np.array(rows, dtype=np.intp).reshape(-1, 3).T
    further = np.array(beside, dtype=np.float64).reshape(-1, 4).T
    there = _tops(to, dof, arc, of_reference, frequency)
    point, dof = np.concatenate(((point, dof), further[:2].astype(np.intp)), axis=1)
    here = _tops(point, dof, arc, curve, parameter)
    height, omega = np.concatenate((there, further[2:]), axis=1)
    return PeakErrors(point, dof, np.abs(height - here.height), np.abs(omega / here.frequency - 1.0))


def _between_minima(amplitude: FloatArray, least: float) -> list[tuple[int, int, int]]:
    """Local maxima above a fraction of the greatest amplitude, each with the minimum before and after it.

    >>> _between_minima(np.array([1.0, 3.0, 2.0, 4.0, 0.0]), 0.1)
    [(1, 0, 2), (3, 2, 4)]
    """
    tops = np.flatnonzero(local_maxima(amplitude[:, None], least)).tolist()
    minima = [i + int(amplitude[i : j + 1].argmin()) for i, j in pairwise((0, *tops, len(amplitude) - 1))]
    return list(zip(tops, minima, minima[1:], strict=False))


def _displaced_top(moved: FloatArray, i: int, low: int, high: int) -> int | None:
    """Index of the highest amplitude between low and high; None at an end, or beside unknown amplitudes."""
    inside = moved[low : high + 1]
    if np.isnan(moved[i]) or np.isnan(inside).all():
        return None
    top = low + int(np.nanargmax(inside))
    around = moved[min(i, top - 1) : max(i, top + 1) + 1]
    return top if low < top < high and not np.isnan(around).any() else None


def _followed_top(reference: ReferenceCurve, d: int, i: int) -> tuple[float, float] | None:
    """Height and frequency of the followed reference's peak nearest to that at point i, or None.

    It must be within `PairOptions.end_tolerance` in both; one farther away is another peak.
    """
    here = np.array((reference.amplitude[i, d], reference.path.parameter[i]))
    found = [
        top
        for one in reference.followed
        if one.first <= i < one.end
        for piece in one.pieces
        for top in _tops_of(piece, d)
    ]
    off = np.abs(np.array(found).reshape(-1, 2) / here - 1.0).max(axis=1)
    near = off.min(initial=np.inf) < reference.options.end_tolerance
    return found[int(off.argmin())] if near else None


def _tops_of(piece: ReferencePiece, d: int) -> list[tuple[float, float]]:
    """Heights and frequencies of the peaks of a degree of freedom along a piece of the reference."""
    amplitude = piece.quantities.amplitude
    k = np.array([top for top, _, _ in _between_minima(amplitude[:, d], 0.0)], dtype=np.intp)
    tops = _tops(k, np.full_like(k, d), piece.arc, amplitude, piece.path.parameter)
    return list(zip(tops.height.tolist(), tops.frequency.tolist(), strict=True))


def _tops(k: Indices, d: Indices, arc: FloatArray, amplitude: FloatArray, frequency: FloatArray) -> _Tops:
    """Tops of parabolas through amplitudes (point, dof) of d (peak,) at and beside points k (peak,)."""
    before, behind = arc[k] - arc[k - 1], arc[k + 1] - arc[k]
    apart = (before > 0.0) & (behind > 0.0)
    before, behind = np.where(apart, before, 1.0), np.where(apart, behind, 1.0)
    slope, bend = _parabola(before, behind, *(amplitude[k + step, d] for step in (-1, 0, 1)))
    turns = apart & (bend < 0.0)
    way = np.where(turns, np.clip(-slope / np.where(turns, 2.0 * bend, 1.0), -before, behind), 0.0)
    height = amplitude[k, d] + way * (slope + way * bend)
    slope, bend = _parabola(before, behind, *(frequency[k + step] for step in (-1, 0, 1)))
    return _Tops(height, frequency[k] + way * (slope + way * bend))


def _parabola(
    before: FloatArray, behind: FloatArray, one: FloatArray, middle: FloatArray, other: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Slope and half the second derivative at the middle of parabolas through three values each."""
    first, second = (middle - one) / before, (other - middle) / behind
    slope: FloatArray = (first * behind + second * before) / (before + behind)
    bend: FloatArray = (second - first) / (before + behind)
    return slope, bend
