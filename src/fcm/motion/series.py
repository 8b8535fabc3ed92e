"""The motion of each combination as a power series by the position, which is counted in steps."""

from __future__ import annotations

import cython
import numpy as np

from fcm.motion.pool import ORDER
from fcm.scene.model import FloatArray

if cython.compiled:
    from cython.cimports.fcm.motion.pool import Pool
else:
    from fcm.motion.pool import Pool

_ORDER = cython.declare(cython.int, 19)
_OPEN = cython.declare(cython.int, 0)
_STICK = cython.declare(cython.int, 1)
_POSITIVE = cython.declare(cython.int, 2)
_SERIES_END = cython.declare(cython.double, 4e-19)  # 1 / 20!, as many terms as make a step complete


@cython.cclass
class Series(Pool):
    """Flows as power series. What is done for a whole series is done in one call: y' = A y is little work."""

    def __init__(
        self,
        modal: tuple[FloatArray, ...],
        ports: tuple[FloatArray, ...],
        law: FloatArray,
        springs: tuple[FloatArray, ...],
    ) -> None:
        Pool.__init__(self, modal, ports, law, springs)
        self._own = np.zeros((ORDER + 1, self.size))

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def derive(
        self,
        slot: cython.Py_ssize_t,
        y: cython.double[:, ::1],
        a: cython.Py_ssize_t,
        z: cython.double[:, ::1],
        b: cython.Py_ssize_t,
    ) -> cython.void:
        """Row b of z becomes A y, y being row a."""
        i: cython.Py_ssize_t
        for i in range(self.size):
            self._own[0, i] = y[a, i]
        self.extend(slot, self._own, 1, 1.0, self._own, False)
        for i in range(self.size):
            z[b, i] = self._own[1, i]

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def extend(
        self,
        slot: cython.Py_ssize_t,
        z: cython.double[:, ::1],
        last: cython.Py_ssize_t,
        step: cython.double,
        y: cython.double[:, ::1],
        graded: cython.bint,
    ) -> cython.void:
        """Taylor coefficients from row 0 of z on, by the position in a step of that length [s].

        If it is graded, those of the derivative by the frequency of the motion with the coefficients y:
        z[a + 1] = step / (a + 1) (A z[a] + dA / d omega y[a]).
        """
        m: cython.Py_ssize_t = self.modes
        c: cython.Py_ssize_t = self.contacts
        end: cython.Py_ssize_t = self.linear
        a: cython.Py_ssize_t
        b: cython.Py_ssize_t
        i: cython.Py_ssize_t
        j: cython.Py_ssize_t
        half: cython.Py_ssize_t = m // 2
        odd: cython.bint = m % 2 == 1
        state: cython.int
        factor: cython.double
        w: cython.double
        f: cython.double
        n: cython.double
        u: cython.double
        v: cython.double
        one: cython.double
        sine: cython.double
        cosine: cython.double
        for a in range(last):
            b = a + 1
            factor = step / b
            one, sine, cosine = z[a, end - 1], z[a, end], z[a, end + 1]
            z[b, end - 1] = 0.0
            z[b, end] = factor * self.omega * cosine
            z[b, end + 1] = -factor * self.omega * sine
            for i in range(m):
                z[b, i] = factor * z[a, m + i]
                z[b, m + i] = factor * (
                    self.drive[0, i] * sine + self.drive[1, i] * cosine + self.hold[i] * one
                    - self.stiffness[i] * z[a, i] - self.damping[i] * z[a, m + i]
                )  # fmt: skip
            for j in range(self.springs):
                u = 0.0
                for i in range(m):
                    u += self.stretch[j, i] * z[a, i]
                u *= factor
                for i in range(m):
                    z[b, m + i] -= self.pull[j, i] * u
            for j in range(c):
                state = self.states[slot, j]
                v = w = 0.0  # two sums, for one would wait for each addition
                for i in range(half):
                    v += self.normal[j, i] * z[a, m + i]
                    w += self.normal[j, half + i] * z[a, m + half + i]
                if odd:
                    w += self.normal[j, m - 1] * z[a, m + m - 1]
                v = factor * self.k_v[j] * (v + w)
                f, n, u = z[a, 2 * m + j], z[a, 2 * m + c + j], 0.0
                if state == _OPEN:  # the preload is missing
                    f, n = 0.0, -max(self.n_0[j], 0.0) * one
                else:  # a gap is not pressed
                    n += min(self.n_0[j], 0.0) * one
                    if state != _STICK:
                        u = self.mu[j] * v if state == _POSITIVE else -self.mu[j] * v
                    elif self.rough[j]:
                        w = 0.0
                        for i in range(half):
                            u += self.tangential[j, i] * z[a, m + i]
                            w += self.tangential[j, half + i] * z[a, m + half + i]
                        if odd:
                            w += self.tangential[j, m - 1] * z[a, m + m - 1]
                        u = factor * self.k_u[j] * (u + w)
                f *= factor
                n *= factor
                if f != 0.0:
                    for i in range(m):
                        z[b, m + i] -= self.push_u[j, i] * f
                if n != 0.0:
                    for i in range(m):
                        z[b, m + i] -= self.push_v[j, i] * n
                z[b, 2 * m + j] = u
                z[b, 2 * m + c + j] = v
            if graded:
                sine, cosine = factor * y[a, end], factor * y[a, end + 1]
                z[b, end] += cosine
                z[b, end + 1] -= sine
                for i in range(m):
                    z[b, m + i] += self.slope[0, i] * sine + self.slope[1, i] * cosine

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
