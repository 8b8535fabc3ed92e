"""Narrow places: a curve may have a peak there that no point away from them tells of, so steps end there."""

from __future__ import annotations

from collections.abc import Sequence

import cython
import numpy as np
from cython.cimports.libc.math import fabs

from fcm.continuation.front import Front

SHORTEST = cython.declare(cython.double, 1e-9)  # no step ends nearer than that
AT = cython.declare(cython.double, 0.25)  # of the width of a narrow place, within which a step ends there


@cython.cclass
class Narrow:
    """`place` (k, 2), values of the parameter with a width; `met`: whether the step was cut to end at one."""

    def __init__(self, places: Sequence[tuple[float, float]]) -> None:
        self.place, self.met = np.array(places, dtype=np.float64).reshape(-1, 2), False

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def up_to(self, front: Front, step: cython.double) -> cython.double:
        """The step, or the length at which it comes to the first narrow place."""
        k: cython.Py_ssize_t
        n: cython.Py_ssize_t = front.problem.unknowns
        way: cython.double
        unit: cython.double = front.here.tangent[n] * front.newton.scale[n]
        first: cython.double = step
        for k in range(self.place.shape[0]):
            way = self.place[k, 0] - front.here.z[n]
            nearer: cython.bint = way * unit > 0.0 and fabs(way) > AT * self.place[k, 1]
            if nearer and fabs(way) < first * fabs(unit):
                first = way / unit
        self.met = SHORTEST < first < step
        return first if self.met else step

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def across(self, front: Front, step: cython.double) -> cython.double:
        """Length at which a step comes to the first narrow place that it leads across; 0 if there is none."""
        k: cython.Py_ssize_t
        n: cython.Py_ssize_t = front.problem.unknowns
        way: cython.double
        gone: cython.double = front.there.z[n] - front.here.z[n]
        first: cython.double = step
        for k in range(self.place.shape[0]):
            way = self.place[k, 0] - front.here.z[n]
            within: cython.bint = way * gone > 0.0 and fabs(way) < fabs(gone)
            if within and min(fabs(way), fabs(gone - way)) > AT * self.place[k, 1]:
                first = min(first, step * way / gone)
        return first if SHORTEST < first < step else 0.0
