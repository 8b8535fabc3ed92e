"""The fitted numbers as unknowns of least squares: logarithms of positive numbers, others scaled."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np
from scipy.stats import qmc

from fcm.fit.options import FIT, FitOptions
from fcm.frozen import Frozen
from fcm.model.scene import Address, FloatArray, Scene
from fcm.scene.draft import Number, number_of
from fcm.scene.optimum import without_bounds


class FitError(ValueError):
    """Raised when there is nothing to fit; the message says why."""


class Parameters(Frozen):
    """The fitted numbers of a scene, as scaled or logarithmic unknowns.

    start, low, high: (number,); log: (number,) whether the unknown is the number's logarithm; unit:
    (number,) scale of the other unknowns.
    """

    scene: Scene
    numbers: tuple[Number, ...]
    start: FloatArray
    low: FloatArray
    high: FloatArray
    log: FloatArray
    unit: FloatArray

    @property
    def keys(self) -> tuple[str, ...]:
        return tuple(number.key for number in self.numbers)

    def unknowns(self, values: FloatArray) -> FloatArray:
        """Unknowns x of given values of the numbers."""
        with np.errstate(divide="ignore"):  # a bound of 0
            logs = np.log(np.where(self.log > 0.0, values, 1.0))
        return np.where(self.log > 0.0, logs, values / self.unit)

    def values(self, x: FloatArray) -> FloatArray:
        """The numbers that belong to unknowns x, which may be infinite."""
        return np.where(self.log > 0.0, np.exp(np.where(self.log > 0.0, x, 0.0)), x * self.unit)

    def rates(self, values: FloatArray) -> FloatArray:
        """Derivatives of the numbers by their unknowns, (number,)."""
        return np.where(self.log > 0.0, values, self.unit)

    def at(self, values: FloatArray) -> Scene:
        """The scene with these values of the numbers written into it."""
        return with_numbers(self.scene, self.numbers, values)

    def starts(self, count: int, seed: int = 1) -> Iterator[FloatArray]:
        """Starting unknowns: the scene's numbers, then a Latin hypercube sample within the bounds."""
        first = self.unknowns(self.start)
        yield first
        if count == 1:
            return
        low, high = (self.unknowns(end) for end in (self.low, self.high))
        low, high = (
            np.where(np.isfinite(low), low, first - 1.0),
            np.where(np.isfinite(high), high, first + 1.0),
        )
        for place in qmc.LatinHypercube(len(first), rng=seed).random(count - 1):
            yield low + place * (high - low)


def parameters_of(
    scene: Scene, keys: Sequence[str], bounds: Sequence[tuple[float, float] | None], options: FitOptions = FIT
) -> Parameters:
    """The parameters with these keys; a number without bounds gets default bounds far below and above it.

    Raises
    ------
    FitError
        If a number starts at 0 and has no bounds.
    """
    numbers = tuple(number_of(scene, key) for key in keys)
    start, low, high = (np.empty(len(numbers)) for _ in range(3))
    for i, (number, ends) in enumerate(zip(numbers, bounds, strict=True)):
        values = [value / weight for _, value, weight in number.each(scene)]
        start[i] = np.mean(values)
        low[i], high[i] = ends or _up_and_down(start[i], number, options)
        start[i] = min(max(start[i], low[i]), high[i])
    log = ((low > 0.0) & (start > 0.0)).astype(float)
    unit = np.where(
        start != 0.0, np.abs(start), np.where(np.isfinite(high), np.maximum(abs(low), abs(high)), 1.0)
    )
    return Parameters(scene, numbers, start, low, high, log, unit)


def _up_and_down(start: float, number: Number, options: FitOptions) -> tuple[float, float]:
    """Default bounds: the start divided and multiplied by a factor; a negative start is multiplied for low.

    Raises
    ------
    FitError
        If the start is 0.
    """
    if start > 0.0:
        return start / options.unbounded_factor, start * options.unbounded_factor
    if start == 0.0:
        raise FitError(f"fit: bounds: {without_bounds(number)}")
    return start * options.unbounded_factor, -start * options.unbounded_factor


def with_numbers(scene: Scene, numbers: Sequence[Number], values: FloatArray) -> Scene:
    """A scene of one curve with other values of some of its numbers."""
    assert scene.draft is not None
    more: dict[Address, float] = {}
    for number, value in zip(numbers, values.tolist(), strict=True):
        more |= number.values(value)
    return replace(scene.draft.curve(scene, {}, more, fix=True), parameters={}, curves=())
