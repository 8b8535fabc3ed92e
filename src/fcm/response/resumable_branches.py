"""The curves of a scene as they are followed: what is finished of them is kept, and need not be again."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable
from dataclasses import replace
from functools import partial

import numpy as np

from fcm.continuation import Checkpoint, Events, FollowOptions, Path, Status, follow
from fcm.continuation.options import PATH
from fcm.continuation.problem import Points, Stored
from fcm.frozen import Frozen
from fcm.model.scene import FloatArray
from fcm.response.options import RESUMABLE
from fcm.run import Report
from fcm.shooting.orbit_record import recorded
from fcm.shooting.period_doubling import DoubledPeriodProblem
from fcm.shooting.periodic_orbit import never_interrupt
from fcm.shooting.problem import OrbitProblem


class SavedPath(Frozen):
    """A curve from one start in one direction: whole, or as far as it has come."""

    number: int  # in the order in which they are followed
    held: tuple[int, ...]  # the contacts that were held
    repeats: int  # periods after which the motions repeat
    path: Path | None
    checkpoint: Checkpoint | None

    def partial_path(self) -> Path:
        """The points of a saved path as those of a curve that is cut off."""
        if self.path is not None:
            return replace(self.path, status=Status.INTERRUPTED)
        assert self.checkpoint is not None
        return self.checkpoint.path(Status.INTERRUPTED)


SAVED_KINDS = (SavedPath, Path, Checkpoint, Status, Stored, Points)  # what is saved consists of these


class _Ended(Exception):  # noqa: N818
    """A curve has come to its end within the range."""


class TimeOver(Exception):  # noqa: N818
    """A curve has taken as long as it may."""


class CurveTimeLimit:
    """The processor time [s] that a curve may take, from now on; no limit if it is None.

    Each look is reported as a step.
    """

    def __init__(self, limit: float | None, report: Report) -> None:
        self.limit, self.report, self._ask = limit, report, 0.0
        self._end = None if limit is None else time.process_time() + limit

    def share(self, part: float) -> float:
        """A part of the limit [s]."""
        return np.inf if self.limit is None else part * self.limit

    @property
    def over(self) -> bool:
        """Whether the time is over."""
        return self._end is not None and time.process_time() > self._end

    def poll(self) -> None:
        """Raise `TimeOver` when the time is over."""
        self.report.again()
        if self._end is not None and time.monotonic() > self._ask:
            if self.over:
                raise TimeOver
            self._ask = time.monotonic() + RESUMABLE.poll_interval


class ResumablePaths:
    """Follows curves as `fcm.continuation.follow` does, one after the other.

    The same curves in the same order after an interruption: those that were finished are not followed again,
    and the one that was begun goes on from its last point.

    poll : called before every step, as a `CurveTimeLimit` looks.
    passing : called with the problem and every point from which a step is made.
    """

    def __init__(
        self,
        span: tuple[float, float],
        report: Report,
        poll: Callable[[], None] = never_interrupt,
        passing: Callable[[OrbitProblem, FloatArray], None] | None = None,
    ) -> None:
        self.report, self.low, self.high = report, *span
        self.poll, self.passing = poll, passing
        self.number = 0  # of the next one
        self._recorded = 0  # points of the one that is followed
        self._begun: tuple[OrbitProblem, Checkpoint] | None = None
        self._passed: SavedPath | None = None  # the last one of which nothing was wrong
        self._given = dict[int, SavedPath]()  # of another scene, with the same motions
        self._seen, self._took = time.monotonic(), 0.0
        every = (saved for saved in report.saved if isinstance(saved, SavedPath))
        self._known = {_key(saved): saved for saved in every}  # the latest of each

    def __call__(
        self,
        problem: OrbitProblem,
        start: FloatArray,
        span: tuple[float, float],
        events: Events,
        options: FollowOptions,
        *,
        forward: bool,
    ) -> Path:
        """Follow a curve, see `follow`; one of doubled periods up to where it comes to those of half."""
        saved = self._known.get(_key(self._saved_path(problem))) or self._taken(problem, start, forward)
        if saved is None or saved.path is None:
            checkpoint = None if saved is None else saved.checkpoint
            whole = partial(follow, problem, start, span, events, options, forward=forward)
            path = self._followed(problem, start, partial(whole, checkpoint=checkpoint))
            saved = self._saved_path(problem, path)
            self._save(saved)
        self._begun = None
        self.number += 1
        assert saved.path is not None
        return saved.path

    def _followed(self, problem: OrbitProblem, start: FloatArray, whole: Callable[..., Path]) -> Path:
        """The curve by `follow` with a watch; one of doubled periods up to those of half."""
        self._recorded = 0
        watch = partial(self._watch, problem, float(start[-1]))
        if isinstance(problem, DoubledPeriodProblem):
            problem.reset_flips()
        try:
            return whole(watch=watch)
        except _Ended:
            assert self._begun is not None
            return self._begun[1].path(Status.COMPLETE)

    def _watch(self, problem: OrbitProblem, begin: float, checkpoint: Checkpoint) -> None:
        if isinstance(problem, DoubledPeriodProblem) and problem.has_passed_flip(checkpoint.z):
            raise _Ended
        self._begun = problem, checkpoint
        self._record(problem, checkpoint)
        covered = abs(float(checkpoint.z[-1]) - begin) / (self.high - self.low)
        if time.monotonic() - self._seen > max(RESUMABLE.save_interval, self._took / RESUMABLE.time_fraction):
            self.keep()
        self.report(covered, f"{checkpoint.kept.number} points")
        if self.passing is not None:
            self.passing(problem, checkpoint.z)
            self._passed = self._saved_path(problem, checkpoint=checkpoint)
        self.poll()

    def _record(self, problem: OrbitProblem, checkpoint: Checkpoint) -> None:
        """Record the new points before their periods are forgotten.

        Then a curve that is stopped is there at once. Many together: after each step it would make the
        following a tenth slower.
        """
        if problem.full:
            for z in (*checkpoint.kept.before.z[self._recorded :], checkpoint.kept.last[0]):
                recorded(problem, z)
            self._recorded = checkpoint.kept.number - 1
            problem.forget()

    def found(self, problem: OrbitProblem) -> list[SavedPath]:
        """The paths of a problem as far as all their points were passed."""
        saved_paths = {_key(saved): saved for saved in self._known.values() if saved.path is not None}
        if self._passed is not None and _key(self._passed) not in saved_paths:
            saved_paths[_key(self._passed)] = self._passed
        held, repeats = problem_kind(problem)
        return [saved for saved in saved_paths.values() if (saved.held, saved.repeats) == (held, repeats)]

    def take(self, saved_paths: Iterable[SavedPath]) -> None:
        """Go on with paths that begin where one is to be followed."""
        self._given = {saved.number: saved for saved in saved_paths}

    def _taken(self, problem: OrbitProblem, start: FloatArray, forward: bool) -> SavedPath | None:
        """The saved path with the next number, if it begins at the start."""
        saved = self._given.get(self.number)
        known = saved is not None and _key(saved) == _key(self._saved_path(problem))
        return saved if saved is not None and known and _begins_at(saved, problem, start, forward) else None

    def keep(self) -> None:
        """Save the curve that is being followed as far as it is there."""
        if self._begun is None:
            return
        begin = time.monotonic()
        self._save(self._saved_path(self._begun[0], checkpoint=self._begun[1]))
        self._seen = time.monotonic()
        self._took = self._seen - begin

    def paths(self, problem: OrbitProblem) -> list[Path]:
        """Saved parts of the curves of a problem, including those of an earlier run."""
        held, repeats = problem_kind(problem)
        saved_paths = [
            saved for saved in self._known.values() if (saved.held, saved.repeats) == (held, repeats)
        ]
        found = [saved.partial_path() for saved in sorted(saved_paths, key=lambda saved: saved.number)]
        return [path for path in found if path.z.shape[0]]

    def _saved_path(
        self, problem: OrbitProblem, path: Path | None = None, checkpoint: Checkpoint | None = None
    ) -> SavedPath:
        """The path that is followed now, as it is saved."""
        return SavedPath(self.number, *problem_kind(problem), path, checkpoint)

    def _save(self, saved: SavedPath) -> None:
        self._known[_key(saved)] = saved
        self.report.save(saved)


def _begins_at(saved: SavedPath, problem: OrbitProblem, start: FloatArray, forward: bool) -> bool:
    """Whether a path is that from a start in a direction."""
    if saved.path is not None:
        first, rise = saved.path.z[0], float(saved.path.direction[0, -1])
    else:
        assert saved.checkpoint is not None
        first, rise = saved.checkpoint.first, float(saved.checkpoint.initial_direction[-1])
    problem.evaluate_scale(first)
    off = np.linalg.norm((first - start) / np.asarray(problem.scale))
    return bool(off < PATH.solution_tolerance) and (rise > 0.0) == forward


def _key(saved: SavedPath) -> tuple[int, tuple[int, ...], int]:
    return saved.number, saved.held, saved.repeats


def problem_kind(problem: OrbitProblem) -> tuple[tuple[int, ...], int]:
    """The held contacts and the number of periods: curves with others are different."""
    return tuple(one.place for one in problem.scene.held), problem.repeats
