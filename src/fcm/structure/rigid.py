"""Rigid-body modes: those that closed contacts hold, and those that are adrift.

A rigid-body mode has no stiffness. In the mean only normal forces respond to its displacement, as friction
depends on motion and not on place. So the rigid-body modes are rotated, among themselves, into modes that
move some contact along its normal, and modes that move none. The latter are adrift: no mean force depends on
their place, and a mean load accelerates them without end.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import numpy.typing as npt

from fcm.model.scene import FloatArray, Modal, Scene
from fcm.structure.options import RIGID_BODY

BoolArray = npt.NDArray[np.bool_]


def settled(scene: Scene) -> tuple[Modal, BoolArray]:
    """The modes with rigid-body modes rotated into held and adrift ones; mask (mode,) of those adrift."""
    modal = scene.modal
    adrift = np.zeros(modal.frequency.size, dtype=bool)
    rigid = np.flatnonzero(modal.frequency == 0.0)
    if rigid.size == 0:
        return modal, adrift
    unit = modal.shapes[rigid] / np.sqrt(modal.mass[rigid])[:, None]  # of modal mass 1
    turn, size, _ = np.linalg.svd(_normal_motion(scene, unit))
    held = int(np.count_nonzero(size > RIGID_BODY.min_normal_motion * size.max(initial=0.0)))
    shapes, mass = modal.shapes.copy(), modal.mass.copy()
    shapes[rigid], mass[rigid] = turn.T @ unit, 1.0
    adrift[rigid[held:]] = True
    return replace(modal, shapes=shapes, mass=mass), adrift


def _normal_motion(scene: Scene, shapes: FloatArray) -> FloatArray:
    """Motion of shapes (mode, dof) along the normals of the contacts that have a normal stiffness."""
    normals = [contact.normal for contact in scene.contacts if contact.k_v > 0.0]
    directions = np.array(normals).reshape(len(normals), shapes.shape[1]).T
    motion = shapes @ directions
    motion[np.abs(motion) <= RIGID_BODY.rounding * (np.abs(shapes) @ np.abs(directions))] = 0.0
    moved: FloatArray = motion
    return moved
