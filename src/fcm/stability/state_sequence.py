"""The states of the contacts over a period of a motion: which contact changes its state when, and into which.

The small disturbances of a motion, balanced or exact, depend on these alone.

Of a balanced motion they come from the located events of its contacts (`BalancedSequence`). Of contacts in a
plane the disturbances also depend on quantities at every angle in between (`PlanarSequence`). These are the
direction of slip, the rates of the displacements, and the radius of the disc. The states have the same
numbers there.
"""

from __future__ import annotations

import cython
import numpy as np
import numpy.typing as npt
from cython.cimports.libc.math import cos, fabs, sin, sqrt

from fcm.contact.kernels import periodic_contact
from fcm.contact.plane.options import OPTIONS
from fcm.contact.plane.radau import radau
from fcm.stability.options import STABILITY, PlanarStabilityOptions

if cython.compiled:
    from cython.cimports.fcm.contact.periodic.cycle import POSITIVE, SEPARATION, STICK, STUCK, join_states
    from cython.cimports.fcm.contact.periodic.motion import OPEN, TWO_PI, UNKNOWN
    from cython.cimports.fcm.contact.plane.cycle import UNSOLVED
    from cython.cimports.fcm.contact.plane.forces import PlanarContact
    from cython.cimports.fcm.contact.plane.panel import STAGES
    from cython.cimports.fcm.contact.plane.slider import SLIP
else:
    from fcm.contact.periodic.cycle import POSITIVE, SEPARATION, STICK, STUCK, join_states
    from fcm.contact.periodic.motion import OPEN, TWO_PI, UNKNOWN
    from fcm.contact.plane.cycle import UNSOLVED
    from fcm.contact.plane.forces import PlanarContact
    from fcm.contact.plane.radau import STAGES
    from fcm.contact.plane.slider import SLIP


FREE = cython.declare(cython.int, 3)  # closed without friction, a state beside those of a cycle


@cython.cclass
class StateSequence:
    """Events are changes of a state; number `order[i]` is the i-th of them.

    Attributes
    ----------
    angle, whose, into : (event,)
        When, which contact, and into which state: those of a `LineCycle`, or FREE.
    along : (event,)
        Where a slider comes to rest, its place varies as k_u u + along mu k_v v.
    state, remembers : (contact,)
        Before the first event, and whether the slider's place is one of the disturbances then.
    """

    def __init__(self, contacts: int, most: int) -> None:
        """Makes a sequence for a number of contacts with room for `most` events."""
        self.contacts, self.events = contacts, 0
        self.allocate(most)
        self.state, self.remembers = np.zeros(contacts, dtype=np.intc), np.zeros(contacts, dtype=np.intc)

    def allocate(self, most: int) -> None:
        """Arrays for so many events."""
        self.angle, self.along = np.zeros(most), np.zeros(most)
        self.whose, self.into, self.order = (np.zeros(most, dtype=np.intc) for _ in range(3))

    @cython.cfunc
    @cython.exceptval(check=False)
    def add_event(
        self, angle: cython.double, c: cython.int, into: cython.int, along: cython.double
    ) -> cython.void:
        """Adds the event that contact c enters a state at an angle [rad]."""
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


@cython.cclass
class BalancedSequence(StateSequence):
    """`find_events` at a motion finds its events.

    Parameters
    ----------
    contact : (contact, 4)
        mu, k_u, k_v, n_0.
    harmonics : list of int
        Of the motions; unknowns as in `contact_law`.

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
                    self.add_event(self.cycle.event_angle[e], c, STICK, self.limit_at(0))
            return True
        if not rubs and not self.opens():  # it slides to and fro, and nothing changes by that
            self.state[c] = FREE
            return True
        self.moving += 1
        for p in range(self.cycle.pieces):
            state = self.cycle.state[p]
            if not rubs and state != SEPARATION:
                state = FREE
            self.add_event(self.cycle.begin[p], c, state, self.limit_at(p) if state == STICK else 0.0)
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


def states() -> tuple[int, int, int]:
    """The numbers of the states STICK, SLIP and SEPARATION."""
    return STICK, SLIP, SEPARATION


@cython.cclass
class PlanarSequence:
    """`find_events` at a motion finds the cycles of its contacts.

    Parameters
    ----------
    contact : (contact, 4)
        mu, k_u, k_v, n_0.
    harmonics : tuple of int
        Of the motions; unknowns as of `PlanarContact`.

    Attributes
    ----------
    count (contact,), begin, state (contact, count)
        How many states each has in a period; the angles [rad] at which they begin, rising, less than a turn
        from the first; and which they are: STICK, SLIP, SEPARATION, or FREE, closed without friction.
    first (contact + 1,), record (panel, 5 + s)
        Of its panels of slip, the rows that a contact has; as `Slider.record`.
    moving, held : int
        Contacts that slip with friction, or open and close. A slider that never slips stays where it is: none
        is held by an extreme of its limit, and `yielding` changes nothing.
    e_x, e_y, x_1, y_1, r, r_1
        What `direction` and `rates` found: the direction of slip; u_x', u_y', the radius and its derivative.
    """

    def __init__(
        self,
        contact: npt.NDArray[np.float64],
        harmonics: tuple[int, ...],
        options: PlanarStabilityOptions = STABILITY.planar,
    ) -> None:
        numbers = [int(h) for h in harmonics]
        self.options, self.invisible = options, OPTIONS.min_state_length
        self.contact, self.contacts = np.ascontiguousarray(contact), contact.shape[0]
        self.kernel = PlanarContact(numbers, [1], options.initial_panels)
        self.width, self.capacity = 3 + 6 * len(numbers), self.kernel.cycle.slider.capacity
        self.count = np.zeros(self.contacts, dtype=np.intc)
        self.first = np.zeros(self.contacts + 1, dtype=np.intc)
        self.begin = np.zeros((self.contacts, self.capacity))
        self.state = np.zeros((self.contacts, self.capacity), dtype=np.intc)
        self.piece = np.zeros(self.capacity, dtype=np.intc)
        self.record = np.zeros((self.contacts * options.initial_panels, 5 + STAGES))
        self.re, self.im = np.zeros((2, self.contacts, 3, len(numbers)))
        self.mean, self.order = np.zeros(self.contacts), np.array(numbers, dtype=np.float64)
        rule = radau(STAGES)
        self.node, self.bary = np.concatenate(([0.0], rule.nodes)), rule.bary
        self.moving = self.held = self.highest = 0
        self.yielding = True
        self.e_x = self.e_y = self.x_1 = self.y_1 = self.r = self.r_1 = 0.0

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def find_events(self, x: cython.double[::1]) -> cython.bint:
        """Find the cycles of the motion x; false where a number is not finite, or one is not found."""
        c: cython.int
        self.moving = self.highest = 0
        found: cython.bint = True
        for c in range(self.contacts):
            found = found and self.look(x, c)
        return found

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def look(self, x: cython.double[::1], c: cython.int) -> cython.bint:
        """Find the cycle of one contact."""
        i: cython.int
        k: cython.int
        mu: cython.double = self.contact[c, 0]
        k_u: cython.double = self.contact[c, 1]
        k_v: cython.double = self.contact[c, 2]
        n_0: cython.double = self.contact[c, 3]
        first: cython.Py_ssize_t = c * self.width
        kind: cython.int = self.kernel.evaluate(x, first, mu, k_u, k_v, n_0, 0.0, 0.0, False)
        if kind in (UNKNOWN, UNSOLVED):
            return False
        if self.kernel.cycle.slider.panels > self.kernel.cycle.slider.most_panels:
            harmonics = np.asarray(self.kernel.motion.number).tolist()
            self.kernel = PlanarContact(harmonics, [1], 2 * self.kernel.cycle.slider.panels)
            return self.look(x, c)
        ratio: cython.double = mu * k_v / k_u if k_u > 0.0 else 0.0
        self.mean[c] = mu * (n_0 + k_v * x[first + 2]) / k_u if k_u > 0.0 else 0.0
        for k in range(self.order.shape[0]):
            for i in range(3):
                by: cython.double = ratio if i == 2 else 1.0
                self.re[c, i, k] = by * x[first + 3 + 6 * k + 2 * i]
                self.im[c, i, k] = by * x[first + 4 + 6 * k + 2 * i]
                if self.re[c, i, k] != 0.0 or self.im[c, i, k] != 0.0:
                    self.highest = max(self.highest, k + 1)
        return self.keep(c)

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def keep(self, c: cython.int) -> cython.bint:
        """Keeps the states of contact c without those within rounding, joined, and its panels."""
        i: cython.int
        p: cython.int
        state: cython.int
        n: cython.int = 0
        rubs: cython.bint = self.contact[c, 0] * self.contact[c, 1] != 0.0
        pieces: cython.int = self.kernel.cycle.slider.pieces
        for p in range(pieces):
            if pieces > 1 and self.kernel.cycle.slider.length(p) <= self.invisible:
                continue
            state = self.kernel.cycle.slider.state[p]
            if state != SEPARATION and not rubs:
                state = FREE
            self.state[c, n], self.piece[n] = state, p
            n += 1
        n = join_states(self.state[c], self.piece, n)
        for i in range(n):
            self.begin[c, i] = self.kernel.cycle.slider.begin[self.piece[i]]
        self.count[c] = n
        if n > 1 or self.state[c, 0] == SLIP:
            self.moving += 1
        first: cython.int = self.first[c]
        panels: cython.int = self.kernel.cycle.slider.panels
        if first + panels > self.record.shape[0]:
            more = np.zeros((2 * (first + panels), 5 + STAGES))
            more[:first] = np.asarray(self.record)[:first]
            self.record = more
        for p in range(panels):
            for i in range(5 + STAGES):
                self.record[first + p, i] = self.kernel.cycle.slider.record[p, i]
        self.first[c + 1] = first + panels
        return True

    def state_at(self, c: cython.int, theta: float) -> cython.int:
        """The state of a contact at an angle."""
        i: cython.int = self.count[c] - 1
        since: float = (theta - self.begin[c, 0]) % TWO_PI
        if since < 0.0:
            since += TWO_PI
        while i > 0 and self.begin[c, i] - self.begin[c, 0] > since:
            i -= 1
        return self.state[c, i]

    def remembers(self, c: cython.int, theta: float) -> cython.int:
        """How many numbers a contact remembers at an angle: the place of its slider, or its direction."""
        state: cython.int = self.state_at(c, theta)
        if self.count[c] == 1:
            return 1 if state == SLIP else 0
        return 2 if state == STICK else 1 if state == SLIP else 0

    def slip_at(
        self, c: cython.int, angles: cython.double[::1], before: cython.bint = False
    ) -> npt.NDArray[np.float64]:
        """(angle, 6) of a contact at angles of its slip: e_x, e_y, x_1, y_1, r_1, r; before as of `panel`."""
        found = np.zeros((angles.shape[0], 6))
        out: cython.double[:, ::1] = found
        i: cython.Py_ssize_t
        for i in range(angles.shape[0]):
            if self.first[c + 1] > self.first[c]:
                self.direction(self.panel(c, angles[i], before), angles[i])
            self.rates(c, angles[i])
            out[i, 0], out[i, 1] = self.e_x, self.e_y
            out[i, 2], out[i, 3], out[i, 4], out[i, 5] = self.x_1, self.y_1, self.r_1, self.r
        return found

    def rates(self, c: cython.int, theta: float) -> None:
        """`x_1`, `y_1`, `r_1`, and `r`, at an angle."""
        k: cython.int
        h: cython.int = 1
        c_1: float = cos(theta)
        s_1: float = sin(theta)
        a: float = c_1
        b: float = s_1
        x: float = 0.0
        y: float = 0.0
        z: float = 0.0
        r: float = self.mean[c]
        for k in range(self.highest):
            while h < self.order[k]:
                a, b = a * c_1 - b * s_1, b * c_1 + a * s_1
                h += 1
            x -= self.order[k] * (self.re[c, 0, k] * b + self.im[c, 0, k] * a)
            y -= self.order[k] * (self.re[c, 1, k] * b + self.im[c, 1, k] * a)
            z -= self.order[k] * (self.re[c, 2, k] * b + self.im[c, 2, k] * a)
            r += self.re[c, 2, k] * a - self.im[c, 2, k] * b
        self.x_1, self.y_1, self.r_1, self.r = x, y, z, r

    def panel(self, c: cython.int, theta: float, before: bool) -> cython.int:
        """The panel of a slip that an angle is in, or at the end of which (before) it is."""
        p: cython.int = self.first[c + 1] - 1
        first: float = self.record[self.first[c], 0]
        since: float = (theta - first) % TWO_PI
        if since < 0.0:
            since += TWO_PI
        if before and since < 1e-9:
            since += TWO_PI
        while p > self.first[c] and (
            self.record[p, 0] - first > since or (before and self.record[p, 0] - first >= since - 1e-11)
        ):
            p -= 1
        return p

    def direction(self, p: cython.int, theta: float) -> None:
        """`e_x`, `e_y`, of slip at an angle of a panel."""
        k: cython.int
        since: float = (theta - self.record[p, 0]) % TWO_PI
        if since < 0.0:
            since += TWO_PI
        if since > 0.5 * (TWO_PI + self.record[p, 1]):  # a rounding error before it
            since = 0.0
        length: float = self.record[p, 1]
        part: float = min(since / length, 1.0)
        if self.record[p, 4] > 0.0:
            left: float = self.record[p, 4]
            part = (1.0 - sqrt(1.0 - part * length / left)) / (1.0 - sqrt(1.0 - length / left))
        total: float = 0.0
        t: float = 0.0
        for k in range(STAGES + 1):
            apart: float = part - self.node[k]
            value: float = self.record[p, 4 + k] if k > 0 else 0.0
            if apart == 0.0:
                t, total = value, 1.0
                break
            total += self.bary[k] / apart
            t += self.bary[k] / apart * value
        t /= total
        by: float = 1.0 / (1.0 + t * t)
        a: float = (1.0 - t * t) * by
        b: float = 2.0 * t * by
        self.e_x = self.record[p, 2] * a - self.record[p, 3] * b
        self.e_y = self.record[p, 3] * a + self.record[p, 2] * b
