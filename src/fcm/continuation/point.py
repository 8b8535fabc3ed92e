"""A point on a curve, with what the problem says of it."""

from __future__ import annotations

import cython
import numpy as np
from cython.cimports.libc.math import fabs

if cython.compiled:
    from cython.cimports.fcm.continuation.problem import NONE, Problem
else:
    from fcm.continuation.problem import NONE, Problem

PI = cython.declare(cython.double, 3.141592653589793)
AHEAD = cython.declare(cython.double, 1e-6)  # length over which margins have their slopes
APART = cython.declare(cython.double, 1.0)  # [rad] margins this far from one another are not the same


@cython.cclass
class Point:
    """A point of the curve with what the problem says of it; the tangent in scaled coordinates, a unit
    vector."""

    def __init__(self, problem: Problem) -> None:
        self.z, self.tangent = np.zeros(problem.unknowns + 1), np.zeros(problem.unknowns + 1)
        self.margin, self.angle = np.zeros(problem.margins), np.zeros(problem.margins)
        self.kind = np.zeros(problem.margins, dtype=np.intc)
        self.slope = np.zeros(problem.margins)  # of the margins, along a unit of length
        self.output, self.growth = np.zeros(problem.outputs), np.zeros(problem.outputs)
        self.orientation, self.group = 0.0, problem.group
        self.inclined = False  # whether the slopes are those there

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def bounded(self, problem: Problem) -> cython.int:
        """Take the margins that a problem was last asked for."""
        k: cython.Py_ssize_t
        for k in range(problem.margins):
            self.margin[k], self.kind[k], self.angle[k] = problem.margin[k], problem.kind[k], problem.angle[k]
        return 0

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def like(self, other: Point, unit: cython.double) -> cython.int:
        """Take everything from another point, whose unit of length is so many of the new."""
        i: cython.Py_ssize_t
        self.orientation, self.inclined = other.orientation, other.inclined
        for i in range(other.z.shape[0]):
            self.z[i], self.tangent[i] = other.z[i], other.tangent[i]
        for i in range(other.slope.shape[0]):
            self.margin[i], self.kind[i], self.angle[i] = other.margin[i], other.kind[i], other.angle[i]
            self.slope[i] = other.slope[i] / unit
        for i in range(other.growth.shape[0]):
            self.output[i], self.growth[i] = other.output[i], other.growth[i] / unit
        return 0

    @cython.ccall
    @cython.exceptval(-2, check=False)
    def partner(
        self, k: cython.Py_ssize_t, kind: cython.int[::1], angle: cython.double[::1]
    ) -> cython.Py_ssize_t:
        """Which of other margins is the one with number k here; -1 if none is.

        It is that of its group and kind nearest to it, if it is also nearest to that.
        """
        i: cython.Py_ssize_t
        first: cython.Py_ssize_t = k - k % self.group
        end: cython.Py_ssize_t = first + self.group
        if self.kind[k] == NONE:
            return -1
        if kind[k] == self.kind[k] and angle[k] == self.angle[k]:
            return k
        i = nearest(self.kind[k], self.angle[k], kind, angle, first, end)
        return i if i >= 0 and nearest(kind[i], angle[i], self.kind, self.angle, first, end) == k else -1

    @cython.ccall
    @cython.exceptval(-1e300, check=False)
    def margin_at(self, k: cython.Py_ssize_t, other: Point) -> cython.double:
        """The margin at another point that is the one with number k here; 0 if none is."""
        i: cython.Py_ssize_t = self.partner(k, other.kind, other.angle)
        return other.margin[i] if i >= 0 else 0.0

    @cython.cfunc
    @cython.exceptval(-1e300, check=False)
    def asked(self, k: cython.Py_ssize_t, problem: Problem) -> cython.double:
        """The margin that a problem was last asked for and is the one with number k here; 0 if none is."""
        i: cython.Py_ssize_t = self.partner(k, problem.kind, problem.angle)
        return problem.margin[i] if i >= 0 else 0.0

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def incline(self, problem: Problem, scale: cython.double[::1], beside: cython.double[::1]) -> cython.int:
        """The slopes of the margins along the tangent, from differences to a point that is put beside."""
        i: cython.Py_ssize_t
        k: cython.Py_ssize_t
        self.inclined = True
        if problem.margins == 0 or problem.labelled:
            return 0
        for i in range(beside.shape[0]):
            beside[i] = self.z[i] + AHEAD * scale[i] * self.tangent[i]
        problem.bound(beside)
        for k in range(problem.margins):
            self.slope[k] = 0.0
            i = self.partner(k, problem.kind, problem.angle)
            if i >= 0:
                self.slope[k] = (problem.margin[i] - self.margin[k]) / AHEAD
        return 0


@cython.cfunc
@cython.exceptval(check=False)
def nearest(
    wanted: cython.int,
    at: cython.double,
    kind: cython.int[::1],
    angle: cython.double[::1],
    first: cython.Py_ssize_t,
    end: cython.Py_ssize_t,
) -> cython.Py_ssize_t:
    """Of those from first to before end the number of that of a kind whose angle is nearest to one given.

    -1 if there is none near it.
    """
    i: cython.Py_ssize_t
    best: cython.Py_ssize_t = -1
    least: cython.double = APART
    for i in range(first, end):
        if kind[i] == wanted:
            off: cython.double = fabs(at - angle[i])
            off = off if off <= PI else fabs(2.0 * PI - off)
            if off < least:
                least, best = off, i
    return best
