"""The integrals of the modal displacements over a motion, and of their products with sin and cos.

Over a step they are those of its polynomial, times exp(-i theta) by moments from Gauss quadrature.
"""

from __future__ import annotations

import cython
import numpy as np
from cython.cimports.libc.math import cos, sin

from fcm.motion.pool import ORDER

if cython.compiled:
    from cython.cimports.fcm.motion.steps import Steps
else:
    from fcm.motion.steps import Steps

NODES = 16  # integrate exactly polynomials of degree 31; what a step has beyond that is rounding
_PLACES, _SHARES = np.polynomial.legendre.leggauss(NODES)
_ON_ONE = 0.5 * (_PLACES + 1.0), 0.5 * _SHARES  # on [0, 1]
_NODES = cython.declare(cython.int, 16)
_ORDER = cython.declare(cython.int, 19)


@cython.cclass
class Integrals:
    """`mean`, `sine` and `cosine` (mode,): the integrals over time of q, q sin(theta) and q cos(theta)."""

    def __init__(self, steps: Steps) -> None:
        self.steps, self._slot = steps, -1
        m = steps.flows.modes
        self.mean, self.sine, self.cosine = np.zeros(m), np.zeros(m), np.zeros(m)
        self._real, self._imag, self._even = np.zeros(ORDER + 1), np.zeros(ORDER + 1), np.zeros(ORDER + 1)
        self._sums = np.zeros((3, m))
        self._nodes, self._weights = _ON_ONE

    def go(self) -> int:
        """Integrate over all steps: 0 when done, -1 where a flow is missing."""
        stopped: cython.int
        with cython.nogil:
            stopped = self._go()
        return int(stopped)

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def _go(self) -> cython.int:
        stopped: cython.int
        while True:
            stopped = self.steps.next()
            if stopped != 1:
                return stopped
            self._moments()
            self._integrate()

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def _moments(self) -> cython.void:
        """Integrals of x**j, x**j cos(omega h x) and x**j sin(omega h x) over the step."""
        i: cython.int
        j: cython.int
        x: cython.double
        angle: cython.double = self.steps.flows.omega * self.steps.h
        real: cython.double
        imag: cython.double
        if self.steps.length == 1.0 and self._slot == self.steps.slot:
            return
        self._slot = self.steps.slot if self.steps.length == 1.0 else -1
        x = self.steps.length
        for j in range(_ORDER + 1):
            self._real[j] = self._imag[j] = 0.0
            self._even[j] = x / (j + 1)
            x *= self.steps.length
        for i in range(_NODES):
            x = self._nodes[i] * self.steps.length
            real = self._weights[i] * self.steps.length
            imag = real * sin(angle * x)
            real *= cos(angle * x)
            for j in range(_ORDER + 1):
                self._real[j] += real
                self._imag[j] += imag
                real *= x
                imag *= x

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def _integrate(self) -> cython.void:
        i: cython.Py_ssize_t
        j: cython.int
        even: cython.double
        real: cython.double
        imag: cython.double
        h: cython.double = self.steps.h
        sine: cython.double = self.steps.y[0, self.steps.flows.linear]
        cosine: cython.double = self.steps.y[0, self.steps.flows.linear + 1]
        terms: cython.double[:, ::1] = self.steps.terms
        for i in range(self.steps.flows.modes):
            self._sums[0, i] = self._sums[1, i] = self._sums[2, i] = 0.0
        for j in range(_ORDER, -1, -1):
            even, real, imag = self._even[j], self._real[j], self._imag[j]
            for i in range(self.steps.flows.modes):
                self._sums[0, i] += terms[j, i] * even
                self._sums[1, i] += terms[j, i] * real
                self._sums[2, i] += terms[j, i] * imag
        for i in range(self.steps.flows.modes):
            real, imag = self._sums[1, i], self._sums[2, i]
            self.mean[i] += h * self._sums[0, i]
            self.cosine[i] += h * (real * cosine - imag * sine)
            self.sine[i] += h * (real * sine + imag * cosine)
