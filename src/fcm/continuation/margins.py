"""What the margins at both ends of a step tell of the way between them."""

from __future__ import annotations

import cython
from cython.cimports.libc.math import sqrt

from fcm.continuation.front import Front


@cython.cfunc
@cython.exceptval(-1, check=False)
def dip(front: Front) -> cython.double:
    """Length at which a margin of one sign here and there has the other between them; 0 if none has.

    As far as the cubic through both ends, with their slopes, tells.
    """
    i: cython.Py_ssize_t
    k: cython.Py_ssize_t
    at: cython.double
    first: cython.double = front.step
    for k in range(front.problem.margins):
        i = front.here.partner(k, front.there.kind, front.there.angle)
        if i >= 0 and front.here.margin[k] * front.there.margin[i] > 0.0:
            at = lowest(
                front.here.margin[k],
                front.here.slope[k] * front.step,
                front.there.margin[i],
                front.there.slope[i] * front.step / front.spread(),
            )
            if 0.0 < at * front.step < first:
                first = at * front.step
    return first if first < front.step else 0.0


@cython.cfunc
@cython.exceptval(-1, check=False)
def crosses(front: Front) -> cython.bint:
    """Whether a margin changes sign from here to there."""
    k: cython.Py_ssize_t
    for k in range(front.problem.margins):
        if front.here.margin[k] * front.here.margin_at(k, front.there) < 0.0:
            return True
    return False


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def lowest(
    before: cython.double, begin: cython.double, after: cython.double, end: cython.double
) -> cython.double:
    """Where in (0, 1) the cubic with values of one sign and slopes at 0 and 1 is furthest beyond 0; 0 if it
    is not."""
    sign: cython.double = 1.0 if before > 0.0 else -1.0
    a: cython.double = sign * begin
    b: cython.double = sign * (3.0 * (after - before) - 2.0 * begin - end)
    c: cython.double = sign * (begin + end - 2.0 * (after - before))
    root: cython.double = b * b - 3.0 * a * c
    if not (a < 0.0 and sign * end > 0.0 and root > 0.0):
        return 0.0
    x: cython.double = -a / (b + sqrt(root)) if b > 0.0 else (sqrt(root) - b) / (3.0 * c)
    return x if 0.0 < x < 1.0 and sign * before + x * (a + x * (b + x * c)) < 0.0 else 0.0
