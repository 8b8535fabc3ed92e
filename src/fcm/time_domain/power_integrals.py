"""The integrals of all powers over a motion, by Gauss quadrature that is exact to rounding on a step."""

from __future__ import annotations

import cython
import numpy as np
from cython.cimports.libc.math import fabs

from fcm.model.scene import FloatArray
from fcm.time_domain.flow_cache import ORDER

if cython.compiled:
    from cython.cimports.fcm.time_domain.flow import Flows
    from cython.cimports.fcm.time_domain.polynomial import summed
    from cython.cimports.fcm.time_domain.segment_walk import Walk
    from cython.cimports.fcm.time_domain.segments import Segments
else:
    from fcm.time_domain.flow import Flows
    from fcm.time_domain.polynomial import summed
    from fcm.time_domain.segment_walk import Walk
    from fcm.time_domain.segments import Segments

NODES = 8  # integrate exactly polynomials of degree 15
_PLACES, _SHARES = np.polynomial.legendre.leggauss(NODES)
_ON_ONE = 0.5 * (_PLACES + 1.0), 0.5 * _SHARES  # on [0, 1]
_NODES = cython.declare(cython.int, 8)
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
        self._nodes, self._weights = _ON_ONE
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
            for i in range(_NODES):
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
