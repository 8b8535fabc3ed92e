r"""What becomes of a small disturbance of a travelling wave while the wave goes on by a part of a period.

After 2 pi / n, in a ring of n sectors whose motion repeats after no fewer, each sector does what the one j
sectors ahead did before. So the disturbances after that time, counted from j sectors behind, obey the same
equations again: that map, `matrix`, n times over is the monodromy, and takes an n-th of the time.
"""

from __future__ import annotations

import cython
import numpy as np
import numpy.typing as npt

from fcm.stability.propagator import Propagator

if cython.compiled:
    from cython.cimports.fcm.contact.periodic.cycle import TWO_PI
    from cython.cimports.fcm.contact.periodic.slider import STICK
    from cython.cimports.fcm.stability.monodromy import Monodromy
    from cython.cimports.fcm.stability.state_sequence import StateSequence
    from cython.cimports.fcm.stability.stiffness import Stiffness
else:
    from fcm.contact.periodic.cycle import TWO_PI
    from fcm.contact.periodic.slider import STICK
    from fcm.stability.monodromy import Monodromy
    from fcm.stability.state_sequence import StateSequence
    from fcm.stability.stiffness import Stiffness


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
            self.happen(e)
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
