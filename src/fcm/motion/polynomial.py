"""A polynomial by its powers of x, its derivatives, and the root of one of them."""

from __future__ import annotations

import cython
from cython.cimports.libc.math import fabs

_ORDER = cython.declare(cython.int, 19)  # its degree, ORDER of fcm.motion.pool


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
