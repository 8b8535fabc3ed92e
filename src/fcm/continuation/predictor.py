"""Predictor of the next point of a curve: a parabola or a cubic.

The parabola has the tangent here and the curvature over the last step. For a labelled problem, whose points
are expensive, there is also the cubic through the last point and here with both tangents. The predictor that
would have predicted the last step better is used.
"""

from __future__ import annotations

import cython
import numpy as np
from cython.cimports.libc.math import sqrt

from fcm.continuation.problem import Point


@cython.cclass
class Predictor:
    """Predicts the point at a length from here.

    curvature (n + 1,) is the second derivative of the parabola; second and third (n + 1,) are the second and
    third derivatives of the cubic, all in scaled coordinates. has_cubic: whether there is a cubic; cubic:
    whether it is used.
    """

    def __init__(self, size: cython.Py_ssize_t, min_cosine: cython.double) -> None:
        self.min_cosine = min_cosine  # cosine of a turn below which no cubic is fitted to the step
        self.curvature, self.second, self.third = np.zeros(size), np.zeros(size), np.zeros(size)
        self.direction = np.zeros(size)
        self.has_cubic, self.cubic = False, False

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def reset(self) -> cython.int:
        """Forget the way here, and predict by the tangent alone."""
        self.curvature[:] = 0.0
        self.has_cubic, self.cubic = False, False
        return 0

    @cython.cfunc
    @cython.exceptval(check=False)
    def predict(
        self, here: Point, scale: cython.double[::1], step: cython.double, guess: cython.double[::1]
    ) -> cython.void:
        """Fill the guess of the point at a step from here."""
        i: cython.Py_ssize_t
        second: cython.double
        third: cython.double
        for i in range(guess.shape[0]):
            second = self.second[i] if self.cubic else self.curvature[i]
            third = self.third[i] if self.cubic else 0.0
            guess[i] = here.z[i] + scale[i] * step * (
                here.tangent[i] + step * (0.5 * second + step * third / 6.0)
            )

    @cython.cfunc
    @cython.exceptval(check=False)
    def rescale(
        self,
        here: Point,
        point: Point,
        scale: cython.double[::1],
        new: cython.double[::1],
        length: cython.double,
    ) -> cython.double:
        """Convert the tangent of a point at a length from here, and the curvature up to it, to a new scale.

        Returns the unit of length in the new scale.
        """
        i: cython.Py_ssize_t
        unit: cython.double
        ratio: cython.double
        for i in range(self.curvature.shape[0]):
            ratio = scale[i] / new[i]
            self.curvature[i] = (point.tangent[i] - here.tangent[i]) / length * ratio if length > 0.0 else 0.0
            point.tangent[i] *= ratio
        unit = sqrt(dot(point.tangent, point.tangent))
        for i in range(self.curvature.shape[0]):
            point.tangent[i] /= unit
        outwards: cython.double = dot(point.tangent, self.curvature)
        for i in range(self.curvature.shape[0]):
            self.curvature[i] = (self.curvature[i] - outwards * point.tangent[i]) / unit
        return unit

    @cython.cfunc
    @cython.exceptval(check=False)
    def update(
        self,
        here: Point,
        point: Point,
        scale: cython.double[::1],
        new: cython.double[::1],
        length: cython.double,
    ) -> cython.void:
        """Choose the predictor that was better for a point at a length from here, and fit the next cubic."""
        i: cython.Py_ssize_t
        off: cython.double
        parabola: cython.double = 0.0
        cubic: cython.double = 0.0
        if not (length > 0.0 and dot(here.tangent, point.tangent) > self.min_cosine):
            self.has_cubic, self.cubic = False, False
            return
        for i in range(self.curvature.shape[0]):
            off = (point.z[i] - here.z[i]) / scale[i] - length * here.tangent[i]
            parabola += (off - 0.5 * length * length * self.curvature[i]) ** 2
            cubic += (off - length * length * (0.5 * self.second[i] + length * self.third[i] / 6.0)) ** 2
        self.cubic = self.has_cubic and cubic < parabola
        self.has_cubic = True
        self.fit_cubic(here, point, scale, new)

    @cython.cfunc
    @cython.exceptval(check=False)
    def fit_cubic(
        self, here: Point, point: Point, scale: cython.double[::1], new: cython.double[::1]
    ) -> cython.void:
        """Fit the cubic from a point back through here: its derivatives along the tangent, in a new scale."""
        i: cython.Py_ssize_t
        size: cython.Py_ssize_t = self.curvature.shape[0]
        back: cython.double = 0.0
        slope: cython.double = 0.0
        aside: cython.double
        rate: cython.double
        for i in range(size):
            self.direction[i] = point.tangent[i] * scale[i] / new[i]
        unit: cython.double = sqrt(dot(self.direction, self.direction))
        for i in range(size):
            self.direction[i] /= unit
            back += self.direction[i] * (here.z[i] - point.z[i]) / new[i]
            slope += self.direction[i] * here.tangent[i] * scale[i] / new[i]
        for i in range(size):
            aside = (here.z[i] - point.z[i]) / new[i] - back * self.direction[i]
            rate = here.tangent[i] * scale[i] / (new[i] * slope) - self.direction[i]
            self.second[i] = 2.0 * (3.0 * aside - back * rate) / (back * back)
            self.third[i] = 6.0 * (back * rate - 2.0 * aside) / (back * back * back)


@cython.cfunc
@cython.exceptval(check=False)
def dot(a: cython.double[::1], b: cython.double[::1]) -> cython.double:
    """Scalar product of two vectors."""
    i: cython.Py_ssize_t
    total: cython.double = 0.0
    for i in range(a.shape[0]):
        total += a[i] * b[i]
    return total
