r"""Isolated branches: they begin and end where a curve of folds crosses the level 1.

Where the level of the forces turns back before 1 at a frequency, two solutions meet that the response at the
level 1 does not have there. Along the curve of these folds in (frequency, level) the level may come to 1;
from there on the response has the two solutions, and the crossing is a fold of their branch. What turns
beyond 1 lies between two solutions of the response at that frequency, whose branches are followed anyhow.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from fcm.branches.fold_continuation import Folds, folds_from
from fcm.branches.force_level import LevelSolutions, few_harmonics
from fcm.branches.level_turns import LevelFold
from fcm.branches.options import FOLDS, FoldOptions
from fcm.branches.surface import Surface
from fcm.continuation import Path
from fcm.continuation.all_branches import contains
from fcm.harmonic_balance.cost_model import seconds_of
from fcm.harmonic_balance.prolongation import Prolongation
from fcm.harmonic_balance.system import System
from fcm.harmonic_balance.work_budget import WorkLimitError
from fcm.model.scene import FloatArray


@dataclass(frozen=True)
class Crossings:
    """Solutions (unknown + 1,) beside the folds at the level 1 that curves of folds come to; and the
    frequencies [rad/s] from where folds were not followed as far as they are looked at, so that others may be
    missing."""

    solutions: tuple[FloatArray, ...]
    uncertain: tuple[float, ...]


def level_one_crossings(
    system: System, found: Sequence[LevelSolutions], paths: tuple[Path, ...]
) -> Crossings:
    """Those that lie on none of some paths.

    Parameters
    ----------
    system : System
        Whose level was followed; with many harmonics the folds are followed with a few of them, and what
        they come to is led to all.
    found : sequence of Found
        At which frequencies, and where it turned.
    paths : tuple of Path
        The branches that are known.
    """
    options = system.option(FOLDS)
    few = system.with_harmonics(system.harmonics[: few_harmonics(system)])
    solutions, span = list[FloatArray](), system.scene.frequency_range
    turns = [turn.extended(few, one.harmonics) for one in found for turn in one.folds]
    turns = [turn for turn in turns if turn.unfinished and options.covers(turn.level)]
    curves = _Curves(few, turns, options)
    seconds = max(options.work_fraction * system.work.seconds, options.min_seconds)
    try:
        with system.work.limited_to(system.work.seconds + seconds):
            for curve in curves:
                for z in _at_level_one(few, system, curve):
                    known = any(contains(path, z, system.reset_balance()) for path in paths)
                    if span[0] <= z[-1] <= span[1] and not known:
                        solutions.append(z)
    except WorkLimitError:
        pass  # the folds from where none was followed are left
    return Crossings(tuple(solutions), tuple(dict.fromkeys(curves.uncertain)))


class _Curves:
    """The curves of folds, each once."""

    def __init__(self, few: System, turns: Sequence[LevelFold], options: FoldOptions) -> None:
        self.few, self.options, self.left = few, options, list(turns)
        self.lost = list[float]()  # frequencies at which curves were lost

    @property
    def uncertain(self) -> tuple[float, ...]:
        """Frequencies of what was lost, and of what is left to be followed."""
        return *self.lost, *(float(turn.z[-1]) for turn in self.left)

    def __iter__(self) -> Iterator[Folds]:
        if not self.left:
            return
        few, options, span = self.few, self.options, self.few.scene.frequency_range
        surface, known = (
            Surface(few.new_balance()),
            list[Folds](),
        )  # of its own: others are followed meanwhile
        paid = 0

        def pay() -> None:
            nonlocal paid
            new, paid = surface.evaluations - paid, surface.evaluations
            few.work.add(seconds_of(few, new, len(few.harmonics)))

        while self.left:
            turn = self.left[0]
            if not any(_passes_fold(curve, turn, surface, options) for curve in known):
                start = np.append(turn.z, turn.level)
                curve = folds_from(surface, start, turn.directions, span, options, pay)
                if curve is None:
                    self.lost.append(float(turn.z[-1]))
                else:
                    self.lost += curve.lost
                    known.append(curve)
                    yield curve
            del self.left[0]


def _passes_fold(curve: Folds, turn: LevelFold, surface: Surface, options: FoldOptions) -> bool:
    """Whether a curve passes a fold."""
    z = np.append(turn.z, turn.level)
    surface.measure(z)
    points = (curve.z - z) / np.asarray(surface.scale)
    off = points[:, -2]
    for i in np.flatnonzero(off[:-1] * off[1:] <= 0.0).tolist():
        chord = points[i + 1] - points[i]
        part = off[i] / (off[i] - off[i + 1]) if off[i] != off[i + 1] else 0.0
        if np.linalg.norm(points[i] + part * chord) < options.curve_tolerance * np.linalg.norm(chord):
            return True
    return False


def _at_level_one(few: System, system: System, curve: Folds) -> Iterator[FloatArray]:
    """The solutions of a system beside the crossings of the level 1 by a curve of folds."""
    off = curve.level - 1.0
    for i in np.flatnonzero(off[:-1] * off[1:] < 0.0).tolist():
        part = off[i] / (off[i] - off[i + 1])
        z = (curve.z[i] + part * (curve.z[i + 1] - curve.z[i]))[:-1]
        way = curve.singular[i if part < 0.5 else i + 1][:-1]
        there = _corrected_in_plane(few, z, way)
        if there is not None and few.harmonics != system.harmonics:
            there = _prolongated(few, system, there, way)
        if there is not None:
            yield there


def _corrected_in_plane(system: System, z: FloatArray, way: FloatArray) -> FloatArray | None:
    """The solution near a guess, in the plane across a direction in the displacements."""
    balance, newton = system.reset_balance(), system.shared_stepper.newton
    balance.measure(z)
    newton.scale[:], newton.z[:] = balance.scale, z
    row = way / np.asarray(balance.scale)
    newton.row[:] = row / np.linalg.norm(row)
    return np.array(newton.z) if newton.correct(1.0) else None


def _prolongated(few: System, system: System, z: FloatArray, way: FloatArray) -> FloatArray | None:
    """The solution with more harmonics near one with few."""
    lifted = Prolongation(system.new_balance(), list(few.harmonics), list(system.harmonics), 1e-6)
    if not lifted.find_normal(z, way):
        return None
    return _corrected_in_plane(system, np.array(lifted.newton.z), system.extended(way, few.harmonics))
