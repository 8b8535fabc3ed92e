"""Which further harmonics a point of a balance takes: those that would do most there."""

from __future__ import annotations

import cython
import numpy as np

from fcm.harmonic.further import Further
from fcm.harmonic.system import System

FURTHER = 8  # harmonics beyond those of the balance: those that would do most
FEWEST = 3  # where there are so many contacts that those would be more than
UNKNOWNS = 240  # unknowns
LEAST = cython.declare(cython.double, 0.01)  # of what the first of them would do; less is not taken
COVERED = 0.98  # of what the best of them do, by which a set that is there already is good enough
ENOUGH_COVERED = cython.declare(cython.double, COVERED**2)


@cython.cclass
class Ranking:
    """The harmonics that a system leaves out, ranked at a point by what they would do, and the sets of
    harmonics that points took before: one that covers nearly as much as the best is taken again.
    """

    def __init__(self, system: System) -> None:
        contacts = max(len(system.scene.contacts), 1)
        self.count = min(FURTHER, max(FEWEST, UNKNOWNS // (4 * contacts)))  # of further harmonics
        self.further = Further(system)
        # whether a point takes no more than a few milliseconds
        self.cheap = 4 * contacts * (len(system.harmonics) + self.count) <= UNKNOWNS
        # the greatest squares of what harmonics would do, and where they are
        self.top, self.place, self.among = np.zeros(self.count), np.zeros(self.count, dtype=np.intp), 0
        self.take(system)

    def take(self, system: System) -> None:
        """A system with the same structure and harmonics, whose contacts may be others; no set is known."""
        self.own = system.harmonics
        self.further.take(system)
        self.sets: list[tuple[int, ...]] = []
        self.covers = np.zeros((FURTHER, self.further.highest), dtype=np.uint8)  # which harmonics they have

    def number(self, harmonics: tuple[int, ...]) -> int:
        """Of a set, which is then known."""
        if harmonics not in self.sets:
            covers = np.asarray(self.covers)
            if len(self.sets) == len(covers):
                covers = np.concatenate((covers, np.zeros_like(covers)))
            covers[len(self.sets), np.array(harmonics) - 1] = 1
            self.covers = covers
            self.sets.append(harmonics)
        return self.sets.index(harmonics)

    def best(self, share: cython.double[::1]) -> tuple[int, ...]:
        """The harmonics of the system and those that would do most, for the shares (harmonic,) of a point;
        those beyond the last given are not taken."""
        self.further.share[:] = 0.0
        self.further.share[: share.shape[0]] = share
        return self.most()

    def enough_of(self, share: cython.double[::1]) -> tuple[int, ...]:
        """The same, or a set that is there already and covers nearly as much."""
        self.further.share[:] = share
        k = self.choose(False)
        harmonics: tuple[int, ...] = self.sets[k] if k >= 0 else self.own
        return harmonics

    def most(self) -> tuple[int, ...]:
        """The best for the point that `further` was at last."""
        self.rank()
        more = [1 + int(self.place[k]) for k in range(self.among)]
        return tuple(sorted({*self.own, *more}))

    @cython.cfunc
    @cython.exceptval(-2, check=False)
    def choose(self, best: cython.bint) -> cython.Py_ssize_t:
        """The number of the set for the point that `further` was at last; -1 where nothing is left out."""
        self.rank()
        k: cython.Py_ssize_t = -1 if best else self.covering()
        if k >= 0 or self.among == 0:
            return k
        return self.number(self.most())

    @cython.cfunc
    @cython.exceptval(-2, check=False)
    def covering(self) -> cython.Py_ssize_t:
        """The first set that covers nearly as much as the best, -1 if there is none."""
        share: cython.double[::1] = self.further.share
        wanted: cython.double = 0.0
        k: cython.Py_ssize_t
        h: cython.Py_ssize_t
        for k in range(self.among):
            wanted += self.top[k]
        for k in range(len(self.sets)):
            covered: cython.double = 0.0
            for h in range(share.shape[0]):
                if self.covers[k, h]:
                    covered += share[h] * share[h]
            if covered >= ENOUGH_COVERED * wanted:
                return k
        return -1

    @cython.cfunc
    @cython.exceptval(check=False)
    def rank(self) -> cython.void:
        """The harmonics that would do most, and the squares of what they would do, the greatest first."""
        share: cython.double[::1] = self.further.share
        h: cython.Py_ssize_t
        j: cython.Py_ssize_t
        self.among = 0
        for h in range(share.shape[0]):
            square: cython.double = share[h] * share[h]
            if self.among == self.count and not square > self.top[self.count - 1]:
                continue
            j = min(self.among, self.count - 1)
            while j > 0 and self.top[j - 1] < square:
                self.top[j], self.place[j] = self.top[j - 1], self.place[j - 1]
                j -= 1
            self.top[j], self.place[j] = square, h
            self.among = min(self.among + 1, self.count)
        while self.among and not self.top[self.among - 1] > LEAST * LEAST * self.top[0]:
            self.among -= 1
