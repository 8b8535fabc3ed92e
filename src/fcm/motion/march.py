"""From transition to transition: when a combination of states ends, and which one follows.

What follows is decided by the sign of the first derivative that does not vanish of each exit function, so
that coinciding transitions, grazing ones and contacts released at rest need no cases of their own. Up to
that derivative the motion is the same in the old and the new state, so that the answer is unique.
"""

from __future__ import annotations

from typing import Any

import cython
import numpy as np
from cython.cimports.libc.math import fabs

from fcm.motion.events import workspace
from fcm.motion.pool import BLOCK, ORDER
from fcm.scene.model import FloatArray

if cython.compiled:
    from cython.cimports.fcm.motion.events import first_descent
    from cython.cimports.fcm.motion.flow import Flows
    from cython.cimports.fcm.motion.segments import Segments
    from cython.cimports.fcm.motion.series import summed
else:
    from fcm.motion.events import first_descent
    from fcm.motion.flow import Flows
    from fcm.motion.segments import Segments
    from fcm.motion.series import summed

DONE, MISSING, FULL, UNDECIDED, PAUSED, LONG = range(6)  # why the march has stopped
ROUNDING = cython.declare(cython.double, 3e-14)  # of a state after a step, relative to its terms
DEPTH = cython.declare(cython.double, 1e-13)  # an exit that is passed by less, relative to its size, is not
MOST_PASSES = cython.declare(cython.int, 100)  # until a combination of states agrees with itself
MOST_STEPS = cython.declare(cython.double, 2e8)  # in one segment
PATIENCE = cython.declare(cython.int, 50_000)  # blocks until signals are looked at
_ORDER = cython.declare(cython.int, 19)
_LEADING = cython.declare(cython.int, 8)
_BLOCK = cython.declare(cython.int, 16)
_WHOLE = cython.declare(cython.int, 4)  # BLOCK is 2**4 steps
_OPEN = cython.declare(cython.int, 0)
_STICK = cython.declare(cython.int, 1)
_POSITIVE = cython.declare(cython.int, 2)


@cython.cclass
class March:
    """The motion from a state on: its `segments`, and `y` and `states` to which it has come."""

    def __init__(self, flows: Flows) -> None:
        self.flows = flows
        d, c = flows.size, flows.contacts
        e = 2 * c + 1
        self.y, self.states = np.zeros((1, d)), np.zeros((1, c), np.int8)
        self._here, self._there, self._terms = np.zeros((1, d)), np.zeros((1, d)), np.zeros((ORDER + 1, d))
        self._powers, self._work = np.zeros((ORDER + 1, e)), workspace()
        self._noise, self._floors, self._failed = np.zeros(d), np.zeros(e), np.zeros(e, np.int8)
        self._seen = np.zeros((BLOCK + 1) * 3 * e)
        self.segments = Segments(d, c)

    def begins(self, y: FloatArray, states: Any, duration: float, limit: int) -> None:
        """Set the state vector (d,), the contacts' states (contact,) and the time to march [s]."""
        np.asarray(self.y)[0], np.asarray(self.states)[0] = y, states
        self.duration, self.limit, self.time = duration, limit, 0.0
        self.segments = Segments(self.flows.size, self.flows.contacts, max(self.segments.count + 8, 16))
        self._passes, self._exit = 0, -1
        self._settled, self._fresh = False, True

    def go(self) -> int:
        """March on; returns why it has stopped."""
        stopped: cython.int
        if self.segments.count == self.segments.start.shape[0]:
            self.segments = self.segments.room(2 * self.segments.count)
        with cython.nogil:
            stopped = self._go()
        return int(stopped)

    def rate(self) -> float:
        """The rate of the present flow [1/s]."""
        return 1.0 / float(self.flows.step[self._slot])

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def _go(self) -> cython.int:
        stopped: cython.int
        blocks: cython.int = 0
        while True:
            if not self._settled:
                stopped = self._settle()
                if stopped:
                    return stopped
                if self.segments.count == self.segments.start.shape[0] or self.segments.count > self.limit:
                    return 2
                self._open_segment()
                if self._left > MOST_STEPS:
                    return 5
                if self._passed(0.0):
                    continue
            while not self._block():
                blocks += 1
                if blocks > PATIENCE:
                    return 4
            if self._exit < 0:
                return 0

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def _settle(self) -> cython.int:
        """Find the combination of states that lasts from y on."""
        i: cython.Py_ssize_t
        while self._passes < MOST_PASSES:
            self._slot = self.flows.find(self.states, 0)
            if self._slot < 0:
                return 1
            self.flows.refresh(self._slot)
            if self._fresh:
                self.flows.bound(self._slot, self.y, 0, self._noise)
                for i in range(self.flows.size):
                    self._noise[i] *= ROUNDING
                self._fresh = False
            for i in range(self.flows.size):
                self._terms[0, i] = self.y[0, i]
            self.flows.extend(self._slot, self._terms, 0, _LEADING - 1)
            self.flows.leave(self._slot, self._terms, 0, _LEADING - 1, self._powers)
            if not self._fails():
                self.flows.extend(self._slot, self._terms, _LEADING - 1, _ORDER)
                self.flows.leave(self._slot, self._terms, _LEADING, _ORDER, self._powers)
                return 0
            self._switch()
            for i in range(self.flows.size):
                self._noise[i] *= 2.0  # states that take turns differ by rounding that was underrated
            self._passes += 1
        return 3

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def _fails(self) -> cython.bint:
        """Mark the exits whose first coefficient beyond rounding is negative; set those before it to zero."""
        n: cython.Py_ssize_t = self.flows.linear
        e: cython.Py_ssize_t
        i: cython.Py_ssize_t
        j: cython.int
        zero: cython.double
        some: cython.bint = False
        for e in range(self.flows.exits[self._slot]):
            self._failed[e] = e == self._exit
            for j in range(_LEADING):
                zero = self.flows.rounding_forced[self._slot, j, e, 0] * self._noise[n]
                zero += self.flows.rounding_forced[self._slot, j, e, 1] * self._noise[n + 1]
                for i in range(n):
                    zero += self.flows.rounding[self._slot, j, e, i] * self._noise[i]
                if fabs(self._powers[j, e]) > zero:
                    if self._powers[j, e] < 0.0:
                        self._failed[e] = 1
                    break
                self._powers[j, e] = 0.0
            some = some or self._failed[e] != 0
        self._exit = -1
        return some

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def _switch(self) -> cython.void:
        """Let the contacts take their failed exits, and put the friction where the new state wants it."""
        j: cython.Py_ssize_t
        e: cython.Py_ssize_t
        wanted: cython.int
        goal: cython.int
        f: cython.Py_ssize_t = 2 * self.flows.modes
        load: cython.double
        for j in range(self.flows.contacts):
            wanted = -1
            for e in range(self.flows.exits[self._slot]):
                if self._failed[e] and self.flows.owner[self._slot, e] == j:
                    goal = self.flows.goal[self._slot, e]
                    # both limits of stick passed at once, or the load gone while slipping: the contact opens
                    wanted = goal if wanted < 0 or wanted == goal else _OPEN
            if wanted < 0:
                continue
            self.states[0, j] = wanted
            load = self.flows.mu[j] * (self.flows.n_0[j] + self.y[0, f + self.flows.contacts + j])
            if wanted == _OPEN:
                self.y[0, f + j] = 0.0
            elif wanted != _STICK:
                self.y[0, f + j] = load if wanted == _POSITIVE else -load

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def _open_segment(self) -> cython.void:
        """Note the segment that begins, and how deep its exits may be passed by rounding."""
        n: cython.Py_ssize_t = self.flows.linear
        i: cython.Py_ssize_t
        e: cython.Py_ssize_t
        j: cython.int
        k: cython.Py_ssize_t = self.segments.count
        size: cython.double
        self._settled, self._passes, self._base = True, 0, 0.0
        self._left = (self.duration - self.time) / self.flows.step[self._slot]
        self.segments.start[k] = self.time
        for j in range(self.flows.contacts):
            self.segments.states[k, j] = self.states[0, j]
        for i in range(self.flows.size):
            self.segments.y[k, i] = self._here[0, i] = self._there[0, i] = self.y[0, i]
        for e in range(self.flows.exits[self._slot]):
            self._floors[e] = 0.0
            self._failed[e] = 1  # all are to be inspected
            for j in range(3):
                size = self.flows.rounding_forced[self._slot, j, e, 0] * fabs(self.y[0, n])
                size += self.flows.rounding_forced[self._slot, j, e, 1] * fabs(self.y[0, n + 1])
                for i in range(n):
                    size += self.flows.rounding[self._slot, j, e, i] * fabs(self.y[0, i])
                self._floors[e] = max(self._floors[e], DEPTH * size)

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def _passed(self, before: cython.double) -> cython.bint:
        """Whether a marked exit is passed within the step whose Taylor terms are there; ends the segment."""
        e: cython.Py_ssize_t
        at: cython.double
        best: cython.double = 2.0
        for e in range(self.flows.exits[self._slot]):
            if self._failed[e]:
                at = first_descent(self._powers, e, self._floors[e], self._work)
                if 0.0 <= at < best:
                    best, self._exit = at, e
        if self._exit >= 0 and before + best <= self._left:
            self._finish(before + best, best)
            return True
        self._exit = -1
        return False

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def _block(self) -> cython.bint:
        """Look for an exit in the next BLOCK steps; whether the segment has ended."""
        k: cython.Py_ssize_t
        e: cython.Py_ssize_t
        whole: cython.int
        some: cython.bint
        exits: cython.Py_ssize_t = self.flows.exits[self._slot]
        self.flows.watch(self._slot, self._here, 0, self._seen)
        for e in range(exits):
            for k in range(_BLOCK + 1):
                self._floors[e] = max(self._floors[e], DEPTH * fabs(self._seen[3 * k * exits + e]))
        for k in range(_BLOCK):
            if self._base + k >= self._left:
                break
            some = False
            for e in range(exits):
                self._failed[e] = self._suspect(k, e)
                some = some or self._failed[e] != 0
            if some and self._base + k > 0.0:
                self._stand(k)
                self.flows.leave(self._slot, self._terms, 0, _ORDER, self._powers)
                if self._passed(self._base + k):
                    return True
        if self._base + _BLOCK >= self._left:
            whole = cython.cast(cython.int, self._left - self._base)
            self._stand(whole)
            self._finish(self._left, self._left - self._base - whole)
            return True
        self.flows.advance(self._slot, _WHOLE, self._here, 0)
        self._base += _BLOCK
        return False

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def _suspect(self, k: cython.Py_ssize_t, e: cython.Py_ssize_t) -> cython.bint:
        """Whether exit e may be passed in step k of the block.

        The least of the Bernstein coefficients of the cubic through g and g' at both ends bounds g from below
        but for h**4 / 384 times the greatest fourth derivative. A step is at most a radian of the fastest
        motion: inside it that derivative is no more than twice the greater of its ends'.
        """
        exits: cython.Py_ssize_t = self.flows.exits[self._slot]
        a: cython.Py_ssize_t = 3 * k * exits + e
        b: cython.Py_ssize_t = a + 3 * exits
        g: cython.double[::1] = self._seen
        low: cython.double = min(min(g[a], g[b]), min(g[a] + g[a + exits] / 3.0, g[b] - g[b + exits] / 3.0))
        return low - max(fabs(g[a + 2 * exits]), fabs(g[b + 2 * exits])) / 192.0 < -self._floors[e]

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def _stand(self, steps: cython.int) -> cython.void:
        """Take the Taylor coefficients after so many steps of the block."""
        i: cython.Py_ssize_t
        j: cython.int
        for i in range(self.flows.size):
            self._there[0, i] = self._here[0, i]
        for j in range(_WHOLE + 1):
            if steps >> j & 1:
                self.flows.advance(self._slot, j, self._there, 0)
        self.flows.taylor(self._slot, self._there, 0, self._terms)

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def _finish(self, position: cython.double, inside: cython.double) -> cython.void:
        """End the segment at a position, which is `inside` the step whose Taylor terms are there."""
        i: cython.Py_ssize_t
        summed(self._terms, inside, self.y, 0)
        self.flows.bound(self._slot, self._there, 0, self._noise)
        for i in range(self.flows.size):
            self._noise[i] *= ROUNDING
        self.segments.length[self.segments.count] = position
        self.segments.ended[self.segments.count] = self._exit
        self.time += position * self.flows.step[self._slot]
        self.segments.count += 1
        self._settled = False
