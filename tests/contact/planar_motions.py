"""Motions in the plane on which the contact is tried."""

from dataclasses import dataclass

import numpy as np

from fcm import planar_forces, planar_gradients
from fcm.contact.contact_kernel import ContactParameters
from fcm.contact.plane.cycle import PlanarContact
from fcm.contact.plane.options import FINE

from .motions import decaying


@dataclass(frozen=True)
class Planar:
    """The arguments of `planar_forces`."""

    u_x: np.ndarray
    u_y: np.ndarray
    v: np.ndarray
    mu: float = 0.5
    k_u: float = 1.0
    k_v: float = 1.0
    n_0: float = 1.0

    def arguments(self):
        return self.u_x, self.u_y, self.v, self.mu, self.k_u, self.k_v, self.n_0

    def forces(self, **options):
        return planar_forces(*self.arguments(), **options)

    def gradients(self, **options):
        return planar_gradients(*self.arguments(), **options)

    @property
    def size(self):
        """k_u times the greatest coefficient."""
        return self.k_u * max(np.abs(self.u_x).max(), np.abs(self.u_y).max())

    def cycle(self):
        """The kernel's cycle."""
        contact, x = kernel(self)
        contact.at(x, ContactParameters(self.mu, self.k_u, self.k_v, self.n_0), gradient=False)
        return contact.cycle

    def sequence(self):
        slider = self.cycle().slider
        return "".join("EPS"[slider.state[i]] for i in range(slider.pieces))


def kernel(case, outputs=None, options=FINE):
    """A contact of the kernel for a motion, and its unknowns."""
    count = max(one.size for one in (case.u_x, case.u_y, case.v))
    x = np.zeros((count, 3), complex)
    for i, one in enumerate((case.u_x, case.u_y, case.v)):
        x[: one.size, i] = one
    harmonics = list(range(1, count))
    contact = PlanarContact(harmonics, list(range(1, (outputs or count - 1) + 1)), options=options)
    return contact, np.concatenate((x[0].real, x[1:].view(float).ravel()))


def random_planar(rng, most=5):
    """1 to `most` harmonics, from circles to nearly straight lines, loads that do and do not vanish."""
    harmonics, decay = int(rng.integers(1, most + 1)), rng.uniform(0.7, 3.0)
    u_x, u_y, v = (decaying(rng, harmonics, decay) for _ in range(3))
    u_y = u_y * 10.0 ** rng.uniform(-3.0, 0.0)
    k_v = 10.0 ** rng.uniform(-1.0, 1.0)
    n_0 = k_v * (rng.normal(0.0, 1.5) if rng.random() < 0.6 else 10.0 ** rng.uniform(0.0, 1.0))
    return Planar(u_x, u_y, v, rng.uniform(0.1, 1.2), 10.0 ** rng.uniform(-0.5, 0.5), k_v, n_0)


def random_planars(n, seed=0, most=5):
    rng = np.random.default_rng(seed)
    return [random_planar(rng, most) for _ in range(n)]
