"""The extremes of any rows of the state vector over a motion: roots of their velocities.

Of the steps only those are expanded that may hold one: where the velocity changes its sign from end to end,
or has an extreme of its own between ends of one sign and beyond zero; and where that may be beyond the values
at the ends of many steps, which are looked at before.

The rows are those of numbers with which the state vector is multiplied, of which most are zeros (`Rows`).
"""

from __future__ import annotations

import cython
import numpy as np
from cython.cimports.libc.math import fabs

from fcm.model.scene import FloatArray
from fcm.time_domain.segment_walk import SPAN
from fcm.time_domain.segments import ORDER

if cython.compiled:
    from cython.cimports.fcm.time_domain.flow import Flows, root, value
    from cython.cimports.fcm.time_domain.segment_walk import Walk
    from cython.cimports.fcm.time_domain.segments import Segments
else:
    from fcm.time_domain.flow import Flows, root, value
    from fcm.time_domain.segment_walk import Walk
    from fcm.time_domain.segments import Segments


@cython.cclass
class Rows:
    """Rows (row, linear) without their zeros, of the state vector without the forces' phases."""

    def __init__(self, rows: FloatArray) -> None:
        places = np.nonzero(rows)
        self.count, self.dense = rows.shape[0], np.ascontiguousarray(rows.T)
        self.entry, self.column = rows[places], places[1].copy()
        self.first = np.searchsorted(places[0], np.arange(self.count + 1))
        self.used = np.unique(places[1])

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def dot(self, r: cython.Py_ssize_t, y: cython.double[:, ::1], k: cython.Py_ssize_t) -> cython.double:
        """Of row r with row k of y."""
        i: cython.Py_ssize_t
        total: cython.double = 0.0
        other: cython.double = 0.0  # two sums, for one would wait for each addition
        first: cython.Py_ssize_t = self.first[r]
        half: cython.Py_ssize_t = (self.first[r + 1] - first) // 2
        for i in range(first, first + half):
            total += self.entry[i] * y[k, self.column[i]]
            other += self.entry[half + i] * y[k, self.column[half + i]]
        for i in range(first + 2 * half, self.first[r + 1]):
            total += self.entry[i] * y[k, self.column[i]]
        return total + other

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def all(
        self,
        y: cython.double[:, ::1],
        k: cython.Py_ssize_t,
        out: cython.double[:, ::1],
        b: cython.Py_ssize_t,
    ) -> cython.void:
        """Of all rows with row k of y, into row b of out."""
        p: cython.Py_ssize_t
        r: cython.Py_ssize_t
        i: cython.Py_ssize_t
        x: cython.double
        for r in range(self.count):
            out[b, r] = 0.0
        for p in range(self.used.shape[0]):
            i = self.used[p]
            x = y[k, i]
            for r in range(self.count):
                out[b, r] += self.dense[i, r] * x


LARGEST = cython.declare(cython.double, 1.7976931348623157e308)  # beyond every value
_ORDER = cython.declare(cython.int, 19)
_SPAN = cython.declare(cython.int, 128)


@cython.cclass
class Scan(Walk):
    """`greatest` and `least` (row,), the extremes of rows @ y.

    `place` (2 rows, 2) is where they are: segment and position of all the least, then of the greatest.
    """

    def __init__(self, flows: Flows, rows: Rows) -> None:
        Walk.__init__(self, flows)
        self._rows = rows
        self.greatest, self.least = np.zeros(rows.count), np.zeros(rows.count)
        self.place, self._powers = np.zeros((2 * rows.count, 2)), np.zeros(ORDER + 1)
        self._there, self._terms = np.zeros((3, flows.size)), np.zeros((ORDER + 1, flows.size))
        self._path = self.ahead if self.span else np.zeros((SPAN + 1, flows.size))
        self._values = np.zeros((2, SPAN + 1, rows.count))
        self._first, self._length = 0.0, 0.0

    def begins(self, segments: Segments) -> None:
        """Stand before the first segment, with no extreme so far."""
        r: cython.Py_ssize_t
        Walk.begins(self, segments)
        for r in range(self._rows.count):
            self.greatest[r], self.least[r] = -LARGEST, LARGEST

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(-1, check=False)
    def visit(self, slot: cython.Py_ssize_t) -> cython.int:
        """Some steps after the other: the greatest and least of their ends, and then what is beyond these."""
        left: cython.double = self.segments.length[self.at]
        i: cython.Py_ssize_t
        k: cython.Py_ssize_t
        count: cython.Py_ssize_t
        self._first = 0.0
        for i in range(self.flows.size):
            self._path[0, i] = self.segments.y[self.at, i]
        while left > 0.0:
            count = self._steps(slot, left)
            self._note_ends(count, min(left - (count - 1), 1.0))
            for k in range(count):
                self._length = min(left - k, 1.0)
                self._step(slot, k)
            for i in range(self.flows.size):
                self._path[0, i] = self._path[count, i]
            self._first += count
            left -= count
        return 0

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(-1, check=False)
    def _steps(self, slot: cython.Py_ssize_t, left: cython.double) -> cython.Py_ssize_t:
        """Make the next of the steps that are left, and what is looked at there; how many they are."""
        i: cython.Py_ssize_t
        count: cython.Py_ssize_t = 0
        if self.span > 0 and left >= self.span:
            with cython.gil:
                self.reach(slot)
                self.values(slot)
            return self.span
        self._rows_at(slot, 0)
        while count < _SPAN and left > 0.0:
            for i in range(self.flows.size):
                self._path[count + 1, i] = self._path[count, i]
            count += 1
            if left >= 1.0:
                self.flows.advance(slot, 0, self._path, count)
            else:
                self.flows.part(slot, left, self._path, count, count + 1)
            self._rows_at(slot, count)
            left -= 1.0
        return count

    def values(self, slot: cython.Py_ssize_t) -> None:
        """Displacements and velocities that the state vectors `ahead` have."""
        n: cython.Py_ssize_t = self.flows.linear
        rows, y = np.asarray(self._rows.dense), np.asarray(self.ahead)
        out, forces = np.asarray(self._values), np.zeros((2 * self.flows.waves, 2, self.flows.size))
        for b in range(2 * self.flows.waves):
            forces[b, 0, n + b] = 1.0
            self.flows.extend(slot, forces[b], 1, self.flows.step[slot], forces[b], False)
        term = np.asarray(self.flows.terms)[slot, 1].reshape(n, n)
        np.matmul(y[:, :n], rows, out=out[0])
        np.matmul(y, np.vstack((term @ rows, forces[:, 1, :n] @ rows)), out=out[1])

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def _rows_at(self, slot: cython.Py_ssize_t, k: cython.Py_ssize_t) -> cython.void:
        """The rows where step k begins, and their slopes by the position."""
        self._spread(slot, k, 1)
        self._rows.all(self._there, 0, self._values[0], k)
        self._rows.all(self._there, 1, self._values[1], k)

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def _spread(self, slot: cython.Py_ssize_t, k: cython.Py_ssize_t, last: cython.Py_ssize_t) -> cython.void:
        """The Taylor coefficients by the position where step k begins, up to the last."""
        i: cython.Py_ssize_t
        for i in range(self.flows.size):
            self._there[0, i] = self._path[k, i]
        self.flows.extend(slot, self._there, last, self.flows.step[slot], self._there, False)

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def _note_ends(self, count: cython.Py_ssize_t, last: cython.double) -> cython.void:
        """Take the values at the ends of so many steps, the last one of that length."""
        k: cython.Py_ssize_t
        r: cython.Py_ssize_t
        for k in range(count + 1):
            for r in range(self.greatest.shape[0]):
                self._note(r, k if k < count else k - 1 + last, self._values[0, k, r])

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def _step(self, slot: cython.Py_ssize_t, k: cython.Py_ssize_t) -> cython.void:
        """Over step k."""
        r: cython.Py_ssize_t
        expanded: cython.bint = False
        for r in range(self.greatest.shape[0]):
            if self._may_exceed(r, k) and self._has_extreme(slot, r, k):
                if not expanded:
                    self.flows.taylor(slot, self._path, k, self._terms)
                    expanded = True
                self._extremes(r, k)

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def _may_exceed(self, r: cython.Py_ssize_t, k: cython.Py_ssize_t) -> cython.bint:
        """Whether step k may go beyond the extremes so far, by the slopes at its ends.

        A step is a part of the fastest motion in which no slope grows to more than twice those at its ends:
        what rises and falls by no more goes no further from the middle of its ends than it.
        """
        middle: cython.double = 0.5 * (self._values[0, k, r] + self._values[0, k + 1, r])
        reach: cython.double = max(fabs(self._values[1, k, r]), fabs(self._values[1, k + 1, r]))
        return middle + reach > self.greatest[r] or middle - reach < self.least[r]

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def _has_extreme(
        self, slot: cython.Py_ssize_t, r: cython.Py_ssize_t, k: cython.Py_ssize_t
    ) -> cython.bint:
        """Whether step k may hold an extreme of its own."""
        first: cython.double = self._values[1, k, r]
        bend: cython.double
        if first * self._values[1, k + 1, r] < 0.0:
            return True
        self._spread(slot, k, 2)
        bend = self._rows.dot(r, self._there, 2)
        if bend * first >= 0.0:
            return False
        self._spread(slot, k + 1, 2)
        return bend * self._rows.dot(r, self._there, 2) < 0.0

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def _extremes(self, r: cython.Py_ssize_t, k: cython.Py_ssize_t) -> cython.void:
        """Those of row r in step k, whose terms are there."""
        first: cython.double = self._values[1, k, r]
        j: cython.int
        inflection: cython.double
        for j in range(_ORDER + 1):
            self._powers[j] = self._rows.dot(r, self._terms, j)
        if first * self._values[1, k + 1, r] < 0.0:
            self._extreme_between(r, k, 0.0, self._length)
            return
        inflection = root(self._powers, 2, 0.0, self._length)
        if value(self._powers, 1, inflection) * first < 0.0:
            self._extreme_between(r, k, 0.0, inflection)
            self._extreme_between(r, k, inflection, self._length)

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def _extreme_between(
        self, r: cython.Py_ssize_t, k: cython.Py_ssize_t, low: cython.double, high: cython.double
    ) -> cython.void:
        """Take the value where the velocity changes its sign in step k."""
        x: cython.double = root(self._powers, 1, low, high)
        self._note(r, k + x, value(self._powers, 0, x))

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def _note(self, r: cython.Py_ssize_t, x: cython.double, here: cython.double) -> cython.void:
        """Take a value, x steps from the first of those that are looked at, if it is an extreme so far."""
        if here > self.greatest[r]:
            self.greatest[r] = here
            self._put(self._rows.count + r, x)
        if here < self.least[r]:
            self.least[r] = here
            self._put(r, x)

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def _put(self, k: cython.Py_ssize_t, x: cython.double) -> cython.void:
        """Take x for a place."""
        self.place[k, 0], self.place[k, 1] = self.at, self._first + x
