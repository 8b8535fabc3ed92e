r"""Quasi-static modes, which follow contacts without delay, and their reduction to a few combinations.

With springs k of the contacts' directions, and shapes P on them of modes of mass 1,

    k^(1/2) P^T W^-2 P k^(1/2) = V diag(s) V^T.

s_i is the compliance of the structure along V_i k^(-1/2), relative to the springs. One mode is kept for each
s_i above a tolerance. The modes left out would change the springs by no more than the tolerance.
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
        """Shapes, natural frequencies and damping of the modes that are not far."""
        return self.shapes[~self.far], self.natural[~self.far], self.damping[~self.far]

    @property
    def flexibility(self) -> FloatArray:
        """Flexibility (port, port) of the far modes: displacements under unit forces on the ports."""
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
    """Mask (mode,) of the modes so far above the excitation that they follow without delay.

    With few modes there are none on a line. With contacts in a plane there are, but farther above: time steps
    would have to resolve each of their vibrations.
    """
    times = max(options.structure.above_excitation, options.structure.above_harmonics * max(harmonics))
    if natural.size <= options.structure.many_modes:
        times *= options.structure.above_of_few if planar else np.inf
    far: npt.NDArray[np.bool_] = natural > highest * times
    return far


def combined(shapes: FloatArray, natural: FloatArray, springs: FloatArray, tolerance: float) -> FloatArray:
    """Shapes (mode, direction) of fewer modes, of frequency 1, as compliant as those of frequencies natural.

    Directions without a spring (direction,) are left out: no force acts along them.

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
