"""The structure's answer to mean forces, rigid-body modes and contacts that act as springs included.

Without stiffness of its own a rigid-body mode has no flexibility. Then the normal springs of the contacts
are counted to the structure, and taken off the contacts' forces again:

    v_mean = -G_k (f_mean - k_v v_mean),    G_k the flexibility with the springs k_v,

which is the same equation, and has its terms finite as long as the closed contacts hold the structure.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fcm.contact.limits import FloatArray
from fcm.response.structure import AnyArray, Group, IntArray, receptance


@dataclass(frozen=True)
class Static:
    """Mean displacements under mean forces, of the curves of a group."""

    receptance: FloatArray  # (curve, port, port)
    flexibility: FloatArray  # (curve, mode), or (curve, mode, mode) where springs join the modes
    counted: FloatArray | None  # (curve, contact) normal stiffness that is counted to the structure

    def take(self, index: IntArray) -> Static:
        """Those of some of the curves."""
        return Static(
            _taken(self.receptance, index),
            _taken(self.flexibility, index),
            None if self.counted is None else _taken(self.counted, index),
        )

    def answer(self, force: FloatArray) -> FloatArray:
        """Modal displacements under modal forces, both (curve, mode)."""
        if self.flexibility.ndim == 2:
            return self.flexibility * force
        displacement: FloatArray = (self.flexibility @ force[..., None])[..., 0]
        return displacement


def static_of(group: Group) -> Static:
    """The static answer of a group's structures."""
    stiffness = group.mass * group.frequency**2
    rigid = bool((group.frequency == 0.0).any())
    if not rigid and group.k_springs.shape[1] == 0:
        return Static(receptance(group, 1.0 / stiffness), 1.0 / stiffness, None)
    matrix = stiffness[:, :, None] * np.eye(stiffness.shape[1])
    matrix = matrix + _normal_springs(group.springs, group.k_springs[:, 1::2], group)
    if rigid:
        matrix = matrix + _normal_springs(group.ports, group.k_v, group)
    flexibility = _inverse(matrix, group)
    ports = group.ports
    return Static(ports.swapaxes(1, 2) @ flexibility @ ports, flexibility, group.k_v if rigid else None)


def _normal_springs(ports: FloatArray, k_v: FloatArray, group: Group) -> FloatArray:
    """Stiffness of springs at the second of each pair of ports (curve, mode, port), by modes."""
    normal = np.where(group.adrift[:, :, None], 0.0, ports[:, :, 1::2])
    matrix: FloatArray = (normal * k_v[:, None, :]) @ normal.swapaxes(1, 2)
    return matrix


def _inverse(matrix: FloatArray, group: Group) -> FloatArray:
    """Inverse of the stiffness (curve, mode, mode); modes adrift stay where they are."""
    curve, mode = np.nonzero(np.broadcast_to(group.adrift, matrix.shape[:2]))
    matrix[curve, mode, mode] = 1.0
    unit = 1.0 / np.sqrt(np.diagonal(matrix, axis1=1, axis2=2))
    both = unit[:, :, None] * unit[:, None, :]
    inverse: FloatArray = np.linalg.inv(matrix * both) * both
    inverse[curve, mode, mode] = 0.0
    return inverse


def _taken(value: AnyArray, index: IntArray) -> AnyArray:
    return value if value.shape[0] == 1 else value[index]
