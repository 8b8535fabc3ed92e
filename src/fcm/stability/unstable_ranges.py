"""Frequency ranges in which all motions found are unstable."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence

import numpy as np

from fcm.continuation import Path
from fcm.model.scene import FloatArray

Stretch = tuple[float, float]


def unstable_stretches(parts: Iterable[tuple[FloatArray, FloatArray]], span: Stretch) -> list[Stretch]:
    """Stretches within span in which no motion is or may be stable, the widest first.

    parts holds for each path its frequencies (point,), and stable (point,): 1 where the motion is stable, 0
    where it is not, and NaN where that is unknown, so that it may be.
    """
    stable_ranges = [ends for frequency, stable in parts for ends in _stable_ranges(frequency, stable)]
    reached, found = span[0], []
    for low, high in [*sorted(stable_ranges), (span[1], span[1])]:
        if low > reached:
            found.append((reached, low))
        reached = max(reached, high)
    return sorted(found, key=lambda ends: ends[0] - ends[1])


def stretches_of(paths: Sequence[Path], stable: Sequence[FloatArray], span: Stretch) -> list[Stretch]:
    """Stretches without a stable motion of paths with stable (path, point); see `unstable_stretches`."""
    parts = ((path.parameter, one) for path, one in zip(paths, stable, strict=True))
    return unstable_stretches(parts, span)


def without_frequencies(stretches: Iterable[Stretch], frequencies: Iterable[float]) -> list[Stretch]:
    """The stretches that contain none of the frequencies.

    >>> without_frequencies([(1.0, 2.0), (3.0, 3.5)], [0.5, 1.5])
    [(3.0, 3.5)]
    """
    at = list(frequencies)
    return [(low, high) for low, high in stretches if not any(low <= w <= high for w in at)]


def _stable_ranges(frequency: FloatArray, stable: FloatArray) -> Iterator[Stretch]:
    """Yield the frequency range of each part of a path that may be stable; single points are no parts."""
    may = np.concatenate(([False], stable != 0.0, [False]))
    ends = np.flatnonzero(may[1:] != may[:-1]).tolist()
    for first, end in zip(ends[::2], ends[1::2], strict=True):
        part = frequency[first:end]
        if end > first + 1:
            yield float(part.min()), float(part.max())
