"""Where the level of the forces turns short of 1, and the solutions that come of that at other frequencies.

The level of the forces at which its curve turns is another at each frequency. Where it comes to be 1 a window
of several solutions begins or ends: a fold of the response, and maybe of a closed branch that lies between
the frequencies at which the level was followed, and that none of them tells of but by a turn near 1.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from itertools import pairwise
from typing import NamedTuple, Protocol

import numpy as np

from fcm.continuation import Path
from fcm.continuation.newton import Newton
from fcm.harmonic.floquet import multipliers_of
from fcm.harmonic.further import padded
from fcm.harmonic.system import System
from fcm.scene.model import FloatArray

SHORT = 4.0  # times 1, and that part of it: between these a turn may come to 1 within a range,
STAGE = 1.25  # by stages, each of so many times the level,
SHORTEST = 0.5  # and this part of that where Newton's method does not lead from one to the next
ASIDE = (0.02, 0.1)  # of its size: from a solution beside a fold to those on either side of that
FAR = 0.5  # of a solution's size: what Newton's method finds further away has little to do with the turn


class Loaded(Protocol):
    """A problem in the frequency, at the level of the forces that is its load."""

    load: float
    scale: FloatArray

    def measure(self, z: FloatArray) -> int:
        """See `Problem`."""


class Turn(NamedTuple):
    """Where the curve of a level turns: z (unknown + 1,), with the frequency; the curve's direction there
    (unknown + 1,), in which that does not change; short if it turns before it passes the level 1."""

    level: float
    z: FloatArray
    direction: FloatArray
    short: bool

    @property
    def may_come(self) -> bool:
        """Whether the level may be 1 at a turn like this one within a range."""
        return self.short and 1.0 / SHORT < self.level < SHORT

    def padded(self, harmonics: Sequence[int], more: Sequence[int]) -> Turn:
        """That of a balance with some harmonics as one of more."""
        z, direction = (padded(one, harmonics, more) for one in (self.z, self.direction))
        return self._replace(z=z, direction=direction)


def turns_of(path: Path, omega: float, unit: float = 1.0) -> tuple[Turn, ...]:
    """Where a curve of levels at a frequency turns; its displacements and levels are multiples of a unit."""
    levels = (unit * path.parameter).tolist()
    rises = [after > before for before, after in pairwise(levels)]
    found = []
    for i in (i for i in range(1, len(rises)) if rises[i] != rises[i - 1]):
        z, direction = np.append(unit * path.z[i, :-1], omega), np.append(path.direction[i, :-1], 0.0)
        found.append(Turn(levels[i], z, direction, (levels[i] < 1.0) == rises[i - 1]))
    return tuple(found)


def passed_beside(system: System, turns: Sequence[Turn]) -> Iterator[FloatArray]:
    """Stable solutions (unknown + 1,) at the level 1 beside turns short of it, at whatever frequencies.

    At a turn the balance F(x, omega, level) = 0 is singular in the displacements x alone. With the part of x
    along the curve held, the frequency takes its place among the unknowns, and is found for other levels,
    stage by stage, up to 1. That is beside a fold, of which one side at most is stable.
    """
    of = None
    for turn in turns:
        if not turn.may_come:
            continue
        balance, newton = system.afresh(), system.front.newton
        if came(balance, newton, turn):
            of = of or multipliers_of(system, system.scene.frequency_range[1])
            yield from (z for z in beside(newton) if of.verdict(z, enough=(1.0,)).stable == 1.0)


def came(problem: Loaded, newton: Newton, turn: Turn) -> bool:
    """Whether a turn leads to a solution at the level 1, by shorter stages where one was too long; newton is
    of that problem, and comes to it."""
    problem.load = turn.level
    problem.measure(turn.z)
    newton.z[:], newton.scale[:] = turn.z, problem.scale
    along = turn.direction / np.asarray(problem.scale)
    newton.row[:] = along / np.linalg.norm(along)
    left, known = math.log(turn.level), turn.z
    stage = left / max(math.ceil(abs(left) / math.log(STAGE)), 1)
    shortest = stage * SHORTEST
    while left != 0.0:
        then = left - stage if abs(left) > 1.5 * abs(stage) else 0.0
        problem.load = math.exp(then)
        if newton.correct(1.0) and newton.moved < FAR:
            left, known, newton.row[:] = then, np.array(newton.z), newton.tangent
        elif abs(stage) > abs(shortest):
            stage, newton.z[:] = 0.5 * stage, known
        else:
            return False
    return True


def beside(newton: Newton) -> list[FloatArray]:
    """Solutions on both sides of the one that was found last, in its plane or a little along its curve."""
    middle, along = np.array(newton.z), np.array(newton.tangent)
    found = [middle]
    for way in (sign * aside for aside in ASIDE for sign in (-1.0, 1.0)):
        newton.z[:], newton.row[:] = middle + way * along * np.asarray(newton.scale), along
        if newton.correct(abs(way)):
            found.append(np.array(newton.z))
    return found
