"""Values along a curve of which those at some points are known: what lies between, and how far it is off."""

from __future__ import annotations

import cython
import numpy as np
from cython.cimports.libc.math import fabs, isnan, sqrt

from fcm.model.scene import FloatArray

NEAR = cython.declare(cython.double, 1e-4)  # of the length of a curve: points nearer coincide
LEAST = cython.declare(cython.double, 1e-300)  # unit of a curve that stays where it is
INFINITY = cython.declare(cython.double, float("inf"))


@cython.cclass
class Filled:
    """`at` points fills values (point, column) by cubics through those at the known (point,) ones, by bytes.

    place (point,) is how far along the curve each is. The slopes are those of parabolas through neighbours.
    """

    place: cython.double[::1]
    value: cython.double[:, ::1]
    known: cython.uchar[::1]
    number: cython.Py_ssize_t[::1]  # of the known points
    count: cython.Py_ssize_t

    def __init__(
        self, place: cython.double[::1], value: cython.double[:, ::1], known: cython.uchar[::1]
    ) -> None:
        self.place, self.value, self.known = place, value, known
        self.number, self.count = np.zeros(place.shape[0], dtype=np.intp), 0

    def at(self, points: cython.Py_ssize_t[::1], out: cython.double[:, ::1]) -> None:
        """Values (point, column) at some points."""
        i: cython.Py_ssize_t
        j: cython.Py_ssize_t
        first: cython.Py_ssize_t
        self.sort()
        for i in range(points.shape[0]):
            first = self.before(points[i])
            for j in range(self.value.shape[1]):
                if self.known[points[i]] or self.count == 1:
                    out[i, j] = self.value[self.number[first], j]
                else:
                    out[i, j] = self.cubic(first, self.place[points[i]], j)

    @cython.cfunc
    @cython.exceptval(check=False)
    def sort(self) -> cython.void:
        """The numbers of the known points but for those that nearly coincide with one before: of such the
        difference is that of their roundings, and no slope."""
        i: cython.Py_ssize_t
        before: cython.Py_ssize_t
        near: cython.double = NEAR * (self.place[self.place.shape[0] - 1] - self.place[0])
        self.count = 0
        for i in range(self.known.shape[0]):
            if not self.known[i]:
                continue
            if self.count:
                before = self.number[self.count - 1]
                same: cython.bint = isnan(self.value[i, 0]) == isnan(self.value[before, 0])
                if same and self.place[i] - self.place[before] < near:
                    continue
            self.number[self.count] = i
            self.count += 1

    @cython.cfunc
    @cython.exceptval(check=False)
    def before(self, point: cython.Py_ssize_t) -> cython.Py_ssize_t:
        """Which of the known points is the last at or before one."""
        low: cython.Py_ssize_t = 0
        high: cython.Py_ssize_t = self.count
        while high - low > 1:
            middle: cython.Py_ssize_t = (low + high) // 2
            if self.number[middle] <= point:
                low = middle
            else:
                high = middle
        return low

    @cython.cfunc
    @cython.exceptval(check=False)
    def cubic(self, k: cython.Py_ssize_t, place: cython.double, j: cython.Py_ssize_t) -> cython.double:
        """From known point k to the next, or beyond the last."""
        last: cython.Py_ssize_t = self.count - 1
        k = min(k, last - 1)
        begin: cython.double = self.place[self.number[k]]
        length: cython.double = self.place[self.number[k + 1]] - begin
        x: cython.double = (place - begin) / (length if length > 0.0 else 1.0)
        y: cython.double = 1.0 - x
        value: cython.double = self.value[self.number[k], j] * (1.0 + 2.0 * x) * (y * y)
        value += self.value[self.number[k + 1], j] * (x * x) * (3.0 - 2.0 * x)
        return value + length * (self.slope(k, j) * x * (y * y) - self.slope(k + 1, j) * (x * x) * y)

    @cython.cfunc
    @cython.exceptval(check=False)
    def slope(self, k: cython.Py_ssize_t, j: cython.Py_ssize_t) -> cython.double:
        """At known point k; beside a gap by what is there."""
        one: cython.Py_ssize_t = max(k - 1, 0)
        other: cython.Py_ssize_t = min(k, self.count - 2)
        before: cython.double = self.secant(one, j)
        after: cython.double = self.secant(other, j)
        if isnan(before):
            return after
        if isnan(after):
            return before
        step: cython.double = self.step(one)
        next_step: cython.double = self.step(other)
        return (next_step * before + step * after) / (step + next_step)

    @cython.cfunc
    @cython.exceptval(check=False)
    def secant(self, k: cython.Py_ssize_t, j: cython.Py_ssize_t) -> cython.double:
        """From known point k to the next."""
        return (self.value[self.number[k + 1], j] - self.value[self.number[k], j]) / self.step(k)

    @cython.cfunc
    @cython.exceptval(check=False)
    def step(self, k: cython.Py_ssize_t) -> cython.double:
        """Length of the same; points may coincide."""
        length: cython.double = self.place[self.number[k + 1]] - self.place[self.number[k]]
        return length if length > 0.0 else 1.0

    def unforeseen(
        self,
        points: cython.Py_ssize_t[:, ::1],
        expected: cython.double[:, ::1],
        weight: cython.double[::1],
        part: cython.double,
        nothing: cython.double,
        out: cython.uchar[::1],
    ) -> None:
        """Whether values are off what was expected there by more than a part of them, and more than nothing.

        points (3, place): each between two others, all known. Values count by the first, times the weight
        (point,), or the greatest of the rest. What is missing where it was not expected to be, or the other
        way round, is off.
        """
        i: cython.Py_ssize_t
        j: cython.Py_ssize_t
        for i in range(points.shape[1]):
            k: cython.Py_ssize_t = points[1, i]
            missing: cython.bint = isnan(expected[i, 0])
            if missing or isnan(self.value[k, 0]):
                out[i] = missing != isnan(self.value[k, 0])
                continue
            off: cython.double = weight[k] * fabs(self.value[k, 0] - expected[i, 0])
            for j in range(1, self.value.shape[1]):
                off = max(off, fabs(self.value[k, j] - expected[i, j]))
            most: cython.double = self.size(k, weight[k])
            for j in (0, 2):
                most = max(most, self.size(points[j, i], weight[points[j, i]]))
            out[i] = off > max(part * most, nothing)

    @cython.cfunc
    @cython.exceptval(check=False)
    def size(self, k: cython.Py_ssize_t, weight: cython.double) -> cython.double:
        """Of the values at a point; nothing is more than that of one that is missing."""
        j: cython.Py_ssize_t
        if isnan(self.value[k, 0]):
            return INFINITY
        most: cython.double = weight * fabs(self.value[k, 0])
        for j in range(1, self.value.shape[1]):
            most = max(most, fabs(self.value[k, j]))
        return most


def places(
    z: cython.double[:, ::1], direction: cython.double[:, ::1], range_of: cython.double, out: FloatArray
) -> None:
    """Lengths (point,) along a curve z (point, unknown + 1), in the unit of its directions; the parameter,
    the last, counts by the width of its range."""
    i: cython.Py_ssize_t
    j: cython.Py_ssize_t
    n: cython.Py_ssize_t = z.shape[1] - 1
    place: cython.double[::1] = out
    most: cython.double = LEAST
    before: cython.double = 0.0
    for i in range(z.shape[0]):
        for j in range(n):
            most = max(most, fabs(z[i, j]))
    for i in range(z.shape[0]):
        speed: cython.double = (direction[i, n] / range_of) ** 2
        chord: cython.double = ((z[i, n] - z[i - 1, n]) / range_of) ** 2 if i else 0.0
        for j in range(n):
            speed += (direction[i, j] / most) ** 2
            if i:
                chord += ((z[i, j] - z[i - 1, j]) / most) ** 2
        speed = sqrt(speed)
        place[i] = place[i - 1] + 2.0 * sqrt(chord) / (speed + before) if i else 0.0
        before = speed


def steepness(
    parameter: cython.double[::1], amplitude: cython.double[:, ::1], most: cython.double, out: FloatArray
) -> None:
    """Greatest relative change of an amplitude over that of the parameter (point,), from 1 up to the most."""
    i: cython.Py_ssize_t
    d: cython.Py_ssize_t
    last: cython.Py_ssize_t = parameter.shape[0] - 1
    steep: cython.double[::1] = out
    for i in range(last + 1):
        a: cython.Py_ssize_t = max(i - 1, 0)
        b: cython.Py_ssize_t = min(i + 1, last)
        rise: cython.double = 0.0
        run: cython.double = fabs(parameter[b] - parameter[a]) / fabs(parameter[i])
        for d in range(amplitude.shape[1]):
            if amplitude[i, d] > 0.0:
                rise = max(rise, fabs(amplitude[b, d] - amplitude[a, d]) / amplitude[i, d])
        steep[i] = max(rise / run, 1.0) if rise < most * run else most
