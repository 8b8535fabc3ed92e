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
        self._terms, self._grades = np.zeros((ORDER + 1, self.size)), np.zeros((ORDER + 1, self.size))

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def refresh(self, slot: cython.Py_ssize_t) -> cython.void:
        """Make the columns of the forces for the frequency, unless they are."""
        self.clock += 1
        self.used[slot] = self.clock
        if self.made_for[slot] == self.omega:
            return
        b: cython.Py_ssize_t
        for b in range(2):
            self._unit(slot, b)
        self.reached[slot] = self.looked[slot] = 0
        self.reach(slot, 0)
        self.made_for[slot] = self.omega

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def _unit(self, slot: cython.Py_ssize_t, b: cython.Py_ssize_t) -> cython.void:
        """One step from sin(theta) = 1 (b = 0) or cos(theta) = 1 alone, and its derivative by omega."""
        n: cython.Py_ssize_t = self.linear
        i: cython.Py_ssize_t
        j: cython.int
        for i in range(self.size):
            self._terms[0, i] = self._grades[0, i] = 0.0
        self._terms[0, n + b] = 1.0
        self.extend(slot, self._terms, _ORDER, self.step[slot], self._terms, False)
        self.extend(slot, self._grades, _ORDER, self.step[slot], self._terms, True)
        for i in range(n):
            self.forced[slot, 0, b, i] = self.forced[slot, 0, 2 + b, i] = 0.0
            self.sizes_forced[slot, b, i] = fabs(self._terms[1, i]) + fabs(self._terms[2, i])
        for j in range(_ORDER, 0, -1):
            for i in range(n):
                self.forced[slot, 0, b, i] += self._terms[j, i]
                self.forced[slot, 0, 2 + b, i] += self._grades[j, i]
        self._unit_exits(slot, b)

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def _unit_exits(self, slot: cython.Py_ssize_t, b: cython.Py_ssize_t) -> cython.void:
        """The exits in that step."""
        exits: cython.Py_ssize_t = self.exits[slot]
        e: cython.Py_ssize_t
        i: cython.Py_ssize_t
        w: cython.Py_ssize_t
        j: cython.int
        g: cython.double
        for e in range(exits):
            w = e * (_ORDER + 1)
            for j in range(_ORDER + 1):
                self.series_forced[slot, b, w + j] = 0.0
            for i in range(self.linear):
                g = self.row[slot, e, i]
                if g != 0.0:
                    for j in range(_ORDER + 1):
                        self.series_forced[slot, b, w + j] += g * self._terms[j, i]
            self.table_forced[slot, b, e] = self.series_forced[slot, b, w]
            self.table_forced[slot, b, exits + e] = self.series_forced[slot, b, w + 1]
            self.table_forced[slot, b, 2 * exits + e] = 24.0 * self.series_forced[slot, b, w + 4]

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
