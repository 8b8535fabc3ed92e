"""A balance whose scene has numbers that move along a line: values = origin + s * direction."""

from __future__ import annotations

from copy import copy
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from fcm.harmonic.by_number import Rates, rates_of
from fcm.harmonic.system import System
from fcm.scene.draft import Number
from fcm.scene.model import FloatArray, Scene
from fcm.structure.linear import linear_of

ComplexArray = npt.NDArray[np.complex128]


class Line(NamedTuple):
    """Numbers of a scene and how they move together with the parameter s."""

    numbers: tuple[Number, ...]
    origin: FloatArray  # (number,)
    direction: FloatArray  # (number,)

    def values(self, s: float) -> FloatArray:
        """Of the numbers, (number,)."""
        values: FloatArray = self.origin + s * self.direction
        return values

    def scene(self, scene: Scene, s: float) -> Scene:
        """The scene with the numbers at s."""
        assert scene.draft is not None
        every = {
            address: one
            for number, value in zip(self.numbers, self.values(s), strict=True)
            for address, one in number.values(float(value)).items()
        }
        return scene.draft.curve(scene, scene.parameters, every)


def along(number: Number) -> Line:
    """The line on which the parameter is the number itself."""
    return Line((number,), np.zeros(1), np.ones(1))


class Varied:
    """The balance of a system (of one curve) that `put` moves along a line, with the rates by s.

    A number of a contact is changed in the balance as it is; a number of the structure makes another one.
    """

    def __init__(self, system: System, line: Line) -> None:
        self.base, self.line, self.s = system, line, np.nan
        tables = {address[0] for number in line.numbers for address in number.addresses}
        fields = {address[-1] for number in line.numbers for address in number.addresses}
        rigid = bool((system.linear.natural == 0.0).any())
        self._structure = tables != {"contact"} or not fields <= {"n_0", "gap", "mu", "k_u", "k_v"} or rigid
        self.system, self.balance = system, system.balance()
        self.contacts, self.harmonics = len(system.scene.contacts), system.harmonics
        self._rates: list[Rates] = []

    def put(self, s: float) -> None:
        """Move the numbers."""
        if s == self.s:
            return
        self.s = s
        self.system = system = copy(self.base)
        object.__setattr__(system, "scene", self.line.scene(self.base.scene, s))
        if self._structure:
            object.__setattr__(system, "linear", linear_of(system.scene))
            self.balance = system.balance()
        for law, contact in zip(self.balance.laws, system.scene.contacts, strict=True):
            law.mu, law.k_u, law.k_v, law.n_0 = contact.mu, contact.k_u, contact.k_v, contact.n_0
        self._rates = []

    def by_s(self, z: FloatArray) -> tuple[FloatArray, ComplexArray]:
        """Rates of the residual and of the displacements reported, by s at fixed z; evaluates the balance."""
        balance = self.balance
        residual = np.zeros(balance.unknowns)
        shown = np.zeros((len(self.harmonics), balance.outputs), dtype=np.complex128)
        balance.evaluate(z)
        for rate, weight in zip(self.rates, self.line.direction, strict=True):
            if weight:
                of_residual, of_shown = rate.at(balance, z)
                residual, shown = residual + weight * of_residual, shown + weight * of_shown
        return residual, shown

    @property
    def rates(self) -> list[Rates]:
        """Of each of the numbers."""
        self._rates = self._rates or [rates_of(self.system, number.key) for number in self.line.numbers]
        return self._rates

    def contact_rates(self) -> FloatArray:
        """Rates of mu, k_u, k_v, n_0 by s, (contact, 4)."""
        total: FloatArray = sum(
            (weight * rate.contact for rate, weight in zip(self.rates, self.line.direction, strict=True)),
            np.zeros((self.contacts, 4)),
        )
        return total
