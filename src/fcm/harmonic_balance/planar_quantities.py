"""Points of a balance with contacts that slide in a plane: their motions across, and their friction."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from fcm.harmonic_balance.system import System
from fcm.model.scene import FloatArray


@dataclass(frozen=True)
class PlanarQuantities:
    """Of every point; x(theta) = Re sum_h X_h exp(i h theta), the mean first."""

    motion: npt.NDArray[np.complex128]  # (point, contact, direction, 1 + harmonic) across the contacts
    friction: FloatArray  # (point, contact, 2) amplitude of the fundamental of the friction force
    law: FloatArray  # (contact, 4) mu, k_u, k_v, n_0

    def at(self, rows: npt.NDArray[np.intp]) -> PlanarQuantities:
        """Of some points, with a gap where an index is -1."""
        motion, friction = self.motion[rows], self.friction[rows]
        motion[rows < 0], friction[rows < 0] = np.nan, np.nan
        return PlanarQuantities(motion, friction, self.law)


def planar_quantities(system: System, z: FloatArray) -> PlanarQuantities | None:
    """Motions across contacts, and their friction forces, where one of them slides in a plane."""
    scene, layout, z = system.scene, system.layout, np.ascontiguousarray(z)
    if not scene.planar:
        return None
    motion = np.stack([layout.complex_ports(one).reshape(layout.contacts, 3, -1) for one in z])
    friction, j = np.zeros((len(z), layout.contacts, 2)), 1 + system.harmonics.index(1)
    for i, law in enumerate(system.exact_laws(system.harmonics)):
        for k, one in enumerate(z):
            law.probe(one, i * layout.width)
            force = np.asarray(law.force)[3 * (2 * j - 1) :][:4]
            friction[k, i] = np.hypot(force[::2], force[1::2])
    return PlanarQuantities(motion, friction, np.array([(c.mu, c.k_u, c.k_v, c.n_0) for c in scene.contacts]))
