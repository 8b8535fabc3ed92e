"""One steady cycle of a contact under any periodic motion: its states, when each begins, where the slider rests.

The slider w is held between the limits of `motion`; it moves only when one of them pushes it, and follows u
while the contact is open. The cycle is cut where the contact closes and opens, at the maxima of the lower
limit (tops) and at the minima of the upper limit (bottoms). Between two cuts neither limit has an extreme
that could push and let go again, so over such a span the law is one clip,

    w_end = max(lower, min(w_start, upper)),

and at most one slip, which lasts until the end of the span. A rounding error can shift an event, but never
choose a wrong sequence by more than that error. The steady cycle is known from its start on: at a closing
w = u; without one, the greatest top pins w if it is above the least bottom, and else w never moves.
"""

from __future__ import annotations

import cython
import numpy as np
from cython.cimports.libc.math import cos, fabs, sin

if cython.compiled:
    from cython.cimports.fcm.contact.periodic.crossings import Crossings
    from cython.cimports.fcm.contact.periodic.motion import (
        CLOSED,
        FORCE,
        LOAD,
        LOWER,
        LOWER_RATE,
        MIXED,
        OPEN,
        REACH,
        UNKNOWN,
        UPPER,
        UPPER_RATE,
        Motion,
    )
else:
    from fcm.contact.periodic.crossings import Crossings
    from fcm.contact.periodic.motion import (
        CLOSED,
        FORCE,
        LOAD,
        LOWER,
        LOWER_RATE,
        MIXED,
        OPEN,
        REACH,
        UNKNOWN,
        UPPER,
        UPPER_RATE,
        Motion,
    )

CLOSES = cython.declare(cython.int, 0)  # kinds of cuts
OPENS = cython.declare(cython.int, 1)
TOP = cython.declare(cython.int, 2)
BOTTOM = cython.declare(cython.int, 3)
SLIPS = cython.declare(cython.int, 4)  # where a limit meets the slider: an event that is no cut

STICK = cython.declare(cython.int, 0)  # states, and what brought a slider to rest
POSITIVE = cython.declare(cython.int, 1)
NEGATIVE = cython.declare(cython.int, -1)
SEPARATION = cython.declare(cython.int, 2)

STUCK = cython.declare(cython.int, 4)  # of a whole cycle, beside OPEN, MIXED and UNKNOWN: MIXED is any other

TWO_PI = cython.declare(cython.double, 6.283185307179586)


@cython.cclass
class Cycle:
    """The pieces of a cycle in order, up to `pieces`, and the events at which they begin."""

    def __init__(self, motion: Motion) -> None:
        self.motion = motion
        self.crossings = Crossings(motion)
        size = 2 * self.crossings.capacity + 4
        self.event_cos, self.event_sin = np.zeros(size), np.zeros(size)
        self.event_angle = np.zeros(size)
        self.lower, self.upper, self.moved = np.zeros(size), np.zeros(size), np.zeros(size)
        self.lower_rate, self.upper_rate = np.zeros(size), np.zeros(size)
        self.load_rate, self.motion_rate = np.zeros(size), np.zeros(size)
        self.event_kind, self.margin = np.zeros(size, dtype=np.intc), np.zeros(size)
        self.order = np.zeros(self.crossings.capacity, dtype=np.intc)
        self.state, self.event = np.zeros(size, dtype=np.intc), np.zeros(size, dtype=np.intc)
        self.cause = np.zeros(size, dtype=np.intc)
        self.begin, self.rest = np.zeros(size), np.zeros(size)
        self.pieces = self.events = 0

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def solve(self, behaviour: cython.int, start: cython.double) -> cython.int:
        """The cycle of a loaded motion whose slider started at `start`, from the mean of u: OPEN, STUCK, MIXED.

        Of a contact that never slips there is one piece, a stick, whose cause is 0 unless a limit holds it.
        """
        self.pieces = self.events = 0
        self.overlap = 0.0
        if behaviour == UNKNOWN:
            return UNKNOWN
        if behaviour == OPEN:
            self.add(SEPARATION, 0, 0.0, 0.0, 0)
            return OPEN
        if behaviour == CLOSED and self.far_inside(start):
            self.add(STICK, 0, 0.0, start, 0)
            return STUCK
        self.motion.sample()
        self.crossings.begin()
        if behaviour == MIXED:
            self.crossings.search(LOAD, CLOSES, OPENS)
            if self.crossings.count == 0:
                if self.crossings.sign <= 0:
                    self.add(SEPARATION, 0, 0.0, 0.0, 0)
                    return OPEN
                behaviour = CLOSED
        self.crossings.search(LOWER_RATE, -1, TOP)
        self.crossings.search(UPPER_RATE, BOTTOM, -1)
        self.crossings.curvature = self.motion.limit_bound[2]
        self.sort_cuts()
        if behaviour == CLOSED:
            return self.never_open(start)
        first: cython.int = 0
        while self.crossings.kind[self.order[first]] != CLOSES:
            first += 1
        self.march(first, CLOSES)
        return MIXED

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def far_inside(self, start: cython.double) -> cython.bint:
        """Whether the slider stays between the limits whatever the phases of the harmonics."""
        return self.motion.mean[REACH] >= self.motion.limit_bound[0] + fabs(start)

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def sort_cuts(self) -> cython.void:
        """`order`: the cuts by their angles, each reduced to the turn that begins at the first node."""
        i: cython.int
        j: cython.int
        for i in range(self.crossings.count):
            if self.crossings.angle[i] < self.motion.first:
                self.crossings.angle[i] += TWO_PI
            elif self.crossings.angle[i] >= self.motion.first + TWO_PI:
                self.crossings.angle[i] -= TWO_PI
            j = i
            while j > 0 and self.crossings.angle[self.order[j - 1]] > self.crossings.angle[i]:
                self.order[j] = self.order[j - 1]
                j -= 1
            self.order[j] = i

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def place(self, theta: cython.double, kind: cython.int) -> cython.int:
        """A new event at an angle: its limits and their rates."""
        c_1: cython.double = cos(theta)
        s_1: cython.double = sin(theta)
        c: cython.double = c_1
        s: cython.double = s_1
        turned: cython.double
        u: cython.double = 0.0
        u_1: cython.double = 0.0
        y: cython.double = 0.0
        y_1: cython.double = 0.0
        h: cython.int = 1
        k: cython.int
        e: cython.int = self.events
        for k in range(self.motion.count):
            while h < self.motion.number[k]:
                turned = c * c_1 - s * s_1
                s = s * c_1 + c * s_1
                c = turned
                h += 1
            u += self.motion.re[FORCE, k] * c - self.motion.im[FORCE, k] * s
            y += self.motion.re[REACH, k] * c - self.motion.im[REACH, k] * s
            u_1 -= self.motion.order[k] * (self.motion.re[FORCE, k] * s + self.motion.im[FORCE, k] * c)
            y_1 -= self.motion.order[k] * (self.motion.re[LOAD, k] * s + self.motion.im[LOAD, k] * c)
        y = max(y + self.motion.mean[REACH], 0.0)
        self.event_kind[e], self.margin[e] = kind, 0.0
        self.event_angle[e], self.event_cos[e], self.event_sin[e] = theta, c_1, s_1
        self.moved[e], self.lower[e], self.upper[e] = u, u - y, u + y
        self.motion_rate[e], self.load_rate[e] = u_1, y_1
        self.lower_rate[e] = u_1 - self.motion.ratio * y_1
        self.upper_rate[e] = u_1 + self.motion.ratio * y_1
        self.events += 1
        return e

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def add(
        self,
        state: cython.int,
        event: cython.int,
        theta: cython.double,
        rest: cython.double,
        cause: cython.int,
    ) -> cython.void:
        """The next piece, unless it goes on with the last."""
        i: cython.int = self.pieces
        if i > 0 and self.state[i - 1] == state:
            return
        self.state[i], self.event[i], self.begin[i] = state, event, theta
        self.rest[i], self.cause[i] = rest, cause
        self.pieces += 1

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def never_open(self, start: cython.double) -> cython.int:
        """Without separation: from the greatest top on, if it is above the least bottom."""
        i: cython.int
        e: cython.int
        top: cython.int = -1
        bottom: cython.int = -1
        first: cython.int = 0
        for i in range(self.crossings.count):
            e = self.place(self.crossings.angle[self.order[i]], self.crossings.kind[self.order[i]])
            if self.crossings.kind[self.order[i]] == TOP:
                if top < 0 or self.lower[e] > self.lower[top]:
                    top, first = e, i
            elif bottom < 0 or self.upper[e] < self.upper[bottom]:
                bottom = e
        if top < 0 or bottom < 0:  # a limit that does not move at all, or hardly
            e = self.place(self.motion.first, SLIPS)
            top, bottom = e if top < 0 else top, e if bottom < 0 else bottom
        self.overlap = self.lower[top] - self.upper[bottom]
        if self.overlap <= 0.0 or self.crossings.count == 0:
            if start < self.lower[top]:
                self.add(STICK, top, 0.0, self.lower[top], POSITIVE)
            elif start > self.upper[bottom]:
                self.add(STICK, bottom, 0.0, self.upper[bottom], NEGATIVE)
            else:
                self.add(STICK, 0, 0.0, start, 0)
            return STUCK
        self.march(first, TOP)
        return MIXED

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def march(self, first: cython.int, kind: cython.int) -> cython.void:
        """Span after span, from the cut at which w is known."""
        count: cython.int = self.crossings.count
        turn: cython.double = 0.0
        i: cython.int
        at: cython.int = first
        theta: cython.double = self.crossings.angle[self.order[first]]
        opened: cython.bint = False
        self.slipping, self.span_cause = 0, POSITIVE
        self.span = first if kind == TOP else self.place(theta, kind)
        self.span_begin, self.w = theta, self.lower[self.span]
        never_opens: cython.bint = kind == TOP  # then all cuts have been placed, in their order
        if kind == CLOSES:
            self.close()
        for i in range(count if never_opens else count - 1):  # noqa: B007
            at += 1
            if at == count:
                at, turn = 0, TWO_PI
            theta = self.crossings.angle[self.order[at]] + turn
            kind = self.crossings.kind[self.order[at]]
            if opened:
                if kind == CLOSES:
                    opened = False
                    self.span, self.span_begin = self.place(theta, kind), theta
                    self.close()
                continue
            self.advance(at if never_opens else self.place(theta, kind), theta, kind)
            if kind == OPENS:
                opened = True
                self.add(SEPARATION, self.span, theta, 0.0, 0)

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def close(self) -> cython.void:
        """(20) to (22): what follows the separation."""
        self.w, self.span_cause, self.slipping = self.moved[self.span], SEPARATION, 0
        if self.pushes(POSITIVE):
            self.slipping = POSITIVE
        elif self.pushes(NEGATIVE):
            self.slipping = NEGATIVE

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def pushes(self, side: cython.int) -> cython.bint:
        """Whether a limit that has met the slider goes on to push it; where that is rounding, the span decides."""
        if side == 0:
            return False
        rate: cython.double = self.lower_rate[self.span] if side > 0 else -self.upper_rate[self.span]
        return rate > self.crossings.noise

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def advance(self, end: cython.int, theta: cython.double, kind: cython.int) -> cython.void:
        """One span, to a cut at which the contact is closed or opens."""
        if kind == OPENS:
            self.lower[end] = self.upper[end] = self.moved[end]
        self.margin[end] = self.w - self.upper[end] if kind == BOTTOM else self.lower[end] - self.w
        w: cython.double = max(self.lower[end], min(self.w, self.upper[end]))
        side: cython.int = POSITIVE if w > self.w else NEGATIVE if w < self.w else 0
        if side == 0 or side != self.slipping:
            self.add(STICK, self.span, self.span_begin, self.w, self.span_cause)
        if side != 0:
            self.slip(side, end, theta)
        if side != 0:
            self.span_cause = side
        self.w, self.span, self.span_begin = w, end, theta
        self.slipping = side if kind != (TOP if side > 0 else BOTTOM) and self.pushes(side) else 0

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def slip(self, side: cython.int, end: cython.int, theta: cython.double) -> cython.void:
        """The slip that ends a span."""
        begin: cython.double
        if side == self.slipping:
            self.add(side, self.span, self.span_begin, 0.0, 0)
        else:
            begin = self.slip_begin(side, end, theta)
            self.add(side, self.place(begin, SLIPS), begin, 0.0, 0)

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def slip_begin(self, side: cython.int, end: cython.int, theta: cython.double) -> cython.double:
        """Where the limit that pushes meets the resting slider; before, it may first have receded."""
        row: cython.int = LOWER if side > 0 else UPPER
        g: cython.double = (self.lower[end] if side > 0 else self.upper[end]) - self.w
        d: cython.double = self.lower_rate[end] if side > 0 else self.upper_rate[end]
        j: cython.int = self.motion.node_before(theta)
        node: cython.int = j % self.motion.nodes
        low: cython.double = self.motion.first + j * self.motion.step
        value: cython.double
        slope: cython.double
        while low > self.span_begin:
            value, slope = self.motion.at[row, node] - self.w, self.motion.at[row + 1, node]
            if low < theta:
                if value * side < 0.0:
                    return self.crossings.root(row, self.w, low, value, slope, theta, g, d)
                if value != 0.0:
                    theta, g, d = low, value, slope
            j -= 1
            node = node - 1 if node > 0 else self.motion.nodes - 1
            low = self.motion.first + j * self.motion.step
        value = (self.lower[self.span] if side > 0 else self.upper[self.span]) - self.w
        slope = self.lower_rate[self.span] if side > 0 else self.upper_rate[self.span]
        if value * side > -self.crossings.noise:
            value = 0.0  # the limit lets go of the slider here, and comes back
        return self.crossings.root(row, self.w, self.span_begin, value, slope, theta, g, d)
