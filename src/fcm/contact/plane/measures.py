"""Kernel: what a cycle in the plane says besides its forces: greatest ones, energy, way, states in order."""

from __future__ import annotations

import cython
import numpy as np
from cython.cimports.libc.math import hypot

if cython.compiled:
    from cython.cimports.fcm.contact.periodic.events import Crossings
    from cython.cimports.fcm.contact.periodic.motion import LOAD, LOAD_RATE, MIXED, OPEN
    from cython.cimports.fcm.contact.plane.cycle import STUCK, Cycle
    from cython.cimports.fcm.contact.plane.motion import SCAN
    from cython.cimports.fcm.contact.plane.slider import SEPARATION, SLIP, STICK
else:
    from fcm.contact.periodic.events import Crossings
    from fcm.contact.periodic.motion import LOAD, LOAD_RATE, MIXED, OPEN
    from fcm.contact.plane.cycle import STUCK, Cycle
    from fcm.contact.plane.motion import SCAN
    from fcm.contact.plane.slider import SEPARATION, SLIP, STICK

TWO_PI = cython.declare(cython.double, 6.283185307179586)


@cython.cclass
class PlanarMeasures:
    """Of the cycle that a contact has last solved; numbers in the units of its arguments.

    Attributes
    ----------
    greatest_load, greatest_friction
        Greatest normal force, and magnitude of the friction force [force].
    dissipation, slip_path
        Energy that friction takes in a cycle [force length], and the way of the slider [length].
    pieces, state (piece,)
        The states in their order, from the first stick if there is one: STICK, SLIP, SEPARATION.
    """

    def __init__(self, cycle: Cycle) -> None:
        given = cycle.motion.options
        self.invisible, self.steps = given.invisible, given.steps
        self.cycle, self.motion = cycle, cycle.motion
        self.crossings = Crossings(cycle.motion.normal)
        self.greatest_load = self.greatest_friction = self.dissipation = self.slip_path = 0.0
        self.pieces, self.state = 0, np.zeros(cycle.slider.capacity + 1, dtype=np.intc)

    def bear(self, mu: float, k_u: float) -> None:
        """All attributes, of the cycle as it is."""
        rubs: cython.bint = mu * k_u > 0.0
        length: float = self.motion.scale / k_u if k_u > 0.0 else 0.0
        self.greatest_friction = self.dissipation = self.slip_path = 0.0
        self.states(rubs)
        self.loads()
        if rubs and (self.cycle.kind == MIXED or self.cycle.kind == STUCK):
            self.friction()
        if rubs and self.cycle.kind == MIXED:
            self.dissipation = self.cycle.slider.sums.work * self.motion.scale * length
            self.slip_path = self.cycle.slider.sums.path * length

    def loads(self) -> None:
        """The greatest load, at one of its extremes."""
        i: cython.int
        value: float
        self.motion.normal.sample()
        high: float = self.motion.normal.at[LOAD, 0]
        self.crossings.begin()
        self.crossings.search(LOAD_RATE, 0, 1)
        for i in range(self.crossings.count):
            value, _ = self.motion.normal.evaluate(LOAD, self.crossings.angle[i])
            high = max(high, value)
        self.greatest_load = max(high, 0.0) * self.motion.load_scale

    def friction(self) -> None:
        """The greatest magnitude in each piece: at its ends, or at the top of a parabola."""
        p: cython.int
        i: cython.int
        n: cython.int = self.cycle.slider.pieces
        most: float = 0.0
        for p in range(n):
            begin: float = self.cycle.slider.begin[p]
            end: float = self.cycle.slider.begin[0 if p + 1 == n else p + 1]
            while end <= begin:
                end += TWO_PI
            step: float = 1.0 / (self.steps * max(self.motion.highest, 1))
            steps: cython.int = cython.cast(cython.int, (end - begin) / step) + 2
            step = (end - begin) / steps
            older: float = self.force(p, begin)
            old: float = self.force(p, begin + step)
            most = max(most, older, old)
            for i in range(2, steps + 1):
                new: float = self.force(p, begin + i * step)
                most = max(most, new)
                bend: float = 2.0 * old - older - new
                if old >= older and old >= new and bend > 0.0:
                    most = max(most, old + 0.125 * (new - older) * (new - older) / bend)
                older, old = old, new
        self.greatest_friction = most * self.motion.scale

    def force(self, p: cython.int, theta: float) -> float:
        """Magnitude of the friction force in a piece."""
        self.motion.place(SCAN, theta)
        if self.cycle.slider.state[p] == STICK:
            stretched: float = hypot(
                self.motion.value[SCAN, 0] - self.cycle.slider.rest_x[p],
                self.motion.value[SCAN, 1] - self.cycle.slider.rest_y[p],
            )
            return stretched
        if self.cycle.slider.state[p] == SLIP:
            limit: float = max(self.motion.value[SCAN, 2], 0.0)
            return limit
        return 0.0

    def length(self, p: cython.int) -> float:
        """Of a piece of several [rad]."""
        last: cython.bint = p + 1 == self.cycle.slider.pieces
        length: float = self.cycle.slider.begin[0 if last else p + 1] - self.cycle.slider.begin[p]
        while length < 0.0 or (last and length <= 0.0):
            length += TWO_PI
        return length

    def states(self, rubs: cython.bint) -> None:
        """Without what is rounding, neighbours joined, and without friction closed instead of slipping."""
        p: cython.int
        i: cython.int
        state: cython.int
        first: cython.int = 0
        n: cython.int = self.cycle.slider.pieces
        for p in range(n):
            if self.cycle.slider.state[p] == STICK and (n == 1 or self.length(p) > self.invisible):
                first = p
                break
        self.pieces = 0
        for i in range(n):
            p = (first + i) % n
            if n > 1 and self.length(p) < self.invisible:
                continue
            state = self.cycle.slider.state[p]
            if state == SLIP and not rubs:
                state = STICK
            if self.pieces == 0 or self.state[self.pieces - 1] != state:
                self.state[self.pieces] = state
                self.pieces += 1
        if self.pieces > 1 and self.state[self.pieces - 1] == self.state[0]:
            self.pieces -= 1
        if self.cycle.kind == OPEN:
            self.pieces, self.state[0] = 1, SEPARATION
