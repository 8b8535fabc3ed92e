"""Points inserted into a path: where stability changes, and within a window between two points."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from fcm.continuation import Mark, Path
from fcm.frozen import Frozen
from fcm.model.scene import FloatArray
from fcm.stability.classification import Bifurcation


class InsertedPoint(Frozen):
    """A point of the curve between two of the path, within a window in which stability differs from both."""

    place: float  # number of the point of the path before it, plus the fraction of the way to the next
    z: FloatArray  # (unknown + 1,)
    direction: FloatArray  # (unknown + 1,) along the curve
    orientation: float
    stable: float = 1.0

    @property
    def after(self) -> int:
        """Number of the point of the path before it."""
        return int(self.place)

    @property
    def mark(self) -> int:
        """Mark of the point: none."""
        return Mark.NONE

    @property
    def frequency(self) -> float:
        """Frequency of the point [rad/s]."""
        return float(self.z[-1])


class MultiplierCrossing(InsertedPoint):
    """A point of the curve at which stability changes without a fold; its own stability is unknown.

    A disturbance neither grows nor decays there, apart from the effect of more harmonics."""

    stable: float = math.nan
    kind: Bifurcation = Bifurcation.NEIMARK_SACKER

    @property
    def mark(self) -> int:
        """Mark of the point: a crossing of multipliers."""
        return Mark.CROSSING


def with_points(path: Path, inserted: Sequence[InsertedPoint]) -> Path:
    """The path with inserted points, in order."""
    if not inserted:
        return path
    at = np.array([one.after for one in inserted]) + 1
    return replace(
        path,
        z=np.insert(path.z, at, [one.z for one in inserted], axis=0),
        direction=np.insert(path.direction, at, [one.direction for one in inserted], axis=0),
        mark=np.insert(path.mark, at, [one.mark for one in inserted]),
        orientation=np.insert(path.orientation, at, [one.orientation for one in inserted]),
    )
