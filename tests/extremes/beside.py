"""Points of a harmonic-balance curve beside the exact periodic motion at the same frequencies."""

from __future__ import annotations

from contextlib import suppress
from dataclasses import dataclass

import numpy as np

from fcm.model.scene import Scene
from fcm.response import Curve
from fcm.shooting import harmonic_state, periodic
from fcm.time_domain import Measure, SimulationError

SHARES = (0.02, 0.25, 0.5, 0.75, 0.98)  # where along a curve it is compared, beside its highest point
FROM_FOLDS = 0.03  # relative distance in frequency within which a fold of the exact curve may lie elsewhere


@dataclass(frozen=True)
class Beside:
    """One point."""

    frequency: float  # [rad/s]
    difference: float  # of amplitudes, relative to the greatest; NaN if no exact motion is found
    truncation: float  # the estimate of what the single harmonic leaves out of them, relative


def beside_exact(scene: Scene, curve: Curve) -> list[Beside]:
    """Compare some stable points of a curve, away from its folds, with exact periodic solutions.

    The exact motion is found by shooting from the point itself, or else from the motion that begins at rest,
    and half its peak-to-peak displacement compared, of which errors are estimated.
    """
    return [_beside(scene, curve, int(i)) for i in chosen(curve)]


def chosen(curve: Curve) -> list[int]:
    """Stable points at some shares of the curve and its highest one, none of them next to a fold."""
    away = np.isfinite(curve.frequency) & (curve.stable == 1.0)
    for fold in curve.folds:
        away &= np.abs(curve.frequency - fold) > FROM_FOLDS * fold
    at = np.flatnonzero(away)
    if at.size == 0:
        return []
    some = {int(at[round(share * (at.size - 1))]) for share in SHARES}
    return sorted(some | {int(at[curve.amplitude[at].max(axis=1).argmax()])})


def _beside(scene: Scene, curve: Curve, i: int) -> Beside:
    frequency, truncation = float(curve.frequency[i]), float(curve.truncation_error[i])
    exact = _exact_near(scene, curve, i)
    if exact is None:
        return Beside(frequency, float("nan"), truncation)
    off, size = float(np.abs(exact.amplitude - curve.amplitude[i]).max()), float(curve.amplitude[i].max())
    return Beside(frequency, off / (size if size > 0.0 else 1.0), truncation)


def _exact_near(scene: Scene, curve: Curve, i: int) -> Measure | None:
    frequency = float(curve.frequency[i])
    guess = harmonic_state(scene, frequency, curve.fundamental[i], curve.phase[i], curve.mean[i])
    for start in (guess, None):
        with suppress(SimulationError):
            return periodic(scene, frequency, start).measure
    return None
