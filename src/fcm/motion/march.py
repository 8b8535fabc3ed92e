"""From transition to transition: when a combination of states ends, and which one follows.

What follows is decided by the sign of the first derivative that does not vanish of each exit function, so
that coinciding transitions, grazing ones and contacts released at rest need no cases of their own. Up to
that derivative the motion is the same in the old and the new state, so that the answer is unique.
"""

from __future__ import annotations

import cython
import numpy as np
from cython.cimports.libc.math import fabs, isfinite

from fcm.motion.stopped import Stopped

if cython.compiled:
    from cython.cimports.fcm.motion.flow import Flows
    from cython.cimports.fcm.motion.lookout import Lookout
    from cython.cimports.fcm.motion.segments import Segments
else:
    from fcm.motion.flow import Flows
    from fcm.motion.lookout import Lookout
    from fcm.motion.segments import Segments

_DONE = cython.declare(cython.int, Stopped.DONE)  # as the loops know it, which have numbers alone
_MISSING = cython.declare(cython.int, Stopped.MISSING)
_FULL = cython.declare(cython.int, Stopped.FULL)
_UNDECIDED = cython.declare(cython.int, Stopped.UNDECIDED)
_PAUSED = cython.declare(cython.int, Stopped.PAUSED)
_LONG = cython.declare(cython.int, Stopped.LONG)
ROUNDING = cython.declare(cython.double, 3e-14)  # of a state after a step, relative to its terms
MOST_PASSES = cython.declare(cython.int, 100)  # until a combination of states agrees with itself
MOST_STEPS = cython.declare(cython.double, 2e8)  # in one segment
PATIENCE = cython.declare(cython.int, 50_000)  # blocks until signals are looked at
_ORDER = cython.declare(cython.int, 19)
_LEADING = cython.declare(cython.int, 8)  # derivatives of an exit that may tell which combination follows
_OPEN = cython.declare(cython.int, 0)
_STICK = cython.declare(cython.int, 1)
_POSITIVE = cython.declare(cython.int, 2)
_NEGATIVE = cython.declare(cython.int, 3)


@cython.cclass
class March:
    """The motion from a state on: its `segments`, and `y` and `states` to which it has come."""

    def __init__(self, flows: Flows) -> None:
        self.flows, self._ahead = flows, Lookout(flows)
        d, c = flows.size, flows.contacts
        self.y, self.states = np.zeros((1, d)), np.zeros((1, c), np.int8)
        self._noise, self._failed = np.zeros(d), np.zeros(2 * c + 1, np.int8)
        self.segments = Segments(d, c)

    def begins(self, y: cython.double[::1], states: cython.schar[::1], duration: float, limit: int) -> None:
        """Set the state vector (d,), the contacts' states (contact,) and the time to march [s]."""
        i: cython.Py_ssize_t
        for i in range(self.flows.size):
            self.y[0, i] = y[i]
        for i in range(self.flows.contacts):
            self.states[0, i] = states[i]
        self.lasts(duration, limit)

    def enters(self, x: cython.double[::1], sine: cython.double, cosine: cython.double) -> bool:
        """Set y and states from x = (q, q', f) and the phase of the forces; f is brought into its limits.

        Whether all of these numbers are finite.
        """
        m: cython.Py_ssize_t = self.flows.modes
        c: cython.Py_ssize_t = self.flows.contacts
        n: cython.Py_ssize_t = self.flows.linear
        i: cython.Py_ssize_t
        j: cython.Py_ssize_t
        change: cython.double
        finite: cython.bint = isfinite(sine) and isfinite(cosine)
        for i in range(2 * m + c):
            self.y[0, i] = x[i]
            finite = finite and isfinite(x[i])
        for j in range(c):
            change = 0.0
            for i in range(m):
                change += self.flows.normal[j, i] * x[i]
            self.y[0, 2 * m + c + j] = self.flows.k_v[j] * change
        self.y[0, n - 1], self.y[0, n], self.y[0, n + 1] = 1.0, sine, cosine
        for j in range(c):
            self._enter(j)
        return bool(finite)

    @cython.cfunc
    def _enter(self, j: cython.Py_ssize_t) -> cython.void:
        """The state of a contact by its load and its friction force."""
        f: cython.Py_ssize_t = 2 * self.flows.modes + j
        load: cython.double = self.flows.n_0[j] + self.y[0, f + self.flows.contacts]
        limit: cython.double = self.flows.mu[j] * load
        if load < 0.0 or (load == 0.0 and self.flows.k_v[j] == 0.0):
            self.y[0, f], self.states[0, j] = 0.0, _OPEN
        elif not self.flows.rough[j]:
            self.y[0, f], self.states[0, j] = 0.0, _STICK
        elif fabs(self.y[0, f]) <= limit:
            self.states[0, j] = _STICK
        else:
            self.states[0, j] = _POSITIVE if self.y[0, f] > 0.0 else _NEGATIVE
            self.y[0, f] = limit if self.y[0, f] > 0.0 else -limit

    def lasts(self, duration: float, limit: int) -> None:
        """Set the time to march [s] from y and states as they stand."""
        self.duration, self.limit, self.time = duration, limit, 0.0
        self.segments = Segments(self.flows.size, self.flows.contacts, max(self.segments.count + 8, 16))
        self._passes, self._ahead.exit = 0, -1
        self._settled, self._fresh = False, True

    def go(self) -> int:
        """March on; returns why it has stopped, a `Stopped`."""
        stopped: cython.int
        if self.segments.count == self.segments.start.shape[0]:
            self.segments = self.segments.room(2 * self.segments.count)
        with cython.nogil:
            stopped = self._go()
        return int(stopped)

    def rate(self) -> float:
        """The rate of the present flow [1/s]."""
        return 1.0 / float(self.flows.step[self._ahead.slot])

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def _go(self) -> cython.int:
        stopped: cython.int
        ended: cython.bint
        blocks: cython.int = 0
        while True:
            ended = False
            if not self._settled:
                stopped = self._settle()
                if stopped != _DONE:
                    return stopped
                if self.segments.count == self.segments.start.shape[0] or self.segments.count > self.limit:
                    return _FULL
                self._open_segment()
                if self._ahead.left > MOST_STEPS:
                    return _LONG
            while not ended:
                ended = self._ahead.block()
                blocks += 1
                if blocks > PATIENCE and not ended:
                    return _PAUSED
            self._close_segment()
            if self._ahead.exit < 0:
                return _DONE

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def _settle(self) -> cython.int:
        """Find the combination of states that lasts from y on; DONE when it is found."""
        i: cython.Py_ssize_t
        slot: cython.Py_ssize_t
        while self._passes < MOST_PASSES:
            slot = self.flows.find(self.states, 0)
            if slot < 0:
                return _MISSING
            self.flows.refresh(slot)
            self._ahead.slot = slot
            if self._fresh:
                self.flows.bound(slot, self.y, 0, self._noise)
                for i in range(self.flows.size):
                    self._noise[i] *= ROUNDING
                self._fresh = False
            if not self._fails(slot):
                return _DONE
            self._switch(slot)
            for i in range(self.flows.size):
                self._noise[i] *= 2.0  # states that take turns differ by rounding that was underrated
            self._passes += 1
        return _UNDECIDED

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def _fails(self, slot: cython.Py_ssize_t) -> cython.bint:
        """Mark the exits whose first coefficient beyond rounding is negative; set those before it to zero.

        The coefficients beyond the first are asked for only where that is rounding.
        """
        e: cython.Py_ssize_t
        i: cython.Py_ssize_t
        value: cython.double
        zero: cython.double
        some: cython.bint = False
        for e in range(self.flows.exits[slot]):
            value = zero = 0.0
            for i in range(self.flows.first[slot, e], self.flows.linear):
                value += self.flows.row[slot, e, i] * self.y[0, i]
                zero += fabs(self.flows.row[slot, e, i]) * self._noise[i]
            self._failed[e] = e == self._ahead.exit
            self._ahead.touched[e] = fabs(value) <= zero
            if self._ahead.touched[e]:
                self._descends(slot, e)
            elif value < 0.0:
                self._failed[e] = 1
            some = some or self._failed[e] != 0
        self._ahead.exit = -1
        return some

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def _descends(self, slot: cython.Py_ssize_t, e: cython.Py_ssize_t) -> cython.void:
        """Mark exit e, zero here, if the first of its further coefficients beyond rounding is negative."""
        powers: cython.double[:, ::1] = self._ahead.powers
        n: cython.Py_ssize_t = self.flows.linear
        i: cython.Py_ssize_t
        w: cython.Py_ssize_t
        j: cython.int
        zero: cython.double
        self.flows.leave(slot, e, self.y, 0, powers)
        powers[e, 0] = 0.0
        for j in range(1, _LEADING):
            w = e * (_ORDER + 1) + j
            zero = fabs(self.flows.series_forced[slot, 0, w]) * self._noise[n]
            zero += fabs(self.flows.series_forced[slot, 1, w]) * self._noise[n + 1]
            for i in range(n):
                zero += fabs(self.flows.series[slot, i, w]) * self._noise[i]
            if fabs(powers[e, j]) > zero:
                if powers[e, j] < 0.0:
                    self._failed[e] = 1
                return
            powers[e, j] = 0.0

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def _switch(self, slot: cython.Py_ssize_t) -> cython.void:
        """Let the contacts take their failed exits, and put the friction where the new state wants it."""
        j: cython.Py_ssize_t
        e: cython.Py_ssize_t
        wanted: cython.int
        goal: cython.int
        f: cython.Py_ssize_t = 2 * self.flows.modes
        load: cython.double
        for j in range(self.flows.contacts):
            wanted = -1
            for e in range(self.flows.exits[slot]):
                if self._failed[e] and self.flows.owner[slot, e] == j:
                    goal = self.flows.goal[slot, e]
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
        """Note the segment that begins."""
        i: cython.Py_ssize_t
        k: cython.Py_ssize_t = self.segments.count
        self._settled, self._passes = True, 0
        self.segments.start[k] = self.time
        for i in range(self.flows.contacts):
            self.segments.states[k, i] = self.states[0, i]
        for i in range(self.flows.size):
            self.segments.y[k, i] = self.y[0, i]
        self._ahead.begin(self.y, (self.duration - self.time) / self.flows.step[self._ahead.slot])

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def _close_segment(self) -> cython.void:
        """Note how the segment ends, and go there."""
        i: cython.Py_ssize_t
        k: cython.Py_ssize_t = self.segments.count
        slot: cython.Py_ssize_t = self._ahead.slot
        self.flows.bound(slot, self._ahead.there, 0, self._noise)
        for i in range(self.flows.size):
            self._noise[i] *= ROUNDING
            self.y[0, i] = self._ahead.there[0, i]
        self.flows.part(slot, self._ahead.inside, self.y, 0, 1)
        self.segments.length[k], self.segments.ended[k] = self._ahead.base, self._ahead.exit
        for i in range(self.flows.contacts):
            self.segments.slack[k, i] = self._ahead.slack[i]
        self.time += self._ahead.base * self.flows.step[slot]
        self.segments.count += 1
        self._settled = False
