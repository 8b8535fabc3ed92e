"""Reads a matrix from a MatrixMarket file (.mtx), and refuses files that break the format in any word.

The first line names the layout (coordinate, array), the field (real, integer, complex, pattern) and the
symmetry. Comments, the sizes, and one entry on each line follow. A symmetric, skew-symmetric or hermitian
matrix is given by its lower triangle alone. The format does not define repeated entries, so a file with one
is refused.
Source: R. F. Boisvert, R. Pozo, K. A. Remington, The Matrix Market Exchange Formats: Initial Design,
NISTIR 5935 (1996).
"""

from __future__ import annotations

import re
import warnings
from collections.abc import Callable, Iterator
from itertools import islice
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt
import scipy.sparse

from fcm.scene.errors import choices, counted, quoted
from fcm.scene.files import DataFileError, Files
from fcm.scene.number_text import fault_of_number, number_in
from fcm.scene.options import MESSAGES

LAYOUTS = ("coordinate", "array")
FIELDS = {"real": 1, "double": 1, "integer": 1, "unsigned-integer": 1, "complex": 2}  # numbers of an entry
SYMMETRIES = ("general", "symmetric", "skew-symmetric", "hermitian")
_WHOLE = re.compile(r"[-+]?\d+", re.ASCII)
_INDEX = re.compile(r"[-+]?\d{1,18}", re.ASCII)  # at most as many digits as fit into 64 bits

Entries = npt.NDArray[Any]  # structured: row and column from 1, for layout coordinate, and parts of the value
Line = tuple[int, str]  # number in the file, from 1, and text


class _Head(NamedTuple):
    """Header of a file: its format, its sizes, and the number of the line with the sizes."""

    layout: str
    field: str
    symmetry: str
    rows: int
    columns: int
    entries: int
    line: int

    @property
    def indices(self) -> int:
        """Number of indices on the line of an entry: row and column, or none for layout array."""
        return 2 if self.layout == "coordinate" else 0

    @property
    def words(self) -> int:
        """Number of words on the line of an entry."""
        return self.indices + FIELDS[self.field]

    @property
    def of_integers(self) -> bool:
        return "integer" in self.field

    def kind(self, value: type) -> npt.DTypeLike:
        """numpy type of an entry whose values have a given type."""
        names = (("row", np.int64), ("column", np.int64))[: self.indices]
        return [*names, *((f"value{i}", value) for i in range(FIELDS[self.field]))]


def read_matrix_market(path: Path, files: Files) -> Any:
    """The matrix of a file as a scipy sparse array, both triangles of a symmetric one.

    Exponents may be written with a D, and the file may begin with a byte-order mark.

    Raises
    ------
    DataFileError
        If the file breaks the format; the message says in which line, what is wrong, and what would be
        right. Mistakes: a word that is not a number of the field, too few or too many words in a line, an
        index out of range, an entry above the diagonal of a symmetric matrix, a repeated entry, or another
        number of entries than the sizes say.
    """
    with path.open("rb") as file:
        if file.read(2) in (b"\xff\xfe", b"\xfe\xff"):
            raise _refused(path, ["it is text in UTF-16: save it as UTF-8"])
    head = _head(path)
    files.check_size(path, 8 * max(head.rows, head.columns))
    found = _numbers(path, head)
    if faults := [*_outside(found, head), *_across(found, head)]:
        numbers = _lines_of(path, head, [entry for entry, _ in faults[: MESSAGES.faults]])
        said = [f"line {number}: {fault}" for number, (_, fault) in zip(numbers, faults, strict=False)]
        raise _refused(path, said, len(faults))
    parts = [found[f"value{i}"] for i in range(FIELDS[head.field])]
    value = parts[0].astype(np.float64) if len(parts) == 1 else parts[0] + 1j * parts[1]
    row, column = (found["row"] - 1, found["column"] - 1) if head.indices else _places(head)
    matrix = scipy.sparse.csc_array(
        scipy.sparse.coo_array((value, (row, column)), shape=(head.rows, head.columns))
    )
    if matrix.nnz < value.size:
        raise _refused(path, *_repeated(path, head, row, column))
    return _completed(matrix, head.symmetry)


def _refused(path: Path, faults: list[str], count: int = 0) -> DataFileError:
    more = count - len(faults)
    rest = [f"{quoted(path.name)}: {counted(more, 'more such line')}"] if more > 0 else []
    return DataFileError(*(f"{quoted(path.name)}, {fault}" for fault in faults), *rest)


def _lines(path: Path) -> Iterator[Line]:
    """Yields the lines of a file with their numbers."""
    with path.open(encoding="utf-8-sig", errors="replace") as file:
        yield from enumerate(file, 1)


def _head(path: Path) -> _Head:
    """The header, from the first line and the line with the sizes."""
    lines = _lines(path)
    _, first = next(lines, (1, ""))
    wanted = '"%%MatrixMarket matrix coordinate real symmetric"'
    words = first.lower().split()
    if words[:2] != ["%%matrixmarket", "matrix"] or len(words) != 5:
        raise _refused(path, [f"line 1: must be such as {wanted}, is {quoted(first.strip())}"])
    _, _, layout, field, symmetry = words
    if field == "pattern":
        raise _refused(path, ["line 1: it is a pattern: places of entries without their values"])
    right = ((layout, LAYOUTS), (field, tuple(FIELDS)), (symmetry, SYMMETRIES))
    if faults := [f"line 1: {quoted(w)} is none of {choices(known)}" for w, known in right if w not in known]:
        raise _refused(path, faults)
    if symmetry == "hermitian" and field != "complex":
        raise _refused(path, [f"line 1: a {field} matrix cannot be hermitian: write symmetric"])
    for number, line in lines:
        if line.strip() and not line.startswith("%"):
            return _Head(layout, field, symmetry, *_sizes(path, number, line, layout, symmetry), number)
    raise _refused(path, ["it is cut off: there is no line of sizes"])


def _sizes(path: Path, number: int, line: str, layout: str, symmetry: str) -> tuple[int, int, int]:
    """Rows, columns and how many entries there are to be."""
    words, coordinate = line.split(), layout == "coordinate"
    right = "rows, columns and entries" if coordinate else "rows and columns"
    if len(words) != (3 if coordinate else 2) or not all(
        w[0].isdecimal() and _INDEX.fullmatch(w) for w in words
    ):
        raise _refused(
            path, [f"line {number}: must be the whole numbers of {right}, is {quoted(line.strip())}"]
        )
    rows, columns, *entries = map(int, words)
    if symmetry != "general" and rows != columns:
        raise _refused(path, [f"line {number}: a {symmetry} matrix of {rows} rows has {columns} columns"])
    if coordinate:
        return rows, columns, entries[0]
    triangle = {"general": rows * columns, "skew-symmetric": rows * (rows - 1) // 2}
    return rows, columns, triangle.get(symmetry, rows * (rows + 1) // 2)


def _body(path: Path, head: _Head) -> Iterator[Line]:
    """The lines of entries: all lines after the sizes that are not blank."""
    return ((n, line) for n, line in islice(_lines(path), head.line, None) if line.strip())


def _lines_of(path: Path, head: _Head, entries: list[int]) -> list[int]:
    """The numbers of the lines of entries."""
    wanted = set(entries)
    found = {entry: number for entry, (number, _) in enumerate(_body(path, head)) if entry in wanted}
    return [found[entry] for entry in entries]


def _numbers(path: Path, head: _Head) -> Entries:
    """The entries; their number and each word are checked."""
    text = (line.replace("D", "E").replace("d", "e") for _, line in _body(path, head))
    kind = head.kind(np.int64 if head.of_integers else np.float64)
    with warnings.catch_warnings():
        warnings.simplefilter("error")  # numpy warns of an index with a point, and of no entries
        try:
            found = np.loadtxt(text, dtype=kind, comments=None, ndmin=1)
            at_once = all(np.isfinite(found[name]).all() for name in found.dtype.names or ())
        except (ValueError, Warning):
            at_once = False  # `_one_by_one` finds the wrong words
    if not at_once:
        found = _one_by_one(path, head)
    if found.size != head.entries:
        what = "it is cut off, or the count is wrong" if found.size < head.entries else "the count is wrong"
        said = f"line {head.line}: there are to be {head.entries} entries, and there are {found.size}"
        raise _refused(path, [f"{said}: {what}"])
    return found


def _one_by_one(path: Path, head: _Head) -> Entries:
    """Reads the entries line by line, slower than `_numbers`, and reports what is wrong."""
    found: list[tuple[float, ...]] = []
    faults: list[str] = []
    count = 0
    for number, line in _body(path, head):
        entry = _entry(line.split(), head)
        if isinstance(entry, tuple):
            found.append(entry)
            continue
        count += 1
        if len(faults) < MESSAGES.faults:
            faults.append(f"line {number}: {entry}")
    if faults:
        raise _refused(path, faults, count)
    return np.array(found, dtype=head.kind(np.float64))


def _entry(words: list[str], head: _Head) -> tuple[float, ...] | str:
    """The numbers of one line, or what is wrong with it."""
    if len(words) != head.words:
        of = "row, column and value" if head.indices else "a value"
        if FIELDS[head.field] == 2:
            of = f"{'row, column and ' if head.indices else ''}the real and the imaginary part"
        return f"must be {of}, is {quoted(' '.join(words))}"
    for word in words[: head.indices]:
        if not _INDEX.fullmatch(word):
            return f"a row and a column are whole numbers, is {quoted(' '.join(words))}"
    values = words[head.indices :]
    for word in values:
        if head.of_integers and not _WHOLE.fullmatch(word):
            return f"{quoted(word)} is not a whole number, as line 1 says: write real there"
    numbers = [number_in(word) for word in values]
    wrong = [fault_of_number(w) for w, value in zip(values, numbers, strict=True) if value is None]
    if wrong:
        return "; ".join(wrong)
    return (*map(int, words[: head.indices]), *(value for value in numbers if value is not None))


def _outside(found: Entries, head: _Head) -> list[tuple[int, str]]:
    """Entries whose row or column is out of range, each with the fault."""
    if not head.indices:
        return []
    row, column = found["row"], found["column"]
    wrong = (row < 1) | (row > head.rows) | (column < 1) | (column > head.columns)
    said = f"is not within the {head.rows} rows and {head.columns} columns, counted from 1"
    return [(int(k), f"entry ({row[k]}, {column[k]}) {said}") for k in np.flatnonzero(wrong)]


def _across(found: Entries, head: _Head) -> list[tuple[int, str]]:
    """Entries of a matrix with a symmetry that are not in the lower triangle, each with fault and remedy."""
    if not head.indices or head.symmetry == "general":
        return []
    row, column = found["row"], found["column"]
    skew = head.symmetry == "skew-symmetric"
    wrong = (row <= column) if skew else (row < column)
    where = "is not below the diagonal" if skew else "is above the diagonal"
    said = f"{where}; of a {head.symmetry} matrix the lower triangle alone is given"
    at = np.flatnonzero(wrong)
    mirrored = row[at] + column[at] * (head.rows + 1)
    twice = np.isin(mirrored, (column + row * (head.rows + 1))[~wrong]) | (row[at] == column[at]) | skew
    return [
        (
            int(k),
            f"entry ({row[k]}, {column[k]}) {said}: "
            + (
                "leave it out, or write general in line 1" if both else f"write it as ({column[k]}, {row[k]})"
            ),
        )
        for k, both in zip(at, twice.tolist(), strict=True)
    ]


def _repeated(path: Path, head: _Head, row: Any, column: Any) -> tuple[list[str], int]:
    """Sentences on repeated entries, with both lines; and the number of repeated entries."""
    order = np.lexsort((column, row))
    same = np.flatnonzero((np.diff(row[order]) == 0) & (np.diff(column[order]) == 0))
    shown = same[: MESSAGES.faults]
    pairs = [int(order[k + i]) for k in shown for i in (0, 1)]
    numbers = _lines_of(path, head, pairs)
    said = [
        f"line {numbers[2 * n + 1]}: entry ({row[at] + 1}, {column[at] + 1}) is there already, in line "
        f"{numbers[2 * n]}; each must be there once: write their sum, or leave one out"
        for n, at in enumerate(pairs[::2])
    ]
    return said, int(same.size)


def _places(head: _Head) -> tuple[Any, Any]:
    """The rows and columns of the entries of layout array, which are listed column by column."""
    below = {"general": lambda i, j: i >= 0, "skew-symmetric": lambda i, j: i > j}
    kept: Callable[[Any, Any], Any] = below.get(head.symmetry, lambda i, j: i >= j)
    column, row = np.indices((head.columns, head.rows)).reshape(2, -1)
    there = kept(row, column)
    return row[there], column[there]


def _completed(matrix: Any, symmetry: str) -> Any:
    """The matrix with both triangles, the upper one by symmetry."""
    if symmetry == "general":
        return matrix
    below = scipy.sparse.tril(matrix, -1, format="csc")
    sign = -1.0 if symmetry == "skew-symmetric" else 1.0
    return scipy.sparse.csc_array(matrix + sign * (below.T.conj() if symmetry == "hermitian" else below.T))
