"""From transition to transition: a combination of states ends (`lookout`), another follows (`successor`)."""

from __future__ import annotations

import cython
import numpy as np
from cython.cimports.libc.math import cos, fabs, isfinite, sin

from fcm.time_domain.stop_reason import Stopped

if cython.compiled:
    from cython.cimports.fcm.time_domain.event_detection import Lookout
    from cython.cimports.fcm.time_domain.flow import Flows
    from cython.cimports.fcm.time_domain.next_states import Successor
    from cython.cimports.fcm.time_domain.segments import Segments
else:
    from fcm.time_domain.event_detection import Lookout
    from fcm.time_domain.flow import Flows
    from fcm.time_domain.next_states import Successor
    from fcm.time_domain.segments import Segments

_DONE = cython.declare(cython.int, Stopped.DONE)  # as the loops know it, which have numbers alone
_FULL = cython.declare(cython.int, Stopped.FULL)
_PAUSED = cython.declare(cython.int, Stopped.PAUSED)
_LONG = cython.declare(cython.int, Stopped.LONG)
MOST_STEPS = cython.declare(cython.double, 2e8)  # in one segment
PATIENCE = cython.declare(cython.int, 50_000)  # blocks until signals are looked at
_SEPARATED = cython.declare(cython.int, 0)
_STICKING = cython.declare(cython.int, 1)
_POSITIVE_SLIP = cython.declare(cython.int, 2)
_NEGATIVE_SLIP = cython.declare(cython.int, 3)


@cython.cclass
class March:
    """The motion from a state on: its `segments`, and `y` and `states` to which it has come."""

    def __init__(self, flows: Flows) -> None:
        self.flows, self._ahead = flows, Lookout(flows)
        d, c = flows.size, flows.contacts
        self.y, self.states = np.zeros((1, d)), np.zeros((1, c), np.int8)
        self._next, self.segments = Successor(self._ahead, self.y, self.states), Segments(d, c)

    def begins(self, y: cython.double[::1], states: cython.schar[::1], duration: float, limit: int) -> None:
        """Set the state vector (d,), the contacts' states (contact,) and the time to march [s]."""
        i: cython.Py_ssize_t
        for i in range(self.flows.size):
            self.y[0, i] = y[i]
        for i in range(self.flows.contacts):
            self.states[0, i] = states[i]
        self.lasts(duration, limit)

    def enters(self, x: cython.double[::1], angle: cython.double, level: cython.double) -> bool:
        """Set y and states from x = (q, q', f), the forces' angle and level; f is brought into its limits.

        Whether all of these numbers are finite.
        """
        m: cython.Py_ssize_t = self.flows.modes
        c: cython.Py_ssize_t = self.flows.contacts
        n: cython.Py_ssize_t = self.flows.linear
        i: cython.Py_ssize_t
        j: cython.Py_ssize_t
        h: cython.Py_ssize_t
        change: cython.double
        finite: cython.bint = isfinite(angle) and isfinite(level)
        for i in range(2 * m + c):
            self.y[0, i] = x[i]
            finite = finite and isfinite(x[i])
        for j in range(c):
            change = 0.0
            for i in range(m):
                change += self.flows.normal[j, i] * x[i]
            self.y[0, 2 * m + c + j] = self.flows.k_v[j] * change
        self.y[0, n - 1] = 1.0
        for h in range(self.flows.waves):
            self.y[0, n + 2 * h] = level * sin(self.flows.harmonic[h] * angle)
            self.y[0, n + 2 * h + 1] = level * cos(self.flows.harmonic[h] * angle)
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
            self.y[0, f], self.states[0, j] = 0.0, _SEPARATED
        elif not self.flows.rough[j]:
            self.y[0, f], self.states[0, j] = 0.0, _STICKING
        elif fabs(self.y[0, f]) <= limit:
            self.states[0, j] = _STICKING
        else:
            self.states[0, j] = _POSITIVE_SLIP if self.y[0, f] > 0.0 else _NEGATIVE_SLIP
            self.y[0, f] = limit if self.y[0, f] > 0.0 else -limit

    def lasts(self, duration: float, limit: int) -> None:
        """Set the time to march [s] from y and states as they stand."""
        self.duration, self.limit, self.time = duration, limit, 0.0
        self.segments = Segments(self.flows.size, self.flows.contacts, max(self.segments.count + 8, 16))
        self._next.begins()
        self._settled = False

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
    @cython.exceptval(-1, check=False)
    def _go(self) -> cython.int:
        stopped: cython.int
        ended: cython.bint
        blocks: cython.int = 0
        while True:
            ended = False
            if not self._settled:
                stopped = self._next.settle()
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
    def _open_segment(self) -> cython.void:
        """Note the segment that begins."""
        i: cython.Py_ssize_t
        k: cython.Py_ssize_t = self.segments.count
        self._settled = True
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
        self._next.rounded(self._ahead.there)
        for i in range(self.flows.size):
            self.y[0, i] = self._ahead.there[0, i]
        self.flows.part(slot, self._ahead.inside, self.y, 0, 1)
        self.segments.length[k], self.segments.ended[k] = self._ahead.base, self._ahead.exit
        for i in range(self.flows.contacts):
            self.segments.slack[k, i] = self._ahead.slack[i]
        self.time += self._ahead.base * self.flows.step[slot]
        self.segments.count += 1
        self._settled = False
