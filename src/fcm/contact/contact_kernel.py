"""Kernel: base classes of the kernels of contacts on a line and in a plane.

A contact slides along one direction or two; its last direction is its normal. Unknowns and forces are real
numbers in the same order: the means along all directions, then for each harmonic h the Re and Im along each
direction, with x(theta) = Re sum X_h exp(i h theta).

Over a cycle the forces are rows of a motion, which are trigonometric polynomials, times functions of the
angle such as 1 while the contact sticks. So their coefficients, and the derivatives of these by the motion's
coefficients, need only the integrals of these functions times exp(-i m theta) (`FourierIntegrals`).
"""

from __future__ import annotations

import cython
import numpy as np
from cython.cimports.libc.math import fabs, isfinite

if cython.compiled:
    from cython.cimports.fcm.contact.closed_form import PI
else:
    from fcm.contact.closed_form import PI

# Behaviour of a contact over a cycle
OPEN = cython.declare(cython.int, 0)
CLOSED = cython.declare(cython.int, 1)  # by its load; it may slip
MIXED = cython.declare(cython.int, 2)  # its load opens and closes; for a whole cycle: any other behaviour
UNKNOWN = cython.declare(cython.int, 3)  # an argument is not finite
STUCK = cython.declare(cython.int, 4)
UNSOLVED = cython.declare(cython.int, 5)  # no steady cycle was found

# Doubles end at 1e-308: scales are at least SMALLEST, and SMALLEST_SHARE of the mean
SMALLEST = cython.declare(cython.double, 1e-290)
SMALLEST_SHARE = cython.declare(cython.double, 1e-150)


@cython.cclass
class ContactParameters:
    """Parameters of a contact: mu [-], k_u, k_v [force / length], preload n_0 [force].

    start_x, start_y: tangential displacement at which the contact began unstressed [length], usually 0. The
    slider of a contact that never slips rests there, or as near as the slip limits permit. On a line start_y
    is 0.
    """

    def __init__(
        self,
        mu: float = 0.0,
        k_u: float = 0.0,
        k_v: float = 0.0,
        n_0: float = 0.0,
        start_x: float = 0.0,
        start_y: float = 0.0,
    ) -> None:
        self.mu, self.k_u, self.k_v, self.n_0 = mu, k_u, k_v, n_0
        self.start_x, self.start_y = start_x, start_y

    def take_row(self, table: cython.double[:, ::1], i: cython.Py_ssize_t) -> None:
        """Takes row i of (contact, 4 to 6): mu, k_u, k_v, n_0, start_x, start_y; missing ones are 0."""
        self.mu, self.k_u = float(table[i, 0]), float(table[i, 1])
        self.k_v, self.n_0 = float(table[i, 2]), float(table[i, 3])
        self.start_x = float(table[i, 4]) if table.shape[1] > 4 else 0.0
        self.start_y = float(table[i, 5]) if table.shape[1] > 5 else 0.0

    def take(self, other: ContactParameters) -> None:
        """Takes the parameters of another contact."""
        self.mu, self.k_u, self.k_v, self.n_0 = other.mu, other.k_u, other.k_v, other.n_0
        self.start_x, self.start_y = other.start_x, other.start_y

    def equals(self, other: ContactParameters) -> bool:
        """Whether all parameters equal those of another contact."""
        if not (self.mu == other.mu and self.k_u == other.k_u and self.k_v == other.k_v):
            return False
        return self.n_0 == other.n_0 and self.start_x == other.start_x and self.start_y == other.start_y


@cython.cclass
class HarmonicMotion:
    """Rows of trigonometric polynomials: displacements, load and slip limits with given harmonics.

    Attributes
    ----------
    number, order (harmonic,)
        The harmonics, as integers and as floats; `highest` is the last.
    moving
        Number of harmonics up to the last one that is not zero.
    mean (row,), re, im (row, harmonic)
        The coefficients, of forces divided by their scale.
    scale, load_scale, ratio, preload
        Scale of forces due to u, and of those due to v; mu load_scale / scale; the mean load [force].
    """

    def __init__(self, harmonics: list[int], directions: int, rows: int) -> None:
        numbers, self.count = np.array(harmonics, dtype=np.intc), len(harmonics)
        self.number, self.order = numbers, numbers.astype(np.float64)
        self.highest, self.directions, self.moving = max(harmonics, default=0), directions, 0
        self.re, self.im = np.zeros((2, rows, max(self.count, 1)))
        self.mean = np.zeros(rows)
        self.scale = self.load_scale = self.ratio = self.preload = 0.0

    def measure(self, x: cython.double[::1], first: cython.Py_ssize_t, contact: ContactParameters) -> bool:
        """Sets `moving` and all scales for the motion x[first:]; False if a number is not finite."""
        k: cython.int
        p: cython.int
        along: cython.int = 2 * self.directions - 2
        i: cython.Py_ssize_t = first + self.directions
        size: float
        motion: float = 0.0
        variation: float = 0.0
        mean: float = 0.0
        self.moving = 0
        for k in range(self.count):
            for p in range(along + 2):
                size = fabs(x[i + p])
                if not isfinite(size):
                    return False
                if size != 0.0:
                    self.moving = k + 1
                if p < along:
                    motion = max(motion, size)
                else:
                    variation = max(variation, size)
            i += along + 2
        for p in range(self.directions - 1):
            if not isfinite(x[first + p]):
                return False
            mean = max(mean, fabs(x[first + p]))
        if not (isfinite(x[first + self.directions - 1]) and isfinite(contact.n_0) and isfinite(contact.mu)):
            return False
        self.preload = contact.n_0 + contact.k_v * float(x[first + self.directions - 1])
        self.load_scale = max(contact.k_v * variation, SMALLEST_SHARE * fabs(self.preload), SMALLEST)
        self.scale = max(
            contact.k_u * motion, contact.mu * self.load_scale, SMALLEST_SHARE * contact.k_u * mean, SMALLEST
        )
        self.ratio = contact.mu * (self.load_scale / self.scale) if contact.mu > 0.0 else 0.0
        return bool(
            isfinite(self.scale)
            and isfinite(self.preload)
            and isfinite(contact.k_u)
            and isfinite(contact.k_v)
        )


@cython.cclass
class FourierIntegrals:
    """Integrals over a cycle of functions of the angle times exp(-i m theta).

    Attributes
    ----------
    most, highest
        The greatest harmonic of the forces, and the greatest m: the sum of `most` and the motion's highest.
    cos_sum, sin_sum (function, m)
        Integrals of the functions times cos(m theta) and sin(m theta).
    power_cos, power_sin (slot, m)
        cos(m theta) and sin(m theta) at some angles.
    re, im
        The integral that `product` computed.
    """

    def __init__(self, motion: HarmonicMotion, most: int, functions: int) -> None:
        self.motion, self.most = motion, most
        self.highest = most + motion.highest
        self.cos_sum, self.sin_sum = np.zeros((2, functions, self.highest + 1))
        self.power_cos, self.power_sin = np.ones((2, self.highest + 1)), np.zeros((2, self.highest + 1))
        self.reciprocal = 1.0 / np.maximum(np.arange(self.highest + 1), 1)
        self.re = self.im = 0.0

    def clear(self) -> None:
        """Sets all integrals to zero."""
        m: cython.int
        p: cython.Py_ssize_t
        for p in range(self.cos_sum.shape[0]):
            for m in range(self.highest + 1):
                self.cos_sum[p, m] = self.sin_sum[p, m] = 0.0

    def powers(self, slot: cython.int, c_1: float, s_1: float) -> None:
        """Fills cos(m theta) and sin(m theta) for all m, from those of theta, into one slot."""
        m: cython.int
        c: float = 1.0
        s: float = 0.0
        turned: float
        for m in range(1, self.highest + 1):
            turned = c * c_1 - s * s_1
            s = s * c_1 + c * s_1
            c = turned
            self.power_cos[slot, m], self.power_sin[slot, m] = c, s

    def add(self, which: cython.int, begin: cython.int, end: cython.int, length: float, value: float) -> None:
        """Adds an interval, between the angles of two slots, in which a function has a constant value."""
        m: cython.int
        self.cos_sum[which, 0] += value * length
        for m in range(1, self.highest + 1):
            c: float = (self.power_sin[end, m] - self.power_sin[begin, m]) * self.reciprocal[m]
            s: float = (self.power_cos[begin, m] - self.power_cos[end, m]) * self.reciprocal[m]
            self.cos_sum[which, m] += value * c
            self.sin_sum[which, m] += value * s

    def product(self, h: cython.int, which: cython.int, row: cython.int) -> None:
        """Sets `re`, `im`: the integral of a row of the motion times a function times exp(-i h theta)."""
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
        self.re, self.im = re, im


@cython.cclass
class ForceDerivatives:
    """Derivatives of forces by the unknowns of a motion, `jacobian` (force, unknown).

    place (output,): number of the motion's harmonic that equals an output, or -1.
    """

    def __init__(self, integrals: FourierIntegrals, outputs: list[int]) -> None:
        self.integrals, self.motion, d = integrals, integrals.motion, integrals.motion.directions
        self.output, self.outputs = np.array(outputs, dtype=np.intc), len(outputs)
        motion_of = {h: k for k, h in enumerate(np.asarray(self.motion.number).tolist())}
        self.place = np.array([motion_of.get(h, -1) for h in outputs], dtype=np.intc)
        self.unknowns, self.equations = (d + 2 * d * count for count in (self.motion.count, self.outputs))
        self.jacobian = np.zeros((self.equations, self.unknowns))
        self.of_friction, self.of_normal = np.zeros((2, self.unknowns))

    def fill(self, value: float) -> None:
        """Sets all derivatives to one value."""
        i: cython.Py_ssize_t
        j: cython.int
        for i in range(self.equations):
            for j in range(self.unknowns):
                self.jacobian[i, j] = value

    def stick_waves(self) -> None:
        """Sets the derivatives of the harmonics of a contact that never slips: those of the motion."""
        d: cython.int = self.motion.directions
        i: cython.int
        p: cython.int
        for i in range(self.outputs):
            if self.place[i] >= 0:
                for p in range(2 * d):
                    self.jacobian[d + 2 * d * i + p, d + 2 * d * self.place[i] + p] = 1.0

    def add_product(self, i: cython.int, direction: cython.int, which: cython.int, along: cython.int) -> None:
        """Adds the contribution of a displacement times function `which` to the force along `direction`.

        i is the output, or -1 for the mean; `along` is the direction of the displacement.
        """
        n: cython.int = self.motion.directions
        h: cython.int = self.output[i] if i >= 0 else 0
        row: cython.Py_ssize_t = n + 2 * n * i + 2 * direction if i >= 0 else direction
        factor: float = 1.0 / PI if i >= 0 else 0.5 / PI
        k: cython.int
        d: cython.int
        p: cython.int
        c: float
        s: float
        column: cython.Py_ssize_t
        if along == n - 1:  # a slider forgets the mean of the tangential displacements
            self.jacobian[row, along] += factor * self.integrals.cos_sum[which, h]
            if i >= 0:
                self.jacobian[row + 1, along] -= factor * self.integrals.sin_sum[which, h]
        factor *= 0.5
        for k in range(self.motion.count):
            d, p = h - self.motion.number[k], h + self.motion.number[k]
            column = n + 2 * n * k + 2 * along
            if d >= 0:
                c, s = factor * self.integrals.cos_sum[which, d], factor * self.integrals.sin_sum[which, d]
            else:
                c, s = factor * self.integrals.cos_sum[which, -d], -factor * self.integrals.sin_sum[which, -d]
            cos_p: float = factor * self.integrals.cos_sum[which, p]
            sin_p: float = factor * self.integrals.sin_sum[which, p]
            self.jacobian[row, column] += c + cos_p
            self.jacobian[row, column + 1] += s - sin_p
            if i >= 0:
                self.jacobian[row + 1, column] -= s + sin_p
                self.jacobian[row + 1, column + 1] += c - cos_p

    def rescale(self, contact: ContactParameters) -> None:
        """Scales the dimensionless derivatives to the units of the parameters."""
        n: cython.int = self.motion.directions
        i: cython.Py_ssize_t
        j: cython.int
        for j in range(self.unknowns):
            self.of_friction[j], self.of_normal[j] = contact.k_u, 0.0
        for j in range(n - 1, self.unknowns):
            if j == n - 1 or (j >= n and (j - n) % (2 * n) >= 2 * n - 2):
                self.of_friction[j], self.of_normal[j] = contact.mu * contact.k_v, contact.k_v
        for i in range(self.equations):
            if i == n - 1 or (i >= n and (i - n) % (2 * n) >= 2 * n - 2):
                for j in range(self.unknowns):
                    self.jacobian[i, j] *= self.of_normal[j]
            else:
                for j in range(self.unknowns):
                    self.jacobian[i, j] *= self.of_friction[j]


@cython.cclass
class ContactKernel:
    """Kernel of contacts with given harmonics of motion and forces, evaluated one after the other.

    Other kernels call `evaluate`, which needs no lock, and read `forces` and `jacobian`. Each thread needs
    its own kernel.

    Attributes
    ----------
    forces (equation,), jacobian (equation, unknown)
        For the motion evaluated last.
    kind, behaviour
        kind of its cycle: OPEN, STUCK, MIXED, UNKNOWN or UNSOLVED; behaviour by its load: OPEN, CLOSED or
        MIXED.
    """

    def __init__(self, derivatives: ForceDerivatives) -> None:
        self.motion, self.jacobian = derivatives.motion, derivatives.jacobian
        self.outputs, self.output, self.place = derivatives.outputs, derivatives.output, derivatives.place
        self.unknowns, self.equations = derivatives.unknowns, derivatives.equations
        self.forces = np.zeros(self.equations)
        self.kind = self.behaviour = UNKNOWN

    def evaluate(
        self, x: cython.double[::1], first: cython.Py_ssize_t, contact: ContactParameters, gradient: bool
    ) -> cython.int:
        """Evaluates the motion x[first:]: `forces`, and with gradient their derivatives in `jacobian`.

        Returns
        -------
        int
            `kind`. If it is UNKNOWN or UNSOLVED, the results are NaN.
        """
        return UNKNOWN

    def solve(
        self, x: cython.double[::1], first: cython.Py_ssize_t, contact: ContactParameters
    ) -> cython.int:
        """Solves the cycle of the motion x[first:], without its forces if that costs less; returns `kind`."""
        return self.evaluate(x, first, contact, False)

    def resist(self, contact: ContactParameters, resistance: cython.double[:, ::1]) -> None:
        """Fills the derivatives of the forces by the displacements, averaged over the present cycle."""

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
        """Fills `forces` (point, equation) of motions (point, unknown) with `parameters` (point, 4 to 6).

        `jacobians` (point, equation, unknown) is filled as well unless it has no points. Returns the number
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

    def clear(self, value: float) -> None:
        """Sets all forces to one value."""
        i: cython.int
        for i in range(self.equations):
            self.forces[i] = value

    def take_waves(self, direction: cython.int, row: cython.int) -> None:
        """Sets the harmonics of the force along a direction to those of a row of the motion."""
        i: cython.int
        k: cython.int
        at: cython.Py_ssize_t
        for i in range(self.outputs):
            k = self.place[i]
            if k >= 0:
                at = (2 * i + 1) * self.motion.directions + 2 * direction
                self.forces[at], self.forces[at + 1] = self.motion.re[row, k], self.motion.im[row, k]

    def press(self, row: cython.int) -> None:
        """Sets the normal force of a contact that never opens to a row of the motion."""
        self.forces[self.motion.directions - 1] = self.motion.mean[row]
        self.take_waves(self.motion.directions - 1, row)

    def rescale(self) -> None:
        """Scales the dimensionless forces to the units of the parameters."""
        n: cython.int = self.motion.directions
        i: cython.int
        for i in range(self.equations):
            if i == n - 1 or (i >= n and (i - n) % (2 * n) >= 2 * n - 2):
                self.forces[i] *= self.motion.load_scale
            else:
                self.forces[i] *= self.motion.scale


@cython.cclass
class CycleMeasures:
    """Forces, energy and states of the cycle that a contact solved last, in the units of its arguments.

    Attributes
    ----------
    greatest_load, greatest_friction
        Greatest normal force, and greatest magnitude of the friction force [force].
    dissipation, slip_path
        Energy dissipated by friction in a cycle [force length], never negative, and path of the slider while
        it slips [length].
    pieces, state (piece,)
        The number of states, and the states in order.
    """

    def __init__(self, state: cython.int[::1]) -> None:
        self.greatest_load = self.greatest_friction = self.dissipation = self.slip_path = 0.0
        self.pieces, self.state = 0, state

    def bear(self, contact: ContactParameters) -> None:
        """Computes all attributes of the present cycle."""
