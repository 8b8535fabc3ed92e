"""The first exit of a segment that is passed: none missed, and most steps not looked at one by one.

The exits are known on `BLOCK` steps at once; a cubic and a bound of what it leaves out say in which of these
steps one may be passed, and only there its power series is searched.
"""

from __future__ import annotations

import cython
import numpy as np
from cython.cimports.libc.math import fabs

from fcm.motion.first_descent import workspace
from fcm.motion.pool import BLOCK, ORDER

if cython.compiled:
    from cython.cimports.fcm.motion.first_descent import first_descent
    from cython.cimports.fcm.motion.flow import Flows
else:
    from fcm.motion.first_descent import first_descent
    from fcm.motion.flow import Flows

DEPTH = cython.declare(cython.double, 1e-13)  # an exit that is passed by less, relative to its size, is not
UNSEEN = cython.declare(cython.double, 1e300)  # bound of what no step has been looked at for
_ORDER = cython.declare(cython.int, 19)
_BLOCK = cython.declare(cython.int, 16)
_WHOLE = cython.declare(cython.int, 4)  # BLOCK is 2**4 steps


@cython.cclass
class Lookout:
    """Goes along the flow `slot` from its state `there`, with the exits' power series in `powers`.

    Where the segment ends, `there` is the state before the last part of a step, which is `inside`, at the
    position `base` + that part; `exit` is what ends it, or -1 where `left` steps have gone by. `slack` is a
    lower bound of the exits of each contact over the segment.
    """

    def __init__(self, flows: Flows) -> None:
        d, e = flows.size, 2 * flows.contacts + 1
        self.flows, self.slot, self.exit = flows, -1, -1
        self.base, self.left, self.inside = 0.0, 0.0, 0.0
        self.there, self.powers, self.slack = np.zeros((1, d)), np.zeros((e, ORDER + 1)), np.zeros(e)
        self._here, self._work = np.zeros((1, d)), workspace()
        self._floors, self._marked = np.zeros(e), np.zeros(e, np.int8)
        self._seen = np.zeros((BLOCK + 1) * 3 * e)

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def begin(self, y: cython.double[:, ::1], left: cython.double) -> cython.bint:
        """Begin a segment of at most so many steps at y, its powers known; whether its first step ends it."""
        n: cython.Py_ssize_t = self.flows.linear
        i: cython.Py_ssize_t
        e: cython.Py_ssize_t
        w: cython.Py_ssize_t
        j: cython.int
        size: cython.double
        self.base, self.left = 0.0, left
        for i in range(self.flows.size):
            self._here[0, i] = self.there[0, i] = y[0, i]
        for i in range(self.flows.contacts):
            self.slack[i] = UNSEEN
        for e in range(self.flows.exits[self.slot]):
            self._floors[e] = 0.0
            self._marked[e] = 1
            for j in range(3):
                w = e * (_ORDER + 1) + j
                size = fabs(self.flows.series_forced[self.slot, 0, w] * y[0, n])
                size += fabs(self.flows.series_forced[self.slot, 1, w] * y[0, n + 1])
                for i in range(n):
                    size += fabs(self.flows.series[self.slot, i, w] * y[0, i])
                self._floors[e] = max(self._floors[e], DEPTH * size)
        return self._passed(0.0)

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def block(self) -> cython.bint:
        """Look for an exit in the next BLOCK steps; whether the segment has ended."""
        k: cython.Py_ssize_t
        e: cython.Py_ssize_t
        whole: cython.int
        some: cython.bint
        exits: cython.Py_ssize_t = self.flows.exits[self.slot]
        self.flows.watch(self.slot, self._here, 0, self._seen)
        for e in range(exits):
            for k in range(_BLOCK + 1):
                self._floors[e] = max(self._floors[e], DEPTH * fabs(self._seen[3 * k * exits + e]))
        for k in range(_BLOCK):
            if self.base + k >= self.left:
                break
            some = False
            for e in range(exits):
                self._marked[e] = self._suspect(k, e)
                some = some or self._marked[e] != 0
            if some and self.base + k > 0.0:
                self._stand(k)
                self.flows.leave(self.slot, self.there, 0, self.powers)
                if self._passed(self.base + k):
                    return True
        if self.base + _BLOCK >= self.left:
            whole = cython.cast(cython.int, self.left - self.base)
            self._stand(whole)
            self.exit, self.inside, self.base = -1, self.left - self.base - whole, self.left
            return True
        self.flows.advance(self.slot, _WHOLE, self._here, 0)
        self.base += _BLOCK
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
        g: cython.double[::1] = self._seen
        low: cython.double = min(min(g[a], g[b]), min(g[a] + g[a + exits] / 3.0, g[b] - g[b + exits] / 3.0))
        low -= max(fabs(g[a + 2 * exits]), fabs(g[b + 2 * exits])) / 192.0
        self.slack[owner] = min(self.slack[owner], low)
        return low < -self._floors[e]

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def _stand(self, steps: cython.int) -> cython.void:
        """Go to so many steps from the start of the block."""
        i: cython.Py_ssize_t
        j: cython.int
        for i in range(self.flows.size):
            self.there[0, i] = self._here[0, i]
        for j in range(_WHOLE + 1):
            if steps >> j & 1:
                self.flows.advance(self.slot, j, self.there, 0)

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def _passed(self, before: cython.double) -> cython.bint:
        """Whether a marked exit is passed within the step whose powers are there; ends the segment."""
        e: cython.Py_ssize_t
        at: cython.double
        best: cython.double = 2.0
        self.exit = -1
        for e in range(self.flows.exits[self.slot]):
            if self._marked[e]:
                at = first_descent(self.powers, e, self._floors[e], self._work)
                if 0.0 <= at < best:
                    best, self.exit = at, e
        if self.exit >= 0 and before + best <= self.left:
            self.base, self.inside = before + best, best
            if before == 0.0:
                self._hold(best)
            return True
        self.exit = -1
        return False

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def _hold(self, x: cython.double) -> cython.void:
        """Bound the exits in a part of a step by their powers."""
        e: cython.Py_ssize_t
        j: cython.int
        fall: cython.double
        owner: cython.Py_ssize_t
        for e in range(self.flows.exits[self.slot]):
            fall = 0.0
            for j in range(_ORDER, 0, -1):
                fall = (fall + fabs(self.powers[e, j])) * x
            owner = self.flows.owner[self.slot, e]
            self.slack[owner] = min(self.slack[owner], self.powers[e, 0] - fall)
