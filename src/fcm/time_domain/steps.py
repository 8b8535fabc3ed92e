"""A motion step by step, each as a polynomial."""

from __future__ import annotations

import cython
import numpy as np

from fcm.time_domain.flow_cache import ORDER

if cython.compiled:
    from cython.cimports.fcm.time_domain.flow import Flows
    from cython.cimports.fcm.time_domain.polynomial import summed
    from cython.cimports.fcm.time_domain.segments import Segments
else:
    from fcm.time_domain.flow import Flows
    from fcm.time_domain.polynomial import summed
    from fcm.time_domain.segments import Segments

MISSING = -1


@cython.cclass
class Steps:
    """The steps of segments: from `time` [s] on, y is the sum of terms[j] x**j, x to `length` of `h` [s]."""

    def __init__(self, flows: Flows, segments: Segments) -> None:
        self.flows, self.segments = flows, segments
        self.y, self.terms = np.zeros((1, flows.size)), np.zeros((ORDER + 1, flows.size))
        self.at, self.slot, self.left, self.length = -1, -1, 0.0, 0.0
        self.time, self.h = 0.0, 1.0

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(-2, check=False)
    def next(self) -> cython.int:
        """Go to the next step: 1 if there is one, 0 at the end, -1 if segment at + 1 has no flow yet."""
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
