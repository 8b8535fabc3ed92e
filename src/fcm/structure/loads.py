"""External forces on the degrees of freedom: harmonic, constant or growing with omega, and static."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from fcm.scene.model import FloatArray, Scene

ComplexArray = npt.NDArray[np.complex128]


class Loads(NamedTuple):
    """The forces are static + Im((constant + omega^2 square) exp(i omega t)), each (dof,)."""

    constant: ComplexArray
    square: ComplexArray  # as of an unbalance; omega in rad/s
    static: FloatArray

    def harmonic(self, omega: float) -> ComplexArray:
        """Amplitudes at a frequency [rad/s]."""
        return self.constant + omega**2 * self.square


def loads_of(scene: Scene) -> Loads:
    """The external forces of a scene.

    Examples
    --------
    >>> import fcm
    >>> loads_of(fcm.load_scene("yang1998-n5")).harmonic(2.0)
    array([1.+0.j, 1.+0.j])
    """
    constant, square = np.zeros((2, len(scene.modal.dofs)), dtype=np.complex128)
    for force in scene.forces:
        onto = square if force.power else constant
        onto += force.direction * force.amplitude * np.exp(1j * force.phase)
    static = np.zeros(len(scene.modal.dofs))
    for load in scene.loads:
        static += load.direction * load.force
    return Loads(constant, square, static)
