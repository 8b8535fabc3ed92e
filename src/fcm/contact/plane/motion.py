"""Kernel: a contact's periodic motion in its plane as trigonometric polynomials: u_x, u_y and the radius.

Everything is divided by the greatest amplitude of a force, so that the slider k_u w is held within the disc

    |U - W| <= R,   U = k_u u,   R = mu n,   n = n_0 + k_v v where that is positive.

The means of u are left out: they matter only to a slider that never moves.
"""

from __future__ import annotations

import cython
import numpy as np
from cython.cimports.libc.math import cos, fabs, isfinite, sin

if cython.compiled:
    from cython.cimports.fcm.contact.periodic.motion import UNKNOWN, Motion
    from cython.cimports.fcm.contact.plane.motion import place_eight
else:
    from fcm.contact.periodic.motion import UNKNOWN, Motion

from fcm.contact.plane.options import PlanarOptions

# Rows of coefficients; `value` has those of X, Y and REACH, then their first and their second derivatives.
X = cython.declare(cython.int, 0)
Y = cython.declare(cython.int, 1)
REACH = cython.declare(cython.int, 2)
LOAD = cython.declare(cython.int, 3)  # the normal force, divided by its own scale
ROWS = cython.declare(cython.int, 4)
SCAN = cython.declare(cython.int, 0)  # the slot of single angles; those of a panel follow

BOUNDS = cython.declare(cython.int, 5)  # orders of derivatives that are bounded
LEAST = cython.declare(cython.double, 1e-290)  # what is smaller counts as nothing


@cython.cclass
class PlaneMotion:
    """u_x, u_y and n_0 + k_v v with given harmonics; `load` takes one contact, `place` an angle.

    Attributes
    ----------
    normal
        The same load as the motion of a contact on a line, which finds where the contact closes and opens.
    moving
        The harmonics after so many are nothing.
    scale, load_scale, ratio
        What forces on u and on v are divided by; mu load_scale / scale.
    size, reach
        Bounds of |U| and of R.
    motion_bound, reach_bound
        By the order of a derivative: no value of that of U, of R, is greater.
    cos, sin (slot, harmonic), value (slot, 11)
        Of the angles taken by `place`: the harmonics; U_x, U_y, R, their first derivatives, their second,
        which `bend` adds; cosine and sine of the angle.
    """

    def __init__(self, harmonics: list[int], stages: int, options: PlanarOptions) -> None:
        self.options = given = options
        self.smooth, self.faint = given.smooth, given.faint
        numbers, self.count = np.array(harmonics, dtype=np.intc), len(harmonics)
        self.normal = Motion(harmonics)
        self.highest, self.stages = max(harmonics, default=0), stages
        self.number, self.order = numbers, numbers.astype(np.float64)
        self.re = np.zeros((ROWS, max(self.count, 1)))
        self.im = np.zeros((ROWS, max(self.count, 1)))
        self.mean = np.zeros(ROWS)
        self.scale = self.load_scale = self.ratio = self.preload = self.mean_x = self.mean_y = 0.0
        self.size = self.reach = 0.0
        self.motion_bound, self.reach_bound = np.zeros(BOUNDS), np.zeros(BOUNDS)
        self.cos = np.zeros((stages + 1, max(self.count, 1)))
        self.sin = np.zeros((stages + 1, max(self.count, 1)))
        self.value = np.zeros((stages + 1, 11))
        self.line = np.zeros(2 + 4 * self.count)
        self.moving = 0

    def load(
        self,
        x: cython.double[::1],
        first: cython.Py_ssize_t,
        mu: float,
        k_u: float,
        k_v: float,
        n_0: float,
    ) -> cython.int:
        """Take a contact; OPEN, CLOSED or MIXED over the cycle, UNKNOWN where a number is not finite."""
        k: cython.int
        p: cython.int
        i: cython.Py_ssize_t = first + 3
        motion: float = 0.0
        variation: float = 0.0
        self.moving = 0
        self.line[0], self.line[1] = 0.0, x[first + 2]
        for k in range(self.count):
            for p in range(6):
                if not isfinite(x[i + p]):
                    return UNKNOWN
                if x[i + p] != 0.0:
                    self.moving = k + 1
            motion = max(motion, fabs(x[i]), fabs(x[i + 1]), fabs(x[i + 2]), fabs(x[i + 3]))
            variation = max(variation, fabs(x[i + 4]), fabs(x[i + 5]))
            self.line[2 + 4 * k] = self.line[3 + 4 * k] = 0.0
            self.line[4 + 4 * k], self.line[5 + 4 * k] = x[i + 4], x[i + 5]
            i += 6
        if not (isfinite(x[first]) and isfinite(x[first + 1]) and isfinite(x[first + 2])):
            return UNKNOWN
        if not (isfinite(n_0) and isfinite(mu)):
            return UNKNOWN
        self.preload = n_0 + k_v * float(x[first + 2])
        self.load_scale = max(k_v * variation, self.faint * fabs(self.preload), LEAST)
        away: float = self.faint * k_u * max(fabs(x[first]), fabs(x[first + 1]))
        self.scale = max(k_u * motion, mu * self.load_scale, away, LEAST)
        if not (isfinite(self.scale) and isfinite(self.preload) and isfinite(k_u) and isfinite(k_v)):
            return UNKNOWN
        self.ratio = mu * (self.load_scale / self.scale) if mu > 0.0 else 0.0
        self.mean_x, self.mean_y = k_u * x[first] / self.scale, k_u * x[first + 1] / self.scale
        self.mean[LOAD] = self.preload / self.load_scale
        self.mean[REACH] = self.ratio * self.mean[LOAD]
        self.fill(x, first + 3, k_u, k_v)
        self.bound()
        return self.normal.load(self.line, 0, 1.0, 0.0, k_v, n_0)

    def fill(self, x: cython.double[::1], first: cython.Py_ssize_t, k_u: float, k_v: float) -> None:
        """The coefficients of all rows."""
        k: cython.int
        i: cython.Py_ssize_t = first
        for k in range(self.count):
            self.re[X, k], self.im[X, k] = k_u * x[i] / self.scale, k_u * x[i + 1] / self.scale
            self.re[Y, k], self.im[Y, k] = k_u * x[i + 2] / self.scale, k_u * x[i + 3] / self.scale
            self.re[LOAD, k] = k_v * x[i + 4] / self.load_scale
            self.im[LOAD, k] = k_v * x[i + 5] / self.load_scale
            self.re[REACH, k] = self.ratio * self.re[LOAD, k]
            self.im[REACH, k] = self.ratio * self.im[LOAD, k]
            i += 6

    def bound(self) -> None:
        """Sums of order**power times the amplitude."""
        k: cython.int
        p: cython.int
        motion: float
        reach: float
        for p in range(BOUNDS):
            self.motion_bound[p] = self.reach_bound[p] = 0.0
        for k in range(self.count):
            motion = fabs(self.re[X, k]) + fabs(self.im[X, k]) + fabs(self.re[Y, k]) + fabs(self.im[Y, k])
            reach = fabs(self.re[REACH, k]) + fabs(self.im[REACH, k])
            for p in range(BOUNDS):
                self.motion_bound[p] += motion
                self.reach_bound[p] += reach
                motion *= self.order[k]
                reach *= self.order[k]
        self.reach_bound[0] += fabs(self.mean[REACH])
        self.size, self.reach = self.motion_bound[0], self.reach_bound[0]

    def rubs(self) -> bool:
        """Whether there is friction that is more than rounding beside the motion."""
        rubs: bool = self.reach > self.smooth * self.size
        return rubs

    def place(self, slot: cython.int, theta: float) -> None:
        """U, R and their derivatives at an angle, and the harmonics there."""
        c_1: float = cos(theta)
        s_1: float = sin(theta)
        c: float = c_1
        s: float = s_1
        turned: float
        order: float
        x: float = 0.0
        y: float = 0.0
        r: float = self.mean[REACH]
        x_1: float = 0.0
        y_1: float = 0.0
        r_1: float = 0.0
        h: cython.int = 1
        k: cython.int
        for k in range(self.moving):
            while h < self.number[k]:
                turned = c * c_1 - s * s_1
                s = s * c_1 + c * s_1
                c = turned
                h += 1
            order = self.order[k]
            self.cos[slot, k], self.sin[slot, k] = c, s
            x += self.re[X, k] * c - self.im[X, k] * s
            y += self.re[Y, k] * c - self.im[Y, k] * s
            r += self.re[REACH, k] * c - self.im[REACH, k] * s
            x_1 -= order * (self.re[X, k] * s + self.im[X, k] * c)
            y_1 -= order * (self.re[Y, k] * s + self.im[Y, k] * c)
            r_1 -= order * (self.re[REACH, k] * s + self.im[REACH, k] * c)
        self.value[slot, 0], self.value[slot, 1], self.value[slot, 2] = x, y, r
        self.value[slot, 3], self.value[slot, 4], self.value[slot, 5] = x_1, y_1, r_1
        self.value[slot, 9], self.value[slot, 10] = c_1, s_1

    def place_nodes(self, theta: cython.p_double) -> None:
        """Slots 1 to 8, at eight angles."""
        i: cython.int
        if cython.compiled and place_eight(
            theta, cython.address(self.re[0, 0]), cython.address(self.im[0, 0]),
            cython.address(self.number[0]), self.moving, self.re.shape[1], self.mean[REACH],
            cython.address(self.value[1, 0]), cython.address(self.cos[1, 0]), cython.address(self.sin[1, 0]),
        ):  # fmt: skip
            return
        for i in range(self.stages):
            self.place(i + 1, theta[i])

    def bend(self, slot: cython.int) -> None:
        """The second derivatives at an angle that has its place."""
        k: cython.int
        square: float
        x: float = 0.0
        y: float = 0.0
        r: float = 0.0
        for k in range(self.moving):
            square = self.order[k] * self.order[k]
            x -= square * (self.re[X, k] * self.cos[slot, k] - self.im[X, k] * self.sin[slot, k])
            y -= square * (self.re[Y, k] * self.cos[slot, k] - self.im[Y, k] * self.sin[slot, k])
            r -= square * (self.re[REACH, k] * self.cos[slot, k] - self.im[REACH, k] * self.sin[slot, k])
        self.value[slot, 6], self.value[slot, 7], self.value[slot, 8] = x, y, r
