"""The level of the forces as the parameter of the exact motion: all harmonic ones times it, at a frequency.

Rest is the motion at the level 0. The curve from there passes the level 1 at every motion that hangs together
with it, also at those that no sweep of the frequency from an end of the range comes to.
"""

from __future__ import annotations

from fcm.model.scene import FloatArray, Scene
from fcm.shooting.options import SHOOTING, ShootingOptions
from fcm.shooting.problem import OrbitProblem
from fcm.shooting.residual import Shot
from fcm.time_domain.errors import SimulationError


class LevelProblem(OrbitProblem):
    """The closure of one period at omega [rad/s], z = (q, q', f, level) at the forces' angle 0."""

    def __init__(self, scene: Scene, omega: float, options: ShootingOptions = SHOOTING) -> None:
        super().__init__(scene, options=options)
        self.omega = omega

    def _made(self, z: FloatArray) -> Shot | None:
        self.periods += 1
        try:
            return self.shooting.residual(z[:-1], self.omega, float(z[-1]), by_level=True)
        except SimulationError:
            return None

    def measure(self, z: FloatArray) -> int:
        """See `OrbitProblem`."""
        super().measure(z)
        self._scale[-1] = max(abs(float(z[-1])), self.options.level.level_floor)
        return 0

    def report(self, z: FloatArray, direction: FloatArray) -> int:
        """Nothing: only what the level passes matters."""
        return 0


class ProblemAtLevel(OrbitProblem):
    """The closure of one period, z = (q, q', f, omega), with all harmonic forces times its `load`."""

    @property
    def load(self) -> float:
        """The level of the forces."""
        return self._load

    @load.setter
    def load(self, level: float) -> None:
        self._load = level
        self.forget()

    def _made(self, z: FloatArray) -> Shot | None:
        self.periods += 1
        try:
            return self.shooting.residual(z[:-1], float(z[-1]), self._load)
        except SimulationError:
            return None
