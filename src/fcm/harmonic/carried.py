"""Solutions at a frequency where those with fewer harmonics are known.

The level leads to what hangs together with rest, and which solutions do is another matter with each number of
harmonics: what the level of seven passes on one curve may be off that of nineteen, and just as true. So what
was found with fewer is led to more, and is a solution beside those of the level. The level of very many
harmonics takes longer to follow than the branches themselves, and passes 1 where that of many does. So once
many have told which solutions there are, and each of them is close to one with more, these are all; where
one is not, or the level turned so near 1 that more harmonics may move the turn across it, the level is
followed again. With a few it always is: branches come to be up to the seventh harmonic or so.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np

from fcm.continuation import FollowOptions, Path, Status, follow
from fcm.harmonic.balance import Balance
from fcm.harmonic.linear_contacts import foresee
from fcm.harmonic.nearby import lowest_of, turns_near
from fcm.harmonic.replaced import Replaced
from fcm.harmonic.start import Found, solutions
from fcm.harmonic.system import System
from fcm.scene.model import FloatArray

MANY = 7  # harmonics, from the first on, with which a peak is within a per cent or so
FAR = 0.5  # of a solution's size: a Newton step that leads further is not believed
CLOSE = 0.1  # of it: what moves further may have come to another solution
ON_THE_WAY = FollowOptions(0.5)  # to a solution
DETOUR = -9.0  # as far back as the way may lead before it does: it has folds
REPORTS = 16  # of the follower, of 16 steps each, after which it is too long
APART = 1e-3  # of their size: solutions that come closer than this have become one


def found_at(system: System, frequencies: Sequence[float], fewer: Sequence[Found] = ()) -> tuple[Found, ...]:
    """Solutions at some frequencies, of fewer harmonics where those are known; many are known before more."""
    if len(system.harmonics) > MANY and not any(len(one.harmonics) >= MANY for one in fewer):
        fewer = found_at(system.with_harmonics(system.harmonics[:MANY]), frequencies, fewer)
    foresee(system, frequencies)
    known = {one.omega: one for one in fewer}
    return tuple(_at(system, omega, known.get(omega)) for omega in frequencies)


def _at(system: System, omega: float, before: Found | None) -> Found:
    if before is None:
        return solutions(system, omega)
    reach = before.reach if np.isfinite(before.reach) else None
    return carried(system, before) or _with_led(system, solutions(system, omega, reach), before)


def carried(system: System, before: Found) -> Found | None:
    """What was found with fewer harmonics, with those of a system; None where the level is to be followed."""
    few = lowest_of(before.harmonics) < MANY
    if few or not before.solutions or not before.complete or turns_near(before):
        return None
    known: list[FloatArray] = []
    for z in before.solutions:
        there = at_its_frequency(system, system.extended(z, before.harmonics), CLOSE)
        if there is None or any(same(there, other) for other in known):
            return None
        known.append(there)
    turns = tuple(turn.extended(system, before.harmonics) for turn in before.turns)
    return replace(before, harmonics=system.harmonics, solutions=tuple(known), turns=turns)


def _with_led(system: System, found: Found, before: Found) -> Found:
    """With the solutions that those of fewer harmonics lead to and the level does not."""
    known = list(found.solutions)
    for z in before.solutions:
        there = led_to(system, system.extended(z, before.harmonics))
        if there is not None and not any(same(there, other) for other in known):
            known.append(there)
    return replace(found, solutions=tuple(known))


def led(
    system: System, fewer: tuple[int, ...], paths: Sequence[Path], frequencies: Sequence[float]
) -> Iterator[FloatArray]:
    """Solutions that the points of paths of fewer harmonics at some frequencies lead to."""
    for path in paths:
        for z in path.z[np.isin(path.parameter, frequencies)]:
            there = led_to(system, system.extended(z, fewer))
            if there is not None:
                yield there


def place_on(system: System, path: Path, z: FloatArray) -> int | None:
    """The point of a path between which and the next the solution z lies; None if there is none."""
    w = path.parameter - z[-1]
    for i in np.flatnonzero((w[:-1] * w[1:] <= 0.0) & (w[:-1] != w[1:])).tolist():
        guess = path.z[i] + w[i] / (w[i] - w[i + 1]) * (path.z[i + 1] - path.z[i])
        there = at_its_frequency(system, guess)
        if there is not None and same(there, z):
            return int(i)
    return None


def same(one: FloatArray, other: FloatArray) -> bool:
    """Whether two solutions at a frequency are one."""
    return bool(np.abs(one - other)[:-1].max() < APART * np.abs(one[:-1]).max())


def at_its_frequency(system: System, z: FloatArray, far: float = FAR) -> FloatArray | None:
    """The solution that Newton's method finds from z at its frequency, if that is not far."""
    balance, newton = system.afresh(), system.stepper.newton
    newton.z[:], newton.row[:] = z, np.eye(z.size)[-1]
    balance.measure(z)
    newton.scale[:] = balance.scale
    return np.array(newton.z) if newton.correct(1.0) and newton.moved < far else None


def led_to(system: System, z: FloatArray) -> FloatArray | None:
    """The solution that a guess z leads to at its frequency, by one step or by a way of many."""
    near = at_its_frequency(system, z)
    if near is not None:
        return near
    way, left = _Way(system.afresh(), z), REPORTS

    def tire(_: float) -> None:
        nonlocal left
        left -= 1
        if not left:
            raise _LostError

    try:
        path = follow(way, np.append(z[:-1], 0.0), (DETOUR, 1.0), options=ON_THE_WAY, progress=tire)
    except _LostError:
        return None
    arrived = path.status is Status.COMPLETE and path.parameter[-1] == 1.0
    return np.append(path.z[-1, :-1], z[-1]) if arrived else None


class _LostError(Exception):
    """The way leads too far."""


class _Way(Replaced):
    """From a guess to a solution: F(x) = (1 - t) F(guess), where the parameter t leads from 0 to 1.

    Its corners are no events, but places at which the steps are short.
    """

    def __init__(self, balance: Balance, guess: FloatArray) -> None:
        Replaced.__init__(self, balance)
        self.at = guess.copy()
        balance.evaluate(guess)
        self.given = np.array(balance.residual)

    def evaluate(self, z: FloatArray) -> int:
        balance = self._put(z)
        balance.evaluate(self.at)
        np.asarray(self.residual)[:] = np.asarray(balance.residual) - (1.0 - z[-1]) * self.given
        np.asarray(self.jacobian)[:] = balance.jacobian
        np.asarray(self.jacobian)[:, -1] = self.given
        return 0

    def measure(self, z: FloatArray) -> int:
        balance = self._put(z)
        balance.measure(self.at)
        np.asarray(self.scale)[:] = balance.scale
        self.scale[-1] = 1.0
        return 0

    def _put(self, z: FloatArray) -> Balance:
        self.at[:-1] = np.asarray(z)[:-1]
        return self.inner

    def factor(self, row: FloatArray, scale: FloatArray) -> float:
        np.asarray(self.inner.jacobian)[:] = self.jacobian
        return super().factor(row, scale)
