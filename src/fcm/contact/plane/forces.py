"""Kernel: Fourier coefficients of the forces of a contact in its plane, and their derivatives.

What other kernels call: see `PlanarContact`.
"""

from __future__ import annotations

import cython
from cython.cimports.libc.math import hypot

if cython.compiled:
    from cython.cimports.fcm.contact.closed_form import NAN, PI
    from cython.cimports.fcm.contact.contact_kernel import (
        CLOSED,
        MIXED,
        STUCK,
        UNKNOWN,
        UNSOLVED,
        ContactKernel,
        ContactParameters,
    )
    from cython.cimports.fcm.contact.plane.cycle import PlanarCycle
    from cython.cimports.fcm.contact.plane.integrals import CONTACT, SLIPS_X, SLIPS_Y, STICKS
    from cython.cimports.fcm.contact.plane.panel import LOAD, REACH, SCAN, STAGES, PlaneMotion, X, Y
else:
    from fcm.contact.closed_form import NAN, PI
    from fcm.contact.contact_kernel import (
        CLOSED,
        MIXED,
        STUCK,
        UNKNOWN,
        UNSOLVED,
        ContactKernel,
        ContactParameters,
    )
    from fcm.contact.plane.cycle import PlanarCycle
    from fcm.contact.plane.integrals import CONTACT, SLIPS_X, SLIPS_Y, STICKS
    from fcm.contact.plane.panel import LOAD, REACH, SCAN, PlaneMotion, X, Y
    from fcm.contact.plane.radau import STAGES

from fcm.contact.plane.options import OPTIONS, PlanarOptions


@cython.cclass
class PlanarContact(ContactKernel):
    """Kernel of contacts in a plane.

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
    """

    def __init__(
        self, harmonics: list[int], outputs: list[int], most_panels: int = 0, options: PlanarOptions = OPTIONS
    ) -> None:
        self.cycle = PlanarCycle(PlaneMotion(harmonics, STAGES, options), outputs, most_panels)
        self.integrals, self.derivatives = self.cycle.slider.integrals, self.cycle.slider.derivatives
        ContactKernel.__init__(self, self.derivatives)

    def evaluate(
        self, x: cython.double[::1], first: cython.Py_ssize_t, contact: ContactParameters, gradient: bool
    ) -> cython.int:
        load: cython.int = self.cycle.motion.load(x, first, contact)
        if load != UNKNOWN and gradient:
            self.motion.moving = self.motion.count
        s_x: float = NAN
        s_y: float = NAN
        if load != UNKNOWN:
            s_x = contact.k_u * contact.start_x / self.motion.scale - self.cycle.motion.mean_x
            s_y = contact.k_u * contact.start_y / self.motion.scale - self.cycle.motion.mean_y
        if not s_x - s_x == s_y - s_y == 0.0:
            load = UNKNOWN
        if gradient:
            self.derivatives.fill(0.0)
        self.kind = self.cycle.solve(load, s_x, s_y, gradient)
        self.behaviour = self.cycle.behaviour
        nothing: float = NAN if self.kind == UNKNOWN or self.kind == UNSOLVED else 0.0
        self.clear(nothing)
        if self.kind == STUCK:
            self.stick()
            if gradient:
                self.stick_gradient(s_x, s_y)
        elif self.kind == MIXED:
            self.integrals.total()
            self.slip()
            if gradient:
                self.derivatives.settle(self.behaviour == CLOSED)
                self.derivatives.direct()
        if self.kind == STUCK or self.kind == MIXED:
            self.rescale()
            if gradient:
                self.derivatives.rescale(contact)
        elif gradient:
            self.derivatives.fill(nothing)
        return self.kind

    def stick(self) -> None:
        """Sets the forces of a contact whose slider rests."""
        self.forces[0], self.forces[1] = -self.cycle.slider.w_x, -self.cycle.slider.w_y
        self.take_waves(0, X)
        self.take_waves(1, Y)
        self.press(LOAD)

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
            self.integrals.product(h, STICKS, X)
            x_re, x_im = (
                self.integrals.re - self.integrals.held_x_re[h],
                self.integrals.im - self.integrals.held_x_im[h],
            )
            self.integrals.product(h, STICKS, Y)
            y_re, y_im = (
                self.integrals.re - self.integrals.held_y_re[h],
                self.integrals.im - self.integrals.held_y_im[h],
            )
            self.integrals.product(h, SLIPS_X, REACH)
            x_re, x_im = x_re + self.integrals.re, x_im + self.integrals.im
            self.integrals.product(h, SLIPS_Y, REACH)
            y_re, y_im = y_re + self.integrals.re, y_im + self.integrals.im
            self.forces[row], self.forces[row + step] = factor * x_re, factor * y_re
            if i >= 0:
                self.forces[row + 1], self.forces[row + 3] = factor * x_im, factor * y_im
            if self.behaviour == CLOSED:
                continue
            self.integrals.product(h, CONTACT, LOAD)
            self.forces[row + 2 * step] = factor * self.integrals.re
            if i >= 0:
                self.forces[row + 5] = factor * self.integrals.im
        if self.behaviour == CLOSED:
            self.press(LOAD)

    def stick_gradient(self, s_x: float, s_y: float) -> None:
        """Sets the derivatives of a contact that never slips."""
        self.derivatives.take(0, self.unknowns)  # a cycle that was sought before may have left fewer
        self.jacobian[2, 2] = 1.0
        self.derivatives.stick_waves()
        if self.cycle.resting.held == 0:
            self.jacobian[0, 0] = self.jacobian[1, 1] = 1.0
        elif self.cycle.resting.held == 1:
            self.held_by_one(s_x, s_y)
        else:
            self.held_by_two()

    def held_by_one(self, s_x: float, s_y: float) -> None:
        """Derivatives where one disc holds the slider, at W = s + (|U - s| - R) e nearest to its start."""
        j: cython.int
        self.cycle.motion.place(SCAN, self.cycle.resting.basis[0, 3])
        self.cycle.motion.bend(SCAN)
        d_x: float = self.cycle.motion.value[SCAN, 0] - s_x
        d_y: float = self.cycle.motion.value[SCAN, 1] - s_y
        d: float = hypot(d_x, d_y)
        e_x: float = d_x / d
        e_y: float = d_y / d
        beyond: float = d - self.cycle.motion.value[SCAN, 2]
        across: float = e_x * self.cycle.motion.value[SCAN, 4] - e_y * self.cycle.motion.value[SCAN, 3]
        bend: float = e_x * self.cycle.motion.value[SCAN, 6] + e_y * self.cycle.motion.value[SCAN, 7]
        bend += across * across / d - self.cycle.motion.value[SCAN, 8]
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
                    self.cycle.motion.sin[SCAN, k] if p % 2 == 0 else self.cycle.motion.cos[SCAN, k]
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
            self.cycle.motion.place(SCAN, self.cycle.resting.basis[i, 3])
            e_x = self.cycle.motion.value[SCAN, 0] - self.cycle.slider.w_x
            e_y = self.cycle.motion.value[SCAN, 1] - self.cycle.slider.w_y
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
