"""Linear responses of a scene whose contacts are springs, or nothing."""

from __future__ import annotations

import numpy as np

from fcm.contact.limits import FloatArray
from fcm.response.structure import ComplexArray, group_of, modal_compliance, receptance, to_ports
from fcm.scene.model import Scene

SPREAD = 24  # frequencies of the range at which linear responses are looked at, besides resonances
BESIDE = 1e-7  # relative distance from a resonance, where nothing is infinite


def all_springs(scene: Scene) -> FloatArray:
    """Stiffnesses of all contacts, (2 contacts,): k_u, k_v of the first, ..."""
    return np.array([k for c in scene.contacts for k in (c.k_u, c.k_v)])


def telling_frequencies(scene: Scene, springs: FloatArray) -> FloatArray:
    """Frequencies spread over the range, and the resonances in it."""
    low, high = scene.frequency_range
    at = resonances(scene, springs) * (1.0 + BESIDE)
    return np.concatenate((np.linspace(low, high, SPREAD), at[(at > low) & (at < high)]))


def resonances(scene: Scene, springs: FloatArray) -> FloatArray:
    """Natural frequencies with springs (2 contacts,) for contacts."""
    group, modal = group_of([scene]), scene.modal
    ports = group.ports[0] / np.sqrt(group.mass[0])[:, None]
    square = np.linalg.eigvalsh(np.diag(modal.frequency**2) + (ports * springs) @ ports.T)
    return np.asarray(np.sqrt(np.maximum(square, 0.0)), dtype=np.float64)


def linear_response(scene: Scene, omega: FloatArray, springs: FloatArray) -> ComplexArray:
    """Amplitudes (frequency, dof) with springs (2 contacts,) for contacts."""
    group = group_of([scene])
    compliance, _ = modal_compliance(group, omega)
    matrix = np.eye(springs.size) + receptance(group, compliance) * springs[:, None]
    external = to_ports(group, compliance * group.force)
    ports = np.linalg.solve(matrix, external[..., None])[..., 0]
    load = group.force - (springs * ports) @ group.ports[0].T
    response: ComplexArray = (compliance * load) @ group.shapes[0]
    return response
