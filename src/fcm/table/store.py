"""The table file: netCDF-4 with CF conventions, written completely or not at all, checked when read."""

from __future__ import annotations

import errno
import json
import zlib
from collections.abc import Iterable, Mapping
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

import numpy as np

import fcm
from fcm.files import NOT_THERE, no_file, real, replacing
from fcm.table import TableError, file_checksum
from fcm.table.arrays import VARIABLES, Arrays, decode, expected
from fcm.table.atlas import FloatArray
from fcm.table.partial_table import TablePart

LAYOUT = 1  # increment whenever `decode` or `atlas` changes
PART_LAYOUT = 2  # of files with a part of the nodes, which earlier versions would take for all
TITLE = "Fourier coefficients of the friction force of a contact with variable normal load"
COMMENT = (
    "Levels: the first level_open are with separation, from n0_bar = -b_bar (fully open) to n0_bar = b_bar. "
    "The others slip without separation, from n0_bar = b_bar to the slip limit. phi + pi changes the sign of "
    "F_b alone. b_bar = 1e8 stands for infinity. Between the nodes fcm interpolates F (1 + b_bar) / b_bar in "
    "separation and the slopes in slip by cubic splines. measured_error is the absolute error of that."
)
PART_COMMENT = (
    " This file has a part of the nodes, those that one scene needs. part has the first of them and one "
    "past the last, along separation (from its onset), slip, variation and phase. Elsewhere fcm uses the "
    "closed form."
)
HDF5 = b"\x89HDF\r\n\x1a\n"  # first bytes of every netCDF-4 file
REMEDY = "make it anew with fcm tabulate"


def write(
    path: str | Path, arrays: Arrays, error: Mapping[str, Any], history: str, part: TablePart | None = None
) -> None:
    """Write a table under a temporary name in the same folder, then rename it.

    Raises
    ------
    OSError
        If the file cannot be written.
    """
    target = real(path)
    if not target.parent.is_dir():
        raise FileNotFoundError(errno.ENOENT, "no such folder", str(target.parent))
    attributes = _attributes(arrays, error, history, part)
    with replacing(path) as partial:
        _write(partial, arrays, attributes)
        file_checksum.attach(partial)


def _attributes(
    arrays: Arrays, error: Mapping[str, Any], history: str, part: TablePart | None
) -> dict[str, Any]:
    if part is None:
        resolution = (arrays["ratio_b"].shape[0], *arrays["slope_b"].shape)
        part = TablePart.all_of((resolution[0], resolution[1], resolution[2], resolution[3]))
    attributes = {
        "Conventions": "CF-1.8",
        "title": TITLE,
        "institution": "unknown",
        "source": f"fcm {fcm.__version__}, closed form of the periodic solution",
        "references": "Yang, Chu and Menq (1998), Journal of Sound and Vibration 210(4), 453-481",
        "history": f"{datetime.now(UTC):%Y-%m-%dT%H:%M:%SZ} {history}",
        "comment": COMMENT,
        "layout": np.int32(LAYOUT if part.whole else PART_LAYOUT),
        "resolution": np.array(part.resolution, dtype=np.int32),
        "measured_error": json.dumps(error),
    }
    if not part.whole:
        attributes["comment"] = COMMENT + PART_COMMENT
        attributes["part"] = np.array(part[1:], dtype=np.int32).reshape(-1)
    return {**attributes, "checksum": _checksum(arrays, attributes)}


def _write(path: Path, arrays: Arrays, attributes: dict[str, Any]) -> None:
    import netCDF4

    with netCDF4.Dataset(path, "w", format="NETCDF4") as file:
        for key, (dimensions, described) in VARIABLES.items():
            if key not in arrays:
                continue
            for name, size in zip(dimensions, arrays[key].shape, strict=True):
                if name not in file.dimensions:
                    file.createDimension(name, size)
            variable = file.createVariable(key, arrays[key].dtype, dimensions, fill_value=False)
            variable.setncatts(described)
            variable[...] = arrays[key]
        file.setncatts(attributes)


def _checksum(arrays: Arrays, attributes: Mapping[str, Any]) -> str:
    """Checksum of the shapes and bytes of all arrays, and of the attributes on accuracy and resolution."""
    part = _written(attributes["part"]) if "part" in attributes else ""
    resolution = _written(attributes["resolution"])
    value = zlib.crc32(f"{attributes['measured_error']} {resolution}{part}".encode())
    for key in sorted(arrays):
        array = np.ascontiguousarray(arrays[key])
        value = zlib.crc32(
            array.tobytes(), zlib.crc32(f"{key} {array.dtype.str} {array.shape}".encode(), value)
        )
    return f"crc32:{value:08x}"


def _written(numbers: Iterable[int]) -> str:
    """Numbers as text, in the form that every table has, independent of numpy's print options."""
    return f"[{', '.join(f'np.int32({int(number)})' for number in numbers)}]"


def load(path: str | Path) -> tuple[FloatArray, FloatArray, dict[str, Any], TablePart]:
    """The reduced coefficients of the two charts, the recorded error, and the nodes of the file.

    Raises
    ------
    TableError
        If the file is missing, is not a table, is of another layout, or is damaged.
    """
    name = Path(path)
    if what := no_file(name):
        raise TableError(f"{name}: {'no such file' if what == NOT_THERE else what}")
    try:
        content = file_checksum.check(name)
        if content is None:
            raise TableError(f"{name}: {_unsealed(name)}")
        attributes, arrays = _read(name, content)
    except (TableError, MemoryError, ImportError):
        raise
    except file_checksum.BrokenSealError as reason:
        raise TableError(f"{name}: damaged, {reason}; {REMEDY}") from None
    except Exception as reason:
        if getattr(reason, "errno", 0) == errno.ENOMEM:
            raise MemoryError(str(reason)) from reason
        raise TableError(f"{name}: not a netCDF file ({reason}); {REMEDY}") from None
    if damage := _damage(attributes, arrays):
        raise TableError(f"{name}: damaged, {damage}; {REMEDY}")
    part = _part(attributes)
    return *decode(arrays, part), json.loads(attributes["measured_error"]), part


def _part(attributes: Mapping[str, Any]) -> TablePart:
    resolution = tuple(map(int, attributes["resolution"]))
    whole = TablePart.all_of((resolution[0], resolution[1], resolution[2], resolution[3]))
    if "part" not in attributes:
        return whole
    ends = tuple(map(int, attributes["part"]))
    return TablePart(whole.resolution, *((ends[k], ends[k + 1]) for k in (0, 2, 4, 6)))


def _unsealed(path: Path) -> str:
    """Text on a file without a valid seal.

    The file is not opened, as the netCDF library may crash on it or never return.
    """
    content = path.read_bytes()
    if TITLE.encode() in content:
        return f"damaged, it was changed or cut off after it was written; {REMEDY}"
    if content.startswith(HDF5):
        return f"not a table made by fcm tabulate, or a damaged one; {REMEDY}"
    return "not a netCDF file"


def _read(path: Path, content: bytes) -> tuple[dict[str, Any], Arrays]:
    """Attributes and arrays of a table, from its content."""
    import netCDF4

    with netCDF4.Dataset(path, memory=content) as file:
        file.set_auto_mask(False)
        attributes = {key: file.getncattr(key) for key in file.ncattrs()}
        _check_kind(path, attributes)
        return attributes, {key: variable[...] for key, variable in file.variables.items()}


def _check_kind(path: Path, attributes: Mapping[str, Any]) -> None:
    if not np.array_equal(attributes.get("title", ""), TITLE):
        raise TableError(f"{path}: netCDF, but not a table made by fcm tabulate")
    if not np.array_equal(attributes.get("layout", ""), PART_LAYOUT if "part" in attributes else LAYOUT):
        found = f"a table of layout {attributes.get('layout')}, and this fcm reads layout {LAYOUT}"
        raise TableError(f"{path}: {found}; {REMEDY}")


def _damage(attributes: Mapping[str, Any], arrays: Arrays) -> str:
    """Fault of a file that claims to be a table; empty if there is none."""
    if missing := sorted({"measured_error", "resolution", "checksum"} - set(attributes)):
        return f"attribute {', '.join(missing)} missing"
    if missing := sorted(expected(_part(attributes)) - set(arrays)):
        return f"{', '.join(missing)} missing"
    for key, array in arrays.items():
        if array.dtype.kind != "f" or not np.isfinite(array.sum()):
            return f"{key} holds values that are not finite numbers"
    if _checksum(arrays, attributes) != attributes["checksum"]:
        return "its data do not match its checksum"
    return ""
