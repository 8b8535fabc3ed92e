r"""Modes that follow without delay, and few combinations of them that yield beside the springs of contacts.

With springs k of the contacts' directions, and shapes P on them of modes of mass 1,

    k^(1/2) P^T W^-2 P k^(1/2) = V diag(s) V^T.

Under the force that a spring makes of a displacement along V_i k^(-1/2), the structure yields s_i of it. With
more than a mode for each s_i above a tolerance, the springs would change by no more than the tolerance.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

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
