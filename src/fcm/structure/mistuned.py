r"""A ring with different blades, in the modal coordinates of the ring with equal blades.

The tuned modes of nodal diameter n have the shapes P_i on one sector (P_i^H M P_i = 1 for each sector). They
move sector k by
    x_k = sqrt(2 / N) Re(P_i exp(2 pi i n k / N) z),    z = c + i s

with two real coordinates c, s of modal mass 1. For n = 0 and N / 2 there is only c, with 1 / sqrt(N). The
stiffness K_b of blade k is multiplied by 1 + d_k. In these coordinates that adds

    dK = sum_k d_k X_k^T K_b X_k,    X_k (row, coordinate) the displacements of sector k

to diag(w_i^2), and couples the waves of all diameters. With all modes of the sector this is exact. With some
of them it is the method of the subset of nominal modes (Yang and Griffin, Journal of Engineering for Gas
Turbines and Power 123, 2001). That is accurate as long as the mistuned modes are combinations of the kept
modes.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
from scipy.linalg.lapack import dgejsv

from fcm.frozen import Frozen
from fcm.structure.eigen import FloatArray, StructureError

ComplexArray = npt.NDArray[np.complex128]


class MistunedOptions(Frozen):
    """Tolerances for mistuned rings."""

    # w^2 relative to the lowest nonzero one of the tuned ring, up to which it counts as 0
    rigid_tolerance: float = 1e-9
    # likeness of the shapes of a family from which on their strains count as alike
    min_likeness: float = 0.5


OPTIONS = MistunedOptions()


class Basis(Frozen):
    """Real coordinates of a ring: the shape on sector k is r_k Re P + i_k Im P, with P of a sector's mode."""

    mode: npt.NDArray[np.intp]  # (coordinate,) the sector's mode of each coordinate
    real: FloatArray  # (coordinate, sector)
    imaginary: FloatArray  # (coordinate, sector)

    def shapes(self, shapes: ComplexArray) -> FloatArray:
        """Shapes of the ring (coordinate, sector, dof) from the sector's shapes (mode, dof)."""
        own = shapes[self.mode][:, None, :]
        found: FloatArray = self.real[..., None] * own.real + self.imaginary[..., None] * own.imag
        return found

    def stiffness(self, energy: FloatArray, change: FloatArray) -> FloatArray:
        """Stiffness change (coordinate, coordinate) by relative changes (sector,) of the blades' stiffness.

        energy (2, mode, 2, mode): K_b between real (0) and imaginary (1) parts of the modes' shapes.
        """
        parts = (self.real, self.imaginary)
        found = np.zeros((self.mode.size, self.mode.size))
        for one, left in enumerate(parts):
            for other, right in enumerate(parts):
                block = energy[one, :, other, :][np.ix_(self.mode, self.mode)]
                found += ((left * change) @ right.T) * block
        return found


def basis_of(diameter: npt.NDArray[np.int64], sectors: int) -> Basis:
    """Coordinates of a ring of N sectors, from the nodal diameters (mode,) of a sector's modes.

    >>> basis = basis_of(np.array([0, 1, 2]), 4)
    >>> basis.mode.tolist(), basis.real[1].round(3).tolist()
    ([0, 1, 1, 2], [0.707, 0.0, -0.707, -0.0])
    """
    double = (diameter > 0) & (2 * diameter != sectors)
    mode = np.repeat(np.arange(diameter.size), np.where(double, 2, 1))
    second = np.append(False, mode[1:] == mode[:-1])  # the sine of a pair
    angle = 2.0 * np.pi * (diameter[mode][:, None] * np.arange(sectors) % sectors) / sectors
    size = np.sqrt(np.where(double[mode], 2.0, 1.0) / sectors)[:, None]
    real = size * np.where(second[:, None], -np.sin(angle), np.cos(angle))
    imaginary = -size * np.where(second[:, None], np.cos(angle), np.sin(angle))
    return Basis(mode, real, imaginary)


def energy_of(shapes: ComplexArray, weighted: ComplexArray) -> FloatArray:
    """Elastic energy by K_b between real and imaginary parts (2, mode, 2, mode).

    `weighted` is K_b times the shapes (mode, row).
    """
    left, right = (np.concatenate((one.real, one.imag)) for one in (shapes, weighted))
    found = left @ right.T
    modes = len(shapes)
    return np.ascontiguousarray(((found + found.T) / 2.0).reshape(2, modes, 2, modes))


def strains(
    frequency: FloatArray, shapes: ComplexArray, diameter: npt.NDArray[np.int64]
) -> tuple[ComplexArray, FloatArray]:
    """Strain amplitudes (mode, family) of sector modes for an unknown stiffness, and their likeness.

    In the fundamental mistuning model (Feiner and Griffin, Journal of Turbomachinery 124, 2002) the i-th
    modes of all diameters are a family, in which a sector deforms alike. So the strain energy of a sector
    between two modes of a family is w_i w_j times a phase factor, that of P_ref^H P; between two families it
    is 0. The likeness (mode,) is |P_ref^H P| / (|P_ref| |P|), which the model takes as 1; P_ref belongs to
    the lowest diameter.
    """
    order = np.lexsort((frequency, diameter))
    families = int((diameter == diameter.min()).sum())
    family = np.empty(diameter.size, dtype=np.intp)
    family[order] = np.arange(diameter.size) % families
    found = np.zeros((diameter.size, families), dtype=np.complex128)
    likeness = np.ones(diameter.size)
    size = np.linalg.norm(shapes, axis=1)
    for place in range(families):
        members = np.flatnonzero(family == place)
        reference = members[diameter[members].argmin()]
        product = shapes[members] @ shapes[reference].conj()
        likeness[members] = np.abs(product) / (size[members] * size[reference])
        found[members, place] = frequency[members] * np.exp(1j * np.angle(product))
    return found, likeness


def modes_of_mistuned(squared: FloatArray, change: FloatArray) -> tuple[FloatArray, FloatArray]:
    """w^2 (mode,) in ascending order, and eigenvectors (coordinate, mode), of diag(squared) + change.

    A Jacobi method computes them, which is as accurate for the lowest modes as for the highest (Drmac and
    Veselic, SIAM Journal on Matrix Analysis 29, 2008). The highest modes represent flexibility and can be a
    million times as high.

    Raises
    ------
    StructureError
        If an eigenvalue is negative, or more eigenvalues are 0 than those of the tuned ring.

    Examples
    --------
    >>> found, vectors = modes_of_mistuned(np.array([1.0, 4.0]), np.array([[0.5, 0.0], [0.0, 0.0]]))
    >>> found.round(6).tolist()
    [1.5, 4.0]
    """
    rigid = squared <= 0.0
    shift = float(squared[~rigid].min()) if rigid.any() and not rigid.all() else 0.0
    whole = np.diag(np.where(rigid, 0.0, squared) + shift) + change
    size = np.sqrt(np.maximum(whole.diagonal(), 0.0))
    if not size.all():
        raise StructureError(_SOFT)
    try:
        factor = np.linalg.cholesky(whole / size[:, None] / size) * size[:, None]
    except np.linalg.LinAlgError:
        raise StructureError(_SOFT) from None
    values, vectors, _, work, _, info = dgejsv(factor, joba=2, jobu=0, jobv=3)
    if info:
        raise StructureError(f"the modes of the mistuned ring could not be found (LAPACK says {info})")
    values = values * (work[0] / work[1])
    found = values[::-1] ** 2 - shift
    found[np.abs(found) < OPTIONS.rigid_tolerance * shift] = 0.0
    if (found < 0.0).any() or (not rigid.any() and not found.all()):
        raise StructureError(_SOFT)
    return found, np.ascontiguousarray(vectors[:, ::-1])


_SOFT = (
    "with these factors the ring has a negative stiffness: the blade is not part of the sector's stiffness"
)
