"""How disturbances of a motion with contacts in a plane are carried through the events of a period.

From event to event, in steps as long as polynomials resolve the velocities of the disturbances. What a step
does, and an event, is for `PlanarMonodromy` and `ManyPlanarMonodromy` to say.
"""

from __future__ import annotations

import cython
import numpy as np
import numpy.typing as npt

if cython.compiled:
    from cython.cimports.fcm.contact.periodic.cycle import TWO_PI
    from cython.cimports.fcm.contact.plane.slider import SEPARATION, SLIP
    from cython.cimports.fcm.stability.planar_sequence import PlanarSequence
else:
    from fcm.contact.periodic.cycle import TWO_PI
    from fcm.contact.plane.slider import SEPARATION, SLIP
    from fcm.stability.planar_sequence import PlanarSequence


@cython.cclass
class VariationalSteps:
    """`follow` a sequence: `matrix` is then the derivative of (q, q', memory) after a period by that before.

    Velocities are by the angle.

    Attributes
    ----------
    steps
        How many the last period took.
    state, fresh, held : (contact,)
        The state of each contact now; whether it has just closed, and slips; and how many numbers it
        remembers at the beginning of the period.
    """

    def __init__(self, sequence: PlanarSequence, stages: int, tolerance: float) -> None:
        """stages, tolerance: of a step, see `PlanarStabilityOptions`."""
        options = sequence.options
        self.sequence, self.contacts, self.stages = sequence, sequence.contacts, stages
        self.tolerance, self.max_step, self.min_step = tolerance, options.max_step, options.min_step
        self.min_factor, self.max_factor, self.safety = options.min_factor, options.max_factor, options.safety
        self.end_factor, self.event_tolerance = options.end_factor, options.event_tolerance
        self.max_retry_factor, self.min_gap = options.max_retry_factor, options.min_gap
        most = self.contacts * sequence.capacity
        self.angle = np.zeros(most)
        self.whose, self.which, self.order = np.zeros((3, most), dtype=np.intc)
        self.state, self.fresh, self.held = np.zeros((3, self.contacts), dtype=np.intc)
        self.events = self.steps = self.first = 0
        self.next = 0.0
        self.filled = np.zeros((0, 0))

    def matrix(self) -> npt.NDArray[np.float64]:
        """(2 modes + memories, the same); of more disturbances than the options allow, not a number."""
        found: npt.NDArray[np.float64] = self.filled
        return found

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def begin(self, omega: cython.double) -> cython.bint:
        """Take a frequency, and the disturbances to be followed; false if they are too many."""
        raise NotImplementedError

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def step(self, theta: cython.double, h: cython.double) -> cython.double:
        """A step from an angle on; what it leaves out beside a disturbance, infinity where it is singular."""
        raise NotImplementedError

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def accept(self) -> cython.int:
        """The end of the step is where the disturbances are."""
        raise NotImplementedError

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def apply_event(self, c: cython.int, i: cython.int) -> cython.int:
        """State i of a contact begins: what it remembers of the disturbances."""
        raise NotImplementedError

    @cython.ccall
    def disturbances(self) -> npt.NDArray[np.float64]:
        """The rows (q, q', memory) now."""
        raise NotImplementedError

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def follow(self, omega: cython.double) -> cython.int:
        """Fill the matrix for a frequency."""
        e: cython.int
        c: cython.int
        i: cython.int
        self.next, self.steps = self.max_step, 0
        self.find()
        start: cython.double = self.start()
        now: cython.double = start
        for c in range(self.contacts):
            self.state[c], self.fresh[c] = self.sequence.state_at(c, start), 0
            self.held[c] = self.sequence.remembers(c, start)
        found: cython.bint = self.begin(omega)
        for i in range(self.events + 1):
            e = self.order[(self.first + i) % self.events] if i < self.events else -1
            at: cython.double = self.angle[e] if e >= 0 else start + TWO_PI
            if at < start:
                at += TWO_PI
            if found and (at - now > self.event_tolerance or e < 0):
                opens: cython.bint = e >= 0 and self.state[self.whose[e]] == SLIP
                opens = opens and self.sequence.state[self.whose[e], self.which[e]] == SEPARATION
                found = self.propagate(now, at - now, opens)
                now = at
            if found and e >= 0:
                self.apply_event(self.whose[e], self.which[e])
        self.filled = self.disturbances() if found else np.full((1, 1), np.nan)
        return 0

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def find(self) -> cython.int:
        """The events of the period, `order` of their angles."""
        c: cython.int
        i: cython.int
        self.events = 0
        for c in range(self.contacts):
            for i in range(self.sequence.count[c]):
                if self.sequence.count[c] == 1:
                    continue
                angle: cython.double = self.sequence.begin[c, i]
                while angle < 0.0:
                    angle += TWO_PI
                while angle >= TWO_PI:
                    angle -= TWO_PI
                self.angle[self.events], self.whose[self.events], self.which[self.events] = angle, c, i
                self.events += 1
        order = np.asarray(self.angle)[: self.events].argsort(kind="stable")
        np.asarray(self.order)[: self.events] = order
        return 0

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def start(self) -> cython.double:
        """An angle at which little is remembered, in the middle between two events; `first` is the next."""
        i: cython.int
        c: cython.int
        count: cython.int
        fewest: cython.int = 3 * self.contacts
        widest: cython.double = 0.0
        found: cython.double = 0.0
        self.first = 0
        for i in range(self.events):
            begin: cython.double = self.angle[self.order[i]]
            last: cython.bint = i + 1 == self.events
            end: cython.double = self.angle[self.order[0 if last else i + 1]] + (TWO_PI if last else 0.0)
            middle: cython.double = 0.5 * (begin + end)
            if not end - begin > self.min_gap:
                continue
            count = 0
            for c in range(self.contacts):
                count += self.sequence.remembers(c, middle)
            if count < fewest or (count == fewest and end - begin > widest):
                fewest, widest, found = count, end - begin, middle
                self.first = 0 if last else i + 1
        return found if found < TWO_PI else found - TWO_PI

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def propagate(self, theta: cython.double, length: cython.double, opens: cython.bint) -> cython.bint:
        """Carry the disturbances from an angle on, in steps; false where no step is short enough.

        Where a contact opens that slipped, s varies as a power of the angle that is left, and where it closes
        and slips, s has one coefficient less: what polynomials leave out there disturbances err by.
        """
        left: cython.double = length
        closed: cython.bint = False
        c: cython.int
        for c in range(self.contacts):
            closed = closed or self.fresh[c] != 0
        while left > 0.0:
            h: cython.double = min(self.next, self.max_step)
            wanted: cython.double = h
            refused: cython.bint = False
            if h >= left:
                h = left
            elif h > 0.5 * left:
                h = 0.5 * left
            while True:
                if h < self.min_step:
                    return False
                rest: cython.double = self.step(theta + length - left, h)
                rest /= self.end_factor if closed or (opens and h == left) else 1.0
                by: cython.double = (self.tolerance / max(rest, 1e-300)) ** (1.0 / self.stages)
                if rest <= self.tolerance:
                    break
                h *= min(max(self.safety * by, self.min_factor), self.max_retry_factor)
                refused = True
            self.next = h * min(max(self.safety * by, self.min_factor), self.max_factor)
            if not refused:  # an event alone cut it
                self.next = max(self.next, wanted)
            self.accept()
            closed = False
            left = left - h if h < left else 0.0
            self.steps += 1
        return True
