"""Checks the entries of a structure's matrix: finite, not too large, symmetric."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import scipy.sparse

from fcm.scene.errors import quoted, shown
from fcm.scene.options import MESSAGES, TOLERANCES
from fcm.scene.rules import ANY
from fcm.scene.section import Section


def check_numbers(section: Section, key: str, matrix: Any) -> bool:
    """Whether all entries are finite and not too large; notes those that are not, as [row][column]."""
    entries = scipy.sparse.coo_array(matrix)
    wrong = ANY.faulty(entries.data)[:, 0].tolist()
    if not wrong:
        return True
    row, column = entries.coords
    each = [f"[{row[k]}][{column[k]}] {ANY.fault(float(entries.data[k]))}" for k in wrong[: MESSAGES.entries]]
    rest = f"; {len(wrong)} such entries in all" if len(wrong) > MESSAGES.entries else ""
    section.wrong(key, f"entry {'; '.join(each)}{rest}")
    return False


def check_symmetric(section: Section, key: str, matrix: Any, dofs: Sequence[str] | None) -> float:
    """The greatest difference across the diagonal, relative to the greatest entry.

    Differences beyond rounding are noted, and the result is then infinite.
    """
    if matrix is None:
        return 0.0
    difference = abs(matrix - matrix.T).tocoo()
    size = abs(matrix)
    both = scipy.sparse.csc_array(size.maximum(size.T))
    row, column = difference.coords
    of_both = np.asarray(both[row, column]).ravel() if row.size else np.zeros(0)
    largest = float(size.max()) if size.nnz else 0.0
    wrong = (
        (difference.data > TOLERANCES.asymmetry * of_both)
        & (difference.data > TOLERANCES.negligible * largest)
        & (row < column)
    )
    if not wrong.any():
        return float(difference.max()) / largest if difference.nnz and largest else 0.0
    worst = np.flatnonzero(wrong)[np.argsort(-difference.data[wrong], kind="stable")][: MESSAGES.entries]
    named = dofs is not None and len(dofs) == matrix.shape[0]
    names = [quoted(name) for name in dofs or ()] if named else [str(i) for i in range(matrix.shape[0])]

    def entry(i: int, j: int) -> str:
        return f"({names[i]}, {names[j]}) is {shown(float(matrix[i, j]))}"

    entries = "; ".join(f"{entry(row[k], column[k])}, {entry(column[k], row[k])}" for k in worst)
    count = int(wrong.sum())
    differ = "a pair of entries differs" if count == 1 else f"{count} pairs of entries differ"
    section.wrong(key, f"is not symmetric: {differ}; {entries}{_one_triangle(matrix)}")
    return float("inf")


def _one_triangle(matrix: Any) -> str:
    """A remark on a matrix with only one triangle, as programs write symmetric ones; else ''."""
    halves = {"lower": scipy.sparse.tril(matrix, -1), "upper": scipy.sparse.triu(matrix, 1)}
    there = [name for name, half in halves.items() if half.count_nonzero()]
    return f"; only its {there[0]} triangle is there: give both" if len(there) == 1 else ""


def symmetric(matrix: Any) -> Any:
    """The symmetric part of the matrix, without asymmetry from rounding."""
    return scipy.sparse.csc_array((matrix + matrix.T) / 2)
