"""The forces of a contact that slides in a plane, as a law of the balance; see `contact_law`."""

from __future__ import annotations

import cython

from fcm.contact.plane.cycle import PlanarContact
from fcm.contact.plane.margins import PlanarMargins, PlanarMeasures
from fcm.harmonic_balance.contact_law import KernelLaw
from fcm.model.scene import Contact

if cython.compiled:
    from cython.cimports.fcm.contact.contact_kernel import MIXED, STUCK
    from cython.cimports.fcm.contact.periodic.margins import SLIPS
    from cython.cimports.fcm.contact.periodic.motion import TWO_PI
    from cython.cimports.fcm.contact.plane.integrals import CONTACT, SLIPS_X, SLIPS_Y, STICKS
else:
    from fcm.contact.contact_kernel import MIXED, STUCK
    from fcm.contact.periodic.margins import SLIPS
    from fcm.contact.periodic.motion import TWO_PI
    from fcm.contact.plane.integrals import CONTACT, SLIPS_X, SLIPS_Y, STICKS

NAN = cython.declare(cython.double, float("nan"))


@cython.cclass
class PlanarLaw(KernelLaw):
    """The law of a contact in a plane."""

    def __init__(self, kernel: PlanarContact, contact: Contact) -> None:
        self.discs = PlanarMargins(kernel.cycle)
        KernelLaw.__init__(self, kernel, 3, self.discs, contact)
        self.integrals, self.measures = kernel.integrals, PlanarMeasures(kernel.cycle)
        self.state = self.measures.state

    @cython.ccall
    @cython.exceptval(-1.0, check=True)
    def squared_margin(
        self, kind: cython.int, x: cython.double[::1], first: cython.Py_ssize_t
    ) -> cython.double:
        if kind != SLIPS:
            return NAN
        own: cython.double[::1] = x[first : first + self.width]
        grown: cython.double = self.discs.overlap(own, self, False)
        return grown if self.discs.resting.brief() else NAN

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def compute_resistance(self) -> cython.int:
        """The resistance along a direction is k_u while it sticks; mu k_v, by the normal displacement, while
        it slips."""
        rubs: cython.bint = self.mu * self.k_u > 0.0
        stick: cython.double = 0.0
        closed: cython.double = 0.0
        x: cython.double = 0.0
        y: cython.double = 0.0
        if self.kernel.kind == STUCK:
            stick = closed = 1.0
        elif self.kernel.kind == MIXED:
            closed = self.integrals.cos_sum[CONTACT, 0] / TWO_PI
            if rubs:
                stick = self.integrals.cos_sum[STICKS, 0] / TWO_PI
                x, y = (
                    self.integrals.cos_sum[SLIPS_X, 0] / TWO_PI,
                    self.integrals.cos_sum[SLIPS_Y, 0] / TWO_PI,
                )
        self.resistance[0, 0] = self.resistance[1, 1] = stick * self.k_u if rubs else 0.0
        self.resistance[0, 2], self.resistance[1, 2] = x * self.mu * self.k_v, y * self.mu * self.k_v
        self.resistance[2, 2] = closed * self.k_v
        return 0

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def cycle(self, x: cython.double[::1], first: cython.Py_ssize_t) -> cython.int:
        self.forces(x, first, False)
        self.measures.bear(self)
        self.pieces = self.measures.pieces
        self.contact_loads[0], self.contact_loads[1] = (
            self.measures.greatest_load,
            self.measures.greatest_friction,
        )
        self.contact_loads[2], self.contact_loads[3] = self.measures.slip_path, self.measures.dissipation
        return 0
