"""Classifies the stability of a solution by its Floquet multipliers, given the parity of those above +1."""

from __future__ import annotations

import math
from collections.abc import Sequence
from enum import Enum
from typing import NamedTuple

from fcm.stability.options import STABILITY, StabilityOptions


class Bifurcation(Enum):
    """Ways in which multipliers leave the unit circle, so that stability changes other than at a fold."""

    PERIOD_DOUBLING = "period doubling"  # one at -1
    NEIMARK_SACKER = "Neimark-Sacker"  # a complex pair
    REAL = "multiplier +1"  # one at +1 beside a fold, where the motion is smooth on one side only


class Classification(NamedTuple):
    """Stability of one solution, by its multipliers."""

    stable: float  # 1, 0, or nan where it is unknown
    growth: float  # logarithm of the factor by which a disturbance grows in a period, other than at a fold
    kind: Bifurcation  # of the multiplier that grows most
    angle_to_flip: float = math.pi  # [rad] from the negative real axis to the nearest pair that is not small
    is_linear: bool = False  # no contact slips or opens
    held: int = 0  # contacts that never slip, but whose slider an extreme of its limit holds
    values: tuple[complex, ...] = ()  # the multipliers
    rebalanced: bool = False  # whether it is that of the motion with further harmonics balanced


LINEAR = Classification(1.0, -math.inf, Bifurcation.NEIMARK_SACKER, is_linear=True)
UNKNOWN = Classification(math.nan, math.nan, Bifurcation.NEIMARK_SACKER)


class MultiplierSpectrum:
    """Multipliers of a solution, grouped by the way in which stability is lost through them.

    Their sizes are logarithms. nearest: size of the positive real multiplier nearest to 1, nan if there is
    none. odd: whether the number of real multipliers above 1 is odd.
    """

    values: tuple[complex, ...]
    nearest: float
    odd: bool
    real: float  # greatest of the real ones above 1, which leave at folds; -inf if there is none
    real_but_nearest: float
    other: float  # greatest of the others, -inf if there is none
    kind: Bifurcation  # of that
    angle_to_flip: float  # as in `Classification`

    def __init__(self, values: list[complex], options: StabilityOptions = STABILITY) -> None:
        self.options = options
        self.values, self.kind, self.angle_to_flip = tuple(values), Bifurcation.NEIMARK_SACKER, math.pi
        self.nearest, self.odd, self.real, self.real_but_nearest = math.nan, False, -math.inf, -math.inf
        self.other = 0.0
        for value in values:
            size = math.hypot(value.real, value.imag)
            if value.imag == 0.0 and value.real > 0.0:
                self.add_positive(math.log(size))
                continue
            if size > self.other:
                self.other, self.kind = (
                    size,
                    Bifurcation.NEIMARK_SACKER if value.imag != 0.0 else Bifurcation.PERIOD_DOUBLING,
                )
            if size > self.options.classification.small_multiplier and value.imag != 0.0:
                self.angle_to_flip = min(
                    self.angle_to_flip, math.pi - abs(math.atan2(value.imag, value.real))
                )
        self.other = math.log(self.other) if self.other > 0.0 else -math.inf

    def add_positive(self, size: float) -> None:
        """Take the logarithm of a real multiplier above 0."""
        farther = size
        if not abs(size) >= abs(self.nearest):
            farther, self.nearest = self.nearest, size
        if farther > self.options.classification.growth_tolerance:
            self.real_but_nearest = max(self.real_but_nearest, farther)
        if size > self.options.classification.growth_tolerance:
            self.odd = not self.odd
            self.real = max(self.real, size)

    def classify(self, without_nearest: bool = False) -> Classification:
        """Classify by all multipliers except the real ones between 0 and 1.

        without_nearest: whether the positive real one nearest to 1 is left out, too.
        """
        most = self.real_but_nearest if without_nearest else self.real
        kind = self.kind
        growth = self.other
        if not growth >= most:
            growth, kind = most, Bifurcation.REAL
        stable = 1.0 if growth <= self.options.classification.growth_tolerance else 0.0
        return Classification(stable, growth, kind, self.angle_to_flip, False, 0, self.values)


def bifurcation_of(multipliers: Sequence[complex]) -> Bifurcation:
    """The bifurcation by which an unstable motion lost its stability, if that was not at a fold.

    >>> bifurcation_of([-1.1, 0.3 + 0.2j, 0.3 - 0.2j]).value
    'period doubling'
    """
    return MultiplierSpectrum(list(multipliers)).classify().kind


def meeting_angle(classified: Classification, options: StabilityOptions = STABILITY) -> float:
    """Least angle [rad] by which multipliers that are not small have to turn until two of them meet."""
    angles: list[float] = []
    for value in classified.values:
        angle = abs(math.atan2(value.imag, value.real))
        if angle > 0.0 and math.hypot(value.real, value.imag) > options.classification.small_multiplier:
            angles.append(angle)
    angles.sort()
    nearest: float = math.pi - angles[len(angles) - 1] if angles else math.inf
    for k in range(len(angles) - 2):
        nearest = min(nearest, angles[k + 2] - angles[k])
    return nearest


def classify_even(
    fine: MultiplierSpectrum,
    plain: MultiplierSpectrum,
    at_fold: bool = False,
    options: StabilityOptions = STABILITY,
) -> Classification:
    """Classify by two approximations to a spectrum that has an even number of real multipliers above 1.

    If an approximation has an odd number, the one nearest to 1 is taken to be on the wrong side, and left
    out. UNKNOWN if both have, and it is too far from 1 for its shift from one to the other. At a fold
    (at_fold) that multiplier is always left out. stable is nan if the approximations disagree.
    """
    if fine.odd and plain.odd and not at_fold:
        off = abs(fine.nearest)
        if off > max(
            options.classification.real_uncertainty,
            options.classification.shift_factor * abs(plain.nearest - fine.nearest),
        ):
            return UNKNOWN
    found = fine.classify(fine.odd or at_fold)
    if found.stable != plain.classify(plain.odd or at_fold).stable:
        return found._replace(stable=math.nan)
    return found


def is_uncertain(
    found: Classification,
    fine: MultiplierSpectrum,
    plain: MultiplierSpectrum,
    times: float,
    meetings: bool = True,
    options: StabilityOptions = STABILITY,
) -> bool:
    """Whether a classification may change if the motion changes further, as it did from plain to fine.

    It may if it is unknown, if a decay is less than the change of the growth, or if a growth is less than
    `times` that change. With meetings, it may if a pair turns so fast that it may meet at -1, where one
    multiplier leaves by a flip. It may, too, if all decays but a left-out multiplier, plain or fine, that is
    far on the wrong side of 1.
    """
    if math.isnan(found.stable):
        return True
    one, other = fine.classify(fine.odd), plain.classify(plain.odd)
    change = abs(one.growth - other.growth)
    if found.stable != 1.0:
        return found.growth < times * change
    near, turned = flip_angle(one, options), abs(flip_angle(one, options) - flip_angle(other, options))
    flips = near < min(
        max(options.classification.flip_angle, turned), options.classification.shift_factor * turned
    )
    far = (fine.odd and abs(fine.nearest) > options.classification.real_uncertainty) or (
        plain.odd and abs(plain.nearest) > options.classification.real_uncertainty
    )
    return (meetings and flips) or -found.growth < change or far


def flip_function(values: Sequence[complex]) -> float:
    """A smooth function of the multipliers that changes its sign where one passes -1.

    It is negative while none has passed, and does not depend on the way to -1.

    >>> flip_function([0.5 + 0.5j, 0.5 - 0.5j]), flip_function([-1.5, -0.5])
    (-2.5, 0.25)
    """
    product = 1.0 + 0.0j
    for value in values:
        product *= 1.0 + value
    return -product.real


def growth_is_linear(
    one: Classification,
    middle: Classification,
    other: Classification,
    many: bool,
    options: StabilityOptions = STABILITY,
) -> bool:
    """Whether three classifications agree, and their growths are close enough to a straight line.

    Then no growth between them has another sign. With many contacts, one begins to slip in every interval,
    and one of the many multipliers is always near a flip: neither is then a reason to look more closely.
    """
    stable, growth = (one.stable, middle.stable, other.stable), (one.growth, middle.growth, other.growth)
    if not stable[0] == stable[1] == stable[2]:
        return math.isnan(stable[0]) and math.isnan(stable[1]) and math.isnan(stable[2])
    # a further flip does not matter to an unstable motion
    if (
        not many
        and stable[0] == 1.0
        and min(one.angle_to_flip, middle.angle_to_flip, other.angle_to_flip)
        < options.classification.flip_angle
    ):
        return False
    safe = max(growth) < options.sampling.safe_growth
    if not many and not safe and not one.held == middle.held == other.held:
        return False
    if stable[0] == 1.0 and (safe or one.is_linear or middle.is_linear or other.is_linear):
        return True
    a, b, c = (max(size, options.sampling.sufficient_decay) for size in growth)
    return abs(b - 0.5 * (a + c)) < options.sampling.max_deviation * min(abs(a), abs(b), abs(c))


def flip_distance(values: Sequence[complex], options: StabilityOptions = STABILITY) -> tuple[float, float]:
    """Distance of a pair of multipliers from -1, and the logarithm of its size; nan if all are small.

    The distance is the pair's sum over its size, plus 2; it is smooth where both meet. Before they meet, it
    is about the square of the angle that is left. After that, it is about minus the square of the logarithm
    by which they have parted along the axis.
    """
    pairs = [
        value
        for value in values
        if value.imag > 0.0 and abs(value) > options.classification.small_multiplier and value.real < 0.0
    ]
    axis = sorted(value.real for value in values if value.imag == 0.0 and value.real < 0.0)
    if len(axis) > 1 and axis[0] * axis[1] > options.classification.small_multiplier**2:
        size = math.sqrt(axis[0] * axis[1])
        return (axis[0] + axis[1]) / size + 2.0, math.log(size)
    if not pairs:
        return math.nan, math.nan
    nearest = max(pairs, key=lambda value: -value.real / abs(value))
    return 2.0 * nearest.real / abs(nearest) + 2.0, math.log(abs(nearest))


def flip_angle(classified: Classification, options: StabilityOptions = STABILITY) -> float:
    """Angle [rad] from the negative real axis to the nearest pair that is not small; 0 once one is on it."""
    met = classified.kind is Bifurcation.PERIOD_DOUBLING and classified.growth > math.log(
        options.classification.small_multiplier
    )
    return 0.0 if met else classified.angle_to_flip


def combine_one_sided(pushed: Classification, resting: Classification) -> Classification:
    """Classify a motion whose slider, just held by its limit, follows that if pushed, and rests if not.

    If the resting motion is not stable, it decides: it is also that with a little less residual friction. If
    only the pushed motion is unstable, a real multiplier above 1 keeps the sign of the disturbance and goes
    on pushing: unstable. A flip or a pair changes the sign, so that the disturbance decays at rest before the
    next push: unknown.
    """
    if resting.stable != 1.0:
        return resting
    if pushed.stable == 1.0:
        return max(pushed, resting, key=lambda classified: classified.growth)
    return pushed if pushed.kind is Bifurcation.REAL else pushed._replace(stable=math.nan)
