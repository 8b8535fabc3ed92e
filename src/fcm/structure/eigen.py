"""Normal modes of a structure given by its stiffness and mass matrices, symmetric or Hermitian.

K phi = lambda M phi is solved about a shift s < 0 next to zero, as (K - s M)^-1 M phi = phi / (lambda - s).
Then K - s M is positive definite with rigid-body modes too, M may have rows of zeros, and the lowest modes
are the most accurate ones. Large matrices are solved by Lanczos (scipy's `eigsh`), small ones whole. Lanczos
may miss one of several equal frequencies. So the modes found are taken out, and it is checked whether a lower
one is left.

One factorisation serves for all of it, and for static displacements: those by K - s M are corrected until
nothing of the shift is left in them.

Of the elastic energy of a low mode little is left: a beam of n elements sums n^4 times as much. So it is
summed with more digits than the matrices have, where the machine has a longer number, and row by row; what
remains is the rounding of the shapes, of second order.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import numpy.typing as npt
import scipy.linalg
import scipy.sparse
from scipy.sparse.linalg import LinearOperator, eigsh

from fcm.frozen import Frozen
from fcm.structure.digits import digits_of
from fcm.structure.factor import NotPositiveError, Solve, TooLargeError, solver

FloatArray = npt.NDArray[np.float64]
Matrix = Any  # scipy sparse array or matrix


class EigenOptions(Frozen):
    """Tolerances of the modes."""

    dense_size: int = 600  # rows up to which all modes are computed at once
    shift: float = 1e-9  # of the largest ratio of stiffness to mass on the diagonals
    min_shift: float = 1e-11  # the same, where a frequency of interest says what a small shift is
    max_shift: float = 1e-4  # the same, where rounding has made rigid-body modes more negative than that
    frequency_shift: float = 1e-3  # of the square of that frequency
    last_digits: float = 10.0  # units of the last digit of entries that a shift is at least, if they have few
    # relative: such an eigenvalue of the inverse problem is a row without mass
    massless_tolerance: float = 1e-13
    mass_tolerance: float = 1e-9  # of a mass whose diagonal is 1: an eigenvalue less negative is rounding
    missed_tolerance: float = 1e-3  # relative: how closely it is looked for a mode that was passed by
    frequency_tolerance: float = 1e-6  # relative: so near to the highest, a mode that is left is not below it
    max_corrections: int = 12  # of static displacements; a shift that needs more is replaced


OPTIONS = EigenOptions()


class StructureError(ValueError):
    """Matrices that are no stiffness and mass of a structure."""


class Modes(Frozen):
    """Normal modes in ascending order, of modal mass 1."""

    stiffness: FloatArray  # (mode,) squares of the angular frequencies; rigid-body modes within rounding of 0
    shapes: FloatArray  # (row, mode)

    @property
    def count(self) -> int:
        return self.stiffness.size


class System(Frozen):
    """Stiffness and mass of a structure, and the answer of K - s M to loads."""

    K: Matrix  # (row, row)
    M: Matrix
    shift: float  # s, negative
    solve: Solve  # loads (row, load) to displacements

    @property
    def rows(self) -> int:
        return int(self.K.shape[0])

    def static(self, loads: FloatArray, beyond: float, near: float) -> FloatArray:
        """Displacements under loads that push no mode below `beyond`, a square of a frequency, by K alone.

        Each correction leaves at most -s / (beyond - s) of what the last one has left, down to `near`.
        """
        found = self.solve(loads)
        for _ in range(self.corrections(beyond, near)):
            found = found + self.solve(loads - self.K @ found)
        return found

    def corrections(self, beyond: float, near: float) -> int:
        """How many corrections that takes."""
        left = -self.shift / (beyond - self.shift)
        return 0 if left <= near else int(np.ceil(np.log(near) / np.log(left))) - 1


def system_of(K: Matrix, M: Matrix, top: float = 0.0) -> System:
    """Factorise K - s M; StructureError where the matrices are no stiffness and mass.

    top is the highest angular frequency of interest, 0 where there is none.
    """
    stiff, heavy = K.diagonal().real, M.diagonal().real
    if not (heavy > 0.0).any():
        raise StructureError("the mass has no entry greater than 0 on its diagonal")
    with np.errstate(over="ignore"):
        ratio = float((np.abs(stiff[heavy > 0.0]) / heavy[heavy > 0.0]).max())
    shift = -_size_of_shift(K, ratio, top)
    if shift == 0.0:
        raise StructureError("the stiffness has no entry on its diagonal")
    if not np.isfinite(shift):
        raise StructureError("the mass is too small beside the stiffness to calculate with")
    faults = _faults_of_mass(M)
    try:
        try:
            solve = solver(K - shift * M)
        except NotPositiveError as error:  # what is left of rigid-body modes may be more negative
            if shift <= (shift := -OPTIONS.max_shift * ratio):
                raise
            try:
                solve = solver(K - shift * M)
            except NotPositiveError:
                raise error from None  # which counts those between the shifts too
    except NotPositiveError as error:
        faults.append(_said("stiffness", error.negative))
    except TooLargeError as error:
        faults.append(str(error))
    if faults:
        raise StructureError("; ".join(faults))
    return System(K, M, shift, solve)


def _size_of_shift(K: Matrix, ratio: float, top: float) -> float:
    """More than rounding of the entries may take away, and little beside what is of interest."""
    digits = digits_of(K)
    rounding = 0.0 if digits is None else OPTIONS.last_digits * 10.0**-digits
    if not top or K.shape[0] <= OPTIONS.dense_size:
        return max(OPTIONS.shift, rounding) * ratio
    return max(max(OPTIONS.min_shift, rounding) * ratio, min(OPTIONS.frequency_shift * top**2, ratio))


def _faults_of_mass(M: Matrix) -> list[str]:
    """Why a mass is not that of a structure; empty where it may be.

    Its diagonal is made 1, so that the unit of a row does not matter. Large matrices are factorised: the
    pivots have as many negative ones as the eigenvalues, and most masses couple no two directions.
    """
    heavy = M.diagonal().real
    unit = scipy.sparse.diags_array(1.0 / np.sqrt(np.where(heavy > 0.0, heavy, heavy.max())))
    scaled = scipy.sparse.csc_array(unit @ M @ unit)
    digits = digits_of(M)
    least = max(OPTIONS.mass_tolerance, 0.0 if digits is None else OPTIONS.last_digits * 10.0**-digits)
    rows = heavy.size
    if rows <= OPTIONS.dense_size:
        count = int((np.linalg.eigvalsh(scaled.toarray()) < -least).sum())
        return [_said("mass", count)] if count else []
    try:
        solver(scaled + least * scipy.sparse.eye_array(rows))
    except NotPositiveError as error:
        return [_said("mass", error.negative)]
    except TooLargeError as error:
        return [str(error)]
    return []


def _said(what: str, negative: int | None) -> str:
    if negative == 0:
        return f"the {what} is singular{' where there is no mass' if what == 'stiffness' else ''}"
    found = f"{negative} negative eigenvalues" if negative and negative > 1 else "1 negative eigenvalue"
    found = "a negative eigenvalue" if negative is None else found
    return f"the {what} has {found}, that of a structure has none"


def _start(rows: int) -> FloatArray:
    """The same vector every time, of no pattern."""
    return np.random.default_rng(0).standard_normal(rows)


def shifted(system: System, shift: float) -> System:
    """The same with another negative shift, by another factorisation.

    Nearer to zero it need not be definite: digits that were not written make rigid-body modes negative.
    """
    try:
        return replace(system, shift=shift, solve=solver(system.K - shift * system.M, definite=False))
    except NotPositiveError as error:
        raise StructureError(_said("stiffness", error.negative)) from None


def modes_of(system: System, count: int) -> Modes:
    """The lowest modes of a structure; fewer where fewer rows have a mass."""
    rows = system.rows
    if rows <= OPTIONS.dense_size or count > rows // 3:
        shapes = _all(system)
    else:
        shapes = _complete(system, _lanczos(system, count), count)
    found = of_shapes(system, shapes)
    return Modes(found.stiffness[:count], found.shapes[:, :count])


def of_shapes(system: System, shapes: FloatArray) -> Modes:
    """Modes with these shapes, in any order and of any mass."""
    shapes = shapes / np.sqrt(energy_of(system.M, shapes))
    stiffness = elastic_energy(system.K, shapes)
    order = np.argsort(stiffness)
    return Modes(stiffness[order], shapes[:, order])


def _lanczos(system: System, count: int, known: FloatArray | None = None, near: float = 0.0) -> FloatArray:
    """The shapes of the lowest modes; of those that are orthogonal to some shapes of mass 1."""
    rows, kind = system.rows, system.K.dtype
    start = _start(rows)
    if known is None:
        inverse = LinearOperator((rows, rows), matvec=system.solve, dtype=kind)
    else:
        heavy, left = system.M @ known, known.conj().T
        start = start - known @ (heavy.conj().T @ start)

        def solve(loads: FloatArray) -> FloatArray:
            loads = np.ravel(loads)
            answer = system.solve(loads - heavy @ (left @ loads))
            pure: FloatArray = answer - known @ (heavy.conj().T @ answer)
            return pure

        inverse = LinearOperator((rows, rows), matvec=solve, dtype=kind)
    found: FloatArray = eigsh(
        system.K, count, system.M, sigma=system.shift, OPinv=inverse, v0=start, tol=near
    )[1]
    return found


def _complete(system: System, shapes: FloatArray, count: int) -> FloatArray:
    """The shapes with those of lower modes that Lanczos has passed by, as of several equal frequencies."""
    while True:
        shapes = _apart(system, shapes)  # of mass 1, and orthogonal where frequencies are close
        highest = np.sort(elastic_energy(system.K, shapes))[count - 1]
        further = of_shapes(system, _lanczos(system, 1, shapes, OPTIONS.missed_tolerance))
        # it is told higher than it is, never lower
        if further.stiffness[0] >= highest - OPTIONS.frequency_tolerance * abs(highest):
            return shapes
        shapes = np.concatenate((shapes, _lanczos(system, 1, shapes)), axis=1)


def _all(system: System) -> FloatArray:
    """The shapes of all modes that have a mass."""
    mass = system.M.toarray()
    shifted = system.K.toarray() - system.shift * mass
    value, shapes = scipy.linalg.eigh(mass, shifted)
    found: FloatArray = shapes[:, value > OPTIONS.massless_tolerance * value.max()]
    return found


def _apart(system: System, shapes: FloatArray) -> FloatArray:
    """The modes within the space of some shapes."""
    left = shapes.conj().T
    try:
        turn = scipy.linalg.eigh(left @ (system.K @ shapes), left @ (system.M @ shapes))[1]
    except np.linalg.LinAlgError:
        raise StructureError(
            "the mass is singular along some of the lowest modes, as the stiffness of a floating body is. "
            "Stiffness and mass may be in each other's place"
        ) from None
    found: FloatArray = shapes @ turn
    return found


def polished(system: System, shapes: FloatArray) -> FloatArray:
    """Shapes of modes near zero frequency after two more inverse iterations, of mass 1.

    That takes other modes out of them, each by its own stiffness beside the shift: also those that the mass
    couples to them and the stiffness does not.
    """
    for _ in range(2):
        shapes = system.solve(system.M @ shapes)
        shapes = shapes / np.sqrt(energy_of(system.M, shapes))
        shapes = _apart(system, shapes)
    return shapes


def unit_columns(rows: int, places: Sequence[int]) -> FloatArray:
    """A column of each place, with 1 there: (row, place).

    >>> unit_columns(3, [2]).tolist()
    [[0.0], [0.0], [1.0]]
    """
    found = np.zeros((rows, len(places)))
    found[list(places), np.arange(len(places))] = 1.0
    return found


def energy_of(matrix: Matrix, shapes: FloatArray) -> FloatArray:
    """phi^H A phi of each shape."""
    energy: FloatArray = np.einsum("ij,ij->j", shapes.conj(), matrix @ shapes).real
    return energy


def elastic_energy(K: Matrix, shapes: FloatArray, together: int = 4096) -> FloatArray:
    """phi^H K phi of each shape, whose terms nearly cancel.

    Row by row, where they cancel already: summed over all rows first, their rounding would be that of the
    greatest sum. Some rows at a time, so that what is computed on the way stays within the cache.
    """
    K = scipy.sparse.csr_array(K.conj(copy=False).T)  # which is K, without a conversion of columns to rows
    long = np.result_type(K.dtype, np.longdouble)
    turned = shapes.T.astype(long)
    found = np.zeros(len(turned), dtype=long)
    for first in range(0, K.shape[0], together):
        begin = K.indptr[first : first + together + 1]
        filled = np.flatnonzero(np.diff(begin))
        if not filled.size:
            continue
        some = slice(begin[0], begin[-1])
        column, entries, starts = K.indices[some], K.data[some].astype(long), begin[filled] - begin[0]
        for mode, shape in enumerate(turned):
            forces = np.add.reduceat(entries * shape[column], starts)
            found[mode] += (shape[first + filled].conj() * forces).sum()
    return found.real.astype(float)
