"""The first exit of a segment that is passed: none missed, and most steps not looked at one by one.

The exits are known on up to `BLOCK` steps at once; a cubic and a bound of what it leaves out say in which of
these steps one may be passed, and only there its power series is searched.
"""

from __future__ import annotations

import cython
import numpy as np
from cython.cimports.libc.math import fabs

from fcm.time_domain.first_crossing import workspace
from fcm.time_domain.flow_cache import BLOCK, ORDER

if cython.compiled:
    from cython.cimports.fcm.time_domain.first_crossing import first_descent
    from cython.cimports.fcm.time_domain.flow import Flows
else:
    from fcm.time_domain.first_crossing import first_descent
    from fcm.time_domain.flow import Flows

DEPTH = cython.declare(cython.double, 1e-13)  # an exit that is passed by less, relative to its size, is not
UNSEEN = cython.declare(cython.double, 1e300)  # bound of what no step has been looked at for
_ORDER = cython.declare(cython.int, 19)
_FIRST = cython.declare(cython.int, 2)  # a segment's first look is at 2**2 steps, for many are short
_WHOLE = cython.declare(cython.int, 3)  # BLOCK is 2**3 steps


@cython.cclass
class Lookout:
    """Goes along the flow `slot`; of exits that are zero at its start, `touched`, the series are in `powers`.

    Where the segment ends, `there` is the state before the last part of a step, which is `inside`, at the
    position `base` + that part; `exit` is what ends it, or -1 where `left` steps have gone by. `slack` is a
    lower bound of the exits of each contact over the segment.
    """

    def __init__(self, flows: Flows) -> None:
        d, e = flows.size, 2 * flows.contacts + 1
        self.flows, self.slot, self.exit = flows, -1, -1
        self.base, self.left, self.inside = 0.0, 0.0, 0.0
        self.there, self.powers, self.slack = np.zeros((1, d)), np.zeros((e, ORDER + 1)), np.zeros(e)
        self.touched = np.zeros(e, np.int8)
        self._here, self._begun, self._work = np.zeros((1, d)), np.zeros((1, d)), workspace()
        self._floors, self._largest, self._marked = np.zeros(e), np.zeros(e), np.zeros(e, np.int8)
        self._seen = np.zeros((BLOCK + 1) * 3 * e)

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def begin(self, y: cython.double[:, ::1], left: cython.double) -> cython.void:
        """Begin a segment of at most so many steps at y, the powers of the exits touched there known."""
        i: cython.Py_ssize_t
        e: cython.Py_ssize_t
        self.base, self.left, self._doubled = 0.0, left, _FIRST
        for i in range(self.flows.size):
            self._here[0, i] = self._begun[0, i] = y[0, i]
        for i in range(self.flows.contacts):
            self.slack[i] = UNSEEN
        for e in range(self.flows.exits[self.slot]):
            self._floors[e], self._largest[e] = -1.0, 0.0

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(-1, check=False)
    def block(self) -> cython.bint:
        """Look for an exit in the next steps, more of them each time; whether the segment has ended."""
        k: cython.Py_ssize_t
        e: cython.Py_ssize_t
        whole: cython.int
        some: cython.bint
        exits: cython.Py_ssize_t = self.flows.exits[self.slot]
        steps: cython.Py_ssize_t = cython.cast(cython.Py_ssize_t, 1) << self._doubled
        self.flows.watch(self.slot, self._here, 0, steps, self._seen)
        for k in range(steps):
            if self.base + k >= self.left:
                break
            some = False
            for e in range(exits):
                self._marked[e] = self._suspect(k, e) or (self.base + k == 0.0 and self.touched[e])
                some = some or self._marked[e] != 0
            if some:
                self._stand(k)
                if self._passed(self.base + k):
                    return True
        if self.base + steps >= self.left:
            whole = cython.cast(cython.int, self.left - self.base)
            self._stand(whole)
            self.exit, self.inside, self.base = -1, self.left - self.base - whole, self.left
            return True
        self.flows.advance(self.slot, self._doubled, self._here, 0)
        self.base += steps
        self._doubled = min(self._doubled + 1, _WHOLE)
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
        exits: cython.Py_ssize_t = self.flows.exits[self.slot]
        owner: cython.Py_ssize_t = self.flows.owner[self.slot, e]
        a: cython.Py_ssize_t = 3 * k * exits + e
        b: cython.Py_ssize_t = a + 3 * exits
        first: cython.double = self._seen[a]
        last: cython.double = self._seen[b]
        low: cython.double = min(
            min(first, last), min(first + self._seen[a + exits] / 3.0, last - self._seen[b + exits] / 3.0)
        )
        low -= max(fabs(self._seen[a + 2 * exits]), fabs(self._seen[b + 2 * exits])) / 192.0
        self.slack[owner] = min(self.slack[owner], low)
        self._largest[e] = max(self._largest[e], fabs(first))
        return low < 0.0 and low < -self._floor(e)

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def _floor(self, e: cython.Py_ssize_t) -> cython.double:
        """The depth of exit e that is rounding: of its size in this segment, so far."""
        n: cython.Py_ssize_t = self.flows.linear
        i: cython.Py_ssize_t
        w: cython.Py_ssize_t
        b: cython.Py_ssize_t
        j: cython.int
        size: cython.double
        if self._floors[e] < 0.0:
            for j in range(3):
                w = e * (_ORDER + 1) + j
                size = 0.0
                for b in range(2 * self.flows.waves):
                    size += fabs(self.flows.series_forced[self.slot, b, w] * self._begun[0, n + b])
                for i in range(n):
                    size += fabs(self.flows.series[self.slot, i, w] * self._begun[0, i])
                self._floors[e] = max(self._floors[e], DEPTH * size)
        return max(self._floors[e], DEPTH * self._largest[e])

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(-1, check=False)
    def _stand(self, steps: cython.int) -> cython.int:
        """Go to so many steps from the start of the block."""
        i: cython.Py_ssize_t
        j: cython.int
        for i in range(self.flows.size):
            self.there[0, i] = self._here[0, i]
        for j in range(_WHOLE + 1):
            if steps >> j & 1:
                self.flows.advance(self.slot, j, self.there, 0)
        return 0

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def _passed(self, before: cython.double) -> cython.bint:
        """Whether a marked exit is passed in the step from there, as many before it; ends the segment."""
        e: cython.Py_ssize_t
        at: cython.double
        best: cython.double = 2.0
        self.exit = -1
        for e in range(self.flows.exits[self.slot]):
            if self._marked[e]:
                if before > 0.0 or not self.touched[e]:
                    self.flows.leave(self.slot, e, self.there, 0, self.powers)
                at = first_descent(self.powers, e, self._floor(e), self._work)
                if 0.0 <= at < best:
                    best, self.exit = at, e
        if self.exit >= 0 and before + best <= self.left:
            self.base, self.inside = before + best, best
            return True
        self.exit = -1
        return False
