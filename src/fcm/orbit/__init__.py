"""Periodic motions: shooting, Floquet's multipliers, curves of them, motions of several periods."""

from fcm.orbit.branch import Branch, trace_orbits
from fcm.orbit.harmonic import harmonic_state
from fcm.orbit.periodic import Orbit, periodic
from fcm.orbit.problem import OrbitProblem
from fcm.orbit.shooting import Shooting

__all__ = [
    "Branch",
    "Orbit",
    "OrbitProblem",
    "Shooting",
    "harmonic_state",
    "periodic",
    "trace_orbits",
]
