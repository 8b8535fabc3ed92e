r"""What becomes of a small disturbance of a periodic motion within one period, slow or fast.

Of a motion whose contacts' states are known over the period, a disturbance obeys linear equations with
coefficients constant between the events. With modes of mass 1, shapes P_u, P_v at the contacts, theta = omega t:

    omega^2 q'' + 2 zeta_i w_i omega q' + w_i^2 q = - sum over the contacts (P_u df + P_v dn)

    stick       df = k_u (du - dw), dn = k_v dv      dw constant: where the slider came to rest
    slip        df = +-mu k_v dv,   dn = k_v dv
    separation  df = dn = 0

The forces are continuous, so events do not make q or q' jump, and their instants do not matter but where they
decide what the slider remembers: at the end of a slip dw = du -+ mu k_v dv / k_u, as the limit is at its extreme;
at a closing w = u where the load vanishes, so dw = du - u' dv / v'.

Modes far above the harmonics follow the contacts' forces as if these were steady, by their flexibility.
"""

from __future__ import annotations

import cython
import numpy as np
import numpy.typing as npt
from cython.cimports.libc.math import ceil, fabs, sqrt

if cython.compiled:
    from cython.cimports.fcm.contact.periodic.cycle import NEGATIVE, POSITIVE, SEPARATION, STICK, TWO_PI
    from cython.cimports.fcm.harmonic.sequence import Sequence
else:
    from fcm.contact.periodic.cycle import NEGATIVE, POSITIVE, SEPARATION, STICK, TWO_PI
    from fcm.harmonic.sequence import Sequence

REACH = cython.declare(cython.double, 6.0)  # of a step, in radians of the fastest motion
SMALL = cython.declare(cython.double, 1e-13)  # of the last term of the series
LARGE = cython.declare(cython.int, 3000)  # products from which on BLAS is faster


@cython.cclass
class Monodromy:
    """`follow` a sequence: `matrix` is then the derivative of (q, q', w) after a period by that before.

    Parameters
    ----------
    shapes : (mode, port), natural, damping : (mode,)
        Of the modes that move; ports u_1, v_1, u_2, ... as in `Linear`.
    flexibility : (port, port) or None
        Of the modes that follow without delay.
    sequence : Sequence
        What it has looked at last is followed.
    """

    def __init__(
        self,
        shapes: npt.NDArray[np.float64],
        natural: npt.NDArray[np.float64],
        damping: npt.NDArray[np.float64],
        flexibility: npt.NDArray[np.float64] | None,
        sequence: Sequence,
    ) -> None:
        modes, ports = shapes.shape
        contacts = ports // 2
        self.modes, self.contacts, self.sequence = modes, contacts, sequence
        self.size = 2 * modes + contacts
        self.shapes = np.ascontiguousarray(shapes)
        self.natural, self.damping = np.array(natural), np.array(damping)
        self.flexibility, self.soft = flexibility, flexibility is not None
        self.contact, self.state = sequence.contact, np.zeros(contacts, dtype=np.intc)
        self.S, self.B = np.zeros((ports, ports)), np.zeros((ports, contacts))
        self.T, self.W = np.zeros((ports, ports)), np.zeros((ports, contacts))
        self.K, self.image = np.zeros((modes, modes)), np.zeros((modes, contacts))
        self.port = np.zeros((2, self.size))
        self.X, self.term = np.zeros((self.size, self.size)), np.zeros((2 * modes, self.size))
        self.work = np.zeros((modes, max(self.size, ports)))
        self.memories, self.omega, self.rate = 0, 1.0, 1.0

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def follow(self, omega: cython.double) -> cython.int:
        """Fill the matrix for a frequency."""
        s: Sequence = self.sequence
        i: cython.int
        e: cython.int
        length: cython.double
        self.omega = omega
        self.begin()
        if s.events == 0:
            self.propagate(TWO_PI)
        for i in range(s.events):
            e = s.order[i]
            self.happen(e)
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
        row: cython.Py_ssize_t = 2 * self.modes
        columns: cython.Py_ssize_t = row + self.memories
        made = np.empty((columns, columns))
        out: cython.double[:, ::1] = made
        out[:row, :] = self.X[:row, :columns]
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
        c: cython.int
        self.memories = 0
        self.state[:] = self.sequence.state
        self.X[:, :] = 0.0
        for i in range(2 * self.modes):
            self.X[i, i] = 1.0
        for c in range(self.contacts):
            if self.sequence.remembers[c]:
                self.X[2 * self.modes + c, 2 * self.modes + self.memories] = 1.0
                self.memories += 1
        return self.assemble()

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def happen(self, e: cython.int) -> cython.int:
        """An event: what the slider remembers of the disturbance, and the new state."""
        c: cython.int = self.sequence.whose[e]
        columns: cython.Py_ssize_t = 2 * self.modes + self.memories
        side: cython.int
        i: cython.Py_ssize_t
        k: cython.Py_ssize_t
        row: cython.Py_ssize_t = 2 * self.modes + c
        weight: cython.double
        if self.sequence.into[e] == STICK:
            for side in range(2):
                if self.soft:
                    shapes = np.asarray(self.T)[2 * c + side] @ np.asarray(self.shapes).T
                    at = shapes @ np.asarray(self.X)[: self.modes]
                    at += np.asarray(self.W)[2 * c + side] @ np.asarray(self.X)[2 * self.modes :]
                    np.asarray(self.port)[side] = at
                else:
                    for k in range(columns):
                        self.port[side, k] = 0.0
                    for i in range(self.modes):
                        weight = self.shapes[i, 2 * c + side]
                        for k in range(columns):
                            self.port[side, k] += weight * self.X[i, k]
            weight = self.sequence.along[e] * self.contact[c, 0] * self.contact[c, 2] / self.contact[c, 1]
            for k in range(columns):
                self.X[row, k] = self.port[0, k] + weight * self.port[1, k]
        else:
            for k in range(columns):
                self.X[row, k] = 0.0
        self.state[c] = self.sequence.into[e]
        return 0

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def assemble(self) -> cython.int:
        """Stiffness of the modes with the contacts as they are, and what the sliders' places do to them."""
        c: cython.int
        i: cython.Py_ssize_t
        j: cython.Py_ssize_t
        p: cython.Py_ssize_t
        q: cython.Py_ssize_t
        unit: cython.double = 1.0 / (self.omega * self.omega)
        total: cython.double
        rows: cython.double = 0.0  # two bounds of the eigenvalues of K: its sums of rows,
        own: cython.double = 0.0  # and the greatest of the modes with the norm of what the contacts add
        squares: cython.double = 0.0
        damped: cython.double = 0.0
        self.S[:, :] = 0.0
        self.B[:, :] = 0.0
        for c in range(self.contacts):
            if self.state[c] != SEPARATION:
                self.S[2 * c + 1, 2 * c + 1] = self.contact[c, 2]
            if self.state[c] == STICK:
                self.S[2 * c, 2 * c] = self.B[2 * c, c] = self.contact[c, 1]
            elif self.state[c] == POSITIVE:
                self.S[2 * c, 2 * c + 1] = self.contact[c, 0] * self.contact[c, 2]
            elif self.state[c] == NEGATIVE:
                self.S[2 * c, 2 * c + 1] = -self.contact[c, 0] * self.contact[c, 2]
        if self.soft:
            self.soften()
        for i in range(self.modes):
            for q in range(2 * self.contacts):
                total = 0.0
                for p in range(2 * self.contacts):
                    total += self.shapes[i, p] * self.S[p, q]
                self.work[i, q] = total * unit
            for c in range(self.contacts):
                total = 0.0
                for p in range(2 * self.contacts):
                    total += self.shapes[i, p] * self.B[p, c]
                self.image[i, c] = total * unit
        for i in range(self.modes):
            total = 0.0
            for j in range(self.modes):
                held: cython.double = 0.0
                for q in range(2 * self.contacts):
                    held += self.work[i, q] * self.shapes[j, q]
                squares += held * held
                self.K[i, j] = held + (self.natural[i] * self.natural[i] * unit if i == j else 0.0)
                total += fabs(self.K[i, j])
            rows = max(rows, total)
            own = max(own, self.natural[i] * self.natural[i] * unit)
            damped = max(damped, 2.0 * self.damping[i] * self.natural[i] / self.omega)
        self.rate = sqrt(min(rows, own + sqrt(squares))) + damped
        return 0

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def soften(self) -> cython.int:
        """Contacts in series with the flexibility C of the modes that follow: ports d = P q - C (S d - B w)."""
        S, B, C = np.asarray(self.S), np.asarray(self.B), self.flexibility
        T = np.linalg.inv(np.eye(S.shape[0]) + C @ S)
        W = T @ C @ B
        np.asarray(self.T)[:], np.asarray(self.W)[:] = T, W
        B -= S @ W
        S[:] = S @ T
        return 0

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def propagate(self, length: cython.double) -> cython.int:
        """X by the series of the exponential, in steps in which its terms do not grow large."""
        steps: cython.int = cython.cast(cython.int, ceil(self.rate * length / REACH))
        i: cython.int
        h: cython.double
        steps = max(steps, 1)
        h = length / steps
        for i in range(steps):  # noqa: B007
            self.apply(h)
        return 0

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def apply(self, h: cython.double) -> cython.int:
        """One step: X plus the terms (A h)^j X / j!, A (q, q') = (q', B w - K q - D q')."""
        m: cython.Py_ssize_t = self.modes
        columns: cython.Py_ssize_t = 2 * m + self.memories
        big: cython.bint = m * m * columns > LARGE
        i: cython.Py_ssize_t
        j: cython.Py_ssize_t
        k: cython.Py_ssize_t
        order: cython.int = 0
        size: cython.double = 1.0
        weight: cython.double
        damped: cython.double
        share: cython.double
        for i in range(2 * m):
            for k in range(columns):
                self.term[i, k] = self.X[i, k]
        while size > SMALL or order < 2:
            order += 1
            share = h / order
            size *= self.rate * share
            if big:
                np.matmul(self.K, self.term[:m], out=np.asarray(self.work)[:, : self.size])
            for i in range(m):
                if not big:
                    for k in range(columns):
                        self.work[i, k] = 0.0
                    for j in range(m):
                        weight = self.K[i, j]
                        for k in range(columns):
                            self.work[i, k] += weight * self.term[j, k]
                damped = 2.0 * self.damping[i] * self.natural[i] / self.omega
                if damped != 0.0:
                    for k in range(columns):
                        self.work[i, k] += damped * self.term[m + i, k]
                if order == 1:
                    for j in range(self.contacts):
                        weight = self.image[i, j]
                        if weight != 0.0:
                            for k in range(columns):
                                self.work[i, k] -= weight * self.X[2 * m + j, k]
            for i in range(m):
                for k in range(columns):
                    self.term[i, k] = share * self.term[m + i, k]
                    self.term[m + i, k] = -share * self.work[i, k]
                    self.X[i, k] += self.term[i, k]
                    self.X[m + i, k] += self.term[m + i, k]
        return 0
