"""Ranges of a number in which the greatest peak is only slightly above its minimum, or unstable."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence

import numpy as np

from fcm.harmonic_balance.consecutive_points import runs
from fcm.model.scene import FloatArray
from fcm.response.options import OPTIMUM, OptimumOptions
from fcm.results.tracked import NearlyLeast, Optimal, TrackedCurve

Piece = tuple[FloatArray, FloatArray]  # numbers along a curve, and heights relative to the least peak
SEARCHED = ("smooth", "kink", "corner", "bound")  # kinds of optima with known curves of peaks beside them


def nearly_least(
    found: Optimal, curves: Iterable[TrackedCurve], dofs: Sequence[str], share: float
) -> NearlyLeast | None:
    """The range of a number in which no tracked peak exceeds the least one by more than this share.

    Heights are interpolated linearly between points. The range ends at an end of the curves if the peaks stay
    below the limit up to there. None with several numbers, or where peaks end or are unknown.
    """
    if len(found.values) != 1 or found.kind not in SEARCHED or found.between is not None:
        return None
    (best,), limit = found.values.values(), (1.0 + share) * found.value
    low, high, span, pieces = -np.inf, np.inf, list[float](), list[Piece]()
    for curve, height in _peaks(found, curves, dofs):
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


def _peaks(
    found: Optimal, curves: Iterable[TrackedCurve], dofs: Sequence[str]
) -> Iterator[tuple[TrackedCurve, FloatArray]]:
    """The tracked peaks that count for an optimum, with their heights (point,); a trough has none."""
    for curve in curves:
        dof = curve.what.removeprefix("peak of ")
        if curve.parameters == found.parameters and f"peak.{dof}" in found.minimised:
            yield curve, np.where(curve.trough, -np.inf, curve.amplitude[:, list(dofs).index(dof)])


def unstable_peaks(
    found: Optimal, curves: Iterable[TrackedCurve], dofs: Sequence[str], options: OptimumOptions = OPTIMUM
) -> tuple[tuple[float, float, float], ...]:
    """Ranges of the number in which the greatest tracked peak is higher than the least, and unstable.

    (low, high, greatest peak) of each that takes more than `OptimumOptions.min_unstable` of the span that the
    peaks were followed over. It is looked at `OptimumOptions.unstable_samples` numbers. Where stability is
    unknown the peak counts as unstable, if it is unstable elsewhere in the same range. Empty for several
    numbers.
    """
    peaks = list(_peaks(found, curves, dofs)) if len(found.values) == 1 else []
    if not peaks:
        return ()
    ends = [(curve.number.min(), curve.number.max()) for curve, _ in peaks]
    numbers = np.linspace(
        min(low for low, _ in ends), max(high for _, high in ends), options.unstable_samples
    )
    greatest, stable = np.zeros(numbers.size), np.ones(numbers.size)
    for curve, height in peaks:
        for i in range(curve.number.size - 1):
            (one, other), (low, high) = curve.number[i : i + 2], np.sort(curve.number[i : i + 2])
            there = np.flatnonzero((numbers >= low) & (numbers <= high)) if high > low else np.zeros(0, int)
            part = (numbers[there] - one) / (other - one)
            here = height[i] + part * (height[i + 1] - height[i])
            higher = here > greatest[there]
            greatest[there[higher]] = here[higher]
            stable[there[higher]] = np.min(curve.stable[i : i + 2])  # nan if one is
    higher = (stable != 1.0) & (greatest > (1.0 + options.nearly) * found.value)
    width, told = options.min_unstable * (numbers[-1] - numbers[0]), []
    for first, end in runs(higher):
        low, high = float(numbers[first]), float(numbers[end - 1])
        if high - low > width and (stable[first:end] == 0.0).any():
            told.append((low, high, float(greatest[first:end].max())))
    return tuple(told)


def _ends_of_higher(pieces: Sequence[Piece], share: float, best: float) -> tuple[tuple[float, float], ...]:
    """The next number on either side of the best one at which the highest peak ends, with its height.

    Ends at the bounds of all curves do not count, nor ends where another peak is nearly as high.
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
    """The greatest height of a curve at a number; 0 if the curve does not reach it."""
    number, height = piece
    there = np.flatnonzero((number[:-1] - at) * (number[1:] - at) <= 0.0)
    return float(np.maximum(height[there], height[there + 1]).max(initial=0.0))


def _above(number: FloatArray, height: FloatArray, limit: float) -> FloatArray:
    """Numbers of the points at or above a limit, and of the crossings of the limit."""
    off = height - limit
    crossed = np.flatnonzero((off[:-1] * off[1:] < 0.0) & np.isfinite(off[:-1] * off[1:]))
    part = off[crossed] / (off[crossed] - off[crossed + 1])
    found: FloatArray = np.concatenate(
        (number[off >= 0.0], number[crossed] + part * (number[crossed + 1] - number[crossed]))
    )
    return found
