r"""Branch points of a traced branch, and the branches that leave it there.

Bordered by the branch's own tangent t, the determinant of

    [ dF/d(x, omega) ]
    [       t        ]

changes its sign where a real eigenvalue passes zero without a fold: another branch crosses (Keller,
"Numerical solution of bifurcation and nonlinear eigenvalue problems", 1977; Allgower and Georg, chapter 8).
The singular vector there leads to that branch: Newton's method in a bordered system finds solutions at a
distance along this vector, off the known branch. A corner of the response may change the sign by a jump; it
is treated in the same way.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from functools import partial
from itertools import islice
from typing import TypeVar

import numpy as np

from fcm.branches.options import BRANCHING, BranchingOptions
from fcm.continuation import Path, Segment
from fcm.continuation.all_branches import contains
from fcm.continuation.corrector import Newton
from fcm.continuation.problem import Problem
from fcm.frozen import Frozen
from fcm.harmonic_balance.dense_jacobian import jacobian_of
from fcm.harmonic_balance.system import System
from fcm.model.scene import FloatArray

Found = TypeVar("Found")
Jacobian = Callable[[], FloatArray]  # (unknown, unknown + 1) of a problem at its last evaluation


class BranchPoint(Frozen):
    """A branch point z (unknown + 1,), and solutions on the branches that leave it.

    starts: these solutions, on either side of the branch. direction (unknown + 1,): direction in which the
    branches leave, of any length.
    """

    z: FloatArray
    starts: tuple[FloatArray, ...]
    direction: FloatArray


def branch_points(system: System, paths: Sequence[Path]) -> Iterator[BranchPoint]:
    """Yield the branch points of paths of a system."""
    if any(sign_changes(path.orientation) for path in paths):
        balance = system.new_balance()
        yield from branch_points_of(balance, partial(jacobian_of, balance), paths, system.option(BRANCHING))


def branch_points_of(
    problem: Problem, jacobian: Jacobian, paths: Sequence[Path], options: BranchingOptions = BRANCHING
) -> Iterator[BranchPoint]:
    """Yield the branch points of paths of a problem that other branches leave."""
    for path in paths:
        for i in sign_changes(path.orientation):
            point = branch_point_at(problem, jacobian, path, i, options)
            if point.starts:
                yield point


def with_leaving(
    found: Found,
    paths: Callable[[Found], Sequence[Path]],
    points: Callable[[Sequence[Path]], Iterator[BranchPoint]],
    extended: Callable[[Found, BranchPoint], Found | None],
    options: BranchingOptions,
) -> Found:
    """Extend what was found at each branch point of its paths, then at those of the new paths, and so on.

    points yields the branch points of given paths. extended returns None if the search is to end.
    """
    known, left = 0, options.max_starts
    for _ in range(options.max_rounds):
        every = paths(found)
        fresh, known = every[known:], len(every)
        for point in islice(points(fresh), left):
            left -= 1
            more = extended(found, point)
            if more is None:
                return found
            found = more
        if len(paths(found)) == known or not left:
            break
    return found


def sign_changes(orientation: FloatArray) -> list[int]:
    """Indices i for which the determinant changes its sign between points i and i + 1."""
    return np.flatnonzero(orientation[:-1] * orientation[1:] < 0.0).tolist()


def branch_point_at(
    problem: Problem, jacobian: Jacobian, path: Path, i: int, options: BranchingOptions = BRANCHING
) -> BranchPoint:
    """The branch point between point i of a path of a problem and the next."""
    z = sign_change_at(problem, path, i, options)
    across = _across(problem, jacobian, z, path, i)
    direction = across * np.asarray(problem.scale)
    return BranchPoint(z, tuple(_leaving(problem, z, across, path, options)), direction)


def sign_change_at(problem: Problem, path: Path, i: int, options: BranchingOptions = BRANCHING) -> FloatArray:
    """The place (unknown + 1,) between points i and i + 1 of a path where the determinant changes sign."""
    between, before, low, high = Segment(problem, path, i), path.orientation[i], 0.0, 1.0
    between.find(low)
    z = between.z
    while high - low > options.tolerance:
        middle = 0.5 * (low + high)
        if not between.find(middle):
            break
        z = between.z
        low, high = (middle, high) if between.orientation == before else (low, middle)
    return z


def _across(problem: Problem, jacobian: Jacobian, z: FloatArray, path: Path, i: int) -> FloatArray:
    """The singular vector, across the path, of a branch point after point i of a path, in scaled unknowns.

    The chord gives the path's direction, as there is no unique tangent.
    """
    problem.evaluate_scale(z)
    problem.evaluate(z)
    scale = np.array(problem.scale)
    t = (path.z[i + 1] - path.z[i]) / scale
    t /= np.linalg.norm(t)
    matrix = np.vstack((jacobian() * scale / scale[:-1, None], t))
    singular = np.linalg.svd(matrix)[2][-1]
    singular -= (singular @ t) * t
    across: FloatArray = singular / np.linalg.norm(singular)
    return across


def _leaving(
    problem: Problem, z: FloatArray, across: FloatArray, path: Path, options: BranchingOptions
) -> Iterator[FloatArray]:
    """Yield solutions on both sides of a branch point, off the path, at the first distance that has any."""
    scale, newton = np.array(problem.scale), Newton(problem)
    for distance in options.distances:
        found = list[FloatArray]()
        for way in (distance, -distance):
            newton.scale[:], newton.row[:] = scale, across
            newton.z[:] = z + way * scale * across
            if newton.correct(distance) and newton.moved < options.max_deviation * distance:
                start = np.array(newton.z)
                found += [] if contains(path, start, problem) else [start]
        if found:
            yield from found
            return
