"""Fourier coefficients of a contact's friction and normal force over a steady cycle, and their derivatives.

The forces are continuous, so the instants of the events do not enter the derivatives; the place where the
slider came to rest does. Where an event grazes, a derivative is that of the side on which it does not occur.
"""

from __future__ import annotations

import cython
import numpy as np
from cython.cimports.libc.math import fabs, isfinite

if cython.compiled:
    from cython.cimports.fcm.contact.periodic.cycle import POSITIVE, SEPARATION, STICK, STUCK, TWO_PI, Cycle
    from cython.cimports.fcm.contact.periodic.integrals import CONTACT, LONG, SLIPS, STICKS, Integrals
    from cython.cimports.fcm.contact.periodic.motion import FORCE, LOAD, MIXED, REACH, UNKNOWN, Motion
else:
    from fcm.contact.periodic.cycle import POSITIVE, SEPARATION, STICK, STUCK, TWO_PI, Cycle
    from fcm.contact.periodic.integrals import CONTACT, LONG, SLIPS, STICKS, Integrals
    from fcm.contact.periodic.motion import FORCE, LOAD, MIXED, REACH, UNKNOWN, Motion

PI = cython.declare(cython.double, 3.141592653589793)
NAN = cython.declare(cython.double, float("nan"))


@cython.cclass
class PeriodicContact:
    """A contact with given harmonics of its motion and of its forces; the workspace of any number of contacts.

    Parameters
    ----------
    harmonics, outputs : list of int, each increasing, from 1 on
        Harmonics of the displacements, and of the forces; the mean is always one.

    Notes
    -----
    Unknowns and forces are real numbers in the order

        mean u, mean v, then for each harmonic h:  Re U_h, Im U_h, Re V_h, Im V_h
        mean f, mean n, then for each harmonic h:  Re F_h, Im F_h, Re N_h, Im N_h

    with x(theta) = Re sum X_h exp(i h theta). `evaluate` is called without the GIL by other kernels.
    """

    def __init__(self, harmonics: list[int], outputs: list[int]) -> None:
        self.motion = Motion(harmonics)
        self.cycle = Cycle(self.motion)
        numbers = np.array(outputs, dtype=np.intc)
        self.output = numbers
        self.outputs = len(outputs)
        self.integrals = Integrals(self.cycle, max(outputs, default=0))
        self.unknowns, self.equations = 2 + 4 * self.motion.count, 2 + 4 * self.outputs
        self.forces = np.zeros(self.equations)
        self.jacobian = np.zeros((self.equations, self.unknowns))
        self.memory = np.zeros(self.unknowns)
        self.kind = UNKNOWN

    def at(
        self,
        x: cython.double[::1],
        mu: cython.double,
        k_u: cython.double,
        k_v: cython.double,
        n_0: cython.double,
        start: cython.double = 0.0,
        derivatives: cython.bint = True,
    ) -> int:
        """`evaluate`, called from Python."""
        return self.evaluate(x, 0, mu, k_u, k_v, n_0, start, derivatives)

    def all(
        self, x: cython.double[:, ::1], parameters: cython.double[:, ::1], forces: cython.double[:, ::1]
    ) -> None:
        """`forces` (point, equation) of many motions (point, unknown); mu, k_u, k_v, n_0 and start of each."""
        i: cython.Py_ssize_t
        j: cython.int
        with cython.nogil:
            for i in range(x.shape[0]):
                self.evaluate(
                    x[i], 0, parameters[i, 0], parameters[i, 1], parameters[i, 2], parameters[i, 3],
                    parameters[i, 4], False,
                )  # fmt: skip
                for j in range(self.equations):
                    forces[i, j] = self.forces[j]

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def evaluate(
        self,
        x: cython.double[::1],
        first: cython.Py_ssize_t,
        mu: cython.double,
        k_u: cython.double,
        k_v: cython.double,
        n_0: cython.double,
        start: cython.double,
        derivatives: cython.bint,
    ) -> cython.int:
        """Forces of the motion x[first:], in `forces`, and if wanted their derivatives, in `jacobian`.

        Parameters
        ----------
        start
            The displacement u at which the contact began unstressed, usually 0. The slider of a contact that
            never slips rests there, unless the limits hold it elsewhere.

        Returns
        -------
        int
            OPEN, STUCK, MIXED; or UNKNOWN where a number is not finite, and then so are the results.
        """
        behaviour: cython.int = self.motion.load(x, first, mu, k_u, k_v, n_0)
        if not isfinite(start):
            behaviour = UNKNOWN
        self.kind = self.cycle.solve(behaviour, k_u * (start - x[first]) / self.motion.scale)
        i: cython.int
        j: cython.int
        for i in range(self.equations):
            self.forces[i] = NAN if self.kind == UNKNOWN else 0.0
            if derivatives:
                for j in range(self.unknowns):
                    self.jacobian[i, j] = NAN if self.kind == UNKNOWN else 0.0
        if self.kind == STUCK:
            self.stuck(derivatives)
        elif self.kind == MIXED:
            self.integrals.integrate()
            self.assemble(derivatives)
            if derivatives:
                self.remember_all()
        if self.kind == STUCK or self.kind == MIXED:
            self.rescale(derivatives, mu, k_u, k_v)
        return self.kind

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def stuck(self, derivatives: cython.bint) -> cython.void:
        """The slider rests; its place is the start's, or the extreme of the limit that holds it."""
        i: cython.int
        k: cython.int
        row: cython.Py_ssize_t
        column: cython.Py_ssize_t
        self.forces[0] = -self.cycle.rest[0]
        self.forces[1] = self.motion.mean[LOAD]
        held: cython.int = self.cycle.cause[0]
        if derivatives:
            self.jacobian[1, 1] = 1.0
            if held == 0:
                self.jacobian[0, 0] = 1.0
            else:
                self.gradient(0)
                for i in range(self.unknowns):
                    self.jacobian[0, i] = -self.memory[i]
        for k in range(self.motion.count):
            for i in range(self.outputs):
                if self.output[i] == self.motion.number[k]:
                    row, column = 2 + 4 * i, 2 + 4 * k
                    self.forces[row] = self.motion.re[FORCE, k]
                    self.forces[row + 1] = self.motion.im[FORCE, k]
                    self.forces[row + 2] = self.motion.re[LOAD, k]
                    self.forces[row + 3] = self.motion.im[LOAD, k]
                    if derivatives:
                        for held in range(4):
                            self.jacobian[row + held, column + held] = 1.0

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def assemble(self, derivatives: cython.bint) -> cython.void:
        """Forces and derivatives from the sums, but for what sticks remember."""
        i: cython.int
        h: cython.int
        row: cython.Py_ssize_t
        factor: cython.double
        for i in range(-1, self.outputs):
            h = self.output[i] if i >= 0 else 0
            row = 2 + 4 * i if i >= 0 else 0
            factor = 1.0 / PI if i >= 0 else 0.5 / PI
            self.integrals.product(h, LONG, FORCE)
            self.integrals.product(h, SLIPS, REACH)
            self.forces[row] = factor * self.integrals.total_re[h]
            if i >= 0:
                self.forces[row + 1] = factor * self.integrals.total_im[h]
            self.integrals.total_re[h] = self.integrals.total_im[h] = 0.0
            self.integrals.product(h, CONTACT, LOAD)
            if i >= 0:
                self.forces[row + 2] = factor * self.integrals.total_re[h]
                self.forces[row + 3] = factor * self.integrals.total_im[h]
            else:
                self.forces[1] = factor * self.integrals.total_re[h]
            if derivatives:
                step: cython.int = 2 if i >= 0 else 1
                self.block(row, 0, step, h, STICKS, factor)
                self.block(row, 1, step, h, SLIPS, factor)
                self.block(row + step, 1, step, h, CONTACT, factor)

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def block(
        self,
        row: cython.Py_ssize_t,
        of_load: cython.int,
        rows: cython.int,
        h: cython.int,
        which: cython.int,
        factor: cython.double,
    ) -> cython.void:
        """Derivatives of one harmonic of a force, in `rows` rows, by all of u or of v."""
        k: cython.int
        d: cython.int
        p: cython.int
        c: cython.double
        s: cython.double
        cos_p: cython.double
        sin_p: cython.double
        column: cython.Py_ssize_t
        if of_load:
            self.jacobian[row, 1] = factor * self.integrals.cos_sum[which, h]
            if rows > 1:
                self.jacobian[row + 1, 1] = -factor * self.integrals.sin_sum[which, h]
        factor *= 0.5
        for k in range(self.motion.count):
            d, p = h - self.motion.number[k], h + self.motion.number[k]
            column = 2 + 4 * k + 2 * of_load
            if d >= 0:
                c, s = factor * self.integrals.cos_sum[which, d], factor * self.integrals.sin_sum[which, d]
            else:
                c, s = factor * self.integrals.cos_sum[which, -d], -factor * self.integrals.sin_sum[which, -d]
            cos_p, sin_p = (
                factor * self.integrals.cos_sum[which, p],
                factor * self.integrals.sin_sum[which, p],
            )
            self.jacobian[row, column] = c + cos_p
            self.jacobian[row, column + 1] = s - sin_p
            if rows > 1:
                self.jacobian[row + 1, column] = -s - sin_p
                self.jacobian[row + 1, column + 1] = c - cos_p

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def gradient(self, p: cython.int) -> cython.void:
        """`memory`: the derivatives of where the slider rests in piece p, without the mean of u.

        After a slip it is that of the limit, where the limit turns. After a separation w = u where the load
        vanishes, and that instant moves by -n_q / n_t.
        """
        e: cython.int = self.cycle.event[p]
        cause: cython.int = self.cycle.cause[p]
        along: cython.double = -1.0 if cause == POSITIVE else 1.0
        k: cython.int
        if cause == SEPARATION:
            # its limits are never steeper than the motion here, or it would not stick
            along = self.motion.ratio * self.cycle.load_rate[e]
            if fabs(self.cycle.motion_rate[e]) < along:
                along = -self.cycle.motion_rate[e] / along
            else:
                along = -1.0 if self.cycle.motion_rate[e] > 0.0 else 1.0
        self.integrals.powers(0, self.cycle.event_cos[e], self.cycle.event_sin[e])
        self.memory[0], self.memory[1] = 0.0, along
        for k in range(self.motion.count):
            c: cython.double = self.integrals.power_cos[0, self.motion.number[k]]
            s: cython.double = self.integrals.power_sin[0, self.motion.number[k]]
            self.memory[2 + 4 * k], self.memory[3 + 4 * k] = c, -s
            self.memory[4 + 4 * k], self.memory[5 + 4 * k] = along * c, -along * s

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def remember_all(self) -> cython.void:
        """Take from the derivatives of the forces what the resting places of the slider add to them."""
        p: cython.int
        for p in range(self.cycle.pieces):
            if self.cycle.state[p] == STICK:
                self.gradient(p)
                self.remember(p)

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def remember(self, p: cython.int) -> cython.void:
        """The part of one stick; `gradient` has left the powers of its start."""
        i: cython.int
        j: cython.int
        h: cython.int
        row: cython.Py_ssize_t
        next_p: cython.int = p + 1 if p + 1 < self.cycle.pieces else 0
        e: cython.int = self.cycle.event[next_p]
        length: cython.double = self.cycle.begin[next_p] - self.cycle.begin[p]
        re: cython.double
        im: cython.double
        if next_p == 0:
            length += TWO_PI
        self.integrals.powers(1, self.cycle.event_cos[e], self.cycle.event_sin[e])
        for j in range(1, self.unknowns):
            self.jacobian[0, j] -= 0.5 / PI * length * self.memory[j]
        for i in range(self.outputs):
            h = self.output[i]
            row = 2 + 4 * i
            re = (
                (self.integrals.power_sin[1, h] - self.integrals.power_sin[0, h])
                * self.integrals.reciprocal[h]
                / PI
            )
            im = (
                (self.integrals.power_cos[1, h] - self.integrals.power_cos[0, h])
                * self.integrals.reciprocal[h]
                / PI
            )
            for j in range(1, self.unknowns):
                self.jacobian[row, j] -= re * self.memory[j]
                self.jacobian[row + 1, j] -= im * self.memory[j]

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def rescale(
        self,
        derivatives: cython.bint,
        mu: cython.double,
        k_u: cython.double,
        k_v: cython.double,
    ) -> cython.void:
        """From forces divided by the greatest amplitude, and derivatives by forces, to those asked for."""
        i: cython.int
        for i in range(-1, self.outputs):
            row: cython.int = 2 + 4 * i if i >= 0 else 0
            step: cython.int = 2 if i >= 0 else 1
            part: cython.int
            for part in range(step):
                self.forces[row + part] *= self.motion.scale
                self.forces[row + step + part] *= self.motion.load_scale
                if derivatives:
                    self.rescale_row(row + part, k_u, mu * k_v)
                    self.rescale_row(row + step + part, 0.0, k_v)

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def rescale_row(self, row: cython.int, by_motion: cython.double, by_load: cython.double) -> cython.void:
        """Derivatives of one number by u and by v."""
        k: cython.int
        self.jacobian[row, 0] *= by_motion
        self.jacobian[row, 1] *= by_load
        for k in range(2, self.unknowns, 4):
            self.jacobian[row, k] *= by_motion
            self.jacobian[row, k + 1] *= by_motion
            self.jacobian[row, k + 2] *= by_load
            self.jacobian[row, k + 3] *= by_load
