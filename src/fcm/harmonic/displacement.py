"""Displacements of the degrees of freedom that are reported, and how fast they grow along a curve."""

from __future__ import annotations

import cython
import numpy as np

from fcm.harmonic.extremes import Extremes
from fcm.structure.linear import Linear
from fcm.structure.receptance import Receptance


@cython.cclass
class Displacements(Extremes):
    """Of x = mean + Re sum X exp(i h theta): mean (dof,), and rest, the answer to static loads alone."""

    def __init__(self, seen: Receptance, linear: Linear) -> None:
        dofs = linear.dofs.shape[1]
        Extremes.__init__(self, seen.harmonics, dofs)
        self.seen = seen
        self.shapes, self.static = linear.dofs, linear.static_of_dofs
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
        w: cython.Py_ssize_t = 2 + 4 * self.seen.count
        for d in range(self.dofs):
            total: cython.double = self.rest[d]
            for p in range(self.seen.ports):
                total -= self.static[d, p] * force[(p // 2) * w + p % 2]
            self.mean[d] = total
        for j in range(self.seen.count):
            self.harmonic(j, load, force, d_force, direction[direction.shape[0] - 1])
        for d in range(self.dofs):
            if not self.apart[d]:
                self.from_ports(d, z, direction)
            if self.seen.count == 1:
                self.single(d)
            else:
                self.several(d)
        return 0

    @cython.cfunc
    @cython.exceptval(check=False)
    def harmonic(
        self,
        j: cython.int,
        load: cython.double,
        force: cython.double[::1],
        d_force: cython.double[::1],
        d_omega: cython.double,
    ) -> cython.void:
        """Amplitudes of one harmonic, mode by mode."""
        w: cython.Py_ssize_t = 2 + 4 * self.seen.count
        i: cython.Py_ssize_t
        d: cython.Py_ssize_t
        p: cython.Py_ssize_t
        k: cython.Py_ssize_t
        driven: cython.double = load if j == self.seen.driven else 0.0
        self.clear(j)
        for i in range(self.seen.modes):
            f_re: cython.double = driven * self.seen.force_re[i]
            f_im: cython.double = driven * self.seen.force_im[i]
            g_re: cython.double = driven * d_omega * self.seen.slope_re[i]
            g_im: cython.double = driven * d_omega * self.seen.slope_im[i]
            for p in range(self.seen.ports):
                k = (p // 2) * w + 2 + 4 * j + 2 * (p % 2)
                f_re -= self.seen.shapes[i, p] * force[k]
                f_im -= self.seen.shapes[i, p] * force[k + 1]
                g_re -= self.seen.shapes[i, p] * d_force[k]
                g_im -= self.seen.shapes[i, p] * d_force[k + 1]
            self.move(self.seen, j, i, f_re, f_im, g_re, g_im, d_omega)
            for d in range(self.dofs):
                shape: cython.double = self.shapes[i, d]
                self.re[j, d] += shape * self.q_re
                self.im[j, d] += shape * self.q_im
                self.d_re[j, d] += shape * self.r_re
                self.d_im[j, d] += shape * self.r_im

    @cython.cfunc
    @cython.exceptval(check=False)
    def clear(self, j: cython.int) -> cython.void:
        """No amplitudes of a harmonic."""
        d: cython.Py_ssize_t
        for d in range(self.dofs):
            self.re[j, d] = self.im[j, d] = self.d_re[j, d] = self.d_im[j, d] = 0.0

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
        w: cython.Py_ssize_t = 2 + 4 * self.seen.count
        j: cython.int
        p: cython.Py_ssize_t
        k: cython.Py_ssize_t
        self.mean[d] = 0.0
        for j in range(self.seen.count):
            self.re[j, d] = self.im[j, d] = self.d_re[j, d] = self.d_im[j, d] = 0.0
        for p in range(self.seen.ports):
            share: cython.double = self.attached[p, d]
            if share != 0.0:
                self.mean[d] += share * z[(p // 2) * w + p % 2]
                for j in range(self.seen.count):
                    k = (p // 2) * w + 2 + 4 * j + 2 * (p % 2)
                    self.re[j, d] += share * z[k]
                    self.im[j, d] += share * z[k + 1]
                    self.d_re[j, d] += share * direction[k]
                    self.d_im[j, d] += share * direction[k + 1]
