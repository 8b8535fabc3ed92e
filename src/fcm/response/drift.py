"""Points that are no steady states, or not determined, because of a rigid-body mode.

Friction does not depend on where a mode adrift is, so nothing can balance its mean: the structure creeps
on. And while no closed contact carries any load along the other rigid-body modes, it floats in its gaps.
"""

from __future__ import annotations

import numpy as np

from fcm.contact.limits import FloatArray
from fcm.response.balance import Balance
from fcm.response.law import UNKNOWNS
from fcm.response.rigid import HELD
from fcm.response.structure import BoolArray

BALANCED = 1e-9  # mean friction on a mode, relative to the amplitude of the contact forces on it
CARRYING = 1e-8  # mean normal force of a contact, relative to what it would be if the contact were glued
REASONS = {
    "pushed": "friction pushes the structure one way on average along a rigid-body mode that nothing holds, "
    "so there is no steady state; hold it by a contact along its normal, or by a small modal.frequency",
    "floating": "no closed contact holds the structure along a rigid-body mode: its place is not determined",
}


def undetermined(balance: Balance, z: FloatArray) -> dict[str, BoolArray]:
    """For each of REASONS whether it applies at points z (point, unknown + 1), each (point,)."""
    group = balance.group
    if group.frequency.min() > 0.0:
        return {}
    x = z[:, :-1].reshape(z.shape[0], group.contacts, UNKNOWNS)
    force, _ = balance.law.forces(x)
    return {"pushed": _pushed(balance, force), "floating": _floating(balance, force, x)}


def _pushed(balance: Balance, force: FloatArray) -> BoolArray:
    """Whether the mean friction on a mode adrift is not 0; force (point, contact, 6)."""
    ports = balance.group.ports[:, :, 0::2]  # tangential
    mean = (ports @ force[..., 4, None])[..., 0]
    size = (np.abs(ports) @ np.hypot(force[..., 0], force[..., 1])[..., None])[..., 0]
    pushed: BoolArray = np.any(balance.group.adrift & (np.abs(mean) > BALANCED * size), axis=1)
    return pushed


def _floating(balance: Balance, force: FloatArray, x: FloatArray) -> BoolArray:
    """Whether the contacts that carry load leave a rigid-body mode free, of those that all would hold."""
    group = balance.group
    held = (group.frequency == 0.0) & ~group.adrift
    springs = np.where(held[:, :, None], group.springs[:, :, 1::2], 0.0)
    ports = np.where(held[:, :, None], group.ports[:, :, 1::2], 0.0) * (group.k_v > 0.0)[:, None, :]
    glued = np.abs(group.n_0) + group.k_v * (np.hypot(x[..., 2], x[..., 3]) + np.abs(x[..., 4]))
    carrying = force[..., 5] + np.maximum(group.n_0, 0.0) > CARRYING * glued
    some = ports * carrying[:, None, :]
    springs = np.broadcast_to(springs, (some.shape[0], *springs.shape[1:]))
    size = np.linalg.svd(np.concatenate((some, springs), axis=2), compute_uv=False)
    floating: BoolArray = (size > HELD * size.max(axis=1, initial=0.0, keepdims=True)).sum(axis=1) < held.sum(
        axis=1
    )
    return floating
