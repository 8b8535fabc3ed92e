"""The passage of a curve through the range of its parameter: what is kept on the way, and where it ends."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import cython
import numpy as np

from fcm.continuation import events
from fcm.continuation.front import Front
from fcm.continuation.path import Mark, Path, Status
from fcm.continuation.place import Place
from fcm.continuation.stage import Stage
from fcm.continuation.trail import Trail

if cython.compiled:
    from cython.cimports.fcm.continuation.events import closes, quiet
else:
    from fcm.continuation.events import closes, quiet

END = cython.declare(cython.long, int(Mark.END))
CORNER = cython.declare(cython.long, int(Mark.CORNER))
STATION = cython.declare(cython.long, int(Mark.STATION))
SAME = cython.declare(cython.double, 1e-6)  # of the greatest unknown: points closer than this are one


@cython.cclass
class Passage:
    """Points are kept in `trail`; `first` is where the curve began, `head` its direction there.

    `values`, the same as `stops`, are those of the parameter that are landed on: stations, then the ends of
    the range. `greatest`, the same as `most`, are the outputs so far.
    """

    def __init__(self, front: Front, span: tuple[float, float], stations: Sequence[float]) -> None:
        self.front, self.n = front, front.problem.unknowns
        self.low, self.high = span
        self.values = [*(value for value in stations if self.low < value < self.high), self.low, self.high]
        self.stops, self.trail = np.array(self.values), Trail(self.n + 1)
        self.greatest = np.zeros(front.problem.outputs)
        self.most, self.first, self.head = self.greatest, np.zeros(self.n + 1), np.zeros(self.n + 1)
        self.interior = self.around = False

    def begins(self, parameter: float) -> None:
        """Begin where the front is, which is to be that value of the parameter."""
        here: Place = self.front.here
        here.z[self.n] = parameter
        self.interior = self.low < parameter < self.high
        self.first, self.head = np.array(here.z), np.array(here.tangent)
        self.trail.add(here, self.front.newton.scale, 0 if self.interior else END, self.front.there.shift)

    def resumes(self, stage: Stage) -> None:
        """Have the points that were kept, and no others."""
        self.trail.restore(stage.kept)
        self.interior, self.greatest[:] = stage.interior, stage.greatest
        self.first, self.head = stage.start.copy(), stage.heading.copy()

    def state(self) -> dict[str, Any]:
        """What of a stage the passage knows."""
        return {
            "kept": self.trail.state(),
            "greatest": self.greatest.copy(),
            "start": np.array(self.first),
            "heading": np.array(self.head),
            "interior": bool(self.interior),
        }

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def keep(self, limit: cython.double) -> cython.bint:
        """Keep what happens within the step up to a limit; true if the curve leaves its range there, or comes
        around to where it was though it did not begin there."""
        if quiet(self.front, self.stops, self.most):
            return False
        for event in events.within(self.front, limit, self.values, self.greatest):
            mark: cython.long = event.mark
            ends: cython.bint = mark & STATION and event.z[self.n] in (self.low, self.high)
            mark = END if ends else mark
            self.trail.put(event.z, event.direction, mark, event.orientation, event.shift)
            if mark & STATION and self.been():
                self.around = True
            if ends or self.around:
                return True
        return False

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def been(self) -> cython.bint:
        """Whether the last point, at a station, was passed before in its direction, or the curve began there,
        with folds in between: a step that ends there may keep it, and the next one once more."""
        trail: Trail = self.trail
        n: cython.Py_ssize_t = self.n
        last: cython.Py_ssize_t = trail.count - 1
        fold: cython.Py_ssize_t = last - 1  # the last point that another direction led to
        i: cython.Py_ssize_t
        rise: cython.double = trail.direction[last, n]
        while fold >= 0 and trail.direction[fold, n] * rise > 0.0:
            fold -= 1
        for i in range(fold):
            stopped: cython.bint = i == 0 or trail.mark[i] & STATION
            again: cython.bint = stopped and trail.z[i, n] == trail.z[last, n]
            if again and trail.direction[i, n] * rise > 0.0 and trail.same(i, last, SAME):
                return True
        return False

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def add(self, mark: cython.long) -> cython.int:
        """Keep the place there."""
        return self.trail.add(self.front.there, self.front.newton.scale, mark, self.front.there.shift)

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
    def rise(self) -> cython.void:
        """The greatest outputs so far."""
        k: cython.Py_ssize_t
        for k in range(self.most.shape[0]):
            self.most[k] = max(self.most[k], self.front.here.output[k])

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def closed(self) -> cython.bint:
        """Whether the step comes to where the curve began; the curve is kept as a closed one then."""
        if not self.interior or not closes(self.front, self.first, self.head):
            return False
        self.trail.close()
        return True

    @cython.cfunc
    @cython.exceptval(check=False)
    def inside(self) -> cython.bint:
        """Whether the place there is in the range."""
        return self.low <= self.front.there.z[self.n] <= self.high

    def covered(self) -> float:
        """Fraction of the range between where the curve began and here."""
        return float(abs(self.front.here.z[self.n] - self.first[self.n]) / (self.high - self.low))

    def end(self) -> Status:
        """The status of a curve that has left its range, or comes around."""
        if self.around and self.interior and self.trail.same(0, self.trail.count - 1, SAME):
            self.trail.drop()
            self.trail.close()
            return Status.CLOSED
        if self.around:
            return Status.AROUND
        back = not self.interior and self.trail.last()[self.n] == self.first[self.n]
        return Status.RETURNED if back else Status.COMPLETE

    def path(self, status: Status) -> Path:
        """The points kept so far."""
        return self.trail.path(status, self.front.newton.evaluations)
