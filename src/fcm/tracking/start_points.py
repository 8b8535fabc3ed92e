"""Starts of tracked curves: the special points of response curves at some values of the number."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from fcm.accuracy.refinement import every_branch
from fcm.at_rest import at_rest
from fcm.continuation import Mark, Path
from fcm.harmonic_balance.reported_quantities import ReportedQuantities
from fcm.harmonic_balance.system import System
from fcm.local_maxima import local_maxima, prominence
from fcm.model.scene import FloatArray
from fcm.tracking.extended_system import Condition, Kind
from fcm.tracking.onset_functions import onset
from fcm.tracking.options import TRACKING, TrackingOptions


class SpecialPoints(NamedTuple):
    """Points z (unknown + 1,) at which conditions nearly hold.

    faults: text on faults of the response curves. uncertain: frequencies [rad/s] at which a curve of the
    level, or a fold of it, was not followed to its end, so that branches may be missing.
    """

    points: list[tuple[Condition, FloatArray]]
    faults: str
    uncertain: tuple[float, ...]


def special_points(
    system: System, conditions: list[Condition], options: TrackingOptions = TRACKING
) -> SpecialPoints:
    """Trace all branches of a system, and find the special points of each condition on them."""
    response = every_branch(system)
    curves, branches = response.traced, response.traced.branches
    levels = tuple(one.omega for one in curves.found if not one.complete)
    uncertain_at, found = (*levels, *curves.folds_lost), []
    for path, amplitude in zip(branches.paths, _amplitudes(response.quantities), strict=True):
        for condition in conditions:
            found += [(condition, z) for z in _points(system, path, amplitude, condition, options)]
    if not branches.paths:
        return SpecialPoints(found, "no solution was found at either end of the range", uncertain_at)
    wrong = "" if branches.status.name == "COMPLETE" else branches.status.value
    return SpecialPoints(found, wrong, uncertain_at)


def _amplitudes(quantities: Sequence[ReportedQuantities]) -> list[FloatArray]:
    """Amplitudes (point, dof) along each path, 0 where a degree of freedom moves only by rounding."""
    every = [one.amplitude for one in quantities]
    moves = ~at_rest(np.max([one.max(axis=0) for one in every], axis=0)) if every else 0.0
    return [one * moves for one in every]


def _points(
    system: System,
    path: Path,
    amplitude: FloatArray,
    condition: Condition,
    options: TrackingOptions = TRACKING,
) -> Iterator[FloatArray]:
    if condition.kind is Kind.FOLD:
        yield from path.z[path.where(Mark.FOLD)]
    elif condition.kind is Kind.END:
        yield from path.z[path.parameter == condition.omega]
    elif condition.kind is Kind.PEAK:
        yield from path.z[_tops(amplitude[:, condition.which], options)]
    else:
        yield from _onsets(system, path, condition, options)


def _tops(amplitude: FloatArray, options: TrackingOptions = TRACKING) -> npt.NDArray[np.intp]:
    """Indices of peaks inside the curve: the highest one, and others with enough prominence."""
    curves, highest = options.curves, amplitude.max(initial=0.0)
    tops = np.flatnonzero(local_maxima(amplitude[:, None], curves.min_height)[:, 0])
    outstanding = [
        amplitude[k] == highest or prominence(amplitude, int(k)) > curves.min_prominence * amplitude[k]
        for k in tops
    ]
    return tops[np.array(outstanding, dtype=np.bool_)]


def _onsets(
    system: System, path: Path, condition: Condition, options: TrackingOptions = TRACKING
) -> Iterator[FloatArray]:
    """Yield points at which an onset function changes its sign, by linear interpolation."""
    law, c = system.laws()[condition.which], condition.which
    blocks = [np.ascontiguousarray(z[c * law.width : (c + 1) * law.width]) for z in path.z]
    value = np.array([onset(law, x, condition.onset, system.harmonics, options).value for x in blocks])
    for i in np.flatnonzero(value[:-1] * value[1:] < 0.0):
        part = value[i] / (value[i] - value[i + 1])
        yield path.z[i] + part * (path.z[i + 1] - path.z[i])
    yield from path.z[value == 0.0]
