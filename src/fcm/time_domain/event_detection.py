"""The first exit of a segment that is passed: none missed, and most steps not looked at one by one.

The exits are known on up to `BLOCK` steps at once; a cubic and a bound of what it leaves out say in which of
these steps one may be passed, and only there its power series is searched.

There the first descent through zero on [0, 1] is found, none missed. The Bernstein coefficients of a
polynomial enclose its values: where none is negative, neither is the polynomial; where their sign changes
once, it has exactly one root. Otherwise the interval is halved. The way from powers to Bernstein coefficients
is a sum with weights between 0 and 1, so it is accurate.
"""

from __future__ import annotations

from math import comb

import cython
import numpy as np
from cython.cimports.libc.math import fabs, ldexp

from fcm.model.scene import FloatArray
from fcm.time_domain.segments import BLOCK, ORDER

if cython.compiled:
    from cython.cimports.fcm.time_domain.flow import Flows
else:
    from fcm.time_domain.flow import Flows

N = 19  # degree, ORDER of fcm.time_domain.segments
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


DEPTH = cython.declare(cython.double, 1e-13)  # an exit that is passed by less, relative to its size, is not
UNSEEN = cython.declare(cython.double, 1e300)  # bound of what no step has been looked at for
_ORDER = cython.declare(cython.int, 19)
_FIRST = cython.declare(cython.int, 2)  # a segment's first look is at 2**2 steps, for many are short
_WHOLE = cython.declare(cython.int, 3)  # BLOCK is 2**3 steps


@cython.cclass
class EventDetector:
    """Goes along the flow `slot`; of exits that are zero at its start, `touched`, the series are in `powers`.

    Where the segment ends, `there` is the state before the last part of a step, which is `inside`, at the
    position `base` + that part; `exit` is what ends it, or -1 where `left` steps have gone by. `slack` is a
    lower bound of the exits of each contact over the segment.
    """

    def __init__(self, flows: Flows) -> None:
        d, e = flows.size, 2 * flows.contacts + 1
        self.flows, self.slot, self.exit = flows, -1, -1
        self.base, self.left, self.inside = 0.0, 0.0, 0.0
        self.there, self.powers, self.slack = np.zeros((1, d)), np.zeros((e, ORDER + 1)), np.zeros(e)
        self.touched = np.zeros(e, np.int8)
        self._here, self._begun, self._work = np.zeros((1, d)), np.zeros((1, d)), workspace()
        self._floors, self._largest, self._marked = np.zeros(e), np.zeros(e), np.zeros(e, np.int8)
        self._seen = np.zeros((BLOCK + 1) * 3 * e)

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def begin(self, y: cython.double[:, ::1], left: cython.double) -> cython.void:
        """Begin a segment of at most so many steps at y, the powers of the exits touched there known."""
        i: cython.Py_ssize_t
        e: cython.Py_ssize_t
        self.base, self.left, self._doubled = 0.0, left, _FIRST
        for i in range(self.flows.size):
            self._here[0, i] = self._begun[0, i] = y[0, i]
        for i in range(self.flows.contacts):
            self.slack[i] = UNSEEN
        for e in range(self.flows.exits[self.slot]):
            self._floors[e], self._largest[e] = -1.0, 0.0

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(-1, check=False)
    def block(self) -> cython.bint:
        """Look for an exit in the next steps, more of them each time; whether the segment has ended."""
        k: cython.Py_ssize_t
        e: cython.Py_ssize_t
        whole: cython.int
        some: cython.bint
        exits: cython.Py_ssize_t = self.flows.exits[self.slot]
        steps: cython.Py_ssize_t = cython.cast(cython.Py_ssize_t, 1) << self._doubled
        self.flows.watch(self.slot, self._here, 0, steps, self._seen)
        for k in range(steps):
            if self.base + k >= self.left:
                break
            some = False
            for e in range(exits):
                self._marked[e] = self._suspect(k, e) or (self.base + k == 0.0 and self.touched[e])
                some = some or self._marked[e] != 0
            if some:
                self._stand(k)
                if self._passed(self.base + k):
                    return True
        if self.base + steps >= self.left:
            whole = cython.cast(cython.int, self.left - self.base)
            self._stand(whole)
            self.exit, self.inside, self.base = -1, self.left - self.base - whole, self.left
            return True
        self.flows.advance(self.slot, self._doubled, self._here, 0)
        self.base += steps
        self._doubled = min(self._doubled + 1, _WHOLE)
        return False

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def _suspect(self, k: cython.Py_ssize_t, e: cython.Py_ssize_t) -> cython.bint:
        """Whether exit e may be passed in step k of the block.

        The least of the Bernstein coefficients of the cubic through g and g' at both ends bounds g from below
        but for h**4 / 384 times the greatest fourth derivative. A step is at most a radian of the fastest
        motion: inside it that derivative is no more than twice the greater of its ends'.
        """
        exits: cython.Py_ssize_t = self.flows.exits[self.slot]
        owner: cython.Py_ssize_t = self.flows.owner[self.slot, e]
        a: cython.Py_ssize_t = 3 * k * exits + e
        b: cython.Py_ssize_t = a + 3 * exits
        first: cython.double = self._seen[a]
        last: cython.double = self._seen[b]
        low: cython.double = min(
            min(first, last), min(first + self._seen[a + exits] / 3.0, last - self._seen[b + exits] / 3.0)
        )
        low -= max(fabs(self._seen[a + 2 * exits]), fabs(self._seen[b + 2 * exits])) / 192.0
        self.slack[owner] = min(self.slack[owner], low)
        self._largest[e] = max(self._largest[e], fabs(first))
        return low < 0.0 and low < -self._floor(e)

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def _floor(self, e: cython.Py_ssize_t) -> cython.double:
        """The depth of exit e that is rounding: of its size in this segment, so far."""
        n: cython.Py_ssize_t = self.flows.linear
        i: cython.Py_ssize_t
        w: cython.Py_ssize_t
        b: cython.Py_ssize_t
        j: cython.int
        size: cython.double
        if self._floors[e] < 0.0:
            for j in range(3):
                w = e * (_ORDER + 1) + j
                size = 0.0
                for b in range(2 * self.flows.waves):
                    size += fabs(self.flows.series_forced[self.slot, b, w] * self._begun[0, n + b])
                for i in range(n):
                    size += fabs(self.flows.series[self.slot, i, w] * self._begun[0, i])
                self._floors[e] = max(self._floors[e], DEPTH * size)
        return max(self._floors[e], DEPTH * self._largest[e])

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(-1, check=False)
    def _stand(self, steps: cython.int) -> cython.int:
        """Go to so many steps from the start of the block."""
        i: cython.Py_ssize_t
        j: cython.int
        for i in range(self.flows.size):
            self.there[0, i] = self._here[0, i]
        for j in range(_WHOLE + 1):
            if steps >> j & 1:
                self.flows.advance(self.slot, j, self.there, 0)
        return 0

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def _passed(self, before: cython.double) -> cython.bint:
        """Whether a marked exit is passed in the step from there, as many before it; ends the segment."""
        e: cython.Py_ssize_t
        at: cython.double
        best: cython.double = 2.0
        self.exit = -1
        for e in range(self.flows.exits[self.slot]):
            if self._marked[e]:
                if before > 0.0 or not self.touched[e]:
                    self.flows.leave(self.slot, e, self.there, 0, self.powers)
                at = first_descent(self.powers, e, self._floor(e), self._work)
                if 0.0 <= at < best:
                    best, self.exit = at, e
        if self.exit >= 0 and before + best <= self.left:
            self.base, self.inside = before + best, best
            return True
        self.exit = -1
        return False
