"""Additional quantities of curves of exact periodic solutions."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
import numpy.typing as npt

from fcm.contact.limits import FloatArray
from fcm.frozen import Frozen
from fcm.results.jumps import FrequencySweep


class Stuck(Frozen):
    """A motion that no point is of, in which contacts stick all through the period."""

    frequency: float  # [rad/s]
    states: tuple[str, ...]  # of each contact: E sticks, or is closed without friction; S is open; or others
    friction: FloatArray  # (contact,) of [start], which leads to it
    least: FloatArray  # (dof,) amplitude over the residual friction of those that stick
    greatest: FloatArray  # (dof,)


@dataclass(eq=False)
class Orbits:
    """Additional quantities at the points of an exact curve, see `fcm.response.exact.trace_exact`."""

    closure_error: FloatArray  # (point,) by which a period fails to close, relative to the motion
    sweep: npt.NDArray[np.str_]  # (point,) 'up' or 'down' if a sweep came to it, else ''
    repeats: FloatArray  # (point,) periods of the force after which the motion repeats, 0 if not after 8
    cycle_least: FloatArray  # (point, dof) least and greatest amplitude of a cycle,
    cycle_greatest: FloatArray  # (point, dof) which differ where the motion does not repeat after each
    family_least: FloatArray  # (point, dof) least and greatest amplitude over the residual friction of
    family_greatest: FloatArray  # (point, dof) contacts that never slip, of stable motions where the point is
    # stable, else of all; nan where unique, or not sought
    family_complete: FloatArray  # (point,) 1 where all of these were reached, 0 where there may be others
    swept: FrequencySweep | None = None  # what slow sweeps met; None where the curve itself tells
    periods: int = 0  # of the motion that were computed to trace the curve
    held: FloatArray = field(default_factory=lambda: np.zeros((0, 2)))  # (contact, 2) what contacts that were
    # left out keep of their slip limits, or of their gaps; nan where computed, no contacts where none was
    doubles: list[float] = field(
        default_factory=list
    )  # [rad/s] where the period doubles to what is not there
    stuck: list[Stuck] = field(default_factory=list)  # beside points of peaks, or visited ones
    span: tuple[float, float] | None = None  # [rad/s] where peaks, folds and jumps alone were sought

    @property
    def visited(self) -> bool:
        """Whether the points are those of frequencies that were visited, and of no curve."""
        return self.swept is not None and self.span is None

    @property
    def unreached(self) -> list[int]:
        """The points at frequencies that were visited to which neither sweep came."""
        return np.flatnonzero(self.sweep == "").tolist() if self.visited else []
