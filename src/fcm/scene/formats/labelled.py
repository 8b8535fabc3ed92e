"""Matrices with names of rows, and rules that are common to all programs that write them."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt
import scipy.sparse

from fcm.frozen import Frozen
from fcm.scene.files import UnreadableError

Integers = npt.NDArray[np.int64]
Floats = npt.NDArray[np.float64]

DIRECTIONS = ("x", "y", "z", "rx", "ry", "rz")  # numbered from 1 by CalculiX, Abaqus and Nastran


class Labelled(Frozen):
    """A sparse matrix (row, row); rows are the names of its degrees of freedom, empty if it has none."""

    matrix: Any
    rows: tuple[str, ...] = ()


def row_name(node: int, direction: int) -> str:
    """The name of a degree of freedom: node 40 in direction 1 is 40x; a scalar point has no direction.

    >>> row_name(40, 1), row_name(40, 6), row_name(40, 0), row_name(40, 8)
    ('40x', '40rz', 'point40', '40:8')
    """
    if direction == 0:
        return f"point{node}"
    return f"{node}{DIRECTIONS[direction - 1]}" if 1 <= direction <= 6 else f"{node}:{direction}"


def labelled_from(
    node: Integers, direction: Integers, of: Integers, value: Floats, mirrored: bool = True
) -> Labelled:
    """The matrix of entries whose row and column are given by node and direction.

    Parameters
    ----------
    node, direction : (entry, 2)
        Those of the row and of the column.
    of : (entry,)
        The line of each entry, for messages.
    value : (entry,)
    mirrored : bool
        Whether one triangle stands for both, as in `symmetric_from`.

    Rows are sorted by node, then by direction.
    """
    pairs = np.stack((node.ravel(), direction.ravel()), axis=1)
    rows, place = np.unique(pairs, axis=0, return_inverse=True)
    names = tuple(row_name(int(one), int(way)) for one, way in rows)
    place = place.reshape(-1, 2)
    row, column = place[:, 0], place[:, 1]
    if mirrored:
        return Labelled(symmetric_from(row, column, of, value, len(rows), names), names)
    size = (len(rows), len(rows))
    return Labelled(scipy.sparse.coo_array((value, (row, column)), shape=size), names)


def symmetric_from(
    row: Integers, column: Integers, of: Integers, value: Floats, size: int, names: tuple[str, ...] = ()
) -> Any:
    """A symmetric matrix from one of its triangles, or from both if they are equal.

    A repeated entry, or one that differs from its mirror image, raises UnreadableError.
    """
    low, high = np.minimum(row, column), np.maximum(row, column)
    order = np.lexsort((row, low, high))
    same = (low[order][1:] == low[order][:-1]) & (high[order][1:] == high[order][:-1])
    first, second = order[:-1][same], order[1:][same]
    wrong = (row[first] == row[second]) | (value[first] != value[second])
    if wrong.any():
        at = int(wrong.argmax())
        one, other = int(first[at]), int(second[at])
        shown = [names[i] if names else str(i + 1) for i in (int(row[one]), int(column[one]))]
        lines = sorted((int(of[one]), int(of[other])))
        twice = row[one] == row[other]
        what = "is there twice" if twice else f"is {value[one]:g} and {value[other]:g} across the diagonal"
        raise UnreadableError(
            f"lines {lines[0]} and {lines[1]}: the entry of {shown[0]} and {shown[1]} {what}; "
            "give each once, for one triangle of a symmetric matrix"
        )
    once = np.ones(len(row), dtype=np.bool_)
    once[second] = False
    low, high, value = low[once], high[once], value[once]
    off = low != high
    places = np.concatenate((low, high[off])), np.concatenate((high, low[off]))
    return scipy.sparse.coo_array((np.concatenate((value, value[off])), places), shape=(size, size))
