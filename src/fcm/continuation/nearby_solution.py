"""A solution near a guess, by Newton's method: at the parameter of the guess, or in a plane through it."""

from __future__ import annotations

import numpy as np

from fcm.continuation.corrector import Newton
from fcm.continuation.path import FloatArray


def begin_near(newton: Newton, z: FloatArray, normal: FloatArray | None = None) -> None:
    """Place Newton's method at a guess z (n + 1,), with the scale there.

    normal: direction (n + 1,), in the units of z, normal to the plane in which the solution is sought; by
    default the parameter's, which is then held.
    """
    newton.problem.evaluate_scale(z)
    scale = np.array(newton.problem.scale)
    row = np.eye(z.size)[-1] if normal is None else normal / scale
    length = float(np.linalg.norm(row))
    for place, values in ((newton.scale, scale), (newton.z, z), (newton.row, row / length)):
        np.asarray(place)[:] = values


def solution_near(
    newton: Newton, z: FloatArray, normal: FloatArray | None = None, reach: float = 1.0
) -> FloatArray | None:
    """The solution (n + 1,) that Newton's method finds from a guess; None if it does not converge.

    normal: as for `begin_near`; reach: as for `Newton.correct`.
    """
    begin_near(newton, z, normal)
    return np.array(newton.z) if newton.correct(reach) else None
