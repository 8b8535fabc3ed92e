"""Test whether a known curve of special points passes a point, so that no curve is followed twice.

Near a turn of the number, or a cusp, parts of a curve come close to each other and to other curves. Distances
do not decide there. Instead the curve is computed in the plane through the point that is normal to the
nearest chord of the curve.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from fcm.continuation.all_branches import distances_from_chords
from fcm.continuation.corrector import Newton
from fcm.model.scene import FloatArray
from fcm.tracking.curve import SpecialPointCurve
from fcm.tracking.extended_system import Condition
from fcm.tracking.options import TRACKING, TrackingOptions
from fcm.tracking.tracked_point import TrackedPoint, TrackingSetup


def passes(curve: SpecialPointCurve, condition: Condition, point: TrackedPoint, setup: TrackingSetup) -> bool:
    """Whether a curve has passed a point."""
    if curve.condition != condition:
        return False
    problem = setup.tracked(condition)
    problem.evaluate_scale(point.z)
    scale = np.array(problem.scale)
    points = (np.array([one.z for one in curve.points]) - point.z) / scale
    if np.linalg.norm(points, axis=1).min() < setup.options.known.point_tolerance:
        return True
    return any(_crosses(curve, i, point, setup, scale) for i in _nearest_chords(points, setup.options))


def _nearest_chords(points: FloatArray, options: TrackingOptions = TRACKING) -> npt.NDArray[np.intp]:
    """Indices of the chords between points that are closest to the origin, the nearest first."""
    length, _, off = distances_from_chords(points)
    order = np.argsort(off)
    near: npt.NDArray[np.intp] = order[
        off[order] < options.known.max_chord_part * length[order] + options.known.point_tolerance
    ][: options.known.nearest_chords]
    return near


def _crosses(
    curve: SpecialPointCurve, i: int, point: TrackedPoint, setup: TrackingSetup, scale: FloatArray
) -> bool:
    """Whether the curve between points i and i + 1 meets a point, in the plane there normal to its chord."""
    one, other = curve.points[i], curve.points[i + 1]
    problem = setup.tracked((other.corner if one.switch else one.corner) or curve.condition)
    chord = (other.z - one.z) / scale
    row = chord / max(float(np.linalg.norm(chord)), 1e-300)
    guess = one.z + scale * row * float(row @ ((point.z - one.z) / scale))
    problem.evaluate_scale(guess)
    newton = Newton(problem)
    newton.scale[:], newton.z[:], newton.row[:] = scale, guess, row
    if not newton.correct(setup.options.pieces.reach):
        return False
    return bool(
        np.linalg.norm((np.asarray(newton.z) - point.z) / scale) < setup.options.known.point_tolerance
    )
