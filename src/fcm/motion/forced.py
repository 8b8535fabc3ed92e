"""The columns of the forces, the only ones of a flow that the frequency enters: made anew for each.

A column is what sin(theta) or cos(theta) = 1 alone at the start has done after a step, or after 2**j, and its
derivative by the frequency; likewise for the exits of a combination, on the steps of a block.
"""

from __future__ import annotations

import cython
import numpy as np
from cython.cimports.libc.math import cos, fabs, sin

from fcm.motion.pool import ORDER
from fcm.scene.model import FloatArray

if cython.compiled:
    from cython.cimports.fcm.motion.series import Series
else:
    from fcm.motion.series import Series

_ORDER = cython.declare(cython.int, 19)
NOTHING = cython.declare(cython.double, 1e-20)  # of the first term: those from there on are left out


@cython.cclass
class Forced(Series):
    """`refresh` makes the columns of a flow for the frequency `omega` [rad/s], for one step; see `Pool`.

    Those for more are made where they are needed, by `reach` and `look`.
    """

    def __init__(
        self,
        modal: tuple[FloatArray, ...],
        ports: tuple[FloatArray, ...],
        law: FloatArray,
        springs: tuple[FloatArray, ...],
    ) -> None:
        Series.__init__(self, modal, ports, law, springs)
        self._turned = np.zeros(ORDER)

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def refresh(self, slot: cython.Py_ssize_t) -> cython.void:
        """Make the columns of the forces for the frequency, unless they are."""
        self.clock += 1
        self.used[slot] = self.clock
        if self.made_for[slot] == self.omega:
            return
        e: cython.Py_ssize_t
        exits: cython.Py_ssize_t = self.exits[slot]
        b: cython.int
        w: cython.Py_ssize_t
        self._one_step(slot)
        self._sized(slot)
        self._angles(slot)
        for e in range(exits):
            w = e * (_ORDER + 1)
            self.spread[slot, e] = 0
            self._of_exit(slot, e, 1)
            self._of_exit(slot, e, 2)
            self._of_exit(slot, e, 4)
            for b in range(2):
                self.series_forced[slot, b, w] = self.table_forced[slot, b, e] = 0.0
                self.table_forced[slot, b, exits + e] = self.series_forced[slot, b, w + 1]
                self.table_forced[slot, b, 2 * exits + e] = 24.0 * self.series_forced[slot, b, w + 4]
        self.reached[slot] = self.looked[slot] = 0
        self.reach(slot, 0)
        self.made_for[slot] = self.omega

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def _one_step(self, slot: cython.Py_ssize_t) -> cython.void:
        """One step from sin(theta) = 1 or cos(theta) = 1 alone, and its derivative by omega.

        The j-th derivative of the forces by time grows as omega**j; what each does is known with the flow.
        """
        n: cython.Py_ssize_t = self.linear
        i: cython.Py_ssize_t
        j: cython.int
        h: cython.double = self.step[slot]
        x: cython.double = self.omega * h
        square: cython.double = self.omega * self.omega
        new: cython.double[:, ::1] = self.forced[slot, 0]
        first: cython.double
        other: cython.double
        grade: cython.double
        slope: cython.double
        rate: cython.double
        size: cython.double = 1.0
        power: cython.double = 1.0
        before: cython.double = 0.0
        for i in range(n):
            new[0, i] = new[1, i] = new[2, i] = new[3, i] = 0.0
        for j in range(_ORDER):
            slope, rate = j * before * h, 2.0 * self.omega * power
            for i in range(n):
                first = self.pushed[slot, 0, j, i] + square * self.pushed[slot, 2, j, i]
                other = self.pushed[slot, 1, j, i] + square * self.pushed[slot, 3, j, i]
                grade = slope * first + rate * self.pushed[slot, 2, j, i]
                new[j % 2, i] += power * first
                new[2 + j % 2, i] += grade
                grade = slope * other + rate * self.pushed[slot, 3, j, i]
                if j % 2:
                    new[0, i] -= power * other
                    new[2, i] -= grade
                else:
                    new[1, i] += power * other
                    new[3, i] += grade
            size *= x / (j + 1)
            if size < NOTHING * x:
                return
            before = power
            power *= -x if j % 2 else x
            if j % 2:
                before = -before

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def _sized(self, slot: cython.Py_ssize_t) -> cython.void:
        """The size of the first two terms of that step."""
        i: cython.Py_ssize_t
        x: cython.double = self.omega * self.step[slot]
        square: cython.double = self.omega * self.omega
        sine: cython.double
        cosine: cython.double
        for i in range(self.linear):
            sine = self.push[slot, 0, 0, i] + square * self.push[slot, 0, 2, i]
            cosine = self.push[slot, 0, 1, i] + square * self.push[slot, 0, 3, i]
            self.sizes_forced[slot, 0, i] = fabs(sine) + 0.5 * fabs(
                self.push[slot, 1, 0, i] + square * self.push[slot, 1, 2, i] - x * cosine
            )
            self.sizes_forced[slot, 1, i] = fabs(cosine) + 0.5 * fabs(
                self.push[slot, 1, 1, i] + square * self.push[slot, 1, 3, i] + x * sine
            )

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def _angles(self, slot: cython.Py_ssize_t) -> cython.void:
        """The powers of the angle of a step, with the signs of the derivatives of sin from sin = 0."""
        j: cython.int
        power: cython.double = 1.0
        x: cython.double = self.omega * self.step[slot]
        for j in range(_ORDER):
            self._turned[j] = power
            power *= -x if j % 2 else x

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def _of_exit(self, slot: cython.Py_ssize_t, e: cython.Py_ssize_t, a: cython.int) -> cython.void:
        """The Taylor coefficient a > 0 of an exit in that step."""
        k: cython.int
        j: cython.int
        square: cython.double = self.omega * self.omega
        first: cython.double
        other: cython.double
        sine: cython.double = 0.0
        cosine: cython.double = 0.0
        total: cython.double = 1.0
        for k in range(a):
            total *= k + 1
            j = a - 1 - k
            first = self._turned[j] * (self.kick[slot, e, 0, k] + square * self.kick[slot, e, 2, k])
            other = self._turned[j] * (self.kick[slot, e, 1, k] + square * self.kick[slot, e, 3, k])
            if j % 2:
                sine, cosine = sine - other, cosine + first
            else:
                sine, cosine = sine + first, cosine + other
        self.series_forced[slot, 0, e * (_ORDER + 1) + a] = sine / total
        self.series_forced[slot, 1, e * (_ORDER + 1) + a] = cosine / total

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
    def reach(self, slot: cython.Py_ssize_t, last: cython.Py_ssize_t) -> cython.void:
        """Make the columns of the forces over 1, 2, 4 ... 2**last steps, those that are not made yet."""
        t: cython.double
        while self.reached[slot] <= last:
            if self.reached[slot] > 0:
                self._double(slot, self.reached[slot] - 1)
            t = self.omega * self.step[slot] * (1 << self.reached[slot])
            self.turn[slot, self.reached[slot], 0] = cos(t)
            self.turn[slot, self.reached[slot], 1] = sin(t)
            self.reached[slot] += 1

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def _double(self, slot: cython.Py_ssize_t, j: cython.Py_ssize_t) -> cython.void:
        """The columns over twice as many steps: C(2 t) = E C + C R, with the rotation R of the forces."""
        n: cython.Py_ssize_t = self.linear
        i: cython.Py_ssize_t
        p: cython.Py_ssize_t
        b: cython.int
        x: cython.double
        t: cython.double = self.step[slot] * (1 << j)
        c: cython.double = self.turn[slot, j, 0]
        s: cython.double = self.turn[slot, j, 1]
        old: cython.double[:, ::1] = self.forced[slot, j]
        new: cython.double[:, ::1] = self.forced[slot, j + 1]
        for i in range(n):
            new[0, i] = c * old[0, i] - s * old[1, i]
            new[1, i] = s * old[0, i] + c * old[1, i]
            new[2, i] = c * old[2, i] - s * old[3, i] - t * new[1, i]
            new[3, i] = s * old[2, i] + c * old[3, i] + t * new[0, i]
        for b in range(4):
            for p in range(n):
                x = old[b, p]
                for i in range(n):
                    new[b, i] += self.power[slot, j, p, i] * x

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def look(self, slot: cython.Py_ssize_t, steps: cython.Py_ssize_t) -> cython.void:
        """Make the columns of the table of exits up to so many steps, those that are not made yet.

        T[k + 1] = T[k] exp(A h).
        """
        g: cython.Py_ssize_t = 3 * self.exits[slot]
        begin: cython.Py_ssize_t = self.looked[slot] * g
        end: cython.Py_ssize_t = steps * g
        w: cython.Py_ssize_t
        i: cython.Py_ssize_t
        b: cython.int
        x: cython.double
        c: cython.double = self.turn[slot, 0, 0]
        s: cython.double = self.turn[slot, 0, 1]
        if begin >= end:
            return
        for b in range(2):
            for w in range(begin + g, end + g):
                self.table_forced[slot, b, w] = 0.0
            for i in range(self.linear):
                x = self.forced[slot, 0, b, i]
                for w in range(begin, end):
                    self.table_forced[slot, b, w + g] += self.table[slot, i, w] * x
        for w in range(begin, end):
            self.table_forced[slot, 0, w + g] += (
                c * self.table_forced[slot, 0, w] - s * self.table_forced[slot, 1, w]
            )
            self.table_forced[slot, 1, w + g] += (
                s * self.table_forced[slot, 0, w] + c * self.table_forced[slot, 1, w]
            )
        self.looked[slot] = steps
