"""The contacts of a free motion, whose displacements and forces are divided by the amplitude of its mode."""

from __future__ import annotations

import numpy as np

from fcm.harmonic.system import System
from fcm.scene.model import FloatArray


class ScaledContacts:
    """Unknowns as in `law`, contact by contact; mean_rows (port,) and rows (harmonic, port) say which they
    are of each displacement, the latter that of its Re, before that of its Im."""

    def __init__(self, system: System) -> None:
        self.laws, self._contacts, self._counted = system.laws(), system.scene.contacts, system.linear.counted
        harmonics, count = len(system.harmonics), len(self.laws)
        self.width, self.unknowns = 2 + 4 * harmonics, (2 + 4 * harmonics) * count
        p = np.arange(2 * count)
        self.mean_rows = (p // 2) * self.width + p % 2
        self.rows = (p // 2) * self.width + 2 + 4 * np.arange(harmonics)[:, None] + 2 * (p % 2)
        self._springs = np.zeros(self.unknowns)  # of each unknown's displacement, where all stick
        self._springs[self.mean_rows] = system.springs(stuck=True)
        self._springs[self.rows] = self._springs[self.rows + 1] = system.springs(stuck=True)
        self.force = np.zeros(self.unknowns)
        self.tangent = np.zeros((self.unknowns, self.unknowns))

    def evaluate(self, x: FloatArray, a: float) -> None:
        """Forces over a and their tangents at displacements a x, without those counted to the structure."""
        w = self.width
        for c, law in enumerate(self.laws):
            here = slice(c * w, (c + 1) * w)
            if self._held(c, a * x[here]):
                self.force[here] = self._springs[here] * x[here]
                self.tangent[here, here] = np.diag(self._springs[here])
            else:
                law.evaluate(a * x, c * w)
                self.force[here] = np.asarray(law.force) / a
                self.tangent[here, here] = law.tangent
            self.force[c * w + 1] -= self._counted[c] * x[c * w + 1]
            self.tangent[c * w + 1, c * w + 1] -= self._counted[c]

    def _held(self, c: int, x: FloatArray) -> bool:
        """Whether a contact surely neither slips nor opens: then two springs, without rounding by n_0."""
        contact = self._contacts[c]
        size = np.hypot(x[2::2], x[3::2])
        u, v = abs(x[0]) + size[::2].sum(), abs(x[1]) + size[1::2].sum()
        least = contact.n_0 - contact.k_v * v
        return bool(least > 0.0 and (contact.mu == 0.0 or contact.k_u * u < contact.mu * least))
