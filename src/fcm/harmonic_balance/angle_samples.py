"""Cosines and sines of harmonics at the angles among which the extremes of a displacement are sought."""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from fcm.model.scene import FloatArray

SAMPLES = 12  # for each period of the highest harmonic
TABLES = 64  # that are kept: many balances have the same harmonics


@lru_cache(TABLES)
def waves(harmonics: tuple[float, ...]) -> tuple[FloatArray, FloatArray]:
    """Of each harmonic at the samples, (harmonic, sample); one harmonic alone needs no samples."""
    samples = int(SAMPLES * harmonics[-1]) if len(harmonics) > 1 else 0
    angle = np.outer(harmonics, 2.0 * np.pi * np.arange(samples) / max(samples, 1))
    return np.cos(angle), np.sin(angle)
