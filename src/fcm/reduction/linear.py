"""Linear responses of a scene with springs, or nothing, in place of contacts."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from fcm.model.scene import FloatArray, Scene
from fcm.reduction.options import REDUCTION
from fcm.structure.linear import Linear, linear_of
from fcm.structure.loads import driven_harmonics
from fcm.structure.receptance import dynamic_stiffness

ComplexArray = npt.NDArray[np.complex128]


def contact_stiffnesses(scene: Scene) -> FloatArray:
    """Stiffnesses (port,) of all contacts along their directions."""
    along = scene.directions_of_contact - 1
    return np.array([(*[c.k_u] * along, c.k_v) for c in scene.contacts]).ravel()


def comparison_frequencies(scene: Scene, springs: FloatArray) -> FloatArray:
    """Frequencies spread over the range, and those within it at which a driven harmonic is in resonance."""
    low, high = scene.frequency_range
    natural = natural_frequencies(scene, springs) * (1.0 + REDUCTION.resonance_offset)
    at = np.concatenate([natural / harmonic for harmonic in driven_harmonics(scene)])
    return np.concatenate((np.linspace(low, high, REDUCTION.frequencies), at[(at > low) & (at < high)]))


def natural_frequencies(scene: Scene, springs: FloatArray) -> FloatArray:
    """Natural frequencies with springs (port,) in place of contacts."""
    return linear_of(scene).stiffened(springs)


def change(full: Scene, fewer: Scene, springs: FloatArray) -> float:
    """Greatest relative change of the linear response between all modes and fewer ones.

    Springs (port,) replace the contacts. The result is of first order in what the fewer modes omit. Only
    systems of the size of the fewer modes are solved; all modes then respond to the known forces.
    """
    omega = comparison_frequencies(fewer, springs)
    linear, few = linear_of(full), linear_of(fewer)
    worst = 0.0
    for k, h in enumerate(linear.driven):
        driven = ModesWithSprings(few, k, omega, springs)
        ports = driven.response @ few.ports
        compliance = 1.0 / dynamic_stiffness(linear.natural, linear.damping, h * omega)
        moved = compliance * (_force(linear, k, omega) - (springs * ports) @ linear.ports.T)
        error = moved @ linear.ports - ports
        error -= driven.solved((springs * error) @ few.ports.T) @ few.ports
        moved -= compliance * ((springs * error) @ linear.ports.T)
        whole = moved @ linear.dofs
        size = np.abs(whole).max(axis=1)
        off = np.abs(whole - driven.response @ few.dofs).max(axis=1)
        worst = max(worst, float((off / np.where(size > 0.0, size, 1.0)).max()))
    return worst


class ModesWithSprings:
    """The modes with springs (port,) in place of contacts, at frequencies omega (frequency,).

    response (frequency, mode): amplitudes under the forces of harmonic `linear.driven[k]`.
    """

    def __init__(self, linear: Linear, k: int, omega: FloatArray, springs: FloatArray) -> None:
        stiffness = dynamic_stiffness(linear.natural, linear.damping, linear.driven[k] * omega)
        held = (linear.ports * springs) @ linear.ports.T
        self.matrix = stiffness[..., None] * np.eye(linear.natural.size) + held
        self.response = self.solved(_force(linear, k, omega))

    def solved(self, force: ComplexArray) -> ComplexArray:
        """Amplitudes (frequency, mode) under modal forces of the same shape."""
        return np.asarray(np.linalg.solve(self.matrix, force[..., None])[..., 0])


def _force(linear: Linear, k: int, omega: FloatArray) -> ComplexArray:
    """The modal forces (frequency, mode) of harmonic `linear.driven[k]`."""
    return np.asarray(linear.force[k] + omega[:, None] ** 2 * linear.square[k])
