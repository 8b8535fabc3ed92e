r"""Effect of the harmonics that a balance leaves out, without their feedback on the contact forces.

The exact friction and normal forces of a motion with few harmonics have all harmonics. The response to one of
them is the receptance of the structure at its frequency times its coefficient,

    X_h = -G(h omega) F_h

so that the structure decides as much as the contact which harmonics matter.

A balanced motion with these harmonics added (`EnrichedMotion`) is closer to the exact one. The errors of its
Floquet multipliers are five to ten times smaller. The differences from the multipliers of the balance
estimate the errors of the latter.

For a structure softer than its contacts, such as the halves of a joint, this response would be many times the
motion itself. Where |G K| > 1 at a port, the mean stiffness K of the contacts over the cycle enters,

    (1 + G(h omega) K) X_h = -G(h omega) F_h

On a line the stiffnesses are k_u while a contact sticks, k_v while it is closed, and +-mu k_v (friction by
normal displacement) while it slips.
"""

from __future__ import annotations

from functools import lru_cache

import cython
import numpy as np
import numpy.typing as npt
from cython.cimports.libc.math import fabs, floor, isfinite

from fcm.distinct_values import distinct_values
from fcm.harmonic_balance.contact_law import Law
from fcm.harmonic_balance.options import HARMONIC_BALANCE, SpectrumOptions
from fcm.harmonic_balance.system import System
from fcm.model.scene import FloatArray
from fcm.scene.options import LIMITS
from fcm.structure.receptance import ForcedModes, Receptance

if cython.compiled:
    from cython.cimports.fcm.continuation.dense_solver import eliminate, substitute
else:
    from fcm.continuation.dense_solver import eliminate, substitute


def highest_harmonic(system: System) -> int:
    """Highest harmonic of the exact forces that is computed for a system."""
    return max(LIMITS.harmonics, int(system.options.spectrum.highest_factor * max(system.harmonics)))


@lru_cache(maxsize=256)
def left_out(highest: int, harmonics: tuple[int, ...]) -> npt.NDArray[np.intp]:
    """The harmonics from 1 to highest that are not among harmonics."""
    return np.setdiff1d(np.arange(1, highest + 1), harmonics, assume_unique=True)


@cython.cclass
class FurtherHarmonics:
    """The harmonics of the exact forces at solutions of a balance."""

    def __init__(self, system: System) -> None:
        linear, self.highest = system.linear, highest_harmonic(system)
        self.contacts, self.width = len(system.scene.contacts), system.layout.width
        self.directions = system.layout.directions
        few = system.scene.ring is None and linear.ports.size <= system.options.spectrum.few_products
        own = linear.natural, linear.damping, linear.ports, linear.dofs
        self.modes = ForcedModes(*own) if few else None
        self.natural = np.array(linear.natural)
        self.others, self.least = (
            left_out(self.highest, system.harmonics),
            system.options.spectrum.least_amplitude,
        )
        self.leading = system.options.spectrum.leading_share
        self.force = np.zeros((self.highest, system.layout.ports, 2))
        self.share, self.size = np.zeros(self.highest), np.zeros(linear.dofs.shape[1])
        self.reset(system)

    def reset(self, system: System) -> None:
        """Use another system with the same structure and harmonics; its contacts may differ."""
        self.system = system
        self.laws = system.exact_laws(tuple(range(1, self.highest + 1)))

    def shares(
        self, z: FloatArray, amplitude: FloatArray, known: tuple[int, ...] | None = None
    ) -> FloatArray:
        """Response in each harmonic left out, relative to the amplitude (point, dof): (point, harmonic).

        It is the greatest of all degrees of freedom at points z (point, unknown + 1); an infinite amplitude
        excludes a degree of freedom. It is 0 for the known harmonics, by default those of the balance. A
        harmonic of the balance that is not among the known ones has a share, too.
        """
        found, own = np.zeros((len(z), self.highest)), self.others
        if known is not None:
            self.others = left_out(self.highest, known)
        for i in range(len(z)):
            self.shares_at(z[i], amplitude[i])
            found[i] = self.share
        self.others = own
        self.share[:] = 0.0
        return found

    def resonances(self, z: cython.double[:, ::1], amplitude: cython.double[:, ::1]) -> npt.NDArray[np.intp]:
        """Points of a curve z (point, unknown + 1) where a harmonic left out is in resonance and leads.

        Resonance means that a multiple of the frequency passes a natural frequency. The neighbours of each
        point are included.
        """
        if self.modes is None and self.system.scene.ring is None:
            return self.resonances_of_many(np.asarray(z), np.asarray(amplitude))
        m: cython.Py_ssize_t
        i: cython.Py_ssize_t
        n: cython.Py_ssize_t = z.shape[1] - 1
        met = np.zeros(z.shape[0], dtype=np.uint8)
        flags: cython.uchar[::1] = met
        for m in range(self.natural.shape[0]):
            for i in range(1, z.shape[0] - 2):
                before: cython.double = self.natural[m] / z[i, n]
                after: cython.double = self.natural[m] / z[i + 1, n]
                h: cython.double = floor(max(before, after))
                if h == floor(min(before, after)) or h > self.highest:
                    continue
                at: cython.Py_ssize_t = i + 1 if fabs(after - h) < fabs(before - h) else i
                if self.is_leading(z[at], amplitude[at], cython.cast(cython.Py_ssize_t, h) - 1):
                    flags[at - 1] = flags[at] = flags[at + 1] = 1
        return np.flatnonzero(met)

    def resonances_of_many(
        self, z: npt.NDArray[np.float64], amplitude: npt.NDArray[np.float64]
    ) -> npt.NDArray[np.intp]:
        """Compute `resonances` with many modes or contacts.

        The forces change slowly and are computed at intervals of points. The harmonic in resonance is
        compared with the greatest share at the nearest of these points.
        """
        omega, linear, count = z[:, -1], self.system.linear, self.system.options.spectrum.point_interval
        every = np.arange(min(count // 2, len(z) - 1), len(z), count)
        most, force = np.zeros(len(every)), np.empty((len(every), *np.asarray(self.force).shape))
        for k, i in enumerate(every.tolist()):
            self.shares_at(z[i], amplitude[i])
            most[k], force[k] = np.max(self.share), self.force
        near = np.minimum(np.arange(len(z)) // count, len(every) - 1)
        least = self.least * amplitude.max(axis=1, keepdims=True)
        size = np.maximum(amplitude, least)
        size[size == 0.0] = np.inf
        ratio = self.natural / omega[1:-1, None]
        passed = np.floor(np.maximum(ratio[1:], ratio[:-1]))
        meets = (passed != np.floor(np.minimum(ratio[1:], ratio[:-1]))) & (passed <= self.highest)
        met = np.zeros(len(z), dtype=np.bool_)
        for h in distinct_values(passed[meets]).tolist():
            if int(h) not in self.others:
                continue
            step, mode = np.nonzero(meets & (passed == h))
            later = np.abs(ratio[step + 1, mode] - h) < np.abs(ratio[step, mode] - h)
            at = distinct_values(1 + step + later)
            ports = force[near[at], int(h) - 1].view(np.complex128)[..., 0][:, None]
            displaced = np.abs(linear.displacements(np.array([h]), omega[at], ports))[:, 0]
            leading = at[(displaced / size[at]).max(axis=1) > self.leading * most[near[at]]]
            for beside in (-1, 0, 1):
                met[leading + beside] = True
        return np.flatnonzero(met)

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def is_leading(
        self, z: cython.double[::1], amplitude: cython.double[::1], h: cython.Py_ssize_t
    ) -> cython.bint:
        """Whether the share of harmonic h + 1 leads at a point; false if all contacts are linear there."""
        k: cython.Py_ssize_t
        most: cython.double = 0.0
        bent: cython.bint = False
        for k in range(self.contacts):
            law: Law = self.laws[k]
            law.evaluate_forces(z, k * self.width)
            bent = bent or law.nonlinear
        if not bent:
            return False
        self.shares_at(z, amplitude)
        for k in range(self.highest):
            most = max(most, self.share[k])
        return self.share[h] > self.leading * most

    def linear(self, z: FloatArray) -> npt.NDArray[np.bool_]:
        """Whether no contact slips or separates (point,), so that the forces have no further harmonics."""
        linear = np.ones(len(z), dtype=np.bool_)
        for i in range(len(z)):
            for c, law in enumerate(self.laws):
                law.evaluate_forces(z[i], c * self.width)
                linear[i] &= not law.nonlinear
        return linear

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def shares_at(self, z: cython.double[::1], amplitude: cython.double[::1]) -> cython.int:
        """Fill share (harmonic,), a row of `shares`."""
        c: cython.Py_ssize_t
        h: cython.Py_ssize_t
        k: cython.Py_ssize_t
        at: cython.Py_ssize_t
        most: cython.double = 0.0
        for c in range(self.contacts):
            law: Law = self.laws[c]
            law.evaluate_forces(z, c * self.width)
            for h in range(self.highest):
                for k in range(self.directions):
                    at = self.directions * (1 + 2 * h) + 2 * k
                    self.force[h, c * self.directions + k, 0] = law.force[at]
                    self.force[h, c * self.directions + k, 1] = law.force[at + 1]
        for k in range(self.size.shape[0]):
            if isfinite(amplitude[k]):  # an infinite amplitude excludes a degree of freedom
                most = max(most, amplitude[k])
        for k in range(self.size.shape[0]):
            self.size[k] = max(amplitude[k], self.least * most)
        if self.modes is None:
            return self.shares_of_many(z[self.contacts * self.width])
        self.modes.shares(self.others, z[self.contacts * self.width], self.force, self.size, self.share)
        return 0

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def shares_of_many(self, omega: cython.double) -> cython.int:
        """Fill share with many modes, by BLAS, or for a ring."""
        others, size = np.asarray(self.others), np.asarray(self.size)
        force = np.asarray(self.force).view(np.complex128)[others - 1, :, 0][None]
        linear, at = self.system.linear, np.array([omega])
        displaced = np.abs(linear.displacements(others.astype(np.float64), at, force))[0]
        np.asarray(self.share)[others - 1] = (displaced / np.where(size > 0.0, size, np.inf)).max(axis=1)
        return 0


def enriched_harmonics(
    harmonics: list[int], options: SpectrumOptions = HARMONIC_BALANCE.spectrum
) -> list[int]:
    """Harmonics of the enriched motion: all up to the highest, and about as many beyond it."""
    highest = max(harmonics)
    further = min(max(highest, options.min_further), options.max_further)
    return list(range(1, highest + further + 1))


@cython.cclass
class EnrichedMotion:
    """The motion of a balance enriched by further harmonics, the response to its exact contact forces.

    `at` fills x, the unknowns of the enriched motion, for a point z of the balance. laws (contact,) have the
    harmonics of the balance for the motion, and the finer harmonics for the forces.

    shift is the greatest amplitude added to a displacement of a contact, relative to the greatest balanced
    amplitude of that displacement. Tangential and normal displacements have separate references, since even
    a small normal motion may open and close a contact. The mean indentation or gap is the reference where it
    is greater. In a plane both tangential directions share one: a small motion across turns the slip little.
    """

    def __init__(
        self,
        receptance: Receptance,
        laws: list[Law],
        harmonics: list[int],
        options: SpectrumOptions = HARMONIC_BALANCE.spectrum,
    ) -> None:
        self.few = receptance.ports <= options.compiled_ports
        finer = [int(h) for h in receptance.harmonics]
        self.receptance, self.laws, self.contacts = receptance, laws, len(laws)
        self.directions = receptance.ports // self.contacts if laws else 0
        self.width = self.directions * (1 + 2 * len(harmonics))
        self.wide = self.directions * (1 + 2 * len(finer))
        self.force, self.x = np.zeros((self.contacts, self.wide)), np.zeros(self.contacts * self.wide)
        where = [harmonics.index(h) if h in harmonics else -1 for h in finer]
        self.place, self.shift = np.array(where, dtype=np.intc), 0.0
        self.resistance = np.zeros((self.contacts, self.directions, self.directions))
        self.stiffness: npt.NDArray[np.float64] | None = None  # resistance on the modes
        size = 2 * receptance.ports if self.few else 0
        self.matrix, self.right = np.zeros((size, size)), np.zeros(size)
        self.swapped = np.zeros(size, dtype=np.intc)

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def at(self, z: cython.double[::1]) -> cython.int:
        """Fill x, the unknowns of the enriched motion, at a point z of the balance."""
        c: cython.Py_ssize_t
        i: cython.Py_ssize_t
        k: cython.Py_ssize_t
        h: cython.Py_ssize_t
        self.receptance.at(z[self.contacts * self.width])
        for c in range(self.contacts):
            law: Law = self.laws[c]
            law.evaluate_forces(z, c * self.width)
            law.compute_resistance()
            for i in range(self.wide):
                self.force[c, i] = law.force[i]
            for i in range(self.directions):
                for k in range(self.directions):
                    self.resistance[c, i, k] = law.resistance[i, k]
        self.unknowns(z)
        self.stiffness = None
        for h in range(self.place.shape[0]):
            if self.place[h] < 0 and self.few:
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
        """Greatest amplitude added at some ports, relative to the greatest balanced one or to least.

        0 if there is no such reference.
        """
        h: cython.Py_ssize_t
        i: cython.Py_ssize_t
        p: cython.Py_ssize_t
        most: cython.double = least
        new: cython.double = 0.0
        for h in range(self.place.shape[0]):
            for p in range(first, first + ports):
                for i in range(2):
                    size: cython.double = abs(
                        self.x[self.receptance.wave_at[p] + self.receptance.stride * h + i]
                    )
                    if self.place[h] < 0:
                        new = max(new, size)
                    else:
                        most = max(most, size)
        return new / most if most > 0.0 else 0.0

    @cython.cfunc
    @cython.exceptval(check=False)
    def unknowns(self, z: cython.double[::1]) -> cython.void:
        """Copy the balanced unknowns z to their places in x."""
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
        """Fill x with the response of the structure in one harmonic left out, at few ports."""
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
                G_re, G_im = self.receptance.G_re[h, p, p], self.receptance.G_im[h, p, p]
                re = self.resistance[c, d, d]
                resisted = resisted or (G_re * G_re + G_im * G_im) * re * re > 1.0
        for p in range(self.receptance.ports):
            self.right[2 * p] = self.right[2 * p + 1] = 0.0
            for c in range(self.contacts):
                for d in range(each):
                    q, at = c * each + d, each * (1 + 2 * h) + 2 * d
                    G_re, G_im = self.receptance.G_re[h, p, q], self.receptance.G_im[h, p, q]
                    self.right[2 * p] -= G_re * self.force[c, at] - G_im * self.force[c, at + 1]
                    self.right[2 * p + 1] -= G_re * self.force[c, at + 1] + G_im * self.force[c, at]
                    if not resisted:
                        continue
                    re = im = 0.0  # a displacement may also change forces in other directions
                    for e in range(each):
                        re += self.receptance.G_re[h, p, c * each + e] * self.resistance[c, e, d]
                        im += self.receptance.G_im[h, p, c * each + e] * self.resistance[c, e, d]
                    self.matrix[2 * p, 2 * q] = self.matrix[2 * p + 1, 2 * q + 1] = re
                    self.matrix[2 * p + 1, 2 * q] = im
                    self.matrix[2 * p, 2 * q + 1] = -im
            if resisted:
                self.matrix[2 * p, 2 * p] += 1.0
                self.matrix[2 * p + 1, 2 * p + 1] += 1.0
        if resisted and eliminate(self.matrix, self.swapped) != 0.0:
            substitute(self.matrix, self.swapped, self.right)
        for p in range(self.receptance.ports):
            at = self.receptance.wave_at[p] + self.receptance.stride * h
            self.x[at], self.x[at + 1] = self.right[2 * p], self.right[2 * p + 1]

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def displace_many(self, h: cython.int) -> cython.int:
        """Fill x with the response of the structure in one harmonic left out, at many ports.

        It is computed by modes where the receptance matrix is not formed.
        """
        receptance, each = self.receptance, self.directions
        at = np.asarray(receptance.wave_at) + receptance.stride * h
        force, K = np.asarray(self.force).ravel(), np.asarray(self.resistance)
        F, spring = force[at] + 1j * force[at + 1], np.diagonal(K, axis1=1, axis2=2).ravel()
        if receptance.summed:
            G = receptance.of_harmonic(h)
            X = -(G @ F)
            if (np.abs(G.diagonal()) * spring > 1.0).any():
                GK = (G.reshape(-1, self.contacts, 1, each) @ K).reshape(G.shape)
                X = np.asarray(np.linalg.solve(np.eye(len(G)) + GK, X), dtype=np.complex128)
        else:
            P = np.asarray(receptance.shapes)
            c = np.asarray(receptance.c_re)[h] + 1j * np.asarray(receptance.c_im)[h]
            q = -c * (P @ F)
            if (np.abs(c @ np.square(P)) * spring > 1.0).any():
                if self.stiffness is None:
                    self.stiffness = (P.reshape(-1, self.contacts, 1, each) @ K).reshape(P.shape) @ P.T
                q = np.linalg.solve(np.eye(len(c)) + c[:, None] * self.stiffness, q)
            X = q @ P
        x = np.asarray(self.x)
        x[at], x[at + 1] = X.real, X.imag
        return 0
