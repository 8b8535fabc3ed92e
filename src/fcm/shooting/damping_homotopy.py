"""Homotopy in the damping: a periodic motion reached from one with more damping."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from fcm.continuation.corrector import Newton
from fcm.model.scene import FloatArray, Scene
from fcm.shooting.options import SHOOTING, ShootingOptions
from fcm.shooting.problem import OrbitProblem, correct_at_frequency


def more_damped(scene: Scene, options: ShootingOptions = SHOOTING) -> tuple[Scene, float] | None:
    """The scene with all damping raised, and the factor; None if its damping suffices, or a mode has none."""
    least = float(scene.modal.damping.min())
    if not 0.0 < least < options.damping.damping_ratio:
        return None
    return damped(scene, options.damping.damping_ratio / least), options.damping.damping_ratio / least


def damped(scene: Scene, factor: float) -> Scene:
    """The scene with all damping times a factor."""
    return replace(scene, modal=replace(scene.modal, damping=scene.modal.damping * factor))


def less_damped(
    scene: Scene, z: FloatArray, factor: float, options: ShootingOptions = SHOOTING
) -> FloatArray | None:
    """Follow a motion z with damping larger by a factor to the scene's damping; None if this fails."""
    points = [(np.log(factor), z)]
    ratio = options.damping.first_factor
    while factor > 1.0 and ratio < options.damping.max_factor:
        new = max(1.0, factor * ratio)
        found = next(
            _corrected(OrbitProblem(damped(scene, new), options=options), _guesses(points, np.log(new))), None
        )
        if found is None:
            ratio = np.sqrt(ratio)
            continue
        factor, ratio = new, max(ratio**1.5, options.damping.min_factor)
        points = [points[-1], (np.log(new), found)]
    return points[-1][1] if factor == 1.0 else None


def _guesses(points: list[tuple[float, FloatArray]], at: float) -> Iterator[FloatArray]:
    """Yield guesses for the next damping: the secant predictor, and the last point."""
    if len(points) > 1:
        (before, one), (last, other) = points
        yield other + (other - one) * (at - last) / (last - before)
    yield points[-1][1]


def _corrected(problem: OrbitProblem, guesses: Iterator[FloatArray]) -> Iterator[FloatArray]:
    """Yield the motions that Newton's method finds at the frequency of each guess."""
    newton = Newton(problem)
    for guess in guesses:
        if correct_at_frequency(newton, guess):
            yield np.array(newton.z)
