"""Stability along a curve: it changes at folds, and where a flip or a pair crosses the unit circle.

Between two folds the number of real multipliers above +1 is even or odd throughout, as the sign of the
balance's determinant says. Where it is odd nothing needs to be calculated. Where it is even the others
decide, at the ends and at as many points between as it takes to see that the growth keeps its sign.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from math import isnan

import numpy as np
import numpy.typing as npt

from fcm.continuation import Between, Mark, Path
from fcm.harmonic.multipliers import multipliers, multipliers_of
from fcm.harmonic.spectrum import Kind, Verdict
from fcm.harmonic.system import System
from fcm.scene.model import FloatArray

IntArray = npt.NDArray[np.intp]

__all__ = ["Crossing", "Kind", "Stability", "multipliers", "stability"]

SPAN = 16  # points between two that are always looked at
DEVIATION = 1.0  # of the growth from a straight line, over its own size, that is followed up
TURN = 0.4  # [rad] from -1 within which a multiplier is followed as it passes: there modes flip
SAFE = -0.05  # growth that is not followed up
ENOUGH = -0.3  # growth that is as good as any that is less
FINE = 1e-9  # of a step: a crossing is known to this, or to a growth of ZERO
ZERO = 1e-10
LOOKS = 60  # at a crossing


@dataclass(frozen=True)
class Crossing:
    """A point of the curve at which stability changes without a fold."""

    after: int  # the point of the path that it follows
    kind: Kind
    z: FloatArray  # (unknown + 1,)
    direction: FloatArray  # (unknown + 1,) along the curve
    orientation: float

    @property
    def frequency(self) -> float:
        """[rad/s]"""
        return float(self.z[-1])


@dataclass(frozen=True)
class Stability:
    """stable (point,): 1 where small disturbances die out, 0 where one grows, nan where it cannot be told."""

    stable: FloatArray
    crossings: tuple[Crossing, ...]
    evaluations: int  # of multipliers


def stability(system: System, path: Path) -> Stability:
    """Stability of the points of a path followed in the frequency, and where it changes between folds.

    A fold counts to the stable side. What is stable with the balanced harmonics and not with the next ones
    that their forces make, or the other way round, is nan.
    """
    return _Along(system, path).run()


def with_points(path: Path, crossings: Sequence[Crossing]) -> Path:
    """The path with the points of crossings on it."""
    if not crossings:
        return path
    at = np.array([crossing.after for crossing in crossings]) + 1
    return replace(
        path,
        z=np.insert(path.z, at, [crossing.z for crossing in crossings], axis=0),
        direction=np.insert(path.direction, at, [crossing.direction for crossing in crossings], axis=0),
        mark=np.insert(path.mark, at, int(Mark.CROSSING)),
        orientation=np.insert(path.orientation, at, [crossing.orientation for crossing in crossings]),
        shift=np.insert(path.shift, at, path.shift[at - 1]),
    )


class _Along:
    def __init__(self, system: System, path: Path) -> None:
        self.system, self.path = system, path
        self.verdicts: dict[int, Verdict] = {}
        self.evaluations = 0
        self.multipliers = multipliers_of(system, float(path.parameter.max(initial=0.0)))
        self.fold = (path.mark & Mark.FOLD) != 0

    def run(self) -> Stability:
        stable = np.zeros(self.path.z.shape[0])
        crossings: list[Crossing] = []
        for first, last in _runs(self._even()):
            self._look(first, last)
            at = np.array(sorted(i for i in self.verdicts if first <= i <= last))
            known = np.array([self.verdicts[i].stable for i in at.tolist()])
            # points between two that were looked at have neighbours that agree
            stable[first : last + 1] = known[_nearer(at, first, last)]
            crossings += self._crossings(at)
        return Stability(stable, tuple(crossings), self.evaluations)

    def _even(self) -> npt.NDArray[np.bool_]:
        """Whether the number of real multipliers above 1 is even, folds included on that side."""
        sign = self.path.orientation * np.sign(self.path.direction[:, -1])
        even: npt.NDArray[np.bool_] = (sign > 0.0) | self.fold
        return even

    def _verdict(self, i: int) -> Verdict:
        if i not in self.verdicts:
            self.evaluations += 1
            self.verdicts[i] = self.multipliers.verdict(self.path.z[i], bool(self.fold[i]))
        return self.verdicts[i]

    def _look(self, first: int, last: int) -> None:
        """Enough points of a run."""
        parts = max(-(-(last - first) // SPAN), 1)
        nodes = np.unique(np.linspace(first, last, parts + 1).astype(int)).tolist()
        for i in nodes:
            self._verdict(i)
        for a, b in itertools.pairwise(nodes):
            self._between(a, b)

    def _between(self, a: int, b: int) -> None:
        """Look between two points until neither the verdict nor a change of its sign can hide there."""
        if b - a < 2:
            return
        one, other = self._verdict(a), self._verdict(b)
        if one.passive and other.passive:
            return
        middle = (a + b) // 2
        if not _straight(one, self._verdict(middle), other):
            self._between(a, middle)
            self._between(middle, b)

    def _crossings(self, at: IntArray) -> Iterator[Crossing]:
        """Where the growth changes sign between neighbours of which both are told."""
        for a, b in itertools.pairwise(at.tolist()):
            one, other = self.verdicts[a], self.verdicts[b]
            if b > a + 1 or one.unknown or other.unknown:
                continue
            if (one.growth > 0.0) != (other.growth > 0.0):
                found = self._crossing(a)
                if found is not None:
                    yield found

    def _crossing(self, a: int) -> Crossing | None:
        """Where the growth changes sign between point a and the next: by secants that close in (Illinois)."""
        curve = Between(self.system.balance(), self.path, a)
        low, high, last, found = 0.0, 1.0, 0, None
        before, after = (max(self.verdicts[i].growth, ENOUGH) for i in (a, a + 1))
        kind = self.verdicts[a if before > 0.0 else a + 1].kind
        for _ in range(LOOKS):
            at = (low * after - high * before) / (after - before)
            if high - low < FINE or not curve.put(at):
                break
            self.evaluations += 1
            verdict = self.multipliers.verdict(curve.z)
            now = max(verdict.growth, ENOUGH)
            if isnan(now):
                break
            kind = verdict.kind if now > 0.0 else kind
            found = Crossing(a, kind, curve.z, curve.direction, curve.orientation)
            if abs(now) < ZERO:
                break
            if (now > 0.0) == (before > 0.0):
                after = 0.5 * after if last == 1 else after
                low, before, last = at, now, 1
            else:
                before = 0.5 * before if last == -1 else before
                high, after, last = at, now, -1
        return found


def _runs(flags: npt.NDArray[np.bool_]) -> Iterator[tuple[int, int]]:
    """First and last index of each run of flags."""
    edges = np.flatnonzero(np.diff(np.concatenate(([False], flags, [False])).astype(int)))
    for first, end in edges.reshape(-1, 2).tolist():
        yield first, end - 1


def _straight(one: Verdict, middle: Verdict, other: Verdict) -> bool:
    """Whether three verdicts agree, with growths so nearly on a line that none between has another sign."""
    verdicts = (one, middle, other)
    if all(isnan(v.stable) for v in verdicts):
        return True
    if not one.stable == middle.stable == other.stable:
        return False
    # what is unstable is no less so by a flip besides
    if one.stable == 1.0 and min(v.turn for v in verdicts) < TURN:
        return False
    safe = max(v.growth for v in verdicts) < SAFE
    if not safe and not one.held == middle.held == other.held:
        return False
    if one.stable == 1.0 and (safe or any(v.passive for v in verdicts)):
        return True
    a, b, c = (max(v.growth, ENOUGH) for v in verdicts)
    return abs(b - 0.5 * (a + c)) < DEVIATION * min(abs(a), abs(b), abs(c))


def _nearer(at: IntArray, first: int, last: int) -> IntArray:
    """For each of first to last the number of the nearest in at, which holds both."""
    return np.rint(np.interp(np.arange(first, last + 1), at, np.arange(at.size))).astype(np.intp)
