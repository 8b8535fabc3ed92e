"""Continuation of the exact curves of a scene that saves its progress and resumes after an interruption."""

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
    """A curve from one start in one direction: complete, or as far as it was followed."""

    number: int  # in the order in which they are followed
    held: tuple[int, ...]  # the contacts that were held
    repeats: int  # periods after which the motions repeat
    path: Path | None
    checkpoint: Checkpoint | None

    def partial_path(self) -> Path:
        """The saved points as a path with the status of an interruption."""
        if self.path is not None:
            return replace(self.path, status=Status.INTERRUPTED)
        assert self.checkpoint is not None
        return self.checkpoint.path(Status.INTERRUPTED)


SAVED_KINDS = (SavedPath, Path, Checkpoint, Status, Stored, Points)  # classes of saved data


class _Ended(Exception):  # noqa: N818
    """A curve has come to its end within the range."""


class TimeOver(Exception):  # noqa: N818
    """A curve has used up its time limit."""


class CurveTimeLimit:
    """Limit of the processor time [s] of a curve, from now on; None for no limit.

    Each poll is reported as a step.
    """

    def __init__(self, limit: float | None, report: Report) -> None:
        self.limit, self.report, self._ask = limit, report, 0.0
        self._end = None if limit is None else time.process_time() + limit

    def share(self, part: float) -> float:
        """A part of the limit [s]; infinite without a limit."""
        return np.inf if self.limit is None else part * self.limit

    @property
    def over(self) -> bool:
        """Whether the time is over."""
        return self._end is not None and time.process_time() > self._end

    def poll(self) -> None:
        """Raise `TimeOver` if the time is over."""
        self.report.again()
        if self._end is not None and time.monotonic() > self._ask:
            if self.over:
                raise TimeOver
            self._ask = time.monotonic() + RESUMABLE.poll_interval


class ResumablePaths:
    """Follows curves one after the other, as `fcm.continuation.follow` does.

    After an interruption the same curves must be followed in the same order. Finished ones are then not
    followed again, and the unfinished one continues from its last point.

    poll : called before every step, for instance `CurveTimeLimit.poll`.
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
        self.number = 0  # number of the next path
        self._recorded = 0  # recorded points of the present path
        self._begun: tuple[OrbitProblem, Checkpoint] | None = None
        self._passed: SavedPath | None = None  # the last one that `passing` has accepted
        self._given = dict[int, SavedPath]()  # from another scene with the same motions
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
        """Follow a curve, see `follow`; a curve of doubled period ends at that of half the period."""
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
        """Follow a curve with `_watch`; a curve of doubled period ends at that of half the period."""
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
        """Record the new points before the problem forgets their periods.

        So a curve that is stopped is available at once. Many points are recorded together: to do so after
        each step would slow the continuation by a tenth.
        """
        if problem.full:
            for z in (*checkpoint.kept.before.z[self._recorded :], checkpoint.kept.last[0]):
                recorded(problem, z)
            self._recorded = checkpoint.kept.number - 1
            problem.forget()

    def found(self, problem: OrbitProblem) -> list[SavedPath]:
        """The paths of a problem as far as `passing` has accepted their points."""
        saved_paths = {_key(saved): saved for saved in self._known.values() if saved.path is not None}
        if self._passed is not None and _key(self._passed) not in saved_paths:
            saved_paths[_key(self._passed)] = self._passed
        held, repeats = problem_kind(problem)
        return [saved for saved in saved_paths.values() if (saved.held, saved.repeats) == (held, repeats)]

    def take(self, saved_paths: Iterable[SavedPath]) -> None:
        """Use saved paths of another scene for curves that begin at the same points."""
        self._given = {saved.number: saved for saved in saved_paths}

    def _taken(self, problem: OrbitProblem, start: FloatArray, forward: bool) -> SavedPath | None:
        """The path given by `take` with the present number, if it begins at the start."""
        saved = self._given.get(self.number)
        known = saved is not None and _key(saved) == _key(self._saved_path(problem))
        return saved if saved is not None and known and _begins_at(saved, problem, start, forward) else None

    def keep(self) -> None:
        """Save the part of the present curve that has been followed."""
        if self._begun is None:
            return
        begin = time.monotonic()
        self._save(self._saved_path(self._begun[0], checkpoint=self._begun[1]))
        self._seen = time.monotonic()
        self._took = self._seen - begin

    def paths(self, problem: OrbitProblem) -> list[Path]:
        """The saved parts of the curves of a problem, including those of an earlier run."""
        held, repeats = problem_kind(problem)
        saved_paths = [
            saved for saved in self._known.values() if (saved.held, saved.repeats) == (held, repeats)
        ]
        found = [saved.partial_path() for saved in sorted(saved_paths, key=lambda saved: saved.number)]
        return [path for path in found if path.z.shape[0]]

    def _saved_path(
        self, problem: OrbitProblem, path: Path | None = None, checkpoint: Checkpoint | None = None
    ) -> SavedPath:
        """The present path in the form in which it is saved."""
        return SavedPath(self.number, *problem_kind(problem), path, checkpoint)

    def _save(self, saved: SavedPath) -> None:
        self._known[_key(saved)] = saved
        self.report.save(saved)


def _begins_at(saved: SavedPath, problem: OrbitProblem, start: FloatArray, forward: bool) -> bool:
    """Whether a saved path begins at a start in a direction."""
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
    """The held contacts and the number of periods, which distinguish the curves of different problems."""
    return tuple(one.place for one in problem.scene.held), problem.repeats
