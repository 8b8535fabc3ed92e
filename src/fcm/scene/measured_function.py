"""Compares a measured function with the scene: its place, quantity and units.

Place, quantity and units stated in a universal file are compared with the measurement of [[fit.data]] and
the force of the scene. A contradicting quantity is a mistake, another place is questioned, another unit is
converted. The heading of a column of a table may state a unit, too.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from math import isclose
from typing import NamedTuple

import numpy as np

from fcm.frozen import Frozen
from fcm.model.question import Question
from fcm.model.scene import FloatArray
from fcm.rotational_dofs import is_rotation
from fcm.scene.errors import quoted
from fcm.scene.files import DataFileError
from fcm.scene.measured_units import force_unit, length_unit, motion_unit, ratio_of
from fcm.scene.names import motion_of
from fcm.scene.uff_functions import Axis, Function, Location
from fcm.scene.uff_qualifiers import UNKNOWN, Qualifiers
from fcm.units import PER_TIME, QUANTITIES

FORCES = ("force", "reaction force")


class Excitation(Frozen):
    """The excitation of a scene with a single harmonic force or a base motion."""

    amplitude: complex  # along the axis: A in Im(A exp(i omega t))
    dof: str = ""  # degree of freedom of a force on a single one
    power: int = 0  # the force is proportional to this power of omega
    base: bool = False


class Surroundings(NamedTuple):
    """The parts of a scene that measured functions are compared with."""

    dofs: Sequence[str]
    units: tuple[str, str]  # of length and force, empty if the scene does not state them
    noted: list[str]  # receives notes


class Scale(NamedTuple):
    """The quantity of the values of a file, and the factor that converts them to the units of the scene."""

    quantity: str
    factor: float


def function_of_table(omega: FloatArray, columns: Mapping[str, FloatArray], unit: str) -> Function:
    """The function over frequencies [rad/s] from columns of amplitudes, in a unit, and phases.

    A unit that is not one of motion raises DataFileError.
    """
    upper, lower = ratio_of(unit)
    if motion_unit(upper) is None:
        raise DataFileError(
            f"its amplitude is in {quoted(unit)}, no unit of a motion that is known. Units are of length or "
            "angle, as mm or deg, each also by s or s^2, and g. Each may be by a unit of force, as mm/N"
        )
    phase = columns.get("phase")
    return Function(
        hertz=omega / (2.0 * np.pi),
        value=columns["amplitude"] * np.exp(1j * (np.zeros_like(omega) if phase is None else phase)),
        phased=phase is not None,
        per_reference=bool(lower),
        response=Location(),
        reference=Location(),
        ordinate=Axis("", unit),
        denominator=Axis(),
        system=None,
        of_table=True,
    )


class ComparedFile(NamedTuple):
    """A file of measured data and the scene it is compared with; collects mistakes and notes on it."""

    name: str
    scene: Surroundings
    excitation: Excitation | None
    wrong: Callable[[str, str], None]  # notes a mistake; takes a key and what is wrong there

    def mistake(self, what: str, key: str = "file") -> None:
        self.wrong(key, f"{quoted(self.name)} {what}")

    def note(self, what: str) -> None:
        self.scene.noted.append(f"fit: {self.name} {what}")

    def ask(self, what: str) -> None:
        self.scene.noted.append(Question(f"fit: {self.name} {what}"))

    def note_once(self, what: str) -> None:
        """Notes once what applies to all files."""
        if (said := f"fit: {what}") not in self.scene.noted:
            self.scene.noted.append(said)


def compare(file: ComparedFile, function: Function, dof: str, quantity: str) -> Scale:
    """The quantity and the conversion factor of a function's values; disagreements are noted.

    dof and quantity are those of the measurement; quantity is empty if the scene does not state it.
    """
    _compare_places(file, function, dof)
    upper, lower = ratio_of(function.ordinate.unit)
    ordinate = function.ordinate._replace(unit=upper)
    if function.unknown_unit:
        file.ask(f"has frequencies in {quoted(function.unknown_unit)}, taken for Hz. Are they?")
    found = _quantity(file, ordinate, dof, quantity)
    factor = _factor(file, ordinate, dof, found, function.system)
    if not function.of_table:
        factor *= _of_qualifiers(file, function)
    if function.per_reference:
        factor /= _reference_factor(file, function, lower)
    if not function.phased and not function.of_table:
        file.note("has no phase: a displacement is taken as half the peak-to-peak value")
    return Scale(found, factor)


def _of_qualifiers(file: ComparedFile, function: Function) -> float:
    """The factor that converts amplitudes to half the peak-to-peak value, by dataset 1858."""
    known, spectrum = function.qualifiers or Qualifiers(), not function.per_reference
    if fault := known.fault(spectrum):
        file.mistake(fault)
        return 1.0
    if known.damps:
        file.note(
            "was measured with an exponential window (dataset 1858), which adds damping: a fit takes it for "
            "that of the structure"
        )
    if not spectrum:
        return 1.0
    if known.scale == UNKNOWN:
        file.ask(
            "does not say whether its amplitudes are peak values or RMS (dataset 1858): taken for peak "
            "values. Are they? RMS are 0.707 of these: export peak values, or that dataset, too"
        )
    elif known.factor() != 1.0:
        file.note("has RMS amplitudes (dataset 1858), multiplied by the square root of 2")
    return known.factor()


def force_factor(file: ComparedFile, unit: str) -> float:
    """The factor that converts a column of forces, or of base accelerations, to the units of the scene."""
    units = file.scene.units
    if file.excitation is not None and file.excitation.base:
        return _factor(file, Axis("", unit), "", "acceleration", None)
    if unit in ("", units[1]):
        return 1.0
    if (size := force_unit(unit)) is None:
        file.mistake(f"has levels in {quoted(unit)}, which is no known unit of force", "level")
        return 1.0
    return _converted(file, size, unit, force_unit(units[1]), units[1], "N")


def _compare_places(file: ComparedFile, function: Function, dof: str) -> None:
    """Asks if the file belongs to another degree of freedom, by node and direction or by name."""
    excitation = file.excitation
    pairs = [("the response at", "the measurement is at", function.response, dof)]
    if function.per_reference and excitation is not None and excitation.dof:
        pairs.append(("a force at", "the force of the scene is at", function.reference, excitation.dof))
    for what, own, place, name in pairs:
        if other := _elsewhere(place, name, file.scene.dofs):
            file.ask(f"has {what} {other}, and {own} {name}. Is it the right file?")


def _elsewhere(place: Location, dof: str, dofs: Sequence[str]) -> str:
    """The name of a place if it is another degree of freedom, by node and direction or by name; else ''."""
    if motion_of(dof):
        return place.dof if place.dof != motion_of(dof) else ""
    return place.entity if place.entity != dof and place.entity in dofs else ""


def _quantity(file: ComparedFile, ordinate: Axis, dof: str, given: str) -> str:
    """The measured quantity by type or unit in the file; a contradiction to the scene is a mistake."""
    unit = motion_unit(ordinate.unit)
    if ordinate.what and ordinate.what not in QUANTITIES:
        file.mistake(
            f"says that it is of {ordinate.what}, and a fit is to {given or 'the motion'} at {quoted(dof)}: "
            "displacement, velocity or acceleration"
        )
        return given or "displacement"
    if ordinate.what and unit and unit.quantity != ordinate.what:
        file.mistake(f"says that it is {ordinate.what}, in {ordinate.unit}, the unit of {unit.quantity}")
    found = ordinate.what or (unit.quantity if unit else "")
    if found and given and found != given:
        file.wrong("quantity", f"is {quoted(given)}, and {quoted(file.name)} says that it is {quoted(found)}")
    if unit and unit.angular != is_rotation(dof):
        kinds = ["a displacement", "a rotation"]
        kinds = kinds if unit.angular else kinds[::-1]
        file.mistake(f"is in {ordinate.unit}, the unit of {kinds[1]}, and {quoted(dof)} is {kinds[0]}")
    if not found and not given:
        file.ask("does not say what its values are of: are they displacements? Say it by quantity")
    return found or given or "displacement"


def _factor(
    file: ComparedFile, ordinate: Axis, dof: str, quantity: str, system: tuple[float, float] | None
) -> float:
    """The factor that converts values of the file to the unit of the scene."""
    units = file.scene.units
    turning, end = is_rotation(dof), PER_TIME[quantity]
    own = f"rad{end}" if turning else f"{units[0]}{end}" if units[0] else ""
    known, size, label = motion_unit(ordinate.unit), None, ordinate.unit
    if known is None and label:
        file.ask(f"is in {quoted(label)}, which is not known: taken for {own or 'that of the scene'}")
        return 1.0
    if known:
        size = known.size
    elif system and not turning:
        size, label = system[0], f"m{end}" if system[0] == 1.0 else f"units of {system[0]:g} m{end}"
    return _converted(file, size, label, 1.0 if turning else length_unit(units[0]), own, f"m{end}")


def _reference_factor(file: ComparedFile, function: Function, lower: str) -> float:
    """The factor that converts the reference to the unit of the scene; another excitation is a mistake."""
    denominator, excitation, units = function.denominator, file.excitation, file.scene.units
    if excitation is None:
        file.mistake("has responses per unit of force, which needs a scene with one [[force]] or a [base]")
        return 1.0
    if denominator.what and excitation.base != (denominator.what not in FORCES):
        driven = "the acceleration of its base" if excitation.base else "a [[force]]"
        file.mistake(f"is per unit of {denominator.what}, and the scene is driven by {driven}")
        return 1.0
    if excitation.base:
        if denominator.what not in ("", "acceleration"):
            file.mistake(f"is per unit of {denominator.what}, and the scene has the acceleration of its base")
        return _factor(file, denominator, "", "acceleration", function.system)
    label = denominator.unit or lower
    size = force_unit(label) if label else (function.system[1] if function.system else None)
    if size is None and label:
        own = units[1] or "that of the scene"
        file.ask(f"is per unit of force in {quoted(label)}, which is not known: taken for {own}")
        return 1.0
    if not label and size is not None:
        label = "N" if size == 1.0 else f"units of {size:g} N"
    return _converted(file, size, label, force_unit(units[1]), units[1], "N")


def _converted(
    file: ComparedFile, size: float | None, label: str, own: float | None, unit: str, plain: str
) -> float:
    """The ratio of a unit of the file to that of the scene, noted if not 1; 1 if either is unknown.

    size, label : of the unit of the file; own, unit : of that of the scene; plain : name of the SI unit.
    """
    if size is None:
        return 1.0
    if own is None and isclose(size, 1.0):
        file.note_once(f"measured in {plain}: the scene, without known [units], has to be in these, too")
        return 1.0
    if own is None:
        file.ask(f"is in {label}: is the scene, too? With its [units] of length and force it is converted")
        return 1.0
    if not isclose(size, own):
        file.note(f"is in {label}, converted to {unit}")
    return size / own


def displacements(function: Function, length: str) -> FloatArray:
    """Displacement amplitudes of a function, converted to a unit of length if both units are known.

    Raises
    ------
    DataFileError
        If the values are per unit of force, or not of a motion, or their qualifiers do not fit.
    """
    upper, _ = ratio_of(function.ordinate.unit)
    unit, own = motion_unit(upper), length_unit(length)
    what = function.ordinate.what or (unit.quantity if unit else "displacement")
    if function.per_reference:
        raise DataFileError("its amplitudes are per unit of force: they are no displacements")
    if what not in QUANTITIES:
        raise DataFileError(f"its values are of {what}: they are no displacements")
    known = function.qualifiers or Qualifiers()
    if fault := known.fault(spectrum=True):
        raise DataFileError(f"it {fault}")
    factor = known.factor() * (unit.size / own if unit and own and not unit.angular else 1.0)
    omega = 2.0 * np.pi * function.hertz
    found: FloatArray = factor * np.abs(function.value) / omega ** QUANTITIES[what]
    return found
