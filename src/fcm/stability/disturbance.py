r"""How small disturbances of a periodic motion go on from one event to the next.

Between two events no contact changes its state, and the disturbances of the modal coordinates, their rates by
the angle and the places of the sliders obey

    (q, q', w)' = (q', image w - K q - D q', 0)

with constant coefficients: they are carried by the exponential of that system.
"""

from __future__ import annotations

import cython
import numpy as np
from cython.cimports.libc.math import ceil

from fcm.stability.propagator import Propagator

if cython.compiled:
    from cython.cimports.fcm.stability.stiffness import Stiffness
else:
    from fcm.stability.stiffness import Stiffness

REACH = cython.declare(cython.double, 6.0)  # of a step, in radians of the fastest motion
SMALL = cython.declare(cython.double, 1e-13)  # bound of the last term of the series, relative to the first
LARGE = cython.declare(cython.int, 3000)  # products from which on BLAS is faster
MANY = cython.declare(cython.double, 3.0)  # steps that take longer than to square the exponential
FEW = cython.declare(cython.int, 12)  # disturbances up to which the exponential itself is made, by squaring
# the angle, in radians of the fastest motion, from which it is squared
SHORT = cython.declare(cython.double, 0.25)
ORDER = cython.declare(cython.int, 10)  # of its series there: 0.25^11 / 11! is below rounding


@cython.cclass
class Disturbances:
    """X: of (q, q', w) by rows, one disturbance in each of the first 2 modes + `memories` columns.

    state are those of the contacts, of which `stiffness` has been assembled.
    """

    def __init__(self, stiffness: Stiffness, propagator: Propagator) -> None:
        modes, contacts = stiffness.modes, stiffness.contacts
        self.modes, self.contacts, self.stiffness = modes, contacts, stiffness
        self.size = 2 * modes + contacts
        self.states, self.rows = np.zeros(contacts, dtype=np.intc), np.zeros((self.size, self.size))
        self.state, self.X, self.key = self.states, self.rows, b""  # the same memory
        self.term = np.zeros((2 * modes, self.size))
        self.work = np.zeros((modes, self.size))
        self.A, self.E, self.F = np.zeros((3, 2 * modes, self.size))
        self.memories, self.propagator = 0, propagator

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def assemble(self) -> cython.int:
        """Let `stiffness` take the states."""
        self.key = self.states.tobytes()
        return self.stiffness.assemble(self.state, self.key)

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def propagate(self, length: cython.double) -> cython.int:
        """X by the exponential, by the state's eigenvalues, or by a series in steps in which its terms do not
        grow large; of those there are too many where a mode is far stiffer than the others."""
        if self.size <= FEW:
            return self.jump(length)
        s: Stiffness = self.stiffness
        columns: cython.Py_ssize_t = 2 * self.modes + self.memories
        X = self.rows[:, :columns]
        if self.propagator.through(self.key, length, s.omega, s.system, X):
            return 0
        s.make()
        if s.rate * length > MANY * REACH:
            return self.jump(length)
        steps: cython.int = cython.cast(cython.int, ceil(s.rate * length / REACH))
        i: cython.int
        steps = max(steps, 1)
        for i in range(steps):  # noqa: B007
            self.apply(length / steps)
        return 0

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def jump(self, length: cython.double) -> cython.int:
        """X by the rows of the exponential for (q, q'), from a short angle by squaring."""
        m: cython.Py_ssize_t = self.modes
        n: cython.Py_ssize_t = self.size
        i: cython.Py_ssize_t
        j: cython.Py_ssize_t
        order: cython.int
        squarings: cython.int = 0
        self.stiffness.make()
        while self.stiffness.rate * length > SHORT:
            length *= 0.5
            squarings += 1
        self.fill(length)
        self.E[:, :] = self.A
        for order in range(ORDER, 1, -1):  # A (1 + A / 2 (1 + A / 3 (...)))
            self.product(self.A, self.E, 1.0 / order)
            for i in range(2 * m):
                for j in range(n):
                    self.E[i, j] = self.A[i, j] + self.F[i, j]
        for order in range(squarings):  # (1 + E)^2 = 1 + 2 E + E^2, without the rounding of 1 + E  # noqa: B007
            self.product(self.E, self.E, 1.0)
            for i in range(2 * m):
                for j in range(n):
                    self.E[i, j] = 2.0 * self.E[i, j] + self.F[i, j]
        self.carry()
        return 0

    @cython.cfunc
    @cython.exceptval(check=False)
    def fill(self, length: cython.double) -> cython.void:
        """A, the system times a length."""
        m: cython.Py_ssize_t = self.modes
        i: cython.Py_ssize_t
        j: cython.Py_ssize_t
        for i in range(m):
            for j in range(self.size):
                self.A[i, j] = length if j == m + i else 0.0
                self.A[m + i, j] = 0.0
            for j in range(m):
                self.A[m + i, j] = -length * self.stiffness.K[i, j]
            self.A[m + i, m + i] = -length * self.stiffness.damping[i]
            for j in range(self.contacts):
                self.A[m + i, 2 * m + j] = length * self.stiffness.image[i, j]

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def carry(self) -> cython.int:
        """X by 1 + E, of the rows of (q, q'); the places of the sliders stay."""
        i: cython.Py_ssize_t
        j: cython.Py_ssize_t
        k: cython.Py_ssize_t
        self.product(self.E, self.X, 1.0)  # leaves those places out
        for i in range(2 * self.modes):
            for j in range(2 * self.modes, self.size):
                weight: cython.double = self.E[i, j]
                for k in range(self.size):
                    self.F[i, k] += weight * self.X[j, k]
            for j in range(self.size):
                self.X[i, j] += self.F[i, j]
        return 0

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def product(
        self, left: cython.double[:, ::1], right: cython.double[:, ::1], factor: cython.double
    ) -> cython.int:
        """F = factor left right, of the rows of (q, q')."""
        if self.modes * self.modes * self.size > LARGE:
            n: cython.Py_ssize_t = 2 * self.modes
            np.matmul(np.asarray(left)[:, :n], np.asarray(right)[:n], out=np.asarray(self.F))
            np.multiply(self.F, factor, out=np.asarray(self.F))
            return 0
        i: cython.Py_ssize_t
        j: cython.Py_ssize_t
        k: cython.Py_ssize_t
        weight: cython.double
        for i in range(2 * self.modes):
            for k in range(self.size):
                self.F[i, k] = 0.0
            for j in range(2 * self.modes):
                weight = factor * left[i, j]
                if weight != 0.0:
                    for k in range(self.size):
                        self.F[i, k] += weight * right[j, k]
        return 0

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def apply(self, h: cython.double) -> cython.int:
        """One step: X plus the terms (A h)^j X / j!, A (q, q', w) = (q', image w - K q - D q', 0)."""
        m: cython.Py_ssize_t = self.modes
        columns: cython.Py_ssize_t = 2 * m + self.memories
        i: cython.Py_ssize_t
        k: cython.Py_ssize_t
        order: cython.int = 0
        size: cython.double = 1.0
        share: cython.double
        self.term[:, :] = self.X[: 2 * m, :]
        while size > SMALL or order < 2:
            order += 1
            share = h / order
            size *= self.stiffness.rate * share
            self.resist(columns)
            if order == 1:
                self.drag(columns)
            for i in range(m):
                for k in range(columns):
                    self.term[i, k] = share * self.term[m + i, k]
                    self.term[m + i, k] = -share * self.work[i, k]
                    self.X[i, k] += self.term[i, k]
                    self.X[m + i, k] += self.term[m + i, k]
        return 0

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def resist(self, columns: cython.Py_ssize_t) -> cython.int:
        """work = K q + D q' of the term (q, q')."""
        m: cython.Py_ssize_t = self.modes
        K: cython.double[:, ::1] = self.stiffness.K
        big: cython.bint = m * m * columns > LARGE
        i: cython.Py_ssize_t
        j: cython.Py_ssize_t
        k: cython.Py_ssize_t
        weight: cython.double
        if big:
            np.matmul(K, self.term[:m], out=np.asarray(self.work))
        for i in range(m):
            if not big:
                for k in range(columns):
                    self.work[i, k] = 0.0
                for j in range(m):
                    weight = K[i, j]
                    for k in range(columns):
                        self.work[i, k] += weight * self.term[j, k]
            weight = self.stiffness.damping[i]
            for k in range(columns):
                self.work[i, k] += weight * self.term[m + i, k]
        return 0

    @cython.cfunc
    @cython.exceptval(check=False)
    def drag(self, columns: cython.Py_ssize_t) -> cython.void:
        """From work what the sliders add, image w."""
        i: cython.Py_ssize_t
        j: cython.Py_ssize_t
        k: cython.Py_ssize_t
        weight: cython.double
        for i in range(self.modes):
            for j in range(self.contacts):
                weight = self.stiffness.image[i, j]
                if weight != 0.0:
                    for k in range(columns):
                        self.work[i, k] -= weight * self.X[2 * self.modes + j, k]
