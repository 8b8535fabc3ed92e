"""Kernel: Fourier coefficients of the forces of a contact in its plane, and their derivatives.

What other kernels call: see `PlanarContact`.
"""

from __future__ import annotations

import cython
import numpy as np
from cython.cimports.libc.math import hypot

if cython.compiled:
    from cython.cimports.fcm.contact.closed_form import NAN, PI
    from cython.cimports.fcm.contact.contact_kernel import ContactParameters
    from cython.cimports.fcm.contact.periodic.motion import CLOSED, MIXED, UNKNOWN
    from cython.cimports.fcm.contact.plane.cycle import STUCK, UNSOLVED, PlanarCycle
    from cython.cimports.fcm.contact.plane.integrals import CONTACT, SLIPS_X, SLIPS_Y, STICKS
    from cython.cimports.fcm.contact.plane.panel import LOAD, REACH, SCAN, STAGES, PlaneMotion, X, Y
else:
    from fcm.contact.closed_form import NAN, PI
    from fcm.contact.contact_kernel import ContactParameters
    from fcm.contact.periodic.motion import CLOSED, MIXED, UNKNOWN
    from fcm.contact.plane.cycle import STUCK, UNSOLVED, PlanarCycle
    from fcm.contact.plane.integrals import CONTACT, SLIPS_X, SLIPS_Y, STICKS
    from fcm.contact.plane.panel import LOAD, REACH, SCAN, PlaneMotion, X, Y
    from fcm.contact.plane.radau import STAGES

from fcm.contact.plane.options import OPTIONS, PlanarOptions


@cython.cclass
class PlanarContact:
    """Kernel of contacts in a plane with given harmonics of motion and forces, one after the other.

    Parameters
    ----------
    harmonics, outputs : list of int, each increasing, from 1 on
        Harmonics of the displacements, and of the forces; the mean is always one.
    most_panels : int
        How many panels of slip are recorded, for a loop.
    options : PlanarOptions, optional
        How exactly the motion is followed.

    Notes
    -----
    Unknowns and forces are real numbers in the order

        mean u_x, u_y, v, then for each harmonic h:  Re and Im of U_x, then of U_y, then of V
        mean f_x, f_y, n, then for each harmonic h:  Re and Im of F_x, then of F_y, then of N

    with x(theta) = Re sum X_h exp(i h theta). Other kernels call `evaluate`, which needs no lock, and read
    `forces` and `jacobian`. Each thread needs one of its own.
    """

    def __init__(
        self, harmonics: list[int], outputs: list[int], most_panels: int = 0, options: PlanarOptions = OPTIONS
    ) -> None:
        self.motion = PlaneMotion(harmonics, STAGES, options)
        self.cycle = PlanarCycle(self.motion, outputs, most_panels)
        self.sums, self.derivatives = self.cycle.slider.sums, self.cycle.slider.derivatives
        self.output, self.outputs = np.array(outputs, dtype=np.intc), len(outputs)
        self.unknowns, self.equations = 3 + 6 * self.motion.count, 3 + 6 * self.outputs
        self.forces, self.jacobian = np.zeros(self.equations), self.derivatives.jacobian
        self.kind = UNKNOWN

    def at(self, x: cython.double[::1], contact: ContactParameters, gradient: bool = True) -> int:
        """Calls `evaluate` from Python."""
        kind: int = self.evaluate(x, 0, contact, gradient)
        return kind

    def all(
        self,
        x: cython.double[:, ::1],
        parameters: cython.double[:, ::1],
        forces: cython.double[:, ::1],
        jacobians: cython.double[:, :, ::1],
    ) -> int:
        """Fills `forces` (point, equation) of motions (point, unknown), with mu, k_u, k_v, n_0, start_x,
        start_y.

        `jacobians` (point, equation, unknown) is filled as well, unless it has no points. Returns the number
        of a point without a steady cycle, or -1.
        """
        gradient: cython.bint = jacobians.shape[0] > 0
        i: cython.Py_ssize_t
        j: cython.int
        k: cython.int
        unsolved: cython.Py_ssize_t = -1
        contact: ContactParameters = ContactParameters()
        with cython.nogil:
            for i in range(x.shape[0]):
                contact.take_row(parameters, i)
                if self.evaluate(x[i], 0, contact, gradient) == UNSOLVED:
                    unsolved = i
                for j in range(self.equations):
                    forces[i, j] = self.forces[j]
                    if gradient:
                        for k in range(self.unknowns):
                            jacobians[i, j, k] = self.jacobian[j, k]
        found: int = unsolved
        return found

    def evaluate(
        self, x: cython.double[::1], first: cython.Py_ssize_t, contact: ContactParameters, gradient: bool
    ) -> cython.int:
        """Evaluates the motion x[first:]: `forces`, and if wanted their derivatives in `jacobian`.

        Returns
        -------
        int
            OPEN, STUCK, MIXED; UNKNOWN where a number is not finite, and then so are the results; or UNSOLVED
            where no steady cycle was found, and then they are not finite either.
        """
        behaviour: cython.int = self.motion.load(x, first, contact)
        if behaviour != UNKNOWN and gradient:
            self.motion.moving = self.motion.count
        s_x: float = NAN
        s_y: float = NAN
        if behaviour != UNKNOWN:
            s_x = contact.k_u * contact.start_x / self.motion.scale - self.motion.mean_x
            s_y = contact.k_u * contact.start_y / self.motion.scale - self.motion.mean_y
        if not s_x - s_x == s_y - s_y == 0.0:
            behaviour = UNKNOWN
        if gradient:
            self.derivatives.fill(0.0)
        self.kind = self.cycle.solve(behaviour, s_x, s_y, gradient)
        nothing: float = NAN if self.kind == UNKNOWN or self.kind == UNSOLVED else 0.0
        i: cython.int
        for i in range(self.equations):
            self.forces[i] = nothing
        if self.kind == STUCK:
            self.stick()
            if gradient:
                self.stick_gradient(s_x, s_y)
        elif self.kind == MIXED:
            self.sums.total()
            self.slip()
            if gradient:
                self.derivatives.settle(self.cycle.behaviour == CLOSED)
                self.derivatives.direct()
        if self.kind == STUCK or self.kind == MIXED:
            self.rescale(contact, gradient)
        elif gradient:
            self.derivatives.fill(nothing)
        return self.kind

    def stick(self) -> None:
        """Sets the forces of a contact whose slider rests."""
        i: cython.int
        k: cython.int
        row: cython.Py_ssize_t
        self.forces[0], self.forces[1] = -self.cycle.slider.w_x, -self.cycle.slider.w_y
        self.press()
        for k in range(self.motion.count):
            for i in range(self.outputs):
                if self.output[i] == self.motion.number[k]:
                    row = 3 + 6 * i
                    self.forces[row], self.forces[row + 1] = self.motion.re[X, k], self.motion.im[X, k]
                    self.forces[row + 2], self.forces[row + 3] = self.motion.re[Y, k], self.motion.im[Y, k]

    def slip(self) -> None:
        """Sets the forces from their integrals."""
        i: cython.int
        h: cython.int
        row: cython.int
        step: cython.int
        factor: float
        x_re: float
        x_im: float
        y_re: float
        y_im: float
        for i in range(-1, self.outputs):
            h = self.output[i] if i >= 0 else 0
            row = 3 + 6 * i if i >= 0 else 0
            step = 2 if i >= 0 else 1
            factor = 1.0 / PI if i >= 0 else 0.5 / PI
            self.sums.product(h, STICKS, X)
            x_re, x_im = self.sums.re - self.sums.held_x_re[h], self.sums.im - self.sums.held_x_im[h]
            self.sums.product(h, STICKS, Y)
            y_re, y_im = self.sums.re - self.sums.held_y_re[h], self.sums.im - self.sums.held_y_im[h]
            self.sums.product(h, SLIPS_X, REACH)
            x_re, x_im = x_re + self.sums.re, x_im + self.sums.im
            self.sums.product(h, SLIPS_Y, REACH)
            y_re, y_im = y_re + self.sums.re, y_im + self.sums.im
            self.forces[row], self.forces[row + step] = factor * x_re, factor * y_re
            if i >= 0:
                self.forces[row + 1], self.forces[row + 3] = factor * x_im, factor * y_im
            if self.cycle.behaviour == CLOSED:
                continue
            self.sums.product(h, CONTACT, LOAD)
            self.forces[row + 2 * step] = factor * self.sums.re
            if i >= 0:
                self.forces[row + 5] = factor * self.sums.im
        if self.cycle.behaviour == CLOSED:
            self.press()

    def press(self) -> None:
        """Sets the normal force of a contact that never opens, which is that of its motion alone."""
        i: cython.int
        k: cython.int
        self.forces[2] = self.motion.mean[LOAD]
        for k in range(self.motion.count):
            for i in range(self.outputs):
                if self.output[i] == self.motion.number[k]:
                    self.forces[7 + 6 * i] = self.motion.re[LOAD, k]
                    self.forces[8 + 6 * i] = self.motion.im[LOAD, k]

    def stick_gradient(self, s_x: float, s_y: float) -> None:
        """Sets the derivatives of a contact that never slips."""
        i: cython.int
        k: cython.int
        p: cython.int
        self.derivatives.take(0, self.unknowns)  # a cycle that was sought before may have left fewer
        self.jacobian[2, 2] = 1.0
        for k in range(self.motion.count):
            for i in range(self.outputs):
                if self.output[i] == self.motion.number[k]:
                    for p in range(6):
                        self.jacobian[3 + 6 * i + p, 3 + 6 * k + p] = 1.0
        if self.cycle.resting.held == 0:
            self.jacobian[0, 0] = self.jacobian[1, 1] = 1.0
        elif self.cycle.resting.held == 1:
            self.held_by_one(s_x, s_y)
        else:
            self.held_by_two()

    def held_by_one(self, s_x: float, s_y: float) -> None:
        """Derivatives where one disc holds the slider, at W = s + (|U - s| - R) e nearest to its start."""
        j: cython.int
        self.motion.place(SCAN, self.cycle.resting.basis[0, 3])
        self.motion.bend(SCAN)
        d_x: float = self.motion.value[SCAN, 0] - s_x
        d_y: float = self.motion.value[SCAN, 1] - s_y
        d: float = hypot(d_x, d_y)
        e_x: float = d_x / d
        e_y: float = d_y / d
        beyond: float = d - self.motion.value[SCAN, 2]
        across: float = e_x * self.motion.value[SCAN, 4] - e_y * self.motion.value[SCAN, 3]
        bend: float = e_x * self.motion.value[SCAN, 6] + e_y * self.motion.value[SCAN, 7]
        bend += across * across / d - self.motion.value[SCAN, 8]
        later: float = -1.0 / bend if bend < 0.0 else 0.0
        self.derivatives.moved()
        for j in range(self.unknowns):
            u_x: float = self.derivatives.u_x[j]
            u_y: float = self.derivatives.u_y[j]
            r: float = self.derivatives.r[j]
            if j < 2:  # of the mean of u: the start moves the other way
                u_x, u_y = (1.0, 0.0) if j == 0 else (0.0, 1.0)
            x_1: float = 0.0
            y_1: float = 0.0
            r_1: float = 0.0
            if j >= 3:
                k: cython.int = (j - 3) // 6
                p: cython.int = (j - 3) % 6
                # the derivative of cos is -h sin, that of -sin is -h cos
                rate: float = -self.motion.order[k] * (
                    self.motion.sin[SCAN, k] if p % 2 == 0 else self.motion.cos[SCAN, k]
                )
                if p < 2:
                    x_1 = rate
                elif p < 4:
                    y_1 = rate
                else:
                    r_1 = rate
            turn: float = (e_x * u_y - e_y * u_x) / d
            shift: float = later * (e_x * x_1 + e_y * y_1 - r_1 + turn * across)
            gap: float = e_x * u_x + e_y * u_y - r
            turn += shift * across / d
            w_x: float = gap * e_x - beyond * turn * e_y
            w_y: float = gap * e_y + beyond * turn * e_x
            if j == 0:
                w_x -= 1.0
            elif j == 1:
                w_y -= 1.0
            self.jacobian[0, j], self.jacobian[1, j] = -w_x, -w_y

    def held_by_two(self) -> None:
        """Derivatives where the slider rests where two circles meet: e . (d U - d W) = d R of both."""
        i: cython.int
        j: cython.int
        x: float
        e_x: float
        e_y: float
        det: float = 0.0
        a: float = 0.0
        b: float = 0.0
        for i in range(2):
            self.motion.place(SCAN, self.cycle.resting.basis[i, 3])
            e_x = self.motion.value[SCAN, 0] - self.cycle.slider.w_x
            e_y = self.motion.value[SCAN, 1] - self.cycle.slider.w_y
            x = hypot(e_x, e_y)
            e_x, e_y = e_x / x, e_y / x
            self.derivatives.moved()
            if i == 0:
                a, b = e_x, e_y
                for j in range(2, self.unknowns):
                    self.derivatives.turn[j] = (
                        e_x * self.derivatives.u_x[j] + e_y * self.derivatives.u_y[j] - self.derivatives.r[j]
                    )
                continue
            det = a * e_y - b * e_x
            det = 1.0 / det if det != 0.0 else 0.0
            for j in range(2, self.unknowns):
                x = e_x * self.derivatives.u_x[j] + e_y * self.derivatives.u_y[j] - self.derivatives.r[j]
                self.jacobian[0, j] = det * (b * x - e_y * self.derivatives.turn[j])
                self.jacobian[1, j] = det * (e_x * self.derivatives.turn[j] - a * x)

    def rescale(self, contact: ContactParameters, gradient: bool) -> None:
        """Scales the dimensionless forces and derivatives to the units of the arguments."""
        i: cython.int
        p: cython.int
        row: cython.int
        step: cython.int
        for i in range(-1, self.outputs):
            row = 3 + 6 * i if i >= 0 else 0
            step = 2 if i >= 0 else 1
            for p in range(step):
                self.forces[row + p] *= self.motion.scale
                self.forces[row + step + p] *= self.motion.scale
                self.forces[row + 2 * step + p] *= self.motion.load_scale
        if gradient:
            self.derivatives.rescale(contact.k_u, contact.mu * contact.k_v, contact.k_v)
