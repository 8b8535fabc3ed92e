"""Points of curves at a frequency that is held."""

from __future__ import annotations

import numpy as np

from fcm.continuation.corrector import Newton
from fcm.model.scene import FloatArray


def correct_at_frequency(newton: Newton, z: FloatArray, reach: float = 1.0) -> bool:
    """Whether Newton's method comes to the curve from near z, with the frequency held."""
    newton.problem.measure(z)
    np.asarray(newton.scale)[:] = newton.problem.scale
    np.asarray(newton.z)[:] = z
    row = np.asarray(newton.row)
    row[:-1], row[-1] = 0.0, 1.0
    if not newton.correct(reach):
        return False
    newton.z[-1] = z[-1]
    return True
