r"""Test functions that show where stability may change and change back between two places of a curve.

The growth is no guide there: a pair of multipliers l keeps its size until it meets another pair or the real
axis, and then leaves the unit circle at once. These products vary smoothly along the curve, and vanish where
multipliers leave the unit circle:

    prod_i (1 + l_i)   at a flip,        prod_{i<j} (1 - l_i l_j)   where a pair leaves.

The parabola through three places predicts the least value of a product, and whether it may be below zero.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import lru_cache
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from fcm.model.scene import FloatArray
from fcm.stability.classification import Classification
from fcm.stability.options import STABILITY, StabilityOptions

MIN_LOGARITHM = 1e-300  # least value of a product, or of a length


class MultiplierSample(NamedTuple):
    """Functions of the multipliers at a place of a curve."""

    length: float  # along the curve
    stable: float
    growth: float
    flip: float  # logarithms of the products
    pair: float


def multiplier_sample(
    length: float, classified: Classification, options: StabilityOptions = STABILITY
) -> MultiplierSample:
    """The sample of a place with a classification.

    The products are computed only if it is stable; otherwise their logarithms are 0, and not used.
    """
    if classified.stable != 1.0:
        return MultiplierSample(length, classified.stable, classified.growth, 0.0, 0.0)
    values = np.array(
        [value for value in classified.values if abs(value) > options.windows.min_size], dtype=np.complex128
    )
    i, j = _pairs(values.size)
    products = np.abs(1.0 + values), np.abs(1.0 - values[i] * values[j])
    sums = (float(np.log(product + MIN_LOGARITHM).sum()) for product in products)
    return MultiplierSample(length, classified.stable, classified.growth, *sums)


@lru_cache(maxsize=16)
def _pairs(count: int) -> tuple[npt.NDArray[np.intp], npt.NDArray[np.intp]]:
    i, j = np.triu_indices(count, 1)
    return i, j


def predicted_minimum(
    low: MultiplierSample,
    high: MultiplierSample,
    places: Sequence[MultiplierSample],
    divided: int = 0,
    options: StabilityOptions = STABILITY,
) -> float | None:
    """Predict the length at which a test function is so small that stability may change; None if nowhere.

    Parameters
    ----------
    low, high : MultiplierSample
        Ends of the interval; both stable or both not.
    places : sequence of MultiplierSample
        The ends and their neighbours in order, three or four.
    divided : int
        How often the interval between two points has been divided.
    """
    windows = options.windows
    near, most, at = windows.min_distance * (high.length - low.length), 0.0, None
    if high.length - low.length < windows.min_length:
        return None
    for k in range(len(places) - 2):
        three = places[k : k + 3]
        lengths = [one.length for one in three]
        for values in _positive(three):
            place, least = _parabola_minimum(lengths, values)
            if not low.length <= place <= high.length:
                continue
            place = min(max(place, low.length + near), high.length - near)
            greatest = max(values)
            excess = (
                windows.margin * windows.margin_reduction**divided * (greatest - least) - least
            ) / greatest
            if excess > most:
                most, at = excess, place
    return at


def _positive(three: Sequence[MultiplierSample]) -> list[list[float]]:
    """Values of the test functions at three places: positive while stability is unchanged, in any unit."""
    if three[0].stable == 0.0:
        return [[one.growth for one in three]]
    return [_relative([one.flip for one in three]), _relative([one.pair for one in three])]


def _relative(logarithms: list[float]) -> list[float]:
    greatest = max(logarithms)
    return [math.exp(one - greatest) for one in logarithms]


def _parabola_minimum(s: list[float], f: list[float]) -> tuple[float, float]:
    """Place and value of the minimum of the parabola through three points; nan if it has none.

    >>> _parabola_minimum([0.0, 1.0, 3.0], [4.0, 1.0, 1.0])
    (2.0, 0.0)
    """
    first, second = ((f[k + 1] - f[k]) / max(s[k + 1] - s[k], MIN_LOGARITHM) for k in (0, 1))
    bend = (second - first) / max(s[2] - s[0], MIN_LOGARITHM)
    if not bend > 0.0:
        return math.nan, math.nan
    at = 0.5 * (s[0] + s[1] - first / bend)
    return at, f[0] + (at - s[0]) * (first + bend * (at - s[1]))


def products(
    values: npt.NDArray[np.complex128], options: StabilityOptions = STABILITY
) -> tuple[FloatArray, FloatArray]:
    """The logarithms of both products, (place,) each, of multipliers (place, n); 0 stands for no multiplier.

    >>> [each.round(2).tolist() for each in products(np.array([[-0.9, 0.9j, -0.9j]]))]
    [[-1.71], [-1.16]]
    """
    values = np.where(np.abs(values) > options.windows.min_size, values, 0.0)
    flip: FloatArray = np.log(np.abs(1.0 + values) + MIN_LOGARITHM).sum(axis=1)
    pair = np.zeros(len(values))
    for i in range(values.shape[1] - 1):
        pair += np.log(np.abs(1.0 - values[:, i, None] * values[:, i + 1 :]) + MIN_LOGARITHM).sum(axis=1)
    return flip, pair


def predicted_minima(
    s: FloatArray, f: FloatArray, logarithms: bool, options: StabilityOptions = STABILITY
) -> tuple[npt.NDArray[np.bool_], ...]:
    """Whether `predicted_minimum` finds a place by any three consecutive values f at lengths s.

    All places are stable, or all are not. Returns masks (place - 2,): for a place between the first two of
    the three values, and for one between the last two.
    """
    three = np.array([f[:-2], f[1:-1], f[2:]])
    if logarithms:
        three = np.exp(three - three.max(axis=0))
    width = np.diff(s)
    with np.errstate(over="ignore", invalid="ignore"):  # coincident points, which predict nothing
        slope = np.diff(three, axis=0) / np.maximum((width[:-1], width[1:]), MIN_LOGARITHM)
        bend = (slope[1] - slope[0]) / np.maximum(s[2:] - s[:-2], MIN_LOGARITHM)
        up = bend > 0.0
        at = 0.5 * (s[:-2] + s[1:-1] - slope[0] / np.where(up, bend, 1.0))
        least = three[0] + (at - s[:-2]) * (slope[0] + bend * (at - s[1:-1]))
        deep = up & (options.windows.margin * (three.max(axis=0) - least) > least)
    sides, wide = (slice(-1), slice(1, None)), width >= options.windows.min_length
    return tuple(deep & (s[:-1][k] <= at) & (at <= s[1:][k]) & wide[k] for k in sides)
