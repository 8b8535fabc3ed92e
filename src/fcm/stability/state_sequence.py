"""The states of the contacts over a period of a motion: which contact changes its state when, and into which.

The small disturbances of a motion, balanced or exact, depend on these alone.

For a balanced motion, the located events of its contacts give the states (`BalancedSequence`). For contacts
in a plane see `planar_monodromy`.
"""

from __future__ import annotations

import cython
import numpy as np
import numpy.typing as npt

from fcm.contact.kernels import periodic_contact

if cython.compiled:
    from cython.cimports.fcm.contact.contact_kernel import OPEN, STUCK, UNKNOWN, ContactParameters
    from cython.cimports.fcm.contact.periodic.cycle import SEPARATION, STICK
    from cython.cimports.fcm.contact.periodic.motion import TWO_PI
else:
    from fcm.contact.contact_kernel import OPEN, STUCK, UNKNOWN, ContactParameters
    from fcm.contact.periodic.cycle import SEPARATION, STICK
    from fcm.contact.periodic.motion import TWO_PI


FREE = cython.declare(cython.int, 3)  # closed without friction, a state beside those of a cycle


@cython.cclass
class StateSequence:
    """The events over a period, changes of a contact's state; the i-th in time is number `order[i]`.

    Attributes
    ----------
    angle, whose, into : (event,)
        Angle [rad], contact, and new state: one of a `LineCycle`, or FREE.
    along : (event,)
        Where a slider comes to rest, k_u times its place varies as k_u u + along mu k_v v.
    state, remembers : (contact,)
        State before the first event, and whether the slider's place is a disturbance there.
    """

    def __init__(self, contacts: int, most: int) -> None:
        """Make a sequence for a number of contacts with room for `most` events."""
        self.contacts, self.events = contacts, 0
        self.allocate(most)
        self.state, self.remembers = np.zeros(contacts, dtype=np.intc), np.zeros(contacts, dtype=np.intc)

    def allocate(self, most: int) -> None:
        """Allocate arrays for `most` events."""
        self.angle, self.along = np.zeros(most), np.zeros(most)
        self.whose, self.into, self.order = (np.zeros(most, dtype=np.intc) for _ in range(3))

    @cython.cfunc
    @cython.exceptval(check=False)
    def add_event(
        self, angle: cython.double, c: cython.int, into: cython.int, along: cython.double
    ) -> cython.void:
        """Add the event that contact c enters a state at an angle [rad]."""
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
        """Fill `order`: the events by their angles; events at the same angle keep their order."""
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
        """Set the states before the first event: those after the last event of each contact."""
        i: cython.int
        c: cython.int
        for i in range(self.events):
            c = self.whose[self.order[i]]
            self.state[c] = self.into[self.order[i]]
            self.remembers[c] = self.state[c] == STICK


@cython.cclass
class BalancedSequence(StateSequence):
    """The events of a balanced motion; `find_events` finds them.

    Parameters
    ----------
    contact : (contact, 4)
        mu, k_u, k_v, n_0.
    harmonics : list of int
        Those of the motions; unknowns as in `contact_law`.

    Attributes
    ----------
    moving, held : int
        Number of contacts that slip with friction, or open and close; and number of those that never do, but
        whose slider an extreme of its limit holds.
    yielding : bool
        Whether a held slider follows its limit, as it does if it is pushed; otherwise it stays at rest.
    """

    def __init__(self, contact: npt.NDArray[np.float64], harmonics: list[int]) -> None:
        self.width = 2 + 4 * len(harmonics)
        self.contact, self.parameters = np.ascontiguousarray(contact), ContactParameters()
        kernel = periodic_contact(tuple(harmonics), tuple(harmonics))
        self.motion, self.cycle = kernel.motion, kernel.cycle
        contacts = contact.shape[0]
        StateSequence.__init__(self, contacts, contacts * (self.cycle.event.shape[0] + 1))
        self.moving = self.held = 0
        self.yielding = True

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def find_events(self, x: cython.double[::1]) -> cython.bint:
        """Find the events of the motion x; false where a number is not finite."""
        c: cython.int
        self.events, self.moving, self.held = 0, 0, 0
        for c in range(self.contacts):
            if not self.contact_cycle(x, c):
                return False
        self.sort()
        self.begin()
        return True

    @cython.cfunc
    @cython.exceptval(check=False)
    def contact_cycle(self, x: cython.double[::1], c: cython.int) -> cython.bint:
        """Add the events of one contact, or set its state if it has none; false if its cycle is unknown."""
        p: cython.int
        e: cython.int
        kind: cython.int
        state: cython.int
        self.parameters.take_row(self.contact, c)
        rubs: cython.bint = self.parameters.mu > 0.0 and self.parameters.k_u > 0.0
        kind = self.cycle.take(x, c * self.width, self.parameters)
        self.remembers[c] = 0
        if kind == UNKNOWN:
            return False
        if kind in (OPEN, STUCK):
            self.state[c] = SEPARATION if kind == OPEN else STICK if rubs else FREE
            if kind == STUCK and rubs and self.cycle.cause[0] != 0:
                self.held += 1
                if self.yielding:
                    e = self.cycle.event[0]
                    self.add_event(self.cycle.event_angle[e], c, STICK, self.cycle.along(0))
            return True
        if not rubs and not self.opens():  # it slides without friction: its state never changes
            self.state[c] = FREE
            return True
        self.moving += 1
        for p in range(self.cycle.pieces):
            state = self.cycle.state[p]
            if not rubs and state != SEPARATION:
                state = FREE
            self.add_event(self.cycle.begin[p], c, state, self.cycle.along(p) if state == STICK else 0.0)
        return True

    @cython.cfunc
    @cython.exceptval(check=False)
    def opens(self) -> cython.bint:
        """Whether the contact of the last cycle separates."""
        p: cython.int
        found: cython.bint = False
        for p in range(self.cycle.pieces):
            found = found or self.cycle.state[p] == SEPARATION
        return found
