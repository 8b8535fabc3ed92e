"""The way on from a corner: the direction that the curve has beyond it."""

from __future__ import annotations

import cython

from fcm.continuation.front import Front
from fcm.continuation.place import Place

BEYOND = cython.declare(cython.double, 1e-7)  # length past a corner at which the curve is looked for first
FURTHER = cython.declare(cython.int, 3)  # lengths past a corner that are tried, each ten times the last
PIECES = cython.declare(cython.int, 3)  # of those that meet in a corner, which are tried at each
ASTRAY = cython.declare(cython.double, 0.5)  # of the length: a point this far from its prediction is another


@cython.ccall
@cython.exceptval(-1, check=False)
def come(front: Front, place: Place, at: cython.double) -> cython.int:
    """Go to a corner, a place at a length from here, as from before it."""
    place.tangent[:] = front.there.tangent  # that before the corner, on whichever side it was put
    place.growth[:] = front.there.growth
    place.orientation = front.there.orientation
    front.accept(place, at)
    return 0


@cython.ccall
@cython.exceptval(-1, check=False)
def cross(front: Front, stops: cython.double[::1]) -> cython.bint:
    """Go on, from a corner that is here, to the nearest point that the curve is found to have beyond.

    Several margins may be zero here or very near, so that more than two smooth pieces meet; all that is
    nearer is one corner. Where no point is found, or a value of the parameter is passed that is to be landed
    on, only the direction of the curve is taken and here remains.
    """
    count: cython.int
    length: cython.double = BEYOND
    for count in range(FURTHER):  # noqa: B007
        if leaves(front, length):
            take(front, length, not passes(front, stops))
            return True
        length *= 10.0
    aim(front, BEYOND)
    if not onwards(front, BEYOND):
        return False
    take(front, BEYOND, False)
    return True


@cython.cfunc
@cython.exceptval(-1, check=False)
def leaves(front: Front, length: cython.double) -> cython.bint:
    """Whether the corrector comes to a point of the curve that is a length past the corner that is here.

    It is looked for in the direction of the piece into which the curve comes, then in that of the piece into
    which this direction leads, and so on. A point beyond has the orientation of here in the direction in
    which it was looked for; one on the way to the corner has the other.
    """
    count: cython.int
    aim(front, length)
    for count in range(PIECES):  # noqa: B007
        if not onwards(front, length):
            return False
        front.between.z[:] = front.newton.z
        near: cython.bint = front.newton.correct(length) and front.newton.moved < ASTRAY * length
        if near and front.newton.orientation == front.here.orientation:
            return True
        front.newton.z[:] = front.between.z
    return False


@cython.cfunc
@cython.exceptval(-1, check=False)
def onwards(front: Front, length: cython.double) -> cython.bint:
    """Put the corrector a length along the direction that the curve has in the piece where it is now.

    With the orientation that it has here, which is the same in all pieces of a piecewise smooth curve.
    """
    i: cython.Py_ssize_t
    if not front.newton.look():
        return False
    sign: cython.double = 1.0 if front.newton.orientation == front.here.orientation else -1.0
    for i in range(front.here.z.shape[0]):
        front.newton.tangent[i] *= sign
    front.newton.orientation = front.here.orientation
    front.newton.row[:] = front.newton.tangent
    for i in range(front.here.z.shape[0]):
        front.newton.z[i] = front.here.z[i] + length * front.newton.scale[i] * front.newton.row[i]
    return True


@cython.cfunc
@cython.exceptval(check=False)
def passes(front: Front, stops: cython.double[::1]) -> cython.bint:
    """Whether a value of the parameter lies between here and where the corrector is."""
    n: cython.Py_ssize_t = front.here.z.shape[0] - 1
    k: cython.Py_ssize_t
    for k in range(stops.shape[0]):
        if (stops[k] - front.here.z[n]) * (stops[k] - front.newton.z[n]) <= 0.0:
            return True
    return False


@cython.cfunc
@cython.exceptval(-1, check=False)
def take(front: Front, length: cython.double, go: cython.bint) -> cython.int:
    """Go to where the corrector is, a length from here, or take only the direction and the margins there."""
    there: Place = front.between
    front.record(there, True, True)
    there.incline(front.problem, front.newton.scale, front.guess)
    if not go:
        there.z[:] = front.here.z
        there.output[:] = front.here.output
    front.accept(there, 0.0)
    front.past = 0.0 if go else length
    return 0


@cython.ccall
@cython.exceptval(-1, check=False)
def cross_softly(front: Front, past: cython.double) -> cython.bint:
    """Turn, where a label changes, into the direction that the curve has a length past it.

    The labels are those beyond, even if no curve is found. The next place is looked for from as far beyond:
    a curve that nearly goes back is else found on the side that it came from.
    """
    i: cython.Py_ssize_t
    aim(front, past)
    front.problem.bound(front.newton.z)
    front.here.margin[:] = front.problem.margin
    front.aside[:] = 0.0
    if not onwards(front, past):
        return False
    for i in range(front.guess.shape[0]):
        front.aside[i] = past * front.here.tangent[i]
    front.here.tangent[:] = front.newton.tangent
    for i in range(front.guess.shape[0]):
        front.guess[i] = front.newton.scale[i] * front.here.tangent[i]
    if front.problem.outputs:
        front.problem.report(front.here.z, front.guess)
        front.here.growth[:] = front.problem.growth
    return True


@cython.cfunc
@cython.exceptval(check=False)
def aim(front: Front, past: cython.double) -> cython.void:
    """Put the corrector a length along the tangent of here."""
    i: cython.Py_ssize_t
    for i in range(front.here.z.shape[0]):
        front.newton.row[i] = front.here.tangent[i]
        front.newton.z[i] = front.here.z[i] + past * front.newton.scale[i] * front.here.tangent[i]
