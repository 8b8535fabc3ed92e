r"""Folds of the level of the forces, followed as curves in (frequency, level).

At a fixed frequency the level of the forces turns back at folds; where the frequency varies these make
curves, on which the test function g of `surface` is zero. Such a curve is followed by predictor and
corrector on the surface of all solutions: the zero of g on an arc of a circle ahead is the next place
(Allgower and Georg, "Introduction to Numerical Continuation Methods", SIAM 2003; Rheinboldt, Numer. Math. 53
(1988) 165, for the local axes of a surface). Only the sign of g counts, so that nothing is differentiated
twice, and a fold that lies in a corner of the solutions, where g jumps, is followed like any other. Cusps,
where two folds meet, are ordinary places of such a curve; where their curves touch on the surface, and the
strip between them vanishes, the curve goes back on the other side of the strip.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from enum import Enum
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from fcm.branches.options import FOLDS, FoldOptions
from fcm.branches.surface import Surface
from fcm.scene.model import FloatArray


class Ending(Enum):
    """How a curve of folds ended."""

    RANGE = "it left the range of frequencies"
    LEVEL = "it left the levels that are looked at"
    CLOSED = "it came back to where it began"
    STALLED = "no further fold was found"
    LONG = "it has too many points"


@dataclass(frozen=True)
class Folds:
    """Folds along a curve, in order.

    z (point, n + 2): displacements, frequency [rad/s], level; singular (point, n + 2): the direction in which
    the displacements alone change, in the units of z.
    """

    z: FloatArray
    singular: FloatArray
    endings: tuple[Ending, Ending]

    @property
    def frequency(self) -> FloatArray:
        """[rad/s]."""
        return self.z[:, -2]

    @property
    def level(self) -> FloatArray:
        """Of the forces."""
        return self.z[:, -1]

    @property
    def lost(self) -> list[float]:
        """Frequencies [rad/s] of those ends from which the curve would go on; none where it is closed."""
        if Ending.CLOSED in self.endings:
            return []
        short = (Ending.STALLED, Ending.LONG)
        ends = zip(self.endings, self.frequency[[0, -1]].tolist(), strict=True)
        return [omega for ending, omega in ends if ending in short]


def folds_from(
    surface: Surface,
    start: FloatArray,
    across: Sequence[FloatArray],
    span: tuple[float, float],
    options: FoldOptions = FOLDS,
    paid: Callable[[], None] = lambda: None,
) -> Folds | None:
    """The curve of folds through one, both ways; None where there is none near the start.

    Parameters
    ----------
    surface : Surface
        Of the balance.
    start : (n + 2,)
        A fold.
    across : sequence of (n + 2,)
        Directions of the surface across the curve there, as of the solutions at that frequency: of which the
        first is taken that both sides of the fold can be seen by.
    span : (low, high)
        Of the frequency [rad/s].
    paid : callable
        Called now and then.
    """
    follower = _Follower(surface, span, options, paid)
    for singular in across:
        ways = follower.ways(start, singular)
        if ways:
            break
    else:
        return None
    ahead, ending = follower.run(start, singular, ways[0])
    if ending is Ending.CLOSED:
        return _joined(ahead, (ending, ending))
    back, other = follower.run(start, singular, ways[1])
    return _joined([*reversed(back), *ahead], (other, ending))


_Point = tuple[FloatArray, FloatArray]


def _joined(points: list[_Point], endings: tuple[Ending, Ending]) -> Folds:
    return Folds(np.array([z for z, _ in points]), np.array([v for _, v in points]), endings)


class _Way(NamedTuple):
    """From the centre to a place of the curve: length, angle; directions (n + 2,), in the units of z, to
    there and across, in the middle of both sides of the curve; the sign of the test function on its left."""

    radius: float
    angle: float
    along: FloatArray
    across: FloatArray
    left: float


class _Side(NamedTuple):
    """A place on one side of the curve: its angle, the test function, the direction of the circle there."""

    angle: float
    value: float
    across: FloatArray


class _Follower:
    """Steps along a curve of folds."""

    def __init__(
        self,
        surface: Surface,
        span: tuple[float, float],
        options: FoldOptions,
        paid: Callable[[], None],
    ) -> None:
        self.surface, self.span, self.options, self.paid = surface, span, options, paid

    def ways(self, start: FloatArray, singular: FloatArray) -> list[_Way]:
        """The two ways of the curve from its start."""
        if not self._begin(start, singular):
            return []
        for wider in self.options.wider:
            found = list(self._around(self.options.first * wider))
            pairs = [(a, b) for i, a in enumerate(found) for b in found[i + 1 :]]
            if pairs:
                opposite = np.argmin([np.cos(one.angle - other.angle) for one, other in pairs])
                return list(pairs[opposite])
        return []

    def run(self, start: FloatArray, singular: FloatArray, way: _Way) -> tuple[list[_Point], Ending]:
        """From the start on by one of its ways."""
        options, surface = self.options, self.surface
        self._begin(start, singular)
        self._side(way.radius, way.angle)
        if not surface.recentre(way.along, way.across):
            return [], Ending.STALLED
        points = [(np.array(surface.centre), way.across)]
        first, step, bend, turned = np.array(surface.centre), options.first, 0.0, False
        before, taken, retreats = first, way, options.retreats
        for count in range(options.most):
            found = self._ahead(step, bend, way.left)
            off = 2.0 * options.fine * way.radius
            while found is None and step > options.shortest:
                step, bend = 0.3 * step, 0.0
                if step < 10.0 * off and self._onto(off, way.left):
                    off *= options.fine
                if step < options.thin and not turned and self._over(options.thin):
                    turned, step = True, options.thin
                found = self._ahead(step, bend, way.left) or self._round(step, way.left)
            if found is None and retreats and len(points) > 1:  # the last step led to another part
                retreats, way, step, bend = retreats - 1, taken, 0.3 * way.radius, 0.0
                points.pop()
                surface.z[:] = before
                surface.recentre(way.along, way.across)
                continue
            if found is None:
                return points, Ending.STALLED
            before, taken, way = np.array(surface.centre), way, found
            if not surface.recentre(found.along, found.across):
                return points, Ending.STALLED
            points.append((np.array(surface.z), self._singular(found.across)))
            if count % options.report == 0:
                self.paid()
            ending = self._ended(points[-1][0])
            if ending is not None:
                return points, ending
            if count > 2 and _passes(first, before, points[-1][0], np.array(surface.scale)):
                return [*points, points[0]], Ending.CLOSED
            longer = min(max(options.turn / max(abs(found.angle), 1e-3), 0.4), 2.0) * step
            longer = min(longer, options.longest)
            bend, step = 0.5 * found.angle * (1.0 + longer / step), longer
        return points, Ending.LONG

    def _begin(self, start: FloatArray, singular: FloatArray) -> bool:
        other = np.zeros(start.size)
        other[-2] = self.span[1] - self.span[0]
        return self.surface.begin(np.array(start), other, np.array(singular))

    def _side(self, radius: float, angle: float) -> _Side:
        """A place on a circle about the centre; its value is NaN where there is none on this part."""
        surface, c, s = self.surface, np.cos(angle), np.sin(angle)
        if not surface.put(radius * c, radius * s):
            surface.z[:] = surface.centre
            return _Side(angle, np.nan, np.empty(0))
        tangents = np.asarray(surface.tangents)
        across = c * tangents[1] - s * tangents[0]
        length = float(np.linalg.norm(across))
        value = float(surface.value) if length < self.options.upright else np.nan
        return _Side(angle, value, across / length)

    def _around(self, radius: float, left: float = 0.0) -> Iterator[_Way]:
        """Ways to where the sign changes on a circle, with that sign on the left if one is given."""
        self.surface.z[:] = self.surface.centre
        angles = 2.0 * np.pi * np.arange(self.options.circle + 1) / self.options.circle - np.pi
        sides = [self._side(radius, angle) for angle in angles]
        for low, high in pairwise(sides):
            if low.value * high.value < 0.0 and (not left or left * high.value > 0.0):
                self._side(radius, low.angle)
                way = self._root(radius, low, high)
                if way is not None:
                    yield way

    def _root(self, radius: float, low: _Side, high: _Side) -> _Way | None:
        """The way between two sides, at whose end z is left; None where there is no place on the way."""
        at, fine, weights = np.inf, self.options.fine, [1.0, 1.0]
        while high.angle - low.angle > fine:
            before, after, width = weights[0] * low.value, weights[1] * high.value, high.angle - low.angle
            slope = abs(high.value - low.value)
            at = low.angle - before * width / (after - before)
            at = min(max(at, low.angle + 0.05 * width), high.angle - 0.05 * width)
            now = self._side(radius, at)
            if not np.isfinite(now.value):
                return None
            if now.value * low.value > 0.0:  # the method of Illinois
                low, weights = now, [1.0, 0.5 * weights[1]]
            else:
                high, weights = now, [0.5 * weights[0], 1.0]
            if abs(now.value) * width < fine * slope:
                break
        scale = np.asarray(self.surface.scale)
        along = np.asarray(self.surface.z) - np.asarray(self.surface.centre)
        angle = at if np.isfinite(at) else high.angle
        return _Way(
            radius, float(angle), along, scale * (low.across + high.across), float(np.sign(high.value))
        )

    def _ahead(self, step: float, bend: float, left: float) -> _Way | None:
        """The way to the next place, near the angle of a bend; None where it is not found."""
        most = self.options.most_turn
        self.surface.z[:] = self.surface.centre
        one = self._side(step, min(max(bend, -most), most))
        width = max(0.5 * abs(one.angle), self.options.turn)
        while np.isfinite(one.value):
            then = one.angle - np.sign(one.value * left) * width
            if abs(then) > most:
                return None
            other = self._side(step, then)
            if one.value * other.value <= 0.0:
                return self._root(step, *sorted((one, other), key=lambda side: side.angle))
            one, width = other, 2.0 * width
        return None

    def _onto(self, off: float, left: float) -> bool:
        """Take for the centre the place on the curve that is no further than that across it; whether it is
        there. A short step needs a centre that is nearer to the curve than the last step left it."""
        surface, axes = self.surface, np.array(self.surface.axes) * np.asarray(self.surface.scale)
        surface.z[:] = surface.centre
        here = self._side(0.0, 0.0).value
        side = -0.5 * np.pi * np.sign(here * left)
        there = self._side(off, side).value
        if not here * there < 0.0:
            return False
        low, high = 0.0, off
        while high - low > self.options.fine * off:
            middle = 0.5 * (low + high)
            low, high = (middle, high) if self._side(middle, side).value * here > 0.0 else (low, middle)
        return bool(surface.recentre(axes[0], axes[1]))

    def _over(self, thin: float) -> bool:
        """Cross the strip beside the curve if it is as thin as that: take for the centre the place of the
        curve on its other side, with the way back ahead. Whether it is that thin."""
        surface, axes = self.surface, np.array(self.surface.axes) * np.asarray(self.surface.scale)
        surface.z[:] = surface.centre
        one, other = (self._side(thin, side * 0.5 * np.pi).value for side in (1.0, -1.0))
        if not one * other > 0.0:
            return False
        for side in (1.0, -1.0):
            surface.z[:] = surface.centre
            high, low = thin, thin
            while low > self.options.fine * self.options.fine * thin:
                low *= 0.7
                if self._side(low, side * 0.5 * np.pi).value * one < 0.0:
                    break
                high = low
            else:
                continue
            while high - low > self.options.fine * low:
                middle = 0.5 * (low + high)
                inside = self._side(middle, side * 0.5 * np.pi).value * one < 0.0
                low, high = (middle, high) if inside else (low, middle)
            return bool(surface.recentre(-axes[0], axes[1]))
        return False

    def _round(self, step: float, left: float) -> _Way | None:
        """The way nearest ahead with the same sign on its left, on all of a circle but the way back."""
        ways = [way for way in self._around(step, left) if abs(way.angle) < 0.8 * np.pi]
        if not ways:
            return None
        nearest = min(ways, key=lambda way: abs(way.angle))
        self._side(step, nearest.angle)
        return nearest

    def _singular(self, across: FloatArray) -> FloatArray:
        """The direction in the surface that changes frequency and level least, in the units of z; at a corner
        that across the curve."""
        tangents, scale = np.asarray(self.surface.tangents), np.asarray(self.surface.scale)
        sizes, ways = np.linalg.svd(tangents[:, -2:].T)[1:]
        if sizes[1] > 0.1 * sizes[0]:
            return across
        way = ways[-1] @ tangents
        singular: FloatArray = way / np.linalg.norm(way) * scale
        return singular

    def _ended(self, z: FloatArray) -> Ending | None:
        if not self.span[0] <= z[-2] <= self.span[1]:
            return Ending.RANGE
        return None if self.options.within(z[-1]) else Ending.LEVEL


def _passes(first: FloatArray, before: FloatArray, after: FloatArray, scale: FloatArray) -> bool:
    """Whether a step comes by the first place of a curve."""
    way, off = (after - before) / scale, (first - before) / scale
    length = float(way @ way) or 1.0
    part = float(off @ way) / length
    return 0.0 < part <= 1.0 and float(np.linalg.norm(off - part * way)) < 0.3 * np.sqrt(length)
