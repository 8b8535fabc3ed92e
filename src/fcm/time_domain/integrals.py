"""The integrals of the modal displacements over a motion, and of their products with sin and cos.

Over a step a displacement is the polynomial with its first `TERMS` Taylor coefficients at both ends; that and
its integrals times exp(i theta) are exact to rounding: what is left out is of the order 1e-19. All that is
linear in the state vector, so the vectors of all whole steps are summed before their coefficients are made.

The integrals of all powers are by Gauss quadrature that is exact to rounding on a step (`Powers`).
"""

from __future__ import annotations

from math import comb

import cython
import numpy as np
from cython.cimports.libc.math import cos, fabs, sin

from fcm.model.scene import FloatArray
from fcm.time_domain.segments import ORDER

if cython.compiled:
    from cython.cimports.fcm.time_domain.flow import Flows, summed
    from cython.cimports.fcm.time_domain.segment_walk import Walk
    from cython.cimports.fcm.time_domain.segments import Segments
else:
    from fcm.time_domain.flow import Flows, summed
    from fcm.time_domain.segment_walk import Walk
    from fcm.time_domain.segments import Segments

POWER_NODES = 8  # integrate exactly polynomials of degree 15
_POWER_PLACES, _POWER_SHARES = np.polynomial.legendre.leggauss(POWER_NODES)
_POWER_ON_ONE = 0.5 * (_POWER_PLACES + 1.0), 0.5 * _POWER_SHARES  # on [0, 1]
_POWER_NODES = cython.declare(cython.int, 8)
_POSITIVE_SLIP = cython.declare(cython.int, 2)
_NEGATIVE_SLIP = cython.declare(cython.int, 3)


@cython.cclass
class Powers(Walk):
    """Work of the forces, dissipation by slip and by damping, and the sum of all magnitudes, over a motion.

    `slips` and `paths` (contact,): the dissipation by each contact, and the way that it slips.

    Parameters
    ----------
    flows : Flows
    wave : (2 waves, mode)
        Modal amplitudes of the forces: of sin(h theta) and cos(h theta) of each of their harmonics h.
    static : (mode,)
        Modal steady forces.
    damper : (mode,)
        2 m zeta omega of the modes.
    everywhere : bool
        Or only while a contact slips, for what slip takes.
    """

    def __init__(
        self,
        flows: Flows,
        wave: FloatArray,
        static: FloatArray,
        damper: FloatArray,
        everywhere: bool = True,
    ) -> None:
        Walk.__init__(self, flows)
        self._everywhere = everywhere
        self._wave, self._static, self._damper = wave, static, damper
        self._y, self._terms = np.zeros((2, flows.size)), np.zeros((ORDER + 1, flows.size))
        self._nodes, self._weights = _POWER_ON_ONE
        self.slips, self.paths = np.zeros((2, flows.contacts))
        self._none()

    def begins(self, segments: Segments) -> None:
        """See `Walk`; nothing is done yet."""
        Walk.begins(self, segments)
        self._none()

    def _none(self) -> None:
        """Nothing was done."""
        self.work = self.slip = self.damping = self.turnover = 0.0
        self.slips[:] = 0.0
        self.paths[:] = 0.0

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(-1, check=False)
    def visit(self, slot: cython.Py_ssize_t) -> cython.int:
        """Step by step, each a polynomial."""
        left: cython.double = self.segments.length[self.at]
        length: cython.double
        i: cython.Py_ssize_t
        slips: cython.bint = self._everywhere
        for i in range(self.flows.contacts):
            slips |= self.segments.states[self.at, i] >= _POSITIVE_SLIP
        if not slips:
            return 0
        for i in range(self.flows.size):
            self._y[1, i] = self.segments.y[self.at, i]
        while left > 0.0:
            length = min(left, 1.0)
            self.flows.taylor(slot, self._y, 1, self._terms)
            for i in range(_POWER_NODES):
                summed(self._terms, self._nodes[i] * length, self._y, 0)
                self._add(self._weights[i] * length * self.flows.step[slot])
            summed(self._terms, 1.0, self._y, 1)
            left -= 1.0
        return 0

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def _add(self, weight: cython.double) -> cython.void:
        """The powers at an instant; w' of a slipping contact is (6), (8)."""
        m: cython.Py_ssize_t = self.flows.modes
        n: cython.Py_ssize_t = self.flows.linear
        i: cython.Py_ssize_t
        j: cython.Py_ssize_t
        state: cython.int
        push: cython.double
        power: cython.double = 0.0
        loss: cython.double = 0.0
        slip: cython.double = 0.0
        rate: cython.double
        ratio: cython.double
        for i in range(m):
            push = 0.0
            for j in range(self._wave.shape[0]):
                push += self._wave[j, i] * self._y[0, n + j]
            power += self._y[0, m + i] * (push + self._static[i])
            loss += self._damper[i] * self._y[0, m + i] * self._y[0, m + i]
        for j in range(self.flows.contacts):
            state = self.segments.states[self.at, j]
            if state != _POSITIVE_SLIP and state != _NEGATIVE_SLIP:
                continue
            ratio = self.flows.mu[j] * self.flows.k_v[j] / self.flows.k_u[j]
            if state == _NEGATIVE_SLIP:
                ratio = -ratio
            rate = 0.0
            for i in range(m):
                rate += self._y[0, m + i] * (self.flows.tangential[j, i] - ratio * self.flows.normal[j, i])
            lost: cython.double = self._y[0, 2 * m + j] * rate
            slip += lost
            self.slips[j] += weight * lost
            self.paths[j] += weight * fabs(rate)
        self.work += weight * power
        self.slip += weight * slip
        self.damping += weight * loss
        self.turnover += weight * (fabs(power) + slip + loss)


TERMS = 8  # of a step's displacements at either end: 8!**2 / (16! 17!) = 2e-19
NODES = 16  # integrate exactly polynomials of degree 31
_TERMS = cython.declare(cython.int, 8)
_NODES = cython.declare(cython.int, 16)


def _basis(x: FloatArray) -> FloatArray:
    """Hermite's polynomials on [0, 1], with one Taylor coefficient at 0 or 1 that is 1: (x, 2 TERMS)."""
    columns = []
    for end in (x, 1.0 - x):
        for k in range(TERMS):
            series = sum(comb(TERMS - 1 + s, s) * end**s for s in range(TERMS - k))
            columns.append(end**k * (1.0 - end) ** TERMS * series * (1.0 if end is x else (-1.0) ** k))
    return np.array(columns).T.copy()


_PLACES, _SHARES = np.polynomial.legendre.leggauss(NODES)
_ON_ONE = 0.5 * (_PLACES + 1.0), 0.5 * _SHARES[:, None] * _basis(0.5 * (_PLACES + 1.0))


@cython.cclass
class Integrals(Walk):
    """`sums` (3, mode): the integrals over time of q, q sin(theta) and q cos(theta)."""

    def __init__(self, flows: Flows) -> None:
        Walk.__init__(self, flows)
        self.sums = np.zeros((3, flows.modes))
        self._nodes, self._shares = _ON_ONE
        self._weights, self._terms = np.zeros((3, 2 * TERMS)), np.zeros((TERMS, flows.size))
        self._there, self._sums = np.zeros((2, flows.size)), np.zeros((6, flows.size))

    def begins(self, segments: Segments) -> None:
        """Stand before the first segment, with nothing summed."""
        i: cython.Py_ssize_t
        b: cython.int
        Walk.begins(self, segments)
        for b in range(3):
            for i in range(self.flows.modes):
                self.sums[b, i] = 0.0

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(-1, check=False)
    def visit(self, slot: cython.Py_ssize_t) -> cython.int:
        """Over all whole steps, and over what is left of one."""
        h: cython.double = self.flows.step[slot]
        whole: cython.longlong = cython.cast(cython.longlong, self.segments.length[self.at])
        x: cython.double = self.segments.length[self.at] - whole
        i: cython.Py_ssize_t
        b: cython.int
        for i in range(self.flows.size):
            self._there[0, i] = self.segments.y[self.at, i]
        if whole > 0:
            for b in range(6):
                for i in range(self.flows.size):
                    self._sums[b, i] = 0.0
            self._steps(slot, whole)
            self._weigh(self.flows.omega * h)
            for b in range(2):
                self._take(slot, self._sums, 3 * b, h, b, 1.0, 0.0, 0.0)
                self._take(slot, self._sums, 3 * b + 1, h, b, 0.0, 1.0, 0.0)
                self._take(slot, self._sums, 3 * b + 2, h, b, 0.0, 0.0, 1.0)
        if x > 0.0:
            self._weigh(self.flows.omega * x * h)
            sine: cython.double = self._there[0, self.flows.linear]
            cosine: cython.double = self._there[0, self.flows.linear + 1]
            self._take(slot, self._there, 0, x * h, 0, 1.0, sine, cosine)
            self.flows.part(slot, x, self._there, 0, 1)
            self._take(slot, self._there, 0, x * h, 1, 1.0, sine, cosine)
        return 0

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(-1, check=False)
    def _steps(self, slot: cython.Py_ssize_t, whole: cython.longlong) -> cython.int:
        """Sum the state vectors at both ends of whole steps, times 1, sin(theta), cos(theta) at the first."""
        i: cython.Py_ssize_t
        k: cython.Py_ssize_t
        while self.span > 0 and whole >= self.span:
            for i in range(self.flows.size):
                self.ahead[0, i] = self._there[0, i]
            with cython.gil:
                self.reach(slot)
            for k in range(self.span):
                self._gather(self.ahead, k)
            for i in range(self.flows.size):
                self._there[0, i] = self.ahead[self.span, i]
            whole -= self.span
        while whole > 0:
            for i in range(self.flows.size):
                self._there[1, i] = self._there[0, i]
            self.flows.advance(slot, 0, self._there, 1)
            self._gather(self._there, 0)
            for i in range(self.flows.size):
                self._there[0, i] = self._there[1, i]
            whole -= 1
        return 0

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def _gather(self, y: cython.double[:, ::1], k: cython.Py_ssize_t) -> cython.void:
        """Add the step from row k of y to the next."""
        i: cython.Py_ssize_t
        sine: cython.double = y[k, self.flows.linear]
        cosine: cython.double = y[k, self.flows.linear + 1]
        for i in range(self.flows.size):
            self._sums[0, i] += y[k, i]
            self._sums[1, i] += sine * y[k, i]
            self._sums[2, i] += cosine * y[k, i]
            self._sums[3, i] += y[k + 1, i]
            self._sums[4, i] += sine * y[k + 1, i]
            self._sums[5, i] += cosine * y[k + 1, i]

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def _weigh(self, angle: cython.double) -> cython.void:
        """The weights of the coefficients in the integrals of q times 1, sin(angle x), cos(angle x)."""
        i: cython.int
        j: cython.int
        real: cython.double
        imag: cython.double
        share: cython.double
        for j in range(2 * _TERMS):
            self._weights[0, j] = self._weights[1, j] = self._weights[2, j] = 0.0
        for i in range(_NODES):
            imag, real = sin(angle * self._nodes[i]), cos(angle * self._nodes[i])
            for j in range(2 * _TERMS):
                share = self._shares[i, j]
                self._weights[0, j] += share
                self._weights[1, j] += share * imag
                self._weights[2, j] += share * real

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def _take(
        self,
        slot: cython.Py_ssize_t,
        y: cython.double[:, ::1],
        k: cython.Py_ssize_t,
        h: cython.double,
        end: cython.int,
        one: cython.double,
        sine: cython.double,
        cosine: cython.double,
    ) -> cython.void:
        """Add what row k of y does at the first (0) or last (1) end of steps of length h [s].

        It is what it is, or a sum over steps of it times sin or cos of the forces' angle at the first end.
        """
        i: cython.Py_ssize_t
        j: cython.int
        w: cython.int
        even: cython.double
        by_sine: cython.double
        by_cosine: cython.double
        for i in range(self.flows.size):
            self._terms[0, i] = y[k, i]
        self.flows.extend(slot, self._terms, _TERMS - 1, h, self._terms, False)
        for j in range(_TERMS):
            w = end * _TERMS + j
            even = h * one * self._weights[0, w]
            by_sine = h * (sine * self._weights[2, w] + cosine * self._weights[1, w])
            by_cosine = h * (cosine * self._weights[2, w] - sine * self._weights[1, w])
            for i in range(self.flows.modes):
                self.sums[0, i] += even * self._terms[j, i]
                self.sums[1, i] += by_sine * self._terms[j, i]
                self.sums[2, i] += by_cosine * self._terms[j, i]
