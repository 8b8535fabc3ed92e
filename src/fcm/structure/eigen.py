"""Normal modes of a structure given by its stiffness and mass matrices, symmetric or Hermitian.

K phi = lambda M phi is solved about a shift s < 0 next to zero, as (K - s M)^-1 M phi = phi / (lambda - s):
K - s M is positive definite with rigid-body modes too, M may have rows of zeros, and the lowest modes are the
most accurate ones. Large matrices by Lanczos (scipy's `eigsh`), small ones whole. Beside rigid-body modes,
-1 / s, the elastic ones, 1 / (lambda - s), lose the digits by which s is nearer to zero than their lambda:
then all are solved for again about -lambda of the first elastic one.

Of the elastic energy of a low mode little is left: a beam of n elements sums n^4 times as much. So it is
summed with more digits than the matrices have, where the machine has a longer number; what remains is the
rounding of the shapes, of second order.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import numpy.typing as npt
import scipy.linalg
import scipy.sparse
from scipy.sparse.linalg import LinearOperator, eigsh, splu

from fcm.structure.digits import digits_of

FloatArray = npt.NDArray[np.float64]
Matrix = Any  # scipy sparse array or matrix

DENSE = 600  # rows up to which all modes are computed at once
SHIFT = 1e-9  # of the largest ratio of stiffness to mass on the diagonals
LAST_DIGITS = 10.0  # units of the last digit of the entries that a shift is at least, if they have few digits
NO_MASS = 1e-13  # relative: below it, an eigenvalue of the inverse problem is no mode, but a row without mass
NEAR = 1e-9  # relative: squares of frequencies so near to each other are one, beside rounding
NEGATIVE = 1e-9  # of the largest mass: less negative than that is rounding


class StructureError(ValueError):
    """Matrices that are no stiffness and mass of a structure."""


@dataclass(frozen=True)
class Modes:
    """Normal modes in ascending order, of modal mass 1."""

    stiffness: FloatArray  # (mode,) squares of the angular frequencies; rigid-body modes within rounding of 0
    shapes: FloatArray  # (row, mode)

    @property
    def count(self) -> int:
        return self.stiffness.size


@dataclass(frozen=True)
class System:
    """Stiffness and mass of a structure, and the answer of K - s M to loads."""

    K: Matrix  # (row, row)
    M: Matrix
    shift: float  # s, negative
    solve: Callable[[FloatArray], FloatArray]  # loads (row, load) to displacements

    @property
    def rows(self) -> int:
        return int(self.K.shape[0])


def system_of(K: Matrix, M: Matrix) -> System:
    """Factorise K - s M; StructureError where the matrices are no stiffness and mass."""
    stiff, heavy = K.diagonal().real, M.diagonal().real
    if not (heavy > 0.0).any():
        raise StructureError("the mass has no entry greater than 0 on its diagonal")
    with np.errstate(over="ignore"):
        shift = -_part(K) * float((np.abs(stiff[heavy > 0.0]) / heavy[heavy > 0.0]).max())
    if shift == 0.0:
        raise StructureError("the stiffness has no entry on its diagonal")
    if not np.isfinite(shift):
        raise StructureError("the mass is too small beside the stiffness to calculate with")
    ground = scipy.sparse.diags_array(np.full(heavy.size, NEGATIVE * heavy.max()))
    both = (("mass", M + ground), ("stiffness", K - shift * M))
    if faults := [fault for what, matrix in both if (fault := _fault(what, matrix))]:
        raise StructureError("; ".join(faults))
    return System(
        K, M, shift, _factor(K - shift * M, "the stiffness is singular where there is no mass").solve
    )


def _part(K: Matrix) -> float:
    """How much of the largest ratio the shift is: more than rounding of the entries may take away."""
    digits = digits_of(K)
    return SHIFT if digits is None else max(SHIFT, LAST_DIGITS * 10.0**-digits)


def _fault(what: str, matrix: Matrix) -> str:
    """Why a matrix is not that of a structure; empty where it may be."""
    try:
        count = _negative(_factor(matrix, f"the {what} is singular"))
    except StructureError as error:
        return str(error)
    found = "1 negative eigenvalue" if count == 1 else f"{count} negative eigenvalues"
    return f"the {what} has {found}, that of a structure has none" if count else ""


def nearer(system: System, shift: float) -> System:
    """The same with a shift that is no farther from zero than this one, which is negative."""
    return system if shift <= system.shift else shifted(system, shift)


def shifted(system: System, shift: float) -> System:
    """The same with another negative shift."""
    return replace(system, shift=shift, solve=_factor(system.K - shift * system.M, "no matter").solve)


def _factor(matrix: Matrix, singular: str) -> Any:
    """LU factors without pivoting off the diagonal: the signs of the pivots are those of the eigenvalues."""
    try:
        return splu(
            scipy.sparse.csc_array(matrix),
            permc_spec="MMD_AT_PLUS_A",
            diag_pivot_thresh=0.0,
            options={"SymmetricMode": True},
        )
    except RuntimeError:
        raise StructureError(singular) from None


def _negative(factor: Any) -> int | None:
    """How many eigenvalues are negative (Sylvester's law of inertia); None if rows were exchanged."""
    exchanged = (factor.perm_r != factor.perm_c).any()
    return None if exchanged else int((factor.U.diagonal().real < 0.0).sum())


def modes_of(system: System, count: int) -> Modes:
    """The lowest modes of a structure; fewer where fewer rows have a mass."""
    rows = system.rows
    if rows <= DENSE or count > rows // 3:
        shapes = _all(system)
    else:
        inverse = LinearOperator((rows, rows), matvec=system.solve, dtype=system.K.dtype)
        start = np.random.default_rng(0).standard_normal(rows)  # the same answer every time
        _, shapes = eigsh(system.K, count, system.M, sigma=system.shift, OPinv=inverse, v0=start)
        if np.iscomplexobj(shapes):  # those of close frequencies are not orthogonal to each other
            shapes = _apart(system, shapes)
    shapes = shapes / np.sqrt(energy_of(system.M, shapes))
    stiffness = elastic_energy(system.K, shapes)
    order = np.argsort(stiffness)[:count]
    return Modes(stiffness[order], shapes[:, order])


def _all(system: System) -> FloatArray:
    """The shapes of all modes that have a mass."""
    mass = system.M.toarray()
    shifted = system.K.toarray() - system.shift * mass
    value, shapes = scipy.linalg.eigh(mass, shifted)
    found: FloatArray = shapes[:, value > NO_MASS * value.max()]
    return found


def _apart(system: System, shapes: FloatArray) -> FloatArray:
    """The modes within the space of some shapes."""
    left = shapes.conj().T
    found: FloatArray = shapes @ scipy.linalg.eigh(left @ (system.K @ shapes), left @ (system.M @ shapes))[1]
    return found


def energy_of(matrix: Matrix, shapes: FloatArray) -> FloatArray:
    """phi^H A phi of each shape."""
    energy: FloatArray = np.einsum("ij,ij->j", shapes.conj(), matrix @ shapes).real
    return energy


def elastic_energy(K: Matrix, shapes: FloatArray) -> FloatArray:
    """phi^H K phi of each shape, whose terms nearly cancel."""
    upper = scipy.sparse.coo_array(scipy.sparse.triu(K, 1))
    long = np.result_type(K.dtype, np.longdouble)
    diagonal, beside = K.diagonal().astype(long), upper.data.astype(long)
    found = np.zeros(shapes.shape[1])
    for mode, shape in enumerate(shapes.T.astype(long)):
        crossed = (shape[upper.row].conj() * beside * shape[upper.col]).sum()
        found[mode] = float(((diagonal * shape.conj() * shape).sum() + 2.0 * crossed).real)
    return found


def missed(system: System, modes: Modes) -> int | None:
    """How many modes below the highest of those found are not among them; None where it cannot be told.

    By Sylvester's law of inertia: K - a M has as many negative pivots as there are modes below a.
    """
    if modes.count < 2:
        return None
    gaps = np.diff(modes.stiffness)
    at = int(np.argmax(gaps[-min(8, gaps.size) :])) + max(0, gaps.size - 8)
    below, above = modes.stiffness[at : at + 2]
    if above - below <= NEAR * above:
        return None  # all of them are one frequency: none is between
    between = float(below + above) / 2.0
    try:
        count = _negative(_factor(system.K - between * system.M, "no matter"))
    except StructureError:
        return None
    return None if count is None else count - (at + 1)
