"""Kernel: the spans of the cycles of many contacts, as arrays."""

from typing import NamedTuple

import cython
import numpy as np
import numpy.typing as npt

if cython.compiled:
    from cython.cimports.fcm.contact.cycle import SLIPPING, Cycle
else:
    from fcm.contact.cycle import SLIPPING, Cycle


class Spans(NamedTuple):
    """The spans of cycles, each array (span, point), as `Cycle` has them; 0 where there is none."""

    length: npt.NDArray[np.float64]
    slip: npt.NDArray[np.float64]
    side: npt.NDArray[np.float64]
    slope: npt.NDArray[np.float64]
    curvature: npt.NDArray[np.float64]
    end_sin: npt.NDArray[np.float64]
    end_cos: npt.NDArray[np.float64]


class Cycles(NamedTuple):
    """What contacts do, as the codes of `cycle` (point,), and of those that slip the cycle."""

    behaviour: npt.NDArray[np.intc]
    opens: npt.NDArray[np.bool_]
    theta_1: npt.NDArray[np.float64]
    first_sin: npt.NDArray[np.float64]
    first_cos: npt.NDArray[np.float64]
    spans: Spans


@cython.cclass
class Record(Cycle):
    """Writes each span down."""

    def take(self) -> None:
        """One row of numbers for each of the fields of `Spans`."""
        self.spans[0, self.span, self.point] = self.length
        self.spans[1, self.span, self.point] = self.slip
        self.spans[2, self.span, self.point] = self.side
        self.spans[3, self.span, self.point] = self.slope
        self.spans[4, self.span, self.point] = self.curvature
        self.spans[5, self.span, self.point] = self.end_sin
        self.spans[6, self.span, self.point] = self.end_cos

    def of(self, points: cython.double[:, ::1]) -> Cycles:
        """The cycles of contacts, rows (3, point) of n0_bar, b_bar, phi."""
        count: cython.Py_ssize_t = points.shape[1]
        spans, cycles, codes = np.zeros((7, 3, count)), np.zeros((4, count)), np.empty(count, dtype=np.intc)
        self.spans = spans
        whole: cython.double[:, ::1] = cycles
        behaviour: cython.int[::1] = codes
        i: cython.Py_ssize_t
        for i in range(count):
            self.point = i
            behaviour[i] = self.find(points[0, i], points[1, i], points[2, i])
            if behaviour[i] == SLIPPING:
                whole[0, i], whole[1, i] = self.opens, self.theta_1
                whole[2, i], whole[3, i] = self.first_sin, self.first_cos
        return Cycles(codes, cycles[0] > 0.0, cycles[1], cycles[2], cycles[3], Spans(*spans))
