"""Points that are no steady states, or not determined, because of a rigid-body mode.

Friction does not depend on where a mode adrift is, so nothing can balance its mean: the structure creeps
on. And while no closed contact carries any load along the other rigid-body modes, it floats in its gaps.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from fcm.harmonic_balance.system import System
from fcm.model.scene import FloatArray
from fcm.structure.options import RIGID_BODY

BoolArray = npt.NDArray[np.bool_]
REASONS = {
    "pushed": "friction pushes the structure one way on average along a rigid-body mode that nothing holds, "
    "so there is no steady state; hold it by a contact along its normal, or by {}",
    "floating": "no closed contact holds the structure along a rigid-body mode: its place is not determined",
}


def undetermined(system: System, z: FloatArray, force: FloatArray) -> dict[str, BoolArray]:
    """For each of REASONS whether it applies at points z (point, unknown + 1), each (point,).

    force (point, unknown): of the contacts, laid out as the unknowns.
    """
    if system.linear.natural.size == 0 or system.linear.natural.min() > 0.0:
        return {}
    blocks, forces = system.layout.blocks(z), system.layout.blocks(force)
    return {"pushed": _pushed(system, forces), "floating": _floating(system, blocks, forces)}


def _pushed(system: System, force: FloatArray) -> BoolArray:
    """Whether the mean friction on a mode adrift is not 0; force (point, contact, width)."""
    layout = system.layout
    d, first = layout.directions, layout.directions + layout.stride * system.harmonics.index(1)
    mean, size = np.zeros((2, len(force), system.linear.natural.size))
    for along in range(d - 1):
        ports, at = system.linear.ports[:, along::d], first + 2 * along
        mean += force[:, :, along] @ ports.T
        size += np.hypot(force[:, :, at], force[:, :, at + 1]) @ np.abs(ports).T
    pushed: BoolArray = np.any(
        system.linear.adrift & (np.abs(mean) > system.options.rigid.friction_tolerance * size), axis=1
    )
    return pushed


def _floating(system: System, x: FloatArray, force: FloatArray) -> BoolArray:
    """Whether the contacts that carry load leave a rigid-body mode free, of those that all would hold."""
    contacts, linear = system.scene.contacts, system.linear
    k_v, n_0 = np.array([c.k_v for c in contacts]), np.array([c.n_0 for c in contacts])
    held = (linear.natural == 0.0) & ~linear.adrift
    ports = np.where(held[:, None], linear.normal, 0.0) * (k_v > 0.0)
    layout, j = system.layout, system.harmonics.index(1)
    mean = layout.directions - 1
    first = layout.directions + layout.stride * j + 2 * mean
    glued = np.abs(n_0) + k_v * (np.hypot(x[:, :, first], x[:, :, first + 1]) + np.abs(x[:, :, mean]))
    normal = force[:, :, mean] + linear.counted * x[:, :, mean] + np.maximum(n_0, 0.0)
    carrying = normal > system.options.rigid.load_tolerance * glued
    size = np.linalg.svd(ports[None] * carrying[:, None, :], compute_uv=False)
    largest = size.max(axis=1, initial=0.0, keepdims=True)
    floating: BoolArray = (size > RIGID_BODY.min_normal_motion * largest).sum(axis=1) < held.sum()
    return floating
