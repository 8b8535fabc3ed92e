"""Elimination order of the rows of a sparse symmetric matrix, and fronts of columns.

Rows with the same entries, for example of one node of a mesh, are one vertex of a graph. METIS orders the
graph by nested dissection. The elimination tree says which columns wait for which. Successive columns that
share the rows below them are one front.

Sources: G. Karypis and V. Kumar, A fast and high quality multilevel scheme for partitioning irregular
graphs, SIAM J. Sci. Comput. 20 (1998) 359; J. W. H. Liu, The role of elimination trees in sparse
factorization, SIAM J. Matrix Anal. Appl. 11 (1990) 134.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt
import scipy.sparse

from fcm.frozen import Frozen

IntArray = npt.NDArray[np.intp]
Matrix = Any  # scipy sparse array or matrix


class FrontOptions(Frozen):
    """Options for merging fronts into fewer and larger ones, which store some zeros."""

    max_zeros: float = 0.1  # share of zeros in a merged front up to which it is merged
    few_columns: int = 48  # number of columns of a merged front up to which `max_zeros_of_few` holds instead
    max_zeros_of_few: float = 0.4  # share of zeros in a merged front of few columns


class Tree(Frozen):
    """Elimination order of the rows, and the fronts, each after those for which it waits.

    Front i has the columns begin[i] to begin[i + 1] of the ordered matrix, and the rows below[i] under them.
    """

    order: IntArray  # (row,)
    begin: list[int]  # (front + 1,)
    below: list[IntArray]  # rows below each front, ascending
    parent: list[int]  # the front that waits for each; -1 if none does

    @property
    def entries(self) -> int:
        """Number of entries stored by a factor with these fronts."""
        columns = np.diff(self.begin)
        return int((columns * (columns + np.array([one.size for one in self.below]))).sum())


def nested_dissection(graph: Matrix) -> IntArray:
    """Fill-reducing order of the vertices (row,) of a symmetric graph."""
    from pymetis import CSRAdjacency
    from pymetis import nested_dissection as dissected

    order, _ = dissected(CSRAdjacency(adj_starts=graph.indptr, adjacent=graph.indices))
    return np.asarray(order, dtype=np.intp)


def graph_of(matrix: Matrix) -> tuple[IntArray, Matrix]:
    """Vertex of each row (row,), and the graph of the vertices: a pattern without diagonal.

    Rows with the same pattern share a vertex. A hash identifies the pattern: the sum, over a row's entries,
    of a random number for each column. If two different rows had the same hash, their vertex would have the
    entries of both.
    """
    rows = matrix.shape[0]
    pattern = scipy.sparse.csc_array(
        (np.ones(matrix.nnz, np.int32), matrix.indices, matrix.indptr), matrix.shape
    )
    drawn = np.random.default_rng(0).integers(2**63, size=rows, dtype=np.uint64)
    summed = np.append(np.cumsum(drawn[matrix.indices], dtype=np.uint64), np.uint64(0))
    ends = summed[matrix.indptr.astype(np.intp) - 1]
    _, group = np.unique(ends[1:] - ends[:-1], return_inverse=True)
    member = scipy.sparse.csr_array((np.ones(rows, np.int32), (np.arange(rows), group)))
    graph = member.T @ pattern @ member
    graph = scipy.sparse.csr_array(graph + graph.T)
    graph.setdiag(0)
    graph.eliminate_zeros()
    graph.sort_indices()
    return group, graph


def tree_of(matrix: Matrix, options: FrontOptions | None = None) -> Tree:
    """Elimination order and fronts of a square matrix, from the pattern of both triangles."""
    options = options or FrontOptions()
    group, graph = graph_of(matrix)
    order = nested_dissection(graph) if graph.nnz else np.arange(graph.shape[0])
    order = order[_postorder(_parents(graph[order][:, order]))]
    graph = graph[order][:, order]
    parent = _parents(graph)
    weight = np.bincount(group, minlength=order.size)[order]
    begin, below = _taken_together(*_fronts(graph, parent), weight, options)
    # from vertices to rows
    first = np.concatenate(([0], np.cumsum(weight)))
    back = np.empty(order.size, dtype=np.intp)
    back[order] = np.arange(order.size)
    row_order = np.argsort(back[group], kind="stable")
    number = np.repeat(np.arange(len(below)), np.diff(begin))
    above = [int(number[one[0]]) if one.size else -1 for one in below]
    return Tree(row_order, first[begin].tolist(), [_rows(one, first) for one in below], above)


def _rows(vertices: IntArray, first: IntArray) -> IntArray:
    """Row numbers of ascending vertices."""
    if not vertices.size:
        return vertices
    many = first[vertices + 1] - first[vertices]
    skipped = np.repeat(first[vertices] - np.concatenate(([0], np.cumsum(many)[:-1])), many)
    return skipped + np.arange(skipped.size)


def _parents(graph: Matrix) -> list[int]:
    """The elimination tree: the parent of each column (the one that waits for it), -1 for a root."""
    graph = scipy.sparse.csr_array(graph)
    start, column = graph.indptr.tolist(), graph.indices.tolist()
    parent = [-1] * graph.shape[0]
    above = [-1] * graph.shape[0]  # the highest known ancestor, so that no path is followed twice
    for row in range(graph.shape[0]):
        for at in column[start[row] : start[row + 1]]:
            if at >= row:
                continue
            while above[at] not in (-1, row):
                above[at], at = row, above[at]
            if above[at] == -1:
                above[at] = parent[at] = row
    return parent


def _children(parent: list[int]) -> list[list[int]]:
    found: list[list[int]] = [[] for _ in parent]
    for one, above in enumerate(parent):
        if above >= 0:
            found[above].append(one)
    return found


def _postorder(parent: list[int]) -> IntArray:
    """Postorder of the columns, in which the columns of a branch are contiguous."""
    children = _children(parent)
    waiting = [one for one, above in enumerate(parent) if above < 0]
    found = []
    while waiting:
        found.append(waiting.pop())
        waiting.extend(children[found[-1]])
    return np.array(found[::-1], dtype=np.intp)


def _fronts(graph: Matrix, parent: list[int]) -> tuple[list[int], list[IntArray]]:
    """Fronts of columns that share all rows below: their first columns, and the end; rows below each."""
    lower = scipy.sparse.csc_array(scipy.sparse.tril(graph, -1))
    lower.sort_indices()
    children = _children(parent)
    under: list[IntArray | None] = [None] * graph.shape[0]  # below each column, until its parent is reached
    held = np.full(graph.shape[0], -1)
    begin: list[int] = []
    below: list[IntArray] = []
    for column, those in enumerate(children):
        parts = [lower.indices[lower.indptr[column] : lower.indptr[column + 1]].astype(np.intp)]
        for one in those:
            rows = under[one]
            assert rows is not None
            parts.append(rows[1:])
            under[one] = None
        longest = parts[-1] if those else parts[0]
        held[longest] = column
        if those and all((held[part] == column).all() for part in parts[:-1]):
            under[column] = longest  # the rows below the previous column
            below[-1] = longest
        else:
            under[column] = rows = np.unique(np.concatenate(parts))
            begin.append(column)
            below.append(rows)
    return [*begin, graph.shape[0]], below


def _taken_together(
    begin: list[int], below: list[IntArray], weight: IntArray, options: FrontOptions
) -> tuple[list[int], list[IntArray]]:
    """Merges fronts with preceding fronts for which they wait, if that stores few zeros."""
    first = np.concatenate(([0], np.cumsum(weight)))
    kept: list[tuple[int, IntArray, int]] = []  # first column, rows below, zeros
    for i, rows in enumerate(below):
        column, last, zeros = begin[i], begin[i + 1], 0
        while kept and kept[-1][1].size and kept[-1][1][0] < last:
            before, there, within = kept[-1]
            wide, tall = first[column] - first[before], int(weight[rows].sum()) + first[last] - first[column]
            more = int(zeros + within + wide * (tall - weight[there].sum()))
            columns = first[last] - first[before]
            share = options.max_zeros_of_few if columns <= options.few_columns else options.max_zeros
            if more > share * columns * (tall + wide - 0.5 * columns):
                break
            column, zeros = before, more
            kept.pop()
        kept.append((column, rows, zeros))
    return [*(column for column, *_ in kept), begin[-1]], [rows for _, rows, _ in kept]
