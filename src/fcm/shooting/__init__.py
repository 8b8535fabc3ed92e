"""Periodic motions by shooting: Floquet multipliers, continuation, motions of several periods.

The names below are imported on first use, since every response needs the options of this package.
"""

from typing import TYPE_CHECKING

from fcm.lazy_import import on_demand

if TYPE_CHECKING:
    from fcm.shooting.harmonic_balance_state import harmonic_state
    from fcm.shooting.periodic_orbit import Orbit, periodic
    from fcm.shooting.problem import OrbitProblem
    from fcm.shooting.residual import Shooting
    from fcm.shooting.trace import Branch, trace_orbits

__all__ = ["Branch", "Orbit", "OrbitProblem", "Shooting", "harmonic_state", "periodic", "trace_orbits"]

_HOME = {
    "Branch": "trace",
    "Orbit": "periodic_orbit",
    "OrbitProblem": "problem",
    "Shooting": "residual",
    "harmonic_state": "harmonic_balance_state",
    "periodic": "periodic_orbit",
    "trace_orbits": "trace",
}

__getattr__ = on_demand(__name__, _HOME)
