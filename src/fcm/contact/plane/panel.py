r"""Kernel: the direction of slip over a panel of angles, by collocation of its Riccati equation.

In slip U - W = R e, e = (cos alpha, sin alpha), and the slider W' = lambda e moves only as it is pushed, so

    lambda = e . U' - R' >= 0,    R alpha' = e_perp . U'

with e_perp = (-sin alpha, cos alpha). Seen from the direction e_0 at the start of the panel, with
t = tan((alpha - alpha_0) / 2), a = e_0 . U' and b = e_0_perp . U',

    2 R t' = b - 2 a t - b t^2

which is a Riccati equation: t = y_2 / y_1, where y' = [[a, b], [b, -a]] y / (2 R) is linear. So the end of a
panel is a Moebius map of its start. A polynomial t of degree s that obeys the equation at Radau's s points
errs at the end by the order 2 s - 1 of the length; multiplied by R, the equation has no singular point where
the load vanishes, and where R is small, its roots alpha = direction of U' are met without a small step
(Hairer and Wanner, Solving ordinary differential equations II, IV.5).

Of an error of the direction the force has no more than it began with, (|R d alpha|)' <= 0 while lambda >= 0.
"""

from __future__ import annotations

import cython
import numpy as np
from cython.cimports.libc.math import fabs

if cython.compiled:
    from cython.cimports.fcm.contact.plane.motion import SCAN, PlaneMotion
else:
    from fcm.contact.plane.motion import SCAN, PlaneMotion

from fcm.contact.plane.radau import radau

EPSILON = cython.declare(cython.double, 2.220446049250313e-16)
CONVERGED = cython.declare(cython.double, 1e-9)  # a change of t after which the next is rounding
STEPS = cython.declare(cython.int, 12)  # of Newton's method; where it takes more, the panel is too long
STEEPEST = cython.declare(cython.double, 0.6)  # t at the end, to begin with
WIDEST = cython.declare(cython.double, 1.2)  # of t: directions within 100 degrees of the start
GROWTH = cython.declare(cython.double, 2.0)  # exponent by which directions may part in a panel


@cython.cclass
class Panel:
    """A panel solved by `solve`, its nodes in the slots of the motion from 1 on.

    Attributes
    ----------
    theta, length, start_x, start_y
        The angle [rad] at which it begins, how long it is, and the direction there.
    tangent (s + 1,), change (s,), rate (s,)
        t at the start and at the nodes; its derivative by the angle, and that of alpha, at the nodes.
    e_x, e_y, along (s,), push (s + 1,)
        The direction and e . U' at the nodes; lambda at the start and at the nodes.
    noise
        The rounding of lambda.
    """

    def __init__(self, motion: PlaneMotion) -> None:
        rule = radau(motion.stages)
        s = motion.stages
        self.motion, self.stages = motion, s
        self.node, self.weight, self.slopes, self.tail, self.bary = (
            np.concatenate(([0.0], rule.nodes)), rule.weights, np.ascontiguousarray(rule.slopes), rule.tail,
            rule.bary,
        )  # fmt: skip
        self.tangent, self.push = np.zeros((2, s + 1))
        self.change, self.rate, self.e_x, self.e_y, self.along, self.right = np.zeros((6, s))
        self.matrix, self.pivot = np.zeros((s, s)), np.zeros(s, dtype=np.intc)
        self.theta = self.length = self.start_x = self.start_y = self.noise = 0.0

    def solve(self, theta: float, length: float, e_x: float, e_y: float, rate: float) -> bool:
        """Take a panel from a direction on, that turns at about a rate; False if it is too long for that."""
        j: cython.int
        self.theta, self.length, self.start_x, self.start_y = theta, length, e_x, e_y
        self.noise = 4.0 * EPSILON * (self.motion.motion_bound[1] + self.motion.reach_bound[1])
        for j in range(self.stages):
            self.motion.place(j + 1, theta + length * self.node[j + 1])
        slope: float = max(min(0.5 * rate * length, STEEPEST), -STEEPEST)
        return self.newton(slope) and self.finish()

    def newton(self, start: float) -> bool:
        """The collocated Riccati equation by Newton's method, from a straight line on."""
        i: cython.int
        j: cython.int
        step: cython.int
        s: cython.int = self.stages
        a: float
        b: float
        r: float
        t: float
        slope: float
        most: float
        for j in range(s + 1):
            self.tangent[j] = start * self.node[j]
        for step in range(STEPS):  # noqa: B007
            for i in range(s):
                x_1: float = self.motion.value[i + 1, 3]
                y_1: float = self.motion.value[i + 1, 4]
                a = self.start_x * x_1 + self.start_y * y_1
                b = self.start_x * y_1 - self.start_y * x_1
                r = 2.0 * max(self.motion.value[i + 1, 2], 0.0) / self.length
                t = self.tangent[i + 1]
                slope = 0.0
                for j in range(s):
                    slope += self.slopes[i + 1, j + 1] * self.tangent[j + 1]
                    self.matrix[i, j] = r * self.slopes[i + 1, j + 1]
                self.matrix[i, i] += 2.0 * (a + b * t)
                self.right[i] = b - t * (2.0 * a + b * t) - r * slope
            if not self.factor():
                return False
            self.back()
            most = 0.0
            for i in range(s):
                self.tangent[i + 1] += self.right[i]
                most = max(most, fabs(self.right[i]))
                if not fabs(self.tangent[i + 1]) < WIDEST:
                    return False
            if most < CONVERGED:
                return True
        return False

    def factor(self) -> bool:
        """`matrix` as L and U, rows exchanged; False if it is singular."""
        i: cython.int
        j: cython.int
        k: cython.int
        p: cython.int
        s: cython.int = self.stages
        part: float
        for k in range(s):
            p = k
            for i in range(k + 1, s):
                if fabs(self.matrix[i, k]) > fabs(self.matrix[p, k]):
                    p = i
            self.pivot[k] = p
            if not fabs(self.matrix[p, k]) > 0.0:
                return False
            if p != k:
                for j in range(s):
                    self.matrix[k, j], self.matrix[p, j] = self.matrix[p, j], self.matrix[k, j]
            part = 1.0 / self.matrix[k, k]
            for i in range(k + 1, s):
                self.matrix[i, k] *= part
                for j in range(k + 1, s):
                    self.matrix[i, j] -= self.matrix[i, k] * self.matrix[k, j]
        return True

    def back(self) -> None:
        """`right` becomes the solution."""
        i: cython.int
        j: cython.int
        s: cython.int = self.stages
        for i in range(s):
            j = self.pivot[i]
            if j != i:
                self.right[i], self.right[j] = self.right[j], self.right[i]
        for i in range(s):
            for j in range(i):
                self.right[i] -= self.matrix[i, j] * self.right[j]
        for i in range(s - 1, -1, -1):
            for j in range(i + 1, s):
                self.right[i] -= self.matrix[i, j] * self.right[j]
            self.right[i] /= self.matrix[i, i]

    def finish(self) -> bool:
        """Directions and lambda at the nodes; False where directions part more than the panel can follow."""
        i: cython.int
        j: cython.int
        s: cython.int = self.stages
        for i in range(s):
            t: float = self.tangent[i + 1]
            part: float = 1.0 / (1.0 + t * t)
            c: float = (1.0 - t * t) * part
            d: float = 2.0 * t * part
            slope: float = 0.0
            for j in range(s):
                slope += self.slopes[i + 1, j + 1] * self.tangent[j + 1]
            self.change[i] = slope / self.length
            self.rate[i] = 2.0 * self.change[i] * part
            self.e_x[i] = self.start_x * c - self.start_y * d
            self.e_y[i] = self.start_y * c + self.start_x * d
            self.along[i] = (
                self.e_x[i] * self.motion.value[i + 1, 3] + self.e_y[i] * self.motion.value[i + 1, 4]
            )
            self.push[i + 1] = self.along[i] - self.motion.value[i + 1, 5]
            if -self.along[i] * self.length > GROWTH * max(self.motion.value[i + 1, 2], 0.0):
                return False
        return True

    def rest(self) -> float:
        """The last coefficient of t in Legendre's polynomials: what the polynomial leaves out is like it."""
        j: cython.int
        total: float = 0.0
        for j in range(self.stages):
            total += self.tail[j + 1] * self.tangent[j + 1]
        rest: float = fabs(total)
        return rest

    def end_of_slip(self) -> float:
        """The part of the panel after which lambda is no more than rounding; 2 if it does not fall so far."""
        j: cython.int
        f_0: float = self.push[0] - self.noise
        if f_0 <= 0.0 and self.push[1] <= self.noise:
            return 0.0
        d_0: float = self.slope_at(0)
        for j in range(self.stages):
            h: float = self.node[j + 1] - self.node[j]
            f_1: float = self.push[j + 1] - self.noise
            d_1: float = self.slope_at(j + 1)
            if f_1 < 0.0:
                return self.root(self.node[j], self.node[j + 1])
            if d_0 < 0.0 < d_1:
                # where the tangents at both ends meet; lambda is hardly below that
                x: float = (f_0 - f_1 + d_1 * h) / (d_1 - d_0)
                if f_0 + d_0 * x < 0.0:
                    low: float = self.lowest(self.node[j], self.node[j + 1])
                    value, _ = self.pushed(low)
                    if value < 0.0:
                        return self.root(self.node[j], low)
            f_0, d_0 = f_1, d_1
        return 2.0

    def slope_at(self, j: cython.int) -> float:
        """The derivative of lambda by the part of the panel, at the start or at a node."""
        k: cython.int
        slope: float = 0.0
        for k in range(self.stages + 1):
            slope += self.slopes[j, k] * self.push[k]
        return slope

    def pushed(self, x: float) -> tuple[float, float]:
        """lambda beyond rounding, and its derivative by the part x of the panel."""
        k: cython.int
        total: float = 0.0
        t: float = 0.0
        for k in range(self.stages + 1):
            apart: float = x - self.node[k]
            if apart == 0.0:
                t, total = self.tangent[k], 1.0
                break
            total += self.bary[k] / apart
            t += self.bary[k] / apart * self.tangent[k]
        t /= total
        part: float = 1.0 / (1.0 + t * t)
        e_x: float = (self.start_x * (1.0 - t * t) - self.start_y * 2.0 * t) * part
        e_y: float = (self.start_y * (1.0 - t * t) + self.start_x * 2.0 * t) * part
        self.motion.place(SCAN, self.theta + x * self.length)
        self.motion.bend(SCAN)
        across: float = e_x * self.motion.value[SCAN, 4] - e_y * self.motion.value[SCAN, 3]
        value: float = e_x * self.motion.value[SCAN, 3] + e_y * self.motion.value[SCAN, 4]
        slope: float = e_x * self.motion.value[SCAN, 6] + e_y * self.motion.value[SCAN, 7]
        slope -= self.motion.value[SCAN, 8]
        if self.motion.value[SCAN, 2] > 0.0:
            slope += across * across / self.motion.value[SCAN, 2]
        return value - self.motion.value[SCAN, 5] - self.noise, slope * self.length

    def root(self, low: float, high: float) -> float:
        """Where lambda vanishes, between parts at which it is positive and negative: Newton, bracketed."""
        x: float = 0.5 * (low + high)
        step: float
        i: cython.int
        for i in range(60):  # noqa: B007
            value, slope = self.pushed(x)
            if value > 0.0:
                low = x
            else:
                high = x
            step = -value / slope if slope < 0.0 else high - low
            if not low < x + step < high:
                step = 0.5 * (low + high) - x
            x += step
            if fabs(step) < 1e-13 or high - low < 1e-13:
                break
        return x

    def lowest(self, low: float, high: float) -> float:
        """Where lambda is least between parts at which it falls and rises."""
        i: cython.int
        x: float = 0.5 * (low + high)
        for i in range(40):  # noqa: B007
            value, slope = self.pushed(x)
            if value < 0.0 or high - low < 1e-9:
                break
            if slope < 0.0:
                low = x
            else:
                high = x
            x = 0.5 * (low + high)
        return x
