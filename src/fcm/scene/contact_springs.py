"""Stiffness matrices with contact springs, in coordinates of modes of mass 1."""

from __future__ import annotations

import numpy as np

from fcm.model.scene import FloatArray, Scene


def along_contacts(scene: Scene, normal: bool) -> FloatArray:
    """Displacements (mode, direction) of modes of mass 1 along contact normals, or sliding directions."""
    each = [one.directions[-1:] if normal else one.directions[:-1] for one in scene.contacts]
    moved: FloatArray = scene.modal.shapes @ np.array([one for many in each for one in many]).T
    return moved / np.sqrt(scene.modal.mass)[:, None]


def closed_stiffness(scene: Scene) -> FloatArray:
    """The stiffness (mode, mode) with all contacts closed and without friction, in modes of mass 1."""
    normal = along_contacts(scene, normal=True)
    found: FloatArray = np.diag(scene.modal.frequency**2)
    return found + (normal * [one.k_v for one in scene.contacts]) @ normal.T


def sticking_stiffness(scene: Scene) -> FloatArray:
    """Stiffness (mode, mode) that sticking contacts add by friction, in modes of mass 1."""
    along = along_contacts(scene, normal=False)
    k_u = [one.k_u for one in scene.contacts for _ in one.directions[:-1]]
    found: FloatArray = (along * k_u) @ along.T
    return found


def stuck_stiffness(scene: Scene) -> FloatArray:
    """The stiffness (mode, mode) with all contacts stuck, in modes of mass 1."""
    return closed_stiffness(scene) + sticking_stiffness(scene)
