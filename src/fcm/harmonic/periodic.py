"""The contact with mean and any harmonics, its forces exact."""

from __future__ import annotations

import cython

from fcm.contact.periodic.forces import PeriodicContact
from fcm.contact.periodic.margins import Margins
from fcm.harmonic.law import Law

if cython.compiled:
    from cython.cimports.fcm.contact.periodic.motion import MIXED
    from cython.cimports.fcm.continuation.problem import NONE
else:
    from fcm.contact.periodic.motion import MIXED
    from fcm.continuation.problem import NONE


@cython.cclass
class Periodic(Law):
    """Forces of a periodic motion with their derivatives; contacts may share the kernel, a workspace, whose
    array the tangent is."""

    def __init__(
        self,
        kernel: PeriodicContact,
        mu: cython.double,
        k_u: cython.double,
        k_v: cython.double,
        n_0: cython.double,
    ) -> None:
        self.kernel, self.bounds = kernel, Margins(kernel.cycle)
        Law.__init__(self, kernel.unknowns, self.bounds.most, mu, k_u, k_v, n_0)
        self.tangent = kernel.jacobian

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def evaluate(self, x: cython.double[::1], first: cython.Py_ssize_t) -> cython.int:
        return self.forces(x, first, True)

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def probe(self, x: cython.double[::1], first: cython.Py_ssize_t) -> cython.int:
        return self.forces(x, first, False)

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def forces(self, x: cython.double[::1], first: cython.Py_ssize_t, tangent: cython.bint) -> cython.int:
        """And their tangent, if that is wanted."""
        i: cython.Py_ssize_t
        self.kernel.evaluate(x, first, self.mu, self.k_u, self.k_v, self.n_0, 0.0, tangent)
        for i in range(self.width):
            self.force[i] = self.kernel.forces[i]
        self.force[1] -= max(self.n_0, 0.0)
        self.mixed = self.kernel.kind == MIXED
        return 0

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def bound(self, x: cython.double[::1], first: cython.Py_ssize_t) -> cython.int:
        i: cython.Py_ssize_t
        self.bounds.find(x, first, self.mu, self.k_u, self.k_v, self.n_0)
        for i in range(self.margins):
            self.kind[i] = self.bounds.kind[i] if i < self.bounds.count else NONE
        self.margin[:] = self.bounds.value
        self.angle[:] = self.bounds.angle
        return 0
