"""A response as netCDF file and xarray dataset, from one description; see also `summary` and `csv_file`."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

import fcm
from fcm.files import replacing
from fcm.results.fields import fields_of, swept_names
from fcm.results.options import RESULTS, NetcdfOptions
from fcm.results.padded_arrays import Field, Padded
from fcm.results.result import Response
from fcm.results.summary import summary
from fcm.results.tracked_fields import tracked_names

if TYPE_CHECKING:
    import xarray

LAYOUT = "fcm response 1"  # to be changed when a reader of older files would misread it


def attributes(response: Response) -> dict[str, str]:
    """Global attributes of the file."""
    asked = {"output": json.dumps(response.output)} if response.output else {}
    return asked | {
        "title": response.title,
        "layout": LAYOUT,
        "source": f"fcm {fcm.__version__}, {_kind(response)}",
        "frequency_unit": response.frequency_unit,
        "summary": json.dumps(_summary(response), allow_nan=False),
    }


def _summary(response: Response) -> dict[str, Any]:
    """The summary attribute of a file; without curves if the file has no points, as variables hold them."""
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
        kinds.append(f"{response.tracking.what} tracked by extended systems of harmonic balance")
    return "; ".join(kinds)


def to_dataset(response: Response) -> xarray.Dataset:
    """The response as an xarray dataset."""
    import xarray

    fields = fields_of(response)
    variables = {name: (f.dims, np.asarray(f.values), f.attrs) for name, f in fields.items()}
    coords = {name: variables.pop(name) for name in ["dof", "contact", *_coordinates(response, fields)]}
    return xarray.Dataset(variables, coords, attributes(response))


def _coordinates(response: Response, fields: dict[str, Field]) -> list[str]:
    """Variables that identify a curve or an instant: swept values, and times if there are any."""
    swept = [*swept_names(response).values(), *tracked_names(response.tracking).values()]
    return [*swept, *(name for name in ("time", "cycles", "cycle_start") if name in fields)]


def write_netcdf(response: Response, path: str | Path, options: NetcdfOptions = RESULTS.file) -> None:
    """Write the response as netCDF-4; the file appears only when it is complete.

    All variables are defined before any is filled: each switch between the two makes the library process all
    definitions, which took half of the time.
    """
    import netCDF4

    fields = fields_of(response)
    coordinates = _coordinates(response, fields)
    with replacing(path) as temporary, netCDF4.Dataset(temporary, "w", format="NETCDF4") as file:
        file.setncatts(attributes(response))
        for name, field in fields.items():
            of = [x for x in coordinates if set(fields[x].dims) <= set(field.dims)]
            more = {"coordinates": " ".join(of)} if of and name not in coordinates else {}
            _described(file, name, field, options).setncatts(field.attrs | more)
        for name, field in fields.items():
            _fill(file.variables[name], field.values, options.chunk)


def _described(file: Any, name: str, field: Field, options: NetcdfOptions) -> Any:
    """Define a variable of an open file, without values."""
    for dim, size in zip(field.dims, field.values.shape, strict=True):
        if dim not in file.dimensions:
            file.createDimension(dim, size)
    size = 8 * int(np.prod(field.values.shape))
    if 0 < size <= options.contiguous and field.values.dtype.kind != "U":
        return _variable(file, name, field.dims, field.values.dtype, contiguous=True)
    if not isinstance(field.values, Padded):
        return _variable(file, name, field.dims, field.values.dtype)
    step, (count, *rest) = field.values.step(options.chunk), field.values.shape
    chunks = (max(min(step, count), 1), *(max(one, 1) for one in rest))
    cache = 2 * options.chunk
    # each chunk is written once, so a large cache for every variable gains nothing
    return _variable(file, name, field.dims, field.values.dtype, chunksizes=chunks, chunk_cache=cache)


def _fill(variable: Any, values: npt.NDArray[Any] | Padded, chunk: int) -> None:
    """Write the values; padded arrays are made and written some curves at a time."""
    if not isinstance(values, Padded):
        variable[...] = _storable(values)
        return
    step = values.step(chunk)
    for begin in range(0, values.shape[0], step):
        variable[begin : begin + step] = _storable(values.part(begin, begin + step))


def _variable(file: Any, name: str, dims: tuple[str, ...], kind: np.dtype[Any], **options: Any) -> Any:
    if kind.kind == "U":
        return file.createVariable(name, str, dims, **options)
    if kind.kind == "f":
        options["fill_value"] = np.nan
    if not options.get("contiguous"):
        # only padding compresses well, digits of numbers hardly: a higher level gains nothing
        options |= {"zlib": True, "complevel": 1}
    return file.createVariable(name, kind, dims, **options)


def _storable(values: Any) -> Any:
    return values.astype(object) if values.dtype.kind == "U" else values
