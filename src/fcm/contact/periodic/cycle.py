"""Kernel: one steady cycle of a contact under any periodic motion, and Fourier coefficients of its forces.

The cycle is cut where the contact closes and opens, at the maxima of the lower limit (tops) and at the minima
of the upper limit (bottoms). Within a span, between two cuts, neither limit has an extreme at which it could
push the slider and release it again. So the law in a span is one clip,

    w_end = max(lower, min(w_start, upper)),

and at most one slip, which lasts until the end of the span (`advance`). While the contact is open, w follows
u. The steady cycle is known from its start: at a closing w = u. Without a closing, the greatest top
determines w if it is above the least bottom; otherwise w never moves (`LineCycle`). A rounding error can
shift an event, but cannot choose a wrong sequence by more than that error.

Over each piece of the cycle the forces are trigonometric polynomials. So their Fourier coefficients need only
the integrals of exp(-i m theta) over the pieces in which the contact sticks, slips (with the sign of the
force) and is closed. Short sticks are integrated by Gauss's rule instead, from differences to their start;
the closed form would be a difference of nearly equal numbers (`LineIntegrals`).

The derivatives are by the coefficients of the motion. As the forces are continuous, the instants of the
events do not enter; the place where the slider came to rest does. Where an event grazes, the derivative is
the one-sided derivative without the event (`LineDerivatives`). Other kernels call `PeriodicContact`.
"""

from __future__ import annotations

import cython
import numpy as np
from cython.cimports.libc.math import fabs, isfinite, sin

from fcm.contact.periodic.gauss import gauss

if cython.compiled:
    from cython.cimports.fcm.contact.closed_form import NAN, PI
    from cython.cimports.fcm.contact.contact_kernel import (
        CLOSED,
        MIXED,
        OPEN,
        STUCK,
        UNKNOWN,
        ContactKernel,
        ContactParameters,
        ForceDerivatives,
        FourierIntegrals,
    )
    from cython.cimports.fcm.contact.periodic.motion import (
        BOTTOM,
        CLOSES,
        FORCE,
        LOAD,
        LOWER,
        LOWER_RATE,
        MEETS,
        OPENS,
        REACH,
        TOP,
        TWO_PI,
        UPPER,
        UPPER_RATE,
        CycleEvents,
        LineMotion,
        ZeroCrossings,
    )
else:
    from fcm.contact.closed_form import NAN, PI
    from fcm.contact.contact_kernel import (
        CLOSED,
        MIXED,
        OPEN,
        STUCK,
        UNKNOWN,
        ContactKernel,
        ContactParameters,
        ForceDerivatives,
        FourierIntegrals,
    )
    from fcm.contact.periodic.motion import (
        BOTTOM,
        CLOSES,
        FORCE,
        LOAD,
        LOWER,
        LOWER_RATE,
        MEETS,
        OPENS,
        REACH,
        TOP,
        TWO_PI,
        UPPER,
        UPPER_RATE,
        CycleEvents,
        LineMotion,
        ZeroCrossings,
    )

STICK = cython.declare(cython.int, 0)  # states, and causes of rest; a slip has the sign of its force
POSITIVE = cython.declare(cython.int, 1)
NEGATIVE = cython.declare(cython.int, -1)
SEPARATION = cython.declare(cython.int, 2)
# Sets of pieces over which exp(-i m theta) is integrated
STICKS = cython.declare(cython.int, 0)
SIGNED_SLIPS = cython.declare(cython.int, 1)  # positive less negative
CONTACT = cython.declare(cython.int, 2)
LONG = cython.declare(cython.int, 3)  # sticks that are integrated in closed form
# A stick is short up to two radians of its highest harmonic: eight points are then exact to rounding.
SHORT = cython.declare(cython.double, 2.0)
POINTS = cython.declare(cython.int, 8)
_GAUSS = gauss(8)  # POINTS points, on 0 to 1


def join_states(state: cython.int[::1], piece: cython.int[::1], count: cython.int) -> cython.int:
    """Joins successive pieces of a cycle with the same state; returns the number of pieces left.

    Joined pieces keep the number of the first of them; the last piece may join the first of the cycle.

    >>> state, piece = (np.array(numbers, dtype=np.intc) for numbers in ([0, 1, 1, 2, 0], [0, 1, 2, 4, 5]))
    >>> left = join_states(state, piece, 5)
    >>> state[:left].tolist(), piece[:left].tolist()
    ([1, 2, 0], [1, 4, 5])
    """
    i: cython.int
    n: cython.int = 0
    for i in range(count):
        if n == 0 or state[n - 1] != state[i]:
            state[n], piece[n] = state[i], piece[i]
            n += 1
    if n > 1 and state[0] == state[n - 1]:
        n -= 1
        for i in range(n):
            state[i], piece[i] = state[i + 1], piece[i + 1]
    return n


@cython.cclass
class LineCycle(CycleEvents):
    """A steady cycle of a contact on a line: its pieces in order, `pieces` in number.

    Attributes
    ----------
    state
        STICK, POSITIVE or NEGATIVE slip, SEPARATION.
    begin
        The angle [rad] at which a piece begins, increasing; the last ends 2 pi after the first begins.
    event
        The event at which a piece begins; meaningless for a single piece with `cause` 0.
    rest
        For a stick, the place of the slider k_u w relative to the mean of u, over the scale of the motion.
    cause
        For a stick, what brought the slider to rest: POSITIVE or NEGATIVE slip, SEPARATION; 0: its start.
    w, slipping, span, span_begin, span_cause
        For the present span: the slider, the side of a slip that continues into it (0: it rests), the event
        and the angle at which it begins, and what brought the slider to rest.
    behaviour, kind, start
        For the motion taken last: results of `LineMotion.load` and `solve`, and the start passed to `solve`.
    greatest_lower, least_upper, overlap
        For a contact that never opens: the greatest top, the least bottom, and the first minus the second.
    """

    def __init__(self, motion: LineMotion) -> None:
        crossings = ZeroCrossings(motion)
        size = 2 * crossings.capacity + 4
        CycleEvents.__init__(self, motion, size)
        self.crossings = crossings
        self.state, self.event = np.zeros(size, dtype=np.intc), np.zeros(size, dtype=np.intc)
        self.cause = np.zeros(size, dtype=np.intc)
        self.begin, self.rest = np.zeros(size), np.zeros(size)
        self.pieces = self.slipping = self.span = self.span_cause = 0
        self.span_begin = self.w = self.start = 0.0
        self.overlap = self.greatest_lower = self.least_upper = 0.0
        self.behaviour = self.kind = UNKNOWN
        self.numbers, self.contact = np.zeros(2 + 4 * motion.count), ContactParameters()

    def take(self, x: cython.double[::1], first: cython.Py_ssize_t, contact: ContactParameters) -> cython.int:
        """Solves the cycle of the motion x[first:], see `solve`; unless it is the motion taken last."""
        if self.known(x, first, contact):
            return self.kind
        i: cython.Py_ssize_t
        self.behaviour = self.motion.load(x, first, contact)
        if self.behaviour == UNKNOWN or not isfinite(contact.start_x):
            self.kind = self.solve(UNKNOWN, 0.0)
            return self.kind
        self.start = contact.k_u * (contact.start_x - x[first]) / self.motion.scale
        self.kind = self.solve(self.behaviour, self.start)
        for i in range(self.numbers.shape[0]):
            self.numbers[i] = x[first + i]
        self.contact.take(contact)
        self.motion.taken = True
        return self.kind

    def known(self, x: cython.double[::1], first: cython.Py_ssize_t, contact: ContactParameters) -> bool:
        """Whether motion and parameters equal those taken last."""
        i: cython.Py_ssize_t
        if not (self.motion.taken and self.contact.equals(contact)):
            return False
        for i in range(self.numbers.shape[0]):  # noqa: SIM110 - a loop in C
            if self.numbers[i] != x[first + i]:
                return False
        return True

    def solve(self, behaviour: cython.int, start: float) -> cython.int:
        """Solves the cycle of a loaded motion; returns OPEN, STUCK or MIXED.

        start: place of the slider at the start, relative to the mean of u. A contact that never slips has one
        piece, a stick, whose cause is 0 unless a limit holds it.
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
        while self.crossings.kind[self.crossings.order[first]] != CLOSES:
            first += 1
        self.march(first, CLOSES)
        return MIXED

    def far_inside(self, start: float) -> bool:
        """Whether the slider stays between the limits whatever the phases of the harmonics."""
        spare: float = self.motion.mean[REACH] - self.motion.limit_bound[0] - fabs(start)
        return spare >= 0.0

    def sort_cuts(self) -> None:
        """Sorts the cuts by angle, reduced to the turn that begins at the first node."""
        i: cython.int
        for i in range(self.crossings.count):
            if self.crossings.angle[i] < self.motion.first:
                self.crossings.angle[i] += TWO_PI
            elif self.crossings.angle[i] >= self.motion.first + TWO_PI:
                self.crossings.angle[i] -= TWO_PI
        self.crossings.sort()

    def never_open(self, start: float) -> cython.int:
        """Solves a cycle without separation; from the greatest top if it lies above the least bottom."""
        i: cython.int
        e: cython.int
        top: cython.int = -1
        bottom: cython.int = -1
        first: cython.int = 0
        for i in range(self.crossings.count):
            e = self.place(
                self.crossings.angle[self.crossings.order[i]], self.crossings.kind[self.crossings.order[i]]
            )
            if self.crossings.kind[self.crossings.order[i]] == TOP:
                if top < 0 or self.lower[e] > self.lower[top]:
                    top, first = e, i
            elif bottom < 0 or self.upper[e] < self.upper[bottom]:
                bottom = e
        if top < 0 or bottom < 0:  # a limit that is constant, or nearly so
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
        """Passes through all spans, from the cut at which w is known."""
        count: cython.int = self.crossings.count
        turn: float = 0.0
        i: cython.int
        at: cython.int = first
        theta: float = self.crossings.angle[self.crossings.order[first]]
        opened: bool = False
        self.slipping, self.span_cause = 0, POSITIVE
        self.span = first if kind == TOP else self.place(theta, kind)
        self.span_begin, self.w = theta, self.lower[self.span]
        never_opens: bool = kind == TOP  # then all cuts have been placed, in order
        if kind == CLOSES:
            self.close()
        for i in range(count if never_opens else count - 1):  # noqa: B007
            at += 1
            if at == count:
                at, turn = 0, TWO_PI
            theta = self.crossings.angle[self.crossings.order[at]] + turn
            kind = self.crossings.kind[self.crossings.order[at]]
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

    def add(self, state: cython.int, event: cython.int, theta: float, rest: float, cause: cython.int) -> None:
        """Appends a piece, unless the last one has the same state."""
        i: cython.int = self.pieces
        if i > 0 and self.state[i - 1] == state:
            return
        self.state[i], self.event[i], self.begin[i] = state, event, theta
        self.rest[i], self.cause[i] = rest, cause
        self.pieces += 1

    def length(self, p: cython.int) -> float:
        """Length [rad] of piece p."""
        end: float = self.begin[p + 1] if p + 1 < self.pieces else self.begin[0] + TWO_PI
        length: float = end - self.begin[p]
        return length

    def along(self, p: cython.int) -> float:
        """Derivative of the place of the slider in stick p by the load, beside that by k_u u; see `cause`.

        After a slip it is that of the limit. After a separation w = u where the load vanishes, and that
        instant moves by -dn / n'.
        """
        e: cython.int = self.event[p]
        along: float = -1.0 if self.cause[p] == POSITIVE else 1.0
        if self.cause[p] == SEPARATION:
            # its limits are never steeper than the motion here; otherwise it would not stick
            along = self.motion.ratio * self.load_rate[e]
            if fabs(self.motion_rate[e]) < along:
                along = -self.motion_rate[e] / along
            else:
                along = -1.0 if self.motion_rate[e] > 0.0 else 1.0
        return along

    def close(self) -> None:
        """Sets the slider where the contact closes, and whether it slips at once, (20) to (22)."""
        self.w, self.span_cause, self.slipping = self.moved[self.span], SEPARATION, 0
        if self.pushes(POSITIVE):
            self.slipping = POSITIVE
        elif self.pushes(NEGATIVE):
            self.slipping = NEGATIVE

    def pushes(self, side: cython.int) -> bool:
        """Whether a limit that has met the slider continues to push it, by more than rounding."""
        if side == 0:
            return False
        rate: float = self.lower_rate[self.span] if side > 0 else -self.upper_rate[self.span]
        rounding: float = self.crossings.noise
        return rate > rounding

    def advance(self, end: cython.int, theta: float, kind: cython.int) -> None:
        """Passes one span, up to a cut; the contact is closed before it."""
        if kind == OPENS:
            self.lower[end] = self.upper[end] = self.moved[end]
        self.margin[end] = self.w - self.upper[end] if kind == BOTTOM else self.lower[end] - self.w
        w: float = max(self.lower[end], min(self.w, self.upper[end]))
        side: cython.int = POSITIVE if w > self.w else NEGATIVE if w < self.w else 0
        if side == 0 or side != self.slipping:
            self.add(STICK, self.span, self.span_begin, self.w, self.span_cause)
        if side != 0:
            self.slip(side, end, theta)
        if side != 0:
            self.span_cause = side
        self.w, self.span, self.span_begin = w, end, theta
        self.slipping = side if kind != (TOP if side > 0 else BOTTOM) and self.pushes(side) else 0

    def slip(self, side: cython.int, end: cython.int, theta: float) -> None:
        """Appends the slip at the end of a span, with the angle at which it begins."""
        begin: float
        if side == self.slipping:
            self.add(side, self.span, self.span_begin, 0.0, 0)
        else:
            begin = self.slip_begin(side, end, theta)
            self.add(side, self.place(begin, MEETS), begin, 0.0, 0)

    def slip_begin(self, side: cython.int, end: cython.int, theta: float) -> float:
        """Angle at which the pushing limit meets the resting slider.

        Before that, the limit may have receded from the slider.
        """
        row: cython.int = LOWER if side > 0 else UPPER
        g: float = (self.lower[end] if side > 0 else self.upper[end]) - self.w
        d: float = self.lower_rate[end] if side > 0 else self.upper_rate[end]
        j: cython.int = self.motion.node_before(theta)
        node: cython.int = j % self.motion.nodes
        low: float = self.motion.first + j * self.motion.step
        value: float
        slope: float
        while low > self.span_begin:
            value, slope = self.motion.at[row, node] - self.w, self.motion.at[row + 1, node]
            if low < theta:
                if value * side < 0.0:
                    break
                if value != 0.0:
                    theta, g, d = low, value, slope
            j -= 1
            node = node - 1 if node > 0 else self.motion.nodes - 1
            low = self.motion.first + j * self.motion.step
        else:
            low = self.span_begin
            value = (self.lower[self.span] if side > 0 else self.upper[self.span]) - self.w
            slope = self.lower_rate[self.span] if side > 0 else self.upper_rate[self.span]
            if value * side > -self.crossings.noise:
                value = 0.0  # the limit releases the slider here, and returns
        self.crossings.begin_at(low, value, slope)
        begin: float = self.crossings.root(row, self.w, theta, g, d)
        return begin


@cython.cclass
class LineIntegrals(FourierIntegrals):
    """Integrals over the sets of pieces of a cycle; total_re, total_im (h,): of the force in sticks."""

    def __init__(self, cycle: LineCycle, most: int) -> None:
        FourierIntegrals.__init__(self, cycle.motion, most, 4)
        self.cycle = cycle
        self.stick_re, self.stick_im = np.zeros((2, self.most + 1))
        self.grow_re, self.grow_im = np.zeros((2, self.highest + 1))
        self.total_re, self.total_im = np.zeros((2, self.most + 1))
        self.points, self.weights = _GAUSS

    def integrate(self) -> None:
        """Computes the integrals of exp(-i m theta) over the sets of pieces, and of the force in sticks."""
        m: cython.int
        p: cython.int
        e: cython.int = self.cycle.event[0]
        self.clear()
        for m in range(self.most + 1):
            self.total_re[m] = self.total_im[m] = 0.0
        self.powers(0, self.cycle.event_cos[e], self.cycle.event_sin[e])
        for p in range(self.cycle.pieces):
            e = self.cycle.event[p + 1 if p + 1 < self.cycle.pieces else 0]
            self.powers((p + 1) % 2, self.cycle.event_cos[e], self.cycle.event_sin[e])
            if self.cycle.state[p] != SEPARATION:
                self.piece(p, p % 2, (p + 1) % 2, max(self.cycle.length(p), 0.0))

    def piece(self, p: cython.int, begin: cython.int, end: cython.int, length: float) -> None:
        """Adds a piece in which the contact is closed to the integrals of its sets."""
        m: cython.int
        state: cython.int = self.cycle.state[p]
        w: float = self.cycle.rest[p]
        self.add(CONTACT, begin, end, length, 1.0)
        if state != STICK:
            self.add(SIGNED_SLIPS, begin, end, length, 1.0 if state == POSITIVE else -1.0)
            return
        self.add(STICKS, begin, end, length, 1.0)
        if length * self.highest <= SHORT:
            self.short_stick(p, begin, length)
            return
        self.add(LONG, begin, end, length, 1.0)
        self.total_re[0] -= w * length
        for m in range(1, self.most + 1):
            self.total_re[m] -= w * ((self.power_sin[end, m] - self.power_sin[begin, m]) * self.reciprocal[m])
            self.total_im[m] += w * ((self.power_cos[begin, m] - self.power_cos[end, m]) * self.reciprocal[m])

    def short_stick(self, p: cython.int, begin: cython.int, length: float) -> None:
        """Adds the integrals of f exp(-i h theta) over a short stick, from f at its beginning."""
        e: cython.int = self.cycle.event[p]
        i: cython.int
        k: cython.int
        m: cython.int
        h: cython.int
        a: float
        b: float
        reach: float = 0.5 * (self.cycle.upper[e] - self.cycle.lower[e])
        start: float = 0.0
        if self.cycle.cause[p] != SEPARATION:
            start = self.cycle.cause[p] * reach
        for m in range(self.most + 1):
            self.stick_re[m] = self.stick_im[m] = 0.0
        for i in range(POINTS):
            y: float = self.points[i] * length
            half: float = sin(0.5 * y)
            f: float = start
            limit: float = reach
            self.grow(-2.0 * half * half, sin(y))
            for k in range(self.motion.moving):
                h = self.motion.number[k]
                a = self.power_cos[begin, h] * self.grow_re[h] - self.power_sin[begin, h] * self.grow_im[h]
                b = self.power_sin[begin, h] * self.grow_re[h] + self.power_cos[begin, h] * self.grow_im[h]
                f += self.motion.re[FORCE, k] * a - self.motion.im[FORCE, k] * b
                limit += self.motion.re[REACH, k] * a - self.motion.im[REACH, k] * b
            # if the load is tiny relative to the motion, rounding may put f beyond the limit
            f = max(-limit, min(f, limit))
            f *= self.weights[i] * length
            for m in range(self.most + 1):
                self.stick_re[m] += f * (1.0 + self.grow_re[m])
                self.stick_im[m] -= f * self.grow_im[m]
        for m in range(self.most + 1):
            a, b = self.power_cos[begin, m], self.power_sin[begin, m]
            self.total_re[m] += self.stick_re[m] * a + self.stick_im[m] * b
            self.total_im[m] += self.stick_im[m] * a - self.stick_re[m] * b

    def grow(self, re: float, im: float) -> None:
        """Fills exp(i m y) - 1 for all m from the value of m = 1, each with full relative accuracy."""
        m: cython.int
        a: float = 0.0
        b: float = 0.0
        next_a: float
        for m in range(1, self.highest + 1):
            next_a = a + re + (a * re - b * im)
            b = b + im + (a * im + b * re)
            a = next_a
            self.grow_re[m], self.grow_im[m] = a, b


@cython.cclass
class LineDerivatives(ForceDerivatives):
    """Derivatives of the forces on a line; `memory` (unknown,) holds those of one place of rest."""

    def __init__(self, integrals: LineIntegrals, outputs: list[int]) -> None:
        ForceDerivatives.__init__(self, integrals, outputs)
        self.cycle, self.memory = integrals.cycle, np.zeros(self.unknowns)

    def stick(self) -> None:
        """Sets the derivatives of a contact that never slips."""
        i: cython.int
        self.jacobian[1, 1] = 1.0
        if self.cycle.cause[0] == 0:
            self.jacobian[0, 0] = 1.0
        else:
            self.gradient(0)
            for i in range(self.unknowns):
                self.jacobian[0, i] = -self.memory[i]
        self.stick_waves()

    def slip(self) -> None:
        """Adds the derivatives of a contact that slips or opens."""
        i: cython.int
        p: cython.int
        for i in range(-1, self.outputs):
            self.add_product(i, 0, STICKS, 0)
            self.add_product(i, 0, SIGNED_SLIPS, 1)
            self.add_product(i, 1, CONTACT, 1)
        for p in range(self.cycle.pieces):
            if self.cycle.state[p] == STICK:
                self.gradient(p)
                self.remember(p)

    def gradient(self, p: cython.int) -> None:
        """Fills `memory`: derivatives of the place of rest in stick p, except that by the mean of u."""
        e: cython.int = self.cycle.event[p]
        along: float = self.cycle.along(p)
        k: cython.int
        self.integrals.powers(0, self.cycle.event_cos[e], self.cycle.event_sin[e])
        self.memory[0], self.memory[1] = 0.0, along
        for k in range(self.motion.count):
            c: float = self.integrals.power_cos[0, self.motion.number[k]]
            s: float = self.integrals.power_sin[0, self.motion.number[k]]
            self.memory[2 + 4 * k], self.memory[3 + 4 * k] = c, -s
            self.memory[4 + 4 * k], self.memory[5 + 4 * k] = along * c, -along * s

    def remember(self, p: cython.int) -> None:
        """Subtracts the contribution of stick p; `gradient` has filled the powers of its start."""
        i: cython.int
        j: cython.int
        h: cython.int
        row: cython.Py_ssize_t
        next_p: cython.int = p + 1 if p + 1 < self.cycle.pieces else 0
        e: cython.int = self.cycle.event[next_p]
        re: float
        im: float
        self.integrals.powers(1, self.cycle.event_cos[e], self.cycle.event_sin[e])
        for j in range(1, self.unknowns):
            self.jacobian[0, j] -= 0.5 / PI * self.cycle.length(p) * self.memory[j]
        for i in range(self.outputs):
            h = self.output[i]
            row = 2 + 4 * i
            re = self.integrals.power_sin[1, h] - self.integrals.power_sin[0, h]
            im = self.integrals.power_cos[1, h] - self.integrals.power_cos[0, h]
            re, im = re * self.integrals.reciprocal[h] / PI, im * self.integrals.reciprocal[h] / PI
            for j in range(1, self.unknowns):
                self.jacobian[row, j] -= re * self.memory[j]
                self.jacobian[row + 1, j] -= im * self.memory[j]


@cython.cclass
class PeriodicContact(ContactKernel):
    """Kernel of contacts on a line.

    Parameters
    ----------
    harmonics, outputs : list of int, each increasing, from 1 on
        Harmonics of the displacements, and of the forces; the mean is always one.

    Notes
    -----
    Unknowns and forces are real numbers in the order

        mean u, mean v, then for each harmonic h:  Re U_h, Im U_h, Re V_h, Im V_h
        mean f, mean n, then for each harmonic h:  Re F_h, Im F_h, Re N_h, Im N_h

    Another kernel obtains the stiffness d Re F_1 / d Re U_1 as follows:

        from cython.cimports.fcm.contact.periodic.cycle import PeriodicContact

        kernel: PeriodicContact                   # PeriodicContact([1, 2, 3, 9], [1, 2, 3, 9, 10])
        kernel.evaluate(x, first, contact, True)  # ContactParameters(mu, k_u, k_v, n_0)
        stiffness = kernel.jacobian[2, 2]
    """

    def __init__(self, harmonics: list[int], outputs: list[int]) -> None:
        self.cycle = LineCycle(LineMotion(harmonics))
        self.integrals = LineIntegrals(self.cycle, max(outputs, default=0))
        self.derivatives = LineDerivatives(self.integrals, outputs)
        ContactKernel.__init__(self, self.derivatives)

    def evaluate(
        self, x: cython.double[::1], first: cython.Py_ssize_t, contact: ContactParameters, gradient: bool
    ) -> cython.int:
        self.kind = self.cycle.take(x, first, contact)
        self.behaviour = self.cycle.behaviour
        nothing: float = NAN if self.kind == UNKNOWN else 0.0
        self.clear(nothing)
        if self.kind == STUCK:
            self.stick()
        elif self.kind == MIXED:
            self.integrals.integrate()
            self.slip()
        if gradient:
            self.derivatives.fill(nothing)
            if self.kind == STUCK:
                self.derivatives.stick()
            elif self.kind == MIXED:
                self.derivatives.slip()
        if self.kind == STUCK or self.kind == MIXED:
            self.rescale()
            if gradient:
                self.derivatives.rescale(contact)
        return self.kind

    def solve(
        self, x: cython.double[::1], first: cython.Py_ssize_t, contact: ContactParameters
    ) -> cython.int:
        return self.cycle.take(x, first, contact)

    def resist(self, contact: ContactParameters, resistance: cython.double[:, ::1]) -> None:
        p: cython.int
        stick: float = 0.0
        closed: float = 0.0
        pushed: float = 0.0
        for p in range(self.cycle.pieces):
            state: cython.int = self.cycle.state[p]
            length: float = self.cycle.length(p) / TWO_PI
            closed += length if state != SEPARATION else 0.0
            stick += length if state == STICK else 0.0
            pushed += length if state == POSITIVE else -length if state == NEGATIVE else 0.0
        resistance[0, 0] = stick * contact.k_u if contact.mu > 0.0 else 0.0
        resistance[0, 1] = pushed * contact.mu * contact.k_v
        resistance[1, 1] = closed * contact.k_v

    def stick(self) -> None:
        """Sets the forces of a sticking contact.

        Its slider rests at its start, or at the extreme of the limit that holds it.
        """
        self.forces[0] = -self.cycle.rest[0]
        self.take_waves(0, FORCE)
        self.press(LOAD)

    def slip(self) -> None:
        """Sets the forces from the integrals; the totals contain the short sticks already."""
        i: cython.int
        h: cython.int
        row: cython.Py_ssize_t
        opens: cython.bint = self.behaviour != CLOSED
        for i in range(-1, self.outputs):
            h = self.output[i] if i >= 0 else 0
            self.integrals.product(h, LONG, FORCE)
            re: float = self.integrals.total_re[h] + self.integrals.re
            im: float = self.integrals.total_im[h] + self.integrals.im
            self.integrals.product(h, SIGNED_SLIPS, REACH)
            re, im = re + self.integrals.re, im + self.integrals.im
            self.integrals.re = self.integrals.im = 0.0
            if opens:
                self.integrals.product(h, CONTACT, LOAD)
            if i < 0:
                self.forces[0], self.forces[1] = 0.5 / PI * re, 0.5 / PI * self.integrals.re
            else:
                row = 2 + 4 * i
                self.forces[row], self.forces[row + 1] = re / PI, im / PI
                self.forces[row + 2] = self.integrals.re / PI
                self.forces[row + 3] = self.integrals.im / PI
        if not opens:
            self.press(LOAD)
