"""A polynomial by its powers of x, its derivatives, the root of one of them; and many polynomials at once."""

from __future__ import annotations

import cython
from cython.cimports.libc.math import fabs

_ORDER = cython.declare(cython.int, 19)  # its degree, ORDER of fcm.time_domain.flow_cache
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
