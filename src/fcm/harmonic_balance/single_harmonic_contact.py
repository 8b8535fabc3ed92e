"""The contact with mean and one harmonic, in closed form (section 4 of the paper)."""

from __future__ import annotations

import cython
import numpy as np
from cython.cimports.libc.math import atan2, hypot, sqrt

from fcm.contact.closed_form import CoefficientLaw
from fcm.harmonic_balance.contact_law import Law

PI = cython.declare(cython.double, 3.141592653589793)
MIN_AMPLITUDE = cython.declare(cython.double, 1e-150)  # amplitudes below this count as this in a division
CLOSES = cython.declare(cython.int, 0)  # margins, see `bound`
OPENS = cython.declare(cython.int, 1)
SLIPS = cython.declare(cython.int, 2)
MOST = cython.declare(cython.int, 3)
LEAST = cython.declare(cython.int, 4)


@cython.cclass
class SingleHarmonicLaw(Law):
    """Forces (27) and (29) with their derivatives by u_0, v_0, U, V.

    Its coefficients are a law's: the closed form, or a table.
    """

    def __init__(
        self,
        coefficients: CoefficientLaw,
        mu: cython.double,
        k_u: cython.double,
        k_v: cython.double,
        n_0: cython.double,
    ) -> None:
        Law.__init__(self, 6, 2, 5, mu, k_u, k_v, n_0)
        self.coefficients = coefficients
        self.numbers, self.slopes = np.zeros(12), np.zeros((3, 6))
        self.least, self.most = 0.0, 0.0  # see `limits`

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def evaluate(self, x: cython.double[::1], first: cython.Py_ssize_t) -> cython.int:
        b: cython.double = hypot(x[first + 4], x[first + 5])
        self.force[:] = 0.0
        self.tangent[:, :] = 0.0
        self.nonlinear = False
        if self.k_v > 0.0:
            self.normal(x, first, b)
        if self.mu > 0.0 and self.k_u > 0.0:
            self.limits(x, first, b)
            if self.rests():
                self.stuck(x, first)
            elif self.margin[CLOSES] > 0.0:
                self.nonlinear = True
                self.slipping(x, first, b)
        return 0

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def bound(self, x: cython.double[::1], first: cython.Py_ssize_t) -> cython.int:
        """Forces by which a contact is closed at some time, and at all times; by which it is beyond the slip
        limit (25); and, where it never slips, by which its mean friction is within its limits.
        """
        self.limits(x, first, hypot(x[first + 4], x[first + 5]))
        return 0

    @cython.cfunc
    @cython.exceptval(check=False)
    def limits(self, x: cython.double[::1], first: cython.Py_ssize_t, b: cython.double) -> cython.void:
        """The same where |V| is b; and between which limits a contact's mean friction is where it sticks."""
        load: cython.double = self.n_0 + self.k_v * x[first + 1]
        variation: cython.double = self.k_v * b
        self.margin[CLOSES] = load + variation if variation > 0.0 else load
        self.margin[OPENS] = load - variation
        self.most = self.mu * load - self.limit(x, first, -1.0)
        self.least = self.limit(x, first, 1.0) - self.mu * load
        self.margin[SLIPS] = self.most - self.least
        within: cython.bint = self.most > self.least and load > variation
        self.margin[MOST] = self.most - self.k_u * x[first] if within else 0.0
        self.margin[LEAST] = self.k_u * x[first] - self.least if within else 0.0

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def rests(self) -> cython.bint:
        """Whether the contact never slips nor opens, by the margins as they were last asked for."""
        return self.margin[SLIPS] > 0.0 and self.margin[OPENS] > 0.0

    @cython.cfunc
    @cython.exceptval(check=False)
    def limit(self, x: cython.double[::1], first: cython.Py_ssize_t, sign: cython.double) -> cython.double:
        """|k_u U + sign mu k_v V|: k_u a times ell_1 (sign -1) or ell_2 (sign 1) of (A9)."""
        m: cython.double = sign * self.mu * self.k_v
        return hypot(self.k_u * x[first + 2] + m * x[first + 4], self.k_u * x[first + 3] + m * x[first + 5])

    @cython.cfunc
    @cython.exceptval(check=False)
    def stuck(self, x: cython.double[::1], first: cython.Py_ssize_t) -> cython.void:
        """A spring; it resists the mean displacement too, as far as the `limits` of its friction allow."""
        k: cython.double = self.k_u
        sign: cython.double = 0.0
        i: cython.Py_ssize_t
        for i in range(2, 4):
            self.force[i] = k * x[first + i]
            self.tangent[i, i] = k
        if k * x[first] > self.most:
            sign, self.force[0] = -1.0, self.most
        elif k * x[first] < self.least:
            sign, self.force[0] = 1.0, self.least
        else:
            self.force[0], self.tangent[0, 0] = k * x[first], k
            return
        # the derivative of sign (|k_u U + sign mu k_v V| - mu n)
        m: cython.double = sign * self.mu * self.k_v
        size: cython.double = max(self.limit(x, first, sign), MIN_AMPLITUDE)
        for i in range(2):
            along: cython.double = (k * x[first + 2 + i] + m * x[first + 4 + i]) / size
            self.tangent[0, 2 + i] = sign * k * along
            self.tangent[0, 4 + i] = sign * m * along
        self.tangent[0, 1] = -m

    @cython.cfunc
    @cython.exceptval(check=False)
    def normal(self, x: cython.double[::1], first: cython.Py_ssize_t, b: cython.double) -> cython.void:
        """(28) to (31): k_v b (N_b + N_s cos), less the preload that the structure at rest balances."""
        k: cython.double = self.k_v
        load: cython.double = self.n_0 + k * x[first + 1]
        preload: cython.double = max(self.n_0, 0.0)
        i: cython.Py_ssize_t
        j: cython.Py_ssize_t
        if load >= k * b:
            # closed throughout, without the preload: it may be far larger than what is left
            self.force[1] = k * x[first + 1] + min(self.n_0, 0.0)
            self.tangent[1, 1] = k
            for i in range(4, 6):
                self.force[i] = k * x[first + i]
                self.tangent[i, i] = k
            return
        self.force[1] = -preload
        if load <= -k * b:
            return
        self.nonlinear = True
        star: cython.double = load / (k * b)
        closed: cython.double = sqrt(1.0 + star)
        opened: cython.double = sqrt(1.0 - star)
        theta_1: cython.double = 2.0 * atan2(closed, opened)
        sin_1: cython.double = closed * opened
        N_s: cython.double = (star * sin_1 + theta_1) / PI
        slope: cython.double = 2.0 * sin_1 / PI  # of N_s by n0_star
        self.force[1] = k * b * (sin_1 + star * theta_1) / PI - preload
        self.tangent[1, 1] = k * theta_1 / PI
        for i in range(2):
            self.force[4 + i] = k * N_s * x[first + 4 + i]
            along_i: cython.double = x[first + 4 + i] / b
            self.tangent[1, 4 + i] = k * sin_1 / PI * along_i
            self.tangent[4 + i, 1] = k * slope * along_i
            for j in range(2):
                self.tangent[4 + i, 4 + j] = -k * slope * star * along_i * x[first + 4 + j] / b
            self.tangent[4 + i, 4 + i] += k * N_s

    @cython.cfunc
    @cython.exceptval(check=False)
    def slipping(self, x: cython.double[::1], first: cython.Py_ssize_t, b: cython.double) -> cython.void:
        """(27) with the phase of u restored: k_u U (F_s + i F_c), and the mean k_u a F_b."""
        k: cython.double = self.k_u
        U_r: cython.double = x[first + 2]
        U_i: cython.double = x[first + 3]
        V_r: cython.double = x[first + 4]
        V_i: cython.double = x[first + 5]
        a: cython.double = max(hypot(U_r, U_i), MIN_AMPLITUDE)
        ratio: cython.double = self.mu / (k * a)
        n0_bar: cython.double = ratio * (self.n_0 + self.k_v * x[first + 1])
        b_bar: cython.double = ratio * self.k_v * b
        phi: cython.double = atan2(V_i * U_r - V_r * U_i, V_r * U_r + V_i * U_i)
        self.coefficients.evaluate(n0_bar, b_bar, phi, True, self.numbers, 0)
        self.chain(x, first, n0_bar, b_bar, a, max(b, MIN_AMPLITUDE))
        F_b: cython.double = self.numbers[0]
        F_s: cython.double = self.numbers[1]
        F_c: cython.double = self.numbers[2]
        cos_u: cython.double = U_r / a
        sin_u: cython.double = U_i / a
        i: cython.Py_ssize_t
        for i in range(6):
            self.tangent[0, i] = k * self.slopes[0, i]
            self.tangent[2, i] = k * (cos_u * self.slopes[1, i] - sin_u * self.slopes[2, i])
            self.tangent[3, i] = k * (sin_u * self.slopes[1, i] + cos_u * self.slopes[2, i])
        self.force[0] = k * a * F_b
        self.force[2] = k * (F_s * U_r - F_c * U_i)
        self.force[3] = k * (F_s * U_i + F_c * U_r)
        self.tangent[0, 2] += k * F_b * cos_u
        self.tangent[0, 3] += k * F_b * sin_u
        self.tangent[2, 2] += k * F_s
        self.tangent[3, 3] += k * F_s
        self.tangent[2, 3] -= k * F_c
        self.tangent[3, 2] += k * F_c

    @cython.cfunc
    @cython.exceptval(check=False)
    def chain(
        self,
        x: cython.double[::1],
        first: cython.Py_ssize_t,
        n0_bar: cython.double,
        b_bar: cython.double,
        a: cython.double,
        b: cython.double,
    ) -> cython.void:
        """slopes: a times the derivatives of F_b, F_s, F_c by the unknowns, from those by n0_bar, b_bar,
        phi."""
        k: cython.double = self.mu / self.k_u * self.k_v
        relative: cython.double = a / b
        i: cython.Py_ssize_t
        j: cython.Py_ssize_t
        for j in range(3):
            by_n0: cython.double = self.numbers[3 + 3 * j]
            by_b: cython.double = self.numbers[4 + 3 * j]
            by_phi: cython.double = self.numbers[5 + 3 * j]
            self.slopes[j, 1] = by_n0 * k
            for i in range(2):
                along: cython.double = x[first + 2 + i] / a
                self.slopes[j, 2 + i] = -(by_n0 * n0_bar + by_b * b_bar) * along
                self.slopes[j, 4 + i] = by_b * k * x[first + 4 + i] / b
            self.slopes[j, 2] += by_phi * x[first + 3] / a
            self.slopes[j, 3] -= by_phi * x[first + 2] / a
            self.slopes[j, 4] -= by_phi * relative * x[first + 5] / b
            self.slopes[j, 5] += by_phi * relative * x[first + 4] / b
