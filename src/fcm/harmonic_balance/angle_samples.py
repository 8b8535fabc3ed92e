"""Cosines and sines of harmonics at the angles among which the extremes of a displacement are sought."""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from fcm.harmonic_balance.options import HARMONIC_BALANCE
from fcm.model.scene import FloatArray


@lru_cache(64)  # many balances have the same harmonics
def waves(
    harmonics: tuple[float, ...], samples_of_period: int = HARMONIC_BALANCE.extremes.samples
) -> tuple[FloatArray, FloatArray]:
    """Of each harmonic at the samples, so many for each period of the highest, (harmonic, sample); one
    harmonic alone needs no samples."""
    samples = int(samples_of_period * harmonics[-1]) if len(harmonics) > 1 else 0
    angle = np.outer(harmonics, 2.0 * np.pi * np.arange(samples) / max(samples, 1))
    return np.cos(angle), np.sin(angle)
