"""Kernel: where the slider of a contact that never slips rests, and whether there is such a place.

The slider rests at any W with |U - W| <= R at every angle: a place common to all discs. It began unstressed;
it is taken to rest there if the discs allow that, else at the nearest place that is common to them all.

Two small convex problems, each with a disc for every angle: the least t by which all discs have to grow until
they have a place in common (that of the smallest enclosing circle, with weights), and that nearest place. A
solution is held by three discs, or two, at most. Both are solved by exchange: the disc that is missed most
joins those that hold it, and the best that these allow takes its place, until none is missed.
"""

from __future__ import annotations

import cython
import numpy as np
from cython.cimports.libc.math import fabs, hypot, sin, sqrt

if cython.compiled:
    from cython.cimports.fcm.contact.plane.panel import REACH, SCAN, PlaneMotion, X, Y
else:
    from fcm.contact.plane.panel import REACH, SCAN, PlaneMotion, X, Y

TWO_PI = cython.declare(cython.double, 6.283185307179586)
FIRST = cython.declare(cython.double, 0.1171)  # of a step: nodes lie beside the multiples of pi / 2
EPSILON = cython.declare(cython.double, 2.220446049250313e-16)
FAR = cython.declare(cython.double, 1e300)


@cython.cclass
class Resting:
    """The place of rest of a motion that never opens.

    Attributes
    ----------
    w_x, w_y
        The place, from the means of u.
    overlap
        How far all discs have to grow to have a place in common; below 0 they have, above 0 it slips. A lower
        bound, unless it is asked for exactly.
    held, basis (3, 4)
        The number of discs that hold the place, and of each its centre, radius and angle.
    beyond, angle
        Of the place asked for last by `farthest`: how far outside the disc it is that it misses most.
    """

    def __init__(self, motion: PlaneMotion) -> None:
        given = motion.options
        self.exchanges, self.same = given.exchanges, given.same
        self.motion = motion
        self.nodes = 12 * max(motion.highest, 1) + 3
        self.step = TWO_PI / self.nodes
        angle = np.outer(self.step * (FIRST + np.arange(self.nodes)), np.asarray(motion.order))
        self.node_cos, self.node_sin = np.cos(angle), np.sin(angle)
        self.at, self.gap = np.zeros((3, self.nodes)), np.zeros(self.nodes)
        self.basis = np.zeros((4, 4))
        self.held = self.best_i = self.best_j = 0
        self.w_x = self.w_y = self.overlap = self.beyond = self.angle = 0.0
        self.x = self.y = self.t = self.best = 0.0
        self.found = self.sampled = False

    def stays(self, s_x: float, s_y: float) -> bool:
        """Whether the slider need never slip; then where it rests, if it began at a place."""
        self.held, self.sampled = 0, False
        self.overlap = -FAR
        self.w_x, self.w_y = s_x, s_y
        if hypot(s_x, s_y) + self.motion.size <= 2.0 * self.motion.mean[REACH] - self.motion.reach:
            return True
        self.sample()
        self.farthest(s_x, s_y)
        if self.beyond <= 0.0:
            return True
        if not self.encloses(False):
            return False
        self.nearest(s_x, s_y)
        return True

    def encloses(self, exact: bool) -> bool:
        """Whether all discs have a place in common; `overlap` only as far as that takes, unless exactly."""
        i: cython.int
        rounding: float = 4.0 * EPSILON * (self.motion.size + self.motion.reach)
        self.sample()
        self.held, self.overlap = 0, -FAR
        self.w_x = self.w_y = 0.0
        for i in range(self.exchanges):  # noqa: B007
            self.farthest(self.w_x, self.w_y)
            if self.beyond <= (self.overlap if exact else max(0.0, self.overlap)) + rounding:
                break
            self.exchange(False, 0.0, 0.0)
            if not self.found or (self.overlap > rounding and not exact):
                break
        return self.overlap <= rounding

    def nearest(self, s_x: float, s_y: float) -> None:
        """The place of rest nearest to one that is not."""
        i: cython.int
        w_x: float = self.w_x
        w_y: float = self.w_y
        rounding: float = 4.0 * EPSILON * (self.motion.size + self.motion.reach)
        self.held = 0
        self.w_x, self.w_y = s_x, s_y
        for i in range(self.exchanges):  # noqa: B007
            self.farthest(self.w_x, self.w_y)
            if self.beyond <= rounding:
                break
            self.exchange(True, s_x, s_y)
            if not self.found:  # the only place that is common, within rounding
                self.w_x, self.w_y, self.held = w_x, w_y, 0
                return
        self.sharpen(s_x, s_y)

    def sharpen(self, s_x: float, s_y: float) -> None:
        """The angles of the discs that hold the place, which it misses by the square of their errors.

        Along the edge of one disc alone it moves by the error itself.
        """
        i: cython.int
        for i in range(self.held):
            self.sharpen_one(i, self.w_x, self.w_y)
        if self.held == 2 and fabs(sin(0.5 * (self.basis[1, 3] - self.basis[0, 3]))) < self.same:
            self.held = 1  # one disc, from two sides
        if self.held == 1:
            self.sharpen_one(0, s_x, s_y)
            self.held = 0
            self.exchange(True, s_x, s_y)

    def sharpen_one(self, i: cython.int, w_x: float, w_y: float) -> None:
        """The angle near that of a disc at which a place misses its disc most."""
        self.x, self.y, self.beyond = w_x, w_y, -FAR
        self.refine(self.basis[i, 3])
        self.basis[i, 3] = self.angle

    def sample(self) -> None:
        """U and R at all nodes."""
        j: cython.int
        k: cython.int
        if self.sampled:
            return
        self.sampled = True
        for j in range(self.nodes):
            x: float = 0.0
            y: float = 0.0
            r: float = self.motion.mean[REACH]
            for k in range(self.motion.moving):
                c: float = self.node_cos[j, k]
                s: float = self.node_sin[j, k]
                x += self.motion.re[X, k] * c - self.motion.im[X, k] * s
                y += self.motion.re[Y, k] * c - self.motion.im[Y, k] * s
                r += self.motion.re[REACH, k] * c - self.motion.im[REACH, k] * s
            self.at[0, j], self.at[1, j], self.at[2, j] = x, y, r

    def farthest(self, w_x: float, w_y: float) -> None:
        """`beyond` and `angle`: the disc that a place misses most."""
        j: cython.int
        before: float
        after: float
        most: float = -FAR
        self.x, self.y = w_x, w_y
        for j in range(self.nodes):
            d_x: float = self.at[0, j] - w_x
            d_y: float = self.at[1, j] - w_y
            self.gap[j] = sqrt(d_x * d_x + d_y * d_y) - self.at[2, j]
            most = max(most, self.gap[j])
        # where the gap is greatest its second derivative is bounded by that of U and R
        rise: float = (
            0.125 * self.step * self.step * (self.motion.motion_bound[2] + self.motion.reach_bound[2])
        )
        self.beyond = -FAR
        for j in range(self.nodes):
            before = self.gap[j - 1 if j > 0 else self.nodes - 1]
            after = self.gap[j + 1 if j + 1 < self.nodes else 0]
            if self.gap[j] >= before and self.gap[j] >= after and self.gap[j] + rise >= most:
                self.refine(self.step * (FIRST + j))
        # two discs less than a step apart, between which no node tells: each goes on from where it was
        for j in range(self.held):
            self.refine(self.basis[j, 3])

    def outside(self, theta: float) -> float:
        """How far the place in `x`, `y` is outside the disc of an angle; see `refine` for the slope."""
        self.motion.place(SCAN, theta)
        gap: float = hypot(self.motion.value[SCAN, 0] - self.x, self.motion.value[SCAN, 1] - self.y)
        gap -= self.motion.value[SCAN, 2]
        return gap

    def refine(self, theta: float) -> None:
        """The greatest gap within a step of a node, if it is greater than any before."""
        i: cython.int
        low: float = theta - self.step
        high: float = theta + self.step
        gap: float = self.outside(theta)
        step: float
        slope: float
        bend: float
        for i in range(50):  # noqa: B007
            self.motion.bend(SCAN)
            d_x: float = self.motion.value[SCAN, 0] - self.x
            d_y: float = self.motion.value[SCAN, 1] - self.y
            d: float = hypot(d_x, d_y)
            if d > 0.0:
                d_x, d_y = d_x / d, d_y / d
            x_1: float = self.motion.value[SCAN, 3]
            y_1: float = self.motion.value[SCAN, 4]
            slope = d_x * x_1 + d_y * y_1 - self.motion.value[SCAN, 5]
            bend = d_x * self.motion.value[SCAN, 6] + d_y * self.motion.value[SCAN, 7]
            bend -= self.motion.value[SCAN, 8]
            if d > 0.0:
                bend += (d_x * y_1 - d_y * x_1) * (d_x * y_1 - d_y * x_1) / d
            if slope > 0.0:
                low = theta
            else:
                high = theta
            step = -slope / bend if bend < 0.0 else high - low
            if not low < theta + step < high:
                step = 0.5 * (low + high) - theta
            if fabs(step) < 1e-15 or high - low < 1e-15:
                break
            theta += step
            gap = self.outside(theta)
            if fabs(step) < 1e-9 and bend < 0.0:
                break
        if gap > self.beyond:
            self.beyond, self.angle = gap, theta

    def exchange(self, near: bool, s_x: float, s_y: float) -> None:
        """The disc missed most joins those that hold the place, and the best place is found again."""
        i: cython.int
        j: cython.int
        n: cython.int = self.held
        self.motion.place(SCAN, self.angle)
        for i in range(3):
            self.basis[n, i] = self.motion.value[SCAN, i]
        self.basis[n, 3] = self.angle
        self.found, self.best = False, FAR
        self.attempt(near, s_x, s_y, -1, -1)
        for i in range(n):
            self.attempt(near, s_x, s_y, i, -1)
            for j in range(i):
                if not near:
                    self.attempt(near, s_x, s_y, i, j)
        if not self.found:
            return
        i, j = self.best_i, self.best_j
        self.held = 0
        if j >= 0:  # j < i: neither is overwritten before it is read
            self.keep(j)
        if i >= 0:
            self.keep(i)
        self.keep(n)
        self.w_x, self.w_y = self.x, self.y
        if not near:
            self.overlap = self.t

    def keep(self, i: cython.int) -> None:
        """One of the discs is the next of those that hold the place."""
        p: cython.int
        for p in range(4):
            self.basis[self.held, p] = self.basis[i, p]
        self.held += 1

    def attempt(self, near: bool, s_x: float, s_y: float, i: cython.int, j: cython.int) -> None:
        """The places on the circles of the new disc, and if not -1 of those with the numbers i and j."""
        n: cython.int = self.held
        r: float = self.basis[n, 2]
        x: float
        y: float
        d: float
        t: float
        u: float
        if i < 0:
            if not near:
                self.consider(near, s_x, s_y, self.basis[n, 0], self.basis[n, 1], -r, i, j)
                return
            x, y = s_x - self.basis[n, 0], s_y - self.basis[n, 1]
            d = hypot(x, y)
            d = r / d if d > 0.0 else 0.0
            self.consider(near, s_x, s_y, self.basis[n, 0] + d * x, self.basis[n, 1] + d * y, 0.0, i, j)
            return
        x, y = self.basis[i, 0] - self.basis[n, 0], self.basis[i, 1] - self.basis[n, 1]
        d = hypot(x, y)
        if not d > 0.0:
            return
        if j < 0 and not near:
            t = 0.5 * (d - r - self.basis[i, 2])
            u = (r + t) / d
            self.consider(near, s_x, s_y, self.basis[n, 0] + u * x, self.basis[n, 1] + u * y, t, i, j)
            return
        if j < 0:
            # where both circles meet: along the line of the centres, and to both sides
            t = 0.5 * (d + (r - self.basis[i, 2]) * (r + self.basis[i, 2]) / d)
            u = sqrt(max((r - t) * (r + t), 0.0))
            t, u = t / d, u / d
            self.consider(
                near, s_x, s_y, self.basis[n, 0] + t * x - u * y, self.basis[n, 1] + t * y + u * x, 0.0, i, j
            )
            self.consider(
                near, s_x, s_y, self.basis[n, 0] + t * x + u * y, self.basis[n, 1] + t * y - u * x, 0.0, i, j
            )
            return
        # three circles that grow by t: W = p + q t from the new centre, from differences of their squares
        x_2: float = self.basis[j, 0] - self.basis[n, 0]
        y_2: float = self.basis[j, 1] - self.basis[n, 1]
        across: float = x * y_2 - y * x_2
        if across == 0.0:
            return
        one: float = 0.5 * (d * d + (r - self.basis[i, 2]) * (r + self.basis[i, 2]))
        two: float = 0.5 * (x_2 * x_2 + y_2 * y_2 + (r - self.basis[j, 2]) * (r + self.basis[j, 2]))
        p_x: float = (one * y_2 - two * y) / across
        p_y: float = (two * x - one * x_2) / across
        one, two = r - self.basis[i, 2], r - self.basis[j, 2]
        q_x: float = (one * y_2 - two * y) / across
        q_y: float = (two * x - one * x_2) / across
        # |p + q t|^2 = (r + t)^2
        a: float = q_x * q_x + q_y * q_y - 1.0
        b: float = p_x * q_x + p_y * q_y - r
        c: float = p_x * p_x + p_y * p_y - r * r
        root: float = sqrt(max(b * b - a * c, 0.0))
        root = -(b + root) if b >= 0.0 else root - b
        if a != 0.0:
            t = root / a
            self.consider(
                near, s_x, s_y, self.basis[n, 0] + p_x + q_x * t, self.basis[n, 1] + p_y + q_y * t, t, i, j
            )
        if root != 0.0:
            t = c / root
            self.consider(
                near, s_x, s_y, self.basis[n, 0] + p_x + q_x * t, self.basis[n, 1] + p_y + q_y * t, t, i, j
            )

    def consider(
        self,
        near: bool,
        s_x: float,
        s_y: float,
        x: float,
        y: float,
        t: float,
        i: cython.int,
        j: cython.int,
    ) -> None:
        """Keep a place if it misses none of the discs that are known, and is the best."""
        value: float = hypot(x - s_x, y - s_y) if near else t
        if value < self.best and self.fits(x, y, t):
            self.best, self.found = value, True
            self.best_i, self.best_j = i, j
            self.x, self.y, self.t = x, y, t

    def fits(self, x: float, y: float, t: float) -> bool:
        """Whether a place is within all discs that are known, grown by t, but for rounding."""
        i: cython.int
        rounding: float = 16.0 * EPSILON * (self.motion.size + self.motion.reach + fabs(x) + fabs(y))
        for i in range(self.held + 1):
            if not hypot(self.basis[i, 0] - x, self.basis[i, 1] - y) <= self.basis[i, 2] + t + rounding:
                return False
        return True
