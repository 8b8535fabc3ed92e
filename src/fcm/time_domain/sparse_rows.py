"""Rows of numbers with which the state vector is multiplied, of which most are zeros."""

from __future__ import annotations

import cython
import numpy as np

from fcm.model.scene import FloatArray


@cython.cclass
class Rows:
    """Rows (row, linear) without their zeros, of the state vector without the forces' phases."""

    def __init__(self, rows: FloatArray) -> None:
        places = np.nonzero(rows)
        self.count, self.dense = rows.shape[0], np.ascontiguousarray(rows.T)
        self.entry, self.column = rows[places], places[1].copy()
        self.first = np.searchsorted(places[0], np.arange(self.count + 1))
        self.used = np.unique(places[1])

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def dot(self, r: cython.Py_ssize_t, y: cython.double[:, ::1], k: cython.Py_ssize_t) -> cython.double:
        """Of row r with row k of y."""
        i: cython.Py_ssize_t
        total: cython.double = 0.0
        other: cython.double = 0.0  # two sums, for one would wait for each addition
        first: cython.Py_ssize_t = self.first[r]
        half: cython.Py_ssize_t = (self.first[r + 1] - first) // 2
        for i in range(first, first + half):
            total += self.entry[i] * y[k, self.column[i]]
            other += self.entry[half + i] * y[k, self.column[half + i]]
        for i in range(first + 2 * half, self.first[r + 1]):
            total += self.entry[i] * y[k, self.column[i]]
        return total + other

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def all(
        self,
        y: cython.double[:, ::1],
        k: cython.Py_ssize_t,
        out: cython.double[:, ::1],
        b: cython.Py_ssize_t,
    ) -> cython.void:
        """Of all rows with row k of y, into row b of out."""
        p: cython.Py_ssize_t
        r: cython.Py_ssize_t
        i: cython.Py_ssize_t
        x: cython.double
        for r in range(self.count):
            out[b, r] = 0.0
        for p in range(self.used.shape[0]):
            i = self.used[p]
            x = y[k, i]
            for r in range(self.count):
                out[b, r] += self.dense[i, r] * x
