"""Between two points of a curve of periodic solutions: where it turns in frequency, where it is highest."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

import numpy as np

from fcm.scene.model import FloatArray
from fcm.simulate.arc import Equations, rescaled
from fcm.simulate.sample import Sample, distance, sampled

ALONG = 0.3  # cosine to the chord below which an end's direction belongs to a corner and is not used
FOLD = 1e-8  # arc within which a fold is known: its frequency to the square of it, a corner's to it
MOST_CUTS = 60
NUDGE = 1e-3  # of a bracket, past the root that is expected, so that both ends close in
GAIN = 1e-9  # relative, by which a peak is thought to be above the highest point when the search ends
MOST_PEAK_CUTS = 16


def between(equations: Equations, a: Sample, b: Sample, share: float) -> Sample | None:
    """The point at a share of the chord: cubic interpolation, corrected across the chord."""
    chord = b.z - a.z
    row = chord / a.scale
    length = float(np.linalg.norm(row))
    if length == 0.0:
        return None
    first, last = (_slope(end, chord, row / length, length, a.scale) for end in (a, b))
    s = share
    guess = a.z + s * s * (3.0 - 2.0 * s) * chord + s * (1.0 - s) * ((1.0 - s) * first - s * last)
    new = equations.correct(guess, a.scale, row / length, length)
    if new is None or new.orientation != a.orientation:
        return None
    return sampled(rescaled(equations, new))


def _slope(end: Sample, chord: FloatArray, row: FloatArray, length: float, scale: FloatArray) -> FloatArray:
    """An end's direction per share of the chord; the chord itself at a corner."""
    direction = end.tangent * end.scale
    along = float(direction / scale @ row)
    usable = along > ALONG * float(np.linalg.norm(direction / scale))
    return direction * (length / along) if usable else chord


def fold(equations: Equations, a: Sample, b: Sample) -> Sample:
    """Where between two points the frequency turns, on the stable side if there is one."""
    for count in range(MOST_CUTS):
        if distance(a, b) < FOLD:
            break
        rate, other = float(a.tangent[-1]), float(b.tangent[-1])
        share = 0.5 if count % 3 == 2 else rate / (rate - other) + NUDGE * (-1.0) ** (count % 3)
        new = between(equations, a, b, min(max(share, NUDGE), 1.0 - NUDGE))
        if new is None:
            break
        a, b = (new, b) if new.tangent[-1] * rate > 0.0 else (a, new)
    return a if a.stable or not b.stable else b


def with_folds(equations: Equations, orbits: Sequence[Sample]) -> tuple[list[Sample], list[Sample]]:
    """The points with those added at which the frequency turns, and these alone."""
    out, folds = list(orbits[:1]), []
    for a, b in pairwise(orbits):
        if a.tangent[-1] * b.tangent[-1] < 0.0:
            folds.append(fold(equations, a, b))
            out.append(folds[-1])
        out.append(b)
    return out, folds


def with_peaks(equations: Equations, orbits: Sequence[Sample]) -> list[Sample]:
    """The points with those added at which a degree of freedom is highest."""
    out = list(orbits)
    for dof in range(orbits[0].measure.amplitude.size if orbits else 0):
        for _ in range(MOST_PEAK_CUTS):
            amplitude = np.array([orbit.measure.amplitude[dof] for orbit in out])
            at, share = _summit(out, amplitude)
            if at < 0:
                break
            new = between(equations, out[at], out[at + 1], share)
            if new is None:
                break
            out.insert(at + 1, new)
    return out


def _summit(orbits: Sequence[Sample], amplitude: FloatArray) -> tuple[int, float]:
    """The segment, and the share of it, in which a parabola through three points has the highest vertex.

    (-1, 0) where that is no higher than the highest point.
    """
    best, found = (1.0 + GAIN) * amplitude.max(initial=0.0), (-1, 0.0)
    inner = amplitude[1:-1]
    for k in (1 + np.flatnonzero((inner >= amplitude[:-2]) & (inner >= amplitude[2:]))).tolist():
        left, right = distance(orbits[k - 1], orbits[k]), distance(orbits[k], orbits[k + 1])
        if min(left, right) < FOLD:
            continue
        down, up = (amplitude[k - 1] - amplitude[k]) / left, (amplitude[k + 1] - amplitude[k]) / right
        bend = (down + up) / (left + right)
        slope = (up * left - down * right) / (left + right)
        if bend < 0.0 and amplitude[k] - 0.25 * slope * slope / bend > best:
            best, place = amplitude[k] - 0.25 * slope * slope / bend, -0.5 * slope / bend
            found = (k, place / right) if place >= 0.0 else (k - 1, 1.0 + place / left)
    return found
