"""Factors of sparse symmetric or Hermitian matrices that are positive definite.

CHOLMOD (the package scikit-sparse) where it is installed and the matrix is large, else SuperLU with a
symmetric ordering: nested dissection by METIS of large matrices, minimum degree of small ones. All give the
same solutions to rounding; tests/benchmarks/solid.py measures them.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt
import scipy.sparse
from scipy.sparse.linalg import splu

FloatArray = npt.NDArray[np.float64]
Matrix = Any  # scipy sparse array or matrix
Solve = Callable[[FloatArray], FloatArray]  # loads (row,) or (row, load) to displacements


@dataclass(frozen=True)
class FactorOptions:
    """How matrices are factorised."""

    package: str = ""  # "CHOLMOD" or "SuperLU"; the first of them that is installed where it is empty
    small: int = 600  # rows up to which SuperLU is taken: there the orderings of CHOLMOD gain nothing
    dissected: int = 5000  # rows from which on SuperLU takes the ordering of METIS: 3 times faster at 150,000


class NotPositiveError(ValueError):
    """A matrix that is not positive definite, with the number of its negative eigenvalues.

    The number is None where it cannot be told, and 0 of a singular matrix.
    """

    def __init__(self, negative: int | None) -> None:
        self.negative = negative
        super().__init__("the matrix is not positive definite")


class TooLargeError(ValueError):
    """A matrix whose factors the memory does not hold."""

    def __init__(self, rows: int, entries: int) -> None:
        super().__init__(
            f"the factors of its {rows} rows and {entries} entries take more memory than there is: reduce "
            "the structure, as by Craig and Bampton, or install scikit-sparse, whose factors are smaller"
        )


def has_cholmod() -> bool:
    """Whether scikit-sparse is installed, in a release that has what is used here."""
    try:
        from sksparse.cholmod import CholmodNotPositiveDefiniteError, cholesky
    except ImportError:
        return False
    return callable(cholesky) and issubclass(CholmodNotPositiveDefiniteError, Exception)


def solver(matrix: Matrix, definite: bool = True, options: FactorOptions | None = None) -> Solve:
    """Factorise a positive definite matrix once, for any number of solutions; else NotPositiveError.

    Where it need not be definite, only a singular one is refused.

    >>> solver(scipy.sparse.csc_array([[2.0, 1.0], [1.0, 2.0]]))(np.array([3.0, 3.0]))
    array([1., 1.])
    """
    options = options or FactorOptions()
    matrix = scipy.sparse.csc_array(matrix)
    large = matrix.shape[0] > options.small
    if large and (options.package == "CHOLMOD" or (not options.package and has_cholmod())):
        solve = _cholmod(matrix)
        if solve is not None:
            return solve
    if matrix.shape[0] < options.dissected:
        return _superlu(matrix, definite)
    order = nested_dissection(matrix)
    solve, back = _superlu(matrix[order][:, order], definite, "NATURAL"), np.argsort(order)
    return lambda loads: solve(np.asarray(loads)[order])[back]


def nested_dissection(matrix: Matrix) -> npt.NDArray[np.intp]:
    """The order of the rows (row,) in which the factors of a symmetric matrix have few entries.

    Source: G. Karypis and V. Kumar, A fast and high quality multilevel scheme for partitioning irregular
    graphs, SIAM J. Sci. Comput. 20 (1998) 359; the package pymetis.
    """
    from pymetis import CSRAdjacency
    from pymetis import nested_dissection as dissected

    pattern = scipy.sparse.csr_array((np.ones(matrix.nnz), matrix.indices, matrix.indptr), shape=matrix.shape)
    graph = pattern + pattern.T  # METIS needs both triangles, and no diagonal
    graph = scipy.sparse.csr_array(graph - scipy.sparse.diags_array(graph.diagonal()))
    graph.eliminate_zeros()
    order, _ = dissected(CSRAdjacency(adj_starts=graph.indptr, adjacent=graph.indices))
    return np.asarray(order, dtype=np.intp)


def _cholmod(matrix: Matrix) -> Solve | None:
    """By CHOLMOD; None where the matrix is not positive definite, which SuperLU tells more of."""
    from sksparse.cholmod import CholmodNotPositiveDefiniteError, cholesky

    try:
        factor = cholesky(scipy.sparse.csc_matrix(matrix), mode="supernodal")  # others take any sign
    except CholmodNotPositiveDefiniteError:
        return None
    return lambda loads: np.asarray(factor(np.asarray(loads)))


def _superlu(matrix: Matrix, definite: bool, ordering: str = "MMD_AT_PLUS_A") -> Solve:
    """By SuperLU without pivoting off the diagonal: the signs of its pivots are those of the eigenvalues.

    That is Sylvester's law of inertia, where no rows were exchanged.
    """
    try:
        factor = splu(matrix, permc_spec=ordering, diag_pivot_thresh=0.0, options={"SymmetricMode": True})
    except RuntimeError:
        raise NotPositiveError(0) from None
    except MemoryError:
        raise TooLargeError(matrix.shape[0], matrix.nnz) from None
    if definite and (factor.perm_r != factor.perm_c).any():
        raise NotPositiveError(None)
    if definite and (negative := _negative(factor)):
        raise NotPositiveError(negative)
    solve: Solve = factor.solve
    return solve


def _negative(factor: Any) -> int:
    """Pivots below zero."""
    return int((factor.U.diagonal().real < 0.0).sum())
