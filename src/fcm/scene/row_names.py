"""The names of the rows of matrices: in the scene, or in a file with one on each line."""

from __future__ import annotations

from pathlib import Path

from fcm.scene.files import DataFileError, Files
from fcm.scene.names import Names, RowNames, checked_names
from fcm.scene.section import Section


def row_names(section: Section, files: Files, rows: int | None) -> Names | None:
    """The names of the rows: a list, or a file with one on each line."""
    value = section.data.get("dofs", section.data.get("file"))
    if "dofs" in section.data and "file" in section.data:
        section.wrong("", "has both dofs and file; give the names of the rows once")
        return None
    if value is None:
        section.wrong("dofs", 'missing; give a list of the names of the rows, or a file such as "dofs.txt"')
        return None
    if isinstance(value, str):
        key = "dofs" if "dofs" in section.data else "file"
        try:
            with files.opened(value) as path:
                value = names_of(_text(path))
        except DataFileError as error:
            for fault in error.faults:
                section.wrong(key, fault)
            return None
    names = checked_names(section, value)
    if names is not None and rows is not None and len(names) != rows:
        section.wrong("dofs", f"names {len(names)} rows, but the stiffness has {rows}")
    return None if names is None else RowNames(names)


def _text(path: Path) -> str:
    try:
        return path.read_text("utf-8-sig")
    except UnicodeDecodeError:
        raise ValueError("it is no text in UTF-8; save it as that") from None


def names_of(text: str) -> list[str]:
    """Names, one on each line; a node and a direction beside each other are one name.

    ValueError where there are more words on a line.

    >>> names_of("40x  # tip\\n40 y\\n\\n41:3\\n41 1")
    ['40x', '40y', '41:3', '41:1']
    """
    lines = [line.partition("#")[0].replace(",", " ").split() for line in text.splitlines()]
    for number, words in enumerate(lines, 1):
        if len(words) > 2:
            raise ValueError(
                f"line {number} has {len(words)} words: write one name on each line, "
                "or a node and a direction"
            )
    return [(":" if words[-1].isdecimal() else "").join(words) for words in lines if words]
