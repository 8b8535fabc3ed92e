"""Points of tracked curves, their endings, and the setup that all curves of a run share."""

from __future__ import annotations

from enum import Enum
from functools import cached_property

import numpy as np

from fcm.frozen import Frozen
from fcm.harmonic_balance.system import System
from fcm.model.scene import FloatArray
from fcm.tracking.extended_system import Condition, ExtendedSystem
from fcm.tracking.options import TRACKING, TrackingOptions
from fcm.tracking.parameter_line import ParameterLine, VariedBalance


class Ending(Enum):
    """Reasons why a tracked curve ended."""

    SPAN = "the number reached an end of its range"
    RANGE = "its frequency left the range that is traced"
    CLOSED = "the curve came back to where it began"
    MET = "another extreme within the cycle became the greatest, and so there is no peak beyond"
    TROUGH = "another extreme within the cycle became the greatest, and the least amplitude is there"
    CORNER = "it goes on as a corner of the response, which cannot be followed there"
    STALLED = "no further point could be found"
    LONG = "there are too many points"
    TURNED = "the number turned back, and only peaks are followed"

    @property
    def whole(self) -> bool:
        """Whether the curve was followed to its end, or to an end of the requested range."""
        return self not in (Ending.CORNER, Ending.STALLED, Ending.LONG)


class TrackedPoint(Frozen):
    """A point of a tracked curve: z = (x, omega, s), its direction in units of z, and marks."""

    z: FloatArray
    direction: FloatArray
    corner: Condition | None = None  # the corner of the response, where this is the special point
    turn: bool = False  # the number turns back
    user_point: bool = False  # the number has a requested value
    switch: bool = False  # a corner becomes the special point, or ceases to be it


class TrackingSetup(Frozen):
    """The setup that all curves of one run share."""

    system: System
    line: ParameterLine
    span: tuple[float, float]  # of s
    user_values: tuple[float, ...] = ()
    step: float = 0.05  # longest step
    peaks_only: bool = False  # end a curve where the number turns back and a peak meets a trough
    options: TrackingOptions = TRACKING

    @cached_property
    def varied(self) -> VariedBalance:
        """The balance that is moved along the line."""
        return VariedBalance(self.system, self.line)

    def tracked(self, condition: Condition) -> ExtendedSystem:
        """The extended system of a condition, with a balance of its own."""
        return ExtendedSystem(self.varied.another(), condition, self.span[1] - self.span[0], self.options)


def kinks(setup: TrackingSetup) -> list[float]:
    """Values of s at which a preload changes sign: there the forces at rest have a kink."""
    loads = np.array([[c.n_0 for c in setup.line.scene(setup.system.scene, s).contacts] for s in setup.span])
    found = set()
    for low, high in loads.T:
        if low * high <= 0.0 and low != high:
            found.add(float(setup.span[0] - low * (setup.span[1] - setup.span[0]) / (high - low)))
    return sorted(found)
