"""March from transition to transition: find the first exit that is passed, and the states that follow.

No exit is missed, and most steps are not examined individually. The exits are evaluated on up to `BLOCK`
steps at once. A cubic and a bound of its error tell in which of these steps an exit may be passed; only there
its power series is searched.

The search finds the first descent through zero on [0, 1]. The Bernstein coefficients of a polynomial enclose
its values: if none is negative, neither is the polynomial; if their sign changes once, it has exactly one
root. Otherwise the interval is halved. The conversion from powers to Bernstein coefficients is accurate, as
its weights are between 0 and 1.

The states that follow, or that last from the start of a motion, are decided for each exit function by the
sign of its first derivative that does not vanish. So coinciding or grazing transitions, and contacts released
at rest, need no special cases. Up to that derivative the motion is the same in the old and the new state, so
the answer is unique (`Successor`).
"""

from __future__ import annotations

from math import comb

import cython
import numpy as np
import numpy.typing as npt
from cython.cimports.libc.math import cos, fabs, isfinite, ldexp, sin

from fcm.model.scene import FloatArray
from fcm.time_domain.flow import BLOCK, ORDER
from fcm.time_domain.options import TIME
from fcm.time_domain.stop_reason import Stopped

if cython.compiled:
    from cython.cimports.fcm.cubic import value_bounds
    from cython.cimports.fcm.time_domain.flow import (
        SERIES_ORDER,
        STATE_NEGATIVE_SLIP,
        STATE_POSITIVE_SLIP,
        STATE_SEPARATED,
        STATE_STICKING,
        Flows,
    )
    from cython.cimports.fcm.time_domain.segments import Segments
else:
    from fcm.cubic import value_bounds
    from fcm.time_domain.flow import (
        SERIES_ORDER,
        STATE_NEGATIVE_SLIP,
        STATE_POSITIVE_SLIP,
        STATE_SEPARATED,
        STATE_STICKING,
        Flows,
    )
    from fcm.time_domain.segments import Segments


_DONE = cython.declare(cython.int, Stopped.DONE)  # plain numbers, for loops without the interpreter
_MISSING = cython.declare(cython.int, Stopped.MISSING)
_UNDECIDED = cython.declare(cython.int, Stopped.UNDECIDED)


def _weights(degree: int) -> FloatArray:
    """Weights (power, coefficient) from powers to Bernstein coefficients of a degree."""
    weights = np.zeros((ORDER + 1, ORDER + 1))
    for i in range(degree + 1):
        weights[i, i : degree + 1] = [comb(j, i) / comb(degree, i) for j in range(i, degree + 1)]
    return weights


_WEIGHTS = cython.declare(cython.double[:, :, ::1], np.array([_weights(n) for n in range(ORDER + 1)]))


def workspace(max_halvings: int) -> FloatArray:
    """Work array for `first_descent`: the coefficients at every depth of halving."""
    return np.zeros((max_halvings + 2, ORDER + 1))


def first_descent_of(powers: FloatArray, floor: float) -> float | None:
    """First point where sum powers[i] x**i, not negative at 0, descends through zero to below -floor.

    Parameters
    ----------
    powers : (20,)
    floor : float
        Depth below zero that is rounding, >= 0.

    Returns
    -------
    float or None
        The root in [0, 1], to rounding; None if there is none.

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
    options = TIME.flows.transitions
    found = first_descent(row, 0, floor, options.negligible_power, workspace(options.max_halvings))
    return found if found >= 0.0 else None


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def first_descent(
    powers: cython.double[:, ::1],
    k: cython.Py_ssize_t,
    floor: cython.double,
    negligible: cython.double,
    work: cython.double[:, ::1],
) -> cython.double:
    """Root of the first descent for row k of the powers; -1 if there is none.

    Highest powers up to `negligible` times the sum of their magnitudes are omitted.
    """
    i: cython.int
    j: cython.int
    degree: cython.int
    leading: cython.int = 0
    change: cython.double = 0.0
    while leading < SERIES_ORDER and powers[k, leading] == 0.0:
        leading += 1
    for i in range(leading + 1, SERIES_ORDER + 1):
        change += fabs(powers[k, i])
    if powers[k, leading] - change >= -floor:
        return -1.0
    degree = SERIES_ORDER
    while degree > 1 and fabs(powers[k, degree]) <= negligible * change:
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
    """Finds the first descent by bisection, depth first and left before right.

    Row i of work holds the coefficients of the interval that waits at depth i. An interval at depth i begins
    at an even multiple of its length 2**-i if it is a left half.
    """
    depth: cython.int = 0
    low: cython.double = 0.0
    kind: cython.int
    while True:
        kind = _interval_kind(work, degree, depth, floor)
        if kind == 2 or (kind == 3 and depth >= work.shape[0] - 2):
            return low  # it descends from within rounding at the very start
        if kind == 1:
            return _root(powers, k, degree, low, low + ldexp(1.0, -depth), work[depth])
        if kind == 3:
            _halve(work, degree, depth)
            depth += 1
            continue
        # no descent here: go right, at the depth of the nearest interval that is a left half
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
    """Whether the interval at low, of length 2**-depth, is a right half."""
    half: cython.double = ldexp(low, depth - 1)
    return half != cython.cast(cython.double, cython.cast(cython.longlong, half))


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def _interval_kind(
    work: cython.double[:, ::1], degree: cython.int, depth: cython.int, floor: cython.double
) -> cython.int:
    """Kind of an interval: 0 no descent, 1 exactly one root, 2 descends at its start, 3 to be halved."""
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
    """Sets row depth + 1 to the left half of row depth, which becomes the right half (de Casteljau)."""
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
    """Sets row depth to the right half, which its parent holds."""
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
    """Finds the only root, positive at low and negative at high, by bracketed Newton steps.

    The first of `ends` and the one of index degree are the values at low and high, up to rounding. It begins
    on the line between these, away from low, where there may be another root, of a grazing contact.
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
            return new  # the next step would be below rounding
        if fabs(new - x) <= 1e-16 or not low < new < high:
            return new
        x = new
    return x


UNSEEN = cython.declare(cython.double, 1e300)  # initial `slack`, before any step is examined
_WHOLE = cython.declare(cython.int, 3)  # BLOCK is 2**3 steps


@cython.cclass
class EventDetector:
    """Follows the flow `slot` until an exit is passed.

    `powers` holds the series of the exits that are zero at its start, `touched`.

    At the end of the segment, `there` is the state before the last fraction of a step, `inside`; the end is
    at the position `base`. `exit` is the exit that ends it, or -1 if `left` steps are over. `slack` is a
    lower bound of the exits of each contact over the segment.
    """

    def __init__(self, flows: Flows) -> None:
        d, e = flows.size, 2 * flows.contacts + 1
        self.flows, self.slot, self.exit = flows, -1, -1
        self.base, self.left, self.inside = 0.0, 0.0, 0.0
        self.there, self.powers, self.slack = np.zeros((1, d)), np.zeros((e, ORDER + 1)), np.zeros(e)
        self.touched = np.zeros(e, np.int8)
        self._here, self._begun, self._work = (
            np.zeros((1, d)),
            np.zeros((1, d)),
            workspace(flows.max_halvings),
        )
        self._floors, self._largest, self._marked = np.zeros(e), np.zeros(e), np.zeros(e, np.int8)
        self._seen = np.zeros((BLOCK + 1) * 3 * e)

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def begin(self, y: cython.double[:, ::1], left: cython.double) -> cython.void:
        """Begins a segment at y of at most `left` steps; the powers of the touched exits have to be set."""
        i: cython.Py_ssize_t
        e: cython.Py_ssize_t
        self.base, self.left, self._doubled = 0.0, left, self.flows.first_doublings
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
        """Searches the next block of steps for an exit; returns whether the segment has ended.

        Each block has twice the steps of the last, up to `BLOCK`.
        """
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

        Its values and slopes at both ends bound it from below. A step is at most a radian of the fastest
        motion. So the fourth derivative inside is at most twice the greater of those at the ends.
        """
        exits: cython.Py_ssize_t = self.flows.exits[self.slot]
        owner: cython.Py_ssize_t = self.flows.owner[self.slot, e]
        a: cython.Py_ssize_t = 3 * k * exits + e
        b: cython.Py_ssize_t = a + 3 * exits
        first: cython.double = self._seen[a]
        last: cython.double = self._seen[b]
        fourth: cython.double = 2.0 * max(fabs(self._seen[a + 2 * exits]), fabs(self._seen[b + 2 * exits]))
        low, _ = value_bounds(1.0, fourth, first, self._seen[a + exits], last, self._seen[b + exits])
        self.slack[owner] = min(self.slack[owner], low)
        self._largest[e] = max(self._largest[e], fabs(first))
        return low < 0.0 and low < -self._floor(e)

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def _floor(self, e: cython.Py_ssize_t) -> cython.double:
        """Depth of exit e below zero that is rounding, from its size in this segment so far."""
        n: cython.Py_ssize_t = self.flows.linear
        i: cython.Py_ssize_t
        w: cython.Py_ssize_t
        b: cython.Py_ssize_t
        j: cython.int
        size: cython.double
        if self._floors[e] < 0.0:
            for j in range(3):
                w = e * (SERIES_ORDER + 1) + j
                size = 0.0
                for b in range(2 * self.flows.waves):
                    size += fabs(self.flows.series_forced[self.slot, b, w] * self._begun[0, n + b])
                for i in range(n):
                    size += fabs(self.flows.series[self.slot, i, w] * self._begun[0, i])
                self._floors[e] = max(self._floors[e], self.flows.depth * size)
        return max(self._floors[e], self.flows.depth * self._largest[e])

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(-1, check=False)
    def _stand(self, steps: cython.int) -> cython.int:
        """Sets `there` to the state a number of steps after the start of the block."""
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
        """Whether a marked exit is passed in the present step; if so, the segment ends there."""
        e: cython.Py_ssize_t
        at: cython.double
        best: cython.double = 2.0
        self.exit = -1
        for e in range(self.flows.exits[self.slot]):
            if self._marked[e]:
                if before > 0.0 or not self.touched[e]:
                    self.flows.leave(self.slot, e, self.there, 0, self.powers)
                at = first_descent(self.powers, e, self._floor(e), self.flows.negligible_power, self._work)
                if 0.0 <= at < best:
                    best, self.exit = at, e
        if self.exit >= 0 and before + best <= self.left:
            self.base, self.inside = before + best, best
            return True
        self.exit = -1
        return False


@cython.cclass
class Successor:
    """Sets `states` (1, contact) to those that last from `y` (1, d) on, and the flow of `ahead`."""

    def __init__(self, ahead: EventDetector, y: FloatArray, states: npt.NDArray[np.int8]) -> None:
        self.flows, self.ahead, self.y, self.states = ahead.flows, ahead, y, states
        self._noise, self._failed = (
            np.zeros(ahead.flows.size),
            np.zeros(2 * ahead.flows.contacts + 1, np.int8),
        )
        self._passes, self._fresh = 0, True

    @cython.cfunc
    @cython.exceptval(check=False)
    def begins(self) -> cython.void:
        """Starts a motion: its rounding is unknown, and no exit has been passed."""
        self._passes, self._fresh, self.ahead.exit = 0, True, -1

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def rounded(self, y: cython.double[:, ::1]) -> cython.void:
        """Bounds the rounding of a state after a step of the present flow from row 0 of y."""
        i: cython.Py_ssize_t
        self.flows.bound(self.ahead.slot, y, 0, self._noise)
        for i in range(self.flows.size):
            self._noise[i] *= self.flows.rounding

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(-1, check=False)
    def settle(self) -> cython.int:
        """Finds the combination of states that lasts from y on; returns DONE if it is found."""
        i: cython.Py_ssize_t
        slot: cython.Py_ssize_t
        while self._passes < self.flows.max_passes:
            slot = self.flows.find(self.states, 0)
            if slot < 0:
                return _MISSING
            self.flows.refresh(slot)
            self.ahead.slot = slot
            if self._fresh:
                self.rounded(self.y)
                self._fresh = False
            if not self._fails(slot):
                self._passes = 0
                return _DONE
            self._switch(slot)
            for i in range(self.flows.size):
                self._noise[i] *= 2.0  # states that alternate differ by rounding that was underestimated
            self._passes += 1
        return _UNDECIDED

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def _fails(self, slot: cython.Py_ssize_t) -> cython.bint:
        """Marks exits whose first coefficient beyond rounding is negative; returns whether there are any.

        Coefficients before it are set to zero. Coefficients after the first are computed only if the first is
        rounding.
        """
        e: cython.Py_ssize_t
        i: cython.Py_ssize_t
        value: cython.double
        zero: cython.double
        some: cython.bint = False
        for e in range(self.flows.exits[slot]):
            value = zero = 0.0
            for i in range(self.flows.first[slot, e], self.flows.linear):
                value += self.flows.row[slot, e, i] * self.y[0, i]
                zero += fabs(self.flows.row[slot, e, i]) * self._noise[i]
            self._failed[e] = e == self.ahead.exit
            self.ahead.touched[e] = fabs(value) <= zero
            if self.ahead.touched[e]:
                self._descends(slot, e)
            elif value < 0.0:
                self._failed[e] = 1
            some = some or self._failed[e] != 0
        self.ahead.exit = -1
        return some

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def _descends(self, slot: cython.Py_ssize_t, e: cython.Py_ssize_t) -> cython.void:
        """Marks exit e, which is zero here, if its next coefficient beyond rounding is negative."""
        powers: cython.double[:, ::1] = self.ahead.powers
        n: cython.Py_ssize_t = self.flows.linear
        i: cython.Py_ssize_t
        w: cython.Py_ssize_t
        b: cython.Py_ssize_t
        j: cython.int
        zero: cython.double
        self.flows.leave(slot, e, self.y, 0, powers)
        powers[e, 0] = 0.0
        for j in range(1, self.flows.max_order + 1):
            w = e * (SERIES_ORDER + 1) + j
            zero = 0.0
            for b in range(2 * self.flows.waves):
                zero += fabs(self.flows.series_forced[slot, b, w]) * self._noise[n + b]
            for i in range(n):
                zero += fabs(self.flows.series[slot, i, w]) * self._noise[i]
            if fabs(powers[e, j]) > zero:
                if powers[e, j] < 0.0:
                    self._failed[e] = 1
                return
            powers[e, j] = 0.0

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def _switch(self, slot: cython.Py_ssize_t) -> cython.void:
        """Switches the contacts by their failed exits, and sets the friction of each new state."""
        j: cython.Py_ssize_t
        e: cython.Py_ssize_t
        wanted: cython.int
        goal: cython.int
        f: cython.Py_ssize_t = 2 * self.flows.modes
        load: cython.double
        for j in range(self.flows.contacts):
            wanted = -1
            for e in range(self.flows.exits[slot]):
                if self._failed[e] and self.flows.owner[slot, e] == j:
                    goal = self.flows.goal[slot, e]
                    # both limits of stick passed at once, or the load gone while slipping: the contact opens
                    wanted = goal if wanted < 0 or wanted == goal else STATE_SEPARATED
            if wanted < 0:
                continue
            self.states[0, j] = wanted
            load = self.flows.mu[j] * (self.flows.n_0[j] + self.y[0, f + self.flows.contacts + j])
            if wanted == STATE_SEPARATED:
                self.y[0, f + j] = 0.0
            elif wanted != STATE_STICKING:
                self.y[0, f + j] = load if wanted == STATE_POSITIVE_SLIP else -load


_FULL = cython.declare(cython.int, Stopped.FULL)
_PAUSED = cython.declare(cython.int, Stopped.PAUSED)
_LONG = cython.declare(cython.int, Stopped.LONG)


@cython.cclass
class March:
    """Marches a motion from a state on: its `segments`, and `y` and `states` at its present end."""

    def __init__(self, flows: Flows) -> None:
        self.flows, self._ahead = flows, EventDetector(flows)
        d, c = flows.size, flows.contacts
        self.y, self.states = np.zeros((1, d)), np.zeros((1, c), np.int8)
        self._next, self.segments = Successor(self._ahead, self.y, self.states), Segments(d, c)

    def begins(self, y: cython.double[::1], states: cython.schar[::1], duration: float, limit: int) -> None:
        """Sets the state vector (d,), the contact states (contact,) and the time to march [s]."""
        i: cython.Py_ssize_t
        for i in range(self.flows.size):
            self.y[0, i] = y[i]
        for i in range(self.flows.contacts):
            self.states[0, i] = states[i]
        self.lasts(duration, limit)

    def enters(self, x: cython.double[::1], angle: cython.double, level: cython.double) -> bool:
        """Sets y and states from x = (q, q', f) and the forces' angle and level; f is clipped to its limits.

        Returns whether all these numbers are finite.
        """
        m: cython.Py_ssize_t = self.flows.modes
        c: cython.Py_ssize_t = self.flows.contacts
        n: cython.Py_ssize_t = self.flows.linear
        i: cython.Py_ssize_t
        j: cython.Py_ssize_t
        h: cython.Py_ssize_t
        change: cython.double
        finite: cython.bint = isfinite(angle) and isfinite(level)
        for i in range(2 * m + c):
            self.y[0, i] = x[i]
            finite = finite and isfinite(x[i])
        for j in range(c):
            change = 0.0
            for i in range(m):
                change += self.flows.normal[j, i] * x[i]
            self.y[0, 2 * m + c + j] = self.flows.k_v[j] * change
        self.y[0, n - 1] = 1.0
        for h in range(self.flows.waves):
            self.y[0, n + 2 * h] = level * sin(self.flows.harmonic[h] * angle)
            self.y[0, n + 2 * h + 1] = level * cos(self.flows.harmonic[h] * angle)
        for j in range(c):
            self._enter(j)
        return bool(finite)

    @cython.cfunc
    def _enter(self, j: cython.Py_ssize_t) -> cython.void:
        """Sets the state of a contact from its load and its friction force."""
        f: cython.Py_ssize_t = 2 * self.flows.modes + j
        load: cython.double = self.flows.n_0[j] + self.y[0, f + self.flows.contacts]
        limit: cython.double = self.flows.mu[j] * load
        if load < 0.0 or (load == 0.0 and self.flows.k_v[j] == 0.0):
            self.y[0, f], self.states[0, j] = 0.0, STATE_SEPARATED
        elif not self.flows.rough[j]:
            self.y[0, f], self.states[0, j] = 0.0, STATE_STICKING
        elif fabs(self.y[0, f]) <= limit:
            self.states[0, j] = STATE_STICKING
        else:
            self.states[0, j] = STATE_POSITIVE_SLIP if self.y[0, f] > 0.0 else STATE_NEGATIVE_SLIP
            self.y[0, f] = limit if self.y[0, f] > 0.0 else -limit

    def lasts(self, duration: float, limit: int) -> None:
        """Sets the time to march [s] from the present y and states."""
        self.duration, self.limit, self.time = duration, limit, 0.0
        self.segments = Segments(self.flows.size, self.flows.contacts, max(self.segments.count + 8, 16))
        self._next.begins()
        self._settled = False

    def go(self) -> int:
        """Continues the march; returns the reason why it stops, a `Stopped`."""
        stopped: cython.int
        if self.segments.count == self.segments.start.shape[0]:
            self.segments = self.segments.room(2 * self.segments.count)
        with cython.nogil:
            stopped = self._go()
        return int(stopped)

    def rate(self) -> float:
        """Rate of the present flow [1/s], the reciprocal of its step."""
        return 1.0 / float(self.flows.step[self._ahead.slot])

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(-1, check=False)
    def _go(self) -> cython.int:
        stopped: cython.int
        ended: cython.bint
        blocks: cython.int = 0
        while True:
            ended = False
            if not self._settled:
                stopped = self._next.settle()
                if stopped != _DONE:
                    return stopped
                if self.segments.count == self.segments.start.shape[0] or self.segments.count > self.limit:
                    return _FULL
                self._open_segment()
                if self._ahead.left > self.flows.max_steps:
                    return _LONG
            while not ended:
                ended = self._ahead.block()
                blocks += 1
                if blocks > self.flows.max_blocks and not ended:
                    return _PAUSED
            self._close_segment()
            if self._ahead.exit < 0:
                return _DONE

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def _open_segment(self) -> cython.void:
        """Records the start of a segment."""
        i: cython.Py_ssize_t
        k: cython.Py_ssize_t = self.segments.count
        self._settled = True
        self.segments.start[k] = self.time
        for i in range(self.flows.contacts):
            self.segments.states[k, i] = self.states[0, i]
        for i in range(self.flows.size):
            self.segments.y[k, i] = self.y[0, i]
        self._ahead.begin(self.y, (self.duration - self.time) / self.flows.step[self._ahead.slot])

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def _close_segment(self) -> cython.void:
        """Records the end of the segment, and advances to it."""
        i: cython.Py_ssize_t
        k: cython.Py_ssize_t = self.segments.count
        slot: cython.Py_ssize_t = self._ahead.slot
        self._next.rounded(self._ahead.there)
        for i in range(self.flows.size):
            self.y[0, i] = self._ahead.there[0, i]
        self.flows.part(slot, self._ahead.inside, self.y, 0, 1)
        self.segments.length[k], self.segments.ended[k] = self._ahead.base, self._ahead.exit
        for i in range(self.flows.contacts):
            self.segments.slack[k, i] = self._ahead.slack[i]
        self.time += self._ahead.base * self.flows.step[slot]
        self.segments.count += 1
        self._settled = False
