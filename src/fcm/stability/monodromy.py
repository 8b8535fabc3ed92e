r"""The monodromy matrix, which maps a small disturbance of a periodic motion to that after one period.

If the contacts' states over the period are known, a disturbance obeys linear equations whose coefficients are
constant between events. With modes of mass 1 and shapes P_u, P_v at the contacts,

    q_i'' + 2 zeta_i w_i q_i' + w_i^2 q_i = - sum over the contacts (P_u df + P_v dn)

    stick       df = k_u (du - dw), dn = k_v dv      dw constant: where the slider came to rest
    slip        df = +-mu k_v dv,   dn = k_v dv
    separation  df = dn = 0

The forces are continuous, so q and q' do not jump at events. The instants of events matter only where they
decide what the slider remembers. At the end of a slip the limit is at its extreme, so
dw = du -+ mu k_v dv / k_u. At a closing w = u where the load vanishes, so dw = du - u' dv / v'.

In a ring, let the motion repeat after n sectors and no fewer. After the angle 2 pi / n each sector repeats
what the one j sectors ahead did before. With the sectors counted from j behind, the disturbances of the
travelling wave then obey the same equations again. The n-th power of that map is the monodromy matrix, so
only an n-th of the period is followed (`RingMonodromy`).

With many contacts (`ManyMonodromy`) a period has many events, and each changes the state of one contact. The
contacts' part of the matrices is therefore not assembled anew for every state, but updated by a matrix of
rank two. The modes far above the excitation, f, follow without delay: they are a flexibility
S = P_f^T W_f^-2 P_f between the ports. With modes of mass 1, shapes P on the ports and the contacts'
stiffness D (port, port) of a state, the displacements d of the ports under forces phi = k_u w of the resting
sliders are

    q'' + C q' + K q = V phi,   d = U q + G phi,
    U = (1 + S D)^-1 P^T,   G = (1 + S D)^-1 S,   V = P (1 + D S)^-1,   K = W^2 + P D U

If a contact's stiffness changes by s (2, 2) between its two ports, c, then G, U, V and K change (Sherman,
Morrison, Woodbury), with e = (1 + s G_cc)^-1 s, by

    -G_c e G^c,    -G_c e U^c,    -V_c e G^c,    V_c e U^c

where _c are the columns and ^c the rows of its ports. Together they are one matrix [[-K, V], [U, G]], which
changes by a product of its columns and rows. The sliders' force on the modes, V phi, changes only along V_c,
too. Contacts that keep their state through the period have no ports. The updates start from the state where
every contact sticks, which is assembled once.

If there are fewer far modes than these ports, they replace the ports (`by_modes`). Then, with
K_ab = W_ab^2 + P_a D P_b^T, B = K_ff^-1 and p_f = P_f phi,

    d = P^T q + P_f^T q_f,   q_f = B (p_f - K_fm q)
    [[-K, V], [U, G]] = [[-(K_mm - K_mf B K_fm), -K_mf B], [-B K_fm, B]]

and the contact's shapes on the modes m and f give the rows and columns by which that matrix changes.

The period begins after the event at which the fewest sliders rest, so that the fewest disturbances are
followed.
"""

from __future__ import annotations

import cython
import numpy as np
import numpy.typing as npt
from cython.cimports.libc.math import ceil, fabs, sqrt

from fcm.distinct_values import distinct_values
from fcm.stability.disturbance import Propagator
from fcm.stability.options import STABILITY, PropagationOptions
from fcm.stability.quasi_static_modes import PortModes

if cython.compiled:
    from cython.cimports.fcm.contact.periodic.cycle import NEGATIVE, POSITIVE, SEPARATION, STICK
    from cython.cimports.fcm.contact.periodic.motion import TWO_PI
    from cython.cimports.fcm.harmonic_balance.modal_equations import sum_of_rows
    from cython.cimports.fcm.stability.disturbance import Disturbances, Stiffness
    from cython.cimports.fcm.stability.monodromy import add_term, add_two_products
    from cython.cimports.fcm.stability.state_sequence import StateSequence
else:
    from fcm.contact.periodic.cycle import NEGATIVE, POSITIVE, SEPARATION, STICK
    from fcm.contact.periodic.motion import TWO_PI
    from fcm.harmonic_balance.modal_equations import sum_of_rows
    from fcm.stability.disturbance import Disturbances, Stiffness
    from fcm.stability.state_sequence import StateSequence


LANES = 8  # numbers in the widest registers; arrays have a multiple of as many columns


@cython.cclass
class Monodromy(Disturbances):
    """Monodromy of few contacts on a line.

    After `follow`, `matrix` is the derivative of (q, q', w) after a period by that before. Velocities are by
    the angle. The period begins before event number `first` of the sequence's order. memory (contact,):
    whether a slider's place is a disturbance there.
    """

    def __init__(
        self, stiffness: Stiffness, sequence: StateSequence, propagator: Propagator | None = None
    ) -> None:
        Disturbances.__init__(self, stiffness, propagator or Propagator())
        self.sequence = sequence
        self.port, self.first = np.zeros((2, self.size)), 0
        self.memory = np.zeros(self.contacts, dtype=np.intc)

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def follow(self, omega: cython.double) -> cython.int:
        """Compute the monodromy of the sequence of states at a frequency."""
        s: StateSequence = self.sequence
        i: cython.int
        e: cython.int
        length: cython.double
        self.stiffness.at(omega)
        self.begin()
        if s.events == 0:
            self.propagate(TWO_PI)
        for i in range(s.events):
            e = s.order[i]
            self.apply_event(e)
            if i + 1 < s.events:
                length = s.angle[s.order[i + 1]] - s.angle[e]
            else:
                length = s.angle[s.order[0]] + TWO_PI - s.angle[e]
            self.assemble()
            if length > 0.0:
                self.propagate(length)
        return 0

    def matrix(self) -> npt.NDArray[np.float64]:
        """The monodromy matrix, square, of 2 modes + memories rows.

        Only contacts that stick when the period begins have a memory.
        """
        c: cython.int
        i: cython.Py_ssize_t
        j: cython.Py_ssize_t
        row: cython.Py_ssize_t = 2 * self.modes
        columns: cython.Py_ssize_t = row + self.memories
        made = np.empty((columns, columns))
        out: cython.double[:, ::1] = made
        for j in range(row):
            for i in range(columns):
                out[j, i] = self.X[j, i]
        for c in range(self.contacts):
            if self.memory[c]:
                for i in range(columns):
                    out[row, i] = self.X[2 * self.modes + c, i]
                row += 1
        return made

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def begin(self) -> cython.int:
        """Set the initial disturbances, and the states before the first event."""
        s: StateSequence = self.sequence
        i: cython.int
        j: cython.int
        c: cython.int
        self.memories = 0
        for c in range(self.contacts):
            self.state[c], self.memory[c] = s.state[c], s.remembers[c]
        for i in range(self.first):
            c = s.whose[s.order[i]]
            self.state[c] = s.into[s.order[i]]
            self.memory[c] = self.state[c] == STICK
        for i in range(self.X.shape[0]):
            for j in range(self.X.shape[1]):
                self.X[i, j] = 1.0 if i == j and i < 2 * self.modes else 0.0
        for c in range(self.contacts):
            if self.memory[c]:
                self.X[2 * self.modes + c, 2 * self.modes + self.memories] = 1.0
                self.memories += 1
        return self.assemble()

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def apply_event(self, e: cython.int) -> cython.int:
        """Pass an event: set what the slider remembers of the disturbance, and the new state."""
        c: cython.int = self.sequence.whose[e]
        k: cython.Py_ssize_t
        row: cython.Py_ssize_t = 2 * self.modes + c
        mu: cython.double = self.stiffness.contact[c, 0]
        k_u: cython.double = self.stiffness.contact[c, 1]
        k_v: cython.double = self.stiffness.contact[c, 2]
        if self.sequence.into[e] == STICK:
            self.stiffness.displacement(2 * c, self.X, self.port[0])
            self.stiffness.displacement(2 * c + 1, self.X, self.port[1])
            weight: cython.double = self.sequence.along[e] * mu * k_v / k_u
            for k in range(self.size):
                self.X[row, k] = self.port[0, k] + weight * self.port[1, k]
        else:
            for k in range(self.size):
                self.X[row, k] = 0.0
        self.state[c] = self.sequence.into[e]
        return 0


class BySeries(Propagator):
    """A propagator that never propagates, so that the series is used instead.

    The series is faster through the short angles of a part of a period.
    """

    def through(self, *_: object) -> bool:
        """Whether the disturbances were propagated: never."""
        return False


@cython.cclass
class RingMonodromy(Monodromy):
    """Monodromy of the contacts of all sectors of a ring, see `Monodromy`.

    part is the angle that is followed. renumber (mode, mode) renumbers the sectors in modal coordinates.
    source (contact,) is the contact whose slider takes the place of each contact's after the renumbering.
    """

    def __init__(
        self,
        stiffness: Stiffness,
        sequence: StateSequence,
        part: cython.double,
        renumber: npt.NDArray[np.float64],
        source: npt.NDArray[np.intp],
    ) -> None:
        Monodromy.__init__(self, stiffness, sequence, BySeries())
        self.part, self.renumber, self.source = part, renumber, source
        self.start = 0.0

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def follow(self, omega: cython.double) -> cython.int:
        """Compute the monodromy of the sequence of states at a frequency."""
        s: StateSequence = self.sequence
        i: cython.int
        e: cython.int
        self.stiffness.at(omega)
        self.widest()
        self.begin()
        now: cython.double = self.start
        end: cython.double = self.start + self.part
        for i in range(s.events):
            e = s.order[(self.first + i) % s.events]
            angle: cython.double = s.angle[e] + (TWO_PI if self.first + i >= s.events else 0.0)
            if angle >= end:
                break
            if angle > now:
                self.propagate(angle - now)
                now = angle
            self.apply_event(e)
            self.assemble()
        self.propagate(end - now)
        return 0

    @cython.cfunc
    @cython.exceptval(check=False)
    def widest(self) -> cython.void:
        """Start the period in the middle of the widest gap between events, so that none is at its ends."""
        s: StateSequence = self.sequence
        i: cython.int
        widest: cython.double = -1.0
        self.first, self.start = 0, 0.0
        for i in range(s.events):
            before: cython.double = (
                s.angle[s.order[i - 1]] if i > 0 else s.angle[s.order[s.events - 1]] - TWO_PI
            )
            gap: cython.double = s.angle[s.order[i]] - before
            if gap > widest:
                widest, self.first, self.start = gap, i, before + 0.5 * gap

    def matrix(self) -> npt.NDArray[np.float64]:
        """The matrix of the followed part of a period, square, of 2 modes + memories rows.

        Only contacts that stick at the start have a memory.
        """
        m: cython.Py_ssize_t = self.modes
        columns: cython.Py_ssize_t = 2 * m + self.memories
        X = np.asarray(self.X)[:, :columns]
        memory = np.flatnonzero(np.asarray(self.memory))
        sliders = X[2 * m + np.asarray(self.source)[memory]]
        return np.concatenate((self.renumber @ X[:m], self.renumber @ X[m : 2 * m], sliders))


@cython.cfunc
@cython.exceptval(check=False)
def add_products(
    matrix: cython.double[:, ::1],
    p: cython.double[::1],
    x: cython.double[::1],
    q: cython.double[::1],
    y: cython.double[::1],
) -> cython.void:
    """Add p x^T + q y^T to a matrix (row, column)."""
    if not cython.compiled:
        np.add(matrix, np.outer(p, x[: matrix.shape[1]]) + np.outer(q, y[: matrix.shape[1]]), out=matrix)
    elif matrix.shape[0] > 0:
        add_two_products(
            cython.address(matrix[0, 0]), cython.address(p[0]), cython.address(x[0]),
            cython.address(q[0]), cython.address(y[0]), matrix.shape[0], matrix.shape[1],
        )  # fmt: skip


@cython.cclass
class ManyMonodromy:
    """Monodromy of many contacts on a line.

    After `follow`, `matrix` is the derivative of (q, q', w) after a period by that before. Velocities are by
    the angle. w are the places of moving contacts that stick when the period begins.

    Parameters
    ----------
    modes : PortModes
        With two ports for each contact.
    contact : (contact, 4)
        mu, k_u, k_v, n_0.
    """

    def __init__(
        self,
        modes: PortModes,
        contact: npt.NDArray[np.float64],
        sequence: StateSequence,
        options: PropagationOptions = STABILITY.propagation,
    ) -> None:
        self.step_radians, self.series_tolerance = options.step_radians_of_many, options.series_tolerance
        self.shapes, self.natural, self.ratio = modes.near
        self.modes, self.contacts = len(self.shapes), contact.shape[0]
        self.contact, self.sequence = np.ascontiguousarray(contact), sequence
        self.following, self.stiff = modes.shapes[modes.far], modes.natural[modes.far]
        self.static = modes.flexibility
        self.all_stuck: npt.NDArray[np.float64] | None = None
        self.soft, self.by_modes = bool(modes.far.any()), False
        self.K = np.zeros((self.modes, self.modes))
        self.damping, self.state = np.zeros(self.modes), np.zeros(self.contacts, dtype=np.intc)
        self.first, self.rate, self.omega = 0, 1.0, 1.0
        self.number = np.zeros(self.contacts, dtype=np.intc)  # among the contacts that move
        self.remembering: list[int] = []
        self.allocate(2 * self.modes, 0)

    def with_springs(self) -> npt.NDArray[np.float64]:
        """The matrix [[-K, V], [U, G]] of modes, tangential ports and normal ports, if all contacts stick."""
        order, m = _by_direction(np.arange(self.contacts)), self.modes
        k_u, k_v = np.asarray(self.contact).T[1:3]
        springs, P = np.concatenate((k_u, k_v)), self.shapes[:, order]
        S = self.static[np.ix_(order, order)]
        R = np.eye(len(S)) + S * springs
        found = np.asarray(np.linalg.solve(R, np.concatenate((P.T, S), axis=1)), dtype=np.float64)
        K = np.diag(self.natural**2) + (P * springs) @ found[:, :m]
        return np.block([[-K, found[:, :m].T], [found]])

    def allocate(self, columns: int, moving: int) -> None:
        """Allocate arrays for numbers of disturbances (columns) and of contacts that move."""
        self.columns, self.moving, wide = columns, moving, -(-columns // LANES) * LANES
        self.by_modes = self.soft and len(self.following) < moving
        self.q, self.v, self.tq, self.tv, self.work, self.g = np.zeros((6, self.modes, wide))
        follow = len(self.following) if self.by_modes else 2 * moving if self.soft else 0
        self.pushing = follow if self.by_modes else moving
        self.w, self.phi = np.zeros((self.contacts, wide)), np.zeros((self.pushing, wide))
        self.port, self.followed, self.row = np.zeros((3, 2, wide))
        self.push = np.zeros(wide)
        self.left, self.right, self.changed = np.zeros((3, 2, self.modes + follow))
        self.pulled = np.zeros((2, self.modes))

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def follow(self, omega: cython.double) -> cython.int:
        """Compute the monodromy of the sequence of states at a frequency [rad/s]."""
        s: StateSequence = self.sequence
        i: cython.int
        k: cython.int
        e: cython.int
        length: cython.double
        self.omega = omega
        self.begin()
        if s.events == 0:
            self.find_rate()
            self.propagate(TWO_PI)
            return 0
        for i in range(s.events):
            k = (self.first + i) % s.events
            e = s.order[k]
            length = s.angle[s.order[(k + 1) % s.events]] - s.angle[e]
            if k + 1 == s.events:
                length += TWO_PI
            if i > 0:
                self.apply_event(e)
            if length > 0.0:
                self.find_rate()
                self.propagate(length)
        # the period ends with the event after which it began
        return self.apply_event(s.order[self.first])

    def matrix(self) -> npt.NDArray[np.float64]:
        """The monodromy matrix, square, of 2 modes + memories rows."""
        w = np.asarray(self.w)[self.remembering]
        return np.vstack((np.asarray(self.q), np.asarray(self.v), w))[:, : self.columns]

    def begin(self) -> None:
        """Set the disturbances, the states and the matrices at the beginning of the period."""
        s = self.sequence
        order, whose = np.asarray(s.order)[: s.events], np.asarray(s.whose)[: s.events]
        into = np.asarray(s.into)[: s.events]
        moving = distinct_values(whose).astype(np.intp)
        state = np.array(s.state)
        i: cython.int
        resting = int((state[moving] == STICK).sum())
        fewest, self.first = len(state) + 1, 0
        states = state.copy()
        for i, e in enumerate(order.tolist()):
            c = whose[e]
            resting += int(into[e] == STICK) - int(states[c] == STICK)
            states[c] = into[e]
            if resting < fewest:
                fewest, self.first = resting, i
        for e in order[: self.first + 1].tolist():
            state[whose[e]] = into[e]
        np.asarray(self.state)[:] = state
        self.remembering = [c for c in moving.tolist() if state[c] == STICK]
        columns = 2 * self.modes + len(self.remembering)
        if (columns, len(moving)) != (self.columns, self.moving):
            self.allocate(columns, len(moving))
        np.asarray(self.number)[moving] = np.arange(len(moving))
        self.assemble(state, moving)
        self.q[:, :] = 0.0
        self.v[:, :] = 0.0
        self.w[:, :] = 0.0
        self.g[:, :] = 0.0
        self.phi[:, :] = 0.0
        m = np.arange(self.modes)
        np.asarray(self.q)[m, m] = np.asarray(self.v)[m, self.modes + m] = 1.0
        column: cython.Py_ssize_t = 2 * self.modes
        one: cython.Py_ssize_t
        for one in self.remembering:
            force = self.contact[one, 1] / self.omega**2
            self.w[one, column] = 1.0
            at: cython.Py_ssize_t = self.number[one]
            if self.by_modes:
                weights = np.asarray(self.weights)[at]
                np.asarray(self.phi)[:, column] = force * weights
                pushed = np.asarray(self.own)[at] + np.asarray(self.upper) @ weights
            else:
                self.phi[at, column] = force
                pushed = np.asarray(self.upper)[:, at]
            np.asarray(self.g)[:, column] = force * pushed
            column += 1

    def assemble(self, state: npt.NDArray[np.intc], moving: npt.NDArray[np.intp]) -> None:
        """Assemble all matrices for states of the contacts.

        Derivatives are by the angle, so stiffnesses are divided by omega^2. lower is [U, G], and upper is V,
        for the ports of moving contacts, or for the far modes (`by_modes`).
        """
        unit, m, n = 1.0 / self.omega**2, self.modes, self.contacts
        mu, k_u, k_v = np.asarray(self.contact).T[:3]
        u, v = np.where(state == STICK, k_u, 0.0), np.where(state != SEPARATION, k_v, 0.0)
        across = np.where(state == POSITIVE, mu * k_v, np.where(state == NEGATIVE, -mu * k_v, 0.0))
        np.asarray(self.damping)[:] = 2.0 * self.ratio * self.natural / self.omega
        ports = _by_direction(moving)
        if self.by_modes or not self.soft:
            shapes = np.concatenate((self.shapes, self.following))
            P, Q = shapes[:, ::2], shapes[:, 1::2]
            K = (P * u) @ P.T + (Q * v) @ Q.T + (P * across) @ Q.T
            K += np.diag(np.concatenate((self.natural, self.stiff)) ** 2)
            if not self.soft:
                np.asarray(self.K)[:] = unit * K
                self.upper = np.ascontiguousarray(self.shapes[:, ports])
                self.lower = np.ascontiguousarray(np.asarray(self.upper).T)
                return
            B = np.linalg.inv(K[m:, m:])
            U, V = -B @ K[m:, :m], -K[:m, m:] @ B
            np.asarray(self.K)[:] = unit * (K[:m, :m] + K[:m, m:] @ U)
            self.upper = np.ascontiguousarray(V)
            self.lower = np.concatenate((U, self.omega**2 * B), axis=1)
            self.own = np.ascontiguousarray(self.shapes[:, ports].T)
            self.weights = np.ascontiguousarray(self.following[:, ports].T)
            return
        if self.all_stuck is None:
            self.all_stuck = self.with_springs()
        other = np.flatnonzero(state != STICK)
        at, k = m + np.concatenate((other, n + other)), len(other)
        s = np.diag(np.concatenate((u[other] - k_u[other], v[other] - k_v[other])))
        s[np.arange(k), k + np.arange(k)] = across[other]
        kept = np.concatenate((np.arange(m), m + np.concatenate((moving, n + moving))))
        every: npt.NDArray[np.float64] = self.all_stuck
        rows = every[np.ix_(at, kept)]
        e = np.linalg.solve(np.eye(2 * k) + s @ every[np.ix_(at, at)], s)
        found = every[np.ix_(kept, kept)] - every[np.ix_(kept, at)] @ (e @ rows)
        np.asarray(self.K)[:] = -unit * found[:m, :m]
        self.upper = np.ascontiguousarray(found[:m, m:])
        found[m:, m:] *= self.omega**2
        self.lower = np.ascontiguousarray(found[m:])

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def apply_event(self, e: cython.int) -> cython.int:
        """Pass an event: set what the slider remembers of the disturbance, and the new state."""
        c: cython.int = self.sequence.whose[e]
        to: cython.int = self.sequence.into[e]
        was: cython.int = self.state[c]
        m: cython.Py_ssize_t = self.modes
        i: cython.Py_ssize_t
        k: cython.Py_ssize_t
        wide: cython.Py_ssize_t = self.w.shape[1]
        unit: cython.double = 1.0 / (self.omega * self.omega)
        k_u: cython.double = self.contact[c, 1] * unit
        k_v: cython.double = self.contact[c, 2] * unit
        mu: cython.double = self.contact[c, 0]
        n: cython.Py_ssize_t = self.moving
        one: cython.Py_ssize_t = self.number[c]
        self.find_products(one)
        # G between the ports, and (1 + s G)^-1 s with the change s of the stiffness
        G_uu: cython.double = self.flexibility(0, one)
        G_uv: cython.double = self.flexibility(0, n + one)
        G_vu: cython.double = self.flexibility(1, one)
        G_vv: cython.double = self.flexibility(1, n + one)
        s_uu: cython.double = (k_u if to == STICK else 0.0) - (k_u if was == STICK else 0.0)
        s_vv: cython.double = (k_v if to != SEPARATION else 0.0) - (k_v if was != SEPARATION else 0.0)
        s_uv: cython.double = mu * k_v * (_side(to) - _side(was))
        a: cython.double = 1.0 + s_uu * G_uu + s_uv * G_vu
        b: cython.double = s_uu * G_uv + s_uv * G_vv
        t: cython.double = s_vv * G_vu
        z: cython.double = 1.0 + s_vv * G_vv
        det: cython.double = a * z - b * t
        d_uu: cython.double = z * s_uu / det
        d_uv: cython.double = (z * s_uv - b * s_vv) / det
        d_vu: cython.double = -t * s_uu / det
        d_vv: cython.double = (a * s_vv - t * s_uv) / det
        # the slider's force before and after
        before: cython.double = k_u if was == STICK else 0.0
        after: cython.double = k_u if to == STICK else 0.0
        weight: cython.double = self.sequence.along[e] * mu * self.contact[c, 2] / self.contact[c, 1]
        share: cython.double = 1.0 - d_uu * G_uu - d_uv * G_vu
        other: cython.double = -d_vu * G_uu - d_vv * G_vu
        old: cython.double
        new: cython.double
        f_u: cython.double
        f_v: cython.double
        for k in range(wide):
            old = before * self.w[c, k]
            f_u = self.followed[0, k] + G_uu * old
            f_v = self.followed[1, k] + G_vu * old
            if to == STICK:
                self.w[c, k] = (
                    self.port[0, k] - self.followed[0, k]
                    + weight * (self.port[1, k] - self.followed[1, k])
                )  # fmt: skip
            new = after * self.w[c, k]
            self.push[k] = new - old
            if not self.by_modes:
                self.phi[one, k] = new
            self.row[0, k] = d_uu * f_u + d_uv * f_v + share * new - old
            self.row[1, k] = d_vu * f_u + d_vv * f_v + other * new
        if self.by_modes:
            for i in range(self.pushing):
                for k in range(wide):
                    self.phi[i, k] += self.weights[one, i] * self.push[k]
        add_products(self.g, self.left[0], self.row[0], self.left[1], self.row[1])
        self.state[c] = to
        if was == to:
            return 0
        for k in range(self.changed.shape[1]):
            self.changed[0, k] = -self.left[0, k] * d_uu - self.left[1, k] * d_vu
            self.changed[1, k] = -self.left[0, k] * d_uv - self.left[1, k] * d_vv
        for k in range(m):
            self.pulled[0, k], self.pulled[1, k] = -self.right[0, k], -self.right[1, k]
        p, q, x, y = self.changed[0], self.changed[1], self.right[0], self.right[1]
        add_products(self.K, p[:m], self.pulled[0], q[:m], self.pulled[1])
        if self.soft:
            add_products(self.lower, p[m:], x, q[m:], y)
            add_products(self.upper, p[:m], x[m:], q[:m], y[m:])
        return 0

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def find_products(self, one: cython.Py_ssize_t) -> cython.int:
        """Fill left, right, port and followed for the two ports of a moving contact.

        left are columns of V and G, and right are rows of U and G. Displacements are port - followed, with
        port = U q and followed = -G phi, the part of the far modes.
        """
        i: cython.Py_ssize_t
        k: cython.Py_ssize_t
        r: cython.Py_ssize_t
        at: cython.Py_ssize_t
        m: cython.Py_ssize_t = self.modes
        for r in range(2):
            at = one + r * self.moving
            if self.by_modes:
                sum_of_rows(self.weights[at], self.lower, self.right[r])
                for i in range(m):
                    self.right[r, i] += self.own[at, i]
                    self.left[r, i] = self.own[at, i]
                    for k in range(self.pushing):
                        self.left[r, i] += self.upper[i, k] * self.weights[at, k]
                for i in range(self.pushing):
                    self.left[r, m + i] = 0.0
                    for k in range(self.pushing):
                        self.left[r, m + i] += self.lower[i, m + k] * self.weights[at, k]
            else:
                for i in range(m):
                    self.left[r, i] = self.upper[i, at]
                for i in range(self.lower.shape[1]):
                    self.right[r, i] = self.lower[at, i]
                for i in range(self.lower.shape[0] if self.soft else 0):
                    self.left[r, m + i] = self.lower[i, m + at]
            sum_of_rows(self.right[r, :m], self.q, self.port[r])
            if not self.soft:
                continue
            sum_of_rows(self.right[r, m : m + self.pushing], self.phi, self.followed[r])
            for i in range(self.followed.shape[1]):
                self.followed[r, i] = -self.followed[r, i]
        return 0

    @cython.cfunc
    @cython.exceptval(check=False)
    def flexibility(self, r: cython.Py_ssize_t, at: cython.Py_ssize_t) -> cython.double:
        """Flexibility G between port r of the last `find_products` and the port with index at."""
        i: cython.Py_ssize_t
        found: cython.double = 0.0
        if not self.soft:
            return 0.0
        if not self.by_modes:
            return self.right[r, self.modes + at]
        for i in range(self.pushing):
            found += self.right[r, self.modes + i] * self.weights[at, i]
        return found

    @cython.cfunc
    @cython.exceptval(check=False)
    def find_rate(self) -> cython.void:
        """Compute the rate, which bounds how fast the motion turns."""
        i: cython.Py_ssize_t
        j: cython.Py_ssize_t
        rows: cython.double = 0.0
        damped: cython.double = 0.0
        total: cython.double
        for i in range(self.modes):
            total = 0.0
            for j in range(self.modes):
                total += fabs(self.K[i, j])
            rows, damped = max(rows, total), max(damped, self.damping[i])
        self.rate = sqrt(rows) + damped

    @cython.cfunc
    @cython.exceptval(check=False)
    def propagate(self, length: cython.double) -> cython.void:
        """Propagate the disturbances through an angle by a series in steps.

        Steps are so short that the terms of the series do not grow large.
        """
        i: cython.int
        steps: cython.int = cython.cast(cython.int, ceil(self.rate * length / self.step_radians))
        steps = max(steps, 1)
        for i in range(steps):  # noqa: B007
            self.apply(length / steps)

    @cython.cfunc
    @cython.exceptval(check=False)
    def apply(self, h: cython.double) -> cython.void:
        """Take one step: add the terms (A h)^j / j! of (q, q')' = (q', g - K q - D q')."""
        order: cython.int = 0
        size: cython.double = 1.0
        share: cython.double
        i: cython.Py_ssize_t
        k: cython.Py_ssize_t
        if self.modes == 0:
            return
        for i in range(self.modes):
            for k in range(self.q.shape[1]):
                self.tq[i, k], self.tv[i, k] = self.q[i, k], self.v[i, k]
        while size > self.series_tolerance or order < 2:
            order += 1
            share = h / order
            size *= self.rate * share
            if not cython.compiled:
                work = (self.g if order == 1 else 0.0) - self.K @ self.tq - self.damping[:, None] * self.tv
                self.tq[:, :], self.tv[:, :] = share * self.tv, share * work
                self.q += self.tq
                self.v += self.tv
            else:
                add_term(
                    cython.address(self.K[0, 0]), cython.address(self.damping[0]),
                    cython.address(self.g[0, 0]), order == 1, share,
                    cython.address(self.tq[0, 0]), cython.address(self.tv[0, 0]),
                    cython.address(self.q[0, 0]), cython.address(self.v[0, 0]),
                    cython.address(self.work[0, 0]), self.modes, self.q.shape[1],
                )  # fmt: skip


@cython.cfunc
@cython.exceptval(check=False)
def _side(state: cython.int) -> cython.double:
    """Sign of the load's part in the friction force, 0 without slip."""
    return 1.0 if state == POSITIVE else -1.0 if state == NEGATIVE else 0.0


def _by_direction(contacts: npt.NDArray[np.intp]) -> npt.NDArray[np.intp]:
    """Indices of the tangential ports of some contacts, then of their normal ones.

    >>> _by_direction(np.array([0, 2])).tolist()
    [0, 4, 1, 5]
    """
    found: npt.NDArray[np.intp] = np.concatenate((2 * contacts, 2 * contacts + 1))
    return found
