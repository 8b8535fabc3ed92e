"""One dense linear system: factored once, solved for several right-hand sides.

Compiled code eliminates small systems itself. LAPACK solves large ones; its import takes as long as thousands
of small systems.

The elimination is Gaussian with pivots along rows, which suits stiff contacts. It replaces a matrix (n, n) in
place by its lower and its unit upper triangle. From a row, the rows above are subtracted four at a time, so
that each number is loaded and stored once for all four. Of a large matrix four rows are eliminated together,
by code that C compiles for registers of any width (see the .pxd); the numbers are the same either way.

If there are more rows and columns than pivots, the elimination condenses the others; see `condense`.
"""

from __future__ import annotations

import cython
import numpy as np
from cython.cimports.libc.math import fabs

from fcm.continuation.options import SOLVER, SolverOptions

BLOCKED_ROWS = cython.declare(cython.int, SOLVER.blocked_rows)


@cython.cclass
class Solver:
    """Solver of a dense system, matrix x = right.

    Fill `matrix`, `factor`, fill `right`, `solve`: right is then x.

    orientation is the sign of the determinant. Do not replace either array by another one.
    """

    def __init__(self, size: cython.int, options: SolverOptions = SOLVER) -> None:
        self.size, self.lapack_size = size, options.lapack_size
        self.matrix = np.zeros((size, size))
        self.right = np.zeros(size)
        self.swapped = np.zeros(size, dtype=np.intc)
        self.orientation = 0.0
        self.factors = (np.empty(0), np.empty(0))  # LAPACK's

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def factor(self) -> cython.bint:
        """Factor the matrix, in place; false if it is singular or not finite."""
        if self.size < self.lapack_size:
            self.orientation = eliminate(self.matrix, self.swapped)
            return self.orientation != 0.0
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
        """Replace the right side by the solution x."""
        if self.size < self.lapack_size:
            substitute(self.matrix, self.swapped, self.right)
            return 0
        from scipy.linalg import lapack

        right = np.asarray(self.right)
        right[:] = lapack.dgetrs(*self.factors, right, trans=1)[0]
        return 0


@cython.cfunc
@cython.exceptval(check=False)
def eliminate(a: cython.double[:, ::1], swapped: cython.int[::1]) -> cython.double:
    """Factor the matrix a in place; return the sign of its determinant, 0 if it is singular or not finite.

    swapped (n,): number of the column that was exchanged with each. If a has more rows and columns, only the
    first n have pivots.
    """
    n: cython.Py_ssize_t = swapped.shape[0]
    rows: cython.Py_ssize_t = a.shape[0]
    columns: cython.Py_ssize_t = a.shape[1]
    above: cython.Py_ssize_t
    i: cython.Py_ssize_t
    j: cython.Py_ssize_t
    k: cython.Py_ssize_t
    p: cython.double
    q: cython.double
    r: cython.double
    s: cython.double
    sign: cython.double = 1.0
    for i in range(rows):
        above = min(i, n)
        k = 0
        if cython.compiled and columns >= BLOCKED_ROWS and i - i % 4 + 4 <= rows:
            k = min(i - i % 4, n - n % 4)
            if i % 4 == 0:
                _four_rows(a, i, k)
        while k + 4 <= above:
            p = a[i, k]
            q = a[i, k + 1] - p * a[k, k + 1]
            r = a[i, k + 2] - p * a[k, k + 2] - q * a[k + 1, k + 2]
            s = a[i, k + 3] - p * a[k, k + 3] - q * a[k + 1, k + 3] - r * a[k + 2, k + 3]
            a[i, k + 1], a[i, k + 2], a[i, k + 3] = q, r, s
            for j in range(k + 4, columns):
                a[i, j] = a[i, j] - p * a[k, j] - q * a[k + 1, j] - r * a[k + 2, j] - s * a[k + 3, j]
            k += 4
        while k < above:
            p = a[i, k]
            for j in range(k + 1, columns):
                a[i, j] -= p * a[k, j]
            k += 1
        if i >= n:
            continue
        most: cython.double = _greatest(a, i, n)
        if not (0.0 < most <= 1e300):
            return 0.0
        j = i
        while fabs(a[i, j]) != most:
            j += 1
        swapped[i] = cython.cast(cython.int, j)
        if j != i:
            sign = -sign
            _swap(a, i, j)
        if a[i, i] < 0.0:
            sign = -sign
        for j in range(i + 1, columns):
            a[i, j] /= a[i, i]
    return sign


@cython.cfunc
@cython.exceptval(check=False)
def condense(a: cython.double[:, ::1], swapped: cython.int[::1]) -> cython.bint:
    """Replace the rows [M R] with M (n, n), and [L D] below: R by M^-1 R, and D by D - L M^-1 R.

    swapped (n,). False if M is singular or not finite.
    """
    n: cython.Py_ssize_t = swapped.shape[0]
    if not cython.compiled:
        try:
            found = np.linalg.solve(a[:n, :n], a[:n, n:])
        except np.linalg.LinAlgError:
            return False
        a[n:, n:] -= a[n:, :n] @ found
        a[:n, n:] = found
        return bool(np.isfinite(found).all())
    if n > 0 and eliminate(a, swapped) == 0.0:
        return False
    i: cython.Py_ssize_t
    j: cython.Py_ssize_t
    columns: cython.Py_ssize_t = a.shape[1]
    for i in range(n - 1, -1, -1):
        if i >= n - n % 4:
            _less_below(a, i, i + 1, n)
        elif i % 4 == 3:
            _four_less_below(a, i - 3, n)
    for i in range(n - 1, -1, -1):
        if swapped[i] != i:
            for j in range(n, columns):
                a[i, j], a[swapped[i], j] = a[swapped[i], j], a[i, j]
    return True


@cython.cfunc
@cython.inline
@cython.exceptval(check=False)
def _less_below(
    a: cython.double[:, ::1], i: cython.Py_ssize_t, first: cython.Py_ssize_t, n: cython.Py_ssize_t
) -> cython.void:
    """Subtract from the right sides of row i those of rows first to n - 1, each times its entry in row i."""
    j: cython.Py_ssize_t
    k: cython.Py_ssize_t
    for k in range(first, n):
        by: cython.double = a[i, k]
        for j in range(n, a.shape[1]):
            a[i, j] -= by * a[k, j]


@cython.cfunc
@cython.inline
@cython.exceptval(check=False)
def _four_less_below(a: cython.double[:, ::1], i: cython.Py_ssize_t, n: cython.Py_ssize_t) -> cython.void:
    """Subtract from the right sides of rows i to i + 3 those of the rows below, as `_less_below`."""
    k: cython.Py_ssize_t = i + 4
    r: cython.Py_ssize_t
    width: cython.Py_ssize_t = a.shape[1]
    while k + 4 <= n:
        rows, below = cython.address(a[i, 0]), cython.address(a[k, 0])
        four_less_upper(rows, below, width, k, n)  # type: ignore[name-defined]  # noqa: F821
        k += 4
    for r in range(i + 3, i - 1, -1):
        _less_below(a, r, k, n)
        _less_below(a, r, r + 1, i + 4)


@cython.cfunc
@cython.exceptval(check=False)
def substitute(a: cython.double[:, ::1], swapped: cython.int[::1], x: cython.double[::1]) -> cython.void:
    """Replace the right side x (n,) by the solution."""
    n: cython.Py_ssize_t = a.shape[0]
    i: cython.Py_ssize_t = 0
    j: cython.Py_ssize_t
    held: cython.double
    while i < n and x[i] == 0.0:
        i += 1
    _triangle(a, x, i, 1)
    _triangle(a, x, n - 1, -1)
    for i in range(n - 1, -1, -1):
        j = swapped[i]
        held = x[j]
        x[j] = x[i]
        x[i] = held


@cython.cfunc
@cython.inline
@cython.exceptval(check=False)
def _triangle(
    a: cython.double[:, ::1], x: cython.double[::1], first: cython.Py_ssize_t, way: cython.Py_ssize_t
) -> cython.void:
    """Solve with the lower triangle (way 1) or the upper triangle (-1), beginning at row `first`."""
    count: cython.Py_ssize_t = a.shape[0] - first if way > 0 else first + 1
    m: cython.Py_ssize_t
    k: cython.Py_ssize_t
    for m in range(count):
        k = m - m % 4
        if k + 4 > count:
            k = 0
        elif k == m:
            _four(a, x, first, way, m)
        i: cython.Py_ssize_t = first + way * m
        held: cython.double = x[i]
        while k < m:
            held -= a[i, first + way * k] * x[first + way * k]
            k += 1
        x[i] = held / a[i, i] if way > 0 else held


@cython.cfunc
@cython.inline
@cython.exceptval(check=False)
def _four(
    a: cython.double[:, ::1],
    x: cython.double[::1],
    first: cython.Py_ssize_t,
    way: cython.Py_ssize_t,
    known: cython.Py_ssize_t,
) -> cython.void:
    """Subtract the known numbers of x from the next four right sides, in four independent sums.

    known: how many numbers are known, counted from `first`.
    """
    i: cython.Py_ssize_t = first + way * known
    j: cython.Py_ssize_t = first
    p: cython.double = x[i]
    q: cython.double = x[i + way]
    r: cython.double = x[i + 2 * way]
    s: cython.double = x[i + 3 * way]
    while j != i:
        held: cython.double = x[j]
        p -= a[i, j] * held
        q -= a[i + way, j] * held
        r -= a[i + 2 * way, j] * held
        s -= a[i + 3 * way, j] * held
        j += way
    x[i], x[i + way], x[i + 2 * way], x[i + 3 * way] = p, q, r, s


@cython.cfunc
@cython.inline
@cython.exceptval(check=False)
def _four_rows(a: cython.double[:, ::1], i: cython.Py_ssize_t, count: cython.Py_ssize_t) -> cython.void:
    """Subtract the first `count` rows, a multiple of four, from rows i to i + 3; for compiled code only."""
    columns: cython.Py_ssize_t = a.shape[1]
    k: cython.Py_ssize_t
    for k in range(0, count, 4):
        row, above = cython.address(a[i, k]), cython.address(a[k, k])
        four_less_four(row, above, columns, columns - k)  # type: ignore[name-defined]  # noqa: F821


@cython.cfunc
@cython.inline
@cython.exceptval(check=False)
def _greatest(a: cython.double[:, ::1], i: cython.Py_ssize_t, n: cython.Py_ssize_t) -> cython.double:
    """Greatest absolute value in row i from the diagonal up to column n, by four independent maxima.

    A NaN is passed over here. It spreads over its column in all rows below, so that the last row has 0.
    """
    j: cython.Py_ssize_t = i
    p: cython.double = 0.0
    q: cython.double = 0.0
    r: cython.double = 0.0
    s: cython.double = 0.0
    while n >= BLOCKED_ROWS and j + 4 <= n:
        p = max(p, fabs(a[i, j]))
        q = max(q, fabs(a[i, j + 1]))
        r = max(r, fabs(a[i, j + 2]))
        s = max(s, fabs(a[i, j + 3]))
        j += 4
    while j < n:
        p = max(p, fabs(a[i, j]))
        j += 1
    return max(max(p, q), max(r, s))


@cython.cfunc
@cython.inline
@cython.exceptval(check=False)
def _swap(a: cython.double[:, ::1], i: cython.Py_ssize_t, j: cython.Py_ssize_t) -> cython.void:
    """Swap columns i and j of the matrix a."""
    k: cython.Py_ssize_t
    held: cython.double
    for k in range(a.shape[0]):
        held = a[k, i]
        a[k, i] = a[k, j]
        a[k, j] = held
