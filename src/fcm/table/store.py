"""The table file: netCDF-4 after the CF conventions, checked when read, written whole or not at all."""

from __future__ import annotations

import json
import os
import tempfile
import zlib
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

import fcm
from fcm.contact import fourier_coefficients
from fcm.table import atlas, build
from fcm.table.atlas import FloatArray

LAYOUT = 1
TITLE = "Fourier coefficients of the friction force of a contact with variable normal load"
DEFAULT = Path(__file__).parent.parent / "tables" / "default.nc"
NAMES = ("b", "s", "c")
KINDS = {"b": "mean", "s": "sine (stiffness)", "c": "cosine (damping)"}


class TableError(ValueError):
    """A file that is not a sound table; the message says why and for which file."""


def save(
    path: str | Path,
    separation: FloatArray,
    slip: FloatArray,
    error: dict[str, Any],
    history: str = "fcm.table.build_table",
) -> None:
    """Write the reduced coefficients of both charts, as returned by `fcm.table.build.charts`.

    The file is written under a temporary name in the same folder, then renamed.
    """
    target = Path(path)
    handle, name = tempfile.mkstemp(prefix=target.name + ".", suffix=".part", dir=target.parent)
    os.close(handle)
    try:
        _write(name, separation, slip, error, history)
        umask = os.umask(0)
        os.umask(umask)
        Path(name).chmod(0o666 & ~umask)
        Path(name).replace(target)
    except BaseException:
        Path(name).unlink(missing_ok=True)
        raise


def _write(
    name: str, separation: FloatArray, slip: FloatArray, error: dict[str, Any], history: str
) -> None:
    import netCDF4

    variables = _variables(separation, slip)
    levels, nx, nz = variables["n0_bar"][1].shape
    with netCDF4.Dataset(name, "w", format="NETCDF4") as file:
        for dimension, size in (
            ("level", levels),
            ("variation", nx),
            ("phase", nz),
            ("level_open", separation.shape[1]),
            ("level_slip", slip.shape[1]),
        ):
            file.createDimension(dimension, size)
        for key, (dimensions, values, attributes) in variables.items():
            variable = file.createVariable(key, values.dtype, dimensions, fill_value=False)
            variable.setncatts(attributes)
            variable[...] = values
        file.setncatts(
            {
                "Conventions": "CF-1.8",
                "title": TITLE,
                "institution": "made by the user of fcm",
                "source": f"fcm {fcm.__version__}, closed form of the periodic solution",
                "references": "Yang, Chu and Menq (1998), Journal of Sound and Vibration 210(4), 453-481",
                "history": f"{datetime.now(UTC):%Y-%m-%dT%H:%M:%SZ} {history}",
                "comment": COMMENT,
                "layout": np.int32(LAYOUT),
                "resolution": np.array(build.resolution_of(separation, slip), dtype=np.int32),
                "measured_error": json.dumps(error),
                "checksum": _checksum({key: values for key, (_, values, _) in variables.items()}),
            }
        )


COMMENT = (
    "Levels run from n0_bar = -b_bar (fully open) to the slip limit; the first level_open of them are those with "
    "separation, the others slip without. phi + pi changes the sign of F_b alone. Between the nodes fcm interpolates "
    "F (1 + b_bar) / b_bar in separation and the mean slopes in slip, by cubic splines. Absolute error: see "
    "measured_error."
)
Variable = tuple[tuple[str, ...], npt.NDArray[Any], dict[str, str]]


def _variables(separation: FloatArray, slip: FloatArray) -> dict[str, Variable]:
    nodes = build.nodes(build.resolution_of(separation, slip))
    grid, node = ("level", "variation", "phase"), "n0_bar b_bar phi"
    F = fourier_coefficients(*nodes)
    found: dict[str, Variable] = {
        "phi": (("phase",), nodes.phi[0, 0], {"long_name": "phase of normal before tangential motion", "units": "radian"}),
        "b_bar": (grid[1:], nodes.b_bar[0], {"long_name": "normal load variation mu k_v b / (k_u a)", "units": "1"}),
        "n0_bar": (grid, nodes.n0_bar, {"long_name": "preload mu n_0 / (k_u a)", "units": "1"}),
    }
    for k, name in enumerate(NAMES):
        what = f"{KINDS[name]} coefficient of the friction force over k_u a"
        found[f"F_{name}"] = (
            grid, F[k].astype(np.float32), {"long_name": what, "units": "1", "coordinates": node}
        )
    for k, name in enumerate(NAMES):
        what = f"limit of F_{name} / b_bar as b_bar vanishes, in separation"
        found[f"ratio_{name}"] = (
            ("level_open", "phase"), separation[k, ::-1, 0].astype(np.float32), {"long_name": what, "units": "1"}
        )
        what = f"mean slope of F_{name} by n0_bar from the slip limit back to the node, negative, in slip"
        found[f"slope_{name}"] = (
            ("level_slip", *grid[1:]), slip[k].astype(np.float32), {"long_name": what, "units": "1"}
        )
    return found


def _checksum(arrays: dict[str, npt.NDArray[Any]]) -> str:
    value = 0
    for key in sorted(arrays):
        value = zlib.crc32(np.ascontiguousarray(arrays[key]).tobytes(), zlib.crc32(key.encode(), value))
    return f"crc32:{value:08x}"


def load(path: str | Path | None = None) -> tuple[FloatArray, FloatArray, dict[str, Any]]:
    """The reduced coefficients of both charts and the recorded error.

    Raises
    ------
    TableError
        If the file is missing, is not a table, is of another layout, or is damaged.
    """
    name = Path(DEFAULT if path is None else path)
    attributes, arrays = _read(name)
    if attributes.get("title") != TITLE:
        raise TableError(f"{name}: a netCDF file, but not a table made by `fcm tabulate`")
    if int(attributes.get("layout", -1)) != LAYOUT:
        raise TableError(f"{name}: table of layout {attributes.get('layout')}, this version reads {LAYOUT}; make it anew")
    missing = {"F_b", "F_s", "F_c", "b_bar"} - set(arrays)
    if missing:
        raise TableError(f"{name}: damaged, {', '.join(sorted(missing))} missing")
    if any(not np.all(np.isfinite(values)) for values in arrays.values()):
        raise TableError(f"{name}: damaged, it holds values that are not finite numbers")
    if _checksum(arrays) != attributes.get("checksum"):
        raise TableError(f"{name}: damaged, its checksum does not match its data; make it anew")
    F, ratio, slip = (np.stack([arrays[f"{kind}_{k}"] for k in NAMES]) for kind in ("F", "ratio", "slope"))
    b = arrays["b_bar"][1:]
    separation = np.empty((*ratio.shape[:2], *F.shape[2:]))
    separation[:, :, 0] = ratio
    np.multiply(F[:, : ratio.shape[1], 1:], (1.0 + b) / b, out=separation[:, :, 1:])
    return separation[:, ::-1], slip.astype(np.float64), json.loads(attributes["measured_error"])


def _read(name: Path) -> tuple[dict[str, Any], dict[str, npt.NDArray[Any]]]:
    import netCDF4

    if not name.is_file():
        raise TableError(f"{name}: no such file")
    try:
        with netCDF4.Dataset(name) as file:
            file.set_auto_mask(False)
            attributes = {key: file.getncattr(key) for key in file.ncattrs()}
            if attributes.get("title") != TITLE or attributes.get("layout") != LAYOUT:
                return attributes, {}
            return attributes, {key: variable[...] for key, variable in file.variables.items()}
    except (OSError, RuntimeError, AttributeError, UnicodeError) as reason:
        raise TableError(f"{name}: not a sound netCDF file ({reason})") from None
