"""Reads measured points: columns of a CSV file, arrays of .mat or .npz, functions of a universal file.

A response has the columns frequency, amplitude, and optionally phase (rad), weight and levels. A backbone has
amplitude, frequency, damping (ratios) and weight. Some columns have other names in files written by
``fcm respond --csv``. A heading may end with a unit, as in ``frequency [Hz]``.
"""

from __future__ import annotations

import csv
import re
from collections.abc import Collection, Mapping, Sequence
from pathlib import Path
from types import MappingProxyType
from typing import NamedTuple

import numpy as np

from fcm.files import MEASURED
from fcm.model.scene import FloatArray
from fcm.scene.errors import choices, quoted
from fcm.scene.files import DataFileError, Files
from fcm.scene.measured_units import FREQUENCIES, hertz_of
from fcm.scene.npz_file import names_in_npz, read_npz
from fcm.scene.number_text import fault_of_number, number_in
from fcm.scene.options import MESSAGES
from fcm.scene.reader_process import NAMES, read_apart
from fcm.scene.uff_functions import Function, read_function
from fcm.units import UNIT

_HEAD = re.compile(r"(\w+)[\s_]*(?:[(\[/,]([^()\[\]]*)[)\]]?)?")  # a name, then a unit
_UNITS = {"phase": {"rad": 1.0, "deg": np.pi / 180.0}, "damping": {"1": 1.0, "%": 0.01}}


class MeasuredFile(NamedTuple):
    """Columns of measured points by name; for a universal file also the function that they come from.

    units: units from the headings of columns, by name. Frequencies, phases and damping are already converted,
    and have none.
    """

    columns: dict[str, FloatArray]
    function: Function | None = None
    units: Mapping[str, str] = MappingProxyType({})


def read_measured(
    name: str,
    files: Files,
    wanted: Sequence[str],
    optional: Collection[str],
    others: Mapping[str, str] | None = None,
    places: tuple[str, str] = ("", ""),
) -> MeasuredFile:
    """The columns of a file, (point,) each: all wanted ones, and those optional ones that it has.

    others: the names of wanted columns in files of ``fcm respond``. places: the measured degree of freedom
    and that of the force, to choose one of several functions. If a file states the unit of its frequencies,
    as a universal file does, the result has angular_frequency [rad/s] in place of frequency.

    Raises
    ------
    DataFileError
        If the file cannot be read, or a column is missing or holds something that is not a number.
    """
    others = others or {}
    ending = Path(name).suffix.lower()
    if ending not in MEASURED:
        raise DataFileError(f"{quoted(name)}: measured points are read from {choices(MEASURED)}")
    units: dict[str, str] = {}
    with files.opened(name) as path:
        if ending in (".uff", ".unv"):
            function = read_function(path, *places)
            omega = 2.0 * np.pi * function.hertz
            return MeasuredFile({"angular_frequency": omega, "amplitude": np.abs(function.value)}, function)
        if ending in (".mat", ".npz"):
            found, named = _arrays(path, [*wanted, *others.values(), *optional], files)
            chosen = _chosen(found, wanted, optional, others)
            found = {key: found[its] for key, its in chosen.items()}
        else:
            found, named, units = _csv(path, wanted, optional, others)
    there = {*found, *(["frequency"] if "angular_frequency" in found else [])}
    if missing := [one for one in wanted if one not in there]:
        heads = [quoted(one) + (f" (or {quoted(others[one])})" if one in others else "") for one in missing]
        write = "".join(_right_head(one, named) for one in missing)
        raise DataFileError(
            f"{quoted(name)} has no column {', '.join(heads)}; it has {choices(named)}{write}"
        )
    sizes = {value.size for value in found.values()}
    if len(sizes) > 1:
        each = ", ".join(f"{key} {value.size}" for key, value in found.items())
        raise DataFileError(f"{quoted(name)}: its columns are of different lengths: {each}")
    if sizes == {0}:
        raise DataFileError(f"{quoted(name)} holds no points")
    return MeasuredFile(found, None, units)


def _chosen(
    heads: Collection[str], wanted: Collection[str], optional: Collection[str], others: Mapping[str, str]
) -> dict[str, str]:
    """By column to read, its name in the file; a column's own name takes precedence over its other name."""
    names = {key: [key, *([others[key]] if key in others else [])] for key in (*wanted, *optional)}
    found = {key: next((one for one in every if one in heads), None) for key, every in names.items()}
    return {key: one for key, one in found.items() if one is not None}


def _arrays(path: Path, wanted: Sequence[str], files: Files) -> tuple[dict[str, FloatArray], list[str]]:
    """Vectors of numbers by their names, and the names of all arrays."""
    if path.suffix.lower() == ".npz":
        arrays, named = dict(read_npz(path, wanted, files)), names_in_npz(path)
    else:
        arrays = dict(read_apart(path, wanted, files))
        named = arrays.pop(NAMES, np.array([])).tolist()
    found = {}
    for key, value in arrays.items():
        if value.dtype.kind not in "iuf" or max(value.shape, default=0) != value.size:
            raise DataFileError(f"{quoted(path.name)}: {quoted(key)} is no vector of real numbers")
        found[key] = np.asarray(value, dtype=np.float64).ravel()
        if not np.isfinite(found[key]).all():
            at = int(np.flatnonzero(~np.isfinite(found[key]))[0])
            raise DataFileError(
                f"{quoted(path.name)}: {key}[{at}] is {found[key][at]}; leave such points out"
            )
    return found, named


def _csv(
    path: Path, wanted: Sequence[str], optional: Collection[str], others: Mapping[str, str]
) -> tuple[dict[str, FloatArray], list[str], dict[str, str]]:
    """Columns of a text file, the headings in its first line, and the units in these headings.

    Lines that begin with # are skipped. A word that is not a number is a fault only in columns that are read.
    """
    try:
        text = path.read_text(encoding="utf-8-sig")
    except UnicodeDecodeError as error:
        at = error.object.count(b"\n", 0, error.start) + 1
        said = f"it is no text in UTF-8, from line {at} on: save it as UTF-8"
        raise DataFileError(f"{quoted(path.name)} cannot be read: {said}") from None
    lines = [(number, line) for number, line in enumerate(text.splitlines(), 1) if line.strip(" ,;\t")]
    lines = [(number, line) for number, line in lines if not line.lstrip().startswith("#")]
    if not lines:
        raise DataFileError(
            f"{quoted(path.name)} is empty; its first line must name its columns: frequency,amplitude"
        )
    between = next((one for one in ",;\t" if one in lines[0][1]), None)
    header = _words(lines[0][1], between)
    if all(number_in(word) is not None for word in header):
        first = quoted(lines[0][1].strip(), 40)
        what = f"its first line, {first}, must name its columns, as frequency,amplitude"
        raise DataFileError(f"{quoted(path.name)}: {what}")
    twice = [name for name in dict.fromkeys(header) if header.count(name) > 1]
    if twice:
        raise DataFileError(f"{quoted(path.name)}: its first line names {choices(twice)} twice")
    heads = [_name_and_unit(word) for word in header]
    places = {name: i for i, (name, _) in reversed(list(enumerate(heads)))}
    chosen = {key: places[its] for key, its in _chosen(places, wanted, optional, others).items()}
    rows, faults = [], []
    for number, line in lines[1:]:
        words = _words(line, between)
        if len(words) != len(header):
            faults.append(f"line {number} has {len(words)} entries; the first line names {len(header)}")
            continue
        values = {key: number_in(words[i]) for key, i in chosen.items()}
        faults += [
            f"line {number}: {header[chosen[key]]}: {fault_of_number(words[chosen[key]])}"
            for key, value in values.items()
            if value is None
        ]
        rows.append((words, list(values.values())))
    faults += _curves([words for words, _ in rows], heads, chosen, others)
    if faults:
        raise DataFileError(*(f"{quoted(path.name)}, {fault}" for fault in faults[: MESSAGES.faults]))
    table = np.array([values for _, values in rows], dtype=np.float64).reshape(len(rows), len(chosen))
    found = dict(zip(chosen, table.T.copy(), strict=True))
    units = {key: heads[i][1] for key, i in chosen.items() if heads[i][1]}
    found = _in_units(found, units, path.name)
    return found, header, {key: unit for key, unit in units.items() if key not in ("frequency", *_UNITS)}


def _right_head(column: str, heads: Sequence[str]) -> str:
    """Hint on a heading that resembles that of a column; else ''.

    >>> _right_head("frequency", ["f", "Frequency (Hz)"]), _right_head("frequency", ["f"])
    ('; write "Frequency (Hz)" as "frequency [Hz]"', '')
    """
    for head in heads:
        found = _HEAD.fullmatch(head)
        if found and found[1].lower() == column and head != column:
            unit = f" [{found[2].strip()}]" if found[2] and found[2].strip() else ""
            return f"; write {quoted(head)} as {quoted(column + unit)}"
    return ""


def _name_and_unit(head: str) -> tuple[str, str]:
    """Name and unit of a column, from its heading.

    >>> _name_and_unit("frequency [rad/s]"), _name_and_unit("frequency")
    (('frequency', 'rad/s'), ('frequency', ''))
    """
    name, opened, unit = head.partition(" [")
    return (name, unit[:-1]) if opened and unit.endswith("]") else (head, "")


def _curves(
    rows: Sequence[Sequence[str]],
    heads: Sequence[tuple[str, str]],
    chosen: Mapping[str, int],
    others: Mapping[str, str],
) -> list[str]:
    """Fault of a file of ``fcm respond`` that contains several curves, as a list; empty if it has one."""
    own = any(heads[i][0] == others.get(key) for key, i in chosen.items())
    places = [i for i, (name, _) in enumerate(heads) if name == "curve"]
    found = len({row[places[0]] for row in rows}) if own and places else 1
    return [f"column curve: it has {found} curves; leave the points of one"] if found > 1 else []


def _in_units(found: dict[str, FloatArray], units: Mapping[str, str], file: str) -> dict[str, FloatArray]:
    """Converts frequencies to rad/s if the file states their unit, phases to rad, damping to ratios.

    An unknown unit raises DataFileError.
    """
    if unit := units.get("frequency", ""):
        size = UNIT.get(unit) or 2.0 * np.pi * (hertz_of(unit) or 0.0)
        if not size:
            known = choices(FREQUENCIES)
            raise DataFileError(f"{quoted(file)}: its frequency is in {quoted(unit)}; known are {known}")
        found["angular_frequency"] = size * found.pop("frequency")
    for key, known_units in _UNITS.items():
        unit = units.get(key, "")
        if unit in known_units:
            found[key] *= known_units[unit]
        elif unit:
            known = choices(known_units)
            raise DataFileError(f"{quoted(file)}: its {key} is in {quoted(unit)}; known are {known}")
    return found


def _words(line: str, between: str | None) -> list[str]:
    if between is None:
        return line.split()
    return [word.strip() for word in next(csv.reader([line], delimiter=between))]
