"""Kernel: signed distances of a contact from other regimes (margins); extremes and energy of a cycle.

A regime of a contact is the sequence of its events. The derivatives of its forces jump, or begin like a
square root, where

- an extreme of the load passes zero: the contact closes once more, or opens once more;
- the greatest lower limit of the slider passes the least upper one: it begins to slip, equation (25);
- one of these two passes the start of the slider of a contact that never slips;
- an extreme of a limit passes the slider that rests there: another slip begins, which leaves the slider
  elsewhere; or another extreme of a limit holds the slider of a contact that never slips.

The derivatives are continuous where a slip halts (P to PEP), and where the direction of slip at opening or
closing changes. `Margins` are these functions for any motion, smooth while the preceding events do not
change. `Measures` are the extremes and the energy of a solved cycle.
"""

from __future__ import annotations

import cython
import numpy as np
from cython.cimports.libc.math import cos, fabs, sin

from fcm.contact.periodic.gauss import gauss

if cython.compiled:
    from cython.cimports.fcm.contact.closed_form import NAN
    from cython.cimports.fcm.contact.contact_kernel import (
        CLOSED,
        MIXED,
        OPEN,
        STUCK,
        UNKNOWN,
        ContactParameters,
        CycleMeasures,
    )
    from cython.cimports.fcm.contact.periodic.cycle import NEGATIVE, POSITIVE, SEPARATION, STICK, LineCycle
    from cython.cimports.fcm.contact.periodic.motion import (
        BOTTOM,
        FORCE,
        FORCE_RATE,
        LOAD,
        LOAD_RATE,
        LOWER,
        LOWER_RATE,
        REACH,
        TOP,
        TWO_PI,
        UPPER,
        UPPER_RATE,
        LineMotion,
        ZeroCrossings,
    )
else:
    from fcm.contact.closed_form import NAN
    from fcm.contact.contact_kernel import (
        CLOSED,
        MIXED,
        OPEN,
        STUCK,
        UNKNOWN,
        ContactParameters,
        CycleMeasures,
    )
    from fcm.contact.periodic.cycle import NEGATIVE, POSITIVE, SEPARATION, STICK, LineCycle
    from fcm.contact.periodic.motion import (
        BOTTOM,
        FORCE,
        FORCE_RATE,
        LOAD,
        LOAD_RATE,
        LOWER,
        LOWER_RATE,
        REACH,
        TOP,
        TWO_PI,
        UPPER,
        UPPER_RATE,
        LineMotion,
        ZeroCrossings,
    )

CLOSES = cython.declare(cython.int, 0)  # kinds of margins
OPENS = cython.declare(cython.int, 1)
SLIPS = cython.declare(cython.int, 2)
MOST = cython.declare(cython.int, 3)
LEAST = cython.declare(cython.int, 4)
UPWARDS = cython.declare(cython.int, 5)
DOWNWARDS = cython.declare(cython.int, 6)
MINIMUM = cython.declare(cython.int, 7)
MAXIMUM = cython.declare(cython.int, 8)
FIXED = cython.declare(cython.int, 5)  # number of kinds with one margin each
PAST = cython.declare(cython.double, 1.0)  # size of a margin of which only the sign is known


@cython.cclass
class RegimeMargins:
    """Margins of a motion: value, kind, angle (margin,), the first `count` of them; `most` is the capacity.

    Values are relative to the scale of the load or of the motion; angles [rad] are those of the extremes.
    """

    def __init__(self, normal: LineMotion, of_slips: int) -> None:
        self.normal, self.crossings = normal, ZeroCrossings(normal)
        self.most, self.count = FIXED + self.crossings.capacity + of_slips, 0
        self.value, self.angle = np.zeros(self.most), np.zeros(self.most)
        self.kind = np.zeros(self.most, dtype=np.intc)

    def find(self, x: cython.double[::1], first: cython.Py_ssize_t, contact: ContactParameters) -> None:
        """Computes the margins of the motion x[first:] of a contact; see `ContactKernel`."""

    def note(self, kind: cython.int, angle: float, value: float) -> None:
        """Appends a margin if there is room for it."""
        if self.count < self.most:
            self.kind[self.count], self.angle[self.count], self.value[self.count] = kind, angle, value
            self.count += 1

    def squared(
        self, kind: cython.int, x: cython.double[::1], first: cython.Py_ssize_t, contact: ContactParameters
    ) -> float:
        """The squared margin of a kind, a smooth function of the motion; NaN if the margin is not a root."""
        none: float = NAN
        return none

    def loads(self, behaviour: cython.int) -> None:
        """Appends the margins of closing and opening, from the extremes of the sampled load.

        If the extremes cannot matter, only the signs of the margins are set.
        """
        i: cython.int
        value: float
        self.note(CLOSES, 0.0, PAST if behaviour == CLOSED else -PAST)
        self.note(OPENS, 0.0, self.value[0])
        if behaviour != MIXED:
            return
        self.value[0] = self.value[1] = self.normal.at[LOAD, 0]
        self.crossings.begin()
        self.crossings.search(LOAD_RATE, MINIMUM, MAXIMUM)
        for i in range(self.crossings.count):
            value, _ = self.normal.evaluate(LOAD, self.crossings.angle[i])
            self.note(self.crossings.kind[i], self.crossings.angle[i], value)
            self.value[0], self.value[1] = max(self.value[0], value), min(self.value[1], value)


@cython.cclass
class Margins(RegimeMargins):
    """Margins of a contact on a line; `find` computes them for a motion."""

    def __init__(self, cycle: LineCycle) -> None:
        RegimeMargins.__init__(self, cycle.motion, 2 * cycle.motion.highest + 2)
        self.cycle = cycle

    def find(self, x: cython.double[::1], first: cython.Py_ssize_t, contact: ContactParameters) -> None:
        kind: cython.int = self.cycle.take(x, first, contact)
        self.count = 0
        if self.cycle.behaviour == UNKNOWN:
            return
        self.loads(self.cycle.behaviour)
        if contact.mu * contact.k_u > 0.0 and kind != OPEN:
            self.slips(kind, self.cycle.behaviour, self.cycle.start)

    def slips(self, kind: cython.int, behaviour: cython.int, start: float) -> None:
        """Appends the margins of slip, for a contact with friction that closes."""
        e: cython.int
        if kind == STUCK:
            if behaviour == CLOSED and self.cycle.far_inside(start):
                self.note(SLIPS, 0.0, -PAST)
                self.note(MOST, 0.0, PAST)
                self.note(LEAST, 0.0, PAST)
            else:
                self.note(SLIPS, 0.0, self.cycle.overlap)
                self.note(MOST, 0.0, self.cycle.least_upper - start)
                self.note(LEAST, 0.0, start - self.cycle.greatest_lower)
                if start < self.cycle.greatest_lower:
                    self.holders(TOP, UPWARDS, self.cycle.lower, 1.0)
                elif start > self.cycle.least_upper:
                    self.holders(BOTTOM, DOWNWARDS, self.cycle.upper, -1.0)
            return
        self.note(SLIPS, 0.0, self.cycle.overlap if self.cycle.overlap > 0.0 else PAST)
        for e in range(self.cycle.events):
            if self.cycle.event_kind[e] == TOP:
                self.note(UPWARDS, self.cycle.event_angle[e], self.cycle.margin[e])
            elif self.cycle.event_kind[e] == BOTTOM:
                self.note(DOWNWARDS, self.cycle.event_angle[e], self.cycle.margin[e])

    def holders(self, extreme: cython.int, kind: cython.int, limit: cython.double[::1], side: float) -> None:
        """Appends the margin of each extreme of the limit that holds the slider to the furthest other one."""
        e: cython.int
        furthest: cython.int = -1
        second: cython.int = -1
        for e in range(self.cycle.events):
            if self.cycle.event_kind[e] == extreme:
                if furthest < 0 or side * limit[e] > side * limit[furthest]:
                    furthest, second = e, furthest
                elif second < 0 or side * limit[e] > side * limit[second]:
                    second = e
        if second < 0:
            return
        for e in range(self.cycle.events):
            if self.cycle.event_kind[e] == extreme:
                other: cython.int = second if e == furthest else furthest
                self.note(kind, self.cycle.event_angle[e], side * (limit[e] - limit[other]))


LEAST_LOAD = cython.declare(cython.int, 10)  # kinds of extremes, beside TOP and BOTTOM
GREATEST_LOAD = cython.declare(cython.int, 11)
TURN = cython.declare(cython.int, 12)  # extremes of the motion
POINTS = cython.declare(cython.int, 8)
PART = cython.declare(cython.double, 3.0)  # length [rad] over which POINTS points err by 2e-15
_GAUSS = gauss(8)  # POINTS points, on 0 to 1


def greatest_load(crossings: ZeroCrossings) -> float:
    """Greatest load of a sampled motion, over the extremes in `crossings`, relative to the load's scale."""
    i: cython.int
    value: float
    high: float = crossings.motion.at[LOAD, 0]
    for i in range(crossings.count):
        if crossings.kind[i] == GREATEST_LOAD:
            value, _ = crossings.motion.evaluate(LOAD, crossings.angle[i])
            high = max(high, value)
    return high


@cython.cclass
class Measures(CycleMeasures):
    """Measures of the cycle of a contact on a line.

    Attributes
    ----------
    least_load, greatest_load
        Extremes of n_0 + k_v v [force]: the first is positive if the contact never opens. The second, as
        computed by `measure`, is negative if it never closes.
    overlap
        Greatest lower limit minus least upper limit of k_u w [force], equation (25): negative if the contact
        never slips; positive for a contact that opens.
    """

    def __init__(self, cycle: LineCycle) -> None:
        CycleMeasures.__init__(self, cycle.state)
        self.cycle, self.motion = cycle, cycle.motion
        self.crossings = ZeroCrossings(cycle.motion)
        self.value = np.zeros(self.crossings.capacity)
        self.least_load = self.overlap = self.piece_energy = self.piece_path = 0.0
        self.points, self.weights = _GAUSS
        self.turn_cos, self.turn_sin = np.zeros((2, POINTS))

    def measure(self, k_u: float) -> None:
        """Computes all attributes of the present cycle."""
        self.motion.sample()
        self.friction()
        self.extremes()
        self.slips(k_u)

    def bear(self, contact: ContactParameters) -> None:
        """Computes the attributes of `CycleMeasures`, which costs less than `measure`."""
        self.pieces = self.cycle.pieces
        self.motion.sample()
        self.friction()
        # `friction` has found the extremes
        self.greatest_load = max(greatest_load(self.crossings) * self.motion.load_scale, 0.0)
        self.slips(contact.k_u)

    def extremes(self) -> None:
        """Computes the extremes of the load and of both limits as if the contact never opened."""
        i: cython.int
        kind: cython.int
        value: float
        low: float = self.motion.at[LOAD, 0]
        high: float = low
        top: float = self.motion.at[LOWER, 0]
        bottom: float = self.motion.at[UPPER, 0]
        self.crossings.begin()
        self.crossings.search(LOAD_RATE, LEAST_LOAD, GREATEST_LOAD)
        self.crossings.search(LOWER_RATE, -1, TOP)
        self.crossings.search(UPPER_RATE, BOTTOM, -1)
        for i in range(self.crossings.count):
            kind = self.crossings.kind[i]
            value, _ = self.motion.evaluate(
                LOWER if kind == TOP else UPPER if kind == BOTTOM else LOAD, self.crossings.angle[i]
            )
            self.value[i] = value
            if kind == TOP:
                top = max(top, value)
            elif kind == BOTTOM:
                bottom = min(bottom, value)
            else:
                low, high = min(low, value), max(high, value)
        self.least_load, self.greatest_load = low * self.motion.load_scale, high * self.motion.load_scale
        self.overlap = (top - bottom) * self.motion.scale

    def friction(self) -> None:
        """Computes the greatest friction force: at an event, or at an extreme of the load or the motion."""
        p: cython.int
        i: cython.int
        self.crossings.begin()
        self.crossings.search(LOAD_RATE, LEAST_LOAD, GREATEST_LOAD)
        self.crossings.search(FORCE_RATE, TURN, TURN)
        most: float = 0.0
        for p in range(self.cycle.pieces):
            if self.cycle.pieces > 1:
                most = max(most, fabs(self.force(p, self.cycle.begin[p])))
        for i in range(self.crossings.count):
            most = max(most, fabs(self.force(self.piece(self.crossings.angle[i]), self.crossings.angle[i])))
        if self.crossings.count == 0 and self.cycle.pieces == 1:
            most = fabs(self.force(0, 0.0))
        self.greatest_friction = most * self.motion.scale

    def piece(self, theta: float) -> cython.int:
        """Number of the piece that contains an angle."""
        p: cython.int = 0
        begin: float = self.cycle.begin[0]
        while theta < begin:
            theta += TWO_PI
        while theta >= begin + TWO_PI:
            theta -= TWO_PI
        while p + 1 < self.cycle.pieces and self.cycle.begin[p + 1] <= theta:
            p += 1
        return p

    def force(self, p: cython.int, theta: float) -> float:
        """Friction force at an angle in piece p, divided by the scale of the motion."""
        state: cython.int = self.cycle.state[p]
        value: float = 0.0
        if state == STICK:
            value, _ = self.motion.evaluate(FORCE, theta)
            value -= self.cycle.rest[p]
        elif state != SEPARATION:
            value, _ = self.motion.evaluate(REACH, theta)
            value *= state
        return value

    def slips(self, k_u: float) -> None:
        """Computes the energy and path of all slips, as sums of non-negative terms."""
        p: cython.int
        energy: float = 0.0
        path: float = 0.0
        for p in range(self.cycle.pieces):
            if self.cycle.state[p] == POSITIVE or self.cycle.state[p] == NEGATIVE:
                self.slip(p, self.cycle.length(p))
                energy += self.piece_energy
                path += self.piece_path
        # energy and path are in forces squared and forces: the stiffness converts them; friction needs a
        # stiffness
        length: float = self.motion.scale / k_u if k_u > 0.0 else 0.0
        self.dissipation, self.slip_path = energy * self.motion.scale * length, path * length

    def slip(self, p: cython.int, length: float) -> None:
        """Integrates energy and path over one slip by Gauss's rule, in sufficiently short parts."""
        i: cython.int
        j: cython.int
        row: cython.int = LOWER if self.cycle.state[p] > 0 else UPPER
        parts: cython.int = cython.cast(cython.int, 2.0 / PART * length * max(self.motion.highest, 1)) + 1
        step: float = length / parts
        c: float
        s: float
        rate: float
        load: float
        for j in range(POINTS):
            self.turn_cos[j], self.turn_sin[j] = cos(step * self.points[j]), sin(step * self.points[j])
        self.piece_energy = self.piece_path = 0.0
        for i in range(parts):
            c, s = cos(self.cycle.begin[p] + step * i), sin(self.cycle.begin[p] + step * i)
            for j in range(POINTS):
                _, rate, load = self.motion.derivatives(
                    row,
                    REACH,
                    c * self.turn_cos[j] - s * self.turn_sin[j],
                    s * self.turn_cos[j] + c * self.turn_sin[j],
                )
                rate = max(rate * self.cycle.state[p], 0.0) * self.weights[j] * step
                self.piece_energy += rate * max(load, 0.0)
                self.piece_path += rate
