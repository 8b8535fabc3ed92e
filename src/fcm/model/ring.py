"""A ring of equal sectors, and the wave that travels around it."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from math import gcd

import numpy as np
import numpy.typing as npt

from fcm.frozen import Frozen

FloatArray = npt.NDArray[np.float64]
ComplexArray = npt.NDArray[np.complex128]

NEXT = "next."  # prefix of the names of the next sector's degrees of freedom


class Ring(Frozen):
    """Equal sectors that move alike with a time shift: x_k(t) = x_0(t + k phi / omega) for sector k.

    phi is 2 pi engine_order / sectors. The forces on sector k have the phase k phi, and harmonic h of its
    motion is X_h exp(i h k phi). This is a wave with h engine_order periods around the ring. The sectors
    alias it to r = h engine_order mod sectors, so it excites the modes of nodal diameter r or sectors - r.

    In a mode of diameter n the next sector moves as this one times exp(2 pi i n / sectors).
    """

    sectors: int
    engine_order: int
    frequency: FloatArray  # (mode,) [rad/s], of all diameters
    damping: FloatArray  # (mode,)
    shapes: ComplexArray  # (mode, dof), of modal mass 1 for each sector
    diameter: npt.NDArray[np.int64]  # (mode,)
    added: npt.NDArray[np.bool_]  # (mode,) True for those that stand for the flexibility of omitted modes

    def waves(self, harmonic: int) -> int:
        """The aliased number of waves of a harmonic around the ring, from 0 to sectors - 1."""
        return harmonic * self.engine_order % self.sectors

    def meets(self, harmonic: int) -> int:
        """The nodal diameter of the modes that a harmonic excites."""
        waves = self.waves(harmonic)
        return min(waves, self.sectors - waves)

    def modes(self, harmonic: int) -> tuple[FloatArray, FloatArray, ComplexArray]:
        """Frequency (mode,), damping (mode,) and shapes (mode, dof) of the modes that a harmonic excites.

        More waves than sectors / 2 are a backward travelling wave; its shapes are the complex conjugates.
        """
        which = self.diameter == self.meets(harmonic)
        shapes = self.shapes[which]
        backward = 2 * self.waves(harmonic) > self.sectors
        return self.frequency[which], self.damping[which], shapes.conj() if backward else shapes

    def lacking(self, harmonics: Iterable[int]) -> dict[int, int]:
        """Nodal diameter by harmonic, for those harmonics whose diameter has no modes."""
        there = set(self.diameter.tolist())
        return {h: self.meets(h) for h in harmonics if self.meets(h) not in there}

    @property
    def period(self) -> int:
        """Number of sectors after which the motion repeats."""
        return self.sectors // gcd(self.engine_order, self.sectors)

    def at(self, used: npt.NDArray[np.bool_]) -> Ring:
        """The ring restricted to some of the degrees of freedom."""
        return replace(self, shapes=self.shapes[:, used])


def with_own(dofs: tuple[str, ...], used: npt.NDArray[np.bool_]) -> npt.NDArray[np.bool_]:
    """The mask used (dof,) that also includes x for each used next.x, its copy in the next sector.

    >>> with_own(("tip", "root", "next.tip", "next.root"), np.array([False, False, True, False])).tolist()
    [True, False, True, False]
    """
    meant = {name.removeprefix(NEXT) for name, one in zip(dofs, used, strict=True) if one}
    return used | np.array([name in meant for name in dofs], dtype=np.bool_)


def of_sector(name: str, sector: int) -> str:
    """The name in the whole ring of a degree of freedom or contact of a sector.

    >>> of_sector("tip", 3)
    'tip@3'
    """
    return f"{name}@{sector}"
