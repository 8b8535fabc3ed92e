r"""What harmonics that a balance leaves out would do, were there no feedback.

The exact friction and normal forces of a motion of few harmonics have all harmonics; what one of them does is
its coefficient times the receptance of the structure at its frequency,

    X_h = -G(h omega) F_h

so that it is the structure as much as the contact that decides which harmonics matter.
"""

from __future__ import annotations

from functools import lru_cache

import cython
import numpy as np
import numpy.typing as npt
from cython.cimports.libc.math import fabs, floor, isfinite

from fcm.harmonic_balance.contact_law import Law
from fcm.harmonic_balance.system import System
from fcm.model.scene import FloatArray
from fcm.scene.options import LIMITS
from fcm.structure.receptance import ForcedModes


def highest_harmonic(system: System) -> int:
    """Harmonic up to which the forces of a system's motions are looked at."""
    return max(LIMITS.harmonics, int(system.options.spectrum.ahead * max(system.harmonics)))


@lru_cache(maxsize=256)
def left_out(highest: int, harmonics: tuple[int, ...]) -> npt.NDArray[np.intp]:
    """The harmonics up to the highest that are not among some."""
    return np.setdiff1d(np.arange(1, highest + 1), harmonics)


@cython.cclass
class FurtherHarmonics:
    """The harmonics of the exact forces of motions of a system's balance."""

    def __init__(self, system: System) -> None:
        linear, self.highest = system.linear, highest_harmonic(system)
        self.contacts, self.width = len(system.scene.contacts), system.layout.width
        self.directions = system.layout.directions
        few = system.scene.ring is None and linear.ports.size <= system.options.spectrum.few
        own = linear.natural, linear.damping, linear.ports, linear.dofs
        self.modes = ForcedModes(*own) if few else None
        self.natural = np.array(linear.natural)
        self.others, self.least = (
            left_out(self.highest, system.harmonics),
            system.options.spectrum.least_amplitude,
        )
        self.leading = system.options.spectrum.leads
        self.force = np.zeros((self.highest, system.layout.ports, 2))
        self.share, self.size = np.zeros(self.highest), np.zeros(linear.dofs.shape[1])
        self.reset(system)

    def reset(self, system: System) -> None:
        """A system with the same structure and harmonics, whose contacts may be others."""
        self.system = system
        self.laws = system.exact_laws(tuple(range(1, self.highest + 1)))

    def shares(
        self, z: FloatArray, amplitude: FloatArray, known: tuple[int, ...] | None = None
    ) -> FloatArray:
        """Share of the amplitude (point, dof) that each harmonic left out would have: (point, harmonic).

        Of motions z (point, unknown + 1) the greatest of all degrees of freedom of finite amplitude;
        zero for known harmonics, those of the balance unless others are given: then, for harmonics of the
        balance, what they have.
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
        """Points of a curve z (point, unknown + 1) where a harmonic that is left out meets a mode and leads
        there, each with those beside it."""
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
        """The same of many modes or contacts.

        The forces, which change slowly, are those of every so many points, and a harmonic that meets a mode
        is compared with the greatest share there.
        """
        omega, linear, count = z[:, -1], self.system.linear, self.system.options.spectrum.every
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
        for h in np.unique(passed[meets]).tolist():
            if int(h) not in self.others:
                continue
            step, mode = np.nonzero(meets & (passed == h))
            later = np.abs(ratio[step + 1, mode] - h) < np.abs(ratio[step, mode] - h)
            at = np.unique(1 + step + later)
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
        """Whether one of the shares at a point is nearly the greatest: none is where contacts are linear."""
        k: cython.Py_ssize_t
        most: cython.double = 0.0
        bent: cython.bint = False
        for k in range(self.contacts):
            law: Law = self.laws[k]
            law.probe(z, k * self.width)
            bent = bent or law.nonlinear
        if not bent:
            return False
        self.shares_at(z, amplitude)
        for k in range(self.highest):
            most = max(most, self.share[k])
        return self.share[h] > self.leading * most

    def linear(self, z: FloatArray) -> npt.NDArray[np.bool_]:
        """Whether no contact slips or separates, so that the forces have no further harmonic, (point,)."""
        linear = np.ones(len(z), dtype=np.bool_)
        for i in range(len(z)):
            for c, law in enumerate(self.laws):
                law.probe(z[i], c * self.width)
                linear[i] &= not law.nonlinear
        return linear

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def shares_at(self, z: cython.double[::1], amplitude: cython.double[::1]) -> cython.int:
        """Fill share (harmonic,), as one row of `shares`."""
        c: cython.Py_ssize_t
        h: cython.Py_ssize_t
        k: cython.Py_ssize_t
        at: cython.Py_ssize_t
        most: cython.double = 0.0
        for c in range(self.contacts):
            law: Law = self.laws[c]
            law.probe(z, c * self.width)
            for h in range(self.highest):
                for k in range(self.directions):
                    at = self.directions * (1 + 2 * h) + 2 * k
                    self.force[h, c * self.directions + k, 0] = law.force[at]
                    self.force[h, c * self.directions + k, 1] = law.force[at + 1]
        for k in range(self.size.shape[0]):
            if isfinite(amplitude[k]):  # infinite: of a degree of freedom that does not count
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
        """Of many modes, by BLAS, or of a ring."""
        others, size = np.asarray(self.others), np.asarray(self.size)
        force = np.asarray(self.force).view(np.complex128)[others - 1, :, 0][None]
        linear, at = self.system.linear, np.array([omega])
        displaced = np.abs(linear.displacements(others.astype(np.float64), at, force))[0]
        np.asarray(self.share)[others - 1] = (displaced / np.where(size > 0.0, size, np.inf)).max(axis=1)
        return 0
