"""Values of the parameter to land on: a curve may have a peak there that no point away from them tells of."""

from __future__ import annotations

from collections.abc import Sequence

import cython
import numpy as np
from cython.cimports.libc.math import fabs

from fcm.continuation.stepper import Stepper


@cython.cclass
class Landing:
    """`value` (k, 2), of the parameter with a width; `met`: whether the step was cut to end at one."""

    def __init__(self, values: Sequence[tuple[float, float]]) -> None:
        self.value, self.met = np.array(values, dtype=np.float64).reshape(-1, 2), False

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def up_to(self, stepper: Stepper, step: cython.double) -> cython.double:
        """The step, or the length at which it comes to the first value."""
        k: cython.Py_ssize_t
        n: cython.Py_ssize_t = stepper.problem.unknowns
        way: cython.double
        unit: cython.double = stepper.here.tangent[n] * stepper.newton.scale[n]
        first: cython.double = step
        for k in range(self.value.shape[0]):
            way = self.value[k, 0] - stepper.here.z[n]
            nearer: cython.bint = (
                way * unit > 0.0 and fabs(way) > stepper.options.events.landing * self.value[k, 1]
            )
            if nearer and fabs(way) < first * fabs(unit):
                first = way / unit
        self.met = stepper.options.step.shortest < first < step
        return first if self.met else step

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def across(self, stepper: Stepper, step: cython.double) -> cython.double:
        """Length at which a step comes to the first value that it leads across; 0 if there is none."""
        k: cython.Py_ssize_t
        n: cython.Py_ssize_t = stepper.problem.unknowns
        way: cython.double
        gone: cython.double = stepper.there.z[n] - stepper.here.z[n]
        first: cython.double = step
        for k in range(self.value.shape[0]):
            way = self.value[k, 0] - stepper.here.z[n]
            within: cython.bint = way * gone > 0.0 and fabs(way) < fabs(gone)
            if (
                within
                and min(fabs(way), fabs(gone - way)) > stepper.options.events.landing * self.value[k, 1]
            ):
                first = min(first, step * way / gone)
        return first if stepper.options.step.shortest < first < step else 0.0
