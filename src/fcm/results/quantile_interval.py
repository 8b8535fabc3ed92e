r"""Distribution-free confidence intervals of quantiles, from a sample whose values have errors.

Among n independent draws, the number below the quantile of order p is binomial. So the quantile lies between
the ordered values of ranks l < u with the probability

.. math:: P(l \le B < u), \qquad B \sim \mathrm{Bin}(n, p).

The ranks are the innermost for which P(B < l) and P(B >= u) are each at most half of 1 - confidence. With few
draws there is no such rank. The least count is that of Wilks (1941), 59 for 5 or 95 % at a confidence of 90
%.

Errors of the values are included. If each value lies in an interval of its own, each ordered value lies
between the ordered lower ends and the ordered upper ends. So the lower end is that of rank l among the lower
ends, and the upper end that of rank u among the upper ends.
"""

from __future__ import annotations

import math

import numpy as np

from fcm.model.scene import FloatArray
from fcm.results.options import RESULTS


def ranks(count: int, percent: float, confidence: float = RESULTS.draws.confidence) -> tuple[int, int]:
    """Ranks (l, u) of the ordered values that bound a percentile; 0 and count + 1 if none does.

    >>> ranks(10, 50.0), ranks(59, 95.0), ranks(58, 95.0)
    ((2, 9), (53, 59), (52, 59))
    """
    lower = _lower_rank(count, percent / 100.0, confidence)
    return lower, count + 1 - _lower_rank(count, 1.0 - percent / 100.0, confidence)


def _lower_rank(count: int, share: float, confidence: float) -> int:
    """The greatest l with P(B < l) within the tail; 0 if there is none."""
    from scipy.special import bdtr  # most runs do not need it

    below = bdtr(np.arange(count), count, share)  # P(B <= k)
    return int(np.searchsorted(below, 0.5 * (1.0 - confidence), side="right"))


def draws_needed(percent: float) -> float:
    """Least number of draws for which both ends of the interval of a percentile are known.

    >>> [draws_needed(percent) for percent in (5.0, 25.0, 50.0, 95.0, 100.0)]
    [59, 11, 5, 59, inf]
    """
    inner = max(percent, 100.0 - percent) / 100.0
    outside = 0.5 * (1.0 - RESULTS.draws.confidence)
    return math.ceil(math.log(outside) / math.log(inner)) if inner < 1.0 else math.inf


def intervals(
    values: FloatArray, errors: FloatArray, percents: tuple[float, ...], confidence: float, left_out: int = 0
) -> FloatArray:
    """Intervals (percent, 2) of percentiles of values with relative errors; NaN for an unknown end.

    NaN values are left out. The error of a value may be NaN (unknown); a value of 0 has none. left_out:
    number of draws without a value, which may have any.

    >>> intervals(np.arange(1.0, 12.0), np.zeros(11), (50.0,), 0.9).tolist()
    [[3.0, 9.0]]
    >>> intervals(np.arange(1.0, 12.0), np.zeros(11), (50.0,), 0.9, left_out=2).tolist()
    [[2.0, 10.0]]
    """
    known = np.isfinite(values)
    value, error = values[known], np.where(values[known] == 0.0, 0.0, errors[known])
    any_value = np.full(left_out, np.inf)
    low = np.where(np.isnan(error), -np.inf, np.maximum(value * (1.0 - error), 0.0))
    high = np.where(np.isnan(error), np.inf, value * (1.0 + error))
    low, high = np.sort(np.append(low, -any_value)), np.sort(np.append(high, any_value))
    found = np.full((len(percents), 2), np.nan)
    for row, percent in zip(found, percents, strict=True):
        lower, upper = ranks(low.size, percent, confidence)
        if lower > 0:
            row[0] = low[lower - 1]
        if upper <= high.size:
            row[1] = high[upper - 1]
    return np.where(np.isfinite(found), found, np.nan)
