"""Whether a matrix of a structure is symmetric, and which of its entries are not."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import scipy.sparse

from fcm.scene.errors import quoted, shown
from fcm.scene.section import Section

ASYMMETRY = 1e-8  # relative difference of two entries that ought to be equal
NEGLIGIBLE = 1e-12  # of the largest entry: differences this small are rounding
MOST_SHOWN = 3  # entries that are not symmetric, named in a message


def check_symmetric(section: Section, key: str, matrix: Any, dofs: Sequence[str] | None) -> None:
    """Note the entries that differ from those across the diagonal."""
    if matrix is None:
        return
    difference = abs(matrix - matrix.T).tocoo()
    size = abs(matrix)
    both = scipy.sparse.csc_array(size.maximum(size.T))
    row, column = difference.coords
    of_both = np.asarray(both[row, column]).ravel() if row.size else np.zeros(0)
    largest = float(size.max()) if size.nnz else 0.0
    wrong = (
        (difference.data > ASYMMETRY * of_both) & (difference.data > NEGLIGIBLE * largest) & (row < column)
    )
    if not wrong.any():
        return
    worst = np.flatnonzero(wrong)[np.argsort(-difference.data[wrong], kind="stable")][:MOST_SHOWN]
    named = dofs is not None and len(dofs) == matrix.shape[0]
    names = [quoted(name) for name in dofs or ()] if named else [str(i) for i in range(matrix.shape[0])]

    def entry(i: int, j: int) -> str:
        return f"({names[i]}, {names[j]}) is {shown(float(matrix[i, j]))}"

    entries = "; ".join(f"{entry(row[k], column[k])}, {entry(column[k], row[k])}" for k in worst)
    count = int(wrong.sum())
    differ = "a pair of entries differs" if count == 1 else f"{count} pairs of entries differ"
    section.wrong(key, f"is not symmetric: {differ}; {entries}")


def symmetric(matrix: Any) -> Any:
    """The matrix without what rounding has left of asymmetry."""
    return scipy.sparse.csc_array((matrix + matrix.T) / 2)
