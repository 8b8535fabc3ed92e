r"""The monodromy matrix of a motion whose contacts slide in a plane.

It is carried from event to event, in steps as long as polynomials resolve its velocities. Their degree is
that which reaches the next event at the least cost. What a step does, and an event, is for `PlanarMonodromy`
and `ManyPlanarMonodromy` to say.

The modes, of mass 1 and with shapes P on the ports, obey as on a line (see `monodromy`)

    q'' + 2 zeta w q' + w^2 q = - P dF

and the forces of a contact in its plane change with its displacements du (2,), dv and with what its slider
remembers. With r = mu n / k_u, dr = mu k_v dv / k_u and the direction of slip e = (cos alpha, sin alpha):

    stick        df = k_u (du - dw),                               dw constant
    slip         df = k_u (dr e + (e_perp . du - s) e_perp),       s = e_perp . dw,   e . dw = e . du - dr
                 r s' = lambda (e_perp . du - s) - (e_perp . u') (e . du - dr)
    separation   df = dn = 0

The equation of s is that of the direction, r alpha' = e_perp . u', linearised. Forces are continuous, so
events make nothing jump but what is remembered: as slip begins s = e_perp . dw, as it ends dw is put
together again; at a closing w = u where the load vanishes, so dw = du - u' dv / v' if it sticks. If it slips
at once nothing is remembered: of all solutions of the equation of s, whose factor r vanishes there, one is
regular. A slider that never slips stays where it is.

Between events the equations are collocated at Radau's points, as that of the direction is (see `Panel`), in
steps as long as polynomials resolve the velocities. The equation of s, with r before s', has no singular
point where the load vanishes. The answers of the modes to forces at the points, and of s to displacements,
are known beforehand. What is left are equations for the displacements of the closed contacts at the points of
a step, or of the modes where these are fewer. They are solved for all disturbances at once.
"""

from __future__ import annotations

import cython
import numpy as np
import numpy.typing as npt
from cython.cimports.libc.math import ceil, fabs

from fcm.contact.plane.radau import radau
from fcm.stability.following_modes import PortModes

if cython.compiled:
    from cython.cimports.fcm.contact.periodic.motion import TWO_PI
    from cython.cimports.fcm.contact.plane.slider import SEPARATION, SLIP, STICK
    from cython.cimports.fcm.stability.planar_sequence import PlanarSequence
else:
    from fcm.contact.periodic.motion import TWO_PI
    from fcm.contact.plane.slider import SEPARATION, SLIP, STICK
    from fcm.stability.planar_sequence import PlanarSequence


@cython.cclass
class VariationalSteps:
    """Steps of disturbances through a sequence of states of contacts in a plane.

    `follow` a sequence: `matrix` is then the derivative of (q, q', memory) after a period by that before.

    Velocities are by the angle.

    Attributes
    ----------
    steps
        How many the last period took.
    part
        The angle that is followed, a period.
    state, fresh, held : (contact,)
        The state of each contact now; whether it has just closed, and slips; and how many numbers it
        remembers at the beginning of the period.
    """

    def __init__(self, sequence: PlanarSequence, degrees: tuple[int, ...], tolerance: float) -> None:
        """degrees: the numbers of Radau points that a step may have; tolerance: of a step, see
        `PlanarStabilityOptions`."""
        options = sequence.options
        self.sequence, self.contacts, self.stages = sequence, sequence.contacts, max(degrees)
        self.degrees, self.longest = np.array(degrees, dtype=np.intc), np.zeros(len(degrees))
        self.tolerance, self.max_step, self.min_step = tolerance, options.max_step, options.min_step
        self.min_factor, self.max_factor, self.safety = options.min_factor, options.max_factor, options.safety
        self.end_factor, self.event_tolerance = options.end_factor, options.event_tolerance
        self.max_retry_factor, self.min_gap = options.max_retry_factor, options.min_gap
        most = self.contacts * sequence.capacity
        self.angle = np.zeros(most)
        self.whose, self.which, self.order = np.zeros((3, most), dtype=np.intc)
        self.state, self.fresh, self.held = np.zeros((3, self.contacts), dtype=np.intc)
        self.events = self.steps = self.first = 0
        self.part = TWO_PI
        self.filled = np.zeros((0, 0))

    def matrix(self) -> npt.NDArray[np.float64]:
        """The monodromy matrix, (2 modes + memories, the same).

        It is nan where there are more disturbances than the options allow.
        """
        found: npt.NDArray[np.float64] = self.filled
        return found

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def begin(self, omega: cython.double) -> cython.bint:
        """Set the frequency and the initial disturbances; false if these are too many."""
        raise NotImplementedError

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def step(self, theta: cython.double, h: cython.double) -> cython.double:
        """Take a step from an angle on; its error relative to a disturbance, infinity if singular."""
        raise NotImplementedError

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def accept(self) -> cython.int:
        """Take the end of the step for the present place of the disturbances."""
        raise NotImplementedError

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def apply_event(self, c: cython.int, i: cython.int) -> cython.int:
        """Let state i of a contact begin, and keep what it remembers of the disturbances."""
        raise NotImplementedError

    @cython.ccall
    def disturbances(self) -> npt.NDArray[np.float64]:
        """The present disturbances, rows (q, q', memory)."""
        raise NotImplementedError

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

        Where a slipping contact opens, s varies as a power of the angle that is left. Where it closes and
        slips at once, s has one coefficient less. The error of disturbances there is what polynomials leave
        out of that.
        """
        left: cython.double = length
        closed: cython.bint = False
        c: cython.int
        for c in range(self.contacts):
            closed = closed or self.fresh[c] != 0
        while left > 0.0:
            while True:
                i: cython.int = self.cheapest(left)
                self.stages = self.degrees[i]
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
            # a step that an event cuts short says nothing of a longer one
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
        """Which of the degrees takes an angle at the least cost: as a cube, by its longest step."""
        i: cython.int
        best: cython.int = 0
        least: cython.double = 0.0
        for i in range(self.longest.shape[0]):
            cost: cython.double = ceil(left / self.longest[i]) * self.degrees[i] ** 3
            if i == 0 or cost < least:
                best, least = i, cost
        return best


@cython.cclass
class PlanarMonodromy(VariationalSteps):
    """The monodromy of few contacts: with the displacements of those that are closed, or of the modes, as
    unknowns.

    Parameters
    ----------
    modes : PortModes
        With three ports for each contact.
    """

    def __init__(self, modes: PortModes, sequence: PlanarSequence) -> None:
        options = sequence.options
        VariationalSteps.__init__(self, sequence, (options.stages,), options.tolerance)
        self.coefficient_floor, self.max_disturbances = options.coefficient_floor, options.max_disturbances
        shapes, self.natural, self.damping = modes.near
        self.shapes, self.soft = np.ascontiguousarray(shapes), modes.flexibility
        m, c, s = len(self.natural), sequence.contacts, options.stages
        self.modes = m
        rule = radau(s)
        self.node, self.slopes, self.inner = rule.nodes, np.ascontiguousarray(rule.slopes[1:]), rule.inner
        self.butcher, self.tail = np.linalg.inv(rule.slopes[1:, 1:]), rule.tail
        # at the nodes of a step, of what modes do by themselves, by q and q'; and by forces at the nodes
        self.q_to, self.p_to = np.zeros((2, m, s, 2))
        self.q_by, self.p_by = np.zeros((2, m, s, s))
        self.rest_to, self.rest_by = np.zeros((2 * m, 2)), np.zeros((2 * m, s))
        self.system = np.zeros((s, 2 * s))
        # of the unknowns at the nodes, by the forces on closed contacts there; those of modes, and the rest
        self.answer, self.seen = np.zeros((s, 3 * c, s, 3 * c)), np.zeros((m, 3 * c))
        self.remote = bool(modes.far.any())
        # of s at the nodes: what it feels of displacements there, and what is kept of s at the start
        self.inverse, self.feels = np.zeros((c, s, s)), np.zeros((c, s, 3))
        self.kept, self.e_x, self.e_y = np.zeros((3, c, s))
        self.fore, self.aft = np.zeros((2, s))
        self.active = np.zeros(c, dtype=np.intc)
        self.actives = self.unknowns = 0
        self.modal = False
        self.taken = self.period = 0.0
        self._room(2 * m)

    def _room(self, columns: int) -> None:
        """Allocate arrays for a number of disturbances."""
        m, c, s = self.modes, self.contacts, self.stages
        self.columns = columns
        self.q, self.p, self.q_new, self.p_new = np.zeros((4, m, columns))
        self.memory, self.after = np.zeros((2, 2 * c, columns))
        self.force, self.du = np.zeros((3 * c, columns)), np.zeros((3, columns))
        self.stress = np.zeros((3 * c * s, columns))
        self.work = np.zeros((3 * c * s, 3 * c * s + columns))
        self.push, self.scale = np.zeros((m * s, columns)), np.zeros(columns)

    def disturbances(self) -> npt.NDArray[np.float64]:
        """The present disturbances, rows (q, q', memory)."""
        rows = [2 * c + i for c in range(self.contacts) for i in range(self.held[c])]
        return np.concatenate((self.q, self.p, np.asarray(self.memory)[rows]))

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def begin(self, omega: cython.double) -> cython.bint:
        """Set the frequency and the initial disturbances; false if these are too many."""
        c: cython.int
        i: cython.int
        j: cython.int
        self.period, self.taken = 1.0 / omega, -1.0
        columns: cython.int = 2 * self.modes
        for c in range(self.contacts):
            columns += self.held[c]
        if columns > self.max_disturbances:
            return False
        if columns != self.columns:
            self._room(columns)
        for i in range(self.modes):
            for j in range(columns):
                self.q[i, j], self.p[i, j] = float(i == j), float(self.modes + i == j)
        columns = 2 * self.modes
        for c in range(self.contacts):
            for i in range(2):
                for j in range(self.columns):
                    self.memory[2 * c + i, j] = 0.0
                if i < self.held[c]:
                    self.memory[2 * c + i, columns] = 1.0
                    columns += 1
        self.activate()
        return True

    def activate(self) -> None:
        """List the contacts that are closed, and forget what forces on these do."""
        c: cython.int
        i: cython.int
        m: cython.int
        self.actives = 0
        for c in range(self.contacts):
            if self.state[c] == SEPARATION:
                continue
            for m in range(self.modes):
                for i in range(3):
                    self.seen[m, 3 * self.actives + i] = self.shapes[m, 3 * c + i]
            self.active[self.actives] = c
            self.actives += 1
        # what modes far above add to displacements is of the contacts, not of the modes
        self.modal = not self.remote and self.modes < 3 * self.actives
        self.unknowns = self.modes if self.modal else 3 * self.actives
        self.taken = -1.0

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def apply_event(self, c: cython.int, i: cython.int) -> cython.int:
        """Let state i of a contact begin, and keep what it remembers of the disturbances."""
        j: cython.int
        x: cython.Py_ssize_t = 2 * c
        before: cython.int = self.state[c]
        now: cython.int = self.sequence.state[c, i]
        angle: float = self.sequence.begin[c, i]
        self.state[c], self.fresh[c] = now, now == SLIP and before == SEPARATION
        if (now == SLIP and before == STICK) or (now == STICK and before == SLIP):
            self.sequence.direction(self.sequence.panel(c, angle, now == STICK), angle)
        if now == STICK:
            self.displaced(c)
            self.sequence.rates(c, angle)
        e_x: float = self.sequence.e_x
        e_y: float = self.sequence.e_y
        ratio: float = self.contact_ratio(c)
        for j in range(self.columns):
            w_x: float = self.memory[x, j]
            w_y: float = self.memory[x + 1, j]
            v: float = self.du[2, j]
            if now == SLIP and before == STICK:
                w_x, w_y = e_x * w_y - e_y * w_x, 0.0
            elif now == STICK and before == SLIP:
                along: float = e_x * self.du[0, j] + e_y * self.du[1, j] - ratio * v
                w_x, w_y = along * e_x - w_x * e_y, along * e_y + w_x * e_x
            elif now == STICK:
                later: float = ratio * v / self.sequence.r_1
                w_x = self.du[0, j] - self.sequence.x_1 * later
                w_y = self.du[1, j] - self.sequence.y_1 * later
            else:
                w_x = w_y = 0.0
            self.memory[x, j], self.memory[x + 1, j] = w_x, w_y
        self.activate()
        return 0

    def displaced(self, c: cython.int) -> None:
        """Fill `du` with the displacements of a contact, which far modes share in."""
        d: cython.int
        i: cython.int
        j: cython.int
        by: float
        for d in range(3):
            for j in range(self.columns):
                self.du[d, j] = 0.0
            for i in range(self.modes):
                by = self.shapes[i, 3 * c + d]
                for j in range(self.columns):
                    self.du[d, j] += by * self.q[i, j]
            for i in range(3 * self.contacts):
                by = self.soft[3 * c + d, i]
                if by != 0.0:
                    for j in range(self.columns):
                        self.du[d, j] -= by * self.force[i, j]

    def contact_ratio(self, c: cython.int) -> float:
        """Ratio mu k_v / k_u: derivative of the radius by the normal displacement."""
        k_u: float = self.sequence.contact[c, 1]
        ratio: float = self.sequence.contact[c, 0] * self.sequence.contact[c, 2] / k_u if k_u > 0.0 else 0.0
        return ratio

    def prepare(self, h: float) -> None:
        """Compute the answers of modes and closed contacts to forces at the nodes of a step."""
        m: cython.int
        if h == self.taken:
            return
        for m in range(self.modes):
            self.respond(m, h)
        self.couple()
        self.taken = h

    def respond(self, m: cython.int, h: float) -> None:
        """Compute the answer of one mode to forces f at the nodes of a step.

        q = q_to (q_0, p_0) + q_by f, and p likewise, from q = q_0 + h A p, p = p_0 + h A p'.

        With p' = -w^2 q - 2 zeta w p + f: (1 + 2 zeta w h A + w^2 h^2 A^2) p = p_0 - w^2 h A q_0 + h A f.
        """
        s: cython.int = self.stages
        i: cython.int
        j: cython.int
        k: cython.int
        part: float
        square: float = self.natural[m] * self.period * h
        damp: float = 2.0 * self.damping[m] * square
        square *= square
        for i in range(s):
            for j in range(s):
                part = 0.0
                for k in range(s):
                    part += self.butcher[i, k] * self.butcher[k, j]
                self.system[i, j] = square * part + damp * self.butcher[i, j] + float(i == j)
                self.system[i, s + j] = self.butcher[i, j]
        # of a rule's matrix and positive numbers no pivot vanishes
        for k in range(s):
            for i in range(s):
                if i == k:
                    continue
                part = self.system[i, k] / self.system[k, k]
                for j in range(k + 1, 2 * s):
                    self.system[i, j] -= part * self.system[k, j]
        for k in range(s):
            part = 1.0 / self.system[k, k]
            for j in range(s):
                self.p_by[m, k, j] = h * part * self.system[k, s + j]
        square /= h * h
        damp /= h
        for i in range(s):
            once: float = 0.0
            twice: float = 0.0
            for j in range(s):
                part = 0.0
                for k in range(s):
                    part += self.butcher[i, k] * self.p_by[m, k, j]
                self.q_by[m, i, j] = h * part
                once += self.p_by[m, i, j]
                twice += h * part
            self.q_to[m, i, 0], self.q_to[m, i, 1] = 1.0 - square * twice, once
            self.p_to[m, i, 0], self.p_to[m, i, 1] = -square * once, 1.0 - damp * once - square * twice
        for i in range(2):
            for j in range(2):
                part = self.tail[i, 0] if j == 1 else 0.0
                for k in range(s):
                    part += self.tail[i, k + 1] * self.p_to[m, k, j]
                self.rest_to[2 * m + i, j] = part
            for j in range(s):
                part = 0.0
                for k in range(s):
                    part += self.tail[i, k + 1] * self.p_by[m, k, j]
                self.rest_by[2 * m + i, j] = part

    def couple(self) -> None:
        """Compute the answers of the unknowns to forces on closed contacts, by near and far modes."""
        s: cython.int = self.stages
        ports: cython.int = 3 * self.actives
        i: cython.int
        j: cython.int
        a: cython.int
        b: cython.int
        m: cython.int
        part: float
        for i in range(s):
            for a in range(self.unknowns):
                for j in range(s):
                    part = -self.period * self.period * self.q_by[a, i, j] if self.modal else 0.0
                    for b in range(ports):
                        self.answer[i, a, j, b] = part * self.seen[a, b] if self.modal else 0.0
        if self.modal:
            return
        for a in range(ports):
            for b in range(ports):
                part = self.soft[3 * self.active[a // 3] + a % 3, 3 * self.active[b // 3] + b % 3]
                for i in range(s):
                    self.answer[i, a, i, b] = -part
        for m in range(self.modes):
            for i in range(s):
                for a in range(ports):
                    for j in range(s):
                        part = -self.period * self.period * self.q_by[m, i, j] * self.seen[m, a]
                        for b in range(ports):
                            self.answer[i, a, j, b] += part * self.seen[m, b]

    def slip(self, c: cython.int, theta: float, h: float) -> None:
        """Compute s of a contact that slips at the nodes of a step.

        s = inverse (feels . (du, dv)) + kept s_0.

        As it closes, no s_0: the polynomial has the nodes only.
        """
        s: cython.int = self.stages
        i: cython.int
        j: cython.int
        k: cython.int
        part: float
        ratio: float = self.contact_ratio(c)
        for i in range(s):
            at: float = theta + h * self.node[i]
            self.sequence.direction(self.sequence.panel(c, at, False), at)
            self.sequence.rates(c, at)
            e_x: float = self.sequence.e_x
            e_y: float = self.sequence.e_y
            r: float = max(self.sequence.r, 1e-12 * self.sequence.mean[c])
            x_1: float = h * self.sequence.x_1
            y_1: float = h * self.sequence.y_1
            across: float = e_x * y_1 - e_y * x_1
            push: float = max(e_x * x_1 + e_y * y_1 - h * self.sequence.r_1, 0.0)
            self.e_x[c, i], self.e_y[c, i] = e_x, e_y
            self.feels[c, i, 0] = -push * e_y - across * e_x
            self.feels[c, i, 1] = push * e_x - across * e_y
            self.feels[c, i, 2] = across * ratio
            for j in range(s):
                self.system[i, j] = r * (self.inner[i, j] if self.fresh[c] else self.slopes[i, j + 1])
                self.system[i, s + j] = float(i == j)
            self.system[i, i] += push
            self.kept[c, i] = 0.0 if self.fresh[c] else -r * self.slopes[i, 0]
        for k in range(s):
            for i in range(s):
                if i == k:
                    continue
                part = self.system[i, k] / self.system[k, k]
                for j in range(k + 1, s + k + 1):
                    self.system[i, j] -= part * self.system[k, j]
        for i in range(s):
            self.fore[i] = self.kept[c, i]
        for i in range(s):
            part = 1.0 / self.system[i, i]
            self.kept[c, i] = 0.0
            for j in range(s):
                self.inverse[c, i, j] = part * self.system[i, s + j]
                self.kept[c, i] += self.inverse[c, i, j] * self.fore[j]

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def step(self, theta: cython.double, h: cython.double) -> cython.double:
        """Take one step from an angle on, in `q_new`, `p_new` and `work`; its error, as `rest`."""
        a: cython.int
        self.prepare(h)
        for a in range(self.actives):
            if self.state[self.active[a]] == SLIP:
                self.slip(self.active[a], theta, h)
        self.unforced()
        for a in range(self.actives):
            self.assemble(a)
        if not self.solve(self.unknowns * self.stages):
            return 1e300
        self.move()
        return self.rest()

    def unforced(self) -> None:
        """Fill `work` with the unit matrix, and the unknowns as the modes go on without forces."""
        size: cython.int = self.unknowns * self.stages
        i: cython.int
        j: cython.int
        a: cython.int
        m: cython.int
        row: cython.Py_ssize_t
        by: float
        on: float
        for i in range(self.stages):
            for a in range(self.unknowns):
                row = i * self.unknowns + a
                for j in range(size + self.columns):
                    self.work[row, j] = 0.0
                self.work[row, row] = 1.0
                for m in range(self.modes):
                    if self.modal and m != a:
                        continue
                    by = 1.0 if self.modal else self.seen[m, a]
                    by, on = by * self.q_to[m, i, 0], by * self.q_to[m, i, 1]
                    for j in range(self.columns):
                        self.work[row, size + j] += by * self.q[m, j] + on * self.p[m, j]

    def assemble(self, a: cython.int) -> None:
        """Subtract the effect of a closed contact's forces from `work`."""
        s: cython.int = self.stages
        c: cython.int = self.active[a]
        state: cython.int = self.state[c]
        x: cython.Py_ssize_t = 3 * a
        i: cython.int
        j: cython.int
        k: cython.int
        b: cython.int
        row: cython.Py_ssize_t
        size: cython.Py_ssize_t = self.unknowns * s
        k_u: float = self.sequence.contact[c, 1]
        k_v: float = self.sequence.contact[c, 2]
        ratio: float = self.contact_ratio(c)
        own: float
        other: float
        part: float
        for i in range(s):
            for b in range(self.unknowns):
                row = i * self.unknowns + b
                own = 0.0
                other = 0.0
                if state == SLIP:
                    for j in range(s):
                        self.aft[j] = k_u * (
                            self.answer[i, b, j, x + 1] * self.e_x[c, j]
                            - self.answer[i, b, j, x] * self.e_y[c, j]
                        )
                        own += self.aft[j] * self.kept[c, j]
                for k in range(s):
                    by_x: float = k_u * self.answer[i, b, k, x]
                    by_y: float = k_u * self.answer[i, b, k, x + 1]
                    by_v: float = k_v * self.answer[i, b, k, x + 2]
                    if state == SLIP:
                        part = 0.0
                        for j in range(s):
                            part += self.aft[j] * self.inverse[c, j, k]
                        by_v += ratio * (by_x * self.e_x[c, k] + by_y * self.e_y[c, k])
                        by_v -= part * self.feels[c, k, 2]
                        by_x = -self.aft[k] * self.e_y[c, k] - part * self.feels[c, k, 0]
                        by_y = self.aft[k] * self.e_x[c, k] - part * self.feels[c, k, 1]
                    elif state == STICK:
                        own += by_x
                        other += by_y
                    else:
                        by_x = by_y = 0.0
                    if self.modal:
                        for j in range(self.unknowns):
                            self.work[row, k * self.unknowns + j] -= (
                                by_x * self.seen[j, x]
                                + by_y * self.seen[j, x + 1]
                                + by_v * self.seen[j, x + 2]
                            )
                    else:
                        self.work[row, k * self.unknowns + x] -= by_x
                        self.work[row, k * self.unknowns + x + 1] -= by_y
                        self.work[row, k * self.unknowns + x + 2] -= by_v
                for j in range(self.columns):
                    self.work[row, size + j] -= (
                        own * self.memory[2 * c, j] + other * self.memory[2 * c + 1, j]
                    )

    def solve(self, size: cython.int) -> bool:
        """Replace the right side of `work` by the solution: Gaussian elimination, pivots along columns."""
        i: cython.int
        j: cython.int
        k: cython.int
        p: cython.int
        by: float
        width: cython.int = size + self.columns
        for k in range(size):
            p = k
            for i in range(k + 1, size):
                if fabs(self.work[i, k]) > fabs(self.work[p, k]):
                    p = i
            if not 1e-300 < fabs(self.work[p, k]) < 1e300:
                return False
            if p != k:
                for j in range(k, width):
                    self.work[k, j], self.work[p, j] = self.work[p, j], self.work[k, j]
            for i in range(k + 1, size):
                by = self.work[i, k] / self.work[k, k]
                if by != 0.0:
                    for j in range(k + 1, width):
                        self.work[i, j] -= by * self.work[k, j]
        for k in range(size - 1, -1, -1):
            by = 1.0 / self.work[k, k]
            for j in range(size, width):
                self.work[k, j] *= by
            for i in range(k):
                by = self.work[i, k]
                for j in range(size, width):
                    self.work[i, j] -= by * self.work[k, j]
        return True

    def move(self) -> None:
        """Fill the forces at the nodes, and `q_new`, `p_new` at the end of the step.

        `stress`: the forces; `push`: these on the modes.
        """
        s: cython.int = self.stages
        ports: cython.int = 3 * self.actives
        a: cython.int
        i: cython.int
        j: cython.int
        m: cython.int
        by: float
        on: float
        self.displace()
        for a in range(self.actives):
            self.strain(a)
        for i in range(s):
            for m in range(self.modes):
                for j in range(self.columns):
                    self.push[i * self.modes + m, j] = 0.0
                for a in range(ports):
                    by = -self.period * self.period * self.seen[m, a]
                    for j in range(self.columns):
                        self.push[i * self.modes + m, j] += by * self.stress[i * ports + a, j]
        for m in range(self.modes):
            for j in range(self.columns):
                self.q_new[m, j] = (
                    self.q_to[m, s - 1, 0] * self.q[m, j] + self.q_to[m, s - 1, 1] * self.p[m, j]
                )
                self.p_new[m, j] = (
                    self.p_to[m, s - 1, 0] * self.q[m, j] + self.p_to[m, s - 1, 1] * self.p[m, j]
                )
            for i in range(s):
                by, on = self.q_by[m, s - 1, i], self.p_by[m, s - 1, i]
                for j in range(self.columns):
                    self.q_new[m, j] += by * self.push[i * self.modes + m, j]
                    self.p_new[m, j] += on * self.push[i * self.modes + m, j]

    def displace(self) -> None:
        """Fill `stress` with the displacements of closed contacts at the nodes."""
        ports: cython.int = 3 * self.actives
        size: cython.Py_ssize_t = self.unknowns * self.stages
        a: cython.int
        i: cython.int
        j: cython.int
        m: cython.int
        row: cython.Py_ssize_t
        by: float
        for i in range(self.stages):
            for a in range(ports):
                row = i * ports + a
                if not self.modal:
                    for j in range(self.columns):
                        self.stress[row, j] = self.work[row, size + j]
                    continue
                for j in range(self.columns):
                    self.stress[row, j] = 0.0
                for m in range(self.modes):
                    by = self.seen[m, a]
                    for j in range(self.columns):
                        self.stress[row, j] += by * self.work[i * self.modes + m, size + j]

    def strain(self, a: cython.int) -> None:
        """Replace the displacements of a closed contact by its forces, and fill its memory at the end."""
        s: cython.int = self.stages
        c: cython.int = self.active[a]
        state: cython.int = self.state[c]
        ports: cython.int = 3 * self.actives
        i: cython.int
        j: cython.int
        k: cython.int
        x: cython.Py_ssize_t
        k_u: float = self.sequence.contact[c, 1]
        k_v: float = self.sequence.contact[c, 2]
        ratio: float = self.contact_ratio(c)
        for j in range(self.columns):
            known: float = self.memory[2 * c, j]
            other: float = self.memory[2 * c + 1, j]
            if state == SLIP:
                for i in range(s):
                    x = i * ports + 3 * a
                    self.fore[i] = self.feels[c, i, 0] * self.stress[x, j]
                    self.fore[i] += self.feels[c, i, 1] * self.stress[x + 1, j]
                    self.fore[i] += self.feels[c, i, 2] * self.stress[x + 2, j]
                for i in range(s):
                    self.aft[i] = self.kept[c, i] * known
                    for k in range(s):
                        self.aft[i] += self.inverse[c, i, k] * self.fore[k]
                self.after[2 * c, j] = self.aft[s - 1]
            for i in range(s):
                x = i * ports + 3 * a
                u_x: float = self.stress[x, j]
                u_y: float = self.stress[x + 1, j]
                v: float = self.stress[x + 2, j]
                if state == SLIP:
                    e_x: float = self.e_x[c, i]
                    e_y: float = self.e_y[c, i]
                    across: float = e_x * u_y - e_y * u_x - self.aft[i]
                    u_x, u_y = ratio * v * e_x - across * e_y, ratio * v * e_y + across * e_x
                elif state == STICK:
                    u_x, u_y = u_x - known, u_y - other
                else:
                    u_x = u_y = 0.0
                self.stress[x, j], self.stress[x + 1, j], self.stress[x + 2, j] = (
                    k_u * u_x,
                    k_u * u_y,
                    k_v * v,
                )

    def rest(self) -> float:
        """Error of a step: the last coefficient of the velocities, relative to a disturbance.

        See `Panel.rest`.
        """
        i: cython.int
        j: cython.int
        k: cython.int
        m: cython.int
        most: float = 0.0
        value: float
        for j in range(self.columns):
            self.scale[j] = 1.0
        for m in range(self.modes):
            for j in range(self.columns):
                self.scale[j] = max(self.scale[j], fabs(self.q[m, j]), fabs(self.p[m, j]))
        for m in range(self.modes):
            for i in range(2):
                for j in range(self.columns):
                    value = self.rest_to[2 * m + i, 0] * self.q[m, j]
                    value += self.rest_to[2 * m + i, 1] * self.p[m, j]
                    for k in range(self.stages):
                        value += self.rest_by[2 * m + i, k] * self.push[k * self.modes + m, j]
                    value = fabs(value) if i == 1 else self.coefficient_floor * fabs(value)
                    most = max(most, value / self.scale[j])
        return most

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def accept(self) -> cython.int:
        """Take the end of the step for the present place of the disturbances."""
        a: cython.int
        c: cython.int
        i: cython.int
        j: cython.int
        ports: cython.int = 3 * self.actives
        last: cython.Py_ssize_t = ports * (self.stages - 1)
        self.q, self.q_new = self.q_new, self.q
        self.p, self.p_new = self.p_new, self.p
        for i in range(3 * self.contacts):
            for j in range(self.columns):
                self.force[i, j] = 0.0
        for a in range(self.actives):
            c = self.active[a]
            for i in range(3):
                for j in range(self.columns):
                    self.force[3 * c + i, j] = self.stress[last + 3 * a + i, j]
            if self.state[c] == SLIP:
                self.fresh[c] = 0
                for j in range(self.columns):
                    self.memory[2 * c, j] = self.after[2 * c, j]
        return 0


@cython.cclass
class RingPlanarMonodromy(PlanarMonodromy):
    """Monodromy of the contacts of all sectors of a ring, in a part of a period; see `PlanarMonodromy`.

    part is the angle that is followed; renumber (mode, mode) renumbers the sectors in the coordinates of
    modes that are not far, and source (contact,) is the contact whose memory has the place of each
    afterwards.
    """

    def __init__(
        self,
        modes: PortModes,
        sequence: PlanarSequence,
        part: float,
        renumber: npt.NDArray[np.float64],
        source: npt.NDArray[np.intp],
    ) -> None:
        PlanarMonodromy.__init__(self, modes, sequence)
        self.part, self.renumber, self.source = part, renumber, source

    def disturbances(self) -> npt.NDArray[np.float64]:
        """The present disturbances, rows (q, q', memory), as the sectors are numbered at the beginning."""
        rows = [2 * self.source[c] + i for c in range(self.contacts) for i in range(self.held[c])]
        q, p = self.renumber @ np.asarray(self.q), self.renumber @ np.asarray(self.p)
        return np.concatenate((q, p, np.asarray(self.memory)[rows]))
