"""Modes from a file: NumPy's .npz, MATLAB's .mat, universal files."""

from __future__ import annotations

from typing import Any

import numpy as np

from fcm.scene.apart import read_apart
from fcm.scene.archive import read_npz
from fcm.scene.errors import kind, quoted
from fcm.scene.files import DataFileError, Files
from fcm.scene.uff import read_uff

ARRAYS = ("mass", "frequency", "damping", "shapes")
KEYS = ("dofs", *ARRAYS)


def read_modal_file(name: str, files: Files) -> dict[str, Any]:
    """What a file of modes holds of dofs, mass, frequency, damping and shapes.

    A universal file is always in Hz: it has angular_frequency [rad/s] in place of frequency.
    """
    ending = (files.folder / name).suffix.lower()
    if ending not in (".npz", ".mat", ".uff", ".unv"):
        raise DataFileError(f"{quoted(name)} cannot be read: a file of modes is .npz, .mat, .uff, .unv")
    with files.opened(name) as path:
        if ending == ".npz":
            found: dict[str, Any] = read_npz(path, KEYS, files)
        elif ending == ".mat":
            found = {key: _without_matrix(key, value) for key, value in read_apart(path, KEYS, files).items()}
        else:
            found = read_uff(path)
        return {key: _plain(key, value) for key, value in found.items()}


def _without_matrix(key: str, array: Any) -> Any:
    """MATLAB has matrices only: a vector or a number from one."""
    if key in ("shapes", "dofs"):
        return array
    flat = array.ravel()
    return flat[0] if flat.size == 1 and key in ("mass", "damping") else flat


def _plain(key: str, value: Any) -> Any:
    """An array of numbers as it is; a single number as a float; names as a list of strings."""
    if key == "dofs":
        return [str(name) for name in np.ravel(np.asarray(value))]
    array = np.asarray(value)
    if array.dtype.kind not in "iuf":
        raise DataFileError(f"{key} must hold real numbers, is {kind(value)} of {array.dtype}")
    return float(array) if array.ndim == 0 else array.astype(np.float64)
