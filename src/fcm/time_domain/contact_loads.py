"""The contact loads over cycles of an exact motion: greatest forces, way of the slip, energy."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from fcm.model.scene import FloatArray
from fcm.time_domain.cycle import Cycle
from fcm.time_domain.cycle_measures import Scanned, scanned


def contact_loads(cycles: Sequence[Cycle], known: Scanned | None = None) -> FloatArray:
    """Greatest normal and friction force of each contact, its slip and its dissipated energy per period of
    the force.

    Parameters
    ----------
    cycles : sequence of Cycle
        Those after which the motion repeats, or some of one that does not.
    known : Scanned, optional
        Extremes of the first.

    Returns
    -------
    (contact, 4) array
        Two forces, a length, and the energy that the slip takes, each in the scene's units.

    Examples
    --------
    >>> import fcm
    >>> from fcm.shooting import periodic
    >>> orbit = periodic(fcm.load_scene("yang1998-n5"), 1.3)  # mu is 0.4
    >>> contact_loads([orbit.cycle]).round(3)
    array([[11.715,  4.686, 14.069, 23.449]])
    """
    out = _of(cycles[0], known)
    for cycle in cycles[1:]:
        more = _of(cycle)
        out[:, :2], out[:, 2:] = np.maximum(out[:, :2], more[:, :2]), out[:, 2:] + more[:, 2:]
    out[:, 2:] /= sum(cycle.duration for cycle in cycles) / cycles[0].system.period
    return out


def _of(cycle: Cycle, known: Scanned | None = None) -> FloatArray:
    """Greatest forces of each contact, and its slip and energy over one whole cycle: (contact, 4)."""
    system, each = cycle.system, len(cycle.system.contacts)
    least, greatest = (known or scanned(system, cycle.segments)).part(system.parts.forces)
    system.run(system.slips, cycle.segments)
    out = np.empty((each, 4))
    out[:, 0] = np.maximum(system.preload + greatest[:each], 0.0)
    out[:, 1] = np.maximum(np.abs(least[each:]), np.abs(greatest[each:]))
    out[:, 2], out[:, 3] = system.slips.paths, system.slips.slips
    return out
