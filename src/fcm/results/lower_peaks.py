"""Peaks of a curve other than its highest: the local maxima of each degree of freedom along it."""

from __future__ import annotations

from itertools import pairwise
from math import isfinite

import numpy as np
import numpy.typing as npt

from fcm.contact.limits import FloatArray
from fcm.local_maxima import local_maxima, prominence
from fcm.results.options import RESULTS

_PARABOLA, _BEFORE, _BEHIND = (-1, 0, 1), (-2, -1, 0, 1), (-1, 0, 1, 2)  # points that polynomials go through
_SAMPLES = 129  # number of samples between two neighbours, including the middle point


def lower_peaks(amplitude: FloatArray) -> npt.NDArray[np.intp]:
    """Dof and point (peak, 2) of local maxima that are not the highest of their degree of freedom.

    amplitude (point, dof) has rows of NaN between branches; the ends of branches are not maxima.

    >>> u, v = [0.0, 2.0, 1.0, 5.0, 0.0], [0.0, 1.0, 2.0, 3.0, 4.0]
    >>> lower_peaks(np.transpose((u, v))).tolist()
    [[0, 1]]
    """
    points, dofs = np.nonzero(local_maxima(amplitude, RESULTS.peaks.least_share))
    if not points.size:
        return np.empty((0, 2), dtype=np.intp)
    highest = np.where(np.isnan(amplitude), -np.inf, amplitude).argmax(axis=0)
    found = [
        (d, k)
        for d, k in zip(dofs.tolist(), points.tolist(), strict=True)
        if k != highest[d]
        and prominence(amplitude[:, d], k) > RESULTS.peaks.least_prominence * amplitude[k, d]
    ]
    return np.array(sorted(found), dtype=np.intp).reshape(-1, 2)


def rise_beside(frequency: FloatArray, amplitude: FloatArray, k: int) -> float:
    """Relative rise, above local maximum k, of polynomials through it and its neighbours.

    Only the highest peaks are located on the curve; others may rise between two points by about as much. The
    result is the maximum of a parabola and of the cubics with one more point on either side.

    >>> x = np.array([0.0, 1.0, 3.0])
    >>> round(rise_beside(x, 4.0 - (x - 1.5) ** 2, 1), 3)
    0.067
    """
    first, end = max(k - 2, 0), min(k + 3, len(amplitude))
    x = _place_along(frequency[first:end], amplitude[first:end], k - first)
    y = (amplitude[first:end] / amplitude[k] - 1.0).tolist()
    top = k - first
    sets = [rows for rows in (_PARABOLA, _BEFORE, _BEHIND) if 0 <= top + rows[0] and top + rows[-1] < len(y)]
    return max(_rise([x[top + i] for i in rows], [y[top + i] for i in rows]) for rows in sets)


def _place_along(x: FloatArray, y: FloatArray, top: int) -> list[float]:
    """Abscissa, 0 at the top: the frequency, or beside a fold, where that turns, the length of the chords."""
    steps = np.abs(np.diff(x))
    if not ((np.diff(x) > 0.0).all() or (np.diff(x) < 0.0).all()):
        steps = np.hypot(*(np.diff(one) / (np.ptp(one) or 1.0) for one in (x, y)))
    place = np.concatenate(([0.0], np.cumsum(steps)))
    found: list[float] = (place - place[top]).tolist()
    return found


def _rise(x: list[float], y: list[float]) -> float:
    """The greatest value, between the neighbours of 0, of the polynomial through three or four points.

    0 if points coincide or are missing."""
    if not all(one < other for one, other in pairwise(x)) or not all(map(isfinite, y)):
        return 0.0
    top, unit = x.index(0.0), x[-1] - x[0]
    places = np.array(x) / unit
    coefficients = np.linalg.solve(np.vander(places), y)
    return float(np.polyval(coefficients, np.linspace(places[top - 1], places[top + 1], _SAMPLES)).max())
