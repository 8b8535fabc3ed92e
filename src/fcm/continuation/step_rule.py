"""The step rule: which step is accepted, and how long the next one is.

A step is good if the curve was where the parabola foretold it, turned gently, kept its orientation, and if
what is reported changed as foreseen. The next step aims at a turn of AIM, a miss of MISS and at UNEVEN.
"""

from __future__ import annotations

import cython
from cython.cimports.libc.math import acos, fabs, sqrt

from fcm.continuation import sharp
from fcm.continuation.front import Front

if cython.compiled:
    from cython.cimports.fcm.continuation.margins import crosses
else:
    from fcm.continuation.margins import crosses

SHARP = cython.declare(cython.double, sharp.SHARP)
COSINE = cython.declare(cython.double, 0.94)  # of the angle that a longer step may turn by: 20 degrees
FAR = cython.declare(cython.double, 0.5)  # of its length, by which a step may miss the curve
AIM = cython.declare(cython.double, 0.2)  # [rad] the turn that a step aims at
MISS = cython.declare(cython.double, 0.03)  # of its length, by which a step aims to miss the curve
UNEVEN = cython.declare(
    cython.double, 0.15
)  # change of an output, over its size, that a step aims not to have foreseen
MOST = cython.declare(cython.double, 4.0)  # times as much a step may have
SHRINK = cython.declare(cython.double, 0.4)  # of a step: the next one is at least that,
GROW = cython.declare(cython.double, 2.5)  # and at most that,
HASTE = cython.declare(cython.double, 10.0)  # or that, where points close to one another tell nothing
SHARE = cython.declare(cython.double, 0.9)  # of the next step that all aims allow


@cython.ccall
@cython.exceptval(-1, check=False)
def good(front: Front) -> cython.bint:
    """Whether the curve was where it was predicted, and went on as it did."""
    if front.step <= SHARP:
        return front.cosine > 0.0
    return kept(front) and front.missed < FAR and front.cosine > COSINE and unforeseen(front) < MOST * UNEVEN


@cython.cfunc
@cython.exceptval(-1, check=False)
def kept(front: Front) -> cython.bint:
    """Whether the orientation is the same here and there: otherwise there may be the far side of a corner."""
    return front.there.orientation == front.here.orientation


@cython.ccall
@cython.exceptval(-1, check=False)
def clear(front: Front, step: cython.double) -> cython.bint:
    """Whether there is a good step of a length before a corner, and no margin changes its sign on it."""
    return front.go(step) and kept(front) and good(front) and not crosses(front)


@cython.ccall
@cython.exceptval(-1, check=False)
def next_step(front: Front, longest: cython.double, hasty: cython.bint) -> cython.double:
    """Length of the step that follows a good one."""
    growth: cython.double = AIM / max(acos(min(front.cosine, 1.0)), 1e-9)
    growth = min(growth, sqrt(MISS / max(front.missed, 1e-9)), UNEVEN / max(unforeseen(front), 1e-9))
    return min(front.step * min(max(SHARE * growth, SHRINK), HASTE if hasty else GROW), longest)


@cython.ccall
@cython.exceptval(-1, check=False)
def unforeseen(front: Front) -> cython.double:
    """Greatest change of the growth of an output over the step, as a change of the output over its
    size."""
    k: cython.Py_ssize_t
    worst: cython.double = 0.0
    size: cython.double
    for k in range(front.problem.outputs):
        size = max(front.here.output[k], front.there.output[k])
        if size > 0.0:
            worst = max(worst, fabs(front.there.growth[k] - front.here.growth[k]) * front.step / size)
    return worst


@cython.ccall
@cython.exceptval(-1, check=False)
def extent(front: Front) -> cython.double:
    """Greatest unit of the unknowns: the size of the solution."""
    i: cython.Py_ssize_t
    most: cython.double = 0.0
    for i in range(front.problem.unknowns):
        most = max(most, front.newton.scale[i])
    return most
