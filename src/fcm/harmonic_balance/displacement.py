"""Displacements of the degrees of freedom that are reported, and how fast they change along a curve."""

from __future__ import annotations

import cython
import numpy as np

from fcm.structure.linear import Linear
from fcm.structure.receptance import Receptance

if cython.compiled:
    from cython.cimports.fcm.harmonic_balance.peak_to_peak import MANY, Extremes
else:
    from fcm.harmonic_balance.peak_to_peak import MANY, Extremes


@cython.cclass
class Displacements(Extremes):
    """`Extremes` whose parts `at` fills: sums of the shapes (mode, dof) times the parts of each mode,
    of_modes (4 * harmonic, mode). mean (dof,); rest (dof,): the answer to static loads alone.
    """

    def __init__(self, seen: Receptance, linear: Linear) -> None:
        count, dofs = seen.count, linear.dofs.shape[1]
        Extremes.__init__(self, seen.harmonics, dofs)
        self.seen = seen
        self.shapes, self.static = linear.dofs, linear.static_of_dofs
        self.of_modes = np.zeros((4 * count, seen.modes))
        self.mean, self.rest = np.zeros(dofs), np.zeros(dofs)
        self.attached, self.apart = linear.attached

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def at(
        self,
        load: cython.double,
        force: cython.double[::1],
        d_force: cython.double[::1],
        z: cython.double[::1],
        direction: cython.double[::1],
    ) -> cython.int:
        """From the contact forces (unknown,), laid out as the unknowns, and their rates.

        The receptance is at omega. What contacts' displacements make up is from these, z (unknown + 1,): of
        a small displacement, forces that nearly balance leave few digits.
        """
        j: cython.int
        d: cython.Py_ssize_t
        p: cython.Py_ssize_t
        for d in range(self.dofs):
            total: cython.double = self.rest[d]
            for p in range(self.seen.ports):
                total -= self.static[d, p] * force[self.seen.mean_at[p]]
            self.mean[d] = total
        for j in range(self.seen.count):
            self.harmonic(j, load, force, d_force, direction[direction.shape[0] - 1])
        self.sum_modes()
        for d in range(self.dofs):
            if not self.apart[d]:
                self.from_ports(d, z, direction)
        self.fill()
        return 0

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def harmonic(
        self,
        j: cython.int,
        load: cython.double,
        force: cython.double[::1],
        d_force: cython.double[::1],
        d_omega: cython.double,
    ) -> cython.int:
        """Amplitudes of the modes in one harmonic."""
        n: cython.Py_ssize_t = self.seen.count
        i: cython.Py_ssize_t
        p: cython.Py_ssize_t
        k: cython.Py_ssize_t
        forced: cython.int = self.seen.forced[j]
        driven: cython.double = load if forced >= 0 else 0.0
        forced = max(forced, 0)
        for i in range(self.seen.modes):
            f_re: cython.double = driven * self.seen.force_re[forced, i]
            f_im: cython.double = driven * self.seen.force_im[forced, i]
            g_re: cython.double = driven * d_omega * self.seen.slope_re[forced, i]
            g_im: cython.double = driven * d_omega * self.seen.slope_im[forced, i]
            for p in range(self.seen.ports):
                k = self.seen.wave_at[p] + self.seen.stride * j
                f_re -= self.seen.shapes[i, p] * force[k]
                f_im -= self.seen.shapes[i, p] * force[k + 1]
                g_re -= self.seen.shapes[i, p] * d_force[k]
                g_im -= self.seen.shapes[i, p] * d_force[k + 1]
            self.move(self.seen, j, i, f_re, f_im, g_re, g_im, d_omega)
            self.of_modes[j, i], self.of_modes[n + j, i] = self.q_re, self.q_im
            self.of_modes[2 * n + j, i], self.of_modes[3 * n + j, i] = self.r_re, self.r_im
        return 0

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def sum_modes(self) -> cython.int:
        """From the modes to the degrees of freedom."""
        k: cython.Py_ssize_t
        i: cython.Py_ssize_t
        d: cython.Py_ssize_t
        if self.dofs > MANY:
            np.matmul(np.asarray(self.of_modes), np.asarray(self.shapes), out=np.asarray(self.parts))
            return 0
        for k in range(self.parts.shape[0]):
            for d in range(self.dofs):
                self.parts[k, d] = 0.0
            for i in range(self.seen.modes):
                for d in range(self.dofs):
                    self.parts[k, d] += self.shapes[i, d] * self.of_modes[k, i]
        return 0

    @cython.cfunc
    @cython.exceptval(check=False)
    def move(
        self,
        seen: Receptance,
        j: cython.int,
        i: cython.Py_ssize_t,
        f_re: cython.double,
        f_im: cython.double,
        g_re: cython.double,
        g_im: cython.double,
        d_omega: cython.double,
    ) -> cython.void:
        """q, the amplitude of mode i under its force f in harmonic j, and its rate r; g is that of f."""
        c_re: cython.double = seen.c_re[j, i]
        c_im: cython.double = seen.c_im[j, i]
        s_re: cython.double = seen.s_re[j, i] * d_omega
        s_im: cython.double = seen.s_im[j, i] * d_omega
        self.q_re = c_re * f_re - c_im * f_im
        self.q_im = c_re * f_im + c_im * f_re
        self.r_re = c_re * g_re - c_im * g_im + s_re * f_re - s_im * f_im
        self.r_im = c_re * g_im + c_im * g_re + s_re * f_im + s_im * f_re

    @cython.cfunc
    @cython.exceptval(check=False)
    def from_ports(
        self, d: cython.Py_ssize_t, z: cython.double[::1], direction: cython.double[::1]
    ) -> cython.void:
        """A combination of the contacts' displacements."""
        j: cython.int
        p: cython.Py_ssize_t
        k: cython.Py_ssize_t
        self.mean[d] = 0.0
        for j in range(self.seen.count):
            self.re[j, d] = self.im[j, d] = self.d_re[j, d] = self.d_im[j, d] = 0.0
        for p in range(self.seen.ports):
            share: cython.double = self.attached[p, d]
            if share != 0.0:
                self.mean[d] += share * z[self.seen.mean_at[p]]
                for j in range(self.seen.count):
                    k = self.seen.wave_at[p] + self.seen.stride * j
                    self.re[j, d] += share * z[k]
                    self.im[j, d] += share * z[k + 1]
                    self.d_re[j, d] += share * direction[k]
                    self.d_im[j, d] += share * direction[k + 1]
