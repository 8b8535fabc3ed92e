"""The integrals of the modal displacements over a motion, and of their products with sin and cos.

Over a step a displacement is the polynomial with its first `TERMS` Taylor coefficients at both ends; that and
its integrals times exp(i theta) are exact to rounding: what is left out is of the order 1e-19. All that is
linear in the state vector, so the vectors of all whole steps are summed before their coefficients are made.
"""

from __future__ import annotations

from math import comb

import cython
import numpy as np
from cython.cimports.libc.math import cos, sin

from fcm.model.scene import FloatArray

if cython.compiled:
    from cython.cimports.fcm.time_domain.flow import Flows
    from cython.cimports.fcm.time_domain.segment_walk import Walk
    from cython.cimports.fcm.time_domain.segments import Segments
else:
    from fcm.time_domain.flow import Flows
    from fcm.time_domain.segment_walk import Walk
    from fcm.time_domain.segments import Segments

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
