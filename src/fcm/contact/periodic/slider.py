"""Kernel: the slider w of a contact under any periodic motion, from one cut of the cycle to the next.

The slider is held between the limits of `motion`; it moves only when one of them pushes it, and follows u
while the contact is open. Between two cuts, a span, neither limit has an extreme that could push and let go
again, so the law there is one clip,

    w_end = max(lower, min(w_start, upper)),

and at most one slip, which lasts until the end of the span. A rounding error can shift an event, but never
choose a wrong sequence by more than that error.
"""

from __future__ import annotations

import cython
import numpy as np

if cython.compiled:
    from cython.cimports.fcm.contact.periodic.crossings import Crossings
    from cython.cimports.fcm.contact.periodic.events import BOTTOM, MEETS, OPENS, TOP, Events
    from cython.cimports.fcm.contact.periodic.motion import LOWER, UPPER, Motion
else:
    from fcm.contact.periodic.crossings import Crossings
    from fcm.contact.periodic.events import BOTTOM, MEETS, OPENS, TOP, Events
    from fcm.contact.periodic.motion import LOWER, UPPER, Motion

STICK = cython.declare(cython.int, 0)  # states, and what brought a slider to rest; of a slip its sign
POSITIVE = cython.declare(cython.int, 1)
NEGATIVE = cython.declare(cython.int, -1)
SEPARATION = cython.declare(cython.int, 2)


@cython.cclass
class Slider(Events):
    """The pieces of a cycle in order, up to `pieces`, and the slider at the beginning of the present span.

    Attributes
    ----------
    state
        STICK, POSITIVE or NEGATIVE slip, SEPARATION.
    begin
        The angle [rad] at which it begins, increasing; the last ends at 2 pi after the first begins.
    event
        The event at which it begins; nothing, if it is the only one and `cause` is 0.
    rest
        Of a stick the place of the slider k_u w, from the mean of u, divided by the scale of the motion.
    cause
        Of a stick what brought the slider to rest: POSITIVE or NEGATIVE slip, SEPARATION; 0 its start.
    w, slipping, span, span_begin, span_cause
        Of the present span: the slider, the side of a slip that goes on into it (0: it rests), the event and
        the angle at which it begins, and what brought the slider to rest.
    """

    def __init__(self, motion: Motion) -> None:
        crossings = Crossings(motion)
        size = 2 * crossings.capacity + 4
        Events.__init__(self, motion, size)
        self.crossings = crossings
        self.state, self.event = np.zeros(size, dtype=np.intc), np.zeros(size, dtype=np.intc)
        self.cause = np.zeros(size, dtype=np.intc)
        self.begin, self.rest = np.zeros(size), np.zeros(size)
        self.pieces = self.slipping = self.span = self.span_cause = 0
        self.span_begin = self.w = 0.0

    def add(
        self,
        state: cython.int,
        event: cython.int,
        theta: float,
        rest: float,
        cause: cython.int,
    ) -> None:
        """The next piece, unless it goes on with the last."""
        i: cython.int = self.pieces
        if i > 0 and self.state[i - 1] == state:
            return
        self.state[i], self.event[i], self.begin[i] = state, event, theta
        self.rest[i], self.cause[i] = rest, cause
        self.pieces += 1

    def close(self) -> None:
        """(20) to (22): what follows the separation."""
        self.w, self.span_cause, self.slipping = self.moved[self.span], SEPARATION, 0
        if self.pushes(POSITIVE):
            self.slipping = POSITIVE
        elif self.pushes(NEGATIVE):
            self.slipping = NEGATIVE

    def pushes(self, side: cython.int) -> bool:
        """Whether a limit that has met the slider goes on to push it, beyond rounding."""
        if side == 0:
            return False
        rate: float = self.lower_rate[self.span] if side > 0 else -self.upper_rate[self.span]
        rounding: float = self.crossings.noise
        return rate > rounding

    def advance(self, end: cython.int, theta: float, kind: cython.int) -> None:
        """One span, to a cut at which the contact is closed or opens."""
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
        """The slip that ends a span."""
        begin: float
        if side == self.slipping:
            self.add(side, self.span, self.span_begin, 0.0, 0)
        else:
            begin = self.slip_begin(side, end, theta)
            self.add(side, self.place(begin, MEETS), begin, 0.0, 0)

    def slip_begin(self, side: cython.int, end: cython.int, theta: float) -> float:
        """Where the limit that pushes meets the resting slider; before, it may first have receded."""
        row: cython.int = LOWER if side > 0 else UPPER
        g: float = (self.lower[end] if side > 0 else self.upper[end]) - self.w
        d: float = self.lower_rate[end] if side > 0 else self.upper_rate[end]
        j: cython.int = self.motion.node_before(theta)
        node: cython.int = j % self.motion.nodes
        low: float = self.motion.first + j * self.motion.step
        value: float
        slope: float
        begin: float
        while low > self.span_begin:
            value, slope = self.motion.at[row, node] - self.w, self.motion.at[row + 1, node]
            if low < theta:
                if value * side < 0.0:
                    begin = self.crossings.root(row, self.w, low, value, slope, theta, g, d)
                    return begin
                if value != 0.0:
                    theta, g, d = low, value, slope
            j -= 1
            node = node - 1 if node > 0 else self.motion.nodes - 1
            low = self.motion.first + j * self.motion.step
        value = (self.lower[self.span] if side > 0 else self.upper[self.span]) - self.w
        slope = self.lower_rate[self.span] if side > 0 else self.upper_rate[self.span]
        if value * side > -self.crossings.noise:
            value = 0.0  # the limit lets go of the slider here, and comes back
        begin = self.crossings.root(row, self.w, self.span_begin, value, slope, theta, g, d)
        return begin
