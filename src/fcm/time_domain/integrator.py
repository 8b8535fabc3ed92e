"""From transition to transition: a combination of states ends, another follows (`Successor`).

Which one follows, or lasts from the start of a motion, is decided by the sign of the first derivative that
does not vanish of each exit function. So coinciding transitions, grazing ones and contacts released at rest
need no cases of their own. Up to that derivative the motion is the same in the old and the new state, so that
the answer is unique (`Successor`).
"""

from __future__ import annotations

import cython
import numpy as np
import numpy.typing as npt
from cython.cimports.libc.math import cos, fabs, isfinite, sin

from fcm.model.scene import FloatArray
from fcm.time_domain.stop_reason import Stopped

if cython.compiled:
    from cython.cimports.fcm.time_domain.event_detection import EventDetector
    from cython.cimports.fcm.time_domain.flow import Flows
    from cython.cimports.fcm.time_domain.segments import Segments
else:
    from fcm.time_domain.event_detection import EventDetector
    from fcm.time_domain.flow import Flows
    from fcm.time_domain.segments import Segments

_DONE = cython.declare(cython.int, Stopped.DONE)  # as the loops know it, which have numbers alone
_MISSING = cython.declare(cython.int, Stopped.MISSING)
_UNDECIDED = cython.declare(cython.int, Stopped.UNDECIDED)
ROUNDING = cython.declare(cython.double, 3e-14)  # of a state after a step, relative to its terms
MOST_PASSES = cython.declare(cython.int, 100)  # until a combination of states agrees with itself
_ORDER = cython.declare(cython.int, 19)
_LEADING = cython.declare(cython.int, 8)  # derivatives of an exit that may tell which combination follows
_SEPARATED = cython.declare(cython.int, 0)
_STICKING = cython.declare(cython.int, 1)
_POSITIVE_SLIP = cython.declare(cython.int, 2)


@cython.cclass
class Successor:
    """Sets `states` (1, contact) to what lasts from `y` (1, d) on, and the detector `ahead` to its flow."""

    def __init__(self, ahead: EventDetector, y: FloatArray, states: npt.NDArray[np.int8]) -> None:
        self.flows, self.ahead, self.y, self.states = ahead.flows, ahead, y, states
        self._noise, self._failed = (
            np.zeros(ahead.flows.size),
            np.zeros(2 * ahead.flows.contacts + 1, np.int8),
        )
        self._passes, self._fresh = 0, True

    @cython.cfunc
    @cython.exceptval(check=False)
    def begins(self) -> cython.void:
        """Stand at the start of a motion: of its rounding nothing is known, and no exit has been passed."""
        self._passes, self._fresh, self.ahead.exit = 0, True, -1

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def rounded(self, y: cython.double[:, ::1]) -> cython.void:
        """Take the rounding of a state after a step of the present flow that begins at row 0 of y."""
        i: cython.Py_ssize_t
        self.flows.bound(self.ahead.slot, y, 0, self._noise)
        for i in range(self.flows.size):
            self._noise[i] *= ROUNDING

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(-1, check=False)
    def settle(self) -> cython.int:
        """Find the combination of states that lasts from y on; DONE when it is found."""
        i: cython.Py_ssize_t
        slot: cython.Py_ssize_t
        while self._passes < MOST_PASSES:
            slot = self.flows.find(self.states, 0)
            if slot < 0:
                return _MISSING
            self.flows.refresh(slot)
            self.ahead.slot = slot
            if self._fresh:
                self.rounded(self.y)
                self._fresh = False
            if not self._fails(slot):
                self._passes = 0
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
            self._failed[e] = e == self.ahead.exit
            self.ahead.touched[e] = fabs(value) <= zero
            if self.ahead.touched[e]:
                self._descends(slot, e)
            elif value < 0.0:
                self._failed[e] = 1
            some = some or self._failed[e] != 0
        self.ahead.exit = -1
        return some

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def _descends(self, slot: cython.Py_ssize_t, e: cython.Py_ssize_t) -> cython.void:
        """Mark exit e, zero here, if the first of its further coefficients beyond rounding is negative."""
        powers: cython.double[:, ::1] = self.ahead.powers
        n: cython.Py_ssize_t = self.flows.linear
        i: cython.Py_ssize_t
        w: cython.Py_ssize_t
        b: cython.Py_ssize_t
        j: cython.int
        zero: cython.double
        self.flows.leave(slot, e, self.y, 0, powers)
        powers[e, 0] = 0.0
        for j in range(1, _LEADING):
            w = e * (_ORDER + 1) + j
            zero = 0.0
            for b in range(2 * self.flows.waves):
                zero += fabs(self.flows.series_forced[slot, b, w]) * self._noise[n + b]
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
                    wanted = goal if wanted < 0 or wanted == goal else _SEPARATED
            if wanted < 0:
                continue
            self.states[0, j] = wanted
            load = self.flows.mu[j] * (self.flows.n_0[j] + self.y[0, f + self.flows.contacts + j])
            if wanted == _SEPARATED:
                self.y[0, f + j] = 0.0
            elif wanted != _STICKING:
                self.y[0, f + j] = load if wanted == _POSITIVE_SLIP else -load


_FULL = cython.declare(cython.int, Stopped.FULL)
_PAUSED = cython.declare(cython.int, Stopped.PAUSED)
_LONG = cython.declare(cython.int, Stopped.LONG)
MOST_STEPS = cython.declare(cython.double, 2e8)  # in one segment
PATIENCE = cython.declare(cython.int, 50_000)  # blocks until signals are looked at
_NEGATIVE_SLIP = cython.declare(cython.int, 3)


@cython.cclass
class March:
    """The motion from a state on: its `segments`, and `y` and `states` to which it has come."""

    def __init__(self, flows: Flows) -> None:
        self.flows, self._ahead = flows, EventDetector(flows)
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
