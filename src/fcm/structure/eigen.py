"""Normal modes of a structure given by its stiffness and mass matrices, symmetric or Hermitian.

K phi = lambda M phi is solved about a shift s < 0 next to zero, as (K - s M)^-1 M phi = phi / (lambda - s).
Then K - s M is positive definite even with rigid-body modes, M may have rows of zeros, and the lowest modes
are the most accurate. Lanczos (scipy's `eigsh`) solves large matrices, a dense solver small ones. Lanczos may
miss one of several equal frequencies. So the modes found are deflated, and a search for a lower mode follows.

One factorisation serves all this and static displacements. These are solved with K - s M, then corrected
until the shift has no effect.

Most of the elastic energy of a low mode cancels: the terms for a beam of n elements are n^4 times as large.
So it is summed row by row, in extended precision where the machine has it. The remaining error is that of the
shapes, of second order.
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

    dense_size: int = 600  # rows up to which all modes are computed by a dense solver
    # size of the shift relative to the largest ratio of stiffness to mass on the diagonals
    shift: float = 1e-9
    # least shift, relative to the same ratio, where a frequency of interest is given
    min_shift: float = 1e-11
    # shift, relative to the same ratio, that is tried if K - s M is not positive definite
    max_shift: float = 1e-4
    frequency_shift: float = 1e-3  # shift relative to the square of the highest frequency of interest
    last_digits: float = 10.0  # least shift in units of the entries' last digit, if they have few digits
    # eigenvalue of the inverse problem, relative to the greatest, up to which a row is massless
    massless_tolerance: float = 1e-13
    # negative eigenvalue of the mass, scaled to a diagonal of 1, that counts as rounding
    mass_tolerance: float = 1e-9
    missed_tolerance: float = 1e-3  # relative tolerance of the search for a mode that Lanczos has missed
    # part by which the w^2 of a missed mode must be below the highest one found
    frequency_tolerance: float = 1e-6
    max_corrections: int = 12  # corrections of static displacements; a shift that needs more is replaced


OPTIONS = EigenOptions()


class StructureError(ValueError):
    """Raised for matrices that are not the stiffness and mass of a structure."""


class Modes(Frozen):
    """Normal modes in ascending order, of modal mass 1."""

    stiffness: FloatArray  # (mode,) squares of the angular frequencies; rigid-body modes: rounding of 0
    shapes: FloatArray  # (row, mode)

    @property
    def count(self) -> int:
        return self.stiffness.size


class FactoredStructure(Frozen):
    """Stiffness and mass of a structure, and a solver of (K - s M) x = loads."""

    K: Matrix  # (row, row)
    M: Matrix
    shift: float  # s, negative
    solve: Solve  # loads (row, load) to displacements

    @property
    def rows(self) -> int:
        return int(self.K.shape[0])

    def static(self, loads: FloatArray, beyond: float, near: float) -> FloatArray:
        """Static displacements (by K alone) under loads that push no mode with w^2 below `beyond`.

        Each correction reduces the error by the factor -s / (beyond - s), down to `near`.
        """
        found = self.solve(loads)
        for _ in range(self.corrections(beyond, near)):
            found = found + self.solve(loads - self.K @ found)
        return found

    def corrections(self, beyond: float, near: float) -> int:
        """Number of corrections that `static` needs to reach the tolerance `near`."""
        left = -self.shift / (beyond - self.shift)
        return 0 if left <= near else int(np.ceil(np.log(near) / np.log(left))) - 1


def factored_structure(K: Matrix, M: Matrix, top: float = 0.0) -> FactoredStructure:
    """Factorises K - s M; raises StructureError if the matrices are not those of a structure.

    top is the highest angular frequency of interest, or 0.
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
        except NotPositiveError as error:  # residuals of rigid-body modes may be more negative
            if shift <= (shift := -OPTIONS.max_shift * ratio):
                raise
            try:
                solve = solver(K - shift * M)
            except NotPositiveError:
                raise error from None  # its count includes those between the shifts
    except NotPositiveError as error:
        faults.append(_said("stiffness", error.negative))
    except TooLargeError as error:
        faults.append(str(error))
    if faults:
        raise StructureError("; ".join(faults))
    return FactoredStructure(K, M, shift, solve)


def _size_of_shift(K: Matrix, ratio: float, top: float) -> float:
    """Size of the shift: above the rounding of the entries, and small relative to what is of interest."""
    digits = digits_of(K)
    rounding = 0.0 if digits is None else OPTIONS.last_digits * 10.0**-digits
    if not top or K.shape[0] <= OPTIONS.dense_size:
        return max(OPTIONS.shift, rounding) * ratio
    return max(max(OPTIONS.min_shift, rounding) * ratio, min(OPTIONS.frequency_shift * top**2, ratio))


def _faults_of_mass(M: Matrix) -> list[str]:
    """Reasons why a mass matrix is not that of a structure; empty if it may be.

    Its diagonal is scaled to 1, so that the unit of a row does not matter. Large matrices are factorised: as
    many pivots as eigenvalues are negative, and the factor is sparse, as most masses couple no two
    directions.
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
    """Start vector of Lanczos: pseudo-random, but always the same."""
    return np.random.default_rng(0).standard_normal(rows)


def shifted(structure: FactoredStructure, shift: float) -> FactoredStructure:
    """The structure, factorised again with another negative shift.

    With a shift nearer to zero the matrix need not be definite: rounded entries may make rigid-body modes
    negative.
    """
    try:
        return replace(
            structure, shift=shift, solve=solver(structure.K - shift * structure.M, definite=False)
        )
    except NotPositiveError as error:
        raise StructureError(_said("stiffness", error.negative)) from None


def modes_of(structure: FactoredStructure, count: int) -> Modes:
    """The lowest modes of a structure; fewer than `count` if fewer rows have mass."""
    rows = structure.rows
    if rows <= OPTIONS.dense_size or count > rows // 3:
        shapes = _all(structure)
    else:
        shapes = _complete(structure, _lanczos(structure, count), count)
    found = of_shapes(structure, shapes)
    return Modes(found.stiffness[:count], found.shapes[:, :count])


def of_shapes(structure: FactoredStructure, shapes: FloatArray) -> Modes:
    """Modes from shapes in any order and of any modal mass: normalised and sorted."""
    shapes = shapes / np.sqrt(energy_of(structure.M, shapes))
    stiffness = elastic_energy(structure.K, shapes)
    order = np.argsort(stiffness)
    return Modes(stiffness[order], shapes[:, order])


def _lanczos(
    structure: FactoredStructure, count: int, known: FloatArray | None = None, near: float = 0.0
) -> FloatArray:
    """Shapes of the lowest modes by Lanczos, orthogonal to `known` shapes of mass 1 if given."""
    rows, kind = structure.rows, structure.K.dtype
    start = _start(rows)
    if known is None:
        inverse = LinearOperator((rows, rows), matvec=structure.solve, dtype=kind)
    else:
        heavy, left = structure.M @ known, known.conj().T
        start = start - known @ (heavy.conj().T @ start)

        def solve(loads: FloatArray) -> FloatArray:
            loads = np.ravel(loads)
            answer = structure.solve(loads - heavy @ (left @ loads))
            pure: FloatArray = answer - known @ (heavy.conj().T @ answer)
            return pure

        inverse = LinearOperator((rows, rows), matvec=solve, dtype=kind)
    found: FloatArray = eigsh(
        structure.K, count, structure.M, sigma=structure.shift, OPinv=inverse, v0=start, tol=near
    )[1]
    return found


def _complete(structure: FactoredStructure, shapes: FloatArray, count: int) -> FloatArray:
    """The shapes and those of lower modes that Lanczos missed, for example at equal frequencies."""
    while True:
        shapes = _apart(structure, shapes)  # of mass 1, and orthogonal even if frequencies are close
        highest = np.sort(elastic_energy(structure.K, shapes))[count - 1]
        further = of_shapes(structure, _lanczos(structure, 1, shapes, OPTIONS.missed_tolerance))
        # Lanczos overestimates it, never underestimates it
        if further.stiffness[0] >= highest - OPTIONS.frequency_tolerance * abs(highest):
            return shapes
        shapes = np.concatenate((shapes, _lanczos(structure, 1, shapes)), axis=1)


def _all(structure: FactoredStructure) -> FloatArray:
    """Shapes of all modes with mass, by a dense solver."""
    mass = structure.M.toarray()
    shifted = structure.K.toarray() - structure.shift * mass
    value, shapes = scipy.linalg.eigh(mass, shifted)
    found: FloatArray = shapes[:, value > OPTIONS.massless_tolerance * value.max()]
    return found


def _apart(structure: FactoredStructure, shapes: FloatArray) -> FloatArray:
    """Shapes of the modes within the space spanned by some shapes (Rayleigh-Ritz)."""
    left = shapes.conj().T
    try:
        turn = scipy.linalg.eigh(left @ (structure.K @ shapes), left @ (structure.M @ shapes))[1]
    except np.linalg.LinAlgError:
        raise StructureError(
            "the mass is singular along some of the lowest modes, as the stiffness of a floating body is. "
            "Stiffness and mass may be in each other's place"
        ) from None
    found: FloatArray = shapes @ turn
    return found


def polished(structure: FactoredStructure, shapes: FloatArray) -> FloatArray:
    """Shapes of modes near zero frequency, of mass 1, after two more inverse iterations.

    These remove other modes from them, by the ratio of the other mode's stiffness to the shift. That includes
    modes coupled to them by the mass and not by the stiffness.
    """
    for _ in range(2):
        shapes = structure.solve(structure.M @ shapes)
        shapes = shapes / np.sqrt(energy_of(structure.M, shapes))
        shapes = _apart(structure, shapes)
    return shapes


def unit_columns(rows: int, places: Sequence[int]) -> FloatArray:
    """Unit vectors (row, place), with a 1 at each place.

    >>> unit_columns(3, [2]).tolist()
    [[0.0], [0.0], [1.0]]
    """
    found = np.zeros((rows, len(places)))
    found[list(places), np.arange(len(places))] = 1.0
    return found


def energy_of(matrix: Matrix, shapes: FloatArray) -> FloatArray:
    """Energy phi^H A phi of each shape."""
    energy: FloatArray = np.einsum("ij,ij->j", shapes.conj(), matrix @ shapes).real
    return energy


def elastic_energy(K: Matrix, shapes: FloatArray, together: int = 4096) -> FloatArray:
    """Elastic energy phi^H K phi of each shape, accurate although its terms nearly cancel.

    The terms are summed row by row, where they cancel already. A sum over all rows first would have the
    rounding of the greatest sum. `together` rows are treated at a time, so that intermediate results stay in
    the cache.
    """
    K = scipy.sparse.csr_array(K.conj(copy=False).T)  # equals K, without a conversion of columns to rows
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
