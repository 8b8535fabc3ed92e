"""Multifrontal factors of large sparse symmetric or Hermitian matrices: A = L S L^H with signs S.

Columns that share their entries are eliminated together, in a dense front, by LAPACK and BLAS. The pivots of
a front are factored by Cholesky if they are positive definite, otherwise by an eigendecomposition, whose
signs are counted. By Haynsworth's rule, A has as many negative eigenvalues as the pivots of all fronts
together. One triangle is stored, half the size of L and U.

Sources: J. W. H. Liu, The multifrontal method for sparse matrix solution: theory and practice, SIAM Review
34 (1992) 82; E. V. Haynsworth, Determination of the inertia of a partitioned Hermitian matrix, Linear
Algebra Appl. 1 (1968) 73.
"""

from __future__ import annotations

from itertools import pairwise
from typing import Any

import numpy as np
import numpy.typing as npt
import scipy.sparse
from scipy.linalg import get_blas_funcs, get_lapack_funcs

from fcm.frozen import Frozen
from fcm.structure.elimination_tree import Tree, tree_of

IntArray = npt.NDArray[np.intp]
Array = npt.NDArray[Any]  # of float or complex numbers
Matrix = Any  # scipy sparse array or matrix


class SingularError(ValueError):
    """Raised for a matrix with a pivot of zero."""


class Factor:
    """A factorised matrix.

    Attributes
    ----------
    negative
        Number of its negative eigenvalues.

    >>> factor = Factor(scipy.sparse.csc_array([[1.0, 2.0], [2.0, 1.0]]))
    >>> factor.solve(np.array([3.0, 3.0])).round(12).tolist(), factor.negative
    ([1.0, 1.0], 1)
    """

    def __init__(self, matrix: Matrix, tree: Tree | None = None) -> None:
        """Factorises a matrix given with both triangles, in the order of a tree (made if none is given).

        Raises
        ------
        SingularError
            If a pivot is zero to rounding.
        MemoryError
            If the factor does not fit into memory.
        """
        matrix = scipy.sparse.csc_array(matrix)
        self._tree = tree or tree_of(matrix)
        self.fronts: list[_Front] = []
        order = self._tree.order
        lower = scipy.sparse.csc_array(scipy.sparse.tril(matrix[order][:, order]))
        del matrix
        self._eliminate(lower)
        self.negative = sum(front.negative for front in self.fronts)

    def solve(self, loads: Array) -> Array:
        """Solution (row,) or (row, load) of A x = loads."""
        loads = np.asarray(loads)
        order, begin = self._tree.order, self._tree.begin
        table = loads.reshape(order.size, -1)[order].astype(np.result_type(self._kind, loads), copy=False)
        passed = list(zip(pairwise(begin), self._tree.below, self.fronts, strict=True))
        for (first, last), below, front in passed:
            table[first:last] = mine = front.forward(table[first:last])
            if below.size:
                table[below] -= front.beneath @ mine
        for (first, last), below, front in reversed(passed):
            table[first:last] = front.backward(table[first:last], table[below])
        answer = np.empty_like(table)
        answer[order] = table
        return answer.reshape(loads.shape)

    def _eliminate(self, lower: Matrix) -> None:
        self._kind = lower.dtype
        scale = float(np.abs(lower.diagonal()).max(initial=0.0))
        place = np.empty(lower.shape[0], dtype=np.intp)
        sizes = np.diff(self._tree.begin) + np.array([below.size for below in self._tree.below])
        room = np.empty(int(sizes.max()) ** 2, dtype=lower.dtype)  # shared by all fronts in turn
        waiting: dict[int, list[tuple[IntArray, Array]]] = {}
        for number, ((first, last), below) in enumerate(
            zip(pairwise(self._tree.begin), self._tree.below, strict=True)
        ):
            count = last - first
            place[first:last] = np.arange(count)
            place[below] = np.arange(count, count + below.size)
            entries = slice(lower.indptr[first], lower.indptr[last])
            column = np.repeat(np.arange(count), np.diff(lower.indptr[first : last + 1]))
            size = count + below.size
            full = room[: size * size].reshape((size, size), order="F")
            full[:] = 0.0
            full[place[lower.indices[entries]], column] = lower.data[entries]
            for rows, left in waiting.pop(number, ()):
                _add(full, place[rows], left)
            front, left = _eliminated(full, count, scale)
            self.fronts.append(front)
            if below.size:
                waiting.setdefault(self._tree.parent[number], []).append((below, left))


class _Front(Frozen):
    """The stored part of an eliminated front: pivots F = L S L^H, and the rows B below them."""

    pivots: Array  # L; or its inverse if there are signs
    beneath: Array  # B L^-H
    signs: Array | None  # S; None if all are positive

    @property
    def negative(self) -> int:
        return 0 if self.signs is None else int((self.signs < 0.0).sum())

    def forward(self, loads: Array) -> Array:
        """Forward substitution of a front: S L^-1 loads."""
        if self.signs is not None:
            return np.asarray(self.signs[:, None] * (self.pivots @ loads))
        return _triangular(self.pivots, loads, 0)

    def backward(self, mine: Array, below: Array) -> Array:
        """Backward substitution of a front: L^-H (mine - S (B L^-H)^H below)."""
        taken = (below.conj().T @ self.beneath).conj().T
        if self.signs is not None:
            return np.asarray(self.pivots.conj().T @ (mine - self.signs[:, None] * taken))
        return _triangular(self.pivots, mine - taken, 2)


def _triangular(lower: Array, loads: Array, turned: int) -> Array:
    """Solves with a triangular factor: L^-1 loads, or L^-H loads if `turned` is 2."""
    (trsm,) = get_blas_funcs(("trsm",), (lower, loads))
    found: Array = trsm(1.0, lower, loads, lower=1, trans_a=turned)
    return found


def _eliminated(full: Array, count: int, scale: float) -> tuple[_Front, Array]:
    """The front of the first `count` columns, and the lower triangle of its update to the rows below."""
    (potrf,) = get_lapack_funcs(("potrf",), (full,))
    pivots, failed = potrf(full[:count, :count], lower=1, clean=1)
    rest = full[count:, count:]
    if failed:
        front = _of_any_sign(full, count, scale)
        assert front.signs is not None
        return front, rest - (front.beneath * front.signs) @ front.beneath.conj().T
    (trsm,) = get_blas_funcs(("trsm",), (full,))
    (update,) = get_blas_funcs(("herk" if np.iscomplexobj(full) else "syrk",), (full,))
    if not rest.size:
        return _Front(pivots, np.zeros((0, count), dtype=full.dtype), None), rest.copy()
    beneath = trsm(1.0, pivots, full[count:, :count], side=1, lower=1, trans_a=2)
    return _Front(pivots, beneath, None), update(-1.0, beneath, 1.0, rest, lower=1)


def _of_any_sign(full: Array, count: int, scale: float) -> _Front:
    """A front with indefinite pivots F = Q D Q^H: L = Q |D|^1/2, S the signs of D."""
    value, vectors = np.linalg.eigh(full[:count, :count])
    size = np.abs(value)
    if size.min() <= count * np.finfo(float).eps * scale:
        raise SingularError("a pivot is zero to rounding")
    inverse = vectors.conj().T / np.sqrt(size)[:, None]
    return _Front(inverse, np.asfortranarray(full[count:, :count] @ inverse.conj().T), np.sign(value))


def _add(full: Array, at: IntArray, left: Array, together: int = 64) -> None:
    """Adds the update of one front (lower triangle) to another front, at ascending indices.

    `together` columns are added at a time, as single nodes would take as many calls as there are nodes,
    squared. Entries above the diagonal in these columns are added as well, but never read.
    """
    flat, size = full.ravel(order="K"), full.shape[0]  # by columns
    for first in range(0, at.size, together):
        columns = at[first : first + together, None]
        flat[columns * size + at[first:]] += left[first:, first : first + together].T
