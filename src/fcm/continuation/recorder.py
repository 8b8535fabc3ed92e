"""What is kept of a curve on its way through the range of its parameter, and where it ends."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import cython
import numpy as np
from cython.cimports.libc.math import sqrt

from fcm.continuation import events
from fcm.continuation.checkpoint import Checkpoint
from fcm.continuation.events import Events
from fcm.continuation.path import Mark, Path, Status
from fcm.continuation.point import Point, PointStore
from fcm.continuation.stepper import Stepper

if cython.compiled:
    from cython.cimports.fcm.continuation.events import closes_curve, without_events
else:
    from fcm.continuation.events import closes_curve, without_events


END = cython.declare(cython.long, int(Mark.END))
CORNER = cython.declare(cython.long, int(Mark.CORNER))
STATION = cython.declare(cython.long, int(Mark.STATION))


@cython.cclass
class Recorder:
    """Points are kept in `store`; `first` is where the curve began, `initial_direction` its direction there.

    `values`, the same as `stops`, are those of the parameter that are landed on: stations, then the ends of
    the range. `greatest`, the same as `most`, are the outputs so far.
    """

    def __init__(self, stepper: Stepper, span: tuple[float, float], wanted: Events) -> None:
        self.stepper, self.n = stepper, stepper.problem.unknowns
        self.low, self.high = span
        self.values = [
            *(value for value in wanted.values if self.low < value < self.high),
            self.low,
            self.high,
        ]
        self.stops, self.store = np.array(self.values), PointStore(self.n + 1)
        self.greatest = np.zeros(stepper.problem.outputs)
        self.most, self.first, self.initial_direction = (
            self.greatest,
            np.zeros(self.n + 1),
            np.zeros(self.n + 1),
        )
        self.far = stepper.options.events.far_tolerance  # and these two are not
        self.interior = self.came_around = self.stopped = False
        self.last, self.ended_by = wanted.last, -1
        self.same = (
            stepper.options.events.point_tolerance
        )  # of the greatest unknown: points closer than this are one

    def start(self, parameter: float) -> None:
        """Begin where the stepper is, which is to be that value of the parameter."""
        here: Point = self.stepper.here
        here.z[self.n] = parameter
        self.interior = self.low < parameter < self.high
        self.first, self.initial_direction = np.array(here.z), np.array(here.tangent)
        self.store.add(here, self.stepper.newton.scale, 0 if self.interior else END)

    def restore(self, checkpoint: Checkpoint) -> None:
        """Have the points that were kept, and no others."""
        self.store.restore(checkpoint.kept)
        self.interior, self.greatest[:] = checkpoint.interior, checkpoint.greatest
        self.first, self.initial_direction = checkpoint.start.copy(), checkpoint.heading.copy()

    def state(self) -> dict[str, Any]:
        """What of a checkpoint the recorder knows."""
        return {
            "kept": self.store.state(),
            "greatest": self.greatest.copy(),
            "start": np.array(self.first),
            "heading": np.array(self.initial_direction),
            "interior": bool(self.interior),
        }

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def keep_events(self, limit: cython.double) -> cython.bint:
        """Keep what happens within the step up to a limit; true if the curve leaves its range there, or comes
        around to where it was though it did not begin there."""
        if without_events(self.stepper, self.stops, self.most):
            return False
        for event in events.events_within(self.stepper, limit, self.values, self.greatest):
            mark: cython.long = event.mark
            ends: cython.bint = mark & STATION and event.z[self.n] in (self.low, self.high)
            mark = END if ends else mark
            self.store.put(event.z, event.direction, mark, event.orientation)
            if mark & STATION and self.revisits_station():
                self.came_around = True
            self.stopped = self.stopped or bool(mark & self.last)
            if ends or self.came_around or self.stopped:
                return True
        return False

    def stop_at(self, length: float, number: int) -> Status:
        """Keep the point at a length of the step, where a function that is to end the curve does."""
        stepper = self.stepper
        if self.keep_events(length):
            return self.end_status()
        far = length > stepper.options.step.min_step
        if far and stepper.find_between(length, False, False) and stepper.sharpen(False, False):
            self.store.add(stepper.between, stepper.newton.scale, 0)
        self.stopped, self.ended_by = True, number
        return Status.EVENT

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def revisits_station(self) -> cython.bint:
        """Whether the last point, at a station, was passed before in its direction, or the curve began there,
        with folds in between: a step that ends there may keep it, and the next one once more."""
        store: PointStore = self.store
        n: cython.Py_ssize_t = self.n
        last: cython.Py_ssize_t = store.count - 1
        fold: cython.Py_ssize_t = last - 1  # the last point that another direction led to
        i: cython.Py_ssize_t
        rise: cython.double = store.direction[last, n]
        while fold >= 0 and store.direction[fold, n] * rise > 0.0:
            fold -= 1
        for i in range(fold):
            stopped: cython.bint = i == 0 or store.mark[i] & STATION
            again: cython.bint = stopped and store.z[i, n] == store.z[last, n]
            if again and store.direction[i, n] * rise > 0.0 and store.same(i, last, self.same):
                return True
        return False

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def revisits_corner(self) -> cython.bint:
        """Whether the last point, a corner, was passed before in its direction, and the curve was elsewhere
        in between: it then goes around for ever."""
        store: PointStore = self.store
        i: cython.Py_ssize_t
        j: cython.Py_ssize_t
        last: cython.Py_ssize_t = store.count - 1
        elsewhere: cython.bint = False
        for i in range(last - 1, -1, -1):
            if not elsewhere:
                elsewhere = not store.same(i, last, self.far)
            elif store.mark[i] & CORNER and store.same(i, last, self.same):
                along: cython.double = 0.0
                one: cython.double = 0.0
                other: cython.double = 0.0
                for j in range(self.n + 1):
                    along += store.direction[i, j] * store.direction[last, j]
                    one += store.direction[i, j] * store.direction[i, j]
                    other += store.direction[last, j] * store.direction[last, j]
                if along > self.stepper.options.events.around_cosine * sqrt(one * other):
                    return True  # and does not cross itself there
        return False

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def add(self, mark: cython.long) -> cython.int:
        """Keep the point there."""
        return self.store.add(self.stepper.there, self.stepper.newton.scale, mark)

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def add_corner(self, point: Point) -> cython.int:
        """Keep a point as a corner; the step before may have come to it already."""
        mark: cython.long = CORNER
        if self.store.ends_at(point):
            mark |= self.store.drop()
        return self.store.add(point, self.stepper.newton.scale, mark)

    @cython.cfunc
    @cython.exceptval(check=False)
    def update_greatest(self) -> cython.void:
        """The greatest outputs so far."""
        k: cython.Py_ssize_t
        for k in range(self.most.shape[0]):
            self.most[k] = max(self.most[k], self.stepper.here.output[k])

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def closed(self) -> cython.bint:
        """Whether the step comes to where the curve began; the curve is kept as a closed one then."""
        if not self.interior or not closes_curve(self.stepper, self.first, self.initial_direction):
            return False
        self.store.close()
        return True

    @cython.cfunc
    @cython.exceptval(check=False)
    def inside(self) -> cython.bint:
        """Whether the point there is in the range."""
        return self.low <= self.stepper.there.z[self.n] <= self.high

    def covered(self) -> float:
        """Fraction of the range between where the curve began and here."""
        return float(abs(self.stepper.here.z[self.n] - self.first[self.n]) / (self.high - self.low))

    def end_status(self) -> Status:
        """The status of a curve that has left its range, or comes around."""
        if self.stopped:
            return Status.EVENT
        if self.came_around and self.interior and self.store.same(0, self.store.count - 1, self.same):
            self.store.drop()
            self.store.close()
            return Status.CLOSED
        if self.came_around:
            return Status.AROUND
        back = not self.interior and self.store.last()[self.n] == self.first[self.n]
        return Status.RETURNED if back else Status.COMPLETE

    def path(self, status: Status) -> Path:
        """The points kept so far."""
        path = self.store.path(status, self.stepper.newton.evaluations)
        return replace(path, ended_by=self.ended_by) if self.ended_by >= 0 else path


def step_back(stepper: Stepper, store: PointStore, points: int) -> bool:
    """Whether there is a plain point so many points back or more: the curve then ends there."""
    kept = store.points()
    plain = np.flatnonzero(kept.mark[: max(store.count - points, 0)] == 0)
    if not plain.size:
        return False
    i = int(plain[-1])
    stepper.problem.measure(kept.z[i])
    row = kept.direction[i] / np.asarray(stepper.problem.scale)
    if not stepper.begin(kept.z[i], row / np.linalg.norm(row)):
        return False
    if stepper.here.orientation != kept.orientation[i]:
        return False
    store.cut(i + 1)
    return True
