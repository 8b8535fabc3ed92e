"""The way on from a corner: the direction that the curve has beyond it."""

from __future__ import annotations

import cython

from fcm.continuation.front import Front
from fcm.continuation.place import Place

NEARER = cython.declare(cython.int, 3)  # lengths past a corner that are tried
CLOSER = cython.declare(cython.double, 0.01)  # each of them this share of the last


@cython.ccall
@cython.exceptval(-2, check=False)
def come(front: Front, place: Place, at: cython.double, which: cython.Py_ssize_t) -> cython.Py_ssize_t:
    """Go to a corner, a place at a length from here, as from before it; which margin is zero there."""
    same: cython.Py_ssize_t = front.here.partner(which, place.kind, place.angle)
    if same >= 0:
        place.margin[same] = front.here.margin[which]
    place.tangent[:] = front.there.tangent  # that before the corner, on whichever side it was put
    place.growth[:] = front.there.growth
    place.orientation = front.there.orientation
    front.accept(place, at)
    return same


@cython.ccall
@cython.exceptval(-1, check=False)
def cross(front: Front, which: cython.Py_ssize_t, past: cython.double) -> cython.bint:
    """Turn, at a corner that is here, into the direction that the curve has a length past it.

    It goes on to where the margin has the other sign; where that does not tell, as the orientation says,
    which is the same on both sides of a piecewise smooth curve. The margins are then those beyond.
    """
    count: cython.int
    sign: cython.double = 1.0
    before: cython.double = front.here.margin[which] if which >= 0 else 0.0
    for count in range(NEARER):  # noqa: B007
        aim(front, past)
        if not front.newton.look():
            return False
        sign = 1.0 if front.newton.orientation == front.here.orientation else -1.0
        if not before * beyond(front, which, sign * past) > 0.0:
            break
        if not before * beyond(front, which, -sign * past) < 0.0:
            beyond(front, which, sign * past)
            break
        # the two disagree: the curve may bend by much within that length
        sign, past = -sign, CLOSER * past
    bear(front, sign)
    adopt(front, which, before)
    front.past = past
    return True


@cython.ccall
@cython.exceptval(-1, check=False)
def cross_softly(front: Front, past: cython.double) -> cython.bint:
    """Turn, where a label changes, into the direction that the curve has a length past it.

    The orientation is the same on both sides. The labels are those beyond, even if no curve is found.
    """
    aim(front, past)
    front.problem.bound(front.newton.z)
    front.here.margin[:] = front.problem.margin
    if not front.newton.look():
        return False
    bear(front, 1.0 if front.newton.orientation == front.here.orientation else -1.0)
    return True


@cython.cfunc
@cython.exceptval(check=False)
def aim(front: Front, past: cython.double) -> cython.void:
    """Put the corrector a length along the tangent of here."""
    i: cython.Py_ssize_t
    for i in range(front.here.z.shape[0]):
        front.newton.row[i] = front.here.tangent[i]
        front.newton.z[i] = front.here.z[i] + past * front.newton.scale[i] * front.here.tangent[i]


@cython.cfunc
@cython.exceptval(-1, check=False)
def bear(front: Front, sign: cython.double) -> cython.int:
    """Take the corrector's direction, with a sign, as that of here."""
    i: cython.Py_ssize_t
    front.here.orientation = sign * front.newton.orientation
    for i in range(front.here.z.shape[0]):
        front.here.tangent[i] = sign * front.newton.tangent[i]
        front.guess[i] = front.newton.scale[i] * front.here.tangent[i]
    if front.problem.outputs:
        front.problem.report(front.here.z, front.guess)
        front.here.growth[:] = front.problem.growth
    return 0


@cython.cfunc
@cython.exceptval(-1e300, check=False)
def beyond(front: Front, which: cython.Py_ssize_t, past: cython.double) -> cython.double:
    """A margin of here at a length along the corrector's tangent; 0 if it is not there."""
    i: cython.Py_ssize_t
    for i in range(front.guess.shape[0]):
        front.guess[i] = front.here.z[i] + past * front.newton.scale[i] * front.newton.tangent[i]
    front.problem.bound(front.guess)
    return front.here.asked(which, front.problem) if which >= 0 else 0.0


@cython.cfunc
@cython.exceptval(-1, check=False)
def adopt(front: Front, which: cython.Py_ssize_t, before: cython.double) -> cython.int:
    """Take the margins last asked for; one that has not changed its sign is only touched."""
    i: cython.Py_ssize_t = -1
    if which >= 0:
        i = front.here.partner(which, front.problem.kind, front.problem.angle)
    front.here.bounded(front.problem)
    if i >= 0 and front.here.margin[i] * before > 0.0:
        front.here.margin[i] = 0.0
    front.here.incline(front.problem, front.newton.scale, front.guess)
    return 0
