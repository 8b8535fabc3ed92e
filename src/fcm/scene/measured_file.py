"""Files of measured points: columns of a CSV file, arrays of .mat or .npz, functions of a universal file.

The columns of a response are frequency, amplitude, and any of phase (rad), weight, and one of levels; those
of a backbone amplitude, frequency, damping (ratios), weight.
"""

from __future__ import annotations

import csv
from collections.abc import Collection, Sequence
from pathlib import Path

import numpy as np

from fcm.files import MEASURED
from fcm.model.scene import FloatArray
from fcm.scene.errors import choices, quoted
from fcm.scene.files import DataFileError, Files
from fcm.scene.npz_file import names_in_npz, read_npz
from fcm.scene.number_text import fault_of_number, number_in
from fcm.scene.options import MESSAGES
from fcm.scene.reader_process import NAMES, read_apart
from fcm.scene.uff_functions import read_functions


def read_measured(
    name: str, files: Files, wanted: Sequence[str], optional: Collection[str]
) -> dict[str, FloatArray]:
    """The columns of a file, (point,) each: all that are wanted, and those of the optional that it has.

    A universal file is in Hz: it has angular_frequency [rad/s] in place of frequency, and per_force (point,)
    1 where amplitudes are those per unit of force, and power (point,) of the frequency that they have over
    displacements, where the file says it.

    Raises
    ------
    DataFileError
        If it cannot be read, or a column is missing or holds something that is no number.
    """
    ending = Path(name).suffix.lower()
    if ending not in MEASURED:
        raise DataFileError(f"{quoted(name)}: measured points are read from {choices(MEASURED)}")
    with files.opened(name) as path:
        if ending in (".uff", ".unv"):
            return read_functions(path)
        if ending in (".mat", ".npz"):
            found, named = _arrays(path, [*wanted, *optional], files)
        else:
            found, named = _csv(path)
    missing = [one for one in wanted if one not in found]
    if missing:
        raise DataFileError(f"{quoted(name)} has no column {choices(missing)}; it has {choices(named)}")
    found = {key: value for key, value in found.items() if key in (*wanted, *optional)}
    sizes = {value.size for value in found.values()}
    if len(sizes) > 1:
        each = ", ".join(f"{key} {value.size}" for key, value in found.items())
        raise DataFileError(f"{quoted(name)}: its columns are of different lengths: {each}")
    if sizes == {0}:
        raise DataFileError(f"{quoted(name)} holds no points")
    return found


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


def _csv(path: Path) -> tuple[dict[str, FloatArray], list[str]]:
    """The columns of a text file, whose first line names them; lines that begin with # are passed over."""
    text = path.read_text(encoding="utf-8-sig")
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
    rows, faults = [], []
    for number, line in lines[1:]:
        words = _words(line, between)
        if len(words) != len(header):
            faults.append(f"line {number} has {len(words)} entries; the first line names {len(header)}")
            continue
        values = [number_in(word) for word in words]
        faults += [
            f"line {number}: {name}: {fault_of_number(word)}"
            for name, word, value in zip(header, words, values, strict=True)
            if value is None
        ]
        rows.append(values)
    if faults:
        raise DataFileError(*(f"{quoted(path.name)}, {fault}" for fault in faults[: MESSAGES.faults]))
    table = np.array(rows, dtype=np.float64).reshape(len(rows), len(header))
    return dict(zip(header, table.T.copy(), strict=True)), header


def _words(line: str, between: str | None) -> list[str]:
    if between is None:
        return line.split()
    return [word.strip() for word in next(csv.reader([line], delimiter=between))]
