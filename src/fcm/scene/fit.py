"""Reads the [fit] table of a scene: the numbers to fit, their bounds, and the measured data."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from fcm.model.question import Question
from fcm.model.scene import Fit, FloatArray, Measured
from fcm.rotational_dofs import dof_unit
from fcm.scene.address import LEVEL
from fcm.scene.draft import Draft, Number
from fcm.scene.errors import choices, counted, kind, quoted, shown
from fcm.scene.files import DataFileError, Files
from fcm.scene.keys import names
from fcm.scene.measured_function import (
    ComparedFile,
    Excitation,
    Surroundings,
    compare,
    force_factor,
    function_of_table,
)
from fcm.scene.measured_units import units_in
from fcm.scene.names import Names
from fcm.scene.optimum import pair_of_bounds, varied_numbers
from fcm.scene.options import LIMITS
from fcm.scene.rules import FRACTION, POSITIVE, Rule
from fcm.scene.section import Section
from fcm.units import ANGLES, PER_TIME, QUANTITIES, UNIT, in_unit

if TYPE_CHECKING:
    from fcm.scene.measured_file import MeasuredFile
    from fcm.scene.uff_functions import Function

RESPONSE_KEYS = ("dof", "level", "quantity", "amplitude_error", "frequency_error")
BACKBONE_KEYS = ("dof", "mode", "frequency_error", "damping_error")
MODE = Rule("a whole number of at least 1", low=1.0, whole=True)
STARTS = Rule("a whole number from 1 to 100", low=1.0, high=100.0, whole=True)
NOT_POSITIVE: Callable[[FloatArray], Any] = lambda values: ~(values > 0.0)  # noqa: E731
NEGATIVE: Callable[[FloatArray], Any] = lambda values: ~(values >= 0.0)  # noqa: E731
TOO_LARGE: Callable[[FloatArray], Any] = lambda values: ~(abs(values) <= LIMITS.largest)  # noqa: E731
RIGHT = {
    "frequency": (NOT_POSITIVE, "greater than 0"),
    "angular_frequency": (NOT_POSITIVE, "greater than 0"),
    "amplitude": (NEGATIVE, "at least 0"),
    "weight": (NEGATIVE, "at least 0"),
}


def read_fit(top: Section, files: Files, draft: Draft, reported: Sequence[str], unit: str) -> Fit | None:
    """Reads the [fit] table; None without it, or after a mistake."""
    section = top.table("fit", "") if "fit" in top.data else None
    if section is None:
        return None
    section.only(*names("fit"))
    before = section.mistakes.count
    for other in ("optimum", "sweep", "schedule"):
        if other in top.data:
            section.wrong("", f"is of no use with [{other}]: fit first, then use the numbers found")
    refused = {LEVEL: "the level of the forces belongs to the data: give it there"}
    numbers = varied_numbers(section, draft, "contact.shroud.mu", LIMITS.fitted, refused)
    bounds = _bounds(section, numbers)
    starts = section.number("starts", STARTS) if "starts" in section.data else None
    sections = section.tables("data")
    if not sections and section.mistakes.count == before:
        section.wrong("data", "missing; give [[fit.data]] with the file of measured points")
    scene = Surroundings(reported, units_in(top.data), files.noted)
    for i, one in enumerate(sections):
        if one.data in [other.data for other in sections[:i]]:
            one.wrong("", "is there twice: the same data would count as measured again, with smaller errors")
    data = [_data(one, files, draft, scene, UNIT[unit]) for one in sections]
    if section.mistakes.count > before:
        return None
    known = tuple(one for one in data if one)
    values = sum(one.values for one in known)
    if values <= len(numbers):
        what = f"has {counted(values, 'measured value')} for {counted(len(numbers), 'number')}"
        section.wrong("data", f"{what}; give more values than numbers that vary")
        return None
    keys = tuple(number.key for number in numbers if number)
    return Fit(keys, tuple(bounds), known, None if starts is None else int(starts))


def notes_of_data(fit: Fit | None, ends: tuple[float, float], unit: str) -> list[str]:
    """A question on each measured response with all frequencies outside the scene's range, ends [rad/s]."""
    said = list[str]()
    for one in fit.data if fit is not None else ():
        low, high = float(one.frequency.min()), float(one.frequency.max())
        if one.damping is None and not (low <= ends[1] and high >= ends[0]) and np.isfinite(ends).all():
            own, whole = (
                " to ".join(f"{float(in_unit(end, unit)):.6g}" for end in both)
                for both in ((low, high), ends)
            )
            said.append(
                Question(
                    f"fit: {one.file} has frequencies from {own} {unit}, none within the range, "
                    f"{whole} {unit}. Is its unit that of the scene?"
                )
            )
    return said


def _bounds(section: Section, numbers: Sequence[Number | None]) -> list[tuple[float, float] | None]:
    """Bounds [from, to] of each number; None for those without."""
    value = section.data.get("bounds")
    if value is None or not numbers:
        return [None] * len(numbers)
    if not isinstance(value, list | tuple) or len(value) != len(numbers):
        what = f"a list of {len(value)}" if isinstance(value, list | tuple) else kind(value)
        section.wrong("bounds", f"must be [from, to] for each of the {len(numbers)} that vary, is {what}")
        return [None] * len(numbers)
    return [
        None if number is None else pair_of_bounds(section, number, pair)
        for number, pair in zip(numbers, value, strict=True)
    ]


def _data(section: Section, files: Files, draft: Draft, scene: Surroundings, unit: float) -> Measured | None:
    """Reads one set of measured points."""
    before = section.mistakes.count
    backbone = "backbone" in section.data
    if backbone and "file" in section.data:
        section.wrong("backbone", "is given beside file; give one: a response, or a backbone")
    for key in section.data:
        allowed = BACKBONE_KEYS if backbone else RESPONSE_KEYS
        if key in names("fit.data") and key not in (*allowed, "file", "backbone"):
            section.wrong(key, f"means nothing with a {'backbone' if backbone else 'response'}")
    section.only(*names("fit.data"))
    dof = _dof(section, scene.dofs, needed=not backbone)
    errors: dict[str, Any] = {
        key: section.number(key, FRACTION) if key in section.data else None
        for key in ("amplitude_error", "frequency_error", "damping_error")
    }
    level = _level(section, draft)
    quantity = section.text("quantity", "displacement")
    if quantity and quantity not in QUANTITIES:
        section.wrong(
            "quantity", f"must be {choices(QUANTITIES)}, is {quoted(quantity)}", quantity, QUANTITIES
        )
    mode = section.number("mode", MODE, 1.0)
    name = section.text("backbone" if backbone else "file")
    column = level if isinstance(level, str) else ""
    others = {"damping": "damping_ratio"} if backbone else {}
    others["amplitude"] = f"amplitude {dof}" if dof else "modal_amplitude"
    driven = _excitation(draft)
    read = _columns(section, files, name, column, others, driven) if name else None
    if read is None or section.mistakes.count > before:
        return None
    columns = read.columns
    scaled = columns["angular_frequency"] if "angular_frequency" in columns else unit * columns["frequency"]
    count = scaled.size
    levels = np.full(count, 1.0 if isinstance(level, str) else level)
    compared = ComparedFile(name, scene, driven, section.wrong)
    if isinstance(level, str):
        force = columns[level] * force_factor(compared, read.units.get(level, ""))
        levels = force / abs(_force(driven))
    if read.function is None and "phase" in columns:
        largest = float(np.abs(columns["phase"]).max())
        if largest > ANGLES.largest:
            asked = f"has a phase of {shown(largest)} rad. Are they in degrees? Call the column phase [deg]"
            scene.noted.append(Question(f"fit: {name} {asked}"))
    function = read.function or _function_of_table(section, read, scaled, name, dof, scene)
    if function is not None:
        given = quantity if "quantity" in section.data or backbone else ""
        quantity, factor = compare(compared, function, dof, given)
        value = factor * function.value
        if function.per_reference and driven is not None:
            value = value * levels * driven.amplitude * scaled**driven.power
        columns["amplitude"] = np.abs(value)
        if function.phased:
            columns["phase"] = np.angle(value)
    if section.mistakes.count > before:
        return None
    amplitude = columns["amplitude"]
    weight = columns.get("weight", np.ones(count))
    if not weight.max() > 0.0:
        section.wrong("file" if not backbone else "backbone", f"{quoted(name)}: all weights are 0")
        return None
    if not amplitude.max() > 0.0:
        section.wrong("file" if not backbone else "backbone", f"{quoted(name)}: all amplitudes are 0")
        return None
    used = weight > 0.0
    columns = {key: value[used] for key, value in columns.items()}
    scaled, amplitude, weight, levels = scaled[used], amplitude[used], weight[used], levels[used]
    again = scaled.size - len(set(zip(scaled.tolist(), levels.tolist(), amplitude.tolist(), strict=True)))
    if again:
        asked = f"has {again} of its {scaled.size} points again. Each counts as a measurement of its own, so"
        scene.noted.append(Question(f"fit: {name} {asked} that standard errors are too small. Is it meant?"))
    return Measured(
        name, dof, scaled, amplitude, weight, levels, columns.get("phase"),
        columns.get("damping"), quantity, int(mode), **errors,
    )  # fmt: skip


def _function_of_table(
    section: Section, read: MeasuredFile, omega: FloatArray, name: str, dof: str, scene: Surroundings
) -> Function | None:
    """The measured function of a table whose amplitude unit differs from the scene's; None if it does not."""
    unit, backbone = read.units.get("amplitude", ""), "backbone" in section.data
    quantity = str(section.data.get("quantity", "displacement"))
    length = dof_unit(dof, scene.units[0])
    if not unit or (length and unit == f"{length}{PER_TIME.get(quantity, '')}"):
        return None
    key = "backbone" if backbone else "file"
    if not dof:
        if length and unit != length:
            section.wrong(
                key, f"{quoted(name)}: its amplitude is modal, and in {quoted(unit)}; give it without"
            )
        return None
    try:
        found = function_of_table(omega, read.columns, unit)
    except DataFileError as error:
        section.wrong(key, f"{quoted(name)}: {error}")
        return None
    if backbone and found.per_reference:
        section.wrong(key, f"{quoted(name)}: its amplitude is in {unit}, and a backbone is of displacements")
        return None
    return found


def _columns(
    section: Section,
    files: Files,
    name: str,
    level: str,
    others: Mapping[str, str],
    driven: Excitation | None,
) -> MeasuredFile | None:
    """The columns of a file, or its measured function; None after a mistake."""
    from fcm.scene.measured_file import read_measured

    backbone = "backbone" in section.data
    key = "backbone" if backbone else "file"
    wanted = ["frequency", "amplitude", *(["damping"] if backbone else []), *([level] if level else [])]
    try:
        optional = ("weight",) if backbone else ("phase", "weight")
        dof = section.data.get("dof")
        places = (dof if isinstance(dof, str) else "", driven.dof if driven else "")
        read = read_measured(name, files, wanted, optional, others, places)
    except DataFileError as error:
        for fault in error.faults:
            section.wrong(key, fault)
        return None
    faults, found = [], read.columns
    if backbone and "damping" not in found:
        faults.append("has no damping ratios; a backbone is read from .csv, .mat or .npz")
    if level and level not in found:
        faults.append(f"has no column {quoted(level)}; give the level as a number")
    right = RIGHT | ({level: (NOT_POSITIVE, "greater than 0")} if level else {})
    right |= {"amplitude": (NOT_POSITIVE, "greater than 0")} if backbone else {}
    checks = [*right.items(), *((column, (TOO_LARGE, f"at most {LIMITS.largest:g}")) for column in found)]
    for column, (wrong, text) in checks:
        if column in found and (at := np.flatnonzero(wrong(found[column]))).size:
            value = shown(float(found[column][at[0]]))
            faults.append(f"{column} of point {at[0] + 1} must be {text}, is {value}")
    for fault in faults:
        section.wrong(key, f"{quoted(name)}: {fault}")
    return None if faults else read


def _dof(section: Section, reported: Sequence[str], needed: bool) -> str:
    """The degree of freedom that was measured; empty where none is named."""
    if "dof" not in section.data and not needed:
        return ""
    dof = section.text("dof")
    found = Names(reported).find(dof) if reported and dof else dof
    if dof and not found:
        section.wrong(
            "dof",
            f"there is no degree of freedom {quoted(dof)} in the results, which have {choices(reported)}",
            dof,
            reported,
        )
    return found or dof


def _level(section: Section, draft: Draft) -> float | str:
    """The level of the scene's forces, or the name of the column with the force of each point."""
    value = section.data.get("level", 1.0)
    if not isinstance(value, str):
        return section.number("level", POSITIVE, 1.0)
    if not _force(_excitation(draft)):
        section.wrong(
            "level", "is a column of forces, which needs a scene with one [[force]] of an amplitude"
        )
    return value


def _force(driven: Excitation | None) -> complex:
    """The amplitude of the scene's only force, which the level multiplies; 0 if there is not exactly one."""
    return driven.amplitude if driven is not None else 0.0


def _excitation(draft: Draft) -> Excitation | None:
    """The only force of a scene, or its base motion; None if there is not exactly one.

    For a force on a single degree of freedom the amplitude includes its weight.
    """
    found = []
    for one in draft.parts["force"]:
        if one["amplitude"]:
            dof = one["dof"]
            weights = dof[dof != 0.0] if dof is not None else np.ones(1)
            amplitude = one["amplitude"] * (weights[0] if weights.size == 1 else 1.0)
            turned = complex(amplitude * np.exp(1j * one["phase"]))
            found.append(Excitation(turned, one["name"], one["power"]))
    for one in draft.parts["base"]:
        if one.get("acceleration"):
            found.append(Excitation(complex(one["acceleration"] * np.exp(1j * one["phase"])), base=True))
    return found[0] if len(found) == 1 else None
