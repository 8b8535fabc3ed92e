"""The greatest and the least displacement of a motion of several harmonics over a cycle."""

from __future__ import annotations

import cython
import numpy as np
from cython.cimports.libc.math import cos, fabs, hypot, sin

from fcm.harmonic_balance.angle_samples import waves

REFINED = cython.declare(cython.int, 4)  # Newton steps from a sample to the extreme, at most
# [rad] the last of them, after which the angle errs by its square
CLOSE = cython.declare(cython.double, 1e-6)
BLOCK = cython.declare(cython.int, 256)  # degrees of freedom whose samples lie in the processor's cache
MANY = cython.declare(cython.int, 50)  # degrees of freedom from which on sums over modes and waves are BLAS's


@cython.cclass
class Extremes:
    """re, im (harmonic, dof) amplitudes of x = mean + Re sum X exp(i h theta), d_re, d_im their rates: parts
    (4 * harmonic, dof) one after the other.

    amplitude (dof,): half the peak-to-peak displacement, with one harmonic |X|; growth: its rate; angles
    (2, dof): of the greatest and the least displacement, if there are several.
    """

    def __init__(self, harmonics: cython.double[::1], dofs: cython.int) -> None:
        count: cython.int = harmonics.shape[0]
        self.harmonics, self.count, self.dofs = harmonics, count, dofs
        self.parts = np.zeros((4 * count, dofs))
        self.re, self.im, self.d_re, self.d_im = np.asarray(self.parts).reshape(4, count, dofs)
        self.amplitude, self.growth, self.angles = np.zeros(dofs), np.zeros(dofs), np.zeros((2, dofs))
        self.cosine, self.sine = waves(tuple(np.asarray(harmonics).tolist()))
        self.samples = self.cosine.shape[1]
        self.sampling = np.concatenate((self.cosine, np.negative(self.sine)))
        self.wave, self.c, self.s = np.zeros(self.samples), np.zeros(count), np.zeros(count)
        self.value = self.rate = self.angle = 0.0

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def fill(self) -> cython.int:
        """Amplitude, growth and angles from the parts."""
        d: cython.Py_ssize_t
        if self.count == 1:
            for d in range(self.dofs):
                self.single(d)
        elif self.dofs > MANY:
            self.many()
        else:
            for d in range(self.dofs):
                self.several(d)
        return 0

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
        """Several: half the distance of the greatest and the least displacement."""
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
        """The same of all degrees of freedom."""
        d: cython.Py_ssize_t
        first: cython.Py_ssize_t
        amplitudes = np.asarray(self.parts)[: 2 * self.count].T
        for first in range(0, self.dofs, BLOCK):
            sampled: cython.double[:, ::1] = amplitudes[first : first + BLOCK] @ self.sampling
            for d in range(sampled.shape[0]):
                self.wave[:] = sampled[d]
                self.both(first + d)
        return 0

    @cython.cfunc
    @cython.exceptval(check=False)
    def both(self, d: cython.Py_ssize_t) -> cython.void:
        """The greatest and the least of a sampled displacement."""
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
        """The half of the amplitude on a side, of the displacement (0) or of minus it (1).

        Between samples an extreme is greater than these by `between` at most, the curvature times the square
        of half their distance over 2. So the greatest may be one next to lower samples than another.
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
            beside: cython.double = sign * self.wave[k - 1 if k > 0 else last]
            beside = max(beside, sign * self.wave[k + 1 if k < last else 0])
            if here < beside or here + between < max(most, value):
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
        """`value` at the extreme next to a sample, the `rate` of that, and its `angle`."""
        j: cython.int
        step: cython.double = 6.283185307179586 / self.samples
        theta: cython.double = k * step
        slope: cython.double
        curvature: cython.double
        for _ in range(REFINED):
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
            if fabs(slope) < fabs(curvature) * CLOSE:
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
        """c, s (harmonic,): cosine and sine of each harmonic at an angle."""
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
