"""Reads text matrices of Abaqus, `*MATRIX OUTPUT` (job_STIF2.mtx): node, direction, node, direction, value.

Source: Abaqus Keywords Reference Guide, *MATRIX INPUT: of a symmetric matrix either triangle, or both with
equal entries.
"""

from __future__ import annotations

from pathlib import Path

from fcm.scene.files import UnreadableError
from fcm.scene.formats.columns import MARK, read_columns
from fcm.scene.formats.labelled import Labelled, labelled_from

PLACES = 4  # number of whole numbers on a line: node and direction of the row and of the column


def is_abaqus(path: Path) -> bool:
    """Whether the first line that is not a comment has entries separated by commas.

    MatrixMarket files, which have the same ending, begin with %%MatrixMarket.
    """
    with path.open("rb") as file:
        for line in file:
            text = line.removeprefix(MARK).strip()
            if text and not text.startswith(b"**"):
                return text.count(b",") > 1 and not text.startswith(b"%")
    return False


def read_abaqus(path: Path, largest: int) -> dict[str, Labelled]:
    """The symmetric matrix of a file, with the names of its rows."""
    whole, value, line = read_columns(path, PLACES, ",")
    if whole.shape[0] * 8 > largest:
        raise MemoryError
    wrong = (whole[:, 1::2] < 1).any(axis=1)
    if wrong.any():
        raise UnreadableError(f"line {line[int(wrong.argmax())]}: directions are counted from 1")
    return {"matrix": labelled_from(whole[:, 0::2], whole[:, 1::2], line, value)}
