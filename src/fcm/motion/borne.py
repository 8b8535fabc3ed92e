"""What contacts bear over cycles of an exact motion: greatest forces, way of the slip, energy."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from fcm.motion.cycle import Cycle
from fcm.motion.energy import powers_of
from fcm.scene.model import FloatArray


def borne(cycles: Sequence[Cycle]) -> FloatArray:
    """Of each contact the greatest normal and friction force; slip and energy in a period of the force.

    Parameters
    ----------
    cycles : sequence of Cycle
        Those after which the motion repeats, or some of one that does not.

    Returns
    -------
    (contact, 4) array
        Two forces, a length, and the energy that the slip takes, each in the scene's units.

    Examples
    --------
    >>> import fcm
    >>> from fcm.orbit import periodic
    >>> orbit = periodic(fcm.load_scene("yang1998-n5"), 1.3)  # mu is 0.4
    >>> borne([orbit.cycle]).round(3)
    array([[11.715,  4.686, 14.069, 23.449]])
    """
    greatest = np.max([_greatest(cycle) for cycle in cycles], axis=0)
    slip = np.sum([_slip(cycle) for cycle in cycles], axis=0)
    periods = sum(cycle.duration for cycle in cycles) / cycles[0].system.period
    together: FloatArray = np.concatenate((greatest, slip / periods)).T
    return together


def _greatest(cycle: Cycle) -> FloatArray:
    """The greatest normal and friction force of each contact: (2, contact)."""
    system, each = cycle.system, len(cycle.system.contacts)
    system.run(system.forces, cycle.segments)
    least, greatest = np.asarray(system.forces.least), np.asarray(system.forces.greatest)
    load = np.maximum(system.preload + greatest[:each], 0.0)
    return np.array([load, np.maximum(np.abs(least[each:]), np.abs(greatest[each:]))])


def _slip(cycle: Cycle) -> FloatArray:
    """The way that each contact slips, and the energy that this takes: (2, contact)."""
    powers = powers_of(cycle, everywhere=False)
    return np.array([powers.paths, powers.slips])
