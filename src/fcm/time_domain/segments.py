"""The segments of a motion: what happens between two transitions."""

from __future__ import annotations

import cython
import numpy as np
from cython.cimports.libc.math import fabs

from fcm.model.scene import FloatArray

if cython.compiled:
    from cython.cimports.fcm.time_domain.flow_cache import Pool
else:
    from fcm.time_domain.flow_cache import Pool

TINY = cython.declare(cython.double, 1e-300)  # instead of a division by zero where nothing moves


@cython.cclass
class Segments:
    """Arrays over segments, of which the first `count` are there.

    A segment begins at the time `start` [s] with the state vector `y` (d,), lasts for `length` steps of the
    flow of its `states` (contact,), and is `ended` by that exit of it, or (-1) by the end of the motion.
    While it lasts, the exits of each contact are no less than `slack` (contact,).
    """

    def __init__(self, size: int, contacts: int, capacity: int = 16) -> None:
        self.count = 0
        self._numbers = np.empty((capacity, size + contacts + 3))
        self.states = np.empty((capacity, contacts), np.int8)
        self._part(size)

    @cython.cfunc
    def _part(self, size: cython.Py_ssize_t) -> cython.void:
        """Name the columns of the numbers, which are one array so that it is soon made."""
        wide: cython.Py_ssize_t = self._numbers.shape[1]
        self.y, self.slack = self._numbers[:, :size], self._numbers[:, size : wide - 3]
        self.start, self.length = self._numbers[:, wide - 3], self._numbers[:, wide - 2]
        self.ended = self._numbers[:, wide - 1]

    def __len__(self) -> int:
        return self.count

    def largest(self) -> FloatArray:
        """The greatest magnitude of each component at the ends of segments: (d,)."""
        greatest = np.zeros(self.y.shape[1])
        out: cython.double[::1] = greatest
        k: cython.Py_ssize_t
        i: cython.Py_ssize_t
        for k in range(self.count):
            for i in range(self.y.shape[1]):
                out[i] = max(out[i], fabs(self.y[k, i]))
        return greatest

    def scale(
        self,
        per_unit: cython.double[::1],
        flows: Pool,
    ) -> FloatArray:
        """The size of the displacements, velocities and friction forces: (2 modes + contacts,).

        A mode's is the greatest displacement by the one that its shape gives, a contact's the greatest of its
        force and of the smaller of its limit and of the force of that displacement.
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
        """The greatest displacement of any mode, or velocity over the mode's own rate (mode,) [1/s]."""
        m: cython.Py_ssize_t = rates.shape[0]
        y: cython.double[::1] = self.largest()
        length: cython.double = TINY
        i: cython.Py_ssize_t
        for i in range(m):
            length = max(length, max(y[i], y[m + i] / rates[i]))
        return float(length)

    def lasting(self, duration: cython.double, least: cython.double) -> bytes:
        """The states in the segments that last longer than the least [s], of all those of a duration."""
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
        """A lower bound of the exits of contact j over all segments."""
        k: cython.Py_ssize_t
        i: cython.Py_ssize_t = j
        least: cython.double = self.slack[0, i]
        for k in range(1, self.count):
            least = min(least, self.slack[k, i])
        return float(least)

    def seen(self) -> list[int]:
        """For each contact the sum of 2**code of the states that it has been in."""
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
        """These segments without room for more."""
        self._numbers, self.states = self._numbers[: self.count], self.states[: self.count]
        self._part(self.y.shape[1])
        return self

    def room(self, capacity: int) -> Segments:
        """The same segments with room for more."""
        made = Segments(self.y.shape[1], self.states.shape[1], capacity)
        k = made.count = self.count
        np.asarray(made._numbers)[:k], np.asarray(made.states)[:k] = (
            np.asarray(self._numbers)[:k],
            np.asarray(self.states)[:k],
        )
        return made
