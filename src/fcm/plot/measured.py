"""Measured points over the curves of a response or a mode: those of a fit, or those of a file."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from fcm.frozen import Frozen
from fcm.plot.errors import PlotError
from fcm.plot.labels import with_unit
from fcm.plot.options import READ
from fcm.plot.style import LAYOUT
from fcm.plot.summary import summary_of
from fcm.rotational_dofs import dof_unit
from fcm.units import EXCITED, PER_TIME, QUANTITIES, UNIT, unit_of_number

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from matplotlib.legend import Legend

    from fcm.plot.read import DrawnCurve, DrawnResponse

FloatArray = npt.NDArray[np.float64]
NEEDED = ("data_frequency", "data_displacement", "data_level", "data_dof")
OWN = ("data_amplitude", "data_phase", "data_quantity")
BACKBONE = ("data_frequency", "data_modal_amplitude", "data_damping")
SIZE, NEUTRAL = 4.0, "#404040"
WORD = "measured"


class DrawnMeasured(Frozen):
    """Points of one measurement: frequencies in the unit of the curves, displacements."""

    dof: str  # empty: whichever is drawn
    frequency: FloatArray
    amplitude: FloatArray
    level: FloatArray | None = None  # of the forces; None where it is not known
    quantity: str = ""  # whose fundamental was measured; empty: half the peak-to-peak displacement
    own: FloatArray | None = None  # amplitude of that quantity


class MeasuredBackbone(Frozen):
    """Points (point,) of a backbone: modal amplitude, frequency in the unit of the modes, damping ratio."""

    amplitude: FloatArray
    frequency: FloatArray
    damping: FloatArray


class FittedNumber(Frozen):
    """A number of the scene that a fit found, and its standard error; NaN where that is unknown.

    >>> print(FittedNumber("contact.lap.mu", 0.30123, 0.0042))
    contact.lap.mu = 0.3012 ± 0.0042
    >>> print(FittedNumber("contact.lap.k_u", 2.0e9, float("nan")))
    contact.lap.k_u = 2e+09, standard error unknown
    >>> print(FittedNumber("contact.lap.k_u", 400002.3, 76.2, "N/m"))
    contact.lap.k_u = 400002 ± 76 N/m
    """

    key: str
    value: float
    error: float
    unit: str = ""

    def __str__(self) -> str:
        unit = f" {self.unit}" if self.unit else ""
        if not np.isfinite(self.error):
            return f"{self.key} = {self.value:.4g}{unit}, standard error unknown"
        return f"{self.key} = {self.value:.{self._digits()}g} ± {self.error:.2g}{unit}"

    def _digits(self) -> int:
        """Digits of the value down to the second digit of the error, at least four and at most eight."""
        if not (self.value and self.error > 0.0):
            return 4
        size, error = (int(np.floor(np.log10(abs(one)))) for one in (self.value, self.error))
        return min(max(size - error + 2, 4), 8)


def backbones_of(variables: Any) -> tuple[MeasuredBackbone, ...]:
    """Backbones that numbers were fitted to, from the variables of a file of modes; empty without a fit."""
    if not all(name in variables for name in BACKBONE):
        return ()
    from fcm.plot.read import floats

    frequency, amplitude, damping = (floats(variables[name]) for name in BACKBONE)
    known = np.isfinite(amplitude)
    return tuple(
        MeasuredBackbone(amplitude[i, there], frequency[i, there], damping[i, there])
        for i, there in enumerate(known)
        if there.any()
    )


def draw_backbones(upper: Axes, lower: Axes, measured: Sequence[MeasuredBackbone]) -> None:
    """Mark the points of backbones: frequencies above, damping in percent below."""
    for one in measured:
        for axes, values in ((upper, one.frequency), (lower, 100.0 * one.damping)):
            axes.plot(one.amplitude, values, "+", markersize=SIZE, label=f"_{WORD}", color=NEUTRAL)


def measured_of(variables: Any) -> tuple[DrawnMeasured, ...]:
    """Responses that numbers were fitted to, from the variables of a response file; empty without a fit."""
    if not all(name in variables for name in NEEDED):
        return ()
    from fcm.plot.read import floats

    frequency, displacement, level = (floats(variables[name]) for name in NEEDED[:3])
    dofs = np.asarray(variables["data_dof"][:], dtype=str).tolist()
    known = np.isfinite(displacement)  # not of backbones
    quantities, own = [""] * len(dofs), displacement
    if all(name in variables for name in OWN):
        own, phase = (floats(variables[name]) for name in OWN[:2])
        every = np.asarray(variables[OWN[2]][:], dtype=str).tolist()
        phased = [bool(np.isfinite(row).any()) for row in phase]
        quantities = [
            what if QUANTITIES.get(what, 0) > 0 or (what in QUANTITIES and turned) else ""
            for what, turned in zip(every, phased, strict=True)
        ]
    return tuple(
        DrawnMeasured(
            dof, frequency[i, there], displacement[i, there], level[i, there], quantities[i], own[i, there]
        )
        for i, (dof, there) in enumerate(zip(dofs, known, strict=True))
        if there.any()
    )


def as_measured(response: DrawnResponse, column: int) -> tuple[DrawnResponse, str]:
    """The response in the quantity that was measured at a degree of freedom, and the name of its axis.

    If all data there are fundamentals, so are the curves and points: of the quantity, or of displacements if
    several quantities were measured. Otherwise all are half peak-to-peak, and the name is empty.
    """
    dof = response.dofs[column]
    own = [one for one in response.measured if one.dof in ("", dof)]
    kinds = {one.quantity for one in own}
    unit = UNIT.get(response.frequency_unit)
    if not kinds or "" in kinds or unit is None or any(one.fundamental is None for one in response.curves):
        return response, ""
    several = len(kinds) > 1
    quantity = "displacement" if several else kinds.pop()
    curves = []
    for curve in response.curves:
        assert curve.fundamental is not None
        amplitude = curve.amplitude.copy()
        amplitude[:, column] = curve.fundamental[:, column] * (unit * curve.frequency) ** QUANTITIES[quantity]
        curves.append(replace(curve, amplitude=amplitude))
    points = tuple(
        one if several or one.own is None or one.dof != dof else replace(one, amplitude=one.own)
        for one in response.measured
    )
    name = f"{quantity.capitalize()} of {dof}, fundamental"
    length = dof_unit(dof, response.length)
    name = with_unit(name, f"{length}{PER_TIME[quantity]}" if length else "")
    return replace(response, curves=tuple(curves), measured=points), name


def read_measured_points(path: Path, unit: str, length: str = "") -> DrawnMeasured:
    """Read the points of a file of measurements, like those of [fit].

    Frequencies are in `unit`, displacements in the unit `length` if it is known. Velocities or accelerations,
    if the file declares them, are converted to displacements.

    Raises
    ------
    PlotError
        If it cannot be read, or the curves are over the level of the forces.
    """
    from fcm.plot.read import LEVEL
    from fcm.scene.files import DataFileError, Files
    from fcm.scene.measured_file import read_measured
    from fcm.scene.measured_function import displacements, function_of_table

    if unit == LEVEL:
        raise PlotError(
            f"{path}: measured points are over frequency, the curves over the level of the forces"
        )
    try:
        read = read_measured(path.name, Files(path.parent), ("frequency", "amplitude"), ())
        found, function, of_head = read.columns, read.function, read.units.get("amplitude", "")
        if "angular_frequency" not in found:
            found["angular_frequency"] = UNIT.get(unit, 1.0) * found.pop("frequency")
        if function is None and of_head and of_head != length:
            function = function_of_table(found["angular_frequency"], found, of_head)
        if function is not None:
            found["amplitude"] = displacements(function, length)
    except DataFileError as error:
        raise PlotError(f"{path}: {error}") from None
    return DrawnMeasured("", found["angular_frequency"] / UNIT.get(unit, 1.0), found["amplitude"])


def draw_measured(
    axes: Axes,
    measured: Sequence[DrawnMeasured],
    dof: str,
    curves: Sequence[DrawnCurve],
    colours: Sequence[str],
) -> bool:
    """Mark the points of a degree of freedom in the colours of their curves; return whether there are any."""
    drawn = False
    for one in measured:
        if one.dof not in ("", dof):
            continue
        drawn = True
        for number, rows in _by_curve(one, curves):
            axes.plot(
                one.frequency[rows], one.amplitude[rows], "+", markersize=SIZE, label=f"_{WORD}",
                color=NEUTRAL if number is None or len(curves) == 1 else colours[number],
            )  # fmt: skip
    return drawn


def _by_curve(
    one: DrawnMeasured, curves: Sequence[DrawnCurve]
) -> list[tuple[int | None, npt.NDArray[np.intp]]]:
    """Number of each curve with the points that have its force level; None for the other points."""
    if one.level is None:
        return [(None, np.arange(one.frequency.size))]
    found: list[tuple[int | None, npt.NDArray[np.intp]]] = []
    free = np.ones(one.frequency.size, dtype=bool)
    for number, curve in enumerate(curves):
        here = free & np.isclose(
            one.level, curve.parameters.get(EXCITED, np.nan), rtol=READ.same_level, atol=0.0
        )
        free &= ~here
        found += [(number, np.flatnonzero(here))] if here.any() else []
    return [*found, (None, np.flatnonzero(free))] if free.any() else found


def fitted_of(data: Any) -> tuple[FittedNumber, ...]:
    """The numbers that a fit found, from the summary of an open file; empty without a fit."""
    if not any(name in data.variables for name in ("data_frequency", "data_displacement")):
        return ()
    try:
        summary = summary_of(data)
        numbers, units = summary.get("fitted", {}).get("numbers", {}), summary.get("units", {})
        given = units.get("length", ""), units.get("force", ""), summary.get("frequency_unit", "")
        return tuple(
            FittedNumber(
                str(key),
                float(one["value"]),
                np.nan if one["standard_error"] is None else float(one["standard_error"]),
                unit_of_number(str(key), *given),
            )
            for key, one in numbers.items()
        )
    except (AttributeError, LookupError, TypeError) as error:
        raise ValueError("its attribute summary is not of a fit") from error


def name_measured(
    figure: Figure,
    fitted: Sequence[FittedNumber] = (),
    others: Mapping[str, Artist] | None = None,
    beside: Legend | None = None,
) -> Legend:
    """Name the crosses and the fitted numbers above the axes, left of a legend beside the axes, if any.

    others : further artists to be named there, by their names
    """
    from matplotlib.lines import Line2D

    names: list[tuple[Artist, str]] = [(handle, name) for name, handle in (others or {}).items()]
    names.append((Line2D([], [], linestyle="none", marker="+", color=NEUTRAL, markersize=SIZE), WORD))
    names += [(Line2D([], [], linestyle="none"), str(one)) for one in fitted]
    room = figure.bbox.width - (beside.get_window_extent().width if beside is not None else 0.0)
    for columns in range(min(len(names), 1 + LAYOUT.fitted_of_row), 1, -1):
        legend = _above(figure, names, columns, beside is not None)
        if legend.get_window_extent().width <= room:
            return legend
        legend.remove()
    return _above(figure, names, 1, beside is not None)


def _above(figure: Figure, names: Sequence[tuple[Artist, str]], columns: int, left: bool) -> Legend:
    handles, words = zip(*names, strict=True)
    return figure.legend(
        handles, words, loc="outside upper left" if left else "outside upper right", ncols=columns,
        handlelength=0.8, handletextpad=0.4,
    )  # fmt: skip
