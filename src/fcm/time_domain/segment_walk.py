"""Through the segments of a motion, one after the other."""

from __future__ import annotations

import cython
import numpy as np

from fcm.time_domain.flow_cache import SMALL

if cython.compiled:
    from cython.cimports.fcm.time_domain.flow import Flows
    from cython.cimports.fcm.time_domain.segments import Segments
else:
    from fcm.time_domain.flow import Flows
    from fcm.time_domain.segments import Segments


DENSE = 32  # components from which many steps are sooner made at once, by BLAS
DOUBLINGS = 7  # of the steps that are made at once
SPAN = 2**DOUBLINGS


@cython.cclass
class Walk:
    """`visit` is what is done along each segment that lasts; `at` is the one where it is.

    Of a large system `ahead` are the state vectors on a `span` of so many steps; else that is 0.
    """

    def __init__(self, flows: Flows) -> None:
        self.flows, self.segments, self.at = flows, Segments(flows.size, flows.contacts, 0), -1
        self.span = SPAN if DENSE <= flows.linear <= SMALL else 0
        self.ahead = np.zeros((self.span + 1, flows.size))

    def begins(self, segments: Segments) -> None:
        """Stand before the first segment."""
        self.segments, self.at = segments, -1

    def go(self) -> int:
        """Go through all segments: 0 when done, -1 where the flow of the next one is missing."""
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

    def reach(self, slot: cython.Py_ssize_t) -> None:
        """Fill the rows of `ahead` after the first, each time as many as there are."""
        self.flows.reach(slot, DOUBLINGS)
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
        """Along the segment `at`, whose flow is in that place of the pool."""
        return 0
