"""Periodic motions: shooting, Floquet's multipliers, curves of them, motions of several periods."""

from fcm.shooting.harmonic_balance_state import harmonic_state
from fcm.shooting.periodic import Orbit, periodic
from fcm.shooting.problem import OrbitProblem
from fcm.shooting.residual import Shooting
from fcm.shooting.trace import Branch, trace_orbits

__all__ = [
    "Branch",
    "Orbit",
    "OrbitProblem",
    "Shooting",
    "harmonic_state",
    "periodic",
    "trace_orbits",
]
