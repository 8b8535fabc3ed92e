"""A solution of a balance with the harmonics of the finer motion balanced as well, at the same frequency."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from fcm.continuation.newton import Newton, settle
from fcm.harmonic.further import padded
from fcm.harmonic.homotopy import Homotopy
from fcm.harmonic.system import System
from fcm.scene.model import FloatArray

FAR = 0.5  # of a solution's size: what lies further away is another one


class Refined:
    """`beside` a point of a system's balance is one of the balance with more harmonics; a workspace."""

    def __init__(self, system: System, more: Sequence[int]) -> None:
        self.harmonics, self.more, self.fewer = system.harmonics, tuple(more), system
        self.system = system.with_harmonics(self.more)
        self.balance = self.system.balance()
        self.homotopy = Homotopy(self.balance)
        self.homotopy.taken = 1.0
        self.newton = Newton(self.homotopy)
        self.newton.row[:] = np.eye(self.balance.unknowns + 1)[-1]  # holds the frequency
        balanced = np.isin(np.repeat([0, *self.more], [2, *[4] * len(self.more)]), [0, *self.harmonics])
        self.balanced = np.tile(balanced, len(system.scene.contacts))

    def take(self, system: System) -> None:
        """A system with the same structure and harmonics, whose contacts may be others."""
        self.fewer, self.system = system, system.with_harmonics(self.more)
        self.balance.laws = self.system.laws()
        self.balance.largest[:] = 0.0

    def beside(self, z: FloatArray, x: FloatArray) -> FloatArray | None:
        """The solution (unknown of more + 1,) for z (unknown + 1,), sought from the finer motion x.

        The forces are those of z, whatever their level: what the harmonics balanced there lack is kept. None
        where Newton's method finds nothing near.
        """
        here = padded(z, self.harmonics, self.more)
        self.balance.measure(here)
        self.balance.probe(here)
        self.homotopy.removed[:] = np.where(self.balanced, self.balance.residual, 0.0)
        newton = self.newton
        newton.z[:-1], newton.z[-1] = x, z[-1]
        newton.scale[:] = self.balance.scale
        found = settle(newton, FAR)
        return np.array(newton.z) if found and newton.moved <= FAR else None
