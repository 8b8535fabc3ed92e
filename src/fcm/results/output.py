"""A response as netCDF, CSV, JSON summary and xarray dataset, all from one description."""

from __future__ import annotations

import csv
import json
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

import fcm
from fcm.files import replacing
from fcm.results.field import Field
from fcm.results.fields import fields_of
from fcm.results.meanings import ORBIT_KINDS
from fcm.results.orbits import Orbits
from fcm.results.padded import CHUNK, Padded
from fcm.results.result import Response
from fcm.results.scatter import scatter, summary_of
from fcm.rotation import unit_of
from fcm.units import in_unit

if TYPE_CHECKING:
    import xarray

LAST_COLUMNS = ("stable", "table_error", "truncation_error")
ORBIT_COLUMNS = ("closure_error", "sweep", "repeats")
SMALL = 1 << 16  # bytes of a variable up to which to compress it takes longer than to write it
LAYOUT = "fcm response 1"  # changes when a reader of older files would misread


def summary(response: Response) -> dict[str, Any]:
    """What ``fcm respond --json`` prints; a number that does not exist is None."""
    data = {
        "curves": [curve.summary(response.frequency_unit) for curve in response.curves],
        "method": response.method,
        "frequency_unit": response.frequency_unit,
        "left_out": response.left_out,
        "notes": response.notes,
        "units": dict(zip(("length", "force"), response.units, strict=True)),
        "seconds": response.seconds,
    }
    if response.curves and (found := scatter(response)):
        unit = response.frequency_unit
        data["scatter"] = [summary_of(one, response.dofs, unit) for one in found]
    if response.histories is not None:
        from fcm.motion import output

        data["histories"] = output.summary(response.histories)
    if response.tracking is not None:
        unit = response.frequency_unit
        data["tracked"] = response.tracking.summary(unit)
        if response.tracking.optima:
            data["optimum"] = [one.summary(unit) for one in response.tracking.optima]
    return _without_nan(data)  # type: ignore[no-any-return]


def _without_nan(value: Any) -> Any:
    if isinstance(value, dict):
        return {key: _without_nan(item) for key, item in value.items()}
    if isinstance(value, list):
        return [_without_nan(item) for item in value]
    return None if isinstance(value, float) and not np.isfinite(value) else value


def attributes(response: Response) -> dict[str, str]:
    """Global attributes of the file."""
    return {
        "title": response.title,
        "layout": LAYOUT,
        "source": f"fcm {fcm.__version__}, {_kind(response)}",
        "frequency_unit": response.frequency_unit,
        "summary": json.dumps(_summary(response), allow_nan=False),
    }


def _summary(response: Response) -> dict[str, Any]:
    """What the file says of itself; of curves without points it has all that in its variables."""
    if not response.peaks_only:
        curves = [replace(curve, sensitivity=None) for curve in response.curves]
        return summary(replace(response, curves=curves))
    return {key: value for key, value in summary(replace(response, curves=[])).items() if key != "curves"}


def _kind(response: Response) -> str:
    kinds = []
    if response.curves:
        exact = "exact periodic solutions between transitions, by shooting"
        balance = f"harmonic balance, method {response.method}"
        kinds.append(exact if response.method == "exact" else balance)
    if response.histories is not None:
        kinds.append("exact simulation of a schedule")
    if response.tracking is not None:
        kinds.append(f"{response.tracking.what} tracked by extended systems of the balance")
    return "; ".join(kinds)


def to_dataset(response: Response) -> xarray.Dataset:
    """The response as an xarray dataset."""
    import xarray

    fields = fields_of(response)
    variables = {name: (f.dims, np.asarray(f.values), f.attrs) for name, f in fields.items()}
    coords = {name: variables.pop(name) for name in ["dof", "contact", *_coordinates(response, fields)]}
    return xarray.Dataset(variables, coords, attributes(response))


def _coordinates(response: Response, fields: dict[str, Field]) -> list[str]:
    """Variables that say what a curve or an instant is: swept values, and times if there are any."""
    swept = list(response.parameters[0]) if response.parameters else []
    return [*swept, *(name for name in ("time", "cycles", "cycle_start") if name in fields)]


def write_netcdf(response: Response, path: str | Path) -> None:
    """Write the response as netCDF-4; the file appears only when it is complete.

    All variables are described before any is filled: between the one and the other the library goes through
    all it has been told, which for each variable by itself took half of the time.
    """
    import netCDF4

    fields = fields_of(response)
    coordinates = _coordinates(response, fields)
    with replacing(path) as temporary, netCDF4.Dataset(temporary, "w", format="NETCDF4") as file:
        file.setncatts(attributes(response))
        for name, field in fields.items():
            of = [x for x in coordinates if set(fields[x].dims) <= set(field.dims)]
            more = {"coordinates": " ".join(of)} if of and name not in coordinates else {}
            _described(file, name, field).setncatts(field.attrs | more)
        for name, field in fields.items():
            _fill(file.variables[name], field.values)


def _described(file: Any, name: str, field: Field) -> Any:
    """A variable of an open file, without values."""
    for dim, size in zip(field.dims, field.values.shape, strict=True):
        if dim not in file.dimensions:
            file.createDimension(dim, size)
    if 0 < 8 * int(np.prod(field.values.shape)) <= SMALL and field.values.dtype.kind != "U":
        return _variable(file, name, field.dims, field.values.dtype, contiguous=True)
    if not isinstance(field.values, Padded):
        return _variable(file, name, field.dims, field.values.dtype)
    step, (count, *rest) = field.values.step, field.values.shape
    chunks = (max(min(step, count), 1), *(max(size, 1) for size in rest))
    # each chunk is written once, so that nothing is gained by keeping many of every variable
    return _variable(file, name, field.dims, field.values.dtype, chunksizes=chunks, chunk_cache=2 * CHUNK)


def _fill(variable: Any, values: npt.NDArray[Any] | Padded) -> None:
    """Write the values; what is of many curves is made and written some curves at a time."""
    if not isinstance(values, Padded):
        variable[...] = _storable(values)
        return
    for begin in range(0, values.shape[0], values.step):
        variable[begin : begin + values.step] = _storable(values.part(begin, begin + values.step))


def _variable(file: Any, name: str, dims: tuple[str, ...], kind: np.dtype[Any], **options: Any) -> Any:
    if kind.kind == "U":
        return file.createVariable(name, str, dims, **options)
    if kind.kind == "f":
        options["fill_value"] = np.nan
    if not options.get("contiguous"):
        # padding is what shrinks, the digits of numbers hardly do: more effort than the least gains nothing
        options |= {"zlib": True, "complevel": 1}
    return file.createVariable(name, kind, dims, **options)


def _storable(values: Any) -> Any:
    return values.astype(object) if values.dtype.kind == "U" else values


def write_csv(response: Response, path: str | Path) -> None:
    """Write the response as CSV, a row for each point; frequencies in the scene's unit."""
    keys = list(response.parameters[0]) if response.parameters else []
    exact = response.method == "exact"
    levels = any(curve.level is not None for curve in response.curves)
    modes = ("modal_amplitude", "damping_ratio") if any(c.mode is not None for c in response.curves) else ()
    kinds = ("amplitude", "phase", "mean", "fundamental", "error", *(ORBIT_KINDS if exact else ()))
    units = {dof: unit_of(dof, response.units[0]) for dof in response.dofs}
    columns = [
        f"{kind} {dof} [{units[dof]}]" if units[dof] and kind not in ("phase", "error") else f"{kind} {dof}"
        for dof in response.dofs
        for kind in kinds
    ]
    regimes = [f"regime {name}" for name in response.contacts]
    with replacing(path) as temporary, temporary.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(
            [
                "curve",
                "branch",
                *keys,
                f"frequency [{response.frequency_unit}]",
                *(["level"] if levels else []),
                *modes,
                *columns,
                *regimes,
                *LAST_COLUMNS,
                *(ORBIT_COLUMNS if exact else ()),
            ]
        )
        for number, c in enumerate(response.curves):
            orbits = c.orbits
            own = () if orbits is None else tuple(getattr(orbits, kind) for kind in ORBIT_KINDS)
            parts = (c.amplitude, c.phase, c.mean, c.fundamental, c.error, *own)
            frequency = in_unit(c.frequency, response.frequency_unit)
            values = np.stack(parts, axis=2).reshape(c.frequency.size, len(columns))
            for k in np.flatnonzero(np.isfinite(c.frequency)):
                writer.writerow(
                    [number, c.branch[k], *c.parameters.values(), repr(float(frequency[k]))]
                    + ([] if c.level is None else [repr(float(c.level[k]))])
                    + (
                        []
                        if c.mode is None
                        else [repr(float(x[k])) for x in (c.mode.amplitude, c.mode.damping)]
                    )
                    + [repr(float(value)) for value in values[k]]
                    + [*c.regime[k].tolist(), f"{c.stable[k]:g}"]
                    + [repr(float(c.table_error[k])), repr(float(c.truncation_error[k]))]
                    + ([] if orbits is None else _of_orbit(orbits, int(k)))
                )


def write_tracked_csv(response: Response, path: str | Path) -> None:
    """Write tracked curves as CSV, a row for each point; frequencies in the scene's unit."""
    tracking = response.tracking
    assert tracking is not None
    keys = list(tracking.curves[0].parameters) if tracking.curves else []
    units = {dof: unit_of(dof, response.units[0]) for dof in response.dofs}
    amplitudes = [f"amplitude {dof} [{units[dof]}]" if units[dof] else f"amplitude {dof}" for dof in units]
    header = ["track", "what", *keys, tracking.key, f"frequency [{response.frequency_unit}]", *amplitudes]
    with replacing(path) as temporary, temporary.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow([*header, "corner", "turn", "trough"])
        for number, one in enumerate(tracking.curves):
            frequency = in_unit(one.frequency, response.frequency_unit)
            for k in range(one.number.size):
                values = [repr(float(x)) for x in (one.number[k], frequency[k], *one.amplitude[k])]
                marks = [str(one.corner[k]), int(one.turn[k]), int(one.trough[k])]
                writer.writerow([number, one.what, *one.parameters.values(), *values, *marks])


def _of_orbit(orbits: Orbits, point: int) -> list[Any]:
    """The last columns of a row of CSV."""
    return [repr(float(orbits.closure_error[point])), orbits.sweep[point], int(orbits.repeats[point])]
