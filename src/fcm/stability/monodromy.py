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

from fcm.stability.propagator import Propagator

if cython.compiled:
    from cython.cimports.fcm.contact.periodic.cycle import TWO_PI
    from cython.cimports.fcm.contact.periodic.slider import STICK
    from cython.cimports.fcm.stability.disturbance import Disturbances
    from cython.cimports.fcm.stability.state_sequence import StateSequence
    from cython.cimports.fcm.stability.stiffness import Stiffness
else:
    from fcm.contact.periodic.cycle import TWO_PI
    from fcm.contact.periodic.slider import STICK
    from fcm.stability.disturbance import Disturbances
    from fcm.stability.state_sequence import StateSequence
    from fcm.stability.stiffness import Stiffness


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
    def happen(self, e: cython.int) -> cython.int:
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
