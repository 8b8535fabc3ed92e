"""Kernel: signed distances of a contact in a plane from other regimes (margins); extremes of a cycle.

As on a line, the derivatives of its forces jump, or begin like a root, where

- an extreme of the load passes zero: the contact closes once more, or opens once more;
- all discs begin, or cease, to have a place in common: it stops, or begins, to slip;
- the start of the slider of a contact that never slips leaves the places that all discs have in common;
- a disc begins to hold a slider that never slips, besides the one that does;
- a disc that passes a slider at rest comes to touch it: another slip begins, and leaves it elsewhere.

The derivatives are continuous where lambda vanishes for an instant, so that a slip halts.

`PlanarMeasures` computes greatest forces, energy, slip path and states of a cycle.
"""

from __future__ import annotations

import cython
import numpy as np
from cython.cimports.libc.math import fabs, hypot, sqrt

if cython.compiled:
    from cython.cimports.fcm.contact.closed_form import NAN
    from cython.cimports.fcm.contact.contact_kernel import (
        CLOSED,
        MIXED,
        OPEN,
        STUCK,
        UNKNOWN,
        UNSOLVED,
        ContactParameters,
        CycleMeasures,
    )
    from cython.cimports.fcm.contact.periodic.cycle import join_states
    from cython.cimports.fcm.contact.periodic.margins import (
        GREATEST_LOAD,
        PAST,
        SLIPS,
        RegimeMargins,
        greatest_load,
    )
    from cython.cimports.fcm.contact.periodic.motion import LOAD_RATE, ZeroCrossings
    from cython.cimports.fcm.contact.plane.cycle import PlanarCycle
    from cython.cimports.fcm.contact.plane.panel import SCAN
    from cython.cimports.fcm.contact.plane.resting import FAR
    from cython.cimports.fcm.contact.plane.slider import SEPARATION, SLIP, STICK
else:
    from fcm.contact.closed_form import NAN
    from fcm.contact.contact_kernel import (
        CLOSED,
        MIXED,
        OPEN,
        STUCK,
        UNKNOWN,
        UNSOLVED,
        ContactParameters,
        CycleMeasures,
    )
    from fcm.contact.periodic.cycle import join_states
    from fcm.contact.periodic.margins import GREATEST_LOAD, PAST, SLIPS, RegimeMargins, greatest_load
    from fcm.contact.periodic.motion import LOAD_RATE, ZeroCrossings
    from fcm.contact.plane.cycle import PlanarCycle
    from fcm.contact.plane.panel import SCAN
    from fcm.contact.plane.resting import FAR
    from fcm.contact.plane.slider import SEPARATION, SLIP, STICK


STARTS = cython.declare(cython.int, 3)
HOLDS = cython.declare(cython.int, 4)
PUSHES = cython.declare(cython.int, 5)


@cython.cclass
class PlanarMargins(RegimeMargins):
    """Margins of a contact in a plane; `find` computes them for a motion."""

    def __init__(self, cycle: PlanarCycle) -> None:
        RegimeMargins.__init__(self, cycle.motion.normal, 4 * cycle.motion.highest + 4)
        self.steps = cycle.motion.options.samples_per_radian
        self.cycle, self.motion, self.resting = cycle, cycle.motion, cycle.resting

    def find(self, x: cython.double[::1], first: cython.Py_ssize_t, contact: ContactParameters) -> None:
        behaviour: cython.int = self.motion.load(x, first, contact)
        self.count = 0
        if behaviour == UNKNOWN:
            return
        s_x: float = -self.motion.mean_x
        s_y: float = -self.motion.mean_y
        kind: cython.int = self.cycle.solve(behaviour, s_x, s_y, False)
        if behaviour == MIXED:
            self.normal.sample()
        self.loads(behaviour)
        if not contact.mu * contact.k_u > 0.0 or kind in (OPEN, UNKNOWN):
            return
        if kind == STUCK:
            self.rests(s_x, s_y)
            return
        if self.cycle.behaviour == CLOSED:
            self.resting.encloses(True)
            # a slip is as long as the root of this, and turns by as much
            beyond: float = self.resting.overlap if self.resting.overlap > 0.0 else PAST
            self.note(SLIPS, 0.0, sqrt(beyond * self.motion.reach))
        else:
            self.note(SLIPS, 0.0, PAST)
        if kind != UNSOLVED:
            self.pushes()

    def overlap(self, x: cython.double[::1], contact: ContactParameters, start: bool) -> float:
        """How far all discs of a motion x must grow to share a place [force]; see `resting`.

        With `start` the discs must contain the start of the slider.
        """
        self.hold(x, 0, contact, start)
        reach: float = self.resting.beyond if start else self.resting.overlap
        grown: float = reach * self.motion.scale
        return grown

    def squared(
        self, kind: cython.int, x: cython.double[::1], first: cython.Py_ssize_t, contact: ContactParameters
    ) -> float:
        grown: float = NAN
        if kind == SLIPS:
            self.hold(x, first, contact, False)
            if self.resting.brief():
                grown = self.resting.overlap * self.motion.scale
        return grown

    def hold(
        self,
        x: cython.double[::1],
        first: cython.Py_ssize_t,
        contact: ContactParameters,
        start: cython.bint,
    ) -> None:
        """Examines a motion by `resting`."""
        self.motion.load(x, first, contact)
        self.resting.sampled = False
        if start:
            self.resting.sample()
            self.resting.farthest_of_all(-self.motion.mean_x, -self.motion.mean_y)
        else:
            self.resting.encloses(True)

    def rests(self, s_x: float, s_y: float) -> None:
        """Appends the margins of a contact that never slips: of slip, and of leaving its start."""
        if not self.resting.sampled:  # far inside
            self.note(SLIPS, 0.0, -PAST)
            self.note(STARTS, 0.0, PAST)
            return
        corner: cython.bint = self.resting.held == 2
        if self.resting.held == 1:
            self.note(HOLDS, 0.0, self.other())
        elif self.resting.held == 2:
            self.note(HOLDS, 0.0, -min(self.weaker(s_x, s_y), PAST))
        self.resting.farthest_of_all(s_x, s_y)
        starts: float = -self.resting.beyond
        self.resting.encloses(True)
        room: float = max(-self.resting.overlap, 0.0)
        # a corner of the common places moves as the root of this, and so do the forces
        self.note(SLIPS, 0.0, -sqrt(room * self.motion.reach) if corner else -room)
        self.note(STARTS, 0.0, starts)

    def other(self) -> float:
        """How far the next disc is from holding the place that one disc holds."""
        self.resting.next_farthest()
        room: float = min(-self.resting.beyond, PAST)
        return room

    def weaker(self, s_x: float, s_y: float) -> float:
        """Push of the weaker of the two discs that hold a place: w - s = p_1 e_1 + p_2 e_2."""
        a_x: float = self.resting.basis[0, 0] - self.resting.w_x
        a_y: float = self.resting.basis[0, 1] - self.resting.w_y
        b_x: float = self.resting.basis[1, 0] - self.resting.w_x
        b_y: float = self.resting.basis[1, 1] - self.resting.w_y
        across: float = a_x * b_y - a_y * b_x
        x: float = self.resting.w_x - s_x
        y: float = self.resting.w_y - s_y
        least: float = PAST
        if across == 0.0:
            return least
        one: float = (x * b_y - y * b_x) / across * hypot(a_x, a_y)
        two: float = (a_x * y - a_y * x) / across * hypot(b_x, b_y)
        least = min(one, two)
        return least

    def pushes(self) -> None:
        """Appends for every stick the discs that nearly touch its slider, and its gap after the next slip.

        If there is a single stick, which the beginning of a period may divide, the slip takes the slider back
        to where it was. It then gives no margin, nor does a stick within rounding.
        """
        p: cython.int
        n: cython.int = self.cycle.slider.pieces
        for p in range(n):
            if self.cycle.slider.state[p] != STICK or n == 1:
                continue
            last: cython.bint = p + 1 == n
            follows: cython.int = 0 if last else p + 1
            end: float = self.cycle.slider.begin[p] + self.cycle.slider.length(p)
            self.within(p, end)
            if self.cycle.slider.state[follows] == SLIP:
                after: cython.int = 0 if follows + 1 == n else follows + 1
                whole: cython.bint = p == 0 and after == n - 1 and self.cycle.slider.state[after] == STICK
                if after == p or whole:
                    continue
                halt: float = end + self.cycle.slider.length(follows)
                self.note(PUSHES, halt, self.outside(p, halt))

    def within(self, p: cython.int, end: float) -> None:
        """Appends the margins of the discs within a stick that come nearest to its slider."""
        begin: float = self.cycle.slider.begin[p]
        step: float = 1.0 / (self.steps * max(self.motion.highest, 1))
        steps: cython.int = cython.cast(cython.int, (end - begin) / step) + 2
        i: cython.int
        step = (end - begin) / steps
        older: float = self.outside(p, begin)
        old: float = self.outside(p, begin + step)
        for i in range(2, steps + 1):
            new: float = self.outside(p, begin + i * step)
            if old > older and old >= new:
                self.resting.x, self.resting.y = self.cycle.slider.rest_x[p], self.cycle.slider.rest_y[p]
                self.resting.beyond = -FAR
                self.resting.refine(begin + (i - 1) * step)
                if begin < self.resting.angle < end:
                    self.note(PUSHES, self.resting.angle, min(self.resting.beyond, 0.0))
            older, old = old, new

    def outside(self, p: cython.int, theta: float) -> float:
        """Distance of a stick's slider outside the disc at an angle; negative inside."""
        self.motion.place(SCAN, theta)
        gap: float = hypot(
            self.motion.value[SCAN, 0] - self.cycle.slider.rest_x[p],
            self.motion.value[SCAN, 1] - self.cycle.slider.rest_y[p],
        )
        gap -= fabs(self.motion.value[SCAN, 2])
        return gap


@cython.cclass
class PlanarMeasures(CycleMeasures):
    """Measures of the cycle of a contact in a plane; states begin with the first stick, if there is one."""

    def __init__(self, cycle: PlanarCycle) -> None:
        CycleMeasures.__init__(self, np.zeros(cycle.slider.capacity + 1, dtype=np.intc))
        given = cycle.motion.options
        self.invisible, self.steps = given.min_state_length, given.samples_per_radian
        self.cycle, self.motion = cycle, cycle.motion
        self.crossings = ZeroCrossings(cycle.motion.normal)
        self.growth, self.piece = 0.0, np.zeros(cycle.slider.capacity + 1, dtype=np.intc)

    def bear(self, contact: ContactParameters) -> None:
        rubs: cython.bint = contact.mu * contact.k_u > 0.0
        length: float = self.motion.scale / contact.k_u if contact.k_u > 0.0 else 0.0
        self.greatest_friction = self.dissipation = self.slip_path = 0.0
        self.states(rubs)
        self.loads()
        if rubs and (self.cycle.kind == MIXED or self.cycle.kind == STUCK):
            self.friction()
        if rubs and self.cycle.kind == MIXED:
            self.dissipation = self.cycle.slider.integrals.work * self.motion.scale * length
            self.slip_path = self.cycle.slider.integrals.path * length

    def loads(self) -> None:
        """Computes the greatest load, at one of its extremes."""
        self.motion.normal.sample()
        self.crossings.begin()
        self.crossings.search(LOAD_RATE, -1, GREATEST_LOAD)
        self.greatest_load = max(greatest_load(self.crossings), 0.0) * self.motion.load_scale

    def friction(self) -> None:
        """Computes the greatest friction force: at the ends of a piece, or where it stops growing."""
        p: cython.int
        i: cython.int
        n: cython.int = self.cycle.slider.pieces
        most: float = 0.0
        for p in range(n):
            begin: float = self.cycle.slider.begin[p]
            end: float = begin + self.cycle.slider.length(p)
            step: float = 1.0 / (self.steps * max(self.motion.highest, 1))
            steps: cython.int = cython.cast(cython.int, (end - begin) / step) + 2
            step = (end - begin) / steps
            most = max(most, self.force(p, begin))
            before: float = self.growth
            for i in range(1, steps + 1):
                most = max(most, self.force(p, begin + i * step))
                if before > 0.0 >= self.growth:
                    most = max(most, self.top(p, begin + (i - 1) * step, begin + i * step, before))
                    self.force(p, begin + i * step)
                before = self.growth
        self.greatest_friction = most * self.motion.scale

    def top(self, p: cython.int, low: float, high: float, before: float) -> float:
        """Greatest friction in an interval, where its growth vanishes, by false position (Illinois)."""
        i: cython.int
        after: float = self.growth
        most: float = 0.0
        for i in range(60):  # noqa: B007
            if high - low < 1e-9 or before == after:
                break
            middle: float = (low * after - high * before) / (after - before)
            most = max(most, self.force(p, middle))
            if self.growth > 0.0:
                low, before, after = middle, self.growth, 0.5 * after
            else:
                high, after, before = middle, self.growth, 0.5 * before
        return most

    def force(self, p: cython.int, theta: float) -> float:
        """Magnitude of the friction force in a piece; `growth` is half the derivative of its square."""
        self.motion.place(SCAN, theta)
        self.growth = 0.0
        if self.cycle.slider.state[p] == STICK:
            d_x: float = self.motion.value[SCAN, 0] - self.cycle.slider.rest_x[p]
            d_y: float = self.motion.value[SCAN, 1] - self.cycle.slider.rest_y[p]
            self.growth = d_x * self.motion.value[SCAN, 3] + d_y * self.motion.value[SCAN, 4]
            stretched: float = hypot(d_x, d_y)
            return stretched
        if self.cycle.slider.state[p] == SLIP:
            limit: float = max(self.motion.value[SCAN, 2], 0.0)
            self.growth = limit * self.motion.value[SCAN, 5]
            return limit
        return 0.0

    def states(self, rubs: cython.bint) -> None:
        """Fills the states, without those within rounding, and with equal neighbours joined.

        Without friction a closed contact counts as sticking.
        """
        p: cython.int
        i: cython.int
        state: cython.int
        first: cython.int = 0
        n: cython.int = self.cycle.slider.pieces
        for p in range(n):
            if self.cycle.slider.state[p] == STICK and (
                n == 1 or self.cycle.slider.length(p) > self.invisible
            ):
                first = p
                break
        self.pieces = 0
        for i in range(n):
            p = (first + i) % n
            if n > 1 and self.cycle.slider.length(p) <= self.invisible:
                continue
            state = self.cycle.slider.state[p]
            if state == SLIP and not rubs:
                state = STICK
            self.state[self.pieces], self.piece[self.pieces] = state, p
            self.pieces += 1
        first = self.piece[0]
        self.pieces = join_states(self.state, self.piece, self.pieces)
        if self.piece[0] != first:  # the last state continues in the first, and replaces it
            state = self.state[self.pieces - 1]
            for i in range(self.pieces - 1, 0, -1):
                self.state[i] = self.state[i - 1]
            self.state[0] = state
        if self.cycle.kind == OPEN:
            self.pieces, self.state[0] = 1, SEPARATION
