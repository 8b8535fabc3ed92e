"""All branches of a problem that hold some known solutions, each traced once."""

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
    """Options, progress and function with which each branch is followed.

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
    """Separate paths; each solution that was given lies on one of them, or is in lost."""

    paths: tuple[Path, ...]
    lost: tuple[FloatArray, ...] = ()  # solutions from which nothing could be followed

    @property
    def status(self) -> Status:
        """COMPLETE if every branch ended as a whole branch does, else how the first that did not ended."""
        broken = [path.status for path in self.paths if not path.status.is_whole]
        return broken[0] if broken else Status.STALLED if self.lost else Status.COMPLETE


class BranchesInterrupted(KeyboardInterrupt):
    """Following branches was interrupted; branches: those up to there, the last as far as it had come."""

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
    """Follow every solution that no branch followed before contains.

    Parameters
    ----------
    new_problem : callable
        Makes the problem anew; what it made before is not used any more.
    solutions : iterable of (n + 1,)
        In the order in which they are to be followed; those at an end of the span lead inwards, those inside
        it both ways.
    following : Following
        How each is followed.
    known : sequence of Path
        Branches that were followed before, which are the first of those returned.
    user_values : sequence of float, optional
        Parameters of all solutions, where these are found in turn.

    Raises
    ------
    BranchesInterrupted
        With the branches up to there, where a `KeyboardInterrupt` comes.
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
    """The paths, of which those from ends of the span that ended too early are joined with others.

    One whose ends lie on a whole branch is part of that, and two that overlap are one branch.
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
    """The branch of two paths of which the other comes by the end of the one behind a point, as `passed`."""
    before = other.part(np.arange(passed + 2))  # `then` takes the point beyond the end for it
    same_end = one.parameter[0] == other.parameter[0]
    whole = replace(one.then(before.backwards()), status=Status.RETURNED if same_end else Status.COMPLETE)
    return whole.backwards() if whole.parameter[0] > whole.parameter[-1] else whole


def _known(path: Path, paths: Sequence[Path], problem: Problem) -> bool:
    """Whether a path has the ends of one followed before: rounding may hide that its start is on that.

    So it does where a preload is so large that displacements are not known as well as
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
    """The point of a path before a solution z (n + 1,) on it, -1 if that is the first; None if it is not.

    It does where it is a point of that. Between the points no distance tells, as branches come close to each
    other. There Newton's method starts from the nearest chord of the path, in the plane through the solution
    across that chord.
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
    """The chords between points next to which the origin lies, the nearest first, and where on them."""
    length, part, off = distances_from_chords(points)
    near = np.argsort(off)[: PATH.nearest_chords].tolist()
    return [
        (i, float(part[i]))
        for i in near
        if PATH.solution_tolerance < length[i] and off[i] < PATH.max_distance_ratio * length[i]
    ]


def distances_from_chords(points: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Length of each chord (point - 1,) between points, its place next to the origin, and the distance of
    that.

    The place is a part of the chord, from 0 to 1; the distance is from the origin."""
    chord = np.diff(points, axis=0)
    square = np.maximum((chord * chord).sum(axis=1), np.finfo(float).tiny)  # of two points that are one
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
    """The whole branch through a solution, from its lower end where it has one; see `follow`."""
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
