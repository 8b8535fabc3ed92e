r"""What becomes of a small disturbance of a periodic motion within one period, slow or fast.

Of a motion whose contacts' states are known over the period, a disturbance obeys linear equations with
coefficients that are constant between the events. With modes of mass 1 and shapes P_u, P_v at the contacts,

    q_i'' + 2 zeta_i w_i q_i' + w_i^2 q_i = - sum over the contacts (P_u df + P_v dn)

    stick       df = k_u (du - dw), dn = k_v dv      dw constant: where the slider came to rest
    slip        df = +-mu k_v dv,   dn = k_v dv
    separation  df = dn = 0

The forces are continuous, so events do not make q or q' jump, and their instants do not matter but where they
decide what the slider remembers: at the end of a slip dw = du -+ mu k_v dv / k_u, as the limit is at its
extreme; at a closing w = u where the load vanishes, so dw = du - u' dv / v'.

In a ring of n sectors whose motion repeats after no fewer, after 2 pi / n each sector does what the one j
sectors ahead did before. So the disturbances of a travelling wave after that time, counted from j sectors
behind, obey the same equations again: that map, n times over, is the monodromy, and takes an n-th of the time
(`RingMonodromy`).

With many contacts (`ManyMonodromy`) the events of a period are many, and each changes the state of one
contact alone. So what the contacts add to the modes is not put together anew for every state, but changed by
a matrix of rank two. With modes of mass 1, of which those far above the excitation, f, follow without delay,
shapes P on the ports and the contacts' stiffness S (port, port) of a state,

    q'' + D q' + K q = phi - R phi_f,    q_f = G phi_f - L q,
    G = (W_f^2 + P_f S P_f^T)^-1,   L = G P_f S P^T,   R = P S P_f^T G,   K = W^2 + P S P^T - R P_f S P^T

where phi are the forces k_u w of the sliders that rest. Where a contact with shapes a, a_f on its two ports
changes its stiffness by s (2, 2) they change (Sherman, Morrison, Woodbury), with
d = (1 + s a_f^T G a_f)^-1 s, by

    -G a_f d a_f^T G,    G a_f d o,    i d a_f^T G,    i d o,    o = a^T - a_f^T L,   i = a - R a_f.

Together K, -R, L and G are one matrix [[K, -R], [L, G]], which changes by [i, G a_f] d [o, -a_f^T G]. What
the sliders push the modes with, phi - R phi_f, changes along i alone, too.

The period begins after the event at which the fewest sliders remember where they rest: so many disturbances
less are to be followed.
"""

from __future__ import annotations

import cython
import numpy as np
import numpy.typing as npt
from cython.cimports.libc.math import ceil, fabs, sqrt

from fcm.stability.disturbance import Propagator
from fcm.stability.options import STABILITY, PropagationOptions

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


LANES = 8  # columns beside one another in the widest registers; arrays have a multiple of them


@cython.cclass
class Monodromy(Disturbances):
    """`follow` a sequence: `matrix` is then the derivative of (q, q', w) after a period by that before.

    Velocities are by the angle. Followed is the motion that the sequence is of.
    """

    def __init__(
        self, stiffness: Stiffness, sequence: StateSequence, propagator: Propagator | None = None
    ) -> None:
        Disturbances.__init__(self, stiffness, propagator or Propagator())
        self.sequence = sequence
        self.port = np.zeros((2, self.size))

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def follow(self, omega: cython.double) -> cython.int:
        """Fill the matrix for a frequency."""
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
        """(2 modes + memories, the same): only contacts that stick when the period begins remember."""
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
            if self.sequence.remembers[c]:
                for i in range(columns):
                    out[row, i] = self.X[2 * self.modes + c, i]
                row += 1
        return made

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def begin(self) -> cython.int:
        """The disturbances to be followed, before the first event."""
        i: cython.int
        j: cython.int
        c: cython.int
        self.memories = 0
        for i in range(self.X.shape[0]):
            for j in range(self.X.shape[1]):
                self.X[i, j] = 1.0 if i == j and i < 2 * self.modes else 0.0
        for c in range(self.contacts):
            self.state[c] = self.sequence.state[c]
            if self.sequence.remembers[c]:
                self.X[2 * self.modes + c, 2 * self.modes + self.memories] = 1.0
                self.memories += 1
        return self.assemble()

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def apply_event(self, e: cython.int) -> cython.int:
        """An event: what the slider remembers of the disturbance, and the new state."""
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
    """Carries nothing: through the short angles of a part of a period the series takes less time."""

    def through(self, *_: object) -> bool:
        """Whether it has carried anything."""
        return False


@cython.cclass
class RingMonodromy(Monodromy):
    """As `Monodromy`, of the contacts of all sectors.

    part is the angle that is followed; renumber (mode, mode) renumbers the sectors in modal coordinates, and
    source (contact,) is the contact whose slider has the place of each afterwards.
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
        self.memory = np.zeros(self.contacts, dtype=np.intc)
        self.first, self.start = 0, 0.0

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def follow(self, omega: cython.double) -> cython.int:
        """Fill the matrix for a frequency."""
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
        """Begin in the middle of the widest gap between events, so that none is at the ends."""
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

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def begin(self) -> cython.int:
        """The disturbances to be followed, and the states at the start."""
        s: StateSequence = self.sequence
        i: cython.int
        c: cython.int
        self.memories = 0
        self.state[:] = s.state
        self.memory[:] = s.remembers
        for i in range(self.first):
            c = s.whose[s.order[i]]
            self.state[c] = s.into[s.order[i]]
            self.memory[c] = self.state[c] == STICK
        self.X[:, :] = 0.0
        for i in range(2 * self.modes):
            self.X[i, i] = 1.0
        for c in range(self.contacts):
            if self.memory[c]:
                self.X[2 * self.modes + c, 2 * self.modes + self.memories] = 1.0
                self.memories += 1
        return self.assemble()

    def matrix(self) -> npt.NDArray[np.float64]:
        """(2 modes + memories, the same): only contacts that stick at the start remember."""
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
    """`follow` a sequence: `matrix` is then the derivative of (q, q', w) after a period by that before.

    Velocities are by the angle; of the places w those that are remembered when the period begins.

    Parameters
    ----------
    shapes, natural, damping : (mode, port), (mode,), (mode,)
        Of all modes; natural frequencies in rad/s.
    far : (mode,) bool
        Which follow without delay.
    contact : (contact, 4)
        mu, k_u, k_v, n_0.
    """

    def __init__(
        self,
        shapes: npt.NDArray[np.float64],
        natural: npt.NDArray[np.float64],
        damping: npt.NDArray[np.float64],
        far: npt.NDArray[np.bool_],
        contact: npt.NDArray[np.float64],
        sequence: StateSequence,
        options: PropagationOptions = STABILITY.propagation,
    ) -> None:
        self.step_radians, self.series_tolerance = options.step_radians_of_many, options.series_tolerance
        self.slow, self.fast = shapes[~far], shapes[far]
        modes, follow, contacts = len(self.slow), len(self.fast), contact.shape[0]
        self.modes, self.follows, self.contacts = modes, follow, contacts
        self.contact, self.sequence = np.ascontiguousarray(contact), sequence
        # by ports, so that what an event needs stands together
        self.by_slow, self.by_fast = np.ascontiguousarray(self.slow.T), np.ascontiguousarray(self.fast.T)
        self.natural, self.ratio, self.far = natural[~far], damping[~far], natural[far]
        self.K = np.zeros((modes, modes))
        self.lower, self.upper = np.zeros((2, follow, modes + follow))  # [L, G], [-R, G] by columns
        self.left, self.right, self.changed = np.zeros((3, 2, modes + follow))
        self.damping, self.state = np.zeros(modes), np.zeros(contacts, dtype=np.intc)
        self.columns, self.first, self.rate, self.omega = 2 * modes, 0, 1.0, 1.0
        self.remembering: list[int] = []
        self.allocate(2 * modes)

    def allocate(self, columns: int) -> None:
        """Arrays for so many disturbances."""
        self.columns, wide = columns, -(-columns // LANES) * LANES
        self.q, self.v, self.tq, self.tv, self.work, self.g = np.zeros((6, self.modes, wide))
        self.w, self.phi_f = np.zeros((self.contacts, wide)), np.zeros((self.follows, wide))
        self.port, self.followed, self.row, self.pushed = np.zeros((4, 2, wide))

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def follow(self, omega: cython.double) -> cython.int:
        """Take a period at a frequency [rad/s]."""
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
        # the event after which the period began ends it
        return self.apply_event(s.order[self.first])

    def matrix(self) -> npt.NDArray[np.float64]:
        """(2 modes + memories, the same)."""
        w = np.asarray(self.w)[self.remembering]
        return np.vstack((np.asarray(self.q), np.asarray(self.v), w))[:, : self.columns]

    def begin(self) -> None:
        """The disturbances, the states and the matrices when the period begins."""
        s = self.sequence
        order, whose = np.asarray(s.order)[: s.events], np.asarray(s.whose)[: s.events]
        into = np.asarray(s.into)[: s.events]
        moving = np.unique(whose)
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
        if 2 * self.modes + len(self.remembering) != self.columns:
            self.allocate(2 * self.modes + len(self.remembering))
        self.assemble(state)
        self.q[:, :] = 0.0
        self.v[:, :] = 0.0
        self.w[:, :] = 0.0
        self.g[:, :] = 0.0
        self.phi_f[:, :] = 0.0
        m = np.arange(self.modes)
        np.asarray(self.q)[m, m] = np.asarray(self.v)[m, self.modes + m] = 1.0
        column: cython.Py_ssize_t = 2 * self.modes
        one: cython.Py_ssize_t
        for one in self.remembering:
            k_u = self.contact[one, 1] / self.omega**2
            on_fast = np.asarray(self.by_fast)[2 * one]
            on_slow = np.asarray(self.by_slow)[2 * one] + on_fast @ np.asarray(self.upper)[:, : self.modes]
            self.w[one, column] = 1.0
            np.asarray(self.g)[:, column] = k_u * on_slow
            np.asarray(self.phi_f)[:, column] = k_u * on_fast
            column += 1

    def assemble(self, state: npt.NDArray[np.intc]) -> None:
        """All of the matrices, for states of the contacts; stiffnesses over omega^2: all is by the angle."""
        unit, modes = 1.0 / self.omega**2, self.modes
        mu, k_u, k_v = np.asarray(self.contact).T[:3] * np.array([[1.0], [unit], [unit]])
        slow, fast = self.slow, self.fast
        u, v = np.where(state == STICK, k_u, 0.0), np.where(state != SEPARATION, k_v, 0.0)
        across = np.where(state == POSITIVE, mu * k_v, np.where(state == NEGATIVE, -mu * k_v, 0.0))

        def between(left: npt.NDArray[np.float64], right: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
            pushed = (left[:, ::2] * u) @ right[:, ::2].T + (left[:, 1::2] * v) @ right[:, 1::2].T
            return pushed + (left[:, ::2] * across) @ right[:, 1::2].T

        G = np.linalg.inv(np.diag(unit * self.far**2) + between(fast, fast))
        along = between(fast, slow)
        R = between(slow, fast) @ G
        lower, upper = np.asarray(self.lower), np.asarray(self.upper)
        lower[:, :modes], lower[:, modes:] = G @ along, G
        upper[:, :modes], upper[:, modes:] = -R.T, G.T
        np.asarray(self.K)[:] = np.diag(unit * self.natural**2) + between(slow, slow) - R @ along
        np.asarray(self.damping)[:] = 2.0 * self.ratio * self.natural / self.omega

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def apply_event(self, e: cython.int) -> cython.int:
        """An event: what the slider remembers of the disturbance, and the new state."""
        c: cython.int = self.sequence.whose[e]
        to: cython.int = self.sequence.into[e]
        was: cython.int = self.state[c]
        m: cython.Py_ssize_t = self.modes
        k: cython.Py_ssize_t
        wide: cython.Py_ssize_t = self.w.shape[1]
        unit: cython.double = 1.0 / (self.omega * self.omega)
        k_u: cython.double = self.contact[c, 1] * unit
        k_v: cython.double = self.contact[c, 2] * unit
        mu: cython.double = self.contact[c, 0]
        self.find_products(c)
        # G between the ports, and (1 + s G)^-1 s with the change s of the stiffness
        G_uu: cython.double = 0.0
        G_uv: cython.double = 0.0
        G_vu: cython.double = 0.0
        G_vv: cython.double = 0.0
        for k in range(self.follows):
            G_uu += self.by_fast[2 * c, k] * self.left[0, m + k]
            G_uv += self.by_fast[2 * c, k] * self.left[1, m + k]
            G_vu += self.by_fast[2 * c + 1, k] * self.left[0, m + k]
            G_vv += self.by_fast[2 * c + 1, k] * self.left[1, m + k]
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
            self.pushed[0, k], self.pushed[1, k] = new - old, 0.0
            self.row[0, k] = d_uu * f_u + d_uv * f_v + share * new - old
            self.row[1, k] = d_vu * f_u + d_vv * f_v + other * new
        add_products(self.g, self.left[0], self.row[0], self.left[1], self.row[1])
        add_products(self.phi_f, self.by_fast[2 * c], self.pushed[0], self.by_fast[2 * c], self.pushed[1])
        self.state[c] = to
        if was == to:
            return 0
        for k in range(self.changed.shape[1]):
            self.changed[0, k] = self.left[0, k] * d_uu + self.left[1, k] * d_vu
            self.changed[1, k] = self.left[0, k] * d_uv + self.left[1, k] * d_vv
        p, q, x, y = self.changed[0], self.changed[1], self.right[0], self.right[1]
        add_products(self.K, p, x, q, y)
        add_products(self.lower, p[m:], x, q[m:], y)
        add_products(self.upper, x[m:], p, y[m:], q)
        return 0

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def find_products(self, c: cython.int) -> cython.int:
        """left, [i, G a_f], and right, [o, -a_f^T G], of the two ports of a contact; its displacements, from
        port less followed, with followed, -a_f^T G phi_f, by the modes that follow."""
        i: cython.Py_ssize_t
        r: cython.Py_ssize_t
        for r in range(2):
            sum_of_rows(self.by_fast[2 * c + r], self.upper, self.left[r])
            sum_of_rows(self.by_fast[2 * c + r], self.lower, self.right[r])
            for i in range(self.modes + self.follows):
                self.right[r, i] = -self.right[r, i]
            for i in range(self.modes):
                self.left[r, i] += self.by_slow[2 * c + r, i]
                self.right[r, i] += self.by_slow[2 * c + r, i]
            sum_of_rows(self.right[r, : self.modes], self.q, self.port[r])
            sum_of_rows(self.right[r, self.modes :], self.phi_f, self.followed[r])
        return 0

    @cython.cfunc
    @cython.exceptval(check=False)
    def find_rate(self) -> cython.void:
        """How fast the motion turns, at most."""
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
        """The disturbances after an angle, by a series in steps in which its terms do not grow large."""
        i: cython.int
        steps: cython.int = cython.cast(cython.int, ceil(self.rate * length / self.step_radians))
        steps = max(steps, 1)
        for i in range(steps):  # noqa: B007
            self.apply(length / steps)

    @cython.cfunc
    @cython.exceptval(check=False)
    def apply(self, h: cython.double) -> cython.void:
        """One step: the terms (A h)^j / j! of (q, q')' = (q', g - K q - D q')."""
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
    """By which sign the load adds to the friction force."""
    return 1.0 if state == POSITIVE else -1.0 if state == NEGATIVE else 0.0
