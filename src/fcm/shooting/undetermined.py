"""What is said of a periodic motion that was found, and from which no branch can be followed."""

from __future__ import annotations

import numpy as np

from fcm.model.scene import Scene
from fcm.shooting.options import SHOOTING, ShootingOptions
from fcm.shooting.periodic_orbit import Orbit
from fcm.shooting.residual import Shot
from fcm.units import spoken


def undetermined_reason(orbit: Orbit, options: ShootingOptions = SHOOTING) -> str:
    """That a solution is not determined, and why."""
    unit = orbit.scene.frequency_unit
    where = f"the solution at {spoken(orbit.frequency, unit)} to start from is not determined"
    ratio = orbit.frequency / float(orbit.scene.modal.frequency.max(initial=0.0) or np.inf)
    if ratio > options.search.rounding_frequency:
        return (
            f"{where}: that is {ratio:.1g} times the frequency of the highest mode, which hardly moves, and "
            "loses nothing, in one period of the force; take a lower frequency"
        )
    return (
        f"{where}: a mode is free to drift, or resonates without damping; add damping, or try another range"
    )


def start_reason(scene: Scene, orbit: Orbit, near: Shot) -> str:
    """That its contacts cannot rest where a scene starts."""
    names = " and ".join(scene.contacts[choice.contact].name for choice in near.chosen if choice.gap)
    at = spoken(orbit.frequency, scene.frequency_unit)
    return (
        f"of the solution found at {at} the contact {names} always sticks, on a "
        "residual friction of its own, and with that of [start] there is none near it; give [start] another "
        "friction"
    )
