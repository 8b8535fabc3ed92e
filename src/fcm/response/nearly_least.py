"""Numbers with which the greatest of some peaks is hardly more than the least one."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np

from fcm.model.scene import FloatArray
from fcm.results.tracked import NearlyLeast, Optimal, TrackedCurve

SEARCHED = ("smooth", "kink", "corner", "bound")  # kinds of optima beside which peaks are known as curves


def nearly_least(
    found: Optimal, curves: Iterable[TrackedCurve], dofs: Sequence[str], share: float
) -> NearlyLeast | None:
    """The range of a number in which no tracked peak is more than this share above the least.

    Peaks between two points of a curve are those of a straight line. An end of the curves is one of the range
    where the peaks are not greater up to there. None of several numbers, and where peaks end or are unknown.
    """
    if len(found.values) != 1 or found.kind not in SEARCHED or found.between is not None:
        return None
    (best,), limit = found.values.values(), (1.0 + share) * found.value
    low, high, span = -np.inf, np.inf, list[float]()
    for curve in curves:
        dof = curve.what.removeprefix("peak of ")
        if curve.parameters != found.parameters or f"peak.{dof}" not in found.minimised:
            continue
        height = np.where(curve.trough, -np.inf, curve.amplitude[:, list(dofs).index(dof)])
        span += [float(curve.number.min()), float(curve.number.max())]
        at = _above(curve.number, height, limit)
        low = max(low, float(at[at <= best].max(initial=-np.inf)))
        high = min(high, float(at[at > best].min(initial=np.inf)))
    if not span:
        return None
    ends = max(low, min(span)), min(high, max(span))
    return NearlyLeast(share, *ends, low > -np.inf, high < np.inf)


def _above(number: FloatArray, height: FloatArray, limit: float) -> FloatArray:
    """Ranges of numbers at which a curve is at or above a limit, and where it crosses that."""
    off = height - limit
    crossed = np.flatnonzero((off[:-1] * off[1:] < 0.0) & np.isfinite(off[:-1] * off[1:]))
    part = off[crossed] / (off[crossed] - off[crossed + 1])
    found: FloatArray = np.concatenate(
        (number[off >= 0.0], number[crossed] + part * (number[crossed + 1] - number[crossed]))
    )
    return found
