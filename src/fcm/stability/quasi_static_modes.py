r"""Quasi-static modes, which follow contacts without delay, and few combinations that yield beside springs.

With springs k of the contacts' directions, and shapes P on them of modes of mass 1,

    k^(1/2) P^T W^-2 P k^(1/2) = V diag(s) V^T.

Under the force that a spring makes of a displacement along V_i k^(-1/2), the structure yields s_i of it. With
more than a mode for each s_i above a tolerance, the springs would change by no more than the tolerance.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from fcm.stability.options import STABILITY, StabilityOptions

FloatArray = npt.NDArray[np.float64]


class PortModes(NamedTuple):
    """Modes of mass 1 on the contacts' ports, of which some follow the contacts' forces without delay."""

    shapes: FloatArray  # (mode, port)
    natural: FloatArray  # (mode,) [rad/s]
    damping: FloatArray  # (mode,) ratio
    far: npt.NDArray[np.bool_]  # (mode,) which follow without delay

    @property
    def near(self) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Shapes, natural frequencies and damping of those that move on their own."""
        return self.shapes[~self.far], self.natural[~self.far], self.damping[~self.far]

    @property
    def flexibility(self) -> FloatArray:
        """Displacements (port, port) of those that follow, under unit forces on the ports."""
        following: FloatArray = self.shapes[self.far]
        found: FloatArray = (following.T * self.natural[self.far] ** -2.0) @ following
        return found


def quasi_static_modes(
    natural: FloatArray,
    highest: float,
    harmonics: Sequence[int],
    planar: bool,
    options: StabilityOptions = STABILITY,
) -> npt.NDArray[np.bool_]:
    """Mask (mode,) of the modes so far above the excitation that they follow without delay: of many modes.

    With contacts in a plane also of few: steps would have to resolve each of their vibrations.
    """
    times = max(options.structure.above_excitation, options.structure.above_harmonics * max(harmonics))
    if natural.size <= options.structure.many_modes:
        times *= options.structure.above_of_few if planar else np.inf
    far: npt.NDArray[np.bool_] = natural > highest * times
    return far


def combined(shapes: FloatArray, natural: FloatArray, springs: FloatArray, tolerance: float) -> FloatArray:
    """Shapes (mode, direction) of modes of frequency 1 that yield as some of frequencies natural (mode,) do.

    Directions without a spring (direction,) are left out: nothing acts along them.

    >>> combined(np.array([[1.0, 0.0], [0.0, 0.1]]), np.array([2.0, 2.0]), np.array([4.0, 4.0]), 0.1)
    array([[0.5, 0. ]])
    """
    root = np.sqrt(springs)
    static = shapes / natural[:, None]
    yielding, along = np.linalg.eigh((static * root).T @ (static * root))
    most = yielding > tolerance
    with np.errstate(divide="ignore"):
        back = np.where(root > 0.0, 1.0 / root, 0.0)
    found: FloatArray = np.sqrt(yielding[most])[:, None] * along[:, most].T * back
    return found
