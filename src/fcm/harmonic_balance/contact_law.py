"""What a contact is to the balance: forces, their tangent, and margins, from its block of the unknowns.

Of one contact the unknowns are the mean and amplitudes of its displacement along each of its directions, the
last of which is its normal, laid out as in `fcm.structure.layout`. Its forces on the structure are laid out
alike: the friction along its tangential directions, and the normal force, which is that beyond the preload,
n - max(n_0, 0), in equilibrium with the structure at rest.

How many directions there are, which harmonics its forces have, and where they are not smooth is for the law
to say; nothing else knows.
"""

from __future__ import annotations

from typing import Any

import cython
import numpy as np

if cython.compiled:
    from cython.cimports.fcm.continuation.problem import NONE
else:
    from fcm.continuation.problem import NONE

KINDS = cython.declare(cython.int, 9)  # of margins, at most


@cython.cclass
class Law:
    """A contact with so many directions, whose forces may have more harmonics than its motion.

    Attributes
    ----------
    force (equation,), tangent (equation, width)
        By `evaluate`.
    nonlinear
        By `evaluate`: whether it slips or separates within the cycle, so that its forces have harmonics that
        its motion has not.
    margin, kind, angle (margins,)
        By `bound`, as those of a `Problem`, with kinds from 0 to KINDS - 1.
    resistance (direction, direction)
        By `compute_resistance`: derivatives of the forces by the displacements, in the mean over the cycle.
    pieces, state (piece,)
        By `cycle`: the states that follow one another, 0 stick, 1 slip, -1 slip the other way, 2 separation.
    contact_loads (4,)
        By `cycle`: greatest normal force, greatest friction force, way of the slip, and the energy that
        friction takes.
    """

    def __init__(
        self,
        width: cython.int,
        directions: cython.int,
        margins: cython.int,
        mu: cython.double,
        k_u: cython.double,
        k_v: cython.double,
        n_0: cython.double,
    ) -> None:
        self.width, self.directions, self.margins = width, directions, margins
        self.mu, self.k_u, self.k_v, self.n_0, self.nonlinear = mu, k_u, k_v, n_0, False
        self.force, self.tangent = np.zeros(width), np.zeros((width, width))
        self.margin, self.angle = np.ones(margins), np.zeros(margins)
        self.kind = np.arange(margins, dtype=np.intc)
        self.resistance, self.contact_loads = np.zeros((directions, directions)), np.zeros(4)
        self.pieces, self.state = 0, np.zeros(0, dtype=np.intc)

    def set_parameters(self, mu: float, k_u: float, k_v: float, n_0: float) -> None:
        """Take other numbers."""
        self.mu, self.k_u, self.k_v, self.n_0 = mu, k_u, k_v, n_0

    def without_margins(self) -> None:
        """Say of none of the margins that it is one."""
        self.kind[:] = NONE

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
    def compute_resistance(self) -> cython.int:
        """Fill `resistance`, of the motion that was evaluated last."""
        return 0

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def cycle(self, x: cython.double[::1], first: cython.Py_ssize_t) -> cython.int:
        """Go through the cycle of a motion, for its states and what it bears."""
        return 0


@cython.cclass
class KernelLaw(Law):
    """A law with the forces of a kernel, exact for a motion of any harmonics; contacts may share it."""

    def __init__(
        self,
        kernel: Any,
        directions: cython.int,
        margins: cython.int,
        mu: cython.double,
        k_u: cython.double,
        k_v: cython.double,
        n_0: cython.double,
    ) -> None:
        Law.__init__(self, kernel.unknowns, directions, margins, mu, k_u, k_v, n_0)
        self.force, self.tangent = np.zeros(kernel.equations), kernel.jacobian

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
        return 0

    @cython.cfunc
    @cython.exceptval(check=False)
    def take_forces(self, forces: cython.double[::1]) -> cython.void:
        """Those of the kernel, less the preload that the structure at rest balances."""
        i: cython.Py_ssize_t
        for i in range(self.force.shape[0]):
            self.force[i] = forces[i]
        self.force[self.directions - 1] -= max(self.n_0, 0.0)

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def take_margins(
        self, count: cython.int, kind: cython.int[::1], value: cython.double[::1], angle: cython.double[::1]
    ) -> cython.int:
        """So many that were found; the others are none."""
        i: cython.Py_ssize_t
        for i in range(self.margins):
            self.kind[i] = kind[i] if i < count else NONE
        self.margin[:] = value
        self.angle[:] = angle
        return 0


def kind_of(law: Law, i: int, contact: int) -> int:
    """Of the margin i of a contact, which it is among those of all contacts; for problems in Python."""
    return NONE if law.kind[i] == NONE else int(law.kind[i] + contact * KINDS)
