"""The states of the contacts over a period of a motion: which contact changes its state when, and into which.

All that the small disturbances of a motion depend on, be the motion balanced or exact.
"""

from __future__ import annotations

import cython
import numpy as np

if cython.compiled:
    from cython.cimports.fcm.contact.periodic.cycle import TWO_PI
    from cython.cimports.fcm.contact.periodic.slider import STICK
else:
    from fcm.contact.periodic.cycle import TWO_PI
    from fcm.contact.periodic.slider import STICK

FREE = cython.declare(cython.int, 3)  # closed without friction, a state beside those of a cycle


@cython.cclass
class StateSequence:
    """Events are changes of a state; number `order[i]` is the i-th of them.

    Attributes
    ----------
    angle, whose, into : (event,)
        When, which contact, and into which state: those of a `Cycle`, or FREE.
    along : (event,)
        Where a slider comes to rest, its place varies as k_u u + along mu k_v v.
    state, remembers : (contact,)
        Before the first event, and whether the slider's place is one of the disturbances then.
    """

    def __init__(self, contacts: int, most: int) -> None:
        """Of so many contacts, with at most so many events."""
        self.contacts, self.events = contacts, 0
        self.room(most)
        self.state, self.remembers = np.zeros(contacts, dtype=np.intc), np.zeros(contacts, dtype=np.intc)

    def room(self, most: int) -> None:
        """Arrays for so many events."""
        self.angle, self.along = np.zeros(most), np.zeros(most)
        self.whose, self.into, self.order = (np.zeros(most, dtype=np.intc) for _ in range(3))

    @cython.cfunc
    @cython.exceptval(check=False)
    def occurs(
        self, angle: cython.double, c: cython.int, into: cython.int, along: cython.double
    ) -> cython.void:
        """One more event."""
        i: cython.int = self.events
        while angle < 0.0:
            angle += TWO_PI
        while angle >= TWO_PI:
            angle -= TWO_PI
        self.angle[i], self.whose[i], self.into[i], self.along[i] = angle, c, into, along
        self.events += 1

    @cython.cfunc
    @cython.exceptval(check=False)
    def sort(self) -> cython.void:
        """`order`: the events by their angles; those of one contact at one angle as they were."""
        i: cython.int
        j: cython.int
        for i in range(self.events):
            j = i
            while j > 0 and self.angle[self.order[j - 1]] > self.angle[i]:
                self.order[j] = self.order[j - 1]
                j -= 1
            self.order[j] = i

    @cython.cfunc
    @cython.exceptval(check=False)
    def begin(self) -> cython.void:
        """The states before the first event: those after the last of each contact."""
        i: cython.int
        c: cython.int
        for i in range(self.events):
            c = self.whose[self.order[i]]
            self.state[c] = self.into[self.order[i]]
            self.remembers[c] = self.state[c] == STICK
