"""Relative motions of the contacts at points of a balance, and their friction amplitudes in a plane."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from fcm.frozen import Frozen
from fcm.harmonic_balance.system import System
from fcm.model.scene import FloatArray


class ContactMotions(Frozen):
    """Relative motions of the contacts; x(theta) = Re sum_h X_h exp(i h theta), the mean first."""

    motion: npt.NDArray[np.complex128]  # (point, contact, direction, 1 + harmonic)
    friction: FloatArray | None  # (point, contact, 2) amplitude of its fundamental, in a plane
    law: FloatArray  # (contact, 4) mu, k_u, k_v, n_0
    start: FloatArray  # (contact, direction) displacements at which they start unstressed

    def at(self, rows: npt.NDArray[np.intp]) -> ContactMotions:
        """The motions of some points; NaN where an index is -1."""
        motion, friction = self.motion[rows], None if self.friction is None else self.friction[rows]
        motion[rows < 0] = np.nan
        if friction is not None:
            friction[rows < 0] = np.nan
        return ContactMotions(motion, friction, self.law, self.start)


def contact_motions(system: System, z: FloatArray) -> ContactMotions | None:
    """Relative motions of the contacts at points z (point, unknown + 1), and their friction in a plane.

    None without contacts, and where all have friction and move on a line in one harmonic: the loops say all.
    """
    scene, layout, z = system.scene, system.layout, np.ascontiguousarray(z)
    by_loops = not scene.planar and len(system.harmonics) == 1 and all(one.mu > 0.0 for one in scene.contacts)
    if not scene.contacts or by_loops:
        return None
    shape = (len(z), layout.contacts, layout.directions, -1)
    motion = np.stack([layout.complex_ports(one) for one in z]).reshape(shape)
    start = scene.sliders().reshape(layout.contacts, layout.directions)
    motion[..., 0] += start
    law = np.array([(c.mu, c.k_u, c.k_v, c.n_0) for c in scene.contacts])
    return ContactMotions(motion, _friction(system, z) if scene.planar else None, law, start)


def _friction(system: System, z: FloatArray) -> FloatArray:
    """Amplitudes (point, contact, 2) of the fundamental of the friction forces in a plane."""
    layout = system.layout
    friction, j = np.zeros((len(z), layout.contacts, 2)), 1 + system.harmonics.index(1)
    for i, law in enumerate(system.exact_laws(system.harmonics)):
        for k, one in enumerate(z):
            law.evaluate_forces(one, i * layout.width)
            force = np.asarray(law.force)[3 * (2 * j - 1) :][:4]
            friction[k, i] = np.hypot(force[::2], force[1::2])
    return friction
