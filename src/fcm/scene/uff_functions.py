"""Measured functions of a universal file, dataset 58: a response over the frequency, as complex amplitudes.

Its sixth line names the function (4 is a frequency response function, 12 a spectrum), the seventh the type of
its values (2 and 4 real, 5 and 6 complex, of single and double precision), their number, and whether the
frequencies are evenly spaced; the ninth says what the values are of (8 a displacement, 11 a velocity, 12 an
acceleration). Text is in columns of 13 or 20, as in Fortran's E13.5 and E20.12.
Source: SDRC I-DEAS Test Data Universal File Format, dataset 58, as published by the University of Cincinnati.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import numpy.typing as npt

from fcm.model.scene import FloatArray
from fcm.scene.errors import counted, quoted
from fcm.scene.files import DataFileError
from fcm.scene.number_text import fault_of_number, number_in
from fcm.scene.uff_datasets import Dataset, read_datasets
from fcm.units import QUANTITIES

ComplexArray = npt.NDArray[np.complex128]
HEAD = 11  # lines before the values
FUNCTION, FORM, ORDINATE = 5, 6, 8  # lines that say what it is, how its values are laid out, and of what
RESPONSE, SPECTRUM = 4, 12
KINDS = {
    RESPONSE: "a frequency response function", SPECTRUM: "a spectrum", 1: "a time response",
    2: "an auto spectrum", 3: "a cross spectrum", 6: "a coherence",
}  # fmt: skip
WIDTH = {2: 13, 4: 20, 5: 13, 6: 20}  # columns of a value, by its type
MEASURED = {8: "displacement", 11: "velocity", 12: "acceleration"}
SINGLE, DOUBLE = (2, 5), (4, 6)
COMPLEX = (5, 6)
EVEN_WIDTH = 13  # columns of an abscissa


def read_functions(path: Path) -> dict[str, FloatArray]:
    """angular_frequency [rad/s], amplitude, phase [rad], per_force and power of the one function of a file.

    power : of the frequency that the values have over displacements, where the file says it.

    Raises
    ------
    DataFileError
        If it has no response over the frequency, or several, or values that are no numbers.
    """
    every = read_datasets(path)
    functions = [one for one in every if one.kind in ("58", "58b")]
    said = [(one, _kind(one)) for one in functions]
    chosen = [one for one, kind in said if kind in (RESPONSE, SPECTRUM)]
    if len(chosen) != 1:
        others = ", ".join(dict.fromkeys(KINDS.get(kind, f"function {kind}") for _, kind in said)) or "none"
        held = ", ".join(dict.fromkeys(f"dataset {one.kind}" for one in every)) or "no dataset"
        what = f"has {counted(len(chosen), 'response')} over the frequency among its functions ({others})"
        raise DataFileError(f"{quoted(path.name)} {what}; one is right. The file holds {held}")
    frequency, value = _values(chosen[0], path)
    found = {
        "angular_frequency": 2.0 * np.pi * frequency,
        "amplitude": np.abs(value),
        "phase": np.angle(value),
        "per_force": np.full(frequency.size, float(_kind(chosen[0]) == RESPONSE)),
    }
    words = _line(chosen[0], ORDINATE).split()
    if words and words[0].isdecimal() and (quantity := MEASURED.get(int(words[0]))):
        found["power"] = np.full(frequency.size, float(QUANTITIES[quantity]))
    return found


def _kind(one: Dataset) -> int:
    found = one.integers(FUNCTION) or [
        int(word) for word in _line(one, FUNCTION).split()[:1] if word.isdecimal()
    ]
    return found[0] if found else -1


def _line(one: Dataset, at: int) -> str:
    return one.lines[at] if at < len(one.lines) else ""


def _values(one: Dataset, path: Path) -> tuple[FloatArray, ComplexArray]:
    """Frequencies [Hz] and complex values."""
    words = _line(one, FORM).split()
    where = f"{quoted(path.name)}, line {one.first + FORM}"
    numbers = [number_in(word) for word in words[:5]]
    if len(numbers) < 5 or any(number is None for number in numbers):
        raise DataFileError(
            f"{where}: must be type, count, spacing, first, step; is {quoted(_line(one, FORM), 60)}"
        )
    kind, count, even = (int(number or 0) for number in numbers[:3])
    first, step = (float(number or 0.0) for number in numbers[3:5])
    if kind not in COMPLEX:
        raise DataFileError(
            f"{where}: its values are not complex (type {kind}); a response has a phase: type 5 or 6"
        )
    flat = _binary(one, kind, even) if one.kind == "58b" else _text(one, kind, even, path)
    each = 2 if even else 3
    if flat.size != count * each:
        raise DataFileError(f"{where}: says {count} values, and {flat.size / each:g} follow")
    table = flat.reshape(count, each)
    frequency = np.asarray(first + step * np.arange(count) if even else table[:, 0], dtype=np.float64)
    return frequency, table[:, -2] + 1j * table[:, -1]


def _text(one: Dataset, kind: int, even: int, path: Path) -> FloatArray:
    """The numbers of a text, which may touch one another in their columns."""
    width = WIDTH[kind]
    abscissa = [] if even else [EVEN_WIDTH if kind == 6 else width]  # of single precision
    widths = [*abscissa, width, width] if abscissa else [width] * 6
    found = []
    for number, line in enumerate(one.lines[HEAD:], one.first + HEAD):
        at, words = 0, []
        for columns in widths:
            if word := line[at : at + columns].strip():
                words.append(word)
            at += columns
        if len(line.split()) == len(words) or any(number_in(word) is None for word in words):
            words = line.split()
        values = [number_in(word) for word in words]
        for word, value in zip(words, values, strict=True):
            if value is None:
                raise DataFileError(f"{quoted(path.name)}, line {number}: {fault_of_number(word)}")
        found += values
    return np.array(found, dtype=np.float64)


def _binary(one: Dataset, kind: int, even: int) -> FloatArray:
    """The numbers of the bytes: little-endian unless the file says otherwise."""
    order = ">" if one.big_endian else "<"
    real = np.dtype(f"{order}f{4 if kind in SINGLE else 8}")
    if even:
        return np.frombuffer(one.payload[: len(one.payload) // real.itemsize * real.itemsize], real).astype(
            np.float64
        )
    row = np.dtype([("x", f"{order}f{4 if kind in SINGLE else 8}"), ("y", real, 2)])
    rows = np.frombuffer(one.payload[: len(one.payload) // row.itemsize * row.itemsize], row)
    return np.column_stack((rows["x"], rows["y"])).astype(np.float64).ravel()
