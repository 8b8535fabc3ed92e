"""Kernel: one steady cycle of a contact under any periodic motion, its states and where the slider rests.

The cycle is cut where the contact closes and opens, at the maxima of the lower limit (tops) and at the minima
of the upper limit (bottoms); `slider` leads from one cut to the next. The steady cycle is known from its
start on: at a closing w = u; without one, the greatest top pins w if it is above the least bottom, and else w
never moves.
"""

from __future__ import annotations

import cython
import numpy as np
from cython.cimports.libc.math import fabs, isfinite

if cython.compiled:
    from cython.cimports.fcm.contact.periodic.events import BOTTOM, CLOSES, MEETS, OPENS, TOP
    from cython.cimports.fcm.contact.periodic.motion import (
        CLOSED,
        LOAD,
        LOWER_RATE,
        MIXED,
        OPEN,
        REACH,
        UNKNOWN,
        UPPER_RATE,
        Motion,
    )
    from cython.cimports.fcm.contact.periodic.slider import NEGATIVE, POSITIVE, SEPARATION, STICK, Slider
else:
    from fcm.contact.periodic.events import BOTTOM, CLOSES, MEETS, OPENS, TOP
    from fcm.contact.periodic.motion import (
        CLOSED,
        LOAD,
        LOWER_RATE,
        MIXED,
        OPEN,
        REACH,
        UNKNOWN,
        UPPER_RATE,
        Motion,
    )
    from fcm.contact.periodic.slider import NEGATIVE, POSITIVE, SEPARATION, STICK, Slider

STUCK = cython.declare(cython.int, 4)  # of a whole cycle, beside OPEN, MIXED and UNKNOWN: MIXED is any other

TWO_PI = cython.declare(cython.double, 6.283185307179586)


@cython.cclass
class Cycle(Slider):
    """A steady cycle, its pieces those of `Slider`.

    Attributes
    ----------
    behaviour, kind, start
        Of the motion taken last: as of `Motion.load` and `solve`, and the start as `solve` has it.
    greatest_lower, least_upper, overlap
        Of a contact that never opens, the greatest top, the least bottom, and the first less the second.
    """

    def __init__(self, motion: Motion) -> None:
        Slider.__init__(self, motion)
        self.order = np.zeros(self.crossings.capacity, dtype=np.intc)
        self.overlap = self.greatest_lower = self.least_upper = 0.0
        self.behaviour = self.kind = UNKNOWN
        self.start = 0.0
        self.numbers, self.law = np.zeros(2 + 4 * motion.count), np.zeros(5)

    def take(
        self,
        x: cython.double[::1],
        first: cython.Py_ssize_t,
        mu: float,
        k_u: float,
        k_v: float,
        n_0: float,
        start: float,
    ) -> cython.int:
        """The cycle of the motion x[first:], as of `solve`; nothing is done for the one taken last."""
        if self.known(x, first, mu, k_u, k_v, n_0, start):
            return self.kind
        i: cython.Py_ssize_t
        self.behaviour = self.motion.load(x, first, mu, k_u, k_v, n_0)
        if self.behaviour == UNKNOWN or not isfinite(start):
            self.kind = self.solve(UNKNOWN, 0.0)
            return self.kind
        self.start = k_u * (start - x[first]) / self.motion.scale
        self.kind = self.solve(self.behaviour, self.start)
        for i in range(self.numbers.shape[0]):
            self.numbers[i] = x[first + i]
        self.law[0], self.law[1], self.law[2], self.law[3], self.law[4] = mu, k_u, k_v, n_0, start
        self.motion.taken = True
        return self.kind

    def known(
        self,
        x: cython.double[::1],
        first: cython.Py_ssize_t,
        mu: float,
        k_u: float,
        k_v: float,
        n_0: float,
        start: float,
    ) -> bool:
        """Whether that is what was taken last."""
        i: cython.Py_ssize_t
        if not (self.motion.taken and self.law[0] == mu and self.law[1] == k_u and self.law[2] == k_v):
            return False
        if not (self.law[3] == n_0 and self.law[4] == start):
            return False
        for i in range(self.numbers.shape[0]):  # noqa: SIM110 - a loop in C
            if self.numbers[i] != x[first + i]:
                return False
        return True

    def solve(self, behaviour: cython.int, start: float) -> cython.int:
        """The cycle of a loaded motion, OPEN, STUCK or MIXED; its slider began at `start` from the mean of u.

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

    def far_inside(self, start: float) -> bool:
        """Whether the slider stays between the limits whatever the phases of the harmonics."""
        spare: float = self.motion.mean[REACH] - self.motion.limit_bound[0] - fabs(start)
        return spare >= 0.0

    def sort_cuts(self) -> None:
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

    def never_open(self, start: float) -> cython.int:
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
            e = self.place(self.motion.first, MEETS)
            top, bottom = e if top < 0 else top, e if bottom < 0 else bottom
        self.greatest_lower, self.least_upper = self.lower[top], self.upper[bottom]
        self.overlap = self.greatest_lower - self.least_upper
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

    def march(self, first: cython.int, kind: cython.int) -> None:
        """Span after span, from the cut at which w is known."""
        count: cython.int = self.crossings.count
        turn: float = 0.0
        i: cython.int
        at: cython.int = first
        theta: float = self.crossings.angle[self.order[first]]
        opened: bool = False
        self.slipping, self.span_cause = 0, POSITIVE
        self.span = first if kind == TOP else self.place(theta, kind)
        self.span_begin, self.w = theta, self.lower[self.span]
        never_opens: bool = kind == TOP  # then all cuts have been placed, in their order
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
