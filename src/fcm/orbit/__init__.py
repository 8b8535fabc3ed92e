"""Periodic motions: shooting, Floquet's multipliers, motions of several periods."""

from fcm.orbit.harmonic import harmonic_state
from fcm.orbit.periodic import Orbit, periodic
from fcm.orbit.shooting import Shooting

__all__ = ["Orbit", "Shooting", "harmonic_state", "periodic"]
