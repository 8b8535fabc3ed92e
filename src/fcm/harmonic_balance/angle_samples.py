"""Cosines and sines of harmonics at the angles where the search for extremes of a displacement starts."""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from fcm.model.scene import FloatArray


@lru_cache(64)  # many balances have the same harmonics
def waves(harmonics: tuple[float, ...], samples_of_period: int) -> tuple[FloatArray, FloatArray]:
    """Return cos(h theta) and sin(h theta), each (harmonic, sample).

    There are samples_of_period samples for each period of the highest harmonic; none for a single harmonic.
    """
    samples = int(samples_of_period * harmonics[-1]) if len(harmonics) > 1 else 0
    angle = np.outer(harmonics, 2.0 * np.pi * np.arange(samples) / max(samples, 1))
    return np.cos(angle), np.sin(angle)
