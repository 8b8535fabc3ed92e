"""What is measured of a motion: integrals of the modal displacements, extremes of any rows, samples.

The integrals over a step are those of its polynomial, times exp(-i theta) by moments from Gauss quadrature.
An extreme is a root of the velocity: where that changes its sign from end to end of a step, or has an
extreme of its own between ends of one sign and beyond zero.
"""

from __future__ import annotations

import cython
import numpy as np
from cython.cimports.libc.math import cos, fabs, sin

from fcm.motion.pool import ORDER
from fcm.scene.model import FloatArray

if cython.compiled:
    from cython.cimports.fcm.motion.steps import Steps
else:
    from fcm.motion.steps import Steps

NODES = 16  # integrate exactly polynomials of degree 31; what a step has beyond that is rounding
_ORDER = cython.declare(cython.int, 19)
_PLACES, _SHARES = np.polynomial.legendre.leggauss(NODES)
_ON_ONE = 0.5 * (_PLACES + 1.0), 0.5 * _SHARES  # on [0, 1]
_NODES = cython.declare(cython.int, 16)


@cython.cclass
class Gauge:
    """Measures of a motion.

    `mean`, `sine` and `cosine` (mode,) are the integrals over time of q, q sin(theta) and q cos(theta);
    `greatest` and `least` (row,) the extremes of rows @ y, y without its last two components, and `place`
    (row, 4) where they are: segment and position of the greatest, and of the least.
    """

    def __init__(self, steps: Steps, rows: FloatArray, integrals: bool = True) -> None:
        self.steps, self._integrals = steps, integrals
        count, m = rows.shape[0], steps.flows.modes
        places = np.nonzero(rows)
        self._entry, self._column = rows[places], places[1].copy()
        self._first = np.searchsorted(places[0], np.arange(count + 1))
        self.mean, self.sine, self.cosine = np.zeros(m), np.zeros(m), np.zeros(m)
        self.greatest, self.least = np.full(count, -np.inf), np.full(count, np.inf)
        self.place, self._powers = np.zeros((count, 4)), np.zeros(ORDER + 1)
        self._real, self._imag, self._slot = np.zeros(ORDER + 1), np.zeros(ORDER + 1), -1
        self._ends = np.zeros((3, steps.flows.size))
        self._here, self._there = np.zeros((3, steps.flows.size)), np.zeros((3, steps.flows.size))
        self._old, self._new = np.zeros((3, count)), np.zeros((3, count))
        self._nodes, self._weights = _ON_ONE

    def go(self) -> int:
        """Measure all steps: 0 when done, -1 where a flow is missing."""
        stopped: cython.int
        with cython.nogil:
            stopped = self._go() if self._integrals else self._scan()
        return int(stopped)

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def _scan(self) -> cython.int:
        """The extremes alone: only steps that may hold one are expanded."""
        slot: cython.Py_ssize_t
        while self.steps.at + 1 < self.steps.segments.count:
            if self.steps.segments.length[self.steps.at + 1] > 0.0:
                slot = self.steps.flows.find(self.steps.segments.states, self.steps.at + 1)
                if slot < 0:
                    return -1
                self.steps.flows.refresh(slot)
                self.steps.at += 1
                self._scan_segment(slot)
            else:
                self.steps.at += 1
        return 0

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def _scan_segment(self, slot: cython.Py_ssize_t) -> cython.void:
        left: cython.double = self.steps.segments.length[self.steps.at]
        length: cython.double
        i: cython.Py_ssize_t
        r: cython.Py_ssize_t
        expanded: cython.bint
        self.steps.first = 0.0
        for i in range(self.steps.flows.size):
            self._here[0, i] = self._there[0, i] = self.steps.segments.y[self.steps.at, i]
        self._look(slot, self._old)
        for r in range(self.greatest.shape[0]):
            self._note(r, 0.0, self._old[0, r])
        while left > 0.0:
            length = min(left, 1.0)
            if length == 1.0:
                self.steps.flows.advance(slot, 0, self._there, 0)
            else:
                self.steps.flows.part(slot, length, self._there, 0)
            self._look(slot, self._new)
            expanded = False
            for r in range(self.greatest.shape[0]):
                if self._may_turn(r):
                    if not expanded:
                        self.steps.length = length
                        self.steps.flows.taylor(slot, self._here, 0, self.steps.terms)
                        self._reach_end()
                        expanded = True
                    self._extremes(r)
                self._note(r, length, self._new[0, r])
                for i in range(3):
                    self._old[i, r] = self._new[i, r]
            for i in range(self.steps.flows.size):
                self._here[0, i] = self._there[0, i]
            left -= 1.0
            self.steps.first += 1.0

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def _look(self, slot: cython.Py_ssize_t, out: cython.double[:, ::1]) -> cython.void:
        """The rows at the place there, and their first two derivatives by the position."""
        r: cython.Py_ssize_t
        j: cython.int
        h: cython.double = self.steps.flows.step[slot]
        self.steps.flows.derive(slot, self._there, 0, self._there, 1, h)
        self.steps.flows.derive(slot, self._there, 1, self._there, 2, h)
        for r in range(self.greatest.shape[0]):
            for j in range(3):
                out[j, r] = self._dot(r, self._there, j)

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def _may_turn(self, r: cython.Py_ssize_t) -> cython.bint:
        """Whether the step may hold an extreme beyond those so far, by the slopes at its ends.

        A step is a part of the fastest motion in which no slope grows to more than twice those at its ends.
        """
        first: cython.double = self._old[1, r]
        last: cython.double = self._new[1, r]
        bend: cython.double = self._old[2, r]
        reach: cython.double
        if first * last >= 0.0 and (bend * first >= 0.0 or bend * self._new[2, r] >= 0.0):
            return False
        reach = 2.0 * max(fabs(first), fabs(last))
        high: cython.bint = max(self._old[0, r], self._new[0, r]) + reach > self.greatest[r]
        return high or min(self._old[0, r], self._new[0, r]) - reach < self.least[r]

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def _go(self) -> cython.int:
        stopped: cython.int
        r: cython.Py_ssize_t
        while True:
            stopped = self.steps.next()
            if stopped != 1:
                return stopped
            if self._integrals:
                self._integrate()
            if self.greatest.shape[0] == 0:
                continue
            self._reach_end()
            for r in range(self.greatest.shape[0]):
                self._extremes(r)

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def _moments(self) -> cython.void:
        """Integrals of x**j cos(omega h x) and x**j sin(omega h x) over the step."""
        i: cython.int
        j: cython.int
        x: cython.double
        angle: cython.double = self.steps.flows.omega * self.steps.h
        real: cython.double
        imag: cython.double
        if self.steps.length == 1.0 and self._slot == self.steps.slot:
            return
        self._slot = self.steps.slot if self.steps.length == 1.0 else -1
        for j in range(_ORDER + 1):
            self._real[j] = self._imag[j] = 0.0
        for i in range(_NODES):
            x = self._nodes[i] * self.steps.length
            real = self._weights[i] * self.steps.length
            imag = real * sin(angle * x)
            real *= cos(angle * x)
            for j in range(_ORDER + 1):
                self._real[j] += real
                self._imag[j] += imag
                real *= x
                imag *= x

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def _integrate(self) -> cython.void:
        i: cython.Py_ssize_t
        j: cython.int
        power: cython.double
        one: cython.double
        real: cython.double
        imag: cython.double
        h: cython.double = self.steps.h
        sine: cython.double = self.steps.y[0, self.steps.flows.linear]
        cosine: cython.double = self.steps.y[0, self.steps.flows.linear + 1]
        terms: cython.double[:, ::1] = self.steps.terms
        self._moments()
        for i in range(self.steps.flows.modes):
            one = real = imag = 0.0
            power = self.steps.length
            for j in range(_ORDER + 1):
                one += terms[j, i] * power / (j + 1)
                real += terms[j, i] * self._real[j]
                imag += terms[j, i] * self._imag[j]
                power *= self.steps.length
            self.mean[i] += h * one
            self.cosine[i] += h * (real * cosine - imag * sine)
            self.sine[i] += h * (real * sine + imag * cosine)

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def _dot(self, r: cython.Py_ssize_t, y: cython.double[:, ::1], k: cython.Py_ssize_t) -> cython.double:
        """Of row r with row k of y."""
        i: cython.Py_ssize_t
        total: cython.double = 0.0
        for i in range(self._first[r], self._first[r + 1]):
            total += self._entry[i] * y[k, self._column[i]]
        return total

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def _reach_end(self) -> cython.void:
        """The state vector at the end of the step, and its first two derivatives by the position."""
        i: cython.Py_ssize_t
        j: cython.int
        x: cython.double = self.steps.length
        terms: cython.double[:, ::1] = self.steps.terms
        for i in range(self.steps.flows.linear):
            self._ends[0, i] = self._ends[1, i] = self._ends[2, i] = 0.0
        for j in range(_ORDER, -1, -1):
            for i in range(self.steps.flows.linear):
                self._ends[2, i] = self._ends[2, i] * x + 2.0 * self._ends[1, i]
                self._ends[1, i] = self._ends[1, i] * x + self._ends[0, i]
                self._ends[0, i] = self._ends[0, i] * x + terms[j, i]

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def _extremes(self, r: cython.Py_ssize_t) -> cython.void:
        first: cython.double = self._dot(r, self.steps.terms, 1)
        last: cython.double = self._dot(r, self._ends, 1)
        bend: cython.double = self._dot(r, self.steps.terms, 2)
        j: cython.int
        turn: cython.double
        self._note(r, 0.0, self._dot(r, self.steps.terms, 0))
        self._note(r, self.steps.length, self._dot(r, self._ends, 0))
        turns: cython.bint = first * last < 0.0
        if not turns and (bend * first >= 0.0 or bend * self._dot(r, self._ends, 2) >= 0.0):
            return  # nor does the velocity dip through zero
        for j in range(_ORDER + 1):
            self._powers[j] = self._dot(r, self.steps.terms, j)
        if turns:
            self._turn(r, 0.0, self.steps.length)
            return
        turn = self._root(2, 0.0, self.steps.length)
        if self._value(1, turn) * first < 0.0:
            self._turn(r, 0.0, turn)
            self._turn(r, turn, self.steps.length)

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def _turn(self, r: cython.Py_ssize_t, low: cython.double, high: cython.double) -> cython.void:
        """Take the value where the velocity changes its sign."""
        x: cython.double = self._root(1, low, high)
        self._note(r, x, self._value(0, x))

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def _note(self, r: cython.Py_ssize_t, x: cython.double, value: cython.double) -> cython.void:
        """Take a value, at x, if it is an extreme so far."""
        if value > self.greatest[r]:
            self.greatest[r] = value
            self.place[r, 0], self.place[r, 1] = self.steps.at, self.steps.first + x
        if value < self.least[r]:
            self.least[r] = value
            self.place[r, 2], self.place[r, 3] = self.steps.at, self.steps.first + x

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def _value(self, order: cython.int, x: cython.double) -> cython.double:
        """The polynomial or one of its derivatives."""
        j: cython.int
        factor: cython.double
        total: cython.double = 0.0
        for j in range(_ORDER, order - 1, -1):
            factor = (
                1.0
                if order == 0
                else j
                if order == 1
                else j * (j - 1)
                if order == 2
                else j * (j - 1) * (j - 2)
            )
            total = total * x + factor * self._powers[j]
        return total

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def _root(self, order: cython.int, low: cython.double, high: cython.double) -> cython.double:
        """The root of a derivative with different signs at low and high: Newton's method between them."""
        sense: cython.double = self._value(order, low)
        x: cython.double = 0.5 * (low + high)
        value: cython.double
        slope: cython.double
        new: cython.double
        for _ in range(60):
            value, slope = self._value(order, x), self._value(order + 1, x)
            if value == 0.0:
                return x
            if value * sense > 0.0:
                low = x
            else:
                high = x
            new = x - value / slope if slope != 0.0 else low
            if not low < new < high:
                new = 0.5 * (low + high)
            if fabs(new - x) <= 1e-15:
                return new
            x = new
        return x


def sample(
    steps: Steps, times: cython.double[::1], out: cython.double[:, ::1], done: cython.Py_ssize_t
) -> int:
    """State vectors at increasing times [s], into the rows of out from `done` on; returns how many there are.

    Fewer than all where a flow is missing; the last step serves later times too.
    """
    with cython.nogil:
        done = _sample(steps, times, out, done)
    return int(done)


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def _sample(
    steps: Steps, times: cython.double[::1], out: cython.double[:, ::1], done: cython.Py_ssize_t
) -> cython.Py_ssize_t:
    stopped: cython.int
    until: cython.double
    x: cython.double
    i: cython.Py_ssize_t
    j: cython.int
    while done < times.shape[0]:
        stopped = steps.next()
        if stopped != 1:
            return done
        last: cython.bint = steps.left <= 1.0
        until = steps.time + steps.h * steps.length
        if last and steps.at + 1 < steps.segments.count:
            until = steps.segments.start[steps.at + 1]
        while done < times.shape[0] and (
            times[done] < until or (last and steps.at + 1 == steps.segments.count)
        ):
            x = (times[done] - steps.time) / steps.h
            for i in range(steps.flows.size):
                out[done, i] = steps.terms[_ORDER, i]
            for j in range(_ORDER - 1, -1, -1):
                for i in range(steps.flows.size):
                    out[done, i] = out[done, i] * x + steps.terms[j, i]
            done += 1
    return done
