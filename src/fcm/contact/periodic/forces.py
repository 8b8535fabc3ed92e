"""Kernel: Fourier coefficients of a contact's forces over a steady cycle, and their derivatives.

Over each piece of the cycle the forces are trigonometric polynomials. So all that is needed are the integrals
of exp(-i m theta) over the pieces in which the contact sticks, slips (with the sign of the force) and is
closed. Short sticks are integrated by Gauss's rule instead, from differences since their start: the closed
form would be a difference of nearly equal numbers (`Integrals`).

The derivatives are by the coefficients of the motion. The forces are continuous, so the instants of the
events do not enter; the place where the slider came to rest does. Where an event grazes, a derivative is that
of the side on which it does not occur (`Derivatives`). What other kernels call: see `PeriodicContact`.
"""

from __future__ import annotations

import cython
import numpy as np
from cython.cimports.libc.math import fabs, sin

from fcm.contact.periodic.gauss import gauss

if cython.compiled:
    from cython.cimports.fcm.contact.closed_form import NAN, PI
    from cython.cimports.fcm.contact.contact_kernel import ContactParameters
    from cython.cimports.fcm.contact.periodic.cycle import POSITIVE, SEPARATION, STICK, STUCK, LineCycle
    from cython.cimports.fcm.contact.periodic.motion import (
        CLOSED,
        FORCE,
        LOAD,
        MIXED,
        REACH,
        TWO_PI,
        UNKNOWN,
        LineMotion,
    )
else:
    from fcm.contact.closed_form import NAN, PI
    from fcm.contact.contact_kernel import ContactParameters
    from fcm.contact.periodic.cycle import POSITIVE, SEPARATION, STICK, STUCK, LineCycle
    from fcm.contact.periodic.motion import CLOSED, FORCE, LOAD, MIXED, REACH, TWO_PI, UNKNOWN, LineMotion

# Sets of pieces over which exp(-i m theta) is integrated
STICKS = cython.declare(cython.int, 0)
SIGNED_SLIPS = cython.declare(cython.int, 1)  # positive less negative
CONTACT = cython.declare(cython.int, 2)
LONG = cython.declare(cython.int, 3)  # sticks that are integrated in closed form
# A stick is short up to two radians of the highest harmonic in it: eight points are then exact to rounding.
SHORT = cython.declare(cython.double, 2.0)
POINTS = cython.declare(cython.int, 8)
_GAUSS = gauss(8)  # POINTS of them, on 0 to 1


@cython.cclass
class Integrals:
    """Sums over the pieces of a cycle: integrals of each set of pieces, and of the forces' harmonics."""

    def __init__(self, cycle: LineCycle, most: int) -> None:
        self.cycle = cycle
        self.motion = cycle.motion
        self.most = most
        self.highest = most + self.motion.highest
        self.cos_sum, self.sin_sum = np.zeros((2, 4, self.highest + 1))
        self.power_cos, self.power_sin = np.ones((3, self.highest + 1)), np.zeros((3, self.highest + 1))
        self.stick_re, self.stick_im = np.zeros((2, self.most + 1))
        self.grow_re, self.grow_im = np.zeros((2, self.highest + 1))
        self.total_re, self.total_im = np.zeros((2, self.most + 1))
        self.points, self.weights = _GAUSS
        self.reciprocal = 1.0 / np.maximum(np.arange(self.highest + 1), 1)

    def integrate(self) -> None:
        """Sums the integrals of exp(-i m theta) over the pieces, and the forces of short sticks."""
        m: cython.int
        p: cython.int
        last: cython.int = self.cycle.pieces - 1
        e: cython.int = self.cycle.event[0]
        for m in range(self.highest + 1):
            for p in range(4):
                self.cos_sum[p, m] = self.sin_sum[p, m] = 0.0
        for m in range(self.most + 1):
            self.total_re[m] = self.total_im[m] = 0.0
        self.powers(0, self.cycle.event_cos[e], self.cycle.event_sin[e])
        begin: cython.int = 0
        end: cython.int = 1
        length: float
        for p in range(last + 1):
            if p < last:
                e = self.cycle.event[p + 1]
                self.powers(end, self.cycle.event_cos[e], self.cycle.event_sin[e])
                length = self.cycle.begin[p + 1] - self.cycle.begin[p]
            else:
                end = 2
                e = self.cycle.event[0]
                self.powers(end, self.cycle.event_cos[e], self.cycle.event_sin[e])
                length = self.cycle.begin[0] + TWO_PI - self.cycle.begin[p]
            if self.cycle.state[p] != SEPARATION:
                self.piece(p, begin, end, max(length, 0.0))
            begin, end = end, begin

    def piece(self, p: cython.int, begin: cython.int, end: cython.int, length: float) -> None:
        """Adds a piece in which the contact is closed to the sums of its sets."""
        m: cython.int
        state: cython.int = self.cycle.state[p]
        w: float = self.cycle.rest[p]
        sign: float = 0.0
        long: float = 0.0
        c: float = length
        s: float = 0.0
        if state == STICK:
            if length * self.highest > SHORT:
                long = 1.0
            else:
                self.short_stick(p, begin, length)
        else:
            sign = 1.0 if state == POSITIVE else -1.0
        for m in range(self.highest + 1):
            if m > 0:
                c = (self.power_sin[end, m] - self.power_sin[begin, m]) * self.reciprocal[m]
                s = (self.power_cos[begin, m] - self.power_cos[end, m]) * self.reciprocal[m]
            self.cos_sum[CONTACT, m] += c
            self.sin_sum[CONTACT, m] += s
            if state != STICK:
                self.cos_sum[SIGNED_SLIPS, m] += sign * c
                self.sin_sum[SIGNED_SLIPS, m] += sign * s
                continue
            self.cos_sum[STICKS, m] += c
            self.sin_sum[STICKS, m] += s
            self.cos_sum[LONG, m] += long * c
            self.sin_sum[LONG, m] += long * s
            if m <= self.most:
                self.total_re[m] -= long * w * c
                self.total_im[m] += long * w * s

    def powers(self, into: cython.int, c_1: float, s_1: float) -> None:
        """Fills cos(m theta) and sin(m theta) for all m."""
        m: cython.int
        c: float = 1.0
        s: float = 0.0
        turned: float
        for m in range(1, self.highest + 1):
            turned = c * c_1 - s * s_1
            s = s * c_1 + c * s_1
            c = turned
            self.power_cos[into, m], self.power_sin[into, m] = c, s

    def short_stick(self, p: cython.int, begin: cython.int, length: float) -> None:
        """Adds the integrals of f exp(-i h theta) over a short stick, from f at its beginning."""
        e: cython.int = self.cycle.event[p]
        i: cython.int
        k: cython.int
        m: cython.int
        h: cython.int
        a: float
        b: float
        reach: float = 0.5 * (self.cycle.upper[e] - self.cycle.lower[e])
        start: float = 0.0
        if self.cycle.cause[p] != SEPARATION:
            start = self.cycle.cause[p] * reach
        for m in range(self.most + 1):
            self.stick_re[m] = self.stick_im[m] = 0.0
        for i in range(POINTS):
            y: float = self.points[i] * length
            half: float = sin(0.5 * y)
            f: float = start
            limit: float = reach
            self.grow(-2.0 * half * half, sin(y))
            for k in range(self.motion.moving):
                h = self.motion.number[k]
                a = self.power_cos[begin, h] * self.grow_re[h] - self.power_sin[begin, h] * self.grow_im[h]
                b = self.power_sin[begin, h] * self.grow_re[h] + self.power_cos[begin, h] * self.grow_im[h]
                f += self.motion.re[FORCE, k] * a - self.motion.im[FORCE, k] * b
                limit += self.motion.re[REACH, k] * a - self.motion.im[REACH, k] * b
            # of a load that is tiny beside the motion, a rounding error may put it past the limit
            f = max(-limit, min(f, limit))
            f *= self.weights[i] * length
            for m in range(self.most + 1):
                self.stick_re[m] += f * (1.0 + self.grow_re[m])
                self.stick_im[m] -= f * self.grow_im[m]
        for m in range(self.most + 1):
            a, b = self.power_cos[begin, m], self.power_sin[begin, m]
            self.total_re[m] += self.stick_re[m] * a + self.stick_im[m] * b
            self.total_im[m] += self.stick_im[m] * a - self.stick_re[m] * b

    def grow(self, re: float, im: float) -> None:
        """Fills exp(i m y) - 1 for all m from that of m = 1, each to full relative accuracy."""
        m: cython.int
        a: float = 0.0
        b: float = 0.0
        next_a: float
        for m in range(1, self.highest + 1):
            next_a = a + re + (a * re - b * im)
            b = b + im + (a * im + b * re)
            a = next_a
            self.grow_re[m], self.grow_im[m] = a, b

    def product(self, h: cython.int, which: cython.int, row: cython.int) -> None:
        """Adds to the totals of h the integral of a row times exp(-i h theta) over a set of pieces."""
        k: cython.int
        d: cython.int
        p: cython.int
        a: float
        b: float
        c: float
        s: float
        re: float = self.motion.mean[row] * self.cos_sum[which, h]
        im: float = -self.motion.mean[row] * self.sin_sum[which, h]
        for k in range(self.motion.moving):
            d, p = h - self.motion.number[k], h + self.motion.number[k]
            a, b = 0.5 * self.motion.re[row, k], 0.5 * self.motion.im[row, k]
            if d >= 0:
                c, s = self.cos_sum[which, d], self.sin_sum[which, d]
            else:
                c, s = self.cos_sum[which, -d], -self.sin_sum[which, -d]
            re += a * (c + self.cos_sum[which, p]) + b * (s - self.sin_sum[which, p])
            im += b * (c - self.cos_sum[which, p]) - a * (s + self.sin_sum[which, p])
        self.total_re[h] += re
        self.total_im[h] += im


@cython.cclass
class Derivatives:
    """Builds `jacobian` (force, unknown), in the order of `PeriodicContact`.

    `memory` is the derivatives of one place of rest.
    """

    def __init__(self, integrals: Integrals, outputs: list[int]) -> None:
        self.integrals, self.cycle, self.motion = integrals, integrals.cycle, integrals.motion
        self.output = np.array(outputs, dtype=np.intc)
        self.outputs = len(outputs)
        self.unknowns = 2 + 4 * self.motion.count
        self.jacobian = np.zeros((2 + 4 * self.outputs, self.unknowns))
        self.memory = np.zeros(self.unknowns)

    def fill(self, value: float) -> None:
        """Sets all derivatives to one value."""
        i: cython.Py_ssize_t
        j: cython.int
        for i in range(2 + 4 * self.outputs):
            for j in range(self.unknowns):
                self.jacobian[i, j] = value

    def stick(self) -> None:
        """Sets the derivatives of a contact that never slips."""
        i: cython.int
        k: cython.int
        part: cython.int
        self.jacobian[1, 1] = 1.0
        if self.cycle.cause[0] == 0:
            self.jacobian[0, 0] = 1.0
        else:
            self.gradient(0)
            for i in range(self.unknowns):
                self.jacobian[0, i] = -self.memory[i]
        for k in range(self.motion.count):
            for i in range(self.outputs):
                if self.output[i] == self.motion.number[k]:
                    for part in range(4):
                        self.jacobian[2 + 4 * i + part, 2 + 4 * k + part] = 1.0

    def slip(self) -> None:
        """Sets the derivatives of a contact that slips or opens."""
        i: cython.int
        h: cython.int
        step: cython.int
        row: cython.Py_ssize_t
        factor: float
        for i in range(-1, self.outputs):
            h = self.output[i] if i >= 0 else 0
            row = 2 + 4 * i if i >= 0 else 0
            step = 2 if i >= 0 else 1
            factor = 1.0 / PI if i >= 0 else 0.5 / PI
            self.block(row, 0, step, h, STICKS, factor)
            self.block(row, 1, step, h, SIGNED_SLIPS, factor)
            self.block(row + step, 1, step, h, CONTACT, factor)
        self.remember_all()

    def block(
        self,
        row: cython.Py_ssize_t,
        of_load: cython.int,
        rows: cython.int,
        h: cython.int,
        which: cython.int,
        factor: float,
    ) -> None:
        """Sets the derivatives of one harmonic of a force, in `rows` rows, by all unknowns of u or of v."""
        k: cython.int
        d: cython.int
        p: cython.int
        c: float
        s: float
        cos_p: float
        sin_p: float
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
            cos_p = factor * self.integrals.cos_sum[which, p]
            sin_p = factor * self.integrals.sin_sum[which, p]
            self.jacobian[row, column] = c + cos_p
            self.jacobian[row, column + 1] = s - sin_p
            if rows > 1:
                self.jacobian[row + 1, column] = -s - sin_p
                self.jacobian[row + 1, column + 1] = c - cos_p

    def gradient(self, p: cython.int) -> None:
        """Fills `memory`: derivatives of the slider's resting place in piece p, but for the mean of u.

        After a slip it is that of the limit, where the limit turns. After a separation w = u where the load
        vanishes, and that instant moves by -n_q / n_t.
        """
        e: cython.int = self.cycle.event[p]
        cause: cython.int = self.cycle.cause[p]
        along: float = -1.0 if cause == POSITIVE else 1.0
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
            c: float = self.integrals.power_cos[0, self.motion.number[k]]
            s: float = self.integrals.power_sin[0, self.motion.number[k]]
            self.memory[2 + 4 * k], self.memory[3 + 4 * k] = c, -s
            self.memory[4 + 4 * k], self.memory[5 + 4 * k] = along * c, -along * s

    def remember_all(self) -> None:
        """Subtracts from the force derivatives what the resting places of all sticks contribute."""
        p: cython.int
        for p in range(self.cycle.pieces):
            if self.cycle.state[p] == STICK:
                self.gradient(p)
                self.remember(p)

    def remember(self, p: cython.int) -> None:
        """Subtracts the contribution of one stick; `gradient` has left the powers of its start."""
        i: cython.int
        j: cython.int
        h: cython.int
        row: cython.Py_ssize_t
        next_p: cython.int = p + 1 if p + 1 < self.cycle.pieces else 0
        e: cython.int = self.cycle.event[next_p]
        length: float = self.cycle.begin[next_p] - self.cycle.begin[p]
        re: float
        im: float
        if next_p == 0:
            length += TWO_PI
        self.integrals.powers(1, self.cycle.event_cos[e], self.cycle.event_sin[e])
        for j in range(1, self.unknowns):
            self.jacobian[0, j] -= 0.5 / PI * length * self.memory[j]
        for i in range(self.outputs):
            h = self.output[i]
            row = 2 + 4 * i
            re = self.integrals.power_sin[1, h] - self.integrals.power_sin[0, h]
            im = self.integrals.power_cos[1, h] - self.integrals.power_cos[0, h]
            re, im = re * self.integrals.reciprocal[h] / PI, im * self.integrals.reciprocal[h] / PI
            for j in range(1, self.unknowns):
                self.jacobian[row, j] -= re * self.memory[j]
                self.jacobian[row + 1, j] -= im * self.memory[j]

    def rescale(self, row: cython.int, by_motion: float, by_load: float) -> None:
        """Scales the derivatives of one number by u and by v."""
        k: cython.int
        self.jacobian[row, 0] *= by_motion
        self.jacobian[row, 1] *= by_load
        for k in range(2, self.unknowns, 4):
            self.jacobian[row, k] *= by_motion
            self.jacobian[row, k + 1] *= by_motion
            self.jacobian[row, k + 2] *= by_load
            self.jacobian[row, k + 3] *= by_load


@cython.cclass
class PeriodicContact:
    """Kernel of contacts with given harmonics of their motion and forces, evaluated one after the other.

    Parameters
    ----------
    harmonics, outputs : list of int, each increasing, from 1 on
        Harmonics of the displacements, and of the forces; the mean is always one.

    Notes
    -----
    Unknowns and forces are real numbers in the order

        mean u, mean v, then for each harmonic h:  Re U_h, Im U_h, Re V_h, Im V_h
        mean f, mean n, then for each harmonic h:  Re F_h, Im F_h, Re N_h, Im N_h

    with x(theta) = Re sum X_h exp(i h theta). Other kernels call `evaluate`, which needs no lock, and read
    `forces` and `jacobian`:

        from cython.cimports.fcm.contact.periodic.forces import PeriodicContact

        kernel: PeriodicContact                   # PeriodicContact([1, 2, 3, 9], [1, 2, 3, 9, 10])
        kernel.evaluate(x, first, contact, True)  # ContactParameters(mu, k_u, k_v, n_0)
        stiffness = kernel.jacobian[2, 2]         # d Re F_1 / d Re U_1

    Each thread needs one of its own.
    """

    def __init__(self, harmonics: list[int], outputs: list[int]) -> None:
        self.motion = LineMotion(harmonics)
        self.cycle = LineCycle(self.motion)
        self.integrals = Integrals(self.cycle, max(outputs, default=0))
        self.derivatives = Derivatives(self.integrals, outputs)
        self.output, self.outputs = np.array(outputs, dtype=np.intc), len(outputs)
        self.unknowns, self.equations = 2 + 4 * self.motion.count, 2 + 4 * self.outputs
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
    ) -> None:
        """Fills `forces` (point, equation) of motions (point, unknown), each with mu, k_u, k_v, n_0, start.

        `jacobians` (point, equation, unknown) is filled as well, unless it has no points.
        """
        gradient: cython.bint = jacobians.shape[0] > 0
        i: cython.Py_ssize_t
        j: cython.int
        k: cython.int
        contact: ContactParameters = ContactParameters()
        with cython.nogil:
            for i in range(x.shape[0]):
                contact.take_row(parameters, i)
                self.evaluate(x[i], 0, contact, gradient)
                for j in range(self.equations):
                    forces[i, j] = self.forces[j]
                    if gradient:
                        for k in range(self.unknowns):
                            jacobians[i, j, k] = self.jacobian[j, k]

    def evaluate(
        self, x: cython.double[::1], first: cython.Py_ssize_t, contact: ContactParameters, gradient: bool
    ) -> cython.int:
        """Evaluates the motion x[first:]: `forces`, and if wanted their derivatives in `jacobian`.

        Returns
        -------
        int
            OPEN, STUCK, MIXED; or UNKNOWN where a number is not finite, and then so are the results.
        """
        self.kind = self.cycle.take(x, first, contact)
        nothing: float = NAN if self.kind == UNKNOWN else 0.0
        i: cython.int
        for i in range(self.equations):
            self.forces[i] = nothing
        if self.kind == STUCK:
            self.stick()
        elif self.kind == MIXED:
            self.integrals.integrate()
            self.slip()
        if gradient:
            self.derivatives.fill(nothing)
            if self.kind == STUCK:
                self.derivatives.stick()
            elif self.kind == MIXED:
                self.derivatives.slip()
        if self.kind == STUCK or self.kind == MIXED:
            self.rescale(contact, gradient)
        return self.kind

    def stick(self) -> None:
        """Sets the forces of a sticking contact.

        Its slider rests at the start, or at the extreme of the limit that holds it.
        """
        i: cython.int
        k: cython.int
        row: cython.Py_ssize_t
        self.forces[0] = -self.cycle.rest[0]
        for k in range(self.motion.count):
            for i in range(self.outputs):
                if self.output[i] == self.motion.number[k]:
                    row = 2 + 4 * i
                    self.forces[row] = self.motion.re[FORCE, k]
                    self.forces[row + 1] = self.motion.im[FORCE, k]
        self.press()

    def press(self) -> None:
        """Sets the normal forces of a contact that never opens: those of its motion."""
        i: cython.int
        k: cython.int
        row: cython.Py_ssize_t
        self.forces[1] = self.motion.mean[LOAD]
        for k in range(self.motion.count):
            for i in range(self.outputs):
                if self.output[i] == self.motion.number[k]:
                    row = 4 + 4 * i
                    self.forces[row] = self.motion.re[LOAD, k]
                    self.forces[row + 1] = self.motion.im[LOAD, k]

    def slip(self) -> None:
        """Sets the forces from their integrals; those of short sticks are in the totals already."""
        i: cython.int
        h: cython.int
        row: cython.Py_ssize_t
        opens: cython.bint = self.cycle.behaviour != CLOSED
        for i in range(-1, self.outputs):
            h = self.output[i] if i >= 0 else 0
            self.integrals.product(h, LONG, FORCE)
            self.integrals.product(h, SIGNED_SLIPS, REACH)
            friction_re: float = self.integrals.total_re[h]
            friction_im: float = self.integrals.total_im[h]
            self.integrals.total_re[h] = self.integrals.total_im[h] = 0.0
            if opens:
                self.integrals.product(h, CONTACT, LOAD)
            if i < 0:
                self.forces[0] = 0.5 / PI * friction_re
                self.forces[1] = 0.5 / PI * self.integrals.total_re[h]
            else:
                row = 2 + 4 * i
                self.forces[row], self.forces[row + 1] = friction_re / PI, friction_im / PI
                self.forces[row + 2] = self.integrals.total_re[h] / PI
                self.forces[row + 3] = self.integrals.total_im[h] / PI
        if not opens:
            self.press()

    def rescale(self, contact: ContactParameters, gradient: bool) -> None:
        """Scales the dimensionless forces and derivatives to the units of the arguments."""
        i: cython.int
        part: cython.int
        row: cython.int
        step: cython.int
        for i in range(-1, self.outputs):
            row = 2 + 4 * i if i >= 0 else 0
            step = 2 if i >= 0 else 1
            for part in range(step):
                self.forces[row + part] *= self.motion.scale
                self.forces[row + step + part] *= self.motion.load_scale
                if gradient:
                    self.derivatives.rescale(row + part, contact.k_u, contact.mu * contact.k_v)
                    self.derivatives.rescale(row + step + part, 0.0, contact.k_v)
