r"""Kernel: a contact's periodic motion in its plane, and the direction of its slip over a panel of angles.

u_x, u_y and the radius are trigonometric polynomials. They are divided by the greatest amplitude of a force,
so that the slider k_u w is held within the disc

    |U - W| <= R,   U = k_u u,   R = mu n,   n = n_0 + k_v v where that is positive.

The means of u are omitted: they matter only for a slider that never moves.

The direction of slip is found by collocation of its Riccati equation. In slip U - W = R e, e = (cos alpha,
sin alpha), and the slider W' = lambda e moves only as it is pushed, so

    lambda = e . U' - R' >= 0,    R alpha' = e_perp . U'

with e_perp = (-sin alpha, cos alpha). Seen from the direction e_0 at the start of the panel, with
t = tan((alpha - alpha_0) / 2), a = e_0 . U' and b = e_0_perp . U',

    2 R t' = b - 2 a t - b t^2

which is a Riccati equation: t = y_2 / y_1, where y' = [[a, b], [b, -a]] y / (2 R) is linear. So the end of a
panel is a Moebius map of its start. A polynomial t of degree s that satisfies the equation at Radau's s
points errs at the end by the order 2 s - 1 of the length. Multiplied by R, the equation has no singular point
where the load vanishes. Where R is small, the solution alpha = direction of U' needs no small step (Hairer
and Wanner, Solving ordinary differential equations II, IV.5).

The error of the force due to the direction does not grow: (|R d alpha|)' <= 0 while lambda >= 0.
"""

from __future__ import annotations

import cython
import numpy as np
from cython.cimports.libc.math import cos, fabs, sin, sqrt

from fcm.contact.plane.options import PlanarOptions
from fcm.contact.plane.radau import radau

if cython.compiled:
    from cython.cimports.fcm.contact.contact_kernel import UNKNOWN, ContactParameters, HarmonicMotion
    from cython.cimports.fcm.contact.periodic.motion import EPSILON, LineMotion
    from cython.cimports.fcm.contact.plane.panel import (
        apply_eight,
        face_eight,
        newton_eight,
        place_eight,
        turn_of_eight,
    )
else:
    from fcm.contact.contact_kernel import UNKNOWN, ContactParameters, HarmonicMotion
    from fcm.contact.periodic.motion import EPSILON, LineMotion
    from fcm.contact.plane.radau import STAGES


# Rows of coefficients; `value` holds X, Y and REACH, then their first and their second derivatives.
X = cython.declare(cython.int, 0)
Y = cython.declare(cython.int, 1)
REACH = cython.declare(cython.int, 2)
LOAD = cython.declare(cython.int, 3)  # the normal force, divided by its own scale
ROWS = cython.declare(cython.int, 4)
SCAN = cython.declare(cython.int, 0)  # the slot of single angles; those of a panel follow

BOUNDS = cython.declare(cython.int, 5)  # number of orders of derivatives that are bounded, from 0 on


@cython.cclass
class PlaneMotion(HarmonicMotion):
    """u_x, u_y and n_0 + k_v v with given harmonics; `load` takes one contact, `place` an angle.

    Attributes
    ----------
    normal
        The same load as a `LineMotion`, which finds where the contact closes and opens.
    size, reach
        Bounds of |U| and of R.
    motion_bound, reach_bound
        Bounds of the derivatives of U and of R, by the order of the derivative.
    cos, sin (slot, harmonic), value (slot, 11)
        For the angles placed by `place`: the harmonics; U_x, U_y, R, their first derivatives, their second
        ones (filled by `bend`), cosine and sine of the angle. Of the nodes of a panel only the last has them.
    node (8, s), node_cos, node_sin (harmonic, s)
        For the nodes of a panel: U_x, U_y, R, their first derivatives, cosine and sine; the harmonics.
    """

    def __init__(self, harmonics: list[int], stages: int, options: PlanarOptions) -> None:
        self.options = given = options
        HarmonicMotion.__init__(self, harmonics, 3, ROWS)
        self.smooth, self.normal, self.stages = given.smooth_radius, LineMotion(harmonics), stages
        self.mean_x = self.mean_y = self.size = self.reach = 0.0
        self.motion_bound, self.reach_bound = np.zeros(BOUNDS), np.zeros(BOUNDS)
        self.cos = np.zeros((stages + 1, max(self.count, 1)))
        self.sin = np.zeros((stages + 1, max(self.count, 1)))
        self.value = np.zeros((stages + 1, 11))
        self.line = np.zeros(2 + 4 * self.count)
        self.node_cos, self.node_sin = np.zeros((2, max(self.count, 1), stages))
        if not cython.compiled:
            self.node = np.zeros(8 * stages)

    def load(self, x: cython.double[::1], first: cython.Py_ssize_t, contact: ContactParameters) -> cython.int:
        """Takes a motion x[first:]; returns OPEN, CLOSED or MIXED, or UNKNOWN if a number is not finite."""
        k: cython.int
        i: cython.Py_ssize_t = first + 3
        k_u: float = contact.k_u
        k_v: float = contact.k_v
        if not self.measure(x, first, contact):
            return UNKNOWN
        self.line[0], self.line[1] = 0.0, x[first + 2]
        self.mean_x, self.mean_y = k_u * x[first] / self.scale, k_u * x[first + 1] / self.scale
        self.mean[LOAD] = self.preload / self.load_scale
        self.mean[REACH] = self.ratio * self.mean[LOAD]
        for k in range(self.count):
            self.line[2 + 4 * k] = self.line[3 + 4 * k] = 0.0
            self.line[4 + 4 * k], self.line[5 + 4 * k] = x[i + 4], x[i + 5]
            self.re[X, k], self.im[X, k] = k_u * x[i] / self.scale, k_u * x[i + 1] / self.scale
            self.re[Y, k], self.im[Y, k] = k_u * x[i + 2] / self.scale, k_u * x[i + 3] / self.scale
            self.re[LOAD, k] = k_v * x[i + 4] / self.load_scale
            self.im[LOAD, k] = k_v * x[i + 5] / self.load_scale
            self.re[REACH, k] = self.ratio * self.re[LOAD, k]
            self.im[REACH, k] = self.ratio * self.im[LOAD, k]
            i += 6
        self.bound()
        return self.normal.load(self.line, 0, contact)

    def bound(self) -> None:
        """Fills bounds of motion and reach: sums of order**power times the amplitude."""
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
        """Whether the friction exceeds rounding relative to the motion."""
        rubs: bool = self.reach > self.smooth * self.size
        return rubs

    def place(self, slot: cython.int, theta: float) -> None:
        """Fills U, R, their derivatives and the harmonics at an angle, into a slot."""
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
        """Fills the motion at the nodes of a panel; the last node also into a slot."""
        i: cython.int
        k: cython.int
        last: cython.int = self.stages
        if not cython.compiled or not place_eight(
            theta, cython.address(self.re[0, 0]), cython.address(self.im[0, 0]),
            cython.address(self.number[0]), self.moving, self.re.shape[1], self.mean[REACH],
            cython.address(self.node[0]), cython.address(self.node_cos[0, 0]),
            cython.address(self.node_sin[0, 0]),
        ):  # fmt: skip
            for i in range(last):
                self.place(last, theta[i])
                for k in range(6):
                    self.node[last * k + i] = self.value[last, k]
                self.node[6 * last + i], self.node[7 * last + i] = self.value[last, 9], self.value[last, 10]
                for k in range(self.moving):
                    self.node_cos[k, i], self.node_sin[k, i] = self.cos[last, k], self.sin[last, k]
            return
        for k in range(6):
            self.value[last, k] = self.node[last * k + last - 1]
        self.value[last, 9], self.value[last, 10] = self.node[7 * last - 1], self.node[8 * last - 1]
        for k in range(self.moving):
            self.cos[last, k], self.sin[last, k] = self.node_cos[k, last - 1], self.node_sin[k, last - 1]

    def bend(self, slot: cython.int) -> None:
        """Fills the second derivatives at an angle in a slot."""
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


@cython.cclass
class Panel:
    """A panel of slip, solved by `solve`; its nodes are those of `PlaneMotion.place_nodes`.

    Attributes
    ----------
    theta, length, start_x, start_y, start_rate, start_bend
        The angle [rad] at which it begins, its length, and the direction, alpha' and alpha'' there.
    left, fade
        left is 0 if its nodes are Radau's in the angle. Otherwise the panel is graded: left is the distance
        from its beginning to the opening [rad], and its nodes are Radau's in the root of the remaining
        distance; fade is the relative decrease of that root. The direction approaches that of U' like a power
        of the remaining distance, to which the force is proportional.
    speed, fall (s,)
        At the nodes: derivative of the angle by the fraction of the panel; remaining part of `left`.
    tangent (s + 1,), change (s,), rate (s,)
        t at the start and at the nodes; its derivative by the angle, and that of alpha, at the nodes.
    e_x, e_y, along (s,), push (s + 1,)
        The direction and e . U' at the nodes; lambda at the start and at the nodes.
    noise
        The rounding of lambda.
    driven
        Whether the right sides of its derivatives have been computed.
    tail_before, tail_last (s,)
        Weights by which the last two coefficients of its derivatives follow from the right sides; see
        `tails`.
    exact
        Whether `inverse`, of the derivatives of the equations, has to be that at the solution.
    """

    def __init__(self, motion: PlaneMotion) -> None:
        given = motion.options
        self.converged, self.settled, self.frozen, self.most_steps, self.steepest, self.widest = (
            given.last_change,
            given.zero_change,
            given.frozen_change,
            given.max_iterations,
            given.max_initial_tangent,
            given.max_tangent,
        )
        self.before, self.growth = given.coefficient_floor, given.max_growth
        rule = radau(STAGES)
        self.motion = motion
        self.node, self.weight, self.slopes, self.tail, self.bary = (
            np.concatenate(([0.0], rule.nodes)), rule.weights, np.ascontiguousarray(rule.slopes), rule.tail,
            rule.bary,
        )  # fmt: skip
        self.tangent, self.push = np.zeros((2, STAGES + 1))
        self.change, self.rate, self.e_x, self.e_y, self.along = np.zeros((5, STAGES))
        self.theta = self.length = self.noise = self.left = self.fade = 0.0
        self.start_x = self.start_y = self.start_rate = self.start_bend = 0.0
        self.speed = np.zeros(STAGES)
        if not cython.compiled:
            self.inverse, self.columns = np.zeros((2, STAGES * STAGES))
            self.right, self.missing, self.a, self.b, self.r, self.at, self.fall = np.zeros((7, STAGES))
            self.tail_before, self.tail_last = np.zeros((2, STAGES))
        self.exact, self.driven = True, False
        i: cython.int
        j: cython.int
        for i in range(STAGES):
            for j in range(STAGES):
                self.columns[STAGES * j + i] = self.slopes[i + 1, j + 1]

    def begin(self, theta: float, e_x: float, e_y: float, rate: float, bend: float) -> None:
        """Begins at an angle in a direction; alpha' and alpha'' there predict how it changes."""
        self.theta, self.start_x, self.start_y = theta, e_x, e_y
        self.start_rate, self.start_bend = rate, bend

    def solve(self, length: float, left: float) -> bool:
        """Solves a panel of a length from its beginning; False if it is too long."""
        i: cython.int
        gone: float
        rate: float = self.start_rate
        bend: float = self.start_bend
        e_x: float = self.start_x
        e_y: float = self.start_y
        self.length = length
        self.driven = False
        self.left = left if length < left else 0.0
        self.fade = 1.0 - sqrt(1.0 - length / left) if length < left else 0.0
        self.noise = 4.0 * EPSILON * (self.motion.motion_bound[1] + self.motion.reach_bound[1])
        for i in range(STAGES):
            gone, self.speed[i] = self.gone(self.node[i + 1])
            self.at[i] = self.theta + gone
            self.fall[i] = 1.0 - gone / left if self.fade > 0.0 else 1.0
        self.motion.place_nodes(self.at)
        if not cython.compiled or not face_eight(
            self.motion.node, cython.address(self.speed[0]), e_x, e_y, self.a, self.b, self.r
        ):
            for i in range(STAGES):
                x_1: float = self.motion.node[3 * STAGES + i]
                y_1: float = self.motion.node[4 * STAGES + i]
                self.a[i] = e_x * x_1 + e_y * y_1
                self.b[i] = e_x * y_1 - e_y * x_1
                self.r[i] = 2.0 * max(self.motion.node[2 * STAGES + i], 0.0) / self.speed[i]
        if self.fade > 0.0:
            bend = self.fade * self.fade * left * (4.0 * bend * left - 2.0 * rate)
            rate *= 2.0 * self.fade * left
        else:
            bend, rate = bend * length * length, rate * length
        slope: float = max(min(0.5 * rate, self.steepest), -self.steepest)
        bend = max(min(0.25 * bend, self.steepest), -self.steepest)
        return self.newton(slope, bend) and self.finish()

    def gone(self, part: float) -> tuple[float, float]:
        """Angle [rad] from the panel's beginning to a fraction of it, and its derivative by the fraction."""
        root: float
        if self.fade > 0.0:
            root = 1.0 - self.fade * part
            return self.left * (1.0 - root * root), 2.0 * self.left * self.fade * root
        return self.length * part, self.length

    def newton(self, slope: float, bend: float) -> bool:
        """Solves the collocated Riccati equation by Newton's method, starting from a parabola.

        After a small change the derivatives of the equation are kept, and changes fall by a constant factor.
        If `inverse` has to be exact, one step more than t needs is taken.
        """
        i: cython.int
        step: cython.int
        most: float
        ahead: float
        before: float = 0.0
        close: float = self.converged * self.converged
        wanted: cython.bint = True
        last: cython.bint = False
        for i in range(STAGES + 1):
            self.tangent[i] = self.node[i] * (slope + self.node[i] * bend)
        for step in range(self.most_steps):  # noqa: B007
            if not self.improve(wanted):
                return False
            most = 0.0
            for i in range(STAGES):
                self.tangent[i + 1] += self.right[i]
                most = max(most, fabs(self.right[i]))
                if not fabs(self.tangent[i + 1]) < self.widest:
                    return False
            if last or (most < self.settled and (wanted or not self.exact)):
                return True
            # with kept derivatives the next change falls by the same ratio, otherwise quadratically
            ahead = most * most if wanted else most * (most / before)
            last = ahead < close
            wanted = most > self.frozen or (last and self.exact)
            before = most
        return False

    def improve(self, wanted: cython.bint) -> bool:
        """Computes a Newton step `right` from t, with a new `inverse` if wanted; False if it is singular."""
        found: cython.int = -1
        if cython.compiled:
            found = newton_eight(
                self.columns, self.r, self.a, self.b, cython.address(self.tangent[1]), self.inverse,
                self.right, wanted,
            )  # fmt: skip
        if found >= 0:
            regular: bool = found > 0
            return regular
        if wanted and not self.invert():
            return False
        self.residual()
        self.apply()
        return True

    def residual(self) -> None:
        """Fills `missing`, the residual of the equation at the nodes."""
        i: cython.int
        j: cython.int
        for i in range(STAGES):
            slope: float = 0.0
            for j in range(STAGES):
                slope += self.columns[STAGES * j + i] * self.tangent[j + 1]
            t: float = self.tangent[i + 1]
            self.missing[i] = self.b[i] - t * (2.0 * self.a[i] + self.b[i] * t) - self.r[i] * slope

    def apply(self) -> None:
        """Sets `right` to the inverse times the residual `missing`."""
        i: cython.int
        j: cython.int
        if cython.compiled and apply_eight(self.inverse, self.missing, self.right):
            return
        for i in range(STAGES):
            self.right[i] = 0.0
        for j in range(STAGES):
            for i in range(STAGES):
                self.right[i] += self.inverse[STAGES * j + i] * self.missing[j]

    def invert(self) -> bool:
        """Fills `inverse`, by columns, of the equation's derivatives by t; False if they are singular.

        Pivoting is not needed: for the derivatives of Radau's rule with positive numbers on the diagonal no
        pivot is small.
        """
        i: cython.int
        j: cython.int
        k: cython.int
        part: float
        for j in range(STAGES):
            for i in range(STAGES):
                self.inverse[STAGES * j + i] = self.r[i] * self.columns[STAGES * j + i]
            self.inverse[STAGES * j + j] += 2.0 * (self.a[j] + self.b[j] * self.tangent[j + 1])
        for k in range(STAGES):
            part = self.inverse[STAGES * k + k]
            if not fabs(part) > 1e-300:
                return False
            self.inverse[STAGES * k + k] = 1.0
            for i in range(STAGES):
                self.inverse[STAGES * k + i] /= part
            for j in range(STAGES):
                if j == k:
                    continue
                part = self.inverse[STAGES * j + k]
                self.inverse[STAGES * j + k] = 0.0
                for i in range(STAGES):
                    self.inverse[STAGES * j + i] -= part * self.inverse[STAGES * k + i]
        return True

    def finish(self) -> bool:
        """Sets directions and lambda at the nodes; False if directions part too much in the panel."""
        i: cython.int
        j: cython.int
        found: cython.int = -1
        if cython.compiled:
            found = turn_of_eight(
                self.columns, self.motion.node, self.r, self.a, self.b, cython.address(self.speed[0]),
                cython.address(self.tangent[1]), self.start_x, self.start_y, self.growth,
                cython.address(self.change[0]), cython.address(self.rate[0]), cython.address(self.e_x[0]),
                cython.address(self.e_y[0]), cython.address(self.along[0]), cython.address(self.push[1]),
            )  # fmt: skip
        if found >= 0:
            follows: bool = found > 0
            return follows
        for i in range(STAGES):
            t: float = self.tangent[i + 1]
            part: float = 1.0 / (1.0 + t * t)
            c: float = (1.0 - t * t) * part
            d: float = 2.0 * t * part
            slope: float = 0.0
            for j in range(STAGES):
                slope += self.slopes[i + 1, j + 1] * self.tangent[j + 1]
            self.change[i] = slope / self.speed[i]
            self.rate[i] = 2.0 * self.change[i] * part
            self.e_x[i] = self.start_x * c - self.start_y * d
            self.e_y[i] = self.start_y * c + self.start_x * d
            self.along[i] = self.a[i] * c + self.b[i] * d
            self.push[i + 1] = self.along[i] - self.motion.node[5 * STAGES + i]
            if -2.0 * self.along[i] > self.growth * self.r[i]:
                return False
        return True

    def rest(self) -> float:
        """Last Legendre coefficient of t, an estimate of the truncation error of its polynomial.

        In a graded panel t is multiplied by the remaining distance, as the force is. The last coefficient may
        vanish by chance; then a tenth of the one before it is taken.
        """
        j: cython.int
        before: float = 0.0
        last: float = 0.0
        for j in range(STAGES):
            before += self.tail[0, j + 1] * self.fall[j] * self.tangent[j + 1]
            last += self.tail[1, j + 1] * self.fall[j] * self.tangent[j + 1]
        rest: float = max(fabs(last), self.before * fabs(before))
        return rest

    def tails(self) -> None:
        """Fills `tail_before`, `tail_last`: weights for the last coefficients of derivatives of t."""
        i: cython.int
        j: cython.int
        one: float
        for j in range(STAGES):
            self.tail_before[j] = self.tail_last[j] = 0.0
            for i in range(STAGES):
                one = self.fall[i] * self.inverse[STAGES * j + i]
                self.tail_before[j] += self.tail[0, i + 1] * one
                self.tail_last[j] += self.tail[1, i + 1] * one

    def end_of_slip(self) -> float:
        """Fraction of the panel at which lambda falls to its rounding; 2 if it does not."""
        j: cython.int
        least: float = self.push[0]
        most: float = self.push[0]
        for j in range(STAGES):
            least, most = min(least, self.push[j + 1]), max(most, self.push[j + 1])
        if least > 0.5 * most:  # between nodes a resolved polynomial does not fall to zero from there
            return 2.0
        f_0: float = self.push[0] - self.noise
        if f_0 <= 0.0 and self.push[1] <= self.noise:
            return 0.0
        d_0: float = self.slope_at(0)
        for j in range(STAGES):
            h: float = self.node[j + 1] - self.node[j]
            f_1: float = self.push[j + 1] - self.noise
            d_1: float = self.slope_at(j + 1)
            if f_1 < 0.0:
                return self.root(self.node[j], self.node[j + 1])
            if d_0 < 0.0 < d_1:
                # where the tangents at both ends meet; lambda is hardly below that point
                x: float = (f_0 - f_1 + d_1 * h) / (d_1 - d_0)
                if f_0 + d_0 * x < 0.0:
                    low: float = self.lowest(self.node[j], self.node[j + 1])
                    value, _ = self.pushed(low)
                    if value < 0.0:
                        return self.root(self.node[j], low)
            f_0, d_0 = f_1, d_1
        return 2.0

    def slope_at(self, j: cython.int) -> float:
        """Derivative of lambda by the fraction of the panel, at the start or at a node."""
        k: cython.int
        slope: float = 0.0
        for k in range(STAGES + 1):
            slope += self.slopes[j, k] * self.push[k]
        return slope

    def pushed(self, x: float) -> tuple[float, float]:
        """lambda minus its rounding, and its derivative, at a fraction x of the panel."""
        k: cython.int
        total: float = 0.0
        t: float = 0.0
        for k in range(STAGES + 1):
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
        gone, speed = self.gone(x)
        self.motion.place(SCAN, self.theta + gone)
        self.motion.bend(SCAN)
        across: float = e_x * self.motion.value[SCAN, 4] - e_y * self.motion.value[SCAN, 3]
        value: float = e_x * self.motion.value[SCAN, 3] + e_y * self.motion.value[SCAN, 4]
        slope: float = e_x * self.motion.value[SCAN, 6] + e_y * self.motion.value[SCAN, 7]
        slope -= self.motion.value[SCAN, 8]
        if self.motion.value[SCAN, 2] > 0.0:
            slope += across * across / self.motion.value[SCAN, 2]
        return value - self.motion.value[SCAN, 5] - self.noise, slope * speed

    def root(self, low: float, high: float) -> float:
        """Fraction at which lambda vanishes, by bracketed Newton's method.

        lambda is positive at `low` and negative at `high`.
        """
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
        """Fraction at which lambda is least, between `low`, where it falls, and `high`, where it rises."""
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
