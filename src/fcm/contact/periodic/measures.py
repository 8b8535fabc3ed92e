"""Kernel: what a cycle says besides its forces: extremes, energy, and how far it is from another regime.

A regime of a contact is the sequence of its events. It changes where the load comes to vanish for an instant
or no longer does (an extreme of the load passes zero), and where a limit comes to push the slider at one of
its extremes or no longer does (`margin` of its event). Each such number is signed, and smooth while the
events before it stay what they are.
"""

from __future__ import annotations

import cython
import numpy as np
from cython.cimports.libc.math import cos, fabs, sin

from fcm.contact.periodic.gauss import gauss

if cython.compiled:
    from cython.cimports.fcm.contact.periodic.crossings import Crossings
    from cython.cimports.fcm.contact.periodic.cycle import TWO_PI, Cycle
    from cython.cimports.fcm.contact.periodic.events import BOTTOM, TOP
    from cython.cimports.fcm.contact.periodic.motion import (
        FORCE,
        FORCE_RATE,
        LOAD,
        LOAD_RATE,
        LOWER,
        LOWER_RATE,
        REACH,
        UPPER,
        UPPER_RATE,
    )
    from cython.cimports.fcm.contact.periodic.slider import NEGATIVE, POSITIVE, SEPARATION, STICK
else:
    from fcm.contact.periodic.crossings import Crossings
    from fcm.contact.periodic.cycle import TWO_PI, Cycle
    from fcm.contact.periodic.events import BOTTOM, TOP
    from fcm.contact.periodic.motion import (
        FORCE,
        FORCE_RATE,
        LOAD,
        LOAD_RATE,
        LOWER,
        LOWER_RATE,
        REACH,
        UPPER,
        UPPER_RATE,
    )
    from fcm.contact.periodic.slider import NEGATIVE, POSITIVE, SEPARATION, STICK

LEAST_LOAD = cython.declare(cython.int, 10)  # kinds of extremes, beside TOP and BOTTOM
GREATEST_LOAD = cython.declare(cython.int, 11)
TURN = cython.declare(cython.int, 12)  # of the motion
POINTS = cython.declare(cython.int, 8)
PART = cython.declare(cython.double, 3.0)  # [rad] in which as many points err by 2e-15
_GAUSS = gauss(8)  # POINTS of them, on 0 to 1
PRIME = cython.declare(cython.int, 100000007)  # seven times that is an int still


@cython.cclass
class Measures:
    """Of the cycle that a contact has last solved; numbers in the units of its arguments.

    Attributes
    ----------
    least_load, greatest_load
        Extremes of n_0 + k_v v [force]: the first is positive where the contact never opens, the second
        negative where it never closes.
    overlap
        Greatest lower limit less least upper limit of k_u w [force]: negative where the contact never slips,
        equation (25); of a contact that opens it is positive.
    greatest_friction
        Greatest magnitude of the friction force [force].
    dissipation
        Energy that friction takes in a cycle [force length], never negative.
    slip_path
        Way of the slider while it slips, in a cycle [length].
    signature
        A number for the sequence of states; equal for equal sequences.
    """

    def __init__(self, cycle: Cycle) -> None:
        self.cycle, self.motion = cycle, cycle.motion
        self.crossings = Crossings(cycle.motion)
        self.value = np.zeros(self.crossings.capacity)
        self.least_load = self.greatest_load = self.overlap = self.greatest_friction = 0.0
        self.dissipation = self.slip_path = self.piece_energy = self.piece_path = 0.0
        self.signature = 0
        self.points, self.weights = _GAUSS
        self.turn_cos, self.turn_sin = np.zeros((2, POINTS))

    def take(self, k_u: float) -> None:
        """`measure`, called from Python."""
        self.measure(k_u)

    def measure(self, k_u: float) -> None:
        """All attributes, of the cycle as it is."""
        self.motion.sample()
        self.friction()
        self.extremes()
        self.slips(k_u)
        self.sign()

    def bear(self, k_u: float) -> None:
        """Of these the greatest load and friction, the energy and the way of the slip, which cost less."""
        self.motion.sample()
        self.friction()
        self.greatest()
        self.slips(k_u)

    def greatest(self) -> None:
        """The greatest load, at one of the extremes that `friction` has found."""
        i: cython.int
        value: float
        high: float = self.motion.at[LOAD, 0]
        for i in range(self.crossings.count):
            if self.crossings.kind[i] == GREATEST_LOAD:
                value, _ = self.motion.evaluate(LOAD, self.crossings.angle[i])
                high = max(high, value)
        self.greatest_load = high * self.motion.load_scale

    def extremes(self) -> None:
        """Of the load and of both limits, as if the contact never opened."""
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
        """Greatest friction force: at an event, or where the load or the motion has an extreme."""
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
        """The piece that holds an angle."""
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
        """Friction force in a piece."""
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
        """Energy and path of all slips: sums of what cannot be negative."""
        p: cython.int
        last: cython.int = self.cycle.pieces - 1
        energy: float = 0.0
        path: float = 0.0
        end: float
        for p in range(last + 1):
            if self.cycle.state[p] == POSITIVE or self.cycle.state[p] == NEGATIVE:
                end = self.cycle.begin[p + 1] if p < last else self.cycle.begin[0] + TWO_PI
                self.slip(p, end - self.cycle.begin[p])
                energy += self.piece_energy
                path += self.piece_path
        # forces times ways of forces: the stiffness turns these into lengths; without it there is no friction
        length: float = self.motion.scale / k_u if k_u > 0.0 else 0.0
        self.dissipation, self.slip_path = energy * self.motion.scale * length, path * length

    def slip(self, p: cython.int, length: float) -> None:
        """Gauss's rule over one slip, in parts of PART of the highest product."""
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
                rate, load = self.motion.rate_and_value(
                    row,
                    REACH,
                    c * self.turn_cos[j] - s * self.turn_sin[j],
                    s * self.turn_cos[j] + c * self.turn_sin[j],
                )
                rate = max(rate * self.cycle.state[p], 0.0) * self.weights[j] * step
                self.piece_energy += rate * max(load, 0.0)
                self.piece_path += rate

    def sign(self) -> None:
        """The states, from the first of the least number that they make, as one number."""
        i: cython.int
        p: cython.int
        state: cython.int
        number: cython.longlong
        self.signature = PRIME
        for i in range(self.cycle.pieces):
            number = 0
            for p in range(self.cycle.pieces):
                state = self.cycle.state[(i + p) % self.cycle.pieces]
                number = (number * 7 + cython.cast(cython.longlong, state) + 2) % PRIME
            self.signature = min(self.signature, number)
