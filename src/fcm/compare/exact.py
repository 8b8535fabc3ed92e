"""Lines of the exact periodic motion: the fundamental of each orbit, its peaks located between points."""

from __future__ import annotations

import numpy as np
from scipy.optimize import minimize_scalar

from fcm.compare.lines import Line
from fcm.response.path import Progress
from fcm.response.result import Curve
from fcm.scene.model import Scene
from fcm.simulate import SimulationError, State, harmonic_state, periodic, trace_exact

CLOSE = 1e-8  # to which the frequency of a peak is located, relative
JUMP = 0.2  # relative change of amplitude from which a solution near a peak is one of another branch


def exact_lines(scene: Scene, progress: Progress | None = None) -> list[Line]:
    """The exact curves of a scene; those that cannot be followed to their end are not complete."""
    curves = trace_exact(scene, None, progress).curves
    if any(curve.reason.startswith("interrupted") for curve in curves):
        raise KeyboardInterrupt
    return [_line(one, curve) for one, curve in zip(scene.each_curve(), curves, strict=True)]


def _line(scene: Scene, curve: Curve) -> Line:
    if curve.orbits is None or curve.points == 0:
        return Line(curve.frequency, curve.amplitude, curve.peaks, curve.folds, curve.complete, curve.reason)
    amplitude = curve.orbits.fundamental
    peaks = {name: _peak(scene, curve, amplitude[:, j], j) for j, name in enumerate(scene.modal.dofs)}
    return Line(
        curve.frequency, amplitude, peaks, curve.folds, curve.complete, curve.reason, {}, curve.orbits.periods
    )


def _peak(scene: Scene, curve: Curve, amplitude: np.ndarray, dof: int) -> tuple[float, float]:
    """Greatest amplitude of a degree of freedom, located between the points by solutions of its own."""
    k = int(np.nanargmax(amplitude))
    at_point = float(amplitude[k]), float(curve.frequency[k])
    around = curve.frequency[max(k - 1, 0) : k + 2]
    if around.size < 3 or not np.all(np.diff(around) * np.diff(around)[0] > 0.0):
        return at_point  # the end of the range, or next to a fold
    guess = _state(scene, curve, k)

    def below(omega: float) -> float:
        try:
            found = float(periodic(scene, omega, guess).measure.fundamental[dof])
        except SimulationError:
            return 0.0
        return -found if abs(found - at_point[0]) < JUMP * at_point[0] else 0.0

    options = {"xatol": CLOSE * around[1]}
    best = minimize_scalar(below, bounds=(around.min(), around.max()), method="bounded", options=options)
    return (-float(best.fun), float(best.x)) if -best.fun > at_point[0] else at_point


def _state(scene: Scene, curve: Curve, k: int) -> State:
    """The state of a point, as far as its fundamental and mean tell: a guess."""
    assert curve.orbits is not None
    return harmonic_state(
        scene, float(curve.frequency[k]), curve.orbits.fundamental[k], curve.phase[k], curve.mean[k]
    )
