"""The sequence of states of a balanced motion, from the located events of its contacts."""

from __future__ import annotations

import cython
import numpy as np
import numpy.typing as npt
from cython.cimports.libc.math import fabs

from fcm.contact.periodic.workspace import periodic_contact

if cython.compiled:
    from cython.cimports.fcm.contact.periodic.cycle import STUCK
    from cython.cimports.fcm.contact.periodic.motion import OPEN, UNKNOWN
    from cython.cimports.fcm.contact.periodic.slider import POSITIVE, SEPARATION, STICK
    from cython.cimports.fcm.stability.state_sequence import FREE, StateSequence
else:
    from fcm.contact.periodic.cycle import STUCK
    from fcm.contact.periodic.motion import OPEN, UNKNOWN
    from fcm.contact.periodic.slider import POSITIVE, SEPARATION, STICK
    from fcm.stability.state_sequence import FREE, StateSequence


@cython.cclass
class BalancedSequence(StateSequence):
    """`find_events` at a motion finds its events.

    Parameters
    ----------
    contact : (contact, 4)
        mu, k_u, k_v, n_0.
    harmonics : list of int
        Of the motions; unknowns as in `law`.

    Attributes
    ----------
    moving, held : int
        Contacts that slip with friction, or open and close; and those that never do, but for an extreme of a
        limit that holds the slider.
    yielding : bool
        Whether such a slider follows that limit. It does when it is pushed, and stays where it is when not.
    """

    def __init__(self, contact: npt.NDArray[np.float64], harmonics: list[int]) -> None:
        self.width = 2 + 4 * len(harmonics)
        self.contact = np.ascontiguousarray(contact)
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
        """The events of one contact; the state of one that has none."""
        p: cython.int
        e: cython.int
        kind: cython.int
        state: cython.int
        mu: cython.double = self.contact[c, 0]
        k_u: cython.double = self.contact[c, 1]
        rubs: cython.bint = mu > 0.0 and k_u > 0.0
        first: cython.Py_ssize_t = c * self.width
        kind = self.motion.load(x, first, mu, k_u, self.contact[c, 2], self.contact[c, 3])
        kind = self.cycle.solve(kind, -k_u * x[first] / self.motion.scale)
        self.remembers[c] = 0
        if kind == UNKNOWN:
            return False
        if kind in (OPEN, STUCK):
            self.state[c] = SEPARATION if kind == OPEN else STICK if rubs else FREE
            if kind == STUCK and rubs and self.cycle.cause[0] != 0:
                self.held += 1
                if self.yielding:
                    e = self.cycle.event[0]
                    self.occurs(self.cycle.event_angle[e], c, STICK, self.limit_at(0))
            return True
        if not rubs and not self.opens():  # it slides to and fro, and nothing changes by that
            self.state[c] = FREE
            return True
        self.moving += 1
        for p in range(self.cycle.pieces):
            state = self.cycle.state[p]
            if not rubs and state != SEPARATION:
                state = FREE
            self.occurs(self.cycle.begin[p], c, state, self.limit_at(p) if state == STICK else 0.0)
        return True

    @cython.cfunc
    @cython.exceptval(check=False)
    def opens(self) -> cython.bint:
        """Whether the contact that was looked at separates."""
        p: cython.int
        found: cython.bint = False
        for p in range(self.cycle.pieces):
            found = found or self.cycle.state[p] == SEPARATION
        return found

    @cython.cfunc
    @cython.exceptval(check=False)
    def limit_at(self, p: cython.int) -> cython.double:
        """`along` of a stick. After a separation w = u where the load vanishes: that moves by -dn / n'."""
        e: cython.int = self.cycle.event[p]
        if self.cycle.cause[p] != SEPARATION:
            return -1.0 if self.cycle.cause[p] == POSITIVE else 1.0
        # the limits are never steeper than the motion here, or it would not stick
        load: cython.double = self.motion.ratio * self.cycle.load_rate[e]
        if fabs(self.cycle.motion_rate[e]) < load:
            return -self.cycle.motion_rate[e] / load
        return -1.0 if self.cycle.motion_rate[e] > 0.0 else 1.0
