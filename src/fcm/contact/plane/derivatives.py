r"""Kernel: derivatives of the forces by the coefficients of the motion, through every piece of the cycle.

The forces are continuous, so the instants of events do not enter their integrals. What the slider remembers
does. With U the motion and xi the derivative of the direction alpha,

    stick:  d W is kept;                          d F = d U - d W
    slip:   R xi' = -(e . U') xi + e_perp . d U' - alpha' d R;   d F = d R e + R xi e_perp

From stick to slip R xi = e_perp . (d U - d W): what is along e is what the disc takes. From slip to stick
d W = d U - d F. Where the contact closes, W = U at an instant that moves by -d R / R'; or, where it slips at
once, the equation of slip has one solution that is finite, (e . U') xi = e_perp . d U' - alpha' d R.
At the end of a period of a contact that never opens, d W is that of the start; what it would be from one kept
fixed, and from its two unit changes, are carried along as columns of their own.
"""

from __future__ import annotations

import cython
import numpy as np
import numpy.typing as npt
from cython.cimports.libc.math import cos, fabs, sin

if cython.compiled:
    from cython.cimports.fcm.contact.plane.derivatives import carry_eight
    from cython.cimports.fcm.contact.plane.motion import SCAN
    from cython.cimports.fcm.contact.plane.panel import STAGES, Panel
    from cython.cimports.fcm.contact.plane.sums import CONTACT, SLIPS_X, SLIPS_Y, STICKS, Sums
else:
    from fcm.contact.plane.motion import SCAN
    from fcm.contact.plane.panel import Panel
    from fcm.contact.plane.radau import STAGES
    from fcm.contact.plane.sums import CONTACT, SLIPS_X, SLIPS_Y, STICKS, Sums

PI = cython.declare(cython.double, 3.141592653589793)


def _whole_lines(rows: int, width: int) -> npt.NDArray[np.float64]:
    """Zeros (rows, width) that begin where a line of the processor's memory does."""
    room = np.zeros(rows * width + 8)
    first = -room.ctypes.data // 8 % 8
    return room[first : first + rows * width].reshape(rows, width)


@cython.cclass
class Derivatives:
    """`jacobian` (force, unknown), in the order of `PlanarContact`, while its rows are made.

    Columns 0 and 1, which are those of the means of u, are of the place of the slider at the start until
    `settle`: that it moves one way is that u moves the other. Only columns from `low` to `high` are made.

    Attributes
    ----------
    w_x, w_y, turn (unknown,)
        Derivatives of the resting slider, and of the direction of slip.
    """

    def __init__(self, panel: Panel, sums: Sums, outputs: list[int]) -> None:
        self.motion, self.panel, self.sums = panel.motion, panel, sums
        self.output, self.outputs = np.array(outputs, dtype=np.intc), len(outputs)
        self.unknowns = 3 + 6 * self.motion.count
        self.jacobian = np.zeros((3 + 6 * self.outputs, self.unknowns))
        self.turn, self.w_x, self.w_y, self.u_x, self.u_y, self.r = np.zeros((6, self.unknowns))
        motion_of = {h: k for k, h in enumerate(np.asarray(self.motion.number).tolist())}
        self.rows = 2 + 4 * self.outputs
        self.width = (self.unknowns + 7) // 8 * 8  # whole registers
        self.block, self.gathered = _whole_lines(STAGES, self.width), _whole_lines(self.rows, self.width)
        # of an output that is a harmonic of the motion, its place among them
        self.place = np.array([motion_of.get(h, -1) for h in outputs], dtype=np.intc)
        self.known = bool(np.all(np.asarray(self.place) >= 0))
        self.weight = np.zeros((self.rows, STAGES))
        self.low, self.high = 0, self.unknowns

    def fill(self, value: float) -> None:
        """All of them the same."""
        i: cython.Py_ssize_t
        j: cython.int
        for i in range(3 + 6 * self.outputs):
            for j in range(self.unknowns):
                self.jacobian[i, j] = value
        for i in range(self.rows):
            for j in range(self.width):
                self.gathered[i, j] = 0.0

    def take(self, low: cython.int, high: cython.int) -> None:
        """The columns that are made, from a slider at rest that nothing has moved."""
        self.low, self.high = low, high
        self.start()

    def start(self) -> None:
        """The slider moves by the two unit changes of its place."""
        j: cython.int
        for j in range(self.low, self.high):
            self.w_x[j] = self.w_y[j] = 0.0
        if self.low == 0:
            self.w_x[0] = self.w_y[1] = 1.0

    def moved(self) -> None:
        """`u_x`, `u_y`, `r`: derivatives of U and R at the angle in SCAN."""
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
            c, s = self.motion.cos[SCAN, k], self.motion.sin[SCAN, k]
            j = 3 + 6 * k
            self.u_x[j], self.u_x[j + 1], self.u_y[j + 2], self.u_y[j + 3] = c, -s, c, -s
            self.r[j + 4], self.r[j + 5] = c, -s

    def slide(self, e_x: float, e_y: float) -> None:
        """A stick that ends at the angle in SCAN, in a direction."""
        j: cython.int
        self.moved()
        by: float = 1.0 / self.motion.value[SCAN, 2]
        for j in range(self.low, self.high):
            self.turn[j] = by * (e_x * (self.u_y[j] - self.w_y[j]) - e_y * (self.u_x[j] - self.w_x[j]))

    def rest(self, e_x: float, e_y: float) -> None:
        """A slip that ends at the angle in SCAN, in a direction."""
        j: cython.int
        across: float
        self.moved()
        r: float = max(self.motion.value[SCAN, 2], 0.0)
        for j in range(self.low, self.high):
            across = r * self.turn[j]
            self.w_x[j] = self.u_x[j] - self.r[j] * e_x + across * e_y
            self.w_y[j] = self.u_y[j] - self.r[j] * e_y - across * e_x

    def close(self) -> None:
        """The contact closes at the angle in SCAN, and sticks."""
        j: cython.int
        later: float
        self.moved()
        x_1: float = self.motion.value[SCAN, 3]
        y_1: float = self.motion.value[SCAN, 4]
        # the motion is never faster here than the disc grows, or it would not stick
        by: float = max(self.motion.value[SCAN, 5], fabs(x_1), fabs(y_1))
        by = 1.0 / by if by > 0.0 else 0.0
        for j in range(self.low, self.high):
            later = -by * self.r[j]
            self.w_x[j] = self.u_x[j] + x_1 * later
            self.w_y[j] = self.u_y[j] + y_1 * later

    def close_sliding(self, e_x: float, e_y: float, rate: float) -> None:
        """The contact closes at the angle in SCAN, and slips, its direction turning at a rate."""
        j: cython.int
        k: cython.int
        c: float
        s: float
        order: float
        along: float = e_x * self.motion.value[SCAN, 3] + e_y * self.motion.value[SCAN, 4]
        by: float = 1.0 / along
        for j in range(self.low, self.high):
            self.turn[j] = 0.0
        if self.high < 3:
            return
        self.turn[2] = -by * rate
        for k in range(self.motion.count):
            order = by * self.motion.order[k]
            c, s = self.motion.cos[SCAN, k], self.motion.sin[SCAN, k]
            j = 3 + 6 * k
            self.turn[j], self.turn[j + 1] = e_y * order * s, e_y * order * c
            self.turn[j + 2], self.turn[j + 3] = -e_x * order * s, -e_x * order * c
            self.turn[j + 4], self.turn[j + 5] = -by * rate * c, by * rate * s

    def greatest(self) -> float:
        """The greatest derivative of the direction."""
        j: cython.int
        most: float = 0.0
        for j in range(self.low, self.high):
            most = max(most, fabs(self.turn[j]))
        return most

    def carry(self, gather: bool) -> None:
        """Through the panel, whose matrix is that of its last step; if wanted their part of the Jacobian."""
        i: cython.int
        j: cython.int
        k: cython.int
        part: float
        from_start: float
        across_x: float
        across_y: float
        of_reach: float
        c: float
        d: float
        for i in range(STAGES):
            t: float = self.panel.tangent[i + 1]
            part = 1.0 + t * t
            from_start = -0.5 * self.panel.r[i] * self.panel.slopes[i + 1, 0]
            for j in range(self.low):
                self.block[i, j] = 0.0
            for j in range(self.low, self.high):
                self.block[i, j] = from_start * self.turn[j]
            if self.high < 3:
                continue
            of_reach = -part * self.panel.rate[i]
            across_x, across_y = -part * self.panel.e_y[i], part * self.panel.e_x[i]
            self.block[i, 2] += of_reach
            for k in range(self.motion.count):
                c, d = self.motion.cos[i + 1, k], self.motion.sin[i + 1, k]
                j = 3 + 6 * k
                self.block[i, j + 4] += of_reach * c
                self.block[i, j + 5] -= of_reach * d
                c, d = c * self.motion.order[k], d * self.motion.order[k]
                self.block[i, j] -= across_x * d
                self.block[i, j + 1] -= across_x * c
                self.block[i, j + 2] -= across_y * d
                self.block[i, j + 3] -= across_y * c
        if gather:
            self.weigh()
        if not cython.compiled or not carry_eight(
            cython.address(self.panel.matrix[0]),
            cython.address(self.block[0, 0]),
            self.width,
            self.high,
            cython.address(self.weight[0, 0]),
            cython.address(self.gathered[0, 0]),
            self.rows if gather else 0,
        ):
            self.solve(gather)
        part = 2.0 / (1.0 + self.panel.tangent[STAGES] * self.panel.tangent[STAGES])
        for j in range(self.low, self.high):
            self.turn[j] = part * self.block[STAGES - 1, j]

    def solve(self, gather: bool) -> None:
        """`block` becomes the derivatives of t at the nodes; if wanted what they add is gathered."""
        i: cython.int
        j: cython.int
        p: cython.int
        by: float
        for i in range(STAGES):
            for p in range(i):
                by = self.panel.matrix[STAGES * i + p]
                for j in range(self.low, self.high):
                    self.block[i, j] -= by * self.block[p, j]
        for i in range(STAGES - 1, -1, -1):
            for p in range(i + 1, STAGES):
                by = self.panel.matrix[STAGES * i + p]
                for j in range(self.low, self.high):
                    self.block[i, j] -= by * self.block[p, j]
            by = self.panel.matrix[STAGES * i + i]
            for j in range(self.low, self.high):
                self.block[i, j] *= by
        if gather:
            for p in range(self.rows):
                for i in range(STAGES):
                    by = self.weight[p, i]
                    for j in range(self.low, self.high):
                        self.gathered[p, j] += by * self.block[i, j]

    def weigh(self) -> None:
        """`weight`: what derivatives of t at the nodes add to R xi e_perp exp(-i h theta), integrated."""
        i: cython.int
        m: cython.int
        row: cython.int
        w: float
        x: float
        y: float
        c: float
        s: float
        for i in range(STAGES):
            t: float = self.panel.tangent[i + 1]
            w = self.panel.weight[i] * self.panel.speed[i] * 2.0 / (1.0 + t * t) / PI
            w *= max(self.motion.value[i + 1, 2], 0.0)
            x, y = -w * self.panel.e_y[i], w * self.panel.e_x[i]
            self.weight[0, i], self.weight[1, i] = 0.5 * x, 0.5 * y
            if not self.known:
                self.sums.powers(0, self.motion.value[i + 1, 9], self.motion.value[i + 1, 10])
            for m in range(self.outputs):
                if self.known:
                    c, s = self.motion.cos[i + 1, self.place[m]], self.motion.sin[i + 1, self.place[m]]
                else:
                    c, s = self.sums.power_cos[0, self.output[m]], self.sums.power_sin[0, self.output[m]]
                row = 2 + 4 * m
                self.weight[row, i], self.weight[row + 1, i] = x * c, -x * s
                self.weight[row + 2, i], self.weight[row + 3, i] = y * c, -y * s

    def stick(self, begin: float, end: float) -> None:
        """Take from the derivatives of the friction what the place of the slider adds to them."""
        j: cython.int
        m: cython.int
        h: cython.int
        row: cython.Py_ssize_t
        c: float = 0.5 / PI * (end - begin)
        s: float
        for j in range(self.low, self.high):
            self.jacobian[0, j] -= c * self.w_x[j]
            self.jacobian[1, j] -= c * self.w_y[j]
        self.sums.powers(0, cos(begin), sin(begin))
        self.sums.powers(1, cos(end), sin(end))
        for m in range(self.outputs):
            h = self.output[m]
            row = 3 + 6 * m
            c = (self.sums.power_sin[1, h] - self.sums.power_sin[0, h]) * self.sums.reciprocal[h] / PI
            s = (self.sums.power_cos[1, h] - self.sums.power_cos[0, h]) * self.sums.reciprocal[h] / PI
            for j in range(self.low, self.high):
                self.jacobian[row, j] -= c * self.w_x[j]
                self.jacobian[row + 1, j] -= s * self.w_x[j]
                self.jacobian[row + 2, j] -= c * self.w_y[j]
                self.jacobian[row + 3, j] -= s * self.w_y[j]

    def direct(self) -> None:
        """Add what the forces have from the motion and the load at the same angle."""
        i: cython.int
        h: cython.int
        rows: cython.int
        row: cython.Py_ssize_t
        factor: float
        for i in range(-1, self.outputs):
            h = self.output[i] if i >= 0 else 0
            row = 3 + 6 * i if i >= 0 else 0
            rows = 2 if i >= 0 else 1
            factor = 1.0 / PI if i >= 0 else 0.5 / PI
            self.row(row, rows, h, STICKS, 0, factor)
            self.row(row + rows, rows, h, STICKS, 1, factor)
            self.row(row, rows, h, SLIPS_X, 2, factor)
            self.row(row + rows, rows, h, SLIPS_Y, 2, factor)
            self.row(row + 2 * rows, rows, h, CONTACT, 2, factor)

    def row(
        self,
        row: cython.Py_ssize_t,
        rows: cython.int,
        h: cython.int,
        which: cython.int,
        part: cython.int,
        factor: float,
    ) -> None:
        """Of one harmonic of a force, in `rows` rows, by all of u_x, u_y or v (parts 0 to 2)."""
        k: cython.int
        d: cython.int
        p: cython.int
        c: float
        s: float
        cos_p: float
        sin_p: float
        column: cython.Py_ssize_t
        if part == 2:
            self.jacobian[row, 2] += factor * self.sums.cos_sum[which, h]
            if rows > 1:
                self.jacobian[row + 1, 2] -= factor * self.sums.sin_sum[which, h]
        factor *= 0.5
        for k in range(self.motion.count):
            d, p = h - self.motion.number[k], h + self.motion.number[k]
            column = 3 + 6 * k + 2 * part
            if d >= 0:
                c, s = factor * self.sums.cos_sum[which, d], factor * self.sums.sin_sum[which, d]
            else:
                c, s = factor * self.sums.cos_sum[which, -d], -factor * self.sums.sin_sum[which, -d]
            cos_p, sin_p = factor * self.sums.cos_sum[which, p], factor * self.sums.sin_sum[which, p]
            self.jacobian[row, column] += c + cos_p
            self.jacobian[row, column + 1] += s - sin_p
            if rows > 1:
                self.jacobian[row + 1, column] -= s + sin_p
                self.jacobian[row + 1, column + 1] += c - cos_p

    def settle(self, kept: bool) -> None:
        """Give the slider at the start the derivatives that it has at the end; W = P(W_0) of a period."""
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
                for i in range(3 + 6 * self.outputs):
                    self.jacobian[i, j] += self.jacobian[i, 0] * x + self.jacobian[i, 1] * y
        for i in range(3 + 6 * self.outputs):
            self.jacobian[i, 0] = self.jacobian[i, 1] = 0.0

    def rescale(self, by_motion: float, by_load: float, load_by_load: float) -> None:
        """All derivatives: of the friction by u and by v, and of the load by v; `w_x`, `w_y` are lost."""
        i: cython.Py_ssize_t
        j: cython.int
        p: cython.int
        for j in range(self.unknowns):  # three means, then six numbers of each harmonic
            p = 2 * j if j < 3 else (j - 3) % 6
            self.w_x[j] = by_load if p >= 4 else by_motion
            self.w_y[j] = load_by_load if p >= 4 else 0.0
        for i in range(3 + 6 * self.outputs):
            p = 2 * i if i < 3 else (i - 3) % 6
            if p < 4:
                for j in range(self.unknowns):
                    self.jacobian[i, j] *= self.w_x[j]
            else:
                for j in range(self.unknowns):
                    self.jacobian[i, j] *= self.w_y[j]
