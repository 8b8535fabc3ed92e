"""The curves of a scene as they are followed: what is finished of them is kept, and need not be again."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import partial

from fcm.continuation import Mark, Path, Stage, Status, follow
from fcm.continuation.trail import Kept, Points
from fcm.orbit.doubled import Doubled
from fcm.orbit.periodic import without_end
from fcm.orbit.problem import OrbitProblem
from fcm.run import Report
from fcm.scene.model import FloatArray

OFTEN = 0.5  # [s] between two savings of a curve that is being followed
SHARE = 0.05  # of the time, that saving may take
SELDOM = 0.05  # [s] between two looks at the processor time, which takes long to tell on some machines


@dataclass(frozen=True)
class Leg:
    """A curve from one start in one direction: whole, or as far as it has come."""

    number: int  # in the order in which they are followed
    path: Path | None
    stage: Stage | None


LEGS = (Leg, Path, Stage, Status, Kept, Points, Mark)  # what is saved consists of these


class _Ended(Exception):  # noqa: N818
    """A curve has come to its end within the range."""


class TimeOver(Exception):  # noqa: N818
    """A curve has taken as long as it may."""


class Clock:
    """Of the processor time that a curve may take [s], from the beginning; without end if that is None."""

    def __init__(self, limit: float | None) -> None:
        self.limit, self._ask = limit, 0.0
        self._end = None if limit is None else time.process_time() + limit

    @property
    def over(self) -> bool:
        """Whether it is taken."""
        return self._end is not None and time.process_time() > self._end

    def look(self) -> None:
        """Raise `TimeOver` when it is."""
        if self._end is not None and time.monotonic() > self._ask:
            if self.over:
                raise TimeOver
            self._ask = time.monotonic() + SELDOM


class Legs:
    """Follows curves as `fcm.continuation.follow` does, one after the other.

    The same curves in the same order after an interruption: those that were finished are not followed again,
    and the one that was begun goes on from its last point.

    look : called before every step, as a `Clock` looks.
    passing : called with the problem and every point from which a step is made.
    """

    def __init__(
        self,
        span: tuple[float, float],
        report: Report,
        look: Callable[[], None] = without_end,
        passing: Callable[[OrbitProblem, FloatArray], None] | None = None,
    ) -> None:
        self.report, self.low, self.high = report, *span
        self.look, self.passing = look, passing
        self.finished: list[Path] = []
        self._last: Stage | None = None
        self._seen, self._took = time.monotonic(), 0.0
        self._saved: dict[int, Leg] = {}
        for leg in report.saved:
            if isinstance(leg, Leg):
                self._saved[leg.number] = leg  # the latest of each

    def __call__(
        self,
        problem: OrbitProblem,
        start: FloatArray,
        span: tuple[float, float],
        forward: bool,
        max_step: float,
        stations: Sequence[float],
        _progress: object = None,
    ) -> Path:
        """See `follow`; of motions of twice the periods of others up to where the curve comes to those."""
        saved = self._saved.get(len(self.finished))
        if saved is not None and _unknowns(saved) != start.size:  # with other contacts held than now
            saved = None
        if saved is not None and saved.path is not None:
            path = saved.path
        else:
            stage = None if saved is None else saved.stage
            watch = partial(self._watch, problem, float(start[-1]))
            if isinstance(problem, Doubled):
                problem.begins()
            try:
                path = follow(problem, start, span, forward, max_step, stations, None, stage, watch)
            except _Ended:
                assert self._last is not None
                path = self._last.path(Status.COMPLETE)
        self._last = None
        self.finished.append(path)
        if saved is None or saved.path is None:
            self.report.save(Leg(len(self.finished) - 1, path, None))
        return path

    def _watch(self, problem: OrbitProblem, begin: float, stage: Stage) -> None:
        if isinstance(problem, Doubled) and problem.ended(stage.z):
            raise _Ended
        self._last = stage
        covered = abs(float(stage.z[-1]) - begin) / (self.high - self.low)
        if time.monotonic() - self._seen > max(OFTEN, self._took / SHARE):
            self.keep()
        self.report(covered, f"{stage.kept.number} points")
        if self.passing is not None:
            self.passing(problem, stage.z)
        self.look()

    def keep(self) -> None:
        """Save the curve that is being followed as far as it is there."""
        if self._last is None:
            return
        begin = time.monotonic()
        self.report.save(Leg(len(self.finished), None, self._last))
        self._seen = time.monotonic()
        self._took = self._seen - begin

    def paths(self) -> list[Path]:
        """What there is: whole curves, and the one that was interrupted."""
        begun = [] if self._last is None else [self._last.path(Status.INTERRUPTED)]
        found = [path for path in (*self.finished, *begun) if path.z.shape[0]]
        return [replace(path, status=Status.INTERRUPTED) for path in found]


def _unknowns(leg: Leg) -> int:
    """The numbers of a point of a leg."""
    if leg.path is not None:
        return int(leg.path.z.shape[1])
    return 0 if leg.stage is None else leg.stage.z.size
