r"""What harmonics that a balance leaves out would do, were there no feedback.

The exact friction and normal forces of a motion of few harmonics have all harmonics; what one of them does is
its coefficient times the receptance of the structure at its frequency,

    X_h = -G(h omega) F_h

so that it is the structure as much as the contact that decides which harmonics matter.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np
import numpy.typing as npt

from fcm.contact.periodic.forces import PeriodicContact
from fcm.contact.periodic.workspace import periodic_contact
from fcm.harmonic.points import forces_of
from fcm.harmonic.system import System
from fcm.scene.model import FloatArray
from fcm.structure.answers import Answers

HIGHEST = 50  # harmonic that is looked at, and that a balance may have
AHEAD = 1.5  # times the highest of a balance that is looked at in any case: to have all is not to be exact
FEW = 1000  # modes times ports, up to which a sum over them is faster without BLAS
LEAST_AMPLITUDE = 1e-9  # of the greatest of all degrees of freedom, to which a share is referred


def highest(system: System) -> int:
    """Harmonic up to which the forces of a system's motions are looked at."""
    return max(HIGHEST, int(AHEAD * max(system.harmonics)))


class Further:
    """The harmonics of the exact forces of motions of a system's balance."""

    def __init__(self, system: System) -> None:
        self.system = system
        self.highest = highest(system)
        self.kernel = periodic_contact(system.harmonics, tuple(range(1, self.highest + 1)))
        others = np.ones(self.highest, dtype=np.bool_)
        others[np.array(system.harmonics) - 1] = False
        self.others = np.flatnonzero(others)
        self.orders = 1.0 + self.others.astype(np.float64)
        linear, products = system.linear, system.linear.natural.size * system.linear.ports.shape[1]
        few = system.scene.ring is None and products <= FEW
        own = linear.natural, linear.damping, linear.ports, linear.dofs
        self.answers = Answers(*own) if few else None

    def forces(self, z: FloatArray) -> npt.NDArray[np.complex128]:
        """Of motions (point, unknown + 1): (point, harmonic, port)."""
        out = np.zeros((len(z), self.highest, 2 * len(self.system.scene.contacts)), dtype=np.complex128)
        for j, (made, _) in enumerate(self._each(self.kernel, z)):
            pairs = made[:, 2:].view(np.complex128)
            out[:, :, 2 * j : 2 * j + 2] = pairs.reshape(len(z), self.highest, 2)
        return out

    def linear(self, z: FloatArray) -> npt.NDArray[np.bool_]:
        """Whether no contact slips or separates, so that the forces have no further harmonic, (point,)."""
        kernel = periodic_contact(self.system.harmonics, (1,))
        linear = np.ones(len(z), dtype=np.bool_)
        for _, one in self._each(kernel, z):
            linear &= one > 0.0
        return linear

    def _each(self, kernel: PeriodicContact, z: FloatArray) -> Iterator[tuple[FloatArray, FloatArray]]:
        """Forces (point, equation) of each contact, and 1 where they are linear, else 0."""
        z, width = np.ascontiguousarray(z), 2 + 4 * len(self.system.harmonics)
        for j, c in enumerate(self.system.scene.contacts):
            made, linear = np.empty((len(z), kernel.equations)), np.ones(len(z))
            forces_of(kernel, z, j * width, np.array([c.mu, c.k_u, c.k_v, c.n_0]), made, linear)
            yield made, linear

    def shares(
        self,
        z: FloatArray,
        force: npt.NDArray[np.complex128],
        amplitude: FloatArray,
        known: tuple[int, ...] | None = None,
    ) -> FloatArray:
        """Share of the amplitude (point, dof) that each harmonic left out would have: (point, harmonic).

        The greatest of all degrees of freedom; zero for known harmonics, those of the balance unless others
        are given: then, for harmonics of the balance, what they have. force as by `forces`.
        """
        others, orders = self.others, self.orders
        if known is not None:
            others = np.setdiff1d(np.arange(self.highest), np.array(known) - 1)
            orders = 1.0 + others.astype(np.float64)
        size = np.maximum(amplitude, LEAST_AMPLITUDE * amplitude.max(axis=1, keepdims=True))
        share = np.zeros((len(z), self.highest))
        if self.answers is not None:
            parts = force.view(np.float64).reshape(*force.shape, 2)
            self.answers.shares(orders, np.ascontiguousarray(z[:, -1]), parts, size, share)
            return share
        answer = np.abs(self.system.linear.answers(orders, z[:, -1], force[:, others]))
        share[:, others] = (answer / np.where(size > 0.0, size, np.inf)[:, None, :]).max(axis=2)
        return share


def padded(z: FloatArray, harmonics: Sequence[int], more: Sequence[int]) -> FloatArray:
    """Unknowns (unknown + 1,) of a balance as those of one with other harmonics: what it lacks is zero."""
    width, wide = 2 + 4 * len(harmonics), 2 + 4 * len(more)
    contacts = (len(z) - 1) // width
    out = np.zeros(contacts * wide + 1)
    blocks = out[:-1].reshape(contacts, wide)
    old = z[:-1].reshape(contacts, width)
    blocks[:, :2] = old[:, :2]
    for j, h in enumerate(harmonics):
        if h in more:
            at = 2 + 4 * more.index(h)
            blocks[:, at : at + 4] = old[:, 2 + 4 * j : 6 + 4 * j]
    out[-1] = z[-1]
    return out
