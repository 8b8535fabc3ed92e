r"""Linear system of a balance with many contacts, formed by modes without arrays of ports by ports.

`ModalCompliance` is the response of the structure to contact forces with all modes. `ModalEquations` is the
system closed by a row, condensed to some of the modes.

The notation is that of `modal_condensation`. `multiply` applies the full system to a vector, and `condensed`
solves the condensed system. `correct` solves the full system by GMRES (Saad and Schultz 1986), with the
condensed system as the preconditioner.
"""

from __future__ import annotations

from typing import Any

import cython
import numpy as np
import numpy.typing as npt
from cython.cimports.libc.math import fabs, hypot, isfinite, sqrt

from fcm.continuation.dense_solver import Solver
from fcm.structure.receptance import Receptance

if cython.compiled:
    from cython.cimports.fcm.harmonic_balance.modal_equations import add_rows, add_rows_of_several

DIVERGED = cython.declare(cython.double, 1e300)  # a greater length counts as infinite


@cython.cfunc
@cython.exceptval(check=False)
def sum_of_rows(
    by: cython.double[::1], matrix: cython.double[:, ::1], out: cython.double[::1]
) -> cython.void:
    """Fill out (column,) with by (row,) times matrix (row, column)."""
    if not cython.compiled:
        with np.errstate(invalid="ignore", over="ignore"):  # where Newton's method has diverged
            np.matmul(by, matrix, out=out)
    elif matrix.shape[1] > 0:
        add_rows(
            cython.address(out[0]), cython.address(by[0]), cython.address(matrix[0, 0]),
            matrix.shape[0], matrix.shape[1],
        )  # fmt: skip


@cython.cfunc
@cython.exceptval(check=False)
def sums_of_rows(
    by: cython.double[:, ::1], matrix: cython.double[:, ::1], out: cython.double[:, ::1]
) -> cython.void:
    """Fill out (part, column) with by (part, row) times matrix (row, column)."""
    if not cython.compiled:
        with np.errstate(invalid="ignore", over="ignore"):
            np.matmul(by, matrix, out=out)
    elif matrix.shape[1] > 0:
        add_rows_of_several(
            cython.address(out[0, 0]), cython.address(by[0, 0]), cython.address(matrix[0, 0]),
            by.shape[0], matrix.shape[0], matrix.shape[1],
        )  # fmt: skip


@cython.cclass
class ModalCompliance:
    """The compliance of the modes of a receptance at its present frequency; forces are laid out as unknowns.

    flexibility (mode, mode): mean displacements under mean forces. place (part, port): index, among the
    unknowns, of the mean and of the real and imaginary part of each harmonic of a port.
    """

    def __init__(self, receptance: Receptance, flexibility: npt.NDArray[np.float64]) -> None:
        self.receptance, self.shapes = receptance, receptance.shapes
        self.by_port = np.ascontiguousarray(np.asarray(receptance.shapes).T)
        self.flexibility = np.ascontiguousarray(flexibility.T)  # a row for each mode that is loaded
        self.diagonal = not np.any(flexibility != np.diag(flexibility.diagonal()))
        mean, wave = np.asarray(receptance.mean_at), np.asarray(receptance.wave_at)
        rows = [wave + receptance.stride * j + i for j in range(receptance.count) for i in (0, 1)]
        self.place = np.array([mean, *rows], dtype=np.intp)
        self.at, self.parts = self.place, 1 + 2 * receptance.count
        self.on_ports, self.moved = np.zeros((2, self.parts, receptance.ports))
        self.on_modes, self.mean = np.zeros((self.parts, receptance.modes)), np.zeros(receptance.modes)

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def displace(self, force: cython.double[::1], out: cython.double[::1]) -> cython.int:
        """Fill out (unknown,) with G F, the displacements that contact forces (unknown,) take away."""
        self.collect(force)
        self.means()
        self.apply_compliance(self.receptance.c_re, self.receptance.c_im)
        self.spread(out)
        return 0

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def rate(self, force: cython.double[::1], out: cython.double[::1]) -> cython.int:
        """Fill out (unknown,) with the derivative of G F by the frequency, 0 for the means."""
        self.collect(force)
        self.on_modes[0, :] = 0.0
        self.apply_compliance(self.receptance.s_re, self.receptance.s_im)
        self.spread(out)
        return 0

    @cython.cfunc
    @cython.exceptval(check=False)
    def collect(self, force: cython.double[::1]) -> cython.void:
        """Project forces (unknown,) on the modes: (part, mode)."""
        j: cython.Py_ssize_t
        p: cython.Py_ssize_t
        for j in range(self.parts):
            for p in range(self.at.shape[1]):
                self.on_ports[j, p] = force[self.at[j, p]]
        sums_of_rows(self.on_ports, self.by_port, self.on_modes)

    @cython.cfunc
    @cython.exceptval(check=False)
    def means(self) -> cython.void:
        """Replace the mean forces on the modes by their mean displacements."""
        i: cython.Py_ssize_t
        if not self.diagonal:
            sum_of_rows(self.on_modes[0], self.flexibility, self.mean)
        for i in range(self.mean.shape[0]):
            held: cython.double = self.flexibility[i, i] * self.on_modes[0, i]
            self.on_modes[0, i] = held if self.diagonal else self.mean[i]

    @cython.cfunc
    @cython.exceptval(check=False)
    def apply_compliance(self, re: cython.double[:, ::1], im: cython.double[:, ::1]) -> cython.void:
        """Replace the harmonic forces on the modes by displacements, with compliances (harmonic, mode)."""
        j: cython.Py_ssize_t
        i: cython.Py_ssize_t
        for j in range(re.shape[0]):
            for i in range(re.shape[1]):
                a: cython.double = self.on_modes[1 + 2 * j, i]
                b: cython.double = self.on_modes[2 + 2 * j, i]
                self.on_modes[1 + 2 * j, i] = re[j, i] * a - im[j, i] * b
                self.on_modes[2 + 2 * j, i] = im[j, i] * a + re[j, i] * b

    @cython.cfunc
    @cython.exceptval(check=False)
    def spread(self, out: cython.double[::1]) -> cython.void:
        """Fill out (unknown,) with the displacements of the modes at the ports."""
        j: cython.Py_ssize_t
        p: cython.Py_ssize_t
        sums_of_rows(self.on_modes, self.shapes, self.moved)
        for j in range(self.parts):
            for p in range(self.at.shape[1]):
                out[self.at[j, p]] = self.moved[j, p]


@cython.cclass
class ModalEquations:
    """The system of a balance closed by a row: call `choose_modes`, `set_closing_row`, then `factor`.

    tangent (contact, width, width): of the contact forces. most: greatest number of GMRES directions. held:
    None, or the system of linear contacts that `condensed` uses instead of the modes. turned: -1 if the last
    `correct` shows that the determinant of the full system has the opposite sign to the condensed one, else
    1.
    """

    def __init__(self, answer: ModalCompliance, tangent: npt.NDArray[np.float64], most: int) -> None:
        contacts, width = tangent.shape[:2]
        unknowns, ports = contacts * width, contacts * (width // answer.parts)
        self.answer, self.tangent = answer, tangent
        self.held: Any = None
        self.contacts, self.width, self.parts = contacts, width, answer.parts
        self.each = width // answer.parts
        # indices (part, direction) of a contact's unknowns
        self.order = np.ascontiguousarray(np.asarray(answer.place)[:, : self.each])
        self.row, self.scale, self.whole = np.zeros((3, unknowns + 1))
        self.by, self.force = np.zeros((2, unknowns))
        self.on_ports, self.moved = np.zeros((2, answer.parts, ports))
        self.basis, self.R = np.zeros((most + 1, unknowns + 1)), np.zeros((most, most))
        self.cosine, self.sine, self.reduced = np.zeros((3, most + 1))
        self.modes, self.rank, self.turned = 0, 0, 1.0

    def choose_modes(self, chosen: npt.NDArray[np.intp]) -> None:
        """Condense to some of the modes."""
        answer, modes, ports = self.answer, chosen.size, self.on_ports.shape[1]
        self.modes, self.rank, self.which = modes, self.parts * modes, chosen
        self.chosen = np.ascontiguousarray(np.asarray(answer.shapes)[chosen])
        self.shapes, self.by_port = self.chosen, np.ascontiguousarray(self.chosen.T)
        self.mean = np.ascontiguousarray(np.asarray(answer.flexibility)[np.ix_(chosen, chosen)])
        self.solver = Solver(self.rank + 1)
        self.pushed, self.answered = np.zeros((2, self.parts, modes))
        # forces by displacements of the modes: on ports (port, part, part, mode), and on modes
        by_mode, on_modes = (
            np.zeros((ports, self.parts * self.rank)),
            np.zeros((modes, self.parts * self.rank)),
        )
        self.sums = by_mode, on_modes
        self.by_mode = by_mode.reshape(ports, self.parts, self.parts, modes)
        self.on_modes = on_modes.reshape(modes, self.parts, self.rank)

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def set_closing_row(
        self, row: cython.double[::1], by: cython.double[::1], scale: cython.double[::1]
    ) -> cython.int:
        """Close the system by a row (unknown + 1,) in units of scale.

        by (unknown,) is the derivative by the parameter.
        """
        i: cython.Py_ssize_t
        for i in range(self.by.shape[0]):
            self.by[i] = by[i]
        for i in range(self.row.shape[0]):
            self.row[i], self.scale[i] = row[i] / scale[i], scale[i]
        return 0

    @cython.ccall
    @cython.exceptval(-2.0, check=False)
    def factor(self) -> cython.double:
        """Factor the system condensed to the modes; return the sign of its determinant, or 0."""
        i: cython.Py_ssize_t
        j: cython.Py_ssize_t
        k: cython.Py_ssize_t
        n: cython.Py_ssize_t = self.by.shape[0]
        m: cython.Py_ssize_t = self.modes
        rank: cython.Py_ssize_t = self.rank
        matrix: cython.double[:, ::1] = self.solver.matrix
        c_re: cython.double[:, ::1] = self.answer.receptance.c_re
        c_im: cython.double[:, ::1] = self.answer.receptance.c_im
        self.by_modes()
        for i in range(m):
            for k in range(rank):
                matrix[i, k] = 0.0
            for j in range(m):
                weight: cython.double = self.mean[j, i]
                if weight != 0.0:
                    for k in range(rank):
                        matrix[i, k] += weight * self.on_modes[j, 0, k]
        for j in range(c_re.shape[0]):
            for i in range(m):
                a: cython.double = c_re[j, self.which[i]]
                b: cython.double = c_im[j, self.which[i]]
                at: cython.Py_ssize_t = (1 + 2 * j) * m + i
                for k in range(rank):
                    re: cython.double = self.on_modes[i, 1 + 2 * j, k]
                    im: cython.double = self.on_modes[i, 2 + 2 * j, k]
                    matrix[at, k] = a * re - b * im
                    matrix[at + m, k] = b * re + a * im
        for i in range(rank):
            matrix[i, i] += 1.0
        self.forces(self.by)
        self.forces_on_modes()
        self.respond(self.solver.right)
        last: cython.double = self.row[n]
        for i in range(rank):
            matrix[i, rank] = self.solver.right[i]
        for i in range(n):
            last -= self.row[i] * self.by[i]
        matrix[rank, rank] = last
        for j in range(self.parts):
            for k in range(self.on_ports.shape[1]):
                self.on_ports[j, k] = -self.row[self.answer.at[j, k]]
        sums_of_rows(self.on_ports, self.by_port, self.pushed)
        for j in range(self.parts):
            for i in range(m):
                matrix[rank, j * m + i] = self.pushed[j, i]
        return self.solver.orientation if self.solver.factor() else 0.0

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def by_modes(self) -> cython.int:
        """Fill on_modes (mode, part, part mode): forces on the modes by displacements of the modes."""
        c: cython.Py_ssize_t
        d: cython.Py_ssize_t
        e: cython.Py_ssize_t
        i: cython.Py_ssize_t
        k: cython.Py_ssize_t
        m: cython.Py_ssize_t
        last: cython.Py_ssize_t = self.each - 1
        for c in range(self.contacts):
            first: cython.Py_ssize_t = c * self.each
            for d in range(self.each):
                p: cython.Py_ssize_t = first + d
                for i in range(self.parts):
                    row: cython.Py_ssize_t = self.order[i, d]
                    for k in range(self.parts):
                        slope: cython.double = self.tangent[c, row, self.order[k, 0]]
                        other: cython.double = self.tangent[c, row, self.order[k, last]] if last > 0 else 0.0
                        for m in range(self.modes):  # both terms at once: one store for each number
                            self.by_mode[p, i, k, m] = (
                                slope * self.by_port[first, m] + other * self.by_port[first + last, m]
                            )
                        for e in range(1, last):
                            slope = self.tangent[c, row, self.order[k, e]]
                            for m in range(self.modes):
                                self.by_mode[p, i, k, m] += slope * self.by_port[first + e, m]
        by_mode, on_modes = self.sums
        with np.errstate(invalid="ignore", over="ignore"):  # where Newton's method has diverged
            np.matmul(self.chosen, by_mode, out=on_modes)
        return 0

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def condensed(self, right: cython.double[::1], out: cython.double[::1]) -> cython.int:
        """Fill out (unknown + 1,) with the solution of the condensed system for a right side.

        The system is condensed to modes, or to the forces of some contacts (`held`).
        """
        i: cython.Py_ssize_t
        j: cython.Py_ssize_t
        n: cython.Py_ssize_t = self.by.shape[0]
        if self.held is not None:
            found: cython.double[::1] = self.held.solve(np.asarray(right))
            out[:] = found
            return 0
        reduced: cython.double[::1] = self.solver.right
        self.forces(right)
        self.forces_on_modes()
        self.respond(reduced)
        last: cython.double = right[n]
        for i in range(n):
            last -= self.row[i] * right[i]
        reduced[self.rank] = last
        self.solver.solve()
        last = reduced[self.rank]
        for i in range(n):
            out[i] = right[i] - self.by[i] * last
        out[n] = last
        for j in range(self.parts):
            for i in range(self.modes):
                self.pushed[j, i] = reduced[j * self.modes + i]
        sums_of_rows(self.pushed, self.shapes, self.moved)
        for j in range(self.parts):
            for i in range(self.moved.shape[1]):
                out[self.answer.at[j, i]] -= self.moved[j, i]
        return 0

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def multiply(self, x: cython.double[::1], out: cython.double[::1]) -> cython.int:
        """Fill out (unknown + 1,) with the full system times x (unknown + 1,)."""
        i: cython.Py_ssize_t
        n: cython.Py_ssize_t = self.by.shape[0]
        across: cython.double = 0.0
        self.forces(x)
        self.answer.displace(self.force, out)
        for i in range(n + 1):
            across += self.row[i] * x[i]
        for i in range(n):
            out[i] += x[i] + self.by[i] * x[n]
        out[n] = across
        return 0

    @cython.ccall
    @cython.exceptval(-1.0, check=False)
    def correct(
        self, right: cython.double[::1], found: cython.double[::1], enough: cython.double, most: cython.int
    ) -> cython.double:
        """Correct a solution `found` for a right side by GMRES; return the length of the next correction.

        It stops when this length, in units of scale, is enough, or after `most` directions. Fill `turned`.
        """
        i: cython.Py_ssize_t
        j: cython.Py_ssize_t
        k: cython.int
        n: cython.Py_ssize_t = self.scale.shape[0]
        taken: cython.int = 0
        size: cython.double = 0.0
        self.turned = 1.0
        self.multiply(found, self.whole)
        for i in range(n):
            self.whole[i] = right[i] - self.whole[i]
        self.condensed(self.whole, self.basis[0])
        for i in range(n):
            self.basis[0, i] /= self.scale[i]
            size += self.basis[0, i] * self.basis[0, i]
        size = sqrt(size)
        if not size < DIVERGED:
            return 2.0 * DIVERGED
        if size <= enough:
            for i in range(n):
                found[i] += self.basis[0, i] * self.scale[i]
            return size
        for i in range(n):
            self.basis[0, i] /= size
        self.reduced[0] = size
        for k in range(most):
            further: cython.double = self.krylov(k)
            long: cython.double = hypot(self.R[k, k], further)
            if not (0.0 < long < DIVERGED):
                break
            c: cython.double = self.R[k, k] / long
            s: cython.double = further / long
            self.R[k, k], self.cosine[k], self.sine[k] = long, c, s
            self.reduced[k + 1] = -s * self.reduced[k]
            self.reduced[k] *= c
            taken = k + 1
            size = fabs(self.reduced[taken])
            if not size > enough or further == 0.0:
                break
        if taken > 0 and self.cosine[taken - 1] < 0.0:  # only the last diagonal entry of R may be negative
            self.turned = -1.0
        for k in range(taken - 1, -1, -1):
            part: cython.double = self.reduced[k]
            for j in range(k + 1, taken):
                part -= self.R[k, j] * self.reduced[j]
            part /= self.R[k, k]
            self.reduced[k] = part
            for i in range(n):
                found[i] += part * self.basis[k, i] * self.scale[i]
        return size

    @cython.cfunc
    @cython.exceptval(-1.0, check=False)
    def krylov(self, k: cython.int) -> cython.double:
        """Append a unit vector to the Krylov basis, orthogonal to the others (Arnoldi's method).

        Return its length before normalisation. Column k of R holds its components along the others, after
        the Givens rotations of the earlier columns.
        """
        i: cython.Py_ssize_t
        j: cython.Py_ssize_t
        n: cython.Py_ssize_t = self.scale.shape[0]
        total: cython.double
        new: cython.double[::1] = self.basis[k + 1]
        for i in range(n):
            new[i] = self.basis[k, i] * self.scale[i]
        self.multiply(new, self.whole)
        self.condensed(self.whole, new)
        for i in range(n):
            new[i] /= self.scale[i]
        for j in range(k + 1):
            total = _dot(self.basis[j], new)
            self.R[j, k] = total
            for i in range(n):
                new[i] -= total * self.basis[j, i]
        for j in range(k):
            total = self.R[j, k]
            self.R[j, k] = self.cosine[j] * total + self.sine[j] * self.R[j + 1, k]
            self.R[j + 1, k] = self.cosine[j] * self.R[j + 1, k] - self.sine[j] * total
        total = sqrt(_dot(new, new))
        if total > 0.0:
            for i in range(n):
                new[i] /= total
        return total if isfinite(total) else 2.0 * DIVERGED

    @cython.cfunc
    @cython.exceptval(check=False)
    def forces(self, x: cython.double[::1]) -> cython.void:
        """Fill force (unknown,) with the change of the contact forces by displacements x."""
        c: cython.Py_ssize_t
        i: cython.Py_ssize_t
        k: cython.Py_ssize_t
        w: cython.Py_ssize_t = self.width
        for c in range(self.contacts):
            for i in range(w):
                even: cython.double = 0.0  # two independent sums
                odd: cython.double = 0.0
                for k in range(0, w - 1, 2):
                    even += self.tangent[c, i, k] * x[c * w + k]
                    odd += self.tangent[c, i, k + 1] * x[c * w + k + 1]
                if w % 2:
                    even += self.tangent[c, i, w - 1] * x[c * w + w - 1]
                self.force[c * w + i] = even + odd

    @cython.cfunc
    @cython.exceptval(check=False)
    def forces_on_modes(self) -> cython.void:
        """Project the forces on the modes: (part, mode)."""
        j: cython.Py_ssize_t
        p: cython.Py_ssize_t
        for j in range(self.parts):
            for p in range(self.on_ports.shape[1]):
                self.on_ports[j, p] = self.force[self.answer.at[j, p]]
        sums_of_rows(self.on_ports, self.by_port, self.pushed)

    @cython.cfunc
    @cython.exceptval(check=False)
    def respond(self, out: cython.double[::1]) -> cython.void:
        """Fill the first entries of out (part mode,) with the displacements of the modes under `pushed`."""
        i: cython.Py_ssize_t
        j: cython.Py_ssize_t
        m: cython.Py_ssize_t = self.modes
        c_re: cython.double[:, ::1] = self.answer.receptance.c_re
        c_im: cython.double[:, ::1] = self.answer.receptance.c_im
        sum_of_rows(self.pushed[0], self.mean, self.answered[0])
        for j in range(c_re.shape[0]):
            for i in range(m):
                a: cython.double = c_re[j, self.which[i]]
                b: cython.double = c_im[j, self.which[i]]
                re: cython.double = self.pushed[1 + 2 * j, i]
                im: cython.double = self.pushed[2 + 2 * j, i]
                self.answered[1 + 2 * j, i] = a * re - b * im
                self.answered[2 + 2 * j, i] = b * re + a * im
        for j in range(self.parts):
            for i in range(m):
                out[j * m + i] = self.answered[j, i]


@cython.ccall
@cython.exceptval(-1, check=False)
def linear_contacts(
    tangent: cython.double[:, :, ::1],
    order: cython.Py_ssize_t[::1],
    linear: cython.double[:, :, ::1],
    slight: cython.double[::1],
    found: cython.uchar[::1],
) -> cython.int:
    """Fill found (contact,) with 1 where a contact's tangent is that of a linear contact, else 0.

    The diagonal of the tangent, sorted by order, must equal linear (contact, part, port) within slight
    (contact,).
    """
    c: cython.Py_ssize_t
    i: cython.Py_ssize_t
    d: cython.Py_ssize_t
    k: cython.Py_ssize_t
    for c in range(tangent.shape[0]):
        found[c] = 1
        for i in range(linear.shape[1]):
            for d in range(linear.shape[2]):
                k = order[i * linear.shape[2] + d]
                if not fabs(tangent[c, k, k] - linear[c, i, d]) <= slight[c]:
                    found[c] = 0
    return 0


@cython.cfunc
@cython.exceptval(check=False)
def _dot(a: cython.double[::1], b: cython.double[::1]) -> cython.double:
    """Scalar product of two vectors, in four independent sums."""
    n: cython.Py_ssize_t = a.shape[0]
    i: cython.Py_ssize_t = 0
    p: cython.double = 0.0
    q: cython.double = 0.0
    r: cython.double = 0.0
    s: cython.double = 0.0
    while i + 4 <= n:
        p += a[i] * b[i]
        q += a[i + 1] * b[i + 1]
        r += a[i + 2] * b[i + 2]
        s += a[i + 3] * b[i + 3]
        i += 4
    while i < n:
        p += a[i] * b[i]
        i += 1
    return p + q + r + s
