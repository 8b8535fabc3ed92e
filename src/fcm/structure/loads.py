"""External forces on the degrees of freedom: harmonic, constant or growing with omega, and static."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from fcm.model.scene import FloatArray, Scene

ComplexArray = npt.NDArray[np.complex128]


class Loads(NamedTuple):
    """External forces: static + Im(sum_h (constant_h + omega^2 square_h) exp(i h omega t))."""

    harmonics: tuple[int, ...]  # (driven,) h: 1, and the harmonics of forces
    constant: ComplexArray  # (driven, dof)
    square: ComplexArray  # (driven, dof) as of an unbalance, with omega in rad/s
    static: FloatArray  # (dof,)

    def at(self, omega: float) -> ComplexArray:
        """Force amplitudes (driven, dof) at a frequency [rad/s]."""
        return self.constant + omega**2 * self.square


def driven_harmonics(scene: Scene) -> tuple[int, ...]:
    """The harmonics of the forces, and always 1, in ascending order."""
    return tuple(sorted({1, *(force.harmonic for force in scene.forces)}))


def loads_of(scene: Scene) -> Loads:
    """The external forces of a scene.

    Examples
    --------
    >>> import fcm
    >>> loads_of(fcm.load_scene("yang1998-n5")).at(2.0)
    array([[1.+0.j, 1.+0.j]])
    """
    harmonics = driven_harmonics(scene)
    constant, square = np.zeros((2, len(harmonics), len(scene.modal.dofs)), dtype=np.complex128)
    for force in scene.forces:
        onto = (square if force.power else constant)[harmonics.index(force.harmonic)]
        onto += force.direction * force.amplitude * np.exp(1j * force.phase)
    static = np.zeros(len(scene.modal.dofs))
    for load in scene.loads:
        static += load.direction * load.force
    return Loads(harmonics, constant, square, static)
