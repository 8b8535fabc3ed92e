"""Reflections of a square matrix from both sides, which leave its eigenvalues as they are.

Arrays have no local names here: to take one counts a reference, which lasts as long as a short row does.
"""

from __future__ import annotations

import cython
import numpy as np
from cython.cimports.libc.math import fabs, sqrt


@cython.cclass
class Reflections:
    """`reflect` the matrix a: fill v with what is to lie on the first axis after. w is a workspace."""

    def __init__(self, most: cython.int) -> None:
        self.a = np.zeros((most, most))
        self.v, self.w = np.zeros((2, max(most, 3)))

    @cython.cfunc
    @cython.exceptval(check=False)
    def reflect(
        self,
        at: cython.Py_ssize_t,
        count: cython.Py_ssize_t,
        left: cython.Py_ssize_t,
        top: cython.Py_ssize_t,
        bottom: cython.Py_ssize_t,
        end: cython.Py_ssize_t,
    ) -> cython.void:
        """A similarity by the reflection that turns v into the first axis.

        It is of the rows and columns from `at` on: of the rows what is from `left` to `end`, of the columns
        what is from `top` to `bottom`.
        """
        weight: cython.double = self.aim(count)
        if weight == 0.0:
            return
        if count == 3:
            self.three_rows(at, left, end, weight)
            self.three_columns(at, top, bottom, weight)
        else:
            self.rows(at, count, left, end, weight)
            self.columns(at, count, top, bottom, weight)

    @cython.cfunc
    @cython.exceptval(check=False)
    def aim(self, count: cython.Py_ssize_t) -> cython.double:
        """Let 1 - weight v v' be the reflection that turns v into the first axis; the weight, 0 if v is 0."""
        i: cython.Py_ssize_t
        most: cython.double = 0.0
        square: cython.double = 0.0
        part: cython.double
        for i in range(count):
            most = max(most, fabs(self.v[i]))
        if most == 0.0:
            return 0.0
        part = 1.0 / most  # divisions take longest, and of a bulge's reflections as long as all else
        for i in range(count):
            self.v[i] *= part
            square += self.v[i] * self.v[i]
        total: cython.double = sqrt(square) if self.v[0] >= 0.0 else -sqrt(square)
        weight: cython.double = 1.0 + self.v[0] / total
        part = 1.0 / (self.v[0] + total)
        for i in range(1, count):
            self.v[i] *= part
        self.v[0] = 1.0
        return weight

    @cython.cfunc
    @cython.exceptval(check=False)
    def three_rows(
        self, at: cython.Py_ssize_t, left: cython.Py_ssize_t, end: cython.Py_ssize_t, weight: cython.double
    ) -> cython.void:
        """Of a bulge, whose rows are short: what they make of one another is not stored between."""
        j: cython.Py_ssize_t
        second: cython.double = self.v[1]
        third: cython.double = self.v[2]
        total: cython.double
        for j in range(left, end):
            total = weight * (self.a[at, j] + second * self.a[at + 1, j] + third * self.a[at + 2, j])
            self.a[at, j] -= total
            self.a[at + 1, j] -= total * second
            self.a[at + 2, j] -= total * third

    @cython.cfunc
    @cython.exceptval(check=False)
    def three_columns(
        self, at: cython.Py_ssize_t, top: cython.Py_ssize_t, bottom: cython.Py_ssize_t, weight: cython.double
    ) -> cython.void:
        """The same of its columns."""
        j: cython.Py_ssize_t
        second: cython.double = self.v[1]
        third: cython.double = self.v[2]
        total: cython.double
        for j in range(top, bottom):
            total = weight * (self.a[j, at] + second * self.a[j, at + 1] + third * self.a[j, at + 2])
            self.a[j, at] -= total
            self.a[j, at + 1] -= total * second
            self.a[j, at + 2] -= total * third

    @cython.cfunc
    @cython.exceptval(check=False)
    def rows(
        self,
        at: cython.Py_ssize_t,
        count: cython.Py_ssize_t,
        left: cython.Py_ssize_t,
        end: cython.Py_ssize_t,
        weight: cython.double,
    ) -> cython.void:
        """a - weight v (v' a), row by row."""
        i: cython.Py_ssize_t
        j: cython.Py_ssize_t
        part: cython.double
        for j in range(left, end):
            self.w[j] = 0.0
        for i in range(count):
            part = weight * self.v[i]
            for j in range(left, end):
                self.w[j] += part * self.a[at + i, j]
        for i in range(count):
            part = self.v[i]
            for j in range(left, end):
                self.a[at + i, j] -= part * self.w[j]

    @cython.cfunc
    @cython.exceptval(check=False)
    def columns(
        self,
        at: cython.Py_ssize_t,
        count: cython.Py_ssize_t,
        top: cython.Py_ssize_t,
        bottom: cython.Py_ssize_t,
        weight: cython.double,
    ) -> cython.void:
        """a - weight (a v) v'; of each row's sum four parts at once, which need not wait for one another."""
        i: cython.Py_ssize_t
        j: cython.Py_ssize_t
        p: cython.double
        q: cython.double
        r: cython.double
        s: cython.double
        for j in range(top, bottom):
            p = q = r = s = 0.0
            i = 0
            while i + 4 <= count:
                p += self.v[i] * self.a[j, at + i]
                q += self.v[i + 1] * self.a[j, at + i + 1]
                r += self.v[i + 2] * self.a[j, at + i + 2]
                s += self.v[i + 3] * self.a[j, at + i + 3]
                i += 4
            while i < count:
                p += self.v[i] * self.a[j, at + i]
                i += 1
            p = weight * (p + q + r + s)
            for i in range(count):
                self.a[j, at + i] -= p * self.v[i]
