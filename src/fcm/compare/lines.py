"""Results of every method in one form: curves as polylines, with their peaks and folds."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import field

import numpy as np
import numpy.typing as npt

from fcm.frozen import Frozen
from fcm.model.scene import Scene
from fcm.results.result import Curve

FloatArray = npt.NDArray[np.float64]


class Line(Frozen):
    """One response curve: half the peak-to-peak displacement against frequency.

    Separate branches follow one another, with a point of NaN between them.
    """

    frequency: FloatArray  # (point,) [rad/s]
    amplitude: FloatArray  # (point, dof)
    peaks: Mapping[str, tuple[float, float]]  # of each dof: amplitude, frequency [rad/s]
    folds: Sequence[float]  # [rad/s] in the order along the curve
    complete: bool
    reason: str = ""
    truncation: Mapping[str, float] = field(default_factory=dict)  # estimate at each peak [-]
    evaluations: int = 0  # of the equations; periods of the exact motion
    stable: Mapping[str, float] = field(default_factory=dict)  # at each peak, as of a `Peak`

    @property
    def points(self) -> int:
        """Number of points."""
        return int(np.isfinite(self.frequency).sum())

    def branches(self) -> list[tuple[FloatArray, FloatArray]]:
        """Frequency and amplitude of each connected part."""
        gaps = np.flatnonzero(np.isnan(self.frequency))
        parts = zip(np.split(self.frequency, gaps), np.split(self.amplitude, gaps), strict=True)
        known = ((w[np.isfinite(w)], a[np.isfinite(w)]) for w, a in parts)
        return [(w, a) for w, a in known if w.size]


def line_of(curve: Curve, scene: Scene) -> Line:
    """A curve of harmonic balance, at the degrees of freedom that its scene reports."""
    shown = {dof: peak for dof, peak in curve.peaks.items() if scene.reports(dof)}
    heights = {dof: (peak.amplitude, peak.frequency) for dof, peak in shown.items()}
    estimate = {dof: peak.error for dof, peak in shown.items()}
    return Line(
        curve.frequency, amplitude(curve, scene), heights, curve.folds, curve.complete, curve.reason,
        estimate, curve.evaluations, {dof: peak.stable for dof, peak in shown.items()},
    )  # fmt: skip


def amplitude(curve: Curve, scene: Scene) -> FloatArray:
    """Amplitudes (point, dof) of the degrees of freedom that the scene of a curve reports."""
    return curve.amplitude[:, [scene.reports(dof) for dof in curve.peaks]]
