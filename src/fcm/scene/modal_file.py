"""Modes from a file: NumPy's .npz, MATLAB's .mat, universal files."""

from __future__ import annotations

import warnings
from pathlib import Path
from typing import Any

import numpy as np

from fcm.scene.errors import kind, quoted
from fcm.scene.uff import read_uff

LONGEST_PATH = 400  # characters of a path shown in a message
ARRAYS = ("mass", "frequency", "damping", "shapes")


class ModalFileError(ValueError):
    """A file of modes that cannot be read."""


def read_modal_file(path: Path) -> dict[str, Any]:
    """What a file of modes holds of dofs, mass, frequency, damping and shapes.

    A universal file is always in Hz: it has angular_frequency [rad/s] in place of frequency.
    """
    reader = _READERS.get(path.suffix.lower())
    if reader is None:
        known = ", ".join(_READERS)
        raise ModalFileError(f"{quoted(path.name)} cannot be read: a file of modes is {known}")
    try:
        if not path.is_file():
            raise ModalFileError(
                f"{quoted(str(path), LONGEST_PATH)} is {'a folder' if path.is_dir() else 'not there'}"
            )
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            found = reader(path)
    except ModalFileError:
        raise
    except Exception as error:  # whatever a damaged file does to its reader, the file is at fault
        reason = str(error).partition("\n")[0] or type(error).__name__
        raise ModalFileError(f"{quoted(str(path), LONGEST_PATH)} cannot be read: {reason[:200]}") from None
    return {key: _plain(key, value) for key, value in found.items()}


def _read_npz(path: Path) -> dict[str, Any]:
    with path.open("rb") as file, np.load(file, allow_pickle=False) as archive:
        if not hasattr(archive, "files"):
            raise ModalFileError(f"{quoted(path.name)} holds a single array; write it with numpy.savez")
        return {key: archive[key] for key in ("dofs", *ARRAYS) if key in archive.files}


def _read_mat(path: Path) -> dict[str, Any]:
    from scipy.io import loadmat

    try:
        found = loadmat(path, variable_names=["dofs", *ARRAYS])
    except NotImplementedError:
        raise ModalFileError(f"{quoted(path.name)} is of MATLAB's version 7.3; save it with -v7") from None
    return {key: _without_matrix(key, found[key]) for key in ("dofs", *ARRAYS) if key in found}


def _without_matrix(key: str, value: Any) -> Any:
    """MATLAB has matrices only: a vector, a number, or a cell of strings from one."""
    array = np.asarray(value)
    if key == "shapes":
        return array
    flat = array.ravel()
    if key == "dofs":
        return [str(np.asarray(name).ravel()[0]).rstrip() if np.size(name) else "" for name in flat]
    return flat[0] if flat.size == 1 and key in ("mass", "damping") else flat


def _plain(key: str, value: Any) -> Any:
    """An array of numbers as it is; a single number as a float; names as a list of strings."""
    if key == "dofs":
        return [str(name) for name in np.ravel(np.asarray(value))]
    array = np.asarray(value)
    if array.dtype.kind not in "iuf":
        raise ModalFileError(f"{key} must hold real numbers, is {kind(value)} of {array.dtype}")
    return float(array) if array.ndim == 0 else array.astype(np.float64)


_READERS = {".npz": _read_npz, ".mat": _read_mat, ".uff": read_uff, ".unv": read_uff}
