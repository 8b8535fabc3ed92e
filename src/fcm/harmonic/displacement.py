"""Displacements of the degrees of freedom that are reported, and how fast they grow along a curve."""

from __future__ import annotations

import cython
import numpy as np
from cython.cimports.libc.math import cos, fabs, hypot, sin

from fcm.harmonic.waves import waves
from fcm.structure.linear import Linear
from fcm.structure.receptance import Receptance

REFINED = cython.declare(cython.int, 4)  # Newton steps from the greatest sample to the extreme, at most
CLOSE = cython.declare(cython.double, 1e-9)  # [rad] the last of them, at which the value errs by its square


@cython.cclass
class Displacements:
    """re, im (harmonic, dof) amplitudes of x = mean + Re sum X exp(i h theta), d_re, d_im their rates.

    amplitude (dof,): half the peak-to-peak displacement, with one harmonic |X|; growth: its rate; angles
    (2, dof): of the greatest and the least displacement, if there are several; rest: the answer to static
    loads alone.
    """

    def __init__(self, seen: Receptance, linear: Linear) -> None:
        count, dofs = seen.count, linear.dofs.shape[1]
        self.seen, self.dofs = seen, dofs
        self.shapes, self.static = linear.dofs, linear.static_of_dofs
        self.re, self.im = np.zeros((count, dofs)), np.zeros((count, dofs))
        self.d_re, self.d_im = np.zeros((count, dofs)), np.zeros((count, dofs))
        self.mean, self.amplitude, self.growth = np.zeros(dofs), np.zeros(dofs), np.zeros(dofs)
        self.rest, self.angles = np.zeros(dofs), np.zeros((2, dofs))
        self.attached, self.apart = linear.attached
        self.cosine, self.sine = waves(tuple(np.asarray(seen.harmonics).tolist()))
        self.samples = self.cosine.shape[1]
        self.wave, self.c, self.s = np.zeros(self.samples), np.zeros(count), np.zeros(count)
        self.value = self.rate = self.angle = 0.0

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

    @cython.cfunc
    @cython.exceptval(check=False)
    def single(self, d: cython.Py_ssize_t) -> cython.void:
        """One harmonic: its size."""
        size: cython.double = hypot(self.re[0, d], self.im[0, d])
        self.amplitude[d] = size
        self.growth[d] = 0.0
        if size > 0.0:
            self.growth[d] = self.re[0, d] / size * self.d_re[0, d] + self.im[0, d] / size * self.d_im[0, d]

    @cython.cfunc
    @cython.exceptval(check=False)
    def several(self, d: cython.Py_ssize_t) -> cython.void:
        """Several: the greatest and the least displacement, from the samples next to them."""
        k: cython.Py_ssize_t
        j: cython.int
        highest: cython.Py_ssize_t = 0
        lowest: cython.Py_ssize_t = 0
        for k in range(self.samples):
            self.wave[k] = 0.0
        for j in range(self.seen.count):
            re: cython.double = self.re[j, d]
            im: cython.double = self.im[j, d]
            for k in range(self.samples):
                self.wave[k] += re * self.cosine[j, k] - im * self.sine[j, k]
        for k in range(1, self.samples):
            if self.wave[k] > self.wave[highest]:
                highest = k
            if self.wave[k] < self.wave[lowest]:
                lowest = k
        self.extreme(d, highest)
        self.amplitude[d], self.growth[d] = 0.5 * self.value, 0.5 * self.rate
        self.angles[0, d] = self.angle
        self.extreme(d, lowest)
        self.amplitude[d] -= 0.5 * self.value
        self.growth[d] -= 0.5 * self.rate
        self.angles[1, d] = self.angle

    @cython.cfunc
    @cython.exceptval(check=False)
    def extreme(self, d: cython.Py_ssize_t, k: cython.Py_ssize_t) -> cython.void:
        """`value` at the extreme next to a sample, the `rate` of that, and its `angle`."""
        j: cython.int
        step: cython.double = 6.283185307179586 / self.samples
        theta: cython.double = k * step
        slope: cython.double
        curvature: cython.double
        for _ in range(REFINED):
            self.waves_at(theta)
            slope = curvature = 0.0
            for j in range(self.seen.count):
                h: cython.double = self.seen.harmonics[j]
                slope -= h * (self.re[j, d] * self.s[j] + self.im[j, d] * self.c[j])
                curvature -= h * h * (self.re[j, d] * self.c[j] - self.im[j, d] * self.s[j])
            if curvature == 0.0 or fabs(slope) > fabs(curvature) * step:
                theta = k * step
                break
            theta -= slope / curvature
            if fabs(slope) < fabs(curvature) * CLOSE:
                break
        self.waves_at(theta)
        self.angle = theta
        self.value = self.rate = 0.0
        for j in range(self.seen.count):
            self.value += self.re[j, d] * self.c[j] - self.im[j, d] * self.s[j]
            self.rate += self.d_re[j, d] * self.c[j] - self.d_im[j, d] * self.s[j]

    @cython.cfunc
    @cython.exceptval(check=False)
    def waves_at(self, theta: cython.double) -> cython.void:
        """c, s (harmonic,): cosine and sine of each harmonic at an angle."""
        c_1: cython.double = cos(theta)
        s_1: cython.double = sin(theta)
        c: cython.double = 1.0
        s: cython.double = 0.0
        h: cython.int = 0
        j: cython.int
        for j in range(self.seen.count):
            while h < self.seen.harmonics[j]:
                c, s = c * c_1 - s * s_1, s * c_1 + c * s_1
                h += 1
            self.c[j], self.s[j] = c, s
