"""Linear responses of a scene whose contacts are springs, or nothing."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from fcm.model.scene import FloatArray, Scene
from fcm.reduction.options import REDUCTION
from fcm.structure.linear import Linear, linear_of
from fcm.structure.loads import driven_harmonics

ComplexArray = npt.NDArray[np.complex128]


def all_springs(scene: Scene) -> FloatArray:
    """Stiffnesses of all contacts, (port,), along their directions."""
    along = scene.directions_of_contact - 1
    return np.array([(*[c.k_u] * along, c.k_v) for c in scene.contacts]).ravel()


def telling_frequencies(scene: Scene, springs: FloatArray) -> FloatArray:
    """Frequencies spread over the range, and those in it at which a driven harmonic is in resonance."""
    low, high = scene.frequency_range
    natural = resonances(scene, springs) * (1.0 + REDUCTION.beside)
    at = np.concatenate([natural / harmonic for harmonic in driven_harmonics(scene)])
    return np.concatenate((np.linspace(low, high, REDUCTION.spread), at[(at > low) & (at < high)]))


def resonances(scene: Scene, springs: FloatArray) -> FloatArray:
    """Natural frequencies with springs (port,) for contacts."""
    return linear_of(scene).stiffened(springs)


def linear_response(scene: Scene, omega: FloatArray, springs: FloatArray) -> ComplexArray:
    """Amplitudes (driven frequency, dof) with springs (port,) for contacts, of one driven harmonic after the
    other."""
    linear = linear_of(scene)
    found = [_answer(linear, k, h, omega, springs) for k, h in enumerate(linear.driven)]
    return np.concatenate(found)


def _answer(linear: Linear, k: int, h: int, omega: FloatArray, springs: FloatArray) -> ComplexArray:
    """To the forces number k, at harmonic h: (frequency, dof)."""
    natural, rate = linear.natural, 2.0 * linear.damping * linear.natural
    w = h * omega[:, None]
    compliance = 1.0 / ((natural - w) * (natural + w) + 1j * rate * w)
    G = np.einsum("ip,wi,iq->wpq", linear.ports, compliance, linear.ports, optimize=True)
    force = linear.force[k] + omega[:, None] ** 2 * linear.square[k]
    external = (compliance * force) @ linear.ports
    matrix = np.eye(springs.size) + G * springs
    ports = np.linalg.solve(matrix, external[..., None])[..., 0]
    load = force - (springs * ports) @ linear.ports.T
    response: ComplexArray = (compliance * load) @ linear.dofs
    return response
