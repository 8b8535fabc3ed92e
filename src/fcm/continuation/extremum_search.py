"""Folds and peaks within a step of a problem whose points are costly.

A fold or a peak is the extremum of a value whose slope is known too. The cubic with the values and slopes at
both ends of a bracket locates it far better than the slopes alone. At a corner of the curve the slope jumps,
and no polynomial fits. But close to the corner both sides are nearly straight, and they meet in it.
"""

from __future__ import annotations

from math import sqrt
from typing import NamedTuple

import numpy as np

from fcm.continuation.path import FloatArray
from fcm.continuation.problem import Point
from fcm.continuation.step_control import Stepper
from fcm.cubic import curve_between, powers
from fcm.frozen import Frozen


class ExtremumOptions(Frozen):
    """Options on how accurately an extremum is located, and when a polynomial predicts it.

    Attributes
    ----------
    fold_tolerance, corner_tolerance : float
        Relative error of the parameter at a fold, and at a fold in a corner.
    min_reduction : float
        Slope at a new point, relative to the slope that it replaces, from which on the next point does not
        use a cubic.
    corner_curvature : float
        Change of slope in the bracket, relative to that in the step, above which the bracket has a corner.
    corner_offset : float
        Distance of the next points from a corner that they bracket, relative to the squared bracket over the
        step.
    min_length : float
        Length of a bracket up to which only the slopes at its ends are used: the values are too nearly equal.
    min_cosine : float
        Cosine of a turn below which a length does not measure the way along the curve.
    """

    fold_tolerance: float = 1e-15
    corner_tolerance: float = 1e-13
    min_reduction: float = 0.25
    corner_curvature: float = 4.0
    corner_offset: float = 0.1
    min_length: float = 1e-5
    min_cosine: float = 0.1


EXTREMUM = ExtremumOptions()  # the defaults


class Sample(NamedTuple):
    """A point on the curve, in the units of the stepper."""

    at: float  # length from the beginning of the step
    z: FloatArray  # scaled
    tangent: FloatArray
    slope: FloatArray  # of z with respect to that length
    output: FloatArray
    growth: FloatArray  # slope of the outputs with respect to that length
    orientation: float


class ExtremumSearch:
    """The known points of a step: every root is sought between the nearest of them."""

    def __init__(self, stepper: Stepper, options: ExtremumOptions = EXTREMUM) -> None:
        self.options = options
        events = stepper.options.events
        self.high = (
            events.peak_tolerance_of_many
            if stepper.problem.outputs >= events.many_outputs
            else events.peak_tolerance
        )
        # where only values of the parameter matter, points are known only to that tolerance
        known = stepper.options.newton.preliminary_tolerance if stepper.options.user_points_only else 0.0
        self.fold_tolerance = max(options.fold_tolerance, known)
        self.corner_tolerance = max(options.corner_tolerance, known)
        self.stepper, self.scale = stepper, np.array(stepper.newton.scale)
        self.known = [self._sample(0.0, stepper.here), self._sample(stepper.step, stepper.there)]

    def extreme(self, output: int | None) -> Sample:
        """The sample at the extremum of an output, or of the parameter if output is None."""
        low, high = self._between(output)
        sense, steep = self._slope(low, output), self._bend(low, high, output)
        upper, again, better = False, 0, True
        for _ in range(self.stepper.options.events.max_evaluations):
            for end in (high, low):
                if self._is_root(end, low, high, output):
                    return end
            if high.at - low.at <= self.stepper.options.events.tolerance * self.stepper.step:
                return high
            if better:
                guess = _cubic(low, high, output, self.options.min_length)
            elif self._bend(low, high, output) > self.options.corner_curvature * steep:
                guess = self._corner(low, high, upper, again)
            else:
                guess = _middle(low, high)
            sample = self._put(*guess) or self._put(*_middle(low, high))
            if sample is None:
                return high
            side = self._slope(sample, output) * sense <= 0.0
            better = abs(self._slope(sample, output)) < self.options.min_reduction * abs(
                self._slope(high if side else low, output)
            )
            again = again + 1 if side == upper else 0
            upper, low, high = side, *((low, sample) if side else (sample, high))
        return high

    def _between(self, output: int | None) -> tuple[Sample, Sample]:
        """The first neighbours whose slopes differ in sign."""
        for low, high in zip(self.known, self.known[1:], strict=False):
            if self._slope(low, output) * self._slope(high, output) <= 0.0:
                return low, high
        return self.known[0], self.known[-1]

    @staticmethod
    def _slope(sample: Sample, output: int | None) -> float:
        return float(sample.slope[-1] if output is None else sample.growth[output])

    def _is_root(self, sample: Sample, low: Sample, high: Sample, output: int | None) -> bool:
        """Whether the extremum exceeds the value at this sample by no more than the tolerance."""
        now, size = abs(self._slope(sample, output)), abs(float(sample.z[-1]))
        smooth, corner = self.fold_tolerance, self.corner_tolerance
        if output is not None:
            size, smooth, corner = float(sample.output[output]), self.high, self.high
        if now * (high.at - low.at) < corner * size:
            return True
        return now * now < 2.0 * smooth * self._bend(low, high, output) * size

    def _bend(self, low: Sample, high: Sample, output: int | None) -> float:
        """Change of the slope over a unit of length."""
        return abs(self._slope(high, output) - self._slope(low, output)) / (high.at - low.at)

    def _corner(self, low: Sample, high: Sample, upper: bool, again: int) -> tuple[float, FloatArray]:
        """Length and guess of a point near where the tangents at both ends meet, on the side not taken last.

        Its distance from there grows tenfold with each attempt that did not bracket the corner.
        """
        width, bend = high.at - low.at, low.slope - high.slope
        meet = low.at + float((high.z - high.slope * width - low.z) @ bend) / max(float(bend @ bend), 1e-300)
        least = 0.25 * self.stepper.options.events.tolerance * self.stepper.step
        aside = max(self.options.corner_offset * width * width / self.stepper.step, least) * 10.0**again
        at = meet - aside if upper else meet + aside
        if not low.at < at < high.at or aside > 0.5 * width:
            at = meet = 0.5 * (low.at + high.at)
        near = low if at < meet else high
        return at, near.z + near.slope * (at - near.at)

    def _put(self, at: float, guess: FloatArray) -> Sample | None:
        """Find and keep the point at a length, from a guess; None if it is not found."""
        stepper = self.stepper
        if not stepper.find_from_guess(at, self.scale * guess):
            return None
        sample = self._sample(at, stepper.between)
        self.known = sorted((*self.known, sample), key=lambda one: one.at)
        return sample

    def _sample(self, at: float, point: Point) -> Sample:
        tangent = np.array(point.tangent)
        along = max(float(tangent @ np.asarray(self.stepper.here.tangent)), self.options.min_cosine)
        growth = np.array(point.growth) / along
        return Sample(
            at, np.array(point.z) / self.scale, tangent, tangent / along, np.array(point.output), growth,
            point.orientation,
        )  # fmt: skip


def _cubic(low: Sample, high: Sample, output: int | None, coarse: float) -> tuple[float, FloatArray]:
    """Length at the extremum of the interpolating cubic between two samples, and z on the cubic there.

    A bracket no wider than coarse is interpolated by its slopes alone.
    """
    width = high.at - low.at
    if output is None:
        rise, begin, end = float(high.z[-1] - low.z[-1]), float(low.slope[-1]), float(high.slope[-1])
    else:
        rise = float(high.output[output] - low.output[output])
        begin, end = float(low.growth[output]), float(high.growth[output])
    part = begin / (begin - end)
    if width > coarse:
        part = _turn(begin, end, rise / width, part)
    z = curve_between(low.z, high.z, low.slope, high.slope, width, part)
    return low.at + part * width, z


def _middle(low: Sample, high: Sample) -> tuple[float, FloatArray]:
    at = 0.5 * (low.at + high.at)
    return at, low.z + low.slope * (at - low.at)


def _turn(begin: float, end: float, mean: float, otherwise: float) -> float:
    """Extremum in (0, 1) of a cubic with given slopes at 0 and 1 and a given mean slope.

    >>> round(_turn(1.0, -1.0, 0.0, 0.0), 3), round(_turn(1.0, -2.0, -0.25, 0.0), 3)
    (0.5, 0.457)
    """
    square, cube = powers(mean, begin, end)
    a, b = 3.0 * cube, 2.0 * square
    root = b * b - 4.0 * a * begin
    if root <= 0.0:
        return otherwise
    half = -0.5 * (b + sqrt(root) if b > 0.0 else b - sqrt(root))
    for x in (begin / half if half != 0.0 else 2.0, half / a if a != 0.0 else 2.0):
        if 0.0 < x < 1.0:
            return x
    return otherwise
