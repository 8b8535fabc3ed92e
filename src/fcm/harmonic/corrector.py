"""Points of a balance displaced to the curve of the balance with more harmonics."""

from __future__ import annotations

import numpy as np

from fcm.harmonic.further import Further
from fcm.harmonic.lifted import Lifted
from fcm.harmonic.system import System
from fcm.scene.model import FloatArray

FURTHER = 8  # harmonics beyond those of the balance: those that would do most
LEAST = 0.01  # of what the first of them would do; what does less is not taken
COVERED = 0.98  # of what the best of them do, by which a set that is there already is good enough
LARGE = 0.05  # a change of an amplitude beyond which the corrected point is corrected once more
ENOUGH = 0.02  # of a displacement, to which it is found


class Corrector:
    """Balances of a scene with more harmonics than those of a system.

    What changes an amplitude much is corrected twice, with harmonics that the corrected motion asks for: a
    branch of few harmonics may have a neighbour with some more and none with many.
    """

    def __init__(self, system: System, again: bool = True, enough: float = ENOUGH) -> None:
        self.system, self.again, self.enough = system, again, enough
        self.known: dict[tuple[int, ...], Lifted] = {}
        self.second: dict[tuple[int, ...], tuple[Further, Corrector]] = {}

    def displaced(
        self, z: FloatArray, direction: FloatArray, share: FloatArray, amplitude: FloatArray
    ) -> FloatArray | None:
        """Frequency and amplitudes (1 + dof,) of the corrected curve in the plane normal to the curve at z.

        direction is that of the curve at z, amplitude (dof,) what it has there, share (harmonic,) what each
        harmonic left out would do. None if no harmonic does anything; NaN if the corrected curve is not
        found, or too far to be believed.
        """
        more = self.chosen(share)
        if more == self.system.harmonics:
            return None
        lifted = self.lifted(more)
        if not lifted.beside(z, direction):
            return np.full(len(lifted.found), np.nan)
        found = np.array(lifted.found)
        if self.again and np.abs(found[1:] - amplitude).max() > LARGE * amplitude.max():
            newton = lifted.newton
            return self.twice(more, np.array(newton.z), np.asarray(newton.tangent) * newton.scale, found)
        return found

    def lifted(self, more: tuple[int, ...]) -> Lifted:
        """The balance of more harmonics."""
        if more not in self.known:
            balance = self.system.with_harmonics(more).balance()
            self.known[more] = Lifted(balance, list(self.system.harmonics), list(more), self.enough)
        return self.known[more]

    def twice(
        self, more: tuple[int, ...], z: FloatArray, direction: FloatArray, found: FloatArray
    ) -> FloatArray:
        """A corrected point corrected."""
        if more not in self.second:
            system = self.system.with_harmonics(more)
            self.second[more] = Further(system), Corrector(system, again=False)
        further, corrector = self.second[more]
        force, _ = further.forces(z[None])
        share = further.shares(z[None], force, found[None, 1:])[0]
        again = corrector.displaced(z, direction, share, found[1:])
        return found if again is None else again

    def chosen(self, share: FloatArray) -> tuple[int, ...]:
        """The harmonics of the system and those that would do most."""
        order = np.argsort(-share)[:FURTHER]
        order = order[share[order] > LEAST * share[order[0]]]
        square = share * share
        enough = COVERED**2 * square[order].sum()
        for more in self.known:
            if square[np.array(more) - 1].sum() >= enough:
                return more
        return tuple(sorted({*self.system.harmonics, *(int(k) + 1 for k in order)}))
