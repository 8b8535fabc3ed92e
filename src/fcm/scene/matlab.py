"""Arrays of a MATLAB file (.mat), read by a process of its own.

scipy's reader can crash the interpreter on a damaged file, and unpacks whatever a file says it holds. So the
file's tags are checked first, and the reader runs in a child with a limit on its memory: whatever becomes of
it, here there are arrays or an error.
"""

from __future__ import annotations

import io
import os
import subprocess
import sys
import warnings
from collections.abc import Collection
from pathlib import Path
from typing import Any

import numpy as np

import fcm
from fcm.scene.archive import Arrays
from fcm.scene.errors import quoted
from fcm.scene.files import DataFileError, Files, megabytes
from fcm.scene.matlab_tags import check_tags

SPARE = 500_000_000  # bytes of memory for the reader itself
COPIES = 3  # of the arrays, while they are read, converted and written
REFUSED = 3  # exit code of the child when it says why

_CODE = "import sys; from fcm.scene.matlab import child; child(sys.argv[1:])"


def read_mat(path: Path, wanted: Collection[str], files: Files) -> Arrays:
    """The arrays of those names that a file has; names in cells or rows of characters become strings."""
    places = [str(Path(fcm.__file__).parents[1]), *filter(None, sys.path)]
    found = subprocess.run(
        [sys.executable, "-P", "-c", _CODE, str(path.resolve()), str(files.largest), *wanted],
        capture_output=True,
        env=os.environ | {"PYTHONPATH": os.pathsep.join(places), "OPENBLAS_NUM_THREADS": "1"},
        check=False,
    )
    if found.returncode == REFUSED:
        raise ValueError(found.stderr.decode("utf-8", "replace").strip() or "it is damaged")
    if found.returncode:
        raise ValueError("it is damaged: what it says of itself does not fit together")
    with np.load(io.BytesIO(found.stdout), allow_pickle=False) as archive:
        return {name: archive[name] for name in archive.files}


def child(arguments: list[str]) -> None:
    """Read a file and write its arrays to standard output, in a process that may die of it."""
    path, largest, *wanted = arguments
    try:
        _limit_memory(COPIES * int(largest) + SPARE)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            check_tags(Path(path).read_bytes(), wanted, int(largest))
            arrays = loaded(Path(path), wanted)
        size = sum(array.nbytes for array in arrays.values())
        if size > int(largest):
            raise ValueError(_too_large(int(largest)))
        packed = io.BytesIO()
        np.savez(packed, **arrays)  # type: ignore[arg-type]
        sys.stdout.buffer.write(packed.getbuffer())
    except MemoryError:
        _refuse(_too_large(int(largest)))
    except Exception as error:
        _refuse(str(error).partition("\n")[0] or type(error).__name__)


def loaded(path: Path, wanted: Collection[str]) -> Arrays:
    """The arrays of a file; in this process, which a damaged file can end."""
    from scipy.io import loadmat

    try:
        found = loadmat(path, variable_names=list(wanted))
    except NotImplementedError:
        raise DataFileError(f"{quoted(path.name)} is of MATLAB's version 7.3; save it with -v7") from None
    return {f"{key}{part}": array for key in wanted if key in found for part, array in _parts(found[key])}


def _parts(value: Any) -> list[tuple[str, Any]]:
    """A variable as plain arrays: a sparse matrix as the parts of one by coordinates."""
    if hasattr(value, "tocoo"):
        value.check_format(full_check=True)
        coo = value.tocoo()
        shape = np.array(coo.shape)
        return [(".row", coo.row), (".col", coo.col), (".data", coo.data), (".shape", shape)]
    array = np.asarray(value)
    if array.dtype.kind in "OU":
        names = [str(np.asarray(name).ravel()[0]).rstrip() if np.size(name) else "" for name in array.ravel()]
        array = np.array(names, dtype=str)
    return [("", array)]


def _too_large(largest: int) -> str:
    return f"it holds more than {megabytes(largest)}: raise the limit by --largest-file"


def _refuse(why: str) -> None:
    sys.stderr.write(why)
    sys.stderr.flush()
    os._exit(REFUSED)


def _limit_memory(more: int) -> None:
    """Let this process take so many bytes more than it has; where the system has no such limit, any."""
    try:
        import resource
    except ImportError:
        return
    pages = Path("/proc/self/statm")
    present = int(pages.read_text().split()[0]) * resource.getpagesize() if pages.exists() else 0
    _, hard = resource.getrlimit(resource.RLIMIT_AS)
    limit = present + more
    resource.setrlimit(
        resource.RLIMIT_AS, (limit if hard == resource.RLIM_INFINITY else min(limit, hard), hard)
    )
