"""Kernel: Fourier coefficients of a contact's forces over a steady cycle, and their derivatives.

Over each piece of the cycle the forces are trigonometric polynomials. So all that is needed are the integrals
of exp(-i m theta) over the pieces in which the contact sticks, slips (with the sign of the force) and is
closed. Short sticks are integrated by Gauss's rule instead, from differences since their start: the closed
form would be a difference of nearly equal numbers (`LineIntegrals`).

The derivatives are by the coefficients of the motion. The forces are continuous, so the instants of the
events do not enter; the place where the slider came to rest does. Where an event grazes, a derivative is that
of the side on which it does not occur (`LineDerivatives`). What other kernels call: see `PeriodicContact`.
"""

from __future__ import annotations

import cython
import numpy as np
from cython.cimports.libc.math import sin

from fcm.contact.periodic.gauss import gauss

if cython.compiled:
    from cython.cimports.fcm.contact.closed_form import NAN, PI
    from cython.cimports.fcm.contact.contact_kernel import (
        CLOSED,
        MIXED,
        STUCK,
        UNKNOWN,
        ContactKernel,
        ContactParameters,
        ForceDerivatives,
        FourierIntegrals,
    )
    from cython.cimports.fcm.contact.periodic.cycle import POSITIVE, SEPARATION, STICK, LineCycle
    from cython.cimports.fcm.contact.periodic.motion import FORCE, LOAD, REACH, LineMotion
else:
    from fcm.contact.closed_form import NAN, PI
    from fcm.contact.contact_kernel import (
        CLOSED,
        MIXED,
        STUCK,
        UNKNOWN,
        ContactKernel,
        ContactParameters,
        ForceDerivatives,
        FourierIntegrals,
    )
    from fcm.contact.periodic.cycle import POSITIVE, SEPARATION, STICK, LineCycle
    from fcm.contact.periodic.motion import FORCE, LOAD, REACH, LineMotion

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
class LineIntegrals(FourierIntegrals):
    """Integrals over the sets of pieces of a cycle; total_re, total_im (h,): of the force in sticks."""

    def __init__(self, cycle: LineCycle, most: int) -> None:
        FourierIntegrals.__init__(self, cycle.motion, most, 4)
        self.cycle = cycle
        self.stick_re, self.stick_im = np.zeros((2, self.most + 1))
        self.grow_re, self.grow_im = np.zeros((2, self.highest + 1))
        self.total_re, self.total_im = np.zeros((2, self.most + 1))
        self.points, self.weights = _GAUSS

    def integrate(self) -> None:
        """Sums the integrals of exp(-i m theta) over the pieces, and the forces of short sticks."""
        m: cython.int
        p: cython.int
        e: cython.int = self.cycle.event[0]
        self.clear()
        for m in range(self.most + 1):
            self.total_re[m] = self.total_im[m] = 0.0
        self.powers(0, self.cycle.event_cos[e], self.cycle.event_sin[e])
        for p in range(self.cycle.pieces):
            e = self.cycle.event[p + 1 if p + 1 < self.cycle.pieces else 0]
            self.powers((p + 1) % 2, self.cycle.event_cos[e], self.cycle.event_sin[e])
            if self.cycle.state[p] != SEPARATION:
                self.piece(p, p % 2, (p + 1) % 2, max(self.cycle.length(p), 0.0))

    def piece(self, p: cython.int, begin: cython.int, end: cython.int, length: float) -> None:
        """Adds a piece in which the contact is closed to the sums of its sets."""
        m: cython.int
        state: cython.int = self.cycle.state[p]
        w: float = self.cycle.rest[p]
        self.add(CONTACT, begin, end, length, 1.0)
        if state != STICK:
            self.add(SIGNED_SLIPS, begin, end, length, 1.0 if state == POSITIVE else -1.0)
            return
        self.add(STICKS, begin, end, length, 1.0)
        if length * self.highest <= SHORT:
            self.short_stick(p, begin, length)
            return
        self.add(LONG, begin, end, length, 1.0)
        self.total_re[0] -= w * length
        for m in range(1, self.most + 1):
            self.total_re[m] -= w * ((self.power_sin[end, m] - self.power_sin[begin, m]) * self.reciprocal[m])
            self.total_im[m] += w * ((self.power_cos[begin, m] - self.power_cos[end, m]) * self.reciprocal[m])

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


@cython.cclass
class LineDerivatives(ForceDerivatives):
    """Derivatives of the forces on a line; `memory` (unknown,) is those of one place of rest."""

    def __init__(self, integrals: LineIntegrals, outputs: list[int]) -> None:
        ForceDerivatives.__init__(self, integrals, outputs)
        self.cycle, self.memory = integrals.cycle, np.zeros(self.unknowns)

    def stick(self) -> None:
        """Sets the derivatives of a contact that never slips."""
        i: cython.int
        self.jacobian[1, 1] = 1.0
        if self.cycle.cause[0] == 0:
            self.jacobian[0, 0] = 1.0
        else:
            self.gradient(0)
            for i in range(self.unknowns):
                self.jacobian[0, i] = -self.memory[i]
        self.stick_waves()

    def slip(self) -> None:
        """Adds the derivatives of a contact that slips or opens."""
        i: cython.int
        p: cython.int
        for i in range(-1, self.outputs):
            self.add_product(i, 0, STICKS, 0)
            self.add_product(i, 0, SIGNED_SLIPS, 1)
            self.add_product(i, 1, CONTACT, 1)
        for p in range(self.cycle.pieces):
            if self.cycle.state[p] == STICK:
                self.gradient(p)
                self.remember(p)

    def gradient(self, p: cython.int) -> None:
        """Fills `memory`: derivatives of the slider's resting place in piece p, but for the mean of u."""
        e: cython.int = self.cycle.event[p]
        along: float = self.cycle.along(p)
        k: cython.int
        self.integrals.powers(0, self.cycle.event_cos[e], self.cycle.event_sin[e])
        self.memory[0], self.memory[1] = 0.0, along
        for k in range(self.motion.count):
            c: float = self.integrals.power_cos[0, self.motion.number[k]]
            s: float = self.integrals.power_sin[0, self.motion.number[k]]
            self.memory[2 + 4 * k], self.memory[3 + 4 * k] = c, -s
            self.memory[4 + 4 * k], self.memory[5 + 4 * k] = along * c, -along * s

    def remember(self, p: cython.int) -> None:
        """Subtracts the contribution of one stick; `gradient` has left the powers of its start."""
        i: cython.int
        j: cython.int
        h: cython.int
        row: cython.Py_ssize_t
        next_p: cython.int = p + 1 if p + 1 < self.cycle.pieces else 0
        e: cython.int = self.cycle.event[next_p]
        re: float
        im: float
        self.integrals.powers(1, self.cycle.event_cos[e], self.cycle.event_sin[e])
        for j in range(1, self.unknowns):
            self.jacobian[0, j] -= 0.5 / PI * self.cycle.length(p) * self.memory[j]
        for i in range(self.outputs):
            h = self.output[i]
            row = 2 + 4 * i
            re = self.integrals.power_sin[1, h] - self.integrals.power_sin[0, h]
            im = self.integrals.power_cos[1, h] - self.integrals.power_cos[0, h]
            re, im = re * self.integrals.reciprocal[h] / PI, im * self.integrals.reciprocal[h] / PI
            for j in range(1, self.unknowns):
                self.jacobian[row, j] -= re * self.memory[j]
                self.jacobian[row + 1, j] -= im * self.memory[j]


@cython.cclass
class PeriodicContact(ContactKernel):
    """Kernel of contacts on a line.

    Parameters
    ----------
    harmonics, outputs : list of int, each increasing, from 1 on
        Harmonics of the displacements, and of the forces; the mean is always one.

    Notes
    -----
    Unknowns and forces are real numbers in the order

        mean u, mean v, then for each harmonic h:  Re U_h, Im U_h, Re V_h, Im V_h
        mean f, mean n, then for each harmonic h:  Re F_h, Im F_h, Re N_h, Im N_h

    Another kernel has the stiffness d Re F_1 / d Re U_1 by

        from cython.cimports.fcm.contact.periodic.forces import PeriodicContact

        kernel: PeriodicContact                   # PeriodicContact([1, 2, 3, 9], [1, 2, 3, 9, 10])
        kernel.evaluate(x, first, contact, True)  # ContactParameters(mu, k_u, k_v, n_0)
        stiffness = kernel.jacobian[2, 2]
    """

    def __init__(self, harmonics: list[int], outputs: list[int]) -> None:
        self.cycle = LineCycle(LineMotion(harmonics))
        self.integrals = LineIntegrals(self.cycle, max(outputs, default=0))
        self.derivatives = LineDerivatives(self.integrals, outputs)
        ContactKernel.__init__(self, self.derivatives)

    def evaluate(
        self, x: cython.double[::1], first: cython.Py_ssize_t, contact: ContactParameters, gradient: bool
    ) -> cython.int:
        self.kind = self.cycle.take(x, first, contact)
        self.behaviour = self.cycle.behaviour
        nothing: float = NAN if self.kind == UNKNOWN else 0.0
        self.clear(nothing)
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
            self.rescale()
            if gradient:
                self.derivatives.rescale(contact)
        return self.kind

    def stick(self) -> None:
        """Sets the forces of a sticking contact.

        Its slider rests at the start, or at the extreme of the limit that holds it.
        """
        self.forces[0] = -self.cycle.rest[0]
        self.take_waves(0, FORCE)
        self.press(LOAD)

    def slip(self) -> None:
        """Sets the forces from their integrals; those of short sticks are in the totals already."""
        i: cython.int
        h: cython.int
        row: cython.Py_ssize_t
        opens: cython.bint = self.behaviour != CLOSED
        for i in range(-1, self.outputs):
            h = self.output[i] if i >= 0 else 0
            self.integrals.product(h, LONG, FORCE)
            re: float = self.integrals.total_re[h] + self.integrals.re
            im: float = self.integrals.total_im[h] + self.integrals.im
            self.integrals.product(h, SIGNED_SLIPS, REACH)
            re, im = re + self.integrals.re, im + self.integrals.im
            self.integrals.re = self.integrals.im = 0.0
            if opens:
                self.integrals.product(h, CONTACT, LOAD)
            if i < 0:
                self.forces[0], self.forces[1] = 0.5 / PI * re, 0.5 / PI * self.integrals.re
            else:
                row = 2 + 4 * i
                self.forces[row], self.forces[row + 1] = re / PI, im / PI
                self.forces[row + 2] = self.integrals.re / PI
                self.forces[row + 3] = self.integrals.im / PI
        if not opens:
            self.press(LOAD)
