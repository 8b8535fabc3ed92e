r"""What becomes of a small disturbance within one period of a motion of many contacts; see `monodromy`.

With many contacts the events of a period are many, and each changes the state of one contact alone. So what
the contacts add to the modes is not put together anew for every state, but changed by a matrix of rank two.
With modes of mass 1, of which those far above the excitation, f, follow without delay, shapes P on the ports
and the contacts' stiffness S (port, port) of a state,

    q'' + D q' + K q = phi - R phi_f,    q_f = G phi_f - L q,
    G = (W_f^2 + P_f S P_f^T)^-1,   L = G P_f S P^T,   R = P S P_f^T G,   K = W^2 + P S P^T - R P_f S P^T

where phi are the forces k_u w of the sliders that rest. Where a contact with shapes a, a_f on its two ports
changes its stiffness by s (2, 2) they change (Sherman, Morrison, Woodbury), with
d = (1 + s a_f^T G a_f)^-1 s, by

    -G a_f d a_f^T G,    G a_f d o,    i d a_f^T G,    i d o,    o = a^T - a_f^T L,   i = a - R a_f.

The period begins after the event at which the fewest sliders remember where they rest: so many disturbances
less are to be followed.
"""

from __future__ import annotations

import cython
import numpy as np
import numpy.typing as npt
from cython.cimports.libc.math import ceil, fabs, sqrt

if cython.compiled:
    from cython.cimports.fcm.contact.periodic.cycle import NEGATIVE, POSITIVE, SEPARATION, STICK, TWO_PI
    from cython.cimports.fcm.stability.state_sequence import StateSequence
else:
    from fcm.contact.periodic.cycle import NEGATIVE, POSITIVE, SEPARATION, STICK, TWO_PI
    from fcm.stability.state_sequence import StateSequence

REACH = cython.declare(cython.double, 3.0)  # of a step, in radians of the fastest motion
SMALL = cython.declare(cython.double, 1e-13)  # bound of the last term of the series, relative to the first


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
    ) -> None:
        self.slow, self.fast = shapes[~far], shapes[far]
        modes, follow, contacts = len(self.slow), len(self.fast), contact.shape[0]
        self.modes, self.follows, self.contacts = modes, follow, contacts
        self.contact, self.sequence = np.ascontiguousarray(contact), sequence
        # by ports, so that what an event needs stands together
        self.by_slow, self.by_fast = np.ascontiguousarray(self.slow.T), np.ascontiguousarray(self.fast.T)
        self.natural, self.ratio, self.far = natural[~far], damping[~far], natural[far]
        self.K, self.G = np.zeros((modes, modes)), np.zeros((follow, follow))
        self.stiffness = np.asarray(self.K)
        self.L, self.R = np.zeros((follow, modes)), np.zeros((modes, follow))
        self.damping, self.state = np.zeros(modes), np.zeros(contacts, dtype=np.intc)
        self.b, self.bt = np.zeros((2, follow)), np.zeros((2, follow))
        self.out, self.into = np.zeros((2, modes)), np.zeros((2, modes))
        self.columns, self.first, self.rate, self.omega = 2 * modes, 0, 1.0, 1.0
        self.remembering: list[int] = []
        self.allocate(2 * modes)

    def allocate(self, columns: int) -> None:
        """Arrays for so many disturbances."""
        self.columns = columns
        self.q, self.v, self.tq, self.tv, self.work, self.g = np.zeros((6, self.modes, columns))
        self.term, self.product = np.asarray(self.tq), np.asarray(self.work)  # for BLAS
        self.w, self.phi = np.zeros((self.contacts, columns)), np.zeros((self.modes, columns))
        self.phi_f, self.port = np.zeros((self.follows, columns)), np.zeros((2, columns))

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
            self.pull()
            return self.propagate(TWO_PI)
        for i in range(s.events):
            k = (self.first + i) % s.events
            e = s.order[k]
            length = s.angle[s.order[(k + 1) % s.events]] - s.angle[e]
            if k + 1 == s.events:
                length += TWO_PI
            if i > 0:
                self.apply_event(e)
            if length > 0.0:
                self.pull()
                self.propagate(length)
        # the event after which the period began ends it
        return self.apply_event(s.order[self.first])

    def matrix(self) -> npt.NDArray[np.float64]:
        """(2 modes + memories, the same)."""
        w = np.asarray(self.w)[self.remembering]
        return np.vstack((np.asarray(self.q), np.asarray(self.v), w))

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
        self.q[:, :] = 0.0
        self.v[:, :] = 0.0
        self.w[:, :] = 0.0
        self.phi[:, :] = 0.0
        self.phi_f[:, :] = 0.0
        m = np.arange(self.modes)
        np.asarray(self.q)[m, m] = np.asarray(self.v)[m, self.modes + m] = 1.0
        k: cython.int
        for k in range(len(self.remembering)):
            one: cython.int = self.remembering[k]
            column: cython.int = 2 * self.modes + k
            k_u: cython.double = self.contact[one, 1] / self.omega**2
            self.w[one, column] = 1.0
            np.asarray(self.phi)[:, column] = k_u * np.asarray(self.by_slow)[2 * one]
            np.asarray(self.phi_f)[:, column] = k_u * np.asarray(self.by_fast)[2 * one]
        self.assemble(state)

    def assemble(self, state: npt.NDArray[np.intc]) -> None:
        """All of the matrices, for states of the contacts; stiffnesses over omega^2: all is by the angle."""
        unit = 1.0 / self.omega**2
        mu, k_u, k_v = np.asarray(self.contact).T[:3] * np.array([[1.0], [unit], [unit]])
        slow, fast = self.slow, self.fast
        u, v = np.where(state == STICK, k_u, 0.0), np.where(state != SEPARATION, k_v, 0.0)
        across = np.where(state == POSITIVE, mu * k_v, np.where(state == NEGATIVE, -mu * k_v, 0.0))

        def between(left: npt.NDArray[np.float64], right: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
            pushed = (left[:, ::2] * u) @ right[:, ::2].T + (left[:, 1::2] * v) @ right[:, 1::2].T
            return pushed + (left[:, ::2] * across) @ right[:, 1::2].T

        G = np.linalg.inv(np.diag(unit * self.far**2) + between(fast, fast))
        along = between(fast, slow)
        np.asarray(self.G)[:], np.asarray(self.L)[:] = G, G @ along
        np.asarray(self.R)[:] = between(slow, fast) @ G
        own = np.diag(unit * self.natural**2) + between(slow, slow)
        np.asarray(self.K)[:] = own - np.asarray(self.R) @ along
        np.asarray(self.damping)[:] = 2.0 * self.ratio * self.natural / self.omega

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def apply_event(self, e: cython.int) -> cython.int:
        """An event: what the slider remembers of the disturbance, and the new state."""
        c: cython.int = self.sequence.whose[e]
        to: cython.int = self.sequence.into[e]
        was: cython.int = self.state[c]
        unit: cython.double = 1.0 / (self.omega * self.omega)
        k_u: cython.double = self.contact[c, 1]
        self.seen(c)
        if to == STICK:
            self.displacements(c)
        if was == STICK:
            self.add_slider_force(c, -k_u * unit)
        if to == STICK:
            weight: cython.double = self.sequence.along[e] * self.contact[c, 0] * self.contact[c, 2] / k_u
            k: cython.Py_ssize_t
            for k in range(self.columns):
                self.w[c, k] = self.port[0, k] + weight * self.port[1, k]
        self.state[c] = to
        self.change(c, was, to, unit)
        if to == STICK:
            self.add_slider_force(c, k_u * unit)
        return 0

    @cython.cfunc
    @cython.exceptval(check=False)
    def seen(self, c: cython.int) -> cython.void:
        """out, into, b and bt of the two ports of a contact."""
        i: cython.Py_ssize_t
        j: cython.Py_ssize_t
        r: cython.Py_ssize_t
        a: cython.double
        for r in range(2):
            for i in range(self.modes):
                self.out[r, i] = self.into[r, i] = self.by_slow[2 * c + r, i]
            for i in range(self.follows):
                self.b[r, i] = self.bt[r, i] = 0.0
            for j in range(self.follows):
                a = self.by_fast[2 * c + r, j]
                if a == 0.0:
                    continue
                for i in range(self.modes):
                    self.out[r, i] -= a * self.L[j, i]
                for i in range(self.follows):
                    self.bt[r, i] += a * self.G[j, i]
            for i in range(self.modes):
                for j in range(self.follows):
                    self.into[r, i] -= self.R[i, j] * self.by_fast[2 * c + r, j]
            for i in range(self.follows):
                for j in range(self.follows):
                    self.b[r, i] += self.G[i, j] * self.by_fast[2 * c + r, j]

    @cython.cfunc
    @cython.exceptval(check=False)
    def displacements(self, c: cython.int) -> cython.void:
        """port: displacements (2, column) of the contact that was seen, before it changes its state."""
        r: cython.Py_ssize_t
        i: cython.Py_ssize_t
        k: cython.Py_ssize_t
        a: cython.double
        for r in range(2):
            for k in range(self.columns):
                self.port[r, k] = 0.0
            for i in range(self.modes):
                a = self.out[r, i]
                for k in range(self.columns):
                    self.port[r, k] += a * self.q[i, k]
            for i in range(self.follows):
                a = self.bt[r, i]
                for k in range(self.columns):
                    self.port[r, k] += a * self.phi_f[i, k]

    @cython.cfunc
    @cython.exceptval(check=False)
    def add_slider_force(self, c: cython.int, by: cython.double) -> cython.void:
        """Add the force of a slider, so many times its place."""
        i: cython.Py_ssize_t
        k: cython.Py_ssize_t
        a: cython.double
        for i in range(self.modes):
            a = by * self.by_slow[2 * c, i]
            for k in range(self.columns):
                self.phi[i, k] += a * self.w[c, k]
        for i in range(self.follows):
            a = by * self.by_fast[2 * c, i]
            if a != 0.0:
                for k in range(self.columns):
                    self.phi_f[i, k] += a * self.w[c, k]

    @cython.cfunc
    @cython.exceptval(check=False)
    def change(self, c: cython.int, was: cython.int, to: cython.int, unit: cython.double) -> cython.void:
        """The matrices, from one state of the contact that was seen to another."""
        i: cython.Py_ssize_t
        j: cython.Py_ssize_t
        if was == to:
            return
        k_u: cython.double = self.contact[c, 1] * unit
        k_v: cython.double = self.contact[c, 2] * unit
        mu: cython.double = self.contact[c, 0]
        s_uu: cython.double = (k_u if to == STICK else 0.0) - (k_u if was == STICK else 0.0)
        s_vv: cython.double = (k_v if to != SEPARATION else 0.0) - (k_v if was != SEPARATION else 0.0)
        s_uv: cython.double = mu * k_v * (_side(to) - _side(was))
        A_uu: cython.double = 0.0
        A_uv: cython.double = 0.0
        A_vu: cython.double = 0.0
        A_vv: cython.double = 0.0
        for i in range(self.follows):
            A_uu += self.by_fast[2 * c, i] * self.b[0, i]
            A_uv += self.by_fast[2 * c, i] * self.b[1, i]
            A_vu += self.by_fast[2 * c + 1, i] * self.b[0, i]
            A_vv += self.by_fast[2 * c + 1, i] * self.b[1, i]
        # 1 + s A, and its inverse times s
        p: cython.double = 1.0 + s_uu * A_uu + s_uv * A_vu
        q: cython.double = s_uu * A_uv + s_uv * A_vv
        t: cython.double = s_vv * A_vu
        z: cython.double = 1.0 + s_vv * A_vv
        det: cython.double = p * z - q * t
        d_uu: cython.double = z * s_uu / det
        d_uv: cython.double = (z * s_uv - q * s_vv) / det
        d_vu: cython.double = -t * s_uu / det
        d_vv: cython.double = (p * s_vv - t * s_uv) / det
        left_u: cython.double
        left_v: cython.double
        for i in range(self.follows):
            left_u = self.b[0, i] * d_uu + self.b[1, i] * d_vu
            left_v = self.b[0, i] * d_uv + self.b[1, i] * d_vv
            for j in range(self.follows):
                self.G[i, j] -= left_u * self.bt[0, j] + left_v * self.bt[1, j]
            for j in range(self.modes):
                self.L[i, j] += left_u * self.out[0, j] + left_v * self.out[1, j]
        for i in range(self.modes):
            left_u = self.into[0, i] * d_uu + self.into[1, i] * d_vu
            left_v = self.into[0, i] * d_uv + self.into[1, i] * d_vv
            for j in range(self.follows):
                self.R[i, j] += left_u * self.bt[0, j] + left_v * self.bt[1, j]
            for j in range(self.modes):
                self.K[i, j] += left_u * self.out[0, j] + left_v * self.out[1, j]

    @cython.cfunc
    @cython.exceptval(check=False)
    def pull(self) -> cython.void:
        """g, the forces of the sliders on the modes, and how fast the motion turns."""
        i: cython.Py_ssize_t
        j: cython.Py_ssize_t
        k: cython.Py_ssize_t
        a: cython.double
        rows: cython.double = 0.0
        damped: cython.double = 0.0
        total: cython.double
        for i in range(self.modes):
            for k in range(self.columns):
                self.g[i, k] = self.phi[i, k]
            for j in range(self.follows):
                a = self.R[i, j]
                for k in range(self.columns):
                    self.g[i, k] -= a * self.phi_f[j, k]
            total = 0.0
            for j in range(self.modes):
                total += fabs(self.K[i, j])
            rows, damped = max(rows, total), max(damped, self.damping[i])
        self.rate = sqrt(rows) + damped

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def propagate(self, length: cython.double) -> cython.int:
        """The disturbances after an angle, by a series in steps in which its terms do not grow large."""
        i: cython.int
        steps: cython.int = cython.cast(cython.int, ceil(self.rate * length / REACH))
        steps = max(steps, 1)
        for i in range(steps):  # noqa: B007
            self.apply(length / steps)
        return 0

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def apply(self, h: cython.double) -> cython.int:
        """One step: the terms (A h)^j / j! of (q, q')' = (q', g - K q - D q')."""
        i: cython.Py_ssize_t
        k: cython.Py_ssize_t
        order: cython.int = 0
        size: cython.double = 1.0
        share: cython.double
        a: cython.double
        for i in range(self.modes):
            for k in range(self.columns):
                self.tq[i, k], self.tv[i, k] = self.q[i, k], self.v[i, k]
        while size > SMALL or order < 2:
            order += 1
            share = h / order
            size *= self.rate * share
            np.matmul(self.stiffness, self.term, out=self.product)
            for i in range(self.modes):
                a = self.damping[i]
                for k in range(self.columns):
                    self.work[i, k] = -self.work[i, k] - a * self.tv[i, k]
                    if order == 1:
                        self.work[i, k] += self.g[i, k]
                    self.tq[i, k] = share * self.tv[i, k]
                    self.tv[i, k] = share * self.work[i, k]
                    self.q[i, k] += self.tq[i, k]
                    self.v[i, k] += self.tv[i, k]
        return 0


@cython.cfunc
@cython.exceptval(check=False)
def _side(state: cython.int) -> cython.double:
    """By which sign the load adds to the friction force."""
    return 1.0 if state == POSITIVE else -1.0 if state == NEGATIVE else 0.0
