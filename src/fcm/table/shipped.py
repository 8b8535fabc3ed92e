"""The shipped table with the coefficients of its splines, which opens without decoding.

Next to the netCDF file, which other programs read, is a file with the spline coefficients: 6 MB, read in 2
ms, while the netCDF file takes 60 ms. `make tables` writes both. A copy that is damaged or of another table
is not used.
"""

from __future__ import annotations

import json
import zlib
from pathlib import Path
from typing import Any

import numpy as np

from fcm.files import replacing
from fcm.table import file_checksum
from fcm.table.lookup import Coefficients, Table
from fcm.table.partial_table import TablePart

DEFAULT = Path(__file__).parent.parent / "tables" / "default.nc"
SPLINES = ".splines"  # suffix of the file
HEADER, CHECK = 4096, 8  # bytes before the numbers; bytes of these for the checksum of the others


def write(table: Table, path: Path) -> None:
    """Write the splines of the table that was opened from a path."""
    about = {
        "table": file_checksum.of(path),
        "shape": table.coefficients.shape,
        "resolution": table.resolution,
        "measured_error": table.error,
        "sum": _sum(table.coefficients),
    }
    text = json.dumps(about).encode().ljust(HEADER - CHECK)
    with replacing(path.with_suffix(SPLINES)) as partial:
        partial.write_bytes(_check(text) + text + table.coefficients.tobytes())


def read(path: Path) -> Table | None:
    """The table whose netCDF file has this path; None if its splines are missing or of another table."""
    try:
        with path.with_suffix(SPLINES).open("rb") as file:
            check, text = file.read(CHECK), file.read(HEADER - CHECK)
            if check != _check(text):
                return None
            about: dict[str, Any] = json.loads(text)
            found = np.fromfile(file, dtype=np.float32)
        if about["table"] != file_checksum.of(path) or about["sum"] != _sum(found):
            return None
    except OSError:
        return None
    part = TablePart.all_of(tuple(about["resolution"]))
    return Table.of_splines(found.reshape(about["shape"]), about["measured_error"], part)


def _check(text: bytes) -> bytes:
    return f"{zlib.crc32(text):08x}".encode()


def _sum(numbers: Coefficients) -> int:
    """Sum over the bits of all numbers, and their count: differs if a bit changes or a number is missing."""
    return int(numbers.view(np.uint32).sum(dtype=np.uint64)) + numbers.size


if __name__ == "__main__":
    from fcm.table import open_table

    write(open_table(DEFAULT), DEFAULT)
