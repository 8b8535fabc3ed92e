"""Kernel: integrals over the pieces of a steady cycle, of exp(-i m theta) and of the forces times that.

Over each piece the forces are trigonometric polynomials, so all that is needed are the integrals of
exp(-i m theta) over the pieces in which the contact sticks, slips (with the sign of the force) and is closed.
Short sticks are integrated by Gauss's rule instead, from differences since their start: the closed form
would be a difference of nearly equal numbers.
"""

from __future__ import annotations

import cython
import numpy as np
from cython.cimports.libc.math import sin

from fcm.contact.periodic.gauss import gauss

if cython.compiled:
    from cython.cimports.fcm.contact.periodic.cycle import TWO_PI, Cycle
    from cython.cimports.fcm.contact.periodic.motion import FORCE, REACH
    from cython.cimports.fcm.contact.periodic.slider import POSITIVE, SEPARATION, STICK
else:
    from fcm.contact.periodic.cycle import TWO_PI, Cycle
    from fcm.contact.periodic.motion import FORCE, REACH
    from fcm.contact.periodic.slider import POSITIVE, SEPARATION, STICK

# Sets of pieces over which exp(-i m theta) is integrated
STICKS = cython.declare(cython.int, 0)
SIGNED_SLIPS = cython.declare(cython.int, 1)  # positive less negative
CONTACT = cython.declare(cython.int, 2)
LONG = cython.declare(cython.int, 3)  # sticks that are integrated in closed form
# A stick is short up to two radians of the highest harmonic in it: eight points are then exact to rounding.
SHORT = cython.declare(cython.double, 2.0)
POINTS = cython.declare(cython.int, 8)
_GAUSS = gauss(8)  # POINTS of them, on 0 to 1


@cython.cclass
class Integrals:
    """Sums over the pieces of a cycle: cosine and sine of each set, and of the forces for each harmonic."""

    def __init__(self, cycle: Cycle, most: int) -> None:
        self.cycle = cycle
        self.motion = cycle.motion
        self.most = most
        self.highest = most + self.motion.highest
        self.cos_sum, self.sin_sum = np.zeros((2, 4, self.highest + 1))
        self.power_cos, self.power_sin = np.ones((3, self.highest + 1)), np.zeros((3, self.highest + 1))
        self.stick_re, self.stick_im = np.zeros((2, self.most + 1))
        self.grow_re, self.grow_im = np.zeros((2, self.highest + 1))
        self.total_re, self.total_im = np.zeros((2, self.most + 1))
        self.points, self.weights = _GAUSS
        self.reciprocal = 1.0 / np.maximum(np.arange(self.highest + 1), 1)

    def integrate(self) -> None:
        """Sum the integrals of exp(-i m theta) over the pieces, and the forces of short sticks."""
        m: cython.int
        p: cython.int
        last: cython.int = self.cycle.pieces - 1
        e: cython.int = self.cycle.event[0]
        for m in range(self.highest + 1):
            for p in range(4):
                self.cos_sum[p, m] = self.sin_sum[p, m] = 0.0
        for m in range(self.most + 1):
            self.total_re[m] = self.total_im[m] = 0.0
        self.powers(0, self.cycle.event_cos[e], self.cycle.event_sin[e])
        begin: cython.int = 0
        end: cython.int = 1
        length: float
        for p in range(last + 1):
            if p < last:
                e = self.cycle.event[p + 1]
                self.powers(end, self.cycle.event_cos[e], self.cycle.event_sin[e])
                length = self.cycle.begin[p + 1] - self.cycle.begin[p]
            else:
                end = 2
                e = self.cycle.event[0]
                self.powers(end, self.cycle.event_cos[e], self.cycle.event_sin[e])
                length = self.cycle.begin[0] + TWO_PI - self.cycle.begin[p]
            if self.cycle.state[p] != SEPARATION:
                self.piece(p, begin, end, max(length, 0.0))
            begin, end = end, begin

    def piece(self, p: cython.int, begin: cython.int, end: cython.int, length: float) -> None:
        """Add a piece in which the contact is closed to the sums of its sets."""
        m: cython.int
        state: cython.int = self.cycle.state[p]
        w: float = self.cycle.rest[p]
        sign: float = 0.0
        long: float = 0.0
        c: float = length
        s: float = 0.0
        if state == STICK:
            if length * self.highest > SHORT:
                long = 1.0
            else:
                self.short_stick(p, begin, length)
        else:
            sign = 1.0 if state == POSITIVE else -1.0
        for m in range(self.highest + 1):
            if m > 0:
                c = (self.power_sin[end, m] - self.power_sin[begin, m]) * self.reciprocal[m]
                s = (self.power_cos[begin, m] - self.power_cos[end, m]) * self.reciprocal[m]
            self.cos_sum[CONTACT, m] += c
            self.sin_sum[CONTACT, m] += s
            if state != STICK:
                self.cos_sum[SIGNED_SLIPS, m] += sign * c
                self.sin_sum[SIGNED_SLIPS, m] += sign * s
                continue
            self.cos_sum[STICKS, m] += c
            self.sin_sum[STICKS, m] += s
            self.cos_sum[LONG, m] += long * c
            self.sin_sum[LONG, m] += long * s
            if m <= self.most:
                self.total_re[m] -= long * w * c
                self.total_im[m] += long * w * s

    def powers(self, into: cython.int, c_1: float, s_1: float) -> None:
        """cos(m theta) and sin(m theta) of all m."""
        m: cython.int
        c: float = 1.0
        s: float = 0.0
        turned: float
        for m in range(1, self.highest + 1):
            turned = c * c_1 - s * s_1
            s = s * c_1 + c * s_1
            c = turned
            self.power_cos[into, m], self.power_sin[into, m] = c, s

    def short_stick(self, p: cython.int, begin: cython.int, length: float) -> None:
        """Add the integrals of f exp(-i h theta), f from what it was when the stick began."""
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
            # of a load that is tiny beside the motion, a rounding error may put it past the limit
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
        """exp(i m y) - 1 of all m from that of 1, each to full relative accuracy."""
        m: cython.int
        a: float = 0.0
        b: float = 0.0
        next_a: float
        for m in range(1, self.highest + 1):
            next_a = a + re + (a * re - b * im)
            b = b + im + (a * im + b * re)
            a = next_a
            self.grow_re[m], self.grow_im[m] = a, b

    def product(self, h: cython.int, which: cython.int, row: cython.int) -> None:
        """Add to the totals of h the integral of a row times exp(-i h theta) over a set of pieces."""
        k: cython.int
        d: cython.int
        p: cython.int
        a: float
        b: float
        c: float
        s: float
        re: float = self.motion.mean[row] * self.cos_sum[which, h]
        im: float = -self.motion.mean[row] * self.sin_sum[which, h]
        for k in range(self.motion.moving):
            d, p = h - self.motion.number[k], h + self.motion.number[k]
            a, b = 0.5 * self.motion.re[row, k], 0.5 * self.motion.im[row, k]
            if d >= 0:
                c, s = self.cos_sum[which, d], self.sin_sum[which, d]
            else:
                c, s = self.cos_sum[which, -d], -self.sin_sum[which, -d]
            re += a * (c + self.cos_sum[which, p]) + b * (s - self.sin_sum[which, p])
            im += b * (c - self.cos_sum[which, p]) - a * (s + self.sin_sum[which, p])
        self.total_re[h] += re
        self.total_im[h] += im
