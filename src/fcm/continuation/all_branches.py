"""Trace all branches that contain given solutions of a problem, each branch once."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace
from itertools import combinations

import numpy as np

from fcm.continuation.corrector import Newton
from fcm.continuation.events import Events
from fcm.continuation.follow import follow
from fcm.continuation.options import FOLLOW, PATH, FollowOptions
from fcm.continuation.path import FloatArray, Path, PathInterrupted, Status
from fcm.continuation.problem import Problem
from fcm.frozen import Frozen

Follow = Callable[..., Path]  # as `follow`


class Following(Frozen):
    """Options and function with which each branch is followed.

    Attributes
    ----------
    options : FollowOptions
        Options of following a curve, see `follow`.
    follow : callable
        Follows a path, as `follow` does.
    """

    options: FollowOptions = FOLLOW
    follow: Follow = follow


class Branches(Frozen):
    """Separate paths; each given solution lies on one of them or is in `lost`."""

    paths: tuple[Path, ...]
    lost: tuple[FloatArray, ...] = ()  # solutions from which no curve could be followed

    @property
    def status(self) -> Status:
        """COMPLETE if every path is a whole branch; otherwise the status of the first that is not.

        STALLED if only solutions are lost.
        """
        broken = [path.status for path in self.paths if not path.status.is_whole]
        return broken[0] if broken else Status.STALLED if self.lost else Status.COMPLETE


class BranchesInterrupted(KeyboardInterrupt):
    """Following branches was interrupted; `branches` holds those found so far, the last one incomplete."""

    def __init__(self, branches: Branches) -> None:
        super().__init__()
        self.branches = branches


FOLLOWING = Following()


def all_branches(
    new_problem: Callable[[], Problem],
    solutions: Iterable[FloatArray],
    span: tuple[float, float],
    following: Following = FOLLOWING,
    known: Sequence[Path] = (),
    user_values: Sequence[float] | None = None,
) -> Branches:
    """Follow a branch through every solution that lies on no branch followed before.

    Parameters
    ----------
    new_problem : callable
        Makes a new problem; problems that it made before are not used any more.
    solutions : iterable of (n + 1,)
        In the order in which they are followed. From a solution at an end of the span the branch is followed
        inwards, from one inside the span both ways.
    following : Following
        How each is followed.
    known : sequence of Path
        Branches followed before; they are returned first.
    user_values : sequence of float, optional
        Parameters of all solutions; needed if the iterable finds its solutions one by one.

    Raises
    ------
    BranchesInterrupted
        On a `KeyboardInterrupt`, with the branches up to there.
    """
    if user_values is None:
        solutions = list(solutions)
        user_values = [float(z[-1]) for z in solutions]
    events = Events(sorted(set(user_values)))
    paths: list[Path] = list(known)
    lost: list[FloatArray] = []
    try:
        for z in solutions:
            problem = new_problem() if paths else None
            if problem is not None and any(contains(path, z, problem) for path in paths):
                continue
            path = branch_through(new_problem, z, span, events, following)
            if not path.z.shape[0]:
                lost.append(z)
            elif problem is None or not _known(path, paths, problem):
                paths.append(path)
    except KeyboardInterrupt as stopped:
        last = (stopped.path,) if isinstance(stopped, PathInterrupted) else ()
        raise BranchesInterrupted(Branches((*paths, *last))) from None
    return Branches((*known, *_joined(paths[len(known) :], span, new_problem)), tuple(lost))


def _joined(
    paths: Sequence[Path], span: tuple[float, float], new_problem: Callable[[], Problem]
) -> list[Path]:
    """Join the paths from ends of the span that ended too early with other paths.

    A path whose two ends lie on a whole branch is part of that branch, and is dropped. Two paths that overlap
    are one branch.
    """
    broken = [path for path in paths if not path.status.is_whole and path.z.shape[0] > 1]
    broken = [path for path in broken if path.parameter[0] in span]
    whole = [path for path in paths if path.status.is_whole]
    for one in broken:
        if _has_ends_on(whole, one, new_problem()):
            return _joined([path for path in paths if path is not one], span, new_problem)
    for one, other in combinations(broken, 2):
        problem = new_problem()
        passed = point_before(other, one.z[-1], problem)
        if passed is not None and contains(one, other.z[-1], problem):
            rest = [path for path in paths if path is not one and path is not other]
            return [_overlapping(one, other, passed), *_joined(rest, span, new_problem)]
    return list(paths)


def _overlapping(one: Path, other: Path, passed: int) -> Path:
    """Join two overlapping paths: `other` passes the end of `one` behind its point number `passed`."""
    before = other.part(np.arange(passed + 2))  # `then` drops the first point of the second path
    same_end = one.parameter[0] == other.parameter[0]
    whole = replace(one.then(before.backwards()), status=Status.RETURNED if same_end else Status.COMPLETE)
    return whole.backwards() if whole.parameter[0] > whole.parameter[-1] else whole


def _known(path: Path, paths: Sequence[Path], problem: Problem) -> bool:
    """Whether the ends of a complete path lie on a path followed before.

    Rounding may hide that its start lies there: a large preload makes displacements less accurate than
    `PathOptions.solution_tolerance`.
    """
    return path.status is Status.COMPLETE and _has_ends_on(paths, path, problem)


def _has_ends_on(paths: Sequence[Path], path: Path, problem: Problem) -> bool:
    """Whether the first and the last solution of a path lie on one of the paths."""
    return any(
        contains(other, path.z[0], problem) and contains(other, path.z[-1], problem) for other in paths
    )


def contains(path: Path, z: FloatArray, problem: Problem) -> bool:
    """Whether a solution z (n + 1,) lies on a path; see `point_before`."""
    return point_before(path, z, problem) is not None


def point_before(path: Path, z: FloatArray, problem: Problem) -> int | None:
    """Number of the point of a path just before a solution z (n + 1,) on it; None if z is not on the path.

    -1 if z is the first point. A solution at a point lies on the path. Between points, distance does not
    decide, as branches come close to each other: Newton's method starts from the nearest chords, in the plane
    through z normal to the chord, and has to come to z.
    """
    problem.evaluate_scale(z)
    scale = np.array(problem.scale)
    points = (path.z - z) / scale
    square = (points * points).sum(axis=1)
    if float(square.min()) < PATH.solution_tolerance**2:
        return int(square.argmin()) - 1
    newton = Newton(problem)
    for i, part in _nearest_chords(points):
        row = points[i + 1] - points[i]
        newton.scale[:], newton.row[:] = scale, row / np.linalg.norm(row)
        newton.z[:] = path.z[i] + part * (path.z[i + 1] - path.z[i])
        if (
            newton.correct(1.0)
            and np.linalg.norm((np.asarray(newton.z) - z) / scale) < PATH.solution_tolerance
        ):
            return i
    return None


def _nearest_chords(points: FloatArray) -> list[tuple[int, float]]:
    """The chords nearest to the origin, the nearest first, each with the part of it at the nearest place."""
    length, part, off = distances_from_chords(points)
    near = np.argsort(off)[: PATH.nearest_chords].tolist()
    return [
        (i, float(part[i]))
        for i in near
        if PATH.solution_tolerance < length[i] and off[i] < PATH.max_distance_ratio * length[i]
    ]


def distances_from_chords(points: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Length, nearest place and distance from the origin of each chord (point - 1,) between points.

    The nearest place is a part of the chord, from 0 to 1."""
    chord = np.diff(points, axis=0)
    square = np.maximum((chord * chord).sum(axis=1), np.finfo(float).tiny)  # tiny: for two equal points
    part = np.clip(-(points[:-1] * chord).sum(axis=1) / square, 0.0, 1.0)
    off = np.linalg.norm(points[:-1] + part[:, None] * chord, axis=1)
    return np.sqrt(square), part, off


def branch_through(
    new_problem: Callable[[], Problem],
    z: FloatArray,
    span: tuple[float, float],
    events: Events,
    following: Following,
) -> Path:
    """The whole branch through a solution, beginning at its lower end if it has one; see `follow`."""
    along, options = following.follow, following.options
    if z[-1] == span[0] or z[-1] == span[1]:
        path = along(new_problem(), z, span, events, options, forward=z[-1] == span[0])
        return path.backwards() if path.status is Status.COMPLETE and z[-1] == span[1] else path
    path = along(new_problem(), z, span, events, options, forward=True)
    if path.status is Status.CLOSED or path.z.shape[0] == 0:
        return path
    try:
        other = along(new_problem(), z, span, events, options, forward=False)
    except PathInterrupted as stopped:
        raise PathInterrupted(path.backwards().then(stopped.path)) from None
    if other.z.shape[0] == 0:
        return path
    if other.status not in (Status.COMPLETE, Status.RETURNED):
        path, other = other, path
    whole = other.backwards().then(path)
    falls = whole.status is Status.COMPLETE and whole.parameter[0] > whole.parameter[-1]
    return whole.backwards() if falls else whole
