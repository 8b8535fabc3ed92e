r"""Stiffness of the modes with contacts of which each sticks, slips or is open, in the angle theta = omega t.

    q'' + D q' + K q = image w

with modes of mass 1 and w the places where the sliders that stick have come to rest.
"""

from __future__ import annotations

import cython
import numpy as np
import numpy.typing as npt
from cython.cimports.libc.math import fabs, sqrt

from fcm.model.scene import FloatArray

if cython.compiled:
    from cython.cimports.fcm.contact.periodic.slider import NEGATIVE, POSITIVE, SEPARATION, STICK
else:
    from fcm.contact.periodic.slider import NEGATIVE, POSITIVE, SEPARATION, STICK


STATES = 256  # of the contacts that are remembered, or fewer:
NUMBERS = 4_000_000  # as many as these are in their matrices


@cython.cclass
class Stiffness:
    """`at` a frequency, `assemble` states of the contacts; `make` then K (mode, mode), image (mode, contact).

    damping (mode,) is the diagonal of D; rate bounds how fast the motion turns, per radian. Modes that follow
    without delay are given by their flexibility (port, port), with contacts in series.
    """

    def __init__(
        self,
        shapes: npt.NDArray[np.float64],
        natural: npt.NDArray[np.float64],
        damping: npt.NDArray[np.float64],
        flexibility: npt.NDArray[np.float64] | None,
        contact: npt.NDArray[np.float64],
    ) -> None:
        modes, ports = shapes.shape
        contacts = ports // 2
        self.modes, self.contacts = modes, contacts
        self.shapes, self.contact = np.ascontiguousarray(shapes), np.ascontiguousarray(contact)
        self.natural, self.ratio = np.array(natural), np.array(damping)
        self.soft = flexibility is not None
        self.flexibility = np.zeros((ports, ports)) if flexibility is None else flexibility
        self.S, self.B = np.zeros((ports, ports)), np.zeros((ports, contacts))
        self.seen, self.W = self.shapes, np.zeros((ports, contacts))
        self.known: dict[bytes, tuple[FloatArray, ...]] = {}
        self.most = min(STATES, NUMBERS // max(ports * (2 * ports + modes), 1))
        self.K, self.image = np.zeros((modes, modes)), np.zeros((modes, contacts))
        self.work, self.damping = np.zeros((modes, ports)), np.zeros(modes)
        self.omega, self.rate, self.made = 1.0, 1.0, False

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def at(self, omega: cython.double) -> cython.int:
        """Take a frequency."""
        i: cython.Py_ssize_t
        self.omega, self.made = omega, False
        for i in range(self.modes):
            self.damping[i] = 2.0 * self.ratio[i] * self.natural[i] / omega
        return 0

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def assemble(self, state: cython.int[::1], key: bytes) -> cython.int:
        """Take states of the contacts, known by a key; K, image and rate are made when they are needed."""
        self.made = False
        if not self.soft:
            self.contacts_alone(state)
            return 0
        if key not in self.known:
            if len(self.known) >= self.most:
                self.known.clear()
            self.S, self.B = np.empty_like(self.S), np.empty_like(self.B)
            self.contacts_alone(state)
            self.known[key] = self.softened()
        self.S, self.B, self.seen, self.W = self.known[key]
        return 0

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def make(self) -> cython.int:
        """Fill K, image and rate."""
        if not self.made:
            self.condense()
            self.modal()
            self.made = True
        return 0

    def system(self) -> tuple[FloatArray, FloatArray, FloatArray]:
        """K, D (mode,) and image."""
        self.make()
        return np.asarray(self.K), np.asarray(self.damping), np.asarray(self.image)

    @cython.cfunc
    @cython.exceptval(check=False)
    def contacts_alone(self, state: cython.int[::1]) -> cython.void:
        """Forces on the ports S d - B w of the displacements d of the ports."""
        c: cython.int
        self.S[:, :] = 0.0
        self.B[:, :] = 0.0
        for c in range(self.contacts):
            if state[c] != SEPARATION:
                self.S[2 * c + 1, 2 * c + 1] = self.contact[c, 2]
            if state[c] == STICK:
                self.S[2 * c, 2 * c] = self.B[2 * c, c] = self.contact[c, 1]
            elif state[c] == POSITIVE:
                self.S[2 * c, 2 * c + 1] = self.contact[c, 0] * self.contact[c, 2]
            elif state[c] == NEGATIVE:
                self.S[2 * c, 2 * c + 1] = -self.contact[c, 0] * self.contact[c, 2]

    def softened(self) -> tuple[FloatArray, ...]:
        """S, B, and displacements of the ports by modes (mode, port) and by places (port, contact).

        In series with the flexibility C: d = P q - C (S d - B w) = T P q + W w.
        """
        S, B, C = np.asarray(self.S), np.asarray(self.B), self.flexibility
        T = np.linalg.inv(np.eye(S.shape[0]) + C @ S)
        W = T @ C @ B
        return S @ T, B - S @ W, np.ascontiguousarray(np.asarray(self.shapes) @ T.T), W

    @cython.cfunc
    @cython.exceptval(check=False)
    def condense(self) -> cython.void:
        """Forces of the ports on the modes, over omega^2."""
        c: cython.int
        i: cython.Py_ssize_t
        p: cython.Py_ssize_t
        q: cython.Py_ssize_t
        unit: cython.double = 1.0 / (self.omega * self.omega)
        total: cython.double
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

    @cython.cfunc
    @cython.exceptval(check=False)
    def modal(self) -> cython.void:
        """K, and the rate from two bounds of its eigenvalues.

        They are the greatest sum of a row; and that of a mode alone, with the norm of what the contacts add.
        """
        i: cython.Py_ssize_t
        j: cython.Py_ssize_t
        q: cython.Py_ssize_t
        own: cython.double
        held: cython.double
        total: cython.double
        rows: cython.double = 0.0
        alone: cython.double = 0.0
        squares: cython.double = 0.0
        damped: cython.double = 0.0
        for i in range(self.modes):
            own = self.natural[i] / self.omega
            own *= own
            total = 0.0
            for j in range(self.modes):
                held = 0.0
                for q in range(2 * self.contacts):
                    held += self.work[i, q] * self.shapes[j, q]
                squares += held * held
                self.K[i, j] = held + own if i == j else held
                total += fabs(self.K[i, j])
            rows, alone, damped = max(rows, total), max(alone, own), max(damped, self.damping[i])
        self.rate = sqrt(min(rows, alone + sqrt(squares))) + damped

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def displacement(
        self, port: cython.Py_ssize_t, X: cython.double[:, ::1], out: cython.double[::1]
    ) -> cython.int:
        """Of a port, for the columns (q, q', w) of X."""
        i: cython.Py_ssize_t
        k: cython.Py_ssize_t
        weight: cython.double
        for k in range(out.shape[0]):
            out[k] = 0.0
        for i in range(self.modes):
            weight = self.seen[i, port]
            for k in range(out.shape[0]):
                out[k] += weight * X[i, k]
        if self.soft:
            for i in range(self.contacts):
                weight = self.W[port, i]
                for k in range(out.shape[0]):
                    out[k] += weight * X[2 * self.modes + i, k]
        return 0
