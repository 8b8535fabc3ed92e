"""Points of a balance displaced to the curve of the balance with more harmonics."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from fcm.harmonic.further import Further, highest
from fcm.harmonic.lifted import Lifted
from fcm.harmonic.system import System
from fcm.scene.model import FloatArray

BoolArray = npt.NDArray[np.bool_]

FURTHER = 8  # harmonics beyond those of the balance: those that would do most
FEWEST = 3  # where there are so many contacts that those would be more than
UNKNOWNS = 240  # unknowns
LEAST = 0.01  # of what the first of them would do; what does less is not taken
COVERED = 0.98  # of what the best of them do, by which a set that is there already is good enough
LARGE = 0.05  # a change of an amplitude beyond which the corrected point is corrected once more
ENOUGH = 0.1  # of a displacement: when Newton's last step was less than this, what is left is far less
ROUNDS = 4  # of more and more harmonics, until a corrected point settles,
SETTLED = 0.05  # which it has when a round changes it by less than this part of the whole


class Corrector:
    """Balances of a scene with more harmonics than those of a system.

    What changes an amplitude much is corrected twice, with harmonics that the corrected motion asks for: a
    branch of few harmonics may have a neighbour with some more and none with many.
    """

    def __init__(self, system: System, again: bool = True, enough: float = ENOUGH) -> None:
        self.system, self.again, self.enough = system, again, enough
        contacts = max(len(system.scene.contacts), 1)
        self.count = min(FURTHER, max(FEWEST, UNKNOWNS // (4 * contacts)))  # of further harmonics
        self.known: dict[tuple[int, ...], Lifted] = {}
        self.covers = np.zeros((0, highest(system)))  # (set, harmonic): which harmonics each known set has
        self.second: dict[tuple[int, ...], tuple[Further, Corrector]] = {}

    def displaced(
        self, z: FloatArray, direction: FloatArray, more: tuple[int, ...], amplitude: FloatArray
    ) -> FloatArray | None:
        """Frequency and amplitudes (point, 1 + dof) of the corrected curve in the planes normal to the curve
        at points z (point, unknown + 1).

        direction is that of the curve there, amplitude (point, dof) what it has there, more the harmonics of
        the corrected curve. None if they are those of the curve; NaN if the corrected curve is not found, or
        too far to be believed.
        """
        if more == self.system.harmonics:
            return None
        lifted = self.lifted(more)
        found = np.empty((len(z), len(lifted.found)))
        there = np.zeros((2, len(z), len(lifted.newton.z)))
        lifted.all(z, direction, found, there)
        if self.again:
            far = np.abs(found[:, 1:] - amplitude).max(axis=1) > LARGE * amplitude.max(axis=1)
            for i in np.flatnonzero(far).tolist():
                found[i] = self.twice(more, there[0, i], there[1, i], found[i])
        return found

    def lifted(self, more: tuple[int, ...]) -> Lifted:
        """The balance of more harmonics."""
        if more not in self.known:
            balance = self.system.with_harmonics(more).balance()
            self.known[more] = Lifted(balance, list(self.system.harmonics), list(more), self.enough)
            covers = np.zeros((1, self.covers.shape[1]))
            covers[0, np.array(more) - 1] = 1.0
            self.covers = np.concatenate((self.covers, covers))
        return self.known[more]

    def twice(
        self, more: tuple[int, ...], z: FloatArray, direction: FloatArray, found: FloatArray
    ) -> FloatArray:
        """A corrected point corrected."""
        further, corrector = self.of(more)
        share = further.shares(z[None], further.forces(z[None]), found[None, 1:])
        more = corrector.sets(share)[0]
        again = corrector.displaced(z[None], direction[None], more, found[None, 1:])
        return found if again is None else again[0]

    def settled(self, z: FloatArray, direction: FloatArray, amplitude: FloatArray) -> FloatArray:
        """Amplitudes (dof,) of a point displaced again and again, each time with the harmonics that would do
        most, until that changes them no more. NaN where that leads nowhere.
        """
        harmonics, now = self.system.harmonics, amplitude
        for _ in range(ROUNDS):
            further, corrector = self.of(harmonics)
            more = corrector.best(further.shares(z[None], further.forces(z[None]), now[None])[0])
            if more == harmonics:
                break
            lifted = corrector.lifted(more)
            if not lifted.beside(z, direction):
                return np.full(len(now), np.nan)
            z, direction = np.array(lifted.newton.z), np.asarray(lifted.newton.tangent) * lifted.newton.scale
            before, now, harmonics = now, np.array(lifted.found[1:]), more
            if (np.abs(now - before) <= SETTLED * np.abs(now - amplitude)).all():
                break
        return now

    def of(self, harmonics: tuple[int, ...]) -> tuple[Further, Corrector]:
        """What further harmonics would do to points of a balance of some, and corrects these."""
        if harmonics not in self.second:
            system = self.system.with_harmonics(harmonics)
            self.second[harmonics] = Further(system), Corrector(system, again=False, enough=self.enough)
        return self.second[harmonics]

    def sets(self, share: FloatArray) -> list[tuple[int, ...]]:
        """The harmonics of the system and those that would do most, for shares (point, harmonic).

        A set that is there already is taken where it covers nearly as much.
        """
        square = share * share
        most = -np.sort(-square, axis=1)[:, : self.count]
        enough = COVERED**2 * np.where(most > LEAST**2 * most[:, :1], most, 0.0).sum(axis=1)
        chosen, left = [self.system.harmonics] * len(share), np.ones(len(share), dtype=np.bool_)
        covered = square @ self.covers.T >= enough[:, None]
        for more, of in zip(self.known, covered.T, strict=True):
            self._take(more, of, chosen, left)
        while left.any():
            first = int(left.argmax())
            more = self.best(share[first])
            of = square[:, np.array(more) - 1].sum(axis=1) >= enough
            of[first] = True
            self._take(more, of, chosen, left)
        return chosen

    def _take(
        self, more: tuple[int, ...], of: BoolArray, chosen: list[tuple[int, ...]], left: BoolArray
    ) -> None:
        """A set for points of which nothing is chosen yet."""
        for i in np.flatnonzero(of & left).tolist():
            chosen[i] = more
        left &= ~of

    def best(self, share: FloatArray) -> tuple[int, ...]:
        """The harmonics of the system and those that would do most, for the shares (harmonic,) of a point."""
        order = np.argsort(-share)[: self.count]
        order = order[share[order] > LEAST * share[order[0]]]
        return tuple(sorted({*self.system.harmonics, *(int(k) + 1 for k in order)}))
