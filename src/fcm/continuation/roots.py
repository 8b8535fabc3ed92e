"""Roots of functions along a step: of a margin, of the slope of the parameter or of an output, and of the
parameter less a value. Each is found on the curve itself; see `looks` for where that is dear."""

from __future__ import annotations

import cython

from fcm.continuation.place import Place
from fcm.continuation.secants import Secants
from fcm.continuation.step import Step

LOOKS = cython.declare(cython.int, 40)  # places looked at to find a root
FINE = cython.declare(cython.double, 1e-11)  # of a step: a root is known to this
LOST = cython.declare(cython.double, -1.0)  # a root that is none
MARGIN = cython.declare(cython.int, 0)  # the functions along a step
FOLD = cython.declare(cython.int, 1)
PEAK = cython.declare(cython.int, 2)
PASSING = cython.declare(cython.int, 3)


@cython.cclass
class Sought:
    """A function along a step: margin k; growth of the parameter, of output k; the parameter less a value."""

    def __init__(self, kind: int, k: int = 0, value: float = 0.0) -> None:
        self.kind, self.k, self.value = kind, k, value


@cython.cfunc
def value(step: Step, place: Place, sought: Sought) -> cython.double:
    """A function along the step; a margin that there is not has not changed its sign."""
    k: cython.Py_ssize_t = sought.k
    if sought.kind == MARGIN:
        margin: cython.double = step.here.margin[k] if place is step.here else step.here.margin_at(k, place)
        return margin if margin != 0.0 else step.here.margin[k]
    if sought.kind == PASSING:
        return place.z[place.z.shape[0] - 1] - sought.value
    return place.tangent[place.tangent.shape[0] - 1] if sought.kind == FOLD else place.growth[k]


@cython.cfunc
def root_within(step: Step, sought: Sought) -> cython.double:
    """Length at which a function changes sign between here and there."""
    before: cython.double = value(step, step.here, sought)
    return root(step, sought, 0.0, step.step, before, value(step, step.there, sought))


@cython.cfunc
def root(
    step: Step,
    sought: Sought,
    low: cython.double,
    high: cython.double,
    before: cython.double,
    after: cython.double,
) -> cython.double:
    """Length at which a function changes sign between two lengths, before and after which it is known.

    Where the curve cannot be found, that length is the root; but of a margin LOST: what is there may be
    another part of a curve that goes back in the corner.
    """
    at: cython.double
    now: cython.double
    count: cython.int
    turning: cython.bint = sought.kind == FOLD or sought.kind == PEAK
    sides: Secants = Secants(low, high, before, after)
    for count in range(LOOKS):  # noqa: B007
        if sides.known(FINE * step.step, sought.kind == MARGIN):
            return min(max(sides.secant, sides.low), sides.high)
        at = sides.at
        if not step.put(at, sought.kind == MARGIN, False):
            return sides.high if turning else LOST
        if turning and not step.sharpen(False, sought.kind == PEAK):
            return sides.high
        now = value(step, step.between, sought)
        if now == 0.0:
            return at
        sides.saw(at, now)
    return sides.high
