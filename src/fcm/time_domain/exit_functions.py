"""The exits of a combination: functions of the state vector that end it where they become negative.

Like the motion itself they are known by columns, of which the frequency enters only those of the forces: on
the steps of a block, and as power series in one step.
"""

from __future__ import annotations

import cython
import numpy as np

from fcm.time_domain.equations import Matrices
from fcm.time_domain.flow_cache import ORDER

if cython.compiled:
    from cython.cimports.fcm.time_domain.forcing import Forced
else:
    from fcm.time_domain.forcing import Forced

_ORDER = cython.declare(cython.int, 19)


@cython.cclass
class Exits(Forced):
    """`watch` tells the exits on the steps of a block, `leave` their series in a step; see `Pool`.

    What these need for a new frequency is made where it is needed, by `make_columns` and `expand`.
    """

    def __init__(self, matrices: Matrices) -> None:
        Forced.__init__(self, matrices)
        self._rotated = np.zeros((self.waves, ORDER))

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(-1, check=False)
    def refresh(self, slot: cython.Py_ssize_t) -> cython.int:
        """Make the columns of the forces for the frequency; of an exit the terms that tell most."""
        e: cython.Py_ssize_t
        exits: cython.Py_ssize_t = self.exits[slot]
        b: cython.int
        w: cython.Py_ssize_t
        made: cython.bint = self.made_for[slot] == self.omega
        Forced.refresh(self, slot)
        if made:
            return 0
        self._angles(slot)
        for e in range(exits):
            w = e * (_ORDER + 1)
            self.spread[slot, e] = 0
            self._of_exit(slot, e, 1)
            self._of_exit(slot, e, 2)
            self._of_exit(slot, e, 4)
            for b in range(2 * self.waves):
                self.series_forced[slot, b, w] = self.table_forced[slot, b, e] = 0.0
                self.table_forced[slot, b, exits + e] = self.series_forced[slot, b, w + 1]
                self.table_forced[slot, b, 2 * exits + e] = 24.0 * self.series_forced[slot, b, w + 4]
        self.watched[slot] = 0
        return 0

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def _angles(self, slot: cython.Py_ssize_t) -> cython.void:
        """The powers of each harmonic's angle of a step, signed as the derivatives of sin from sin = 0."""
        h: cython.Py_ssize_t
        j: cython.int
        power: cython.double
        x: cython.double
        for h in range(self.waves):
            power, x = 1.0, self.harmonic[h] * self.omega * self.step[slot]
            for j in range(_ORDER):
                self._rotated[h, j] = power
                power *= -x if j % 2 else x

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def _of_exit(self, slot: cython.Py_ssize_t, e: cython.Py_ssize_t, a: cython.int) -> cython.void:
        """The Taylor coefficient a > 0 of an exit in that step."""
        h: cython.Py_ssize_t
        b: cython.Py_ssize_t
        k: cython.int
        j: cython.int
        square: cython.double = self.omega * self.omega
        first: cython.double
        other: cython.double
        sine: cython.double
        cosine: cython.double
        total: cython.double = 1.0
        for k in range(a):
            total *= k + 1
        for h in range(self.waves):
            b, sine, cosine = 4 * h, 0.0, 0.0
            for k in range(a):
                j = a - 1 - k
                first = self.kick[slot, e, b, k] + square * self.kick[slot, e, b + 2, k]
                other = self.kick[slot, e, b + 1, k] + square * self.kick[slot, e, b + 3, k]
                first, other = self._rotated[h, j] * first, self._rotated[h, j] * other
                if j % 2:
                    sine, cosine = sine - other, cosine + first
                else:
                    sine, cosine = sine + first, cosine + other
            self.series_forced[slot, 2 * h, e * (_ORDER + 1) + a] = sine / total
            self.series_forced[slot, 2 * h + 1, e * (_ORDER + 1) + a] = cosine / total

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def expand(self, slot: cython.Py_ssize_t, e: cython.Py_ssize_t) -> cython.void:
        """Make all Taylor coefficients of an exit, unless they are."""
        a: cython.int
        if self.spread[slot, e]:
            return
        self._angles(slot)
        for a in range(1, _ORDER + 1):
            self._of_exit(slot, e, a)
        self.spread[slot, e] = 1

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def make_columns(self, slot: cython.Py_ssize_t, steps: cython.Py_ssize_t) -> cython.void:
        """Make the columns of the table of exits up to so many steps, those that are not made yet.

        T[k + 1] = T[k] exp(A h).
        """
        g: cython.Py_ssize_t = 3 * self.exits[slot]
        begin: cython.Py_ssize_t = self.watched[slot] * g
        end: cython.Py_ssize_t = steps * g
        w: cython.Py_ssize_t
        i: cython.Py_ssize_t
        b: cython.Py_ssize_t
        x: cython.double
        c: cython.double
        s: cython.double
        if begin >= end:
            return
        for b in range(2 * self.waves):
            for w in range(begin + g, end + g):
                self.table_forced[slot, b, w] = 0.0
            for i in range(self.linear):
                x = self.forced[slot, 0, b + b // 2 * 2, i]  # of four rows of a harmonic the first two
                for w in range(begin, end):
                    self.table_forced[slot, b, w + g] += self.table[slot, i, w] * x
        for b in range(0, 2 * self.waves, 2):
            c, s = self.rotation[slot, 0, b], self.rotation[slot, 0, b + 1]
            for w in range(begin, end):
                self.table_forced[slot, b, w + g] += (
                    c * self.table_forced[slot, b, w] - s * self.table_forced[slot, b + 1, w]
                )
                self.table_forced[slot, b + 1, w + g] += (
                    s * self.table_forced[slot, b, w] + c * self.table_forced[slot, b + 1, w]
                )
        self.watched[slot] = steps

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def watch(
        self,
        slot: cython.Py_ssize_t,
        y: cython.double[:, ::1],
        k: cython.Py_ssize_t,
        steps: cython.Py_ssize_t,
        seen: cython.double[::1],
    ) -> cython.void:
        """g, g' h and g'''' h**4 of the exits at 0 to `steps` <= BLOCK steps from row k of y."""
        wide: cython.Py_ssize_t = (steps + 1) * 3 * self.exits[slot]
        n: cython.Py_ssize_t = self.linear
        w: cython.Py_ssize_t
        i: cython.Py_ssize_t = 0
        a: cython.double
        b: cython.double
        c: cython.double
        d: cython.double
        h: cython.Py_ssize_t
        self.make_columns(slot, steps)
        for w in range(wide):
            seen[w] = 0.0
        for h in range(0, 2 * self.waves, 2):
            a, b = y[k, n + h], y[k, n + h + 1]
            for w in range(wide):
                seen[w] += self.table_forced[slot, h, w] * a + self.table_forced[slot, h + 1, w] * b
        while i + 4 <= n:
            a, b, c, d = y[k, i], y[k, i + 1], y[k, i + 2], y[k, i + 3]
            for w in range(wide):
                seen[w] = (
                    ((seen[w] + self.table[slot, i, w] * a) + self.table[slot, i + 1, w] * b)
                    + self.table[slot, i + 2, w] * c
                ) + self.table[slot, i + 3, w] * d
            i += 4
        while i < n:
            a = y[k, i]
            for w in range(wide):
                seen[w] += self.table[slot, i, w] * a
            i += 1

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def leave(
        self,
        slot: cython.Py_ssize_t,
        e: cython.Py_ssize_t,
        y: cython.double[:, ::1],
        k: cython.Py_ssize_t,
        powers: cython.double[:, ::1],
    ) -> cython.void:
        """Taylor coefficients (ORDER + 1,) of exit e in the step from row k of y, into its row."""
        n: cython.Py_ssize_t = self.linear
        w: cython.Py_ssize_t = e * (_ORDER + 1)
        i: cython.Py_ssize_t
        h: cython.Py_ssize_t
        j: cython.int
        x: cython.double
        other: cython.double
        self.expand(slot, e)
        for j in range(_ORDER + 1):
            powers[e, j] = 0.0
        for h in range(0, 2 * self.waves, 2):
            x, other = y[k, n + h], y[k, n + h + 1]
            for j in range(_ORDER + 1):
                powers[e, j] += (
                    self.series_forced[slot, h, w + j] * x + self.series_forced[slot, h + 1, w + j] * other
                )
        for i in range(n):
            x = y[k, i]
            if x != 0.0:
                for j in range(_ORDER + 1):
                    powers[e, j] += self.series[slot, i, w + j] * x
