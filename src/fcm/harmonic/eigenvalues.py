r"""Eigenvalues of small real matrices, without leaving compiled code: Francis's implicit double shifts.

The matrix is balanced by powers of two, reduced to Hessenberg form, and one or two eigenvalues at a time are
split off at its end, where a subdiagonal element has become nothing beside its neighbours. All `Reflections`
are orthogonal, so that the eigenvalues are those of a matrix within rounding of the balanced one.
"""

from __future__ import annotations

import cython
import numpy as np
import numpy.typing as npt
from cython.cimports.libc.math import fabs, isfinite, sqrt

if cython.compiled:
    from cython.cimports.fcm.harmonic.reflections import Reflections
else:
    from fcm.harmonic.reflections import Reflections

EPS = cython.declare(cython.double, 2.220446049250313e-16)
ROUNDS = cython.declare(cython.int, 300)  # of shifts for one or two eigenvalues; 2 or 3 are usual
UNUSUAL = cython.declare(
    cython.int, 10
)  # every so many of them others, should the usual ones go round in circles
UNEVEN = cython.declare(cython.double, 0.95)  # a sum that balancing makes less by this factor is worth it


@cython.cclass
class Eigenvalues(Reflections):
    """`find` those of a matrix, of at most so many rows; re, im (n,) are then theirs, pairs side by side."""

    def __init__(self, most: cython.int) -> None:
        Reflections.__init__(self, most)
        self.re, self.im = np.zeros((2, most))
        self.n = 0

    def of(self, matrix: npt.NDArray[np.float64]) -> list[complex] | None:
        """The eigenvalues; None where a number is not finite, or they are not found."""
        found: list[complex] = []
        i: cython.Py_ssize_t
        if not self.find(matrix):
            return None
        for i in range(self.n):
            found.append(complex(self.re[i], self.im[i]))
        return found

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def find(self, matrix: cython.double[:, ::1]) -> cython.bint:
        """Fill re and im."""
        i: cython.Py_ssize_t
        j: cython.Py_ssize_t
        self.n = matrix.shape[0]
        for i in range(self.n):
            for j in range(self.n):
                self.a[i, j] = matrix[i, j]
                if not isfinite(matrix[i, j]):
                    return False
        self.balance()
        self.reduce()
        return self.split()

    @cython.cfunc
    @cython.exceptval(check=False)
    def balance(self) -> cython.void:
        """Rows and columns of about equal sums, by powers of two, which do not round."""
        i: cython.Py_ssize_t
        j: cython.Py_ssize_t
        again: cython.bint = True
        while again:
            again = False
            for i in range(self.n):
                row: cython.double = 0.0
                column: cython.double = 0.0
                for j in range(self.n):
                    if j != i:
                        row += fabs(self.a[i, j])
                        column += fabs(self.a[j, i])
                factor: cython.double = even(row, column)
                if factor != 1.0 and column * factor + row / factor < UNEVEN * (row + column):
                    again = True
                    for j in range(self.n):
                        self.a[i, j] /= factor
                        self.a[j, i] *= factor

    @cython.cfunc
    @cython.exceptval(check=False)
    def reduce(self) -> cython.void:
        """To Hessenberg form: column by column nothing below the subdiagonal."""
        i: cython.Py_ssize_t
        k: cython.Py_ssize_t
        n: cython.Py_ssize_t = self.n
        for k in range(n - 2):
            for i in range(n - 1 - k):
                self.v[i] = self.a[k + 1 + i, k]
            self.reflect(k + 1, n - 1 - k, k, 0, n, n)
            for i in range(k + 2, n):
                self.a[i, k] = 0.0

    @cython.cfunc
    @cython.exceptval(check=False)
    def split(self) -> cython.bint:
        """The eigenvalues of the Hessenberg form from its end on; false where it does not come apart."""
        end: cython.Py_ssize_t = self.n
        first: cython.Py_ssize_t
        rounds: cython.int = 0
        while end > 0:
            first = self.apart(end)
            if first >= end - 2:
                if first == end - 1:
                    self.re[first], self.im[first] = self.a[first, first], 0.0
                else:
                    self.pair(first)
                end, rounds = first, 0
            elif rounds == ROUNDS:
                return False
            else:
                rounds += 1
                self.sweep(first, end, rounds % UNUSUAL == 0)
        return True

    @cython.cfunc
    @cython.exceptval(check=False)
    def apart(self, end: cython.Py_ssize_t) -> cython.Py_ssize_t:
        """The first row of the block before `end` that no subdiagonal element ties to those above."""
        k: cython.Py_ssize_t = end - 1
        while k > 0:
            size: cython.double = fabs(self.a[k - 1, k - 1]) + fabs(self.a[k, k])
            if size == 0.0:
                size = fabs(self.a[k - 1, k])
            if fabs(self.a[k, k - 1]) <= EPS * size:
                self.a[k, k - 1] = 0.0
                break
            k -= 1
        return k

    @cython.cfunc
    @cython.exceptval(check=False)
    def pair(self, k: cython.Py_ssize_t) -> cython.void:
        """Of the two rows from k on: two real ones, or a pair."""
        half: cython.double = 0.5 * (self.a[k, k] - self.a[k + 1, k + 1])
        product: cython.double = self.a[k, k + 1] * self.a[k + 1, k]
        square: cython.double = half * half + product
        root: cython.double = sqrt(fabs(square))
        if square < 0.0:
            self.re[k] = self.re[k + 1] = self.a[k + 1, k + 1] + half
            self.im[k], self.im[k + 1] = root, -root
            return
        far: cython.double = half + root if half >= 0.0 else half - root
        self.re[k] = self.a[k + 1, k + 1] + far
        self.re[k + 1] = self.a[k + 1, k + 1] - (product / far if far != 0.0 else 0.0)
        self.im[k] = self.im[k + 1] = 0.0

    @cython.cfunc
    @cython.exceptval(check=False)
    def sweep(self, first: cython.Py_ssize_t, end: cython.Py_ssize_t, unusual: cython.bint) -> cython.void:
        """Chase a bulge through the rows first to end, with the eigenvalues of the last two as shifts."""
        a: cython.double[:, ::1] = self.a
        k: cython.Py_ssize_t
        i: cython.Py_ssize_t
        count: cython.Py_ssize_t
        last: cython.Py_ssize_t = end - 1
        self.pair(last - 1)  # the shifts; of two real ones the nearer to the end, twice
        near: cython.Py_ssize_t = last
        if fabs(self.re[last - 1] - a[last, last]) < fabs(self.re[last] - a[last, last]):
            near = last - 1
        trace: cython.double = 2.0 * self.re[near]
        product: cython.double = self.re[near] * self.re[near] + self.im[near] * self.im[near]
        if unusual:
            size: cython.double = fabs(a[last, last - 1]) + fabs(a[last - 1, last - 2])
            trace = 2.0 * (a[last, last] + 0.75 * size)
            product = 0.25 * trace * trace + 0.4375 * size * size
        x: cython.double = a[first, first]
        below: cython.double = a[first + 1, first]
        # the first column of a^2 - trace a + product, over the subdiagonal element
        self.v[0] = (x * (x - trace) + product) / below + a[first, first + 1]
        self.v[1] = x + a[first + 1, first + 1] - trace
        self.v[2] = a[first + 2, first + 1]
        for k in range(first, last):
            count = min(3, end - k)
            if k > first:
                for i in range(count):
                    self.v[i] = a[k + i, k - 1]
            # below the bulge there is nothing but the subdiagonal
            self.reflect(k, count, max(k - 1, first), first, min(k + 4, end), end)
            for i in range(1, count if k > first else 1):
                a[k + i, k - 1] = 0.0


@cython.cfunc
@cython.exceptval(check=False)
def even(row: cython.double, column: cython.double) -> cython.double:
    """The power of two by which the sums of a row, over it, and of a column, times it, become about equal."""
    factor: cython.double = 1.0
    if not (row > 0.0 and column > 0.0):
        return factor
    while column * factor * factor * 2.0 < row:
        factor *= 2.0
    while column * factor * factor > 2.0 * row:
        factor *= 0.5
    return factor
