"""The way from a guess to a solution: F(z) - taken F(guess) = 0, which the guess solves with taken = 1."""

from __future__ import annotations

import cython
import numpy as np

from fcm.continuation.problem import Problem


@cython.cclass
class Homotopy(Problem):
    """A problem of which the part `taken` of the residual at a guess, `removed`, is taken away."""

    def __init__(self, inner: Problem) -> None:
        Problem.__init__(self, inner.unknowns, 0, 0, inner.rank)
        self.rooted = inner.rooted
        self.inner, self.taken, self.removed = inner, 0.0, np.zeros(inner.unknowns)
        self.jacobian = inner.jacobian

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def evaluate(self, z: cython.double[::1]) -> cython.int:
        i: cython.Py_ssize_t
        self.inner.evaluate(z)
        for i in range(self.unknowns):
            self.residual[i] = self.inner.residual[i] - self.taken * self.removed[i]
        return 0

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def probe(self, z: cython.double[::1]) -> cython.int:
        i: cython.Py_ssize_t
        self.inner.probe(z)
        for i in range(self.unknowns):
            self.residual[i] = self.inner.residual[i] - self.taken * self.removed[i]
        return 0

    @cython.ccall
    @cython.exceptval(-2.0, check=False)
    def factor(self, row: cython.double[::1], scale: cython.double[::1]) -> cython.double:
        return self.inner.factor(row, scale)

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def solve(self, right: cython.double[::1]) -> cython.int:
        return self.inner.solve(right)
