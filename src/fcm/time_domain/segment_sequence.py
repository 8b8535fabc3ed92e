"""The sequence of states of a motion in time, from the segments between its transitions."""

from __future__ import annotations

import cython
from cython.cimports.libc.math import fabs

from fcm.model.scene import FloatArray

if cython.compiled:
    from cython.cimports.fcm.contact.periodic.cycle import NEGATIVE, POSITIVE, SEPARATION, STICK, TWO_PI
    from cython.cimports.fcm.stability.state_sequence import FREE, StateSequence
    from cython.cimports.fcm.time_domain.segments import Segments
else:
    from fcm.contact.periodic.cycle import NEGATIVE, POSITIVE, SEPARATION, STICK, TWO_PI
    from fcm.stability.state_sequence import FREE, StateSequence
    from fcm.time_domain.segments import Segments

_SEPARATED = cython.declare(cython.int, 0)
_STICKING = cython.declare(cython.int, 1)
_POSITIVE_SLIP = cython.declare(cython.int, 2)


@cython.cclass
class SegmentSequence(StateSequence):
    """`take` segments of a motion that repeats after them; angles are counted from their start to 2 pi.

    The contacts that are held follow those that are computed, and never change their state.

    Parameters
    ----------
    law : (contact, 4)
        mu, k_u, k_v, n_0 of the computed contacts and of those that are held.
    held : int
        How many are.
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
        """Segments that last for a duration [s]."""
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
        """Of a contact in a segment, as a `StateSequence` has it."""
        state: cython.int = segments.states[k, c]
        if state == _SEPARATED:
            return SEPARATION
        if state == _STICKING:
            return STICK if self.law[c, 0] > 0.0 and self.law[c, 1] > 0.0 else FREE
        return POSITIVE if state == _POSITIVE_SLIP else NEGATIVE

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
        """A contact's state in segment k is not that of the segment before.

        `along` as of a `StateSequence`: at the end of a slip the place is a limit's. At a closing w = u where
        the load vanishes, and that moves by -dn / n'.
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
        """Of a contact along its shape, where segment k begins."""
        i: cython.Py_ssize_t
        m: cython.Py_ssize_t = shape.shape[1]
        total: cython.double = 0.0
        for i in range(m):
            total += shape[c, i] * segments.y[k, m + i]
        return total
