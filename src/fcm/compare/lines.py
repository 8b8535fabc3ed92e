"""What every method yields, in one form: curves as lines through points, their peaks and their folds."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
import numpy.typing as npt

from fcm.results.result import Curve

FloatArray = npt.NDArray[np.float64]


@dataclass(frozen=True)
class Line:
    """One response curve: half the peak-to-peak displacement against frequency.

    Branches that do not hang together follow one another, with a point of NaN between them.
    """

    frequency: FloatArray  # (point,) [rad/s]
    amplitude: FloatArray  # (point, dof)
    peaks: Mapping[str, tuple[float, float]]  # of each dof: amplitude, frequency [rad/s]
    folds: Sequence[float]  # [rad/s] in the order along the curve
    complete: bool
    reason: str = ""
    truncation: Mapping[str, float] = field(default_factory=dict)  # estimate at each peak [-]
    evaluations: int = 0  # of the equations; periods of the exact motion

    @property
    def points(self) -> int:
        """Number of points."""
        return int(np.isfinite(self.frequency).sum())

    def branches(self) -> list[tuple[FloatArray, FloatArray]]:
        """Frequency and amplitude of each part that hangs together."""
        gaps = np.flatnonzero(np.isnan(self.frequency))
        parts = zip(np.split(self.frequency, gaps), np.split(self.amplitude, gaps), strict=True)
        known = ((w[np.isfinite(w)], a[np.isfinite(w)]) for w, a in parts)
        return [(w, a) for w, a in known if w.size]


def line_of(curve: Curve) -> Line:
    """A curve of harmonic balance."""
    estimate = {dof: peak.error for dof, peak in curve.peaks.items()}
    return Line(
        curve.frequency, curve.amplitude, heights(curve), curve.folds, curve.complete, curve.reason,
        estimate, curve.evaluations,
    )  # fmt: skip


def heights(curve: Curve) -> dict[str, tuple[float, float]]:
    """Peaks without their errors."""
    return {dof: (peak.amplitude, peak.frequency) for dof, peak in curve.peaks.items()}
