"""Finds the modes that the forces of a scene excite, and questions forces that excite none."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from fcm.model.question import Question
from fcm.model.scene import FloatArray, Scene
from fcm.scene.contact_springs import stuck_stiffness
from fcm.scene.options import MESSAGES, TOLERANCES
from fcm.units import UNIT


def pushed(scene: Scene, turn: FloatArray) -> NDArray[np.bool_]:
    """Mask (combination,) of combinations turn (combination, mode) of modes of mass 1 that forces excite.

    A projection of a force that is rounding counts as zero.
    """
    mass_one = scene.modal.shapes / np.sqrt(scene.modal.mass)[:, None]
    directions = np.array([one.direction for one in scene.forces]).reshape(-1, mass_one.shape[1]).T
    size = np.abs(mass_one).max(axis=0) @ np.abs(directions)
    found: NDArray[np.bool_] = (np.abs(turn @ mass_one @ directions) > TOLERANCES.displacement * size).any(
        axis=1
    )
    return found


def question_of_forces(scene: Scene) -> list[str]:
    """Question about forces that excite no mode up to `range_near` times the end of the range.

    Modes with contacts open and with contacts stuck count. There is none for rings, nor without such modes.
    """
    if scene.ring is not None or not scene.has_range or not scene.forces:
        return []
    highest = MESSAGES.range_near * scene.frequency_range[1] * max(one.harmonic for one in scene.forces)
    modal = scene.modal
    opened = (modal.frequency <= highest) & (
        np.arange(modal.frequency.size) < modal.frequency.size - modal.added
    )
    if not opened.any() or pushed(scene, np.eye(opened.size)[opened]).any():
        return []
    squares, turn = np.linalg.eigh(stuck_stiffness(scene))
    if pushed(scene, turn.T[squares <= highest**2]).any():
        return []
    unit = scene.frequency_unit
    return [
        Question(
            f"the forces push none of the modes up to {highest / UNIT[unit]:.6g} {unit}, so that there is no "
            "resonance. Are the place and the direction of the force those meant? fcm plot modes has the "
            "share of each mode"
        )
    ]
