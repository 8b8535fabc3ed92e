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

NEXT = "next."  # how the names of the next sector's degrees of freedom begin


class Ring(Frozen):
    """Sectors that do the same one after the other: x of sector k at t is x of sector 0 at t + k phi / omega.

    With phi = 2 pi engine_order / sectors: the forces on sector k have the phase k phi, and harmonic h of the
    motion is X_h exp(i h k phi). In space that is h engine_order waves around the ring, of which sectors see
    the remainder r by their number: it meets the modes of the nodal diameter r or sectors - r.

    The modes of diameter n are those of a sector whose next moves as itself times exp(2 pi i n / sectors).
    """

    sectors: int
    engine_order: int
    frequency: FloatArray  # (mode,) [rad/s], of all diameters
    damping: FloatArray  # (mode,)
    shapes: ComplexArray  # (mode, dof), of modal mass 1 for each sector
    diameter: npt.NDArray[np.int64]  # (mode,)
    added: npt.NDArray[np.bool_]  # (mode,) those that stand for the flexibility of modes left out

    def waves(self, harmonic: int) -> int:
        """The number of waves of a harmonic around the ring, from 0 to sectors - 1."""
        return harmonic * self.engine_order % self.sectors

    def meets(self, harmonic: int) -> int:
        """The nodal diameter of the modes that a harmonic meets."""
        waves = self.waves(harmonic)
        return min(waves, self.sectors - waves)

    def modes(self, harmonic: int) -> tuple[FloatArray, FloatArray, ComplexArray]:
        """Frequency (mode,), damping (mode,) and shapes (mode, dof) that a harmonic meets.

        Beyond half of the sectors they travel the other way, and the shapes are the conjugates.
        """
        which = self.diameter == self.meets(harmonic)
        shapes = self.shapes[which]
        backward = 2 * self.waves(harmonic) > self.sectors
        return self.frequency[which], self.damping[which], shapes.conj() if backward else shapes

    def lacking(self, harmonics: Iterable[int]) -> dict[int, int]:
        """The nodal diameters of those harmonics that meet no modes (harmonic: diameter)."""
        there = set(self.diameter.tolist())
        return {h: self.meets(h) for h in harmonics if self.meets(h) not in there}

    @property
    def period(self) -> int:
        """Sectors after which the motion of all harmonics repeats."""
        return self.sectors // gcd(self.engine_order, self.sectors)

    def at(self, used: npt.NDArray[np.bool_]) -> Ring:
        """The ring restricted to some of the degrees of freedom."""
        return replace(self, shapes=self.shapes[:, used])


def with_own(dofs: tuple[str, ...], used: npt.NDArray[np.bool_]) -> npt.NDArray[np.bool_]:
    """Mask of the used degrees of freedom, with a sector's own added for each used one of the next sector.

    >>> with_own(("tip", "root", "next.tip", "next.root"), np.array([False, False, True, False])).tolist()
    [True, False, True, False]
    """
    meant = {name.removeprefix(NEXT) for name, one in zip(dofs, used, strict=True) if one}
    return used | np.array([name in meant for name in dofs], dtype=np.bool_)


def of_sector(name: str, sector: int) -> str:
    """The name of a sector's degree of freedom or contact in the whole ring.

    >>> of_sector("tip", 3)
    'tip@3'
    """
    return f"{name}@{sector}"
