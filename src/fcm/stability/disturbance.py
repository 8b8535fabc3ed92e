"""Propagation of small disturbances of a periodic motion from one event to the next.

Between two events no contact changes its state. The disturbances of the modal coordinates q, of their rates
by the angle theta = omega t, and of the sliders' places w then obey

    (q, q', w)' = (q', image w - K q - D q', 0)

with constant coefficients. The exponential of this system propagates them.

K is the stiffness of the modes, of mass 1, over omega^2, with contacts that stick, slip or are open
(`Stiffness`). w are the places where sticking sliders have come to rest. With many modes, the system is
decomposed by its eigenvalues. By time instead of angle it does not depend on the frequency,

    q' = v,    v' = -K q - D v + B w,

so that each state that recurs along a curve is decomposed only once (`Propagator`).
"""

from __future__ import annotations

from collections.abc import Callable

import cython
import numpy as np
import numpy.typing as npt
from cython.cimports.libc.math import ceil, cos, expm1, fabs, sin, sqrt

from fcm.model.scene import FloatArray
from fcm.stability.options import STABILITY, PropagationOptions

if cython.compiled:
    from cython.cimports.fcm.contact.periodic.cycle import NEGATIVE, POSITIVE, SEPARATION, STICK
else:
    from fcm.contact.periodic.cycle import NEGATIVE, POSITIVE, SEPARATION, STICK


@cython.cclass
class Stiffness:
    """Stiffness of a structure with its contacts in given states, as disturbances see it.

    `at` takes a frequency, and `assemble` states of the contacts; `make` then fills K (mode, mode) and image
    (mode, contact).

    damping (mode,) is the diagonal of D. rate bounds how fast the motion turns, per radian. Modes that follow
    without delay are given by their flexibility (port, port), in series with the contacts.
    """

    def __init__(
        self,
        shapes: npt.NDArray[np.float64],
        natural: npt.NDArray[np.float64],
        damping: npt.NDArray[np.float64],
        flexibility: npt.NDArray[np.float64] | None,
        contact: npt.NDArray[np.float64],
        options: PropagationOptions = STABILITY.propagation,
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
        self.most = min(options.max_states, options.max_numbers // max(ports * (2 * ports + modes), 1))
        self.K, self.image = np.zeros((modes, modes)), np.zeros((modes, contacts))
        self.work, self.damping = np.zeros((modes, ports)), np.zeros(modes)
        self.omega, self.rate, self.made = 1.0, 1.0, False

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def at(self, omega: cython.double) -> cython.int:
        """Set the frequency."""
        i: cython.Py_ssize_t
        self.omega, self.made = omega, False
        for i in range(self.modes):
            self.damping[i] = 2.0 * self.ratio[i] * self.natural[i] / omega
        return 0

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def assemble(self, state: cython.int[::1], key: bytes) -> cython.int:
        """Set the states of the contacts, with their key; `make` fills K, image and rate when needed."""
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
        """Fill K, image and rate, unless that is done already."""
        if not self.made:
            self.condense()
            self.modal()
            self.made = True
        return 0

    def system(self) -> tuple[FloatArray, FloatArray, FloatArray]:
        """The matrices K, D (mode,) and image."""
        self.make()
        return np.asarray(self.K), np.asarray(self.damping), np.asarray(self.image)

    @cython.cfunc
    @cython.exceptval(check=False)
    def contacts_alone(self, state: cython.int[::1]) -> cython.void:
        """Fill S and B: forces on the ports are S d - B w, for displacements d of the ports."""
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
        """S and B in series with the flexibility C, and displacements of the ports by modes and by sliders.

        The displacements are (mode, port) and (port, contact): d = P q - C (S d - B w) = T P q + W w.
        """
        S, B, C = np.asarray(self.S), np.asarray(self.B), self.flexibility
        T = np.linalg.inv(np.eye(S.shape[0]) + C @ S)
        W = T @ C @ B
        return S @ T, B - S @ W, np.ascontiguousarray(np.asarray(self.shapes) @ T.T), W

    @cython.cfunc
    @cython.exceptval(check=False)
    def condense(self) -> cython.void:
        """Fill work with the forces of the ports on the modes, over omega^2."""
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
        """Fill K, and the rate by the lower of two bounds of its eigenvalues.

        One bound is the greatest sum of a row. The other is the greatest eigenvalue of a mode alone, plus the
        norm of what the contacts add.
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
        """Compute the displacement of a port for the columns (q, q', w) of X."""
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


ComplexArray = npt.NDArray[np.complex128]


@cython.cclass
class EigenExpansion:
    """Expansion of a disturbance in parts that grow by exp(value time), one for each complex pair.

    values (value,) are the eigenvalues. share (2 values, 2 modes) maps (q, v) to the parts. driven (2 values,
    contact) maps the places w to the parts that they drive; None if no contact sticks. back (2 modes, 2
    values) maps the parts to (q, v). Real and imaginary parts alternate.
    """

    def __init__(
        self, values: ComplexArray, share: FloatArray, driven: FloatArray | None, back: FloatArray
    ) -> None:
        self.re, self.im = np.array(values.real), np.array(values.imag)
        self.share, self.driven, self.back = share, driven, back
        self.modes, self.count = len(back) // 2, len(values)

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def carry(self, time: cython.double, omega: cython.double, X: FloatArray) -> cython.int:
        """Propagate the rows (q, dq / dangle) of X, above those of w, through a time."""
        rows: cython.double[:, :] = X
        m: cython.Py_ssize_t = self.modes
        i: cython.Py_ssize_t
        k: cython.Py_ssize_t
        for i in range(m, 2 * m):
            for k in range(rows.shape[1]):
                rows[i, k] *= omega
        moving = X[: 2 * m]
        parts = np.matmul(self.share, moving)
        self.grow(time, parts, None if self.driven is None else np.matmul(self.driven, X[2 * m :]))
        np.matmul(self.back, parts, out=moving)
        for i in range(m, 2 * m):
            for k in range(rows.shape[1]):
                rows[i, k] /= omega
        return 0

    @cython.cfunc
    @cython.exceptval(check=False)
    def grow(
        self, time: cython.double, part: cython.double[:, ::1], drive: cython.double[:, ::1]
    ) -> cython.void:
        """Propagate the parts (2 values, column) through a time.

        drive: the parts that the places drive, or None. They grow by (exp(value time) - 1) / value, or by the
        time if the value is 0.
        """
        i: cython.Py_ssize_t
        re: cython.double
        im: cython.double
        for i in range(self.count):
            less: cython.double = expm1(self.re[i] * time)
            half: cython.double = sin(0.5 * self.im[i] * time)
            re = less * cos(self.im[i] * time) - 2.0 * half * half
            im = (1.0 + less) * sin(self.im[i] * time)
            add_complex_product(part[2 * i], part[2 * i + 1], part[2 * i], part[2 * i + 1], re, im)
            if drive is not None:
                still: cython.bint = self.re[i] == 0.0 and self.im[i] == 0.0
                re = time if still else re
                add_complex_product(part[2 * i], part[2 * i + 1], drive[2 * i], drive[2 * i + 1], re, im)


class Propagator:
    """Propagation through states of the contacts by their eigenvalues.

    A state is identified by a key, and decomposed when it comes up for the second time.
    """

    def __init__(self, options: PropagationOptions = STABILITY.propagation) -> None:
        self.options = options
        self.known: dict[bytes, EigenExpansion | None] = {}
        self.counts: set[bytes] = set()

    def through(
        self,
        key: bytes,
        angle: float,
        omega: float,
        system: Callable[[], tuple[FloatArray, FloatArray, FloatArray]],
        X: FloatArray,
    ) -> bool:
        """Propagate the rows (q, dq / dangle) of X, above those of w, through an angle.

        False, with X unchanged, if the state is not decomposed. system returns K, D (mode,) and B of the
        equations by the angle.
        """
        parts = self._parts(key, omega, system)
        if parts is None:
            return False
        parts.carry(angle / omega, omega, X)
        return True

    def _parts(
        self, key: bytes, omega: float, system: Callable[[], tuple[FloatArray, FloatArray, FloatArray]]
    ) -> EigenExpansion | None:
        if key in self.known:
            return self.known[key]
        if key not in self.counts or len(self.known) >= self.options.max_states:
            self.counts.add(key)
            return None
        K, D, B = system()
        m = len(D)
        A = np.zeros((2 * m, 2 * m))
        A[:m, m:] = np.eye(m)
        A[m:, :m], A[m:, m:] = -omega * omega * K, -np.diag(omega * D)
        self.known[key] = _decomposed(
            A, np.vstack((np.zeros_like(B), omega * omega * B)), self.options.max_condition
        )
        return self.known[key]


def _decomposed(A: FloatArray, B: FloatArray, max_condition: float) -> EigenExpansion | None:
    """The eigenvalue expansion of a system; None if the eigenvectors are nearly dependent."""
    try:
        values, vectors = np.linalg.eig(A)
        unit = np.repeat([1.0, np.abs(values).max()], len(A) // 2)[:, None]  # of places and velocities
        if not np.linalg.cond(vectors / unit) < max_condition:
            return None
        inverse = np.linalg.inv(vectors / unit) / unit.T
    except np.linalg.LinAlgError:
        return None
    one = values.imag >= 0.0
    values, vectors, inverse = values[one].astype(np.complex128), vectors[:, one], inverse[one]
    pair = np.where(values.imag > 0.0, 2.0, 1.0)
    driven = _real((inverse @ B) / np.where(values == 0.0, 1.0, values)[:, None]) if B.any() else None
    return EigenExpansion(values, _real(inverse), driven, _real(np.conj(vectors * pair).T).T.copy())


def _real(rows: ComplexArray) -> FloatArray:
    """Complex rows (value, n) as real ones (2 values, n): real and imaginary parts alternate."""
    return np.stack((rows.real, rows.imag), axis=1).reshape(2 * len(rows), -1)


@cython.cfunc
@cython.exceptval(check=False)
def add_complex_product(
    re: cython.double[::1],
    im: cython.double[::1],
    by_re: cython.double[::1],
    by_im: cython.double[::1],
    times: cython.double,
    times_im: cython.double,
) -> cython.void:
    """Add (times + i times_im) (by_re + i by_im) to re + i im; both may be the same arrays."""
    k: cython.Py_ssize_t
    one: cython.double
    other: cython.double
    for k in range(re.shape[0]):
        one, other = by_re[k], by_im[k]
        re[k] += times * one - times_im * other
        im[k] += times * other + times_im * one


ORDER = cython.declare(cython.int, 10)  # of the series of the exponential: 0.25^11 / 11! is below rounding


@cython.cclass
class Disturbances:
    """Disturbances of a motion, propagated through the states of its contacts.

    X has the rows (q, q', w), and a disturbance in each of its first 2 modes + `memories` columns. state
    (contact,) are the states for which `stiffness` has been assembled.
    """

    def __init__(self, stiffness: Stiffness, propagator: Propagator) -> None:
        modes, contacts = stiffness.modes, stiffness.contacts
        self.modes, self.contacts, self.stiffness = modes, contacts, stiffness
        self.size = 2 * modes + contacts
        self.states, self.rows = np.zeros(contacts, dtype=np.intc), np.zeros((self.size, self.size))
        self.state, self.X, self.key = self.states, self.rows, b""  # the same memory
        self.term = np.zeros((2 * modes, self.size))
        self.work = np.zeros((modes, self.size))
        self.A, self.E, self.F = np.zeros((3, 2 * modes, self.size))
        self.memories, self.propagator, options = 0, propagator, propagator.options
        self.step_radians, self.series_tolerance = options.step_radians, options.series_tolerance
        self.max_steps, self.squared_radians = options.max_steps, options.squared_radians
        self.few, self.blas_products = options.few_disturbances, options.blas_products

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def assemble(self) -> cython.int:
        """Assemble `stiffness` for the present states of the contacts."""
        self.key = self.states.tobytes()
        return self.stiffness.assemble(self.state, self.key)

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def propagate(self, length: cython.double) -> cython.int:
        """Propagate X by the matrix exponential, by the state's eigenvalues, or by a series in steps.

        Steps are so short that the terms of the series do not grow large. If a mode is far stiffer than the
        others, there would be too many steps, and the exponential is squared instead.
        """
        if self.size <= self.few:
            return self.propagate_by_squaring(length)
        s: Stiffness = self.stiffness
        columns: cython.Py_ssize_t = 2 * self.modes + self.memories
        X = self.rows[:, :columns]
        if self.propagator.through(self.key, length, s.omega, s.system, X):
            return 0
        s.make()
        if s.rate * length > self.max_steps * self.step_radians:
            return self.propagate_by_squaring(length)
        steps: cython.int = cython.cast(cython.int, ceil(s.rate * length / self.step_radians))
        i: cython.int
        steps = max(steps, 1)
        for i in range(steps):  # noqa: B007
            self.apply(length / steps)
        return 0

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def propagate_by_squaring(self, length: cython.double) -> cython.int:
        """Propagate X by the exponential for the rows (q, q'), squared up from a short angle."""
        m: cython.Py_ssize_t = self.modes
        n: cython.Py_ssize_t = self.size
        i: cython.Py_ssize_t
        j: cython.Py_ssize_t
        order: cython.int
        squarings: cython.int = 0
        self.stiffness.make()
        while self.stiffness.rate * length > self.squared_radians:
            length *= 0.5
            squarings += 1
        self.fill_system(length)
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
        self.carry()
        return 0

    @cython.cfunc
    @cython.exceptval(check=False)
    def fill_system(self, length: cython.double) -> cython.void:
        """Fill A with the system's matrix times a length."""
        m: cython.Py_ssize_t = self.modes
        i: cython.Py_ssize_t
        j: cython.Py_ssize_t
        for i in range(m):
            for j in range(self.size):
                self.A[i, j] = length if j == m + i else 0.0
                self.A[m + i, j] = 0.0
            for j in range(m):
                self.A[m + i, j] = -length * self.stiffness.K[i, j]
            self.A[m + i, m + i] = -length * self.stiffness.damping[i]
            for j in range(self.contacts):
                self.A[m + i, 2 * m + j] = length * self.stiffness.image[i, j]

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def carry(self) -> cython.int:
        """Multiply the rows (q, q') of X by 1 + E; the places of the sliders stay."""
        i: cython.Py_ssize_t
        j: cython.Py_ssize_t
        k: cython.Py_ssize_t
        self.product(self.E, self.X, 1.0)  # leaves those places out
        for i in range(2 * self.modes):
            for j in range(2 * self.modes, self.size):
                weight: cython.double = self.E[i, j]
                for k in range(self.size):
                    self.F[i, k] += weight * self.X[j, k]
            for j in range(self.size):
                self.X[i, j] += self.F[i, j]
        return 0

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def product(
        self, left: cython.double[:, ::1], right: cython.double[:, ::1], factor: cython.double
    ) -> cython.int:
        """Fill F = factor left right, for the rows of (q, q')."""
        if self.modes * self.modes * self.size > self.blas_products:
            n: cython.Py_ssize_t = 2 * self.modes
            np.matmul(np.asarray(left)[:, :n], np.asarray(right)[:n], out=np.asarray(self.F))
            np.multiply(self.F, factor, out=np.asarray(self.F))
            return 0
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
        return 0

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def apply(self, h: cython.double) -> cython.int:
        """Take one step: X plus the terms (A h)^j X / j!, A (q, q', w) = (q', image w - K q - D q', 0)."""
        m: cython.Py_ssize_t = self.modes
        columns: cython.Py_ssize_t = 2 * m + self.memories
        i: cython.Py_ssize_t
        k: cython.Py_ssize_t
        order: cython.int = 0
        size: cython.double = 1.0
        share: cython.double
        self.term[:, :] = self.X[: 2 * m, :]
        while size > self.series_tolerance or order < 2:
            order += 1
            share = h / order
            size *= self.stiffness.rate * share
            self.add_stiffness(columns)
            if order == 1:
                self.add_sliders(columns)
            for i in range(m):
                for k in range(columns):
                    self.term[i, k] = share * self.term[m + i, k]
                    self.term[m + i, k] = -share * self.work[i, k]
                    self.X[i, k] += self.term[i, k]
                    self.X[m + i, k] += self.term[m + i, k]
        return 0

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def add_stiffness(self, columns: cython.Py_ssize_t) -> cython.int:
        """Fill work = K q + D q' of the term (q, q')."""
        m: cython.Py_ssize_t = self.modes
        K: cython.double[:, ::1] = self.stiffness.K
        big: cython.bint = m * m * columns > self.blas_products
        i: cython.Py_ssize_t
        j: cython.Py_ssize_t
        k: cython.Py_ssize_t
        weight: cython.double
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
        return 0

    @cython.cfunc
    @cython.exceptval(check=False)
    def add_sliders(self, columns: cython.Py_ssize_t) -> cython.void:
        """Subtract from work the part of the sliders, image w."""
        i: cython.Py_ssize_t
        j: cython.Py_ssize_t
        k: cython.Py_ssize_t
        weight: cython.double
        for i in range(self.modes):
            for j in range(self.contacts):
                weight = self.stiffness.image[i, j]
                if weight != 0.0:
                    for k in range(columns):
                        self.work[i, k] -= weight * self.X[2 * self.modes + j, k]
