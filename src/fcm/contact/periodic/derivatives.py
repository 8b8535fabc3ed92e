"""Kernel: derivatives of a contact's Fourier coefficients by those of its motion.

The forces are continuous, so the instants of the events do not enter; the place where the slider came to rest
does. Where an event grazes, a derivative is that of the side on which it does not occur.
"""

from __future__ import annotations

import cython
import numpy as np
from cython.cimports.libc.math import fabs

if cython.compiled:
    from cython.cimports.fcm.contact.periodic.cycle import TWO_PI
    from cython.cimports.fcm.contact.periodic.integrals import CONTACT, SIGNED_SLIPS, STICKS, Integrals
    from cython.cimports.fcm.contact.periodic.slider import POSITIVE, SEPARATION, STICK
else:
    from fcm.contact.periodic.cycle import TWO_PI
    from fcm.contact.periodic.integrals import CONTACT, SIGNED_SLIPS, STICKS, Integrals
    from fcm.contact.periodic.slider import POSITIVE, SEPARATION, STICK

PI = cython.declare(cython.double, 3.141592653589793)


@cython.cclass
class Derivatives:
    """`jacobian` (force, unknown), in the order of `PeriodicContact`, while its rows are made.

    `memory` is the derivatives of one place of rest.
    """

    def __init__(self, integrals: Integrals, outputs: list[int]) -> None:
        self.integrals, self.cycle, self.motion = integrals, integrals.cycle, integrals.motion
        self.output = np.array(outputs, dtype=np.intc)
        self.outputs = len(outputs)
        self.unknowns = 2 + 4 * self.motion.count
        self.jacobian = np.zeros((2 + 4 * self.outputs, self.unknowns))
        self.memory = np.zeros(self.unknowns)

    def fill(self, value: float) -> None:
        """All of them the same."""
        i: cython.Py_ssize_t
        j: cython.int
        for i in range(2 + 4 * self.outputs):
            for j in range(self.unknowns):
                self.jacobian[i, j] = value

    def stick(self) -> None:
        """Of a contact that never slips."""
        i: cython.int
        k: cython.int
        part: cython.int
        self.jacobian[1, 1] = 1.0
        if self.cycle.cause[0] == 0:
            self.jacobian[0, 0] = 1.0
        else:
            self.gradient(0)
            for i in range(self.unknowns):
                self.jacobian[0, i] = -self.memory[i]
        for k in range(self.motion.count):
            for i in range(self.outputs):
                if self.output[i] == self.motion.number[k]:
                    for part in range(4):
                        self.jacobian[2 + 4 * i + part, 2 + 4 * k + part] = 1.0

    def slip(self) -> None:
        """Of any other."""
        i: cython.int
        h: cython.int
        step: cython.int
        row: cython.Py_ssize_t
        factor: float
        for i in range(-1, self.outputs):
            h = self.output[i] if i >= 0 else 0
            row = 2 + 4 * i if i >= 0 else 0
            step = 2 if i >= 0 else 1
            factor = 1.0 / PI if i >= 0 else 0.5 / PI
            self.block(row, 0, step, h, STICKS, factor)
            self.block(row, 1, step, h, SIGNED_SLIPS, factor)
            self.block(row + step, 1, step, h, CONTACT, factor)
        self.remember_all()

    def block(
        self,
        row: cython.Py_ssize_t,
        of_load: cython.int,
        rows: cython.int,
        h: cython.int,
        which: cython.int,
        factor: float,
    ) -> None:
        """Derivatives of one harmonic of a force, in `rows` rows, by all of u or of v."""
        k: cython.int
        d: cython.int
        p: cython.int
        c: float
        s: float
        cos_p: float
        sin_p: float
        column: cython.Py_ssize_t
        if of_load:
            self.jacobian[row, 1] = factor * self.integrals.cos_sum[which, h]
            if rows > 1:
                self.jacobian[row + 1, 1] = -factor * self.integrals.sin_sum[which, h]
        factor *= 0.5
        for k in range(self.motion.count):
            d, p = h - self.motion.number[k], h + self.motion.number[k]
            column = 2 + 4 * k + 2 * of_load
            if d >= 0:
                c, s = factor * self.integrals.cos_sum[which, d], factor * self.integrals.sin_sum[which, d]
            else:
                c, s = factor * self.integrals.cos_sum[which, -d], -factor * self.integrals.sin_sum[which, -d]
            cos_p = factor * self.integrals.cos_sum[which, p]
            sin_p = factor * self.integrals.sin_sum[which, p]
            self.jacobian[row, column] = c + cos_p
            self.jacobian[row, column + 1] = s - sin_p
            if rows > 1:
                self.jacobian[row + 1, column] = -s - sin_p
                self.jacobian[row + 1, column + 1] = c - cos_p

    def gradient(self, p: cython.int) -> None:
        """`memory`: the derivatives of where the slider rests in piece p, without the mean of u.

        After a slip it is that of the limit, where the limit turns. After a separation w = u where the load
        vanishes, and that instant moves by -n_q / n_t.
        """
        e: cython.int = self.cycle.event[p]
        cause: cython.int = self.cycle.cause[p]
        along: float = -1.0 if cause == POSITIVE else 1.0
        k: cython.int
        if cause == SEPARATION:
            # its limits are never steeper than the motion here, or it would not stick
            along = self.motion.ratio * self.cycle.load_rate[e]
            if fabs(self.cycle.motion_rate[e]) < along:
                along = -self.cycle.motion_rate[e] / along
            else:
                along = -1.0 if self.cycle.motion_rate[e] > 0.0 else 1.0
        self.integrals.powers(0, self.cycle.event_cos[e], self.cycle.event_sin[e])
        self.memory[0], self.memory[1] = 0.0, along
        for k in range(self.motion.count):
            c: float = self.integrals.power_cos[0, self.motion.number[k]]
            s: float = self.integrals.power_sin[0, self.motion.number[k]]
            self.memory[2 + 4 * k], self.memory[3 + 4 * k] = c, -s
            self.memory[4 + 4 * k], self.memory[5 + 4 * k] = along * c, -along * s

    def remember_all(self) -> None:
        """Take from the derivatives of the forces what the resting places of the slider add to them."""
        p: cython.int
        for p in range(self.cycle.pieces):
            if self.cycle.state[p] == STICK:
                self.gradient(p)
                self.remember(p)

    def remember(self, p: cython.int) -> None:
        """The part of one stick; `gradient` has left the powers of its start."""
        i: cython.int
        j: cython.int
        h: cython.int
        row: cython.Py_ssize_t
        next_p: cython.int = p + 1 if p + 1 < self.cycle.pieces else 0
        e: cython.int = self.cycle.event[next_p]
        length: float = self.cycle.begin[next_p] - self.cycle.begin[p]
        re: float
        im: float
        if next_p == 0:
            length += TWO_PI
        self.integrals.powers(1, self.cycle.event_cos[e], self.cycle.event_sin[e])
        for j in range(1, self.unknowns):
            self.jacobian[0, j] -= 0.5 / PI * length * self.memory[j]
        for i in range(self.outputs):
            h = self.output[i]
            row = 2 + 4 * i
            re = self.integrals.power_sin[1, h] - self.integrals.power_sin[0, h]
            im = self.integrals.power_cos[1, h] - self.integrals.power_cos[0, h]
            re, im = re * self.integrals.reciprocal[h] / PI, im * self.integrals.reciprocal[h] / PI
            for j in range(1, self.unknowns):
                self.jacobian[row, j] -= re * self.memory[j]
                self.jacobian[row + 1, j] -= im * self.memory[j]

    def rescale(self, row: cython.int, by_motion: float, by_load: float) -> None:
        """Derivatives of one number by u and by v."""
        k: cython.int
        self.jacobian[row, 0] *= by_motion
        self.jacobian[row, 1] *= by_load
        for k in range(2, self.unknowns, 4):
            self.jacobian[row, k] *= by_motion
            self.jacobian[row, k + 1] *= by_motion
            self.jacobian[row, k + 2] *= by_load
            self.jacobian[row, k + 3] *= by_load
