"""The motion of each combination as a power series, and the Taylor coefficients of its exits."""

from __future__ import annotations

import cython

if cython.compiled:
    from cython.cimports.fcm.motion.pool import Pool
else:
    from fcm.motion.pool import Pool

_ORDER = cython.declare(cython.int, 19)
_OPEN = cython.declare(cython.int, 0)
_STICK = cython.declare(cython.int, 1)
_POSITIVE = cython.declare(cython.int, 2)


@cython.cclass
class Series(Pool):
    """Flows as power series: positions are counted in steps."""

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
        factor: cython.double,
    ) -> cython.void:
        """Row b of z becomes factor A y, y being row a."""
        m: cython.Py_ssize_t = self.modes
        c: cython.Py_ssize_t = self.contacts
        last: cython.Py_ssize_t = self.linear
        i: cython.Py_ssize_t
        j: cython.Py_ssize_t
        state: cython.int
        f: cython.double
        n: cython.double
        u: cython.double
        v: cython.double
        sine: cython.double = y[a, last]
        cosine: cython.double = y[a, last + 1]
        for i in range(m):
            z[b, i] = factor * y[a, m + i]
            z[b, m + i] = (
                self.drive[0, i] * sine + self.drive[1, i] * cosine + self.hold[i] * y[a, last - 1]
                - self.stiffness[i] * y[a, i] - self.damping[i] * y[a, m + i]
            )  # fmt: skip
        for j in range(c):
            state = self.states[slot, j]
            u = v = 0.0
            for i in range(m):
                u += self.tangential[j, i] * y[a, m + i]
                v += self.normal[j, i] * y[a, m + i]
            v *= self.k_v[j]
            f, n = y[a, 2 * m + j], y[a, 2 * m + c + j]
            if state == _OPEN:  # the preload is missing
                f, n = 0.0, -max(self.n_0[j], 0.0) * y[a, last - 1]
                u = 0.0
            else:  # a gap is not pressed
                n += min(self.n_0[j], 0.0) * y[a, last - 1]
                if state == _STICK:
                    u = self.k_u[j] * u if self.rough[j] else 0.0
                else:
                    u = self.mu[j] * v if state == _POSITIVE else -self.mu[j] * v
            for i in range(m):
                z[b, m + i] -= self.push_u[j, i] * f + self.push_v[j, i] * n
            z[b, 2 * m + j] = factor * u
            z[b, 2 * m + c + j] = factor * v
        for i in range(m):
            z[b, m + i] *= factor
        z[b, last - 1] = 0.0
        z[b, last] = factor * self.omega * cosine
        z[b, last + 1] = -factor * self.omega * sine

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def steepen(
        self,
        y: cython.double[:, ::1],
        a: cython.Py_ssize_t,
        z: cython.double[:, ::1],
        b: cython.Py_ssize_t,
        factor: cython.double,
    ) -> cython.void:
        """Add factor dA / d omega y to row b of z, y being row a, of forces that grow with the frequency."""
        m: cython.Py_ssize_t = self.modes
        n: cython.Py_ssize_t = self.linear
        i: cython.Py_ssize_t
        for i in range(m):
            z[b, m + i] += factor * (self.slope[0, i] * y[a, n] + self.slope[1, i] * y[a, n + 1])

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def extend(
        self, slot: cython.Py_ssize_t, terms: cython.double[:, ::1], known: cython.int, last: cython.int
    ) -> cython.void:
        """Taylor coefficients from those that are known up to an order to the last one."""
        j: cython.int
        for j in range(known, last):
            self.derive(slot, terms, j, terms, j + 1, self.step[slot] / (j + 1))

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
        self.extend(slot, terms, 0, _ORDER)

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def leave(
        self,
        slot: cython.Py_ssize_t,
        terms: cython.double[:, ::1],
        first: cython.int,
        last: cython.int,
        exits: cython.double[:, ::1],
    ) -> cython.void:
        """Taylor coefficients of the exits, (ORDER + 1, exit), from those of the state, of some orders."""
        m: cython.Py_ssize_t = self.modes
        e: cython.Py_ssize_t
        i: cython.Py_ssize_t
        f: cython.Py_ssize_t
        n: cython.Py_ssize_t
        j: cython.int
        g: cython.double
        for e in range(self.exits[slot]):
            f = 2 * m + self.owner[slot, e]
            n = f + self.contacts
            for j in range(first, last + 1):
                if self.goal[slot, e] == _STICK and self.states[slot, self.owner[slot, e]] != _OPEN:
                    g = 0.0  # the end of a slip: its velocity
                    for i in range(m, 2 * m):
                        g += self.row[slot, e, i] * terms[j, i]
                else:
                    g = self.row[slot, e, f] * terms[j, f] + self.row[slot, e, n] * terms[j, n]
                    g += self.row[slot, e, self.linear - 1] * terms[j, self.linear - 1]
                exits[j, e] = g


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
