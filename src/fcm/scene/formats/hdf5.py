"""Reads matrices from HDF5 files of MATLAB 7.3 (.mat) and of any program (.h5, .hdf5), by h5py.

A dataset of two dimensions is a matrix; MATLAB stores its transpose. A group with data, indices and indptr
(or MATLAB's data, ir and jc) is a sparse matrix. The name of a matrix is its path in the file, such as
group/K.
"""

from __future__ import annotations

from collections.abc import Collection
from pathlib import Path
from typing import Any

import numpy as np
import scipy.sparse

from fcm.scene.errors import quoted
from fcm.scene.files import UnreadableError

FLOATS = tuple(f"IEEE_F{bits}{order}" for bits in (16, 32, 64) for order in ("LE", "BE"))
MATLAB = ("data", "ir", "jc")
SCIPY = ("data", "indices", "indptr")


def read_hdf5(path: Path, wanted: Collection[str], largest: int) -> tuple[dict[str, Any], list[str]]:
    """The wanted variables, or all with numbers if none are named; and the names of all variables.

    A variable is an array, a sparse matrix, or an array of strings.
    """
    try:
        import h5py
    except ModuleNotFoundError:
        raise UnreadableError("it needs the package h5py: pip install h5py, or write it as .npz") from None
    with h5py.File(path, "r") as file:
        matlab = bool(file.userblock_size)  # MATLAB writes its header there
        places: dict[str, Any] = {}
        file.visititems(lambda name, one: places.update({name: one}))
        held = {name: one for name, one in places.items() if _is_variable(name, places)}
        chosen = {name: held[name] for name in wanted if name in held} if wanted else {
            name: one for name, one in held.items() if _is_sparse(one) or one.dtype.kind in "biuf"
        }  # fmt: skip
        if sum(_bytes(one) for one in chosen.values()) > largest:
            raise MemoryError
        return {name: _variable(file, one, matlab) for name, one in chosen.items()}, list(held)


def _is_sparse(one: Any) -> bool:
    return hasattr(one, "keys") and _parts(one) is not None


def _is_variable(name: str, places: dict[str, Any]) -> bool:
    """Whether a name is that of an array or a sparse matrix, and not of a component of one."""
    if name.startswith("#"):  # MATLAB stores the contents of cells there
        return False
    one, parent = places[name], places.get(name.rpartition("/")[0])
    if hasattr(one, "keys"):
        return _is_sparse(one)
    return not (parent is not None and _is_sparse(parent)) and hasattr(one, "ndim")


def _parts(group: Any) -> tuple[str, str, str] | None:
    return next((names for names in (MATLAB, SCIPY) if all(name in group for name in names)), None)


def _bytes(one: Any) -> int:
    parts = one.values() if hasattr(one, "keys") else [one]
    return sum(int(part.size) * 8 for part in parts if hasattr(part, "size"))


def _values(one: Any) -> Any:
    """Reads the array of a dataset.

    Numbers in an unusual format raise UnreadableError. The library would convert them, so that a damaged file
    could be read as other numbers.
    """
    from h5py import h5t

    kind, form = one.dtype.kind, one.id.get_type()
    if kind == "f" and not any(form.equal(getattr(h5t, name)) for name in FLOATS):
        raise UnreadableError(
            f"{quoted(one.name.lstrip('/'))} holds numbers that are no IEEE ones of 16 to 64 bits"
        )
    if kind in "iu" and (form.get_precision() != 8 * form.get_size() or form.get_offset()):
        raise UnreadableError(f"{quoted(one.name.lstrip('/'))} holds whole numbers of a part of their bytes")
    return np.asarray(one[()])


def _variable(file: Any, one: Any, matlab: bool) -> Any:
    if _is_sparse(one):
        return _sparse(one)
    array = _values(one)
    if array.dtype.kind == "O":  # references of a cell, or strings
        return np.array([_text(file, item) for item in array.T.ravel()], dtype=str)
    if matlab and one.attrs.get("MATLAB_class") == b"char":
        rows = array.T.reshape(array.shape[::-1] if array.ndim == 2 else (1, -1))
        return np.array(["".join(map(chr, row)).rstrip() for row in rows], dtype=str)
    return array.T if matlab else array


def _text(file: Any, item: Any) -> str:
    """A string, given directly or by a reference to its characters."""
    if isinstance(item, bytes | str):
        return item.decode("utf-8") if isinstance(item, bytes) else item
    return "".join(map(chr, np.asarray(file[item][()]).T.ravel()))


def _sparse(one: Any) -> Any:
    names = _parts(one)
    assert names is not None
    data, indices, pointer = (_values(one[name]) for name in names)
    size = len(pointer) - 1
    if names == MATLAB:
        shape, by_row = (int(one.attrs.get("MATLAB_sparse", size)), size), False
    else:
        form = one.attrs.get("format", one.attrs.get("encoding-type", "csr"))
        by_row = (form.decode() if isinstance(form, bytes) else str(form)).startswith("csr")
        given = one.attrs.get("shape", one["shape"][()] if "shape" in one else (size, size))
        shape = (int(given[0]), int(given[1]))
    matrix = (scipy.sparse.csr_array if by_row else scipy.sparse.csc_array)(
        (data, indices, pointer), shape=shape
    )
    matrix.check_format(full_check=True)
    return matrix
