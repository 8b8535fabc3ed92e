"""The derivatives of a motion along one flow, to any position in steps.

Along it the derivative by the start is the exponential of the flow's matrix. The frequency acts on the
forces alone, which may also grow with it: at a fixed time the derivatives of sin(h omega t) and
cos(h omega t) are h t cos(h omega t) and -h t sin(h omega t), and that of the columns of the forces is known
with the flow. Of the motion itself only the angle of the forces is needed. The level of the forces, a factor
of sin and cos, acts as a start does at which they alone differ.
"""

from __future__ import annotations

import cython
import numpy as np
from cython.cimports.libc.math import cos, sin

from fcm.time_domain.flow_cache import ORDER

if cython.compiled:
    from cython.cimports.fcm.time_domain.flow import Flows
    from cython.cimports.fcm.time_domain.polynomial import needed
else:
    from fcm.time_domain.flow import Flows
    from fcm.time_domain.polynomial import needed

FEW = cython.declare(cython.int, 4)  # rows that are sooner moved one by one
DENSE = cython.declare(cython.int, 32)  # components from which matrices are multiplied by BLAS
_POWERS = cython.declare(cython.int, 8)  # of two, of the steps by which a flow moves at once


@cython.cclass
class Along:
    """`follow` moves the rows of `columns` (unknowns + 2, size) along a flow.

    Row k < unknowns is a derivative of the state vector by its start; the row after them that by the
    frequency, at a fixed time, or by the level of the forces; of the last row, the state vector, only the
    forces' angle is moved. paced: 1 for the derivative by the frequency, 0 for that by the level.
    """

    def __init__(self, flows: Flows, unknowns: cython.Py_ssize_t) -> None:
        self.flows, self.unknowns, self.paced = flows, unknowns, 1.0
        self.columns = np.zeros((unknowns + 2, flows.size))
        self._terms, self._grades = np.zeros((ORDER + 1, flows.size)), np.zeros((ORDER + 1, flows.size))
        self._room = np.zeros((max(unknowns + 1, 4), flows.linear))
        self._flat = np.zeros(flows.linear**2)
        self._matrix = np.asarray(self._flat).reshape(flows.linear, -1)

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(-1, check=False)
    def follow(self, slot: cython.Py_ssize_t, position: cython.double) -> cython.int:
        """Along a flow, to a position in steps."""
        whole: cython.longlong = cython.cast(cython.longlong, position)
        x: cython.double = position - whole
        j: cython.int
        while whole >> _POWERS:
            self._whole(slot, _POWERS - 1)
            whole -= 1 << (_POWERS - 1)
        for j in range(_POWERS):
            if whole >> j & 1:
                self._whole(slot, j)
        self._part(slot, x)
        return 0

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(-1, check=False)
    def _whole(self, slot: cython.Py_ssize_t, j: cython.Py_ssize_t) -> cython.int:
        """By 2**j steps."""
        n: cython.Py_ssize_t = self.flows.linear
        u: cython.Py_ssize_t = self.unknowns
        i: cython.Py_ssize_t
        h: cython.Py_ssize_t
        b: cython.Py_ssize_t
        sine: cython.double
        cosine: cython.double
        by_sine: cython.double
        by_cosine: cython.double
        time: cython.double = self.flows.step[slot] * (1 << j)
        self.flows.reach(slot, j)
        self._times(self.flows.power[slot, j], u + 1)
        for h in range(self.flows.waves):
            b = n + 2 * h
            sine, cosine = self.paced * self.columns[u + 1, b], self.paced * self.columns[u + 1, b + 1]
            by_sine, by_cosine = self.columns[u, b], self.columns[u, b + 1]
            b = 4 * h
            for i in range(n):
                self.columns[u, i] += (
                    (
                        self.flows.forced[slot, j, b, i] * by_sine
                        + self.flows.forced[slot, j, b + 1, i] * by_cosine
                    )
                    + self.flows.forced[slot, j, b + 2, i] * sine
                ) + self.flows.forced[slot, j, b + 3, i] * cosine
            b = 2 * h
            self._rotate(h, self.flows.rotation[slot, j, b], self.flows.rotation[slot, j, b + 1], time)
        return 0

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def _rotate(
        self, h: cython.Py_ssize_t, c: cython.double, s: cython.double, time: cython.double
    ) -> cython.void:
        """Rotate a harmonic's forces by the angle with that cosine and sine, which takes that time [s]."""
        n: cython.Py_ssize_t = self.flows.linear + 2 * h
        u: cython.Py_ssize_t = self.unknowns
        k: cython.Py_ssize_t
        sine: cython.double
        cosine: cython.double
        for k in range(u, u + 2):
            sine, cosine = self.columns[k, n], self.columns[k, n + 1]
            self.columns[k, n], self.columns[k, n + 1] = c * sine + s * cosine, c * cosine - s * sine
        time *= self.paced * self.flows.harmonic[h]
        self.columns[u, n] += time * self.columns[u + 1, n + 1]
        self.columns[u, n + 1] -= time * self.columns[u + 1, n]

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(-1, check=False)
    def _times(self, matrix: cython.double[:, ::1], rows: cython.Py_ssize_t) -> cython.int:
        """Multiply so many of the derivatives by the matrix of a flow."""
        n: cython.Py_ssize_t = self.flows.linear
        k: cython.Py_ssize_t
        done: cython.Py_ssize_t = 0
        if n >= DENSE:
            with cython.gil:
                columns, room = np.asarray(self.columns)[:rows, :n], np.asarray(self._room)[:rows]
                np.matmul(columns, matrix, out=room)
                columns[:] = room
            return 0
        if cython.compiled:  # four rows at once, see the .pxd: every number is the same either way
            row, other = cython.address(self.columns[0, 0]), cython.address(matrix[0, 0])
            stride: cython.Py_ssize_t = self.columns.shape[1]
            done = fours_times(row, stride, rows, other, n, cython.address(self._room[0, 0]))  # type: ignore[name-defined]  # noqa: F821
        for k in range(done, rows):
            self._row_times(matrix, k)
        return 0

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def _row_times(self, matrix: cython.double[:, ::1], k: cython.Py_ssize_t) -> cython.void:
        """Multiply one of the derivatives by the matrix of a flow."""
        n: cython.Py_ssize_t = self.flows.linear
        i: cython.Py_ssize_t
        p: cython.Py_ssize_t = 0
        a: cython.double
        b: cython.double
        c: cython.double
        d: cython.double
        for i in range(n):
            self._room[0, i] = 0.0
        while p + 4 <= n:  # four together, to go through the sums less often
            a, b, c, d = (
                self.columns[k, p],
                self.columns[k, p + 1],
                self.columns[k, p + 2],
                self.columns[k, p + 3],
            )
            if a != 0.0 or b != 0.0 or c != 0.0 or d != 0.0:
                for i in range(n):
                    self._room[0, i] = (
                        ((self._room[0, i] + matrix[p, i] * a) + matrix[p + 1, i] * b) + matrix[p + 2, i] * c
                    ) + matrix[p + 3, i] * d
            p += 4
        while p < n:
            a = self.columns[k, p]
            if a != 0.0:
                for i in range(n):
                    self._room[0, i] += matrix[p, i] * a
            p += 1
        for i in range(n):
            self.columns[k, i] = self._room[0, i]

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(-1, check=False)
    def _fraction(self, slot: cython.Py_ssize_t, x: cython.double, orders: cython.Py_ssize_t) -> cython.int:
        """Those by the start by a part x of a step: by its matrix or, where that is more work, row by row."""
        n: cython.Py_ssize_t = self.flows.linear
        i: cython.Py_ssize_t
        j: cython.Py_ssize_t
        size: cython.double
        a: cython.double
        b: cython.double
        c: cython.double
        d: cython.double
        if self.flows.terms.shape[1] == 0 or self.unknowns < FEW:
            self.flows.part(slot, x, self.columns, 0, self.unknowns)
            return 0
        if not self.flows.spelled[slot]:
            with cython.gil:
                self.flows.spell(slot)
        size = x
        for i in range(n * n):
            self._flat[i] = self.flows.terms[slot, 0, i]
        j = 1
        while j + 3 <= orders:  # four together, as in `_times`
            a, b, c, d = size, size * x, size * x * x, size * x * x * x
            for i in range(n * n):
                self._flat[i] = (
                    (
                        (self._flat[i] + a * self.flows.terms[slot, j, i])
                        + b * self.flows.terms[slot, j + 1, i]
                    )
                    + c * self.flows.terms[slot, j + 2, i]
                ) + d * self.flows.terms[slot, j + 3, i]
            size = d * x
            j += 4
        while j <= orders:
            for i in range(n * n):
                self._flat[i] += size * self.flows.terms[slot, j, i]
            size *= x
            j += 1
        self._times(self._matrix, self.unknowns)
        return 0

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(-1, check=False)
    def _part(self, slot: cython.Py_ssize_t, x: cython.double) -> cython.int:
        """By a part x < 1 of a step."""
        n: cython.Py_ssize_t = self.flows.linear
        u: cython.Py_ssize_t = self.unknowns
        size: cython.double
        orders: cython.Py_ssize_t = needed(x)
        time: cython.double = x * self.flows.step[slot]
        angle: cython.double
        h: cython.Py_ssize_t
        b: cython.Py_ssize_t
        i: cython.Py_ssize_t
        j: cython.Py_ssize_t
        self._fraction(slot, x, orders)
        for i in range(self.flows.size):
            self._grades[0, i] = self.columns[u, i]
        for h in range(self.flows.waves):
            b = n + 2 * h
            self._terms[0, b] = self.paced * self.columns[u + 1, b]
            self._terms[0, b + 1] = self.paced * self.columns[u + 1, b + 1]
            for j in range(orders):
                size = self.flows.harmonic[h] * time * self.flows.omega / (j + 1)
                self._terms[j + 1, b], self._terms[j + 1, b + 1] = (
                    size * self._terms[j, b + 1],
                    -size * self._terms[j, b],
                )
        self.flows.extend(slot, self._grades, orders, time, self._terms, True)
        for j in range(orders - 1, -1, -1):
            for i in range(n):
                self._grades[j, i] += self._grades[j + 1, i]
        for i in range(n):
            self.columns[u, i] = self._grades[0, i]
        for h in range(self.flows.waves):
            angle = self.flows.harmonic[h] * self.flows.omega * time
            self._rotate(h, cos(angle), sin(angle), time)
        return 0
