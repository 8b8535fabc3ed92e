"""Measures of a motion: integrals of its modal displacements, extremes of rows of its state, powers.

`MotionIntegrals` are integrals of displacements, also times sin and cos. Over a step, a displacement is the
polynomial with the exact first `TERMS` Taylor coefficients at both ends. The polynomial and its integrals
times exp(i theta) are exact to rounding, as its error is of the order 1e-19. All this is linear in the state
vector. So the vectors of all whole steps are summed before their coefficients are computed.

`Powers` integrates all powers by Gauss quadrature that is exact to rounding on a step.

`Scan` finds extremes as roots of velocities. It expands only steps that may contain one. In these the
velocity changes sign between the ends, or has an extreme beyond zero between ends of the same sign. The
extreme also has to exceed the values at the ends of the steps, which are evaluated first.

`SparseRows` are rows that multiply the state vector, mostly zeros.
"""

from __future__ import annotations

from math import comb

import cython
import numpy as np
from cython.cimports.libc.math import cos, fabs, sin

from fcm.model.scene import FloatArray
from fcm.time_domain.flow import ORDER
from fcm.time_domain.segments import SPAN

if cython.compiled:
    from cython.cimports.fcm.time_domain.flow import (
        SERIES_ORDER,
        STATE_NEGATIVE_SLIP,
        STATE_POSITIVE_SLIP,
        Flows,
        root,
        summed,
        value,
    )
    from cython.cimports.fcm.time_domain.segments import Segments, Walk
else:
    from fcm.time_domain.flow import (
        SERIES_ORDER,
        STATE_NEGATIVE_SLIP,
        STATE_POSITIVE_SLIP,
        Flows,
        root,
        summed,
        value,
    )
    from fcm.time_domain.segments import Segments, Walk


POWER_NODES = 8  # integrate exactly polynomials of degree 15
_POWER_PLACES, _POWER_SHARES = np.polynomial.legendre.leggauss(POWER_NODES)
_POWER_ON_ONE = 0.5 * (_POWER_PLACES + 1.0), 0.5 * _POWER_SHARES  # on [0, 1]
_POWER_NODES = cython.declare(cython.int, POWER_NODES)


@cython.cclass
class Powers(Walk):
    """Work of the forces, dissipation by slip and by damping, and the sum of their magnitudes over a motion.

    `slips` and `paths` (contact,): the dissipation by each contact, and its slip path.

    Parameters
    ----------
    flows : Flows
    wave : (2 waves, mode)
        Modal amplitudes of the forces: for sin(h theta) and cos(h theta) at each of their harmonics h.
    static : (mode,)
        Modal steady forces.
    damper : (mode,)
        2 m zeta omega of the modes.
    everywhere : bool
        Whether to integrate everywhere; otherwise only while a contact slips, which suffices for slip.
    """

    def __init__(
        self, flows: Flows, wave: FloatArray, static: FloatArray, damper: FloatArray, everywhere: bool = True
    ) -> None:
        Walk.__init__(self, flows)
        self._everywhere = everywhere
        self._wave, self._static, self._damper = wave, static, damper
        self._y, self._terms = np.zeros((2, flows.size)), np.zeros((ORDER + 1, flows.size))
        self._nodes, self._weights = _POWER_ON_ONE
        self.slips, self.paths = np.zeros((2, flows.contacts))
        self._none()

    def begins(self, segments: Segments) -> None:
        """Prepares for the segments, with all integrals zero."""
        Walk.begins(self, segments)
        self._none()

    def _none(self) -> None:
        """Sets all integrals to zero."""
        self.work = self.slip = self.damping = self.turnover = 0.0
        self.slips[:] = 0.0
        self.paths[:] = 0.0

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(-1, check=False)
    def visit(self, slot: cython.Py_ssize_t) -> cython.int:
        """Integrates along the present segment, step by step."""
        left: cython.double = self.segments.length[self.at]
        length: cython.double
        i: cython.Py_ssize_t
        slips: cython.bint = self._everywhere
        for i in range(self.flows.contacts):
            slips |= self.segments.states[self.at, i] >= STATE_POSITIVE_SLIP
        if not slips:
            return 0
        for i in range(self.flows.size):
            self._y[1, i] = self.segments.y[self.at, i]
        while left > 0.0:
            length = min(left, 1.0)
            self.flows.taylor(slot, self._y, 1, self._terms)
            for i in range(_POWER_NODES):
                summed(self._terms, self._nodes[i] * length, self._y, 0)
                self._add(self._weights[i] * length * self.flows.step[slot])
            summed(self._terms, 1.0, self._y, 1)
            left -= 1.0
        return 0

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def _add(self, weight: cython.double) -> cython.void:
        """Adds the weighted powers at an instant; w' of a slipping contact follows from (6), (8)."""
        m: cython.Py_ssize_t = self.flows.modes
        n: cython.Py_ssize_t = self.flows.linear
        i: cython.Py_ssize_t
        j: cython.Py_ssize_t
        state: cython.int
        push: cython.double
        power: cython.double = 0.0
        loss: cython.double = 0.0
        slip: cython.double = 0.0
        rate: cython.double
        ratio: cython.double
        for i in range(m):
            push = 0.0
            for j in range(self._wave.shape[0]):
                push += self._wave[j, i] * self._y[0, n + j]
            power += self._y[0, m + i] * (push + self._static[i])
            loss += self._damper[i] * self._y[0, m + i] * self._y[0, m + i]
        for j in range(self.flows.contacts):
            state = self.segments.states[self.at, j]
            if state != STATE_POSITIVE_SLIP and state != STATE_NEGATIVE_SLIP:
                continue
            ratio = self.flows.mu[j] * self.flows.k_v[j] / self.flows.k_u[j]
            if state == STATE_NEGATIVE_SLIP:
                ratio = -ratio
            rate = 0.0
            for i in range(m):
                rate += self._y[0, m + i] * (self.flows.tangential[j, i] - ratio * self.flows.normal[j, i])
            lost: cython.double = self._y[0, 2 * m + j] * rate
            slip += lost
            self.slips[j] += weight * lost
            self.paths[j] += weight * fabs(rate)
        self.work += weight * power
        self.slip += weight * slip
        self.damping += weight * loss
        self.turnover += weight * (fabs(power) + slip + loss)


TERMS = 8  # Taylor coefficients of the displacements at each end of a step: 8!**2 / (16! 17!) = 2e-19
NODES = 16  # integrate exactly polynomials of degree 31
_TERMS = cython.declare(cython.int, TERMS)
_NODES = cython.declare(cython.int, NODES)


def _basis(x: FloatArray) -> FloatArray:
    """Values (x, 2 TERMS) of Hermite polynomials on [0, 1], each with one Taylor coefficient 1 at an end."""
    columns = []
    for end in (x, 1.0 - x):
        for k in range(TERMS):
            series = sum(comb(TERMS - 1 + s, s) * end**s for s in range(TERMS - k))
            columns.append(end**k * (1.0 - end) ** TERMS * series * (1.0 if end is x else (-1.0) ** k))
    return np.array(columns).T.copy()


_PLACES, _SHARES = np.polynomial.legendre.leggauss(NODES)
_ON_ONE = 0.5 * (_PLACES + 1.0), 0.5 * _SHARES[:, None] * _basis(0.5 * (_PLACES + 1.0))


@cython.cclass
class MotionIntegrals(Walk):
    """Time integrals of q, q sin(theta) and q cos(theta) over a motion, in `sums` (3, mode)."""

    def __init__(self, flows: Flows) -> None:
        Walk.__init__(self, flows)
        self.sums = np.zeros((3, flows.modes))
        self._nodes, self._shares = _ON_ONE
        self._length = 0.0
        self._weights, self._terms = np.zeros((3, 2 * TERMS)), np.zeros((TERMS, flows.size))
        self._there, self._sums = np.zeros((2, flows.size)), np.zeros((6, flows.size))

    def begins(self, segments: Segments) -> None:
        """Prepares for the segments, with all sums zero."""
        i: cython.Py_ssize_t
        b: cython.int
        Walk.begins(self, segments)
        for b in range(3):
            for i in range(self.flows.modes):
                self.sums[b, i] = 0.0

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(-1, check=False)
    def visit(self, slot: cython.Py_ssize_t) -> cython.int:
        """Integrates along the present segment: over its whole steps, then over the rest."""
        h: cython.double = self.flows.step[slot]
        whole: cython.longlong = cython.cast(cython.longlong, self.segments.length[self.at])
        x: cython.double = self.segments.length[self.at] - whole
        i: cython.Py_ssize_t
        b: cython.int
        for i in range(self.flows.size):
            self._there[0, i] = self.segments.y[self.at, i]
        if whole > 0:
            for b in range(6):
                for i in range(self.flows.size):
                    self._sums[b, i] = 0.0
            self._steps(slot, whole)
            self._weigh(h)
            for b in range(2):
                self._take(slot, self._sums[3 * b], b, 1.0, 0.0, 0.0)
                self._take(slot, self._sums[3 * b + 1], b, 0.0, 1.0, 0.0)
                self._take(slot, self._sums[3 * b + 2], b, 0.0, 0.0, 1.0)
        if x > 0.0:
            self._weigh(x * h)
            sine: cython.double = self._there[0, self.flows.linear]
            cosine: cython.double = self._there[0, self.flows.linear + 1]
            self._take(slot, self._there[0], 0, 1.0, sine, cosine)
            self.flows.part(slot, x, self._there, 0, 1)
            self._take(slot, self._there[0], 1, 1.0, sine, cosine)
        return 0

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(-1, check=False)
    def _steps(self, slot: cython.Py_ssize_t, whole: cython.longlong) -> cython.int:
        """Sums the states at both ends of whole steps, times 1, and sin and cos of theta at the first."""
        i: cython.Py_ssize_t
        k: cython.Py_ssize_t
        while self.span > 0 and whole >= self.span:
            for i in range(self.flows.size):
                self.ahead[0, i] = self._there[0, i]
            with cython.gil:
                self.fill_ahead(slot)
            for k in range(self.span):
                self._gather(self.ahead, k)
            for i in range(self.flows.size):
                self._there[0, i] = self.ahead[self.span, i]
            whole -= self.span
        while whole > 0:
            for i in range(self.flows.size):
                self._there[1, i] = self._there[0, i]
            self.flows.advance(slot, 0, self._there, 1)
            self._gather(self._there, 0)
            for i in range(self.flows.size):
                self._there[0, i] = self._there[1, i]
            whole -= 1
        return 0

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def _gather(self, y: cython.double[:, ::1], k: cython.Py_ssize_t) -> cython.void:
        """Adds the step from row k of y to row k + 1."""
        i: cython.Py_ssize_t
        sine: cython.double = y[k, self.flows.linear]
        cosine: cython.double = y[k, self.flows.linear + 1]
        for i in range(self.flows.size):
            self._sums[0, i] += y[k, i]
            self._sums[1, i] += sine * y[k, i]
            self._sums[2, i] += cosine * y[k, i]
            self._sums[3, i] += y[k + 1, i]
            self._sums[4, i] += sine * y[k + 1, i]
            self._sums[5, i] += cosine * y[k + 1, i]

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def _weigh(self, length: cython.double) -> cython.void:
        """Sets the weights of the coefficients in the integrals of q times 1, sin and cos.

        They hold for steps of a length [s]; the angle is relative to the start of a step."""
        angle: cython.double = self.flows.omega * length
        i: cython.int
        j: cython.int
        real: cython.double
        imag: cython.double
        share: cython.double
        self._length = length
        for j in range(2 * _TERMS):
            self._weights[0, j] = self._weights[1, j] = self._weights[2, j] = 0.0
        for i in range(_NODES):
            imag, real = sin(angle * self._nodes[i]), cos(angle * self._nodes[i])
            for j in range(2 * _TERMS):
                share = self._shares[i, j]
                self._weights[0, j] += share
                self._weights[1, j] += share * imag
                self._weights[2, j] += share * real

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def _take(
        self,
        slot: cython.Py_ssize_t,
        y: cython.double[::1],
        end: cython.int,
        one: cython.double,
        sine: cython.double,
        cosine: cython.double,
    ) -> cython.void:
        """Adds the contribution of y at the first (0) or last (1) end of the steps weighed last.

        y is a state vector, or its sum over steps times sin or cos of the forces' angle at the first end.
        """
        i: cython.Py_ssize_t
        j: cython.int
        w: cython.int
        even: cython.double
        by_sine: cython.double
        by_cosine: cython.double
        for i in range(self.flows.size):
            self._terms[0, i] = y[i]
        self.flows.extend(slot, self._terms, _TERMS - 1, self._length, self._terms, False)
        for j in range(_TERMS):
            w = end * _TERMS + j
            even = self._length * one * self._weights[0, w]
            by_sine = self._length * (sine * self._weights[2, w] + cosine * self._weights[1, w])
            by_cosine = self._length * (cosine * self._weights[2, w] - sine * self._weights[1, w])
            for i in range(self.flows.modes):
                self.sums[0, i] += even * self._terms[j, i]
                self.sums[1, i] += by_sine * self._terms[j, i]
                self.sums[2, i] += by_cosine * self._terms[j, i]


@cython.cclass
class SparseRows:
    """Sparse rows (row, linear) that act on the state vector without the forces' phases."""

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
        """Product of row r with row k of y."""
        i: cython.Py_ssize_t
        total: cython.double = 0.0
        other: cython.double = 0.0  # two sums, as a single one would wait for each addition
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
        self, y: cython.double[:, ::1], k: cython.Py_ssize_t, out: cython.double[:, ::1], b: cython.Py_ssize_t
    ) -> cython.void:
        """Products of all rows with row k of y, written to row b of out."""
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


LARGEST = cython.declare(cython.double, 1.7976931348623157e308)  # beyond every value
_SPAN = cython.declare(cython.int, SPAN)


@cython.cclass
class Scan(Walk):
    """Extremes of rows @ y over a motion, in `greatest` and `least` (row,).

    `place` (2 rows, 2) is where they are: segment and position of all least, then of all greatest values.
    """

    def __init__(self, flows: Flows, rows: SparseRows) -> None:
        Walk.__init__(self, flows)
        self._rows = rows
        self.greatest, self.least = np.zeros(rows.count), np.zeros(rows.count)
        self.place, self._powers = np.zeros((2 * rows.count, 2)), np.zeros(ORDER + 1)
        self._there, self._terms = np.zeros((3, flows.size)), np.zeros((ORDER + 1, flows.size))
        self._path = self.ahead if self.span else np.zeros((SPAN + 1, flows.size))
        self._values = np.zeros((2, SPAN + 1, rows.count))
        self._first, self._length = 0.0, 0.0

    def begins(self, segments: Segments) -> None:
        """Prepares for the segments, without extremes."""
        r: cython.Py_ssize_t
        Walk.begins(self, segments)
        for r in range(self._rows.count):
            self.greatest[r], self.least[r] = -LARGEST, LARGEST

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(-1, check=False)
    def visit(self, slot: cython.Py_ssize_t) -> cython.int:
        """Scans the present segment, some steps at a time: first their ends, then their insides."""
        left: cython.double = self.segments.length[self.at]
        i: cython.Py_ssize_t
        k: cython.Py_ssize_t
        count: cython.Py_ssize_t
        self._first = 0.0
        for i in range(self.flows.size):
            self._path[0, i] = self.segments.y[self.at, i]
        while left > 0.0:
            count = self._steps(slot, left)
            self._note_ends(count, min(left - (count - 1), 1.0))
            for k in range(count):
                self._length = min(left - k, 1.0)
                self._step(slot, k)
            for i in range(self.flows.size):
                self._path[0, i] = self._path[count, i]
            self._first += count
            left -= count
        return 0

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(-1, check=False)
    def _steps(self, slot: cython.Py_ssize_t, left: cython.double) -> cython.Py_ssize_t:
        """Computes the next steps and the rows at their ends; returns the number of steps."""
        i: cython.Py_ssize_t
        count: cython.Py_ssize_t = 0
        if self.span > 0 and left >= self.span:
            with cython.gil:
                self.fill_ahead(slot)
                self.values(slot)
            return self.span
        self._rows_at(slot, 0)
        while count < _SPAN and left > 0.0:
            for i in range(self.flows.size):
                self._path[count + 1, i] = self._path[count, i]
            count += 1
            if left >= 1.0:
                self.flows.advance(slot, 0, self._path, count)
            else:
                self.flows.part(slot, left, self._path, count, count + 1)
            self._rows_at(slot, count)
            left -= 1.0
        return count

    def values(self, slot: cython.Py_ssize_t) -> None:
        """Fills the rows' values and slopes at the state vectors `ahead`."""
        n: cython.Py_ssize_t = self.flows.linear
        rows, y = np.asarray(self._rows.dense), np.asarray(self.ahead)
        out, forces = np.asarray(self._values), np.zeros((2 * self.flows.waves, 2, self.flows.size))
        for b in range(2 * self.flows.waves):
            forces[b, 0, n + b] = 1.0
            self.flows.extend(slot, forces[b], 1, self.flows.step[slot], forces[b], False)
        term = np.asarray(self.flows.terms)[slot, 1].reshape(n, n)
        np.matmul(y[:, :n], rows, out=out[0])
        np.matmul(y, np.vstack((term @ rows, forces[:, 1, :n] @ rows)), out=out[1])

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def _rows_at(self, slot: cython.Py_ssize_t, k: cython.Py_ssize_t) -> cython.void:
        """Fills the rows' values and slopes (by the position) at the start of step k."""
        self._spread(slot, k, 1)
        self._rows.all(self._there, 0, self._values[0], k)
        self._rows.all(self._there, 1, self._values[1], k)

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def _spread(self, slot: cython.Py_ssize_t, k: cython.Py_ssize_t, last: cython.Py_ssize_t) -> cython.void:
        """Fills the Taylor coefficients up to `last`, by the position, at the start of step k."""
        i: cython.Py_ssize_t
        for i in range(self.flows.size):
            self._there[0, i] = self._path[k, i]
        self.flows.extend(slot, self._there, last, self.flows.step[slot], self._there, False)

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def _note_ends(self, count: cython.Py_ssize_t, last: cython.double) -> cython.void:
        """Notes the values at the ends of `count` steps, the last of which has the length `last`."""
        k: cython.Py_ssize_t
        r: cython.Py_ssize_t
        for k in range(count + 1):
            for r in range(self.greatest.shape[0]):
                self._note(r, k if k < count else k - 1 + last, self._values[0, k, r])

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def _step(self, slot: cython.Py_ssize_t, k: cython.Py_ssize_t) -> cython.void:
        """Searches step k for extremes of all rows."""
        r: cython.Py_ssize_t
        expanded: cython.bint = False
        for r in range(self.greatest.shape[0]):
            if self._may_exceed(r, k) and self._has_extreme(slot, r, k):
                if not expanded:
                    self.flows.taylor(slot, self._path, k, self._terms)
                    expanded = True
                self._extremes(r, k)

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def _may_exceed(self, r: cython.Py_ssize_t, k: cython.Py_ssize_t) -> cython.bint:
        """Whether the motion within step k may exceed the extremes so far, by the slopes at its ends.

        Let r be the greater slope per step at the ends. A step is a short part of the fastest motion, so no
        slope within it exceeds 2 r. So the motion stays within r of the mean of its ends.
        """
        middle: cython.double = 0.5 * (self._values[0, k, r] + self._values[0, k + 1, r])
        reach: cython.double = max(fabs(self._values[1, k, r]), fabs(self._values[1, k + 1, r]))
        return middle + reach > self.greatest[r] or middle - reach < self.least[r]

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def _has_extreme(
        self, slot: cython.Py_ssize_t, r: cython.Py_ssize_t, k: cython.Py_ssize_t
    ) -> cython.bint:
        """Whether step k may have an extreme of row r inside."""
        first: cython.double = self._values[1, k, r]
        bend: cython.double
        if first * self._values[1, k + 1, r] < 0.0:
            return True
        self._spread(slot, k, 2)
        bend = self._rows.dot(r, self._there, 2)
        if bend * first >= 0.0:
            return False
        self._spread(slot, k + 1, 2)
        return bend * self._rows.dot(r, self._there, 2) < 0.0

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def _extremes(self, r: cython.Py_ssize_t, k: cython.Py_ssize_t) -> cython.void:
        """Notes the extremes of row r within step k, whose Taylor coefficients are in `_terms`."""
        first: cython.double = self._values[1, k, r]
        j: cython.int
        inflection: cython.double
        for j in range(SERIES_ORDER + 1):
            self._powers[j] = self._rows.dot(r, self._terms, j)
        if first * self._values[1, k + 1, r] < 0.0:
            self._extreme_between(r, k, 0.0, self._length)
            return
        inflection = root(self._powers, 2, 0.0, self._length)
        if value(self._powers, 1, inflection) * first < 0.0:
            self._extreme_between(r, k, 0.0, inflection)
            self._extreme_between(r, k, inflection, self._length)

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def _extreme_between(
        self, r: cython.Py_ssize_t, k: cython.Py_ssize_t, low: cython.double, high: cython.double
    ) -> cython.void:
        """Notes the value where the velocity changes sign in a part of step k."""
        x: cython.double = root(self._powers, 1, low, high)
        self._note(r, k + x, value(self._powers, 0, x))

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def _note(self, r: cython.Py_ssize_t, x: cython.double, here: cython.double) -> cython.void:
        """Notes a value, x steps from the first step of the block, if it is an extreme so far."""
        if here > self.greatest[r]:
            self.greatest[r] = here
            self._put(self._rows.count + r, x)
        if here < self.least[r]:
            self.least[r] = here
            self._put(r, x)

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def _put(self, k: cython.Py_ssize_t, x: cython.double) -> cython.void:
        """Records segment and position x of an extreme."""
        self.place[k, 0], self.place[k, 1] = self.at, self._first + x
