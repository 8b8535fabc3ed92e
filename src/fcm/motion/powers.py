"""The integrals of all powers over a motion, by Gauss quadrature that is exact to rounding on a step."""

from __future__ import annotations

import cython
import numpy as np
from cython.cimports.libc.math import fabs

from fcm.scene.model import FloatArray

if cython.compiled:
    from cython.cimports.fcm.motion.series import summed
    from cython.cimports.fcm.motion.steps import Steps
else:
    from fcm.motion.series import summed
    from fcm.motion.steps import Steps

NODES = 8  # integrate exactly polynomials of degree 15
_PLACES, _SHARES = np.polynomial.legendre.leggauss(NODES)
_ON_ONE = 0.5 * (_PLACES + 1.0), 0.5 * _SHARES  # on [0, 1]
_NODES = cython.declare(cython.int, 8)
_POSITIVE = cython.declare(cython.int, 2)
_NEGATIVE = cython.declare(cython.int, 3)


@cython.cclass
class Powers:
    """Work of the forces, dissipation by slip and by damping, and the sum of all magnitudes, over steps.

    Parameters
    ----------
    steps : Steps
    sine, cosine, static : (mode,)
        Modal amplitudes of the forces.
    damper : (mode,)
        2 m zeta omega of the modes.
    """

    def __init__(
        self, steps: Steps, sine: FloatArray, cosine: FloatArray, static: FloatArray, damper: FloatArray
    ) -> None:
        self.steps = steps
        self.work = self.slip = self.damping = self.turnover = 0.0
        self._sine, self._cosine, self._static, self._damper = sine, cosine, static, damper
        self._y = np.zeros((1, steps.flows.size))
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
        i: cython.int
        while True:
            stopped = self.steps.next()
            if stopped != 1:
                return stopped
            for i in range(_NODES):
                summed(self.steps.terms, self._nodes[i] * self.steps.length, self._y, 0)
                self._add(self._weights[i] * self.steps.length * self.steps.h)

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def _add(self, weight: cython.double) -> cython.void:
        """The powers at an instant; w' of a slipping contact is (6), (8)."""
        m: cython.Py_ssize_t = self.steps.flows.modes
        n: cython.Py_ssize_t = self.steps.flows.linear
        i: cython.Py_ssize_t
        j: cython.Py_ssize_t
        state: cython.int
        power: cython.double = 0.0
        loss: cython.double = 0.0
        slip: cython.double = 0.0
        rate: cython.double
        ratio: cython.double
        for i in range(m):
            push: cython.double = self._sine[i] * self._y[0, n] + self._cosine[i] * self._y[0, n + 1]
            power += self._y[0, m + i] * (push + self._static[i])
            loss += self._damper[i] * self._y[0, m + i] * self._y[0, m + i]
        for j in range(self.steps.flows.contacts):
            state = self.steps.segments.states[self.steps.at, j]
            if state != _POSITIVE and state != _NEGATIVE:
                continue
            ratio = self.steps.flows.mu[j] * self.steps.flows.k_v[j] / self.steps.flows.k_u[j]
            if state == _NEGATIVE:
                ratio = -ratio
            rate = 0.0
            for i in range(m):
                rate += self._y[0, m + i] * (
                    self.steps.flows.tangential[j, i] - ratio * self.steps.flows.normal[j, i]
                )
            slip += self._y[0, 2 * m + j] * rate
        self.work += weight * power
        self.slip += weight * slip
        self.damping += weight * loss
        self.turnover += weight * (fabs(power) + slip + loss)
