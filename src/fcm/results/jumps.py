"""Jumps of the response when the frequency is swept slowly up or down along the stable parts of a curve."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from fcm.scene.model import FloatArray

BoolArray = npt.NDArray[np.bool_]
SAME = 1e-6  # relative difference of amplitudes at one frequency that are one point
ROUNDING = 1e-13  # relative difference of frequencies that are one


@dataclass(frozen=True)
class Jump:
    """Where a slow sweep leaves one stable part of a curve, and what it finds on the next."""

    sweep: str  # 'up' or 'down'
    frequency: float  # [rad/s]
    before: FloatArray  # (dof,) amplitude
    after: FloatArray  # (dof,) amplitude; NaN where the curve has no stable part to land on


def jumps(frequency: FloatArray, amplitude: FloatArray, stable: BoolArray) -> list[Jump]:
    """Jumps of an upward, then of a downward sweep along a curve; amplitude (point, dof).

    >>> w = np.array([1.0, 2.0, 3.0, 2.5, 2.0, 3.0, 4.0])
    >>> found = jumps(w, w[:, None] + [[0], [0], [0], [1], [2], [2], [2]], w == w)
    >>> [(j.sweep, j.frequency, j.after.tolist()) for j in found]
    [('up', 3.0, [5.0]), ('down', 2.0, [2.0])]
    >>> w = np.array([1.0, 2.0, np.nextafter(2.0, 1.0), 3.0])  # a peak at a corner is there twice
    >>> jumps(w, w[:, None], w == w)
    []
    """
    frequency, amplitude, stable = _once(frequency, amplitude, stable)
    known = np.flatnonzero(np.isfinite(frequency))
    if not stable[known].any():  # no motion that could be lost
        return []
    first, last = known[frequency[known].argmin()], known[frequency[known].argmax()]
    return _sweep(frequency, amplitude, stable, int(first), "up") + _sweep(
        frequency, amplitude, stable, int(last), "down"
    )


def _once(
    frequency: FloatArray, amplitude: FloatArray, stable: BoolArray
) -> tuple[FloatArray, FloatArray, BoolArray]:
    """The points without those that are there twice, as a peak at a corner is."""
    again = np.abs(np.diff(frequency)) <= ROUNDING * frequency[1:]
    again &= np.isclose(amplitude[1:], amplitude[:-1], rtol=SAME, atol=0.0).all(axis=1)
    kept = np.concatenate((np.ones(min(frequency.size, 1), dtype=bool), ~again))
    return frequency[kept], amplitude[kept], stable[kept]


def _sweep(
    frequency: FloatArray, amplitude: FloatArray, stable: BoolArray, at: int, sweep: str
) -> list[Jump]:
    """Walk from a point along stable segments in the direction of the sweep, and jump where they end."""
    rises = np.diff(frequency) * (1.0 if sweep == "up" else -1.0)
    usable = stable[:-1] & stable[1:] & (rises != 0.0) & np.isfinite(rises)
    onwards = np.where(usable, np.sign(rises), 0.0).tolist()  # a walk over single numbers of an array is slow
    found: list[Jump] = []
    visited: set[int] = set()
    while at not in visited:
        at = _end_of_branch(at, onwards, visited)
        here, before = float(frequency[at]), amplitude[at]
        if here == (np.nanmax(frequency) if sweep == "up" else np.nanmin(frequency)):
            return found
        onto = _landing(frequency, usable, at)
        if onto is None:
            return [*found, Jump(sweep, here, before, np.full_like(before, np.nan))]
        share = (here - frequency[onto]) / (frequency[onto + 1] - frequency[onto])
        after = amplitude[onto] + share * (amplitude[onto + 1] - amplitude[onto])
        found.append(Jump(sweep, here, before, after))
        at = onto + 1 if rises[onto] > 0.0 else onto
    return found


def _end_of_branch(at: int, onwards: list[float], visited: set[int]) -> int:
    """The last point of stable segments that lead onwards (1), or from their end to their start (-1)."""
    while True:
        visited.add(at)
        if at < len(onwards) and onwards[at] > 0.0:
            at += 1
        elif at > 0 and onwards[at - 1] < 0.0:
            at -= 1
        else:
            return at


def _landing(frequency: FloatArray, usable: BoolArray, at: int) -> int | None:
    """Another stable segment at the same frequency: the next along the curve, else any."""
    start, end = frequency[:-1], frequency[1:]
    holds = usable & ((frequency[at] - start) * (frequency[at] - end) <= 0.0)
    holds[max(at - 1, 0) : at + 1] = False
    candidates = np.flatnonzero(holds)
    if candidates.size == 0:
        return None
    later = candidates[candidates > at]
    return int(later[0] if later.size else candidates[-1])
