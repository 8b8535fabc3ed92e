r"""A balanced motion with the harmonics that its own forces make beyond those that were balanced.

The forces of the motion have all harmonics. What the structure answers to those F_h that were left out,

    X_h = -G(h omega) F_h,

without its feedback on the forces, brings the motion nearer to the true one: the multipliers about it err
five to ten times less, and what it changes of them says how wrong they may be.

A structure that resists less than its contacts do, as the halves of a joint, would so answer with many times
the motion itself: where |G K| > 1 at a port the contacts resist, too, as they do in the mean over the cycle,

    (1 + G(h omega) K) X_h = -G(h omega) F_h,

with K of k_u while they stick, k_v while they are closed, and of +-mu k_v while they slip.
"""

from __future__ import annotations

import cython
import numpy as np
import numpy.typing as npt

from fcm.contact.periodic.workspace import periodic_contact
from fcm.structure.receptance import Receptance

if cython.compiled:
    from cython.cimports.fcm.contact.periodic.cycle import TWO_PI
    from cython.cimports.fcm.contact.periodic.slider import NEGATIVE, POSITIVE, SEPARATION, STICK
    from cython.cimports.fcm.continuation.elimination import eliminate, substitute
else:
    from fcm.contact.periodic.cycle import TWO_PI
    from fcm.contact.periodic.slider import NEGATIVE, POSITIVE, SEPARATION, STICK
    from fcm.continuation.elimination import eliminate, substitute

FEWEST, MOST = 6, 15  # harmonics beyond the highest that was balanced
PORTS = 20  # up to which their equations are solved without leaving compiled code


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
        self.spring, self.coupling = np.zeros(2 * self.contacts), np.zeros(self.contacts)
        size = 4 * self.contacts if seen.ports <= PORTS else 0
        self.matrix, self.right = np.zeros((size, size)), np.zeros(size)
        self.swapped = np.zeros(size, dtype=np.intc)

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
            self.resists(c)
        self.unknowns(z)
        for h in range(self.place.shape[0]):
            if self.place[h] < 0 and self.seen.ports <= PORTS:
                self.displace(h)
            elif self.place[h] < 0:
                self.displace_many(h)
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
    def resists(self, c: cython.Py_ssize_t) -> cython.void:
        """The mean stiffness of a contact over the cycle that was evaluated last."""
        p: cython.int
        stick: cython.double = 0.0
        closed: cython.double = 0.0
        pushed: cython.double = 0.0
        for p in range(self.kernel.cycle.pieces):
            state: cython.int = self.kernel.cycle.state[p]
            last: cython.bint = p + 1 == self.kernel.cycle.pieces
            end: cython.double = self.kernel.cycle.begin[0] if last else self.kernel.cycle.begin[p + 1]
            length: cython.double = end - self.kernel.cycle.begin[p]
            while length < 0.0 or (last and length <= 0.0):
                length += TWO_PI
            length /= TWO_PI
            closed += length if state != SEPARATION else 0.0
            stick += length if state == STICK else 0.0
            pushed += length if state == POSITIVE else -length if state == NEGATIVE else 0.0
        self.spring[2 * c] = stick * self.contact[c, 1] if self.contact[c, 0] > 0.0 else 0.0
        self.spring[2 * c + 1] = closed * self.contact[c, 2]
        self.coupling[c] = pushed * self.contact[c, 0] * self.contact[c, 2]

    @cython.cfunc
    @cython.exceptval(check=False)
    def displace(self, h: cython.Py_ssize_t) -> cython.void:
        """What the structure answers in one harmonic that was left out, at few ports."""
        p: cython.Py_ssize_t
        q: cython.Py_ssize_t
        at: cython.Py_ssize_t
        G_re: cython.double
        G_im: cython.double
        resisted: cython.bint = False
        for p in range(2 * self.contacts):
            G_re, G_im = self.seen.G_re[h, p, p], self.seen.G_im[h, p, p]
            resisted = resisted or (G_re * G_re + G_im * G_im) * self.spring[p] * self.spring[p] > 1.0
        for p in range(2 * self.contacts):
            self.right[2 * p] = self.right[2 * p + 1] = 0.0
            for q in range(2 * self.contacts):
                at = 2 + 4 * h + 2 * (q % 2)
                G_re, G_im = self.seen.G_re[h, p, q], self.seen.G_im[h, p, q]
                self.right[2 * p] -= G_re * self.force[q // 2, at] - G_im * self.force[q // 2, at + 1]
                self.right[2 * p + 1] -= G_re * self.force[q // 2, at + 1] + G_im * self.force[q // 2, at]
                if not resisted:
                    continue
                re: cython.double = G_re * self.spring[q]
                im: cython.double = G_im * self.spring[q]
                if q % 2 == 1:  # the normal displacement changes the friction force of a slip
                    re += self.seen.G_re[h, p, q - 1] * self.coupling[q // 2]
                    im += self.seen.G_im[h, p, q - 1] * self.coupling[q // 2]
                self.matrix[2 * p, 2 * q] = self.matrix[2 * p + 1, 2 * q + 1] = re
                self.matrix[2 * p + 1, 2 * q] = im
                self.matrix[2 * p, 2 * q + 1] = -im
            if resisted:
                self.matrix[2 * p, 2 * p] += 1.0
                self.matrix[2 * p + 1, 2 * p + 1] += 1.0
        if resisted and eliminate(self.matrix, self.swapped) != 0.0:
            substitute(self.matrix, self.swapped, self.right)
        for p in range(2 * self.contacts):
            at = (p // 2) * self.wide + 2 + 4 * h + 2 * (p % 2)
            self.x[at], self.x[at + 1] = self.right[2 * p], self.right[2 * p + 1]

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def displace_many(self, h: cython.int) -> cython.int:
        """The same at many ports, by modes where these are fewer."""
        first = 2 + 4 * h
        forces = np.asarray(self.force)[:, first : first + 4].reshape(-1, 2)
        F = forces[:, 0] + 1j * forces[:, 1]
        spring, coupling = np.asarray(self.spring), np.asarray(self.coupling)
        if self.seen.summed:
            G = self.seen.between(h)
            X = -(G @ F)
            if (np.abs(G.diagonal()) * spring > 1.0).any():
                GK = G * spring
                GK[:, 1::2] += G[:, ::2] * coupling
                X = np.asarray(np.linalg.solve(np.eye(len(G)) + GK, X), dtype=np.complex128)
        else:
            P = np.asarray(self.seen.shapes)
            c = np.asarray(self.seen.c_re)[h] + 1j * np.asarray(self.seen.c_im)[h]
            q = -c * (P @ F)
            if (np.abs(c @ np.square(P)) * spring > 1.0).any():
                PK = P * spring
                PK[:, 1::2] += P[:, ::2] * coupling
                q = np.linalg.solve(np.eye(len(c)) + c[:, None] * (PK @ P.T), q)
            X = q @ P
        whole = np.asarray(self.x).reshape(self.contacts, self.wide)
        whole[:, first : first + 4] = np.stack((X.real, X.imag), axis=1).reshape(self.contacts, 4)
        return 0
