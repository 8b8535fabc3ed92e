"""A balance with numbers of its scene on a line: values = origin + s * direction."""

from __future__ import annotations

from copy import copy
from dataclasses import replace
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from fcm.harmonic_balance.dense_jacobian import Amplitude, apply_compliance
from fcm.harmonic_balance.system import System
from fcm.model.scene import FloatArray, Scene
from fcm.scene.address import LEVEL
from fcm.scene.draft import Number
from fcm.sensitivity.parameter_derivatives import Rates, contact_numbers, law_rates, rates_of
from fcm.structure.linear import linear_of

ComplexArray = npt.NDArray[np.complex128]


class ParameterLine(NamedTuple):
    """A line in the space of some numbers of a scene, with the parameter s."""

    numbers: tuple[Number, ...]
    origin: FloatArray  # (number,)
    direction: FloatArray  # (number,)

    def values(self, s: float) -> FloatArray:
        """Values (number,) of the numbers at s."""
        values: FloatArray = self.origin + s * self.direction
        return values

    def scene(self, scene: Scene, s: float) -> Scene:
        """The scene with the numbers at s."""
        assert scene.draft is not None
        values = self.values(s).tolist()
        every = {
            address: one
            for number, value in zip(self.numbers, values, strict=True)
            for address, one in number.values(value).items()
        }
        # a fixed draft gives the rates there; the level must stay relative to the written forces
        fix = all(number.key != LEVEL for number in self.numbers)
        keys = (number.key for number in self.numbers)
        swept = {**scene.parameters, **dict(zip(keys, values, strict=True))}
        return replace(scene.draft.curve(scene, scene.parameters, every, fix=fix), parameters=swept)


def line_along(number: Number) -> ParameterLine:
    """The line on which the parameter is the number itself."""
    return ParameterLine((number,), np.zeros(1), np.ones(1))


class ParameterRates(NamedTuple):
    """Rates by s of the residual and the contact forces (unknown,), and of X (harmonic, dof).

    displacements is None if only numbers of contacts or the excitation vary.
    """

    residual: FloatArray
    force: FloatArray
    displacements: ComplexArray | None

    def of(self, one: Amplitude) -> float:
        """Rate of an amplitude by s."""
        if self.displacements is None:
            return float(one.of_forces @ self.force)
        return float((one.weights @ self.displacements[:, one.dof]).real)


def _excitation(system: System, line: ParameterLine) -> list[tuple[ComplexArray, ComplexArray]]:
    """Forces on the modes at s = 0 with their rates by s; then those that grow with omega^2, likewise."""
    origin, one = (linear_of(line.scene(system.scene, s)) for s in (0.0, 1.0))
    return [(origin.force, one.force - origin.force), (origin.square, one.square - origin.square)]


class VariedBalance:
    """The balance of a system (of one curve) that `set_parameter` moves along a line, with its rates by s.

    Numbers of contacts and amplitudes of forces are changed in the existing balance. Other numbers of the
    structure require a new balance.
    """

    def __init__(self, system: System, line: ParameterLine) -> None:
        self.base, self.line, self.s = system, line, np.nan
        tables = {address[0] for number in line.numbers for address in number.addresses}
        fields = {address[-1] for number in line.numbers for address in number.addresses}
        rigid = bool((system.linear.natural == 0.0).any())
        self.structure = tables != {"contact"} or not fields <= {"n_0", "gap", "mu", "k_u", "k_v"} or rigid
        # the unstressed positions of contacts depend on their stiffness
        self.structure |= "k_u" in fields and system.scene.start is not None
        # the contacts' rates are constant for a single number, or without products of two numbers
        self._constant = len(line.numbers) == 1 or "gap" not in fields
        excited = tables <= {"force", "base"} and fields <= {"amplitude", "acceleration"}
        self._excitation = _excitation(system, line) if excited else None
        self._system: System | None = system
        self.balance = system.new_balance()
        self.contacts, self.harmonics = len(system.scene.contacts), system.harmonics
        self._rates: list[Rates] = []
        self._contact_rates: FloatArray | None = None
        self._at_zero: FloatArray | None = None
        self.numbers = contact_numbers(system.scene)  # present mu, k_u, k_v, n_0 (contact, 4)

    def another(self) -> VariedBalance:
        """A copy with a balance of its own; it shares everything that does not depend on s."""
        if not self.structure and self._constant:
            self._numbers(0.0)
        made = copy(self)
        made.balance = self.base.new_balance()
        return made

    @property
    def system(self) -> System:
        """The system with the numbers at the present s."""
        if self._system is None:
            self._system = self.base.with_scene(self.line.scene(self.base.scene, self.s))
        return self._system

    def set_parameter(self, s: float) -> None:
        """Set the numbers to those at s, and update the balance."""
        if s == self.s:
            return
        self.s, self._system = s, None
        if self._excitation is not None:
            constant, square = (origin + s * rate for origin, rate in self._excitation)
            self.balance.receptance.set_external_forces(constant, square)
            self.balance.largest[:] = 0.0  # units follow the motion there, as in a new balance
            return
        if self.structure:
            self.balance = self.system.new_balance()
        self.numbers = self._numbers(s)
        for law, (mu, k_u, k_v, n_0) in zip(self.balance.laws, self.numbers.tolist(), strict=True):
            law.mu, law.k_u, law.k_v, law.n_0 = mu, k_u, k_v, n_0
        if self.structure or not self._constant:
            self._rates = []
        if not self._constant:
            self._contact_rates = None

    def _numbers(self, s: float) -> FloatArray:
        """Parameters of the contacts (contact, 4) at s; by their rates where these are constant."""
        if self.structure or not self._constant:
            return contact_numbers(self.system.scene)
        if self._at_zero is None:
            self._at_zero = contact_numbers(self.line.scene(self.base.scene, 0.0))
        numbers: FloatArray = self._at_zero + s * self.contact_rates()
        return numbers

    def by_s(self, z: FloatArray) -> ParameterRates:
        """Rates by s at fixed z, the point of the last evaluation of the balance."""
        force = self._forces_by_s(z)
        if not self.structure:
            return ParameterRates(apply_compliance(self.balance, force), force, None)
        residual = np.zeros(self.balance.unknowns)
        displacements = np.zeros((len(self.harmonics), self.balance.outputs), dtype=np.complex128)
        for rate, weight in zip(self.rates, self.line.direction, strict=True):
            if weight:
                of_residual, of_displacements = rate.here(self.balance, z)
                residual, displacements = (
                    residual + weight * of_residual,
                    displacements + weight * of_displacements,
                )
        return ParameterRates(residual, force, displacements)

    def _forces_by_s(self, z: FloatArray) -> FloatArray:
        """Rates (unknown,) of the contact forces by s; a preload acts like a mean normal displacement."""
        balance, rates, normal = self.balance, self.contact_rates(), self.balance.directions - 1
        found = np.zeros((self.contacts, balance.width))
        k_v, n_0 = self.numbers[:, 2], self.numbers[:, 3]
        moved = rates.any(axis=1)
        preload = moved & ~rates[:, :3].any(axis=1) & (k_v > 0.0)
        by_load = np.asarray(balance.tangent)[preload, :, normal]
        by_load[:, normal] += np.asarray(balance.counted)[preload]
        by_load /= k_v[preload, None]
        by_load[:, normal] -= n_0[preload] > 0.0  # the preload that the structure at rest balances
        found[preload] = rates[preload, 3:] * by_load
        for c in np.flatnonzero(moved & ~preload).tolist():
            here = slice(c * balance.width, (c + 1) * balance.width)
            found[c] = rates[c] @ law_rates(balance.laws[c], z[here])
        return found.ravel()

    @property
    def rates(self) -> list[Rates]:
        """Rates of the balance by each of the numbers."""
        self._rates = self._rates or [rates_of(self.system, number.key) for number in self.line.numbers]
        return self._rates

    def contact_rates(self) -> FloatArray:
        """Rates of mu, k_u, k_v, n_0 by s, (contact, 4)."""
        if self._contact_rates is None:
            moved = zip(self.rates, self.line.direction, strict=True)
            each = (weight * rate.contact for rate, weight in moved)
            self._contact_rates = sum(each, np.zeros((self.contacts, 4)))
        return self._contact_rates
