"""The first descent of a polynomial through zero on [0, 1], none missed.

The Bernstein coefficients of a polynomial enclose its values: where none is negative, neither is the
polynomial; where their sign changes once, it has exactly one root. Otherwise the interval is halved.
The way from powers to Bernstein coefficients is a sum with weights between 0 and 1, so it is accurate.
"""

from __future__ import annotations

from math import comb

import cython
import numpy as np
from cython.cimports.libc.math import fabs, ldexp

from fcm.model.scene import FloatArray

N = 19  # degree, ORDER of fcm.time_domain.flow_cache
DEEPEST = 50  # halvings
_N = cython.declare(cython.int, 19)
_DEEPEST = cython.declare(cython.int, 50)
NOTHING = cython.declare(
    cython.double, 1e-20
)  # of what the powers add up to: those above the last that is more are left out


def _weights(degree: int) -> FloatArray:
    """Of the powers in the Bernstein coefficients of a degree: (power, coefficient)."""
    weights = np.zeros((N + 1, N + 1))
    for i in range(degree + 1):
        weights[i, i : degree + 1] = [comb(j, i) / comb(degree, i) for j in range(i, degree + 1)]
    return weights


_WEIGHTS = cython.declare(cython.double[:, :, ::1], np.array([_weights(n) for n in range(N + 1)]))


def workspace() -> FloatArray:
    """Room for `first_descent`: the coefficients at every depth of halving."""
    return np.zeros((DEEPEST + 2, N + 1))


def first_descent_of(powers: FloatArray, floor: float) -> float | None:
    """Where sum powers[i] x**i, not negative at 0, first descends through zero to below -floor.

    Parameters
    ----------
    powers : (20,)
    floor : float
        Depth that is rounding, >= 0.

    Returns
    -------
    float or None
        The root in [0, 1], to rounding; None where there is none.

    Examples
    --------
    >>> import numpy as np
    >>> p = np.zeros(20); p[:3] = 0.24, -1.0, 1.0  # (x - 0.4) (x - 0.6)
    >>> round(first_descent_of(p, 0.0), 15)
    0.4
    >>> p[0] = 0.25  # touches
    >>> first_descent_of(p, 1e-15) is None
    True
    """
    row = np.ascontiguousarray(powers, dtype=np.float64).reshape(1, -1)
    found = first_descent(row, 0, floor, workspace())
    return found if found >= 0.0 else None


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def first_descent(
    powers: cython.double[:, ::1],
    k: cython.Py_ssize_t,
    floor: cython.double,
    work: cython.double[:, ::1],
) -> cython.double:
    """The root for row k of the powers, -1 where there is none."""
    i: cython.int
    j: cython.int
    degree: cython.int
    leading: cython.int = 0
    change: cython.double = 0.0
    while leading < _N and powers[k, leading] == 0.0:
        leading += 1
    for i in range(leading + 1, _N + 1):
        change += fabs(powers[k, i])
    if powers[k, leading] - change >= -floor:
        return -1.0
    degree = _N
    while degree > 1 and fabs(powers[k, degree]) <= NOTHING * change:
        degree -= 1
    for j in range(degree + 1):
        work[0, j] = powers[k, 0]
    for i in range(1, degree + 1):
        for j in range(i, degree + 1):
            work[0, j] += _WEIGHTS[degree, i, j] * powers[k, i]
    return _search(powers, k, degree, floor, work)


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def _search(
    powers: cython.double[:, ::1],
    k: cython.Py_ssize_t,
    degree: cython.int,
    floor: cython.double,
    work: cython.double[:, ::1],
) -> cython.double:
    """Depth first, left before right; row i of work has the coefficients of what waits at depth i.

    An interval at depth i begins at an even multiple of its length 2**-i if it is a left half.
    """
    depth: cython.int = 0
    low: cython.double = 0.0
    verdict: cython.int
    while True:
        verdict = _judge(work, degree, depth, floor)
        if verdict == 2 or (verdict == 3 and depth >= _DEEPEST):
            return low  # it descends from rounding at the very start
        if verdict == 1:
            return _root(powers, k, degree, low, low + ldexp(1.0, -depth), work[depth])
        if verdict == 3:
            _halve(work, degree, depth)
            depth += 1
            continue
        # nothing here: to the right, on the depth of the nearest interval that is a left half
        while depth > 0 and _odd(low, depth):
            low -= ldexp(1.0, -depth)
            depth -= 1
        if depth == 0:
            return -1.0
        low += ldexp(1.0, -depth)
        _mirror(work, degree, depth)


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def _odd(low: cython.double, depth: cython.int) -> cython.bint:
    """Whether the interval at low, 2**-depth long, is a right half."""
    half: cython.double = ldexp(low, depth - 1)
    return half != cython.cast(cython.double, cython.cast(cython.longlong, half))


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def _judge(
    work: cython.double[:, ::1], degree: cython.int, depth: cython.int, floor: cython.double
) -> cython.int:
    """0: no descent; 1: exactly one root; 2: it descends at its start; 3: to be halved."""
    i: cython.int
    first: cython.int = 0
    last: cython.int = 0
    sign: cython.int
    changes: cython.int = 0
    below: cython.bint = False
    for i in range(degree + 1):
        if work[depth, i] < -floor:
            below = True
        if fabs(work[depth, i]) > floor:
            sign = 1 if work[depth, i] > 0.0 else -1
            if first == 0:
                first = sign
            elif sign != last:
                changes += 1
            last = sign
    if not below:
        return 0
    if first < 0:
        return 2
    return 1 if last < 0 and changes == 1 else 3


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def _halve(work: cython.double[:, ::1], degree: cython.int, depth: cython.int) -> cython.void:
    """Row depth + 1 becomes the left half of row depth, which keeps the right one (de Casteljau)."""
    i: cython.int
    j: cython.int
    for j in range(degree + 1):
        work[depth + 1, j] = work[depth, 0]
        for i in range(degree - j):
            work[depth, i] = 0.5 * (work[depth, i] + work[depth, i + 1])


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def _mirror(work: cython.double[:, ::1], degree: cython.int, depth: cython.int) -> cython.void:
    """Row depth becomes the right half that its parent keeps."""
    i: cython.int
    for i in range(degree + 1):
        work[depth, i] = work[depth - 1, i]


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def _root(
    powers: cython.double[:, ::1],
    k: cython.Py_ssize_t,
    degree: cython.int,
    low: cython.double,
    high: cython.double,
    ends: cython.double[::1],
) -> cython.double:
    """Newton's method, kept inside a bracket with the only root: positive at low, negative at high.

    The first of `ends` and that of the degree are the values there, but for rounding; it begins on the line
    between, away from low, where there may be a root as well, of a touch.
    """
    x: cython.double = low + (high - low) * min(max(ends[0] / (ends[0] - ends[degree]), 0.25), 1.0)
    value: cython.double
    slope: cython.double
    bend: cython.double
    new: cython.double
    i: cython.int
    for _ in range(100):
        value = slope = bend = 0.0  # bend is half the second derivative
        for i in range(degree, -1, -1):
            bend = bend * x + slope
            slope = slope * x + value
            value = value * x + powers[k, i]
        if value == 0.0:
            return x
        if value > 0.0:
            low = x
        else:
            high = x
        new = x - value / slope if slope < 0.0 else low
        if not low < new < high:
            new = 0.5 * (low + high)
        elif fabs(bend) * (new - x) * (new - x) <= 1e-17 * fabs(slope):
            return new  # the next step would be less than rounding
        if fabs(new - x) <= 1e-16 or not low < new < high:
            return new
        x = new
    return x
