"""Measures the effect of omitted modes on exact curves: solves some points again with all modes."""

from __future__ import annotations

import numpy as np

from fcm.model.scene import Scene
from fcm.reduction.negligible_parts import ReducedScenes
from fcm.reduction.options import REDUCTION
from fcm.results.result import Curve, Response
from fcm.shooting import harmonic_state, periodic
from fcm.shooting.initial_orbits import inner_resonances, near_balance
from fcm.time_domain.errors import SimulationError


def effect(response: Response, lighter: ReducedScenes) -> float:
    """Greatest change of an amplitude, relative to the greatest amplitude of the point; inf if unknown."""
    numbers = np.unique(np.linspace(0, len(response.curves) - 1, REDUCTION.max_curves).astype(int))
    each = (_of_curve(response.curves[k], lighter.exact[k]) for k in numbers)
    return max(each, default=0.0)


def expected_effect(lighter: ReducedScenes) -> float:
    """Effect of omitted modes at initial orbits from harmonic balance, before any curve is followed."""
    numbers = np.unique(np.linspace(0, len(lighter.full) - 1, REDUCTION.max_curves).astype(int))
    return max((_of_starts(lighter.curves[k], lighter.exact[k]) for k in numbers), default=0.0)


def _of_starts(light: Scene, scene: Scene) -> float:
    changes = [0.0]
    for omega in (*scene.frequency_range, *inner_resonances(scene)):
        pairs = zip(near_balance(light, omega), near_balance(scene, omega), strict=False)
        for one, other in pairs:
            amplitude = other.measure.amplitude
            changes.append(float(np.abs(one.measure.amplitude - amplitude).max() / amplitude.max()))
    return max(changes)


def _of_curve(curve: Curve, scene: Scene) -> float:
    there = np.flatnonzero(np.isfinite(curve.frequency) & (curve.stable == 1.0))
    if there.size == 0:
        return 0.0
    peaks = np.unique(there[curve.amplitude[there].argmax(axis=0)])
    spread = there[np.linspace(0, there.size - 1, REDUCTION.max_points).astype(int)]
    points = dict.fromkeys([*peaks.tolist(), *spread.tolist()])
    return max(_of_point(curve, scene, k) for k in list(points)[: REDUCTION.max_points])


def _of_point(curve: Curve, scene: Scene, k: int) -> float:
    motion = curve.fundamental[k], curve.phase[k], curve.mean[k]
    try:
        guess = harmonic_state(scene, float(curve.frequency[k]), *motion)
        amplitude = periodic(scene, float(curve.frequency[k]), guess).measure.amplitude
    except SimulationError:
        return float("inf")
    return float(np.abs(amplitude - curve.amplitude[k]).max() / np.abs(amplitude).max())
