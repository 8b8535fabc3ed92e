"""The contact loads over cycles of an exact motion: greatest forces, slip path, energy."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from fcm.model.scene import FloatArray
from fcm.time_domain.cycle import Cycle
from fcm.time_domain.cycle_measures import Scanned, scanned


def contact_loads(cycles: Sequence[Cycle], known: Scanned | None = None) -> FloatArray:
    """Greatest normal and friction force of each contact, and its slip path and energy per forcing period.

    Parameters
    ----------
    cycles : sequence of Cycle
        The cycles after which the motion repeats, or some cycles if it does not repeat.
    known : Scanned, optional
        Extremes over the first cycle.

    Returns
    -------
    (contact, 4) array
        Two forces, a length, and the energy that the slip dissipates, in the scene's units.

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
    """Greatest forces of each contact, and its slip path and energy, over one whole cycle: (contact, 4)."""
    system, each = cycle.system, len(cycle.system.contacts)
    least, greatest = (known or scanned(system, cycle.segments)).part(system.parts.forces)
    system.run(system.slips, cycle.segments)
    out = np.empty((each, 4))
    out[:, 0] = np.maximum(system.preload + greatest[:each], 0.0)
    out[:, 1] = np.maximum(np.abs(least[each:]), np.abs(greatest[each:]))
    out[:, 2], out[:, 3] = system.slips.paths, system.slips.slips
    return out
