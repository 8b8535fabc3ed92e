"""Problems whose solutions lead from what is known to what is asked for, along a parameter of their own.

The parameter is the level of the forces, from a structure at rest (`ForceLevelProblem`); or the part of a
guess's residual that is taken off, F(z) - taken F(guess) = 0, which the guess solves with taken = 1
(`Homotopy`).
"""

from __future__ import annotations

import cython
import numpy as np

from fcm.continuation.problem import Problem
from fcm.harmonic_balance.residual import Balance

LEVEL_FLOOR = cython.declare(cython.double, 0.1)  # levels are measured by themselves, and below this by this


@cython.cclass
class ForceLevelProblem(Problem):
    """A balance at omega, followed in the level of its forces."""

    def __init__(self, balance: Balance, omega: cython.double = 0.0) -> None:
        Problem.__init__(self, balance.unknowns, balance.margins, 0, balance.rank)
        self.group, self.residual, self.jacobian = balance.group, balance.residual, balance.jacobian
        self.margin, self.kind, self.angle = balance.margin, balance.kind, balance.angle
        self.unbounded *= self.unbounded  # as much again as the level may grow
        self.balance, self.z = balance, np.zeros(balance.unknowns + 1)
        self.many, self.rooted = self.costly, balance.rooted
        self.begin(omega)

    def begin(self, omega: float, lightly: bool = False) -> None:
        """Another curve, at omega; lightly if slight corners are stepped over however few the unknowns."""
        self.omega, self.costly = omega, lightly or self.many
        self.balance.largest[:] = 0.0

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def evaluate(self, z: cython.double[::1]) -> cython.int:
        b: Balance = self.balance
        n: cython.Py_ssize_t = self.unknowns
        last: cython.Py_ssize_t = 0 if self.rank else n
        row: cython.Py_ssize_t
        p: cython.Py_ssize_t
        i: cython.Py_ssize_t
        j: cython.int
        k: cython.int
        self.place(z)
        b.evaluate(self.z)
        for i in range(n):
            self.jacobian[i, last] = 0.0
        for j in range(b.seen.count):
            k = b.seen.forced[j]
            for p in range(b.ports if k >= 0 else 0):
                row = b.seen.wave_at[p] + b.seen.stride * j
                self.jacobian[row, last] = -b.seen.X_re[k, p]
                self.jacobian[row + 1, last] = -b.seen.X_im[k, p]
        return 0

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def probe(self, z: cython.double[::1]) -> cython.int:
        self.place(z)
        return self.balance.probe(self.z)

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def measure(self, z: cython.double[::1]) -> cython.int:
        self.place(z)
        self.balance.measure(self.z)
        self.scale[:] = self.balance.scale
        self.scale[self.unknowns] = max(abs(z[self.unknowns]), LEVEL_FLOOR)
        return 0

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def bound(self, z: cython.double[::1]) -> cython.int:
        self.place(z)
        return self.balance.bound(self.z)

    @cython.cfunc
    @cython.exceptval(check=False)
    def place(self, z: cython.double[::1]) -> cython.void:
        i: cython.Py_ssize_t
        for i in range(self.unknowns):
            self.z[i] = z[i]
        self.z[self.unknowns] = self.omega
        self.balance.load = z[self.unknowns]

    @cython.ccall
    @cython.exceptval(-2.0, check=False)
    def factor(self, row: cython.double[::1], scale: cython.double[::1]) -> cython.double:
        return self.balance.factor(row, scale)

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def solve(self, right: cython.double[::1]) -> cython.int:
        return self.balance.solve(right)


@cython.cclass
class Homotopy(Problem):
    """A problem of which the part `subtracted_part` of the residual at a guess, `initial_residual`, is
    taken away."""

    def __init__(self, inner: Problem) -> None:
        Problem.__init__(self, inner.unknowns, 0, 0, inner.rank)
        self.rooted = inner.rooted
        self.inner, self.subtracted_part, self.initial_residual = inner, 0.0, np.zeros(inner.unknowns)
        self.jacobian = inner.jacobian

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def evaluate(self, z: cython.double[::1]) -> cython.int:
        i: cython.Py_ssize_t
        self.inner.evaluate(z)
        for i in range(self.unknowns):
            self.residual[i] = self.inner.residual[i] - self.subtracted_part * self.initial_residual[i]
        return 0

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def probe(self, z: cython.double[::1]) -> cython.int:
        i: cython.Py_ssize_t
        self.inner.probe(z)
        for i in range(self.unknowns):
            self.residual[i] = self.inner.residual[i] - self.subtracted_part * self.initial_residual[i]
        return 0

    @cython.ccall
    @cython.exceptval(-2.0, check=False)
    def factor(self, row: cython.double[::1], scale: cython.double[::1]) -> cython.double:
        return self.inner.factor(row, scale)

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def solve(self, right: cython.double[::1]) -> cython.int:
        return self.inner.solve(right)
