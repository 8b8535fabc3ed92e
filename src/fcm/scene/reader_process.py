"""Reads files by readers of other packages (.mat, .h5, .op4) in a separate process.

Those readers can crash the interpreter on a damaged file, and allocate any amount of memory that a file
states. So they run in a child process with a memory limit, whose failure becomes an error.
"""

from __future__ import annotations

import io
import os
import re
import subprocess
import sys
import warnings
from collections.abc import Collection
from pathlib import Path
from typing import Any

import numpy as np

import fcm
from fcm.scene.errors import quoted
from fcm.scene.files import DataFileError, Files, UnreadableError, megabytes, reason_of
from fcm.scene.mat_tags import check_tags, of_struct
from fcm.scene.npz_file import Arrays
from fcm.scene.options import FILES

REFUSED = 3  # exit code of the child when it gives the reason on standard error
NAMES = ".names"  # key of the names of all variables in a file

OP4_BESIDE = 6  # characters of a number besides its decimals, as in "1.E+00"
_OP4_FORMAT = re.compile(rb"^.{32,40}1P,?\d{1,3}E(\d{1,4})(?:\.(\d{1,4}))?", re.MULTILINE)  # of a text file

_CODE = "import sys; from fcm.scene.reader_process import child; child(sys.argv[1:])"


def read_apart(path: Path, wanted: Collection[str], files: Files) -> Arrays:
    """The wanted arrays that a file has; all its arrays of numbers if none are named.

    Names in cells or rows of characters become strings. A sparse matrix K becomes the arrays K.row, K.col,
    K.data and K.shape.
    """
    places = [str(Path(fcm.__file__).parents[1]), *filter(None, sys.path)]
    found = subprocess.run(
        [sys.executable, "-P", "-c", _CODE, str(path.resolve()), str(files.largest), *wanted],
        capture_output=True,
        env=os.environ | {"PYTHONPATH": os.pathsep.join(places), "OPENBLAS_NUM_THREADS": "1"},
        check=False,
    )
    if found.returncode == REFUSED:
        raise UnreadableError(found.stderr.decode("utf-8", "replace").strip() or "it is damaged")
    if found.returncode:
        raise UnreadableError("it is damaged: what it says of itself does not fit together")
    with np.load(io.BytesIO(found.stdout), allow_pickle=False) as archive:
        return {name: archive[name] for name in archive.files}


def child(arguments: list[str]) -> None:
    """Reads a file and writes its arrays to standard output, in a process that may crash."""
    path, largest, *wanted = arguments
    try:
        _limit_memory(FILES.copies * int(largest) + FILES.memory)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            found = _READERS[Path(path).suffix.lower()](Path(path), wanted, int(largest))
        arrays = {f"{name}{part}": array for name, one in found.items() for part, array in _parts(one)}
        if sum(array.nbytes for array in arrays.values()) > int(largest):
            raise MemoryError
        packed = io.BytesIO()
        np.savez(packed, **arrays)
        sys.stdout.buffer.write(packed.getbuffer())
    except MemoryError:
        _refuse(f"it holds more than {megabytes(int(largest))}: raise the limit by --largest-file")
    except Exception as error:
        _refuse(reason_of(error, Path(path).suffix))


def _mat(path: Path, wanted: Collection[str], largest: int) -> dict[str, Any]:
    """Reads variables of a MATLAB file."""
    from scipy.io import loadmat, whosmat

    content = path.read_bytes()
    check_tags(content, wanted, largest)
    try:
        if not wanted:
            numbers = ("double", "single", "sparse", "logical")
            wanted = [name for name, _, kind in whosmat(path) if kind in numbers or "int" in kind]
            check_tags(content, wanted, largest)
        found = loadmat(path, variable_names=list(wanted))
        all_of_it = whosmat(path)
    except NotImplementedError:  # a file of MATLAB 7.3
        return _hdf5(path, wanted, largest)
    arrays = {name: found[name] for name in wanted if name in found}
    structs = [name for name, _, kind in all_of_it if kind == "struct"]
    if structs and not arrays:
        raise UnreadableError(of_struct(structs[0]))
    return arrays | {NAMES: np.array([name for name, *_ in all_of_it], dtype=str)}


def _op4(path: Path, wanted: Collection[str], largest: int) -> dict[str, Any]:
    """Matrices of a Nastran output4 file."""
    try:
        from pyyeti.nastran import op4
    except ModuleNotFoundError as error:
        if error.name and error.name.partition(".")[0] != "pyyeti":  # a dependency of pyyeti is missing
            raise _unusable(path, error) from None
        raise DataFileError("it needs the package pyyeti: pip install pyyeti, or write it as .mtx") from None
    except Exception as error:  # for example an old pyyeti with a numpy that is too new
        raise _unusable(path, error) from None
    for match in _OP4_FORMAT.finditer(path.read_bytes()):
        if not match[2] or int(match[1]) < int(match[2]) + OP4_BESIDE:
            raise UnreadableError("it is damaged: a format of numbers is narrower than they are")
    found: dict[str, Any] = op4.load(str(path), into="dct", justmatrix=True, sparse=None)
    return found


def _hdf5(path: Path, wanted: Collection[str], largest: int) -> dict[str, Any]:
    """Reads variables of an HDF5 file."""
    from fcm.scene.formats.hdf5 import read_hdf5

    found, held = read_hdf5(path, wanted, largest)
    return found | {NAMES: np.array(held, dtype=str)}


def _unusable(path: Path, error: Exception) -> DataFileError:
    """Fault of an installed pyyeti package that cannot be imported."""
    why = str(error).partition("\n")[0]
    return DataFileError(
        f"{quoted(path.name)} needs the package pyyeti, which is installed and cannot be imported "
        f"({type(error).__name__}: {why}): mend that, or write it as .mtx"
    )


_READERS = {".mat": _mat, ".op4": _op4, ".h5": _hdf5, ".hdf5": _hdf5}


def _parts(value: Any) -> list[tuple[str, Any]]:
    """A variable as plain arrays, each with a suffix of its name; a sparse matrix becomes its COO parts."""
    if hasattr(value, "tocoo"):
        if hasattr(value, "check_format"):
            value.check_format(full_check=True)
        coo = value.tocoo()
        shape = np.array(coo.shape)
        return [(".row", coo.row), (".col", coo.col), (".data", coo.data), (".shape", shape)]
    array = np.asarray(value)
    if array.dtype.kind in "OU":
        names = [str(np.asarray(name).ravel()[0]).rstrip() if np.size(name) else "" for name in array.ravel()]
        array = np.array(names, dtype=str)
    return [("", array)]


def _refuse(why: str) -> None:
    sys.stderr.write(why)
    sys.stderr.flush()
    os._exit(REFUSED)


def _limit_memory(more: int) -> None:
    """Limits this process to a number of bytes more than it has, if the system supports such limits."""
    try:
        import resource
    except ImportError:
        return
    pages = Path("/proc/self/statm")
    present = int(pages.read_text().split()[0]) * resource.getpagesize() if pages.exists() else 0
    _, hard = resource.getrlimit(resource.RLIMIT_AS)
    limit = present + more
    if hard != resource.RLIM_INFINITY:
        limit = min(limit, hard)
    resource.setrlimit(resource.RLIMIT_AS, (limit, hard))
