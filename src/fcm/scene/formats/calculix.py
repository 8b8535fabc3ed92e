"""Reads matrices of CalculiX (.sti, .mas), written by `*FREQUENCY, SOLVER=MATRIXSTORAGE`.

Each line has a row, a column and a value; one triangle of a symmetric matrix is stored. The .dof file of the
same job gives node and direction of each row, in lines such as `40.1`.
"""

from __future__ import annotations

from pathlib import Path

from fcm.scene.files import UnreadableError
from fcm.scene.formats.columns import read_columns
from fcm.scene.formats.labelled import DIRECTIONS, Labelled, symmetric_from


def read_calculix(path: Path, largest: int) -> dict[str, Labelled]:
    """The matrix of a file, with the names of its rows if a .dof file lies beside it."""
    whole, value, line = read_columns(path, 2)
    if not value.size:
        raise UnreadableError("it holds no entries")
    if whole.min() < 1:
        at = int((whole < 1).any(axis=1).argmax())
        raise UnreadableError(f"line {line[at]}: rows and columns are counted from 1")
    rows, size = _rows(path), int(whole.max())
    if rows and size > len(rows):
        raise UnreadableError(f'it has {size} rows, but "{path.stem}.dof" has {len(rows)}')
    size = max(size, len(rows))
    if 8 * size > largest:
        raise MemoryError
    row, column = whole[:, 0] - 1, whole[:, 1] - 1
    return {"matrix": Labelled(symmetric_from(row, column, line, value, size, rows), rows)}


def _rows(path: Path) -> tuple[str, ...]:
    """The names of the rows in the .dof file of the job; none if there is no such file."""
    names = path.with_suffix(".dof")
    if not names.is_file():
        return ()
    return tuple(calculix_names(names.read_text("utf-8-sig").splitlines(), names.name))


def calculix_names(lines: list[str], file: str) -> list[str]:
    """Names of rows from lines of node.direction.

    >>> calculix_names(["12.1", "12.3"], "job.dof")
    ['12x', '12z']
    """
    found = []
    for number, line in enumerate(lines, 1):
        word = line.strip()
        if not word:
            continue
        node, _, direction = word.partition(".")
        if not (node.isascii() and node.isdecimal() and direction in ("1", "2", "3", "4", "5", "6")):
            raise UnreadableError(f'"{file}", line {number}: "{word[:40]}" must be node.direction, as 40.1')
        found.append(f"{int(node)}{DIRECTIONS[int(direction) - 1]}")
    return found
