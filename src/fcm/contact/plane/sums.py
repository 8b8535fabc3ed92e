"""Kernel: integrals over a cycle, of exp(-i m theta) times what the forces are multiplied by.

A friction force is U less the place of the slider while the contact sticks, and R times the direction while
it slips. U and R are trigonometric polynomials, so what is needed are the integrals of exp(-i m theta) over
all sticks, in closed form, and of both parts of the direction times that over all slips, by Radau's rule on
the panels by which the direction was found.
"""

from __future__ import annotations

import cython
import numpy as np
from cython.cimports.libc.math import cos, sin

if cython.compiled:
    from cython.cimports.fcm.contact.plane.motion import PlaneMotion
    from cython.cimports.fcm.contact.plane.panel import STAGES, Panel
    from cython.cimports.fcm.contact.plane.sums import turn_eight
else:
    from fcm.contact.plane.motion import PlaneMotion
    from fcm.contact.plane.panel import Panel
    from fcm.contact.plane.radau import STAGES

# Functions of the angle by which exp(-i m theta) is multiplied
STICKS = cython.declare(cython.int, 0)  # 1 while it sticks
CONTACT = cython.declare(cython.int, 1)  # 1 while it is closed
SLIPS_X = cython.declare(cython.int, 2)  # the direction while it slips
SLIPS_Y = cython.declare(cython.int, 3)


@cython.cclass
class Sums:
    """Sums over the pieces of a cycle, cosine and sine (function, m).

    Attributes
    ----------
    held_x_re, held_x_im, held_y_re, held_y_im (h,)
        Of the place of the slider while the contact sticks.
    work, path
        Of the friction force on the slider, and the way of the slider, divided by the scale.
    power_cos, power_sin (slot, m)
        The harmonics at two angles, or at an angle in slot 0.
    """

    def __init__(self, motion: PlaneMotion, most: int) -> None:
        self.motion, self.most = motion, most
        self.highest = most + motion.highest
        self.cos_sum, self.sin_sum = np.zeros((2, 4, self.highest + 1))
        self.power_cos, self.power_sin = np.ones((2, self.highest + 1)), np.zeros((2, self.highest + 1))
        self.held_x_re, self.held_x_im, self.held_y_re, self.held_y_im = np.zeros((4, most + 1))
        self.reciprocal = 1.0 / np.maximum(np.arange(self.highest + 1), 1)
        self.work = self.path = self.re = self.im = 0.0
        # of the slips, each node of a panel by itself: direction x and y times cosine and sine
        self.lanes = np.zeros((4 * (self.highest + 1), STAGES))
        if not cython.compiled:
            self.x, self.y, self.c, self.s = np.zeros((4, STAGES))

    def begin(self) -> None:
        """Nothing yet."""
        m: cython.int
        p: cython.int
        for p in range(4):
            for m in range(self.highest + 1):
                self.cos_sum[p, m] = self.sin_sum[p, m] = 0.0
        for m in range(4 * (self.highest + 1)):
            for p in range(STAGES):
                self.lanes[m, p] = 0.0
        for m in range(self.most + 1):
            self.held_x_re[m] = self.held_x_im[m] = self.held_y_re[m] = self.held_y_im[m] = 0.0
        self.work = self.path = 0.0

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

    def contact(self, begin: float, end: float) -> None:
        """Add angles at which the contact is closed."""
        m: cython.int
        self.powers(0, cos(begin), sin(begin))
        self.powers(1, cos(end), sin(end))
        self.cos_sum[CONTACT, 0] += end - begin
        for m in range(1, self.highest + 1):
            self.cos_sum[CONTACT, m] += (self.power_sin[1, m] - self.power_sin[0, m]) * self.reciprocal[m]
            self.sin_sum[CONTACT, m] += (self.power_cos[0, m] - self.power_cos[1, m]) * self.reciprocal[m]

    def stick(self, begin: float, end: float, w_x: float, w_y: float) -> None:
        """Add a stick at a place of the slider."""
        m: cython.int
        c: float = end - begin
        s: float = 0.0
        self.powers(0, cos(begin), sin(begin))
        self.powers(1, cos(end), sin(end))
        for m in range(self.highest + 1):
            if m > 0:
                c = (self.power_sin[1, m] - self.power_sin[0, m]) * self.reciprocal[m]
                s = (self.power_cos[0, m] - self.power_cos[1, m]) * self.reciprocal[m]
            self.cos_sum[STICKS, m] += c
            self.sin_sum[STICKS, m] += s
            if m <= self.most:
                self.held_x_re[m] += w_x * c
                self.held_x_im[m] -= w_x * s
                self.held_y_re[m] += w_y * c
                self.held_y_im[m] -= w_y * s

    def slip(self, panel: Panel) -> None:
        """Add a panel of slip, to `lanes`."""
        i: cython.int
        m: cython.int
        w: float
        c: float
        d: float
        for i in range(STAGES):
            w = panel.weight[i] * panel.speed[i]
            self.x[i], self.y[i] = w * panel.e_x[i], w * panel.e_y[i]
            self.c[i], self.s[i] = self.motion.value[i + 1, 9], self.motion.value[i + 1, 10]
            w *= panel.push[i + 1]
            self.path += w
            self.work += w * max(self.motion.value[i + 1, 2], 0.0)
        if cython.compiled and turn_eight(
            cython.address(self.x[0]), cython.address(self.y[0]), cython.address(self.c[0]),
            cython.address(self.s[0]), cython.address(self.lanes[0, 0]), self.highest,
        ):  # fmt: skip
            return
        for i in range(STAGES):
            c = 1.0
            d = 0.0
            for m in range(self.highest + 1):
                self.lanes[4 * m, i] += self.x[i] * c
                self.lanes[4 * m + 1, i] += self.x[i] * d
                self.lanes[4 * m + 2, i] += self.y[i] * c
                self.lanes[4 * m + 3, i] += self.y[i] * d
                w = c * self.c[i] - d * self.s[i]
                d = d * self.c[i] + c * self.s[i]
                c = w

    def total(self) -> None:
        """The sums over slips from those of each node."""
        m: cython.int
        i: cython.int
        for m in range(self.highest + 1):
            for i in range(STAGES):
                self.cos_sum[SLIPS_X, m] += self.lanes[4 * m, i]
                self.sin_sum[SLIPS_X, m] += self.lanes[4 * m + 1, i]
                self.cos_sum[SLIPS_Y, m] += self.lanes[4 * m + 2, i]
                self.sin_sum[SLIPS_Y, m] += self.lanes[4 * m + 3, i]

    def product(self, h: cython.int, which: cython.int, row: cython.int) -> None:
        """`re`, `im`: the integral of a row of the motion times a function times exp(-i h theta)."""
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
        self.re, self.im = re, im
