"""The contacts of a free motion; displacements and forces from rest are divided by its amplitude."""

from __future__ import annotations

import numpy as np

from fcm.harmonic_balance.system import System
from fcm.model.scene import FloatArray


class ScaledContacts:
    """Forces and tangents of the contacts, by unknowns laid out as in `fcm.structure.layout`.

    mean_rows (port,) are the indices of the mean displacements, and rows (harmonic, port) those of the real
    parts of the harmonics; the imaginary parts follow them. rest (unknown,): displacements under the static
    loads, about which the contacts move.

    Raises
    ------
    RestError
        If there is no equilibrium with these loads.
    """

    def __init__(self, system: System) -> None:
        self.laws, self._contacts, self._counted = system.laws(), system.scene.contacts, system.linear.counted
        layout = system.layout
        self.width, self.unknowns, self.directions = layout.width, layout.unknowns, layout.directions
        self.mean_rows, self.rows = layout.mean_at, layout.waves_at
        self._springs = np.zeros(self.unknowns)  # of each unknown, if all contacts stick
        self._springs[self.mean_rows] = system.springs(stuck=True)
        self._springs[self.rows] = self._springs[self.rows + 1] = system.springs(stuck=True)
        self.rest = np.zeros(self.unknowns)
        self.rest[self.mean_rows] = system.rest
        self._force_at_rest = np.zeros(self.unknowns)
        if self.rest.any():
            for c, law in enumerate(self.laws):
                law.evaluate(self.rest, c * self.width)
                self._force_at_rest[c * self.width : (c + 1) * self.width] = law.force
        self.force = np.zeros(self.unknowns)
        self.tangent = np.zeros((len(self.laws), self.width, self.width))  # by the contact's own unknowns

    def evaluate(self, x: FloatArray, a: float) -> None:
        """Compute the forces, over a, and their tangents at displacements a x from rest.

        Forces are counted from rest, without those of springs that are counted to the structure.
        """
        w, normal, whole = self.width, self.directions - 1, self.rest + a * x
        for c, law in enumerate(self.laws):
            here = slice(c * w, (c + 1) * w)
            if self._is_linear(c, a * x[here]):
                self.force[here] = self._springs[here] * x[here]
                self.tangent[c] = np.diag(self._springs[here])
            else:
                law.evaluate(whole, c * w)
                self.force[here] = (np.asarray(law.force) - self._force_at_rest[here]) / a
                self.tangent[c] = law.tangent
            at = c * w + normal
            self.force[at] -= self._counted[c] * x[at]
            self.tangent[c, normal, normal] -= self._counted[c]

    def means_at_rest(self) -> FloatArray:
        """Forces at rest (port,), without those of springs that are counted to the structure."""
        found = self._force_at_rest[self.mean_rows]
        found[self.directions - 1 :: self.directions] -= (
            self._counted * self.rest[self.mean_rows][self.directions - 1 :: self.directions]
        )
        return found

    def _is_linear(self, c: int, x: FloatArray) -> bool:
        """Whether a contact surely neither slips nor opens; its springs then avoid rounding by n_0."""
        contact, d = self._contacts[c], self.directions
        size = np.hypot(x[d::2], x[d + 1 :: 2]).reshape(-1, d)
        *along, v = (np.abs(x[:d]) + size.sum(axis=0)).tolist()
        *stretched, pressed = self.rest[c * self.width : c * self.width + d].tolist()
        u = float(np.linalg.norm(along)) + float(np.linalg.norm(stretched))
        least = contact.n_0 + contact.k_v * (pressed - v)
        return bool(least > 0.0 and (contact.mu == 0.0 or contact.k_u * u < contact.mu * least))
