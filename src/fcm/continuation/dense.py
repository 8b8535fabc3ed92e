"""One dense linear system: factored once, solved for several right-hand sides.

Small systems are eliminated here, without leaving compiled code; large ones by LAPACK, whose import takes as
long as thousands of these. Pivots are sought along rows: that suits stiff contacts.
"""

from __future__ import annotations

import cython
import numpy as np
import numpy.typing as npt
from cython.cimports.libc.math import fabs

LARGE = cython.declare(cython.int, 120 if cython.compiled else 40)  # from here on LAPACK


@cython.cclass
class Solver:
    """matrix x = right: fill `matrix`, `factor`, fill `right`, `solve`: right is then x.

    orientation is the sign of the determinant. Neither array may be replaced.
    """

    def __init__(self, size: cython.int) -> None:
        self.size = size
        self.matrix = np.zeros((size, size))
        self.right = np.zeros(size)
        self.swapped = np.zeros(size, dtype=np.intc)
        self.orientation = 0.0
        self.factors = (np.empty(0), np.empty(0))  # of LAPACK

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def factor(self) -> cython.bint:
        """Factor the matrix, in place; false if it is singular or not finite."""
        if self.size < LARGE:
            return self.eliminate()
        from scipy.linalg import lapack

        matrix = np.asarray(self.matrix)
        if not np.isfinite(matrix).all():
            self.orientation = 0.0
            return False
        lu, pivots, info = lapack.dgetrf(matrix.T, overwrite_a=True)
        self.factors = (lu, pivots)
        swaps = np.count_nonzero(pivots != np.arange(self.size))
        self.orientation = 0.0 if info else float(np.prod(np.sign(lu.diagonal()))) * (-1.0) ** swaps
        return info == 0

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def solve(self) -> cython.int:
        """Replace right by the solution."""
        if self.size < LARGE:
            self.substitute()
            return 0
        from scipy.linalg import lapack

        right = np.asarray(self.right)
        right[:] = lapack.dgetrs(*self.factors, right, trans=1)[0]
        return 0

    def inverse(self) -> npt.NDArray[np.float64]:
        """Of the matrix that was factored; right is lost."""
        if self.size >= LARGE:
            from scipy.linalg import lapack

            # all columns at once, which is far faster than one after the other
            return np.asarray(lapack.dgetrs(*self.factors, np.eye(self.size), trans=1)[0])
        made = np.empty((self.size, self.size))
        columns: cython.double[:, ::1] = made
        i: cython.Py_ssize_t
        j: cython.Py_ssize_t
        for i in range(self.size):
            self.right[:] = 0.0
            self.right[i] = 1.0
            self.solve()
            for j in range(self.size):
                columns[j, i] = self.right[j]
        return made

    @cython.cfunc
    @cython.exceptval(check=False)
    def eliminate(self) -> cython.bint:
        """Gaussian elimination, pivots along rows: lower and unit upper triangle where the matrix was.

        From a row those above it are taken four at a time: a number is then loaded and stored once for all.
        """
        a: cython.double[:, ::1] = self.matrix
        n: cython.Py_ssize_t = self.size
        i: cython.Py_ssize_t
        j: cython.Py_ssize_t
        k: cython.Py_ssize_t
        best: cython.Py_ssize_t
        p: cython.double
        q: cython.double
        r: cython.double
        s: cython.double
        self.orientation = 1.0
        for i in range(n):
            k = 0
            while k + 4 <= i:
                p = a[i, k]
                q = a[i, k + 1] - p * a[k, k + 1]
                r = a[i, k + 2] - p * a[k, k + 2] - q * a[k + 1, k + 2]
                s = a[i, k + 3] - p * a[k, k + 3] - q * a[k + 1, k + 3] - r * a[k + 2, k + 3]
                a[i, k + 1], a[i, k + 2], a[i, k + 3] = q, r, s
                for j in range(k + 4, n):
                    a[i, j] = a[i, j] - p * a[k, j] - q * a[k + 1, j] - r * a[k + 2, j] - s * a[k + 3, j]
                k += 4
            while k < i:
                p = a[i, k]
                for j in range(k + 1, n):
                    a[i, j] -= p * a[k, j]
                k += 1
            best = _pivot(a, i)
            if not (0.0 < fabs(a[i, best]) <= 1e300):
                self.orientation = 0.0
                return False
            self.swapped[i] = cython.cast(cython.int, best)
            if best != i:
                self.orientation = -self.orientation
                _swap(a, i, best)
            if a[i, i] < 0.0:
                self.orientation = -self.orientation
            for j in range(i + 1, n):
                a[i, j] /= a[i, i]
        return True

    @cython.cfunc
    @cython.exceptval(check=False)
    def substitute(self) -> cython.void:
        """Column after column, so that no subtraction waits for the one before."""
        a: cython.double[:, ::1] = self.matrix
        x: cython.double[::1] = self.right
        n: cython.Py_ssize_t = self.size
        i: cython.Py_ssize_t
        j: cython.Py_ssize_t
        first: cython.Py_ssize_t = 0
        held: cython.double
        while first < n and x[first] == 0.0:
            first += 1
        for j in range(first, n):
            held = x[j] / a[j, j]
            x[j] = held
            for i in range(j + 1, n):
                x[i] -= a[i, j] * held
        for j in range(n - 1, 0, -1):
            held = x[j]
            for i in range(j):
                x[i] -= a[i, j] * held
        for i in range(n - 1, -1, -1):
            j = self.swapped[i]
            held = x[j]
            x[j] = x[i]
            x[i] = held


@cython.cfunc
@cython.inline
@cython.exceptval(check=False)
def _pivot(a: cython.double[:, ::1], i: cython.Py_ssize_t) -> cython.Py_ssize_t:
    """The column of the greatest number of a row, from the diagonal on."""
    j: cython.Py_ssize_t
    best: cython.Py_ssize_t = i
    most: cython.double = fabs(a[i, i])
    for j in range(i + 1, a.shape[0]):
        if fabs(a[i, j]) > most:
            best, most = j, fabs(a[i, j])
    return best


@cython.cfunc
@cython.inline
@cython.exceptval(check=False)
def _swap(a: cython.double[:, ::1], i: cython.Py_ssize_t, j: cython.Py_ssize_t) -> cython.void:
    """Swap two columns."""
    k: cython.Py_ssize_t
    held: cython.double
    for k in range(a.shape[0]):
        held = a[k, i]
        a[k, i] = a[k, j]
        a[k, j] = held
