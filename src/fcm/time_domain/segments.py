"""The segments of a motion, each between two transitions.

`Walk` goes through them one by one; `Steps` goes step by step, each step as a polynomial; `sample` evaluates
the motion at given instants. `SegmentSequence` is their sequence of contact states.
"""

from __future__ import annotations

import cython
import numpy as np
from cython.cimports.libc.math import fabs

from fcm.model.scene import FloatArray
from fcm.time_domain.flow import ORDER

if cython.compiled:
    from cython.cimports.fcm.contact.periodic.cycle import NEGATIVE, POSITIVE, SEPARATION, STICK
    from cython.cimports.fcm.contact.periodic.motion import TWO_PI
    from cython.cimports.fcm.stability.state_sequence import FREE, StateSequence
    from cython.cimports.fcm.time_domain.flow import (
        SERIES_ORDER,
        STATE_POSITIVE_SLIP,
        STATE_SEPARATED,
        STATE_STICKING,
        FlowArrays,
        Flows,
        summed,
    )
else:
    from fcm.contact.periodic.cycle import NEGATIVE, POSITIVE, SEPARATION, STICK
    from fcm.contact.periodic.motion import TWO_PI
    from fcm.stability.state_sequence import FREE, StateSequence
    from fcm.time_domain.flow import (
        SERIES_ORDER,
        STATE_POSITIVE_SLIP,
        STATE_SEPARATED,
        STATE_STICKING,
        FlowArrays,
        Flows,
        summed,
    )


TINY = cython.declare(cython.double, 1e-300)  # instead of zero sizes where nothing moves


DOUBLINGS = 7  # 2**DOUBLINGS steps are computed at once
SPAN = 2**DOUBLINGS


@cython.cclass
class Segments:
    """Arrays over segments, of which the first `count` are used.

    A segment begins at the time `start` [s] with the state vector `y` (d,). Its length is `length` steps of
    the flow of its `states` (contact,). `ended` is the exit that ends it, -1 at the end of the motion. During
    the segment the exits of each contact are at least `slack` (contact,).
    """

    def __init__(self, size: int, contacts: int, capacity: int = 16) -> None:
        self.count = 0
        self._numbers = np.empty((capacity, size + contacts + 3))
        self.states = np.empty((capacity, contacts), np.int8)
        self._part(size)

    @cython.cfunc
    def _part(self, size: cython.Py_ssize_t) -> cython.void:
        """Assigns the columns of the array of numbers; a single array is quick to allocate."""
        wide: cython.Py_ssize_t = self._numbers.shape[1]
        self.y, self.slack = self._numbers[:, :size], self._numbers[:, size : wide - 3]
        self.start, self.length = self._numbers[:, wide - 3], self._numbers[:, wide - 2]
        self.ended = self._numbers[:, wide - 1]

    def __len__(self) -> int:
        return self.count

    def largest(self) -> FloatArray:
        """Greatest magnitude of each state component over the starts of segments: (d,)."""
        greatest = np.zeros(self.y.shape[1])
        out: cython.double[::1] = greatest
        k: cython.Py_ssize_t
        i: cython.Py_ssize_t
        for k in range(self.count):
            for i in range(self.y.shape[1]):
                out[i] = max(out[i], fabs(self.y[k, i]))
        return greatest

    def scale(self, per_unit: cython.double[::1], flows: FlowArrays) -> FloatArray:
        """Sizes of the displacements, velocities and friction forces: (2 modes + contacts,).

        For a mode: the greatest displacement of all modes over the displacement by one unit of it. For a
        contact: the greatest friction force, or if it is greater, the lesser of the slip limit and k_u times
        that displacement.
        """
        m: cython.Py_ssize_t = flows.modes
        c: cython.Py_ssize_t = flows.contacts
        omega: cython.double = flows.omega
        y: cython.double[::1] = self.largest()
        whole = np.empty(2 * m + c)
        out: cython.double[::1] = whole
        length: cython.double = TINY
        limit: cython.double
        i: cython.Py_ssize_t
        for i in range(m):
            length = max(length, per_unit[i] * max(y[i], y[m + i] / omega))
        for i in range(m):
            out[i] = length / per_unit[i]
            out[m + i] = out[i] * omega
        for i in range(c):
            limit = flows.mu[i] * (fabs(flows.n_0[i]) + y[2 * m + c + i])
            out[2 * m + i] = max(max(y[2 * m + i], min(limit, flows.k_u[i] * length)), TINY)
        return whole

    def length_by(self, rates: cython.double[::1]) -> float:
        """Greatest displacement of any mode, or velocity over the mode's own rate (mode,) [1/s]."""
        m: cython.Py_ssize_t = rates.shape[0]
        y: cython.double[::1] = self.largest()
        length: cython.double = TINY
        i: cython.Py_ssize_t
        for i in range(m):
            length = max(length, max(y[i], y[m + i] / rates[i]))
        return float(length)

    def lasting(self, duration: cython.double, least: cython.double) -> bytes:
        """State codes of all segments that last longer than `least` [s], for a motion of a given duration."""
        codes = []
        k: cython.Py_ssize_t
        j: cython.Py_ssize_t
        end: cython.double
        for k in range(self.count):
            end = self.start[k + 1] if k + 1 < self.count else duration
            if end - self.start[k] > least:
                for j in range(self.states.shape[1]):
                    codes.append(int(self.states[k, j]))
        return bytes(codes)

    def held(self, j: int) -> float:
        """Lower bound of the exits of contact j over all segments."""
        k: cython.Py_ssize_t
        i: cython.Py_ssize_t = j
        least: cython.double = self.slack[0, i]
        for k in range(1, self.count):
            least = min(least, self.slack[k, i])
        return float(least)

    def seen(self) -> list[int]:
        """States in which each contact has been, as the sum of 2**code."""
        found: list[int] = []
        seen: cython.int
        k: cython.Py_ssize_t
        j: cython.Py_ssize_t
        for j in range(self.states.shape[1]):
            seen = 0
            for k in range(self.count):
                seen |= 1 << self.states[k, j]
            found.append(seen)
        return found

    def trim(self) -> Segments:
        """Removes unused capacity, and returns the segments."""
        self._numbers, self.states = self._numbers[: self.count], self.states[: self.count]
        self._part(self.y.shape[1])
        return self

    def room(self, capacity: int) -> Segments:
        """A copy of the segments with another capacity."""
        made = Segments(self.y.shape[1], self.states.shape[1], capacity)
        k = made.count = self.count
        np.asarray(made._numbers)[:k], np.asarray(made.states)[:k] = (
            np.asarray(self._numbers)[:k],
            np.asarray(self.states)[:k],
        )
        return made


@cython.cclass
class Walk:
    """Base class of kernels that go through segments: `visit` is called for each; `at` is its number.

    For a large system `ahead` holds the state vectors on `span` steps; otherwise span is 0.
    """

    def __init__(self, flows: Flows) -> None:
        self.flows, self.segments, self.at = flows, Segments(flows.size, flows.contacts, 0), -1
        self.span = SPAN if flows.dense_size <= flows.linear <= flows.taylor_size else 0
        self.ahead = np.zeros((self.span + 1, flows.size))

    def begins(self, segments: Segments) -> None:
        """Prepares for the segments."""
        self.segments, self.at = segments, -1

    def go(self) -> int:
        """Goes through all segments: 0 when done, -1 if the flow of the next segment is missing."""
        stopped: cython.int
        with cython.nogil:
            stopped = self._go()
        return int(stopped)

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(-2, check=False)
    def _go(self) -> cython.int:
        slot: cython.Py_ssize_t
        while self.at + 1 < self.segments.count:
            if self.segments.length[self.at + 1] > 0.0:
                slot = self.flows.find(self.segments.states, self.at + 1)
                if slot < 0:
                    return -1
                self.flows.refresh(slot)
                self.at += 1
                self.visit(slot)
            else:
                self.at += 1
        return 0

    def fill_ahead(self, slot: cython.Py_ssize_t) -> None:
        """Fills the rows of `ahead` from the first, doubling the number of steps each time."""
        self.flows.fill_columns(slot, DOUBLINGS)
        n, y = self.flows.linear, np.asarray(self.ahead)
        powers, waves = np.asarray(self.flows.power)[slot], self.flows.waves
        forced = (
            np.asarray(self.flows.forced)[slot].reshape(-1, waves, 4, n)[:, :, :2].reshape(-1, 2 * waves, n)
        )
        for j in range(DOUBLINGS + 1):
            k = 1 << j
            last = min(2 * k, SPAN + 1)
            old, new = y[: last - k], y[k:last]
            new[:, :n] = old[:, :n] @ powers[j] + old[:, n:] @ forced[j]
            for b in range(0, 2 * waves, 2):
                c, s = np.asarray(self.flows.rotation)[slot, j, b : b + 2]
                new[:, n + b : n + b + 2] = old[:, n + b : n + b + 2] @ np.array([[c, -s], [s, c]])

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(-1, check=False)
    def visit(self, slot: cython.Py_ssize_t) -> cython.int:
        """Hook called for the segment `at`, whose flow is at `slot` of the pool."""
        return 0


MISSING = -1


@cython.cclass
class Steps:
    """The steps of segments: from `time` [s] on, y is the sum of terms[j] x**j.

    x runs from 0 to `length`, in units of `h` [s].
    """

    def __init__(self, flows: Flows, segments: Segments) -> None:
        self.flows, self.segments = flows, segments
        self.y, self.terms = np.zeros((1, flows.size)), np.zeros((ORDER + 1, flows.size))
        self.at, self.slot, self.left, self.length = -1, -1, 0.0, 0.0
        self.time, self.h = 0.0, 1.0

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(-2, check=False)
    def next(self) -> cython.int:
        """Goes to the next step: 1 if there is one, 0 at the end, -1 if segment at + 1 has no flow yet."""
        i: cython.Py_ssize_t
        slot: cython.Py_ssize_t
        self.left -= self.length
        if self.left > 0.0:
            summed(self.terms, self.length, self.y, 0)
            self.time += self.h
        else:
            while self.at + 1 < self.segments.count and self.segments.length[self.at + 1] <= 0.0:
                self.at += 1
            if self.at + 1 >= self.segments.count:
                self.left = self.length = 0.0
                return 0
            slot = self.flows.find(self.segments.states, self.at + 1)
            if slot < 0:
                self.left = self.length = 0.0
                return -1
            self.flows.refresh(slot)
            self.at += 1
            self.slot, self.h = slot, self.flows.step[slot]
            self.left, self.time = self.segments.length[self.at], self.segments.start[self.at]
            for i in range(self.flows.size):
                self.y[0, i] = self.segments.y[self.at, i]
        self.length = min(self.left, 1.0)
        self.flows.taylor(self.slot, self.y, 0, self.terms)
        return 1


def sample(
    steps: Steps, times: cython.double[::1], out: cython.double[:, ::1], done: cython.Py_ssize_t
) -> int:
    """Fills `out` from row `done` on with state vectors at increasing times [s].

    Returns the number of rows filled, which is less than all if a flow is missing. The last step also serves
    later times.
    """
    with cython.nogil:
        done = _sample(steps, times, out, done)
    return int(done)


@cython.cfunc
@cython.nogil
@cython.exceptval(-1, check=False)
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
                out[done, i] = steps.terms[SERIES_ORDER, i]
            for j in range(SERIES_ORDER - 1, -1, -1):
                for i in range(steps.flows.size):
                    out[done, i] = out[done, i] * x + steps.terms[j, i]
            done += 1
    return done


@cython.cclass
class SegmentSequence(StateSequence):
    """State sequence of a periodic motion, from its segments; angles run from their start to 2 pi.

    The held contacts come after the computed ones, and never change state.

    Parameters
    ----------
    law : (contact, 4)
        mu, k_u, k_v, n_0 of the computed contacts, then of the held ones.
    held : int
        Number of held contacts.
    tangential, normal : (contact, mode)
        Shapes of the displacements u and v of the computed contacts.
    """

    def __init__(self, law: FloatArray, held: int, tangential: FloatArray, normal: FloatArray) -> None:
        StateSequence.__init__(self, len(law), 16)
        self.law, self.computed = law, len(law) - held
        self.tangential, self.normal = tangential, normal
        c: cython.int
        for c in range(self.computed, self.contacts):
            self.state[c] = STICK if law[c, 0] > 0.0 and law[c, 1] > 0.0 else FREE

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def take(self, segments: Segments, duration: cython.double) -> cython.int:
        """Takes the segments of a motion with a duration [s]."""
        k: cython.Py_ssize_t
        c: cython.int
        last: cython.Py_ssize_t = segments.count - 1
        most: cython.Py_ssize_t = segments.count * self.computed
        if self.angle.shape[0] < most:
            self.allocate(2 * most)
        self.events = 0
        for c in range(self.computed):
            self.state[c], self.remembers[c] = self._state(segments, 0, c), 0
        for k in range(1, segments.count):
            for c in range(self.computed):
                if segments.states[k, c] != segments.states[k - 1, c]:
                    self._change(segments, k, k - 1, c, TWO_PI * segments.start[k] / duration)
        for c in range(self.computed):
            if segments.states[0, c] != segments.states[last, c]:
                self._change(segments, 0, last, c, 0.0)
        self.sort()
        self.begin()
        return 0

    @cython.cfunc
    @cython.exceptval(check=False)
    def _state(self, segments: Segments, k: cython.Py_ssize_t, c: cython.int) -> cython.int:
        """State of contact c in segment k, in the codes of a `StateSequence`."""
        state: cython.int = segments.states[k, c]
        if state == STATE_SEPARATED:
            return SEPARATION
        if state == STATE_STICKING:
            return STICK if self.law[c, 0] > 0.0 and self.law[c, 1] > 0.0 else FREE
        return POSITIVE if state == STATE_POSITIVE_SLIP else NEGATIVE

    @cython.cfunc
    @cython.exceptval(check=False)
    def _change(
        self,
        segments: Segments,
        k: cython.Py_ssize_t,
        before: cython.Py_ssize_t,
        c: cython.int,
        angle: cython.double,
    ) -> cython.void:
        """Adds the change of a contact's state at the start of segment k.

        `along` is that of a `StateSequence`: at the end of a slip the place follows a limit. At a closing w =
        u where the load vanishes, and that instant moves by -dn / n'.
        """
        into: cython.int = self._state(segments, k, c)
        was: cython.int = self._state(segments, before, c)
        along: cython.double = 0.0
        if into == STICK and was != SEPARATION:
            along = -1.0 if was == POSITIVE else 1.0
        elif into == STICK:
            u: cython.double = self.law[c, 1] * self._velocity(self.tangential, segments, k, c)
            limit: cython.double = (
                self.law[c, 0] * self.law[c, 2] * self._velocity(self.normal, segments, k, c)
            )
            along = -u / limit if fabs(u) < limit else -1.0 if u > 0.0 else 1.0
        self.add_event(angle, c, into, along)

    @cython.cfunc
    @cython.exceptval(check=False)
    def _velocity(
        self, shape: cython.double[:, ::1], segments: Segments, k: cython.Py_ssize_t, c: cython.int
    ) -> cython.double:
        """Velocity of a contact along its shape, at the start of segment k."""
        i: cython.Py_ssize_t
        m: cython.Py_ssize_t = shape.shape[1]
        total: cython.double = 0.0
        for i in range(m):
            total += shape[c, i] * segments.y[k, m + i]
        return total
