"""The user's own readers for files of matrices and modes: entry points of the group ``fcm.readers``.

The name of an entry point is the ending of the files, without the dot. It refers to a function that takes the
path of a file and returns a dict of its contents by name. A matrix is an array, a scipy sparse array, or a
pair of one of these and the names of its rows. The arrays of modes have the names of [modal]: dofs,
frequency, shapes. The function raises ValueError with the fault for a file that it cannot read.
"""

from __future__ import annotations

from functools import cache
from importlib.metadata import EntryPoint, entry_points
from pathlib import Path
from typing import Any

from fcm.scene.errors import kind
from fcm.scene.files import UnreadableError

GROUP = "fcm.readers"


def own_reader(ending: str) -> EntryPoint | None:
    """Installed reader of files with an ending, such as ".blade"; None if there is none."""
    return installed_readers().get(ending.lower().removeprefix(".")) if ending else None


def own_endings() -> tuple[str, ...]:
    """The endings with an installed reader, sorted."""
    return tuple(f".{name}" for name in sorted(installed_readers()))


@cache
def installed_readers() -> dict[str, EntryPoint]:
    return {one.name.lower(): one for one in entry_points(group=GROUP)}


def read_own(path: Path) -> dict[str, Any]:
    """The contents of a file by the installed reader for its ending.

    Raises
    ------
    UnreadableError
        If the reader cannot be loaded, or cannot read the file, or does not return a dict by names.
    """
    entry = own_reader(path.suffix)
    assert entry is not None
    said = f"the reader {entry.value} of {path.suffix} files"
    try:
        read = entry.load()
    except (ImportError, AttributeError) as error:
        raise UnreadableError(f"{said} cannot be loaded: {error}") from None
    try:
        found = read(path)
    except ValueError as error:
        raise UnreadableError(str(error)) from None
    except Exception as error:  # a user's program can raise anything
        raise UnreadableError(f"{said} failed: {type(error).__name__}: {error}") from None
    if not isinstance(found, dict) or not all(isinstance(name, str) for name in found):
        raise UnreadableError(f"{said} returned {kind(found)}; a dict of arrays by their names is needed")
    return found
