"""The columns of the forces, the only ones of a flow that the frequency enters: made anew for each.

A column is what sin(h theta) or cos(h theta) = 1 alone at the start has done after a step, or after 2**j, and
its derivative by the frequency; there are four for each harmonic h.
"""

from __future__ import annotations

import cython
import numpy as np
from cython.cimports.libc.math import cos, fabs, sin

from fcm.time_domain.equations import Matrices

if cython.compiled:
    from cython.cimports.fcm.time_domain.taylor_series import Series
else:
    from fcm.time_domain.taylor_series import Series

_ORDER = cython.declare(cython.int, 19)
NOTHING = cython.declare(cython.double, 1e-20)  # of the first term: those from there on are left out


@cython.cclass
class Forced(Series):
    """`refresh` makes the columns of a flow for the frequency `omega` [rad/s], for one step; see `Pool`.

    Those for more are made where they are needed, by `reach`.
    """

    def __init__(self, matrices: Matrices) -> None:
        Series.__init__(self, matrices)
        self.whole = np.zeros(self.linear)

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(-1, check=False)
    def refresh(self, slot: cython.Py_ssize_t) -> cython.int:
        """Make the columns of the forces for the frequency, unless they are."""
        self.clock += 1
        self.used[slot] = self.clock
        if self.made_for[slot] == self.omega:
            return 0
        self._one_step(slot)
        self._sized(slot)
        self.reached[slot] = 0
        self.reach(slot, 0)
        self.made_for[slot] = self.omega
        return 0

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def _one_step(self, slot: cython.Py_ssize_t) -> cython.void:
        """One step from sin(h theta) = 1 or cos(h theta) = 1 alone, and its derivative by omega.

        The j-th derivative of the forces by time grows as (h omega)**j; what it does is known with the flow.
        """
        h: cython.Py_ssize_t
        self.forced[slot, 0, :, :] = 0.0
        for h in range(self.waves):
            self._sum_terms(slot, h)

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def _sum_terms(self, slot: cython.Py_ssize_t, h: cython.Py_ssize_t) -> cython.void:
        """The same of one harmonic."""
        j: cython.int
        step: cython.double = self.harmonic[h] * self.step[slot]
        x: cython.double = self.omega * step
        size: cython.double = 1.0
        power: cython.double = 1.0
        before: cython.double = 0.0
        for j in range(_ORDER):
            self._add_term(slot, h, j, power, j * before * step)
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
    def _add_term(
        self,
        slot: cython.Py_ssize_t,
        h: cython.Py_ssize_t,
        j: cython.int,
        power: cython.double,
        slope: cython.double,
    ) -> cython.void:
        """Add what the j-th derivative does, power times, and by omega, of which that is the slope."""
        i: cython.Py_ssize_t
        b: cython.Py_ssize_t = 4 * h
        square: cython.double = self.omega * self.omega
        rate: cython.double = 2.0 * self.omega * power
        first: cython.double
        other: cython.double
        grade: cython.double
        new: cython.double[:, ::1] = self.forced[slot, 0]
        for i in range(self.linear):
            first = self.pushed[slot, b, j, i] + square * self.pushed[slot, b + 2, j, i]
            other = self.pushed[slot, b + 1, j, i] + square * self.pushed[slot, b + 3, j, i]
            grade = slope * first + rate * self.pushed[slot, b + 2, j, i]
            new[b + j % 2, i] += power * first
            new[b + 2 + j % 2, i] += grade
            grade = slope * other + rate * self.pushed[slot, b + 3, j, i]
            if j % 2:
                new[b, i] -= power * other
                new[b + 2, i] -= grade
            else:
                new[b + 1, i] += power * other
                new[b + 3, i] += grade

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def _sized(self, slot: cython.Py_ssize_t) -> cython.void:
        """The size of the first two terms of that step."""
        i: cython.Py_ssize_t
        h: cython.Py_ssize_t
        b: cython.Py_ssize_t
        x: cython.double
        square: cython.double = self.omega * self.omega
        sine: cython.double
        cosine: cython.double
        for h in range(self.waves):
            b, x = 4 * h, self.harmonic[h] * self.omega * self.step[slot]
            for i in range(self.linear):
                sine = self.push[slot, 0, b, i] + square * self.push[slot, 0, b + 2, i]
                cosine = self.push[slot, 0, b + 1, i] + square * self.push[slot, 0, b + 3, i]
                self.sizes_forced[slot, 2 * h, i] = fabs(sine) + 0.5 * fabs(
                    self.push[slot, 1, b, i] + square * self.push[slot, 1, b + 2, i] - x * cosine
                )
                self.sizes_forced[slot, 2 * h + 1, i] = fabs(cosine) + 0.5 * fabs(
                    self.push[slot, 1, b + 1, i] + square * self.push[slot, 1, b + 3, i] + x * sine
                )

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(-1, check=False)
    def reach(self, slot: cython.Py_ssize_t, last: cython.Py_ssize_t) -> cython.int:
        """Make the columns of the forces over 1, 2, 4 ... 2**last steps, those that are not made yet."""
        t: cython.double
        h: cython.Py_ssize_t
        while self.reached[slot] <= last:
            if self.reached[slot] > 0:
                self._double(slot, self.reached[slot] - 1)
            if self.squared[slot] < self.reached[slot]:
                with cython.gil:
                    self.next_power(slot)
            for h in range(self.waves):
                t = self.harmonic[h] * self.omega * self.step[slot] * (1 << self.reached[slot])
                self.rotation[slot, self.reached[slot], 2 * h] = cos(t)
                self.rotation[slot, self.reached[slot], 2 * h + 1] = sin(t)
            self.reached[slot] += 1
        return 0

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def _double(self, slot: cython.Py_ssize_t, j: cython.Py_ssize_t) -> cython.void:
        """The columns over twice as many steps: C(2 t) = E C + C R, with the rotation R of the forces."""
        n: cython.Py_ssize_t = self.linear
        i: cython.Py_ssize_t
        h: cython.Py_ssize_t
        b: cython.Py_ssize_t
        t: cython.double
        c: cython.double
        s: cython.double
        old: cython.double[:, ::1] = self.forced[slot, j]
        new: cython.double[:, ::1] = self.forced[slot, j + 1]
        for h in range(self.waves):
            b, t = 4 * h, self.harmonic[h] * self.step[slot] * (1 << j)
            c, s = self.rotation[slot, j, 2 * h], self.rotation[slot, j, 2 * h + 1]
            for i in range(n):
                new[b, i] = c * old[b, i] - s * old[b + 1, i]
                new[b + 1, i] = s * old[b, i] + c * old[b + 1, i]
                new[b + 2, i] = c * old[b + 2, i] - s * old[b + 3, i] - t * new[b + 1, i]
                new[b + 3, i] = s * old[b + 2, i] + c * old[b + 3, i] + t * new[b, i]
        for b in range(4 * self.waves):
            for i in range(n):
                self.whole[i] = new[b, i]
            self.free(slot, j, old, b)
            for i in range(n):
                new[b, i] = self.whole[i]

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def free(
        self,
        slot: cython.Py_ssize_t,
        j: cython.Py_ssize_t,
        y: cython.double[:, ::1],
        k: cython.Py_ssize_t,
    ) -> cython.void:
        """Add to `whole` what row k of y becomes in 2**j steps without the forces."""
        n: cython.Py_ssize_t = self.linear
        i: cython.Py_ssize_t
        p: cython.Py_ssize_t = 0
        a: cython.double
        b: cython.double
        c: cython.double
        d: cython.double
        while p + 4 <= n:  # four together, to go through the sums less often
            a, b, c, d = y[k, p], y[k, p + 1], y[k, p + 2], y[k, p + 3]
            for i in range(n):
                self.whole[i] = (
                    ((self.whole[i] + self.power[slot, j, p, i] * a) + self.power[slot, j, p + 1, i] * b)
                    + self.power[slot, j, p + 2, i] * c
                ) + self.power[slot, j, p + 3, i] * d
            p += 4
        while p < n:
            a = y[k, p]
            for i in range(n):
                self.whole[i] += self.power[slot, j, p, i] * a
            p += 1
