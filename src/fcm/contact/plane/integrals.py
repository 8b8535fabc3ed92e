r"""Kernel: integrals over a cycle in the plane, for the harmonics of the forces and their derivatives.

A friction force is U minus the place of the slider in stick, and R times the direction in slip. U and R are
trigonometric polynomials. So two kinds of integrals are needed: of exp(-i m theta) over all sticks, in closed
form; and of both components of the direction times exp(-i m theta) over all slips, by Radau's rule on the
panels in which the direction is computed.

Their derivatives by the coefficients of the motion are carried through all pieces of the cycle. As the forces
are continuous, the instants of events do not enter; the memory of the slider does. With U the motion and xi
the derivative of the direction alpha,

    stick:  d W is kept;                          d F = d U - d W
    slip:   R xi' = -(e . U') xi + e_perp . d U' - alpha' d R;   d F = d R e + R xi e_perp

From stick to slip, R xi = e_perp . (d U - d W); the disc takes the component along e. From slip to stick, d W
= d U - d F. Where the contact closes, W = U at an instant that moves by -d R / R'. If it slips at once, the
equation of slip has one finite solution, (e . U') xi = e_perp . d U' - alpha' d R. At the end of a period of
a contact that never opens, d W equals that at the start. So the derivatives from a fixed start, and those for
its two unit changes, are carried along as columns of their own.
"""

from __future__ import annotations

import cython
import numpy as np
import numpy.typing as npt
from cython.cimports.libc.math import cos, fabs, sin

if cython.compiled:
    from cython.cimports.fcm.contact.closed_form import PI
    from cython.cimports.fcm.contact.contact_kernel import ForceDerivatives, FourierIntegrals
    from cython.cimports.fcm.contact.plane.integrals import (
        carry_eight,
        drive_eight,
        rest_eight,
        turn_eight,
        weigh_eight,
    )
    from cython.cimports.fcm.contact.plane.panel import SCAN, STAGES, Panel, PlaneMotion
else:
    from fcm.contact.closed_form import PI
    from fcm.contact.contact_kernel import ForceDerivatives, FourierIntegrals
    from fcm.contact.plane.panel import SCAN, Panel, PlaneMotion
    from fcm.contact.plane.radau import STAGES


# Functions of the angle by which exp(-i m theta) is multiplied
STICKS = cython.declare(cython.int, 0)  # 1 while it sticks
CONTACT = cython.declare(cython.int, 1)  # 1 while it is closed
SLIPS_X = cython.declare(cython.int, 2)  # the direction while it slips
SLIPS_Y = cython.declare(cython.int, 3)


@cython.cclass
class PlanarIntegrals(FourierIntegrals):
    """Integrals over the pieces of a cycle.

    Attributes
    ----------
    held_x_re, held_x_im, held_y_re, held_y_im (h,)
        Integrals of the place of the slider in stick.
    work, path
        Work of the friction force on the slider, and path of the slider, relative to the scale.
    """

    def __init__(self, motion: PlaneMotion, most: int) -> None:
        FourierIntegrals.__init__(self, motion, most, 4)
        self.held_x_re, self.held_x_im, self.held_y_re, self.held_y_im = np.zeros((4, most + 1))
        self.work = self.path = 0.0
        # for the slips, each node of a panel separately: direction x and y times cosine and sine
        self.lanes = np.zeros((4 * (self.highest + 1), STAGES))
        if not cython.compiled:
            self.x, self.y, self.c, self.s = np.zeros((4, STAGES))

    def begin(self) -> None:
        """Sets all sums to zero."""
        m: cython.int
        p: cython.int
        self.clear()
        for m in range(4 * (self.highest + 1)):
            for p in range(STAGES):
                self.lanes[m, p] = 0.0
        for m in range(self.most + 1):
            self.held_x_re[m] = self.held_x_im[m] = self.held_y_re[m] = self.held_y_im[m] = 0.0
        self.work = self.path = 0.0

    def contact(self, begin: float, end: float) -> None:
        """Adds an interval of angles in which the contact is closed."""
        self.powers(0, cos(begin), sin(begin))
        self.powers(1, cos(end), sin(end))
        self.add(CONTACT, 0, 1, end - begin, 1.0)

    def stick(self, begin: float, end: float, w_x: float, w_y: float) -> None:
        """Adds a stick with the slider at a place."""
        m: cython.int
        c: float = end - begin
        s: float = 0.0
        self.powers(0, cos(begin), sin(begin))
        self.powers(1, cos(end), sin(end))
        self.add(STICKS, 0, 1, c, 1.0)
        for m in range(self.most + 1):
            if m > 0:
                c = (self.power_sin[1, m] - self.power_sin[0, m]) * self.reciprocal[m]
                s = (self.power_cos[0, m] - self.power_cos[1, m]) * self.reciprocal[m]
            self.held_x_re[m] += w_x * c
            self.held_x_im[m] -= w_x * s
            self.held_y_re[m] += w_y * c
            self.held_y_im[m] -= w_y * s

    def slip(self, panel: Panel) -> None:
        """Adds a panel of slip to `lanes`."""
        i: cython.int
        m: cython.int
        w: float
        c: float
        d: float
        for i in range(STAGES):
            w = panel.weight[i] * panel.speed[i]
            self.x[i], self.y[i] = w * panel.e_x[i], w * panel.e_y[i]
            self.c[i], self.s[i] = panel.motion.node[6 * STAGES + i], panel.motion.node[7 * STAGES + i]
            w *= panel.push[i + 1]
            self.path += w
            self.work += w * max(panel.motion.node[2 * STAGES + i], 0.0)
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
        """Adds the slip sums of all nodes to the integrals."""
        m: cython.int
        i: cython.int
        for m in range(self.highest + 1):
            for i in range(STAGES):
                self.cos_sum[SLIPS_X, m] += self.lanes[4 * m, i]
                self.sin_sum[SLIPS_X, m] += self.lanes[4 * m + 1, i]
                self.cos_sum[SLIPS_Y, m] += self.lanes[4 * m + 2, i]
                self.sin_sum[SLIPS_Y, m] += self.lanes[4 * m + 3, i]


def _whole_lines(rows: int, width: int) -> npt.NDArray[np.float64]:
    """Zeros (rows, width), aligned to a cache line of the processor."""
    room = np.zeros(rows * width + 8)
    first = -room.ctypes.data // 8 % 8
    return room[first : first + rows * width].reshape(rows, width)


@cython.cclass
class PlanarDerivatives(ForceDerivatives):
    """Derivatives of the forces in a plane.

    Until `settle`, columns 0 and 1 are the derivatives by the place of the slider at the start; later by the
    means of u, which move the other way. Only columns from `low` to `high` are computed.

    Attributes
    ----------
    w_x, w_y, turn (unknown,)
        Derivatives of the place of the slider at rest, and of the direction of slip.
    """

    def __init__(self, panel: Panel, sums: PlanarIntegrals, outputs: list[int]) -> None:
        ForceDerivatives.__init__(self, sums, outputs)
        self.panel, self.known = panel, bool(np.all(np.asarray(self.place) >= 0))
        self.w_x, self.w_y, self.u_x, self.u_y, self.r = np.zeros((5, self.unknowns))
        self.rows = 2 + 4 * self.outputs
        self.width = (self.unknowns + 7) // 8 * 8  # whole registers
        self.turn, self.slope = np.zeros(self.width), np.array(self.panel.slopes)[1:, 0].copy()
        self.block, self.gathered = _whole_lines(STAGES, self.width), _whole_lines(self.rows, self.width)
        self.weight = np.zeros((self.rows, STAGES))
        self.low, self.high = 0, self.unknowns

    def fill(self, value: float) -> None:
        """Sets all derivatives to one value, and clears the gathered ones."""
        i: cython.Py_ssize_t
        j: cython.int
        ForceDerivatives.fill(self, value)
        for i in range(self.rows):
            for j in range(self.width):
                self.gathered[i, j] = 0.0

    def take(self, low: cython.int, high: cython.int) -> None:
        """Chooses the columns that are computed, and starts from a slider at rest."""
        j: cython.int
        self.low, self.high = low, high
        for j in range(low):
            self.turn[j] = 0.0
        self.start()

    def start(self) -> None:
        """Sets the derivatives of the slider at the start: unit changes of its own place, 0 for others."""
        j: cython.int
        for j in range(self.low, self.high):
            self.w_x[j] = self.w_y[j] = 0.0
        if self.low == 0:
            self.w_x[0] = self.w_y[1] = 1.0

    def moved(self) -> None:
        """Fills `u_x`, `u_y`, `r`: derivatives of U and R at the angle in SCAN."""
        j: cython.int
        k: cython.int
        c: float
        s: float
        for j in range(self.low, min(self.high, 2)):
            self.u_x[j] = self.u_y[j] = self.r[j] = 0.0
        if self.high < 3:
            return
        self.u_x[2] = self.u_y[2] = 0.0
        self.r[2] = 1.0
        for k in range(self.motion.count):
            c, s = self.panel.motion.cos[SCAN, k], self.panel.motion.sin[SCAN, k]
            j = 3 + 6 * k
            self.u_x[j], self.u_x[j + 1], self.u_y[j + 2], self.u_y[j + 3] = c, -s, c, -s
            self.r[j + 4], self.r[j + 5] = c, -s

    def slide(self, e_x: float, e_y: float) -> None:
        """Derivatives of the slip direction where a stick ends, at the angle in SCAN."""
        j: cython.int
        self.moved()
        by: float = 1.0 / self.panel.motion.value[SCAN, 2]
        for j in range(self.low, self.high):
            self.turn[j] = by * (e_x * (self.u_y[j] - self.w_y[j]) - e_y * (self.u_x[j] - self.w_x[j]))

    def rest(self, e_x: float, e_y: float) -> None:
        """Derivatives of the slider's place where a slip ends, at the angle in SCAN."""
        j: cython.int
        across: float
        self.moved()
        r: float = max(self.panel.motion.value[SCAN, 2], 0.0)
        for j in range(self.low, self.high):
            across = r * self.turn[j]
            self.w_x[j] = self.u_x[j] - self.r[j] * e_x + across * e_y
            self.w_y[j] = self.u_y[j] - self.r[j] * e_y - across * e_x

    def close(self) -> None:
        """Derivatives of the slider's place where the contact closes and sticks, at the angle in SCAN."""
        j: cython.int
        later: float
        self.moved()
        x_1: float = self.panel.motion.value[SCAN, 3]
        y_1: float = self.panel.motion.value[SCAN, 4]
        # the motion is never faster here than the disc grows; otherwise it would not stick
        by: float = max(self.panel.motion.value[SCAN, 5], fabs(x_1), fabs(y_1))
        by = 1.0 / by if by > 0.0 else 0.0
        for j in range(self.low, self.high):
            later = -by * self.r[j]
            self.w_x[j] = self.u_x[j] + x_1 * later
            self.w_y[j] = self.u_y[j] + y_1 * later

    def close_sliding(self, e_x: float, e_y: float, rate: float) -> None:
        """Derivatives of the slip direction where the contact closes and slips, with alpha' = rate."""
        j: cython.int
        k: cython.int
        c: float
        s: float
        order: float
        along: float = e_x * self.panel.motion.value[SCAN, 3] + e_y * self.panel.motion.value[SCAN, 4]
        by: float = 1.0 / along
        for j in range(self.low, self.high):
            self.turn[j] = 0.0
        if self.high < 3:
            return
        self.turn[2] = -by * rate
        for k in range(self.motion.count):
            order = by * self.motion.order[k]
            c, s = self.panel.motion.cos[SCAN, k], self.panel.motion.sin[SCAN, k]
            j = 3 + 6 * k
            self.turn[j], self.turn[j + 1] = e_y * order * s, e_y * order * c
            self.turn[j + 2], self.turn[j + 3] = -e_x * order * s, -e_x * order * c
            self.turn[j + 4], self.turn[j + 5] = -by * rate * c, by * rate * s

    def greatest(self) -> float:
        """Greatest magnitude of a derivative of the slip direction."""
        j: cython.int
        most: float = 0.0
        for j in range(self.low, self.high):
            most = max(most, fabs(self.turn[j]))
        return most

    def rest_of_turns(self) -> float:
        """Greatest truncation error (`Panel.rest`) of the derivatives of t in the panel.

        Where the load is small relative to the motion, an error of the direction fades at once. The
        derivatives then follow the motion, and panels need not resolve what has faded.
        """
        i: cython.int
        j: cython.int
        one: float
        last: float
        most: float = -1.0
        turn_one: float = 0.5 * self.panel.tail[0, 0]
        turn_last: float = 0.5 * self.panel.tail[1, 0]
        self.drive()
        self.panel.tails()
        if cython.compiled:
            most = rest_eight(
                self.panel.tail_before, self.panel.tail_last, turn_one, turn_last, self.panel.before,
                cython.address(self.turn[0]), cython.address(self.block[0, 0]), self.width,
            )  # fmt: skip
        if most >= 0.0:
            return most
        for j in range(self.low, self.high):
            one, last = turn_one * self.turn[j], turn_last * self.turn[j]
            for i in range(STAGES):
                one += self.panel.tail_before[i] * self.block[i, j]
                last += self.panel.tail_last[i] * self.block[i, j]
            most = max(most, fabs(last), self.panel.before * fabs(one))
        return most

    def carry(self, gather: bool) -> None:
        """Carries the derivatives through the panel and, if gather, adds their part of the Jacobian.

        It uses the inverse of the panel's last Newton step.
        """
        by: float = 2.0 / (1.0 + self.panel.tangent[STAGES] * self.panel.tangent[STAGES])
        if not self.panel.driven:
            self.drive()
        if gather:
            self.weigh()
        if not cython.compiled or not carry_eight(
            self.panel.inverse, cython.address(self.block[0, 0]), self.width, self.high,
            cython.address(self.weight[0, 0]), cython.address(self.gathered[0, 0]),
            self.rows if gather else 0, by, cython.address(self.turn[0]),
        ):  # fmt: skip
            self.solve(gather, by)

    def drive(self) -> None:
        """Fills `block`: right sides for the derivatives of t at the nodes, by first direction and motion."""
        i: cython.int
        j: cython.int
        k: cython.int
        self.panel.driven = True
        if cython.compiled and drive_eight(
            cython.address(self.panel.tangent[1]), self.panel.r, cython.address(self.slope[0]),
            cython.address(self.panel.rate[0]), cython.address(self.panel.e_x[0]),
            cython.address(self.panel.e_y[0]), cython.address(self.panel.motion.node_cos[0, 0]),
            cython.address(self.panel.motion.node_sin[0, 0]), cython.address(self.motion.order[0]),
            self.motion.count, cython.address(self.turn[0]), self.width, self.high > 2,
            cython.address(self.block[0, 0]),
        ):  # fmt: skip
            return
        for i in range(STAGES):
            t: float = self.panel.tangent[i + 1]
            part: float = 1.0 + t * t
            from_start: float = -0.5 * self.panel.r[i] * self.slope[i]
            for j in range(self.width):
                self.block[i, j] = from_start * self.turn[j]
            if self.high < 3:
                continue
            of_reach: float = -part * self.panel.rate[i]
            across_x: float = -part * self.panel.e_y[i]
            across_y: float = part * self.panel.e_x[i]
            self.block[i, 2] += of_reach
            for k in range(self.motion.count):
                c: float = self.panel.motion.node_cos[k, i]
                d: float = self.panel.motion.node_sin[k, i]
                j = 3 + 6 * k
                self.block[i, j + 4] += of_reach * c
                self.block[i, j + 5] -= of_reach * d
                c, d = c * self.motion.order[k], d * self.motion.order[k]
                self.block[i, j] -= across_x * d
                self.block[i, j + 1] -= across_x * c
                self.block[i, j + 2] -= across_y * d
                self.block[i, j + 3] -= across_y * c

    def solve(self, gather: bool, by: float) -> None:
        """Sets `turn` at the end of the panel and, if gather, adds the contribution of t at the nodes."""
        i: cython.int
        j: cython.int
        p: cython.int
        for j in range(self.high):
            for i in range(STAGES):
                t: float = 0.0
                for p in range(STAGES):
                    t += self.panel.inverse[STAGES * p + i] * self.block[p, j]
                if i + 1 == STAGES:
                    self.turn[j] = by * t
                if gather:
                    for p in range(self.rows):
                        self.gathered[p, j] += self.weight[p, i] * t

    def weigh(self) -> None:
        """Fills `weight`: factors of the derivatives of t at the nodes in the friction integrals."""
        i: cython.int
        m: cython.int
        row: cython.int
        w: float
        x: float
        y: float
        c: float
        s: float
        if cython.compiled and self.known and weigh_eight(
            cython.address(self.panel.tangent[1]), cython.address(self.panel.weight[0]),
            cython.address(self.panel.speed[0]), cython.address(self.panel.motion.node[2 * STAGES]),
            cython.address(self.panel.e_x[0]), cython.address(self.panel.e_y[0]),
            cython.address(self.panel.motion.node_cos[0, 0]),
            cython.address(self.panel.motion.node_sin[0, 0]),
            cython.address(self.place[0]), self.outputs, 2.0 / PI, cython.address(self.weight[0, 0]),
        ):  # fmt: skip
            return
        for i in range(STAGES):
            t: float = self.panel.tangent[i + 1]
            w = self.panel.weight[i] * self.panel.speed[i] * 2.0 / (1.0 + t * t) / PI
            w *= max(self.panel.motion.node[2 * STAGES + i], 0.0)
            x, y = -w * self.panel.e_y[i], w * self.panel.e_x[i]
            self.weight[0, i], self.weight[1, i] = 0.5 * x, 0.5 * y
            self.integrals.powers(
                0, self.panel.motion.node[6 * STAGES + i], self.panel.motion.node[7 * STAGES + i]
            )
            for m in range(self.outputs):
                c, s = (
                    self.integrals.power_cos[0, self.output[m]],
                    self.integrals.power_sin[0, self.output[m]],
                )
                row = 2 + 4 * m
                self.weight[row, i], self.weight[row + 1, i] = x * c, -x * s
                self.weight[row + 2, i], self.weight[row + 3, i] = y * c, -y * s

    def stick(self, begin: float, end: float) -> None:
        """Subtracts the contribution of the slider's place in a stick from the friction derivatives."""
        j: cython.int
        m: cython.int
        h: cython.int
        row: cython.Py_ssize_t
        c: float = 0.5 / PI * (end - begin)
        s: float
        for j in range(self.low, self.high):
            self.jacobian[0, j] -= c * self.w_x[j]
            self.jacobian[1, j] -= c * self.w_y[j]
        self.integrals.powers(0, cos(begin), sin(begin))
        self.integrals.powers(1, cos(end), sin(end))
        for m in range(self.outputs):
            h = self.output[m]
            row = 3 + 6 * m
            c = (
                (self.integrals.power_sin[1, h] - self.integrals.power_sin[0, h])
                * self.integrals.reciprocal[h]
                / PI
            )
            s = (
                (self.integrals.power_cos[1, h] - self.integrals.power_cos[0, h])
                * self.integrals.reciprocal[h]
                / PI
            )
            for j in range(self.low, self.high):
                self.jacobian[row, j] -= c * self.w_x[j]
                self.jacobian[row + 1, j] -= s * self.w_x[j]
                self.jacobian[row + 2, j] -= c * self.w_y[j]
                self.jacobian[row + 3, j] -= s * self.w_y[j]

    def direct(self) -> None:
        """Adds the derivatives of the forces by motion and load at the same angle."""
        i: cython.int
        for i in range(-1, self.outputs):
            self.add_product(i, 0, STICKS, 0)
            self.add_product(i, 1, STICKS, 1)
            self.add_product(i, 0, SLIPS_X, 2)
            self.add_product(i, 1, SLIPS_Y, 2)
            self.add_product(i, 2, CONTACT, 2)

    def settle(self, kept: bool) -> None:
        """Closes the period, W = P(W_0): the slider's derivatives at the start become those at the end."""
        i: cython.Py_ssize_t
        j: cython.int
        row: cython.Py_ssize_t
        for i in range(self.rows):
            row = i if i < 2 else 3 + 6 * ((i - 2) // 4) + (i - 2) % 4
            for j in range(self.unknowns):
                self.jacobian[row, j] += self.gathered[i, j]
        a: float = 1.0 - self.w_x[0]
        b: float = -self.w_x[1]
        c: float = -self.w_y[0]
        d: float = 1.0 - self.w_y[1]
        by: float = a * d - b * c
        x: float
        y: float
        if kept and by != 0.0:
            for j in range(2, self.unknowns):
                x, y = (d * self.w_x[j] - b * self.w_y[j]) / by, (a * self.w_y[j] - c * self.w_x[j]) / by
                for i in range(self.equations):
                    self.jacobian[i, j] += self.jacobian[i, 0] * x + self.jacobian[i, 1] * y
        for i in range(self.equations):
            self.jacobian[i, 0] = self.jacobian[i, 1] = 0.0
