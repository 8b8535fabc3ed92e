"""The least peak by trials: response curves only, where the peaks cannot be followed.

Values over the whole range of the number are tried first. Then the lowest local minima of these are refined,
and the lowest of all until it is about as high as its neighbours. A lower peak between two tried values may
be missed, so the result states its neighbours.
"""

from __future__ import annotations

import numpy as np
from scipy.optimize import minimize_scalar

from fcm.tracking.error import error_of_peak
from fcm.tracking.lowest_peak import LowestPeakSearch
from fcm.tracking.nonsmooth_continuation import land
from fcm.tracking.peak_envelope import EnvelopeMinimum


def by_trials(search: LowestPeakSearch) -> EnvelopeMinimum | None:
    """The least of the greatest peaks at the tried values; None if there is no peak."""
    low, high = search.span
    options = search.options.tracking.trials
    for value in np.linspace(low, high, options.values).tolist():
        _greatest(search, value)
    apart = [s for s in _local_minima(search) if not _is_flat(search, s, options.same_height)]
    for k in range(options.refinements):
        lowest = apart[k] if k < min(len(apart), options.minima) else _local_minima(search)[0]
        if k >= options.minima and _is_flat(search, lowest, options.close_height):
            break
        minimize_scalar(
            lambda value: _greatest(search, float(value)),
            bounds=_neighbours(search, lowest),
            method="bounded",
            options={"xatol": options.min_distance * (high - low), "maxiter": options.closer_values},
        )
    s = _local_minima(search)[0]
    top = search.visited_values[s]
    if not top.value > 0.0:
        return None
    if (flat := _flat_about(search, s)) is not None:
        return EnvelopeMinimum(s, top.value, (top,), "flat", flat=((0, *flat),))
    kind = "bound" if s in search.span else "trials"
    tried = tuple(
        (one, search.visited_values[one].value)
        for one in sorted(search.visited_values)
        if search.visited_values[one].value
    )
    return EnvelopeMinimum(s, top.value, (top,), kind, _neighbours(search, s), tried=tried)


def error_of_higher(search: LowestPeakSearch, best: EnvelopeMinimum) -> tuple[float, float]:
    """The greatest error of the higher peaks at the tried values next to the least, and its value.

    Such a peak decides which value is the least. The error is NaN if the reference has no such peak: a peak
    that exists only with few harmonics is spurious.
    """
    worst, at = 0.0, best.s
    for s in best.between or ():
        if not (found := search.known_points.get(s)):
            continue  # no peak there
        condition, top = max(found, key=lambda one: one[1].value)
        if not top.value > best.value * (1.0 + search.options.height_tolerance):
            continue
        point = land(search.setup, condition, top.z)
        error = np.nan if point is None else error_of_peak(search.setup, condition, point)
        if not error <= worst:
            worst, at = error, s
        if np.isnan(worst):
            break
    return worst, at


def _flat_about(search: LowestPeakSearch, s: float) -> tuple[float, float] | None:
    """Range of tried values about s with the same height; None if it is not wide enough."""
    options = search.options.tracking
    tried = sorted(search.visited_values)
    least = search.visited_values[s].value
    same = [
        abs(search.visited_values[one].value - least) <= options.trials.same_height * least for one in tried
    ]
    i = j = tried.index(s)
    while i > 0 and same[i - 1]:
        i -= 1
    while j + 1 < len(tried) and same[j + 1]:
        j += 1
    wide = tried[j] - tried[i] >= options.trials.min_flat * (search.span[1] - search.span[0])
    return (tried[i], tried[j]) if wide else None


def _greatest(search: LowestPeakSearch, value: float) -> float:
    """Greatest height at a value; without a peak, a height that cannot be the least."""
    if value not in search.visited_values:
        search.greatest_at(value)
    unknown = search.options.tracking.envelope.unknown_factor * max(
        height.value for height in search.visited_values.values()
    )
    return search.visited_values[value].value or unknown


def _local_minima(search: LowestPeakSearch) -> list[float]:
    """The tried values with no lower neighbour, the lowest first."""
    tried = sorted(search.visited_values)
    height = np.array([search.visited_values[value].value or np.inf for value in tried])
    around = np.pad(height, 1, constant_values=np.inf)
    lowest = np.flatnonzero((height <= around[:-2]) & (height <= around[2:]))
    return [tried[i] for i in lowest[np.argsort(height[lowest], kind="stable")]]


def _is_flat(search: LowestPeakSearch, s: float, tolerance: float) -> bool:
    """Whether a tried value and its neighbours have peaks of the same height to a tolerance."""
    heights = [search.visited_values[one].value for one in {s, *_neighbours(search, s)}]
    return max(heights) - min(heights) <= tolerance * max(heights)


def _neighbours(search: LowestPeakSearch, s: float) -> tuple[float, float]:
    """The tried values next to s on either side; s itself at an end."""
    tried = sorted(search.visited_values)
    i = tried.index(s)
    return tried[max(i - 1, 0)], tried[min(i + 1, len(tried) - 1)]
