"""Receptances of the structure at the contacts, for every harmonic of a frequency, as sums over modes.

With modes of mass 1, shapes P on the ports in the order of the contacts, and x = Re(X exp(i h omega t)),

    G(h omega) = sum_i P_i P_i^T c_i,    c_i = 1 / (w_i^2 - (h omega)^2 + 2 i zeta_i w_i h omega)

and the derivatives by omega.

In a ring with a travelling wave, each harmonic has its own structure. Harmonic h of the motion of sector k is
X_h exp(i h k phi), so it excites the modes of one nodal diameter (`TravellingReceptance`). Their shapes P on
the ports are complex; on the next sector they are multiplied by exp(i h phi):

    G(h omega) = sum_i P_i P_i^H c_i = A + B + i (D - D^T),    P = a + i b

with the blocks A = sum a a^T c, B = sum b b^T c and D = sum b a^T c of a receptance with real shapes on twice
as many ports, (a, b).
"""

from __future__ import annotations

from typing import NamedTuple

import cython
import numpy as np
import numpy.typing as npt
from cython.cimports.libc.math import sqrt

from fcm.structure.layout import Layout
from fcm.structure.options import DAMPING, RECEPTANCE


def modal_stiffness(natural: float, rate: float, w: float, least_loss: float) -> tuple[float, float]:
    """Dynamic stiffness w_n^2 - w^2 + i rate w of a mode of mass 1: its real and imaginary part.

    It is never zero: an undamped mode excited at its own frequency is given a small damping.
    """
    # the difference of squares as a product: exact next to an undamped resonance
    re: float = (natural - w) * (natural + w)
    im: float = rate * w
    if re == 0.0 and im == 0.0:
        im = least_loss * w * w
    return re, im


def dynamic_stiffness(
    natural: npt.NDArray[np.float64], damping: npt.NDArray[np.float64], w: npt.NDArray[np.float64]
) -> npt.NDArray[np.complex128]:
    """Dynamic stiffness (frequency, mode) of modes of mass 1 at frequencies w (frequency,)."""
    i: cython.Py_ssize_t
    k: cython.Py_ssize_t
    at: cython.double[::1] = np.array(w)
    own: cython.double[::1] = np.array(natural)
    rate: cython.double[::1] = 2.0 * np.asarray(damping) * natural
    least: cython.double = DAMPING.min_loss_factor
    found = np.empty((len(w), len(natural)), dtype=np.complex128)
    out: cython.double[:, :, ::1] = found.view(np.float64).reshape(len(w), len(natural), 2)
    for k in range(at.shape[0]):
        for i in range(own.shape[0]):
            out[k, i, 0], out[k, i, 1] = modal_stiffness(own[i], rate[i], at[k], least)
    return found


class DrivenModes(NamedTuple):
    """Modes of mass 1 seen from the ports of contacts, and the external forces on them.

    The forces (driven, mode) are force + omega^2 square, at the harmonics `driven`.
    """

    shapes: npt.NDArray[np.float64]  # (mode, port)
    natural: npt.NDArray[np.float64]  # (mode,) [rad/s]
    damping: npt.NDArray[np.float64]  # (mode,) ratios
    force: npt.NDArray[np.complex128]
    square: npt.NDArray[np.complex128]
    driven: tuple[int, ...]


@cython.cclass
class Receptance:
    """Receptances at the ports of contacts, and the response to external forces, at one frequency.

    G_re, G_im, dG_re, dG_im (harmonic, port, port) are the receptances and their derivatives; X_re, X_im,
    dX_re, dX_im (driven, port) the response to the external forces. c, s (harmonic, mode) are the compliances
    of the modes and their derivatives; static (port, port) is for mean forces. force_re, force_im, slope_re,
    slope_im (driven, mode) are the external forces at omega and their derivatives. Without `summed`, for many
    ports, G is not computed; responses are then computed by modes.

    forced (harmonic,) is the number of the external force at each harmonic of the list, -1 if there is none;
    first is the place of harmonic 1 in the list.

    mean_at, wave_at (port,): indices of the mean of a port and of the real part of its first harmonic among
    the unknowns of a balance, see `fcm.structure.layout`. stride: step of the index from one harmonic to the
    next. layout: the layout of these unknowns, for the given number of contacts.
    """

    def __init__(
        self,
        driven_modes: DrivenModes,
        static: npt.NDArray[np.float64],
        harmonics: npt.NDArray[np.float64],
        contacts: cython.int = 0,
        summed: cython.bint = True,
    ) -> None:
        shapes, natural, damping, force, square, driven = driven_modes
        modes, ports = shapes.shape
        count = len(harmonics)
        self.modes, self.ports, self.count = modes, ports, count
        layout = Layout(contacts, ports // contacts if contacts else 0, count)
        self.layout = layout
        self.mean_at, self.wave_at, self.stride = layout.mean_at, layout.wave_at, layout.stride
        self.harmonics = np.array(harmonics, dtype=np.float64)
        self.natural, self.rate = np.array(natural), 2.0 * np.asarray(damping) * natural
        self.shapes, self.static = np.ascontiguousarray(shapes), np.ascontiguousarray(static)
        self.constant_re, self.constant_im = np.array(force.real), np.array(force.imag)
        self.force_re, self.force_im = np.array(force.real), np.array(force.imag)
        self.square_re, self.square_im = np.array(square.real), np.array(square.imag)
        self.slope_re, self.slope_im = np.zeros((2, *force.shape))
        self.weights = np.zeros((4 * count, modes))  # of the modes; contiguous with the sums over them
        self.summed, size = summed, ports if summed else 0
        self.sum = np.zeros((4 * count * size, size))
        self.c_re, self.c_im, self.s_re, self.s_im = np.asarray(self.weights).reshape(4, count, modes)
        sums = np.asarray(self.sum).reshape(4, count, size, size)
        self.G_re, self.G_im, self.dG_re, self.dG_im = sums
        low, self.large = np.tril_indices(ports), modes * ports * ports > RECEPTANCE.blas_products
        self.many, self.least_loss = ports >= RECEPTANCE.many_ports, DAMPING.min_loss_factor
        pairs = self.many and summed and not self.large
        self.pairs = (
            np.ascontiguousarray(shapes[:, low[0]] * shapes[:, low[1]]) if pairs else np.zeros((0, 0))
        )
        self.total = np.zeros((4, self.pairs.shape[1]))  # of the sums of one harmonic, by pairs
        self.X_re, self.X_im, self.dX_re, self.dX_im = np.zeros((4, len(driven), ports))
        numbers = [int(h) for h in harmonics]
        self.forced = np.array([driven.index(h) if h in driven else -1 for h in numbers], dtype=np.intc)
        self.first = numbers.index(1) if 1 in numbers else 0
        self.omega = -1.0

    def set_external_forces(
        self, constant: npt.NDArray[np.complex128], square: npt.NDArray[np.complex128]
    ) -> None:
        """Replaces the external forces by constant + omega^2 square (driven, mode)."""
        self.constant_re, self.constant_im = np.array(constant.real), np.array(constant.imag)
        self.square_re, self.square_im = np.array(square.real), np.array(square.imag)
        if self.omega != -1.0:
            self.forces()
            self.external()

    def of_harmonic(self, j: int) -> npt.NDArray[np.complex128]:
        """Receptance G (port, port) of harmonic number j of the list, at the last frequency."""
        if self.summed:
            return np.asarray(self.G_re)[j] + 1j * np.asarray(self.G_im)[j]  # type: ignore[no-any-return]
        c, shapes = np.asarray(self.c_re)[j] + 1j * np.asarray(self.c_im)[j], np.asarray(self.shapes)
        return (shapes.T * c) @ shapes  # type: ignore[no-any-return]

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def at(self, omega: cython.double) -> cython.int:
        """Fills all arrays for a frequency [rad/s]."""
        j: cython.int
        if omega == self.omega:
            return 0
        self.omega = omega
        self.compliances()
        self.forces()
        if self.large and self.summed:
            self.large_sums()
        for j in range(self.count if self.summed and not self.large else 0):
            if self.many:
                self.sums_by_pairs(j)
            else:
                self.sums(j)
        self.external()
        return 0

    @cython.cfunc
    @cython.exceptval(check=False)
    def forces(self) -> cython.void:
        """Sets the external forces on the modes, and their derivatives, at the frequency."""
        i: cython.Py_ssize_t
        k: cython.Py_ssize_t
        w: cython.double = self.omega
        for k in range(self.force_re.shape[0]):
            for i in range(self.modes):
                self.force_re[k, i] = self.constant_re[k, i] + w * w * self.square_re[k, i]
                self.force_im[k, i] = self.constant_im[k, i] + w * w * self.square_im[k, i]
                self.slope_re[k, i] = 2.0 * w * self.square_re[k, i]
                self.slope_im[k, i] = 2.0 * w * self.square_im[k, i]

    @cython.cfunc
    @cython.exceptval(check=False)
    def compliances(self) -> cython.void:
        j: cython.int
        i: cython.Py_ssize_t
        for j in range(self.count):
            h: cython.double = self.harmonics[j]
            w: cython.double = h * self.omega
            for i in range(self.modes):
                re, im = modal_stiffness(self.natural[i], self.rate[i], w, self.least_loss)
                size: cython.double = re * re + im * im
                c_re: cython.double = re / size
                c_im: cython.double = -im / size
                # dc = -c^2 d(1/c) = c^2 h (2 w - i rate)
                self.c_re[j, i] = c_re
                self.c_im[j, i] = c_im
                q_re: cython.double = h * (c_re * c_re - c_im * c_im)
                q_im: cython.double = h * 2.0 * c_re * c_im
                self.s_re[j, i] = 2.0 * w * q_re + self.rate[i] * q_im
                self.s_im[j, i] = 2.0 * w * q_im - self.rate[i] * q_re

    @cython.cfunc
    @cython.exceptval(check=False)
    def sums(self, j: cython.int) -> cython.void:
        """Sums the receptances of one harmonic over the modes; they are symmetric."""
        k: cython.Py_ssize_t
        m: cython.Py_ssize_t
        i: cython.Py_ssize_t
        for k in range(self.ports):
            for m in range(k + 1):
                G_re: cython.double = 0.0
                G_im: cython.double = 0.0
                dG_re: cython.double = 0.0
                dG_im: cython.double = 0.0
                for i in range(self.modes):
                    weight: cython.double = self.shapes[i, k] * self.shapes[i, m]
                    G_re += weight * self.c_re[j, i]
                    G_im += weight * self.c_im[j, i]
                    dG_re += weight * self.s_re[j, i]
                    dG_im += weight * self.s_im[j, i]
                self.G_re[j, k, m] = self.G_re[j, m, k] = G_re
                self.G_im[j, k, m] = self.G_im[j, m, k] = G_im
                self.dG_re[j, k, m] = self.dG_re[j, m, k] = dG_re
                self.dG_im[j, k, m] = self.dG_im[j, m, k] = dG_im

    @cython.cfunc
    @cython.exceptval(check=False)
    def sums_by_pairs(self, j: cython.int) -> cython.void:
        """Sums the receptances of one harmonic for several pairs of ports at once, for speed."""
        i: cython.Py_ssize_t
        k: cython.Py_ssize_t
        m: cython.Py_ssize_t
        p: cython.Py_ssize_t = 0
        pair: cython.double[:, ::1] = self.pairs
        total: cython.double[:, ::1] = self.total
        total[:, :] = 0.0
        for i in range(self.modes):
            c_re: cython.double = self.c_re[j, i]
            c_im: cython.double = self.c_im[j, i]
            s_re: cython.double = self.s_re[j, i]
            s_im: cython.double = self.s_im[j, i]
            for p in range(pair.shape[1]):
                weight: cython.double = pair[i, p]
                total[0, p] += weight * c_re
                total[1, p] += weight * c_im
                total[2, p] += weight * s_re
                total[3, p] += weight * s_im
        p = 0
        for k in range(self.ports):
            for m in range(k + 1):
                self.G_re[j, k, m] = self.G_re[j, m, k] = total[0, p]
                self.G_im[j, k, m] = self.G_im[j, m, k] = total[1, p]
                self.dG_re[j, k, m] = self.dG_re[j, m, k] = total[2, p]
                self.dG_im[j, k, m] = self.dG_im[j, m, k] = total[3, p]
                p += 1

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def large_sums(self) -> cython.int:
        shapes = np.asarray(self.shapes)
        weighted = np.asarray(self.weights)[:, None, :] * shapes.T  # (a weight of the modes, port, mode)
        np.matmul(weighted.reshape(-1, shapes.shape[0]), shapes, out=np.asarray(self.sum))
        return 0

    @cython.cfunc
    @cython.exceptval(check=False)
    def external(self) -> cython.void:
        """Sets the responses of the ports to the external forces, at all driven harmonics."""
        j: cython.int
        for j in range(self.count):
            if self.forced[j] >= 0:
                self.answer(j, self.forced[j])

    @cython.cfunc
    @cython.exceptval(check=False)
    def answer(self, j: cython.int, n: cython.int) -> cython.void:
        """Sets the response of the ports to external force number n, which acts at harmonic number j."""
        k: cython.Py_ssize_t
        i: cython.Py_ssize_t
        for k in range(self.ports):
            self.X_re[n, k] = self.X_im[n, k] = self.dX_re[n, k] = self.dX_im[n, k] = 0.0
        for i in range(self.modes):
            f_re: cython.double = self.force_re[n, i]
            f_im: cython.double = self.force_im[n, i]
            q_re: cython.double = self.c_re[j, i] * f_re - self.c_im[j, i] * f_im
            q_im: cython.double = self.c_re[j, i] * f_im + self.c_im[j, i] * f_re
            d_re: cython.double = self.s_re[j, i] * f_re - self.s_im[j, i] * f_im
            d_im: cython.double = self.s_re[j, i] * f_im + self.s_im[j, i] * f_re
            d_re += self.c_re[j, i] * self.slope_re[n, i] - self.c_im[j, i] * self.slope_im[n, i]
            d_im += self.c_re[j, i] * self.slope_im[n, i] + self.c_im[j, i] * self.slope_re[n, i]
            for k in range(self.ports):
                self.X_re[n, k] += self.shapes[i, k] * q_re
                self.X_im[n, k] += self.shapes[i, k] * q_im
                self.dX_re[n, k] += self.shapes[i, k] * d_re
                self.dX_im[n, k] += self.shapes[i, k] * d_im


@cython.cclass
class TravellingReceptance(Receptance):
    """Receptances of a ring's sector, from those of each travelling-wave harmonic.

    `waves` (harmonic,) are real receptances of one harmonic each. Their ports are the real, then the
    imaginary parts of the sector's ports.
    """

    def __init__(
        self,
        waves: list[Receptance],
        static: npt.NDArray[np.float64],
        harmonics: npt.NDArray[np.float64],
        contacts: cython.int,
        driven: tuple[int, ...],
    ) -> None:
        shapes, none = np.zeros((0, len(static))), np.zeros(0)
        push = np.zeros((len(driven), 0), dtype=np.complex128)
        modes = DrivenModes(shapes, none, none, push, push, driven)
        Receptance.__init__(self, modes, static, harmonics, contacts)
        self.waves = waves

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def at(self, omega: cython.double) -> cython.int:
        """Fills all arrays for a frequency [rad/s]."""
        j: cython.int
        if omega == self.omega:
            return 0
        self.omega = omega
        for j in range(self.count):
            wave: Receptance = self.waves[j]
            wave.at(omega)
            self.from_real(j, wave)
        return 0

    @cython.cfunc
    @cython.exceptval(check=False)
    def from_real(self, j: cython.int, wave: Receptance) -> cython.void:
        """Sets the complex receptance of one harmonic from its real blocks."""
        n: cython.Py_ssize_t = self.ports
        k: cython.int = self.forced[j]
        p: cython.Py_ssize_t
        q: cython.Py_ssize_t
        for p in range(n):
            for q in range(n):
                self.G_re[j, p, q] = (
                    wave.G_re[0, p, q] + wave.G_re[0, n + p, n + q]
                    - wave.G_im[0, n + p, q] + wave.G_im[0, p, n + q]
                )  # fmt: skip
                self.G_im[j, p, q] = (
                    wave.G_im[0, p, q] + wave.G_im[0, n + p, n + q]
                    + wave.G_re[0, n + p, q] - wave.G_re[0, p, n + q]
                )  # fmt: skip
                self.dG_re[j, p, q] = (
                    wave.dG_re[0, p, q] + wave.dG_re[0, n + p, n + q]
                    - wave.dG_im[0, n + p, q] + wave.dG_im[0, p, n + q]
                )  # fmt: skip
                self.dG_im[j, p, q] = (
                    wave.dG_im[0, p, q] + wave.dG_im[0, n + p, n + q]
                    + wave.dG_re[0, n + p, q] - wave.dG_re[0, p, n + q]
                )  # fmt: skip
            if k >= 0:
                self.X_re[k, p] = wave.X_re[0, p] - wave.X_im[0, n + p]
                self.X_im[k, p] = wave.X_im[0, p] + wave.X_re[0, n + p]
                self.dX_re[k, p] = wave.dX_re[0, p] - wave.dX_im[0, n + p]
                self.dX_im[k, p] = wave.dX_im[0, p] + wave.dX_re[0, n + p]


@cython.cclass
class ForcedModes:
    """Forced response of modes of mass 1, with shapes on ports (mode, port) and dofs (mode, dof)."""

    def __init__(
        self,
        natural: npt.NDArray[np.float64],
        damping: npt.NDArray[np.float64],
        ports: npt.NDArray[np.float64],
        dofs: npt.NDArray[np.float64],
    ) -> None:
        self.least_loss = DAMPING.min_loss_factor
        self.natural, self.rate = np.array(natural), 2.0 * np.asarray(damping) * natural
        self.ports, self.dofs = np.ascontiguousarray(ports), np.ascontiguousarray(dofs)
        self.q_re, self.q_im = np.zeros((2, len(natural)))

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def shares(
        self,
        harmonics: cython.Py_ssize_t[::1],
        omega: cython.double,
        force: cython.double[:, :, ::1],
        size: cython.double[::1],
        out: cython.double[::1],
    ) -> cython.int:
        """Fills the greatest amplitude, relative to the size of its degree of freedom, for some harmonics.

        force (harmonic, port, 2): real and imaginary parts; size (dof,), where 0 is left out. Harmonic 1 is
        the first of force and of the result.
        """
        k: cython.Py_ssize_t
        for k in range(harmonics.shape[0]):
            h: cython.Py_ssize_t = harmonics[k]
            self.move(h * omega, force[h - 1])
            out[h - 1] = self.greatest(size)
        return 0

    @cython.cfunc
    @cython.exceptval(check=False)
    def move(self, w: cython.double, force: cython.double[:, ::1]) -> cython.void:
        """Sets the modal amplitudes under forces on the ports (port, 2) at a frequency."""
        m: cython.Py_ssize_t
        p: cython.Py_ssize_t
        for m in range(self.natural.shape[0]):
            f_re: cython.double = 0.0
            f_im: cython.double = 0.0
            for p in range(self.ports.shape[1]):
                f_re += self.ports[m, p] * force[p, 0]
                f_im += self.ports[m, p] * force[p, 1]
            re, im = modal_stiffness(self.natural[m], self.rate[m], w, self.least_loss)
            square: cython.double = re * re + im * im
            self.q_re[m] = (f_re * re + f_im * im) / square
            self.q_im[m] = (f_im * re - f_re * im) / square

    @cython.cfunc
    @cython.exceptval(check=False)
    def greatest(self, size: cython.double[::1]) -> cython.double:
        """Greatest amplitude relative to sizes (dof,)."""
        m: cython.Py_ssize_t
        d: cython.Py_ssize_t
        most: cython.double = 0.0
        for d in range(self.dofs.shape[1]):
            if size[d] > 0.0:
                re: cython.double = 0.0
                im: cython.double = 0.0
                for m in range(self.natural.shape[0]):
                    re += self.dofs[m, d] * self.q_re[m]
                    im += self.dofs[m, d] * self.q_im[m]
                re, im = re / size[d], im / size[d]
                most = max(most, re * re + im * im)
        return sqrt(most)
