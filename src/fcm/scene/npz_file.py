"""Reads requested arrays of a NumPy archive (.npz), and refuses ones larger than their stated size."""

from __future__ import annotations

import zipfile
from collections.abc import Collection
from math import prod
from pathlib import Path
from typing import IO, Any

import numpy as np
import numpy.typing as npt

from fcm.scene.errors import quoted
from fcm.scene.files import DataFileError, Files, UnreadableError

Arrays = dict[str, npt.NDArray[Any]]


def read_npz(path: Path, wanted: Collection[str] | None, files: Files) -> Arrays:
    """The wanted arrays of an archive by name; all if none are named."""
    with path.open("rb") as file:
        if file.read(6) == b"\x93NUMPY":
            raise DataFileError(f"{quoted(path.name)} holds a single array; write it with numpy.savez")
    with zipfile.ZipFile(path) as archive:
        members = {one.filename.removesuffix(".npy"): one for one in archive.infolist()}
        chosen = {name: one for name, one in members.items() if wanted is None or name in wanted}
        files.check_size(path, sum(one.file_size for one in chosen.values()))
        if len(members) < len(archive.infolist()):
            raise UnreadableError("it has two arrays of one name")
        found = {}
        for name, one in members.items():
            with archive.open(one) as stream:  # which fails where the list of names is not that of the arrays
                if name in chosen:
                    found[name] = _array(stream, one.file_size)
        return found


def names_in_npz(path: Path) -> list[str]:
    """The names of all arrays of an archive."""
    with zipfile.ZipFile(path) as archive:
        return [name.removesuffix(".npy") for name in archive.namelist()]


def _array(stream: IO[bytes], size: int) -> npt.NDArray[Any]:
    """An array, whose header must agree with the number of bytes."""
    version = np.lib.format.read_magic(stream)
    header = np.lib.format.read_array_header_1_0 if version == (1, 0) else np.lib.format.read_array_header_2_0
    shape, by_column, kind = header(stream)
    if kind.hasobject:
        raise UnreadableError(
            "Object arrays cannot be loaded: they are pickles; write dofs as an array of strings"
        )
    if prod(shape) * kind.itemsize > size:
        raise UnreadableError("its arrays are larger than the file")
    values = np.frombuffer(stream.read(), dtype=kind, count=prod(shape))
    return values.reshape(shape, order="F" if by_column else "C").copy()
