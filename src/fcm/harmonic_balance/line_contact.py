"""The contact that slides along a line, with mean and any harmonics, its forces exact."""

from __future__ import annotations

import cython

from fcm.contact.periodic.forces import PeriodicContact
from fcm.contact.periodic.margins import Margins, Measures
from fcm.harmonic_balance.contact_law import KernelLaw

if cython.compiled:
    from cython.cimports.fcm.contact.periodic.cycle import NEGATIVE, POSITIVE, SEPARATION, STICK, TWO_PI
    from cython.cimports.fcm.contact.periodic.motion import MIXED
else:
    from fcm.contact.periodic.cycle import NEGATIVE, POSITIVE, SEPARATION, STICK, TWO_PI
    from fcm.contact.periodic.motion import MIXED


@cython.cclass
class LineLaw(KernelLaw):
    """Forces of a periodic motion with their derivatives; the kernel is a workspace, whose array the tangent
    is."""

    def __init__(
        self,
        kernel: PeriodicContact,
        mu: cython.double,
        k_u: cython.double,
        k_v: cython.double,
        n_0: cython.double,
    ) -> None:
        self.kernel, self.bounds = kernel, Margins(kernel.cycle)
        KernelLaw.__init__(self, kernel, 2, self.bounds.most, mu, k_u, k_v, n_0)
        self.state = kernel.cycle.state
        self.measures: Measures | None = None  # made when it is asked for

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def forces(self, x: cython.double[::1], first: cython.Py_ssize_t, tangent: cython.bint) -> cython.int:
        """And their tangent, if that is wanted."""
        self.kernel.evaluate(x, first, self.mu, self.k_u, self.k_v, self.n_0, 0.0, tangent)
        self.take_forces(self.kernel.forces)
        self.nonlinear = self.kernel.kind == MIXED
        return 0

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def bound(self, x: cython.double[::1], first: cython.Py_ssize_t) -> cython.int:
        self.bounds.find(x, first, self.mu, self.k_u, self.k_v, self.n_0)
        return self.take_margins(self.bounds.count, self.bounds.kind, self.bounds.value, self.bounds.angle)

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def compute_resistance(self) -> cython.int:
        p: cython.int
        stick: cython.double = 0.0
        closed: cython.double = 0.0
        pushed: cython.double = 0.0
        for p in range(self.kernel.cycle.pieces):
            state: cython.int = self.kernel.cycle.state[p]
            last: cython.bint = p + 1 == self.kernel.cycle.pieces
            end: cython.double = self.kernel.cycle.begin[0] if last else self.kernel.cycle.begin[p + 1]
            length: cython.double = end - self.kernel.cycle.begin[p]
            while length < 0.0 or (last and length <= 0.0):
                length += TWO_PI
            length /= TWO_PI
            closed += length if state != SEPARATION else 0.0
            stick += length if state == STICK else 0.0
            pushed += length if state == POSITIVE else -length if state == NEGATIVE else 0.0
        self.resistance[0, 0] = stick * self.k_u if self.mu > 0.0 else 0.0
        self.resistance[0, 1] = pushed * self.mu * self.k_v
        self.resistance[1, 1] = closed * self.k_v
        return 0

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def cycle(self, x: cython.double[::1], first: cython.Py_ssize_t) -> cython.int:
        if self.measures is None:
            self.measures = Measures(self.kernel.cycle)
        self.kernel.cycle.take(x, first, self.mu, self.k_u, self.k_v, self.n_0, 0.0)
        self.pieces = self.kernel.cycle.pieces
        self.measures.bear(self.k_u)
        self.contact_loads[0] = max(self.measures.greatest_load, 0.0)
        self.contact_loads[1], self.contact_loads[2] = (
            self.measures.greatest_friction,
            self.measures.slip_path,
        )
        self.contact_loads[3] = self.measures.dissipation
        return 0
