"""What Floquet multipliers say of the stability of a solution, given the parity of those above +1."""

from __future__ import annotations

import cmath
import math
from dataclasses import dataclass
from enum import Enum
from typing import NamedTuple

STABLE = 1e-7  # by which a multiplier may exceed 1
SURELY = 0.02  # logarithm of a real multiplier that truncation may put on the wrong side of 1 in any case
SHIFTED = 2.0  # or, of one that it shifts, as far as this many times the shift
SMALL = 0.75  # multipliers below are far from growth, wherever they turn


class Kind(Enum):
    """How stability ends, besides at a fold."""

    FLIP = "flip"
    PAIR = "pair"
    REAL = "real"  # through +1, of a motion that is smooth only on one side of the balance's


class Verdict(NamedTuple):
    """Of one solution."""

    stable: float  # 1, 0, or nan where it cannot be told
    growth: float  # logarithm of what a disturbance grows by in a period, other than at a fold
    kind: Kind  # of what grows most
    before_flip: float = math.pi  # [rad] from the negative real axis to the nearest pair that is not small
    passive: bool = False  # no contact slips or opens
    held: int = 0  # contacts that never slip, but for an extreme of a limit that holds the slider
    values: tuple[complex, ...] = ()  # the multipliers


PASSIVE = Verdict(1.0, -math.inf, Kind.PAIR, passive=True)
UNKNOWN = Verdict(math.nan, math.nan, Kind.PAIR)


@dataclass
class Spectrum:
    """Multipliers sorted by how stability is lost through them; logarithms of their magnitudes."""

    positive: list[float]  # of the real ones above 0, which leave at folds
    other: float  # greatest of the others, -inf if there is none
    kind: Kind  # of that
    before_flip: float  # as in `Verdict`
    values: tuple[complex, ...] = ()

    @classmethod
    def of(cls, values: list[complex]) -> Spectrum:
        """All multipliers of a solution."""
        positive, other, kind, before_flip = [], 0.0, Kind.PAIR, math.pi
        for value in values:
            size = abs(value)
            if value.imag == 0.0 and value.real > 0.0:
                positive.append(math.log(size))
                continue
            if size > other:
                other, kind = size, Kind.PAIR if value.imag else Kind.FLIP
            if size > SMALL and value.imag != 0.0:
                before_flip = min(before_flip, math.pi - abs(cmath.phase(value)))
        size = math.log(other) if other > 0.0 else -math.inf
        return cls(positive, size, kind, before_flip, tuple(values))

    @property
    def odd(self) -> bool:
        """Whether the number of real multipliers above 1 is odd."""
        return len([size for size in self.positive if size > STABLE]) % 2 == 1

    @property
    def nearest(self) -> float:
        """Of the real multiplier nearest to 1, nan if there is none."""
        return min(self.positive, key=abs, default=math.nan)

    def verdict(self, without_nearest: bool = False) -> Verdict:
        """By all multipliers but the real ones between 0 and 1, and if wanted the nearest to that."""
        most = -math.inf
        if self.positive:
            real = sorted(self.positive, key=abs)[without_nearest:]
            most = max((size for size in real if size > STABLE), default=most)
        growth, kind = (self.other, self.kind) if self.other >= most else (most, Kind.REAL)
        return Verdict(float(growth <= STABLE), growth, kind, self.before_flip, values=self.values)


def even(fine: Spectrum, plain: Spectrum, turning: bool = False) -> Verdict:
    """Verdict of two approximations to a spectrum whose number of real multipliers above 1 is even.

    Where it is odd, the nearest to 1 is on the wrong side, if it is shifted enough from one to the other. At
    a fold (turning) that one does not count.
    """
    if fine.odd and plain.odd and not turning:
        off = abs(fine.nearest)
        if off > max(SURELY, SHIFTED * abs(plain.nearest - fine.nearest)):
            return UNKNOWN
    found = fine.verdict(fine.odd or turning)
    if found.stable != plain.verdict(plain.odd or turning).stable:
        return found._replace(stable=math.nan)
    return found


def either(one: Verdict, other: Verdict) -> Verdict:
    """Of a motion that obeys one linearisation or the other by the sign of the disturbance."""
    if one.stable == other.stable == 1.0:
        return max(one, other, key=lambda verdict: verdict.growth)
    return other if one.stable == 1.0 else one
