"""Kernel: how far a contact is from another regime, as signed functions of its motion.

A regime of a contact is the sequence of its events. The derivatives of its forces jump, or begin like a
square root, where

- an extreme of the load passes zero: the contact closes once more, or opens once more;
- the greatest lower limit of the slider passes the least upper one: it begins to slip, equation (25);
- one of these passes the place where the slider of a contact that never slips began;
- an extreme of a limit passes the slider that rests there: another slip begins, and the slider is left
  elsewhere; or another extreme of a limit holds the slider of a contact that never slips.

Where a slip halts (P to PEP), and in which direction a contact slips as it opens and closes, the derivatives
are continuous.
"""

from __future__ import annotations

import cython
import numpy as np

if cython.compiled:
    from cython.cimports.fcm.contact.periodic.crossings import Crossings
    from cython.cimports.fcm.contact.periodic.cycle import STUCK, Cycle
    from cython.cimports.fcm.contact.periodic.events import BOTTOM, TOP
    from cython.cimports.fcm.contact.periodic.motion import (
        CLOSED,
        LOAD,
        LOAD_RATE,
        MIXED,
        OPEN,
        UNKNOWN,
    )
else:
    from fcm.contact.periodic.crossings import Crossings
    from fcm.contact.periodic.cycle import STUCK, Cycle
    from fcm.contact.periodic.events import BOTTOM, TOP
    from fcm.contact.periodic.motion import CLOSED, LOAD, LOAD_RATE, MIXED, OPEN, UNKNOWN

CLOSES = cython.declare(cython.int, 0)  # kinds of margins
OPENS = cython.declare(cython.int, 1)
SLIPS = cython.declare(cython.int, 2)
MOST = cython.declare(cython.int, 3)
LEAST = cython.declare(cython.int, 4)
UPWARDS = cython.declare(cython.int, 5)
DOWNWARDS = cython.declare(cython.int, 6)
MINIMUM = cython.declare(cython.int, 7)
MAXIMUM = cython.declare(cython.int, 8)
FIXED = cython.declare(cython.int, 5)  # kinds of which there is one each
PAST = cython.declare(cython.double, 1.0)  # a margin of which only the sign is known


@cython.cclass
class Margins:
    """`find` gives those of a motion: value, kind, angle (margin,), the first `count` of `most`.

    Values are divided by the scale of the load or of the motion; angles [rad] are those of the extremes.
    """

    def __init__(self, cycle: Cycle) -> None:
        self.cycle, self.motion = cycle, cycle.motion
        self.crossings = Crossings(cycle.motion)
        self.most, self.count = FIXED + self.crossings.capacity + 2 * cycle.motion.highest + 2, 0
        self.value, self.angle = np.zeros(self.most), np.zeros(self.most)
        self.kind = np.zeros(self.most, dtype=np.intc)

    def find(
        self, x: cython.double[::1], first: cython.Py_ssize_t, mu: float, k_u: float, k_v: float, n_0: float
    ) -> None:
        """Of the motion x[first:] of a contact; see `PeriodicContact`."""
        kind: cython.int = self.cycle.take(x, first, mu, k_u, k_v, n_0, 0.0)
        self.count = 0
        if self.cycle.behaviour == UNKNOWN:
            return
        self.loads(self.cycle.behaviour)
        if mu * k_u > 0.0 and kind != OPEN:
            self.slips(kind, self.cycle.behaviour, self.cycle.start)

    def note(self, kind: cython.int, angle: float, value: float) -> None:
        """One more."""
        self.kind[self.count], self.angle[self.count], self.value[self.count] = kind, angle, value
        self.count += 1

    def loads(self, behaviour: cython.int) -> None:
        """Extremes of the load; where they cannot matter, numbers of their sign."""
        i: cython.int
        value: float
        self.note(CLOSES, 0.0, PAST if behaviour == CLOSED else -PAST)
        self.note(OPENS, 0.0, self.value[0])
        if behaviour != MIXED:
            return
        self.value[0] = self.value[1] = self.motion.at[LOAD, 0]
        self.crossings.begin()
        self.crossings.search(LOAD_RATE, MINIMUM, MAXIMUM)
        for i in range(self.crossings.count):
            value, _ = self.motion.evaluate(LOAD, self.crossings.angle[i])
            self.note(self.crossings.kind[i], self.crossings.angle[i], value)
            self.value[0], self.value[1] = max(self.value[0], value), min(self.value[1], value)

    def slips(self, kind: cython.int, behaviour: cython.int, start: float) -> None:
        """Of a contact with friction that closes."""
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
        """How far the extremes of a limit that holds the slider are beyond the furthest other one."""
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
