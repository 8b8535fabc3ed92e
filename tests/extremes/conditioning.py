"""How far the equations of the path follower are from singular, along a curve."""

from __future__ import annotations

import numpy as np

from fcm.harmonic_balance.system import System
from fcm.model.scene import Scene
from fcm.reduction.restore import unknowns
from fcm.response import Curve


def condition_number(scene: Scene, curve: Curve) -> float:
    """Greatest condition number of the Jacobian along a curve [-]; NaN if it has no points.

    By the unknowns and the frequency together, n by n + 1, so that a fold, where the square Jacobian is
    singular, is nothing special; in the coordinates of the path follower, dimensionless by the curve's size.
    """
    at = np.flatnonzero(np.isfinite(curve.frequency))
    problem = System(scene, curve.harmonics).new_balance()
    n, worst = problem.unknowns, float("nan")
    for z in unknowns(curve, scene, at, curve.harmonics):
        problem.evaluate(z)
        problem.evaluate_scale(z)
        scale = np.asarray(problem.scale)
        values = np.linalg.svd(np.asarray(problem.jacobian) * scale / scale[:n, None], compute_uv=False)
        worst = np.fmax(worst, values[0] / max(values[-1], np.finfo(np.float64).tiny))
    return float(worst)
