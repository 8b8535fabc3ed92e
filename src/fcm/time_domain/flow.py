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

The exits of a combination are functions of the state vector that end it where they become negative (`Exits`).
Like the motion itself they are known by columns: on the steps of a block, and as power series in one step.
"""

from __future__ import annotations

import cython
import numpy as np
from cython.cimports.libc.math import fabs

from fcm.time_domain.equations import Matrices
from fcm.time_domain.forcing import ORDER

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


_SERIES_END = cython.declare(cython.double, 4e-19)  # 1 / 20!, as many terms as make a step complete


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def value(powers: cython.double[::1], order: cython.int, x: cython.double) -> cython.double:
    """The polynomial or one of its derivatives."""
    j: cython.int
    factor: cython.double
    total: cython.double = 0.0
    for j in range(_ORDER, order - 1, -1):
        factor = (
            1.0 if order == 0 else j if order == 1 else j * (j - 1) if order == 2 else j * (j - 1) * (j - 2)
        )
        total = total * x + factor * powers[j]
    return total


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def root(
    powers: cython.double[::1], order: cython.int, low: cython.double, high: cython.double
) -> cython.double:
    """The root of a derivative with different signs at low and high: Newton's method between them."""
    sense: cython.double = value(powers, order, low)
    x: cython.double = 0.5 * (low + high)
    height: cython.double
    slope: cython.double
    new: cython.double
    for _ in range(60):
        height, slope = value(powers, order, x), value(powers, order + 1, x)
        if height == 0.0:
            return x
        if height * sense > 0.0:
            low = x
        else:
            high = x
        new = x - height / slope if slope != 0.0 else low
        if not low < new < high:
            new = 0.5 * (low + high)
        if fabs(new - x) <= 1e-15:
            return new
        x = new
    return x


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def needed(x: cython.double) -> cython.int:
    """The terms beyond the first that a part x of a step takes, to rounding."""
    j: cython.int = 0
    size: cython.double = 1.0
    while size > _SERIES_END and j < _ORDER:
        j += 1
        size *= x / j
    return j


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def summed(
    terms: cython.double[:, ::1], x: cython.double, y: cython.double[:, ::1], k: cython.Py_ssize_t
) -> cython.void:
    """Row k of y becomes the sum of terms[j] x**j."""
    i: cython.Py_ssize_t
    j: cython.int
    n: cython.Py_ssize_t = terms.shape[1]
    for i in range(n):
        y[k, i] = terms[_ORDER, i]
    for j in range(_ORDER - 1, -1, -1):
        for i in range(n):
            y[k, i] = y[k, i] * x + terms[j, i]


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
