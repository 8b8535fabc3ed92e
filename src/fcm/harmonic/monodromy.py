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
"""

from __future__ import annotations

import cython
import numpy as np
import numpy.typing as npt
from cython.cimports.libc.math import ceil

from fcm.harmonic.propagator import Propagator

if cython.compiled:
    from cython.cimports.fcm.contact.periodic.cycle import TWO_PI
    from cython.cimports.fcm.contact.periodic.slider import STICK
    from cython.cimports.fcm.harmonic.stiffness import Stiffness
    from cython.cimports.fcm.harmonic.transitions import Transitions
else:
    from fcm.contact.periodic.cycle import TWO_PI
    from fcm.contact.periodic.slider import STICK
    from fcm.harmonic.stiffness import Stiffness
    from fcm.harmonic.transitions import Transitions

REACH = cython.declare(cython.double, 6.0)  # of a step, in radians of the fastest motion
SMALL = cython.declare(cython.double, 1e-13)  # bound of the last term of the series, relative to the first
LARGE = cython.declare(cython.int, 3000)  # products from which on BLAS is faster
FEW = cython.declare(cython.int, 12)  # disturbances up to which the exponential itself is made, by squaring
SHORT = cython.declare(
    cython.double, 0.25
)  # angle, in radians of the fastest motion, from which it is squared
ORDER = cython.declare(cython.int, 10)  # of its series there: 0.25^11 / 11! is below rounding


@cython.cclass
class Monodromy:
    """`follow` transitions: `matrix` is then the derivative of (q, q', w) after a period by that before.

    Velocities are by the angle. Followed is the motion that they looked at last.
    """

    def __init__(
        self, stiffness: Stiffness, transitions: Transitions, propagator: Propagator | None = None
    ) -> None:
        modes, contacts = stiffness.modes, stiffness.contacts
        self.modes, self.contacts, self.stiffness, self.transitions = modes, contacts, stiffness, transitions
        self.size = 2 * modes + contacts
        self.state = np.zeros(contacts, dtype=np.intc)
        self.port = np.zeros((2, self.size))
        self.X, self.term = np.zeros((self.size, self.size)), np.zeros((2 * modes, self.size))
        self.work = np.zeros((modes, self.size))
        self.A, self.E, self.F = np.zeros((3, 2 * modes, self.size))
        self.memories, self.propagator = 0, propagator or Propagator()

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def follow(self, omega: cython.double) -> cython.int:
        """Fill the matrix for a frequency."""
        s: Transitions = self.transitions
        i: cython.int
        e: cython.int
        length: cython.double
        self.stiffness.at(omega)
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
            self.stiffness.assemble(self.state)
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
            if self.transitions.remembers[c]:
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
        self.state[:] = self.transitions.state
        self.X[:, :] = 0.0
        for i in range(2 * self.modes):
            self.X[i, i] = 1.0
        for c in range(self.contacts):
            if self.transitions.remembers[c]:
                self.X[2 * self.modes + c, 2 * self.modes + self.memories] = 1.0
                self.memories += 1
        return self.stiffness.assemble(self.state)

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def happen(self, e: cython.int) -> cython.int:
        """An event: what the slider remembers of the disturbance, and the new state."""
        c: cython.int = self.transitions.whose[e]
        k: cython.Py_ssize_t
        row: cython.Py_ssize_t = 2 * self.modes + c
        mu: cython.double = self.stiffness.contact[c, 0]
        k_u: cython.double = self.stiffness.contact[c, 1]
        k_v: cython.double = self.stiffness.contact[c, 2]
        if self.transitions.into[e] == STICK:
            self.stiffness.displacement(2 * c, self.X, self.port[0])
            self.stiffness.displacement(2 * c + 1, self.X, self.port[1])
            weight: cython.double = self.transitions.along[e] * mu * k_v / k_u
            for k in range(self.size):
                self.X[row, k] = self.port[0, k] + weight * self.port[1, k]
        else:
            for k in range(self.size):
                self.X[row, k] = 0.0
        self.state[c] = self.transitions.into[e]
        return 0

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def propagate(self, length: cython.double) -> cython.int:
        """X by the exponential, by the state's eigenvalues, or by a series in steps in which its terms do not
        grow large."""
        if self.size <= FEW:
            return self.jump(length)
        s: Stiffness = self.stiffness
        system = np.asarray(s.K), np.asarray(s.damping), np.asarray(s.image)
        columns: cython.Py_ssize_t = 2 * self.modes + self.memories
        X = np.asarray(self.X)[:, :columns]
        if self.propagator.through(np.asarray(self.state), length, s.omega, system, X):
            return 0
        steps: cython.int = cython.cast(cython.int, ceil(self.stiffness.rate * length / REACH))
        i: cython.int
        steps = max(steps, 1)
        for i in range(steps):  # noqa: B007
            self.apply(length / steps)
        return 0

    @cython.cfunc
    @cython.exceptval(check=False)
    def jump(self, length: cython.double) -> cython.int:
        """X by the rows of the exponential for (q, q'), from a short angle by squaring."""
        m: cython.Py_ssize_t = self.modes
        n: cython.Py_ssize_t = self.size
        i: cython.Py_ssize_t
        j: cython.Py_ssize_t
        order: cython.int
        squarings: cython.int = 0
        while self.stiffness.rate * length > SHORT:
            length *= 0.5
            squarings += 1
        for i in range(m):
            for j in range(n):
                self.A[i, j] = length if j == m + i else 0.0
                self.A[m + i, j] = 0.0
            for j in range(m):
                self.A[m + i, j] = -length * self.stiffness.K[i, j]
            self.A[m + i, m + i] = -length * self.stiffness.damping[i]
            for j in range(self.contacts):
                self.A[m + i, 2 * m + j] = length * self.stiffness.image[i, j]
        self.E[:, :] = self.A
        for order in range(ORDER, 1, -1):  # A (1 + A / 2 (1 + A / 3 (...)))
            self.product(self.A, self.E, 1.0 / order)
            for i in range(2 * m):
                for j in range(n):
                    self.E[i, j] = self.A[i, j] + self.F[i, j]
        for order in range(squarings):  # (1 + E)^2 = 1 + 2 E + E^2, without the rounding of 1 + E  # noqa: B007
            self.product(self.E, self.E, 1.0)
            for i in range(2 * m):
                for j in range(n):
                    self.E[i, j] = 2.0 * self.E[i, j] + self.F[i, j]
        self.product(self.E, self.X, 1.0)
        for i in range(2 * m):
            for j in range(2 * m, n):  # the product leaves out the places of the sliders, which stay
                weight: cython.double = self.E[i, j]
                for order in range(n):
                    self.F[i, order] += weight * self.X[j, order]
            for j in range(n):
                self.X[i, j] += self.F[i, j]
        return 0

    @cython.cfunc
    @cython.exceptval(check=False)
    def product(
        self, left: cython.double[:, ::1], right: cython.double[:, ::1], factor: cython.double
    ) -> cython.void:
        """F = factor left right, of the rows of (q, q')."""
        i: cython.Py_ssize_t
        j: cython.Py_ssize_t
        k: cython.Py_ssize_t
        weight: cython.double
        for i in range(2 * self.modes):
            for k in range(self.size):
                self.F[i, k] = 0.0
            for j in range(2 * self.modes):
                weight = factor * left[i, j]
                if weight != 0.0:
                    for k in range(self.size):
                        self.F[i, k] += weight * right[j, k]

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def apply(self, h: cython.double) -> cython.int:
        """One step: X plus the terms (A h)^j X / j!, A (q, q', w) = (q', image w - K q - D q', 0)."""
        m: cython.Py_ssize_t = self.modes
        columns: cython.Py_ssize_t = 2 * m + self.memories
        big: cython.bint = m * m * columns > LARGE
        K: cython.double[:, ::1] = self.stiffness.K
        i: cython.Py_ssize_t
        j: cython.Py_ssize_t
        k: cython.Py_ssize_t
        order: cython.int = 0
        size: cython.double = 1.0
        weight: cython.double
        share: cython.double
        self.term[:, :] = self.X[: 2 * m, :]
        while size > SMALL or order < 2:
            order += 1
            share = h / order
            size *= self.stiffness.rate * share
            if big:
                np.matmul(K, self.term[:m], out=np.asarray(self.work))
            for i in range(m):
                if not big:
                    for k in range(columns):
                        self.work[i, k] = 0.0
                    for j in range(m):
                        weight = K[i, j]
                        for k in range(columns):
                            self.work[i, k] += weight * self.term[j, k]
                weight = self.stiffness.damping[i]
                for k in range(columns):
                    self.work[i, k] += weight * self.term[m + i, k]
                if order == 1:
                    for j in range(self.contacts):
                        weight = self.stiffness.image[i, j]
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
