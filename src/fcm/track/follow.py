"""Follow a special point of a response as a curve in a number of its scene, through its corners and turns."""

from __future__ import annotations

from dataclasses import dataclass, replace
from enum import Enum
from itertools import pairwise

import numpy as np

from fcm.continuation.newton import Newton
from fcm.harmonic.system import System
from fcm.scene.model import FloatArray
from fcm.track.corner import Corner, nearest
from fcm.track.onset import onsets
from fcm.track.tracked import Condition, Kind, Tracked
from fcm.track.varied import Line, Varied

FIRST, SHORTEST = 1e-3, 1e-7  # steps, in the problem's scale
COSINE = 0.94  # of the turn in a step: at most 20 degrees
MISSED = 0.3  # of a step, by which the prediction may be wrong
NEAR = 1e-2  # a corner further away than this does not end a curve
LEAP = (1e-5, 1e-4, 1e-6, 1e-3)  # beyond a corner at which what is tracked is looked for again
CONTINUOUS = 1e-4  # of what is special: less is no jump at a corner
MOST = 3000  # points of a curve
FINE = 1e-11  # of a step: a turn is known to this
KINK = 1e-9  # of the span, by which a kink is passed
SHARP = 1e-4  # a step this short may turn by any angle below a right angle: means have corners, too
SKIPS = (1e-6, 1e-5)  # of the span, by which a corner of the curve is passed
FLAT = 1e-3  # in the problem's scale: what moves more there is another curve
BENT = 5.0  # of such a step, by which the prediction may be wrong
SHORT = 1e-3  # a step below which a corner of the response is looked for ahead
AHEAD = 0.5  # cosine of the angle with the direction, of what lies ahead
AIM = 0.2  # [rad] the turn that a step aims at
FAR = 0.3  # in the problem's scale: a start that is corrected by more is none


class Ending(Enum):
    """How a tracked curve ended."""

    SPAN = "the number reached an end of its range"
    RANGE = "its frequency left the range that is traced"
    CLOSED = "the curve came back to where it began"
    STALLED = "no further point could be found"
    LONG = "there are too many points"

    @property
    def whole(self) -> bool:
        """Whether there is no more of the curve."""
        return self in (Ending.SPAN, Ending.RANGE, Ending.CLOSED)


@dataclass(frozen=True)
class Spot:
    """A point of a tracked curve: z = (x, omega, s), its direction in units of z, and what it is."""

    z: FloatArray
    direction: FloatArray
    corner: Condition | None = None  # of the response, where that is what is special
    turn: bool = False  # the number turns back
    station: bool = False  # the number has a value that was asked for
    switch: bool = False  # a corner begins or ends to be what is special


@dataclass(frozen=True)
class Way:
    """What all curves of one run share."""

    system: System
    line: Line
    span: tuple[float, float]  # of s
    stations: tuple[float, ...] = ()
    step: float = 0.05  # longest

    def tracked(self, condition: Condition) -> Tracked:
        """The problem of a condition, with a balance of its own."""
        return Tracked(Varied(self.system, self.line), condition, self.span[1] - self.span[0])


def follow(way: Way, condition: Condition, start: Spot, forward: bool) -> tuple[list[Spot], Ending]:
    """The curve from a spot, which is the first of the list, with s rising or falling at first."""
    return _Follower(way, condition).run(start, forward)


def land(way: Way, condition: Condition, z: FloatArray) -> Spot | None:
    """The spot near z = (x, omega, s) at the same s; at a corner if there is one that holds."""
    return _Follower(way, condition).land(z)


def _kinks(way: Way) -> list[float]:
    """Values of s at which a preload changes sign: what the structure at rest bears has a kink there."""
    loads = np.array([[c.n_0 for c in way.line.scene(way.system.scene, s).contacts] for s in way.span])
    found = set()
    for low, high in loads.T:
        if low * high <= 0.0 and low != high:
            found.add(float(way.span[0] - low * (way.span[1] - way.span[0]) / (high - low)))
    return sorted(found)


class _Follower:
    """z, t: the place it has come to, and the direction there in the problem's scale, a unit vector."""

    def __init__(self, way: Way, condition: Condition) -> None:
        self.way, self.condition = way, condition
        self.smooth = way.tracked(condition)
        self.low, self.high = way.system.scene.frequency_range
        self.turns = condition.kind in (Kind.FOLD, Kind.PEAK)
        self.values = sorted({*way.span, *way.stations})
        self.kinks, self.first = _kinks(way), FIRST
        self.held = np.eye(self.smooth.n + 2)[-1]
        self._use(None)

    def _use(self, at: Condition | None) -> None:
        """Go on with the equation of a corner, or with that of the smooth curve."""
        self.corner = None if at is None else Corner(self.smooth, at)
        self.newton = Newton(self.smooth if self.corner is None else self.corner.problem)

    def land(self, z: FloatArray) -> Spot | None:
        self._measure(z)
        scale = np.array(self.newton.scale)
        for off, at in nearest(self.smooth.varied, z, scale) if self.turns else ():
            if off > NEAR:
                break
            self._use(at)
            self._measure(z)
            if self._solve(z, self.held) and self.newton.moved < NEAR and self._holds():
                return self._spot(np.array(self.newton.z), np.array(self.newton.tangent))
        self._use(None)
        self._measure(z)
        if self._solve(z, self.held) and self.newton.moved < FAR:
            return self._spot(np.array(self.newton.z), np.array(self.newton.tangent))
        return None

    def run(self, start: Spot, forward: bool) -> tuple[list[Spot], Ending]:
        self._use(start.corner)
        self._measure(start.z)
        row, beside = self.held if forward else -self.held, np.array(start.z)
        if beside[-1] in self.kinks:
            beside += KINK * self.smooth.span * row
        if not self._solve(beside, row):
            return [], Ending.STALLED
        self._accept()
        first, heading, step = self.z, self.t * np.asarray(self.newton.scale), FIRST
        self.spots = [self._spot(self.z, self.t)]
        if self._outside(self.z[-1] + self.t[-1] * SHORTEST * self.smooth.span):
            return self.spots, Ending.SPAN
        for count in range(MOST):
            before = self.z
            taken = self._advance(step)
            if isinstance(taken, Ending):
                return self.spots, taken
            step = taken
            if self._outside(self.z[-1]):
                return self.spots[:-1], Ending.SPAN
            if count > 2 and self._passes(before, first, heading):
                self.spots.append(self.spots[0])
                return self.spots, Ending.CLOSED
        return self.spots, Ending.LONG

    def _outside(self, s: float) -> bool:
        low, high = self.way.span
        return not low - KINK * self.smooth.span < s < high + KINK * self.smooth.span

    def _advance(self, step: float) -> float | Ending:
        """One step; the length of the next, or how the curve ends."""
        bend, met = self.bend, False
        while step > SHORTEST:
            scale = np.asarray(self.newton.scale)
            guess = self.z + scale * (step * self.t + 0.5 * step * step * bend)
            if (kink := self._kink(guess)) is not None and (passed := self._pass(guess, kink, step)):
                return passed
            sharp = step < SHARP
            good = self._solve(guess, self.t) and self.newton.moved < (BENT if sharp else MISSED) * step
            turned = float(np.asarray(self.newton.tangent) @ self.t) if good else 0.0
            good = good and turned > (0.0 if sharp else COSINE)
            good = good and not self._crosses()
            if good and not self._holds():
                return self._leave(step)
            if good:
                return self._keep(step)
            step *= 0.25
            if step < SHORT and not met:
                met = True
                if self._meet():
                    return self.first
        return self._skip()

    def _skip(self) -> float | Ending:
        """Go on just beyond a corner of the curve itself, with s held a little further on."""
        rise = float(np.sign(self.t[-1]))
        for leap in () if self.turns else SKIPS:
            guess = self.z + rise * leap * self.smooth.span * self.held
            if (
                not self._outside(guess[-1])
                and self._solve(guess, rise * self.held)
                and self.newton.moved < FLAT
            ):
                self._accept()
                self.spots.append(self._spot(self.z, self.t))
                return FIRST
        return Ending.STALLED

    def _keep(self, step: float) -> float | Ending:
        """Go on to the point that was found, with what happens on the way."""
        z, t = np.array(self.newton.z), np.array(self.newton.tangent)
        missed, scale = max(self.newton.moved / step, 1e-9), np.array(self.newton.scale)
        if self.t[-1] * t[-1] < 0.0:
            self._turn(step, t)
        ends = self._stations(step, z, t)
        if ends:
            return Ending.SPAN
        if not self.low <= z[-2] <= self.high:
            return self._out(step, z)
        self.newton.z[:], self.newton.tangent[:] = z, t
        turned = float(np.arccos(min(float(self.t @ t), 1.0)))
        bend = (t - self.t) / step
        self._accept()
        ratio = scale / np.asarray(self.newton.scale)
        self.bend = (bend - (bend @ t) * t) * ratio
        self.spots.append(self._spot(self.z, self.t))
        grown = min(AIM / max(turned, 1e-9), float(np.sqrt(0.03 / missed)))
        return min(step * min(max(0.9 * grown, 0.4), 2.5), self.way.step)

    def _crosses(self) -> bool:
        """Whether a corner of the response lies between here and the point found; it is to be landed on."""
        if self.corner is not None or not self.turns:
            return False
        here, there = (self._signs(z) for z in (self.z, np.array(self.newton.z)))
        return bool((here * there < 0.0).any())

    def _signs(self, z: FloatArray) -> FloatArray:
        """Signs of the functions of all onsets."""
        varied = self.smooth.varied
        varied.put(float(z[-1]))
        laws = varied.balance.laws
        return np.sign([one.value for one in onsets(laws, z, varied.harmonics)])

    def _kink(self, guess: FloatArray) -> float | None:
        """The first value of s between here and a guess at which the equations have a kink."""
        passed = [k for k in self.kinks if (k - self.z[-1]) * (k - guess[-1]) < 0.0]
        return min(passed, key=lambda k: abs(k - self.z[-1]), default=None)

    def _pass(self, guess: FloatArray, kink: float, step: float) -> float | Ending | None:
        """Go on just beyond a kink, with a first step; None if it is not reached."""
        part = (kink - self.z[-1]) / (guess[-1] - self.z[-1])
        rise = float(np.sign(guess[-1] - self.z[-1]))
        there = self.z + part * (guess - self.z)
        there[-1] = kink
        if not self._solve(there, rise * self.held) or self.newton.moved > 0.5 * step:
            return None
        z, t = np.array(self.newton.z), np.array(self.newton.tangent)
        if self._stations(step, z, t):
            return Ending.SPAN
        beyond = z.copy()
        beyond[-1] += rise * KINK * self.smooth.span
        if not self._holds() or not self._solve(beyond, rise * self.held):
            return None
        self.spots.append(self._spot(z, t))
        self._accept()
        return FIRST

    def _between(self, at: float) -> bool:
        """Find the point at a length of the step from here."""
        scale = np.asarray(self.newton.scale)
        return self._solve(self.z + scale * (at * self.t + 0.5 * at * at * self.bend), self.t)

    def _turn(self, step: float, after: FloatArray) -> None:
        """Keep where s turns back within the step, by the secant kept between two signs (Illinois)."""
        low, high, below, above, last = 0.0, step, self.t[-1], after[-1], 0
        for _ in range(40):
            at = (low * above - high * below) / (above - below)
            if high - low <= FINE * step or not self._between(at):
                break
            now = float(self.newton.tangent[-1])
            if now * below > 0.0:
                above, low, below, last = above * (0.5 if last == 1 else 1.0), at, now, 1
            else:
                below, high, above, last = below * (0.5 if last == -1 else 1.0), at, now, -1
            if now == 0.0:
                break
        self.spots.append(
            replace(self._spot(np.array(self.newton.z), np.array(self.newton.tangent)), turn=True)
        )

    def _stations(self, step: float, z: FloatArray, t: FloatArray) -> bool:
        """Keep the values of s that were asked for within the step; whether s leaves its span there."""
        way = [(self.z, None), *((spot.z, spot) for spot in self.spots[-1:] if spot.turn), (z, None)]
        for (one, _), (other, _) in pairwise(way):
            rise = other[-1] - one[-1]
            passed = [v for v in self.values if (v - one[-1]) * (v - other[-1]) < 0.0 or v == other[-1]]
            for value in sorted(passed, reverse=bool(rise < 0.0)):
                guess = one + (other - one) * ((value - one[-1]) / rise)
                if not self._solve(guess, self.held * np.sign(rise)) or self.newton.moved > step:
                    continue
                self.spots.append(
                    replace(self._spot(np.array(self.newton.z), np.array(self.newton.tangent)), station=True)
                )
                if value in self.way.span and rise * (value - sum(self.way.span) / 2.0) > 0.0:
                    return True
        return False

    def _out(self, step: float, z: FloatArray) -> Ending:
        """Keep the point at the end of the range of frequencies."""
        end = self.low if z[-2] < self.low else self.high
        part = (end - self.z[-2]) / (z[-2] - self.z[-2])
        guess, row = self.z + part * (z - self.z), np.eye(z.size)[-2]
        guess[-2] = end
        if self._solve(guess, row if z[-2] > self.z[-2] else -row):
            self.spots.append(self._spot(np.array(self.newton.z), np.array(self.newton.tangent)))
        return Ending.RANGE

    def _meet(self) -> bool:
        """Whether the curve ends at a corner of the response: this is tracked from there on, or crossed."""
        if self.corner is not None or not self.turns:
            return False
        z, came, before = self.z, self.t * np.asarray(self.newton.scale), float(self.t[-1])
        for off, at in nearest(self.smooth.varied, z, np.asarray(self.newton.scale)):
            if off > NEAR:
                break
            self._use(at)
            self._measure(z)
            assert self.corner is not None
            self.corner.problem.offset = 0.0
            self.corner.problem.evaluate(z)
            side = int(self.corner.problem.residual[-1] > 0.0)
            there = self.corner.zero(z, side)
            if there is not None and self._is_ahead(there) and self._go_on(there, side, came, before):
                return True
        self._use(None)
        self._measure(z)
        return False

    def _is_ahead(self, corner: FloatArray) -> bool:
        """Whether a corner lies where the curve leads."""
        off = (corner - self.z) / np.asarray(self.newton.scale)
        far = float(np.linalg.norm(off))
        return far < NEAR and (far < SHORTEST or bool(off @ self.t > AHEAD * far))

    def _go_on(self, there: FloatArray, side: int, came: FloatArray, before: float) -> bool:
        """Go on from a corner that was come to from a side: along it, or on its other side."""
        assert self.corner is not None
        if abs(self.corner.sides(there)[1 - side]) > CONTINUOUS:
            return self._begin(there, came, before)
        exact = self.corner.zero(there, None)
        return exact is not None and self._beyond(exact, came, before, 1 - 2 * side)

    def _begin(self, z: FloatArray, came: FloatArray, before: float) -> bool:
        """Go on along the corner that was landed on, to the side on which it holds."""
        assert self.corner is not None
        found = self.corner.reach(z)
        if found is None:
            return False
        scale, t = np.array(self.newton.scale), found[1]
        ways = [t, -t] if t @ (came / scale) > 0.0 else [-t, t]
        for way in ways:
            if self._solve(z + scale * LEAP[1] * way, way) and self._holds():
                self.newton.z[:], self.newton.tangent[:] = z, way
                self._accept()
                self.first = FIRST
                self.spots.append(replace(self._spot(z, way), switch=True, turn=before * way[-1] < 0.0))
                return True
        return False

    def _beyond(self, z: FloatArray, came: FloatArray, before: float, sign: int) -> bool:
        """Go on with the smooth curve from a corner, to the side where its function has a sign."""
        corner = self.corner
        assert corner is not None
        for leap in LEAP:
            self._use(corner.at)
            self._measure(z)
            there = self.corner.zero(z, None, sign * leap) if self.corner is not None else None
            if there is None:
                continue
            self._use(None)
            self._measure(there)
            row = (there - z) / np.asarray(self.newton.scale)
            if self._solve(there, row / np.linalg.norm(row)) and self.newton.moved < 1e-6:
                self._accept()
                self.first = leap
                turn = bool(before * self.t[-1] < 0.0)
                self.spots += [Spot(z, came, None, turn, switch=True), self._spot(self.z, self.t)]
                return True
        self._use(corner.at)
        self._measure(z)
        return False

    def _leave(self, step: float) -> float | Ending:
        """The corner is no more what is tracked: go on with the smooth curve on the side that has it."""
        low, high = 0.0, step
        assert self.corner is not None
        for _ in range(30):
            middle = 0.5 * (low + high)
            if self._between(middle) and self._holds():
                low = middle
            else:
                high = middle
        self._between(low)
        z, before = np.array(self.newton.z), float(self.t[-1])
        came = self.t * np.asarray(self.newton.scale)
        for side in np.argsort(np.abs(self.corner.sides(z))):
            there = self.corner.zero(z, int(side))
            if there is not None and self._beyond(there, came, before, 2 * int(side) - 1):
                return self.first
        return Ending.STALLED

    def _holds(self) -> bool:
        """Whether the point found is a corner that is what is tracked; any is, that is not a corner."""
        return self.corner is None or self.corner.holds(np.array(self.newton.z))

    def _solve(self, guess: FloatArray, row: FloatArray) -> bool:
        self.newton.z[:], self.newton.row[:] = guess, row
        try:
            return bool(self.newton.correct(1e-3)) and bool(np.isfinite(self.newton.z).all())
        except np.linalg.LinAlgError:
            return False

    def _measure(self, z: FloatArray) -> None:
        """Units, and the row of the tangent, at a place."""
        self.smooth.measure(z)
        if self.corner is not None:
            self.corner.problem.row[:] = self.smooth.row
            self.corner.problem.measure(z)
        self.newton.scale[:] = self.smooth.scale

    def _accept(self) -> None:
        """Go on from the point found."""
        self.z = np.array(self.newton.z)
        t = np.asarray(self.newton.tangent) * np.asarray(self.newton.scale)
        self._measure(self.z)
        t = t / np.asarray(self.newton.scale)
        self.t = t / np.linalg.norm(t)
        self.bend = np.zeros(self.z.size)

    def _spot(self, z: FloatArray, t: FloatArray) -> Spot:
        at = None if self.corner is None else self.corner.at
        return Spot(z, t * np.asarray(self.newton.scale), at)

    def _passes(self, before: FloatArray, first: FloatArray, heading: FloatArray) -> bool:
        """Whether the last step passes the point where the curve began, in the same direction."""
        scale = np.asarray(self.newton.scale)
        heading = heading / scale
        heading = heading / np.linalg.norm(heading)
        one, other = (before - first) / scale, (self.z - first) / scale
        length = np.linalg.norm(other - one)
        if min(np.linalg.norm(one), np.linalg.norm(other)) > length:
            return False
        return bool(one @ heading < 0.0 <= other @ heading and self.t @ heading > 0.5)
