"""Through the segments of a motion, one after the other, or step by step, each step as a polynomial.

`sample` has the motion at given instants.
"""

from __future__ import annotations

import cython
import numpy as np

from fcm.time_domain.segments import ORDER, SMALL

if cython.compiled:
    from cython.cimports.fcm.time_domain.flow import Flows, summed
    from cython.cimports.fcm.time_domain.segments import Segments
else:
    from fcm.time_domain.flow import Flows, summed
    from fcm.time_domain.segments import Segments

DENSE = 32  # components from which many steps are sooner made at once, by BLAS
DOUBLINGS = 7  # of the steps that are made at once
SPAN = 2**DOUBLINGS


@cython.cclass
class Walk:
    """`visit` is what is done along each segment that lasts; `at` is the one where it is.

    Of a large system `ahead` are the state vectors on a `span` of so many steps; else that is 0.
    """

    def __init__(self, flows: Flows) -> None:
        self.flows, self.segments, self.at = flows, Segments(flows.size, flows.contacts, 0), -1
        self.span = SPAN if DENSE <= flows.linear <= SMALL else 0
        self.ahead = np.zeros((self.span + 1, flows.size))

    def begins(self, segments: Segments) -> None:
        """Stand before the first segment."""
        self.segments, self.at = segments, -1

    def go(self) -> int:
        """Go through all segments: 0 when done, -1 where the flow of the next one is missing."""
        stopped: cython.int
        with cython.nogil:
            stopped = self._go()
        return int(stopped)

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(-2, check=False)
    def _go(self) -> cython.int:
        slot: cython.Py_ssize_t
        while self.at + 1 < self.segments.count:
            if self.segments.length[self.at + 1] > 0.0:
                slot = self.flows.find(self.segments.states, self.at + 1)
                if slot < 0:
                    return -1
                self.flows.refresh(slot)
                self.at += 1
                self.visit(slot)
            else:
                self.at += 1
        return 0

    def reach(self, slot: cython.Py_ssize_t) -> None:
        """Fill the rows of `ahead` after the first, each time as many as there are."""
        self.flows.reach(slot, DOUBLINGS)
        n, y = self.flows.linear, np.asarray(self.ahead)
        powers, waves = np.asarray(self.flows.power)[slot], self.flows.waves
        forced = (
            np.asarray(self.flows.forced)[slot].reshape(-1, waves, 4, n)[:, :, :2].reshape(-1, 2 * waves, n)
        )
        for j in range(DOUBLINGS + 1):
            k = 1 << j
            last = min(2 * k, SPAN + 1)
            old, new = y[: last - k], y[k:last]
            new[:, :n] = old[:, :n] @ powers[j] + old[:, n:] @ forced[j]
            for b in range(0, 2 * waves, 2):
                c, s = np.asarray(self.flows.rotation)[slot, j, b : b + 2]
                new[:, n + b : n + b + 2] = old[:, n + b : n + b + 2] @ np.array([[c, -s], [s, c]])

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(-1, check=False)
    def visit(self, slot: cython.Py_ssize_t) -> cython.int:
        """Along the segment `at`, whose flow is in that place of the pool."""
        return 0


MISSING = -1


@cython.cclass
class Steps:
    """The steps of segments: from `time` [s] on, y is the sum of terms[j] x**j, x to `length` of `h` [s]."""

    def __init__(self, flows: Flows, segments: Segments) -> None:
        self.flows, self.segments = flows, segments
        self.y, self.terms = np.zeros((1, flows.size)), np.zeros((ORDER + 1, flows.size))
        self.at, self.slot, self.left, self.length = -1, -1, 0.0, 0.0
        self.time, self.h = 0.0, 1.0

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(-2, check=False)
    def next(self) -> cython.int:
        """Go to the next step: 1 if there is one, 0 at the end, -1 if segment at + 1 has no flow yet."""
        i: cython.Py_ssize_t
        slot: cython.Py_ssize_t
        self.left -= self.length
        if self.left > 0.0:
            summed(self.terms, self.length, self.y, 0)
            self.time += self.h
        else:
            while self.at + 1 < self.segments.count and self.segments.length[self.at + 1] <= 0.0:
                self.at += 1
            if self.at + 1 >= self.segments.count:
                self.left = self.length = 0.0
                return 0
            slot = self.flows.find(self.segments.states, self.at + 1)
            if slot < 0:
                self.left = self.length = 0.0
                return -1
            self.flows.refresh(slot)
            self.at += 1
            self.slot, self.h = slot, self.flows.step[slot]
            self.left, self.time = self.segments.length[self.at], self.segments.start[self.at]
            for i in range(self.flows.size):
                self.y[0, i] = self.segments.y[self.at, i]
        self.length = min(self.left, 1.0)
        self.flows.taylor(self.slot, self.y, 0, self.terms)
        return 1


_ORDER = cython.declare(cython.int, 19)


def sample(
    steps: Steps, times: cython.double[::1], out: cython.double[:, ::1], done: cython.Py_ssize_t
) -> int:
    """State vectors at increasing times [s], into the rows of out from `done` on; returns how many there are.

    Fewer than all where a flow is missing; the last step serves later times too.
    """
    with cython.nogil:
        done = _sample(steps, times, out, done)
    return int(done)


@cython.cfunc
@cython.nogil
@cython.exceptval(-1, check=False)
def _sample(
    steps: Steps, times: cython.double[::1], out: cython.double[:, ::1], done: cython.Py_ssize_t
) -> cython.Py_ssize_t:
    stopped: cython.int
    until: cython.double
    x: cython.double
    i: cython.Py_ssize_t
    j: cython.int
    while done < times.shape[0]:
        stopped = steps.next()
        if stopped != 1:
            return done
        last: cython.bint = steps.left <= 1.0
        until = steps.time + steps.h * steps.length
        if last and steps.at + 1 < steps.segments.count:
            until = steps.segments.start[steps.at + 1]
        while done < times.shape[0] and (
            times[done] < until or (last and steps.at + 1 == steps.segments.count)
        ):
            x = (times[done] - steps.time) / steps.h
            for i in range(steps.flows.size):
                out[done, i] = steps.terms[_ORDER, i]
            for j in range(_ORDER - 1, -1, -1):
                for i in range(steps.flows.size):
                    out[done, i] = out[done, i] * x + steps.terms[j, i]
            done += 1
    return done
