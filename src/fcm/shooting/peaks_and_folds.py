"""Location of peaks and folds of exact curves, each on a short piece of the curve near a guess."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import numpy.typing as npt

from fcm.continuation import FollowOptions, Mark, Path, follow
from fcm.continuation.corrector import Newton
from fcm.continuation.nearby_solution import solution_near
from fcm.frozen import Frozen
from fcm.model.scene import FloatArray
from fcm.shooting.options import SHOOTING, ShootingOptions
from fcm.shooting.orbit_record import OrbitRecord, recorded_point
from fcm.shooting.problem import OrbitProblem, correct_at_frequency
from fcm.time_domain.state import State

PeakDofs = npt.NDArray[np.bool_]  # (dof,)


class OrbitGuess(Frozen):
    """A state near a peak or a fold, with a second state nearby for the direction of the curve."""

    frequency: float  # [rad/s]
    state: State
    neighbour: tuple[float, State]
    dof: int | None  # the degree of freedom whose peak is sought; None for a fold


def located(problem: OrbitProblem, guess: OrbitGuess, known: list[OrbitRecord]) -> OrbitRecord | None:
    """The peak or fold near a guess; None if there is none.

    known : the peaks and folds found so far; those of this piece are added.
    """
    z = _on_curve(problem, guess)
    if z is None:
        return None
    low, high = problem.scene.frequency_range
    for window in problem.options.peaks.windows:
        span = (max(z[-1] * (1.0 - window), low), min(z[-1] * (1.0 + window), high))
        found = _within(problem, z, span)
        known += [one for one, _ in found if all(_differ(one, other, problem.options) for other in known)]
        wanted = [one for one, highest in found if _is_wanted(one, highest, guess.dof)]
        if wanted:
            return min(wanted, key=lambda one: _distance_from_guess(one, guess))
    return None


def _on_curve(problem: OrbitProblem, guess: OrbitGuess) -> FloatArray | None:
    """The point of the curve in the plane through a guess normal to it, or else at the guess's frequency."""
    z = problem.z(guess.state, guess.frequency)
    other = problem.z(guess.neighbour[1], guess.neighbour[0])
    newton, chord = Newton(problem), other - z
    across = solution_near(newton, z, chord) if chord.any() else None
    if across is None and not correct_at_frequency(newton, z):
        return None
    return np.array(newton.z) if newton.moved < problem.options.peaks.max_distance else None


def _within(
    problem: OrbitProblem, z: FloatArray, span: tuple[float, float]
) -> list[tuple[OrbitRecord, PeakDofs]]:
    """The peaks, folds and ends of the range on the piece of the curve through z within a span."""
    found: list[tuple[OrbitRecord, PeakDofs]] = []
    options = FollowOptions(problem.scene.max_step)
    paths = [follow(problem, z, span, options=options, forward=forward) for forward in (True, False)]
    left = [_leaves_start(problem, path) for path in paths]
    for path, first in zip(paths, left, strict=True):
        for k in np.flatnonzero(path.mark & (Mark.PEAK | Mark.FOLD | Mark.END)):
            mark = int(path.mark[k])
            if mark & Mark.END and path.parameter[k] not in problem.scene.frequency_range:
                continue
            if k < first and mark == Mark.PEAK:  # a peak at the start, see `_peak_at_start`
                continue
            here = recorded_point(problem, path.z[k], path.direction[k], mark)
            here = _with_stable_side(problem, path.z, path.direction, int(k), here)
            found.append((here, _peak_dofs(problem, path, int(k))))
    return found + _peak_at_start(problem, paths, left)


def _leaves_start(problem: OrbitProblem, path: Path) -> int:
    """Index of the first point of a path that differs from its start: a peak at the start may be repeated."""
    if not len(path.z):
        return 0
    tolerance, start = problem.options.peaks.peak_tolerance, _amplitudes(problem, path, 0)
    for k in range(1, len(path.z)):
        moved = np.abs(_amplitudes(problem, path, k) - start).max() > tolerance * start.max()
        if moved or abs(path.parameter[k] - path.parameter[0]) > tolerance * path.parameter[0]:
            return k
    return len(path.z)


def _peak_at_start(
    problem: OrbitProblem, paths: Sequence[Path], left: Sequence[int]
) -> list[tuple[OrbitRecord, PeakDofs]]:
    """The common start of two paths, if it is a peak: no step of either path contains it.

    left : the first points of the paths that differ from the start.
    """
    if any(k >= len(path.z) for path, k in zip(paths, left, strict=True)):
        return []
    ahead = paths[0]
    here = _amplitudes(problem, ahead, 0)
    level = np.abs(np.asarray(problem.growth)) <= problem.options.peaks.min_growth * here
    if any((path.mark[:k] & Mark.PEAK).any() for path, k in zip(paths, left, strict=True)):
        level[:] = True
    highest = level & (here > 0.0)
    for path, k in zip(paths, left, strict=True):
        highest &= here >= _amplitudes(problem, path, k)
    if not highest.any():
        return []
    return [(recorded_point(problem, ahead.z[0], ahead.direction[0], Mark.PEAK), highest)]


def _peak_dofs(problem: OrbitProblem, path: Path, k: int) -> PeakDofs:
    """Mask (dof,) of amplitudes no less than at the neighbours of point k; marks do not name the dof."""
    here, *sides = (_amplitudes(problem, path, i) for i in (k, k - 1, k + 1) if 0 <= i < len(path.z))
    highest: PeakDofs = np.logical_and.reduce([here > 0.0, *(here >= side for side in sides)])
    return highest


def _amplitudes(problem: OrbitProblem, path: Path, k: int) -> FloatArray:
    problem.evaluate_outputs(path.z[k], path.direction[k])
    return np.array(problem.output)


def _with_stable_side(
    problem: OrbitProblem, z: FloatArray, direction: FloatArray, k: int, here: OrbitRecord
) -> OrbitRecord:
    """The record of a fold, which is stable if one side of it is; other records are unchanged."""
    if not here.mark & Mark.FOLD or here.stable:
        return here
    sides = [i for i in (k - 1, k + 1) if 0 <= i < len(z)]
    return replace(here, stable=any(recorded_point(problem, z[i], direction[i]).stable for i in sides))


def _is_wanted(one: OrbitRecord, highest: PeakDofs, dof: int | None) -> bool:
    return bool(one.mark & Mark.FOLD if dof is None else highest[dof])


def _differ(one: OrbitRecord, other: OrbitRecord, options: ShootingOptions = SHOOTING) -> bool:
    if abs(one.frequency - other.frequency) > options.peaks.peak_tolerance * one.frequency:
        return True
    size = np.abs(one.measure.amplitude).max()
    return bool(
        np.abs(one.measure.amplitude - other.measure.amplitude).max() > options.peaks.peak_tolerance * size
    )


def _distance_from_guess(one: OrbitRecord, guess: OrbitGuess) -> float:
    """A measure by which the best candidate is least: the highest peak, or the nearest fold."""
    if guess.dof is not None:
        return -float(one.measure.amplitude[guess.dof])
    return abs(one.frequency - guess.frequency)
