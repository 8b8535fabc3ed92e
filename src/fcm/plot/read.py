"""A response file, read for drawing."""

from __future__ import annotations

import errno
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import AbstractContextManager, contextmanager
from dataclasses import field, replace
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from fcm.files import NETCDF, no_file
from fcm.frozen import Frozen
from fcm.plot.blades import ALSO as OF_BLADES
from fcm.plot.blades import ENVELOPE, DrawnBlades, blades_of
from fcm.plot.dof import asked_for, column_of, greatest_column, leading_column
from fcm.plot.errors import PlotError
from fcm.plot.labels import with_unit
from fcm.plot.layout import check_layout, is_text
from fcm.plot.measured import NEEDED as MEASURED
from fcm.plot.measured import OWN as OF_MEASURED
from fcm.plot.measured import DrawnMeasured, FittedNumber, fitted_of, measured_of
from fcm.plot.options import READ
from fcm.plot.reader_process import apart
from fcm.plot.style import LAYOUT
from fcm.plot.summary import jumps_of
from fcm.plot.unfinished import NO_SPAN, Unfinished, unfinished_of
from fcm.rotational_dofs import dof_unit
from fcm.units import CF_UNIT
from fcm.unknown_stability import unknown_stability

FloatArray = npt.NDArray[np.float64]
BoolArray = npt.NDArray[np.bool_]
Failures = tuple[type[Exception], ...]

_DESCRIBED = "swept value"  # how the description of a swept value begins
_READ = {written: unit for unit, written in CF_UNIT.items()}
LEVEL = "level"  # stands for a unit of frequency: the curves are over the level of the forces
_NEEDED = ("frequency", "amplitude", "dof")
_ALSO = (
    "stable",
    "table_error",
    "truncation_error",
    "regime",
    "level",
    "complete",
    "fundamental",
    "sweep",
    *MEASURED,
    *OF_MEASURED,
    *OF_BLADES,
)
NO_NETCDF = "Unknown file format"  # what the library says of other files
UNREAD = (OSError, RuntimeError, ValueError)  # what the library raises at reading, and the checks here


class DrawnCurve(Frozen):
    """One curve without its padding; ``stable`` is None where the file does not know.

    Separate branches follow one another, with a point of NaN between them.
    """

    parameters: dict[str, float]
    frequency: FloatArray  # (point,) in the file's unit, or the level of the forces
    amplitude: FloatArray  # (point, dof)
    stable: BoolArray | None = None  # (point,) True also where the stability is unknown
    unknown: BoolArray | None = None  # (point,) where the stability is unknown
    regimes: frozenset[str] = field(default=frozenset())  # all that occur, of every contact
    table_error: FloatArray | None = None  # (point,) relative, before the correction
    truncation_error: FloatArray | None = None  # (point,) relative
    fundamental: FloatArray | None = None  # (point, dof) amplitude
    note: str = ""  # a further line of its name


class DrawnResponse(Frozen):
    dofs: tuple[str, ...]
    frequency_unit: str
    curves: tuple[DrawnCurve, ...]
    length: str = ""  # unit of displacements, if the file says it
    drawn: tuple[str, ...] = ()  # swept keys whose values are random draws
    units: Mapping[str, str] = field(default_factory=dict)  # of swept keys, if the file says them
    measured: tuple[DrawnMeasured, ...] = ()  # points that numbers were fitted to
    asked: tuple[str, ...] = ()  # degrees of freedom that the scene asks for, if it says so
    unfinished: Unfinished = field(
        default_factory=Unfinished
    )  # of all curves, those without a point among them
    fitted: tuple[FittedNumber, ...] = ()  # that a fit found
    blades: DrawnBlades | None = None  # of a mistuned ring, whose envelopes are the last columns

    def column(self, dof: str | None, envelope: bool = True) -> int:
        """The place of a degree of freedom; by default that of `leading_column`.

        envelope: whether the default for a mistuned ring is an envelope over its sectors.
        """
        if dof is not None:
            return column_of(self.dofs, dof)
        none = np.empty((0, len(self.dofs)))
        amplitudes = np.concatenate([none, *(c.amplitude for c in self.curves)])
        own = len(self.own_dofs)
        if self.blades is None or not envelope:
            return leading_column(self.own_dofs, None, amplitudes[:, :own], self.asked)
        return own + greatest_column(self.blades.names, amplitudes[:, own:], self.blades.asked(self.asked))

    def amplitude_label(self, column: int) -> str:
        """Axis label of the amplitudes of a column, with their unit."""
        dof, place = self.dofs[column], self.envelope(column)
        name = f"Amplitude of {dof}"
        if place is not None and self.blades is not None:
            name = self.blades.amplitude_label(place)
        return with_unit(name, dof_unit(dof, self.length))

    @property
    def own_dofs(self) -> tuple[str, ...]:
        """Degrees of freedom without the envelopes."""
        return self.dofs if self.blades is None else self.dofs[: -len(self.blades.names)]

    def envelope(self, column: int) -> int | None:
        """Index of the envelope over sectors in a column; None if the column is no envelope."""
        return None if self.blades is None else self.blades.place(self.dofs, column)


def curves_there(count: int) -> str:
    """How many curves a file has, and their numbers.

    >>> curves_there(1), curves_there(10)
    ('1 curve, number 0', '10 curves, numbers 0 to 9')
    """
    return "1 curve, number 0" if count == 1 else f"{count} curves, numbers 0 to {count - 1}"


def chosen_curve(path: Path, curve: int | None, count: int) -> int:
    """Check the number of a curve, by default of the only one; PlotError if there is none, or several."""
    if curve is None and count > 1:
        raise PlotError(f"{path}: has {count} curves; say which by --curve 0 to --curve {count - 1}")
    row = 0 if curve is None else curve
    if not 0 <= row < count:
        raise PlotError(f"{path}: there is no curve {row}; it has {curves_there(count)}")
    return row


def ends(curves: Sequence[DrawnCurve]) -> tuple[float, float]:
    """The lowest and the highest frequency of all."""
    low = min(float(np.nanmin(curve.frequency)) for curve in curves)
    return low, max(float(np.nanmax(curve.frequency)) for curve in curves)


def on_curve(along: FloatArray, place: float) -> float:
    """A place along a curve (point,), moved to an end that it equals up to rounding; NaN if it is beyond."""
    for end in (float(np.nanmin(along)), float(np.nanmax(along))):
        if abs(place - end) <= READ.same_level * abs(end):
            return end
    return place if np.nanmin(along) <= place <= np.nanmax(along) else np.nan


def asked_beside(wanted: float, there: float, unit: str, digits: int) -> str:
    """Text on the place asked for, beside the place of the point; empty if the digits shown agree.

    >>> asked_beside(120.0, 119.989, "Hz", 6), asked_beside(120.0, 119.989, "Hz", 3)
    ('asked: 120 Hz', '')
    """
    told, shown = (f"{value:.{digits}g}" for value in (wanted, there))
    return "" if told == shown else f"asked: {told} {'' if unit == LEVEL else unit}".rstrip()


def wide(curves: Sequence[DrawnCurve]) -> bool:
    """Whether the frequencies span so much that only a logarithmic axis shows the resonances."""
    low, high = ends(curves)
    return high > LAYOUT.wide_frequencies * low > 0.0


@apart
def read_response(path: Path) -> DrawnResponse:
    """Read what ``fcm respond -o`` has written; PlotError if the file is something else."""
    with opened_response(path) as dataset:
        found = response_in(dataset)
        return replace(found, curves=tuple(_broken_at_jumps(dataset, found.curves)))


def opened_response(path: Path) -> AbstractContextManager[Any]:
    """The open dataset of a response, see `opened`."""
    return opened(path, "a response file", _NEEDED, _ALSO)


class _Variables(dict[str, Any]):
    """Variables by name; a missing one raises ValueError with its name."""

    def __missing__(self, name: str) -> Any:
        raise ValueError(f"it has no variable {name}")


class OpenDataset:
    """An open netCDF dataset: variables by name, and its attributes as attributes of the object."""

    def __init__(self, dataset: Any) -> None:
        self._dataset, self.variables = dataset, _Variables(dataset.variables)

    def __getitem__(self, name: str) -> Any:
        return self.variables[name]

    def __getattr__(self, name: str) -> Any:
        return getattr(self._dataset, name)


@contextmanager
def opened(path: Path, kind: str, needed: Sequence[str], also: Sequence[str] = ()) -> Iterator[Any]:
    """The open netCDF dataset, see `OpenDataset`.

    PlotError if it lacks a variable of `needed`, or if one of these or of `also` has another layout.
    """
    from netCDF4 import Dataset

    if what := no_file(path):
        raise PlotError(f"{path}: {what}")
    scene = path.name if path.suffix == ".toml" else "SCENE"
    with read(
        path,
        f"not a netCDF file that can be read; fcm respond {scene} -o {path.stem or 'FILE'}.nc writes one",
        (Exception,),
    ):  # whatever the library comes to
        dataset = Dataset(str(path))
    with dataset:
        missing = [name for name in needed if name not in dataset.variables]
        if missing:
            names = ", ".join(missing[:3]) + (", ..." if len(missing) > 3 else "")
            raise PlotError(f"{path}: not {kind}: it has no variable {names}{_hint(dataset)}")
        with read(path, f"not {kind}"):
            check_layout(dataset.variables, (*needed, *also))
            yield OpenDataset(dataset)


def _cause(error: BaseException) -> str:
    """Message of a library on a file, without the file's name and error number, already in the text."""
    said = getattr(error, "strerror", None) or str(error)
    return str(said).partition("\n")[0]


@contextmanager
def read(path: Path, otherwise: str, of: Failures = UNREAD) -> Iterator[None]:
    """Context for reading a file that may be damaged: errors become `PlotError`.

    The message has the text `otherwise`, and the reason.
    """
    try:
        yield
    except (PlotError, MemoryError):
        raise
    except of as error:
        if getattr(error, "errno", 0) == errno.ENOMEM:
            raise MemoryError(str(error)) from error
        reason = str(error).partition("\n")[0]
        if (reason.startswith(NETCDF) and NO_NETCDF not in reason) or "HDF" in reason:
            raise PlotError(f"{path}: damaged, or cut off; write it anew ({_cause(error)})") from error
        why = "" if isinstance(error, OSError) else f": {reason or type(error).__name__}"
        raise PlotError(f"{path}: {otherwise}{why}") from error


def _hint(dataset: Any) -> str:
    """Text on the command that draws the file, or on the interruption of its optimum or fit; or ''."""
    kinds = (
        ("history", {"displacement", "time"}),
        ("response", {"amplitude", "frequency"}),
        ("peak", {"peak_amplitude", "peak_frequency"}),
        ("peak", {"tracked_number", "tracked_frequency"}),
    )
    held = dataset.variables.keys()
    found = next((what for what, names in kinds if held >= names), "")
    if not found and "optimum_number" in held:
        return "; the search for its optimum was interrupted, before a response was traced"
    if not found and "fitted_value" in held:
        return "; its fit was interrupted, before a response was traced. fcm respond SCENE --resume goes on"
    alone = "; of curves it has the peaks alone, as by --peaks-only" if "peak_amplitude" in held else ""
    return f"{alone if found == 'peak' else ''}; try fcm plot {found}" if found else ""


def response_in(dataset: Any) -> DrawnResponse:
    """The response of an open file, with the points that it has."""
    variables = dataset.variables
    dofs = tuple(str(name) for name in np.atleast_1d(variables["dof"][:]))
    if not dofs:
        raise ValueError("it has no degree of freedom")
    frequency, amplitude = floats(variables["frequency"]), floats(variables["amplitude"])
    blades = blades_of(variables) if ENVELOPE in variables else None
    if blades is not None:
        dofs, amplitude = (*dofs, *blades.names), np.append(amplitude, floats(variables[ENVELOPE]), axis=2)
    free = "modal_amplitude" in variables  # free motion has no stability and no range of frequencies
    names = ("fundamental", *(() if free else ("stable", "table_error", "truncation_error")))
    others = {name: floats(variables[name]) for name in names if name in variables}
    if "regime" in variables:
        others["regime"] = variables["regime"][:]
    swept = swept_values(variables)
    level = floats(variables["level"]) if "level" in variables else None
    curves = tuple(
        _curve(
            {name: float(values[i]) for name, values in swept.items()},
            frequency[i] if level is None else level[i],
            amplitude[i],
            {name: values[i] for name, values in others.items()},
        )
        for i in range(len(frequency))
    )
    length = str(getattr(variables["amplitude"], "units", ""))
    unit = str(getattr(dataset, "frequency_unit", "rad/s")) if level is None else LEVEL
    drawn = drawn_keys(variables, swept)
    measured = measured_of(variables)
    units, asked = swept_units(variables, swept), asked_for(getattr(dataset, "output", ""), dofs)
    unfinished = unfinished_of(dataset)
    if level is not None or free:  # the range is of frequencies
        unfinished = replace(unfinished, span=NO_SPAN)
    return DrawnResponse(
        dofs, unit, curves, length, drawn, units, measured, asked, unfinished, fitted_of(dataset), blades
    )


def _curve(
    parameters: dict[str, float], frequency: FloatArray, amplitude: FloatArray, others: dict[str, Any]
) -> DrawnCurve:
    """The curve without its padding, with its other variables (point, ...).

    Points of NaN between branches stay, so that no line joins the branches.
    """
    known = np.flatnonzero(np.isfinite(frequency))
    there = slice(0, known[-1] + 1 if known.size else 0)
    regimes = (
        frozenset(map(str, np.unique(others.pop("regime")[known]))) if "regime" in others else frozenset()
    )
    others = {name: values[there] for name, values in others.items()}
    if "stable" in others:
        others["unknown"] = np.isfinite(frequency[there]) & unknown_stability(others["stable"])
        others["stable"] = others["stable"] != 0
    return DrawnCurve(parameters, frequency[there], amplitude[there], regimes=regimes, **others)


def _broken_at_jumps(dataset: Any, curves: Sequence[DrawnCurve]) -> Iterator[DrawnCurve]:
    """The curves with a point of NaN wherever a sweep up or down jumps from one point to the next."""
    if "sweep" not in dataset.variables:
        yield from curves
        return
    sweeps = np.asarray(dataset.variables["sweep"][:], dtype=str)
    every = [*jumps_of(dataset), *([] for _ in curves)]
    for curve, row, jumps in zip(curves, sweeps, every, strict=False):
        f, way, after = curve.frequency, row[: len(curve.frequency)], set[int]()
        for sweep, at in jumps:
            same = (way[:-1] == way[1:]) & (way[1:] == sweep)
            past = (f[:-1] - at) * (f[1:] - at) <= 0.0
            after |= set((1 + np.flatnonzero(same & past)).tolist())
        yield _broken(curve, sorted(after)) if after else curve


def _broken(curve: DrawnCurve, places: list[int]) -> DrawnCurve:
    """The curve with a point of NaN before each of some places."""
    of_points: dict[str, Any] = {}
    for name, values in vars(curve).items():
        if isinstance(values, np.ndarray):
            fill = values[np.array(places) - 1] if values.dtype == np.bool_ else np.nan
            of_points[name] = np.insert(values, places, fill, axis=0)
    return replace(curve, **of_points)


def swept_values(variables: Any) -> dict[str, FloatArray]:
    """The swept values, by their keys in the scene: ``contact.shroud.n_0``."""
    return {key: floats(variable) for key, variable in _swept(variables).items()}


def swept_units(variables: Any, keys: Iterable[str]) -> dict[str, str]:
    """The units of swept values; empty where the file does not give them."""
    held = _swept(variables)
    written = {key: str(getattr(held[key], "units", "")) for key in keys}
    return {key: _READ.get(unit, unit) for key, unit in written.items()}


def drawn_keys(variables: Any, keys: Iterable[str]) -> tuple[str, ...]:
    """Swept keys whose values are random draws."""
    held = _swept(variables)
    return tuple(key for key in keys if getattr(held[key], "drawn", "") == "true")


def _swept(variables: Any) -> dict[str, Any]:
    """The variables of swept values by their keys, which netCDF names may not be able to hold."""
    return {
        str(getattr(variable, "key", name)): variable
        for name, variable in variables.items()
        if variable.dimensions == ("curve",)
        and str(getattr(variable, "long_name", "")).startswith(_DESCRIBED)
        and not is_text(variable.dtype)
    }


def floats(variable: Any) -> FloatArray:
    """A variable of the file, with NaN where it has no value."""
    found: FloatArray = np.ma.filled(np.ma.asarray(variable[:], dtype=float), np.nan)
    largest = float(np.max(np.abs(found), initial=0.0, where=~np.isnan(found)))
    if largest > READ.max_number:
        raise ValueError(f"{getattr(variable, 'name', 'a variable')} holds {largest:.3g}")
    return found
