"""Additional quantities of curves of exact periodic solutions."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
import numpy.typing as npt

from fcm.contact.limits import FloatArray
from fcm.frozen import Frozen
from fcm.results.jumps import FrequencySweep


class Stuck(Frozen):
    """A motion in which contacts stick throughout the period, and which no point of the curve represents."""

    frequency: float  # [rad/s]
    states: tuple[str, ...]  # of each contact: E sticks, or is closed without friction; S is open; or others
    friction: FloatArray  # (contact,) friction of [start] that leads to it
    least: FloatArray  # (dof,) least amplitude over the residual friction of the sticking contacts
    greatest: FloatArray  # (dof,)


@dataclass(eq=False)
class Orbits:
    """Additional quantities at the points of an exact curve, see `fcm.response.exact.trace_exact`."""

    closure_error: FloatArray  # (point,) closure error of a period, relative to the motion
    sweep: npt.NDArray[np.str_]  # (point,) 'up' or 'down' if a sweep reached it, else ''
    repeats: FloatArray  # (point,) forcing periods after which the motion repeats; 0 if it does not after 8
    cycle_least: FloatArray  # (point, dof) least and greatest amplitude of a cycle,
    cycle_greatest: FloatArray  # (point, dof) which differ where the motion does not repeat after each
    family_least: FloatArray  # (point, dof) least and greatest amplitude over the residual friction of
    family_greatest: FloatArray  # (point, dof) contacts that never slip, of stable motions where the point is
    # stable, else of all; nan where unique, or not sought
    family_complete: FloatArray  # (point,) 1 if all of these were reached, 0 if there may be others
    swept: FrequencySweep | None = None  # jumps met by slow sweeps; None if the curve itself shows them
    periods: int = 0  # number of periods of the motion computed to trace the curve
    # (contact, 2) margins of contacts that were left out, to their slip limits or of their gaps; nan if
    # computed; empty if none was left out
    held: FloatArray = field(default_factory=lambda: np.zeros((0, 2)))
    doubles: list[float] = field(default_factory=list)  # [rad/s] period doublings to motions not found
    stuck: list[Stuck] = field(default_factory=list)  # at peaks or visited frequencies
    span: tuple[float, float] | None = None  # [rad/s] range in which only peaks, folds and jumps were sought

    @property
    def visited(self) -> bool:
        """Whether the points are those of visited frequencies, and do not form a curve."""
        return self.swept is not None and self.span is None

    @property
    def unreached(self) -> list[int]:
        """The points at visited frequencies that neither sweep reached."""
        return np.flatnonzero(self.sweep == "").tolist() if self.visited else []
