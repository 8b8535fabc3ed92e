"""Stretches of a curve beside which the corrected curve is not found point by point: it is followed there.

Where a corner or a pair of folds has moved, no point of the corrected curve lies normal to the curve. But it
does on both sides, and from one of them the corrected curve can be followed to the other. With many contacts
that is dear, and may lead through any number of folds, so that all stretches of a curve have one effort.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from fcm.continuation import Path, Status, follow
from fcm.harmonic.balance import Balance
from fcm.harmonic.corrected import Corrected
from fcm.harmonic.points import Points
from fcm.harmonic.replaced import Replaced
from fcm.scene.model import FloatArray

STEP = 0.1  # longest, along the corrected curve
PATIENCE = 30  # reports of the follower, of 16 steps each, before it is given up
DEAR = 100  # unknowns from which on corners are passed by short steps: so many contacts have many, and slight
SAME = 0.02  # relative difference of amplitudes, up to which the curve has come to the other side
BEYOND = 1.0  # times the width of a stretch, how far beyond it the curve is followed
TRIES = 8  # points at an end of a stretch, from which it is sought


class _LostError(Exception):
    """The curve leads too far."""


class _Budget:
    """What is left of the effort of a corrected curve, for evaluations of a balance."""

    def __init__(self, corrected: Corrected, unknowns: int) -> None:
        self.corrected, self.each = corrected, float(unknowns**2)

    @property
    def left(self) -> float:
        """Evaluations."""
        return self.corrected.effort / self.each

    def take(self) -> None:
        """One more."""
        self.corrected.effort -= self.each
        if self.corrected.effort < 0.0:
            raise _LostError


class _Paid(Replaced):
    """A balance whose evaluations a budget pays, with its margins or without them.

    Without them its corners are no events, but places at which the steps are short.
    """

    def __init__(self, inner: Balance, budget: _Budget, margins: bool) -> None:
        Replaced.__init__(self, inner, inner.margins if margins else 0, inner.outputs)
        self.budget, self.group = budget, inner.group
        self.residual, self.jacobian, self.scale = inner.residual, inner.jacobian, inner.scale
        self.output, self.growth = inner.output, inner.growth
        if margins:
            self.margin, self.angle, self.kind = inner.margin, inner.angle, inner.kind

    def evaluate(self, z: FloatArray) -> int:
        self.budget.take()
        self.inner.evaluate(z)
        return 0

    def probe(self, z: FloatArray) -> int:
        self.inner.probe(z)
        return 0

    def measure(self, z: FloatArray) -> int:
        self.inner.measure(z)
        return 0

    def bound(self, z: FloatArray) -> int:
        self.inner.bound(z)
        return 0

    def report(self, z: FloatArray, direction: FloatArray) -> int:
        self.inner.report(z, direction)
        return 0


def heights(corrected: Corrected, first: int, last: int) -> FloatArray | None:
    """Greatest amplitudes (dof,) of the corrected curve between point first and point last of the path.

    These are the last points before and behind a stretch at which it was found; one of them may be beyond an
    end of the path. Where the corrected curve does not lead from one to the other, it is what hangs on both,
    as far as that stays near the stretch. None if that is nothing, or too long, which is foreseen from
    how many evaluations the stretch itself took.
    """
    path, more = corrected.path, _harmonics(corrected, first, last)
    before = _end(corrected, more, range(first, max(first - TRIES, -1), -1))
    behind = _end(corrected, more, range(last, min(last + TRIES, len(path.z))))
    span = _span(corrected, before, behind)
    balance = corrected.corrector.system.with_harmonics(more).balance()
    budget = _Budget(corrected, balance.unknowns)
    if _foreseen(corrected, more, first, last) > budget.left:
        return None
    pieces = []
    for begin, end in ((before, behind), (behind, before)):
        if begin is None:
            continue
        piece = _followed(balance, budget, begin, end, span, begin.rises == (begin is before))
        if piece is None or not piece.greatest.any():  # not a point of it was found
            return None
        if piece.arrived:
            return piece.greatest
        pieces.append(piece.greatest)
    return np.max(pieces, axis=0) if pieces else None


def effort_of(corrected: Corrected, first: int, last: int) -> float:
    """What following the corrected curve between two points is foreseen to take of the effort."""
    more = _harmonics(corrected, first, last)
    unknowns = len(corrected.corrector.system.scene.contacts) * (2 + 4 * len(more))
    return _foreseen(corrected, more, first, last) * float(unknowns**2)


def _harmonics(corrected: Corrected, first: int, last: int) -> tuple[int, ...]:
    """Those of the corrected curve between two points, which may be beyond the ends of the path."""
    inside = np.linspace(max(first, 0), min(last, len(corrected.path.z) - 1), 5)
    return corrected.sets(np.unique(inside.astype(np.intp)))


def _foreseen(corrected: Corrected, more: tuple[int, ...], first: int, last: int) -> float:
    """Evaluations that it takes with more harmonics, by those that the stretch itself took."""
    path = corrected.path
    grown = len(more) / len(corrected.corrector.system.harmonics)  # as the corners and folds are
    return grown * path.evaluations * (last - first) / len(path.z)


@dataclass(frozen=True)
class _End:
    """A point of the corrected curve at an end of a stretch, and whether the frequency rises there."""

    number: int
    z: FloatArray
    amplitude: FloatArray
    rises: bool


@dataclass(frozen=True)
class _Piece:
    """Greatest amplitudes (dof,) of a piece of the corrected curve, and whether it came to the other end."""

    greatest: FloatArray
    arrived: bool


def _end(corrected: Corrected, more: tuple[int, ...], places: Iterable[int]) -> _End | None:
    """At the first of some places where there is one."""
    path, lifted = corrected.path, corrected.corrector.lifted(more)
    for i in places:
        if lifted.beside(path.z[i], path.direction[i]):
            rises = lifted.newton.tangent[-1] > 0.0
            return _End(i, np.array(lifted.newton.z), np.array(lifted.found[1:]), bool(rises))
    return None


def _followed(
    balance: Balance,
    budget: _Budget,
    begin: _End,
    end: _End | None,
    span: tuple[float, float],
    forward: bool,
) -> _Piece | None:
    """The corrected curve from one end to the other, or as far as it stays in the span."""
    stations = (float(end.z[-1]),) if end else ()
    try:
        path = _path(balance, budget, begin.z, span, forward, stations)
    except _LostError:
        return None
    points = Points(balance, len(path.z))
    points.take(path.z, path.direction, np.ones(len(path.z)))
    amplitude = np.asarray(points.amplitude)
    last, arrived = len(amplitude), False
    if end:
        off = np.abs(amplitude - end.amplitude).max(axis=1, initial=0.0)
        there = np.flatnonzero((path.parameter == end.z[-1]) & (off < SAME * end.amplitude.max()))
        last, arrived = (int(there[0]) + 1, True) if there.size else (last, False)
    return _Piece(amplitude[:last].max(axis=0, initial=0.0), arrived)


def _path(
    balance: Balance,
    budget: _Budget,
    start: FloatArray,
    span: tuple[float, float],
    forward: bool,
    stations: tuple[float, ...],
) -> Path:
    """The curve from a start on, past its corners where these are many, and by way of them if that stalls."""
    reports = 0

    def count(_: float) -> None:
        nonlocal reports
        reports += 1
        if reports > PATIENCE:
            raise _LostError

    if balance.unknowns >= DEAR:
        path = follow(_Paid(balance, budget, False), start, span, forward, STEP, stations, count)
        if path.status is not Status.STALLED:
            return path
    return follow(_Paid(balance, budget, True), start, span, forward, STEP, stations, count)


def _span(corrected: Corrected, before: _End | None, behind: _End | None) -> tuple[float, float]:
    """Frequencies, and beyond them, as folds may have moved."""
    path, ends = corrected.path, [end for end in (before, behind) if end]
    first, last = before.number if before else 0, behind.number if behind else len(path.z) - 1
    inside = np.append(path.parameter[first : last + 1], [end.z[-1] for end in ends])
    low, high = float(inside.min()), float(inside.max())
    reach = BEYOND * (high - low)
    lowest, highest = corrected.corrector.system.scene.frequency_range
    return max(low - reach, min(lowest, low)), min(high + reach, max(highest, high))
