"""How far points are from the curve of a problem nearby: one step of Newton's method across their path."""

from __future__ import annotations

import cython
import numpy as np
from cython.cimports.libc.math import sqrt

from fcm.continuation.path import FloatArray

if cython.compiled:
    from cython.cimports.fcm.continuation.corrector import Newton
else:
    from fcm.continuation.corrector import Newton


def distances(newton: Newton, z: FloatArray, direction: FloatArray) -> FloatArray:
    """Lengths (point,) of the steps from points z across directions there, both (point, n + 1), to the curve
    of newton's problem, in its scale; NaN where there is none."""
    found = np.full(len(z), np.nan)
    _step(newton, z, direction, found)
    return found


def _step(
    newton: Newton, z: cython.double[:, ::1], direction: cython.double[:, ::1], found: cython.double[::1]
) -> None:
    i: cython.Py_ssize_t
    k: cython.Py_ssize_t
    for i in range(z.shape[0]):
        newton.problem.measure(z[i])
        total: cython.double = 0.0
        for k in range(z.shape[1]):
            newton.scale[k], newton.z[k] = newton.problem.scale[k], z[i, k]
            newton.row[k] = direction[i, k] / newton.scale[k]
            total += newton.row[k] * newton.row[k]
        for k in range(z.shape[1]):
            newton.row[k] /= sqrt(total)
        if newton.once():
            total = 0.0
            for k in range(z.shape[1]):
                total += ((newton.z[k] - z[i, k]) / newton.scale[k]) ** 2
            found[i] = sqrt(total)
