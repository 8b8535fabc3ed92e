"""Motions with further harmonics that are known beside a curve."""

from __future__ import annotations

import numpy as np

from fcm.frozen import Frozen
from fcm.harmonic_balance.system import System
from fcm.model.scene import FloatArray


class KnownMotions(Frozen):
    """Pieces (motion, unknown + 1) of the curve of a balance with some harmonics, in order along it."""

    harmonics: tuple[int, ...]
    pieces: tuple[FloatArray, ...]

    def interpolate(self, system: System, z: FloatArray) -> FloatArray | None:
        """Interpolate the motion (unknown + 1,) at the frequency of a solution z of a system.

        If there are several, it is the one nearest to z; None if there is none.
        """
        here, near = self._with_harmonics(system, z), list[FloatArray]()
        for piece in self.pieces:
            off = piece[:, -1] - z[-1]
            first = np.flatnonzero((off[:-1] * off[1:] <= 0.0) & (off[:-1] != off[1:]))
            part = (off[first] / (off[first] - off[first + 1]))[:, None]
            near += list((1.0 - part) * piece[first] + part * piece[first + 1])
        return min(near, key=lambda one: float(np.linalg.norm(one - here)), default=None)

    def _with_harmonics(self, system: System, z: FloatArray) -> FloatArray:
        return system.with_harmonics(self.harmonics).extended(z, system.harmonics)
