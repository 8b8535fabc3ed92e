"""Through the segments of a motion, one after the other."""

from __future__ import annotations

import cython

if cython.compiled:
    from cython.cimports.fcm.motion.flow import Flows
    from cython.cimports.fcm.motion.segments import Segments
else:
    from fcm.motion.flow import Flows
    from fcm.motion.segments import Segments


@cython.cclass
class Walk:
    """`visit` is what is done along each segment that lasts; `at` is the one where it is."""

    def __init__(self, flows: Flows) -> None:
        self.flows, self.segments, self.at = flows, Segments(flows.size, flows.contacts, 0), -1

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
    @cython.exceptval(check=False)
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

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def visit(self, slot: cython.Py_ssize_t) -> cython.void:
        """Along the segment `at`, whose flow is in that place of the pool."""
