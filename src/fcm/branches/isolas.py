r"""Isolated branches (isolas): they begin and end where a curve of folds crosses the level 1.

Where the force level turns back before 1 at a frequency, two solutions meet that the response at the level 1
does not have there. Along the curve of these folds in (frequency, level), the level may come to 1. From there
on the response has both solutions, and the crossing is a fold of their branch. A fold beyond 1 lies between
two solutions of the response at that frequency, whose branches are followed anyway.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from fcm.branches.fold_continuation import Folds, folds_from
from fcm.branches.force_level import LevelSolutions, few_harmonics
from fcm.branches.level_folds import LevelFold
from fcm.branches.options import FOLDS, PROLONGATION_POINTS, FoldOptions
from fcm.branches.surface import Surface
from fcm.continuation import Path
from fcm.continuation.all_branches import contains
from fcm.continuation.nearby_solution import solution_near
from fcm.frozen import Frozen
from fcm.harmonic_balance.cost_model import seconds_of
from fcm.harmonic_balance.prolongation import Prolongation
from fcm.harmonic_balance.system import System
from fcm.harmonic_balance.work_budget import WorkLimitError
from fcm.model.scene import FloatArray


class LevelOneCrossings(Frozen):
    """Solutions at which curves of folds cross the level 1, each (unknown + 1,).

    uncertain: frequencies [rad/s] at which curves of folds were lost or not followed, so that other solutions
    may be missing.
    """

    solutions: tuple[FloatArray, ...]
    uncertain: tuple[float, ...]


def level_one_crossings(
    system: System, found: Sequence[LevelSolutions], paths: tuple[Path, ...]
) -> LevelOneCrossings:
    """Crossings of the level 1 by curves of folds that lie on no known path.

    Parameters
    ----------
    system : System
        System whose level was followed. With many harmonics, the folds are followed with a few of them if
        these have such folds, and the crossings are prolongated to all.
    found : sequence of LevelSolutions
        Frequencies at which the level was followed, and where it turned back.
    paths : tuple of Path
        The known branches.
    """
    options, span = system.option(FOLDS), system.scene.frequency_range
    solutions, curves = list[FloatArray](), _Curves(system, found, options)
    seconds = max(options.work_fraction * system.work.seconds, options.min_seconds)
    try:
        with system.work.limited_to(system.work.seconds + seconds):
            for crossings in curves:
                for z in crossings:
                    known = any(contains(path, z, system.reset_balance()) for path in paths)
                    if span[0] <= z[-1] <= span[1] and not known:
                        solutions.append(z)
    except WorkLimitError:
        pass  # the folds that are left count as uncertain
    return LevelOneCrossings(tuple(solutions), tuple(dict.fromkeys(curves.uncertain)))


def folds_to_follow(system: System, found: Sequence[LevelSolutions]) -> tuple[float, ...]:
    """Frequencies [rad/s] of the folds of the level from which curves of folds may come to 1."""
    begun = _begun(found, system.option(FOLDS))
    return tuple(dict.fromkeys(float(turn.z[-1]) for turn, _ in begun))


def _begun(
    found: Sequence[LevelSolutions], options: FoldOptions
) -> Iterator[tuple[LevelFold, tuple[int, ...]]]:
    """Yield the folds from which curves are followed, with the harmonics with which each was found."""
    for one in found:
        yield from (
            (turn, one.harmonics) for turn in one.folds if turn.unfinished and options.covers(turn.level)
        )


class _Curves:
    """Iterates over curves of folds, and yields the solutions at which they cross the level 1.

    Each curve is followed once, with a few harmonics first. If these do not have the fold, or a crossing does
    not lead to a solution with all, more are used, up to those with which the fold was found.
    """

    def __init__(self, system: System, found: Sequence[LevelSolutions], options: FoldOptions) -> None:
        self.options, self.system = options, system
        self.left = list(_begun(found, options))
        self.lost = list[float]()  # frequencies at which curves were lost
        self.known = dict[tuple[int, ...], _CurvesWith]()

    @property
    def uncertain(self) -> tuple[float, ...]:
        """Frequencies at which curves were lost, and of the folds that are left to be followed."""
        return *self.lost, *(float(turn.z[-1]) for turn, _ in self.left)

    def __iter__(self) -> Iterator[list[FloatArray]]:
        while self.left:
            self.system.work.tell("folds of the level of the forces")
            turn, own = self.left[0]
            for harmonics in self._stages(own):
                curves = self._with(harmonics)
                there = turn.extended(curves.system, own)
                if curves.pass_fold(there):
                    break
                curve = curves.follow(there)
                if curve is None:
                    continue
                found, lost = _at_level_one(curves.system, self.system, curve)
                if not lost or harmonics == own:
                    self.lost += [*curve.lost, *lost]
                    yield found
                    break
            else:
                self.lost.append(float(turn.z[-1]))
            del self.left[0]

    def _stages(self, own: tuple[int, ...]) -> Iterator[tuple[int, ...]]:
        """Yield the harmonics with which a fold is followed in turn, up to those it was found with."""
        count, factor = few_harmonics(self.system), self.system.option(PROLONGATION_POINTS).harmonics_factor
        while count < len(own):
            yield own[:count]
            count *= factor
        yield own

    def _with(self, harmonics: tuple[int, ...]) -> _CurvesWith:
        if harmonics not in self.known:
            self.known[harmonics] = _CurvesWith(self.system.with_harmonics(harmonics), self.options)
        return self.known[harmonics]


class _CurvesWith:
    """The known curves of folds of a system."""

    def __init__(self, system: System, options: FoldOptions) -> None:
        self.system, self.options, self.curves = system, options, list[Folds]()
        self.surface = Surface(system.new_balance())  # a balance of its own: others are used meanwhile
        self.paid = 0

    def pass_fold(self, turn: LevelFold) -> bool:
        """Whether a known curve passes a fold."""
        return any(_passes_fold(curve, turn, self.surface, self.options) for curve in self.curves)

    def follow(self, turn: LevelFold) -> Folds | None:
        """Follow the curve through a fold; None if there is none near it."""
        start, span = np.append(turn.z, turn.level), self.system.scene.frequency_range
        curve = folds_from(self.surface, start, turn.directions, span, self.options, self._pay)
        if curve is not None:
            self.curves.append(curve)
        return curve

    def _pay(self) -> None:
        new, self.paid = self.surface.evaluations - self.paid, self.surface.evaluations
        self.system.work.add(seconds_of(self.system, new, len(self.system.harmonics)))


def _passes_fold(curve: Folds, turn: LevelFold, surface: Surface, options: FoldOptions) -> bool:
    """Whether a curve passes a fold."""
    z = np.append(turn.z, turn.level)
    surface.evaluate_scale(z)
    points = (curve.z - z) / np.asarray(surface.scale)
    off = points[:, -2]
    for i in np.flatnonzero(off[:-1] * off[1:] <= 0.0).tolist():
        chord = points[i + 1] - points[i]
        part = off[i] / (off[i] - off[i + 1]) if off[i] != off[i + 1] else 0.0
        if np.linalg.norm(points[i] + part * chord) < options.curve_tolerance * np.linalg.norm(chord):
            return True
    return False


def _at_level_one(few: System, system: System, curve: Folds) -> tuple[list[FloatArray], list[float]]:
    """The solutions of a system where a curve of folds crosses the level 1.

    Also returns the frequencies [rad/s] of the crossings at which no solution was found.
    """
    off, found, lost = curve.level - 1.0, list[FloatArray](), list[float]()
    for i in np.flatnonzero(off[:-1] * off[1:] < 0.0).tolist():
        part = off[i] / (off[i] - off[i + 1])
        z = (curve.z[i] + part * (curve.z[i + 1] - curve.z[i]))[:-1]
        way = curve.singular[i if part < 0.5 else i + 1][:-1]
        there = _corrected_in_plane(few, z, way)
        if there is not None and few.harmonics != system.harmonics:
            there = _prolongated(few, system, there, way)
        if there is None:
            lost.append(float(z[-1]))
        else:
            found.append(there)
    return found, lost


def _corrected_in_plane(system: System, z: FloatArray, way: FloatArray) -> FloatArray | None:
    """The solution near a guess, in the plane across a direction in the displacements."""
    system.reset_balance()
    return solution_near(system.shared_stepper.newton, z, way)


def _prolongated(few: System, system: System, z: FloatArray, way: FloatArray) -> FloatArray | None:
    """The solution with more harmonics near one with few."""
    tolerance = system.option(PROLONGATION_POINTS).tolerance
    prolongation = Prolongation(system.new_balance(), list(few.harmonics), list(system.harmonics), tolerance)
    if not prolongation.find_normal(z, way):
        return None
    return _corrected_in_plane(system, np.array(prolongation.newton.z), system.extended(way, few.harmonics))
