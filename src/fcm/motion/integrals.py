"""The integrals of the modal displacements over a motion, and of their products with sin and cos.

Over a step a displacement is the polynomial with its first `TERMS` Taylor coefficients at both ends; that and
its integrals times exp(i theta) are exact to rounding: what is left out is of the order 1e-19.
"""

from __future__ import annotations

from math import comb

import cython
import numpy as np
from cython.cimports.libc.math import cos, sin

from fcm.scene.model import FloatArray

if cython.compiled:
    from cython.cimports.fcm.motion.flow import Flows
    from cython.cimports.fcm.motion.segments import Segments
    from cython.cimports.fcm.motion.walk import Walk
else:
    from fcm.motion.flow import Flows
    from fcm.motion.segments import Segments
    from fcm.motion.walk import Walk

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
        self._weights, self._part = np.zeros((3, 2 * TERMS)), np.zeros((3, flows.modes))
        self._near, self._far = np.zeros((TERMS, flows.size)), np.zeros((TERMS, flows.size))

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
    @cython.exceptval(check=False)
    def visit(self, slot: cython.Py_ssize_t) -> cython.void:
        """Step by step, and over what is left of one."""
        left: cython.double = self.segments.length[self.at]
        h: cython.double = self.flows.step[slot]
        i: cython.Py_ssize_t
        j: cython.int
        size: cython.double = 1.0
        for i in range(self.flows.size):
            self._near[0, i] = self.segments.y[self.at, i]
        self.flows.extend(slot, self._near, _TERMS - 1, h, self._near, False)
        if left >= 1.0:
            self._weigh(self.flows.omega * h)
        while left >= 1.0:
            for i in range(self.flows.size):
                self._far[0, i] = self._near[0, i]
            self.flows.advance(slot, 0, self._far, 0)
            self.flows.extend(slot, self._far, _TERMS - 1, h, self._far, False)
            self._add(h)
            for j in range(_TERMS):
                for i in range(self.flows.size):
                    self._near[j, i] = self._far[j, i]
            left -= 1.0
        if left > 0.0:
            for i in range(self.flows.size):
                self._far[0, i] = self._near[0, i]
            self.flows.part(slot, left, self._far, 0, 1)
            self.flows.extend(slot, self._far, _TERMS - 1, left * h, self._far, False)
            for j in range(_TERMS):
                for i in range(self.flows.modes):
                    self._near[j, i] *= size
                size *= left
            self._weigh(self.flows.omega * left * h)
            self._add(left * h)

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def _weigh(self, angle: cython.double) -> cython.void:
        """The weights of the coefficients in the integrals of q, q sin(angle x) and q cos(angle x) over [0, 1]."""
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
    def _add(self, h: cython.double) -> cython.void:
        """Over a step of that length [s]."""
        i: cython.Py_ssize_t
        j: cython.int
        b: cython.int
        sine: cython.double = h * self._near[0, self.flows.linear]
        cosine: cython.double = h * self._near[0, self.flows.linear + 1]
        for b in range(3):
            for i in range(self.flows.modes):
                self._part[b, i] = 0.0
            for j in range(_TERMS):
                for i in range(self.flows.modes):
                    self._part[b, i] += (
                        self._weights[b, j] * self._near[j, i] + self._weights[b, _TERMS + j] * self._far[j, i]
                    )
        for i in range(self.flows.modes):
            self.sums[0, i] += h * self._part[0, i]
            self.sums[1, i] += sine * self._part[2, i] + cosine * self._part[1, i]
            self.sums[2, i] += cosine * self._part[2, i] - sine * self._part[1, i]
