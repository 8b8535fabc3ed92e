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
    @cython.exceptval(-1, check=False)
    def condense(self, row: cython.double[::1], matrix: cython.double[:, ::1]) -> cython.int:
        return self.inner.condense(row, matrix)

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def shorten(self, right: cython.double[::1], out: cython.double[::1]) -> cython.int:
        return self.inner.shorten(right, out)

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def lengthen(self, reduced: cython.double[::1], out: cython.double[::1]) -> cython.int:
        return self.inner.lengthen(reduced, out)
