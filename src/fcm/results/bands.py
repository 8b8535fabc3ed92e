"""Bands of the response over random draws: percentiles of the amplitude at each frequency."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from typing import Protocol

import numpy as np
import numpy.typing as npt

from fcm.frozen import Frozen
from fcm.model.scene import FloatArray
from fcm.results.options import RESULTS
from fcm.results.scatter import draws_beyond


class ReadCurve(Protocol):
    """Protocol of a curve as stored in a file.

    parameters: swept values; frequency (point,); amplitude (point, dof); stable: mask of stable points, or
    None.
    """

    @property
    def parameters(self) -> dict[str, float]: ...
    @property
    def frequency(self) -> FloatArray: ...
    @property
    def amplitude(self) -> FloatArray: ...
    @property
    def stable(self) -> npt.NDArray[np.bool_] | None: ...


class Band(Frozen):
    """Percentile band of the curves that differ only in drawn numbers; NaN at frequencies that none reaches.

    With too few draws for a percentage, the band extends to their minimum or maximum.
    """

    parameters: dict[str, float]  # the swept values that are not drawn
    frequency: FloatArray  # (place,)
    low: FloatArray
    median: FloatArray
    high: FloatArray
    draws: int  # number of its curves
    reached: tuple[float, float]  # the percentages of low and high


def bands_of(
    curves: Sequence[ReadCurve],
    drawn: Collection[str],
    column: int,
    span: tuple[float, float],
    wide: bool = False,
) -> list[Band]:
    """A band for each combination of the swept values that are not drawn.

    Parameters
    ----------
    curves : sequence
        Curves with at least one point each.
    drawn : collection of str
        The swept keys whose values are random.
    column : int
        Column of the degree of freedom.
    span : (low, high)
        The percentages of the band.
    wide : bool
        Whether the frequencies of the band are a geometric progression.
    """
    frequencies = np.concatenate([curve.frequency for curve in curves])
    ends = float(np.nanmin(frequencies)), float(np.nanmax(frequencies))
    places = (np.geomspace if wide else np.linspace)(*ends, RESULTS.draws.band_frequencies)
    groups: dict[tuple[tuple[str, float], ...], list[FloatArray]] = {}
    for curve in curves:
        key = tuple((k, v) for k, v in curve.parameters.items() if k not in drawn)
        groups.setdefault(key, []).append(greatest_at(curve, column, places))
    return [_band(dict(key), places, values, span) for key, values in groups.items()]


def greatest_at(curve: ReadCurve, column: int, places: FloatArray) -> FloatArray:
    """The greatest stable amplitude at given frequencies, by interpolation; NaN where there is none."""
    x, y = curve.frequency, curve.amplitude[:, column]
    stable = np.ones(x.size, bool) if curve.stable is None else curve.stable
    if x.size == 1:
        return np.where(places == x[0], y[0], np.nan)
    out = np.full(places.size, np.nan)
    for k in np.flatnonzero(np.isfinite(np.diff(x)) & stable[:-1] & stable[1:]):
        one, other = (k, k + 1) if x[k] <= x[k + 1] else (k + 1, k)
        at = slice(*np.searchsorted(places, (x[one], x[other]), side="left") + np.array([0, 1]))
        inside = places[at][places[at] <= x[other]]
        if inside.size:
            value = np.interp(inside, x[[one, other]], y[[one, other]])
            out[at.start : at.start + inside.size] = np.fmax(out[at.start : at.start + inside.size], value)
    return out


def _band(
    parameters: dict[str, float], places: FloatArray, values: Sequence[FloatArray], span: tuple[float, float]
) -> Band:
    stack = np.array(values)
    known = np.isfinite(stack).any(axis=0)
    found = np.full((3, places.size), np.nan)
    reached = reached_by(len(values), span)
    found[:, known] = np.nanpercentile(stack[:, known], (reached[0], 50.0, reached[1]), axis=0)
    low, median, high = found
    return Band(parameters, places, low, median, high, len(values), reached)


def reached_by(count: int, span: tuple[float, float]) -> tuple[float, float]:
    """The percentages of a band of `count` draws: 0 or 100 if there are too few draws for one of `span`.

    >>> reached_by(19, (5.0, 95.0)), reached_by(20, (5.0, 95.0)), reached_by(3, (0.0, 60.0))
    ((0.0, 100.0), (5.0, 95.0), (0.0, 60.0))
    """
    low, high = (
        end if 0.0 < end < 100.0 and count >= draws_beyond(end) else (0.0 if end <= 50.0 else 100.0)
        for end in span
    )
    return low, high
