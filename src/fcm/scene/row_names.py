"""Reads the names of the rows of matrices, from the scene or from a file with one on each line."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import scipy.sparse

from fcm.scene.errors import choices, quoted
from fcm.scene.files import DataFileError, Files, UnreadableError
from fcm.scene.formats.calculix import calculix_names
from fcm.scene.formats.harwell_boeing import ansys_names
from fcm.scene.formats.labelled import Labelled
from fcm.scene.names import Names, RowNames, RowNamesOfFiles, checked_names
from fcm.scene.section import Section

_DIRECTION = re.compile(r"r?[xyz]|[1-6]", re.IGNORECASE)  # direction of a node


def row_names(section: Section, files: Files, labels: Sequence[str]) -> Names | None:
    """The row names, from a list, a file, or else the matrices' files (labels); None after a mistake."""
    value = section.data.get("dofs", section.data.get("file"))
    if "dofs" in section.data and "file" in section.data:
        section.wrong("", "has both dofs and file; give the names of the rows once")
        return None
    if value is None and labels:
        return RowNamesOfFiles(labels)
    if value is None:
        section.wrong("dofs", 'missing; give a list of the names of the rows, or a file such as "dofs.txt"')
        return None
    if isinstance(value, str):
        key = "dofs" if "dofs" in section.data else "file"
        try:
            with files.opened(value) as path:
                value = names_of_file(path)
        except DataFileError as error:
            for fault in error.faults:
                section.wrong(key, fault)
            return None
    names = checked_names(section, value)
    if names is None:
        return None
    found = RowNames(names)
    if "file" in section.data:
        found.key = "those of structure.file"
    missing = [one for one in found if labels and RowNames(labels).find(one) == ""]
    if missing:
        section.wrong(
            "dofs",
            f"{choices(missing)} {'is' if len(missing) == 1 else 'are'} no row of the matrices; "
            "their files name the node and direction of each, so dofs can be left out",
        )
        return None
    return found


def labels_of(matrices: Iterable[Labelled | None]) -> tuple[str, ...]:
    """The row names in the files of some matrices, each once, those of the first matrix first."""
    return tuple(dict.fromkeys(name for one in matrices if one is not None for name in one.rows))


def in_order(section: Section, key: str, given: Labelled | None, dofs: Names | None) -> Any:
    """A matrix with its rows reordered to those of the structure; unchanged if its file names no rows.

    Rows that the file lacks are zero, since programs omit rows without mass. None after a mistake, which is
    also a matrix without names if the order of the rows is that of another file.
    """
    if given is not None and not given.rows and isinstance(dofs, RowNamesOfFiles):
        section.wrong(key, f"its rows have no names, as other matrices have; give {dofs.key} in its order")
        return None
    if given is None or not given.rows or dofs is None:
        return None if given is None else given.matrix
    names = [dofs.find(one) for one in given.rows]
    unknown = [one for one, name in zip(given.rows, names, strict=True) if not name]
    if unknown:
        section.wrong(key, f"has rows that dofs does not name: {choices(unknown)}")
        return None
    place = np.array([dofs.place[name] for name in names])
    entries = given.matrix.tocoo()
    row, column = entries.coords
    shape = (len(dofs), len(dofs))
    return scipy.sparse.csc_array((entries.data, (place[row], place[column])), shape=shape)


def names_of_file(path: Path) -> list[str]:
    """The names of rows in a text file, also one of CalculiX (.dof) or Ansys (.mapping)."""
    text = _text(path)
    lines = text.splitlines()
    if path.suffix.lower() == ".dof":
        return calculix_names(lines, path.name)
    return ansys_names(lines) if path.suffix.lower() == ".mapping" else names_of(text)


def _text(path: Path) -> str:
    try:
        return path.read_text("utf-8-sig")
    except UnicodeDecodeError:
        raise UnreadableError("it is no text in UTF-8; save it as that") from None


def names_of(text: str) -> list[str]:
    """Names, one on each line; a node and a direction on one line form a name.

    Any other line raises UnreadableError.

    >>> names_of("40x  # tip\\n40 y\\n\\n41:3\\n41 1")
    ['40x', '40y', '41:3', '41:1']
    """
    lines = [line.partition("#")[0].replace(",", " ").split() for line in text.splitlines()]
    for number, words in enumerate(lines, 1):
        if len(words) > 2:
            raise UnreadableError(
                f"line {number} has {len(words)} words: write one name on each line, "
                "or a node and a direction"
            )
        if len(words) == 2 and not _DIRECTION.fullmatch(words[1]):
            what = f"{quoted(words[1])} is no direction (x, y, z, rx, ry, rz, or 1 to 6)"
            raise UnreadableError(
                f"line {number}: {what}: write one name on each line, or a node and a direction"
            )
    return [(":" if words[-1].isdecimal() else "").join(words) for words in lines if words]
