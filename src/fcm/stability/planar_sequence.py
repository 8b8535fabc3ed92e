"""The states over a period of contacts that slide in a plane, and what disturbances depend on in between.

That is, at every angle, the direction of slip, the rates of the displacements, and the radius of the disc.
The states have the same numbers as those on a line, see `state_sequence`.
"""

from __future__ import annotations

import cython
import numpy as np
import numpy.typing as npt
from cython.cimports.libc.math import cos, sin, sqrt

from fcm.contact.plane.options import OPTIONS
from fcm.contact.plane.radau import radau
from fcm.stability.options import STABILITY, PlanarStabilityOptions

if cython.compiled:
    from cython.cimports.fcm.contact.contact_kernel import UNKNOWN, UNSOLVED, ContactParameters
    from cython.cimports.fcm.contact.periodic.cycle import SEPARATION, STICK, join_states
    from cython.cimports.fcm.contact.periodic.motion import TWO_PI
    from cython.cimports.fcm.contact.plane.cycle import PlanarContact
    from cython.cimports.fcm.contact.plane.panel import STAGES
    from cython.cimports.fcm.contact.plane.slider import SLIP
    from cython.cimports.fcm.stability.state_sequence import FREE
else:
    from fcm.contact.contact_kernel import UNKNOWN, UNSOLVED, ContactParameters
    from fcm.contact.periodic.cycle import SEPARATION, STICK, join_states
    from fcm.contact.periodic.motion import TWO_PI
    from fcm.contact.plane.cycle import PlanarContact
    from fcm.contact.plane.radau import STAGES
    from fcm.contact.plane.slider import SLIP
    from fcm.stability.state_sequence import FREE


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
        self.parameters = ContactParameters()
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
        first: cython.Py_ssize_t = c * self.width
        given: ContactParameters = self.parameters
        given.take_row(self.contact, c)
        kind: cython.int = self.kernel.evaluate(x, first, given, False)
        if kind in (UNKNOWN, UNSOLVED):
            return False
        if self.kernel.cycle.slider.panels > self.kernel.cycle.slider.most_panels:
            harmonics = np.asarray(self.kernel.motion.number).tolist()
            self.kernel = PlanarContact(harmonics, [1], 2 * self.kernel.cycle.slider.panels)
            return self.look(x, c)
        ratio: cython.double = given.mu * given.k_v / given.k_u if given.k_u > 0.0 else 0.0
        load: cython.double = given.n_0 + given.k_v * x[first + 2]
        self.mean[c] = given.mu * load / given.k_u if given.k_u > 0.0 else 0.0
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
