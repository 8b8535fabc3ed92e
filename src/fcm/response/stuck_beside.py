"""Motions beside those of a curve: contacts stick all through them, and no branch that was found has them."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
import numpy.typing as npt

from fcm.orbit.linear_motion import Linear, linear_motions
from fcm.results.orbits import Stuck
from fcm.scene.model import FloatArray, Scene

SAME = 1e-3  # relative difference of amplitudes up to which a motion is within an extent


def stuck_beside(
    scene: Scene,
    rows: Iterable[int],
    frequency: FloatArray,
    regime: npt.NDArray[np.str_],
    extent: tuple[FloatArray, FloatArray],
) -> list[Stuck]:
    """Those at the frequencies of some points that are not of a point there, nor in the extent of its family.

    frequency, regime, extent : of all points, (point,), (point, contact) and twice (point, dof).
    """
    found = []
    for omega in np.unique([frequency[k] for k in rows]).tolist():
        here = frequency == omega
        across = (frequency[:-1] - omega) * (frequency[1:] - omega) < 0.0
        near = here | np.append(across, False) | np.append(False, across)
        known = {tuple(states) for states in regime[near].tolist()}
        least, greatest = extent[0][here], extent[1][here]
        for one in linear_motions(scene, omega):
            if one.states not in known and not _within(scene, one, least, greatest):
                found.append(Stuck(omega, one.states, 0.0 - one.residual))
    return found


def _within(scene: Scene, one: Linear, least: FloatArray, greatest: FloatArray) -> bool:
    """Whether its amplitudes lie in the extent of a point."""
    amplitude, room = np.abs(scene.modal.shapes.T @ one.wave), SAME * greatest
    inside = (amplitude >= least - room) & (amplitude <= greatest + room)
    return bool(inside.all(axis=1).any())
