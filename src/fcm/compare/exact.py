"""Lines of the exact periodic motion: half peak-to-peak amplitudes, with peaks located between points."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from scipy.optimize import minimize_scalar

from fcm.compare.lines import Line, amplitude, line_of
from fcm.compare.options import COMPARE, ExactLineOptions
from fcm.model.scene import Scene
from fcm.response.exact import trace_exact
from fcm.response.options import RESPONSE, ResponseOptions, leaving_out
from fcm.results.result import Curve
from fcm.run import Execution, Progress
from fcm.run.progress import part
from fcm.shooting import harmonic_state, periodic
from fcm.time_domain import SimulationError, State


def exact_lines(
    scene: Scene, progress: Progress | None = None, options: ExactLineOptions = COMPARE.exact
) -> list[Line]:
    """The exact curves of a scene; those that do not reach their end within the time limit are incomplete."""
    scenes, lines = scene.each_curve(), []
    for number, one in enumerate(scenes):
        shown = part(progress, number / len(scenes), (number + 1) / len(scenes))
        response = trace_exact(
            replace(one, curves=()), execution=Execution(progress=shown), options=_limited(options)
        )
        if response.interrupted:
            raise KeyboardInterrupt
        lines.append(_line(one, response.curves[0], options))
    return lines


def _limited(options: ExactLineOptions) -> ResponseOptions:
    """Response options with nothing left out, and a time limit for a curve."""
    return leaving_out(None, replace(RESPONSE, exact=replace(RESPONSE.exact, max_seconds=options.limit)))


def _line(scene: Scene, curve: Curve, options: ExactLineOptions) -> Line:
    if curve.orbits is None or curve.points == 0:
        return line_of(curve, scene)
    peaks = {
        dof: _peak(scene, curve, j, options) for j, dof in enumerate(scene.modal.dofs) if scene.reports(dof)
    }
    return Line(
        curve.frequency, amplitude(curve, scene), peaks, curve.folds, curve.complete, curve.reason, {},
        curve.orbits.periods, {dof: peak.stable for dof, peak in curve.peaks.items()},
    )  # fmt: skip


def _peak(scene: Scene, curve: Curve, dof: int, options: ExactLineOptions) -> tuple[float, float]:
    """Greatest amplitude and its frequency, located between the points by further periodic solutions."""
    amplitude = curve.amplitude[:, dof]
    k = int(np.nanargmax(amplitude))
    at_point = float(amplitude[k]), float(curve.frequency[k])
    around = curve.frequency[max(k - 1, 0) : k + 2]
    if around.size < 3 or not np.all(np.diff(around) * np.diff(around)[0] > 0.0):
        return at_point  # the end of the range, or next to a fold
    guess = _state(scene, curve, k)

    def below(omega: float) -> float:
        try:
            found = float(periodic(scene, omega, guess).measure.amplitude[dof])
        except SimulationError:
            return 0.0
        return -found if abs(found - at_point[0]) < options.jump * at_point[0] else 0.0

    within, closely = (around.min(), around.max()), {"xatol": options.peak * around[1]}
    best = minimize_scalar(below, bounds=within, method="bounded", options=closely)
    return (-float(best.fun), float(best.x)) if -best.fun > at_point[0] else at_point


def _state(scene: Scene, curve: Curve, k: int) -> State:
    """A guess of the state at a point, from its fundamental and mean."""
    assert curve.orbits is not None
    return harmonic_state(
        scene, float(curve.frequency[k]), curve.fundamental[k], curve.phase[k], curve.mean[k]
    )
