"""Kernel: the place where the slider of a contact that never slips rests, and whether there is one.

The slider can rest at any W with |U - W| <= R at every angle: a place common to all discs. It began
unstressed. It is taken to rest at its start if the discs permit that, otherwise at the nearest common place.

These are two small convex problems, each with a disc for every angle. The first is the least t by which all
discs have to grow until they have a place in common, a weighted smallest enclosing circle. The second is the
nearest common place. At most three discs, or two, hold a solution. Both problems are solved by exchange: the
disc that the place misses most joins those that hold it, and the best place that these permit replaces it,
until no disc is missed.

The disc missed most is first sought among nodes. That no other disc is missed is proved by

    h = |U - W|^2 - (R + t)^2,

a trigonometric polynomial, positive where a disc grown by t is missed. Its values and slopes at both ends of
a step, and a bound of its fourth derivative, prove that it is negative, monotone or concave in between. A
step that proves nothing is halved. This ends: where the cubic through both ends errs by no more than
rounding, h has at most one maximum, as a cubic has.
"""

from __future__ import annotations

import cython
import numpy as np
from cython.cimports.libc.math import fabs, hypot, sin, sqrt

if cython.compiled:
    from cython.cimports.fcm.contact.periodic.motion import EPSILON, FIRST_NODE, TWO_PI
    from cython.cimports.fcm.contact.plane.panel import REACH, SCAN, PlaneMotion, X, Y
    from cython.cimports.fcm.cubic import VALUE_ERROR, greatest_bend, slope_bounds, value_bounds
else:
    from fcm.contact.periodic.motion import EPSILON, FIRST_NODE, TWO_PI
    from fcm.contact.plane.panel import REACH, SCAN, PlaneMotion, X, Y
    from fcm.cubic import VALUE_ERROR, greatest_bend, slope_bounds, value_bounds

FAR = cython.declare(cython.double, 1e300)


@cython.cclass
class Resting:
    """Finds the place where the slider rests, for a motion that never opens the contact.

    Attributes
    ----------
    w_x, w_y
        The place, relative to the means of u.
    overlap
        How far all discs have to grow to have a place in common: up to 0 they have one, above 0 it slips. A
        lower bound unless it is computed exactly.
    held, basis (3, 4)
        The number of discs that hold the place; centre, radius and angle of each.
    beyond, angle
        For the place passed to `farthest` or `farthest_of_all`: its distance outside the disc that it misses
        most, and the angle of that disc.
    """

    def __init__(self, motion: PlaneMotion) -> None:
        given = motion.options
        self.exchanges, self.same = given.max_exchanges, given.disc_tolerance
        self.max_halvings = given.max_halvings
        self.least_bend = given.min_bend
        self.motion = motion
        self.nodes = 12 * max(motion.highest, 1) + 3
        self.step = TWO_PI / self.nodes
        angle = np.outer(self.step * (FIRST_NODE + np.arange(self.nodes)), np.asarray(motion.order))
        self.node_cos, self.node_sin = np.cos(angle), np.sin(angle)
        self.at, self.gap = np.zeros((3, self.nodes)), np.zeros(self.nodes)
        self.basis = np.zeros((4, 4))
        self.held = self.i = self.j = self.best_i = self.best_j = 0
        self.near, self.s_x, self.s_y = False, 0.0, 0.0
        self.w_x = self.w_y = self.overlap = self.beyond = self.angle = 0.0
        self.square, self.stack = np.zeros(self.nodes), np.empty((self.max_halvings + 2, 4))
        self.x = self.y = self.t = self.best = 0.0
        self.level = self.fourth = self.noise = self.rounding = self.but = 0.0
        self.found = self.sampled = False

    def stays(self, s_x: float, s_y: float) -> bool:
        """Whether the slider need never slip, having begun at s_x, s_y; then sets where it rests."""
        self.held, self.sampled = 0, False
        self.overlap = -FAR
        self.w_x, self.w_y = s_x, s_y
        if hypot(s_x, s_y) + self.motion.size <= 2.0 * self.motion.mean[REACH] - self.motion.reach:
            return True
        self.sample()
        self.farthest(s_x, s_y)
        self.hidden(0.0)
        if self.beyond <= 0.0:
            return True
        if not self.encloses(False):
            return False
        self.nearest(s_x, s_y)
        return True

    def encloses(self, exact: bool) -> bool:
        """Whether all discs have a place in common.

        `overlap` is computed only as far as the answer needs, unless `exact`.
        """
        i: cython.int
        level: float
        rounding: float = 4.0 * EPSILON * (self.motion.size + self.motion.reach)
        self.sample()
        self.held, self.overlap = 0, -FAR
        self.w_x = self.w_y = 0.0
        for i in range(self.exchanges):  # noqa: B007
            level = (self.overlap if exact else max(0.0, self.overlap)) + rounding
            self.farthest(self.w_x, self.w_y)
            self.hidden(level)
            if self.beyond <= level:
                break
            self.exchange(False, 0.0, 0.0)
            if not self.found or (self.overlap > rounding and not exact):
                break
        return self.overlap <= rounding

    def brief(self) -> bool:
        """Whether each disc that holds the place found by `encloses` does so for an instant only.

        A slip there is then as short as the root of `overlap`. For a circular motion all discs hold the
        place.
        """
        i: cython.int
        for i in range(self.held):
            self.motion.place(SCAN, self.basis[i, 3])
            self.motion.bend(SCAN)
            d_x: float = self.motion.value[SCAN, 0] - self.w_x
            d_y: float = self.motion.value[SCAN, 1] - self.w_y
            d: float = hypot(d_x, d_y)
            if not d > 0.0:
                return False
            across: float = (d_x * self.motion.value[SCAN, 4] - d_y * self.motion.value[SCAN, 3]) / d
            bend: float = (d_x * self.motion.value[SCAN, 6] + d_y * self.motion.value[SCAN, 7]) / d
            bend += across * across / d - self.motion.value[SCAN, 8]
            if not bend < -self.least_bend * self.motion.reach:
                return False
        return self.held > 1

    def nearest(self, s_x: float, s_y: float) -> None:
        """Sets the resting place nearest to a start that is not common to all discs."""
        i: cython.int
        w_x: float = self.w_x
        w_y: float = self.w_y
        rounding: float = 4.0 * EPSILON * (self.motion.size + self.motion.reach)
        self.held = 0
        self.w_x, self.w_y = s_x, s_y
        for i in range(self.exchanges):  # noqa: B007
            self.farthest(self.w_x, self.w_y)
            self.hidden(rounding)
            if self.beyond <= rounding:
                break
            self.exchange(True, s_x, s_y)
            if not self.found:  # the only common place, within rounding
                self.w_x, self.w_y, self.held = w_x, w_y, 0
                return
        self.sharpen(s_x, s_y)

    def sharpen(self, s_x: float, s_y: float) -> None:
        """Refines the angles of the discs that hold the place.

        The place errs by the square of their errors; but along the edge of a single disc it errs by the error
        itself.
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
        """Moves the angle of disc i to that at which the place w misses its disc most."""
        self.x, self.y, self.beyond = w_x, w_y, -FAR
        self.refine(self.basis[i, 3])
        self.basis[i, 3] = self.angle

    def sample(self) -> None:
        """Fills U and R at all nodes."""
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
        """Sets `beyond` and `angle` for the disc that a place misses most, among those near nodes."""
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
                self.refine(self.step * (FIRST_NODE + j))

    def farthest_of_all(self, w_x: float, w_y: float) -> None:
        """Sets `beyond` and `angle` for the disc that a place misses most, among all angles."""
        i: cython.int
        self.farthest(w_x, w_y)
        for i in range(self.exchanges):  # noqa: B007
            before: float = self.beyond
            self.hidden(before)
            if not self.beyond > before:
                break

    def next_farthest(self) -> None:
        """Sets `beyond`: distance outside the disc missed most, except the one that holds the place."""
        self.farthest(self.w_x, self.w_y)
        self.beyond = -FAR
        self.maxima(0.0, -FAR, self.basis[0, 3])

    def hidden(self, level: float) -> None:
        """After `farthest`: searches between the nodes for a disc missed by more than a level.

        `beyond` exceeds the level if and only if there is one.
        """
        if self.beyond > level:
            return
        self.maxima(level, 0.0, FAR)
        if self.beyond > level:
            self.refine(self.angle)

    def maxima(self, level: float, least: float, but: float) -> None:
        """Sets `beyond` and `angle` for the disc missed most, among all maxima of h above `least`.

        The disc at the angle `but` is excluded. `level` is the t of h.
        """
        j: cython.int
        k: cython.int
        mean: float = 0.0
        rms: float = 0.0
        most: float = 0.0
        self.level, self.but = level, but
        for j in range(self.nodes):
            d_x: float = self.at[0, j] - self.x
            d_y: float = self.at[1, j] - self.y
            d: float = d_x * d_x + d_y * d_y
            r: float = self.at[2, j] + level
            self.square[j] = d - r * r
            most = max(most, d, r * r)
            mean += self.square[j]
        mean /= self.nodes
        unit: float = most if most > 0.0 else 1.0  # squares of h may overflow
        for j in range(self.nodes):
            d = (self.square[j] - mean) / unit
            rms += d * d
        rms = unit * sqrt(rms / self.nodes)
        # h has harmonics up to twice the highest, which the nodes resolve: the sum of all amplitudes is at
        # most the root of twice their number times the root mean square
        order: float = 2.0 * max(self.motion.highest, 1)
        second: float = order * order * sqrt(2.0 * order) * rms
        self.fourth = order * order * second
        self.rounding = 8.0 * EPSILON * (self.motion.size + self.motion.reach)
        self.noise = EPSILON * most
        second *= 0.125 * self.step * self.step
        for j in range(self.nodes):
            k = j + 1 if j + 1 < self.nodes else 0
            if max(self.square[j], self.square[k]) + second > least:
                self.between(self.step * (FIRST_NODE + j), least)

    def between(self, begin: float, least: float) -> None:
        """Examines the maxima of h within one step from an angle."""
        depth: cython.int = 0
        middle: float
        value: float
        slope: float
        size: float
        next_value: float
        next_slope: float
        next_size: float
        value, slope, size = self.missed(begin)
        next_value, next_slope, next_size = self.missed(begin + self.step)
        self.stack[0, 0], self.stack[0, 1] = begin + self.step, next_value
        self.stack[0, 2], self.stack[0, 3] = next_slope, next_size
        while depth >= 0:
            length: float = self.stack[depth, 0] - begin
            next_value, next_slope = self.stack[depth, 1], self.stack[depth, 2]
            next_size = self.stack[depth, 3]
            error: float = self.fourth * length * length
            count: cython.int = self.most_maxima(
                length, value, slope, next_value, next_slope, least + self.rounding * max(size, next_size)
            )
            if count > 1 and depth < self.max_halvings and VALUE_ERROR * error * length * length > self.noise:
                depth += 1
                middle = begin + 0.5 * length
                next_value, next_slope, next_size = self.missed(middle)
                self.stack[depth, 0], self.stack[depth, 1] = middle, next_value
                self.stack[depth, 2], self.stack[depth, 3] = next_slope, next_size
                continue
            if count > 0:
                self.peak(begin, self.stack[depth, 0])
            begin, value, slope, size = self.stack[depth, 0], next_value, next_slope, next_size
            depth -= 1

    def most_maxima(
        self, length: float, g_0: float, d_0: float, g_1: float, d_1: float, least: float
    ) -> cython.int:
        """Greatest number of maxima of h above `least` in an interval; 2 if nothing is proved."""
        _, high = value_bounds(length, self.fourth, g_0, d_0, g_1, d_1)
        if high <= least:
            return 0
        low, high = slope_bounds(length, self.fourth, g_0, d_0, g_1, d_1)
        if low > 0.0 or high < 0.0:
            return 0
        return 1 if greatest_bend(length, self.fourth, g_0, d_0, g_1, d_1) < 0.0 else 2

    def missed(self, theta: float) -> tuple[float, float, float]:
        """Values of h, its slope, and |U - W| + |R + t| at an angle."""
        self.motion.place(SCAN, theta)
        d_x: float = self.motion.value[SCAN, 0] - self.x
        d_y: float = self.motion.value[SCAN, 1] - self.y
        r: float = self.motion.value[SCAN, 2] + self.level
        d: float = hypot(d_x, d_y)
        slope: float = d_x * self.motion.value[SCAN, 3] + d_y * self.motion.value[SCAN, 4]
        slope -= r * self.motion.value[SCAN, 5]
        return (d - r) * (d + r), 2.0 * slope, d + fabs(r)

    def peak(self, low: float, high: float) -> None:
        """Takes the single maximum of h between two angles if it is missed by more than `beyond`."""
        i: cython.int
        first: float = low
        last: float = high
        theta: float = 0.5 * (low + high)
        step: float
        for i in range(50):  # noqa: B007
            _, slope, _ = self.missed(theta)
            self.motion.bend(SCAN)
            d_x: float = self.motion.value[SCAN, 0] - self.x
            d_y: float = self.motion.value[SCAN, 1] - self.y
            x_1: float = self.motion.value[SCAN, 3]
            y_1: float = self.motion.value[SCAN, 4]
            r_1: float = self.motion.value[SCAN, 5]
            bend: float = x_1 * x_1 + y_1 * y_1 - r_1 * r_1
            bend += d_x * self.motion.value[SCAN, 6] + d_y * self.motion.value[SCAN, 7]
            bend -= (self.motion.value[SCAN, 2] + self.level) * self.motion.value[SCAN, 8]
            if slope > 0.0:
                low = theta
            else:
                high = theta
            step = -0.5 * slope / bend if bend < 0.0 else high - low
            if fabs(step) < 1e-9:
                break
            if not low < theta + step < high:
                step = 0.5 * (low + high) - theta
            theta += step
        if self.but < FAR and self.within(first, last):
            return
        gap: float = self.outside(theta)
        if gap > self.beyond:
            self.beyond, self.angle = gap, theta

    def within(self, first: float, last: float) -> bool:
        """Whether the angle `but`, modulo a turn, lies between two angles or coincides with their ends."""
        middle: float = 0.5 * (first + last)
        off: float = fabs(self.but - middle)
        while off > 0.5 * TWO_PI:
            off = fabs(off - TWO_PI)
        inside: bool = off <= 0.5 * (last - first) + self.same
        return inside

    def outside(self, theta: float) -> float:
        """Distance of the place (`x`, `y`) outside the disc at an angle."""
        self.motion.place(SCAN, theta)
        gap: float = hypot(self.motion.value[SCAN, 0] - self.x, self.motion.value[SCAN, 1] - self.y)
        gap -= self.motion.value[SCAN, 2]
        return gap

    def refine(self, theta: float) -> None:
        """Takes the greatest gap within a step of a node if it exceeds `beyond`."""
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
            if fabs(step) < 1e-15:  # the bracket, which is open at the angle itself, would not permit it
                break
            if not low < theta + step < high:
                step = 0.5 * (low + high) - theta
            if high - low < 1e-15:
                break
            theta += step
            gap = self.outside(theta)
            if fabs(step) < 1e-9 and bend < 0.0:
                break
        if gap > self.beyond:
            self.beyond, self.angle = gap, theta

    def exchange(self, near: bool, s_x: float, s_y: float) -> None:
        """Adds the disc missed most to those that hold the place, and finds the best place anew.

        The best place is the one nearest to the start s_x, s_y if `near`, otherwise the one that the discs
        miss least.
        """
        self.near, self.s_x, self.s_y = near, s_x, s_y
        i: cython.int
        j: cython.int
        n: cython.int = self.held
        self.motion.place(SCAN, self.angle)
        for i in range(3):
            self.basis[n, i] = self.motion.value[SCAN, i]
        self.basis[n, 3] = self.angle
        self.found, self.best = False, FAR
        self.attempt(-1, -1)
        for i in range(n):
            self.attempt(i, -1)
            for j in range(i):
                if not near:
                    self.attempt(i, j)
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
        """Makes disc i the next of the discs that hold the place."""
        p: cython.int
        for p in range(4):
            self.basis[self.held, p] = self.basis[i, p]
        self.held += 1

    def attempt(self, i: cython.int, j: cython.int) -> None:
        """Tries the places on the circle of the new disc, and on circles i and j unless they are -1."""
        self.i, self.j = i, j
        n: cython.int = self.held
        r: float = self.basis[n, 2]
        x: float
        y: float
        d: float
        t: float
        u: float
        if i < 0:
            if not self.near:
                self.consider(self.basis[n, 0], self.basis[n, 1], -r)
                return
            x, y = self.s_x - self.basis[n, 0], self.s_y - self.basis[n, 1]
            d = hypot(x, y)
            d = r / d if d > 0.0 else 0.0
            self.consider(self.basis[n, 0] + d * x, self.basis[n, 1] + d * y, 0.0)
            return
        x, y = self.basis[i, 0] - self.basis[n, 0], self.basis[i, 1] - self.basis[n, 1]
        d = hypot(x, y)
        if not d > 0.0:
            return
        if j < 0 and not self.near:
            t = 0.5 * (d - r - self.basis[i, 2])
            u = (r + t) / d
            self.consider(self.basis[n, 0] + u * x, self.basis[n, 1] + u * y, t)
            return
        if j < 0:
            # where both circles meet: along the line of the centres, then to either side
            t = 0.5 * (d + (r - self.basis[i, 2]) * (r + self.basis[i, 2]) / d)
            u = sqrt(max((r - t) * (r + t), 0.0))
            t, u = t / d, u / d
            self.consider(self.basis[n, 0] + t * x - u * y, self.basis[n, 1] + t * y + u * x, 0.0)
            self.consider(self.basis[n, 0] + t * x + u * y, self.basis[n, 1] + t * y - u * x, 0.0)
            return
        # three circles that grow by t: W = p + q t from the new centre, by the differences of their squares
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
            self.consider(self.basis[n, 0] + p_x + q_x * t, self.basis[n, 1] + p_y + q_y * t, t)
        if root != 0.0:
            t = c / root
            self.consider(self.basis[n, 0] + p_x + q_x * t, self.basis[n, 1] + p_y + q_y * t, t)

    def consider(self, x: float, y: float, t: float) -> None:
        """Keeps a place if it misses none of the known discs, grown by t, and is the best so far."""
        value: float = hypot(x - self.s_x, y - self.s_y) if self.near else t
        if value < self.best and self.fits(x, y, t):
            self.best, self.found = value, True
            self.best_i, self.best_j = self.i, self.j
            self.x, self.y, self.t = x, y, t

    def fits(self, x: float, y: float, t: float) -> bool:
        """Whether a place lies within all known discs, grown by t, up to rounding."""
        i: cython.int
        rounding: float = 16.0 * EPSILON * (self.motion.size + self.motion.reach + fabs(x) + fabs(y))
        for i in range(self.held + 1):
            if not hypot(self.basis[i, 0] - x, self.basis[i, 1] - y) <= self.basis[i, 2] + t + rounding:
                return False
        return True
