"""What becomes of a small disturbance of a periodic motion within one period, slow or fast.

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
"""

from __future__ import annotations

import cython
import numpy as np
import numpy.typing as npt

from fcm.stability.disturbance import Propagator

if cython.compiled:
    from cython.cimports.fcm.contact.periodic.cycle import STICK, TWO_PI
    from cython.cimports.fcm.stability.disturbance import Disturbances, Stiffness
    from cython.cimports.fcm.stability.state_sequence import StateSequence
else:
    from fcm.contact.periodic.cycle import STICK, TWO_PI
    from fcm.stability.disturbance import Disturbances, Stiffness
    from fcm.stability.state_sequence import StateSequence


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
