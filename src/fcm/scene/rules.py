"""Rules for the numbers of a scene, for files and sweeps alike."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from math import ceil, inf, isfinite
from numbers import Real

import numpy as np
import numpy.typing as npt

from fcm.frozen import Frozen
from fcm.model.scene import FloatArray, Scene
from fcm.scene.errors import shown
from fcm.scene.options import LIMITS

IndexArray = npt.NDArray[np.intp]


class Rule(Frozen):
    """The interval in which a number must lie, and its wording in messages.

    >>> POSITIVE.fault(0.0)
    'must be greater than 0, is 0'
    >>> POSITIVE.fault(2.0)
    ''
    """

    text: str
    low: float = -inf
    high: float = inf
    zero: bool = True  # whether zero itself is allowed
    whole: bool = False  # whether it must be a whole number
    scales: bool = False  # whether displacements are proportional to it, so that tiny values underflow

    def fault(self, value: float) -> str:
        """What is wrong with a value; empty if nothing is."""
        if not isfinite(value):
            return f"must be finite, is {shown(value)}"
        right = self.low <= value <= self.high and (value or self.zero)
        if not right or (self.whole and value != int(value)):
            return f"must be {self.text}, is {shown(value)}"
        if abs(value) > LIMITS.largest:
            return f"{shown(value)} is too large to calculate with (more than {LIMITS.largest:g})"
        if (self.low == 0 or self.scales) and 0 < abs(value) < LIMITS.smallest:
            return f"{shown(value)} is too small to calculate with (less than {LIMITS.smallest:g})"
        return ""

    def faulty(self, values: FloatArray) -> IndexArray:
        """Indices (fault, axis) of the values that this rule does not allow."""
        right = (
            np.isfinite(values)
            & (values >= self.low)
            & (values <= self.high)
            & (abs(values) <= LIMITS.largest)
        )
        if not self.zero:
            right &= values != 0
        if self.low == 0 or self.scales:
            right &= (values == 0) | (abs(values) >= LIMITS.smallest)
        if self.whole:
            right &= values == np.rint(values)
        return np.argwhere(~right)


ANY = Rule("a number")
EXCITATION = Rule("a number", scales=True)
POSITIVE = Rule("greater than 0", low=0.0, zero=False)
NOT_NEGATIVE = Rule("at least 0", low=0.0)
FRACTION = Rule("greater than 0 and at most 1", low=0.0, high=1.0, zero=False)


def step_fault(step: float) -> str:
    """What is wrong with a longest step along a curve; empty if nothing is."""
    if (fault := FRACTION.fault(step)) or step >= LIMITS.shortest_step:
        return fault
    return (
        f"must be at least {LIMITS.shortest_step:g}, is {shown(step)}, by which a curve has at least "
        f"{1.0 / step:.0e} points"
    )


def harmonics_fault(harmonics: Sequence[int]) -> str:
    """What the harmonics of a balance must be, if they are wrong; else empty."""
    whole = all(
        isinstance(h, int) and not isinstance(h, bool) and 1 <= h <= LIMITS.harmonics for h in harmonics
    )
    rising = whole and all(a < b for a, b in pairwise(harmonics))
    if harmonics and rising and harmonics[0] == 1:
        return ""
    return f"whole numbers from 1 to {LIMITS.harmonics}, rising, the first of them 1"


def harmonics_up_to(count: int) -> tuple[int, ...]:
    """Harmonics up to a number; for a number above the limit, one harmonic more than the limit.

    >>> harmonics_up_to(3), len(harmonics_up_to(10**30))
    ((1, 2, 3), 51)
    """
    return tuple(range(1, min(count, LIMITS.harmonics + 1) + 1))


def least_points(scene: Scene) -> int:
    """The least number of points of the curves of a scene, from their longest steps."""
    return sum(ceil(1.0 / curve.max_step) for curve in scene.each_curve())


RULES = {
    "mass": POSITIVE,
    "frequency": NOT_NEGATIVE,
    "damping": NOT_NEGATIVE,
    "shapes": ANY,
    "participation": ANY,
    "tangential": ANY,
    "second": ANY,
    "normal": ANY,
    "mu": NOT_NEGATIVE,
    "k_u": NOT_NEGATIVE,
    "k_v": NOT_NEGATIVE,
    "n_0": ANY,
    "gap": ANY,
    "dof": ANY,
    "amplitude": EXCITATION,
    "acceleration": EXCITATION,
    "force": EXCITATION,
    "phase": ANY,
    "sectors": Rule("a whole number from 2 to 1000", low=2.0, high=1000.0, whole=True),
    "engine_order": Rule("a whole number from -1000 to 1000", low=-1000.0, high=1000.0, whole=True),
    "factors": Rule("greater than 0, as 0.97 for 3 % less", low=0.0, zero=False),
    "scale": NOT_NEGATIVE,
    "draw": Rule("a whole number of at least 0", low=0.0, whole=True),
    "nodal_diameter": Rule("a whole number of at least 0", low=0.0, whole=True),
}


def as_float(value: object) -> float | None:
    """The number as a float; None when it is not a number (true and false are not).

    >>> as_float(3), as_float(True), as_float("3"), as_float(10**400)
    (3.0, None, None, inf)
    """
    if isinstance(value, bool) or not isinstance(value, Real):
        return None
    try:
        return float(value)
    except OverflowError:
        return inf
