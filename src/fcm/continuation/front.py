"""The advancing end of a curve: the place it has come to, the next one, and places between the two.

Lengths are measured in the problem's scale at the place `here`. A place at the length s lies in the plane
through here + s tangent whose normal is that tangent.
"""

from __future__ import annotations

import cython
import numpy as np
from cython.cimports.libc.math import fabs, sqrt

from fcm.continuation.newton import Newton

if cython.compiled:
    from cython.cimports.fcm.continuation.problem import NONE, Problem
else:
    from fcm.continuation.problem import NONE, Problem

NAN = cython.declare(cython.double, float("nan"))
ASTRAY = cython.declare(cython.double, 0.3)  # of a step: approximate equations that move it further mislead
LOOKS = cython.declare(cython.int, 50)  # bisections of the predicted step to where a margin changes sign
NEARER = cython.declare(cython.int, 3)  # lengths past a corner that are tried
CLOSER = cython.declare(cython.double, 0.01)  # each of them this share of the last
AHEAD = cython.declare(cython.double, 1e-6)  # length over which margins have their slopes
PI = cython.declare(cython.double, 3.141592653589793)
APART = cython.declare(cython.double, 1.0)  # [rad] margins this far from one another are not the same
KNOWN = cython.declare(cython.double, 1e-4)  # of the length to there, to which it is found
ROUGHLY = cython.declare(cython.double, 2e-3)  # and where a label changes


@cython.cclass
class Place:
    """A point of the curve with what the problem says of it; the tangent in scaled coordinates, a unit
    vector."""

    def __init__(self, problem: Problem) -> None:
        self.z, self.tangent = np.zeros(problem.unknowns + 1), np.zeros(problem.unknowns + 1)
        self.margin, self.angle = np.zeros(problem.margins), np.zeros(problem.margins)
        self.kind = np.zeros(problem.margins, dtype=np.intc)
        self.slope = np.zeros(problem.margins)  # of the margins, along a unit of length
        self.output, self.growth = np.zeros(problem.outputs), np.zeros(problem.outputs)
        self.orientation, self.shift = 0.0, 0.0


@cython.cclass
class Front:
    """See the module. `go` finds the place there, `put` one between, `accept` makes one of them here."""

    def __init__(self, problem: Problem) -> None:
        size = problem.unknowns + 1
        self.problem, self.newton = problem, Newton(problem)
        self.here, self.there, self.between = Place(problem), Place(problem), Place(problem)
        self.bend, self.guess = np.zeros(size), np.zeros(size)
        self.step, self.missed, self.turn, self.which = 0.0, 0.0, 1.0, -1
        self.past = 0.0  # up to here the margins beyond a corner are taken as known

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def begin(self, z: cython.double[::1], row: cython.double[::1]) -> cython.int:
        """Start from near z, moved to the curve in the plane of row; 0 if there is no curve."""
        self.problem.measure(z)
        self.newton.scale[:] = self.problem.scale
        self.newton.z[:] = z
        self.newton.row[:] = row
        if not self.newton.correct(1.0):
            return 0
        self.problem.measure(self.newton.z)  # the guess may have been far larger than the solution
        self.newton.scale[:] = self.problem.scale
        if not self.newton.correct(1.0):
            return 0
        self.record(self.here, True, True)
        self.bend[:] = 0.0
        return 1

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def ahead(self, step: cython.double) -> cython.double:
        """The step, or where on it the prediction comes to the first change of sign of a margin: of which."""
        count: cython.int
        at: cython.double
        before: cython.double
        after: cython.double
        low: cython.double = self.past
        high: cython.double = step
        width: cython.double = 2.0 * step
        aside: cython.double = KNOWN / 3.0  # of the root, to come to either side of it
        if self.problem.soft:
            return self.softly(step)
        if self.problem.margins == 0 or step <= low or not self.crossed(step):
            return step
        before, after = self.here.margin[self.which], self.value(self.which)
        for count in range(LOOKS):
            if high - low < KNOWN * high:
                break
            at = (low * after - high * before) / (after - before) + aside * high
            if not low < at < high or (count % 3 == 2 and high - low > 0.5 * width):
                at = 0.5 * (low + high)
            width = high - low if count % 3 == 0 else width
            which: cython.Py_ssize_t = self.which
            if self.crossed(at):
                high, after, aside = at, self.value(self.which), -KNOWN / 3.0
                before = before if which == self.which else -after  # of another: by halves at first
            else:
                low, aside = at, KNOWN / 3.0
                before = self.value(which) or before
        return high

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def softly(self, step: cython.double) -> cython.double:
        """The step, or where on it a label of the prediction changes: a label has no root, but halves."""
        count: cython.int
        low: cython.double = 0.0
        high: cython.double = step
        if self.problem.margins == 0 or not self.crossed(step):
            return step
        for count in range(LOOKS):  # noqa: B007
            if high - low < ROUGHLY * high:
                break
            if self.crossed(0.5 * (low + high)):
                high = 0.5 * (low + high)
            else:
                low = 0.5 * (low + high)
        return high

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def crossed(self, step: cython.double) -> cython.bint:
        """Whether the prediction a step ahead has a margin of the other sign than here, or a label of
        another value; which is then one of those."""
        k: cython.Py_ssize_t
        self.predict(step)
        self.problem.bound(self.guess)
        for k in range(self.problem.margins):
            if self.problem.soft:
                changed: cython.bint = self.problem.margin[k] != self.here.margin[k]
            else:
                changed = self.value(k) * self.here.margin[k] < 0.0
            if changed:
                self.which = k
                return True
        return False

    @cython.cfunc
    @cython.exceptval(check=False)
    def value(self, k: cython.Py_ssize_t) -> cython.double:
        """The margin last asked for that is the one with number k here; 0 if none is."""
        i: cython.Py_ssize_t = self.partner(k, self.problem.kind, self.problem.angle)
        return self.problem.margin[i] if i >= 0 else 0.0

    @cython.ccall
    @cython.exceptval(-2, check=False)
    def partner(
        self, k: cython.Py_ssize_t, kind: cython.int[::1], angle: cython.double[::1]
    ) -> cython.Py_ssize_t:
        """Which of other margins is the one with number k here; -1 if none is."""
        return partner(self.here, k, kind, angle)

    @cython.ccall
    @cython.exceptval(-1e300, check=False)
    def margin(self, k: cython.Py_ssize_t, place: Place) -> cython.double:
        """The margin at a place that is the one with number k here; 0 if none is."""
        i: cython.Py_ssize_t = self.partner(k, place.kind, place.angle)
        return place.margin[i] if i >= 0 else 0.0

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def go(self, step: cython.double) -> cython.bint:
        """Find the place there at a step; missed and turn say how well it was predicted."""
        i: cython.Py_ssize_t
        missed: cython.double = 0.0
        self.predict(step)
        self.newton.z[:] = self.guess
        self.newton.row[:] = self.here.tangent
        if not self.sought(step):
            return False
        self.turn = 0.0
        for i in range(self.here.tangent.shape[0]):
            self.turn += self.here.tangent[i] * self.newton.tangent[i]
            missed += ((self.newton.z[i] - self.guess[i]) / self.newton.scale[i]) ** 2
        self.step, self.missed = step, sqrt(missed) / step
        self.record(self.there, True, True)
        self.incline(self.there)
        return True

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def sought(self, step: cython.double) -> cython.bint:
        """Correct the place there, with the approximate equations first if there are any.

        What the exact ones then change is its shift; NaN where the approximate ones had no solution.
        """
        near: cython.bint = False
        if self.problem.coarse:
            self.problem.refine(False)
            near = self.newton.correct(step) and self.newton.moved < ASTRAY * step
            self.problem.refine(True)
            near = near and self.newton.correct(step) and self.newton.moved < ASTRAY * step
            if near:
                self.there.shift = self.newton.moved
                return True
            self.newton.z[:] = self.guess
            self.there.shift = NAN
        return self.newton.correct(step)

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def put(self, at: cython.double, margins: cython.bint, outputs: cython.bint) -> cython.bint:
        """Find the place between here and there at a length from here, with its margins, its outputs."""
        self.interpolate(at)
        self.newton.z[:] = self.guess
        self.newton.row[:] = self.here.tangent
        if not self.newton.correct(at):
            return False
        self.record(self.between, margins, outputs)
        return True

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def land(self, parameter: cython.double) -> cython.bint:
        """Find the place between here and there with a value of the parameter between theirs."""
        n: cython.Py_ssize_t = self.problem.unknowns
        rise: cython.double = self.there.z[n] - self.here.z[n]
        self.interpolate(self.step * (parameter - self.here.z[n]) / rise)
        self.newton.z[:] = self.guess
        self.newton.z[n] = parameter
        self.newton.row[:] = 0.0
        self.newton.row[n] = 1.0 if rise > 0.0 else -1.0
        if not self.newton.correct(self.step) or self.newton.moved > self.step:
            return False
        self.newton.z[n] = parameter
        self.record(self.between, False, False)
        return True

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def accept(self, place: Place, length: cython.double) -> cython.int:
        """Go on from a place at a length from here, 0 beyond a corner, in the scale that is right for it."""
        i: cython.Py_ssize_t
        size: cython.Py_ssize_t = place.z.shape[0]
        along: cython.double = 0.0
        total: cython.double = 0.0
        ratio: cython.double
        self.problem.measure(place.z)
        for i in range(size):
            ratio = self.newton.scale[i] / self.problem.scale[i]
            self.bend[i] = (place.tangent[i] - self.here.tangent[i]) / length * ratio if length > 0.0 else 0.0
            place.tangent[i] *= ratio
            total += place.tangent[i] * place.tangent[i]
        total = sqrt(total)
        for i in range(size):
            place.tangent[i] /= total
            along += place.tangent[i] * self.bend[i]
        for i in range(size):
            self.bend[i] = (self.bend[i] - along * place.tangent[i]) / total
        self.past = 0.0
        self.newton.scale[:] = self.problem.scale
        self.here.z[:] = place.z
        self.here.tangent[:] = place.tangent
        self.here.margin[:] = place.margin
        self.here.kind[:] = place.kind
        self.here.angle[:] = place.angle
        for i in range(place.slope.shape[0]):
            self.here.slope[i] = place.slope[i] / total
        self.here.output[:] = place.output
        self.here.orientation = place.orientation
        for i in range(place.growth.shape[0]):
            self.here.growth[i] = place.growth[i] / total
        return 0

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def sharpen(self, margins: cython.bint, outputs: cython.bint) -> cython.bint:
        """Give the place between here and there the direction that it has exactly there.

        That of the corrector is from before its last step.
        """
        if not self.newton.look():
            return False
        self.record(self.between, margins, outputs)
        return True

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def shorten(self, at: cython.double) -> cython.bint:
        """Make the place at a length from here the one there, with the direction that it has exactly
        there."""
        i: cython.Py_ssize_t
        if not self.put(at, False, False) or not self.sharpen(True, True):
            return False
        self.step, self.turn = at, 0.0
        for i in range(self.here.tangent.shape[0]):
            self.turn += self.here.tangent[i] * self.between.tangent[i]
        self.there, self.between = self.between, self.there
        return True

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def cross(self, which: cython.Py_ssize_t, past: cython.double) -> cython.bint:
        """Turn, at a corner that is here, into the direction that the curve has a length past it.

        It goes on to where the margin has the other sign; where that does not tell, as the orientation says,
        which is the same on both sides of a piecewise smooth curve. The margins are then those beyond.
        """
        i: cython.Py_ssize_t
        count: cython.int
        sign: cython.double = 1.0
        size: cython.Py_ssize_t = self.here.z.shape[0]
        before: cython.double = self.here.margin[which] if which >= 0 else 0.0
        self.newton.row[:] = self.here.tangent
        for count in range(NEARER):  # noqa: B007
            for i in range(size):
                self.newton.z[i] = self.here.z[i] + past * self.newton.scale[i] * self.here.tangent[i]
            if not self.newton.look():
                return False
            sign = 1.0 if self.newton.orientation == self.here.orientation else -1.0
            if not before * self.beyond(which, sign * past) > 0.0:
                break
            if not before * self.beyond(which, -sign * past) < 0.0:
                self.beyond(which, sign * past)
                break
            # the two disagree: the curve may bend by much within that length
            sign, past = -sign, CLOSER * past
        self.bear(sign)
        self.adopt(which, before)
        self.past = past
        return True

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def cross_softly(self, past: cython.double) -> cython.bint:
        """Turn, where a label changes, into the direction that the curve has a length past it.

        The orientation is the same on both sides. The labels are those beyond, even if no curve is found.
        """
        i: cython.Py_ssize_t
        self.newton.row[:] = self.here.tangent
        for i in range(self.here.z.shape[0]):
            self.newton.z[i] = self.here.z[i] + past * self.newton.scale[i] * self.here.tangent[i]
        self.problem.bound(self.newton.z)
        self.here.margin[:] = self.problem.margin
        if not self.newton.look():
            return False
        self.bear(1.0 if self.newton.orientation == self.here.orientation else -1.0)
        return True

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def bear(self, sign: cython.double) -> cython.int:
        """Take the corrector's direction, with a sign, as that of here."""
        i: cython.Py_ssize_t
        self.here.orientation = sign * self.newton.orientation
        for i in range(self.here.z.shape[0]):
            self.here.tangent[i] = sign * self.newton.tangent[i]
            self.guess[i] = self.newton.scale[i] * self.here.tangent[i]
        if self.problem.outputs:
            self.problem.report(self.here.z, self.guess)
            self.here.growth[:] = self.problem.growth
        return 0

    @cython.cfunc
    @cython.exceptval(-1e300, check=False)
    def beyond(self, which: cython.Py_ssize_t, past: cython.double) -> cython.double:
        """A margin of here at a length along the corrector's tangent; 0 if it is not there."""
        i: cython.Py_ssize_t
        for i in range(self.guess.shape[0]):
            self.guess[i] = self.here.z[i] + past * self.newton.scale[i] * self.newton.tangent[i]
        self.problem.bound(self.guess)
        return self.value(which) if which >= 0 else 0.0

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def adopt(self, which: cython.Py_ssize_t, before: cython.double) -> cython.int:
        """Take the margins last asked for; one that has not changed its sign is only touched."""
        i: cython.Py_ssize_t = -1
        if which >= 0:
            i = self.partner(which, self.problem.kind, self.problem.angle)
        self.here.margin[:] = self.problem.margin
        self.here.kind[:] = self.problem.kind
        self.here.angle[:] = self.problem.angle
        if i >= 0 and self.here.margin[i] * before > 0.0:
            self.here.margin[i] = 0.0
        self.incline(self.here)
        return 0

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def incline(self, place: Place) -> cython.int:
        """The slopes of a place's margins along its tangent, from differences."""
        i: cython.Py_ssize_t
        k: cython.Py_ssize_t
        if self.problem.margins == 0 or self.problem.soft:
            return 0
        for i in range(self.guess.shape[0]):
            self.guess[i] = place.z[i] + AHEAD * self.newton.scale[i] * place.tangent[i]
        self.problem.bound(self.guess)
        for k in range(self.problem.margins):
            place.slope[k] = 0.0
            i = partner(place, k, self.problem.kind, self.problem.angle)
            if i >= 0:
                place.slope[k] = (self.problem.margin[i] - place.margin[k]) / AHEAD
        return 0

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def dip(self) -> cython.double:
        """Length at which a margin of one sign here and there has the other between them; 0 if none has.

        As far as the cubic through both ends, with their slopes, tells.
        """
        i: cython.Py_ssize_t
        k: cython.Py_ssize_t
        at: cython.double
        first: cython.double = self.step
        for k in range(self.problem.margins):
            i = self.partner(k, self.there.kind, self.there.angle)
            if i >= 0 and self.here.margin[k] * self.there.margin[i] > 0.0:
                at = lowest(
                    self.here.margin[k],
                    self.here.slope[k] * self.step,
                    self.there.margin[i],
                    self.there.slope[i] * self.step / greater(self.turn, 0.1),
                )
                if 0.0 < at * self.step < first:
                    first = at * self.step
        return first if first < self.step else 0.0

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def crosses(self) -> cython.bint:
        """Whether a margin changes sign from here to there."""
        k: cython.Py_ssize_t
        for k in range(self.problem.margins):
            if self.here.margin[k] * self.margin(k, self.there) < 0.0:
                return True
        return False

    @cython.ccall
    @cython.exceptval(-1e300, check=False)
    def length(self, place: Place) -> cython.double:
        """Of the way from here to the plane that a place lies in."""
        i: cython.Py_ssize_t
        total: cython.double = 0.0
        for i in range(place.z.shape[0]):
            total += self.here.tangent[i] * (place.z[i] - self.here.z[i]) / self.newton.scale[i]
        return total

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def extent(self) -> cython.double:
        """Greatest unit of the unknowns: the size of the solution."""
        i: cython.Py_ssize_t
        most: cython.double = 0.0
        for i in range(self.problem.unknowns):
            most = greater(most, self.newton.scale[i])
        return most

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def unforeseen(self) -> cython.double:
        """Greatest change of the growth of an output over the step, as a change of the output over its
        size."""
        k: cython.Py_ssize_t
        worst: cython.double = 0.0
        size: cython.double
        for k in range(self.problem.outputs):
            size = greater(self.here.output[k], self.there.output[k])
            if size > 0.0:
                worst = greater(worst, fabs(self.there.growth[k] - self.here.growth[k]) * self.step / size)
        return worst

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def record(self, place: Place, margins: cython.bint, outputs: cython.bint) -> cython.int:
        """The corrector's result as a place, with its margins, its outputs."""
        i: cython.Py_ssize_t
        place.z[:] = self.newton.z
        place.tangent[:] = self.newton.tangent
        place.orientation = self.newton.orientation
        if margins and self.problem.margins:
            self.problem.bound(place.z)
            place.margin[:] = self.problem.margin
            place.kind[:] = self.problem.kind
            place.angle[:] = self.problem.angle
        if outputs and self.problem.outputs:
            for i in range(place.z.shape[0]):
                self.guess[i] = self.newton.scale[i] * place.tangent[i]
            self.problem.report(place.z, self.guess)
            place.output[:] = self.problem.output
            place.growth[:] = self.problem.growth
        return 0

    @cython.cfunc
    @cython.exceptval(check=False)
    def predict(self, step: cython.double) -> cython.void:
        """A parabola from here along the tangent, with the bend of the last step."""
        i: cython.Py_ssize_t
        for i in range(self.guess.shape[0]):
            self.guess[i] = self.here.z[i] + self.newton.scale[i] * step * (
                self.here.tangent[i] + 0.5 * step * self.bend[i]
            )

    @cython.cfunc
    @cython.exceptval(check=False)
    def interpolate(self, at: cython.double) -> cython.void:
        """The cubic through here and there with their tangents."""
        i: cython.Py_ssize_t
        x: cython.double = at / self.step
        slope: cython.double = self.step / greater(self.turn, 0.1)
        for i in range(self.guess.shape[0]):
            self.guess[i] = (
                self.here.z[i] * (1.0 + 2.0 * x) * (1.0 - x) * (1.0 - x)
                + self.there.z[i] * x * x * (3.0 - 2.0 * x)
                + self.newton.scale[i]
                * (
                    self.step * self.here.tangent[i] * x * (1.0 - x) * (1.0 - x)
                    - slope * self.there.tangent[i] * x * x * (1.0 - x)
                )
            )


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def greater(a: cython.double, b: cython.double) -> cython.double:
    return a if a > b else b


@cython.cfunc
@cython.exceptval(check=False)
def partner(
    place: Place, k: cython.Py_ssize_t, kind: cython.int[::1], angle: cython.double[::1]
) -> cython.Py_ssize_t:
    """Which of other margins is the one with number k of a place; -1 if none is.

    It is that of its kind nearest to it, if it is also nearest to that.
    """
    i: cython.Py_ssize_t
    if place.kind[k] == NONE:
        return -1
    if kind[k] == place.kind[k] and angle[k] == place.angle[k]:
        return k
    i = nearest(place.kind[k], place.angle[k], kind, angle)
    return i if i >= 0 and nearest(kind[i], angle[i], place.kind, place.angle) == k else -1


@cython.cfunc
@cython.exceptval(check=False)
def nearest(
    wanted: cython.int, at: cython.double, kind: cython.int[::1], angle: cython.double[::1]
) -> cython.Py_ssize_t:
    """The number of that of a kind whose angle is nearest to one given; -1 if there is none near it."""
    i: cython.Py_ssize_t
    best: cython.Py_ssize_t = -1
    least: cython.double = APART
    for i in range(kind.shape[0]):
        if kind[i] == wanted:
            off: cython.double = fabs(at - angle[i])
            off = off if off <= PI else fabs(2.0 * PI - off)
            if off < least:
                least, best = off, i
    return best


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
