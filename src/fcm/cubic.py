"""Kernel: the cubic Hermite interpolant of an interval, and bounds of a function from it.

A function with the interpolant's values and slopes at both ends differs from it by at most a multiple of its
fourth derivative. So the Bernstein coefficients of the interpolant bound the function, its slope and its bend
(second derivative) on the interval.
"""

from __future__ import annotations

import cython
import numpy as np
import numpy.typing as npt

# Factors of the errors of value, slope and bend of the cubic, to be multiplied by the greatest fourth
# derivative and a power of the length (Birkhoff and Priver, 1967).
VALUE_ERROR = cython.declare(cython.double, 1.0 / 384.0)
SLOPE_ERROR = cython.declare(cython.double, 3.0**0.5 / 216.0)
BEND_ERROR = cython.declare(cython.double, 1.0 / 12.0)


def cubic(before: float, after: float, begin: float, end: float, unit: float, x: float) -> float:
    """The value at x of the cubic with values before, after and slopes unit * begin, unit * end at 0, 1."""
    return (
        before * (1.0 + 2.0 * x) * (1.0 - x) * (1.0 - x)
        + after * x * x * (3.0 - 2.0 * x)
        + unit * (begin * x * (1.0 - x) * (1.0 - x) - end * x * x * (1.0 - x))
    )


def powers(rise: float, begin: float, end: float) -> tuple[float, float]:
    """Coefficients of x^2 and x^3 of the cubic on [0, 1] with a given rise, and slopes at both ends."""
    return 3.0 * rise - 2.0 * begin - end, begin + end - 2.0 * rise


def curve_between(
    before: cython.double[::1],
    after: cython.double[::1],
    begin: cython.double[::1],
    end: cython.double[::1],
    unit: float,
    x: float,
) -> npt.NDArray[np.float64]:
    """The point (d,) at x of the cubic curve with the arguments of `cubic`, as arrays (d,) at 0 and 1.

    >>> points, slopes = np.array([[0.0, 1.0], [1.0, 1.0]]), np.array([[1.0, 0.0], [0.0, 0.0]])
    >>> curve_between(*points, *slopes, 3.0, 0.5).tolist()
    [0.875, 1.0]
    """
    i: cython.Py_ssize_t
    found = np.empty(before.shape[0])
    out: cython.double[::1] = found
    for i in range(out.shape[0]):
        out[i] = cubic(before[i], after[i], begin[i], end[i], unit, x)
    return found


def value_bounds(
    length: float, fourth: float, g_0: float, d_0: float, g_1: float, d_1: float
) -> tuple[float, float]:
    """Lower and upper bound of a function on an interval.

    g_0, d_0, g_1, d_1: values and slopes at both ends; fourth: bound of the fourth derivative.
    """
    b_1: float = g_0 + length * d_0 / 3.0
    b_2: float = g_1 - length * d_1 / 3.0
    off: float = VALUE_ERROR * (fourth * length * length * length) * length
    return min(g_0, b_1, b_2, g_1) - off, max(g_0, b_1, b_2, g_1) + off


def slope_bounds(
    length: float, fourth: float, g_0: float, d_0: float, g_1: float, d_1: float
) -> tuple[float, float]:
    """Lower and upper bound of the slope of a function on an interval; arguments as `value_bounds`."""
    middle: float = middle_slope(length, g_0, d_0, g_1, d_1)
    off: float = SLOPE_ERROR * (fourth * length * length * length)
    return min(d_0, middle, d_1) - off, max(d_0, middle, d_1) + off


def greatest_bend(length: float, fourth: float, g_0: float, d_0: float, g_1: float, d_1: float) -> float:
    """Upper bound of the bend of a function on an interval, times length; arguments as `value_bounds`."""
    middle: float = middle_slope(length, g_0, d_0, g_1, d_1)
    bend: float = 2.0 * max(middle - d_0, d_1 - middle)
    bend += BEND_ERROR * (fourth * length * length) * length
    return bend


def middle_slope(length: float, g_0: float, d_0: float, g_1: float, d_1: float) -> float:
    """The middle Bernstein coefficient of the interpolant's slope."""
    return 3.0 * ((g_1 - length * d_1 / 3.0) - (g_0 + length * d_0 / 3.0)) / length
