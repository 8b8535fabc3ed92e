"""What a contact is to the balance: forces, their tangent, and margins, from its block of the unknowns.

Of one contact with the harmonics h_1 < h_2 < ... of the balance the unknowns are

    u_0, v_0, Re U_1, Im U_1, Re V_1, Im V_1, Re U_2, ...      u = u_0 + Re sum_j U_j exp(i h_j theta)

the mean and amplitudes of its tangential displacement u and its normal displacement v. Its forces on the
structure, friction f and normal force n, are laid out alike. The normal force is that beyond the preload,
n - max(n_0, 0), which is in equilibrium with the structure at rest.
"""

from __future__ import annotations

import cython
import numpy as np

if cython.compiled:
    from cython.cimports.fcm.continuation.problem import NONE
else:
    from fcm.continuation.problem import NONE

KINDS = cython.declare(cython.int, 9)  # of margins, at most


@cython.cclass
class Law:
    """A contact; force (width,) and tangent (width, width) by `evaluate`; margin, kind and angle
    (margins,) by `bound`, as those of a `Problem`, with kinds from 0 to KINDS - 1; mixed by `evaluate`:
    whether it slips or separates within the cycle, so that its forces have harmonics that its motion has
    not."""

    def __init__(
        self,
        width: cython.int,
        margins: cython.int,
        mu: cython.double,
        k_u: cython.double,
        k_v: cython.double,
        n_0: cython.double,
    ) -> None:
        self.width, self.margins = width, margins
        self.mu, self.k_u, self.k_v, self.n_0, self.mixed = mu, k_u, k_v, n_0, False
        self.force, self.tangent = np.zeros(width), np.zeros((width, width))
        self.margin, self.angle = np.ones(margins), np.zeros(margins)
        self.kind = np.arange(margins, dtype=np.intc)

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def evaluate(self, x: cython.double[::1], first: cython.Py_ssize_t) -> cython.int:
        """Forces and their derivatives at the unknowns of the contact, which begin at x[first]."""
        return 0

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def probe(self, x: cython.double[::1], first: cython.Py_ssize_t) -> cython.int:
        """The forces alone, where that costs less."""
        return self.evaluate(x, first)

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def bound(self, x: cython.double[::1], first: cython.Py_ssize_t) -> cython.int:
        """Functions of the unknowns that change sign where the forces are not smooth."""
        return 0

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def refine(self, exact: cython.bint) -> cython.int:
        """Evaluate the law itself from now on, or an approximation of it if it has one."""
        return 0


def kind_of(law: Law, i: int, contact: int) -> int:
    """Of the margin i of a contact, which it is among those of all contacts; for problems in Python."""
    return NONE if law.kind[i] == NONE else int(law.kind[i] + contact * KINDS)
