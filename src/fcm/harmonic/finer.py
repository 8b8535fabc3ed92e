r"""A balanced motion with the harmonics that its own forces make beyond those that were balanced.

The forces of the motion have all harmonics. What the structure answers to those that were left out,
X_h = -G(h omega) F_h, without its feedback on the forces, brings the motion nearer to the true one: the
multipliers about it err five to ten times less, and what it changes of them says how wrong they may be.
"""

from __future__ import annotations

import cython
import numpy as np
import numpy.typing as npt

from fcm.contact.periodic.workspace import periodic_contact
from fcm.structure.receptance import Receptance

FEWEST, MOST = 6, 15  # harmonics beyond the highest that was balanced


def beyond(harmonics: list[int]) -> list[int]:
    """The harmonics of the finer motion: all, and as many again beyond the highest."""
    highest = max(harmonics)
    return list(range(1, highest + min(max(highest, FEWEST), MOST) + 1))


@cython.cclass
class Finer:
    """`at` a point z of the balance fills x, the unknowns of the finer motion; contact as in `Transitions`.

    shift is the greatest amplitude that was added to a displacement of a contact, tangential or normal,
    relative to the greatest that there was of the same: a small normal motion opens and closes a contact as
    much as a large one does.
    """

    def __init__(self, seen: Receptance, contact: npt.NDArray[np.float64], harmonics: list[int]) -> None:
        finer = [int(h) for h in seen.harmonics]
        self.seen, self.contact = seen, contact
        self.contacts, self.width, self.wide = contact.shape[0], 2 + 4 * len(harmonics), 2 + 4 * len(finer)
        self.kernel = periodic_contact(tuple(harmonics), tuple(finer))
        self.force, self.x = np.zeros((self.contacts, self.wide)), np.zeros(self.contacts * self.wide)
        where = [harmonics.index(h) if h in harmonics else -1 for h in finer]
        self.place, self.shift = np.array(where, dtype=np.intc), 0.0

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def at(self, z: cython.double[::1]) -> cython.int:
        """Fill x."""
        c: cython.Py_ssize_t
        i: cython.Py_ssize_t
        h: cython.Py_ssize_t
        self.seen.at(z[self.contacts * self.width])
        for c in range(self.contacts):
            self.kernel.evaluate(
                z, c * self.width,
                self.contact[c, 0], self.contact[c, 1], self.contact[c, 2], self.contact[c, 3], 0.0, False,
            )  # fmt: skip
            for i in range(self.wide):
                self.force[c, i] = self.kernel.forces[i]
        self.unknowns(z)
        for h in range(self.place.shape[0]):
            if self.place[h] < 0:
                self.displace(h)
        self.shift = 0.0
        for c in range(self.contacts):
            for i in range(2):
                self.shift = max(self.shift, self.added(c, 2 * i))
        return 0

    @cython.cfunc
    @cython.exceptval(check=False)
    def added(self, c: cython.Py_ssize_t, first: cython.Py_ssize_t) -> cython.double:
        """The greatest amplitude that was added to one displacement of a contact, of which first is the first
        number of each harmonic, relative to the greatest that there was; 0 if there was none."""
        h: cython.Py_ssize_t
        i: cython.Py_ssize_t
        most: cython.double = 0.0
        new: cython.double = 0.0
        for h in range(self.place.shape[0]):
            for i in range(2):
                size: cython.double = abs(self.x[c * self.wide + 2 + 4 * h + first + i])
                if self.place[h] < 0:
                    new = max(new, size)
                else:
                    most = max(most, size)
        return new / most if most > 0.0 else 0.0

    @cython.cfunc
    @cython.exceptval(check=False)
    def unknowns(self, z: cython.double[::1]) -> cython.void:
        """What was balanced, in its places."""
        c: cython.Py_ssize_t
        i: cython.Py_ssize_t
        h: cython.Py_ssize_t
        for c in range(self.contacts):
            for i in range(2):
                self.x[c * self.wide + i] = z[c * self.width + i]
            for h in range(self.place.shape[0]):
                for i in range(4):
                    if self.place[h] >= 0:
                        self.x[c * self.wide + 2 + 4 * h + i] = z[c * self.width + 2 + 4 * self.place[h] + i]

    @cython.cfunc
    @cython.exceptval(check=False)
    def displace(self, h: cython.Py_ssize_t) -> cython.void:
        """What the structure answers in one harmonic that was left out."""
        p: cython.Py_ssize_t
        q: cython.Py_ssize_t
        at: cython.Py_ssize_t
        re: cython.double
        im: cython.double
        for p in range(2 * self.contacts):
            re = im = 0.0
            for q in range(2 * self.contacts):
                at = 2 + 4 * h + 2 * (q % 2)
                re -= self.seen.G_re[h, p, q] * self.force[q // 2, at]
                re += self.seen.G_im[h, p, q] * self.force[q // 2, at + 1]
                im -= self.seen.G_re[h, p, q] * self.force[q // 2, at + 1]
                im -= self.seen.G_im[h, p, q] * self.force[q // 2, at]
            at = (p // 2) * self.wide + 2 + 4 * h + 2 * (p % 2)
            self.x[at], self.x[at + 1] = re, im
