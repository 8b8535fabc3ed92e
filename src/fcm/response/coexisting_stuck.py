"""Motions with contacts that always stick, at the frequencies of a curve but on none of its branches."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
import numpy.typing as npt

from fcm.distinct_values import distinct_values
from fcm.harmonic_balance.wave_extremes import half_peak_to_peak
from fcm.model.scene import FloatArray, Scene
from fcm.response.friction_extent import FrictionExtent
from fcm.response.options import COEXISTING
from fcm.results.orbits import Stuck
from fcm.shooting.linear_orbits import linear_motions
from fcm.structure.loads import driven_harmonics


def coexisting_stuck(
    scene: Scene,
    rows: Iterable[int],
    frequency: FloatArray,
    regime: npt.NDArray[np.str_],
    others: FrictionExtent,
) -> list[Stuck]:
    """Motions with stuck contacts at the frequencies of points rows that belong to no point or family there.

    frequency (point,), regime (point, contact) : of all points.
    others : the families known at these points.
    """
    found = []
    for omega in distinct_values(frequency[list(rows)]).tolist():
        here = frequency == omega
        across = (frequency[:-1] - omega) * (frequency[1:] - omega) < 0.0
        near = here | np.append(across, False) | np.append(False, across)
        known = {tuple(states) for states in regime[near].tolist()}
        isolated = [one for one in others.isolated if one.frequency == omega]
        least = np.array([*others.least[here], *(one.least for one in isolated)])
        greatest = np.array([*others.greatest[here], *(one.greatest for one in isolated)])
        for one in linear_motions(scene, omega):
            amplitude = half_peak_to_peak(
                (-1j * one.wave @ scene.modal.shapes)[None], driven_harmonics(scene)
            )[0]
            if one.states not in known and not _within(amplitude, least, greatest):
                found.append(Stuck(omega, one.states, 0.0 - one.residual, amplitude, amplitude))
    return found


def _within(amplitude: FloatArray, least: FloatArray, greatest: FloatArray) -> bool:
    """Whether amplitudes (dof,) lie within one of the extents least to greatest, each (extent, dof)."""
    room = COEXISTING.extent_tolerance * greatest
    inside = (amplitude >= least - room) & (amplitude <= greatest + room)
    return bool(inside.all(axis=1).any())
