"""What both ends of a step tell of the way between them: of margins, of the parameter and of outputs."""

from __future__ import annotations

import cython
from cython.cimports.libc.math import fabs, sqrt

from fcm.continuation.front import Front

BLURRED = cython.declare(cython.double, 1e-4)  # a step this short tells more of rounding than of a way back
RISE = cython.declare(
    cython.double, 1e-7
)  # growth of an output over its size, along a unit of arc, that is not rounding
NEARLY_GREATEST = cython.declare(
    cython.double, 0.9
)  # of the greatest so far: below that no peak is looked for
EVEN = cython.declare(
    cython.double, 0.2
)  # of the lesser slope at the ends: a parameter whose slope changes by less goes on evenly
DOUBTFUL = cython.declare(
    cython.double, 0.25
)  # of the lesser slope at the ends: a cubic less steep between them may hide a way back


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
def detour(front: Front, greatest: cython.double[::1]) -> cython.double:
    """Length at which the parameter, or an output, may go the other way than here and there; 0 if none does.

    There are two folds, or a peak and the least value after it, between then. As far as the cubics through
    both ends tell; of outputs those near their greatest.
    """
    k: cython.Py_ssize_t
    size: cython.double
    step: cython.double = front.step
    along: cython.double = step / front.spread()
    if step <= BLURRED:
        return 0.0
    at: cython.double = turning(front)
    for k in range(front.problem.outputs):
        size = max(front.here.output[k], front.there.output[k])
        if at == 0.0 and size >= NEARLY_GREATEST * greatest[k]:
            at = opposite(
                front.there.output[k] - front.here.output[k],
                front.here.growth[k] * step,
                front.there.growth[k] * along,
                RISE * size * step,
            )
    return at * step


@cython.cfunc
@cython.exceptval(-1, check=False)
def turning(front: Front) -> cython.double:
    """The part of the step where the parameter may go the other way than here and there; 0 if nowhere."""
    n: cython.Py_ssize_t = front.problem.unknowns
    unit: cython.double = front.step * front.newton.scale[n]
    return opposite(
        front.there.z[n] - front.here.z[n],
        front.here.tangent[n] * unit,
        front.there.tangent[n] * unit / front.spread(),
        0.0,
    )


@cython.cfunc
@cython.exceptval(-1, check=False)
def even(front: Front) -> cython.bint:
    """Whether the parameter goes on so evenly that corners within the step hide no pair of folds.

    Beyond a corner its slope may change as a root, and back at the next one: the slope at the ends then
    differs, or the way does from that at their mean. Either alone vanishes somewhere.
    """
    n: cython.Py_ssize_t = front.problem.unknowns
    unit: cython.double = front.step * front.newton.scale[n]
    begin: cython.double = front.here.tangent[n] * unit
    end: cython.double = front.there.tangent[n] * unit / front.spread()
    off: cython.double = fabs(2.0 * (front.there.z[n] - front.here.z[n]) - (begin + end))
    return begin * end > 0.0 and max(off, fabs(end - begin)) < EVEN * min(fabs(begin), fabs(end))


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def opposite(
    rise: cython.double, begin: cython.double, end: cython.double, least: cython.double
) -> cython.double:
    """Where in (0, 1) the cubic that rises so much, with slopes of one sign at 0 and 1, goes the other way
    most, or hardly onwards; 0 if it goes on, or the other way by less than the least slope.
    """
    if not begin * end > 0.0:
        return 0.0
    sign: cython.double = 1.0 if begin > 0.0 else -1.0
    a: cython.double = sign * begin
    b: cython.double = sign * (3.0 * rise - 2.0 * begin - end)
    c: cython.double = sign * (begin + end - 2.0 * rise)
    if not c > 0.0:
        return 0.0
    x: cython.double = -b / (3.0 * c)
    return x if 0.0 < x < 1.0 and a + x * b < DOUBTFUL * min(a, sign * end) - least else 0.0


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
