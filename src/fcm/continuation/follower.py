# cython: wraparound=True
"""The one that follows a curve, step by step."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import cython
import numpy as np
from cython.cimports.libc.math import fabs

from fcm.continuation import events
from fcm.continuation.back import BACK, earlier
from fcm.continuation.front import Front
from fcm.continuation.path import FloatArray, Mark, Path, Status
from fcm.continuation.place import Place
from fcm.continuation.problem import Problem
from fcm.continuation.soft import Soft
from fcm.continuation.stage import Stage, put_back, state_of
from fcm.continuation.trail import Trail

if cython.compiled:
    from cython.cimports.fcm.continuation.ahead import ahead
    from cython.cimports.fcm.continuation.corner import come, cross, cross_softly
    from cython.cimports.fcm.continuation.events import closes, quiet
    from cython.cimports.fcm.continuation.margins import crosses, detour, dip
    from cython.cimports.fcm.continuation.step_rule import clear, extent, good, kept, next_step
else:
    from fcm.continuation.ahead import ahead
    from fcm.continuation.corner import come, cross, cross_softly
    from fcm.continuation.events import closes, quiet
    from fcm.continuation.margins import crosses, detour, dip
    from fcm.continuation.step_rule import clear, extent, good, kept, next_step

FIRST = cython.declare(cython.double, 1e-3)  # the first step
SHORTEST = cython.declare(cython.double, 1e-9)  # a step that is still too long then leads nowhere
PAST = cython.declare(cython.double, 1e-3)  # of a step that ends at a margin, by which it goes past
BEFORE = cython.declare(cython.double, 1e-6)  # of the way to a corner: up to here the curve is smooth
# length past a corner at which the curve's new direction is looked for
BEYOND = cython.declare(cython.double, 1e-7)
TOUCHED = cython.declare(cython.double, 1e-8)  # a margin this near is met: less than BEYOND
NEAR = cython.declare(cython.double, 1e-4)  # where points matter, a corner further away is gone to by steps,
NEARER = cython.declare(cython.double, 0.9)  # each this share of the way
AFTER = cython.declare(cython.double, 1e-5)  # the first step beyond a corner
AT = cython.declare(cython.double, 0.25)  # of the width of a narrow place, within which a step ends there
LONGEST = 20_000  # steps
END = cython.declare(cython.long, int(Mark.END))
FOLD = cython.declare(cython.long, int(Mark.FOLD))
CORNER = cython.declare(cython.long, int(Mark.CORNER))
PEAK = cython.declare(cython.long, int(Mark.PEAK))
BRANCH = cython.declare(cython.long, int(Mark.BRANCH))

Progress = Callable[[float], None]  # fraction of the range that has been covered
Watch = Callable[[Stage], None]


@cython.cclass
class Follower:
    """`begin` or `resume`, then `run`: steps, the points that they keep, and where the curve ends."""

    problem: Problem
    front: Front
    n: cython.Py_ssize_t
    low: cython.double
    high: cython.double
    step: cython.double
    max_step: cython.double
    size: cython.double
    values: list[float]  # of the parameter, to be landed on: stations, then the ends of the range
    stops: cython.double[::1]  # the same
    narrow: cython.double[:, ::1]  # (place, 2) values of the parameter with a width: no step leads across
    trail: Trail
    greatest: FloatArray
    most: cython.double[::1]  # the same
    grew: cython.double[::1]  # growth before a corner
    first: cython.double[::1]  # point,
    head: cython.double[::1]  # and its tangent
    interior: cython.bint
    hasty: cython.bint
    near: cython.double  # a corner no further away is gone to at once
    short: cython.bint  # whether the step ends at a narrow place
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
        self.problem, self.front, self.n = problem, front or Front(problem), problem.unknowns
        self.front.newton.evaluations = 0
        self.low, self.high = span
        self.max_step, self.progress, self.hasty = max_step, progress, hasty
        self.near = max_step if hasty else NEAR
        self.values = [*(value for value in stations if self.low < value < self.high), self.low, self.high]
        self.stops = np.array(self.values)
        apart = [one for one in narrow if one[1] < max_step * (self.high - self.low)]
        self.narrow = np.array(apart, dtype=np.float64).reshape(-1, 2)
        self.trail, self.attempts = Trail(problem.unknowns + 1), 0
        self.short = False
        self.greatest = np.zeros(problem.outputs)
        self.most, self.grew = self.greatest, np.zeros(problem.outputs)
        self.soft = Soft(self.front, self.trail) if problem.soft else None

    def begin(self, start: FloatArray, forward: bool) -> bool:
        """Go to the curve at the start; whether there is one."""
        here: Place = self.front.here
        row = np.zeros(self.n + 1)
        row[-1] = 1.0 if forward else -1.0
        if not self.front.begin(np.array(start, dtype=np.float64), row):
            return False
        here.z[self.n] = start[-1]
        self.interior = self.low < start[-1] < self.high
        self.first, self.head = np.array(here.z), np.array(here.tangent)
        self.size = extent(self.front)
        self.trail.add(here, self.front.newton.scale, 0 if self.interior else END, self.front.there.shift)
        self.step = min(FIRST, self.max_step)
        return True

    def resume(self, stage: Stage) -> None:
        """Go where the curve had come to."""
        put_back(self.front, stage)
        self.trail.restore(stage.kept)
        self.step, self.size, self.interior = stage.step, stage.size, stage.interior
        self.greatest[:] = stage.greatest
        self.first, self.head = stage.start.copy(), stage.heading.copy()

    def stage(self) -> Stage:
        """Where it is."""
        return Stage(
            kept=self.trail.state(), step=self.step, greatest=self.greatest.copy(), size=self.size,
            start=np.array(self.first), heading=np.array(self.head), interior=bool(self.interior),
            **state_of(self.front),
        )  # fmt: skip

    def run(self, watch: Watch | None) -> Path:
        """Step by step to where the curve ends."""
        here: Place = self.front.here
        count: cython.int
        for count in range(LONGEST):
            if watch is not None and self.soft is not None and self.soft.repeated == 0:
                watch(self.stage())
            status = self.advance()
            if status is Status.STALLED and self.taken_back():
                continue
            if status is not None:
                return self.path(status)
            if self.progress is not None and count % 16 == 0:
                self.progress(abs(here.z[self.n] - self.first[self.n]) / (self.high - self.low))
        return self.path(Status.TOO_LONG)

    def taken_back(self) -> bool:
        """Whether the curve can be gone on with from an earlier point, by other steps."""
        if self.soft is not None or self.attempts == len(BACK):
            return False
        self.attempts += 1
        self.step = min(FIRST, self.max_step)
        return earlier(self.front, self.trail, BACK[self.attempts - 1])

    @cython.cfunc
    def advance(self) -> object:
        """One step; a status where the curve ends."""
        front: Front = self.front
        step: cython.double = self.step
        reach: cython.double
        hidden: cython.double
        if self.soft is not None:
            return self.soft.advance(self, step)
        step = self.up_to_narrow(step)
        while step > SHORTEST:
            reach = ahead(front, step)
            if reach < min(step, TOUCHED):
                front.drift(reach)
                return self.turn(front.here, 0.0)
            # curves bend more and more towards a corner, and may hide a pair of folds there
            if self.near < reach < step and clear(front, NEARER * reach) and self.hidden() == 0.0:
                return self.smooth()
            if front.go(reach * (1.0 + PAST) + SHORTEST if reach < step else step):
                if crosses(front):
                    status = self.corner() if front.missed < 1.0 else Status.STALLED
                    if status is not Status.STALLED:
                        return status
                elif reach >= step and good(front):
                    hidden = self.hidden() or self.across(step)
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
    def up_to_narrow(self, step: cython.double) -> cython.double:
        """The step, or the length at which it comes to the first narrow place."""
        k: cython.Py_ssize_t
        way: cython.double
        unit: cython.double = self.front.here.tangent[self.n] * self.front.newton.scale[self.n]
        first: cython.double = step
        for k in range(self.narrow.shape[0]):
            way = self.narrow[k, 0] - self.front.here.z[self.n]
            nearer: cython.bint = way * unit > 0.0 and fabs(way) > AT * self.narrow[k, 1]
            if nearer and fabs(way) < first * fabs(unit):
                first = way / unit
        self.short = SHORTEST < first < step
        return first if self.short else step

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def across(self, step: cython.double) -> cython.double:
        """Length at which a step comes to the first narrow place that it leads across; 0 if there is none."""
        k: cython.Py_ssize_t
        way: cython.double
        gone: cython.double = self.front.there.z[self.n] - self.front.here.z[self.n]
        first: cython.double = step
        for k in range(self.narrow.shape[0]):
            way = self.narrow[k, 0] - self.front.here.z[self.n]
            within: cython.bint = way * gone > 0.0 and fabs(way) < fabs(gone)
            if within and min(fabs(way), fabs(gone - way)) > AT * self.narrow[k, 1]:
                first = min(first, step * way / gone)
        return first if SHORTEST < first < step else 0.0

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def hidden(self) -> cython.double:
        """Length at which the step passes by something that both its ends tell of; 0 if they do not."""
        at: cython.double = dip(self.front)
        return at if at > 0.0 else detour(self.front, self.most)

    def good(self) -> bool:
        """Whether the curve was where it was predicted, and went on as it did."""
        return bool(good(self.front))

    @cython.ccall
    def smooth(self) -> object:
        """Go on to the place there."""
        front: Front = self.front
        count: cython.int = self.trail.count
        if self.keep(front.step):
            return self.end()
        if not self.low <= front.there.z[self.n] <= self.high:
            self.trail.cut(count)  # beyond an end that was not landed on
            self.step = 0.25 * front.step
            return Status.STALLED if self.step < AFTER else None
        if self.interior and closes(front, self.first, self.head):
            self.trail.close()
            return Status.CLOSED
        turned: cython.bint = front.there.orientation != front.here.orientation
        self.trail.add(front.there, front.newton.scale, BRANCH if turned else 0, front.there.shift)
        wanted: cython.double = self.step
        self.step = next_step(front, self.max_step, self.hasty)
        if self.short and self.step >= front.step:  # nothing was there: on with the steps before
            self.step = max(self.step, wanted)
        front.accept(front.there, front.step)
        self.rise()
        return Status.UNBOUNDED if extent(front) > self.problem.boundless * self.size else None

    @cython.cfunc
    def corner(self) -> object:
        """Go on from the first corner of the step, in the direction that the curve has beyond.

        STALLED where the curve is not found up to there, or not where it was predicted.
        """
        front: Front = self.front
        if not kept(front):  # what is there is another part of a curve that goes back in the corner
            return Status.STALLED
        at: cython.double = events.first_margin(front)
        if at < 0.0 or not front.shorten((1.0 - BEFORE) * at) or not kept(front) or not good(front):
            return Status.STALLED
        if self.keep(front.step):
            return self.end()
        place: Place = front.between if front.put(at, True, True) else front.there
        return self.turn(place, at)

    @cython.ccall
    def turn(self, place: Place, at: cython.double, past: cython.double = BEYOND) -> object:
        """Keep the corner, a place at a length from here, and turn into the direction that the curve has
        beyond.

        past: the length at which that is looked for where the corner is a change of label.
        """
        front: Front = self.front
        self.note(place)
        if place is not front.here:
            come(front, place, at)
        rise: cython.double = front.here.tangent[self.n]
        self.grew[:] = front.here.growth
        if self.soft is None:
            cross(front, self.stops)
        else:
            cross_softly(front, past)
        fold: cython.long = FOLD if rise * front.here.tangent[self.n] < 0.0 else 0
        self.trail.mark_last(fold | (PEAK if self.peaked() else 0))
        self.rise()
        self.step = AFTER
        return None

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def note(self, place: Place) -> cython.int:
        """Keep a place as a corner; the step before may have come to it already."""
        mark: cython.long = CORNER
        if self.trail.ends_at(place):
            mark |= self.trail.drop()
        return self.trail.add(place, self.front.newton.scale, mark, self.front.there.shift)

    @cython.cfunc
    @cython.exceptval(check=False)
    def peaked(self) -> cython.bint:
        """Whether an output grew before the corner that is here, and falls beyond it."""
        k: cython.Py_ssize_t
        for k in range(self.grew.shape[0]):  # noqa: SIM110 - a loop in C
            if self.grew[k] > 0.0 and self.front.here.growth[k] < 0.0:
                return True
        return False

    def aim(self, step: float, longer: bool) -> None:
        """Make the next step at most that long, or at least."""
        self.step = min(max(self.step, step), self.max_step) if longer else min(self.step, step)

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def keep(self, limit: cython.double) -> cython.bint:
        """Keep what happens within the step up to a limit; true if the curve leaves its range there."""
        if quiet(self.front, self.stops, self.most):
            return False
        for event in events.within(self.front, limit, self.values, self.greatest):
            ends = event.mark & Mark.STATION and event.z[self.n] in (self.low, self.high)
            mark = Mark.END if ends else event.mark
            self.trail.put(event.z, event.direction, mark, event.orientation, event.shift)
            if ends:
                return True
        return False

    @cython.cfunc
    def end(self) -> object:
        """The status of a curve that has left its range."""
        back = not self.interior and self.trail.last()[-1] == self.first[self.n]
        return Status.RETURNED if back else Status.COMPLETE

    @cython.cfunc
    @cython.exceptval(check=False)
    def rise(self) -> cython.void:
        """The greatest outputs so far."""
        k: cython.Py_ssize_t
        for k in range(self.most.shape[0]):
            self.most[k] = max(self.most[k], self.front.here.output[k])

    def path(self, status: Status) -> Path:
        """The points kept so far."""
        return self.trail.path(status, self.front.newton.evaluations)
