"""Balances the harmonics of the finer motion of a solution, too, at the same frequency."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from fcm.continuation.corrector import Newton, correct_with_kept_jacobian
from fcm.harmonic_balance.options import PROLONGATION
from fcm.harmonic_balance.prolongation import Homotopy, Prolongation
from fcm.harmonic_balance.system import System
from fcm.model.scene import FloatArray
from fcm.stability.options import STABILITY, StabilityOptions


class Rebalancing:
    """A workspace that finds the solution of a balance with more harmonics near one with fewer."""

    def __init__(self, system: System, more: Sequence[int], options: StabilityOptions = STABILITY) -> None:
        self.options = options.confirmation
        self.harmonics, self.more, self.fewer = system.harmonics, tuple(more), system
        self.system = system.with_harmonics(self.more)
        self.balance = self.system.new_balance()
        self.damped = None
        if self.balance.contacts >= PROLONGATION.damped.min_contacts:
            self.damped = Prolongation(self.balance, list(self.harmonics), list(more), self.options.tolerance)
        self.homotopy = Homotopy(self.balance)
        self.homotopy.subtracted_part = 1.0
        self.newton = Newton(self.homotopy)
        self.newton.row[:] = 0.0
        self.newton.row[-1] = 1.0  # holds the frequency
        for newton in (self.newton, *((self.damped.newton,) if self.damped is not None else ())):
            newton.poll = self._poll
        balanced = np.isin(self.system.layout.harmonic_of(self.more), [0, *self.harmonics])
        self.balanced = np.tile(balanced, len(system.scene.contacts))
        self.last: tuple[FloatArray, FloatArray] | None = None  # with many contacts: last z, and its change

    def _poll(self) -> None:
        self.fewer.work.poll()  # of the present system: `take` may change it

    def take(self, system: System) -> None:
        """Take another system with the same structure and harmonics, whose contacts may differ."""
        self.fewer, self.system = system, system.with_harmonics(self.more)
        self.balance.laws = self.system.laws()
        self.balance.largest[:] = 0.0
        self.last = None

    def rebalance(self, z: FloatArray, x: FloatArray, persistent: bool = False) -> FloatArray | None:
        """The solution (unknown of more + 1,) for z (unknown + 1,), sought from the finer motion x.

        The residual of z in its own harmonics is kept, so that the force level of z holds. If Newton's method
        finds nothing near and persistent is set, a homotopy from z adds the further equations by parts. None
        if that fails, too. With many contacts see `_of_many`.
        """
        here = self.system.extended(z, self.harmonics)
        self.balance.evaluate_scale(here)
        self.balance.evaluate_residual(here)
        newton, lack = self.newton, np.array(self.balance.residual)
        newton.z[:-1], newton.z[-1] = x, z[-1]
        newton.scale[:] = self.balance.scale
        if self.damped is not None:
            found = self._of_many(here, lack)
            if found is not None:
                self.last = here, found - here
            return found
        by_parts = persistent and len(lack) < self.options.max_unknowns
        if self._converges(lack, 1.0):
            return np.array(newton.z)
        return np.array(newton.z) if by_parts and self._by_homotopy(here, lack) else None

    def continue_to(self, z: FloatArray, motion: FloatArray) -> FloatArray | None:
        """Find the solution with more harmonics at the frequency of z from a motion near it, or None."""
        here = self.system.extended(z, self.harmonics)
        self.balance.evaluate_scale(here)
        self.balance.evaluate_residual(here)
        newton, lack = self.newton, np.array(self.balance.residual)
        newton.scale[:] = self.balance.scale
        guess = np.append(motion[:-1], z[-1])
        if self.damped is not None:
            found = self.damped.rebalance(guess, np.where(self.balanced, lack, 0.0))
            return np.array(self.damped.newton.z) if found else None
        newton.z[:] = guess
        return np.array(newton.z) if self._converges(lack, 1.0) else None

    def _of_many(self, here: FloatArray, lack: FloatArray) -> FloatArray | None:
        """Solve with many contacts: from the last solution if near, by damped steps, or by full steps."""
        newton, assumed = self.newton, np.array(self.newton.z)
        if self.last is not None:
            there, added = self.last
            scale = np.asarray(self.balance.scale)
            if np.linalg.norm((here - there) / scale) < np.linalg.norm(added / scale):
                newton.z[:] = here + added
                if self._converges(lack, 1.0) and self._is_near(here):
                    return np.array(newton.z)
        assert self.damped is not None
        if self.damped.rebalance(here, np.where(self.balanced, lack, 0.0)):
            return np.array(self.damped.newton.z)
        newton.z[:] = assumed
        return np.array(newton.z) if self._converges(lack, 1.0) else None

    def _is_near(self, here: FloatArray) -> bool:
        """Whether the solution found is so near to here that it is the same motion."""
        return bool(np.linalg.norm((self.newton.z - here) / self.balance.scale) <= self.options.max_change)

    def _converges(self, lack: FloatArray, part: float) -> bool:
        """Whether Newton's method converges nearby with a part (0 to 1) of the further equations."""
        self.homotopy.initial_residual[:] = np.where(self.balanced, lack, (1.0 - part) * lack)
        distance = self.options.max_change
        return correct_with_kept_jacobian(self.newton, distance) and self.newton.moved <= distance

    def _by_homotopy(self, here: FloatArray, lack: FloatArray) -> bool:
        """Whether a homotopy, which adds the further equations by parts, leads to a near solution."""
        self.newton.z[:] = here
        if not all(self._converges(lack, part) for part in self.options.homotopy_parts):
            return False
        return self._is_near(here)
