"""The exact motion in each combination of contact states, as a pool of flows that serves all frequencies.

The state vector is

    y = (q, q', f, n, 1, sin(h theta), cos(h theta) ...),    d = 2 modes + 2 contacts + 1 + 2 waves numbers,

with the modal displacements and velocities q, q', the friction forces f, the changes n = k_v v of the normal
loads from their preloads, and the phase angle theta = omega t of the forces at
each of their harmonics h, of which the first is 1. Then y' = A y in every
combination of states, forcing and preload included. The forces of the contacts are states of their own:
k_u (u - w) of a stiff contact, computed from displacements, would lose as many digits as it is stiffer than
the structure.

Over a step h = 1 / rate the series of exp(A h) is complete to rounding after `ORDER` terms, whatever A is:
defective, singular, resonant without damping. Whole steps are powers of exp(A h). The functions that end a
combination are known on `BLOCK` steps at once from a table of their rows times those powers. The frequency
enters only the columns of the forces (`forced`): everything else of a flow is made once for a scene.
"""

from __future__ import annotations

import cython
from cython.cimports.libc.math import fabs

if cython.compiled:
    from cython.cimports.fcm.time_domain.exit_functions import Exits
    from cython.cimports.fcm.time_domain.polynomial import needed
else:
    from fcm.time_domain.exit_functions import Exits
    from fcm.time_domain.polynomial import needed

_ORDER = cython.declare(cython.int, 19)
_POWERS = cython.declare(cython.int, 8)  # of two, of the steps by which a flow moves at once


@cython.cclass
class Flows(Exits):
    """The flows of a scene, and their forced columns at the frequency `omega` [rad/s]; see `Pool`."""

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(-1, check=False)
    def advance(
        self, slot: cython.Py_ssize_t, j: cython.Py_ssize_t, y: cython.double[:, ::1], k: cython.Py_ssize_t
    ) -> cython.int:
        """Move row k of y by 2**j steps."""
        n: cython.Py_ssize_t = self.linear
        i: cython.Py_ssize_t
        h: cython.Py_ssize_t
        b: cython.Py_ssize_t
        sine: cython.double
        cosine: cython.double
        c: cython.double
        s: cython.double
        self.reach(slot, j)
        for i in range(n):
            self.whole[i] = 0.0
        for h in range(self.waves):
            b, sine, cosine = 4 * h, y[k, n + 2 * h], y[k, n + 2 * h + 1]
            for i in range(n):
                self.whole[i] += self.forced[slot, j, b, i] * sine + self.forced[slot, j, b + 1, i] * cosine
        self.free(slot, j, y, k)
        for i in range(n):
            y[k, i] = self.whole[i]
        for b in range(0, 2 * self.waves, 2):
            sine, cosine = y[k, n + b], y[k, n + b + 1]
            c, s = self.rotation[slot, j, b], self.rotation[slot, j, b + 1]
            y[k, n + b], y[k, n + b + 1] = c * sine + s * cosine, c * cosine - s * sine
        return 0

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(-1, check=False)
    def carry(
        self, slot: cython.Py_ssize_t, position: cython.double, y: cython.double[:, ::1], k: cython.Py_ssize_t
    ) -> cython.int:
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
        return 0

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
        b: cython.Py_ssize_t
        x: cython.double
        other: cython.double
        for i in range(n):
            out[i] = 0.0
        for b in range(0, 2 * self.waves, 2):
            x, other = fabs(y[k, n + b]), fabs(y[k, n + b + 1])
            for i in range(n):
                out[i] += self.sizes_forced[slot, b, i] * x + self.sizes_forced[slot, b + 1, i] * other
            out[n + b] = out[n + b + 1] = 2.5  # of 1 + x + x**2 / 2, x <= 1 the angle of a step
        for p in range(n):
            x = fabs(y[k, p])
            for i in range(n):
                out[i] += self.sizes[slot, p, i] * x

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def taylor(
        self,
        slot: cython.Py_ssize_t,
        y: cython.double[:, ::1],
        k: cython.Py_ssize_t,
        terms: cython.double[:, ::1],
    ) -> cython.void:
        """Taylor coefficients of the motion from row k of y, by the position in a step: (ORDER + 1, d)."""
        i: cython.Py_ssize_t
        for i in range(self.size):
            terms[0, i] = y[k, i]
        self.extend(slot, terms, _ORDER, self.step[slot], terms, False)

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def part(
        self,
        slot: cython.Py_ssize_t,
        x: cython.double,
        y: cython.double[:, ::1],
        first: cython.Py_ssize_t,
        last: cython.Py_ssize_t,
    ) -> cython.void:
        """Move the rows from the first to before the last of y by a part x of a step."""
        i: cython.Py_ssize_t
        j: cython.Py_ssize_t
        k: cython.Py_ssize_t
        orders: cython.Py_ssize_t = needed(x)
        for k in range(first, last):
            for i in range(self.size):
                self._own[0, i] = y[k, i]
            self.extend(slot, self._own, orders, x * self.step[slot], self._own, False)
            for j in range(orders - 1, -1, -1):
                for i in range(self.size):
                    self._own[j, i] += self._own[j + 1, i]
            for i in range(self.size):
                y[k, i] = self._own[0, i]
