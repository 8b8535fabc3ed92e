"""The extremes of any rows of the state vector over a motion: roots of their velocities.

Of the steps only those are expanded that may hold one: where the velocity changes its sign from end to end,
or has an extreme of its own between ends of one sign and beyond zero.
"""

from __future__ import annotations

import cython
import numpy as np
from cython.cimports.libc.math import fabs

from fcm.motion.pool import ORDER

if cython.compiled:
    from cython.cimports.fcm.motion.flow import Flows
    from cython.cimports.fcm.motion.polynomial import root, value
    from cython.cimports.fcm.motion.rows import Rows
    from cython.cimports.fcm.motion.segments import Segments
    from cython.cimports.fcm.motion.walk import Walk
else:
    from fcm.motion.flow import Flows
    from fcm.motion.polynomial import root, value
    from fcm.motion.rows import Rows
    from fcm.motion.segments import Segments
    from fcm.motion.walk import Walk

LARGEST = cython.declare(cython.double, 1.7976931348623157e308)  # beyond every value
_ORDER = cython.declare(cython.int, 19)


@cython.cclass
class Scan(Walk):
    """`greatest` and `least` (row,), the extremes of rows @ y.

    `place` (row, 4) is where they are: segment and position of the greatest, and of the least.
    """

    def __init__(self, flows: Flows, rows: Rows) -> None:
        Walk.__init__(self, flows)
        self._rows = rows
        self.greatest, self.least = np.zeros(rows.count), np.zeros(rows.count)
        self.place, self._powers = np.zeros((rows.count, 4)), np.zeros(ORDER + 1)
        self._there, self._terms = np.zeros((4, flows.size)), np.zeros((ORDER + 1, flows.size))
        self._old, self._new = np.zeros((3, rows.count)), np.zeros((3, rows.count))
        self._values = np.zeros((3, self.span + 1, rows.count))
        self._first, self._length = 0.0, 0.0

    def begins(self, segments: Segments) -> None:
        """Stand before the first segment, with no extreme so far."""
        r: cython.Py_ssize_t
        Walk.begins(self, segments)
        for r in range(self._rows.count):
            self.greatest[r], self.least[r] = -LARGEST, LARGEST

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def visit(self, slot: cython.Py_ssize_t) -> cython.void:
        """Step by step."""
        left: cython.double = self.segments.length[self.at]
        i: cython.Py_ssize_t
        r: cython.Py_ssize_t
        self._first = 0.0
        for i in range(self.flows.size):
            self._there[0, i] = self.segments.y[self.at, i]
        self._look(slot, self._old)
        for r in range(self.greatest.shape[0]):
            self._note(r, 0.0, self._old[0, r])
        while self.span > 0 and left >= self.span:
            self._span(slot)
            left -= self.span
        while left > 0.0:
            self._length = min(left, 1.0)
            for i in range(self.flows.size):
                self._there[3, i] = self._there[0, i]
            if self._length == 1.0:
                self.flows.advance(slot, 0, self._there, 0)
            else:
                self.flows.part(slot, self._length, self._there, 0, 1)
            self._look(slot, self._new)
            self._step(slot, self._there, 3)
            left -= 1.0

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def _span(self, slot: cython.Py_ssize_t) -> cython.void:
        """Over as many whole steps as `ahead` has."""
        i: cython.Py_ssize_t
        k: cython.Py_ssize_t
        r: cython.Py_ssize_t
        j: cython.int
        self._length = 1.0
        for i in range(self.flows.size):
            self.ahead[0, i] = self._there[0, i]
        with cython.gil:
            self.reach(slot)
            self.values(slot)
        for k in range(self.span):
            for j in range(3):
                for r in range(self._rows.count):
                    self._new[j, r] = self._values[j, k + 1, r]
            self._step(slot, self.ahead, k)
        for i in range(self.flows.size):
            self._there[0, i] = self.ahead[self.span, i]

    def values(self, slot: cython.Py_ssize_t) -> None:
        """What `_look` tells of the state vectors `ahead`."""
        n: cython.Py_ssize_t = self.flows.linear
        rows, y = np.asarray(self._rows.dense), np.asarray(self.ahead)
        out, forces = np.asarray(self._values), np.zeros((2, 3, self.flows.size))
        for b in range(2):
            forces[b, 0, n + b] = 1.0
            self.flows.extend(slot, forces[b], 2, self.flows.step[slot], forces[b], False)
        np.matmul(y[:, :n], rows, out=out[0])
        for j in (1, 2):
            term = np.asarray(self.flows.terms)[slot, j].reshape(n, n)
            by_state = np.vstack((term @ rows, forces[:, j, :n] @ rows))
            np.matmul(y, j * by_state, out=out[j])

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def _step(self, slot: cython.Py_ssize_t, y: cython.double[:, ::1], k: cython.Py_ssize_t) -> cython.void:
        """Over a step from row k of y, between what is old and what is new."""
        r: cython.Py_ssize_t
        i: cython.int
        expanded: cython.bint = False
        for r in range(self.greatest.shape[0]):
            if self._may_turn(r):
                if not expanded:
                    self.flows.taylor(slot, y, k, self._terms)
                    expanded = True
                self._extremes(r)
            self._note(r, self._length, self._new[0, r])
            for i in range(3):
                self._old[i, r] = self._new[i, r]
        self._first += 1.0

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def _look(self, slot: cython.Py_ssize_t, out: cython.double[:, ::1]) -> cython.void:
        """The rows at the place there, and their first two derivatives by the position."""
        r: cython.Py_ssize_t
        j: cython.int
        h: cython.double = self.flows.step[slot]
        self.flows.extend(slot, self._there, 2, h, self._there, False)
        for r in range(self.greatest.shape[0]):
            for j in range(3):
                out[j, r] = self._rows.dot(r, self._there, j)
            out[2, r] *= 2.0

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def _may_turn(self, r: cython.Py_ssize_t) -> cython.bint:
        """Whether the step may hold an extreme beyond those so far, by the slopes at its ends.

        A step is a part of the fastest motion in which no slope grows to more than twice those at its ends.
        """
        first: cython.double = self._old[1, r]
        last: cython.double = self._new[1, r]
        bend: cython.double = self._old[2, r]
        reach: cython.double
        if first * last >= 0.0 and (bend * first >= 0.0 or bend * self._new[2, r] >= 0.0):
            return False
        reach = 2.0 * max(fabs(first), fabs(last))
        high: cython.bint = max(self._old[0, r], self._new[0, r]) + reach > self.greatest[r]
        return high or min(self._old[0, r], self._new[0, r]) - reach < self.least[r]

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def _extremes(self, r: cython.Py_ssize_t) -> cython.void:
        """Those of row r in a step whose terms are there."""
        first: cython.double = self._old[1, r]
        j: cython.int
        turn: cython.double
        for j in range(_ORDER + 1):
            self._powers[j] = self._rows.dot(r, self._terms, j)
        if first * self._new[1, r] < 0.0:
            self._turn(r, 0.0, self._length)
            return
        turn = root(self._powers, 2, 0.0, self._length)
        if value(self._powers, 1, turn) * first < 0.0:
            self._turn(r, 0.0, turn)
            self._turn(r, turn, self._length)

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def _turn(self, r: cython.Py_ssize_t, low: cython.double, high: cython.double) -> cython.void:
        """Take the value where the velocity changes its sign."""
        x: cython.double = root(self._powers, 1, low, high)
        self._note(r, x, value(self._powers, 0, x))

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def _note(self, r: cython.Py_ssize_t, x: cython.double, here: cython.double) -> cython.void:
        """Take a value, at x, if it is an extreme so far."""
        if here > self.greatest[r]:
            self.greatest[r] = here
            self.place[r, 0], self.place[r, 1] = self.at, self._first + x
        if here < self.least[r]:
            self.least[r] = here
            self.place[r, 2], self.place[r, 3] = self.at, self._first + x
