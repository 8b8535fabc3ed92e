"""What happens within a step: roots of functions along it, each found on the curve itself."""

from __future__ import annotations

from typing import NamedTuple

import cython
import numpy as np
from cython.cimports.libc.math import sqrt

from fcm.continuation.front import Front
from fcm.continuation.looks import Look, Looks
from fcm.continuation.path import FloatArray, Mark
from fcm.continuation.place import Place
from fcm.continuation.roots import Sought

if cython.compiled:
    from cython.cimports.fcm.continuation.margins import NEARLY_GREATEST, RISE
    from cython.cimports.fcm.continuation.prediction import along
    from cython.cimports.fcm.continuation.problem import DEAR
    from cython.cimports.fcm.continuation.roots import FOLD, LOST, MARGIN, PASSING, PEAK, root, root_within
else:
    from fcm.continuation.margins import NEARLY_GREATEST, RISE
    from fcm.continuation.prediction import along
    from fcm.continuation.problem import DEAR
    from fcm.continuation.roots import FOLD, LOST, MARGIN, PASSING, PEAK, root, root_within

SAME_WAY = cython.declare(cython.double, 0.5)  # cosine beyond which a curve closes, and does not cross itself


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
    """Where within the step a margin changes sign first; LOST if the curve is not found there.

    Of many that change theirs most have not yet done so where another does: their roots are not looked for.
    """
    last, first = front.there, front.step
    for k in _changing(front):
        if front.here.margin[k] * front.here.margin_at(k, last) < 0.0:
            first = min(first, root_within(front, Sought(MARGIN, k)))
            if first == LOST:
                break
            last = front.between
    return first


def _changing(front: Front) -> list[int]:
    """Margins that change sign within the step, those first that seem to be the first."""
    places = {}
    for k in range(front.problem.margins):
        before, after = front.here.margin[k], front.here.margin_at(k, front.there)
        if before * after < 0.0:
            places[k] = before / (before - after)
    return sorted(places, key=lambda k: places[k])


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

    Each look is dear where a problem is soft or has many unknowns; on a curve with many loops most peaks are
    lower than an earlier one.
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
    dear: cython.bint = front.problem.soft or front.problem.unknowns >= DEAR  # what lies between helps
    folds: cython.bint = here.tangent[n] * there.tangent[n] < 0.0
    peaks = [k for k in range(front.problem.outputs) if turns(here, there, k, most[k])]
    looks = Looks(front) if dear and (folds or peaks) else None
    if folds:
        events += located(front, FOLD, 0, limit, Mark.FOLD, looks)
    fold = events[0] if events else None
    for value in values:
        events += passings(front, value, fold)
    for k in peaks:
        if not dear or may_exceed(front, k, most[k]):
            events += located(front, PEAK, k, limit, Mark.PEAK, looks)
    return sorted((event for event in events if event.length <= limit), key=lambda event: event.length)


def located(front: Front, kind: int, k: int, limit: float, mark: int, looks: Looks | None) -> list[Found]:
    """The root of a function along the step, as a list of one point, or none if the curve is not found."""
    if looks is not None:
        look = looks.extreme(None if kind == FOLD else k)
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
