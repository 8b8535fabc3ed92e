"""The derivative of the motion by its initial state, and by the frequency or the force level.

Along one flow the derivative by the start is the exponential of the flow's matrix (`VariationalFlow`). Across
a transition whose instant varies with the start or the frequency, it is multiplied by the saltation matrix

    S = R + (F+ - R F-) g / (g F-),    F = A y at the transition,

with g the row that vanishes there, and R the derivative of the change of state at the transition.

The frequency acts only on the forces, whose amplitudes may also depend on it. At a fixed time t

    d sin(h omega t) / d omega = h t cos(h omega t),    d cos(h omega t) / d omega = -h t sin(h omega t)

and the derivative of the columns of the forces is stored with the flow. Of the motion itself only the phases
of the forces are needed. The force level is a factor of sin and cos; its derivative is that by a start at
which only these differ.

`Directional` is the derivative along one direction at many instants. Instants within one step share its
series, as the extremes of many displacements do.
"""

from __future__ import annotations

import cython
import numpy as np
from cython.cimports.libc.math import cos, fabs, sin

from fcm.time_domain.flow import ORDER

if cython.compiled:
    from cython.cimports.fcm.time_domain.flow import (
        FLOW_POWERS,
        SERIES_ORDER,
        STATE_NEGATIVE_SLIP,
        STATE_POSITIVE_SLIP,
        STATE_SEPARATED,
        Flows,
        needed,
    )
    from cython.cimports.fcm.time_domain.segments import Segments
else:
    from fcm.time_domain.flow import (
        FLOW_POWERS,
        SERIES_ORDER,
        STATE_NEGATIVE_SLIP,
        STATE_POSITIVE_SLIP,
        STATE_SEPARATED,
        Flows,
        needed,
    )
    from fcm.time_domain.segments import Segments


@cython.cclass
class VariationalFlow:
    """Derivatives of the state vector along a flow: `follow` moves the rows of `columns`, (unknowns + 2, d).

    Row k < unknowns is the derivative by component k of the start. The next row is that by the frequency, at
    a fixed time, or by the force level. The last row is the state vector, of which only the forces' phases
    are moved. paced: 1 for the derivative by the frequency, 0 for that by the level.
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
        """Moves the derivatives along a flow by a position in steps."""
        whole: cython.longlong = cython.cast(cython.longlong, position)
        x: cython.double = position - whole
        j: cython.int
        while whole >> FLOW_POWERS:
            self._whole(slot, FLOW_POWERS - 1)
            whole -= 1 << (FLOW_POWERS - 1)
        for j in range(FLOW_POWERS):
            if whole >> j & 1:
                self._whole(slot, j)
        self._part(slot, x)
        return 0

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(-1, check=False)
    def _whole(self, slot: cython.Py_ssize_t, j: cython.Py_ssize_t) -> cython.int:
        """Moves the derivatives by 2**j steps."""
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
        self.flows.fill_columns(slot, j)
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
        """Rotates a harmonic's forces by an angle (cosine c, sine s) that takes `time` [s]."""
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
        """Multiplies the first `rows` derivatives by the matrix of a flow."""
        n: cython.Py_ssize_t = self.flows.linear
        k: cython.Py_ssize_t
        done: cython.Py_ssize_t = 0
        if n >= self.flows.dense_size:
            with cython.gil:
                columns, room = np.asarray(self.columns)[:rows, :n], np.asarray(self._room)[:rows]
                np.matmul(columns, matrix, out=room)
                columns[:] = room
            return 0
        if cython.compiled:  # four rows at once, see the .pxd: the numbers are the same either way
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
        """Multiplies derivative k by the matrix of a flow."""
        n: cython.Py_ssize_t = self.flows.linear
        i: cython.Py_ssize_t
        p: cython.Py_ssize_t = 0
        a: cython.double
        b: cython.double
        c: cython.double
        d: cython.double
        for i in range(n):
            self._room[0, i] = 0.0
        while p + 4 <= n:  # four together, to pass through the sums less often
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
        """Moves the derivatives by the initial state over a fraction x of a step.

        It uses the matrix of the fraction or, if that is more work, goes row by row.
        """
        n: cython.Py_ssize_t = self.flows.linear
        i: cython.Py_ssize_t
        j: cython.Py_ssize_t
        size: cython.double
        a: cython.double
        b: cython.double
        c: cython.double
        d: cython.double
        if self.flows.terms.shape[1] == 0 or self.unknowns < self.flows.few_rows:
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
        """Moves all derivatives by a fraction x < 1 of a step."""
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


@cython.cclass
class Derivative(VariationalFlow):
    """Derivative of a motion by its initial x = (q, q', f), and by the frequency or the force level.

    Row k < unknowns of `columns` is the derivative of the state vector by component k of x. The next row is
    that by the frequency, at a fixed time, or by the level. The last row is the state vector itself; `rate`
    is A y there.
    """

    def __init__(self, flows: Flows, unknowns: int = 0) -> None:
        VariationalFlow.__init__(self, flows, unknowns or 2 * flows.modes + flows.contacts)
        self.at, self.position = 0, 0.0
        self.rate, self._rates = np.zeros(flows.size), np.zeros((2, flows.size))

    def begins(self, segments: Segments, by_level: bool = False) -> None:
        """Sets the derivative at the start of the segments; for the level, the forces' angle there is 0."""
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
        """Goes to the start of the first segment, with the friction derivatives of its states."""
        k: cython.Py_ssize_t
        i: cython.Py_ssize_t
        self.at, self.position = 0, 0.0
        for k in range(self.unknowns):
            self._put_friction(self.columns, k, segments, 0, True)
        for i in range(self.flows.size):
            self.columns[self.unknowns + 1, i] = segments.y[0, i]

    def go(self, segments: Segments, last: int, position: float) -> int:
        """Moves the derivative to a position in a segment.

        Returns the segment whose flow is missing, or -1 if it has arrived.
        """
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
        """Fills the derivatives of x at the end of segments that last for a number of periods.

        by_state (unknown, unknown): by x at the start. by_parameter (unknown,): by the frequency, which also
        shortens the periods, or by the level. Returns what `go` returns.
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
        """Moves the derivative to a position in a segment; of the state vector only the forces' phases."""
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
        """Sets the state vector's row to the state at the present position in the segment."""
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
        """Carries the derivative across the transition that ends segment i.

        The state is continuous there; only its rate jumps.
        """
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
            if fabs(speed) > self.flows.grazing * size:
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
        """Sets the friction in row k by the states of segment i: all contacts, or only those that changed."""
        j: cython.Py_ssize_t
        c: cython.Py_ssize_t = self.flows.contacts
        f: cython.Py_ssize_t = 2 * self.flows.modes
        state: cython.int
        for j in range(c):
            state = segments.states[i, j]
            if not every and segments.states[i - 1, j] == state:
                continue
            if state == STATE_POSITIVE_SLIP:
                z[k, f + j] = self.flows.mu[j] * z[k, f + c + j]
            elif state == STATE_NEGATIVE_SLIP:
                z[k, f + j] = -self.flows.mu[j] * z[k, f + c + j]
            elif state == STATE_SEPARATED:
                z[k, f + j] = 0.0


@cython.cclass
class Directional(Derivative):
    """Derivative along one direction of x = (q, q', f), while the frequency changes by `pace`.

    It is the first row of `columns`. `done` is the number of instants evaluated.
    """

    def __init__(self, flows: Flows) -> None:
        Derivative.__init__(self, flows, 1)
        self._series, self._angle = np.zeros((ORDER + 1, flows.size)), np.zeros((ORDER + 1, flows.size))
        self.pace, self.done = 0.0, 0

    def begins_along(self, segments: Segments, direction: cython.double[::1], pace: float) -> None:
        """Sets the derivative along a direction (unknown,) at the start of the segments."""
        j: cython.Py_ssize_t
        i: cython.Py_ssize_t
        m: cython.Py_ssize_t = self.flows.modes
        n: cython.Py_ssize_t = 2 * m + self.flows.contacts
        self.columns[:] = 0.0
        for i in range(n):
            self.columns[0, i] = direction[i]
        for j in range(self.flows.contacts):
            for i in range(m):
                self.columns[0, n + j] += self.flows.k_v[j] * self.flows.normal[j, i] * direction[i]
        self._stand(segments)
        self.pace, self.done = pace, 0

    def at_places(self, segments: Segments, places: cython.double[:, ::1], out: cython.double[:, ::1]) -> int:
        """Fills rows of out with the change of q at ordered places (segment, position).

        Returns the segment whose flow is missing, or -1 if all are filled.
        """
        missing: cython.Py_ssize_t
        with cython.nogil:
            missing = self._at_places(segments, places, out)
        return int(missing)

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(-2, check=False)
    def _at_places(
        self, segments: Segments, places: cython.double[:, ::1], out: cython.double[:, ::1]
    ) -> cython.Py_ssize_t:
        segment: cython.Py_ssize_t
        missing: cython.Py_ssize_t
        base: cython.double
        while self.done < places.shape[0]:
            segment = cython.cast(cython.Py_ssize_t, places[self.done, 0])
            base = cython.cast(cython.double, cython.cast(cython.longlong, places[self.done, 1]))
            missing = self._reach(segments, segment, base)
            if missing >= 0:
                return missing
            self._expand(self.flows.find(segments.states, segment))
            while self.done < places.shape[0] and places[self.done, 0] == segment:
                if places[self.done, 1] - base > 1.0:
                    break
                self._sum(places[self.done, 1] - base, out)
                self.done += 1
        return -1

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def _expand(self, slot: cython.Py_ssize_t) -> cython.void:
        """Expands the change as a series in the step that begins here."""
        n: cython.Py_ssize_t = self.flows.linear
        h: cython.Py_ssize_t
        i: cython.Py_ssize_t
        j: cython.int
        angle: cython.double
        for i in range(self.flows.size):
            self._series[0, i] = self.columns[0, i] + self.pace * self.columns[1, i]
        for h in range(self.flows.waves):
            i, angle = n + 2 * h, self.flows.harmonic[h] * self.flows.step[slot] * self.flows.omega
            self._angle[0, i], self._angle[0, i + 1] = (
                self.pace * self.columns[2, i],
                self.pace * self.columns[2, i + 1],
            )
            for j in range(SERIES_ORDER):
                self._angle[j + 1, i], self._angle[j + 1, i + 1] = (
                    angle / (j + 1) * self._angle[j, i + 1],
                    -angle / (j + 1) * self._angle[j, i],
                )
        self.flows.extend(slot, self._series, SERIES_ORDER, self.flows.step[slot], self._angle, True)

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def _sum(self, x: cython.double, out: cython.double[:, ::1]) -> cython.void:
        """Computes the change of the displacements at a fraction x of the step."""
        i: cython.Py_ssize_t
        j: cython.int
        k: cython.Py_ssize_t = self.done
        for i in range(self.flows.modes):
            out[k, i] = self._series[SERIES_ORDER, i]
        for j in range(SERIES_ORDER - 1, -1, -1):
            for i in range(self.flows.modes):
                out[k, i] = out[k, i] * x + self._series[j, i]
