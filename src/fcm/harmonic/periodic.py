"""The contact with mean and any harmonics, its forces exact."""

from __future__ import annotations

import cython

from fcm.contact.periodic.forces import PeriodicContact
from fcm.harmonic.law import Law

OPEN = cython.declare(cython.int, 0)


@cython.cclass
class Periodic(Law):
    """Forces of a periodic motion with their derivatives; contacts may share the kernel, which is a
    workspace."""

    def __init__(
        self,
        kernel: PeriodicContact,
        mu: cython.double,
        k_u: cython.double,
        k_v: cython.double,
        n_0: cython.double,
    ) -> None:
        Law.__init__(self, kernel.unknowns, 0, mu, k_u, k_v, n_0)
        self.kernel = kernel

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def evaluate(self, x: cython.double[::1], first: cython.Py_ssize_t) -> cython.int:
        self.kernel.evaluate(x, first, self.mu, self.k_u, self.k_v, self.n_0, 0.0, True)
        self.force[:] = self.kernel.forces
        self.tangent[:, :] = self.kernel.jacobian
        self.force[1] -= max(self.n_0, 0.0)
        return 0
