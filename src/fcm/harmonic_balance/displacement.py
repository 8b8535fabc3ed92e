"""Displacements of the reported degrees of freedom, and their rates of change along a curve.

`Extremes` finds the greatest and the least value of a motion of several harmonics over a cycle. In a ring
with a travelling wave they are those of one sector (`TravellingDisplacements`).
"""

from __future__ import annotations

import cython
import numpy as np
import numpy.typing as npt
from cython.cimports.libc.math import cos, fabs, hypot, sin

from fcm.harmonic_balance.angle_samples import waves
from fcm.harmonic_balance.options import HARMONIC_BALANCE, ExtremeOptions
from fcm.structure.linear import Linear
from fcm.structure.receptance import Receptance, TravellingReceptance


@cython.cclass
class Extremes:
    """Amplitudes of displacements x = mean + Re sum X exp(i h theta), and their rates along a curve.

    Input: re, im (harmonic, dof) of X, and d_re, d_im of its rate. parts (4 * harmonic, dof) holds all four.

    Output: amplitude (dof,) is half the peak-to-peak displacement, |X| with one harmonic. growth (dof,) is
    its rate. angles (2, dof) are those of the greatest and the least displacement, with several harmonics.
    """

    def __init__(
        self,
        harmonics: cython.double[::1],
        dofs: cython.int,
        options: ExtremeOptions = HARMONIC_BALANCE.extremes,
    ) -> None:
        count: cython.int = harmonics.shape[0]
        self.harmonics, self.count, self.dofs = harmonics, count, dofs
        self.parts = np.zeros((4 * count, dofs))
        self.re, self.im, self.d_re, self.d_im = np.asarray(self.parts).reshape(4, count, dofs)
        self.amplitude, self.growth, self.angles = np.zeros(dofs), np.zeros(dofs), np.zeros((2, dofs))
        self.cosine, self.sine = waves(tuple(np.asarray(harmonics).tolist()), options.samples)
        self.samples = self.cosine.shape[1]
        self.sampling = np.concatenate((self.cosine, np.negative(self.sine)))
        self.wave, self.c, self.s = np.zeros(self.samples), np.zeros(count), np.zeros(count)
        self.value = self.rate = self.angle = 0.0
        self.max_steps, self.step_tolerance = options.max_steps, options.step_tolerance
        self.block, self.many_dofs = options.block, options.many_dofs

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def fill(self) -> cython.int:
        """Fill amplitude, growth and angles from the parts."""
        d: cython.Py_ssize_t
        if self.count == 1:
            for d in range(self.dofs):
                self.single(d)
        elif self.dofs > self.many_dofs:
            self.many()
        else:
            for d in range(self.dofs):
                self.several(d)
        return 0

    @cython.cfunc
    @cython.exceptval(check=False)
    def single(self, d: cython.Py_ssize_t) -> cython.void:
        """Fill amplitude and growth of a degree of freedom with one harmonic: |X| and its rate."""
        size: cython.double = hypot(self.re[0, d], self.im[0, d])
        self.amplitude[d] = size
        self.growth[d] = 0.0
        if size > 0.0:
            self.growth[d] = self.re[0, d] / size * self.d_re[0, d] + self.im[0, d] / size * self.d_im[0, d]

    @cython.cfunc
    @cython.exceptval(check=False)
    def several(self, d: cython.Py_ssize_t) -> cython.void:
        """Fill amplitude and growth of a degree of freedom with several harmonics."""
        k: cython.Py_ssize_t
        j: cython.int
        for k in range(self.samples):
            self.wave[k] = 0.0
        for j in range(self.count):
            re: cython.double = self.re[j, d]
            im: cython.double = self.im[j, d]
            for k in range(self.samples):
                self.wave[k] += re * self.cosine[j, k] - im * self.sine[j, k]
        self.both(d)

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def many(self) -> cython.int:
        """Fill amplitude and growth of all degrees of freedom at once, with several harmonics."""
        d: cython.Py_ssize_t
        first: cython.Py_ssize_t
        amplitudes = np.asarray(self.parts)[: 2 * self.count].T
        for first in range(0, self.dofs, self.block):
            sampled: cython.double[:, ::1] = amplitudes[first : first + self.block] @ self.sampling
            for d in range(sampled.shape[0]):
                self.wave[:] = sampled[d]
                self.both(first + d)
        return 0

    @cython.cfunc
    @cython.exceptval(check=False)
    def both(self, d: cython.Py_ssize_t) -> cython.void:
        """Fill amplitude and growth from the samples: half the difference of the two extremes."""
        j: cython.int
        step: cython.double = 6.283185307179586 / self.samples
        between: cython.double = 0.0
        for j in range(self.count):
            h: cython.double = self.harmonics[j] * step
            between += 0.125 * h * h * hypot(self.re[j, d], self.im[j, d])
        self.amplitude[d] = self.growth[d] = 0.0
        self.greatest(d, 0, between)
        self.greatest(d, 1, between)

    @cython.cfunc
    @cython.exceptval(check=False)
    def greatest(self, d: cython.Py_ssize_t, side: cython.int, between: cython.double) -> cython.void:
        """Add half the maximum of a displacement (side 0), or of its negative (side 1), to its amplitude.

        An extreme exceeds the samples next to it by at most `between`: half the curvature times the square of
        half the sampling interval. So the global extreme need not be next to the greatest sample.
        """
        k: cython.Py_ssize_t
        last: cython.Py_ssize_t = self.samples - 1
        sign: cython.double = 1.0 - 2.0 * side
        most: cython.double = sign * self.wave[0]
        for k in range(1, self.samples):
            most = max(most, sign * self.wave[k])
        value: cython.double = most - 1.0 - fabs(most)
        rate: cython.double = 0.0
        for k in range(self.samples):
            here: cython.double = sign * self.wave[k]
            neighbour: cython.double = sign * self.wave[k - 1 if k > 0 else last]
            neighbour = max(neighbour, sign * self.wave[k + 1 if k < last else 0])
            if here < neighbour or here + between < max(most, value):
                continue
            self.extreme(d, k)
            if sign * self.value > value:
                value, rate = sign * self.value, sign * self.rate
                self.angles[side, d] = self.angle
        self.amplitude[d] += 0.5 * value
        self.growth[d] += 0.5 * rate

    @cython.cfunc
    @cython.exceptval(check=False)
    def extreme(self, d: cython.Py_ssize_t, k: cython.Py_ssize_t) -> cython.void:
        """Find the extreme next to a sample by Newton's method: fill `value`, `rate` and `angle`."""
        j: cython.int
        step: cython.double = 6.283185307179586 / self.samples
        theta: cython.double = k * step
        slope: cython.double
        curvature: cython.double
        for _ in range(self.max_steps):
            self.waves_at(theta)
            slope = curvature = 0.0
            for j in range(self.count):
                h: cython.double = self.harmonics[j]
                slope -= h * (self.re[j, d] * self.s[j] + self.im[j, d] * self.c[j])
                curvature -= h * h * (self.re[j, d] * self.c[j] - self.im[j, d] * self.s[j])
            if curvature == 0.0 or fabs(slope) > fabs(curvature) * step:
                theta = k * step
                break
            theta -= slope / curvature
            if fabs(slope) < fabs(curvature) * self.step_tolerance:
                break
        self.waves_at(theta)
        self.angle = theta
        self.value = self.rate = 0.0
        for j in range(self.count):
            self.value += self.re[j, d] * self.c[j] - self.im[j, d] * self.s[j]
            self.rate += self.d_re[j, d] * self.c[j] - self.d_im[j, d] * self.s[j]

    @cython.cfunc
    @cython.exceptval(check=False)
    def waves_at(self, theta: cython.double) -> cython.void:
        """Fill c, s (harmonic,) with the cosine and sine of each harmonic at an angle."""
        c_1: cython.double = cos(theta)
        s_1: cython.double = sin(theta)
        c: cython.double = 1.0
        s: cython.double = 0.0
        h: cython.int = 0
        j: cython.int
        for j in range(self.count):
            while h < self.harmonics[j]:
                c, s = c * c_1 - s * s_1, s * c_1 + c * s_1
                h += 1
            self.c[j], self.s[j] = c, s


@cython.cclass
class Displacements(Extremes):
    """Displacements of the reported degrees of freedom, with their `Extremes`.

    `at` fills the parts. Most degrees of freedom are sums of the shapes (mode, dof) times of_modes (4 *
    harmonic, mode). Those that are combinations of ports are sums of shares (share,) times the displacements
    of the ports share_ports (share,); share_end (dof,) is the end of each sum.

    mean (dof,) is the mean displacement. rest (dof,) is the response to static loads alone; for a combination
    of ports it is the origin from which the displacements of the ports count.
    """

    def __init__(
        self, receptance: Receptance, linear: Linear, options: ExtremeOptions = HARMONIC_BALANCE.extremes
    ) -> None:
        count, dofs = receptance.count, linear.dofs.shape[1]
        Extremes.__init__(self, receptance.harmonics, dofs, options)
        self.receptance = receptance
        self.shapes, self.static = linear.dofs, linear.static_of_dofs
        self.of_modes = np.zeros((4 * count, receptance.modes))
        self.mean, self.rest = np.zeros(dofs), np.zeros(dofs)
        self.attached, self.without_modes = linear.attached
        self.by_modes = bool(np.any(self.without_modes))
        combined, port = np.nonzero(np.where(self.without_modes, 0.0, self.attached).T)
        self.shares, self.share_ports = np.asarray(self.attached)[port, combined], port.astype(np.intc)
        self.share_end = np.cumsum(np.bincount(combined, minlength=dofs)).astype(np.intc)

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
        """Fill the displacements and their rates from the contact forces and their rates, each (unknown,).

        The receptance must be at the frequency of z. Combinations of ports are computed from the unknowns z
        (unknown + 1,) instead: forces that nearly balance leave few digits of a small displacement.
        """
        j: cython.int
        d: cython.Py_ssize_t
        p: cython.Py_ssize_t
        for d in range(self.dofs):
            if not self.without_modes[d]:
                continue
            total: cython.double = self.rest[d]
            for p in range(self.receptance.ports):
                total -= self.static[d, p] * force[self.receptance.mean_at[p]]
            self.mean[d] = total
        if self.by_modes:
            for j in range(self.receptance.count):
                self.harmonic(j, load, force, d_force, direction[direction.shape[0] - 1])
            self.sum_modes()
        for d in range(self.dofs):
            if not self.without_modes[d]:
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
        """Fill the amplitudes of the modes in one harmonic."""
        n: cython.Py_ssize_t = self.receptance.count
        i: cython.Py_ssize_t
        p: cython.Py_ssize_t
        k: cython.Py_ssize_t
        forced: cython.int = self.receptance.forced[j]
        driven: cython.double = load if forced >= 0 else 0.0
        forced = max(forced, 0)
        for i in range(self.receptance.modes):
            f_re: cython.double = driven * self.receptance.force_re[forced, i]
            f_im: cython.double = driven * self.receptance.force_im[forced, i]
            g_re: cython.double = driven * d_omega * self.receptance.slope_re[forced, i]
            g_im: cython.double = driven * d_omega * self.receptance.slope_im[forced, i]
            for p in range(self.receptance.ports):
                k = self.receptance.wave_at[p] + self.receptance.stride * j
                f_re -= self.receptance.shapes[i, p] * force[k]
                f_im -= self.receptance.shapes[i, p] * force[k + 1]
                g_re -= self.receptance.shapes[i, p] * d_force[k]
                g_im -= self.receptance.shapes[i, p] * d_force[k + 1]
            self.f_re, self.f_im, self.g_re, self.g_im = f_re, f_im, g_re, g_im
            self.move(self.receptance, j, i, d_omega)
            self.of_modes[j, i], self.of_modes[n + j, i] = self.q_re, self.q_im
            self.of_modes[2 * n + j, i], self.of_modes[3 * n + j, i] = self.r_re, self.r_im
        return 0

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def sum_modes(self) -> cython.int:
        """Sum the modes to displacements of the degrees of freedom."""
        k: cython.Py_ssize_t
        i: cython.Py_ssize_t
        d: cython.Py_ssize_t
        if self.dofs > self.many_dofs:
            np.matmul(np.asarray(self.of_modes), np.asarray(self.shapes), out=np.asarray(self.parts))
            return 0
        for k in range(self.parts.shape[0]):
            for d in range(self.dofs):
                self.parts[k, d] = 0.0
            for i in range(self.receptance.modes):
                for d in range(self.dofs):
                    self.parts[k, d] += self.shapes[i, d] * self.of_modes[k, i]
        return 0

    @cython.cfunc
    @cython.exceptval(check=False)
    def move(
        self, receptance: Receptance, j: cython.int, i: cython.Py_ssize_t, d_omega: cython.double
    ) -> cython.void:
        """Compute amplitude q and rate r of mode i in harmonic j, from its force f and the rate g of f."""
        c_re: cython.double = receptance.c_re[j, i]
        c_im: cython.double = receptance.c_im[j, i]
        s_re: cython.double = receptance.s_re[j, i] * d_omega
        s_im: cython.double = receptance.s_im[j, i] * d_omega
        self.q_re = c_re * self.f_re - c_im * self.f_im
        self.q_im = c_re * self.f_im + c_im * self.f_re
        self.r_re = c_re * self.g_re - c_im * self.g_im + s_re * self.f_re - s_im * self.f_im
        self.r_im = c_re * self.g_im + c_im * self.g_re + s_re * self.f_im + s_im * self.f_re

    @cython.cfunc
    @cython.exceptval(check=False)
    def from_ports(
        self, d: cython.Py_ssize_t, z: cython.double[::1], direction: cython.double[::1]
    ) -> cython.void:
        """Fill a degree of freedom that is a combination of ports."""
        i: cython.Py_ssize_t
        j: cython.int
        p: cython.Py_ssize_t
        k: cython.Py_ssize_t
        self.mean[d] = self.rest[d]
        for j in range(self.receptance.count):
            self.re[j, d] = self.im[j, d] = self.d_re[j, d] = self.d_im[j, d] = 0.0
        for i in range(self.share_end[d - 1] if d > 0 else 0, self.share_end[d]):
            p = self.share_ports[i]
            share: cython.double = self.shares[i]
            self.mean[d] += share * z[self.receptance.mean_at[p]]
            for j in range(self.receptance.count):
                k = self.receptance.wave_at[p] + self.receptance.stride * j
                self.re[j, d] += share * z[k]
                self.im[j, d] += share * z[k + 1]
                self.d_re[j, d] += share * direction[k]
                self.d_im[j, d] += share * direction[k + 1]


@cython.cclass
class TravellingDisplacements(Displacements):
    """Displacements of a ring: each harmonic has the shapes (mode, dof) of the nodal diameter it excites."""

    def __init__(
        self,
        receptance: TravellingReceptance,
        linear: Linear,
        shapes: list[npt.NDArray[np.complex128]],
        options: ExtremeOptions = HARMONIC_BALANCE.extremes,
    ) -> None:
        Displacements.__init__(self, receptance, linear, options)
        self.waves = receptance.waves
        most = max((len(one) for one in shapes), default=0)
        self.wave_re, self.wave_im = np.zeros((2, len(shapes), most, self.dofs))
        for j, one in enumerate(shapes):
            np.asarray(self.wave_re)[j, : len(one)] = one.real
            np.asarray(self.wave_im)[j, : len(one)] = one.imag

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
        """Fill the amplitudes of the degrees of freedom in one harmonic, mode by mode."""
        wave: Receptance = self.waves[j]
        n: cython.Py_ssize_t = self.receptance.ports
        i: cython.Py_ssize_t
        d: cython.Py_ssize_t
        p: cython.Py_ssize_t
        k: cython.Py_ssize_t
        driven: cython.double = load if self.receptance.forced[j] >= 0 else 0.0
        self.clear(j)
        for i in range(wave.modes):
            f_re: cython.double = driven * wave.force_re[0, i]
            f_im: cython.double = driven * wave.force_im[0, i]
            g_re: cython.double = driven * d_omega * wave.slope_re[0, i]
            g_im: cython.double = driven * d_omega * wave.slope_im[0, i]
            for p in range(n):
                k = self.receptance.wave_at[p] + self.receptance.stride * j
                a: cython.double = wave.shapes[i, p]
                b: cython.double = wave.shapes[i, n + p]
                f_re -= a * force[k] + b * force[k + 1]
                f_im -= a * force[k + 1] - b * force[k]
                g_re -= a * d_force[k] + b * d_force[k + 1]
                g_im -= a * d_force[k + 1] - b * d_force[k]
            self.f_re, self.f_im, self.g_re, self.g_im = f_re, f_im, g_re, g_im
            self.move(wave, 0, i, d_omega)
            for d in range(self.dofs):
                a = self.wave_re[j, i, d]
                b = self.wave_im[j, i, d]
                self.re[j, d] += a * self.q_re - b * self.q_im
                self.im[j, d] += a * self.q_im + b * self.q_re
                self.d_re[j, d] += a * self.r_re - b * self.r_im
                self.d_im[j, d] += a * self.r_im + b * self.r_re
        return 0

    @cython.cfunc
    @cython.exceptval(check=False)
    def clear(self, j: cython.int) -> cython.void:
        """Set the amplitudes of a harmonic to zero."""
        d: cython.Py_ssize_t
        for d in range(self.dofs):
            self.re[j, d] = self.im[j, d] = self.d_re[j, d] = self.d_im[j, d] = 0.0

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def sum_modes(self) -> cython.int:
        """Do nothing: `harmonic` has summed the modes."""
        return 0
