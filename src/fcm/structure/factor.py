"""Factors of sparse symmetric or Hermitian matrices, usually positive definite.

CHOLMOD is used if its package scikit-sparse is installed. Otherwise a multifrontal factor is used if it has
many entries, and SuperLU if it has few. All give the same solutions to rounding. SuperLU stores both
triangles, and its pivots are available only from a copy of them.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import field
from functools import partial
from threading import Thread
from typing import Any

import numpy as np
import numpy.typing as npt
import scipy.sparse
from scipy.sparse.linalg import splu

from fcm.frozen import Frozen
from fcm.structure.elimination_tree import FrontOptions, Tree, tree_of
from fcm.structure.multifrontal import Factor, SingularError

FloatArray = npt.NDArray[np.float64]
Matrix = Any  # scipy sparse array or matrix
Solve = Callable[[FloatArray], FloatArray]  # loads (row,) or (row, load) to displacements


class FactorOptions(Frozen):
    """Options for choosing the factorisation of a sparse matrix."""

    package: str = ""  # "CHOLMOD", "fronts" or "SuperLU"; if empty, chosen by the number of rows
    superlu_size: int = 600  # rows up to which SuperLU is used: CHOLMOD's ordering gains nothing there
    dissection_size: int = 5000  # rows from which on nested dissection is used
    # entries of a factor up to which SuperLU and the copy of its pivots need little memory
    light_entries: int = 5_000_000
    # entries of a matrix from which on SuperLU runs in a thread that an interruption abandons
    polled_entries: int = 200_000
    poll_interval: float = 0.1  # [s] between checks whether that thread is done or the run is interrupted
    # entries of the loads in one call of SuperLU, which no signal can interrupt
    solved_entries: int = 1_000_000
    fronts: FrontOptions = field(default_factory=FrontOptions)


class NotPositiveError(ValueError):
    """Raised for a matrix that is not positive definite, with the number of its negative eigenvalues.

    The number is None if it is unknown, and 0 for a singular matrix.
    """

    def __init__(self, negative: int | None) -> None:
        self.negative = negative
        super().__init__("the matrix is not positive definite")


class TooLargeError(ValueError):
    """Raised when the factors of a matrix do not fit into memory."""

    def __init__(self, rows: int, entries: int) -> None:
        super().__init__(
            f"the factors of its {rows} rows and {entries} entries take more memory than there is. Reduce "
            "the structure, as by Craig and Bampton, or install scikit-sparse, whose factors are smaller"
        )


def has_cholmod() -> bool:
    """Whether scikit-sparse is installed in a release with the functions used here."""
    try:
        from sksparse.cholmod import CholmodNotPositiveDefiniteError, cholesky
    except ImportError:
        return False
    return callable(cholesky) and issubclass(CholmodNotPositiveDefiniteError, Exception)


def solver(matrix: Matrix, definite: bool = True, options: FactorOptions | None = None) -> Solve:
    """Factorises a positive definite matrix once, for any number of solutions; else raises NotPositiveError.

    If definite is false, only a singular matrix is refused.

    >>> solver(scipy.sparse.csc_array([[2.0, 1.0], [1.0, 2.0]]))(np.array([3.0, 3.0]))
    array([1., 1.])
    """
    options = options or FactorOptions()
    matrix = scipy.sparse.csc_array(matrix)
    rows = matrix.shape[0]
    if options.package == "CHOLMOD" or (
        not options.package and rows > options.superlu_size and has_cholmod()
    ):
        solve = _cholmod(matrix)
        if solve is not None:
            return solve
    if rows < options.dissection_size and options.package != "fronts":
        return _superlu(matrix, definite, options)
    tree = tree_of(matrix, options.fronts)
    if options.package == "fronts" or (not options.package and tree.entries > options.light_entries):
        return _fronts(matrix, definite, tree)
    order = tree.order
    solve, back = _superlu(matrix[order][:, order], definite, options, "NATURAL"), np.argsort(order)
    return lambda loads: solve(np.asarray(loads)[order])[back]


def _cholmod(matrix: Matrix) -> Solve | None:
    """Solver by CHOLMOD; None if the matrix is not positive definite.

    The other packages then count its negative eigenvalues.
    """
    from sksparse.cholmod import CholmodNotPositiveDefiniteError, cholesky

    try:
        factor = cholesky(scipy.sparse.csc_matrix(matrix), mode="supernodal")  # others take any sign
    except CholmodNotPositiveDefiniteError:
        return None
    return lambda loads: np.asarray(factor(np.asarray(loads)))


def _fronts(matrix: Matrix, definite: bool, tree: Tree) -> Solve:
    try:
        factor = Factor(matrix, tree)
    except SingularError:
        raise NotPositiveError(0) from None
    except MemoryError:
        raise TooLargeError(matrix.shape[0], matrix.nnz) from None
    if definite and factor.negative:
        raise NotPositiveError(factor.negative)
    return factor.solve


def _superlu(
    matrix: Matrix, definite: bool, options: FactorOptions, ordering: str = "MMD_AT_PLUS_A"
) -> Solve:
    """Solver by SuperLU without off-diagonal pivoting, so that its pivots have the signs of the eigenvalues.

    They have by Sylvester's law of inertia if no rows were exchanged.
    """
    symmetric = {"SymmetricMode": True}
    work = partial(splu, matrix, permc_spec=ordering, diag_pivot_thresh=0.0, options=symmetric)
    try:
        factor = work() if matrix.nnz < options.polled_entries else _left_behind(work, options.poll_interval)
    except RuntimeError:
        raise NotPositiveError(0) from None
    except MemoryError:
        raise TooLargeError(matrix.shape[0], matrix.nnz) from None
    if definite and (factor.perm_r != factor.perm_c).any():
        raise NotPositiveError(None)
    if definite and (negative := _negative(factor)):
        raise NotPositiveError(negative)
    return partial(by_blocks, factor.solve, options.solved_entries)


def by_blocks(solve: Solve, most: int, loads: FloatArray) -> FloatArray:
    """Displacements under loads (row,) or (row, load), solved in blocks of at most `most` entries."""
    if loads.ndim == 1 or loads.size <= most:
        return solve(loads)
    together = max(most // loads.shape[0], 1)
    return np.hstack(
        [solve(loads[:, first : first + together]) for first in range(0, loads.shape[1], together)]
    )


def _left_behind(work: Callable[[], Any], poll: float) -> Any:
    """Result of a compiled call, run in a thread that an interruption abandons.

    The call lets other threads run, but no signal ends it.
    """
    done: list[Any] = []
    failed: list[BaseException] = []

    def call() -> None:
        try:
            done.append(work())
        except BaseException as error:  # raised again in the caller's thread
            failed.append(error)

    thread = Thread(target=call, daemon=True)
    thread.start()
    while thread.is_alive():
        thread.join(poll)  # with a timeout, as an interruption by another thread does not wake it
    if failed:
        raise failed[0]
    return done[0]


def _negative(factor: Any) -> int:
    """Number of negative pivots."""
    return int((factor.U.diagonal().real < 0.0).sum())
