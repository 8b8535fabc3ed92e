# cython: wraparound=True
"""What happens within a step: roots of functions along it, each found on the curve itself."""

from __future__ import annotations

from typing import NamedTuple

import cython
import numpy as np
from cython.cimports.libc.math import fabs, sqrt

from fcm.continuation.front import Front
from fcm.continuation.looks import Look, Looks
from fcm.continuation.path import FloatArray, Mark
from fcm.continuation.place import Place

if cython.compiled:
    from cython.cimports.fcm.continuation.margins import NEARLY_GREATEST, RISE
    from cython.cimports.fcm.continuation.prediction import along
else:
    from fcm.continuation.margins import NEARLY_GREATEST, RISE
    from fcm.continuation.prediction import along

LOOKS = cython.declare(cython.int, 40)  # places looked at to find a root
FINE = cython.declare(cython.double, 1e-11)  # of a step: a root is known to this
SAME_WAY = cython.declare(cython.double, 0.5)  # cosine beyond which a curve closes, and does not cross itself
LOST = cython.declare(cython.double, -1.0)  # a root that is none
MARGIN = cython.declare(cython.int, 0)  # the functions along a step
FOLD = cython.declare(cython.int, 1)
PEAK = cython.declare(cython.int, 2)
PASSING = cython.declare(cython.int, 3)


@cython.cclass
class Sought:
    """A function along a step: of margin k, of output k, of the parameter, less a level."""

    kind: cython.int
    k: cython.Py_ssize_t
    level: cython.double

    def __init__(self, kind: int, k: int = 0, level: float = 0.0) -> None:
        self.kind, self.k, self.level = kind, k, level


class Found(NamedTuple):
    """A point of the curve within a step."""

    length: float  # from the beginning of the step
    mark: int  # a `Mark`
    z: FloatArray
    direction: FloatArray
    orientation: float
    shift: float  # from the approximate equations to the exact ones


def found(front: Front, length: float, mark: int, place: Place) -> Found:
    """A place to keep."""
    direction = np.asarray(front.newton.scale) * np.asarray(place.tangent)
    return Found(length, mark, np.array(place.z), direction, place.orientation, front.there.shift)


def seen(front: Front, look: Look, mark: int) -> Found:
    """A look to keep."""
    scale = np.asarray(front.newton.scale)
    return Found(look.at, mark, scale * look.z, scale * look.tangent, look.orientation, front.there.shift)


def first_margin(front: Front) -> float:
    """Where within the step a margin changes sign first; LOST if the curve is not found there."""
    first = front.step
    for k in range(front.problem.margins):
        if front.here.margin[k] * front.here.margin_at(k, front.there) < 0.0:
            first = min(first, root_within(front, Sought(MARGIN, k)))
    return first


@cython.cfunc
@cython.exceptval(-1, check=False)
def quiet(front: Front, values: cython.double[::1], greatest: cython.double[::1]) -> cython.bint:
    """Whether there is nothing within the step."""
    n: cython.Py_ssize_t = front.problem.unknowns
    k: cython.Py_ssize_t
    here: Place = front.here
    there: Place = front.there
    for k in range(values.shape[0]):
        if (values[k] - here.z[n]) * (values[k] - there.z[n]) < 0.0:
            return False
    if here.tangent[n] * there.tangent[n] < 0.0:
        return False
    for k in range(front.problem.outputs):  # noqa: SIM110 - a loop in C
        if turns(here, there, k, greatest[k]):
            return False
    return True


@cython.cfunc
@cython.exceptval(-1, check=False)
def turns(here: Place, there: Place, k: cython.Py_ssize_t, greatest: cython.double) -> cython.bint:
    """Whether an output has a peak that matters between two places."""
    size: cython.double = max(here.output[k], there.output[k])
    if not (here.growth[k] > RISE * size and there.growth[k] < -RISE * size):
        return False
    return size >= NEARLY_GREATEST * greatest


@cython.cfunc
@cython.exceptval(-1, check=False)
def may_exceed(front: Front, k: cython.Py_ssize_t, greatest: cython.double) -> cython.bint:
    """Whether a peak of an output within the step may be the greatest so far, by the slopes at its ends.

    Each look is dear where a problem is soft; on a curve with many loops most peaks are lower than an
    earlier one.
    """
    here: Place = front.here
    there: Place = front.there
    slope: cython.double = max(here.growth[k], -there.growth[k] / front.spread())
    return max(here.output[k], there.output[k]) + front.step * slope >= greatest


@cython.cfunc
@cython.exceptval(-1, check=False)
def closes(front: Front, first: cython.double[::1], head: cython.double[::1]) -> cython.bint:
    """Whether the step passes the point where the curve began, in the direction that it had there."""
    i: cython.Py_ssize_t
    before: cython.double = 0.0
    after: cython.double = 0.0
    far: cython.double = 0.0
    farther: cython.double = 0.0
    for i in range(first.shape[0]):
        one: cython.double = (front.here.z[i] - first[i]) / front.newton.scale[i]
        other: cython.double = (front.there.z[i] - first[i]) / front.newton.scale[i]
        far += one * one
        farther += other * other
        before += one * head[i]
        after += other * head[i]
    if sqrt(min(far, farther)) > front.step:
        return False
    return before < 0.0 <= after and along(front.here.tangent, head) > SAME_WAY


def within(front: Front, limit: float, values: list[float], greatest: FloatArray) -> list[Found]:
    """Folds, peaks and values of the parameter before a limit, a length of the step, in order."""
    n: cython.Py_ssize_t = front.problem.unknowns
    k: cython.Py_ssize_t
    most: cython.double[::1] = greatest
    here: Place = front.here
    there: Place = front.there
    events = []
    looks = Looks(front) if front.problem.soft else None
    if here.tangent[n] * there.tangent[n] < 0.0:
        events += located(front, FOLD, 0, limit, Mark.FOLD, looks)
    fold = events[0] if events else None
    for value in values:
        events += passings(front, value, fold)
    for k in range(front.problem.outputs):
        if turns(here, there, k, most[k]) and (looks is None or may_exceed(front, k, most[k])):
            events += located(front, PEAK, k, limit, Mark.PEAK, looks)
    return sorted((event for event in events if event.length <= limit), key=lambda event: event.length)


def located(front: Front, kind: int, k: int, limit: float, mark: int, looks: Looks | None) -> list[Found]:
    """The root of a function along the step, as a list of one point, or none if the curve is not found."""
    if looks is not None:
        look = looks.turn(None if kind == FOLD else k)
        return [seen(front, look, mark)] if look.at <= limit else []
    at = root_within(front, Sought(kind, k))
    return [found(front, at, mark, front.between)] if at <= limit and front.put(at, False, False) else []


def passings(front: Front, value: float, fold: Found | None) -> list[Found]:
    """Where the parameter passes a value: once on the way, or on either side of a fold.

    At a value next to a fold the equations have two solutions close together, either of which may be found,
    or none, so that there the place is looked for along the step.
    """
    n: cython.Py_ssize_t = front.problem.unknowns
    begin: float = front.here.z[n] - value
    end: float = front.there.z[n] - value
    if fold is not None:
        top = float(fold.z[n]) - value
        return passing(front, value, 0.0, fold.length, begin, top) + passing(
            front, value, fold.length, front.step, top, end
        )
    if begin * end < 0.0 and front.land(value) and 0.0 <= front.length(front.between) <= front.step:
        return [found(front, front.length(front.between), Mark.STATION, front.between)]
    return passing(front, value, 0.0, front.step, begin, end)


def passing(front: Front, value: float, low: float, high: float, before: float, after: float) -> list[Found]:
    """Where the parameter passes a value between two lengths, at which it is greater by before and after."""
    if not before * after < 0.0:
        return []
    at = root(front, Sought(PASSING, 0, value), low, high, before, after)
    if at == LOST or not front.put(at, False, False):
        return []
    front.between.z[front.problem.unknowns] = value
    return [found(front, at, Mark.STATION, front.between)]


@cython.cfunc
def value(front: Front, place: Place, sought: Sought) -> cython.double:
    """A function along the step; a margin that there is not has not changed its sign."""
    k: cython.Py_ssize_t = sought.k
    if sought.kind == MARGIN:
        margin: cython.double = (
            front.here.margin[k] if place is front.here else front.here.margin_at(k, place)
        )
        return margin if margin != 0.0 else front.here.margin[k]
    if sought.kind == PASSING:
        return place.z[place.z.shape[0] - 1] - sought.level
    return place.tangent[place.tangent.shape[0] - 1] if sought.kind == FOLD else place.growth[k]


@cython.cfunc
def root_within(front: Front, sought: Sought) -> cython.double:
    """Length at which a function changes sign between here and there."""
    before: cython.double = value(front, front.here, sought)
    return root(front, sought, 0.0, front.step, before, value(front, front.there, sought))


@cython.cfunc
def root(
    front: Front,
    sought: Sought,
    low: cython.double,
    high: cython.double,
    before: cython.double,
    after: cython.double,
) -> cython.double:
    """Length at which a function changes sign between two lengths, before and after which it is known.

    By the secant through the last two places; or halfway between those that enclose the root, where that
    leads out of them, or three looks have not halved their distance. Where the curve cannot be found, that
    length is the root; but of a margin LOST: what is there may be another part of a curve that goes back in
    the corner.
    """
    at: cython.double
    now: cython.double
    rise: cython.double
    count: cython.int
    width: cython.double = high - low
    last: cython.double = low
    value_last: cython.double = before
    here: cython.double = high
    value_here: cython.double = after
    fine: cython.double = FINE * front.step
    turning: cython.bint = sought.kind == FOLD or sought.kind == PEAK
    for count in range(LOOKS):
        rise = value_here - value_last
        at = here - value_here * (here - last) / rise if rise != 0.0 else low
        if fabs(at - here) <= fine or high - low <= fine:
            return min(max(at, low), high)
        if count % 3 == 2:
            at = at if high - low <= 0.5 * width else low
            width = high - low
        if not low < at < high:
            at = 0.5 * (low + high)
        if not front.put(at, sought.kind == MARGIN, False):
            return high if turning else LOST
        if turning and not front.sharpen(False, sought.kind == PEAK):
            return high
        now = value(front, front.between, sought)
        if now == 0.0:
            return at
        last, value_last, here, value_here = here, value_here, at, now
        if now * before > 0.0:
            low = at
        else:
            high = at
    return high
