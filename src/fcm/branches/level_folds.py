"""Folds at which the force level turns back, and solutions beside them at other frequencies.

The level of such a fold varies with the frequency. Where it is 1, a window of several solutions begins or
ends: a fold of the response. It may be a fold of a closed branch between the frequencies at which the level
was followed. A fold near 1 is all that the curves of the level show of such a branch.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple, Protocol

import numpy as np

from fcm.branches.options import LEVEL_FOLDS
from fcm.continuation import Mark, Path
from fcm.continuation.corrector import Newton
from fcm.continuation.nearby_solution import begin_near
from fcm.model.scene import FloatArray

if TYPE_CHECKING:
    from fcm.harmonic_balance.system import System


class WithLoad(Protocol):
    """A problem with the frequency as parameter, at the force level that is its load."""

    load: float
    scale: FloatArray

    def evaluate_scale(self, z: FloatArray) -> int:
        """Fill the units of lengths at z, see `Problem.measure`."""


class LevelFold(NamedTuple):
    """A fold of the level of the forces at one frequency: z (unknown + 1,), with the frequency.

    before, after (unknown + 2,): directions of the curve in displacements, frequency (always 0) and level;
    they differ at a corner. unfinished: whether the curve turns back before it crosses the level 1.
    """

    level: float
    z: FloatArray
    before: FloatArray
    after: FloatArray
    unfinished: bool

    @property
    def direction(self) -> FloatArray:
        """Direction (unknown + 1,) of displacements and frequency at the fold."""
        return self.before[:-1]

    @property
    def directions(self) -> tuple[FloatArray, ...]:
        """Directions of displacements, frequency and level at the fold: in the middle, before, after."""
        smooth = self.before is self.after
        return (self.before,) if smooth else (self.before + self.after, self.before, self.after)

    @property
    def may_reach_level_one(self) -> bool:
        """Whether this fold may come to the level 1 at another frequency of the range."""
        return self.unfinished and 1.0 / LEVEL_FOLDS.max_level < self.level < LEVEL_FOLDS.max_level

    def extended(self, system: System, harmonics: tuple[int, ...]) -> LevelFold:
        """The fold of a balance with some harmonics, extended to those of a system with more."""
        before, after = (system.extended(one, harmonics) for one in (self.before, self.after))
        after = before if self.before is self.after else after
        return self._replace(z=system.extended(self.z, harmonics), before=before, after=after)


def level_folds(path: Path, omega: float, unit: float = 1.0) -> tuple[LevelFold, ...]:
    """The folds of a curve of the level at a frequency, whose displacements and levels are in some unit."""
    levels = unit * path.parameter
    rises = np.diff(levels) > 0.0
    found = []
    for i in (1 + np.flatnonzero(rises[1:] != rises[:-1])).tolist():
        z, before = np.append(unit * path.z[i, :-1], omega), _direction(path, i, unit)
        corner = path.mark[i] & Mark.CORNER
        after = _direction(path, i + 1, unit) if corner else before
        level = float(levels[i])
        found.append(LevelFold(level, z, before, after, (level < 1.0) == bool(rises[i - 1])))
    return tuple(found)


def _direction(path: Path, i: int, unit: float) -> FloatArray:
    """The direction (unknown + 2,) of a curve of the level at point i."""
    return unit * np.insert(path.direction[i], -1, 0.0)


def reaches_level_one(problem: WithLoad, newton: Newton, turn: LevelFold) -> bool:
    """Whether a fold is brought to the level 1, by stages that are shortened where Newton's method fails.

    newton belongs to the problem, and is then at the solution.
    """
    problem.load = turn.level
    begin_near(newton, turn.z, turn.direction)
    left, known = math.log(turn.level), turn.z
    stage = left / max(math.ceil(abs(left) / math.log(LEVEL_FOLDS.stage_factor)), 1)
    shortest = stage * LEVEL_FOLDS.min_stage
    while left != 0.0:
        then = left - stage if abs(left) > 1.5 * abs(stage) else 0.0
        problem.load = math.exp(then)
        if newton.correct(1.0) and newton.moved < LEVEL_FOLDS.max_change:
            left, known, newton.row[:] = then, np.array(newton.z), newton.tangent
        elif abs(stage) > abs(shortest):
            stage, newton.z[:] = 0.5 * stage, known
        else:
            return False
    return True


def solutions_past_fold(newton: Newton) -> list[FloatArray]:
    """The solution that was found last, and solutions on both sides of it, a little along its curve."""
    middle, along = np.array(newton.z), np.array(newton.tangent)
    found = [middle]
    for way in (sign * aside for aside in LEVEL_FOLDS.offsets for sign in (-1.0, 1.0)):
        newton.z[:], newton.row[:] = middle + way * along * np.asarray(newton.scale), along
        if newton.correct(abs(way)):
            found.append(np.array(newton.z))
    return found
