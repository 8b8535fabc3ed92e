"""Kernel: the events of a cycle, each with its limits and their rates."""

from __future__ import annotations

import cython
import numpy as np
from cython.cimports.libc.math import cos, sin

if cython.compiled:
    from cython.cimports.fcm.contact.periodic.motion import FORCE, LOAD, REACH, Motion
else:
    from fcm.contact.periodic.motion import FORCE, LOAD, REACH, Motion

CLOSES = cython.declare(cython.int, 0)  # kinds of cuts
OPENS = cython.declare(cython.int, 1)
TOP = cython.declare(cython.int, 2)
BOTTOM = cython.declare(cython.int, 3)
MEETS = cython.declare(cython.int, 4)  # where a limit meets the slider: an event that is no cut


@cython.cclass
class Events:
    """Angles of a cycle in no order, up to `events`, with what a motion's limits are there.

    Attributes
    ----------
    event_kind, event_angle, event_cos, event_sin
        The kind, the angle [rad], its cosine and sine.
    lower, upper, moved
        Both limits and k_u u, divided by the scale of the motion.
    lower_rate, upper_rate, load_rate, motion_rate
        Their derivatives by the angle; that of the load is divided by its own scale.
    margin
        Of a TOP or BOTTOM, how far the limit is beyond the slider there: it slips if that is positive.
        Of an instant that OPENS, which way the slider has to go to be there. Divided by the scale.
    """

    def __init__(self, motion: Motion, size: int) -> None:
        self.motion = motion
        self.events = 0
        self.event_kind, self.event_angle = np.zeros(size, dtype=np.intc), np.zeros(size)
        self.event_cos, self.event_sin, self.margin = np.zeros((3, size))
        self.lower, self.upper, self.moved = np.zeros((3, size))
        self.lower_rate, self.upper_rate, self.load_rate, self.motion_rate = np.zeros((4, size))

    def place(self, theta: float, kind: cython.int) -> cython.int:
        """A new event at an angle: its limits and their rates."""
        c_1: float = cos(theta)
        s_1: float = sin(theta)
        c: float = c_1
        s: float = s_1
        turned: float
        u: float = 0.0
        u_1: float = 0.0
        y: float = 0.0
        y_1: float = 0.0
        h: cython.int = 1
        k: cython.int
        e: cython.int = self.events
        for k in range(self.motion.moving):
            while h < self.motion.number[k]:
                turned = c * c_1 - s * s_1
                s = s * c_1 + c * s_1
                c = turned
                h += 1
            u += self.motion.re[FORCE, k] * c - self.motion.im[FORCE, k] * s
            y += self.motion.re[REACH, k] * c - self.motion.im[REACH, k] * s
            u_1 -= self.motion.order[k] * (self.motion.re[FORCE, k] * s + self.motion.im[FORCE, k] * c)
            y_1 -= self.motion.order[k] * (self.motion.re[LOAD, k] * s + self.motion.im[LOAD, k] * c)
        y = max(y + self.motion.mean[REACH], 0.0)
        self.event_kind[e], self.margin[e] = kind, 0.0
        self.event_angle[e], self.event_cos[e], self.event_sin[e] = theta, c_1, s_1
        self.moved[e], self.lower[e], self.upper[e] = u, u - y, u + y
        self.motion_rate[e], self.load_rate[e] = u_1, y_1
        self.lower_rate[e] = u_1 - self.motion.ratio * y_1
        self.upper_rate[e] = u_1 + self.motion.ratio * y_1
        self.events += 1
        return e
