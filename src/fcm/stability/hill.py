r"""Stability by Hill's method, for contacts whose sequence of states is not known.

A disturbance exp(s t) p(t) of a periodic motion is balanced with the harmonics of the motion itself. The
modes are of mass 1, with shapes P on the ports. D is the time derivative of means, cosines and sines, and T
is the derivative of the contacts' forces by the motion:

    ((s + D)^2 + 2 zeta_i w_i (s + D) + w_i^2) q_i + P_i T P^T q = 0.

This eigenvalue problem has twice as many exponents s as modes times unknowns of each mode. Each exponent
comes several times, shifted by i k omega. The copy whose p(t) lies most evenly about its mean has lost least
by truncation (Lazarus and Thomas, Comptes Rendus Mecanique 338, 2010). The multipliers are
exp(2 pi s / omega).

T is the derivative for periodic motions. For a law with memory, such as friction, it is exact for
disturbances that neither grow nor decay, and approximate for all others.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from fcm.harmonic_balance.system import System
from fcm.model.scene import FloatArray
from fcm.stability.classification import UNKNOWN, Classification, MultiplierSpectrum
from fcm.stability.options import STABILITY, StabilityOptions
from fcm.structure.layout import Layout

ComplexArray = npt.NDArray[np.complex128]


class UnchangedMotion:
    """Stands for an enriched motion, but adds nothing to that of the balance."""

    shift = 0.0

    def at(self, z: FloatArray) -> None:
        """Take a point z (unknown + 1,) and do nothing."""


class HillMultipliers:
    """A workspace that computes multipliers by Hill's method, with the interface of `Multipliers`."""

    def __init__(self, system: System, options: StabilityOptions = STABILITY) -> None:
        self.options = options
        self.system, self.finer = system, UnchangedMotion()
        linear, layout = system.linear, system.layout
        self.harmonics = tuple(range(1, max(system.harmonics) + 1))
        self.wide = Layout(layout.contacts, layout.directions, len(self.harmonics))
        self.laws = system.exact_laws_of(self.harmonics, self.harmonics)
        modes, each = linear.natural.size, 1 + 2 * len(self.harmonics)
        self.at_fold = np.zeros((each, each))  # D / omega
        for j, h in enumerate(self.harmonics):
            a = 1 + 2 * j
            self.at_fold[a, a + 1], self.at_fold[a + 1, a] = -h, h
        # indices of each port's unknowns among those of the balance, means first
        waves = np.stack((self.wide.waves_at, self.wide.waves_at + 1), axis=1).reshape(-1, self.wide.ports)
        self.place = np.vstack((self.wide.mean_at, waves)).T  # (port, each)
        self.modes, self.each = modes, each

    def of(self, z: FloatArray) -> list[complex] | None:
        """Multipliers at z (unknown + 1,), twice as many as modes; None if the stiffness is not finite."""
        from scipy.linalg import eig  # its import takes longer than most curves

        omega, stiffness = float(z[-1]), self._stiffness(z)
        if not np.isfinite(stiffness).all():
            return None
        linear, one = self.system.linear, np.eye(self.each)
        D = omega * self.at_fold
        rate = 2.0 * linear.damping * linear.natural
        first = np.kron(np.eye(self.modes), 2.0 * D) + np.kron(np.diag(rate), one)
        none = np.kron(np.eye(self.modes), D @ D) + np.kron(np.diag(rate), D)
        none += np.kron(np.diag(linear.natural**2), one) + stiffness
        size = self.modes * self.each
        matrix = np.block([[np.zeros((size, size)), np.eye(size)], [-none, -first]])
        exponents, vectors = eig(matrix, check_finite=False)
        off = self._off_centre(vectors[:size])
        found, again = list[complex](), list[complex]()
        for k in np.argsort(np.abs(off), kind="stable").tolist():
            value = complex(np.exp(2.0 * np.pi / omega * exponents[k]))
            # a multiplier at -1 has exponents with both signs of the imaginary part
            same = any(abs(value - one) < self.options.hill.multiplier_tolerance * abs(one) for one in found)
            twice = same and abs(off[k]) > self.options.hill.min_offset
            (again if twice else found).append(value)
        return [*found, *again][: 2 * self.modes]

    def _off_centre(self, vectors: ComplexArray) -> FloatArray:
        """Mean harmonic (exponent,) of the disturbances (mode unknown, exponent), weighted by squares."""
        parts = vectors.reshape(self.modes, self.each, -1)
        ahead, behind = parts[:, 1::2] + 1j * parts[:, 2::2], parts[:, 1::2] - 1j * parts[:, 2::2]
        up, down = (np.sum(np.abs(0.5 * one) ** 2, axis=0) for one in (ahead, behind))
        whole = np.sum(np.abs(parts[:, 0]) ** 2, axis=0) + np.sum(up + down, axis=0)
        mean: FloatArray = np.array(self.harmonics) @ (up - down) / whole
        return mean

    def _stiffness(self, z: FloatArray) -> FloatArray:
        """Stiffness of the contacts on the modes, P T P^T, (mode unknown, mode unknown)."""
        x = np.ascontiguousarray(self.system.layout.with_harmonics(z, self.system.harmonics, self.harmonics))
        ports, d, width = self.system.linear.ports, self.wide.directions, self.wide.width
        found = np.zeros((self.modes, self.each, self.modes, self.each))
        for c, law in enumerate(self.laws):
            law.evaluate(x, c * width)
            at = self.place[c * d : (c + 1) * d] - c * width
            tangent = np.asarray(law.tangent)[
                at[:, :, None, None], at[None, None]
            ]  # (port, each, port, each)
            shapes = ports[:, c * d : (c + 1) * d]
            found += np.einsum("mp,paqb,nq->manb", shapes, tangent, shapes, optimize=True)
        return found.reshape(self.modes * self.each, -1)

    def classify(
        self,
        z: FloatArray,
        at_fold: bool = False,
        sufficient: Sequence[float] = (),
        without_neighbour: bool = False,
    ) -> Classification:
        """Classify a solution with an even number of real multipliers above 1, or a fold (at_fold)."""
        values = self.of(z)
        if values is None:
            return UNKNOWN
        spectrum = MultiplierSpectrum(values, self.options)
        return spectrum.classify(spectrum.odd or at_fold)

    def classify_all(
        self,
        z: Sequence[FloatArray],
        at_fold: Sequence[bool],
        without_neighbour: Sequence[bool],
        sufficient: Sequence[float] = (),
    ) -> list[Classification]:
        """The classifications of several solutions."""
        return [self.classify(*one) for one in zip(z, at_fold, strict=True)]

    def confirms(self, z: FloatArray, stable: float) -> bool:
        """Whether further harmonics confirm the stability of a solution: always, as none are balanced."""
        return True
