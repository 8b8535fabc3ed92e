"""What is kept of a periodic solution on a curve: everything that is reported, without its motion in time."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from fcm.motion.measure import Measure
from fcm.motion.state import State
from fcm.orbit.periodic import closed, within_unit_circle
from fcm.orbit.steady import Steady
from fcm.scene.model import FloatArray
from fcm.simulate.arc import Point


@dataclass(frozen=True)
class Sample:
    """A periodic solution, and where on its curve it is (in units of scale, the frequency last)."""

    frequency: float  # [rad/s]
    state: State  # at the forces' angle 0
    states: tuple[str, ...]  # of each contact over the period
    measure: Measure
    multipliers: npt.NDArray[np.complex128]  # Floquet's, the greatest first
    residual: float  # by which the period fails to close, relative to the motion
    z: FloatArray  # (unknown + 1,)
    scale: FloatArray
    tangent: FloatArray
    orientation: float
    steady: Steady | None = None  # how it repeats or ranges, where it does not after every period

    @property
    def repeats(self) -> int:
        """Periods of the force after which the motion repeats, 0 if it does not."""
        return 1 if self.steady is None else self.steady.periods

    @property
    def stable(self) -> bool:
        """Whether small disturbances die out, or at least do not grow."""
        return within_unit_circle(self.multipliers)


def sampled(point: Point) -> Sample:
    """What is kept of a point."""
    orbit = closed(point.shot)
    return Sample(
        orbit.frequency, orbit.state, orbit.states, orbit.measure, orbit.multipliers, orbit.residual,
        point.z, point.scale, point.tangent, point.orientation,
    )  # fmt: skip


def settled(omega: float, motion: Steady) -> Sample:
    """What is kept of a motion that a simulation has come to."""
    none = np.zeros(0)
    return Sample(
        omega, motion.state, motion.states, motion.measure, motion.multipliers, motion.error,
        none, none, none, 0.0, motion,
    )  # fmt: skip


def distance(one: Sample, other: Sample) -> float:
    """Of two solutions, relative to their size."""
    return float(np.linalg.norm((one.z - other.z) / one.scale))
