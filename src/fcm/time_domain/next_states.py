"""Which combination of states follows where another ends, or lasts from the start of a motion.

That is decided by the sign of the first derivative that does not vanish of each exit function, so that
coinciding transitions, grazing ones and contacts released at rest need no cases of their own. Up to that
derivative the motion is the same in the old and the new state, so that the answer is unique.
"""

from __future__ import annotations

import cython
import numpy as np
import numpy.typing as npt
from cython.cimports.libc.math import fabs

from fcm.model.scene import FloatArray
from fcm.time_domain.stop_reason import Stopped

if cython.compiled:
    from cython.cimports.fcm.time_domain.event_detection import Lookout
else:
    from fcm.time_domain.event_detection import Lookout

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
    """Sets `states` (1, contact) to what lasts from `y` (1, d) on, and the lookout `ahead` to its flow."""

    def __init__(self, ahead: Lookout, y: FloatArray, states: npt.NDArray[np.int8]) -> None:
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
