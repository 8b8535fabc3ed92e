"""The exact motion in each combination of contact states, as a pool of flows that serves all frequencies.

The state vector is

    y = (q, q', f, n, 1, sin(theta), cos(theta)),    d = 2 modes + 2 contacts + 3 numbers,

with the modal displacements and velocities q, q', the friction forces f, the changes n = k_v v of the normal
loads from their preloads, and the phase angle theta = omega t of the forces. Then y' = A y in every
combination of states, forcing and preload included. The forces of the contacts are states of their own:
k_u (u - w) of a stiff contact, computed from displacements, would lose as many digits as it is stiffer than
the structure.

Over a step h = 1 / rate the series of exp(A h) is complete to rounding after `ORDER` terms, whatever A is:
defective, singular, resonant without damping. Whole steps are powers of exp(A h). The functions that end a
combination are known on `BLOCK` steps at once from a table of their rows times those powers. The frequency
enters only the two columns of the forces: everything else of a flow is made once for a scene.
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
_WHOLE = cython.declare(cython.int, 4)  # BLOCK is 2**4 steps
_BLOCK = cython.declare(cython.int, 16)


@cython.cclass
class Flows(Series):
    """The flows of a scene, and their forced columns at the frequency `omega` [rad/s]; see `Pool`."""

    def __init__(self, modal: tuple[FloatArray, ...], ports: tuple[FloatArray, ...], law: FloatArray) -> None:
        Series.__init__(self, modal, ports, law)
        self._terms, self._grades = np.zeros((ORDER + 1, self.size)), np.zeros((ORDER + 1, self.size))
        self._whole = np.zeros(self.size)

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def advance(
        self, slot: cython.Py_ssize_t, j: cython.Py_ssize_t, y: cython.double[:, ::1], k: cython.Py_ssize_t
    ) -> cython.void:
        """Move row k of y by 2**j steps."""
        n: cython.Py_ssize_t = self.linear
        i: cython.Py_ssize_t
        p: cython.Py_ssize_t
        x: cython.double
        sine: cython.double = y[k, n]
        cosine: cython.double = y[k, n + 1]
        for i in range(n):
            self._whole[i] = self.forced[slot, j, 0, i] * sine + self.forced[slot, j, 1, i] * cosine
        for p in range(n):
            x = y[k, p]
            if x != 0.0:
                for i in range(n):
                    self._whole[i] += self.power[slot, j, p, i] * x
        for i in range(n):
            y[k, i] = self._whole[i]
        y[k, n] = self.turn[slot, j, 0] * sine + self.turn[slot, j, 1] * cosine
        y[k, n + 1] = self.turn[slot, j, 0] * cosine - self.turn[slot, j, 1] * sine

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def watch(
        self,
        slot: cython.Py_ssize_t,
        y: cython.double[:, ::1],
        k: cython.Py_ssize_t,
        seen: cython.double[::1],
    ) -> cython.void:
        """g, g' h and g'''' h**4 of the exits at 0 to BLOCK steps from row k of y."""
        wide: cython.Py_ssize_t = (_BLOCK + 1) * 3 * self.exits[slot]
        n: cython.Py_ssize_t = self.linear
        w: cython.Py_ssize_t
        i: cython.Py_ssize_t
        x: cython.double = y[k, n]
        other: cython.double = y[k, n + 1]
        for w in range(wide):
            seen[w] = self.table_forced[slot, 0, w] * x + self.table_forced[slot, 1, w] * other
        for i in range(n):
            x = y[k, i]
            for w in range(wide):
                seen[w] += self.table[slot, i, w] * x

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def leave(
        self,
        slot: cython.Py_ssize_t,
        y: cython.double[:, ::1],
        k: cython.Py_ssize_t,
        powers: cython.double[:, ::1],
    ) -> cython.void:
        """Taylor coefficients (exit, ORDER + 1) of the exits in the step from row k of y."""
        n: cython.Py_ssize_t = self.linear
        e: cython.Py_ssize_t
        w: cython.Py_ssize_t
        i: cython.Py_ssize_t
        j: cython.int
        x: cython.double = y[k, n]
        other: cython.double = y[k, n + 1]
        for e in range(self.exits[slot]):
            w = e * (_ORDER + 1)
            for j in range(_ORDER + 1):
                powers[e, j] = (
                    self.series_forced[slot, 0, w + j] * x + self.series_forced[slot, 1, w + j] * other
                )
        for i in range(n):
            x = y[k, i]
            if x != 0.0:
                for e in range(self.exits[slot]):
                    w = e * (_ORDER + 1)
                    for j in range(_ORDER + 1):
                        powers[e, j] += self.series[slot, i, w + j] * x

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def bound(
        self, slot: cython.Py_ssize_t, y: cython.double[:, ::1], k: cython.Py_ssize_t, out: cython.double[::1]
    ) -> cython.void:
        """The size of the terms from which each component of row k of y is summed over a step."""
        n: cython.Py_ssize_t = self.linear
        i: cython.Py_ssize_t
        p: cython.Py_ssize_t
        x: cython.double = fabs(y[k, n])
        other: cython.double = fabs(y[k, n + 1])
        for i in range(n):
            out[i] = self.sizes_forced[slot, 0, i] * x + self.sizes_forced[slot, 1, i] * other
        for p in range(n):
            x = fabs(y[k, p])
            for i in range(n):
                out[i] += self.sizes[slot, p, i] * x
        out[n] = out[n + 1] = 2.5  # of 1 + x + x**2 / 2, x <= 1 the angle of a step

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
        self.reached[slot] = 0
        self.reach(slot, _WHOLE)
        self._look(slot)
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
    def _look(self, slot: cython.Py_ssize_t) -> cython.void:
        """The columns of the table of exits: T[k + 1] = T[k] exp(A h)."""
        g: cython.Py_ssize_t = 3 * self.exits[slot]
        w: cython.Py_ssize_t
        i: cython.Py_ssize_t
        b: cython.int
        x: cython.double
        c: cython.double = self.turn[slot, 0, 0]
        s: cython.double = self.turn[slot, 0, 1]
        for b in range(2):
            for w in range(g, (_BLOCK + 1) * g):
                self.table_forced[slot, b, w] = 0.0
            for i in range(self.linear):
                x = self.forced[slot, 0, b, i]
                for w in range(_BLOCK * g):
                    self.table_forced[slot, b, w + g] += self.table[slot, i, w] * x
        for w in range(_BLOCK * g):
            self.table_forced[slot, 0, w + g] += (
                c * self.table_forced[slot, 0, w] - s * self.table_forced[slot, 1, w]
            )
            self.table_forced[slot, 1, w + g] += (
                s * self.table_forced[slot, 0, w] + c * self.table_forced[slot, 1, w]
            )
