"""The derivative of the motion by its start, and by the frequency or the level of the forces.

Along a flow it is moved as in `along`. Across a transition whose instant moves with the start or with the
frequency it is the saltation matrix

    S = R + (F+ - R F-) g / (g F-),    F = A y at the transition,

with g the row that vanishes there and R the derivative of what the transition does to the state.
"""

from __future__ import annotations

import cython
import numpy as np
from cython.cimports.libc.math import fabs

if cython.compiled:
    from cython.cimports.fcm.time_domain.flow import Flows
    from cython.cimports.fcm.time_domain.flow_derivative import Along
    from cython.cimports.fcm.time_domain.segments import Segments
else:
    from fcm.time_domain.flow import Flows
    from fcm.time_domain.flow_derivative import Along
    from fcm.time_domain.segments import Segments

# an exit passed this slowly, relative to its terms, is touched
GRAZING = cython.declare(cython.double, 1e-12)
_SEPARATED = cython.declare(cython.int, 0)
_POSITIVE_SLIP = cython.declare(cython.int, 2)
_NEGATIVE_SLIP = cython.declare(cython.int, 3)


@cython.cclass
class Derivative(Along):
    """Of a motion by x = (q, q', f) at its start, and by the frequency or by the level of the forces.

    Row k < unknowns of `columns` is the derivative of the state vector by the component k of x; the row after
    them that by the frequency, at a fixed time, or by the level; the last row is the state vector itself;
    `rate` is A y there.
    """

    def __init__(self, flows: Flows, unknowns: int = 0) -> None:
        Along.__init__(self, flows, unknowns or 2 * flows.modes + flows.contacts)
        self.at, self.position = 0, 0.0
        self.rate, self._rates = np.zeros(flows.size), np.zeros((2, flows.size))

    def begins(self, segments: Segments, by_level: bool = False) -> None:
        """Put the derivative at the start of the segments, at the forces' angle 0 if it is by the level."""
        k: cython.Py_ssize_t
        j: cython.Py_ssize_t
        i: cython.Py_ssize_t
        m: cython.Py_ssize_t = self.flows.modes
        n: cython.Py_ssize_t = 2 * m + self.flows.contacts
        for k in range(self.unknowns + 1):
            for i in range(self.flows.size):
                self.columns[k, i] = 1.0 if i == k and k < self.unknowns else 0.0
        for k in range(m):
            for j in range(self.flows.contacts):
                self.columns[k, n + j] = self.flows.k_v[j] * self.flows.normal[j, k]
        self.paced = 0.0 if by_level else 1.0
        for k in range(self.flows.waves):
            self.columns[self.unknowns, self.flows.linear + 2 * k + 1] = 1.0 - self.paced
        self._stand(segments)

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def _stand(self, segments: Segments) -> cython.void:
        """At the start of the first segment, with the friction that its states want."""
        k: cython.Py_ssize_t
        i: cython.Py_ssize_t
        self.at, self.position = 0, 0.0
        for k in range(self.unknowns):
            self._put_friction(self.columns, k, segments, 0, True)
        for i in range(self.flows.size):
            self.columns[self.unknowns + 1, i] = segments.y[0, i]

    def go(self, segments: Segments, last: int, position: float) -> int:
        """On to a position in a segment; the segment whose flow is missing, or -1 when it is there."""
        segment: cython.Py_ssize_t = last
        end: cython.double = position
        missing: cython.Py_ssize_t
        with cython.nogil:
            missing = self._go(segments, segment, end)
        return int(missing)

    def closes(
        self,
        segments: Segments,
        duration: float,
        by_state: cython.double[:, ::1],
        by_parameter: cython.double[::1],
    ) -> int:
        """Fill the derivatives of x at the end of segments that last for periods; frequency shortens them.

        By x at their start, (unknown, unknown), and by the frequency or the level (unknown,); returns what
        `go` does.
        """
        i: cython.Py_ssize_t
        k: cython.Py_ssize_t
        last: cython.Py_ssize_t = segments.count - 1
        end: cython.double = segments.length[last]
        shorter: cython.double = self.paced * duration / self.flows.omega
        missing: cython.Py_ssize_t
        with cython.nogil:
            missing = self._go(segments, last, end)
            if missing < 0:
                for i in range(self.unknowns):
                    for k in range(self.unknowns):
                        by_state[i, k] = self.columns[k, i]
                    by_parameter[i] = self.columns[self.unknowns, i] - shorter * self.rate[i]
        return int(missing)

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(-2, check=False)
    def _go(self, segments: Segments, last: cython.Py_ssize_t, position: cython.double) -> cython.Py_ssize_t:
        slot: cython.Py_ssize_t
        i: cython.Py_ssize_t
        missing: cython.Py_ssize_t = self._reach(segments, last, position)
        if missing >= 0:
            return missing
        slot = self.flows.find(segments.states, last)
        self._arrive(segments, slot)
        self.flows.derive(slot, self.columns, self.unknowns + 1, self._rates, 0)
        for i in range(self.flows.size):
            self.rate[i] = self._rates[0, i]
        return -1

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(-2, check=False)
    def _reach(
        self, segments: Segments, last: cython.Py_ssize_t, position: cython.double
    ) -> cython.Py_ssize_t:
        """On to a position in a segment, of the state vector only the forces' angle."""
        slot: cython.Py_ssize_t
        new: cython.Py_ssize_t
        while True:
            slot = self.flows.find(segments.states, self.at)
            if slot < 0:
                return self.at
            self.flows.refresh(slot)
            if self.at == last:
                self.follow(slot, position - self.position)
                self.position = position
                return -1
            new = self.flows.find(segments.states, self.at + 1)
            if new < 0:
                return self.at + 1
            self.follow(slot, segments.length[self.at] - self.position)
            self._across(segments, self.at, slot, new)
            self.at += 1
            self.position = 0.0

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(-1, check=False)
    def _arrive(self, segments: Segments, slot: cython.Py_ssize_t) -> cython.int:
        """Put the state vector at the position in the segment into its row."""
        i: cython.Py_ssize_t
        u: cython.Py_ssize_t = self.unknowns
        for i in range(self.flows.size):
            self.columns[u + 1, i] = segments.y[self.at, i]
        self.flows.carry(slot, self.position, self.columns, u + 1)
        return 0

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def _across(
        self, segments: Segments, i: cython.Py_ssize_t, old: cython.Py_ssize_t, new: cython.Py_ssize_t
    ) -> cython.void:
        """Across the transition that ends segment i: the state is continuous, only its rate jumps."""
        n: cython.Py_ssize_t = self.flows.linear
        u: cython.Py_ssize_t = self.unknowns
        k: cython.Py_ssize_t
        p: cython.Py_ssize_t
        e: cython.Py_ssize_t = cython.cast(cython.Py_ssize_t, segments.ended[i])
        speed: cython.double = 0.0
        size: cython.double = 0.0
        moved: cython.double
        for p in range(self.flows.size):
            self.columns[u + 1, p] = segments.y[i + 1, p]
        self.flows.derive(old, self.columns, u + 1, self._rates, 0)
        self.flows.derive(new, self.columns, u + 1, self._rates, 1)
        for p in range(n):
            speed += self.flows.row[old, e, p] * self._rates[0, p]
            size += fabs(self.flows.row[old, e, p]) * fabs(self._rates[0, p])
        self._put_friction(self._rates, 0, segments, i + 1, False)
        for p in range(n):
            self._rates[1, p] -= self._rates[0, p]
        for k in range(u + 1):
            moved = 0.0
            if fabs(speed) > GRAZING * size:
                for p in range(n):
                    moved += self.flows.row[old, e, p] * self.columns[k, p]
                moved /= speed
            self._put_friction(self.columns, k, segments, i + 1, False)
            for p in range(n):
                self.columns[k, p] += self._rates[1, p] * moved

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def _put_friction(
        self,
        z: cython.double[:, ::1],
        k: cython.Py_ssize_t,
        segments: Segments,
        i: cython.Py_ssize_t,
        every: cython.bint,
    ) -> cython.void:
        """Put the friction in row k where segment i wants it, of all contacts or of those that changed."""
        j: cython.Py_ssize_t
        c: cython.Py_ssize_t = self.flows.contacts
        f: cython.Py_ssize_t = 2 * self.flows.modes
        state: cython.int
        for j in range(c):
            state = segments.states[i, j]
            if not every and segments.states[i - 1, j] == state:
                continue
            if state == _POSITIVE_SLIP:
                z[k, f + j] = self.flows.mu[j] * z[k, f + c + j]
            elif state == _NEGATIVE_SLIP:
                z[k, f + j] = -self.flows.mu[j] * z[k, f + c + j]
            elif state == _SEPARATED:
                z[k, f + j] = 0.0
