"""Unsymmetric motions that leave symmetric ones as the level of the forces grows.

At a fixed frequency the motion from rest is symmetric while the level is low. It may lose its symmetry at a
branch point of the curve of the level. The branch that leaves there may pass the level 1 where the symmetric
response itself has no branch point: then it is a closed branch of the response.
"""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import suppress
from functools import partial
from typing import NamedTuple

import numpy as np

from fcm.branches.branch_points import branch_point_at, sign_changes
from fcm.branches.force_level import LevelRange, LevelSolutions, few_harmonics, level_curve
from fcm.branches.options import BRANCHING, FOLDS, BranchingOptions
from fcm.branches.symmetry import is_symmetric, parts_of
from fcm.continuation import Events, FollowOptions, Path, Status, follow
from fcm.continuation.all_branches import contains
from fcm.harmonic_balance.cost_model import seconds_of
from fcm.harmonic_balance.dense_jacobian import jacobian_of
from fcm.harmonic_balance.prolongation import ForceLevelProblem
from fcm.harmonic_balance.system import System
from fcm.harmonic_balance.work_budget import WorkLimitError
from fcm.model.scene import FloatArray


class UnsymmetricSolution(NamedTuple):
    """A solution z (unknown + 1,) at the level 1 of a balance with a few harmonics.

    symmetric: the symmetric motion at the branch point of the level from which its branch leaves. even: the
    leading even harmonics of z.
    """

    few: System
    z: FloatArray
    symmetric: FloatArray
    even: tuple[int, ...]


class UnsymmetricSolutions(NamedTuple):
    """Unsymmetric solutions, and the frequencies at which the search for them did not end.

    unfinished: frequencies [rad/s] at which the curve of the level, or a branch that leaves it, was not
    followed to its end.
    """

    solutions: tuple[UnsymmetricSolution, ...] = ()
    unfinished: tuple[float, ...] = ()


def unsymmetric_solutions(
    system: System, found: Sequence[LevelSolutions], paths: Sequence[Path]
) -> UnsymmetricSolutions:
    """Unsymmetric solutions to which curves of the level lead, if a path of the system is symmetric.

    The frequencies are those at which the level was followed.
    """
    few = system.with_harmonics(tuple(range(1, few_harmonics(system) + 1)))
    if len(few.harmonics) < 2 or not any(is_symmetric(system, path) for path in paths):
        return UnsymmetricSolutions()
    folds, work = system.option(FOLDS), system.work
    seconds = max(folds.work_fraction * work.seconds, folds.min_seconds)
    solutions, left = list[UnsymmetricSolution](), dict.fromkeys(one.omega for one in found)
    with suppress(WorkLimitError), work.limited_to(work.seconds + seconds):
        for omega in tuple(left):
            new, whole = _past_branch_points(few, omega, few.option(BRANCHING))
            solutions += new
            if whole:
                del left[omega]
    return UnsymmetricSolutions(tuple(solutions), tuple(left))


def _past_branch_points(
    few: System, omega: float, options: BranchingOptions
) -> tuple[list[UnsymmetricSolution], bool]:
    """Unsymmetric solutions at one frequency, and whether all curves were followed to their ends."""
    span, found = (0.0, few.option(FOLDS).max_level), list[UnsymmetricSolution]()
    path = level_curve(few, omega, LevelRange(span))
    balance, known = few.new_balance(), list[Path]()
    level = ForceLevelProblem(balance, omega)
    for i in sign_changes(path.orientation):
        point = branch_point_at(level, partial(jacobian_of, balance), path, i, options)
        if not point.starts or any(contains(one, z, level) for one in known for z in point.starts):
            continue
        new = _branch_through(few, level, point.starts[0], span, options)  # the other is its image
        known += new
        for z in (z for one in new for z in one.z[one.parameter == 1.0]):
            even = _leading_even(few, z, options)
            if even:
                there, symmetric = (np.append(each[:-1], omega) for each in (z, point.z))
                found.append(UnsymmetricSolution(few, there, symmetric, even))
    return found, all(one.status.is_whole for one in (path, *known))


def _branch_through(
    few: System,
    level: ForceLevelProblem,
    start: FloatArray,
    span: tuple[float, float],
    options: BranchingOptions,
) -> list[Path]:
    """The branch through a start, followed both ways, or one way if it is closed."""
    ways, wanted = list[Path](), Events((1.0,))
    for forward in (True, False):
        steps = FollowOptions(options.max_level_step)
        ways.append(follow(level, start, span, wanted, steps, forward=forward))
        few.work.add(seconds_of(few, ways[-1].evaluations, len(few.harmonics)))
        if ways[-1].status is Status.CLOSED:
            break
    return ways


def _leading_even(system: System, z: FloatArray, options: BranchingOptions) -> tuple[int, ...]:
    """The leading even harmonics of a motion, without those much smaller; empty if it is symmetric."""
    parts, odd = parts_of(system, z)
    if (parts < options.motion_tolerance * odd.max()).all():
        return ()
    leads = parts[1:] > options.min_leading_fraction * parts[1:].max()
    return tuple(h for h, led in zip((h for h in system.harmonics if h % 2 == 0), leads, strict=True) if led)
