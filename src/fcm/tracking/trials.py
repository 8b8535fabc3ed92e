"""The least peak by trials: of ordinary curves alone, where the peaks cannot be followed.

First at values of the number over all of its range, then ever nearer to the lowest. A lower one between two
of them would be missed, so what is said is between which.
"""

from __future__ import annotations

import numpy as np
from scipy.optimize import minimize_scalar

from fcm.tracking.lowest_peak import Search
from fcm.tracking.peak_envelope import Least


def by_trials(search: Search) -> Least | None:
    """The least of the greatest at the values that were tried; None where nothing has a peak."""
    low, high = search.span
    options = search.options.tracking.trials
    for value in np.linspace(low, high, options.values).tolist():
        _greatest(search, value)
    minimize_scalar(
        lambda value: _greatest(search, float(value)),
        bounds=_neighbours(search, _lowest(search)),
        method="bounded",
        options={"xatol": options.nearest * (high - low), "maxiter": options.closer},
    )
    s = _lowest(search)
    top = search.seen[s]
    if not top.value > 0.0:
        return None
    kind = "bound" if s in search.span else "trials"
    return Least(s, top.value, (top,), kind, _neighbours(search, s))


def _greatest(search: Search, value: float) -> float:
    """The greatest at a value; where there is no peak, none that could be least."""
    if value not in search.seen:
        search.greatest_at(value)
    unknown = search.options.tracking.envelope.unknown * max(height.value for height in search.seen.values())
    return search.seen[value].value or unknown


def _lowest(search: Search) -> float:
    return min(search.seen, key=lambda value: search.seen[value].value or np.inf)


def _neighbours(search: Search, s: float) -> tuple[float, float]:
    """The values on either side of one that were tried."""
    tried = sorted(search.seen)
    i = tried.index(s)
    return tried[max(i - 1, 0)], tried[min(i + 1, len(tried) - 1)]
