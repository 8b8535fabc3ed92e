"""The derivative of a motion along one direction, at many instants of it.

Instants within one step share its series, as those of the extremes of many displacements do.
"""

from __future__ import annotations

import cython
import numpy as np

from fcm.time_domain.flow_cache import ORDER

if cython.compiled:
    from cython.cimports.fcm.time_domain.flow import Flows
    from cython.cimports.fcm.time_domain.segments import Segments
    from cython.cimports.fcm.time_domain.variational import Derivative
else:
    from fcm.time_domain.flow import Flows
    from fcm.time_domain.segments import Segments
    from fcm.time_domain.variational import Derivative

_ORDER = cython.declare(cython.int, 19)


@cython.cclass
class Directional(Derivative):
    """Along a direction of x = (q, q', f), the first row of `columns`, while the frequency changes by `pace`.

    `done` is how many instants have been come to.
    """

    def __init__(self, flows: Flows) -> None:
        Derivative.__init__(self, flows, 1)
        self._series, self._angle = np.zeros((ORDER + 1, flows.size)), np.zeros((ORDER + 1, flows.size))
        self.pace, self.done = 0.0, 0

    def begins_along(self, segments: Segments, direction: cython.double[::1], pace: float) -> None:
        """Put the derivative along a direction (unknown,) at the start of the segments."""
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
        """Fill rows of out with the change of q at places (segment, position), which are in their order.

        The segment whose flow is missing, or -1 when all are filled.
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
        """The series of the change in the step that begins here."""
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
            for j in range(_ORDER):
                self._angle[j + 1, i], self._angle[j + 1, i + 1] = (
                    angle / (j + 1) * self._angle[j, i + 1],
                    -angle / (j + 1) * self._angle[j, i],
                )
        self.flows.extend(slot, self._series, _ORDER, self.flows.step[slot], self._angle, True)

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def _sum(self, x: cython.double, out: cython.double[:, ::1]) -> cython.void:
        """The change of the displacements a part x of the step further."""
        i: cython.Py_ssize_t
        j: cython.int
        k: cython.Py_ssize_t = self.done
        for i in range(self.flows.modes):
            out[k, i] = self._series[_ORDER, i]
        for j in range(_ORDER - 1, -1, -1):
            for i in range(self.flows.modes):
                out[k, i] = out[k, i] * x + self._series[j, i]
