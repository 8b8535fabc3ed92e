"""Kernel: the coefficients of a table as a law, with the exact derivatives of their interpolant."""

import cython
import numpy as np
from cython.cimports.libc.math import isfinite

if cython.compiled:
    from cython.cimports.fcm.contact.closed_form import ClosedForm
    from cython.cimports.fcm.contact.coefficient_law import CoefficientLaw
    from cython.cimports.fcm.table.cubic import Cubic
    from cython.cimports.fcm.table.locate import Place
else:
    from fcm.contact.closed_form import ClosedForm
    from fcm.contact.coefficient_law import CoefficientLaw
    from fcm.table.cubic import Cubic
    from fcm.table.locate import Place

LARGEST = cython.declare(cython.double, 1e300)  # of b_bar
FARTHEST = cython.declare(cython.double, 2e300)  # of n0_bar: an infinite preload or gap is as this one


@cython.final
@cython.cclass
class Frame:
    """What a part of a table answers for: from low to high, in nodes of its chart, rows (chart, 3).

    ``here`` is added to nodes of all of the table (of the slip chart those from its first) for those of the
    part.
    """

    def __init__(self, low: np.ndarray, high: np.ndarray, here: np.ndarray) -> None:
        self.low, self.high, self.here = low, high, here

    def within(self, place: Place) -> cython.bint:
        """Turns a place into one in the nodes of the part; whether it answers for it.

        Where F needs no table, outside of both charts, any coordinates will do.
        """
        chart: cython.Py_ssize_t = 1 if place.u > place.first_slip - 1 else 0
        u: float = place.u - chart * place.first_slip
        inside: cython.bint = (
            self.low[chart, 0] <= u <= self.high[chart, 0]
            and self.low[chart, 1] <= place.x <= self.high[chart, 1]
            and self.low[chart, 2] <= place.z <= self.high[chart, 2]
        )
        place.u = max(min(u, self.high[chart, 0]), self.low[chart, 0]) + self.here[chart, 0]
        place.x = max(min(place.x, self.high[chart, 1]), self.low[chart, 1]) + self.here[chart, 1]
        place.z = max(min(place.z, self.high[chart, 2]), self.low[chart, 2]) + self.here[chart, 2]
        return inside or place.scale == 0.0


@cython.final
@cython.cclass
class Tabulated(CoefficientLaw):
    """Look-up in splines over the nodes of a table, or of a frame of them, and then the closed form outside.

    Not to be used by two threads at a time: each makes its own from the same splines, which costs nothing.
    ``outside`` counts the points that are from the closed form.
    """

    def __init__(self, cubic: Cubic, resolution: tuple[int, int, int, int], frame: Frame | None) -> None:
        self.cubic, self.place, self.frame, self.outside = cubic, Place(resolution), frame, 0
        self.exact = ClosedForm()

    def evaluate(
        self,
        n0_bar: float,
        b_bar: float,
        phi: float,
        gradient: bool,
        out: cython.double[::1],
        at: cython.Py_ssize_t,
    ) -> None:
        """See `CoefficientLaw`."""
        n0: float = min(max(n0_bar, -FARTHEST), FARTHEST)
        if not (n0_bar == n0_bar and isfinite(b_bar) and isfinite(phi)):
            self.unknown(gradient, out, at)
            return
        self.place.find(n0, min(b_bar, LARGEST), phi, gradient)
        if self.frame is not None and not self.frame.within(self.place):
            self.outside += 1
            self.exact.evaluate(n0_bar, b_bar, phi, gradient, out, at)
            return
        self.cubic.evaluate(self.place.u, self.place.x, self.place.z, gradient, out, at)
        if gradient:
            self._chain(out, at)
        out[at] = self.place.sign * (self.place.scale * out[at] + self.place.mean)
        out[at + 1] = self.place.scale * out[at + 1] + self.place.closed
        out[at + 2] = self.place.scale * out[at + 2]

    def _chain(self, out: cython.double[::1], at: cython.Py_ssize_t) -> None:
        """From derivatives of G by the coordinates to derivatives of F by n0_bar, b_bar and phi."""
        by_u: cython.double[3] = [0.0, 0.0, 0.0]
        by_x: cython.double[3] = [0.0, 0.0, 0.0]
        by_z: cython.double[3] = [0.0, 0.0, 0.0]
        i: cython.Py_ssize_t
        for i in range(3):
            by_u[i], by_x[i], by_z[i] = out[at + 3 + i], out[at + 6 + i], out[at + 9 + i]
        for i in range(3):
            out[at + 3 + 3 * i] = self.place.u_n * by_u[i]
            out[at + 4 + 3 * i] = (
                self.place.scale_b * out[at + i] + self.place.u_b * by_u[i] + self.place.x_b * by_x[i]
            )
            out[at + 5 + 3 * i] = (
                self.place.scale_phi * out[at + i]
                + self.place.u_phi * by_u[i]
                + self.place.x_phi * by_x[i]
                + self.place.z_phi * by_z[i]
            )
        out[at + 3] = self.place.sign * (out[at + 3] + self.place.mean_n)
        out[at + 4] = self.place.sign * (out[at + 4] + self.place.mean_b)
        out[at + 5] = self.place.sign * (out[at + 5] + self.place.mean_phi)
