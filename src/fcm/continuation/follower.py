"""The one that follows a curve, step by step."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import cython
import numpy as np

from fcm.continuation.back import BACK, earlier
from fcm.continuation.front import Front
from fcm.continuation.leaving import Leaving
from fcm.continuation.narrow import Narrow
from fcm.continuation.passage import Passage
from fcm.continuation.path import FloatArray, Mark, Path, Status
from fcm.continuation.place import Place
from fcm.continuation.problem import Problem
from fcm.continuation.soft import Soft
from fcm.continuation.stage import Stage, put_back, state_of

if cython.compiled:
    from cython.cimports.fcm.continuation.ahead import ahead
    from cython.cimports.fcm.continuation.front import PRELIMINARY
    from cython.cimports.fcm.continuation.leaving import before_corner
    from cython.cimports.fcm.continuation.margins import crosses, detour, dip, even, turning
    from cython.cimports.fcm.continuation.newton import CLOSE
    from cython.cimports.fcm.continuation.step_rule import clear, extent, good, next_step
else:
    from fcm.continuation.ahead import ahead
    from fcm.continuation.front import PRELIMINARY
    from fcm.continuation.leaving import before_corner
    from fcm.continuation.margins import crosses, detour, dip, even, turning
    from fcm.continuation.newton import CLOSE
    from fcm.continuation.step_rule import clear, extent, good, next_step

FIRST = cython.declare(cython.double, 1e-3)  # the first step
SHORTEST = cython.declare(cython.double, 1e-9)  # a step that is still too long then leads nowhere
PAST = cython.declare(cython.double, 1e-3)  # of a step that ends at a margin, by which it goes past
# length past a corner at which the curve's new direction is looked for
BEYOND = cython.declare(cython.double, 1e-7)
TOUCHED = cython.declare(cython.double, 1e-8)  # a margin this near is met: less than BEYOND
NEAR = cython.declare(cython.double, 1e-4)  # where points matter, a corner further away is gone to by steps,
NEARER = cython.declare(cython.double, 0.9)  # each this share of the way
AFTER = cython.declare(cython.double, 1e-5)  # the first step beyond a corner,
SAME = cython.declare(cython.double, 0.1)  # or this share of that before it, where every place counts
LESS = cython.declare(cython.double, 0.25)  # of a hasty step that does not go over all corners: it may
LONGEST = 20_000  # steps
# unknowns from which on slight corners are stepped over by longer steps where the parameter goes on evenly
MANY = cython.declare(cython.int, 64)
BRANCH = cython.declare(cython.long, int(Mark.BRANCH))

Progress = Callable[[float], None]  # fraction of the range that has been covered
Watch = Callable[[Stage], None]


@cython.cclass
class Follower:
    """`begin` or `resume`, then `run`: steps, the points that they keep, and where the curve ends."""

    problem: Problem
    front: Front
    passage: Passage
    narrow: Narrow  # values of the parameter that no step leads across
    corners: Leaving
    step: cython.double
    max_step: cython.double
    size: cython.double  # of the solution at the start
    hasty: cython.bint
    near: cython.double  # a corner no further away is gone to at once
    attempts: int  # to go back from where no step leads on
    soft: Soft | None
    progress: Progress | None

    def __init__(
        self,
        problem: Problem,
        span: tuple[float, float],
        max_step: float,
        stations: Sequence[float],
        progress: Progress | None,
        hasty: bool = False,
        front: Front | None = None,
        narrow: Sequence[tuple[float, float]] = (),
    ) -> None:
        self.problem, self.front = problem, front or Front(problem)
        self.front.newton.evaluations = 0
        self.front.close = PRELIMINARY if hasty else CLOSE
        self.max_step, self.progress, self.hasty = max_step, progress, hasty
        self.near = max_step if hasty or problem.dear else NEAR
        self.passage = Passage(self.front, span, stations)
        self.narrow = Narrow([one for one in narrow if one[1] < max_step * (span[1] - span[0])])
        self.corners, self.attempts = Leaving(self.passage, problem.soft), 0
        self.soft = Soft(self.front, self.passage.trail) if problem.soft else None

    def begin(self, start: FloatArray, forward: bool) -> bool:
        """Go to the curve at the start; whether there is one."""
        row = np.zeros(self.problem.unknowns + 1)
        row[self.problem.unknowns] = 1.0 if forward else -1.0
        if not self.front.begin(np.array(start, dtype=np.float64), row):
            return False
        self.passage.begins(start[self.problem.unknowns])
        self.size = extent(self.front)
        self.step = min(FIRST, self.max_step)
        return True

    def resume(self, stage: Stage) -> None:
        """Go where the curve had come to."""
        put_back(self.front, stage)
        self.passage.resumes(stage)
        self.step, self.size = stage.step, stage.size

    def stage(self) -> Stage:
        """Where it is."""
        return Stage(step=self.step, size=self.size, **self.passage.state(), **state_of(self.front))

    def run(self, watch: Watch | None) -> Path:
        """Step by step to where the curve ends."""
        count: cython.int
        for count in range(LONGEST):
            if watch is not None and self.soft is not None and self.soft.repeated == 0:
                watch(self.stage())
            status = self.advance()
            if status is None:
                if self.progress is not None and count % 16 == 0:
                    self.progress(self.passage.covered())
            elif status is not Status.STALLED or not self.taken_back():
                return self.path(status)
        return self.path(Status.TOO_LONG)

    def path(self, status: Status) -> Path:
        """The points kept so far."""
        return self.passage.path(status)

    def taken_back(self) -> bool:
        """Whether the curve can be gone on with from an earlier point, by other steps."""
        if self.soft is not None or self.attempts == len(BACK):
            return False
        self.attempts += 1
        self.step = min(FIRST, self.max_step)
        return earlier(self.front, self.passage.trail, BACK[self.attempts - 1])

    @cython.cfunc
    def advance(self) -> object:
        """One step; a status where the curve ends."""
        front: Front = self.front
        step: cython.double = self.step
        if self.soft is not None:
            return self.soft.advance(self, step)
        step = self.narrow.up_to(front, step)
        if self.problem.dear and (self.over(step) or self.over(LESS * step)):
            return self.smooth()
        while step > SHORTEST:
            reach: cython.double = ahead(front, step)
            if reach < step and step > self.near and self.problem.unknowns >= MANY and self.over(step):
                return self.smooth()
            if reach < min(step, TOUCHED):
                front.drift(reach)
                return self.leave(front.here, 0.0)
            # curves bend more and more towards a corner, and may hide a pair of folds there
            if self.near < reach < step and clear(front, NEARER * reach) and self.hidden() == 0.0:
                return self.smooth()
            if front.go(reach * (1.0 + PAST) + SHORTEST if reach < step else step):
                if crosses(front):
                    status = self.corner() if front.missed < 1.0 else Status.STALLED
                    if status is not Status.STALLED:
                        return status
                elif reach >= step and good(front):
                    hidden: cython.double = self.hidden() or self.narrow.across(front, step)
                    if hidden == 0.0:
                        return self.smooth()
                    step = hidden
                    continue
            # the curve may turn back in a corner, so that nothing is to be found beyond
            if reach < step and clear(front, reach * (1.0 - PAST)):
                return self.smooth()
            step = 0.25 * min(step, reach)
        return Status.STALLED

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def over(self, step: cython.double) -> cython.bint:
        """Whether a step goes on past all margins as if there were none: where they are many, most corners
        are slight. Only if none can hide a pair of folds, which a hasty curve may miss."""
        front: Front = self.front
        if not front.go(step) or not good(front) or self.narrow.across(front, step) > 0.0:
            return False
        return detour(front, self.passage.most) == 0.0 and (self.hasty or not crosses(front) or even(front))

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def hidden(self) -> cython.double:
        """Length at which the step passes by something that both its ends tell of; 0 if they do not."""
        self.front.incline()
        at: cython.double = dip(self.front)
        return at if at > 0.0 else detour(self.front, self.passage.most)

    def good(self) -> bool:
        """Whether the curve was where it was predicted, and went on as it did."""
        return bool(good(self.front))

    def turning(self) -> float:
        """Length at which the step passes by two folds that its ends tell of; 0 if they do not."""
        return float(turning(self.front) * self.front.step)

    @cython.ccall
    def smooth(self) -> object:
        """Go on to the place there."""
        front: Front = self.front
        count: cython.int = self.passage.trail.count
        if self.passage.keep(front.step):
            return self.passage.end()
        if not self.passage.inside():
            self.passage.trail.cut(count)  # beyond an end that was not landed on
            self.step = 0.25 * front.step
            return Status.STALLED if self.step < AFTER else None
        if self.passage.closed():
            return Status.CLOSED
        turned: cython.bint = front.there.orientation != front.here.orientation
        self.passage.add(BRANCH if turned else 0)
        wanted: cython.double = self.step
        self.step = next_step(front, self.max_step, self.hasty)
        if self.narrow.met and self.step >= front.step:  # nothing was there: on with the steps before
            self.step = max(self.step, wanted)
        front.accept(front.there, front.step)
        self.passage.rise()
        return Status.UNBOUNDED if extent(front) > self.problem.boundless * self.size else None

    @cython.cfunc
    def corner(self) -> object:
        """Go on from the first corner of the step; STALLED where the curve is not found up to there."""
        front: Front = self.front
        at: cython.double = before_corner(front)
        if at < 0.0:
            return Status.STALLED
        if self.passage.keep(front.step):
            return self.passage.end()
        place: Place = front.between if front.put(at, True, True) else front.there
        return self.leave(place, at)

    @cython.ccall
    def leave(self, place: Place, at: cython.double, past: cython.double = BEYOND) -> object:
        """Go on from a corner, a place at a length from here; past: where to look if it is soft."""
        self.corners.at(place, at, past)
        self.step = max(AFTER, SAME * self.step) if self.problem.dear else AFTER
        return None

    def aim(self, step: float, longer: bool) -> None:
        """Make the next step at most that long, or at least."""
        self.step = min(max(self.step, step), self.max_step) if longer else min(self.step, step)
