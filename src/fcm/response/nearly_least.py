"""Numbers with which the greatest of some peaks is hardly more than the least one."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np

from fcm.model.scene import FloatArray
from fcm.results.tracked import NearlyLeast, Optimal, TrackedCurve

Piece = tuple[FloatArray, FloatArray]  # numbers along a curve, and heights relative to the least
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
    low, high, span, pieces = -np.inf, np.inf, list[float](), list[Piece]()
    for curve in curves:
        dof = curve.what.removeprefix("peak of ")
        if curve.parameters != found.parameters or f"peak.{dof}" not in found.minimised:
            continue
        height = np.where(curve.trough, -np.inf, curve.amplitude[:, list(dofs).index(dof)])
        pieces.append((curve.number, height / found.value))
        span += [float(curve.number.min()), float(curve.number.max())]
        at = _above(curve.number, height, limit)
        low = max(low, float(at[at <= best].max(initial=-np.inf)))
        high = min(high, float(at[at > best].min(initial=np.inf)))
    if not span:
        return None
    ends = max(low, min(span)), min(high, max(span))
    higher = _ends_of_higher(pieces, share, best)
    return NearlyLeast(share, *ends, low > -np.inf, high < np.inf, higher)


def _ends_of_higher(pieces: Sequence[Piece], share: float, best: float) -> tuple[tuple[float, float], ...]:
    """The next number on either side of the best at which a peak ends that is higher than all others there.

    With its height there. Peaks that end at bounds of all, or where another takes over, are none of these.
    """
    least, most = (of([of(number) for number, _ in pieces]) for of in (np.min, np.max))
    below, above = list[tuple[float, float]](), list[tuple[float, float]]()
    for k, (number, height) in enumerate(pieces):
        others = [one for i, one in enumerate(pieces) if i != k]
        for at, top in zip(number[[0, -1]].tolist(), height[[0, -1]].tolist(), strict=True):
            beside = max([1.0, *(_greatest_at(one, at) for one in others)])
            if least < at < most and top > (1.0 + share) * beside:
                (below if at < best else above).append((at, top))
    return tuple([max(below)] if below else []) + tuple([min(above)] if above else [])


def _greatest_at(piece: Piece, at: float) -> float:
    """The greatest height of a curve at a number; 0 where it is not there."""
    number, height = piece
    there = np.flatnonzero((number[:-1] - at) * (number[1:] - at) <= 0.0)
    return float(np.maximum(height[there], height[there + 1]).max(initial=0.0))


def _above(number: FloatArray, height: FloatArray, limit: float) -> FloatArray:
    """Ranges of numbers at which a curve is at or above a limit, and where it crosses that."""
    off = height - limit
    crossed = np.flatnonzero((off[:-1] * off[1:] < 0.0) & np.isfinite(off[:-1] * off[1:]))
    part = off[crossed] / (off[crossed] - off[crossed + 1])
    found: FloatArray = np.concatenate(
        (number[off >= 0.0], number[crossed] + part * (number[crossed + 1] - number[crossed]))
    )
    return found
