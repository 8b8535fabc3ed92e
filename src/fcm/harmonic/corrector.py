"""Points of a balance displaced to the curve of the balance with more harmonics."""

from __future__ import annotations

import threading
from collections.abc import Iterator

import cython
import numpy as np
from cython.cimports.libc.math import fabs

from fcm.harmonic.cost import seconds_of
from fcm.harmonic.lifted import Lifted
from fcm.harmonic.ranking import Ranking
from fcm.harmonic.system import System
from fcm.scene.model import FloatArray

LARGE = cython.declare(cython.double, 0.05)  # a change of an amplitude, from which it is corrected once more
ENOUGH = 0.1  # of a displacement: when Newton's last step was less than this, what is left is far less
ROUNDS = 4  # of more and more harmonics, until a corrected point settles,
SETTLED = 0.05  # which it has when a round changes it by less than this part of the whole, or would
# evaluations times the square of the unknowns, some half second of work, for points that are not found
FRUITLESS = cython.declare(cython.double, 4e7)
MOST = 16  # balances, and correctors, that are kept for the next system,
MANY = 128  # and of balances so many, where each is small: curves of a sweep ask for some eighty sets
NAN = cython.declare(cython.double, float("nan"))

Spare = dict[tuple[int, ...], list[Lifted]]  # balances by their harmonics


@cython.cclass
class Corrector:
    """Balances of a scene with more harmonics than those of a system.

    What changes an amplitude much is corrected twice, with harmonics that the corrected motion asks for: a
    branch of few harmonics may have a neighbour with some more and none with many.
    """

    def __init__(
        self, system: System, again: bool = True, enough: float = ENOUGH, spare: Spare | None = None
    ) -> None:
        self.again, self.enough = again, enough
        self.ranking = Ranking(system)
        self.further = self.ranking.further
        self.found = np.zeros(1 + system.linear.dofs.shape[1])
        self.most = MANY if self.ranking.cheap else MOST
        self.spare: Spare = {} if spare is None else spare  # made for systems that were taken before,
        self.spares: dict[tuple[int, ...], Corrector] = {}  # as these were
        self.lifts: list[Lifted] = []  # of the sets of the ranking
        self.second: dict[tuple[int, ...], Corrector] = {}
        self.take(system)

    def take(self, system: System) -> None:
        """A system with the same structure and harmonics, whose contacts may be others; no set is known."""
        self.system, self.fruitless = system, 0.0
        self.forget()
        self.ranking.take(system)

    def forget(self) -> None:
        """Leave the balances to whichever corrector needs them next."""
        for more, lifted in zip(self.ranking.sets, self.lifts, strict=False):
            if more not in self.spare and len(self.spare) == self.most:
                self.spare.clear()
            self.spare.setdefault(more, []).append(lifted)
        for other in self.second.values():
            other.forget()
        self.lifts, self.second = [], {}

    def move(
        self,
        points: cython.Py_ssize_t[::1],
        z: cython.double[:, ::1],
        direction: cython.double[:, ::1],
        amplitude: cython.double[:, ::1],
        unit: cython.double[:, ::1],
        change: cython.double[:, ::1],
        known: cython.uchar[::1],
        best: cython.bint,
    ) -> None:
        """Relative displacements (point, 1 + dof), of frequency and amplitudes, of some points that are not
        known; then they are.

        That is to the corrected curve in the planes normal to the curve at z (point, unknown + 1) with its
        direction there; amplitudes are relative to their unit (point, dof). Of each point the harmonics are
        those that would do most there, the best, or a set that is there already and covers nearly as much.
        Nothing changes where that are those of the curve; NaN where the corrected curve is not found, or too
        far to be believed.
        """
        n: cython.Py_ssize_t = z.shape[1] - 1
        p: cython.Py_ssize_t
        d: cython.Py_ssize_t
        for p in range(points.shape[0]):
            i: cython.Py_ssize_t = points[p]
            if known[i]:
                continue
            known[i] = 1
            self.further.at(z[i], amplitude[i])
            k: cython.Py_ssize_t = self.ranking.choose(best)
            if k >= 0:
                self.put(k, z[i], direction[i], amplitude[i], best)
                change[i, 0] = (self.found[0] - z[i, n]) / z[i, n]
                for d in range(amplitude.shape[1]):
                    change[i, 1 + d] = (self.found[1 + d] - amplitude[i, d]) / unit[i, d]

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def put(
        self,
        k: cython.Py_ssize_t,
        z: cython.double[::1],
        direction: cython.double[::1],
        amplitude: cython.double[::1],
        best: cython.bint,
    ) -> cython.bint:
        """Whether the curve of a known set is found beside a point; found (1 + dof,) is what it has there.

        Of balances that are not small more than what is found at once is looked for at the best points alone,
        and so it is where that has led nowhere for long.
        """
        lifted: Lifted = self.of_set(k)
        d: cython.Py_ssize_t
        size: cython.double = lifted.balance.unknowns
        before: cython.double = lifted.newton.evaluations
        vain: cython.bint = self.fruitless > FRUITLESS or not self.ranking.cheap
        if not lifted.beside(z, direction, vain and not best):
            self.fruitless += (lifted.newton.evaluations - before) * size * size
            self.found[:] = NAN
            return False
        self.found[:] = lifted.found
        most: cython.double = 0.0
        off: cython.double = 0.0
        for d in range(amplitude.shape[0]):
            most = max(most, amplitude[d])
            off = max(off, fabs(self.found[1 + d] - amplitude[d]))
        if self.again and off > LARGE * most:
            self.twice(k, best)
        return True

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def twice(self, k: cython.Py_ssize_t, best: cython.bint) -> cython.int:
        """The point just found corrected."""
        lifted: Lifted = self.lifts[k]
        corrector: Corrector = self.of(self.ranking.sets[k])
        z = np.array(lifted.newton.z)
        direction = np.asarray(lifted.newton.tangent) * lifted.newton.scale
        corrector.further.at(z, self.found[1:])
        j: cython.Py_ssize_t = corrector.ranking.choose(False)
        if j >= 0:
            corrector.fruitless = self.fruitless
            corrector.put(j, z, direction, self.found[1:], best)
            self.found[:] = corrector.found
            self.fruitless = corrector.fruitless
        return 0

    def seconds(self) -> float:
        """About what all points displaced since a system was taken have taken."""
        found: float = sum(other.seconds() for other in self.second.values())
        for more, lifted in zip(self.ranking.sets, self.lifts, strict=False):
            found += seconds_of(self.system, lifted.newton.evaluations, len(more))
        return found

    def lifted(self, more: tuple[int, ...]) -> Lifted:
        """The balance of more harmonics."""
        found: Lifted = self.of_set(self.ranking.number(more))
        return found

    @cython.cfunc
    def of_set(self, k: cython.Py_ssize_t) -> Lifted:
        """The balance of a set of the ranking."""
        while len(self.lifts) <= k:
            self.lifts.append(self._lifted(self.ranking.sets[len(self.lifts)]))
        found: Lifted = self.lifts[k]
        return found

    def _lifted(self, more: tuple[int, ...]) -> Lifted:
        """The same as if it were new."""
        system, spare = self.system, self.spare.get(more)
        if not spare:
            balance = system.with_harmonics(more).balance()
            return Lifted(balance, list(system.harmonics), list(more), self.enough)
        made = spare.pop()
        made.take(list(system.harmonics), [(c.mu, c.k_u, c.k_v, c.n_0) for c in system.scene.contacts])
        return made

    def of(self, harmonics: tuple[int, ...]) -> Corrector:
        """Corrects points of a balance of some harmonics."""
        if harmonics not in self.second:
            system, made = self.system.with_harmonics(harmonics), self.spares.get(harmonics)
            if made is not None:
                made.take(system)
            else:
                if len(self.spares) == self.most:
                    self.spares.clear()
                made = Corrector(system, again=False, enough=self.enough, spare=self.spare)
                self.spares[harmonics] = made
            self.second[harmonics] = made
        return self.second[harmonics]

    def settled(self, z: FloatArray, direction: FloatArray, amplitude: FloatArray) -> FloatArray:
        """Frequency and amplitudes (1 + dof,) of a point displaced again and again, each time with the
        harmonics that would do most, until that changes the amplitudes (dof,) no more, or would not without
        feedback. NaN where that leads nowhere.
        """
        found = np.append(z[len(z) - 1], amplitude)
        for following in self.rounds(z, direction, amplitude):
            more, found = np.abs(following - found)[1:], following
            if (more <= SETTLED * np.abs(found[1:] - amplitude)).all():
                break
        return found

    def rounds(self, z: FloatArray, direction: FloatArray, amplitude: FloatArray) -> Iterator[FloatArray]:
        """The same (1 + dof,) after each time; NaN, and no more, where that leads nowhere."""
        harmonics, now = self.system.harmonics, amplitude
        for _ in range(ROUNDS):
            corrector = self.of(harmonics)
            corrector.further.at(z, now)
            more = corrector.ranking.most()
            rest = np.asarray(corrector.further.share).sum() * now
            if more == harmonics or (rest <= SETTLED * np.abs(now - amplitude)).all():
                return
            lifted = corrector.lifted(more)
            if not lifted.beside(z, direction):
                yield np.full(1 + len(amplitude), np.nan)
                return
            z, direction = np.array(lifted.newton.z), np.asarray(lifted.newton.tangent) * lifted.newton.scale
            now, harmonics = np.array(lifted.found[1:]), more
            yield np.append(z[len(z) - 1], now)


class _Kept(threading.local):
    """The corrector of each thread, and what it is for."""

    def __init__(self) -> None:
        self.key: tuple[object, ...] = ()
        self.corrector: Corrector | None = None


_KEPT = _Kept()


def corrector_of(system: System) -> Corrector:
    """A corrector as if it were new: that before it, if the contacts alone are others, as in a sweep."""
    kept, scene = _KEPT, system.scene
    key = (*system.linear.numbers, scene.frequency_range, bool(scene.loads), system.harmonics)
    if kept.corrector is None or kept.key != key or scene.ring is not None:
        kept.key, kept.corrector = key, Corrector(system)
    else:
        kept.corrector.take(system)
    return kept.corrector
