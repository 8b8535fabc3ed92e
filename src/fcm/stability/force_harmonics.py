r"""A balanced motion with the harmonics that its own forces make beyond those that were balanced.

The forces of the motion have all harmonics. What the structure answers to those F_h that were left out,

    X_h = -G(h omega) F_h,

without its feedback on the forces, brings the motion nearer to the true one: the multipliers about it err
five to ten times less, and what it changes of them says how wrong they may be.

A structure that resists less than its contacts do, as the halves of a joint, would so answer with many times
the motion itself: where |G K| > 1 at a port the contacts resist, too, as they do in the mean over the cycle,

    (1 + G(h omega) K) X_h = -G(h omega) F_h,

with K the mean of their stiffnesses: on a line of k_u while they stick, of k_v while they are closed, and of
+-mu k_v, by the normal displacement, while they slip.
"""

from __future__ import annotations

import cython
import numpy as np

from fcm.harmonic_balance.contact_law import Law
from fcm.structure.receptance import Receptance

if cython.compiled:
    from cython.cimports.fcm.continuation.dense_solver import eliminate, substitute
else:
    from fcm.continuation.dense_solver import eliminate, substitute

FEWEST, MOST = 6, 15  # harmonics beyond the highest that was balanced
PORTS = 20  # up to which their equations are solved without leaving compiled code


def enriched_harmonics(harmonics: list[int]) -> list[int]:
    """The harmonics of the finer motion: all, and as many again beyond the highest."""
    highest = max(harmonics)
    return list(range(1, highest + min(max(highest, FEWEST), MOST) + 1))


@cython.cclass
class EnrichedMotion:
    """`at` a point z of the balance fills x, the unknowns of the finer motion.

    shift is the greatest amplitude that was added to a displacement of a contact, along it or normal to it,
    relative to the greatest that there was of the same: a small normal motion opens and closes a contact as
    much as a large one does. Not so beside a deep mean indentation, or a wide gap, to which it is relative
    where that is more; and across the motion in its plane a small one turns the slip by little.
    laws (contact,) have the balance's motion, and forces of the finer harmonics.
    """

    def __init__(self, seen: Receptance, laws: list[Law], harmonics: list[int]) -> None:
        finer = [int(h) for h in seen.harmonics]
        self.seen, self.laws, self.contacts = seen, laws, len(laws)
        self.directions = seen.ports // self.contacts if laws else 0
        self.width = self.directions * (1 + 2 * len(harmonics))
        self.wide = self.directions * (1 + 2 * len(finer))
        self.force, self.x = np.zeros((self.contacts, self.wide)), np.zeros(self.contacts * self.wide)
        where = [harmonics.index(h) if h in harmonics else -1 for h in finer]
        self.place, self.shift = np.array(where, dtype=np.intc), 0.0
        self.resistance = np.zeros((self.contacts, self.directions, self.directions))
        size = 2 * seen.ports if seen.ports <= PORTS else 0
        self.matrix, self.right = np.zeros((size, size)), np.zeros(size)
        self.swapped = np.zeros(size, dtype=np.intc)

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def at(self, z: cython.double[::1]) -> cython.int:
        """Fill x."""
        c: cython.Py_ssize_t
        i: cython.Py_ssize_t
        k: cython.Py_ssize_t
        h: cython.Py_ssize_t
        self.seen.at(z[self.contacts * self.width])
        for c in range(self.contacts):
            law: Law = self.laws[c]
            law.probe(z, c * self.width)
            law.compute_resistance()
            for i in range(self.wide):
                self.force[c, i] = law.force[i]
            for i in range(self.directions):
                for k in range(self.directions):
                    self.resistance[c, i, k] = law.resistance[i, k]
        self.unknowns(z)
        for h in range(self.place.shape[0]):
            if self.place[h] < 0 and self.seen.ports <= PORTS:
                self.displace(h)
            elif self.place[h] < 0:
                self.displace_many(h)
        self.shift = 0.0
        tangential: cython.Py_ssize_t = self.directions - 1
        for c in range(self.contacts):
            i = self.directions * c
            self.shift = max(self.shift, self.relative_addition(i, tangential, 0.0))
            closed: Law = self.laws[c]
            load: cython.double = closed.n_0 + closed.k_v * self.x[c * self.wide + tangential]
            depth: cython.double = abs(load) / closed.k_v if closed.k_v > 0.0 else 0.0
            self.shift = max(self.shift, self.relative_addition(i + tangential, 1, depth))
        return 0

    @cython.cfunc
    @cython.exceptval(check=False)
    def relative_addition(
        self, first: cython.Py_ssize_t, ports: cython.Py_ssize_t, least: cython.double
    ) -> cython.double:
        """The greatest amplitude that was added to some displacements of a contact, relative to the greatest
        that there was, and to a least; 0 if there was none."""
        h: cython.Py_ssize_t
        i: cython.Py_ssize_t
        p: cython.Py_ssize_t
        most: cython.double = least
        new: cython.double = 0.0
        for h in range(self.place.shape[0]):
            for p in range(first, first + ports):
                for i in range(2):
                    size: cython.double = abs(self.x[self.seen.wave_at[p] + self.seen.stride * h + i])
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
        each: cython.Py_ssize_t = self.directions
        for c in range(self.contacts):
            for i in range(each):
                self.x[c * self.wide + i] = z[c * self.width + i]
            for h in range(self.place.shape[0]):
                for i in range(2 * each):
                    if self.place[h] >= 0:
                        self.x[c * self.wide + each * (1 + 2 * h) + i] = (
                            z[c * self.width + each * (1 + 2 * self.place[h]) + i]
                        )  # fmt: skip

    @cython.cfunc
    @cython.exceptval(check=False)
    def displace(self, h: cython.Py_ssize_t) -> cython.void:
        """What the structure answers in one harmonic that was left out, at few ports."""
        p: cython.Py_ssize_t
        q: cython.Py_ssize_t
        c: cython.Py_ssize_t
        d: cython.Py_ssize_t
        e: cython.Py_ssize_t
        at: cython.Py_ssize_t
        each: cython.Py_ssize_t = self.directions
        G_re: cython.double
        G_im: cython.double
        re: cython.double
        im: cython.double
        resisted: cython.bint = False
        for c in range(self.contacts):
            for d in range(each):
                p = c * each + d
                G_re, G_im = self.seen.G_re[h, p, p], self.seen.G_im[h, p, p]
                re = self.resistance[c, d, d]
                resisted = resisted or (G_re * G_re + G_im * G_im) * re * re > 1.0
        for p in range(self.seen.ports):
            self.right[2 * p] = self.right[2 * p + 1] = 0.0
            for c in range(self.contacts):
                for d in range(each):
                    q, at = c * each + d, each * (1 + 2 * h) + 2 * d
                    G_re, G_im = self.seen.G_re[h, p, q], self.seen.G_im[h, p, q]
                    self.right[2 * p] -= G_re * self.force[c, at] - G_im * self.force[c, at + 1]
                    self.right[2 * p + 1] -= G_re * self.force[c, at + 1] + G_im * self.force[c, at]
                    if not resisted:
                        continue
                    re = im = 0.0  # a displacement may change the forces in other directions, too
                    for e in range(each):
                        re += self.seen.G_re[h, p, c * each + e] * self.resistance[c, e, d]
                        im += self.seen.G_im[h, p, c * each + e] * self.resistance[c, e, d]
                    self.matrix[2 * p, 2 * q] = self.matrix[2 * p + 1, 2 * q + 1] = re
                    self.matrix[2 * p + 1, 2 * q] = im
                    self.matrix[2 * p, 2 * q + 1] = -im
            if resisted:
                self.matrix[2 * p, 2 * p] += 1.0
                self.matrix[2 * p + 1, 2 * p + 1] += 1.0
        if resisted and eliminate(self.matrix, self.swapped) != 0.0:
            substitute(self.matrix, self.swapped, self.right)
        for p in range(self.seen.ports):
            at = self.seen.wave_at[p] + self.seen.stride * h
            self.x[at], self.x[at + 1] = self.right[2 * p], self.right[2 * p + 1]

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def displace_many(self, h: cython.int) -> cython.int:
        """The same at many ports, by modes where these are fewer."""
        seen, each = self.seen, self.directions
        at = np.asarray(seen.wave_at) + seen.stride * h
        force, K = np.asarray(self.force).ravel(), np.asarray(self.resistance)
        F, spring = force[at] + 1j * force[at + 1], np.diagonal(K, axis1=1, axis2=2).ravel()
        if seen.summed:
            G = seen.between(h)
            X = -(G @ F)
            if (np.abs(G.diagonal()) * spring > 1.0).any():
                GK = (G.reshape(-1, self.contacts, 1, each) @ K).reshape(G.shape)
                X = np.asarray(np.linalg.solve(np.eye(len(G)) + GK, X), dtype=np.complex128)
        else:
            P = np.asarray(seen.shapes)
            c = np.asarray(seen.c_re)[h] + 1j * np.asarray(seen.c_im)[h]
            q = -c * (P @ F)
            if (np.abs(c @ np.square(P)) * spring > 1.0).any():
                PK = (P.reshape(-1, self.contacts, 1, each) @ K).reshape(P.shape)
                q = np.linalg.solve(np.eye(len(c)) + c[:, None] * (PK @ P.T), q)
            X = q @ P
        x = np.asarray(self.x)
        x[at], x[at + 1] = X.real, X.imag
        return 0
