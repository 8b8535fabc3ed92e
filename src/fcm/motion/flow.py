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
enters only the two columns of the forces (`forced`): everything else of a flow is made once for a scene.
"""

from __future__ import annotations

import cython
import numpy as np
from cython.cimports.libc.math import fabs

from fcm.scene.model import FloatArray

if cython.compiled:
    from cython.cimports.fcm.motion.forced import Forced
else:
    from fcm.motion.forced import Forced

_ORDER = cython.declare(cython.int, 19)
_POWERS = cython.declare(cython.int, 8)  # of two, of the steps by which a flow moves at once


@cython.cclass
class Flows(Forced):
    """The flows of a scene, and their forced columns at the frequency `omega` [rad/s]; see `Pool`."""

    def __init__(
        self,
        modal: tuple[FloatArray, ...],
        ports: tuple[FloatArray, ...],
        law: FloatArray,
        springs: tuple[FloatArray, ...],
    ) -> None:
        Forced.__init__(self, modal, ports, law, springs)
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
        p: cython.Py_ssize_t = 0
        a: cython.double
        b: cython.double
        c: cython.double
        d: cython.double
        sine: cython.double = y[k, n]
        cosine: cython.double = y[k, n + 1]
        self.reach(slot, j)
        for i in range(n):
            self._whole[i] = self.forced[slot, j, 0, i] * sine + self.forced[slot, j, 1, i] * cosine
        while p + 4 <= n:  # four together, to go through the sums less often
            a, b, c, d = y[k, p], y[k, p + 1], y[k, p + 2], y[k, p + 3]
            for i in range(n):
                self._whole[i] = (
                    ((self._whole[i] + self.power[slot, j, p, i] * a) + self.power[slot, j, p + 1, i] * b)
                    + self.power[slot, j, p + 2, i] * c
                ) + self.power[slot, j, p + 3, i] * d
            p += 4
        while p < n:
            a = y[k, p]
            for i in range(n):
                self._whole[i] += self.power[slot, j, p, i] * a
            p += 1
        for i in range(n):
            y[k, i] = self._whole[i]
        y[k, n] = self.turn[slot, j, 0] * sine + self.turn[slot, j, 1] * cosine
        y[k, n + 1] = self.turn[slot, j, 0] * cosine - self.turn[slot, j, 1] * sine

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def carry(
        self, slot: cython.Py_ssize_t, position: cython.double, y: cython.double[:, ::1], k: cython.Py_ssize_t
    ) -> cython.void:
        """Move row k of y by any number of steps."""
        whole: cython.longlong = cython.cast(cython.longlong, position)
        x: cython.double = position - whole
        j: cython.int
        while whole >> _POWERS:
            self.advance(slot, _POWERS - 1, y, k)
            whole -= 1 << (_POWERS - 1)
        for j in range(_POWERS):
            if whole >> j & 1:
                self.advance(slot, j, y, k)
        self.part(slot, x, y, k, k + 1)

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
        x: cython.double = y[k, n]
        other: cython.double = y[k, n + 1]
        self.look(slot, steps)
        for w in range(wide):
            seen[w] = self.table_forced[slot, 0, w] * x + self.table_forced[slot, 1, w] * other
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
        j: cython.int
        x: cython.double = y[k, n]
        other: cython.double = y[k, n + 1]
        self.expand(slot, e)
        for j in range(_ORDER + 1):
            powers[e, j] = self.series_forced[slot, 0, w + j] * x + self.series_forced[slot, 1, w + j] * other
        for i in range(n):
            x = y[k, i]
            if x != 0.0:
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
