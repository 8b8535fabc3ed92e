"""Loops over the points of a curve that need no Python: amplitudes, forces, cycles."""

from __future__ import annotations

import cython
import numpy as np

from fcm.harmonic_balance.contact_law import Law
from fcm.harmonic_balance.residual import Balance


@cython.cclass
class Points:
    """`take` points (point, unknown + 1) and directions there, and have what the balance says of each.

    re, im (point, harmonic, dof), mean, amplitude, growth (point, dof), force (point, unknown): see
    `Displacements`; the growth is that along the direction. linear (point,): 1 where no contact slips or
    separates, else 0.
    """

    def __init__(self, balance: Balance, count: cython.int) -> None:
        shown = balance.shown
        dofs, harmonics = shown.dofs, balance.seen.count
        self.balance = balance
        self.re, self.im = np.zeros((2, count, harmonics, dofs))
        self.mean, self.amplitude, self.growth = np.zeros((3, count, dofs))
        self.force, self.linear = np.zeros((count, balance.unknowns)), np.ones(count, dtype=np.intc)

    def take(
        self,
        z: cython.double[:, ::1],
        direction: cython.double[:, ::1],
        level: cython.double[::1],
    ) -> Points:
        """With the forces times level (point,)."""
        b: Balance = self.balance
        i: cython.Py_ssize_t
        d: cython.Py_ssize_t
        j: cython.Py_ssize_t
        for i in range(z.shape[0]):
            b.load = level[i]
            b.pushed(z[i], True)
            b.report(z[i], direction[i])
            for d in range(b.shown.dofs):
                self.mean[i, d], self.amplitude[i, d] = b.shown.mean[d], b.shown.amplitude[d]
                self.growth[i, d] = b.shown.growth[d]
                for j in range(b.seen.count):
                    self.re[i, j, d], self.im[i, j, d] = b.shown.re[j, d], b.shown.im[j, d]
            for j in range(b.unknowns):
                self.force[i, j] = b.force[j]
            for j in range(b.contacts):
                law: Law = b.laws[j]
                if law.mixed:
                    self.linear[i] = 0
        return self


def cycles_of(
    law: Law,
    x: cython.double[:, ::1],
    first: cython.Py_ssize_t,
    state: cython.int[:, ::1],
    borne: cython.double[:, ::1],
) -> None:
    """The cycles of a contact whose motions begin at x[:, first].

    state (point, piece): beyond the last as before. borne (point, 4): see `Law`.
    """
    i: cython.Py_ssize_t
    p: cython.int
    for i in range(x.shape[0]):
        law.cycle(x[i], first)
        for p in range(law.pieces):
            state[i, p] = law.state[p]
        for p in range(4):
            borne[i, p] = law.borne[p]
