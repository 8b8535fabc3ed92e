"""Reads a matrix from a file, and the names of its rows if the file has them.

Formats: .npz (of scipy or numpy), .mat (MATLAB, also 7.3), .h5 (HDF5), .mtx (MatrixMarket or Abaqus), .sti
and .mas (CalculiX), .pch (Nastran DMIG), .op4 (Nastran, by pyyeti), .hb (Harwell-Boeing; .matrix of Ansys),
and those of the user's own readers, see `fcm.scene.readers`.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import scipy.sparse

from fcm.model.scene import FloatArray
from fcm.scene.errors import choices, quoted
from fcm.scene.files import DataFileError, Files, UnreadableError
from fcm.scene.formats.abaqus import is_abaqus, read_abaqus
from fcm.scene.formats.calculix import read_calculix
from fcm.scene.formats.dmig import read_dmig
from fcm.scene.formats.harwell_boeing import read_harwell_boeing
from fcm.scene.formats.labelled import Labelled
from fcm.scene.matrix_market import read_matrix_market
from fcm.scene.npz_file import Arrays, read_npz
from fcm.scene.reader_process import NAMES, read_apart
from fcm.scene.readers import own_endings, own_reader, read_own

Reader = Callable[[Path, str, Files], dict[str, Labelled]]
ENDINGS = (
    *(".npz", ".mat", ".h5", ".hdf5", ".mtx", ".sti", ".mas", ".pch", ".op4"),
    *(".hb", ".rsa", ".rua", ".matrix"),
)


REWRITTEN = {  # endings of files that numpy can convert to one of these formats
    ".npy": "; numpy.savez('{0}.npz', numpy.load('{1}')) writes one",
    ".csv": "; numpy.savez('{0}.npz', numpy.loadtxt('{1}', delimiter=',')) writes one",
    **dict.fromkeys((".txt", ".dat"), "; numpy.savez('{0}.npz', numpy.loadtxt('{1}')) writes one"),
}


def read_matrix(name: str, files: Files) -> Labelled:
    """The matrix of a file as a scipy sparse array; "model.mat:K" selects the matrix K of the file."""
    path, chosen = split_name(name)
    ending = Path(path).suffix.lower()
    if ending not in ENDINGS and own_reader(ending) is None:
        endings = ", ".join((*ENDINGS, *own_endings()))
        hint = REWRITTEN.get(ending, "").format(Path(path).stem, path)
        raise DataFileError(f"{quoted(path)} cannot be read: such a file is {endings}{hint}")
    if ending == ".op4":  # pyyeti returns names in lower case
        chosen = chosen.lower()
    if ending == ".pch":  # Nastran's names are upper case
        chosen = chosen.upper()
    with files.opened(path) as where:
        found = _READERS.get(ending, _from_own)(where, chosen, files)
        which = _chosen({name: one.matrix for name, one in found.items()}, chosen, path)
        return Labelled(_matrix(found[which].matrix, path, files), found[which].rows)


def read_vector(name: str, files: Files) -> FloatArray:
    """The numbers of a file with a single row or column."""
    matrix = read_matrix(name, files).matrix
    if min(matrix.shape) != 1:
        raise DataFileError(f"{quoted(name)} holds a matrix; one row or column is needed")
    return np.asarray(matrix.toarray().ravel(), dtype=np.float64)


def is_matrix_file(name: str) -> bool:
    """Whether a string names a file of a matrix, by its ending.

    >>> is_matrix_file("C.mtx"), is_matrix_file("model.mat:C"), is_matrix_file("high")
    (True, True, False)
    """
    ending = Path(split_name(name)[0]).suffix.lower()
    return ending in ENDINGS or own_reader(ending) is not None


def split_name(name: str) -> tuple[str, str]:
    """The file, and the name of the matrix in it; empty if none is given.

    >>> split_name("model.mat:K"), split_name("model.h5:blade/K"), split_name("K.mtx")
    (('model.mat', 'K'), ('model.h5', 'blade/K'), ('K.mtx', ''))
    """
    match = re.fullmatch(r"(.*\.\w+):([\w/]+)", name)
    return (match[1], match[2]) if match else (name, "")


def _from_npz(path: Path, chosen: str, files: Files) -> dict[str, Labelled]:
    """Reads all arrays of an .npz file; or the one sparse matrix saved by `scipy.sparse.save_npz`."""
    arrays = read_npz(path, None, files)
    if "format" in arrays and "shape" in arrays:
        return {"": Labelled(_from_parts(arrays))}
    return {name: Labelled(one) for name, one in arrays.items()}


def _from_parts(arrays: Arrays) -> Any:
    """A sparse matrix from its component arrays."""
    shape = tuple(int(size) for size in arrays["shape"].ravel())
    form = arrays["format"].item()
    form = form.decode() if isinstance(form, bytes) else str(form)
    if form == "coo":
        return scipy.sparse.coo_array((arrays["data"], (arrays["row"], arrays["col"])), shape=shape)
    if form == "dia":
        return scipy.sparse.dia_array((arrays["data"], arrays["offsets"]), shape=shape)
    if form not in ("csr", "csc", "bsr"):
        raise UnreadableError(f"it holds a sparse matrix of the format {quoted(form)}")
    of_format = getattr(scipy.sparse, f"{form}_array")
    matrix = of_format((arrays["data"], arrays["indices"], arrays["indptr"]), shape=shape)
    matrix.check_format(full_check=True)
    return matrix


def _from_mtx(path: Path, chosen: str, files: Files) -> dict[str, Labelled]:
    """The matrix of a MatrixMarket file, or of an Abaqus .mtx file; it has no name."""
    if is_abaqus(path):
        return read_abaqus(path, files.largest)
    return {chosen or "matrix": Labelled(read_matrix_market(path, files))}


def _of_program(read: Callable[[Path, int], dict[str, Labelled]]) -> Reader:
    """Wraps the reader of a finite-element program's files, with a limit on their size."""
    return lambda path, _chosen, files: read(path, files.largest)


def _from_others(path: Path, chosen: str, files: Files) -> dict[str, Labelled]:
    arrays = read_apart(path, [chosen] if chosen else [], files)
    sparse = [name.removesuffix(".row") for name in arrays if name.endswith(".row")]
    found: dict[str, Any] = {name: array for name, array in arrays.items() if "." not in name}
    for name in sparse:
        row, col, data, shape = (arrays[f"{name}.{part}"] for part in ("row", "col", "data", "shape"))
        found[name] = scipy.sparse.coo_array((data, (row, col)), shape=tuple(int(size) for size in shape))
    if not found and NAMES in arrays:
        what = f"no matrix {quoted(chosen)}" if chosen else "no matrix"
        held = choices(map(str, arrays[NAMES])) if arrays[NAMES].size else "nothing"
        raise DataFileError(f"{quoted(path.name)} holds {what}; it holds {held}")
    return {name: Labelled(one) for name, one in found.items()}


def _from_own(path: Path, chosen: str, files: Files) -> dict[str, Labelled]:
    """Reads matrices by an installed reader of the user."""
    every = read_own(path)
    return {name: Labelled(*_matrix_and_rows(name, one)) for name, one in every.items()}


def _chosen(found: dict[str, Any], chosen: str, path: str) -> str:
    """The name of the requested matrix; without a request, of the only matrix."""
    arrays = {name: one if scipy.sparse.issparse(one) else np.atleast_2d(one) for name, one in found.items()}
    matrices = {name: one for name, one in arrays.items() if one.ndim == 2}
    if chosen in matrices:
        return chosen
    if not matrices:
        raise DataFileError(
            f"{quoted(path)} holds no matrix; it holds {choices(found) if found else 'nothing'}"
        )
    if chosen:
        raise DataFileError(f"{quoted(path)} has no matrix {quoted(chosen)}; it has {choices(matrices)}")
    if len(matrices) > 1:
        example = quoted(f"{path}:{next(iter(matrices))}")
        raise DataFileError(f"{quoted(path)} has {choices(matrices)}; say which, as in {example}")
    return next(iter(matrices))


def _matrix(found: Any, path: str, files: Files) -> Any:
    found = found if scipy.sparse.issparse(found) else np.atleast_2d(found)
    if found.dtype.kind not in "biufc":
        raise DataFileError(f"{quoted(path)} holds a matrix of {found.dtype}, not of numbers")
    files.check_size(Path(path), 8 * max(found.shape))  # a sparse array has a number for each row or column
    wide = (
        np.complex128 if found.dtype.kind == "c" else np.float64
    )  # of half precision, or another byte order
    matrix = scipy.sparse.csc_array(found.astype(wide))
    if matrix.dtype.kind == "c":
        if count := int(np.count_nonzero(matrix.data.imag)):
            raise DataFileError(
                f"{quoted(path)} holds numbers that are not real ({count} of {matrix.nnz}); "
                "damping within a stiffness belongs in structure.damping"
            )
        matrix = matrix.real
    return matrix


_READERS: dict[str, Reader] = {
    ".npz": _from_npz,
    ".mtx": _from_mtx,
    **dict.fromkeys((".mat", ".h5", ".hdf5", ".op4"), _from_others),
    **dict.fromkeys((".sti", ".mas"), _of_program(read_calculix)),
    ".pch": _of_program(read_dmig),
    **dict.fromkeys((".hb", ".rsa", ".rua", ".matrix"), _of_program(read_harwell_boeing)),
}


def _matrix_and_rows(name: str, found: Any) -> tuple[Any, tuple[str, ...]]:
    """A matrix returned by a reader, and the names of its rows if the reader gave any."""
    matrix, rows = found if isinstance(found, tuple) and len(found) == 2 else (found, ())
    rows = tuple(map(str, rows))
    matrix = matrix if scipy.sparse.issparse(matrix) else np.asarray(matrix)
    if rows and len(rows) != matrix.shape[0]:
        raise UnreadableError(f"{quoted(name)} has {matrix.shape[0]} rows and {len(rows)} names of rows")
    return matrix, rows
