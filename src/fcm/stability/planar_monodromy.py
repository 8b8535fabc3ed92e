r"""The monodromy matrix of a motion whose contacts slide in a plane.

A small disturbance is propagated from event to event, in steps as long as polynomials resolve its velocities.
Each step takes the degree that reaches the next event at the least cost.

As on a line (see `monodromy`), the modes of mass 1, with shapes P on the ports, obey

    q'' + 2 zeta w q' + w^2 q = - P dF

The forces of a contact in its plane change with its displacements du (2,), dv and with the memory of its
slider. With r = mu n / k_u, dr = mu k_v dv / k_u and the direction of slip e = (cos alpha, sin alpha):

    stick        df = k_u (du - dw),                               dw constant
    slip         df = k_u (dr e + (e_perp . du - s) e_perp),       s = e_perp . dw,   e . dw = e . du - dr
                 r s' = lambda (e_perp . du - s) - (e_perp . u') (e . du - dr)
    separation   df = dn = 0

The equation of s is the linearised equation of the direction, r alpha' = e_perp . u'. Forces are continuous,
so only the memory jumps at events. When slip begins, s = e_perp . dw. When it ends in stick, the equations of
slip give both components of dw. At a closing w = u where the load vanishes, so dw = du - u' dv / v' if the
contact sticks. If it slips at once, nothing is remembered: the factor r of s' vanishes there, and only one
solution for s is regular. A slider that never slips stays where it is.

The structure with the springs K of all contacts, as if they stuck, is assembled once. With S the flexibility
of the far modes, and P the shapes of the others,

    d = R^-1 P^T q + R^-1 S g,    R = 1 + S K,    q'' + .. + (w^2 + P K R^-1 P^T) q = (R^-1 P^T)^T g

g is the force of a contact's springs as if it stuck, minus its actual force. It is 0 for a contact that
sticks all through the cycle:

    stick        g = k_u dw
    slip         g = k_u (e . du - dr) e + k_u s e_perp
    separation   g = K d

An open contact is linear while it stays open. With T = (K_o^-1 - (R^-1 S)_oo)^-1 of the open contacts, o, the
structure includes them until another one opens or closes:

    d = (R^-1 P^T + (R^-1 S)_o T (R^-1 P^T)_o) q + (R^-1 S + (R^-1 S)_o T (R^-1 S)_o) g

Between events the equations are collocated at Radau points, as the equation of the direction is (see
`Panel`). With r before s', the equation of s has no singular point where the load vanishes. Quantities that
depend on one angle alone are eliminated at each point, as functions of (q, s). These are e . du - dr of the
slipping contacts, the right sides for their s, and the forces on the modes. A step of length h then has
equations for p = q' and s at all its points, solved for all disturbances at once. With the rule's
matrices A and D, and q_0, p_0 and s_0 at the beginning,

    q = q_0 + h A p,    p = p_0 + h A (forces - K q - C p),    r (D s + d s_0) + h lambda s = right side for s
"""

from __future__ import annotations

from collections.abc import Callable

import cython
import numpy as np
import numpy.typing as npt
from cython.cimports.libc.math import ceil, cos, fabs, sin, sqrt

from fcm.contact.plane.options import OPTIONS
from fcm.contact.plane.radau import radau
from fcm.stability.options import STABILITY, PlanarStabilityOptions
from fcm.stability.quasi_static_modes import PortModes

if cython.compiled:
    from cython.cimports.fcm.contact.contact_kernel import UNKNOWN, UNSOLVED, ContactParameters
    from cython.cimports.fcm.contact.periodic.cycle import join_states
    from cython.cimports.fcm.contact.periodic.motion import TWO_PI
    from cython.cimports.fcm.contact.plane.cycle import PlanarContact
    from cython.cimports.fcm.contact.plane.panel import STAGES
    from cython.cimports.fcm.contact.plane.slider import SEPARATION, SLIP, STICK
    from cython.cimports.fcm.continuation.dense_solver import condense
    from cython.cimports.fcm.stability.state_sequence import FREE
else:
    from fcm.contact.contact_kernel import UNKNOWN, UNSOLVED, ContactParameters
    from fcm.contact.periodic.cycle import join_states
    from fcm.contact.periodic.motion import TWO_PI
    from fcm.contact.plane.cycle import PlanarContact
    from fcm.contact.plane.radau import STAGES
    from fcm.contact.plane.slider import SEPARATION, SLIP, STICK
    from fcm.continuation.dense_solver import condense
    from fcm.stability.state_sequence import FREE

FloatArray = npt.NDArray[np.float64]


@cython.cclass
class PlanarSequence:
    """The states of contacts in a plane over a period, and quantities of the motion for its disturbances.

    These are the direction of slip, the rates of the displacements, and the radius of the disc at every
    angle. `find_events` finds the cycles of a motion's contacts. The states have the same numbers as those on
    a line, see `state_sequence`.

    Parameters
    ----------
    contact : (contact, 4)
        mu, k_u, k_v, n_0.
    harmonics : tuple of int
        Those of the motions; unknowns as in `PlanarContact`.

    Attributes
    ----------
    count (contact,), begin, state (contact, count)
        Number of states of each contact in a period; the angles [rad] at which they begin, ascending, less
        than a turn from the first; and the states: STICK, SLIP, SEPARATION, or FREE, closed without friction.
    first (contact + 1,), record (panel, 5 + s)
        Panels of slip, as in `Slider.record`; contact c has the rows from first[c] to first[c + 1].
    moving, held : int
        Number of contacts that slip with friction, or open and close; and 0. A slider that never slips stays
        where it is: no extreme of a limit holds it, and `yielding` has no effect.
    e_x, e_y, x_1, y_1, r, r_1
        Results of `direction` and `rates`: the direction of slip; u_x', u_y', the radius and its derivative.
    """

    def __init__(
        self,
        contact: FloatArray,
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
        """Find the cycles of the motion x; false if a number is not finite, or a cycle is not found."""
        c: cython.int
        self.moving = self.highest = 0
        found: cython.bint = True
        for c in range(self.contacts):
            found = found and self.look(x, c)
        return found

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def look(self, x: cython.double[::1], c: cython.int) -> cython.bint:
        """Find the cycle of one contact; false as in `find_events`."""
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
        """Keep the panels of contact c, and its states, joined, without those too short to be resolved."""
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
        """How many numbers a contact remembers at an angle: its slider's place (2) or direction (1)."""
        state: cython.int = self.state_at(c, theta)
        if self.count[c] == 1:
            return 1 if state == SLIP else 0
        return 2 if state == STICK else 1 if state == SLIP else 0

    def slip_at(self, c: cython.int, angles: cython.double[::1], before: cython.bint = False) -> FloatArray:
        """Values (angle, 6) of e_x, e_y, x_1, y_1, r_1, r at angles of a slip; before as in `panel`."""
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
        """Set `x_1`, `y_1`, `r_1` and `r` at an angle."""
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
        """The panel of slip that contains an angle; with before, the one that ends there, if any."""
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
        """Set `e_x`, `e_y`, the direction of slip at an angle in panel p."""
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


@cython.cclass
class PlanarMonodromy:
    """Monodromy of contacts in a plane; contacts that never move have no disturbances.

    After `follow`, `matrix` is the derivative of (q, q', memory) after a period by that before. Velocities
    are by the angle.

    Parameters
    ----------
    modes : PortModes
        With three ports for each contact.
    sequence : PlanarSequence
    poll : callable, optional
        Called at every event; it may raise an exception to interrupt.

    Attributes
    ----------
    steps
        Number of steps of the last period.
    part
        Angle [rad] that is followed: a period.
    state, fresh, held : (contact,)
        Present state of each contact; whether it has just closed and slips; and how many numbers it remembers
        at the beginning of the period.
    """

    def __init__(self, modes: PortModes, sequence: PlanarSequence, poll: Callable[[], object] = int) -> None:
        options, counts = sequence.options, np.array(sequence.options.stages, dtype=np.intc)
        self.sequence, self.contacts, self.stages = sequence, sequence.contacts, int(counts.max())
        self.stage_counts, self.longest = counts, np.zeros(counts.size)
        self.tolerance, self.max_step, self.min_step = options.tolerance, options.max_step, options.min_step
        self.min_factor, self.max_factor, self.safety = options.min_factor, options.max_factor, options.safety
        self.end_factor, self.event_tolerance = options.end_factor, options.event_tolerance
        self.max_retry_factor, self.min_gap = options.max_retry_factor, options.min_gap
        self.max_disturbances, self.coefficient_floor = options.max_disturbances, options.coefficient_floor
        most = self.contacts * sequence.capacity
        self.angle = np.zeros(most)
        self.whose, self.which, self.order = np.zeros((3, most), dtype=np.intc)
        self.state, self.fresh, self.held = np.zeros((3, self.contacts), dtype=np.intc)
        self.shapes, self.natural, self.damping = modes.near
        self.all_soft, self.modes, self.poll = modes.flexibility, len(self.natural), poll
        self.events = self.steps = self.first = self.slipping = self.columns = self.room = 0
        self.arranged, self.part, self.filled = False, TWO_PI, np.zeros((0, 0))

    def matrix(self) -> FloatArray:
        """The monodromy matrix, square, of 2 modes + memories rows.

        It is (1, 1) and nan if there are too many disturbances, or a step would be too short.
        """
        found: FloatArray = self.filled
        return found

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def follow(self, omega: cython.double) -> cython.int:
        """Compute the monodromy of the sequence of states at a frequency."""
        e: cython.int
        c: cython.int
        i: cython.int
        self.steps = 0
        for i in range(self.longest.shape[0]):
            self.longest[i] = self.max_step
        self.find()
        start: cython.double = self.start()
        now: cython.double = start
        for c in range(self.contacts):
            self.state[c], self.fresh[c] = self.sequence.state_at(c, start), 0
            self.held[c] = self.sequence.remembers(c, start)
        found: cython.bint = self.begin(omega)
        for i in range(self.events):
            e = self.order[(self.first + i) % self.events]
            at: cython.double = self.angle[e]
            if at < start:
                at += TWO_PI
            if not found or at >= start + self.part:
                break
            if at - now > self.event_tolerance:
                opens: cython.bint = self.state[self.whose[e]] == SLIP
                opens = opens and self.sequence.state[self.whose[e], self.which[e]] == SEPARATION
                found = self.propagate(now, at - now, opens)
                now = at
            if found:
                self.apply_event(self.whose[e], self.which[e])
        found = found and self.propagate(now, start + self.part - now, False)
        self.filled = self.disturbances() if found else np.full((1, 1), np.nan)
        return 0

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def find(self) -> cython.int:
        """Find the events of the period, and the `order` of their angles."""
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
        """The angle midway between two events at which contacts remember least; `first` is the next event."""
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
        """Propagate the disturbances from an angle on, in steps; false if no step is short enough.

        Before a slipping contact opens, s varies as a power of the angle that is left. After it closes and
        slips at once, s has one coefficient less. Polynomials resolve this worse, so the tolerance is lower
        there (`end_factor`).
        """
        left: cython.double = length
        closed: cython.bint = False
        c: cython.int
        for c in range(self.contacts):
            closed = closed or self.fresh[c] != 0
        while left > 0.0:
            while True:
                i: cython.int = self.cheapest(left)
                self.stages = self.stage_counts[i]
                h: cython.double = self.longest[i]
                if h >= left:
                    h = left
                elif h > 0.5 * left:
                    h = 0.5 * left
                if h < self.min_step:
                    return False
                rest: cython.double = self.step(theta + length - left, h)
                rest /= self.end_factor if closed or (opens and h == left) else 1.0
                by: cython.double = (self.tolerance / max(rest, 1e-300)) ** (1.0 / self.stages)
                if rest <= self.tolerance:
                    break
                self.longest[i] = h * min(max(self.safety * by, self.min_factor), self.max_retry_factor)
            # a step that an event cuts short does not tell whether a longer one is accurate
            next_step: cython.double = h * min(self.safety * by, self.max_factor)
            self.longest[i] = min(max(self.longest[i], next_step), self.max_step)
            self.accept()
            closed = False
            left = left - h if h < left else 0.0
            self.steps += 1
        return True

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def cheapest(self, left: cython.double) -> cython.int:
        """Index of the number of stages that covers an angle at the least cost: steps times stages cubed."""
        i: cython.int
        best: cython.int = 0
        least: cython.double = 0.0
        for i in range(self.longest.shape[0]):
            cost: cython.double = ceil(left / self.longest[i]) * self.stage_counts[i] ** 3
            if i == 0 or cost < least:
                best, least = i, cost
        return best

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def begin(self, omega: cython.double) -> cython.bint:
        """Set the frequency and the initial disturbances; false if these are too many."""
        count, state = np.asarray(self.sequence.count), np.asarray(self.sequence.state)
        self.moving = np.flatnonzero((count > 1) | (state[:, 0] == SLIP))
        self.number = np.full(count.size, -1)
        self.number[self.moving] = np.arange(self.moving.size)
        held = np.asarray(self.held)[self.moving]
        columns = 2 * self.modes + int(held.sum())
        if columns > self.max_disturbances:
            return False
        self._structure(omega)
        m, self.columns = self.modes, columns
        self.q, self.p = np.eye(m, columns), np.eye(m, columns, m)
        self.q_new, self.p_new = np.zeros((2, m, columns))
        # memory (contact, number, disturbance), and forces g (contact, direction, disturbance) of closed ones
        memory, g = np.zeros((self.moving.size, 2, columns)), np.zeros((self.moving.size, 3, columns))
        self.remembered = [(k, i) for k, n in enumerate(held.tolist()) for i in range(n)]
        for column, (k, i) in enumerate(self.remembered, 2 * m):
            memory[k, i, column] = 1.0
        sticks = np.asarray(self.state)[self.moving] == STICK
        g[sticks, :2] = self.k_u[sticks, None, None] * memory[sticks]
        self.memory, self.g = memory, g
        self.arranged = False
        return True

    def _structure(self, omega: float) -> None:
        """Assemble the structure with the springs of all contacts that are not always open."""
        contact, m = np.asarray(self.sequence.contact), self.modes
        rubs = contact[:, 0] * contact[:, 1] > 0.0
        opened = (np.asarray(self.sequence.count) == 1) & (np.asarray(self.state) == SEPARATION)
        springs = np.stack((contact[:, 1] * rubs, contact[:, 1] * rubs, contact[:, 2]), axis=1)
        springs[opened] = 0.0
        self.k_u, self.springs = springs[self.moving, 0], springs[self.moving]
        self.ratios = np.where(rubs, contact[:, 0] * contact[:, 2] / np.where(rubs, contact[:, 1], 1.0), 0.0)
        self.ratios, every = self.ratios[self.moving], springs.ravel()
        ports = _ports(self.moving)
        seen: FloatArray = self.shapes.T
        soft: FloatArray = self.all_soft[:, ports]
        if self.all_soft.any():
            R: FloatArray = np.eye(every.size) + self.all_soft * every
            found = np.asarray(np.linalg.solve(R, np.concatenate((seen, soft), axis=1)), dtype=np.float64)
            seen, soft = found[:, :m], found[:, m:]
        self.C = 2.0 * self.damping * self.natural / omega
        self.omega = omega
        self.K_closed = ((self.shapes * every) @ seen + np.diag(self.natural**2)) / omega**2
        self.seen_closed, self.soft_closed = seen[ports], soft[ports]
        self.open = np.full(1, -1)  # no contact yet

    def _open(self, contacts: npt.NDArray[np.intp]) -> None:
        """Include open contacts in the structure that was assembled with the springs of all."""
        self.open, ports = contacts, _ports(contacts)
        seen, soft, K = self.seen_closed, self.soft_closed, self.K_closed
        if ports.size:
            springs = self.springs[contacts].ravel()
            freed = np.eye(ports.size) - soft[np.ix_(ports, ports)] * springs
            both = np.concatenate((seen[ports], soft[ports]), axis=1)
            force = springs[:, None] * np.asarray(np.linalg.solve(freed, both), dtype=np.float64)
            m = self.modes
            K = K - seen[ports].T @ force[:, :m] / self.omega**2
            seen, soft = seen + soft[:, ports] @ force[:, :m], soft + soft[:, ports] @ force[:, m:]
        self.K, self.seen, self.soft = K, seen, soft
        self.push = self.seen.T / self.omega**2

    @cython.ccall
    def disturbances(self) -> FloatArray:
        """The present disturbances, rows (q, q', memory)."""
        kept = np.array([self.memory[k, i] for k, i in self.remembered]).reshape(-1, self.columns)
        return np.concatenate((self.q, self.p, kept))

    def _arrange(self) -> None:
        """Group the contacts by state, and prepare the couplings between them."""
        self.poll()
        state, columns, m = np.asarray(self.state)[self.moving], self.columns, self.modes
        slips, sticks = np.flatnonzero(state == SLIP), np.flatnonzero(state == STICK)
        opened = np.flatnonzero(state == SEPARATION)
        if not np.array_equal(opened, self.open):
            self._open(opened)
        n = self.slipping = slips.size
        self.slips, self.sliders = slips.astype(np.intc), self.moving[slips].astype(np.intc)
        self.ratio, self.stiff = self.ratios[slips], self.k_u[slips]
        slide, rest = _ports(slips), _ports(sticks, 2)
        # the memory of sticking contacts: its forces on the modes, and displacements of slipping contacts
        still = np.asarray(self.g)[sticks, :2].reshape(rest.size, columns)
        self.held_push = self.push[:, rest] @ still
        moved = self.soft[slide[:, None], rest] @ still
        by = np.concatenate((self.seen[slide], moved), axis=1)
        # displacements of slipping contacts: (direction, contact, mode or disturbance)
        self.seen_by = by.reshape(n, 3, by.shape[1]).transpose(1, 0, 2).copy()
        k_u = np.asarray(self.stiff)
        soft = self.soft[slide[:, None], slide].reshape(n, 3, n, 3)
        self.of_slips = (soft[..., :2] * k_u[:, None]).transpose(1, 3, 0, 2).copy()
        pushes = self.push[:, slide].reshape(m, n, 3)[..., :2] * k_u[:, None]
        self.pushes = pushes.transpose(2, 0, 1).copy()
        self.swapped_slips = np.zeros(n, dtype=np.intc)
        self.arranged, self.room = True, 0

    def _collocate(self) -> None:
        """Take the collocation rule of a step, and allocate arrays for it."""
        n, m, s, columns = self.slipping, self.modes, self.stages, self.columns
        rule = radau(s)
        self.node, self.slopes, self.inner = rule.nodes, np.ascontiguousarray(rule.slopes[1:]), rule.inner
        self.butcher, self.tail = np.linalg.inv(rule.slopes[1:, 1:]), rule.tail
        self.e_x, self.e_y, self.pressed, self.kept = np.zeros((4, s, n))
        self.sees, self.relaxing = np.zeros((2, s, n, 3)), np.zeros((n, s, s))
        self.by, self.force = np.zeros((s, 2 * n + m, 2 * n + m + columns)), np.zeros((s, m, columns))
        self.whole = np.zeros((s * (m + n), s * (m + n) + columns))
        self.swapped = np.zeros(s * (m + n), dtype=np.intc)
        self.room = s

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def step(self, theta: cython.double, h: cython.double) -> cython.double:
        """Take a step from an angle on; return its error relative to a disturbance, 1e300 if singular."""
        if not self.arranged:
            self._arrange()
        if self.room != self.stages:
            self._collocate()
        i: cython.int
        self.slip(theta, h)
        for i in range(self.stages):
            if not self.at_node(i):
                return 1e300
            self.push_modes(i)
        self.equations_of_modes(h)
        self.equations_of_slip(h)
        if not condense(self.whole, self.swapped):
            return 1e300
        return self.move(h)

    def slip(self, theta: float, h: float) -> None:
        """Fill the directions of slip, the right sides for s and the matrices of s at the nodes of a step."""
        a: cython.int
        c: cython.int
        i: cython.int
        j: cython.int
        r: float
        least: float = 0.0
        for a in range(self.slipping):
            c = self.sliders[a]
            for i in range(self.stages):
                at: float = theta + h * self.node[i]
                self.sequence.direction(self.sequence.panel(c, at, False), at)
                self.sequence.rates(c, at)
                e_x: float = self.sequence.e_x
                e_y: float = self.sequence.e_y
                x_1: float = h * self.sequence.x_1
                y_1: float = h * self.sequence.y_1
                across: float = e_x * y_1 - e_y * x_1
                push: float = max(e_x * x_1 + e_y * y_1 - h * self.sequence.r_1, 0.0)
                self.e_x[i, a], self.e_y[i, a], self.pressed[i, a] = e_x, e_y, push
                self.kept[i, a] = self.sequence.r
                self.sees[0, i, a, 0], self.sees[0, i, a, 1] = e_x, e_y
                self.sees[0, i, a, 2] = -self.ratio[a]
                self.sees[1, i, a, 0] = -push * e_y - across * e_x
                self.sees[1, i, a, 1] = push * e_x - across * e_y
                self.sees[1, i, a, 2] = across * self.ratio[a]
                least = max(least, 1e-12 * fabs(self.sequence.r))
        for a in range(self.slipping):
            fresh: cython.bint = self.fresh[self.sliders[a]] != 0
            for i in range(self.stages):
                r = max(self.kept[i, a], least)
                self.kept[i, a] = 0.0 if fresh else -r * self.slopes[i, 0]
                for j in range(self.stages):
                    self.relaxing[a, i, j] = r * (self.inner[i, j] if fresh else self.slopes[i, j + 1])
                self.relaxing[a, i, i] += self.pressed[i, a]

    def at_node(self, i: cython.int) -> cython.bint:
        """Fill `by` at a node; false if its equations are singular.

        Its rows are e . du - dr of slipping contacts, the right sides for s, and the forces on the modes, by
        (q, s, disturbances).
        """
        n: cython.int = self.slipping
        m: cython.int = self.modes
        a: cython.int
        b: cython.int
        j: cython.int
        row: cython.int
        by: cython.double[:, ::1] = self.by[i]
        of: cython.double[:, :, :, ::1] = self.of_slips
        seen: cython.double[:, :, ::1] = self.seen_by
        e_x: cython.double[::1] = self.e_x[i]
        e_y: cython.double[::1] = self.e_y[i]
        f: float
        g: float
        for row in range(2 * n):
            a = row % n
            x: float = self.sees[row // n, i, a, 0]
            y: float = self.sees[row // n, i, a, 1]
            z: float = self.sees[row // n, i, a, 2]
            for b in range(n):
                f = x * of[0, 0, a, b] + y * of[1, 0, a, b] + z * of[2, 0, a, b]
                g = x * of[0, 1, a, b] + y * of[1, 1, a, b] + z * of[2, 1, a, b]
                by[row, b] = -f * e_x[b] - g * e_y[b]
                by[row, n + m + b] = g * e_x[b] - f * e_y[b]
            for j in range(m):
                by[row, n + j] = x * seen[0, a, j] + y * seen[1, a, j] + z * seen[2, a, j]
            for j in range(m, m + self.columns):
                by[row, 2 * n + j] = x * seen[0, a, j] + y * seen[1, a, j] + z * seen[2, a, j]
        for a in range(n):
            by[a, a] += 1.0
        for a in range(m):
            row = 2 * n + a
            for b in range(n):
                f, g = self.pushes[0, a, b], self.pushes[1, a, b]
                by[row, b] = -f * e_x[b] - g * e_y[b]
                by[row, n + m + b] = g * e_x[b] - f * e_y[b]
            for j in range(m):
                by[row, n + j] = 0.0
            for j in range(self.columns):
                by[row, 2 * n + m + j] = self.held_push[a, j]
        return condense(by, self.swapped_slips)

    def push_modes(self, i: cython.int) -> None:
        """Add the force -K q on the modes to `by` at a node, and fill `force`, the part by q_0 and memory."""
        n: cython.int = self.slipping
        m: cython.int = self.modes
        a: cython.int
        b: cython.int
        j: cython.int
        part: float
        by: cython.double[:, ::1] = self.by[i]
        for a in range(m):
            for j in range(self.columns):
                self.force[i, a, j] = by[2 * n + a, 2 * n + m + j]
            for b in range(m):
                by[2 * n + a, n + b] -= self.K[a, b]
                part = by[2 * n + a, n + b]
                for j in range(self.columns):
                    self.force[i, a, j] += part * self.q[b, j]

    def equations_of_modes(self, h: float) -> None:
        """Fill the equations of the modes in `whole`.

        p + h A C p - h A (forces by q_0 + h A p, s, and disturbances) = p_0.
        """
        n: cython.int = self.slipping
        m: cython.int = self.modes
        s: cython.int = self.stages
        a: cython.int
        b: cython.int
        i: cython.int
        j: cython.int
        k: cython.int
        first: cython.int
        row: cython.Py_ssize_t
        part: float
        twice: float
        out: cython.double[:, ::1] = self.whole
        by: cython.double[:, :, ::1] = self.by
        for i in range(s):
            for a in range(m):
                row = i * m + a
                for j in range(s * m):
                    out[row, j] = 0.0
                for j in range(self.columns):
                    out[row, s * (m + n) + j] = self.p[a, j]
                for j in range(s):
                    part = h * self.butcher[i, j]
                    for k in range(s):
                        twice = part * h * self.butcher[j, k]
                        for b in range(m):
                            out[row, k * m + b] -= twice * by[j, 2 * n + a, n + b]
                    out[row, j * m + a] += part * self.C[a]
                    first = s * m + j * n
                    for b in range(n):
                        out[row, first + b] = -part * by[j, 2 * n + a, n + m + b]
                    for k in range(self.columns):
                        out[row, s * (m + n) + k] += part * self.force[j, a, k]
                out[row, row] += 1.0

    def equations_of_slip(self, h: float) -> None:
        """Fill the equations of slip in `whole`.

        relaxing s - (right side by h A p and s) = (right side by q_0, disturbances and s_0).
        """
        n: cython.int = self.slipping
        m: cython.int = self.modes
        s: cython.int = self.stages
        a: cython.int
        b: cython.int
        i: cython.int
        j: cython.int
        last: cython.Py_ssize_t = s * (m + n)
        row: cython.Py_ssize_t
        part: float
        out: cython.double[:, ::1] = self.whole
        by: cython.double[:, ::1]
        for i in range(s):
            by = self.by[i]
            for a in range(n):
                row = s * m + i * n + a
                for j in range(s):
                    part = h * self.butcher[i, j]
                    for b in range(m):
                        out[row, j * m + b] = -part * by[n + a, n + b]
                    for b in range(n):
                        out[row, s * m + j * n + b] = -by[n + a, n + m + b] if i == j else 0.0
                    out[row, s * m + j * n + a] += self.relaxing[a, i, j]
                for j in range(self.columns):
                    out[row, last + j] = by[n + a, 2 * n + m + j]
                    out[row, last + j] += self.kept[i, a] * self.memory[self.slips[a], 0, j]
                for b in range(m):
                    part = by[n + a, n + b]
                    for j in range(self.columns):
                        out[row, last + j] += part * self.q[b, j]

    def move(self, h: float) -> float:
        """Fill `q_new`, `p_new` at the end of the step; return its error.

        The error is the last coefficient of the velocities, relative to the disturbances.
        """
        m: cython.int = self.modes
        s: cython.int = self.stages
        first: cython.Py_ssize_t = s * (m + self.slipping)
        a: cython.int
        i: cython.int
        j: cython.int
        p: float
        most: float = 0.0
        out: cython.double[:, ::1] = self.whole
        for j in range(self.columns):
            scale: float = 1.0
            size: float = 0.0
            for a in range(m):
                scale = max(scale, fabs(self.q[a, j]), fabs(self.p[a, j]))
            for a in range(m):
                q: float = 0.0
                before: float = self.tail[0, 0] * self.p[a, j]
                last: float = self.tail[1, 0] * self.p[a, j]
                for i in range(s):
                    p = out[i * m + a, first + j]
                    q += self.butcher[s - 1, i] * p
                    before += self.tail[0, i + 1] * p
                    last += self.tail[1, i + 1] * p
                self.q_new[a, j], self.p_new[a, j] = self.q[a, j] + h * q, p
                size = max(size, fabs(last), self.coefficient_floor * fabs(before))
            most = max(most, size / scale)
        return most

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def accept(self) -> cython.int:
        """Advance the disturbances to the end of the step."""
        n: cython.int = self.slipping
        m: cython.int = self.modes
        a: cython.int
        b: cython.int
        c: cython.int
        i: cython.int
        j: cython.int
        part: float
        end: cython.Py_ssize_t = self.stages * (m + n)
        first: cython.Py_ssize_t = end - n  # of s at the end
        by: cython.double[:, ::1] = self.by[self.stages - 1]
        self.q, self.q_new = self.q_new, self.q
        self.p, self.p_new = self.p_new, self.p
        for a in range(n):
            c = self.slips[a]
            along: cython.double[::1] = self.g[c, 2]
            for j in range(self.columns):
                along[j] = by[a, 2 * n + m + j]
            for b in range(m):
                part = by[a, n + b]
                for j in range(self.columns):
                    along[j] += part * self.q[b, j]
            for b in range(n):
                part = by[a, n + m + b]
                for j in range(self.columns):
                    along[j] += part * self.whole[first + b, end + j]
            x: float = self.stiff[a] * self.e_x[self.stages - 1, a]
            y: float = self.stiff[a] * self.e_y[self.stages - 1, a]
            for j in range(self.columns):
                part = self.whole[first + a, end + j]
                self.memory[c, 0, j] = part
                self.g[c, 0, j], self.g[c, 1, j] = x * along[j] - y * part, y * along[j] + x * part
                along[j] = 0.0
        for i in range(self.contacts):
            self.fresh[i] = 0
        return 0

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def apply_event(self, c: cython.int, i: cython.int) -> cython.int:
        """Enter state i of a contact, and update what it remembers of the disturbances."""
        sequence, k = self.sequence, int(self.number[c])
        before, now, angle = int(self.state[c]), int(sequence.state[c, i]), float(sequence.begin[c, i])
        self.state[c], self.fresh[c] = now, now == SLIP and before == SEPARATION
        memory, g, ratio = np.asarray(self.memory), np.asarray(self.g), self.ratios[k]
        w, made = memory[k], np.zeros_like(memory[k])
        if self.arranged:  # several events at one angle see the displacements before them all
            self.g_before = g.reshape(-1, self.columns).copy()
        if {before, now} == {STICK, SLIP}:
            e = sequence.slip_at(c, np.array([angle]), now == STICK)[0, :2]
            aside = np.array([-e[1], e[0]])
        if now == STICK:
            ports = slice(3 * k, 3 * k + 3)
            du = self.seen[ports] @ np.asarray(self.q) + self.soft[ports] @ self.g_before
        if now == SLIP and before == STICK:
            made[0] = aside @ w
        elif now == STICK and before == SLIP:
            made = np.outer(e, e @ du[:2] - ratio * du[2]) + np.outer(aside, w[0])
        elif now == STICK:
            rate = sequence.slip_at(c, np.array([angle]))[0, 2:5]
            made = du[:2] - np.outer(rate[:2], ratio * du[2] / rate[2])
        memory[k] = made
        g[k, :2] = self.k_u[k] * made if now == STICK else 0.0
        self.arranged = False
        return 0


@cython.cclass
class RingPlanarMonodromy(PlanarMonodromy):
    """Monodromy of the contacts of all sectors of a ring, in a part of a period; see `PlanarMonodromy`.

    part is the angle that is followed. renumber (mode, mode) renumbers the sectors in the coordinates of the
    modes that are not far. source (contact,) is the contact whose memory takes the place of each contact's
    after the renumbering.
    """

    def __init__(
        self,
        modes: PortModes,
        sequence: PlanarSequence,
        part: float,
        renumber: FloatArray,
        source: npt.NDArray[np.intp],
        poll: Callable[[], object] = int,
    ) -> None:
        PlanarMonodromy.__init__(self, modes, sequence, poll)
        self.part, self.renumber, self.source = part, renumber, source

    def disturbances(self) -> FloatArray:
        """The present disturbances, rows (q, q', memory), with the sectors renumbered as at the beginning."""
        whose = self.number[self.source[self.moving]]
        kept = np.array([self.memory[whose[k], i] for k, i in self.remembered]).reshape(-1, self.columns)
        q, p = self.renumber @ np.asarray(self.q), self.renumber @ np.asarray(self.p)
        return np.concatenate((q, p, kept))


def _ports(contacts: npt.NDArray[np.intp], directions: int = 3) -> npt.NDArray[np.intp]:
    return (3 * contacts[:, None] + np.arange(directions)).ravel()
